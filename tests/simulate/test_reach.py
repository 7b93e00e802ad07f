"""How far a road excites whoever crosses it: surveys of points, several tracks, joints on roads."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.road import (
    ExpansionJoint,
    Feature,
    FeaturedRoad,
    MeasuredRoad,
    Profile,
    RoadClass,
)
from trundle.route import Route, SpeedOverTime, SteadyAcceleration
from trundle.signals import mid_band_frequencies
from trundle.simulate import Crossing
from trundle.simulate.coverage import coverage_of
from trundle.simulate.sources.passage import Passage
from trundle.simulate.sources.reach import road_reach
from trundle.vehicle import Axle, Body, Description, sprung_mass

BANDS = mid_band_frequencies()
MASS = replace(sprung_mass(mass=1000.0, stiffness=1e6, damping=5e3), contact_patch=0.2)
ROUTE = Route.straight((0.0, 0.0), (20.0, 0.0), speed=5.0)


def survey(apart=0.5, *, more=(), low=-60.0, high=80.0):
    """Return a surveyed road: points some way apart, and more of them at other places."""
    s = np.sort(np.concatenate([np.arange(low, high, apart), more]))
    return Profile.from_samples(s, 1e-3 * np.sin(s))


def joined(base, **where):
    joint = Feature(shape=ExpansionJoint(gap=0.03), station=10.0, **where)
    return FeaturedRoad(base=base, features=(joint,))


def crossing(road, **changes):
    return Crossing(MASS, ROUTE, road, **{"run_in": 5.0, **changes})


def reach(road, **changes):
    found = road_reach(crossing(road, **changes))
    return found.whole, found.partly


def test_a_survey_holds_waves_of_two_points_however_close_a_few_are():
    """Points 0.5 m apart hold 1 cycle/m and no more; one more beside another adds no other wave.

    What lies between the two is there, so that levels above 1 cycle/m are lower bounds: to
    0.5 / 0.01 = 50 cycle/m.
    """
    assert reach(survey()) == pytest.approx((1.0, 1.0))
    assert reach(survey(more=[10.01])) == pytest.approx((1.0, 50.0))
    gap = np.setdiff1d(np.arange(-60.0, 80.0, 0.5), [9.5, 10.0])  # 1.5 m of 20 m without a point
    assert reach(Profile.from_samples(gap, 1e-3 * np.sin(gap)))[0] == pytest.approx(1.0)


def test_only_the_stretch_that_is_driven_on_counts():
    """A survey of 1 m that is fine from 40 m on: fine where its chainage lays the route there."""
    fine = survey(1.0, more=np.arange(40.05, 79.0, 0.1))
    assert reach(fine) == pytest.approx((0.5, 0.5))
    assert reach(fine, chainage=45.0)[0] == pytest.approx(5.0)
    half = survey(0.1, high=10.0, more=np.arange(11.0, 79.0))  # 0.1 m, and 1 m on half the way
    assert reach(half)[0] == pytest.approx(0.5)


def test_a_mirror_image_has_its_points_as_far_apart():
    """A survey of 4 m that goes on as its mirror image, driven on from 30 m on."""
    s = np.arange(0.0, 4.01, 0.25)
    mirrored = Profile.from_samples(s, 1e-3 * np.sin(s), beyond="mirror")
    assert reach(mirrored, chainage=30.0) == pytest.approx((2.0, 2.0))


def test_a_joint_adds_no_roughness_to_a_road():
    """Of 2 mm chamfers, 0.03 m of gap: all bands are excited in part, and none as a whole by it."""
    assert reach(joined(survey())) == pytest.approx((1.0, np.inf))
    assert reach(joined(RoadClass("B"))) == pytest.approx((2.83, np.inf))
    assert reach(joined(joined(survey()))) == pytest.approx((1.0, np.inf))
    assert reach(joined(survey(), route="another")) == pytest.approx((1.0, 1.0))
    assert reach(joined(survey(), across=(0.5, 2.0))) == pytest.approx((1.0, 1.0))
    assert reach(joined(Profile.smooth()))[1] == np.inf


def test_bands_that_a_joint_alone_excites_can_fail_and_not_pass():
    """5 Hz at 5 m/s: of bands above 4 Hz a level is a lower bound, with the joint in all of them."""
    plain, jointed = (coverage_of([crossing(r)], 9.0) for r in (survey(), joined(survey())))
    assert (plain.excited_to, plain.partly_to) == (pytest.approx(5.0), None)
    assert (jointed.excited_to, jointed.partly_to) == (pytest.approx(5.0), np.inf)
    assert BANDS[jointed.excites(BANDS)].max() < 4.1
    assert jointed.excites_partly(BANDS).all()
    assert "nothing excites the bands above" in plain.reasons(waves=True)[0]
    assert "not all of it excites the bands above" in jointed.reasons(waves=True)[0]
    both = coverage_of([crossing(survey(0.1)), crossing(joined(survey()))], 9.0)
    assert (both.excited_to, both.partly_to) == (pytest.approx(5.0), np.inf)


@pytest.mark.parametrize("coarse_first", [True, False])
def test_the_coarsest_track_that_a_wheel_rolls_on_bounds_a_road(coarse_first):
    """0.5 m under one wheel, 0.05 m under the other, whichever comes first; one of 5 m aside."""
    axle = Axle(body=0, setback=0.0, stiffness=1e6, track_width=1.6)
    body = Body(mass=1000.0, roll_inertia=300.0)
    vehicle = Description(name="v", bodies=(body,), axles=(axle,), contact_patch=0.2).build()
    tracks = (survey(0.5), survey(0.05)) if coarse_first else (survey(0.05), survey(0.5))
    road = MeasuredRoad(tracks=(*tracks, survey(5.0)), lateral=np.array([-0.8, 0.8, 4.0]))
    found = road_reach(Crossing(vehicle, ROUTE, road, run_in=5.0))
    assert (found.whole, found.partly) == pytest.approx((1.0, 10.0))


def test_a_vehicle_that_speeds_up_excites_no_more_once_it_has_left():
    """From 5 m/s at 1 m/s2 over 20 m: sqrt(25 + 40) = 8.06 m/s as it leaves, 18 m/s 10 s later."""
    law = SteadyAcceleration(initial=5.0, acceleration=1.0)
    one = Passage(crossing=Crossing(MASS, replace(ROUTE, law=law), RoadClass("B")))
    leaves = law.time_to(20.0)
    assert one.excited_to(leaves + 10.0) == pytest.approx(2.83 * np.sqrt(25.0 + 40.0), rel=1e-6)
    assert one.excited_to(2.0) == pytest.approx(2.83 * 7.0)


def test_before_it_has_started_nothing_is_excited():
    """A standing start at 5 s in a record of 4 s: speed 0, whatever lies on the road."""
    law = SpeedOverTime(time=np.array([0.0, 2.0]), value=np.array([0.0, 3.0]))
    late = Crossing(MASS, replace(ROUTE, law=law), joined(RoadClass("B")), depart=5.0)
    one = Passage(crossing=late)
    assert (one.excited_to(4.0), one.partly_excited_to(4.0)) == (0.0, 0.0)
    assert one.partly_excited_to(6.0) == np.inf
