"""Where the wheels of a crossing are and when; how far sources reach; the clock of a record."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.machine import Unbalance
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import (
    Abrupt,
    DriveIn,
    Ramp,
    Route,
    SpeedOverTime,
    StaticStart,
    SteadyAcceleration,
)
from trundle.signals import mid_band_frequencies
from trundle.simulate import Coverage, Crossing, coverage_of
from trundle.simulate.sources.machine import Machine
from trundle.simulate.sources.passage import Passage, as_sources
from trundle.simulate.step_limits import longest_step, step_problem
from trundle.simulate.wheels.contacts import Contacts
from trundle.simulate.wheels.timeline import starts_standing, timeline_of
from trundle.vehicle import Axle, Body, LumpedMass, build_vehicle, sprung_mass

BANDS = mid_band_frequencies()
SPEED = 5.0
WHEELBASE = 3.0


def van(**changes):
    """Return two axles 3 m apart under a body that pitches, both with tyres."""
    axles = tuple(
        Axle(
            body=0, setback=s, stiffness=1e5, damping=4e3, axle_mass=200.0, tyre_stiffness=8e5,
            tyre_damping=500.0,
        )
        for s in (0.0, WHEELBASE)
    )  # fmt: skip
    body = Body(mass=2000.0, pitch_inertia=3000.0, centre=1.2)
    return replace(build_vehicle(name="van <1>", bodies=(body,), axles=axles), **changes)


def crossing(length=20.0, *, law=None, road=None, **changes):
    route = Route.straight((0.0, 2.0), (length, 2.0), speed=SPEED, name="Ötztal, a&b")
    route = route if law is None else replace(route, law=law)
    return Crossing(van(), route, road or RoadClass("B"), **{"run_in": 10.0, **changes})


@pytest.mark.parametrize(
    ("entry", "lead"),
    [
        (DriveIn(length=2.0), 0.0),
        (Abrupt(), 0.0),
        (Ramp(length=1.5), -1.5),
        (StaticStart(exit_length=1.0), WHEELBASE),
    ],
)
def test_the_last_wheel_leaves_when_its_axle_has_come_to_the_end(entry, lead):
    """20 m of way and 3 m of wheelbase, less what is behind at time 0: (23 - lead) / 5 s.

    From there on no wheel stands on the floor, and just before one does.
    """
    one = crossing(entry=entry, depart=2.0)
    assert one.lead == lead
    leaves = 2.0 + (20.0 + WHEELBASE - lead) / SPEED
    assert one.exit_time == pytest.approx(leaves, rel=1e-12)
    assert one.wheels_on_floor(leaves - 1e-6) == 1
    assert one.wheels_on_floor(leaves + 1e-6) == 0
    # from when its second axle is on to when its first leaves there are two
    assert one.wheels_on_floor(2.0 + (WHEELBASE - lead) / SPEED + 0.01) == 2
    assert one.front_axle(leaves) is None
    at = one.front_axle(2.0 + (4.0 - lead) / SPEED)
    assert at == pytest.approx((4.0, 2.0))


def test_every_wheel_follows_the_first_by_its_setback():
    """Stations by hand: 5 t - 3 of the rear axle; before it begins it stands still."""
    one = crossing(depart=1.0)
    begins = one.begins(0.01)
    assert begins == pytest.approx(1.0 - 10.0 / SPEED)
    time = np.array([begins - 0.5, begins, begins + 0.01, 1.0, 3.0])
    along = one.along(time, begins)
    front = np.array([-10.0, -10.0, -9.95, 0.0, 10.0])
    np.testing.assert_allclose(along.station[:, 0], front, atol=1e-9)
    np.testing.assert_allclose(along.station[:, 1], front - WHEELBASE, atol=1e-9)
    np.testing.assert_allclose(along.speed[:, 0], [0.0, 0.0, SPEED, SPEED, SPEED])


@pytest.mark.parametrize("dt", [0.003, 0.01, 0.07])
def test_a_vehicle_begins_a_whole_number_of_steps_before_the_record(dt):
    """At least its run-in of 2 s before it departs at 0.5 s, and less than a step more."""
    one = crossing(depart=0.5)
    begins = one.begins(dt)
    assert round(begins / dt) == pytest.approx(begins / dt, abs=1e-9)
    assert 0.5 - 10.0 / SPEED - dt < begins <= 0.5 - 10.0 / SPEED + 1e-9
    assert crossing(depart=30.0).begins(dt) > 0.0
    assert crossing(entry=StaticStart(exit_length=1.0)).begins(dt) == 0.0


def test_the_run_in_ends_when_the_slowest_motion_has_died_to_5_per_cent():
    """exp(-3) = 0.05 of the slowest decay rate of the poles; no damping ends it after 20 s."""
    one = crossing(run_in=None)
    system = one.driven.system
    state = np.block(
        [
            [np.zeros((4, 4)), np.eye(4)],
            [-np.linalg.solve(system.mass, system.stiffness),
             -np.linalg.solve(system.mass, system.damping)],
        ]
    )  # fmt: skip
    slowest = -np.linalg.eigvals(state).real.max()
    assert one.run_in_time == pytest.approx(3.0 / slowest, rel=1e-9)
    free = Crossing(sprung_mass(mass=1000.0, stiffness=1e5), one.route, RoadClass("B"))
    assert free.run_in_time == 20.0


def test_a_vehicle_that_stops_stays_where_it_stops():
    """From 5 m/s at 1 m/s2 it stops after 12.5 m and 5 s: on the floor for ever."""
    one = crossing(law=SteadyAcceleration(initial=5.0, acceleration=-1.0))
    assert one.stays
    assert one.exit_time == pytest.approx(5.0)
    assert one.wheels_on_floor(1e6) == 2
    assert one.front_axle(1e6) == pytest.approx((12.5, 2.0))
    share = Passage(crossing=one).track(np.array([0.0, 500.0]), 0.0).share[1]
    np.testing.assert_array_equal(share, [1.0, 1.0])  # the way does not end under it


def test_what_hangs_within_a_vehicle_touches_no_floor():
    """A braking body is pushed inside; the floor carries the wheels alone."""
    axle = Axle(body=0, setback=0.0, stiffness=1e5)
    body = Body(mass=2000.0, pitch_inertia=3000.0, centre=1.2, height=0.8)
    vehicle = build_vehicle(name="v", bodies=(body,), axles=(axle, replace(axle, setback=3.0)))
    route = replace(
        Route.straight((0.0, 2.0), (20.0, 2.0), speed=5.0),
        law=SteadyAcceleration(initial=5.0, acceleration=-1.0),
    )
    one = Crossing(vehicle, route, RoadClass("B"), run_in=0.0)
    assert one.driven.inner == 1
    assert vehicle.inner == 0  # the vehicle that was given stays as it was
    track = Passage(crossing=one).track(np.linspace(0.0, 4.0, 9), 0.0)
    assert (track.share[:, 2] == 0.0).all()
    assert (track.share_slope[:, 2] == 0.0).all()
    assert track.share[-1, :2].tolist() == [1.0, 1.0]


def test_a_contact_patch_comes_from_the_band_or_else_from_the_vehicle():
    """The band's own counts; without one, that of the vehicle's tyres."""
    route = Route.straight((0.0, 2.0), (20.0, 2.0), speed=5.0)
    patched = van(contact_patch=0.25)
    for band, patch in ((RoughnessBand(), 0.25), (RoughnessBand(contact_patch=0.1), 0.1)):
        one = Crossing(patched, route, RoadClass("B"), band=band)
        assert one.band.contact_patch == patch
        assert (one.band.n_min, one.band.n_max) == (band.n_min, band.n_max)
    assert Crossing(van(), route, RoadClass("B")).band.contact_patch == 0.0


def test_a_tyre_sinks_by_its_load_over_its_stiffness():
    """By moments about the other axle: 2000 kg at 1.2 m of 3 m, and 200 kg of each axle."""
    one = crossing()
    loads = 9.81 * (2000.0 * np.array([0.6, 0.4]) + 200.0)
    for contact, load in enumerate(loads):
        assert one.tread(contact).sinking == pytest.approx(load / 8e5, rel=1e-9)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"depart": -1.0}, "depart must be 0 or more"),
        ({"run_in": -1.0}, "run_in must be 0 or more"),
        ({"chainage": np.nan}, "chainage must be finite"),
        ({"chainage": 3.0}, "a random road, which has no stations"),
        ({"start": "level", "entry": StaticStart(exit_length=1.0)}, "static start is in equil"),
    ],
)
def test_crossings_that_cannot_be_are_refused(changes, words):
    """Before any work, with the argument's name."""
    with pytest.raises(InputError, match=words):
        crossing(**changes)


