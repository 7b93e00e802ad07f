"""V4: a constant force along the centre line of a simply supported Kirchhoff plate (Navier).

Double sine series, S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells (1959),
chapter 5, and its modal sum in time. The production shell carries the plate. Tolerance 0.5 % on
frequencies and displacement, for a mesh of 40 elements along the longer side.
"""

import numpy as np
import pytest
from crossings import cross, kirchhoff_plate, undamped
from scipy.sparse.linalg import spsolve

from trundle.dynamics import natural_modes
from trundle.simulate import Decoupled
from trundle.structure import FloorPlan, Material, ShellSection, build_floor
from trundle.vehicle import sprung_mass

CASE = "V4"
SOURCE = "Navier's double series (verification list)"
FORCE = 100e3
PLATES = {
    "8.5 x 8.5 x 0.20 m": {
        "size": (8.5, 8.5, 0.20), "f": [8.8758, 22.189, 22.189, 35.503], "static": 4.021875,
        "kmh": 15.0, "largest": 4.107391, "time": 0.99093, "mesh": 8.5 / 40,
    },
    "20 x 10 x 0.30 m": {
        "size": (20.0, 10.0, 0.30), "f": [6.0120, 9.6191, 15.6311], "static": 2.348647,
        "kmh": 40.0, "largest": 2.378245, "time": 0.93735, "mesh": 0.25,
    },
}  # fmt: skip


def floor_of(case):
    length, width, thickness = case["size"]
    return kirchhoff_plate(length=length, width=width, thickness=thickness, mesh=case["mesh"])


@pytest.mark.parametrize("name", PLATES)
def test_frequencies(record, name):
    case = PLATES[name]
    floor = floor_of(case)
    wanted = case["f"]
    computed = natural_modes(floor.mass, floor.stiffness, f_max=1.1 * wanted[-1]).frequencies
    for i, f in enumerate(wanted):
        record.row(f"{name}, mode {i + 1}", f, computed[i], unit="Hz", rtol=5e-3)


@pytest.mark.parametrize("name", PLATES)
def test_static_deflection(record, name):
    case = PLATES[name]
    floor = floor_of(case)
    length, width, _ = case["size"]
    centre = np.argmin(np.linalg.norm(floor.nodes - [length / 2, width / 2, 0.0], axis=1))
    load = np.zeros(floor.n_dofs)
    load[floor.dof_index[centre, 2]] = FORCE
    computed = 1e3 * spsolve(floor.stiffness, load)[floor.dof_index[centre, 2]]
    record.row(f"{name}, static, centre", case["static"], computed, unit="mm", rtol=5e-3)


@pytest.mark.parametrize("name", PLATES)
def test_moving_force(record, name):
    case = PLATES[name]
    length, width, _ = case["size"]
    speed = case["kmh"] / 3.6
    dt = length / speed / 4000
    runs = cross(
        floor_of(case), length, sprung_mass(mass=FORCE / 9.81, stiffness=1.0),
        undamped(Decoupled, f_max=300.0, dt=dt), duration=length / speed, speed=speed, y=width / 2,
    )  # fmt: skip
    u = -1e3 * runs.displacement[0, :, 0]
    label = f"{name}, {case['kmh']:g} km/h, largest deflection"
    record.row(label, case["largest"], u.max(), unit="mm", rtol=5e-3)
    when = runs.time[u.argmax()]
    record.row(f"{name}, {case['kmh']:g} km/h, its time", case["time"], when, unit="s", atol=0.01)


def test_the_real_thickness_against_mindlin(record):
    """At 0.2 m shear and rotary inertia count: Mindlin's closed form, where Kirchhoff is 0.7 % off.

    ``omega^2`` is the lower root of Mindlin's equation for the hard simply supported plate
    (R. D. Mindlin, J. Appl. Mech. 18 (1951) 31-38), shear factor 5/6 as the element's.
    """
    side, h, e, nu, rho = 8.5, 0.2, 30e9, 0.2, 2500.0
    material = Material(elastic_modulus=e, poisson_ratio=nu, density=rho)
    edges = dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "pinned")
    plan = FloorPlan(
        x_lines=np.array([0.0, side]), y_lines=np.array([0.0, side]), x_extent=(0.0, side),
        y_extent=(0.0, side), material=material, edges=edges,
        slab=ShellSection(thickness=h, material=material),
    )  # fmt: skip
    floor = build_floor(plan, mesh_size=side / 40)
    computed = natural_modes(floor.mass, floor.stiffness, f_max=40.0).frequencies
    rigidity, shear = e * h**3 / 12 / (1 - nu**2), 5 / 6 * e / (2 * (1 + nu)) * h
    for i, (m, n) in ((0, (1, 1)), (3, (2, 2))):
        k = (m**2 + n**2) * (np.pi / side) ** 2
        inertia = rho * h**3 / 12
        # (D k + S - J w2)(S k - rho h w2) = S^2 k
        b = (rigidity * k + shear) * rho * h + shear * k * inertia
        c = rigidity * shear * k**2
        omega2 = (b - np.sqrt(b * b - 4 * inertia * rho * h * c)) / (2 * inertia * rho * h)
        f = np.sqrt(omega2) / (2 * np.pi)
        record.row(
            f"8.5 m plate as thick as it is, mode {m},{n}", f, computed[i], unit="Hz", rtol=5e-3,
            source="Mindlin (1951), closed form",
        )  # fmt: skip
