"""Always: energy balance, monolithic equality, stiff floors, and other invariants of the coupling.

Superposition of trucks, the mirrored route, half models and equal bits for equal seeds are held
in tests/simulate.
"""

import itertools

import numpy as np
import pytest
from scipy import sparse
from scipy.ndimage import convolve1d

from models import small_floor
from trundle.dynamics import (
    ExactRecursion,
    ModalRatio,
    NewmarkPropagator,
    Rayleigh,
    restoring_filter,
)
from trundle.road import Profile
from trundle.route import DriveIn, Route
from trundle.simulate import Coupled, Crossing, Modal, Newmark, ensemble, prepare
from trundle.simulate.direct import march
from trundle.simulate.direct.floors import FullFloor
from trundle.simulate.modal.block_march import drive_in_blocks
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.point_motion import complete, point_filters
from trundle.simulate.sources.given_road import given_road
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.wheels.contacts import Contacts, Wheels
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.simulate.wheels.standing import StandingWheels
from trundle.simulate.wheels.timeline import timeline_of
from trundle.structure import Hermite
from trundle.vehicle import container_truck_40ft, quarter_car

CASE = "Always"
SOURCE = "conservation of energy"


def rough():
    s = np.linspace(-20.0, 40.0, 6001)
    return Profile(
        station=s, elevation=0.006 * np.sin(1.3 * s) + 0.002 * np.sin(4.1 * s + 1.0),
        slope=0.0078 * np.cos(1.3 * s) + 0.0082 * np.cos(4.1 * s + 1.0),
    )  # fmt: skip


def way(vehicle):
    return Crossing(
        vehicle=vehicle, route=Route.straight((0.0, 2.6), (12.0, 2.6), speed=8.0), road=rough(),
        entry=DriveIn(length=2.0), run_in=0.0,
    )  # fmt: skip


def laid_out(floor, crossing, method, duration):
    """Lay out production's own pieces, whose histories production does not keep."""
    prepared = prepare(floor, method.integration, method.damping)
    timeline = timeline_of(as_sources(crossing), method.integration.dt, duration)
    road = roads_under_wheels(as_sources(crossing), timeline, range(1), 0)
    standing = StandingWheels(floor, as_sources(crossing), timeline, method.contact)
    return prepared, timeline, road, standing


def direct_states(floor, crossing, method, duration):
    """Return floor and vehicle displacement and velocity, and forces, at every step."""
    prepared, timeline, road, standing = laid_out(floor, crossing, method, duration)
    carrier = FullFloor(
        prepared.propagator, standing, sparse.csr_array(np.eye(1, floor.n_dofs)), flexibility=prepared.flexibility, coupled=True,
    )  # fmt: skip
    law = march.ContactLaw(
        springs=Contacts(vehicles=(crossing.vehicle,)).springs,
        vehicle=NewmarkPropagator(crossing.vehicle.free_system, method.integration),
    )
    vehicle, forces = march.run_in(law, timeline, road)
    state = (vehicle, carrier.start(1, None), forces)
    kept = [state]
    for step in range(1, len(timeline.time) - timeline.n_run_in):
        at = timeline.n_run_in + step
        state = march._step(law, carrier, state, at, road, step=step)
        kept.append(state)
    motions = [
        np.array([getattr(s[which], name)[:, 0] for s in kept])
        for which in (0, 1)
        for name in ("displacement", "velocity")
    ]
    shapes = np.eye(floor.n_dofs)
    heat = method.damping.matrix(floor.mass, floor.stiffness)
    forces = np.array([s[2][:, 0] for s in kept])
    return (timeline, road, standing), motions, forces, (floor.mass, floor.stiffness, heat, shapes)


