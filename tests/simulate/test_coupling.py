"""The contact solver against the assembled matrices, and its limits."""

import dataclasses
from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu

from models import simple_beam, small_floor
from trundle.dynamics import sparse_solver
from trundle.errors import InputError
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import DriveIn, Ramp, Route, StaticStart, contact_rows
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    ModalRatio,
    Newmark,
    Rayleigh,
    ensemble,
    prepare,
)
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.sources.random_road import RandomRoad
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.simulate.wheels.standing import StandingWheels
from trundle.simulate.wheels.timeline import timeline_of
from trundle.structure import Hat, Hermite
from trundle.vehicle import container_truck_40ft, library_vehicle, quarter_car

DAMPING = Rayleigh(alpha=0.5, beta=0.001)
POINTS = {"a": (3.0, 3.0), "b": (7.3, 1.9)}


def car():
    return quarter_car(
        body_mass=4000.0,
        axle_mass=400.0,
        stiffness=4e5,
        damping=8e3,
        tyre_stiffness=2e6,
        tyre_damping=1e3,
    )


def six_axles():
    """Tyres that damp: what moves with the wheels comes in by the dampers of several at once."""
    worn = library_vehicle("tractor_3axle_semitrailer_6_axle_worn")
    return replace(worn, contact_damping=np.full(worn.n_contacts, 3e3))


def crossing(vehicle=None, *, entry=None, speed=8.0, name="way", road=None, run_in=2.0, y=3.0):
    return Crossing(
        vehicle=vehicle or car(),
        route=Route.straight((0.0, y), (12.0, y), speed=speed, name=name),
        road=road or RoadClass("C"),
        band=RoughnessBand(n_min=0.05, n_max=2.0),
        entry=entry or DriveIn(length=2.0),
        run_in=run_in,
    )


def monolithic(floor, crossings, method, *, seed, duration):
    """Step the assembled vehicle + floor matrices, rebuilt and refactorised at every step.

    M is constant; C and K hold the contact springs and dampers at the wheels' places, with the
    convective block V H' that makes them non-symmetric.
    """
    dt = method.integration.dt
    timeline = timeline_of(as_sources(crossings), dt, duration)
    road = roads_under_wheels(as_sources(crossings), timeline, range(1), seed)
    standing = StandingWheels(floor, as_sources(crossings), timeline, method.contact)
    rows, speeds = standing.window(0, standing.n_steps)
    vehicle = crossings[0].vehicle
    n_contacts, n, nv = vehicle.n_contacts, floor.n_dofs, vehicle.system.n_dofs
    k, c = np.diag(vehicle.contact_stiffness), np.diag(vehicle.contact_damping)
    e = vehicle.contact_map
    damping = method.damping.matrix(floor.mass, floor.stiffness)
    mass = sparse.block_diag([sparse.csc_array(vehicle.system.mass), floor.mass], format="csc")
    values, slopes = (rows.matrix(w) for w in (rows.value, rows.slope))
    u = np.zeros(nv + n)
    # the vehicle starts at rest in equilibrium on the road under its wheels
    u[:nv] = np.linalg.solve(vehicle.system.stiffness, e.T @ (k @ road.start[:, 0]))
    v, a = np.zeros(nv + n), np.zeros(nv + n)
    a0, a1 = 4.0 / dt**2, 2.0 / dt
    out = []
    for step in range(1, len(timeline.time)):
        pick = slice(step * n_contacts, (step + 1) * n_contacts)
        h, hs = values[pick], slopes[pick]
        share = sparse.diags_array(rows.load_share[pick])
        ht = h.T @ share
        speed = sparse.diags_array(speeds[step])
        big_k = sparse.block_array(
            [
                [sparse.csc_array(vehicle.system.stiffness), -e.T @ (k @ h + c @ (speed @ hs))],
                [-ht @ (k @ e), floor.stiffness + ht @ (k @ h + c @ (speed @ hs))],
            ],
            format="csc",
        )
        big_c = sparse.block_array(
            [
                [sparse.csc_array(vehicle.system.damping), -e.T @ (c @ h)],
                [-ht @ (c @ e), damping + ht @ (c @ h)],
            ],
            format="csc",
        )
        push = road.push[step, :, 0]
        load = np.concatenate([e.T @ push, -(ht @ (vehicle.static_forces + push))])
        u_hat = u + dt * v + dt**2 / 4 * a
        v_hat = v + dt / 2 * a
        right = load + mass @ (a0 * u_hat) + big_c @ (a1 * u_hat - v_hat)
        new = splu(sparse.csc_matrix(big_k + a1 * big_c + a0 * mass)).solve(right)
        a = a0 * (new - u_hat)
        v = v_hat + a1 * (new - u_hat)
        u = new
        out.append((u[nv:].copy(), v[nv:].copy(), a[nv:].copy()))
    return out


