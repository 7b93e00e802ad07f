"""Random roads of one and several tracks, surveyed tracks, features on routes, mirrored roads."""

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.road import (
    CosineHump,
    Feature,
    FeaturedRoad,
    MeasuredRoad,
    Profile,
    RoadClass,
    RoughnessBand,
    Tread,
    synthesise,
    synthesise_tracks,
    track_coherence,
)

TYRE = Tread(sinking=0.03, radius=0.0)


@pytest.mark.parametrize("nb", [0.05, 0.3, 1.0])
def test_coherence_of_tracks_is_that_of_an_isotropic_surface(nb):
    """An isotropic surface of spectrum k^-3 has tracks of n^-2, and the cosine transform across.

    ``int cos(2 pi m b) (n^2 + m^2)^(-3/2) dm`` over the same without the cosine, by quadrature.
    """
    n, b = 0.5, nb / 0.5

    def surface(m):
        return (n**2 + m**2) ** -1.5

    cross = integrate.quad(surface, 0.0, np.inf, weight="cos", wvar=2 * np.pi * b)[0]
    whole = integrate.quad(surface, 0.0, np.inf)[0]
    assert track_coherence(n, b) == pytest.approx((cross / whole) ** 2, rel=1e-5)


def test_coherence_is_one_at_one_place_and_none_far_apart():
    """Long waves lift both tracks, short ones each for itself; it falls with either."""
    assert track_coherence(2.0, 0.0) == 1.0
    assert track_coherence(1e-6, 2.0) == pytest.approx(1.0, abs=1e-6)
    assert track_coherence(3.0, 4.0) < 1e-12
    falling = track_coherence(np.linspace(0.01, 2.0, 50), 1.8)
    assert (np.diff(falling) < 0.0).all()


def test_tracks_come_in_the_order_asked_for_whatever_their_places():
    """Left, right, left again: the first is the single road, the third is the first, bit by bit.

    The middle one lies between both and resembles each more than they do each other.
    """
    settings = {"length": 200.0, "band": RoughnessBand(n_max=2.0)}
    made = synthesise_tracks(
        RoadClass("B"), [1.0, -1.0, 1.0, 0.0], rng=np.random.default_rng(3), **settings
    )
    single = synthesise(RoadClass("B"), rng=np.random.default_rng(3), **settings)
    np.testing.assert_array_equal(made[0].elevation, single.elevation)
    np.testing.assert_array_equal(made[2].elevation, made[0].elevation)

    def alike(one, other):
        return np.corrcoef(np.diff(one.elevation), np.diff(other.elevation))[0, 1]

    assert alike(made[3], made[0]) > alike(made[1], made[0])
    assert alike(made[3], made[1]) > alike(made[1], made[0])


def test_a_road_covers_the_way_asked_for_from_its_start():
    """Stations from -7.5 m on, at most a twentieth of the shortest wave apart, to 40 m further."""
    band = RoughnessBand(n_max=2.0)
    made = synthesise(
        RoadClass("A"), length=40.0, rng=np.random.default_rng(1), band=band, start=-7.5
    )
    assert made.station[0] == -7.5
    assert made.station[-1] >= 32.5
    assert np.diff(made.station).max() <= 0.025 * (1 + 1e-9)
    with pytest.raises(InputError, match="the road at 60 m is unknown"):
        made.at(60.0)


def test_amplitudes_drawn_as_well_have_the_same_power_in_the_mean():
    """Phases alone give each road its band's variance; drawn amplitudes scatter about it.

    A period of 202 m holds 303 lines between 0.5 and 2 cycle/m; weighted by n^-2 they scatter as
    173 alike, so a variance by 7.6 % and the mean of 100 roads by 0.8 %.
    """
    road = RoadClass("C")
    exact = road.variance(0.5, 2.0)
    for gaussian, spread in ((False, 0.02), (True, 0.3)):
        band = RoughnessBand(n_min=0.5, n_max=2.0, gaussian_amplitudes=gaussian)
        rng = np.random.default_rng(5)
        found = np.array(
            [synthesise(road, length=200.0, rng=rng, band=band).elevation.var() for _ in range(100)]
        )
        assert found.mean() == pytest.approx(exact, rel=0.04)
        assert found.std() / exact < spread
        assert (found.std() / exact > 0.04) == gaussian


