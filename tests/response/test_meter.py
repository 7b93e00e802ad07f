"""Running levels beside limits: in parts as at once, and against levels formed otherwise."""

import numpy as np
import pytest

from trundle.response import CurveLimit, Meter
from trundle.signals import (
    averaged_rms,
    band_levels,
    mid_band_frequencies,
    running_rms,
)

FS = 200.0
BANDS = mid_band_frequencies()
RNG = np.random.default_rng(3)
NOISE = RNG.standard_normal((2, 3, 6000)) * np.hanning(6000)  # two runs, three points


def limits(value, quantity="band_rms_velocity", name="c"):
    single = quantity in {"peak_acceleration", "response_factor"}
    return CurveLimit(
        name=name, quantity=quantity, limits=np.full(1 if single else len(BANDS), value)
    )


def motion(samples):
    names = ("displacement", "velocity", "acceleration", "felt")
    return dict.fromkeys(names, samples)


def test_the_largest_reading_is_the_largest_band_level():
    """Level over limit, the worst of all bands, is what `band_levels` gives by rule max_1s.

    That rule lets filters ring on behind the record, which fades out here before it ends.
    """
    reading = Meter([limits(0.02)], BANDS, FS).take(motion(NOISE))
    levels = band_levels(NOISE, FS, BANDS)
    expected = levels.max(axis=0) / 0.02
    np.testing.assert_allclose(np.sqrt(reading.square[0].max(axis=-1)), expected, rtol=1e-5)
    at = reading.square[0].argmax(axis=-1)[..., None]
    worst = np.take_along_axis(reading.band[0], at, axis=-1)[..., 0]
    np.testing.assert_array_equal(worst, levels.argmax(axis=0))


@pytest.mark.parametrize(
    "quantity",
    ["band_rms_velocity", "band_peak_acceleration", "peak_acceleration", "response_factor"],
)
def test_in_parts_it_reads_what_it_reads_at_once(quantity):
    """Parts of any length, shorter than a second among them: the same readings, to rounding."""
    curve = [limits(0.05, quantity)]
    whole = Meter(curve, BANDS, FS).take(motion(NOISE)).square
    meter, parts, at = Meter(curve, BANDS, FS), [], 0
    for length in (1, 130, 199, 200, 201, 1500, 3769):
        parts.append(meter.take(motion(NOISE[..., at : at + length])).square)
        at += length
    assert at == NOISE.shape[-1]
    scale = whole.max()
    np.testing.assert_allclose(np.concatenate(parts, axis=-1), whole, atol=1e-6 * scale)


def test_after_a_rest_nothing_is_left():
    """A meter that forgets reads as a new one."""
    curve = [limits(0.05)]
    meter = Meter(curve, BANDS, FS)
    meter.take(motion(NOISE))
    meter.rest()
    np.testing.assert_array_equal(
        meter.take(motion(NOISE)).square, Meter(curve, BANDS, FS).take(motion(NOISE)).square
    )


def test_single_numbers_are_running_ones():
    """Peaks are the largest of the last second, response factors the RMS of it over 0.005."""
    peak, felt = (
        Meter([limits(1.0, quantity)], BANDS, FS).take(motion(NOISE)).square[0]
        for quantity in ("peak_acceleration", "response_factor")
    )
    for i in (250, 3000, 5999):
        np.testing.assert_allclose(
            np.sqrt(peak[..., i]), np.abs(NOISE[..., i - 199 : i + 1]).max(axis=-1), rtol=1e-5
        )
    np.testing.assert_allclose(np.sqrt(felt), running_rms(NOISE, FS) / 0.005, rtol=1e-3, atol=1e-2)
    assert averaged_rms(NOISE, FS, "max_1s").shape == (2, 3)


def test_a_burst_lies_above_for_as_long_as_it_lasts_and_a_second():
    """10 Hz of 4 s, RMS 1 in its band: above 0.1 for 4 s, the window's second, and some delay.

    The running mean square rises within 0.01 s of its beginning and falls 1 s behind its end; the
    filter's delay of some 0.3 s moves both.
    """
    time = np.arange(0.0, 12.0, 1 / FS)
    on = (time > 2.0) & (time < 6.0)
    burst = np.sqrt(2.0) * np.sin(2 * np.pi * 10.0 * time) * on
    one = CurveLimit(name="c", quantity="band_rms_velocity", limits=np.array([0.1]))
    reading = Meter([one], BANDS[10:11], FS).take(motion(burst[None]))
    seconds = (reading.square[0] > 1.0).sum() / FS
    assert seconds == pytest.approx(5.0, abs=0.3)


def test_limits_that_are_not_known_are_not_read():
    """NaN in a band leaves it out; curves of doses and of narrow lines have no running level."""
    some = np.full(len(BANDS), np.nan)
    some[10] = 0.05
    one = CurveLimit(name="c", quantity="band_rms_velocity", limits=some)
    reading = Meter([one], BANDS, FS).take(motion(NOISE))
    assert set(np.unique(reading.band[0][reading.square[0] > 0.0])) == {10}
    dose = CurveLimit(name="d", quantity="vdv", limits=np.array([0.1]))
    assert one.is_read
    assert not dose.is_read
    assert not limits(np.nan).is_read
    assert Meter([dose], BANDS, FS).take(motion(NOISE)).square.max() == 0.0
