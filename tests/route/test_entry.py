"""How wheels come onto the floor, how fast they go and where routes lie, by formulas and hand."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.route import (
    Abrupt,
    Along,
    ConstantSpeed,
    DriveIn,
    Footprint,
    Ramp,
    Route,
    SpeedOverTime,
    StaticStart,
    SteadyAcceleration,
    entry_named,
    follow,
)


@pytest.mark.parametrize(
    ("entry", "stations", "shares"),
    [
        # linear over 2 m before 0 and behind 10 m
        (Ramp(length=2.0), [-3, -2, -1.5, 0, 5, 10, 11, 12, 13], [0, 0, 0.25, 1, 1, 1, 0.5, 0, 0]),
        # 3 x^2 - 2 x^3 over 4 m: 0.15625 at a quarter, 0.5 at half
        (DriveIn(length=4.0), [-1, 0, 1, 2, 4, 6, 8, 9, 10, 11],
         [0, 0, 0.15625, 0.5, 1, 1, 0.5, 0.15625, 0, 0]),
        (StaticStart(exit_length=2.0), [-1e-9, 0, 10, 10.5, 12, 20], [1, 1, 1, 0.75, 0, 0]),
        (Abrupt(), [-1e-9, 0, 5, 10, 10.001], [0, 1, 1, 1, 0]),
    ],
)  # fmt: skip
def test_a_floor_carries_the_share_of_each_entry(entry, stations, shares):
    """On a way of 10 m, by each entry's formula; mirrored at the exit, but for a static start."""
    share, slope = entry.share(np.array(stations, dtype=float), 10.0)
    np.testing.assert_allclose(share, shares, atol=1e-12)
    assert slope.shape == share.shape


@pytest.mark.parametrize("entry", [Ramp(length=2.0), DriveIn(length=4.0), DriveIn(length=30.0)])
def test_the_slope_of_a_share_is_its_derivative(entry):
    """By central differences off the kinks; a transition longer than half the way included.

    A quarter of the way: both transitions overlap, and their product is what the floor carries.
    """
    s = np.linspace(-2.5, 12.5, 331) + 0.0013
    h = 1e-6
    low, high = entry.share(s - h, 10.0)[0], entry.share(s + h, 10.0)[0]
    np.testing.assert_allclose((high - low) / (2 * h), entry.share(s, 10.0)[1], atol=1e-6)


def test_a_way_that_ends_inside_is_never_left():
    """With an end at infinity the share stays 1 behind the entry, with no slope."""
    for entry in (Ramp(length=2.0), DriveIn(length=4.0), Abrupt()):
        share, slope = entry.share(np.array([5.0, 1e4]), np.inf)
        assert share.tolist() == [1.0, 1.0]
        assert slope.tolist() == [0.0, 0.0]


def test_entries_are_found_by_name_with_their_usual_lengths():
    """3 m of a drive-in and 1 m of ramps and ways out; a length that is given counts."""
    assert entry_named("drive_in") == DriveIn(length=3.0)
    assert entry_named("ramp") == Ramp(length=1.0)
    assert entry_named("static") == StaticStart(exit_length=1.0)
    assert entry_named("ramp", 0.4) == Ramp(length=0.4)
    assert entry_named("static", 2.0).exit_length == 2.0
    with pytest.raises(InputError, match="an abrupt entry has no length; got 2 m"):
        entry_named("abrupt", 2.0)
    with pytest.raises(InputError, match="ramp length must be greater than 0"):
        entry_named("ramp", -1.0)
    for name in ("ramp", "drive_in", "static"):
        with pytest.raises(InputError, match="must be greater than 0; got 0"):
            entry_named(name, 0.0)
    with pytest.raises(InputError, match="did you mean 'drive_in'"):
        entry_named("drive-in")


LAWS = [
    ConstantSpeed(4.0),
    SteadyAcceleration(initial=6.0, acceleration=-1.5),
    SteadyAcceleration(initial=2.0, acceleration=0.8),
    SpeedOverTime(time=np.array([0.0, 3.0, 5.0, 9.0]), value=np.array([2.0, 6.0, 0.0, 3.0])),
    SpeedOverTime(time=np.array([0.0, 4.0, 6.0]), value=np.array([0.0, 5.0, 0.0])),
]


