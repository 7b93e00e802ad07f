"""Classes, spectra and indices read off roads, against closed forms and another solution."""

import numpy as np
import pytest
from scipy import signal

from trundle.errors import InputError
from trundle.road import (
    Profile,
    RoadClass,
    RoadSpectrum,
    RoughnessBand,
    classify,
    fit_roughness,
    roughness_index,
    synthesise,
    temporal_psd,
)


def test_the_class_of_a_road_is_that_of_its_straight_line():
    """A road drawn from a spectrum of w = 3: the fit gives back w, and Gd(n0) of either line.

    With w = 2 the line through Gd n^2 passes the mean of log Gd: at the middle of the octaves
    both lines meet. The class is that of the limits about it.
    """
    road = RoadSpectrum(roughness=300e-6, waviness=3.0, name="heavy <b>")
    made = synthesise(road, length=4000.0, rng=np.random.default_rng(8))
    fit = fit_roughness(made)
    assert fit.waviness == pytest.approx(3.0, abs=0.1)
    assert fit.roughness == pytest.approx(300e-6, rel=0.25)
    middle = np.sqrt(fit.n_min * fit.n_max)
    octaves = int(np.log2(fit.n_max / fit.n_min))
    assert octaves >= 6
    expected = fit.roughness * (middle / 0.1) ** (2.0 - fit.waviness)
    assert fit.roughness_at_two == pytest.approx(expected, rel=1e-6)
    limits = 16e-6 * 4.0 ** np.arange(8) * 2.0
    assert classify(made).name == "ABCDEFGH"[int(np.searchsorted(limits, fit.roughness_at_two))]
    assert str(road) == "heavy <b> (Gd(n0) = 300e-6 m3, w = 3)"


@pytest.mark.parametrize("wavelength", [2.5, 9.0, 20.0])
def test_the_index_of_a_sine_is_that_of_the_golden_car(wavelength):
    """Steady motion of the quarter car by its frequency response, dense and by itself.

    Golden car (Sayers 1995) per sprung mass at 80 km/h: mean of |sin| is 2 / pi of the amplitude of
    suspension velocity over speed; 250 mm of averaging leave sin(pi a / L) / (pi a / L). The first
    segments are left to settle.
    """
    amplitude, v = 2e-3, 80.0 / 3.6
    w = 2 * np.pi * v / wavelength
    k1, k2, c, mu = 653.0, 63.3, 6.0, 0.15
    matrix = np.array(
        [
            [k2 + 1j * w * c - w**2, -k2 - 1j * w * c],
            [-k2 - 1j * w * c, k1 + k2 + 1j * w * c - mu * w**2],
        ]
    )
    zs, zu = np.linalg.solve(matrix, np.array([0.0, k1]))
    felt = amplitude * np.sinc(0.25 / wavelength)
    expected = 2.0 / np.pi * felt * w * abs(zs - zu) / v
    s = np.arange(0.0, 800.0, 0.05)
    made = Profile.from_samples(s, amplitude * np.sin(2 * np.pi * s / wavelength) + 250.0)
    index = roughness_index(made, spacing=0.05)
    np.testing.assert_allclose(index[2:], expected, rtol=0.01)


def test_twice_the_height_is_twice_the_index():
    """All is linear, and only whole segments count: 350 m hold three of 100 m, or 7 of 50."""
    made = synthesise(RoadClass("B"), length=350.0, rng=np.random.default_rng(2))
    twice = Profile(
        station=made.station, elevation=2.0 * made.elevation + 9.0, slope=2.0 * made.slope
    )
    one, two = roughness_index(made), roughness_index(twice)
    assert len(one) == 3
    np.testing.assert_allclose(two, 2.0 * one, rtol=1e-6)
    half = roughness_index(made, segment=50.0)
    assert len(half) == 7
    np.testing.assert_allclose(half[:6].reshape(3, 2).mean(axis=1), one, rtol=1e-9)
    with pytest.raises(InputError, match=r"spacing must be at most 0.25 m; got 0.3 m"):
        roughness_index(made, spacing=0.3)


def test_ground_motion_under_a_wheel_has_its_spectrum():
    """A wheel at 8 m/s over a drawn road of class C: Welch's PSD of the height read in time.

    Within 10 % of G(f) = Gd(f / V) / V, averaged over octaves of some hundred windows.
    """
    speed, fs = 8.0, 200.0
    made = synthesise(
        RoadClass("C"), length=6000.0, rng=np.random.default_rng(4), band=RoughnessBand(n_max=4.0)
    )
    height = made.at(speed * np.arange(0.0, 700.0, 1 / fs))[0]
    f, psd = signal.welch(height, fs, nperseg=2048)
    for low in (1.0, 2.0, 4.0, 8.0):
        some = (f >= low) & (f < 2.0 * low)
        ratio = np.mean(psd[some] / temporal_psd(RoadClass("C"), f[some], speed=speed))
        assert ratio == pytest.approx(1.0, abs=0.1)
