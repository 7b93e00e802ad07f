"""Lines and arcs, speeds over time and station, wheels that are pulled: closed forms."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.route import (
    ConstantSpeed,
    Footprint,
    Route,
    SpeedOverTime,
    SteadyAcceleration,
    wheel_places,
)
from trundle.vehicle import Unit

ONE = ConstantSpeed(1.0)


def bend(radius=6.0, arm=40.0, **more):
    """A right angle to the left, from (0, 0) along x and then along y."""
    points = np.array([[0.0, 0.0], [arm, 0.0], [arm, arm]])
    return Route(points=points, law=ONE, radius=radius, **more)


def test_a_rounded_corner_is_two_lines_and_a_quarter_circle():
    """Length ``2 (arm - R) + pi R / 2``; on the arc every place is R from its centre."""
    radius, arm = 6.0, 40.0
    route = bend(radius, arm)
    assert route.length == pytest.approx(2 * (arm - radius) + np.pi * radius / 2, rel=1e-12)
    s = np.linspace(arm - radius, arm - radius + np.pi * radius / 2, 50)
    place, direction = route.locate(s)
    centre = np.array([arm - radius, radius])
    np.testing.assert_allclose(np.linalg.norm(place - centre, axis=1), radius, rtol=1e-12)
    turned = (s - s[0]) / radius
    np.testing.assert_allclose(direction, np.stack([np.cos(turned), np.sin(turned)], 1), atol=1e-12)
    np.testing.assert_allclose(place[-1], [arm, radius], atol=1e-12)


@pytest.mark.parametrize("aside", [-2.0, 0.0, 1.5])
def test_wheels_beside_the_line_do_not_jump(aside):
    """Steps of a millimetre move a wheel by ``1 - k y`` millimetres, round every corner."""
    points = np.array([[0.0, 0.0], [30.0, 0.0], [40.0, 25.0], [20.0, 40.0]])
    route = Route(points=points, law=ONE, radius=5.0)
    s = np.arange(0.0, route.length, 1e-3)
    place, _ = route.locate(s, aside)
    moved = np.linalg.norm(np.diff(place, axis=0), axis=1) / 1e-3
    expected = 0.5 * (route.stretch(s[1:], aside) + route.stretch(s[:-1], aside))
    # over the step in which an arc begins it is between the two
    np.testing.assert_allclose(moved, expected, atol=0.5 / 5.0 * abs(aside) + 1e-6)
    assert np.median(np.abs(moved - expected)) < 1e-6


def test_a_lane_is_a_parallel_of_the_way():
    """Driven 1.75 m to the left, and as far to the right when the way is reversed."""
    route = bend(lane=1.75)
    s = np.linspace(0.0, route.length, 100)
    there, _ = route.locate(s)
    line, direction = bend().locate(s)
    left = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    np.testing.assert_allclose(there, line + 1.75 * left, atol=1e-12)
    back, _ = route.reversed().locate(route.length - s)
    np.testing.assert_allclose(back, there, atol=1e-9)


def led(lead, pivot, *contacts):
    return Unit(lead=lead, pivot=pivot, contacts=contacts)


def test_behind_a_corner_a_pulled_axle_is_on_the_tractrix():
    """Behind a sharp right angle the unit's angle to the way falls as ``tan(a/2) exp(-s/l)``."""
    length = 4.0
    route = Route(
        points=np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 60.0]]), law=ONE, steering="tractrix"
    )
    footprint = Footprint(
        setback=np.array([0.0, length]), lateral=np.zeros(2), units=(led(0.0, length, 0, 1),)
    )
    front = np.linspace(20.0, 45.0, 200)
    made = wheel_places(route, footprint, front)
    body = made.place[:, 0] - made.place[:, 1]
    np.testing.assert_allclose(np.linalg.norm(body, axis=1), length, rtol=1e-9)
    angle = np.pi / 2 - np.arctan2(body[:, 1], body[:, 0])
    expected = 2.0 * np.arctan(np.tan(np.pi / 4) * np.exp(-(front - 20.0) / length))
    np.testing.assert_allclose(angle, expected, atol=2e-6)


