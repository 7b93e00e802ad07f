"""Given profiles under moving wheels: where they lie, how they start, what a step sees of them."""

import dataclasses

import numpy as np
import pytest
from scipy import integrate

from models import small_floor
from trundle.errors import InputError
from trundle.road import Profile, RoadClass, RoughnessBand, synthesise
from trundle.route import DriveIn, Route, SteadyAcceleration
from trundle.simulate import Coupled, Crossing, Decoupled, Modal, contact_forces, ensemble
from trundle.simulate.sources.given_road import given_road, given_road_doubts
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.simulate.wheels.timeline import timeline_of
from trundle.units import KMH
from trundle.vehicle import container_truck_40ft, quarter_car, sprung_mass

DT = 0.005  # production's
HEAVY = {"mass": 1e12, "stiffness": 1e6, "damping": 2e4}  # so heavy that it stands still


def way(road, *, vehicle=None, speed=15 * KMH, run_in=0.0, length=52.0, **more):
    return Crossing(
        vehicle=vehicle or container_truck_40ft(),
        route=Route.straight((0.0, 0.0), (length, 0.0), speed=speed),
        road=road, run_in=run_in, entry=DriveIn(length=2.0), **more,
    )  # fmt: skip


def forces(crossing, *, dt=DT, duration=8.0):
    """Return times and dynamic contact forces."""
    time, out = contact_forces(
        crossing, integration=Modal(f_max=90.0, dt=dt), n_runs=1, seed=1, duration=duration
    )
    return time, out[0] - crossing.vehicle.static_forces


def rough(first=-120.0, *, length=300.0, seed=3):
    road = synthesise(RoadClass("B"), length=length, rng=np.random.default_rng(seed))
    return Profile.from_samples(road.station + first, road.elevation)


def waves(*, wave, height, low=-80.0, high=120.0, grade=0.0, level=0.0):
    s, n = np.arange(low, high, 0.01), 2 * np.pi / wave
    return Profile(
        station=s, elevation=level + grade * s + height * np.sin(n * s),
        slope=grade + n * height * np.cos(n * s),
    )  # fmt: skip


@pytest.mark.parametrize("run_in", [None, 0.0])
def test_a_profile_in_its_own_chainage_is_refused_until_it_is_laid(run_in):
    """A survey from 478 m on has no station 0; by its chainage or moved it is the same road."""
    surveyed = rough(478.0)
    with pytest.raises(InputError, match=r"covers stations 478 to 778.*need.*chainage=.*moved\("):
        forces(way(surveyed, run_in=run_in))
    _, by_chainage = forces(way(surveyed, run_in=run_in, chainage=598.0))
    _, moved = forces(way(surveyed.moved(-598.0), run_in=run_in))
    _, laid = forces(way(rough(-120.0), run_in=run_in))
    assert laid.std(axis=0).min() > 1e3
    np.testing.assert_allclose(by_chainage, laid, atol=1e-4)
    np.testing.assert_allclose(moved, laid, atol=1e-4)


def test_what_the_message_offers_is_enough():
    """The least and the greatest chainage named, and the run-in named, are taken."""
    surveyed = rough(478.0)  # to 778 m; the truck is 12.5 m long
    with pytest.raises(InputError, match=r"chainage=\) from 540.92 to 713.50 m"):
        forces(way(surveyed, run_in=None), duration=20.0)
    for chainage in (540.92, 713.50):
        forces(way(surveyed, run_in=None, chainage=chainage), duration=20.0)
    short = rough(-30.0, length=96.0)
    with pytest.raises(InputError, match=r"shorten the run-in to run_in=17.4 m"):
        forces(way(short, run_in=None), duration=20.0)
    forces(way(short, run_in=17.4), duration=20.0)


@pytest.mark.parametrize(("low", "high"), [(-12.4, 120.0), (-80.0, 64.4)])
def test_a_profile_that_ends_under_the_vehicle_is_refused(low, high):
    """12.5 m of truck before the start, and behind the end of 52 m until its last axle has left."""
    with pytest.raises(InputError, match="but the wheels need"):
        forces(way(waves(wave=2.0, height=0.002, low=low, high=high)), duration=20.0)
    forces(way(waves(wave=2.0, height=0.002, low=-12.6, high=64.6)), duration=20.0)


