"""Joints, humps and holes: their shape, how a tyre meets them, what a vehicle does behind them."""

import dataclasses

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.road import (
    Bump,
    CableProtector,
    CosineHump,
    ExpansionJoint,
    Feature,
    FeaturedRoad,
    MeasuredRoad,
    Patch,
    Pothole,
    Profile,
    RailCrossing,
    RampKink,
    RoadClass,
    Tread,
    laid,
)
from trundle.route import Route
from trundle.simulate import Crossing, Modal, contact_forces
from trundle.vehicle import Axle, Body, build_vehicle

SOFT = Tread(sinking=0.02)
SHAPES = {
    "joint": ExpansionJoint(gap=0.03, step=0.004, runout=2.0),
    "patch": Patch(length=1.0, height=0.02, ramp=0.2),
    "pothole": Pothole(length=0.6, depth=0.05, edge=0.1),
    "bump": Bump(length=0.5, height=0.03),
    "hump": CosineHump(length=3.0, height=0.08),
    "kink": RampKink(grade=0.06, length=4.0, rounding=1.0),
    "rails": RailCrossing(proud=0.003),
    "protector": CableProtector(length=0.3, height=0.04, top=0.1),
}


def on_smooth(*features):
    return FeaturedRoad(base=Profile.smooth(), features=features)


def one(shape, station=5.0, **more):
    return on_smooth(Feature(shape=shape, station=station, **more))


@pytest.mark.parametrize(
    ("shape", "at", "height"),
    [
        (SHAPES["patch"], [0.0, 0.1, 0.5, 0.9, 1.0], [0.0, 0.01, 0.02, 0.01, 0.0]),
        (SHAPES["pothole"], [0.05, 0.3, 0.55], [-0.025, -0.05, -0.025]),
        (SHAPES["bump"], [0.125, 0.25], [0.03 * np.sin(np.pi / 4), 0.03]),
        (SHAPES["hump"], [0.75, 1.5, 2.25], [0.04, 0.08, 0.04]),
        # a parabola of half the rounding on each side: grade / (2 R) (s + R / 2)^2 with R = 1 m
        (SHAPES["kink"], [0.0, 2.0, 10.0], [0.06 / 8.0, 0.12, 0.24]),
        (SHAPES["protector"], [0.05, 0.15], [0.02, 0.04]),
    ],
)  # fmt: skip
def test_shapes_are_what_their_formulas_say(shape, at, height):
    """Heights of the closed forms in the docstrings, at stations behind the start."""
    road = laid([Feature(shape=shape, station=7.3)], 0.0, SOFT)
    np.testing.assert_allclose(road.at(7.3 + np.array(at))[0], height, atol=1e-6)


@pytest.mark.parametrize("name", SHAPES)
def test_slopes_are_derivatives(name):
    """By central differences away from corners, where 1e-5 m of them changes nothing."""
    road = laid([Feature(shape=SHAPES[name], station=0.0)], 0.0, SOFT)
    s = np.linspace(-0.9, 5.1, 4001) + 1.7e-5
    away = np.abs(s[:, None] - road.station).min(axis=1) > 2e-5
    h = 1e-6
    difference = (road.at(s + h)[0] - road.at(s - h)[0]) / (2 * h)
    np.testing.assert_allclose(road.at(s)[1][away], difference[away], atol=1e-6)


def test_where_a_feature_lies_has_nothing_to_do_with_samples():
    """Moved by a third of a millimetre it is the same shape there, to rounding."""
    s = np.linspace(4.0, 8.0, 999)
    here, there = (laid([Feature(shape=SHAPES["joint"], station=x)], 0.0, SOFT)
                   for x in (5.0, 5.0 + 1e-3 / 3))  # fmt: skip
    np.testing.assert_allclose(there.at(s + 1e-3 / 3)[0], here.at(s)[0], atol=1e-12)


def test_overlapping_features_add_and_the_base_stays():
    """A hump over two joints on a survey: the sum of all three at any station, to 1e-9 m."""
    rng = np.random.default_rng(5)
    s = np.arange(0.0, 20.0, 0.25)
    survey = Profile.from_samples(s, 583.0 + 0.003 * rng.standard_normal(len(s)))
    features = (
        Feature(shape=ExpansionJoint(gap=0.02, step=0.003), station=6.0),
        Feature(shape=CosineHump(length=3.0, height=0.05), station=5.0),
        Feature(shape=ExpansionJoint(gap=0.02), station=9.0),
    )
    base = MeasuredRoad(tracks=(survey,), lateral=np.zeros(1))
    whole = FeaturedRoad(base=base, features=features).under(0.0, SOFT)
    at = rng.uniform(0.0, 19.7, 2000)
    parts = [survey, *(laid([f], 0.0, SOFT) for f in features)]
    np.testing.assert_allclose(whole.at(at)[0], sum(p.at(at)[0] for p in parts), atol=1e-9)
    np.testing.assert_allclose(whole.at(at)[1], sum(p.at(at)[1] for p in parts), atol=1e-6)