def test_on_a_long_circle_axles_cut_in_by_pythagoras():
    """A unit's pivot runs on ``sqrt(R^2 - l^2)``; a trailer's on ``sqrt(R^2 - l1^2 + d^2 - l2^2)``.

    d is how far its coupling is before the pivot of the tractor (Alexander and Maddocks 1988).
    """
    radius, l1, coupling, l2 = 20.0, 4.0, 3.5, 7.0
    turn = np.linspace(0.0, 2.0 * np.pi, 361)
    circle = radius * np.stack([np.sin(turn), 1.0 - np.cos(turn)], axis=1)
    twice = np.concatenate([circle, circle[1:100]])
    route = Route(points=twice, law=ONE, steering="tractrix")
    footprint = Footprint(
        setback=np.array([0.0, l1, coupling + l2]),
        lateral=np.zeros(3),
        units=(led(0.0, l1, 0, 1), led(coupling, coupling + l2, 2)),
    )
    front = np.linspace(1.6 * np.pi * radius, 2.4 * np.pi * radius, 60)
    place = wheel_places(route, footprint, front).place
    away = np.linalg.norm(place - np.array([0.0, radius]), axis=2)
    # a polygon of degrees lies within R (1 - cos(1/2 deg)) = 8e-4 m of its circle
    np.testing.assert_allclose(away[:, 1], np.sqrt(radius**2 - l1**2), atol=2e-3)
    hitch = radius**2 - l1**2 + (l1 - coupling) ** 2
    np.testing.assert_allclose(away[:, 2], np.sqrt(hitch - l2**2), atol=2e-3)


def test_places_and_speeds_of_pulled_wheels_agree():
    """What a wheel moves per metre of the way is the derivative of where it is; by differences."""
    route = bend(8.0, steering="tractrix", lane=-0.5)
    footprint = Footprint(
        setback=np.array([0.0, 0.0, 4.0, 4.0, 9.0, 9.0]),
        lateral=np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0]),
        units=(led(0.0, 4.0, 0, 1, 2, 3), led(3.6, 9.0, 4, 5)),
    )
    s, h = np.linspace(20.0, 60.0, 397), 1e-4
    made = wheel_places(route, footprint, s)
    ahead, back = (wheel_places(route, footprint, s + x).place for x in (h, -h))
    moves = made.direction * made.stretch[:, :, None]
    np.testing.assert_allclose((ahead - back) / (2 * h), moves, atol=2e-5)


def test_pulled_wheels_of_a_straight_way_are_on_it():
    """To rounding, with the same speeds: a straight way has no tractrix."""
    points = np.array([[0.0, 1.0], [50.0, 1.0]])
    footprint = Footprint(
        setback=np.array([0.0, 4.0]), lateral=np.array([0.8, -0.8]), units=(led(0.0, 4.0, 0, 1),)
    )
    s = np.linspace(0.0, 50.0, 101)
    one, other = (
        wheel_places(Route(points=points, law=ONE, steering=how), footprint, s)
        for how in ("path", "tractrix")
    )
    np.testing.assert_allclose(one.place, other.place, atol=1e-9)
    np.testing.assert_allclose(one.stretch, other.stretch, atol=1e-12)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: bend(50.0), "does not fit between"),
        (lambda: bend(3.0, lane=4.0), "larger radius"),
        (lambda: Route(points=np.array([[0, 0], [9, 0], [2, 0]], float), law=ONE, radius=2.0),
         "turns back"),
        (lambda: bend(steering="magic"), "steering"),
    ],
)  # fmt: skip
def test_ways_that_cannot_be_driven_are_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_the_radius_that_is_offered_fits():
    """The message names one; with it the same way is taken."""
    with pytest.raises(InputError, match="a radius of") as told:
        bend(50.0)
    offered = float(str(told.value).rsplit("a radius of ", 1)[1].split()[0])
    assert bend(offered * 0.999).length > 0.0


# --- speeds ---


