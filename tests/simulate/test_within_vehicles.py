"""What a vehicle brings itself: braking that pitches it, engines, wheels that are not round."""

from dataclasses import replace

import numpy as np
import pytest

from models import small_floor
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.road import Profile, RoadClass
from trundle.route import Abrupt, Route, SpeedOverTime, StaticStart, SteadyAcceleration
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    contact_forces,
    ensemble,
    lay_out,
    point_load_deflection,
    prepare,
)
from trundle.simulate.sources.passage import Passage
from trundle.vehicle import (
    GRAVITY,
    Axle,
    Body,
    BodyForce,
    Description,
    OutOfRound,
    build_vehicle,
    describe,
)

EVERY = Modal(f_max=90.0, dt=0.005)
SMOOTH = Profile.smooth()
Y, MID, STOP = 3.0, (4.0, 3.0), 8.0


def van(**more):
    """Two axles 3 m apart on tyres alone, its mass of 2 t 0.9 m high and 1.2 m behind the front."""
    stiffness, damping = 4e5, 1.2e4
    return Description(
        name="van",
        bodies=(Body(mass=2000.0, pitch_inertia=2500.0, centre=1.2, height=0.9),),
        axles=tuple(Axle(body=0, setback=x, stiffness=stiffness, damping=damping)
                    for x in (0.0, 3.0)),
        **more,
    )  # fmt: skip


def forces_of(vehicle, route, road=SMOOTH, duration=12.0, n_runs=1, **more):
    crossing = Crossing(vehicle, route, road, **more)
    time, forces = contact_forces(
        crossing, integration=EVERY, n_runs=n_runs, seed=1, duration=duration
    )
    return time, forces, crossing


def way(*values, length=200.0):
    law = SpeedOverTime(time=np.array([0.0, 4.0, 9.0, 20.0]), value=np.array(values, float))
    return Route(points=np.array([[0.0, 0.0], [length, 0.0]]), law=law)


def test_steady_braking_presses_the_front_by_mass_height_and_wheelbase():
    """``m a h / l`` from the rear to the front once pitching has died away; nothing in sum."""
    vehicle = van().build()
    time, forces, _ = forces_of(vehicle, way(12.0, 12.0, 2.0, 2.0))
    braking = (time > 7.0) & (time < 8.9)
    dynamic = forces[0][braking, :2] - vehicle.static_forces
    shift = 2000.0 * 2.0 * 0.9 / 3.0
    np.testing.assert_allclose(dynamic[-1], [shift, -shift], rtol=1e-3)
    steady = forces[0][time < 3.9, :2] - vehicle.static_forces
    assert np.abs(steady).max() < 1e-9 * shift
    # the moment alone bounces nothing: the body's height moves with its pitch alone
    assert forces[0][:, 2:].max() == 0.0


def test_the_pitch_that_braking_starts_is_that_of_one_oscillator():
    """A body whose springs are as far before its centre as behind: pitch alone, by Duhamel.

    Step of moment M: theta = M/K (1 - exp(-zwt)(cos wd t + z w/wd sin wd t)); the front spring
    carries k theta l/2 and its damper the rest.
    """
    k, c, m, inertia, h, span = 4e5, 6e3, 2000.0, 2500.0, 0.9, 3.0
    body = Body(mass=m, pitch_inertia=inertia, centre=1.5, height=h)
    axles = tuple(Axle(body=0, setback=x, stiffness=k, damping=c) for x in (0.0, span))
    vehicle = build_vehicle(name="v", bodies=(body,), axles=axles)
    law = SpeedOverTime(time=np.array([0.0, 2.0, 6.0]), value=np.array([10.0, 10.0, 2.0]))
    route = Route(points=np.array([[0.0, 0.0], [90.0, 0.0]]), law=law)
    time, forces, _ = forces_of(vehicle, route, duration=5.5)
    turn, drag = k * span**2 / 2, c * span**2 / 2
    w, z = np.sqrt(turn / inertia), drag / 2 / np.sqrt(turn * inertia)
    wd, t = w * np.sqrt(1 - z**2), np.maximum(time - 2.0, 0.0)
    decay = np.exp(-z * w * t)
    moment = m * 2.0 * h
    angle = moment / turn * (1 - decay * (np.cos(wd * t) + z * w / wd * np.sin(wd * t)))
    rate = moment / (inertia * wd) * decay * np.sin(wd * t)
    expected = (k * angle + c * rate) * span / 2
    found = forces[0][:, 0] - vehicle.static_forces[0]
    assert np.abs(found - expected).max() < 0.01 * expected.max()