def modal_states(floor, crossing, method, duration):
    """The same in modes: points that read ``Phi^T M u`` are the modes' own coordinates."""
    prepared, timeline, road, standing = laid_out(floor, crossing, method, duration)
    modes = prepared.modes
    reader = sparse.csr_array(modes.shapes.T @ floor.mass)
    carrier = ModalFloor(
        modes, prepared.propagator, standing, reader, flexibility=None,
    )  # fmt: skip
    vehicle = ExactRecursion(crossing.vehicle.free_system, method.integration.dt)
    contacts = Contacts(vehicles=(crossing.vehicle,))
    record = drive_in_blocks(
        Wheels(contacts=contacts, timeline=timeline, static=False),
        carrier, road, weight=np.ones(1), coupled=True,
    )  # fmt: skip
    record = complete(record, point_filters(carrier, None))
    forces = record.forces[:, :, 0]
    push = (forces - crossing.vehicle.static_forces) @ crossing.vehicle.contact_map
    push = convolve1d(push, restoring_filter(), axis=0, mode="nearest")
    springs = contacts.springs
    e, k = springs.contact_map, springs.stiffness
    still = np.linalg.solve(springs.standing_stiffness, e.T @ (k * road.start))[:, 0]
    states = [np.concatenate([still, 0 * still])]
    for before, after in itertools.pairwise(push):
        states.append(
            vehicle.phi @ states[-1] + vehicle.from_start @ before + vehicle.from_end @ after
        )
    z, zd = np.split(np.array(states), 2, axis=1)
    motions = [z, zd, record.displacement[:, :, 0], record.velocity[:, :, 0]]
    heat = np.diag(2 * method.damping.ratios(modes.omega) * modes.omega)
    parts = (np.eye(modes.n_modes), np.diag(modes.omega**2), heat, modes.shapes)
    return (timeline, road, standing), motions, forces, parts


def cumulative(power, dt):
    """Integrate by the trapezoidal rule with Gregory's end corrections, fourth order."""
    total = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1])) * dt])
    slope = np.gradient(power, dt, edge_order=2)
    return total - dt**2 / 12 * (slope - slope[0])


def balance(vehicle, integration, damping, duration=2.4):
    """Return the largest energy that is missing over the largest energy stored, and parts [J].

    Measured from static equilibrium, the static wheel loads ride down with the floor and the
    road (gravity's work), and the drive pushes each contact force up the slope it meets (road's
    work). Both go into motion, strain and heat.
    """
    floor = small_floor(mesh_size=2.0)
    crossing = way(vehicle)
    method = Coupled(integration=integration, damping=damping, contact=Hermite())
    states = direct_states if isinstance(integration, Newmark) else modal_states
    (timeline, _, standing), (z, zd, q, qd), forces, parts = states(
        floor, crossing, method, duration
    )
    mass, strain, heat, shapes = parts
    dt, first = integration.dt, timeline.n_run_in
    n_c = vehicle.n_contacts
    free = vehicle.free_system
    rows, speed = standing.window(0, standing.n_steps)
    value, slope = (rows.matrix(w) @ shapes for w in (rows.value, rows.slope))
    value, slope = (a.reshape(len(q), n_c, -1) for a in (value, slope))
    under = np.einsum("tcm,tm->tc", value, q)
    drift = np.einsum("tcm,tm->tc", speed[:, :, None] * slope, q)
    rise = np.einsum("tcm,tm->tc", value, qd) + drift
    along = crossing.along(timeline.time, timeline.begins[0])
    road = given_road(crossing, along)
    elevation, rate = road.elevation[first:], speed * road.slope[first:]
    squeeze = under + elevation - z @ vehicle.contact_map.T
    squeeze_rate = rise + rate - zd @ vehicle.contact_map.T

    def half(a, matrix):
        return 0.5 * np.einsum("ti,ti->t", a, (matrix @ a.T).T)

    stored = half(zd, free.mass) + half(z, free.stiffness)
    stored = stored + half(qd, mass) + half(q, strain)
    stored = stored + 0.5 * squeeze**2 @ vehicle.contact_stiffness
    lost = 2 * half(zd, free.damping) + 2 * half(qd, heat)
    lost = lost + squeeze_rate**2 @ vehicle.contact_damping
    # the static loads sink with floor and road; the drive pushes up the slope under each wheel
    gravity = -(rise + rate) @ vehicle.static_forces
    drive = np.einsum("tc,tc->t", forces, drift + rate)
    work = cumulative(gravity + drive, dt)
    missing = work - (stored - stored[0]) - cumulative(lost, dt)
    parts = {
        "gravity": cumulative(gravity, dt)[-1], "road and drive": cumulative(drive, dt)[-1],
        "dissipated": cumulative(lost, dt)[-1], "stored": stored.max(),
    }  # fmt: skip
    return np.abs(missing).max() / np.abs(stored).max(), parts


