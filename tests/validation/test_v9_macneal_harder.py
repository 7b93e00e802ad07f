"""V9: four-node and three-node shells on the set of MacNeal and Harder, and the obstacle course.

R. H. MacNeal and R. L. Harder, A proposed standard set of problems to test finite element accuracy,
Finite Elements in Analysis and Design 1 (1985) 3-20. Meshes are finer than theirs where it is said.
"""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve
from shells import KINDS, moved, shell

CASE = "V9"
SOURCE = "MacNeal and Harder (1985)"

# --- straight, curved and twisted cantilevers


def slender(shape, finer=1):
    """Nodes of the straight beam of 6 by 0.2: regular, or its inner lines turned by 45 degrees."""
    n = 6 * finer
    x, y = np.meshgrid(np.linspace(0, 6, n + 1), np.linspace(0.0, 0.2, finer + 1), indexing="ij")
    lean = {"rectangles": 0.0, "parallelograms": 1.0, "trapezoids": (-1.0) ** np.arange(n + 1)}
    turned = np.broadcast_to(lean[shape], n + 1).copy()
    turned[[0, -1]] = 0.0
    # two lines lean towards each other by no more than there is room
    x = x + np.minimum(1.0, 1.0 / finer) * turned[:, None] * (y - 0.1)
    return np.stack([x, y, 0.0 * x], axis=2)


LOADS = {"extension": (0, 3.0e-5), "in-plane shear": (1, 0.1081), "out-of-plane shear": (2, 0.4321)}


def tip(places, thickness, elastic_modulus, poisson, kind, dof):
    """Mean motion of the far edge of a cantilever under a unit force on it."""
    fixed = np.zeros((*places.shape[:2], 6), dtype=bool)
    fixed[0] = True
    floor = shell(places, thickness, elastic_modulus, poisson, fixed, kind)
    n = places.shape[1]
    far = np.arange((places.shape[0] - 1) * n, places.shape[0] * n)
    share = np.ones(n)
    share[1:-1] = 2.0
    share /= share.sum()
    u = moved(floor, {(node, dof): s for node, s in zip(far, share, strict=True)})
    return float(share @ u[far, dof])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("shape", ["rectangles", "parallelograms", "trapezoids"])
def test_straight_cantilever(record, shape, load, kind):
    """6 x 0.2 x 0.1 under unit forces at the tip: 6 elements; 8 times as fine within 2.5 %.

    In its plane, turned four-node elements that pass the patch test must be stiff when they are
    few (MacNeal 1987: 0.05 on trapezoids, as is published of them); what counts is that they
    converge, and that rectangles carry it at once.
    """
    dof, wanted = LOADS[load]
    coarse, fine = (tip(slender(shape, n), 0.1, 1e7, 0.3, kind, dof) for n in (1, 8))
    at_once = shape == "rectangles" or load != "in-plane shear"
    if at_once:
        record.row(
            f"straight beam, {shape}, {kind}, {load}, 6 elements", wanted, coarse, rtol=0.055
        )
    record.row(f"straight beam, {shape}, {kind}, {load}, 48 by 8", wanted, fine, rtol=0.025)


