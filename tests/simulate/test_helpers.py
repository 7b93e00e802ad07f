"""What every script wrote by hand: bridges, nearest nodes, point loads, level starts, entries."""

import numpy as np
import pytest

from models import small_floor
from trundle.dynamics import natural_modes
from trundle.errors import InputError
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import Abrupt, DriveIn, Ramp, Route, StaticStart, entry_named
from trundle.simulate import (
    Crossing,
    Decoupled,
    Modal,
    Newmark,
    contact_force_histories,
    contact_forces,
    harmonics,
    lay_out,
    point_load_deflection,
)
from trundle.structure import beam_bridge
from trundle.vehicle import quarter_car, sprung_mass

EI, M, L = 2.0e10, 12e3, 30.0
CAR = quarter_car(body_mass=400.0, axle_mass=40.0, stiffness=2e4, damping=1.5e3, tyre_stiffness=2e5)
ROOTS = {  # of cos x cosh x = -1, 1 (Blevins, Formulas for Natural Frequency, table 8-1)
    "simple": (np.pi, 2 * np.pi),
    "clamped": (4.730040745, 7.853204624),
    "cantilever": (1.875104069, 4.694091133),
}


@pytest.mark.parametrize("ends", ROOTS)
def test_a_beam_bridge_has_the_frequencies_of_the_closed_form(ends):
    bridge = beam_bridge(length=L, bending_stiffness=EI, line_mass=M, ends=ends)
    found = natural_modes(bridge.mass, bridge.stiffness, f_max=60.0).frequencies[:2]
    exact = [(x / L) ** 2 * np.sqrt(EI / M) / (2 * np.pi) for x in ROOTS[ends]]
    np.testing.assert_allclose(found, exact, rtol=2e-5)


@pytest.mark.parametrize(
    ("ends", "at", "read", "exact"),
    [
        ("simple", 15.0, 15.0, L**3 / 48),
        # within an element cubics lack the bend under the load itself, a^3 b^3 / (3 l^3)
        ("simple", 7.3, 7.3, (7.3 * (L - 7.3)) ** 2 / (3 * L) - (0.55 * 0.2 / 0.75) ** 3 / 3),
        ("simple", 7.3, 20.1, 7.3 * (L - 20.1) * (L**2 - 7.3**2 - (L - 20.1) ** 2) / (6 * L)),
        ("clamped", 15.0, 15.0, L**3 / 192),
        ("cantilever", 30.0, 30.0, L**3 / 3),
    ],
)
def test_point_loads_deflect_a_beam_as_in_closed_form(ends, at, read, exact):
    """Timoshenko, Strength of Materials; load and place also between nodes."""
    bridge = beam_bridge(length=L, bending_stiffness=EI, line_mass=M, ends=ends)
    found = point_load_deflection(bridge, (at, 0.0), force=1e4, points={"here": (read, 0.0)})
    assert found["here"] == pytest.approx(-1e4 * exact / EI, rel=1e-6)


def test_a_point_load_is_reciprocal_on_a_floor():
    """Maxwell: a sinks under a load at b as b does under one at a."""
    floor, a, b = small_floor(mesh_size=1.0), (2.3, 1.9), (8.1, 4.4)
    one = point_load_deflection(floor, a, points={"b": b})["b"]
    other = point_load_deflection(floor, b, points={"a": a})["a"]
    assert one == pytest.approx(other, rel=1e-8)
    assert point_load_deflection(floor, a)["load"] < -abs(one)
    with pytest.raises(InputError):
        point_load_deflection(floor, (99.0, 0.0))


def test_the_nearest_node_is_nearest():
    floor = small_floor(mesh_size=1.0)
    away = np.hypot(*(floor.nodes[:, :2] - [7.7, 2.2]).T)
    assert away[floor.nearest_node(7.7, 2.2)] == away.min()


def test_bad_bridges_are_refused():
    for changes in ({"length": 0.0}, {"line_mass": -1.0}, {"n_elements": 1}):
        with pytest.raises(InputError):
            beam_bridge(**{"length": L, "bending_stiffness": EI, "line_mass": M} | changes)


