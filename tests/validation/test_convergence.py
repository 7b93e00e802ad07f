"""Convergence: mesh, time step and number of modes, with observed orders against theory."""

import numpy as np
import pytest
from crossings import UNDAMPED, V2_BEAM, cross, kirchhoff_plate
from scipy.sparse.linalg import spsolve

from models import simple_beam, small_floor
from trundle.dynamics import REACH, natural_modes
from trundle.road import Profile
from trundle.route import DriveIn, Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    Newmark,
    Rayleigh,
    ensemble,
    prepare,
)
from trundle.vehicle import container_truck_40ft, quarter_car, sprung_mass

CASE = "Convergence"
SOURCE = "order of the method"


def test_mesh_of_a_beam(record):
    """Cubic elements with a consistent mass: frequencies converge at order 4."""
    sizes = np.array([2, 4, 8])
    exact = np.pi / 2 * np.sqrt(V2_BEAM["rigidity"] / V2_BEAM["line_mass"]) / 25.0**2
    errors = []
    for n in sizes:
        beam = simple_beam(**V2_BEAM, n_elements=int(n))
        f = natural_modes(beam.mass, beam.stiffness, f_max=10.0).frequencies[0]
        errors.append(abs(f / exact - 1))
    record.convergence(
        "beam, first frequency", sizes, errors, order=-4.0, tolerance=0.25, figure="mesh",
        x_label="elements along a side", last=3,
    )  # fmt: skip


@pytest.mark.parametrize("quantity", ["frequency", "deflection"])
def test_mesh_of_a_plate(record, quantity):
    """Linear shells: order 2 in frequency and in deflection under pressure (Kirchhoff's series)."""
    sizes = np.array([8, 16, 32])
    rigidity = 30e9 * 0.2**3 / 12 / 0.96
    errors = []
    for n in sizes:
        floor = kirchhoff_plate(length=8.5, width=8.5, thickness=0.2, mesh=8.5 / n)
        if quantity == "frequency":
            exact = np.pi / 8.5**2 * np.sqrt(rigidity / 500.0)
            value = natural_modes(floor.mass, floor.stiffness, f_max=15.0).frequencies[0]
        else:
            exact = 0.004062353 * 500.0 * 8.5**4 / rigidity
            u = spsolve(floor.stiffness, floor.mass @ floor.rigid_vector(2))
            middle = np.argmin(np.abs(floor.nodes - floor.nodes.mean(axis=0)).sum(axis=1))
            value = u[floor.dof_index[middle, 2]]
        errors.append(abs(value / exact - 1))
    record.convergence(
        f"plate, {quantity}", sizes, errors, order=-2.0, tolerance=0.25, figure="mesh",
        x_label="elements along a side", last=2,
    )  # fmt: skip


def car():
    return quarter_car(
        body_mass=4000.0, axle_mass=400.0, stiffness=4e5, damping=8e3, tyre_stiffness=2e6,
        tyre_damping=1e3,
    )  # fmt: skip


def smooth_drive():
    """A car on a sine road that comes onto the floor smoothly: nothing jumps."""
    s = np.linspace(-20.0, 40.0, 12001)
    road = Profile(station=s, elevation=0.004 * np.sin(1.7 * s), slope=0.0068 * np.cos(1.7 * s))
    return Crossing(
        vehicle=car(), route=Route.straight((0.0, 2.6), (12.0, 2.6), speed=8.0), road=road,
        entry=DriveIn(length=2.0), run_in=4.0,
    )  # fmt: skip