@pytest.mark.parametrize("f", [1.5, 4.2, 9.0])
def test_an_engine_shakes_a_floor_by_what_its_springs_let_through(f):
    """A mass on a spring under F cos: the steady force on the ground is F |k + iwc| / |k - mw2 + iwc|."""
    m, k, c, force = 1500.0, 8e5, 9e3, 300.0
    vehicle = Description(
        name="engine",
        bodies=(Body(mass=m),),
        axles=(Axle(body=0, setback=0.0, stiffness=k, damping=c),),
        forces=(BodyForce(amplitude=force, frequency=f),),
    ).build()
    route = Route.straight((0, 0), (90, 0), speed=3.0)
    time, forces, _ = forces_of(vehicle, route, duration=20.0)
    dynamic = forces[0][:, 0] - vehicle.static_forces[0]
    w = 2 * np.pi * f
    gain = abs(k + 1j * w * c) / abs(k - m * w**2 + 1j * w * c)
    late = time > 10.0
    fit = np.stack([np.cos(w * time[late]), np.sin(w * time[late])], axis=1)
    found = np.hypot(*np.linalg.lstsq(fit, dynamic[late], rcond=None)[0])
    # the step of 5 ms holds a wave of 9 Hz to (w dt)^2 / 12 = 0.7 %
    assert found == pytest.approx(force * gain, rel=(w * 0.005) ** 2 / 12 + 1e-3)


def test_a_driveline_turns_with_the_wheels_and_a_mast_acts_while_it_is_told():
    """Order 2 at 3 m/s on 0.3 m: 2 x 3 / (2 pi 0.3) = 3.18 Hz; before and behind, nothing."""
    driveline = BodyForce(amplitude=10.0, order=2.0, radius=0.3)
    t = np.linspace(0.0, 10.0, 10001)
    found = driveline.force(t, 3.0 * t)
    crossings = np.sum(np.diff(np.sign(found)) != 0)
    assert crossings == pytest.approx(2 * 10.0 * 2 * 3.0 / (2 * np.pi * 0.3), abs=1)
    mast = BodyForce(amplitude=10.0, frequency=5.0, during=(2.0, 3.0))
    acts = mast.force(t, t) != 0.0
    assert t[acts].min() == pytest.approx(2.0, abs=0.06)
    assert t[acts].max() == pytest.approx(3.0, abs=0.06)


def test_runout_is_a_wave_of_the_rolling_circumference():
    """1 mm round a wheel of 0.35 m is what a road with that wave under every wheel does."""
    vehicle = van(rounds=(OutOfRound(amplitude=1e-3, radius=0.35),)).build()
    route = Route.straight((0, 0), (60, 0), speed=5.0)
    time, forces, _ = forces_of(vehicle, route, duration=8.0, run_in=30.0)
    n = 1 / 0.35
    s = np.arange(-60.0, 90.0, 0.01)
    # each wheel meets its wave by its own station, as each wheel meets a road
    road = Profile(station=s, elevation=1e-3 * np.cos(n * s), slope=-1e-3 * n * np.sin(n * s))
    plain = van().build()
    _, expected, _ = forces_of(plain, route, road, duration=8.0, run_in=30.0)
    late = time > 4.0
    np.testing.assert_allclose(
        forces[0][late], expected[0][late], atol=1e-3 * np.ptp(expected[0][late])
    )


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
def test_a_truck_stops_inside_and_stands_there(kind):
    """It brakes to rest at x = 8 m: the floor then carries its weight, and sags as for it.

    The sag long after is the static one under the wheels where they stand, by the same floor; the
    record is whole: the vehicle has come to rest, and nothing is said of wheels that have not left.
    """
    floor, vehicle = small_floor(), van().build()
    law = SpeedOverTime.over_stations([0.0, 4.0, STOP], [3.0, 3.0, 0.0])
    route = Route(points=np.array([[0.0, Y], [12.0, Y]]), law=law)
    crossing = Crossing(vehicle, route, SMOOTH)
    assert crossing.stays
    assert crossing.exit_time == pytest.approx(4.0 / 3.0 + 2.0 * 4.0 / 3.0)
    method = kind(integration=Modal(f_max=90.0, dt=0.005), damping=ModalRatio(ratio=0.05))
    runs = ensemble(
        floor, crossing, method=method, points={"mid": MID}, n_runs=1, seed=1, duration=20.0
    )
    assert runs.coverage.left
    static = sum(
        point_load_deflection(floor, (x, Y), force=f, points={"mid": MID})["mid"]
        for x, f in zip((STOP, STOP - 3.0), vehicle.static_forces, strict=True)
    )
    assert runs.displacement[0, -1, 0] == pytest.approx(static, rel=2e-3)