def test_a_floor_is_not_prepared_for_a_profile_that_does_not_cover():
    with pytest.raises(InputError, match="covers stations"):
        ensemble(
            small_floor(mesh_size=2.0), way(rough(478.0), length=12.0), method=Coupled(), seed=0,
            points={"far off the floor": (1e6, 0.0)}, n_runs=1,
        )  # fmt: skip


def test_a_random_road_has_no_chainage():
    with pytest.raises(InputError, match="with a random road"):
        way(RoadClass("B"), chainage=478.0)


@pytest.mark.parametrize("run_in", [None, 0.0, 3.0])
@pytest.mark.parametrize("grade", [0.03, -0.12])
def test_a_steady_slope_adds_nothing(run_in, grade):
    """At constant speed on a plane nothing is accelerated: static forces, from the first step on.

    583 m above the sea too, where a spring's force on the elevation is 8e8 N.
    """
    s = np.linspace(-100.0, 120.0, 23)
    hill = Profile.piecewise_linear(s, 583.0 + grade * s)
    for vehicle in (container_truck_40ft(), sprung_mass(mass=5e3, stiffness=1e6, damping=2e4)):
        _, dynamic = forces(way(hill, run_in=run_in, vehicle=vehicle))
        assert np.abs(dynamic).max() < 1e-5 * vehicle.static_forces.min()


def test_waves_on_a_hill_are_waves_on_a_plain():
    """A plane is a motion without spring forces; the starts differ by the same plane."""
    plain = forces(way(waves(wave=3.0, height=0.004)))[1]
    hill = forces(way(waves(wave=3.0, height=0.004, grade=0.05, level=583.0)))[1]
    np.testing.assert_allclose(hill, plain, atol=1e-6 * np.abs(plain).max())


def test_a_start_on_a_slope_goes_on_as_if_the_vehicle_had_come_along_it():
    """A hill that has lasted for a while, then waves: the same from a start far before."""
    s = np.arange(-100.0, 120.0, 0.01)
    ahead = np.maximum(s - 5.0, 0.0)
    shape = 0.004 * np.sin(2 * ahead) ** 3  # zero, slope and curvature zero, up to 5 m
    gradient = 0.024 * np.sin(2 * ahead) ** 2 * np.cos(2 * ahead)
    hill = Profile(station=s, elevation=0.04 * s + shape, slope=0.04 + gradient)
    short, long = (forces(way(hill, run_in=run_in))[1] for run_in in (0.0, 60.0))
    np.testing.assert_allclose(short, long, atol=1e-6 * np.abs(long).max())


def test_an_accelerating_vehicle_starts_level():
    """A ramp ahead of a level start does not tilt the start."""
    ramp = Profile.piecewise_linear([-60.0, 4.0, 6.0, 90.0], [0.0, 0.0, 0.03, 0.03])
    crossing = way(ramp)
    law = SteadyAcceleration(initial=4.0, acceleration=0.5)
    crossing = dataclasses.replace(
        crossing, route=Route(points=crossing.route.points, law=law), run_in=0.0
    )
    time, dynamic = forces(crossing, duration=1.5)
    first = time < law.time_to(4.0) - 2 * DT
    assert np.abs(dynamic[first]).max() < 30.0  # what filters at 5 ms ring before the ramp, of 5 kN
    assert np.abs(dynamic).max() > 4e3


@pytest.mark.parametrize("patch", [0.0625, 0.125, 0.25])
def test_a_tyre_averages_a_given_profile(patch):
    """Forces times sin(pi a / L) / (pi a / L): 0.637 for half a wave, none for a whole one."""
    road = waves(wave=0.25, height=0.002)
    point, averaged = (
        forces(way(road, band=RoughnessBand(contact_patch=a), run_in=8.0))[1].std(axis=0)
        for a in (0.0, patch)
    )
    assert averaged == pytest.approx(np.sinc(patch / 0.25) * point, rel=1e-3, abs=0.5)