@pytest.mark.longest
@pytest.mark.parametrize("kind", [Decoupled, Coupled])
@pytest.mark.parametrize("scheme", ["newmark", "modal"])
def test_time_step(record, kind, scheme):
    """Second order, both: average acceleration by its own, the exact recursion by the contact
    force, which it takes as linear over a step; against the same run with an eighth of the least
    step."""
    floor = small_floor(mesh_size=2.0)
    damping = Rayleigh(alpha=0.5, beta=0.002)
    steps = np.array([8.0, 4.0, 2.0]) * 1e-3

    def velocity(dt):
        integration = Newmark(dt=dt) if scheme == "newmark" else Modal(f_max=40.0, dt=dt)
        runs = ensemble(
            floor, smooth_drive(), method=kind(integration=integration, damping=damping),
            points={"p": (8.0, 4.0)}, n_runs=1, seed=0, duration=1.6,
        )  # fmt: skip
        return runs.displacement[0, :, 0]

    fine = velocity(steps[-1] / 8)
    errors = []
    for dt in steps:
        coarse = velocity(dt)
        at = fine[:: round(8 * dt / steps[-1])][: len(coarse)]
        errors.append(np.linalg.norm(coarse[: len(at)] - at) / np.linalg.norm(at))
    name = f"{kind.__name__.lower()}, {'average acceleration' if scheme == 'newmark' else 'modal'}"
    record.convergence(
        name, steps, errors, order=2.0, tolerance=0.35, figure="time_step", x_label="time step [s]",
        y_label="error of the displacement, RMS", last=2,
    )  # fmt: skip


@pytest.mark.longest
@pytest.mark.parametrize("residual", [False, True])
def test_modes(record, residual):
    """Deflection during a slow crossing as modes are added, with and without the rest's statics.

    A mode left out misses 1 / n^4 of static deflection: in RMS over the path N^-3.5. With the
    static residual what it misses is its free vibration after the wheel's arrival, smaller by
    the ratio of the passing frequency n pi v / L to its own, 1 / n: N^-4.5.
    """
    beam = simple_beam(**V2_BEAM, n_elements=64)
    # every fifth mode has a node at 0.4 L; these counts all stop just before one
    numbers = np.array([4, 9, 14, 19])
    speed = 5.0
    duration = 25.0 / speed
    settings = {"duration": duration * 0.999, "speed": speed, "point": (10.0, 0.0)}
    vehicle = sprung_mass(mass=3e4, stiffness=1.0)

    def history(n, with_rest):
        f_max = (n + 0.5) ** 2 * 25.7078 / (2 * np.pi)
        # so fine that all modes are stepped: above half the sampling frequency none rings
        modal = Modal(f_max=f_max, dt=duration / 40_000, residual=with_rest)
        method = Decoupled(integration=modal, damping=UNDAMPED)
        return cross(beam, 25.0, vehicle, method, **settings).displacement[0, :, 0]

    exact = history(34, True)
    errors = [
        np.linalg.norm(history(int(n), residual) - exact) / np.linalg.norm(exact) for n in numbers
    ]
    record.convergence(
        "with residual flexibility" if residual else "modes alone", numbers + 1, errors,
        order=-4.5 if residual else -3.5, tolerance=0.5, figure="modes",
        x_label="first mode left out", y_label="error of the displacement, RMS", last=3,
    )  # fmt: skip


@pytest.mark.longest
def test_modal_tends_to_direct(record):
    """All that is left between the methods, as f_max rises, is Newmark's own time error."""
    floor = small_floor(mesh_size=2.0)
    damping = Rayleigh(alpha=0.5, beta=0.001)
    way = Crossing(
        vehicle=container_truck_40ft(), route=Route.straight((0.0, 3.0), (12.0, 3.0), speed=6.0),
        road=Profile.smooth(), entry=DriveIn(length=2.0), run_in=0.0,
    )  # fmt: skip
    settings = {"points": {"p": (7.0, 4.0)}, "n_runs": 1, "seed": 2, "duration": 3.0}
    for kind in (Decoupled, Coupled):
        fine = ensemble(
            floor, way, method=kind(integration=Newmark(dt=1.25e-4), damping=damping), **settings
        )
        integration = Modal(f_max=800.0, dt=5e-4)
        prepared = prepare(floor, integration, damping)
        modal = ensemble(
            prepared, way, method=kind(integration=integration, damping=damping), **settings
        )
        # the record ends under a wheel: nothing behind its last steps is known to complete them
        every, known = fine.velocity[:, ::4], slice(-REACH)
        error = np.abs(modal.velocity - every)[:, known].max() / np.abs(every).max()
        name = f"modal below 800 Hz against direct, {kind.__name__.lower()}, peak difference"
        record.row(name, 0.0, error, atol=1e-3, source="two methods, one answer")
