"""V8: one-third-octave bands against IEC 61260-1, and integrators against their closed forms."""

import numpy as np
import pytest
from iec_mask import mask
from scipy import signal

from trundle.dynamics import LinearSystem, NewmarkPropagator
from trundle.dynamics.stepping import State
from trundle.signals import (
    band_edges,
    band_filter,
    band_levels,
    mid_band_frequencies,
    nominal_frequency,
)
from trundle.simulate import Newmark

CASE = "V8"
SOURCE = "IEC 61260-1:2014"


@pytest.mark.parametrize("fs", [200.0, 400.0, 1000.0])
@pytest.mark.parametrize("f_mid", mid_band_frequencies(), ids=nominal_frequency)
def test_class_1_mask(record, fs, f_mid):
    """How far the attenuation leaves the mask, anywhere below 0.49 fs: nowhere at all."""
    f = f_mid * np.geomspace(0.05, 20.0, 4001)
    f = f[f < 0.49 * fs]
    _, h = signal.freqz_sos(band_filter(f_mid, fs), worN=f, fs=fs)
    attenuation = -20 * np.log10(np.maximum(np.abs(h), 1e-12))
    least, greatest = mask(f / f_mid)
    outside = max(0.0, np.max(least - attenuation), np.max(attenuation - greatest))
    name = f"{nominal_frequency(f_mid):g} Hz band outside class 1, fs = {fs:g} Hz"
    record.row(name, 0.0, outside, unit="dB", atol=1e-6)


@pytest.mark.parametrize("order", [3, 5])
def test_other_orders(order):
    """Control: three sections break the mask, so it can fail; five meet it at a higher cost."""
    f_mid, fs = 10**1.9, 200.0
    sos = signal.butter(order, band_edges(np.array([f_mid]))[0], "bandpass", fs=fs, output="sos")
    f = f_mid * np.geomspace(0.2, 1.23, 4001)
    _, h = signal.freqz_sos(sos, worN=f, fs=fs)
    attenuation = -20 * np.log10(np.maximum(np.abs(h), 1e-12))
    least, greatest = mask(f / f_mid)
    meets = np.all(attenuation >= least) and np.all(attenuation <= greatest)
    assert meets == (order == 5)


@pytest.mark.parametrize(("f_mid", "level"), [(8.0, 1.35873), (10.0, 1.5191), (12.5, 1.69841)])
def test_white_noise(record, f_mid, level):
    """A PSD of 1 (um/s)2/Hz has sqrt(f_m (10^.05 - 10^-.05)) in a band with straight sides.

    The printed values take nominal mid-band frequencies; the filter stands at the exact one and
    has sloping sides, which IEC 61260-1, 5.12 allows 0.4 dB of effective bandwidth: 4.7 %.
    """
    source = "straight sides, nominal mid-band frequency (verification list)"
    straight = np.sqrt(np.ptp(band_edges(np.array([f_mid]))[0]))
    name = f"white noise in the {f_mid:g} Hz band"
    record.row(f"{name}, straight sides", level, straight, unit="um/s", rtol=1e-4, source=source)
    exact = 10 ** (round(10 * np.log10(f_mid)) / 10)
    f, h = signal.freqz_sos(band_filter(exact, 1000.0), worN=2**18, fs=1000.0)
    filtered = np.sqrt(np.trapezoid(np.abs(h) ** 2, f))
    record.row(f"{name}, filter", level, filtered, unit="um/s", rtol=0.047, source=source)
    # the Butterworth band-pass of order 4 passes (pi / 8) / sin(pi / 8) of its band
    own = np.sqrt(np.ptp(band_edges(np.array([exact]))[0]) * (np.pi / 8) / np.sin(np.pi / 8))
    record.row(
        f"{name}, filter against its own noise bandwidth", own, filtered, unit="um/s", rtol=2e-3,
        source="Butterworth, closed form",
    )  # fmt: skip


def test_sine_in_its_band(record):
    """100 um/s at 10 Hz, eased in and out, for a sudden start is a broadband event of its own."""
    fs = 400.0
    t = np.arange(0, 30, 1 / fs)
    ease = np.clip(np.minimum(t, 30 - t) / 4, 0, 1)
    ease = ease**2 * (3 - 2 * ease)
    sine = ease * 100 * np.sin(2 * np.pi * 10 * t)
    for rule, tau in (("max_1s", np.inf), ("slow", 1.0), ("fast", 0.125)):
        level = band_levels(sine, fs, np.array([10.0]), averaging=rule)[0]
        # an exponential average of a squared sine ripples by 1 / sqrt(1 + (4 pi f tau)^2)
        wanted = 70.711 * np.sqrt(1.0 + 1.0 / np.hypot(1.0, 4 * np.pi * 10 * tau))
        name = f"sine of 100 um/s at 10 Hz in its band, {rule}"
        record.row(name, wanted, level, unit="um/s", rtol=1e-3, source="closed form")


@pytest.mark.parametrize(
    ("averaging", "level"), [("max_1s", 0.316), ("slow", 0.262), ("fast", 0.442)]
)
def test_burst(record, averaging, level):
    """A 10 Hz burst, peak 1, decay 0.5 s, in the 10 Hz band; three digits are printed."""
    fs = 1000.0
    t = np.arange(0, 8, 1 / fs)
    burst = np.where(t >= 2, np.exp(-(t - 2) / 0.5) * np.sin(2 * np.pi * 10 * (t - 2)), 0.0)
    computed = band_levels(burst, fs, np.array([10.0]), averaging=averaging)[0]
    source = "verification list"
    record.row(f"burst, {averaging}", level, computed, atol=2e-3, source=source)


@pytest.mark.parametrize(("f", "longer"), [(3.75, 0.0283), (10.0, 0.180)])
def test_period_of_average_acceleration(record, f, longer):
    """Newmark 1/2, 1/4: ``omega_num = (2/dt) atan(omega dt / 2)``; the period read off zeros."""
    dt, omega = 0.025, 2 * np.pi * f
    system = LinearSystem(
        mass=np.eye(1), damping=np.zeros((1, 1)), stiffness=np.array([[omega**2]])
    )
    propagator = NewmarkPropagator(system, Newmark(dt=dt))
    one = np.ones((1, 1))
    state = State(displacement=one, velocity=0 * one, acceleration=-(omega**2) * one)
    u = [1.0]
    for _ in range(4000):
        state = propagator.finish(state, propagator.predict(state))
        u.append(float(state.displacement[0, 0]))
    u = np.array(u)
    down = np.flatnonzero((u[:-1] > 0) & (u[1:] <= 0))
    crossings = down + u[down] / (u[down] - u[down + 1])
    period = dt * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    exact = omega * dt / 2 / np.arctan(omega * dt / 2)
    name = f"period of a {f:g} Hz oscillator at dt = 25 ms over the exact one"
    record.row(name, exact, period * f, rtol=1e-3, source="omega_num = (2/dt) atan(omega dt/2)")
    printed = f"period elongation at {f:g} Hz, as printed"
    record.row(printed, longer, period * f - 1, atol=1e-3, source="verification list")
    record.row(
        f"amplitude kept over 4000 steps at {f:g} Hz", 1.0, np.abs(u[-400:]).max(), rtol=5e-3,
        source="no numerical damping; sampled peak",
    )  # fmt: skip