@pytest.mark.parametrize("law", LAWS)
def test_distance_is_the_integral_of_speed_and_speed_that_of_its_change(law):
    """By quadrature between kinks, from before time 0 to behind the last change."""
    kinks = [0.0, 3.0, 4.0, 5.0, 6.0, 9.0]
    for low, high in ((-3.0, -1.0), (-1.0, 2.5), (2.5, 7.7), (7.7, 14.0)):
        inner = [k for k in kinks if low < k < high]
        way = integrate.quad(law.speed, low, high, points=inner or None, limit=200)[0]
        assert float(law.distance(high) - law.distance(low)) == pytest.approx(way, abs=1e-7)
        gain = integrate.quad(law.change, low, high, points=inner or None, limit=200)[0]
        assert float(law.speed(high) - law.speed(low)) == pytest.approx(gain, abs=1e-6)
    assert float(law.distance(0.0)) == 0.0


@pytest.mark.parametrize("law", LAWS)
def test_the_time_to_a_distance_is_the_first_at_which_it_is_reached(law):
    """The distance at that time is the one asked for, and a moment before it was less."""
    for s in (0.3, 2.0, 7.0, 11.9):
        t = law.time_to(s)
        if np.isinf(t):
            assert float(law.distance(1e5)) < s
            continue
        assert float(law.distance(t)) == pytest.approx(s, abs=1e-9)
        assert float(law.distance(t - 1e-3)) < s
    assert law.time_to(0.0) == 0.0


def test_a_braking_vehicle_rests_where_it_stops():
    """6 m/s at 1.5 m/s2: 4 s and 12 m; 12.01 m are never reached."""
    law = LAWS[1]
    assert law.rests_from == pytest.approx(4.0)
    assert float(law.distance(99.0)) == pytest.approx(12.0)
    assert law.time_to(12.0) == pytest.approx(4.0)
    assert law.time_to(12.01) == np.inf
    assert [one.rests_from for one in LAWS] == [np.inf, 4.0, np.inf, np.inf, 6.0]
    twice = SpeedOverTime(time=np.array([0.0, 1.0, 2.0, 3.0]), value=np.array([3.0, 0.0, 0.0, 0.0]))
    assert twice.rests_from == 1.0


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: ConstantSpeed(0.0), "speed must be greater than 0"),
        (lambda: ConstantSpeed(np.nan), "speed must be finite"),
        (lambda: SteadyAcceleration(initial=0.0, acceleration=1.0), "initial speed must be gr"),
        (
            lambda: SpeedOverTime(time=np.array([0.0, 0.1]), value=np.array([0.0, 2.0])),
            "no wheel holds more than 15",
        ),
        (
            lambda: SpeedOverTime(time=np.array([0.0, 1.0]), value=np.array([0.0, 0.0])),
            "one above it",
        ),
        (
            lambda: SpeedOverTime(time=np.array([1.0, 2.0]), value=np.array([1.0, 1.0])),
            "times must rise from 0",
        ),
        (
            lambda: SpeedOverTime.over_stations([0.0, 5.0], [2.0, 0.0], waits=[1.0, 2.0]),
            "waits gives 2 times for 1 stations",
        ),
        (
            lambda: SpeedOverTime.over_stations([0.0, 5.0], [2.0, 0.0], waits=[-3.0]),
            "wait must be 0 or more; got -3",
        ),
        (
            lambda: SpeedOverTime.over_stations([0.0, 5.0], [2.0, 0.0], waits=[np.nan]),
            "wait must be finite",
        ),
        (
            lambda: SpeedOverTime.over_stations([0.0, 5.0, 9.0], [2.0, 0.0, 0.0]),
            "from station 5 m on the speed is 0 until the next",
        ),
    ],
)
def test_speeds_that_lead_nowhere_say_why(make, words):
    """With the number that is wrong."""
    with pytest.raises(InputError, match=words):
        make()


def along(stations, speed, setback):
    station = np.array(stations, dtype=float)[:, None] - setback
    return Along(
        time=np.arange(float(len(stations))), station=station, speed=np.full_like(station, speed)
    )


