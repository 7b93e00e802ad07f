"""Vehicles that lift off, rub or hit stops, against integrations of their own equations."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate

from models import small_floor
from trundle.dynamics import ModalRatio, Rayleigh
from trundle.errors import InputError
from trundle.road import CosineHump, Feature, FeaturedRoad, Profile, RoadClass, Tread
from trundle.route import Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    Newmark,
    contact_forces,
    ensemble,
)
from trundle.vehicle import GRAVITY, Axle, Body, Description, Friction, Stop

STEP = Newmark(dt=0.001)
M, MU, K, C, KT, CT = 4000.0, 500.0, 2.5e5, 8e3, 2e6, 2e3
SPEED, PATCH = 6.0, 0.2


def quarter(**more):
    axle = Axle(body=0, setback=0.0, stiffness=K, damping=C, axle_mass=MU, tyre_stiffness=KT,
                tyre_damping=CT)  # fmt: skip
    return Description(
        name="quarter", bodies=(Body(mass=M),), axles=(axle,), contact_patch=PATCH, **more
    )


def hump(height=0.08, length=1.2):
    feature = Feature(shape=CosineHump(length=length, height=height), station=4.0)
    return FeaturedRoad(base=Profile.smooth(), features=(feature,))


def driven(vehicle, road, integration=STEP, duration=2.5):
    crossing = Crossing(vehicle, Route.straight((0, 0), (30, 0), speed=SPEED), road, run_in=1.0)
    time, forces = contact_forces(
        crossing, integration=integration, n_runs=1, seed=1, duration=duration
    )
    return time, forces[0], crossing


def own(time, road, force_on_body, *, lifts, memory=0):
    """Integrate the two masses with a law between them: (z, zw, vz, vw, whatever it remembers)."""
    stations = np.linspace(0.0, 30.0, 60001)
    heights, slopes = road.under(0.0, Tread()).averaged(PATCH).at(stations)
    weight = (M + MU) * GRAVITY

    def tyre(t, y):
        z, g = (np.interp(SPEED * t, stations, values) for values in (heights, slopes))
        force = weight + KT * (z - y[1]) + CT * (SPEED * g - y[3])
        return max(force, 0.0) if lifts else force

    def rate(t, y):
        law, change = force_on_body(y)
        spring = -K * (y[0] - y[1]) - C * (y[2] - y[3]) + law
        return [y[2], y[3], spring / M, (tyre(t, y) - weight - spring) / MU, *change]

    found = integrate.solve_ivp(
        rate, (0.0, time[-1]), np.zeros(4 + memory), t_eval=time, max_step=5e-4, rtol=1e-8,
        atol=1e-10,
    )  # fmt: skip
    return np.array([tyre(t, y) for t, y in zip(time, found.y.T, strict=True)]), found.y


def test_a_wheel_that_is_thrown_up_lifts_off_and_lands():
    """Over 16 cm at 6 m/s it is in the air for a while; force and time in the air as by an ODE."""
    time, forces, _ = driven(quarter(lifts_off=True).build(), hump(0.16, 1.0))
    expected, _ = own(time, hump(0.16, 1.0), lambda y: (0.0, []), lifts=True)
    found = forces[:, 0]
    assert found.min() == 0.0
    assert np.mean(found == 0.0) == pytest.approx(np.mean(expected == 0.0), abs=2e-3)
    assert np.sum(expected == 0.0) > 20
    assert np.abs(found - expected).max() < 0.02 * expected.max()
    linear = driven(quarter().build(), hump(0.16, 1.0))[1][:, 0]
    assert linear.min() < -0.3 * GRAVITY * (M + MU)  # the linear one would have pulled


@pytest.mark.parametrize("slip", [2e3, 8e3])
@pytest.mark.longest
def test_leaves_that_rub_follow_jenkins_element(slip):
    """Rate form: the force changes by -k v while it sticks, and stays at the slip force."""
    stiffness = 3e6
    vehicle = quarter(laws=(Friction(axle=0, force=slip, stiffness=stiffness),)).build()
    time, forces, _ = driven(vehicle, hump(0.03))

    def rubs(y):
        pushes = -stiffness * (y[2] - y[3])
        held = (y[4] >= slip and pushes > 0.0) or (y[4] <= -slip and pushes < 0.0)
        return np.clip(y[4], -slip, slip), [0.0 if held else pushes]

    expected, _ = own(time, hump(0.03), rubs, lifts=False, memory=1)
    dynamic = expected - expected[0]
    assert np.abs(forces[:, 0] - expected).max() < 0.02 * np.abs(dynamic).max()
    # friction is no small matter here: without it the force differs by much more
    linear = driven(quarter().build(), hump(0.03))[1][:, 0]
    assert np.abs(linear - expected).max() > 0.08 * np.abs(dynamic).max()


def test_a_stop_behind_a_gap_is_hit():
    """Compressed by more than 15 mm the suspension is ten times as stiff."""
    vehicle = quarter(laws=(Stop(axle=0, gap=0.015, stiffness=10 * K),)).build()
    time, forces, _ = driven(vehicle, hump(0.05))

    def stops(y):
        return 10 * K * max(y[1] - y[0] - 0.015, 0.0), []

    expected, states = own(time, hump(0.05), stops, lifts=False)
    assert (states[1] - states[0]).max() > 0.016
    dynamic = expected - expected[0]
    assert np.abs(forces[:, 0] - expected).max() < 0.02 * np.abs(dynamic).max()


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
def test_laws_that_never_act_change_nothing(kind):
    """A stop out of reach, and wheels that stay down: the linear run, to the solver's tolerance."""
    floor = small_floor()
    laws = (Stop(axle=0, gap=1.0, stiffness=1e6),)
    method = kind(integration=Newmark(dt=0.005), damping=Rayleigh(alpha=0.3, beta=2e-4))
    route = Route.straight((0, 3), (12, 3), speed=3.0)
    runs = [
        ensemble(
            floor, Crossing(one.build(), route, RoadClass("B")), method=method,
            points={"a": (4.0, 3.0)}, n_runs=3, seed=1,
        )
        for one in (quarter(), quarter(laws=laws, lifts_off=True))
    ]  # fmt: skip
    scale = np.abs(runs[0].velocity).max()
    np.testing.assert_allclose(runs[1].velocity, runs[0].velocity, atol=1e-7 * scale)
    assert any("not linear" in one.message for one in runs[1].warnings)