def test_a_gap_is_as_deep_as_a_tyre_sinks_times_its_share_of_the_patch():
    """A row of springs over a patch a that stands on all but the gap g: g / a of its sinking."""
    gap, patch = 0.03, 0.2
    road = one(ExpansionJoint(gap=gap)).under(0.0, SOFT).averaged(patch)
    wall = 2e-3  # the walls are drawn over so much: half of it is missing on each side
    expected = -SOFT.sinking * (gap - wall) / patch
    assert road.at(5.0 + gap / 2)[0] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("radius", [0.05, 0.2])
def test_a_hard_wheel_drops_into_a_gap_by_its_sagitta(radius):
    """R - sqrt(R^2 - (g/2)^2), at samples R/200 apart."""
    gap = 0.03
    road = one(ExpansionJoint(gap=gap)).under(0.0, Tread(radius=radius))
    drop = radius - np.sqrt(radius**2 - (gap / 2) ** 2)
    step = radius / 200
    assert road.at(np.linspace(4.9, 5.2, 3001))[0].min() == pytest.approx(
        -drop, abs=step * gap / (2 * radius) + 1e-6
    )


def test_a_hard_wheel_begins_to_climb_a_step_before_it():
    """Its centre rises where its rim meets the edge, sqrt(2 R h - h^2) ahead of it."""
    radius, height = 0.1, 0.01
    road = one(ExpansionJoint(step=height)).under(0.0, Tread(radius=radius))
    reach = np.sqrt(2 * radius * height - height**2)
    s = np.linspace(4.8, 5.1, 6001)
    rises = s[np.argmax(road.at(s)[0] > 1e-5)]
    assert rises == pytest.approx(5.0 + 2e-3 - reach, abs=1.5e-3)
    # on the edge it turns about a point: R below its centre there
    ahead = 0.03
    expected = np.sqrt(radius**2 - ahead**2) - radius + height
    assert road.at(5.0 + 2e-3 - ahead)[0] == pytest.approx(expected, abs=1e-4)


def test_a_skew_joint_meets_each_wheel_later_by_its_tangent():
    """At 30 degrees a wheel 0.9 m to the left meets it 0.52 m later, and the right one earlier."""
    road = one(Bump(length=0.4, height=0.02), skew=np.deg2rad(30.0))
    s = np.linspace(3.0, 8.0, 50001)
    for aside in (-0.9, 0.0, 0.9):
        top = s[road.under(aside, SOFT).at(s)[0].argmax()]
        assert top == pytest.approx(5.2 + aside * np.tan(np.deg2rad(30.0)), abs=2e-4)


def test_a_feature_lies_under_some_tracks_and_some_routes():
    """Across its width, and on the route that it is for; under others there is nothing."""
    road = one(SHAPES["pothole"], across=(0.2, 1.2), route="north")
    assert road.of("north").under(0.9, SOFT).at(5.3)[0] == pytest.approx(-0.05)
    assert road.of("north").under(-0.9, SOFT).at(5.3)[0] == 0.0
    assert road.of("south").under(0.9, SOFT).at(5.3)[0] == 0.0
    assert not road.of("south").features


def sprung(patch=0.2, f=3.0, zeta=0.0, mass=1000.0):
    k = mass * (2 * np.pi * f) ** 2
    axle = Axle(body=0, setback=0.0, stiffness=k, damping=2 * zeta * np.sqrt(k * mass))
    one_mass = build_vehicle(name="mass", bodies=(Body(mass=mass),), axles=(axle,))
    return dataclasses.replace(one_mass, contact_patch=patch)


@pytest.mark.parametrize("dt", [0.005, 0.0025])
def test_a_step_throws_a_mass_as_its_step_response(dt):
    """Over a step the patch makes a ramp of a / V: (t - sin(wt)/w) h / T, less the same later.

    At the usual step of 5 ms; its error is that of the ramp's corners, which lie between steps.
    """
    height, patch, speed, f = 0.01, 0.2, 2.0, 3.0
    vehicle = sprung(patch, f)
    crossing = Crossing(
        vehicle, Route.straight((0, 0), (20, 0), speed=speed), one(ExpansionJoint(step=height)),
        run_in=1.0,
    )  # fmt: skip
    time, forces = contact_forces(
        crossing, integration=Modal(f_max=90.0, dt=dt), n_runs=1, seed=1, duration=9.0
    )
    w, rise = 2 * np.pi * f, patch / speed
    begin = (5.0 + 1e-3 - patch / 2) / speed  # the wall is drawn over 2 mm

    def ramp(t):
        t = np.maximum(t, 0.0)
        return height / rise * (t - np.sin(w * t) / w)

    body = ramp(time - begin) - ramp(time - begin - rise)
    ground = np.interp(time, [begin, begin + rise], [0.0, height])
    expected = -vehicle.contact_stiffness[0] * (body - ground)
    dynamic = forces[0][:, 0] - vehicle.static_forces[0]
    assert np.abs(dynamic - expected).max() < 1e-3 * np.abs(expected).max()