def test_a_standing_start_leaves_the_floor_as_it_was():
    """From rest on the floor off it: equilibrium at first, and no sag at the end."""
    flat = replace(van(), bodies=(Body(mass=2000.0, pitch_inertia=2500.0, centre=1.2),))
    floor, vehicle = small_floor(), flat.build()  # its mass lies low: it does not pitch
    law = SpeedOverTime.over_stations([0.0, 3.0, 40.0], [0.0, 4.0, 4.0])
    route = Route(points=np.array([[1.0, Y], [12.0, Y]]), law=law)
    crossing = Crossing(vehicle, route, SMOOTH, entry=StaticStart(exit_length=1.0))
    method = Coupled(integration=Modal(f_max=90.0, dt=0.005), damping=ModalRatio(ratio=0.05))
    runs = ensemble(
        floor, crossing, method=method, points={"mid": MID}, n_runs=1, seed=1, duration=25.0
    )
    sag = runs.displacement[0, :, 0]
    assert abs(sag[-1]) < 2e-3 * abs(sag[0])
    assert np.abs(runs.velocity[0, :3, 0]).max() < 0.02 * np.abs(runs.velocity[0, :, 0]).max()


def test_a_stop_behind_the_end_is_refused():
    """Half of it would stand on nothing."""
    law = SpeedOverTime.over_stations([0.0, 13.0], [3.0, 0.0])
    route = Route(points=np.array([[0.0, Y], [12.0, Y]]), law=law)
    with pytest.raises(InputError, match="1 m behind the route's end"):
        Crossing(van().build(), route, SMOOTH)


def test_a_vehicle_driving_backwards_is_its_mirror_image():
    """A two-axle van in reverse presses as one built the other way round, on any road."""
    route = Route.straight((0, 0), (40, 0), speed=3.0)
    back = Route(points=route.points, law=route.law, reverse=True)
    turned = replace(
        van(),
        bodies=(Body(mass=2000.0, pitch_inertia=2500.0, centre=1.8, height=0.9),),
    )
    _, found, _ = forces_of(van().build(), back, RoadClass("C"))
    _, expected, _ = forces_of(turned.build(), route, RoadClass("C"))
    np.testing.assert_allclose(found[0][:, ::-1], expected[0], rtol=1e-8)


def test_braking_backwards_loads_the_axle_that_leads():
    """The mirror image of a van that brakes forwards; m a h / wheelbase goes to the leading axle."""
    law = SpeedOverTime(time=np.array([0.0, 2.0, 8.0]), value=np.array([4.0, 4.0, 1.0]))
    ahead = Route(points=np.array([[0.0, 0.0], [40.0, 0.0]]), law=law)
    back = replace(ahead, reverse=True)
    turned = replace(
        van(),
        bodies=(Body(mass=2000.0, pitch_inertia=2500.0, centre=1.8, height=0.9),),
    )
    time, found, _ = forces_of(van().build(), back)
    _, expected, _ = forces_of(turned.build(), ahead)
    np.testing.assert_allclose(found[0][:, 1::-1], expected[0][:, :2], rtol=1e-8)
    settled = (time > 5.0) & (time < 7.5)
    moved = found[0][settled, 1] - 2000.0 * GRAVITY * 1.2 / 3.0
    np.testing.assert_allclose(moved, 2000.0 * 0.5 * 0.9 / 3.0, rtol=1e-3)


