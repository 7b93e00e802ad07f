"""Roads against ISO 8608: levels, spectra, variance, exact slope."""

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.road import (
    CLASS_NAMES,
    Profile,
    RoadClass,
    RoughnessBand,
    class_limits,
    fit_roughness,
    synthesise,
    temporal_psd,
    temporal_psd_two_sided,
)


def test_table_1():
    """Pan, Mita and Li (2001), Table 1, in 1e-6 m3."""
    table = {
        "A": (8, 16, 32), "B": (32, 64, 128), "C": (128, 256, 512), "D": (512, 1024, 2048),
        "E": (2048, 4096, 8192), "F": (8192, 16384, 32768), "G": (32768, 65536, 131072),
        "H": (131072, 262144, 524288),
    }  # fmt: skip
    for name in CLASS_NAMES:
        assert np.array(class_limits(name)) * 1e6 == pytest.approx(table[name])
    for level, limit in zip(("lower", "geometric_mean", "upper"), table["C"], strict=True):
        assert RoadClass("C", level=level).displacement_psd(0.1) == pytest.approx(limit * 1e-6)


def test_both_forms_of_the_spectrum_hold_the_same_power():
    """Gd(n) dn = Gd(Omega) dOmega; and ISO's Gd(Omega0) of class A is about 1e-6 m3."""
    road = RoadClass("A")
    in_n, _ = integrate.quad(road.displacement_psd, 0.05, 2.0)
    in_angular, _ = integrate.quad(road.displacement_psd_angular, 0.1 * np.pi, 4.0 * np.pi)
    assert in_n == pytest.approx(in_angular, rel=1e-9)
    assert road.displacement_psd_angular(1.0) == pytest.approx(1e-6, rel=0.02)


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_temporal_spectra_hold_the_power_of_the_spatial_ones(derivative):
    """Equations 2 and 3: one-sided over f, two-sided over omega, and (2 pi n V)^2d Gd over n."""
    road, speed = RoadClass("B"), 15 / 3.6
    low, high = 0.2, 10.0
    one, _ = integrate.quad(
        lambda f: temporal_psd(road, f, speed=speed, derivative=derivative), low, high
    )
    two, _ = integrate.quad(
        lambda w: temporal_psd_two_sided(road, w, speed=speed, derivative=derivative),
        2 * np.pi * low,
        2 * np.pi * high,
    )
    space, _ = integrate.quad(
        lambda n: (2 * np.pi * n * speed) ** (2 * derivative) * road.displacement_psd(n),
        low / speed,
        high / speed,
    )
    assert one == pytest.approx(space, rel=1e-8)
    assert 2 * two == pytest.approx(space, rel=1e-8)  # both signs of omega
    # the paper prints (2 pi f)^(2 d) Gd(n) / (4 pi V)
    f = 3.0
    printed = (
        (2 * np.pi * f) ** (2 * derivative) * road.displacement_psd(f / speed) / (4 * np.pi * speed)
    )
    assert temporal_psd_two_sided(
        road, -2 * np.pi * f, speed=speed, derivative=derivative
    ) == pytest.approx(printed)


def test_amplitude_doubles_from_class_to_class():
    """Gd quadruples from A to B, so with the same phases the road is exactly twice as rough."""
    a, b = (synthesise(RoadClass(name), length=50.0, rng=np.random.default_rng(7)) for name in "AB")
    np.testing.assert_allclose(b.elevation, 2 * a.elevation, rtol=1e-12)


def test_shorter_waves_are_added_to_the_same_long_ones():
    """A wider band with the same seed keeps the long waves, so methods share their road."""
    narrow, wide = (
        synthesise(
            RoadClass("B"), length=120.0, rng=np.random.default_rng(4), band=RoughnessBand(n_max=n)
        )
        for n in (0.5, 3.0)
    )
    s = np.linspace(0.0, 120.0, 1201)
    added = wide.at(s)[0] - narrow.at(s)[0]
    assert added.var() == pytest.approx(RoadClass("B").variance(0.5, 3.0), rel=0.05)


def test_slope_is_the_derivative_everywhere():
    """At samples the slope is that of the Fourier series, between them that of the cubic."""
    profile = synthesise(RoadClass("C"), length=60.0, rng=np.random.default_rng(1))
    s = np.random.default_rng(2).uniform(1.0, 59.0, 200)
    h = 1e-6
    difference = (profile.at(s + h)[0] - profile.at(s - h)[0]) / (2 * h)
    np.testing.assert_allclose(profile.at(s)[1], difference, atol=1e-7)