@pytest.mark.parametrize("name", ["pothole", "rails", "protector", "joint"])
def test_forces_behind_a_feature_are_those_of_an_own_integration(name):
    """One mass over the averaged road by scipy's Runge-Kutta, at the usual step: 2 % of the peak.

    A step is 15 mm there, and a rail's groove 65 mm wide.
    """
    vehicle, speed = sprung(0.15, 4.0, 0.1), 3.0
    road = one(SHAPES[name])
    crossing = Crossing(vehicle, Route.straight((0, 0), (30, 0), speed=speed), road, run_in=1.0)
    time, forces = contact_forces(
        crossing, integration=Modal(f_max=90.0, dt=0.005), n_runs=1, seed=1, duration=6.0
    )
    under = road.under(0.0, crossing.tread(0)).averaged(0.15)
    k, c = vehicle.contact_stiffness[0], vehicle.contact_damping[0]

    stations = np.linspace(0.0, 30.0, 120001)
    heights, slopes = under.at(stations)

    def rate(t, y):
        z, g = (np.interp(speed * t, stations, values) for values in (heights, slopes))
        return [y[1], -(k * (y[0] - z) + c * (y[1] - speed * g)) / 1000.0]

    found = integrate.solve_ivp(rate, (0.0, 6.0), [0.0, 0.0], t_eval=time, max_step=5e-4, rtol=1e-8)
    z, g = under.at(speed * time)
    expected = -k * (found.y[0] - z) - c * (found.y[1] - speed * g)
    dynamic = forces[0][:, 0] - vehicle.static_forces[0]
    # a damper's force jumps at corners of the road, which lie between two steps
    off = np.abs(dynamic - expected)
    assert np.quantile(off, 0.99) < 0.02 * np.abs(expected).max()
    assert off.max() < 0.05 * np.abs(expected).max()


def test_a_point_may_not_meet_a_step():
    """Without a patch or a radius the crossing is refused, with what would be usual."""
    with pytest.raises(InputError, match=r"contact patch .some 0.2 m of a truck"):
        Crossing(sprung(0.0), Route.straight((0, 0), (9, 0), speed=2.0), one(SHAPES["joint"]))


def test_random_roads_keep_their_waves_under_features():
    """With and without a hump the forces differ by those on the hump alone: all is linear."""
    vehicle = sprung(0.2, 3.0, 0.1)
    route = Route.straight((0, 0), (20, 0), speed=2.0)
    hump = Feature(shape=SHAPES["hump"], station=5.0)
    roads = (RoadClass("B"), FeaturedRoad(base=RoadClass("B"), features=(hump,)), on_smooth(hump))
    plain, both, alone = (
        contact_forces(
            Crossing(vehicle, route, road), integration=Modal(f_max=90.0, dt=0.005),
            n_runs=3, seed=4, duration=9.0,
        )[1] - vehicle.static_forces
        for road in roads
    )  # fmt: skip
    np.testing.assert_allclose(both - plain, alone, atol=1e-6 * np.abs(alone).max())


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (ExpansionJoint, "a gap or a step"),
        (lambda: ExpansionJoint(gap=0.001), "4 mm to 0.5 m"),
        (lambda: Patch(length=0.3, height=0.02, ramp=0.2), "do not fit"),
        (lambda: Patch(length=0.3, height=0.0), "height must not be 0"),
        (lambda: RampKink(grade=0.05, length=1.0, rounding=2.0), "at most the ramp's length"),
        (lambda: RailCrossing(gauge=0.1), "no room"),
        (lambda: CableProtector(length=0.1, height=0.04, top=0.3), "below length"),
        (lambda: RampKink(grade=5.0, length=3.0), "5 % is 0.05"),
        (lambda: Feature(shape=SHAPES["bump"], station=1.0, skew=1.5), "within 80 degrees"),
        (lambda: Feature(shape=SHAPES["bump"], station=1.0, across=(1.0, 0.0)), "must rise"),
        (lambda: MeasuredRoad(tracks=(), lateral=np.zeros(0)), "needs a track"),
    ],
)
def test_features_that_cannot_be_are_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_a_feature_off_a_survey_is_refused():
    """Nobody would meet it, and nobody would be told."""
    s = np.arange(478.0, 600.0, 0.5)
    base = MeasuredRoad(tracks=(Profile.from_samples(s, 0.0 * s),), lateral=np.zeros(1))
    road = FeaturedRoad(base=base, features=(Feature(shape=SHAPES["bump"], station=12.0),))
    with pytest.raises(InputError, match=r"lies off the measured road, which covers 478 to 599\.5"):
        road.under(0.0, SOFT)