def test_a_passage_put_off_is_the_same_passage():
    """In reverse, braking, with an engine: the same vehicle to the bit, its forces a second later."""
    law = SpeedOverTime(time=np.array([0.0, 2.0, 4.0]), value=np.array([3.0, 3.0, 2.0]))
    ahead = Route.straight((0, 0), (12, 0), speed=3.0)
    route = Route(points=ahead.points, law=law, reverse=True)
    shaken = van(
        forces=(BodyForce(name="engine", amplitude=300.0, frequency=20.0, body=0),)
    ).build()
    first = Passage(crossing=Crossing(shaken, route, SMOOTH, run_in=0.0))
    late = first.later(0.5).later(0.5)
    assert late.contact_names == first.contact_names
    for name in ("contact_map", "setback", "static_forces"):
        found, expected = (getattr(one.oscillator, name) for one in (late, first))
        np.testing.assert_array_equal(found, expected)
    time = np.linspace(0.0, 6.0, 201)
    now, then = first.track(time, 0.0), late.track(time + 1.0, 1.0)
    np.testing.assert_allclose(then.place, now.place, atol=1e-12)
    assert late.crossing.driven.inner == first.crossing.driven.inner == 2


def test_wheels_are_as_fast_as_their_places_move():
    """Round a bend, pulled and on the path: |dx/dt| of every wheel, by differences."""
    law = SpeedOverTime(time=np.array([0.0, 2.0, 6.0]), value=np.array([2.0, 2.0, 1.0]))
    points = np.array([[0.0, 0.0], [15.0, 0.0], [15.0, 20.0]])
    wide = describe("van_vw_vanagon").widened(1.5).build()
    for steering in ("path", "tractrix"):
        route = Route(points=points, law=law, radius=5.0, steering=steering)
        passage = Passage(crossing=Crossing(wide, route, SMOOTH, run_in=0.0))
        time, h = np.linspace(4.003, 12.0, 321), 1e-5
        ahead, back = (passage.track(time + x, 0.0).place for x in (h, -h))
        moved = np.linalg.norm(ahead - back, axis=2) / (2 * h)
        np.testing.assert_allclose(passage.track(time, 0.0).speed, moved, atol=1e-4)


def test_an_inner_force_is_felt_through_the_wheels_alone():
    """What the floor does under an engine is what it does under the wheels' forces, and no more."""
    floor = small_floor()
    shaken = van(forces=(BodyForce(amplitude=200.0, frequency=6.0, setback=1.5),)).build()
    crossing = Crossing(shaken, Route.straight((0, Y), (12, Y), speed=3.0), SMOOTH)
    method = Decoupled(integration=Modal(f_max=90.0, dt=0.005), damping=ModalRatio(ratio=0.05))
    prepared = prepare(floor, method.integration, method.damping)
    layout = lay_out(prepared, crossing, method=method, points={"a": MID}, duration=9.0)
    rows, _ = layout.rows.window(0, layout.rows.n_steps)
    weights = np.abs(rows.value).reshape(layout.rows.n_steps, 3, -1).sum(axis=2)
    assert weights[:, 2].max() == 0.0
    assert weights[:, :2].max() > 0.5


def test_wheels_beside_a_sharp_corner_are_refused():
    """They would jump; with a radius, or on the line, they do not."""
    points = np.array([[0.0, 3.0], [9.0, 3.0], [9.0, 6.0]])
    law = SpeedOverTime(time=np.array([0.0, 1.0]), value=np.array([2.0, 2.0]))
    wide = describe("van_vw_vanagon").widened(1.5).build()
    with pytest.raises(InputError, match=r"0.75 m beside its line would jump"):
        Crossing(wide, Route(points=points, law=law), RoadClass("B"))
    Crossing(wide, Route(points=points, law=law, radius=2.5), RoadClass("B"))
    Crossing(van().build(), Route(points=points, law=law), RoadClass("B"))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: BodyForce(amplitude=1.0), "a frequency of its own, or an order"),
        (lambda: BodyForce(amplitude=1.0, frequency=2.0, order=1.0, radius=0.3), "a frequency"),
        (lambda: BodyForce(amplitude=1.0, order=2.0), "radius of the"),
        (lambda: OutOfRound(amplitude=1e-3, radius=0.3, order=0), "order must be a whole number"),
        (lambda: van(forces=(BodyForce(amplitude=1.0, frequency=2.0, body=3),)).build(), "0 to 0"),
    ],
)
def test_what_cannot_be_is_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_an_axle_out_of_round_is_both_its_wheels():
    """Axle 2 of a vehicle on four wheels, and no other; one that is not there is refused."""
    wide = van(rounds=(OutOfRound(amplitude=1e-3, radius=0.35, axle=1),)).widened(1.5)
    _, forces, _ = forces_of(wide.build(), Route.straight((0, 0), (60, 0), speed=5.0), run_in=9.0)
    shaken = forces[0].std(axis=0)
    np.testing.assert_allclose(shaken[2], shaken[3], rtol=1e-6)
    assert shaken[2] > 1.5 * shaken[0]
    with pytest.raises(InputError, match="has no axle 3 to be out of round"):
        van(rounds=(OutOfRound(amplitude=1e-3, radius=0.35, axle=2),)).build()