def test_a_road_excites_to_its_shortest_wave_at_the_greatest_speed():
    """2.83 cycle/m at 5 m/s end at 14.15 Hz; speeding up by 1 m/s2 for 2 s at 19.81 Hz.

    A given profile of points 0.1 m apart holds waves of 0.2 m: 5 / 0.2 = 25 Hz.
    """
    assert Passage(crossing=crossing()).excited_to(10.0) == pytest.approx(14.15)
    faster = crossing(law=SteadyAcceleration(initial=5.0, acceleration=1.0))
    assert Passage(crossing=faster).excited_to(2.0) == pytest.approx(2.83 * 7.0, rel=1e-6)
    late = crossing(law=SteadyAcceleration(initial=5.0, acceleration=1.0), depart=1.0)
    assert Passage(crossing=late).excited_to(2.0) == pytest.approx(2.83 * 6.0, rel=1e-6)
    stations = np.arange(-40.0, 60.0, 0.1)
    survey = Profile.from_samples(stations, 1e-3 * np.sin(stations))
    assert Passage(crossing=crossing(road=survey)).excited_to(9.0) == pytest.approx(25.0)


def pump(frequency=30.0, **changes):
    return Machine(
        name="pump", feet=np.array([[3.0, 2.0]]),
        force=Unbalance(mass_radius=0.1, frequency=frequency), **changes,
    )  # fmt: skip


