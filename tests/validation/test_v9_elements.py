"""V9: the shell and the beam against plate theory, beam theory and the NAFEMS benchmarks.

Patch tests, rigid-body modes and locking stand in tests/structure; here stand the published and
closed-form values.
"""

import dataclasses

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from models import simple_beam
from trundle.dynamics import natural_modes
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    FloorPlan,
    Material,
    PointMasses,
    Rectangle,
    ShellGroup,
    ShellSection,
    build_floor,
)

CASE = "V9"
SOURCE = "closed form"
STEEL = Material(elastic_modulus=200e9, poisson_ratio=0.3, density=8000.0)


def square_plate(thickness, edge, n, *, side=1.0, material=STEEL):
    return build_floor(
        FloorPlan(
            x_lines=np.array([0.0, side]), y_lines=np.array([0.0, side]), x_extent=(0.0, side),
            y_extent=(0.0, side), slab=ShellSection(thickness=thickness, material=material),
            material=material, edges=dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), edge),
        ),
        mesh_size=side / n,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("edge", "wanted"),
    [
        ("pinned", [19.7392, 49.3480, 49.3480, 78.9568, 98.6960]),
        ("clamped", [35.992, 73.413, 73.413, 108.27, 131.64]),
    ],
)
def test_square_plates(record, edge, wanted):
    """``omega a^2 sqrt(rho t / D)``, nu = 0.3; t/a = 1/200 and 56 x 56 elements: 0.5 %."""
    thickness = 0.005
    rigidity = 200e9 * thickness**3 / 12 / 0.91
    scale = np.sqrt(rigidity / (8000 * thickness)) / (2 * np.pi)
    floor = square_plate(thickness, edge, 56)
    f = natural_modes(floor.mass, floor.stiffness, f_max=1.1 * wanted[-1] * scale).frequencies
    for i, value in enumerate(wanted):
        record.row(
            f"square plate, {edge} edges, mode {i + 1}", value, f[i] / scale, rtol=5e-3,
            source="Leissa, NASA SP-160 (1969)",
        )  # fmt: skip


@pytest.mark.parametrize(("edge", "coefficient"), [("pinned", 4.06235), ("clamped", 1.26532)])
@pytest.mark.parametrize("slenderness", [100, 1000])
def test_plates_under_pressure(record, edge, coefficient, slenderness):
    """``1000 w D / (q a^4)`` at the centre: no locking at t/a = 1/1000; 32 x 32 elements."""
    floor = square_plate(1.0 / slenderness, edge, 32)
    load = floor.mass @ floor.rigid_vector(2) / floor.shells[0].section.mass_per_area
    u = spsolve(floor.stiffness, load)
    middle = np.argmin(np.abs(floor.nodes - floor.nodes.mean(axis=0)).sum(axis=1))
    rigidity = 200e9 / slenderness**3 / 12 / 0.91
    record.row(
        f"plate under pressure, {edge}, t/a = 1/{slenderness}", coefficient,
        1e3 * u[floor.dof_index[middle, 2]] * rigidity, rtol=4e-3,
        source="Timoshenko and Woinowsky-Krieger, tables 8 and 35",
    )  # fmt: skip


def test_free_thin_plate(record):
    """NAFEMS FV12: 10 x 10 x 0.05 m, free; six rigid-body modes, then the values of plate theory.

    In units ``omega a^2 sqrt(rho t / D)``: 13.468, 19.596, 24.270, 34.801 (twice), K. M. Liew et
    al., Vibration of Mindlin Plates (1998). 40 x 40 elements: 0.5 %.
    """
    floor = square_plate(0.05, "free", 40, side=10.0)
    # in-plane motions of a free plate are rigid too; a shift makes the stiffness definite
    shifted = floor.stiffness + (2 * np.pi * 0.1) ** 2 * floor.mass
    f2 = natural_modes(floor.mass, shifted, f_max=5.0).frequencies ** 2 - 0.1**2
    f = np.sqrt(np.abs(f2))
    record.row(
        "FV12, largest of six rigid-body frequencies", 0.0, f[:6].max(), unit="Hz", atol=2e-3
    )
    for i, wanted in enumerate((1.622, 2.360, 2.922, 4.190, 4.190)):
        record.row(
            f"FV12, mode {7 + i}", wanted, f[6 + i], unit="Hz", rtol=5e-3,
            source="NAFEMS FV12; series solution",
        )  # fmt: skip