def test_a_held_wheel_feels_elevation_and_slope():
    """k z + c V dz/ds at every sample off the kinks of a ramp; at a kink between its two sides."""
    k, c, speed = HEAVY["stiffness"], HEAVY["damping"], 4.0
    road = Profile.piecewise_linear([-20.0, 3.005, 3.505, 90.0], [0.0, 0.0, 0.02, 0.02])
    time, dynamic = forces(way(road, vehicle=sprung_mass(**HEAVY), speed=speed), duration=2.0)
    s = speed * time
    on_ramp = (s > 3.005) & (s < 3.505)
    expected = k * np.interp(s, [3.005, 3.505], [0.0, 0.02]) + c * speed * 0.04 * on_ramp
    away = np.min(np.abs(s[:, None] - [3.005, 3.505]), axis=1) > 0.5 * speed * DT
    np.testing.assert_allclose(dynamic[away, 0], expected[away], atol=0.5)
    assert np.all((dynamic[~away, 0] > -1.0) & (dynamic[~away, 0] < 2e4 + 3.2e3 + 1.0))


@pytest.mark.parametrize("chamfer", [1e-6, 1e-3, 0.015, 0.1])
@pytest.mark.parametrize("at", [3.0, 3.0017, 3.011])
def test_a_jump_gives_its_damper_the_whole_impulse(at, chamfer):
    """c dz whatever lies between two steps: the sum of c V dz/ds dt is c times the height gained."""
    c, rise = HEAVY["damping"], 0.02
    heavy = sprung_mass(**(HEAVY | {"stiffness": 1e-3}))
    road = Profile.piecewise_linear([-20.0, at, at + chamfer, 90.0], [0.0, 0.0, rise, rise])
    _, dynamic = forces(way(road, vehicle=heavy, speed=4.0), duration=2.0)
    # the mass gains c dz / m = 4e-10 m/s, of which its damper feels nothing
    assert dynamic.sum() * DT == pytest.approx(c * rise, rel=1e-4)


@pytest.mark.parametrize(("x", "left"), [(0.1, 0.9999), (0.2, 0.998), (0.4, 0.92)])
def test_a_polygon_of_short_sides_keeps_its_waves(x, left):
    """A wave of x waves a step, 20, 40 and 80 Hz at 5 ms, by points 16 a wave.

    Its straight sides keep sinc^2(1/16) of its slope, and make other waves of 15 and 17 sides,
    1/16^2 of it; a mean over each step alone would keep 0.984, 0.935 and 0.757 of that.
    """
    speed, height = 10.0, 0.001
    wave = speed * DT / x
    s = np.arange(-20.0, 80.0, wave / 16)
    road = Profile.piecewise_linear(s, height * np.sin(2 * np.pi * s / wave))
    crossing = way(road, vehicle=sprung_mass(**HEAVY), speed=speed, length=60.0)
    timeline = timeline_of(as_sources(crossing), DT, 5.0)
    slope = given_road(crossing, crossing.along(timeline.time, timeline.begins[0])).slope[:, 0]
    turn = np.exp(-2j * np.pi * x * np.arange(len(slope)))[:1000]
    kept = 2 * np.abs(np.mean(slope[:1000] * turn)) / (2 * np.pi * height / wave)
    assert kept == pytest.approx(left * np.sinc(1 / 16) ** 2, rel=0.006)


