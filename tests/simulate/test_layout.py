"""What runs of several sources share: names, order, time, roads and waves under the wheels."""

from dataclasses import replace

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.machine import Unbalance
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import DriveIn, Route, SteadyAcceleration
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    ModalRatio,
    batches,
    contact_force_histories,
    contact_forces,
    ensemble,
    lay_out,
    mean_response,
    prepare,
    runs_with_mean,
)
from trundle.simulate.fitness import contact_warnings
from trundle.simulate.sources.machine import Machine
from trundle.simulate.sources.passage import Passage, as_sources
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.simulate.wheels.timeline import timeline_of
from trundle.vehicle import Axle, Body, build_vehicle

POINTS = {"Waage <1>": (3.0, 3.0), "b, c": (7.3, 1.9), "ä": (10.0, 5.0)}
INTEGRATION = Modal(f_max=40.0, dt=0.01)
DAMPING = ModalRatio(ratio=0.04)
BAND = RoughnessBand(n_min=0.05, n_max=4.0)


def cart(**changes):
    """Return two axles with tyres on both sides under a body that pitches and rolls."""
    axle = Axle(
        body=0, setback=0.0, stiffness=2e5, damping=9e3, axle_mass=200.0, tyre_stiffness=1e6,
        tyre_damping=800.0, track_width=1.6,
    )  # fmt: skip
    body = Body(mass=3000.0, pitch_inertia=4000.0, roll_inertia=900.0, centre=1.2)
    made = build_vehicle(name="cart", bodies=(body,), axles=(axle, replace(axle, setback=2.8)))
    return replace(made, **changes)


def crossing(name="Weg ß", y=3.0, **changes):
    route = Route.straight((0.0, y), (12.0, y), speed=4.0, name=name)
    values = {"band": BAND, "entry": DriveIn(length=2.0), "run_in": 4.0, **changes}
    return Crossing(cart(), route, RoadClass("B"), **values)


def pump():
    return Machine(
        name="pump", feet=np.array([[9.0, 2.0], [9.5, 2.0]]),
        force=Unbalance(mass_radius=0.2, frequency=11.0), starts=1.0, lasts=2.0,
    )  # fmt: skip


@pytest.fixture(scope="module")
def floor():
    return prepare(small_floor(mesh_size=2.0), INTEGRATION, DAMPING)


def laid(floor, sources, *, kind=Decoupled, points=POINTS, **settings):
    method = kind(integration=INTEGRATION, damping=DAMPING)
    return lay_out(floor, sources, method=method, points=points, **settings)


def test_contacts_of_several_sources_are_told_by_source(floor):
    """Source by source in the order given, each with its contacts; of one alone without its name."""
    wheels = ("axle 1 left", "axle 1 right", "axle 2 left", "axle 2 right")
    both = laid(floor, [crossing(), pump()], duration=1.0)
    assert both.contact_names == (*(f"Weg ß {w}" for w in wheels), "pump foot 1", "pump foot 2")
    assert laid(floor, crossing(), duration=1.0).contact_names == wheels
    assert both.point_names == tuple(POINTS)


def test_a_record_lasts_until_all_have_left_and_five_seconds(floor):
    """12 + 2.8 m at 4 m/s are 3.7 s; one that departs at 2 s leaves at 5.7; a duration given counts."""
    assert laid(floor, crossing()).time[-1] == pytest.approx(3.7 + 5.0, abs=0.011)
    late = [crossing(), crossing("two", depart=2.0)]
    assert laid(floor, late).time[-1] == pytest.approx(5.7 + 5.0, abs=0.011)
    short = laid(floor, crossing(), duration=3.0)
    np.testing.assert_allclose(short.time, 0.01 * np.arange(301), atol=1e-12)
    assert not short.coverage.left


def test_points_keep_their_names_whatever_their_order(floor):
    """The same three places in reverse, and one alone: each has the motion of its name."""
    sources = [crossing(), pump()]
    runs = next(batches(laid(floor, sources, duration=3.0), runs=range(2), seed=5))
    turned = dict(reversed(POINTS.items()))
    other = next(batches(laid(floor, sources, points=turned, duration=3.0), runs=range(2), seed=5))
    scale = np.abs(runs.velocity).max()
    for name in POINTS:
        one = runs.velocity[:, :, runs.point(name)]
        np.testing.assert_allclose(other.velocity[:, :, other.point(name)], one, atol=1e-9 * scale)
    np.testing.assert_allclose(other.contact_forces, runs.contact_forces, atol=1e-6)