def test_interpolation_between_samples_is_exact_enough():
    """A road drawn with a finer step but the same waves differs by under 1e-4 of its height."""
    band = RoughnessBand(n_max=2.0)
    profile = synthesise(RoadClass("B"), length=80.0, rng=np.random.default_rng(3), band=band)
    coarse = Profile(
        station=profile.station[::2], elevation=profile.elevation[::2], slope=profile.slope[::2]
    )
    middle = profile.station[1:-1:2]
    error = coarse.at(middle)[0] - profile.at(middle)[0]
    assert np.abs(error).max() < 2e-4 * profile.elevation.std()


def test_tyre_averaging_follows_sinc():
    """Averaging over a length a multiplies each wave by sin(pi n a) / (pi n a)."""
    band = {"n_min": 0.5, "n_max": 0.52}
    point, patch = (
        synthesise(
            RoadClass("B"),
            length=200.0,
            rng=np.random.default_rng(5),
            band=RoughnessBand(**band, contact_patch=a),
        )
        for a in (0.0, 0.8)
    )
    ratio = patch.elevation.std() / point.elevation.std()
    assert ratio == pytest.approx(np.sinc(0.51 * 0.8), rel=0.01)


def test_roads_do_not_repeat_and_seeds_decide():
    first, again, other = (
        synthesise(RoadClass("B"), length=300.0, rng=np.random.default_rng(seed))
        for seed in (1, 1, 2)
    )
    assert np.array_equal(first.elevation, again.elevation)
    assert not np.array_equal(first.elevation, other.elevation)
    half = len(first.elevation) // 2
    z = first.elevation - first.elevation.mean()
    assert abs(np.corrcoef(z[:half], z[half : 2 * half])[0, 1]) < 0.8


def test_piecewise_linear_profile_and_its_kinks():
    """The ramp of V2: 0 to 10 mm between L/3 and L/2, level on both sides."""
    length = 25.0
    profile = Profile.piecewise_linear(
        [0.0, length / 3, length / 2, length], [0.0, 0.0, 0.01, 0.01], beyond="level"
    )
    z, slope = profile.at([-5.0, 4.0, length * 5 / 12, 20.0, 99.0])
    assert z == pytest.approx([0.0, 0.0, 0.005, 0.01, 0.01])
    assert slope == pytest.approx([0.0, 0.0, 0.01 / (length / 6), 0.0, 0.0])


def test_measured_samples_come_back():
    s = np.linspace(0.0, 10.0, 41)
    profile = Profile.from_samples(s, np.sin(s))
    z, slope = profile.at([2.5, 5.05])
    assert z == pytest.approx(np.sin([2.5, 5.05]), abs=1e-5)
    assert slope == pytest.approx(np.cos([2.5, 5.05]), abs=1e-3)


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: RoadClass("Z"), "road class must be one of"),
        (lambda: RoadClass("B", waviness=20.0), r"waviness must be in \[1, 4\]; got 20"),
        (lambda: RoughnessBand(n_min=2.0, n_max=1.0), "n_max must be above"),
        (lambda: Profile.from_samples([0, 1, 2], [0, 1, 2]), "at least 4 points"),
        (
            lambda: Profile(
                station=np.array([0.0, -1.0]), elevation=np.zeros(2), slope=np.zeros(2)
            ),
            "must not fall",
        ),
        (
            lambda: synthesise(
                RoadClass("B"), length=10.0, rng=np.random.default_rng(0), spacing=1.0
            ),
            "spacing must be at most",
        ),
    ],
)
def test_bad_roads_are_refused(make, match):
    with pytest.raises(InputError, match=match):
        make()


@pytest.mark.parametrize("waviness", [1.0, 1.5, 2.5, 3.0])
def test_other_wavinesses_hold_their_power_and_are_found_again(waviness):
    """Quadrature of Gd over the band is the variance; a fit gives back the exponent asked for."""
    road = RoadClass("B", waviness=waviness)
    power, _ = integrate.quad(road.displacement_psd, 0.02, 2.0)
    assert road.variance(0.02, 2.0) == pytest.approx(power, rel=1e-8)
    band = RoughnessBand(n_min=0.005, n_max=2.83)
    fits = [
        fit_roughness(
            synthesise(road, length=800.0, rng=np.random.default_rng(seed), band=band)
        ).waviness
        for seed in range(20)
    ]
    assert np.mean(fits) == pytest.approx(waviness, abs=0.1)


def test_a_band_that_falls_holds_no_variance():
    """From 1 to 0.1 cycle/m the integral is negative, which no variance is; of one line it is 0."""
    with pytest.raises(InputError, match=r"n_max must be n_min, 1 cycle/m, or more; got 0\.1"):
        RoadClass("A").variance(1.0, 0.1)
    assert RoadClass("A").variance(1.0, 1.0) == 0.0