def test_a_joint_gives_a_mass_its_velocity():
    """A lip of 1 mm, 1 mm long: m dv = c dz at once, then free decay, by a general ODE solver."""
    m, k, c, speed, at = 5e3, 1e5, 2e4, 4.0, 3.004
    road = Profile.piecewise_linear([-20.0, at, at + 1e-3, 90.0], [0.0, 0.0, 1e-3, 1e-3])
    vehicle = sprung_mass(mass=m, stiffness=k, damping=c)
    time, dynamic = forces(way(road, vehicle=vehicle, speed=speed), duration=2.0)
    velocity = (
        (np.cumsum(dynamic[:, 0]) - dynamic[:, 0] / 2) * DT / m
    )  # the force on the ground is that on the mass
    start = (at + 5e-4) / speed
    exact = integrate.solve_ivp(
        lambda _, y: [y[1], (k * (1e-3 - y[0]) - c * y[1]) / m], (start, 2.0), [0.0, c * 1e-3 / m],
        t_eval=time[time > start + 3 * DT], rtol=1e-10, atol=1e-14,
    ).y[1]  # fmt: skip
    late = time > start + 3 * DT
    np.testing.assert_allclose(velocity[late], exact, atol=0.02 * c * 1e-3 / m)


def bump(at, *, length=0.05, height=0.02):
    """A bump of sin^2 on a level road."""
    s = np.linspace(0.0, length, 26)
    n = np.pi / length
    return Profile(
        station=np.r_[-60.0, at + s, 90.0],
        elevation=np.r_[0.0, height * np.sin(n * s) ** 2, 0.0],
        slope=np.r_[0.0, n * height * np.sin(2 * n * s), 0.0],
    )


@pytest.mark.parametrize("at", [6.0, 6.02, 6.035])
def test_a_bump_between_two_steps_is_refused(at):
    """5 cm long and 20 mm high at 40 km/h, where a wheel moves 56 mm in 5 ms; 0.25 ms shows it.

    The bump lasts 4.5 ms; the sample nearest its peak is within sin^2(pi / 36) = 0.8 % of it.
    """
    fast = {"speed": 40 * KMH, "length": 12.0}
    with pytest.raises(InputError, match=r"near station 6.0.*unseen.*time step to 1.25 ms.*patch"):
        forces(way(bump(at), **fast))
    coarse, fine = (forces(way(bump(at), **fast), dt=dt, duration=1.5)[1] for dt in (2.5e-4, 5e-5))
    assert coarse.max() == pytest.approx(fine.max(), rel=0.015)


def test_a_tyre_makes_a_step_one_that_5_ms_can_show():
    """A kerb of 20 mm at 40 km/h: refused on a point, taken on 0.3 m, chamfers named."""
    kerb = Profile.piecewise_linear([-60.0, 6.0, 6.001, 90.0], [0.0, 0.0, 0.02, 0.02])
    with pytest.raises(InputError, match="by its chamfer, or let the tyre average"):
        forces(way(kerb, speed=40 * KMH))
    forces(way(kerb, speed=40 * KMH, band=RoughnessBand(contact_patch=0.3)), duration=3.0)


@pytest.mark.parametrize("name", ["A", "D"])
def test_a_road_that_may_be_drawn_may_be_given(name):
    """Waves up to half a wave a step are taken from a class; so they are from a profile."""
    speed = 40 * KMH
    band = RoughnessBand(n_max=0.45 / (speed * DT))
    road = synthesise(
        RoadClass(name), length=200.0, rng=np.random.default_rng(2), band=band, start=-80.0
    )
    forces(way(road, speed=speed), duration=3.0)


def test_texture_finer_than_a_step_is_refused():
    """0.1 mm every millimetre is low but steep: samples of its slope are waves that are not there.

    A contact patch averages it away: forces are those of the road without texture, within 1 %.
    """
    s = np.arange(-20.0, 80.0, 0.001)
    rng = np.random.default_rng(6)
    smooth = np.interp(s, *_points(rough(-30.0, length=130.0)))
    texture = Profile.from_samples(s, smooth + 1e-4 * rng.standard_normal(len(s)))
    with pytest.raises(InputError, match=r"unseen between two steps.*contact_patch"):
        forces(way(texture))
    patch = RoughnessBand(contact_patch=0.15)
    with_texture, without = (
        forces(way(road, band=patch))[1] for road in (texture, Profile.from_samples(s, smooth))
    )
    assert (with_texture - without).std() < 0.01 * without.std()


def _points(profile):
    return profile.station, profile.elevation