def test_on_a_floor_that_is_not_felt_wheels_press_as_on_the_ground(floor):
    """Decoupled forces are those of the vehicle on rigid ground, on the same roads."""
    one = crossing()
    runs = next(batches(laid(floor, one, duration=4.0), runs=range(2), seed=3))
    time, forces = contact_forces(one, integration=INTEGRATION, n_runs=2, seed=3, duration=4.0)
    np.testing.assert_allclose(time, runs.time)
    np.testing.assert_allclose(runs.contact_forces, forces, rtol=1e-9)
    # their mean over time is the static load, which the road only moves about
    static = cart().static_forces
    assert np.abs(forces.mean(axis=(0, 1)) / static - 1.0).max() < 0.05


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
def test_the_mean_beside_runs_is_that_of_a_smooth_road(floor, kind):
    """Response to the static loads alone, three ways: beside runs, by itself, on a road of no height."""
    one = crossing()
    layout = laid(floor, one, kind=kind, duration=4.0)
    beside = runs_with_mean(layout, runs=range(2), seed=1)[1]
    alone = mean_response(layout)
    smooth = Crossing(
        one.vehicle, one.route, Profile.smooth(), band=BAND, entry=one.entry, run_in=4.0
    )
    run = next(batches(laid(floor, smooth, kind=kind, duration=4.0), runs=range(1), seed=9))
    for mean in (beside, alone):
        for name in ("displacement", "velocity", "acceleration", "contact_forces"):
            wanted = getattr(run, name)[0]
            scale = np.abs(wanted).max()
            np.testing.assert_allclose(getattr(mean, name), wanted, atol=1e-8 * scale)
    forces, still = contact_force_histories(layout, runs=range(2), seed=1)
    np.testing.assert_allclose(still[:, :, 0], run.contact_forces[0], atol=1e-4)
    assert forces.shape == (401, 4, 2)


def test_runs_have_their_numbers_and_progress_rises(floor):
    """Runs 3 and 4 of five are those that begin at 3; shares told rise from batch to batch, to the last step."""
    layout = laid(floor, crossing(), duration=2.0)
    told = []
    parts = list(batches(layout, runs=range(5), seed=2, batch=2, progress=told.append))
    assert [part.n_runs for part in parts] == [2, 2, 1]
    (some,) = batches(layout, runs=range(3, 5), seed=2)
    every = np.concatenate([part.velocity for part in parts])
    np.testing.assert_allclose(some.velocity, every[3:], atol=1e-9 * np.abs(every).max())
    assert told == sorted(told)
    assert 0.99 < told[-1] <= 1.0


def test_a_number_of_runs_is_a_number_of_runs(floor):
    """None, less than one or a half are refused before anything is stepped."""
    method = Decoupled(integration=INTEGRATION, damping=DAMPING)
    with pytest.raises(InputError, match="n_runs must be a whole number of at least 1; got 0"):
        ensemble(floor, crossing(), method=method, points=POINTS, n_runs=0, seed=1)


def test_a_share_of_runs_that_lift_is_written_as_people_do():
    """One of a thousand is 0.1 %, a third 33 %; none is no doubt."""
    assert contact_warnings(0.0) == ()
    (rare,), (often,) = contact_warnings(0.001), contact_warnings(1.0 / 3.0)
    assert "in 0.1 % of the runs" in rare.message
    assert "in 33 % of the runs" in often.message


def test_wheels_are_pushed_by_height_and_slope_of_their_own_track():
    """Sides differ, rear wheels meet what front ones met 2.8 m before, and pushes are k z + c V z'.

    A spring twice as stiff adds k z once more, which tells z; what is left over c is its rate, by
    central differences of waves of 2.5 steps and more. Without a random road nothing is pushed.
    """
    one = crossing()
    vehicle = one.driven
    timeline = timeline_of(as_sources(one), 0.01, 3.0)
    road = roads_under_wheels(as_sources(one), timeline, range(4, 6), 11, smooth=1)
    assert np.abs(road.push[:, :, 2]).max() == 0.0
    assert np.abs(road.start[:, 2]).max() == 0.0
    stiffer = replace(one, vehicle=cart(contact_stiffness=2.0 * vehicle.contact_stiffness))
    other = roads_under_wheels(as_sources(stiffer), timeline, range(4, 6), 11)
    pushed, late = road.push[:, :, :2], round(2.8 / 4.0 / 0.01)
    moving = pushed[1:]  # at the first time all stand still
    scale = np.abs(pushed).max()
    np.testing.assert_allclose(moving[late:, 2:], moving[:-late, :2], atol=1e-6 * scale)
    assert np.abs(pushed[:, 0] - pushed[:, 1]).max() > 0.1 * scale
    height = (other.push - pushed) / vehicle.contact_stiffness[:, None]
    np.testing.assert_allclose(height[0], road.start[:, :2], atol=1e-12)
    rolled = (pushed - vehicle.contact_stiffness[:, None] * height)[1:-1]
    rolled /= vehicle.contact_damping[:, None]
    rate = (height[2:] - height[:-2]) / 0.02
    off = (rolled - rate)[5:-5]
    assert np.sqrt(np.mean(off**2)) < 0.1 * np.sqrt(np.mean(rate**2))