def car():
    return quarter_car(
        body_mass=4000.0, axle_mass=400.0, stiffness=4e5, damping=8e3, tyre_stiffness=2e6,
        tyre_damping=1e3,
    )  # fmt: skip


@pytest.mark.parametrize("name", ["quarter car", "container truck"])
def test_energy_balance(record, name):
    """Work of gravity and road = kinetic + strain + dissipated, at every step, to 1e-6.

    Modal, 30 Hz, without damping models that would hide an error, and with 3 %.
    """
    vehicle = car() if name == "quarter car" else container_truck_40ft()
    for ratio in (0.0, 0.03):
        integration = Modal(f_max=30.0, dt=1e-4, residual=False)
        missing, parts = balance(vehicle, integration, ModalRatio(ratio=ratio))
        label = f"energy missing over largest stored, {name}, {100 * ratio:g} % damping"
        record.row(label, 0.0, missing, atol=1e-6)
    record.explain(
        f"Energy of the last run ({name}): work of gravity {parts['gravity']:.1f} J, of road and drive "
        f"{parts['road and drive']:.1f} J, dissipated {parts['dissipated']:.1f} J, largest stored "
        f"{parts['stored']:.1f} J."
    )


def test_energy_balance_of_direct_integration(record):
    """Average acceleration in all dofs: what is missing falls with the square of the step."""
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = [
        balance(car(), Newmark(dt=dt), Rayleigh(alpha=0.3, beta=1e-3), duration=1.6)[0]
        for dt in steps
    ]
    record.convergence(
        "energy missing, direct integration", steps, errors, order=2.0, tolerance=0.4,
        figure="energy", x_label="time step [s]", y_label="energy missing / largest stored", last=3,
    )  # fmt: skip


def test_coupled_tends_to_decoupled_as_the_floor_stiffens(record):
    """The floor's answer falls as 1 / stiffness, and so does the difference of contact forces."""
    from trundle.simulate import Decoupled
    from trundle.structure import Material, ShellSection

    factors = np.array([10.0, 100.0, 1000.0])
    differences = []
    for factor in factors:
        stiff = Material(elastic_modulus=30e9 * factor, poisson_ratio=0.2, density=2450.0 * factor)
        floor = small_floor(
            mesh_size=2.0, material=stiff, slab=ShellSection(thickness=0.2, material=stiff)
        )
        pair = [
            ensemble(
                floor, way(container_truck_40ft()), points={"p": (3.0, 3.0)}, n_runs=1, seed=3,
                duration=2.5,
                method=kind(integration=Newmark(dt=0.004), damping=Rayleigh(alpha=0.5, beta=1e-3)),
            ).contact_forces
            for kind in (Coupled, Decoupled)
        ]  # fmt: skip
        differences.append(np.abs(pair[0] - pair[1]).max() / np.abs(pair[1]).max())
    record.convergence(
        "coupled to decoupled, contact force", factors, differences, order=-1.0, tolerance=0.1,
        figure="stiff_floor", x_label="stiffness and mass of the floor, times its own",
        y_label="largest difference of contact force", last=3,
        source="coupled tends to decoupled on a stiff floor",
    )  # fmt: skip