@pytest.mark.parametrize("zeta", [0.0, 0.1])
def test_a_level_start_meets_the_road_s_height_as_a_step(zeta):
    """A mass on a spring on a road h high, closed form: ``F = k h cos w t`` without damping."""
    mass, stiffness, h = 1000.0, 4e5, 0.01
    omega = np.sqrt(stiffness / mass)
    vehicle = sprung_mass(mass=mass, stiffness=stiffness, damping=2 * zeta * mass * omega)
    station = np.linspace(-50.0, 200.0, 501)
    road = Profile.from_samples(station, np.full_like(station, h))
    route = Route.straight((0.0, 0.0), (50.0, 0.0), speed=10.0, name="r")

    def force(start):
        crossing = Crossing(vehicle, route, road, run_in=0.0, start=start)
        t, f = contact_forces(
            crossing, integration=Modal(f_max=50.0, dt=0.002), n_runs=1, seed=1, duration=2.0
        )
        return t, f[0, :, 0] - vehicle.static_forces[0]

    t, level = force("level")
    damped = omega * np.sqrt(1 - zeta**2)
    decay = np.exp(-zeta * omega * t)
    z = 1.0 - decay * (np.cos(damped * t) + zeta * omega / damped * np.sin(damped * t))
    rate = decay * omega**2 / damped * np.sin(damped * t)
    exact = h * (stiffness * (1.0 - z) - 2 * zeta * mass * omega * rate)
    np.testing.assert_allclose(level, exact, atol=1e-6 * stiffness * h)
    np.testing.assert_allclose(force("equilibrium")[1], 0.0, atol=1e-9 * stiffness * h)


def test_a_level_start_on_a_random_road_dies_out():
    """The difference of both starts is free vibration: it decays, and the roads are the same."""
    route = Route.straight((0.0, 0.0), (100.0, 0.0), speed=10.0, name="r")

    def force(start):
        crossing = Crossing(CAR, route, RoadClass("C"), run_in=0.0, start=start)
        step = Modal(f_max=50.0, dt=0.002)
        return contact_forces(crossing, integration=step, n_runs=2, seed=1, duration=9.0)[1]

    difference = np.abs(force("level") - force("equilibrium"))[..., 0]
    assert (difference[:, :500].max(axis=1) > 100.0 * difference[:, -500:].max(axis=1)).all()


def test_exact_statistics_of_a_level_start_are_those_of_its_runs():
    """Waves and drawn roads begin alike: variances of forces at every time, 4000 runs, 4 sigma."""
    floor = small_floor(mesh_size=2.0)
    route = Route.straight((0.0, 3.0), (12.0, 3.0), speed=6.0, name="r")
    crossing = Crossing(
        CAR, route, RoadClass("B"), run_in=0.0, start="level", band=RoughnessBand(n_max=2.0)
    )
    method = Decoupled(integration=Modal(f_max=30.0, dt=0.01, residual=False))
    layout = lay_out(floor, crossing, method=method, points={"a": (3.0, 3.0)}, duration=0.5)
    answers = harmonics(layout, n_waves=800)
    exact = sum(np.einsum("w,wsc->sc", h.power, np.abs(h.contact_forces) ** 2) for h in answers)
    forces, mean = contact_force_histories(layout, runs=range(4000), seed=3)
    drawn = np.mean((forces - mean) ** 2, axis=2)
    np.testing.assert_allclose(drawn, exact, rtol=4.0 * np.sqrt(2.0 / 4000))


def test_other_starts_are_refused():
    route = Route.straight((0.0, 0.0), (50.0, 0.0), speed=10.0, name="r")
    level = Crossing(CAR, route, RoadClass("B"), start="level")
    with pytest.raises(InputError, match="choose Modal"):
        contact_forces(level, integration=Newmark(dt=0.01), n_runs=1, seed=1, duration=1.0)
    with pytest.raises(InputError, match="static start"):
        Crossing(CAR, route, RoadClass("B"), start="level", entry=entry_named("static"))


def test_entries_by_name():
    assert entry_named("abrupt") == Abrupt()
    assert entry_named("drive_in") == DriveIn(length=3.0)
    assert entry_named("ramp", 2.0) == Ramp(length=2.0)
    assert entry_named("static", 2.0) == StaticStart(exit_length=2.0)
    with pytest.raises(InputError, match="did you mean 'abrupt'"):
        entry_named("abrubt")
    with pytest.raises(InputError, match="has no length"):
        entry_named("abrupt", 2.0)