def test_wheels_that_turn_too_fast_once_they_have_sped_up_are_refused():
    """Lugs of order 12 on 0.4 m from 2 to 22 m/s over 120 m: 9.5 Hz at first, 105 Hz in the end.

    v^2 = 4 + 2 x 2 x 120 = 22^2. Steps of 10 ms show 40 Hz; those of 3.8 ms are enough. The same
    speeds over time are refused alike, and a route that ends before 40 Hz is not: 8.4 m/s.
    """
    shaken = van(rounds=(OutOfRound(amplitude=1e-4, radius=0.4, order=12, axle=0),)).build()
    over_time = SpeedOverTime(time=np.array([0.0, 10.0]), value=np.array([2.0, 22.0]))
    steady, start = SteadyAcceleration(initial=2.0, acceleration=2.0), Abrupt()

    def passage(length, law):
        route = replace(Route.straight((0, 0), (length, 0), speed=2.0), law=law)
        return Passage(crossing=Crossing(shaken, route, SMOOTH, entry=start))

    for law in (over_time, steady):
        with pytest.raises(InputError, match=r"out_of_round shakes at 105 Hz.*dt to 3.8 ms"):
            passage(120.0 - shaken.length, law).check(0.01, None)
    short = passage(10.0, steady)
    assert short.crossing.fastest == pytest.approx(np.sqrt(4.0 + 4.0 * (10.0 + shaken.length)))
    short.check(0.01, None)


def test_what_shakes_faster_than_a_step_shows_is_refused():
    """At 199 Hz steps of 5 ms would show 1 Hz; with the step that would show it."""
    floor, method = small_floor(), Decoupled(integration=Modal(f_max=60.0, dt=0.005))
    for extra in (
        {"forces": (BodyForce(amplitude=9.0, frequency=199.0),)},
        {"rounds": (OutOfRound(amplitude=1e-3, radius=0.05, order=100),)},
    ):
        crossing = Crossing(
            van(**extra).build(), Route.straight((0, Y), (12, Y), speed=4.0), SMOOTH
        )
        with pytest.raises(InputError, match="80 Hz at most: shorten dt to"):
            ensemble(floor, crossing, method=method, points={"a": MID}, n_runs=1, seed=1)


def test_lifting_off_is_told_of_wheels_alone():
    """An engine's force is negative half of the time, and lifts nothing off the ground."""
    floor = small_floor()
    vehicle = van(forces=(BodyForce(amplitude=50.0, frequency=7.0, setback=0.5),)).build()
    crossing = Crossing(vehicle, Route.straight((0, Y), (12, Y), speed=4.0), SMOOTH)
    method = Decoupled(integration=Modal(f_max=90.0, dt=0.005), damping=ModalRatio(ratio=0.05))
    runs = ensemble(floor, crossing, method=method, points={"a": MID}, n_runs=1, seed=1)
    assert not any("pull on the floor" in one.message for one in runs.warnings)
    assert runs.contact_names == ("axle 1", "axle 2", "engine, inside")
    assert runs.contact_forces[0, :, 2].max() == 0.0
    assert runs.velocity[0].std() > 0.0
    assert vehicle.total_mass == pytest.approx(2000.0)
    assert vehicle.static_forces.sum() == pytest.approx(2000.0 * GRAVITY)