def test_tapered_membrane(record):
    """NAFEMS FV32: cantilevered tapered membrane, in-plane modes only, 16 x 8 elements: 1 %."""
    n_x, n_y = 32, 16
    x = np.linspace(0.0, 10.0, n_x + 1)
    half = 2.5 - 0.2 * x
    y = np.linspace(-1.0, 1.0, n_y + 1)[:, None] * half
    nodes = np.column_stack([np.tile(x, n_y + 1), y.ravel(), np.zeros(y.size)])
    grid = np.arange(y.size).reshape(y.shape)
    corners = [grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]]
    fixed = np.zeros((y.size, 6), dtype=bool)
    fixed[:, 2:5] = True
    fixed[grid[:, 0], :2] = True
    section = ShellSection(thickness=0.05, material=STEEL)
    elements = np.stack([corner.ravel() for corner in corners], axis=1)
    floor = Floor(
        nodes=nodes, fixed=fixed, shells=(ShellGroup(elements=elements, section=section),)
    )
    f = natural_modes(floor.mass, floor.stiffness, f_max=420.0).frequencies
    for i, wanted in enumerate((44.623, 130.03, 162.70, 246.05, 379.90, 391.44)):
        record.row(f"FV32, mode {i + 1}", wanted, f[i], unit="Hz", rtol=0.01, source="NAFEMS FV32")


def test_cantilever_beam(record):
    """Bending frequencies of a slender cantilever, 1.8751, 4.6941, 7.8548; 12 elements: 0.1 %."""
    base = simple_beam(length=10.0, rigidity=4e7, line_mass=500.0, n_elements=12)
    fixed = base.fixed.copy()
    fixed[:, [2, 4]] = False
    fixed[0] = True
    beam = dataclasses.replace(base, fixed=fixed)
    f = natural_modes(beam.mass, beam.stiffness, f_max=200.0).frequencies
    for i, root in enumerate((1.875104, 4.694091, 7.854757)):
        wanted = root**2 / 100.0 * np.sqrt(4e7 / 500.0) / (2 * np.pi)
        record.row(f"cantilever, mode {i + 1}", wanted, f[i], unit="Hz", rtol=1e-3)


@pytest.mark.parametrize("depth", [0.2, 1.0])
def test_timoshenko_beam(record, depth):
    """Simply supported Timoshenko beam, slender and stocky: both roots' lower one in closed form.

    With ``k = n pi / L``: ``(E I k^2 + S)(S k^2 - m w^2) ...`` as for Mindlin's plate; 48 elements.
    """
    length, width, n_el = 6.0, 0.4, 48
    section = BeamSection.rectangle(width, depth, STEEL)
    x = np.linspace(0.0, length, n_el + 1)
    fixed = np.ones((n_el + 1, 6), dtype=bool)
    fixed[:, [2, 4]] = False
    fixed[[0, -1], 2] = True
    elements = np.column_stack([np.arange(n_el), np.arange(1, n_el + 1)])
    floor = Floor(
        nodes=np.column_stack([x, 0 * x, 0 * x]), fixed=fixed,
        beams=(BeamGroup(elements=elements, section=section),),
    )  # fmt: skip
    m, inertia = 8000 * width * depth, 8000 * section.inertia_y
    bending, shear = 200e9 * section.inertia_y, STEEL.shear_modulus * section.shear_area_z
    f = natural_modes(floor.mass, floor.stiffness, f_max=600.0).frequencies
    for n in (1, 2, 3):
        k2 = (n * np.pi / length) ** 2
        b = (bending * k2 + shear) * m + shear * k2 * inertia
        omega2 = (b - np.sqrt(b * b - 4 * m * inertia * bending * shear * k2**2)) / (
            2 * m * inertia
        )
        wanted = np.sqrt(omega2) / (2 * np.pi)
        name = f"Timoshenko beam, L/h = {length / depth:g}, mode {n}"
        record.row(name, wanted, f[n - 1], unit="Hz", rtol=2e-3)


def test_offset_beam_against_composite_theory(record):
    """A web hung below a flange by rigid offsets: end rotation, deflection and neutral axis.

    ``E I = sum E (I + A d^2)`` about the common axis, exact for a constant moment.
    """
    concrete = Material(elastic_modulus=30e9, poisson_ratio=0.2, density=2450.0)
    flange = BeamSection.rectangle(1.5, 0.2, concrete)
    web = BeamSection.rectangle(0.4, 0.8, concrete)
    n, length, moment, drop = 4, 3.0, 1e5, 0.5
    x = np.linspace(0.0, length, n + 1)
    elements = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    fixed = np.zeros((n + 1, 6), dtype=bool)
    fixed[0] = True
    hung = BeamGroup(elements=elements, section=web, offset=np.array([0.0, 0.0, -drop]))
    floor = Floor(
        nodes=np.column_stack([x, 0 * x, 0 * x]), fixed=fixed,
        beams=(BeamGroup(elements=elements, section=flange), hung),
    )  # fmt: skip
    load = np.zeros(floor.n_dofs)
    tip = floor.dof_index[-1]
    load[tip[4]] = moment
    u = spsolve(floor.stiffness, load)
    axis = -drop * web.area / (web.area + flange.area)
    rigidity = 30e9 * (
        flange.inertia_y + flange.area * axis**2 + web.inertia_y + web.area * (axis + drop) ** 2
    )
    for name, wanted, dof in (
        ("rotation", moment * length / rigidity, 4),
        ("deflection", -moment * length**2 / (2 * rigidity), 2),
        ("shift along the beam", -axis * moment * length / rigidity, 0),
    ):
        unit = "rad" if dof == 4 else "m"
        record.row(f"composite cantilever, {name}", wanted, u[tip[dof]], unit=unit, rtol=1e-6)