def test_speeds_over_stations_have_steady_accelerations_between():
    """From rest to 4 m/s in 10 m: a = v^2 / 2 s = 0.8; t = 2 s / v = 5 s; then on at 4 m/s."""
    law = SpeedOverTime.over_stations([0.0, 10.0, 30.0], [0.0, 4.0, 4.0])
    assert law.time_to(10.0) == pytest.approx(5.0)
    assert law.time_to(30.0) == pytest.approx(10.0)
    assert law.time_to(50.0) == pytest.approx(15.0)
    t = np.linspace(0.0, 5.0, 40)
    np.testing.assert_allclose(law.distance(t), 0.4 * t**2, atol=1e-12)
    np.testing.assert_allclose(law.speed(t), 0.8 * t, atol=1e-12)
    np.testing.assert_allclose(law.change([2.0, 7.0]), [0.8, 0.0])
    assert (law.fastest, law.rests_from) == (4.0, np.inf)


def test_stop_and_go_stands_as_long_as_it_is_told():
    """Braking from 5 m/s in 25 m takes 10 s; then 7 s of standing; then as a standing start."""
    law = SpeedOverTime.over_stations([0.0, 25.0, 50.0], [5.0, 0.0, 5.0], waits=[7.0])
    assert law.time_to(25.0) == pytest.approx(10.0)
    np.testing.assert_allclose(law.distance([10.0, 14.0, 17.0]), 25.0)
    np.testing.assert_allclose(law.speed([12.0, 17.0, 27.0]), [0.0, 0.0, 5.0], atol=1e-12)
    assert law.distance(27.0) == pytest.approx(50.0)
    assert law.distance(-2.0) == pytest.approx(-10.0)  # before it begins the speed is steady


def test_it_ends_where_it_comes_to_rest():
    """Never beyond 25 m; at rest from 10 s on."""
    law = SpeedOverTime.over_stations([0.0, 25.0], [5.0, 0.0])
    assert law.time_to(25.0) == pytest.approx(10.0)
    assert law.time_to(26.0) == np.inf
    assert law.rests_from == pytest.approx(10.0)
    assert law.distance(99.0) == pytest.approx(25.0)


@pytest.mark.parametrize(
    "law",
    [
        SpeedOverTime(time=np.array([0.0, 2.0, 5.0, 9.0]), value=np.array([1.0, 4.0, 0.0, 2.0])),
        SpeedOverTime.over_stations([0, 5, 9, 20], [3.0, 1.0, 0.0, 4.0], waits=[2.0]),
        SteadyAcceleration(initial=6.0, acceleration=-0.5),
        SteadyAcceleration(initial=2.0, acceleration=0.5),
        ConstantSpeed(3.0),
    ],
)
def test_laws_agree_with_themselves(law):
    """Speed is the derivative of distance, change that of speed, and time_to the inverse."""
    t, h = np.linspace(0.013, 11.0, 331), 1e-6
    np.testing.assert_allclose(
        (law.distance(t + h) - law.distance(t - h)) / (2 * h), law.speed(t), atol=1e-5
    )
    change = (law.speed(t + h) - law.speed(t - h)) / (2 * h)
    np.testing.assert_allclose(change, law.change(t), atol=1e-3)
    for time in t[::10]:
        if law.speed(time) > 0.0:
            assert law.time_to(float(law.distance(time))) == pytest.approx(time, abs=1e-9)
    assert np.max(law.speed(t)) <= law.fastest + 1e-12


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: SpeedOverTime.over_stations([0, 5, 9], [1, 0, 0]), "give a speed between two"),
        (lambda: SpeedOverTime.over_stations([0, 5], [0, 2], waits=[1, 2]), "2 times for 1"),
        (lambda: SpeedOverTime.over_stations([1, 5], [0, 2]), "rise from 0"),
        (lambda: SpeedOverTime(time=np.array([0.0, 1.0]), value=np.array([0.0, 0.0])), "above it"),
        (lambda: SpeedOverTime(time=np.array([0.0, 0.0]), value=np.array([1.0, 2.0])), "rise"),
    ],
)
def test_speeds_that_lead_nowhere_are_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()
