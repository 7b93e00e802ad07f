"""Bands, levels and spectra; the standard's mask and published levels are in tests/validation."""

import numpy as np
import pytest

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