def test_several_sources_reach_as_far_as_the_least_road():
    """Roads that end at 14.15 and 28.3 Hz: the first bounds what is passed, the second may fail.

    Who leaves last counts for all; a machine that is known altogether bounds nobody.
    """
    slow, fast = crossing(), replace(crossing(), band=RoughnessBand(n_max=5.66), depart=3.0)
    both = coverage_of([slow, fast], 9.0)
    assert (both.excited_to, both.partly_to) == pytest.approx((14.15, 28.3))
    assert (both.by, both.partly_by) == ("road", "road")
    assert both.leaves == pytest.approx(3.0 + 23.0 / 5.0)
    assert both.left
    assert not coverage_of([slow, fast], 7.0).left
    alone = coverage_of([slow], 9.0)
    assert alone.partly_to is None
    with_pump = coverage_of([slow, pump(starts=1.0, lasts=2.0)], 9.0)
    assert with_pump.excited_to == pytest.approx(14.15)
    assert with_pump.partly_by == "forces"
    only = coverage_of([pump(starts=1.0, lasts=2.0)], 9.0)
    assert (only.by, only.leaves) == ("forces", 3.0)


def test_a_band_of_a_road_is_filled_and_one_of_a_machine_holds_a_line():
    """The 10 Hz band is 8.91 to 11.22 Hz: waves must reach its end, but for 1 %; a line of
    9 Hz lies in it, and one of 8.9 in the band below.
    """
    for top, last in ((11.11, 10.0), (11.10, 8.0), (14.0, 12.5)):
        reached = BANDS[Coverage(excited_to=top).excites(BANDS)]
        assert reached.max() == pytest.approx(last, rel=0.02)
    for line, last in ((9.0, 10.0), (8.9, 8.0)):
        held = Coverage(excited_to=line, by="forces").excites(BANDS)
        assert BANDS[held].max() == pytest.approx(last, rel=0.02)
    part = Coverage(excited_to=11.2, partly_to=90.0)
    assert part.excites_partly(BANDS).all()
    assert not part.excites(BANDS).all()
    np.testing.assert_array_equal(
        Coverage(excited_to=20.0).excites_partly(BANDS), Coverage(excited_to=20.0).excites(BANDS)
    )


def test_what_is_missing_is_said_with_what_would_help():
    """80 Hz end at 89.1 Hz: from 14.15 Hz n_max must grow 6.3 times."""
    (road,) = Coverage(excited_to=14.15).reasons(waves=True)
    assert "waves end at 14.2 Hz" in road
    assert "raise n_max 6.3 times for 80 Hz" in road
    (forces,) = Coverage(excited_to=30.0, by="forces").reasons(waves=True)
    assert forces.startswith("the forces that are given end at 30 Hz")
    (late,) = Coverage(leaves=5.0, ends=4.0, by="forces").reasons(waves=False)
    assert "the last source ends at 5 s" in late
    assert Coverage().reasons(waves=False) == ()


def test_the_clock_counts_all_run_ins_and_the_record():
    """Run-ins of 2 s before departures at 0 and 1.5 s: 200 steps before time 0, not 250."""
    sources = as_sources([crossing(), crossing(depart=1.5)])
    timeline = timeline_of(sources, 0.01, 4.0)
    assert timeline.n_run_in == 200
    assert timeline.time[0] == pytest.approx(-2.0)
    np.testing.assert_allclose(timeline.record, 0.01 * np.arange(401), atol=1e-12)
    assert timeline.begins == pytest.approx((-2.0, -0.5))
    assert timeline.begin == (0, 150)
    late = timeline_of(as_sources(crossing(depart=5.0)), 0.01, 4.0)
    assert (late.n_run_in, late.begin) == (0, (300,))
    with pytest.raises(InputError, match=r"at least 2 steps of 0.01 s; got 0.01 s"):
        timeline_of(sources, 0.01, 0.01)