@pytest.mark.parametrize("shape", [Hermite(), Hat()])
@pytest.mark.parametrize("make_vehicle", [car, six_axles])
@pytest.mark.parametrize("mirror", [False, True])
def test_low_rank_step_equals_the_assembled_matrices(shape, make_vehicle, mirror):
    """Design.md: equal to the monolithic matrix to round-off; 1e-9 relative."""
    edges = {"y_min": "symmetry"} if mirror else {}
    floor = small_floor(mesh_size=2.0, edges=edges)
    method = Coupled(integration=Newmark(dt=0.01), damping=DAMPING, contact=shape)
    way = crossing(make_vehicle(), run_in=0.0, entry=Ramp(length=1.0), y=0.0 if mirror else 2.5)
    runs = ensemble(floor, way, method=method, points=POINTS, n_runs=1, seed=5, duration=2.0)
    reference = monolithic(floor, (way,), method, seed=5, duration=2.0)
    rows = contact_rows(
        floor, np.array(list(POINTS.values())), np.array([[1.0, 0.0]] * 2), shape=Hermite()
    )
    read = rows.matrix(rows.value)
    for i, ours in enumerate((runs.displacement, runs.velocity, runs.acceleration)):
        theirs = np.array([read @ step[i] for step in reference])
        scale = np.abs(theirs).max()
        assert np.abs(ours[0, 1:] - theirs).max() < 1e-9 * scale


def test_nothing_is_factorised_during_the_steps(monkeypatch):
    """One factorisation of the effective matrix, however long the record."""
    calls = []
    original = sparse_solver.factorise

    def counting(matrix, *, backend=None):
        calls.append(matrix.shape)
        return original(matrix, backend=backend)

    monkeypatch.setattr("trundle.dynamics.newmark.factorise", counting)
    floor = small_floor(mesh_size=2.0)
    method = Coupled(integration=Newmark(dt=0.01), damping=DAMPING)
    for duration in (0.5, 2.0):
        calls.clear()
        ensemble(
            floor, crossing(), method=method, points=POINTS, n_runs=2, seed=1, duration=duration
        )
        assert len(calls) == 1