def test_waves_push_as_a_road_of_that_wave():
    """(k + i c V 2 pi n) exp(2 pi i n s) under each wheel: by a sine of the same wave, wheel by wheel.

    A wave's share of a track is at most one; the powers of all waves sum to the band's variance.
    """
    flat = build_vehicle(
        name="planar", bodies=(Body(mass=3000.0, pitch_inertia=4000.0, centre=1.2),),
        axles=tuple(Axle(body=0, setback=s, stiffness=3e5, damping=7e3) for s in (0.0, 2.8)),
    )  # fmt: skip
    one = Passage(crossing=replace(crossing(), vehicle=flat))
    time = one.begins(0.01) + 0.01 * np.arange(500)
    (waves,) = one.waves(time, one.begins(0.01), 40)
    assert waves.power.sum() == pytest.approx(RoadClass("B").variance(0.05, 4.0), rel=1e-9)
    some = waves.part(slice(10, 13))
    np.testing.assert_array_equal(some.n, waves.n[10:13])
    np.testing.assert_array_equal(some.power, waves.power[10:13])
    along = one.crossing.along(time, one.begins(0.01))
    for i, (push, start) in enumerate(some.pushes()):
        for j, n in enumerate(some.n):
            unit = np.exp(2j * np.pi * n * along.station[:, i])
            wanted = (3e5 + 1j * 7e3 * along.speed[:, i] * 2 * np.pi * n) * unit
            np.testing.assert_allclose(push[:, j], wanted, rtol=1e-9)
            assert start[j] == pytest.approx(unit[0])
    level = next(iter(replace(some, level=True).pushes()))
    assert np.abs(level[1]).max() == 0.0


def test_a_machine_shares_its_force_and_comes_on_smoothly():
    """Each foot half; nothing before it starts and behind its end; half of a cosine over 1 s.

    A rotor's force is m e omega^2 at most; in its middle it turns freely: m e omega^2 cos(omega t).
    """
    machine = replace(pump(), random_phase=False, lasts=4.0)
    time = 0.005 * np.arange(1300)
    force, height = machine.inputs(time, 0.0, 1).draw(0)
    w = 2 * np.pi * 11.0
    whole = force.sum(axis=1)
    np.testing.assert_allclose(force[:, 0], force[:, 1])
    assert (height == 0.0).all()
    outside = (time < 1.0) | (time > 5.0)
    assert np.abs(whole[outside]).max() < 1e-9
    middle = (time > 2.0) & (time < 4.0)
    peak = 0.2 * w**2
    assert np.abs(whole[middle]).max() == pytest.approx(peak, rel=0.02)
    assert np.abs(whole[(time > 1.0) & (time < 1.1)]).max() < 0.03 * peak
    rms = np.sqrt(np.mean(whole[middle] ** 2))
    assert rms == pytest.approx(peak / np.sqrt(2.0), rel=0.01)
    assert machine.leaves == 5.0
    assert machine.later(2.5).leaves == 7.5
    assert replace(machine, lasts=np.inf).leaves == 11.0
    assert machine.stands_at(0.0) == ((9.0, 2.0), 2)


def test_a_vehicle_that_speeds_up_needs_a_step_for_its_greatest_speed():
    """4 cycle/m at 4 m/s need 31 ms; at 8 m/s, which it reaches, 16 ms: 20 ms are too long."""
    law = SteadyAcceleration(initial=4.0, acceleration=2.0)
    one = crossing()
    faster = replace(one, route=replace(one.route, law=law))
    time = np.arange(0.0, 2.0, 0.02)
    Passage(crossing=one).inputs(time, 0.0, 1)
    with pytest.raises(InputError, match="needs a time step of at most"):
        Passage(crossing=faster).inputs(time, 0.0, 1)