def test_all_stand_on_the_floor_at_first_or_none():
    """One in equilibrium with the floor and one before it have no common start."""
    stands = crossing(entry=StaticStart(exit_length=1.0))
    assert starts_standing(as_sources([stands, stands]))
    assert not starts_standing(as_sources([crossing()]))
    with pytest.raises(InputError, match="either every crossing starts in static equilibrium"):
        starts_standing(as_sources([stands, crossing()]))


def test_a_passage_put_off_keeps_its_name_unless_numbered():
    """Two on one route meet the same road; the second is told by its number."""
    first = Passage(crossing=crossing())
    second = replace(first, number=2).later(3.0)
    assert (first.name, second.name) == ("Ötztal, a&b", "Ötztal, a&b (2)")
    assert second.leaves == pytest.approx(first.leaves + 3.0)
    drawn = [
        one.inputs(one.begins(0.01) + 0.01 * np.arange(900), one.begins(0.01), 7).draw(4)[0]
        for one in (first, second)
    ]
    np.testing.assert_allclose(drawn[0], drawn[1], rtol=1e-9, atol=1e-6)


def test_vehicles_and_floor_settle_as_one_static_system():
    """Contact forces by a dense solution of vehicle and floor springs together.

    A van whose wheels stand on a floor of flexibility S: unknown are the four dofs and both
    forces, ``K z = E^T f_springs``, ``f = static - k (E z - y)``, ``y = -S f``.
    """
    one = crossing().driven
    springs = Contacts(vehicles=(one,)).springs
    sinking = 1e-7 * np.array([[3.0, 1.0], [1.0, 4.0]])
    road = np.array([[0.002, 0.0], [0.0, -0.001]])
    e, k = np.asarray(one.contact_map), one.contact_stiffness
    free = np.asarray(one.free_system.stiffness)
    rigid = one.static_forces[:, None] - k[:, None] * (e @ springs.standing_on(road) - road)
    forces, push, moved = springs.settled(sinking, rigid)
    for run in range(2):
        # displacements from level equilibrium: free springs balance what the contacts add
        a = np.block([[free, -e.T], [k[:, None] * e, np.eye(2) + k[:, None] * sinking]])
        b = np.concatenate([-e.T @ one.static_forces, one.static_forces + k * road[:, run]])
        z_f = np.linalg.solve(a, b)
        np.testing.assert_allclose(forces[:, run], z_f[4:], rtol=1e-8)
        z = springs.standing_on(road)[:, run] + moved[:, run]
        np.testing.assert_allclose(z, z_f[:4], atol=1e-12)
        np.testing.assert_allclose(push[:, run], -k * (sinking @ z_f[4:]), rtol=1e-8)


def test_the_longest_step_shows_the_highest_motion_that_rings():
    """0.45 / f of a mass on a spring at f; one damped beyond half of critical rings no more."""
    mass, f = 1500.0, 11.0
    k = mass * (2 * np.pi * f) ** 2
    ringing = sprung_mass(mass=mass, stiffness=k, damping=0.1 * 2 * np.sqrt(k * mass))
    assert longest_step(ringing) == pytest.approx(0.45 / f, rel=1e-9)
    assert step_problem(ringing, 0.45 / f) == ""
    told = step_problem(replace(ringing, name="cart <2>"), 0.05)
    assert "'cart <2>' vibrates at 11 Hz" in told
    assert "shorten dt to 41 ms" in told
    dull = sprung_mass(mass=mass, stiffness=k, damping=0.6 * 2 * np.sqrt(k * mass))
    assert longest_step(dull) > 1e3


def test_a_lumped_payload_moves_the_static_forces_of_a_crossing():
    """600 kg over the rear axle: 600 g more there and nothing in front."""
    axle = Axle(body=0, setback=0.0, stiffness=1e5)
    body = Body(mass=2000.0, pitch_inertia=3000.0, centre=1.2)
    axles = (axle, replace(axle, setback=WHEELBASE))
    loads = [
        build_vehicle(name="v", bodies=(body,), axles=axles, lumped=lumped).static_forces
        for lumped in ((), (LumpedMass(mass=600.0, body=0, setback=WHEELBASE),))
    ]
    np.testing.assert_allclose(loads[1] - loads[0], [0.0, 600.0 * 9.81], atol=1e-6)


def test_stop_and_go_counts_its_waits():
    """0 to 10 m at 4 m/s braking to rest, 6 s of standing, and on: the exit follows by hand.

    4 m/s to 0 over 10 m take 5 s; from 0 to 4 over 13 m of way and wheelbase 6.5 s.
    """
    law = SpeedOverTime.over_stations([0.0, 10.0, 23.0], [4.0, 0.0, 4.0], waits=[6.0])
    one = crossing(law=law)
    assert not one.stays
    assert one.exit_time == pytest.approx(5.0 + 6.0 + 6.5)
    assert one.front_axle(8.0) == pytest.approx((10.0, 2.0))
