"""Weightings of ISO 8041-1 and the measures of human comfort."""

import numpy as np
import pytest

from trundle.signals import (
    crest_factor,
    estimated_dose_value,
    mtvv,
    response_factor,
    vibration_dose_value,
    weight,
    weighting_response,
)

F = 10.0 ** (np.array([0, 3, 6, 9, 12, 15, 19]) / 10.0)
LISTED = {  # |H| at the exact centres of 1, 2, 4, 8, 16, 31.5, 80 Hz (ISO 8041-1, tables B)
    "Wb": [0.385, 0.417, 0.885, 1.026, 0.814, 0.491, 0.173],
    "Wk": [0.4825, 0.531, 0.965, 1.037, 0.774, 0.403, 0.134],
    "Wd": [1.011, 0.891, 0.514, 0.255, 0.127, 0.063, 0.021],
    "Wm": [0.833, 0.932, 0.818, 0.582, 0.338, 0.176, 0.060],
}


@pytest.mark.parametrize("name", LISTED)
def test_magnitudes_are_those_of_the_standard(name):
    """1 % of the values listed, and half of their last digit."""
    found = np.abs(weighting_response(name, F))
    np.testing.assert_allclose(found, LISTED[name], rtol=0.01, atol=0.0005)
    assert weighting_response(name, np.array([0.0]))[0] == 0.0


@pytest.mark.parametrize("name", LISTED)
@pytest.mark.parametrize("fs", [200.0, 1000.0])
def test_a_sine_is_weighted_by_the_magnitude(name, fs):
    """In steady state the response is the amplitude, whatever the sampling frequency."""
    t = np.arange(0, 40, 1 / fs)
    for f, listed in zip(F, LISTED[name], strict=True):
        steady = weight(np.sin(2 * np.pi * f * t), fs, name)[len(t) // 2 : -len(t) // 8]
        assert np.sqrt(2 * np.mean(steady**2)) == pytest.approx(listed, rel=0.012, abs=0.0006)


def test_a_weighting_is_causal():
    """Nothing comes before its cause: the answer to a burst is rest until the burst."""
    x = np.zeros(4000)
    x[2000] = 1.0
    y = weight(x, 200.0, "Wk")
    assert np.abs(y[:1990]).max() < 0.01 * np.abs(y).max()


def test_measures_of_a_steady_sine():
    """1 m/s2 at 8 Hz: RMS over whole periods 1/sqrt 2; VDV = (3/8 T)^(1/4); crest sqrt 2."""
    fs, t = 320.0, np.arange(0, 20, 1 / 320.0)
    x = np.sin(2 * np.pi * 8 * t)
    assert mtvv(x, fs) == pytest.approx(np.sqrt(0.5), rel=1e-6)
    assert response_factor(mtvv(x, fs)) == pytest.approx(np.sqrt(0.5) / 0.005, rel=1e-6)
    assert vibration_dose_value(x, fs) == pytest.approx((0.375 * 20) ** 0.25, rel=1e-6)
    assert vibration_dose_value(x, fs, events=16) == pytest.approx(
        2 * (0.375 * 20) ** 0.25, rel=1e-6
    )
    assert crest_factor(x) == pytest.approx(np.sqrt(2), rel=1e-6)


def test_an_estimated_dose_is_the_dose_of_steady_motion_and_too_low_for_bursts():
    """VDV over eVDV: 1.107 / 1.4 of a sine, 1.316 / 1.4 of Gaussian noise; above 1 of a burst.

    The fourth moment of a sine of RMS 1 is 1.5, of a normal variable 3; of 100,000 samples the
    latter's fourth root scatters by some 0.3 %. A burst that lasts a share p of the record has
    ``p^(-1/4)`` times the ratio of what it is made of: twice, of a sixteenth.
    """
    fs, n = 100.0, 100_000
    sine = np.sqrt(2.0) * np.sin(2 * np.pi * 7.0 * np.arange(n) / fs)
    noise = np.random.default_rng(0).standard_normal(n)
    burst = np.where(np.arange(n) < n // 16, sine, 0.0)
    for samples, expected in (
        (sine, 1.5**0.25 / 1.4), (noise, 3.0**0.25 / 1.4), (burst, 2.0 * 1.5**0.25 / 1.4),
    ):  # fmt: skip
        rms = np.sqrt(np.mean(samples**2))
        ratio = vibration_dose_value(samples, fs) / estimated_dose_value(rms, n / fs)
        assert ratio == pytest.approx(expected, rel=0.01)