def test_a_wheel_takes_the_surveyed_track_nearest_to_it():
    """Tracks at -0.9, 0.1 and 1 m: at 0.5 m the middle one, at 0.6 the left one, beyond the ends
    the outer ones.
    """
    tracks = tuple(
        Profile.from_samples([0.0, 1.0, 2.0, 3.0], [h, h, h, h]) for h in (0.0, 0.01, 0.02)
    )
    road = MeasuredRoad(tracks=tracks, lateral=np.array([-0.9, 0.1, 1.0]), name="Straße <7>")
    for lateral, height in ((-5.0, 0.0), (-0.41, 0.0), (-0.39, 0.01), (0.54, 0.01), (0.6, 0.02)):
        assert road.under(lateral, TYRE).at(1.5)[0] == height
    assert str(road) == "Straße <7>, 3 tracks of 3 m from 0 m"
    assert road.is_given
    assert road.spectrum is None


@pytest.mark.parametrize(
    ("lateral", "words"),
    [([1.0, 0.0], "places of tracks must rise"), ([0.0, 0.0], "must rise"), ([0.0], "shape")],
)
def test_tracks_without_places_of_their_own_are_refused(lateral, words):
    """Two tracks at one place, or more tracks than places, would hide one."""
    track = Profile.smooth()
    with pytest.raises(InputError, match=words):
        MeasuredRoad(tracks=(track, track), lateral=np.array(lateral))


def test_a_route_meets_its_own_features_and_those_of_all():
    """Of three humps one is for "north", one for "south", one for all; the base is that of both."""
    shape = CosineHump(length=1.0, height=0.02)
    humps = tuple(
        Feature(shape=shape, station=at, route=route)
        for at, route in ((5.0, "north"), (10.0, "south"), (15.0, None))
    )
    road = FeaturedRoad(base=RoadClass("A"), features=humps)
    for route, stations in (("north", [5.0, 15.0]), ("south", [10.0, 15.0]), ("other", [15.0])):
        own = road.of(route)
        profile = own.under(0.0, TYRE)
        tops = [s for s in (5.0, 10.0, 15.0) if profile.at(s + 0.5)[0] > 0.019]
        assert tops == stations
        assert own.spectrum is road.base
    assert str(road) == "class A (geometric mean) with 3 x cosine hump"
    assert not FeaturedRoad(base=RoadClass("A"), features=()).is_given


def test_a_mirrored_road_goes_on_for_ever():
    """Turned about its end: z(L + x) = 2 z(L) - z(L - x), again and again; the slope is even.

    Three lengths on and two back, by that formula applied as often as it takes.
    """
    s = np.linspace(0.0, 4.0, 30)
    road = Profile.from_samples(s, 0.01 * np.sin(2.0 * s) + 0.002 * s, beyond="mirror")
    first, last = road.at(0.0)[0], road.at(4.0)[0]

    def height(x):
        if x > 4.0:
            return 2.0 * last - height(8.0 - x)
        if x < 0.0:
            return 2.0 * first - height(-x)
        return float(road.at(x)[0])

    for x in (-7.3, -3.9, -0.2, 4.2, 7.7, 11.1, 15.9):
        assert road.at(x)[0] == pytest.approx(height(x), abs=1e-12)
        middle, step = np.array([x - 1e-5, x + 1e-5]), 2e-5
        rise = np.diff(road.at(middle)[0])[0]
        assert road.at(x)[1] == pytest.approx(rise / step, abs=1e-6)