def test_wheels_follow_a_route_by_setback_and_track():
    """Along (1, 0) from (2, 5): a wheel 3 m behind and 0.8 m to the left stands at (s - 1, 5.8)."""
    setback, lateral = np.array([0.0, 3.0]), np.array([0.0, 0.8])
    route = Route.straight((2.0, 5.0), (22.0, 5.0), speed=4.0)
    found = follow(
        route, Ramp(length=1.0), Footprint(setback=setback, lateral=lateral),
        along([3.5, 10.0, 21.0], 4.0, setback),
    )  # fmt: skip
    np.testing.assert_allclose(found.place[:, 0], [[5.5, 5.0], [12.0, 5.0], [22.0, 5.0]])
    np.testing.assert_allclose(found.place[:, 1], [[2.5, 5.8], [9.0, 5.8], [20.0, 5.8]])
    np.testing.assert_allclose(found.direction, np.broadcast_to([1.0, 0.0], (3, 2, 2)))
    np.testing.assert_allclose(found.speed, 4.0)
    np.testing.assert_allclose(found.share, [[1.0, 1.0], [1.0, 1.0], [0.0, 1.0]])
    stays = follow(
        route, Ramp(length=1.0), Footprint(setback=setback, lateral=lateral),
        along([3.5, 10.0, 21.0], 4.0, setback), leaves=False,
    )  # fmt: skip
    assert (stays.share == 1.0).all()


def test_an_inner_wheel_goes_slower_and_sees_shares_change_faster():
    """On a left arc of 10 m a wheel 1 m to the left moves 0.9 m for every metre of the way.

    Its speed is 0.9 of the axle's, and what changes by the way's metre changes by 1 / 0.9 of its own.
    """
    route = Route(
        points=np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 30.0]]),
        law=ConstantSpeed(5.0),
        radius=10.0,
    )
    arc = 20.0 + 1.5 * np.pi  # three tenths of a quarter circle of 10 m, before the way's middle
    found = follow(
        route, DriveIn(length=40.0), Footprint(setback=np.zeros(2), lateral=np.array([1.0, -1.0])),
        along([5.0, arc], 5.0, np.zeros(2)),
    )  # fmt: skip
    np.testing.assert_allclose(found.speed, [[5.0, 5.0], [4.5, 5.5]])
    straight = DriveIn(length=40.0).share(np.array([arc]), route.length)[1][0]
    assert straight > 0.001
    np.testing.assert_allclose(found.share_slope[1], [straight / 0.9, straight / 1.1])
    centre = np.array([20.0, 10.0])
    np.testing.assert_allclose(np.linalg.norm(found.place[1] - centre, axis=1), [9.0, 11.0])


def test_the_same_line_the_other_way():
    """Reversed, station s is what was length - s; left is right, and a lane stays where it was."""
    route = Route(
        points=np.array([[0.0, 0.0], [12.0, 0.0], [12.0, 9.0]]), law=ConstantSpeed(3.0),
        radius=2.0, lane=0.7,
    )  # fmt: skip
    back = route.reversed()
    assert back.length == pytest.approx(route.length)
    s = np.linspace(0.0, route.length, 17)
    place, direction = route.locate(s, 0.4)
    other, against = back.locate(route.length - s, -0.4)
    np.testing.assert_allclose(other, place, atol=1e-9)
    np.testing.assert_allclose(against, -direction, atol=1e-9)
    # two lines less 2 m each, and a quarter circle of 2 m
    assert route.length == pytest.approx(12.0 + 9.0 - 4.0 + np.pi)


def test_stations_beyond_a_route_stay_at_its_ends():
    """A wheel that is not on yet is put at the start, one that has left at the end."""
    route = Route.straight((1.0, 1.0), (1.0, 7.0), speed=2.0)
    place, direction = route.locate(np.array([-9.0, 0.0, 6.0, 99.0]), 0.5)
    np.testing.assert_allclose(place, [[0.5, 1.0], [0.5, 1.0], [0.5, 7.0], [0.5, 7.0]])
    np.testing.assert_allclose(direction, np.broadcast_to([0.0, 1.0], (4, 2)))
    assert not route.has_sharp_corners
    turned = replace(route, points=np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]]))
    assert turned.has_sharp_corners
    assert not replace(turned, radius=1.0).has_sharp_corners