def relative_difference(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.mark.parametrize("integration", [Newmark(dt=0.005), Modal(f_max=60.0, dt=0.005)])
def test_coupled_tends_to_decoupled_as_the_floor_stiffens(integration):
    """A floor 100 times stiffer gives back 100 times less of its motion to the vehicle."""
    differences = []
    for factor in (1.0, 100.0):
        from trundle.structure import CONCRETE, ShellSection

        stiff = dataclasses.replace(
            CONCRETE, elastic_modulus=30e9 * factor, density=2450.0 * factor
        )
        floor = small_floor(
            mesh_size=2.0, material=stiff, slab=ShellSection(thickness=0.2, material=stiff)
        )
        runs = [
            ensemble(
                floor,
                crossing(container_truck_40ft()),
                method=kind(integration=integration, damping=DAMPING),
                points=POINTS,
                n_runs=2,
                seed=3,
                duration=3.0,
            )
            for kind in (Coupled, Decoupled)
        ]
        differences.append(relative_difference(runs[0].contact_forces, runs[1].contact_forces))
    assert differences[1] < 0.015 * differences[0] < 0.015


def test_modal_tends_to_direct_as_modes_are_added():
    """With all but the highest modes the two methods differ by the time step alone."""
    floor = small_floor(mesh_size=2.0)
    way = crossing(container_truck_40ft(), speed=6.0)
    dt = 0.002
    settings = {"points": POINTS, "n_runs": 1, "seed": 2, "duration": 3.0}
    for kind in (Decoupled, Coupled):
        direct = ensemble(
            floor, way, method=kind(integration=Newmark(dt=dt), damping=DAMPING), **settings
        )
        errors = []
        for f_max in (20.0, 60.0, 400.0):
            method = kind(integration=Modal(f_max=f_max, dt=dt / 4), damping=DAMPING)
            modal = ensemble(floor, way, method=method, **settings)
            errors.append(relative_difference(modal.velocity[:, ::4], direct.velocity))
        assert errors[2] < errors[0]
        assert errors[2] < 0.01
        shift = relative_difference(modal.displacement[:, ::4], direct.displacement)
        assert shift < 0.002


def test_velocity_and_acceleration_are_rates_with_the_residual_too():
    """Sums over time of each are changes of the one before; few modes leave much to the residual."""
    way = crossing(container_truck_40ft(), speed=6.0)
    dt = 0.002
    method = Decoupled(integration=Modal(f_max=12.0, dt=dt), damping=DAMPING)
    runs = ensemble(
        small_floor(mesh_size=2.0), way, method=method, points=POINTS, n_runs=1, seed=2, duration=3
    )
    modes_alone = replace(method, integration=replace(method.integration, residual=False))
    alone = ensemble(
        small_floor(mesh_size=2.0),
        way,
        method=modes_alone,
        points=POINTS,
        n_runs=1,
        seed=2,
        duration=3,
    )
    assert relative_difference(alone.velocity, runs.velocity) > 0.1  # else nothing is tried
    for change, rate in (
        (runs.displacement, runs.velocity),
        (runs.velocity, runs.acceleration),
    ):
        summed = 0.5 * dt * np.cumsum(rate[:, 1:] + rate[:, :-1], axis=1)
        # a sum over steps of 2 ms of waves below 60 Hz is off by (omega dt)^2 / 12 at most
        assert relative_difference(summed, change[:, 1:] - change[:, :1]) < 0.03


def test_residual_flexibility_removes_the_truncation_error_of_the_static_part():
    """A slow smooth truck: ten modes and the residual sink as the full stiffness says."""
    floor = small_floor(mesh_size=1.5)
    way = crossing(container_truck_40ft(), speed=1.0, road=Profile.smooth(), run_in=0.0)
    method = Decoupled(integration=Modal(f_max=25.0, dt=0.01), damping=DAMPING)
    prepared = prepare(floor, method.integration, method.damping)
    assert prepared.modes is not None
    assert prepared.modes.n_modes < 40
    runs = ensemble(prepared, way, method=method, points=POINTS, n_runs=1, seed=0, duration=14.0)
    step = 700  # t = 7 s: the front axle at 7 m
    timeline = timeline_of(as_sources(way), 0.01, 14.0)
    rows = StandingWheels(floor, as_sources(way), timeline, Hermite()).whole
    n = way.vehicle.n_contacts
    load = -rows.matrix(rows.value)[step * n : (step + 1) * n].T @ way.vehicle.static_forces
    static = sparse_solver.factorise(floor.stiffness).solve(load)
    reader = contact_rows(
        floor, np.array(list(POINTS.values())), np.array([[1.0, 0.0]] * 2), shape=Hermite()
    )
    expected = reader.matrix(reader.value) @ static
    np.testing.assert_allclose(runs.displacement[0, step], expected, rtol=0.01)


def test_four_trucks_decoupled_are_the_sum_of_single_ones():
    """Superposition: the floor is linear and each route's road depends on its name alone."""
    floor = small_floor(mesh_size=2.0)
    ways = [
        crossing(container_truck_40ft(), name=f"way {i}", y=1.0 + i, speed=6.0 + i, run_in=5.0 * i)
        for i in range(4)
    ]
    for integration in (Newmark(dt=0.01), Modal(f_max=40.0, dt=0.01)):
        method = Decoupled(integration=integration, damping=DAMPING)
        settings = {"method": method, "points": POINTS, "n_runs": 2, "seed": 11, "duration": 2.5}
        single = [ensemble(floor, way, **settings).acceleration for way in ways]
        together = ensemble(floor, ways, **settings).acceleration
        assert relative_difference(together, sum(single)) < 1e-9


def test_response_is_linear_in_the_road():
    """Doubling the road doubles what the road adds to the smooth crossing."""
    floor = small_floor(mesh_size=2.0)
    method = Coupled(integration=Modal(f_max=40.0, dt=0.005), damping=DAMPING)
    s = np.linspace(-20.0, 30.0, 2001)

    def run(height):
        road = Profile(
            station=s, elevation=height * np.sin(2 * s), slope=2 * height * np.cos(2 * s)
        )
        return ensemble(
            floor, crossing(road=road), method=method, points=POINTS, n_runs=1, seed=0, duration=3.0
        ).velocity

    flat, once, twice = run(0.0), run(0.004), run(0.008)
    np.testing.assert_allclose(twice - flat, 2 * (once - flat), atol=1e-9 * np.abs(twice).max())


def test_a_route_driven_backwards_mirrors_the_response():
    """On a floor symmetric about x = 6 m, driving the other way mirrors the plan."""
    floor = small_floor(mesh_size=1.5)
    method = Coupled(integration=Newmark(dt=0.01), damping=DAMPING)
    way = crossing(container_truck_40ft(), road=Profile.smooth())
    back = dataclasses.replace(way, route=way.route.reversed())
    settings = {"method": method, "n_runs": 1, "seed": 0, "duration": 3.0}
    there = ensemble(floor, way, points={"p": (4.0, 2.0)}, **settings)
    again = ensemble(floor, back, points={"p": (8.0, 2.0)}, **settings)
    np.testing.assert_allclose(
        there.acceleration, again.acceleration, atol=1e-8 * np.abs(there.acceleration).max()
    )


def test_half_a_model_with_half_the_load_is_the_whole():
    """A truck along the mirror plane: the whole floor and the half give the same response."""
    lines = {"y_lines": np.array([-6.0, 6.0]), "y_extent": (-6.0, 6.0)}
    whole = small_floor(mesh_size=1.5, **lines)
    half = small_floor(
        mesh_size=1.5, y_lines=np.array([6.0]), y_extent=(0.0, 6.0), edges={"y_min": "symmetry"}
    )
    way = crossing(container_truck_40ft(), y=0.0)
    for kind in (Decoupled, Coupled):
        for integration in (Newmark(dt=0.01), Modal(f_max=40.0, dt=0.01)):
            method = kind(integration=integration, damping=DAMPING)
            pair = [
                ensemble(
                    floor,
                    way,
                    method=method,
                    points={"p": (4.0, 3.0)},
                    n_runs=1,
                    seed=4,
                    duration=3.0,
                ).acceleration
                for floor in (whole, half)
            ]
            assert relative_difference(pair[1], pair[0]) < 1e-5


@pytest.mark.parametrize("integration", [Newmark(dt=0.01), Modal(f_max=50.0, dt=0.01)])
def test_a_standing_start_stays_at_rest_until_the_truck_moves(integration):
    """Static equilibrium: on a smooth road at a crawl nothing but the slow sinking is seen."""
    floor = small_floor(mesh_size=2.0, x_lines=np.array([0.0, 8.0, 16.0]), x_extent=(0.0, 16.0))
    way = Crossing(
        vehicle=container_truck_40ft(),
        route=Route.straight((0.0, 3.0), (16.0, 3.0), speed=1e-4),
        road=Profile.smooth(),
        entry=StaticStart(exit_length=1.0),
    )
    for kind in (Decoupled, Coupled):
        method = kind(integration=integration, damping=DAMPING)
        runs = ensemble(floor, way, method=method, points=POINTS, n_runs=1, seed=0, duration=2.0)
        timeline = timeline_of(as_sources(way), 0.01, 2.0)
        rows = StandingWheels(floor, as_sources(way), timeline, Hermite()).whole
        load = -rows.matrix(rows.value)[:3].T @ way.vehicle.static_forces
        static = sparse_solver.factorise(floor.stiffness).solve(load)
        reader = contact_rows(
            floor, np.array(list(POINTS.values())), np.array([[1.0, 0.0]] * 2), shape=Hermite()
        )
        np.testing.assert_allclose(
            runs.displacement[0, 0], reader.matrix(reader.value) @ static, rtol=1e-6
        )
        drift = np.abs(runs.displacement[0] - runs.displacement[0, 0]).max()
        assert drift < 0.01 * np.abs(runs.displacement).max()


def test_same_seed_same_bits_and_more_runs_keep_the_first():
    floor = small_floor(mesh_size=2.0)
    method = Coupled(integration=Modal(f_max=40.0, dt=0.01), damping=ModalRatio(ratio=0.03))

    def run(n_runs, seed):
        return ensemble(
            floor, crossing(), method=method, points=POINTS, n_runs=n_runs, seed=seed, duration=2.0
        ).acceleration

    first, again = run(3, 7), run(3, 7)
    assert np.array_equal(first, again)
    np.testing.assert_allclose(run(5, 7)[:3], first, rtol=1e-9, atol=1e-12)
    assert not np.allclose(run(3, 8), first)


def test_every_method_drives_over_the_same_road():
    """Entry, time step and companions do not change the road of a route and a run."""
    heights = []
    for entry, dt in ((Ramp(length=1.0), 0.02), (DriveIn(length=3.0), 0.005)):
        way = crossing(entry=entry, run_in=7.3)
        timeline = timeline_of(as_sources(way), dt, 3.0)
        along = way.along(timeline.time, timeline.begins[0])
        (profile,) = RandomRoad(way, way.road, along, seed=1)._profiles(0)
        heights.append(profile.at(np.linspace(-10.0, 20.0, 50))[0])
    np.testing.assert_allclose(heights[0], heights[1], rtol=1e-12)


def test_doubts_are_recorded():
    """Time step, truncation, damping, roughness band, mesh passing, lift-off."""
    floor = small_floor(mesh_size=2.0)
    way = Crossing(
        vehicle=car(),
        route=Route.straight((0.0, 3.0), (12.0, 3.0), speed=4.0),
        road=RoadClass("F"),
        band=RoughnessBand(n_max=4.0),
        entry=Ramp(length=2.0),
    )
    method = Coupled(
        integration=Modal(f_max=20.0, dt=0.025),
        damping=Rayleigh(alpha=0.86, beta=0.001),
        contact=Hat(),
    )
    runs = ensemble(floor, way, method=method, points=POINTS, n_runs=3, seed=1)
    subjects = " ".join(warning.subject for warning in runs.warnings)
    for word in (
        "loss of contact",
        "time step",
        "truncation",
        "damping",
        "roughness",
        "mesh passing",
    ):
        assert word in subjects
    stretched = next(w for w in runs.warnings if w.subject == "time step")
    assert "18 Hz" in stretched.message


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"points": {"x": (99.0, 0.0)}}, "not on the floor"),
        ({"points": {}}, "at least one point"),
        ({"n_runs": 0}, "n_runs must be a whole number"),
        ({"duration": -1.0}, "duration must be greater than 0"),
    ],
)
def test_bad_ensembles_are_refused(change, match):
    values = {"points": POINTS, "n_runs": 1, "seed": 1, "duration": 1.0, **change}
    method = Coupled(integration=Modal(f_max=20.0, dt=0.01))
    with pytest.raises(InputError, match=match):
        ensemble(small_floor(mesh_size=2.0), crossing(), method=method, **values)