@pytest.mark.parametrize("kind", KINDS)
def test_curved_cantilever(record, kind):
    """A quarter circle, radii 4.12 and 4.32, in its plane: 12 x 2 and 24 x 4 elements, 1.5 %.

    Out of its plane (Castigliano): ``P R^3 (pi/4 / EI + (3 pi/4 - 2) / GJ)``, with ``J = b t^3 / 3``
    for plates without shear, and Saint-Venant's, 0.229 b t^3, for those with it.
    """
    e, radius, b, t = 1e7, 4.22, 0.2, 0.1
    torsion = {"triangles": b * t**3 / 3.0, "quadrilaterals": 0.229 * b * t**3}[kind]
    stiffness = e * b * t**3 / 12.0, e / 2.5 * torsion
    across = radius**3 * (np.pi / 4 / stiffness[0] + (0.75 * np.pi - 2.0) / stiffness[1])
    for n in (12, 24):
        angle, r = np.linspace(0.0, np.pi / 2, n + 1), np.linspace(4.12, 4.32, n // 6 + 1)
        turn, rings = np.meshgrid(angle, r, indexing="ij")
        places = np.stack([rings * np.sin(turn), rings * np.cos(turn), 0.0 * turn], axis=2)
        found = tip(places, t, e, 0.25, kind, 0)
        record.row(f"curved beam, in plane, {kind}, {n} elements", 0.08734, found, rtol=0.015)
    found = tip(places, t, e, 0.25, kind, 2)
    record.row(f"curved beam, out of plane, {kind}", across, found, rtol=0.03, source="Castigliano")


@pytest.mark.parametrize(("dof", "wanted"), [(1, 0.001754), (2, 0.005424)])
def test_twisted_cantilever(record, dof, wanted):
    """Twisted by a right angle over its length: triangles; quadrilaterals would not be flat."""
    x, s = np.linspace(0.0, 12.0, 25), np.linspace(-0.55, 0.55, 5)
    turn = x / 12.0 * np.pi / 2
    flat = np.broadcast_to(x[:, None], (25, 5))
    places = np.stack([flat, s * np.cos(turn)[:, None], s * np.sin(turn)[:, None]], axis=2)
    found = tip(places, 0.32, 29e6, 0.22, "triangles", dof)
    record.row(f"twisted beam, force along {'xyz'[dof]}", wanted, found, rtol=0.01)


# --- plates


PLATES = {  # support, length: under pressure, under a force in the middle
    ("simple", 2.0): (4.062, 11.60),
    ("simple", 10.0): (12.97, 16.96),
    ("clamped", 2.0): (1.26, 5.60),
    ("clamped", 10.0): (1000.0 / 384.0, 7.23),  # a strip, q a^4 / 384 D; the paper has 2.56
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("edge", "length"), PLATES)
def test_thin_rectangular_plates(record, edge, length, kind):
    """2 by 2 and 2 by 10, 0.0001 thick: a quarter of 16 x 16 elements, aspects 1 and 5: 2 %."""
    n = 16
    x, y = np.meshgrid(
        np.linspace(0.0, 1.0, n + 1), np.linspace(0.0, length / 2, n + 1), indexing="ij"
    )
    fixed = np.zeros((n + 1, n + 1, 6), dtype=bool)
    fixed[..., [0, 1, 5]] = True
    fixed[0, :, 4] = fixed[:, 0, 3] = True  # planes of symmetry
    for side, across, along in (((-1, slice(None)), 4, 3), ((slice(None), -1), 3, 4)):
        fixed[(*side, 2)] = fixed[(*side, along)] = True
        fixed[(*side, across)] |= edge == "clamped"
    places = np.stack([x, y, 0.0 * x], axis=2)
    floor = shell(places, 1e-4, 1.7472e7, 0.3, fixed, kind)
    pressure = 1e-4 * floor.inertia_of(2) / 1e-4  # of density 1 and thickness 1e-4
    middle = floor.dof_index[0, 2]
    under_pressure = spsolve(floor.stiffness, pressure)[middle]
    under_force = moved(floor, {(0, 2): 1e-4})[0, 2]
    for name, wanted, found in zip(
        ("pressure", "force"), PLATES[edge, length], (under_pressure, under_force), strict=True
    ):
        record.row(f"plate 2 by {length:g}, {edge}, {name}, {kind}", wanted, found, rtol=0.02)


# --- shells


@pytest.mark.parametrize("kind", KINDS)
def test_scordelis_lo_roof(record, kind):
    """A barrel vault on diaphragms under its weight: its free edge sinks by 0.3024 at midspan."""
    n = 16
    angle, x = np.meshgrid(
        np.radians(np.linspace(0.0, 40.0, n + 1)), np.linspace(0.0, 25.0, n + 1), indexing="ij"
    )
    places = np.stack([25.0 * np.sin(angle), x, 25.0 * np.cos(angle)], axis=2)
    fixed = np.zeros((n + 1, n + 1, 6), dtype=bool)
    fixed[0][:, [0, 4, 5]] = True  # the crown: symmetric across x
    fixed[:, 0][:, [1, 3, 5]] = True  # midspan
    fixed[:, -1][:, [0, 2]] = True  # the diaphragm
    floor = shell(places, 0.25, 4.32e8, 0.0, fixed, kind)
    sinks = spsolve(floor.stiffness, -90.0 / 0.25 * floor.inertia_of(2))
    edge = n * (n + 1)
    record.row(f"Scordelis-Lo roof, {kind}", -0.3024, sinks[floor.dof_index[edge, 2]], rtol=0.03)


@pytest.mark.parametrize("kind", KINDS)
def test_hemisphere_with_a_hole(record, kind):
    """Radius 10, 0.04 thick, two pairs of unit forces at its equator: 0.094 outwards at a force."""
    n = 24
    turn, up = np.meshgrid(
        np.linspace(0.0, np.pi / 2, n + 1), np.radians(np.linspace(0.0, 72.0, n + 1)), indexing="ij"
    )
    places = 10.0 * np.stack(
        [np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)], axis=2
    )
    fixed = np.zeros((n + 1, n + 1, 6), dtype=bool)
    fixed[0][:, [1, 3, 5]] = True
    fixed[-1][:, [0, 4, 5]] = True
    fixed[0, 0, 2] = True
    floor = shell(places, 0.04, 6.825e7, 0.3, fixed, kind)
    other = n * (n + 1)
    u = moved(floor, {(0, 0): 1.0, (other, 1): -1.0})
    record.row(f"hemisphere, {kind}", 0.094, u[0, 0], rtol=0.03)
    record.row(f"hemisphere, the other force, {kind}", -0.094, u[other, 1], rtol=0.03)