def test_stiffened_panel(record):
    """A slab with a rib below, one of many alike: the first frequency of its T-section.

    Half a span between a mirror and a support that holds the deflection only, ribs 0.6 m apart
    over 12 m: so slender that shear lag (1 %) and shear deformation (0.4 %) stay below 2 %.
    """
    material = Material(elastic_modulus=30e9, poisson_ratio=0.0, density=2500.0)
    span, pitch, t, width, depth = 12.0, 0.6, 0.1, 0.15, 0.4
    plan = FloorPlan(
        x_lines=np.array([0.0, span / 2]), y_lines=np.array([pitch / 2]), x_extent=(0.0, span / 2),
        y_extent=(0.0, pitch), slab=ShellSection(thickness=t, material=material), material=material,
        beams_x=Rectangle(width=width, depth=depth),
        edges={"x_min": "symmetry", "y_min": "symmetry", "y_max": "symmetry"},
    )  # fmt: skip
    floor = build_floor(plan, mesh_size=0.1)
    fixed = floor.fixed.copy()
    fixed[np.abs(floor.nodes[:, 0] - span / 2) < 1e-6, 2] = True
    floor = dataclasses.replace(floor, fixed=fixed)
    areas = np.array([pitch * t, width * depth])
    drops = np.array([0.0, -(t + depth) / 2])
    axis = areas @ drops / areas.sum()
    own = np.array([pitch * t**3 / 12, width * depth**3 / 12])
    inertia = own.sum() + areas @ (drops - axis) ** 2
    line_mass = 2500.0 * areas.sum()
    wanted = np.pi / 2 / span**2 * np.sqrt(30e9 * inertia / line_mass)
    f = natural_modes(floor.mass, floor.stiffness, f_max=3 * wanted).frequencies[0]
    record.row("stiffened panel, first frequency", wanted, f, unit="Hz", rtol=0.02)


def test_storey_frame(record):
    """Sway of a portal frame: ``k = 24 E Ic / h^3 (1 + 6 r) / (4 + 6 r)``, r = (Ib / L) / (Ic / h).

    Bernoulli-Euler members without mass, a mass at each corner: exact but for axial strain.
    """
    height, bay, modulus, mass = 4.0, 6.0, 30e9, 1e4
    column_inertia, beam_inertia = 2e-3, 5e-3
    material = Material(elastic_modulus=modulus, poisson_ratio=0.2, density=1e-6)

    def section(inertia):
        return BeamSection(
            area=1e4, inertia_y=inertia, inertia_z=inertia, torsion_constant=inertia,
            shear_area_y=np.inf, shear_area_z=np.inf, material=material,
        )  # fmt: skip

    nodes = np.array([[0.0, 0, 0], [0.0, 0, height], [bay, 0, height], [bay, 0, 0]])
    fixed = np.zeros((4, 6), dtype=bool)
    fixed[[0, 3]] = True
    fixed[:, [1, 3, 5]] = True  # the frame moves in its own plane
    columns, beam = np.array([[0, 1], [3, 2]]), np.array([[1, 2]])
    floor = Floor(
        nodes=nodes, fixed=fixed,
        beams=(
            BeamGroup(elements=columns, section=section(column_inertia), up=np.array([1.0, 0, 0])),
            BeamGroup(elements=beam, section=section(beam_inertia)),
        ),
        masses=(PointMasses(nodes=np.array([1, 2]), mass=mass),),
    )  # fmt: skip
    r = (beam_inertia / bay) / (column_inertia / height)
    stiffness = 24 * modulus * column_inertia / height**3 * (1 + 6 * r) / (4 + 6 * r)
    load = np.zeros(floor.n_dofs)
    load[floor.dof_index[1, 0]] = 1e5
    sway = spsolve(floor.stiffness, load)[floor.dof_index[1, 0]]
    record.row("portal frame, sway under 100 kN", 1e5 / stiffness, sway, unit="m", rtol=1e-4)
    wanted = np.sqrt(stiffness / (2 * mass)) / (2 * np.pi)
    f = natural_modes(floor.mass, floor.stiffness, f_max=2 * wanted).frequencies[0]
    record.row("portal frame, sway frequency", wanted, f, unit="Hz", rtol=1e-3)