def test_a_road_too_fine_for_the_step_is_refused():
    way = dataclasses.replace(crossing(speed=20.0), band=RoughnessBand(n_max=10.0))
    method = Coupled(integration=Modal(f_max=20.0, dt=0.01))
    with pytest.raises(InputError, match="needs a time step of at most"):
        ensemble(
            small_floor(mesh_size=2.0),
            way,
            method=method,
            points=POINTS,
            n_runs=1,
            seed=1,
            duration=1.0,
        )


def test_direct_integration_refuses_a_ratio_and_says_what_to_do():
    with pytest.raises(InputError, match=r"use Rayleigh\.through"):
        Coupled(integration=Newmark(dt=0.01), damping=ModalRatio(ratio=0.03))


def test_a_beam_without_shells_can_be_crossed():
    beam = simple_beam(length=12.0, rigidity=1e9, line_mass=5000.0, n_elements=12)
    way = Crossing(
        vehicle=car(),
        route=Route.straight((0.0, 0.0), (12.0, 0.0), speed=6.0),
        road=Profile.smooth(),
        entry=Ramp(length=0.1),
    )
    runs = ensemble(
        beam,
        way,
        method=Coupled(integration=Modal(f_max=200.0, dt=0.002), damping=ModalRatio(ratio=0.0)),
        points={"mid": (6.0, 0.0)},
        n_runs=1,
        seed=0,
        duration=2.0,
    )
    static = -4400 * 9.81 * 12.0**3 / (48 * 1e9)
    assert runs.displacement.min() == pytest.approx(static, rel=0.1)
