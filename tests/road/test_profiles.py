"""Measured profiles: what lies between and beyond their points, under a tyre, in which unit."""

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.road import (
    Profile,
    RoadClass,
    classify,
    fit_roughness,
    profile_doubts,
    roughness_index,
    synthesise,
)

STEP = ([0.0, 5.0, 5.05, 10.0], [0.0, 0.0, 0.02, 0.02])


def sine(wave, *, height=0.002, spacing=0.01, beyond="unknown"):
    s, n = np.arange(-3.0, 3.0 + spacing / 2, spacing), 2 * np.pi / wave
    return Profile(
        station=s, elevation=height * np.sin(n * s), slope=n * height * np.cos(n * s), beyond=beyond
    )


@pytest.mark.parametrize("patch", [0.05, 0.125, 0.25, 0.6])
def test_a_tyre_leaves_sinc_of_a_wave(patch):
    """sin(pi a / L) / (pi a / L) of elevation and slope alike; nothing of a wave of its length.

    With k = 2 pi / L the cubics between points h = 1 cm apart are within (k h)^4 / 384 = 1e-5 of
    a wave, and their slopes within (k h)^3 / 72 = 2e-4.
    """
    wave = 0.25
    road, share = sine(wave), np.sinc(patch / wave)
    s = np.linspace(-2.5, 2.5, 999)
    pairs = zip(road.averaged(patch).at(s), road.at(s), (3e-5, 3e-4), strict=True)
    for ours, point, tolerance in pairs:
        np.testing.assert_allclose(ours, share * point, atol=tolerance * np.abs(point).max())


@pytest.mark.parametrize("beyond", ["unknown", "level", "mirror"])
def test_the_average_is_exact_on_straight_lines(beyond):
    """By quadrature between the kinks, at any station; and its slope is its derivative."""
    road = Profile.piecewise_linear(
        [0.0, 1.0, 1.03, 2.5, 4.0], [0.01, 0.0, 0.02, -0.01, 0.03], beyond=beyond
    )
    patch, h = 0.3, 1e-5
    mean = road.averaged(patch)
    margin = 0.16 if beyond == "unknown" else -1.0
    for s in np.linspace(margin, 4.0 - margin, 23):
        kinks = [k for k in (0.0, 1.0, 1.03, 2.5, 4.0) if abs(k - s) < patch / 2]
        area, _ = integrate.quad(
            lambda x: road.at(x)[0], s - patch / 2, s + patch / 2, points=kinks
        )
        assert mean.at(s)[0] == pytest.approx(area / patch, abs=1e-9)
        difference = (mean.at(s + h)[0] - mean.at(s - h)[0]) / (2 * h)
        assert mean.at(s)[1] == pytest.approx(difference, abs=1e-4)


def test_a_profile_shorter_than_the_tyre_is_refused():
    with pytest.raises(InputError, match="cannot be averaged over 20 m"):
        Profile.piecewise_linear(*STEP).averaged(20.0)


def test_the_road_beyond_its_stations_is_a_choice():
    """Unknown is refused; level keeps the height; a mirror image goes on at the same slope."""
    points = ([0.0, 1.0, 3.0], [0.0, 0.01, 0.05])
    with pytest.raises(InputError, match=r"covers 0 to 3 m; the road at 3.5 m is unknown"):
        Profile.piecewise_linear(*points).at([1.0, 3.5])
    level = Profile.piecewise_linear(*points, beyond="level").at([-2.0, 9.0])
    assert level[0] == pytest.approx([0.0, 0.05])
    assert level[1] == pytest.approx([0.0, 0.0])
    # turned about (3, 0.05): up 0.02 a metre to 5 m, 0.01 to 6 m; about (0, 0): 0.01 to -1 m
    mirror = Profile.piecewise_linear(*points, beyond="mirror")
    z, slope = mirror.at([3.5, 5.5, 6.5, -0.5, -2.0, 3.0, 6.0, 0.0])
    assert z == pytest.approx([0.06, 0.095, 0.105, -0.005, -0.03, 0.05, 0.1, 0.0])
    assert slope[:5] == pytest.approx([0.02, 0.01, 0.01, 0.01, 0.02])


def test_a_profile_is_laid_where_it_is_wanted():
    road = Profile.from_samples(478.0 + np.arange(5.0), [0.0, 1.0, 0.0, 2.0, 0.0], beyond="level")
    for laid in (road.moved(-480.0), road.starting_at(-2.0)):
        assert laid.beyond == "level"
        np.testing.assert_array_equal(laid.station, [-2.0, -1.0, 0.0, 1.0, 2.0])
        np.testing.assert_allclose(laid.at([-1.5, 0.7]), road.at([478.5, 480.7]), rtol=1e-12)