@pytest.mark.longest
def test_on_a_stiff_floor_a_coupled_vehicle_lifts_off_as_on_the_ground():
    """A floor of a thousand times the stiffness and mass: the forces of rigid ground."""
    vehicle = quarter(lifts_off=True).build()
    route = Route.straight((0, 3), (12, 3), speed=SPEED)
    road = hump(0.16, 1.0)
    heavy = small_floor()
    from trundle.structure import CONCRETE

    rock = replace(
        CONCRETE, elastic_modulus=1e4 * CONCRETE.elastic_modulus, density=1e3 * CONCRETE.density
    )
    from models import small_plan
    from trundle.structure import ShellSection, build_floor

    heavy = build_floor(
        small_plan(slab=ShellSection(thickness=0.2, material=rock), material=rock), mesh_size=1.5
    )
    found = []
    for kind in (Decoupled, Coupled):
        method = kind(integration=Newmark(dt=0.002), damping=Rayleigh(alpha=0.3, beta=2e-4))
        runs = ensemble(
            heavy, Crossing(vehicle, route, road, run_in=1.0), method=method,
            points={"a": (4.0, 3.0)}, n_runs=1, seed=1,
        )  # fmt: skip
        found.append(runs.contact_forces[0, :, 0])
    assert found[0].min() == 0.0
    np.testing.assert_allclose(found[1], found[0], atol=2e-3 * found[0].max())


def test_exact_steps_refuse_what_is_not_linear():
    """By name, with the method that takes it."""
    vehicle = quarter(lifts_off=True).build()
    crossing = Crossing(vehicle, Route.straight((0, 3), (12, 3), speed=3.0), RoadClass("B"))
    method = Coupled(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=0.03))
    with pytest.raises(InputError, match="run by run with Newmark's method alone"):
        ensemble(small_floor(), crossing, method=method, points={"a": (4.0, 3.0)}, n_runs=1, seed=1)
    with pytest.raises(InputError, match="run by run with Newmark's method alone"):
        contact_forces(
            crossing, integration=Modal(f_max=60.0, dt=0.005), n_runs=1, seed=1, duration=3.0
        )


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: quarter(laws=(Friction(axle=1, force=1.0, stiffness=1.0),)).build(), "1 to 1"),
        (lambda: Description(name="t", bodies=(Body(mass=9.0),),
                             axles=(Axle(body=0, setback=0.0, stiffness=1.0),),
                             laws=(Stop(axle=0, gap=0.1, stiffness=1.0),)).build(), "axle_mass"),
        (lambda: Friction(axle=0, force=0.0, stiffness=1.0), "greater than 0"),
        (lambda: Stop(axle=-1, gap=0.0, stiffness=1.0), "axle must be"),
    ],
)  # fmt: skip
def test_laws_that_cannot_be_are_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()