def test_what_a_step_hides_is_doubted():
    """A bump of 1 mm, some 1 % of a wheel's force: said in the result, at 0.5 ms no longer."""
    low = bump(6.0, height=0.001)
    crossing = way(low, speed=40 * KMH, length=12.0)
    (doubt,) = given_road_doubts((crossing,), DT)
    assert "near station 6.0" in doubt.message
    assert given_road_doubts((crossing,), 5e-4) == ()
    crossing = dataclasses.replace(crossing, route=Route.straight((0, 2.6), (12, 2.6), speed=11.0))
    runs = ensemble(
        small_floor(mesh_size=2.0), crossing, method=Decoupled(integration=Modal(f_max=40.0, dt=DT)),
        points={"p": (6.0, 3.0)}, n_runs=1, seed=0, duration=2.0,
    )  # fmt: skip
    assert doubt.subject in {w.subject for w in runs.warnings}


@pytest.mark.parametrize("beyond", ["level", "mirror"])
def test_a_named_choice_extends_a_profile(beyond):
    """Level at the height of the end, or its mirror image: as read by the profile itself.

    A held wheel feels them but for the plane that it starts on, whose grade is that of its way.
    """
    speed, run_in = 4.0, 4.0
    k, c = HEAVY["stiffness"], HEAVY["damping"]
    road = dataclasses.replace(rough(0.0, length=30.0), beyond=beyond)
    crossing = way(road, vehicle=sprung_mass(**HEAVY), run_in=run_in, speed=speed)
    time, dynamic = forces(crossing, duration=10.0)
    s = speed * time
    (z, slope), (z0, _) = road.at(s), road.at(-run_in)
    felt = k * (z - z0) + c * speed * slope
    off = (s > 0.05) & (np.abs(s - road.station[-1]) > 0.05)  # kinks of the level road
    tilt = k * (s + run_in) + c * speed
    grade = np.linalg.lstsq(tilt[off, None], (felt - dynamic[:, 0])[off], rcond=None)[0][0]
    assert (grade == pytest.approx(0.0, abs=1e-7)) == (beyond == "level")
    np.testing.assert_allclose((dynamic[:, 0] + grade * tilt)[off], felt[off], atol=1.0)


def test_the_road_beside_random_ones_is_the_same():
    """Exact statistics lay a given profile beside waves; it is the road that runs drive over."""
    crossing = way(rough(-120.0), band=RoughnessBand(contact_patch=0.2))
    timeline = timeline_of(as_sources(crossing), DT, 5.0)
    both = roads_under_wheels(as_sources(crossing), timeline, range(2), 0, smooth=1)
    given = given_road(crossing, crossing.along(timeline.time, timeline.begins[0]))
    for run in range(3):
        np.testing.assert_array_equal(both.push[..., run], both.push[..., 0])
        np.testing.assert_array_equal(both.start[:, run], given.elevation[0])


def test_vehicles_that_cannot_tilt_start_at_rest():
    """A quarter car rides a plane; two axles on one body without pitch do not."""
    s = np.linspace(-100.0, 120.0, 23)
    car = quarter_car(
        body_mass=4000.0, axle_mass=400.0, stiffness=4e5, damping=8e3, tyre_stiffness=2e6,
        tyre_damping=1e3,
    )  # fmt: skip
    hill = Profile.piecewise_linear(s, 0.05 * s)
    _, dynamic = forces(way(hill, vehicle=car))
    assert np.abs(dynamic).max() < 1e-5 * car.static_forces.min()
    stiff = dataclasses.replace(
        car, contact_map=np.repeat(car.contact_map, 2, axis=0), setback=np.array([0.0, 3.0]),
        contact_stiffness=np.full(2, 1e6), contact_damping=np.full(2, 5e2),
        static_forces=np.repeat(car.static_forces / 2, 2), lateral=np.zeros(2),
        contact_names=("front", "rear"),
    )  # fmt: skip
    _, dynamic = forces(way(hill, vehicle=stiff))
    # held level, front and rear stand 0.15 m apart in height: springs in series, at the end
    assert np.diff(dynamic[-1]) == pytest.approx(-0.15 * 1e6, rel=1e-3)