@pytest.mark.parametrize("gap", [1e-6, 1e-3, 0.05])
def test_a_curve_through_a_step_does_not_swing(gap):
    """A step of 20 mm between level points: no curve through it needs to leave 0 to 20 mm."""
    s = np.array([0.0, 1.0, 2.0, 3.0, 3.0 + gap, 4.0, 5.0, 6.0])
    z = np.where(s > 3.0, 0.02, 0.0)
    height = Profile.from_samples(s, z).at(np.linspace(0.0, 6.0, 60001))[0]
    assert height.min() >= -1e-12
    assert height.max() <= 0.02 + 1e-12


@pytest.mark.parametrize("power", [0.0, 1.0, 3.0])
def test_a_curve_through_random_points_stays_near_them(power):
    """It leaves the range of the six points about an interval by no more than their range."""
    rng = np.random.default_rng(5)
    s = np.cumsum(rng.exponential(1.0, 400) ** power + 1e-4)
    z = rng.standard_normal(400)
    profile = Profile.from_samples(s, z)
    fine = s[:-1, None] + np.diff(s)[:, None] * np.linspace(0.0, 1.0, 41)
    height = profile.at(fine)[0][2:-2]
    about = np.lib.stride_tricks.sliding_window_view(z, 6)
    low, high = about.min(axis=1)[:, None], about.max(axis=1)[:, None]
    assert np.all(height <= high + (high - low))
    assert np.all(height >= low - (high - low))


def test_a_curve_through_waves_is_the_spline():
    """Six points a wave: the spline's slope, within 1 % of the sine's own."""
    s = np.arange(0.0, 20.0, 1.0 / 6)
    profile = Profile.from_samples(s, np.sin(2 * np.pi * s))
    inner = slice(12, -12)
    exact = 2 * np.pi * np.cos(2 * np.pi * s)
    np.testing.assert_allclose(profile.slope[inner], exact[inner], atol=0.01 * 2 * np.pi)


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (
            lambda: Profile.piecewise_linear([0, 5, 5, 10], [0, 0, 0.02, 0.02]),
            r"vertical step: points 1 and 2 .* stand at 5 m, with elevations 0 and 0.02 m.*chamfer",
        ),
        (lambda: Profile.piecewise_linear([0, 5, 5, 10], [0, 0, 0, 0.1]), "drop one of them"),
        (lambda: Profile.piecewise_linear([0, 5, 4, 10], [0, 0, 0, 0.1]), "must not fall"),
        (lambda: Profile.piecewise_linear([0, 1, 2], [0, 0]), "one elevation each"),
        (lambda: Profile.piecewise_linear([0, 1, 2], [0, np.nan, 0]), "elevation must be finite"),
        (lambda: Profile.from_samples([0, 1, 1, 2], [0, 0, 1, 1]), "vertical step"),
        (lambda: Profile.from_samples([0, 1, np.inf, 2], [0, 0, 1, 1]), "station must be finite"),
        (
            lambda: Profile(
                station=np.array([0.0, 1.0, 1.0, 2.0]),
                elevation=np.array([0.0, 0.0, 0.1, 0.1]),
                slope=np.zeros(4),
            ),
            "vertical step",
        ),
        (
            lambda: Profile(station=np.zeros(2), elevation=np.zeros(2), slope=np.zeros(2)),
            "needs a length",
        ),
    ],
)
def test_bad_points_are_refused_in_words(make, match):
    with pytest.raises(InputError, match=match):
        make()


@pytest.mark.parametrize("name", ["A", "C"])
@pytest.mark.parametrize(
    ("along", "up", "match"),
    [(1.0, 1e3, "in mm or cm"), (1.0, 1e-3, "in km"), (1e-3, 1.0, "in km"), (1e3, 1.0, "in")],
)
def test_another_unit_is_no_class(name, along, up, match):
    """Millimetres, kilometres; chainage in kilometres, in millimetres."""
    road = synthesise(RoadClass(name), length=400.0, rng=np.random.default_rng(1))
    other = Profile(
        station=along * road.station, elevation=up * road.elevation, slope=up / along * road.slope
    )
    for read in (classify, roughness_index):
        with pytest.raises(InputError, match=match):
            read(other)
    assert profile_doubts(other)


@pytest.mark.parametrize("name", list("ABCDE"))
def test_roads_in_metres_are_not_doubted(name):
    """No doubt about units on any paved road, and above all no refusal; the fit doubts class E."""
    road = synthesise(RoadClass(name), length=400.0, rng=np.random.default_rng(1))
    assert profile_doubts(road) == ()
    assert classify(road).name == name
    assert len(fit_roughness(road).doubts) == (name == "E")


@pytest.mark.parametrize("grade", [0.0, 0.03])
def test_a_plane_is_not_doubted(grade):
    """Above sea level too, where rounding leaves something that is no road in kilometres."""
    s = np.arange(0.0, 200.0, 0.1)
    plane = Profile.piecewise_linear(s, 583.0 + grade * s)
    assert profile_doubts(plane) == ()
    assert roughness_index(plane) == pytest.approx(0.0, abs=1e-9)
