"""Edges of a plan against closed forms of one span, and against each other."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.dynamics import natural_modes
from trundle.structure import (
    FloorPlan,
    Material,
    Rectangle,
    ShellSection,
    arching,
    build_floor,
)

LENGTH, WIDTH, SLAB, BEAM = 12.0, 3.0, 0.2, (0.4, 0.8)
MODULUS, DENSITY = 33e9, 2450.0


def hanging_floor(**changes):
    """Return a slab with two beams below it over one span, on bearings unless said otherwise.

    Without lateral contraction the closed form of a beam is that of the floor.
    """
    material = Material(elastic_modulus=MODULUS, poisson_ratio=0.0, density=DENSITY)
    plan = FloorPlan(
        x_lines=np.array([0.0, LENGTH]),
        y_lines=np.array([0.75, 2.25]),
        x_extent=(0.0, LENGTH),
        y_extent=(0.0, WIDTH),
        slab=ShellSection(thickness=SLAB, material=material),
        material=material,
        beams_x=Rectangle(width=BEAM[0], depth=BEAM[1]),
        edges={"x_min": "simple", "x_max": "simple"},
    )
    return replace(plan, **changes)


def composite():
    """Return area, second moment and Timoshenko's correction of the section, by hand."""
    slab, beams = WIDTH * SLAB, 2 * BEAM[0] * BEAM[1]
    apart = 0.5 * (SLAB + BEAM[1])
    inertia = slab * SLAB**2 / 12 + beams * BEAM[1] ** 2 / 12
    inertia += slab * beams / (slab + beams) * apart**2
    area = slab + beams
    # shear on the beams alone, G = E / 2, shear area 5/6; rotary inertia of the whole section
    soft = (np.pi / LENGTH) ** 2 * (inertia / (0.5 * 5 / 6 * beams) + inertia / area)
    return area, inertia, soft


def first(plan, mesh_size=0.5, f_max=30.0):
    """Return the first natural frequencies [Hz]."""
    floor = build_floor(plan, mesh_size=mesh_size)
    return natural_modes(floor.mass, floor.stiffness, f_max=f_max).frequencies


def test_simple_edges_let_hanging_beams_bend_as_one_section():
    """First frequency pi / 2 / L^2 sqrt(EI / m) of the composite section, 12.11 Hz.

    Shear and rotary inertia take 1.75 % of it (Timoshenko, first order): 0.5 % is left to the mesh.
    """
    area, inertia, soft = composite()
    slender = np.pi / 2 / LENGTH**2 * np.sqrt(MODULUS * inertia / DENSITY / area)
    assert slender == pytest.approx(12.11, abs=0.005)
    found = first(hanging_floor())[0]
    assert found == pytest.approx(slender / np.sqrt(1.0 + soft), rel=0.005)


def test_a_half_floor_on_a_mirror_has_the_symmetric_modes_of_the_whole():
    """Invariant: the plane of symmetry cuts the floor where the sliding is held."""
    half = hanging_floor(
        x_lines=np.array([0.0, 0.5 * LENGTH]),
        x_extent=(0.0, 0.5 * LENGTH),
        edges={"x_min": "simple", "x_max": "symmetry"},
    )
    np.testing.assert_allclose(first(half), first(hanging_floor()), rtol=1e-6)


@pytest.mark.parametrize("sides", [("x_min", "x_max"), ("x_min", "y_max"), ("y_min", "y_max")])
def test_what_holds_the_plane_of_a_flat_slab_does_not_touch_its_bending(sides):
    """Invariant: without eccentric beams bending and plane are apart, whatever holds the plane."""
    flat = hanging_floor(beams_x=None)
    simple, pinned = (
        first(replace(flat, edges=dict.fromkeys(sides, kind)), f_max=90.0)
        for kind in ("simple", "pinned")
    )
    bending = simple[np.abs(simple[:, None] - pinned).min(axis=1) < 1e-6 * simple]
    assert len(bending) >= 2
    np.testing.assert_allclose(bending[:2], pinned[:2], rtol=1e-6)


def test_what_is_added_to_hold_the_plane_carries_nothing_at_rest():
    """Invariant: statically determinate restraints have no reaction to a vertical load."""
    floor = build_floor(hanging_floor(), mesh_size=1.0)
    added = np.flatnonzero(floor.fixed[:, 0])
    assert len(added) == 1  # motion along x is all that the two bearings leave free
    fixed = np.array(floor.fixed)
    fixed[added, 0] = False
    loose = replace(floor, fixed=fixed)
    u = np.zeros(floor.fixed.shape)
    weight = floor.mass @ floor.rigid_vector(2)
    u[floor.dof_index >= 0] = np.linalg.solve(floor.stiffness.toarray(), weight)
    rest = loose.stiffness @ u[loose.dof_index >= 0]
    reaction = rest[loose.dof_index[added[0], 0]]
    assert abs(reaction) < 1e-7 * np.abs(weight).sum()


def test_pinned_edges_arch_by_as_much_as_the_closed_form_says():
    """Both ends held: 14.93 Hz by the closed form with end springs; ours has shear on top."""
    _, _, soft = composite()
    times = arching(hanging_floor(edges={"x_min": "pinned", "x_max": "pinned"}), "x")
    assert 12.11 * np.sqrt(times) == pytest.approx(14.93, abs=0.02)
    pinned = first(hanging_floor(edges={"x_min": "pinned", "x_max": "pinned"}))[0]
    # shear takes more of a stiffer span: between once and twice the share of the simple one
    assert 14.93 / (1.0 + soft) < pinned < 14.93 / np.sqrt(1.0 + soft)


@pytest.mark.parametrize(
    "changes",
    [
        {"edges": {"x_min": "pinned", "x_max": "simple"}},
        {"edges": {"x_min": "clamped", "x_max": "clamped"}},
        {"edges": {"x_min": "symmetry", "x_max": "symmetry"}},
        {"edges": {"y_min": "pinned", "y_max": "pinned"}},
        {"edges": {"x_min": "pinned", "x_max": "pinned"}, "eccentric_beams": False},
        {"edges": {"x_min": "pinned", "x_max": "pinned"}, "beams_x": None},
    ],
)
def test_nothing_arches(changes):
    """A sliding end, ends that cannot rotate, no beams along the axis or none below the slab."""
    plan = hanging_floor(**changes)
    assert (arching(plan, "x"), arching(plan, "y")) == (1.0, 1.0)


def test_half_a_span_arches_like_the_whole():
    """Invariant: a plane of symmetry is the middle of the span."""
    whole = arching(hanging_floor(edges={"x_min": "pinned", "x_max": "pinned"}), "x")
    half = arching(hanging_floor(edges={"x_min": "symmetry", "x_max": "pinned"}), "x")
    assert half == pytest.approx(whole)
