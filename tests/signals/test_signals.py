"""Bands, levels and spectra against the standard and closed forms."""

import numpy as np
import pytest
from scipy import signal

from trundle.errors import InputError
from trundle.signals import (
    averaged_rms,
    band_edges,
    band_filter,
    band_levels,
    mid_band_frequencies,
    nominal_frequency,
    running_rms,
    usable_bands,
    welch_psd,
)

# IEC 61260-1:2014, table 1, class 1: normalised frequency G^x for an octave filter with the
# least and greatest relative attenuation [dB]; mapped to one-third octaves by its equation 9.
_OCTAVE = [0.0, 1 / 8, 1 / 4, 3 / 8, 0.4999999, 0.5000001, 1.0, 2.0, 3.0, 4.0]
_LEAST = [-0.4, -0.4, -0.4, -0.4, -0.4, 1.6, 16.6, 40.5, 60.0, 70.0]
_GREATEST = [0.4, 0.5, 0.7, 1.4, 5.3, np.inf, np.inf, np.inf, np.inf, np.inf]


def mask(ratio):
    """Return least and greatest attenuation at frequency over mid-band frequency."""
    g = 10**0.3
    third = []
    for x in _OCTAVE:
        octave = g**x
        third.append(1 + (g ** (1 / 6) - 1) / (g**0.5 - 1) * (octave - 1))
    third = np.log(third)
    position = np.abs(np.log(ratio))
    least = np.interp(position, third, _LEAST)
    greatest = np.interp(position, third[:5], _GREATEST[:5], right=np.inf)
    return least, greatest


@pytest.mark.parametrize("fs", [200.0, 400.0, 1000.0])
def test_every_band_meets_class_1(fs):
    """The whole mask for every band from 1 to 80 Hz, below 0.49 fs (V8)."""
    for f_mid in mid_band_frequencies():
        f = np.concatenate([f_mid * np.geomspace(0.05, 20.0, 4001)])
        f = f[f < 0.49 * fs]
        _, h = signal.freqz_sos(band_filter(f_mid, fs), worN=f, fs=fs)
        attenuation = -20 * np.log10(np.maximum(np.abs(h), 1e-12))
        least, greatest = mask(f / f_mid)
        assert np.all(attenuation >= least - 1e-6), f"{f_mid:.3g} Hz passes too much"
        assert np.all(attenuation <= greatest + 1e-6), f"{f_mid:.3g} Hz holds back too much"


def test_third_order_would_not_do():
    """Control: three sections break the mask, so the mask can fail."""
    f_mid, fs = 80.0 * 0.993, 200.0
    sos = signal.butter(3, band_edges(np.array([f_mid]))[0], "bandpass", fs=fs, output="sos")
    f = f_mid * np.geomspace(0.2, 1.23, 4001)
    _, h = signal.freqz_sos(sos, worN=f, fs=fs)
    attenuation = -20 * np.log10(np.maximum(np.abs(h), 1e-12))
    least, greatest = mask(f / f_mid)
    assert not (np.all(attenuation >= least) and np.all(attenuation <= greatest))


def test_names_and_edges_of_bands():
    f = mid_band_frequencies()
    names = [nominal_frequency(x) for x in f]
    assert names == [
        1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0,
        10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0, 50.0, 63.0, 80.0,
    ]  # fmt: skip
    edges = band_edges(f)
    np.testing.assert_allclose(edges[1:, 0], edges[:-1, 1])  # no gap, no overlap
    assert usable_bands(f, 200.0).all()
    assert usable_bands(f, 40.0).sum() == 13  # up to 16 Hz at the paper's 25 ms


@pytest.mark.parametrize(("f_mid", "level"), [(8.0, 1.35873), (10.0, 1.5191), (12.5, 1.69841)])
def test_white_noise(f_mid, level):
    """V8: PSD 1 (um/s)2/Hz has sqrt(f_m (10^.05 - 10^-.05)) in a band with straight sides.

    The filter's own noise bandwidth is integrated: sloping sides add 1.3 % to the level.
    """
    fs = 1000.0
    assert np.sqrt(np.ptp(band_edges(np.array([f_mid]))[0])) == pytest.approx(level, rel=1e-4)
    f, h = signal.freqz_sos(band_filter(f_mid, fs), worN=2**18, fs=fs)
    assert np.sqrt(np.trapezoid(np.abs(h) ** 2, f)) == pytest.approx(level, rel=0.015)


def test_sine_in_its_band():
    """100 um/s at 10 Hz: 70.711 in its band, next to nothing two bands away."""
    fs = 400.0
    t = np.arange(0, 30, 1 / fs)
    # eased in and out, for a sudden start is a broadband event of its own
    ease = np.clip(np.minimum(t, 30 - t) / 4, 0, 1)
    ease = ease**2 * (3 - 2 * ease)
    levels = band_levels(
        ease * 100 * np.sin(2 * np.pi * 10 * t),
        fs,
        np.array([10**0.8, 10.0, 10**1.2]),
        averaging="max_1s",
    )
    assert levels[1] == pytest.approx(100 / np.sqrt(2), rel=2e-3)
    assert levels[[0, 2]].max() < 5.0


@pytest.mark.parametrize(("averaging", "level"), [("max_1s", 0.316), ("slow", 0.262)])
def test_burst(averaging, level):
    """V8: a 10 Hz burst, peak 1, decay 0.5 s, in the 10 Hz band."""
    fs = 1000.0
    t = np.arange(0, 8, 1 / fs)
    burst = np.where(t >= 2, np.exp(-(t - 2) / 0.5) * np.sin(2 * np.pi * 10 * (t - 2)), 0.0)
    computed = band_levels(burst, fs, np.array([10.0]), averaging=averaging)[0]
    assert computed == pytest.approx(level, abs=0.002)


def test_a_record_that_ends_in_motion_is_no_click():
    """A 4 Hz sine cut at its crest: the 63 Hz band stays 60 dB below, as without the cut."""
    fs = 400.0
    t = np.arange(0, 20.0625, 1 / fs)
    ease = np.clip(t / 4, 0, 1)
    sine = ease**2 * (3 - 2 * ease) * np.sin(2 * np.pi * 4 * t)
    assert abs(sine[-1]) > 0.9
    for rule in ("max_1s", "slow"):
        level = band_levels(sine, fs, np.array([10**0.6, 10**1.8]), averaging=rule)
        assert level[0] == pytest.approx(np.sqrt(0.5), rel=0.02)
        assert level[1] < 1e-3 * level[0]


def test_averaging_rules_on_a_step():
    """A constant 1 for 0.25 s: 0.5 over 1 s, sqrt(1 - e^-0.25) slow, by length over the event."""
    fs = 1000.0
    x = np.zeros(4000)
    x[1000:1250] = 1.0
    assert averaged_rms(x, fs, "max_1s") == pytest.approx(0.5, rel=1e-6)
    assert averaged_rms(x, fs, "slow") == pytest.approx(np.sqrt(1 - np.exp(-0.25)), rel=1e-6)
    assert averaged_rms(x, fs, "event") == pytest.approx(0.25, rel=1e-9)
    assert running_rms(x, fs)[1249] == pytest.approx(0.5, rel=1e-9)


def test_parseval_of_the_psd():
    x = np.random.default_rng(1).standard_normal(200000) * 3.0
    f, psd = welch_psd(x, 100.0, resolution=0.1)
    assert np.trapezoid(psd, f) == pytest.approx(9.0, rel=0.01)


def test_a_band_too_high_is_refused():
    with pytest.raises(InputError, match="80 Hz band needs a sampling frequency"):
        band_filter(10**1.9, 100.0)


def test_filters_ring_on_after_the_record():
    """A burst that ends 0.4 s before its record has the level of the record padded with rest."""
    fs = 200.0
    t = np.arange(0, 5, 1 / fs)
    inside = (t > 4.1) & (t < 4.6)
    burst = np.where(inside, np.sin(np.pi * (t - 4.1) / 0.5) ** 2 * np.sin(2 * np.pi * 4 * t), 0)
    padded = np.concatenate([burst, np.zeros(1000)])
    cut, whole = (band_levels(x, fs, np.array([10**0.6]))[0] for x in (burst, padded))
    assert cut == pytest.approx(whole, rel=0.05)
