"""Flat shells of four and three nodes: turned, renumbered, strained evenly, and their masses."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.structure import CONCRETE, Material, OrthotropicSection, ShellSection
from trundle.structure.elements.quad_shell import shell_mass, shell_stiffness
from trundle.structure.elements.triangle_shell import triangle_mass, triangle_stiffness

SLAB = ShellSection(thickness=0.2, material=CONCRETE, superimposed_mass=150.0)
RIBS = OrthotropicSection(
    bending=(4e7, 2e7, 3e6, 5e6), membrane=(6e9, 5e9, 1e9, 2e9), shear=(2e9, 1.5e9),
    mass_per_area=400.0, rotary_inertia=3.0, thickness=0.3, axis=np.array([0.6, 0.8, 0.0]),
)  # fmt: skip
QUAD = np.array([[0.0, 0.0, 0.0], [2.1, 0.2, 0.0], [1.8, 1.5, 0.0], [-0.2, 1.1, 0.0]])
TRIANGLE = QUAD[:3]
BOTH = [(QUAD, shell_stiffness, shell_mass), (TRIANGLE, triangle_stiffness, triangle_mass)]


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def area_of(corners):
    x, y = corners[:, 0], corners[:, 1]
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


@pytest.mark.parametrize(("corners", "stiffness", "mass"), BOTH, ids=["quad", "triangle"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_plate_turned_in_space_is_the_plate_turned(corners, stiffness, mass, seed):
    """Invariant: ``R K R^T`` and ``R M R^T``, of ribs too if their axis turns with them."""
    turn = rotation(seed)
    whole = np.kron(np.eye(2 * len(corners)), turn)
    moved = (corners @ turn.T + 5.0)[None]
    for section in (SLAB, RIBS):
        other = section if section is SLAB else replace(section, axis=turn @ section.axis)
        for make in (stiffness, mass):
            level, turned = make(corners[None], section)[0], make(moved, other)[0]
            np.testing.assert_allclose(
                turned, whole @ level @ whole.T, atol=1e-9 * np.abs(level).max()
            )


@pytest.mark.parametrize(("corners", "stiffness", "mass"), BOTH, ids=["quad", "triangle"])
@pytest.mark.parametrize("backwards", [False, True])
def test_it_does_not_matter_where_round_a_plate_one_begins(corners, stiffness, mass, backwards):
    """Invariant: any corner first, and either way round: the same matrices, rows renamed."""
    n = len(corners)
    for shift in range(n):
        order = np.roll(np.arange(n), -shift)
        order = order[::-1] if backwards else order
        rows = (6 * order[:, None] + np.arange(6)).ravel()
        for section in (SLAB, RIBS):
            for make in (stiffness, mass):
                one = make(corners[None], section)[0]
                other = make(corners[order][None], section)[0]
                np.testing.assert_allclose(
                    other, one[np.ix_(rows, rows)], atol=1e-9 * np.abs(one).max()
                )


def strained(corners, membrane, curvature):
    """Return nodes' motion under an even strain (xx, yy, xy) and an even curvature.

    u = exx x + gxy y / 2 and so on; w = -(kxx x^2 + kyy y^2 + kxy x y) / 2 has curvatures k.
    """
    x, y = corners[:, 0], corners[:, 1]
    out = np.zeros((len(corners), 6))
    out[:, 0] = membrane[0] * x + membrane[2] * y / 2.0
    out[:, 1] = membrane[1] * y + membrane[2] * x / 2.0
    out[:, 2] = -(curvature[0] * x**2 + curvature[1] * y**2 + curvature[2] * x * y) / 2.0
    out[:, 3] = -(curvature[1] * y + curvature[2] * x / 2.0)  # dw/dy
    out[:, 4] = curvature[0] * x + curvature[2] * y / 2.0  # -dw/dx
    return out.ravel()


def law_of(numbers, degrees):
    """Turn a law of a plate from its own axes to x and y, by energies of unit strains in tensors.

    Of a strain tensor S the plate's own strains are those of Q S Q^T.
    """
    x, y, both, twist = numbers
    own = np.array([[x, both, 0.0], [both, y, 0.0], [0.0, 0.0, twist]])
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    q = np.array([[c, s], [-s, c]])
    columns = []
    for unit in np.eye(3):
        tensor = np.array([[unit[0], unit[2] / 2.0], [unit[2] / 2.0, unit[1]]])
        turned = q @ tensor @ q.T
        columns.append([turned[0, 0], turned[1, 1], 2.0 * turned[0, 1]])
    ways = np.array(columns).T
    return ways.T @ own @ ways


@pytest.mark.parametrize("degrees", [0.0, 30.0, 90.0, -50.0])
@pytest.mark.parametrize(("corners", "stiffness"), [b[:2] for b in BOTH], ids=["quad", "triangle"])
def test_even_strain_of_ribs_at_any_angle_has_the_energy_of_their_law(corners, stiffness, degrees):
    """``A / 2 (e^T C e + k^T D k)``, with laws turned as tensors: exact on any shape of element.

    Of a distorted quadrilateral stretching alone: it holds no deflection that is quadratic.
    """
    section = RIBS.turned(degrees)
    k = stiffness(corners[None], section)[0]
    stretch = np.array([1e-3, -4e-4, 7e-4])
    u = strained(corners, stretch, np.zeros(3))
    expected = 0.5 * area_of(corners) * stretch @ law_of(RIBS.membrane, degrees) @ stretch
    assert 0.5 * u @ k @ u == pytest.approx(expected, rel=1e-9)
    if len(corners) == 3:
        bent = np.array([2e-3, 5e-4, -1e-3])
        u = strained(corners, np.zeros(3), bent)
        expected = 0.5 * area_of(corners) * bent @ law_of(RIBS.bending, degrees) @ bent
        assert 0.5 * u @ k @ u == pytest.approx(expected, rel=1e-9)


def test_a_rectangle_of_ribs_twists_and_bends_by_their_law():
    """On a rectangle with sides along the ribs MITC4 holds even curvatures: the energy is exact."""
    corners = np.array([[0.0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]])
    section = replace(RIBS, axis=np.array([1.0, 0.0, 0.0]))
    k = shell_stiffness(corners[None], section)[0]
    for bent in ([1e-3, 0, 0], [0, 1e-3, 0], [0, 0, 1e-3], [1e-3, -2e-3, 5e-4]):
        u = strained(corners, np.zeros(3), bent)
        expected = 0.5 * 2.0 * np.array(bent) @ law_of(RIBS.bending, 0.0) @ bent
        assert 0.5 * u @ k @ u == pytest.approx(expected, rel=1e-9)


def rigid(corners):
    motions = np.zeros((len(corners), 6, 6))
    motions[:, range(6), range(6)] = 1.0
    for axis in range(3):
        motions[:, :3, 3 + axis] = np.cross(np.eye(3)[axis], corners)
    return motions.reshape(-1, 6)


def test_a_triangle_has_the_mass_and_the_moments_of_its_area():
    """m, m times the centroid, and ``m / 36 (a^2 + b^2 + c^2)`` about it, with rotary inertia.

    A shape that is linear is exact in the plane, and so is the cubic one for a rigid motion.
    """
    inertia = rigid(TRIANGLE).T @ triangle_mass(TRIANGLE[None], SLAB)[0] @ rigid(TRIANGLE)
    area, centre = area_of(TRIANGLE), TRIANGLE.mean(axis=0)
    mass = (2450.0 * 0.2 + 150.0) * area
    np.testing.assert_allclose(np.diag(inertia)[:3], mass, rtol=1e-9)
    assert inertia[1, 5] == pytest.approx(mass * centre[0], rel=1e-9)
    assert inertia[2, 3] == pytest.approx(mass * centre[1], rel=1e-9)
    sides = np.sum((TRIANGLE - np.roll(TRIANGLE, 1, axis=0)) ** 2)
    rotary = 2450.0 * 0.2**3 / 12.0 * area
    about = mass * (sides / 36.0 + centre @ centre)
    assert inertia[5, 5] == pytest.approx(about + rotary, rel=1e-9)
    assert inertia[3, 3] + inertia[4, 4] == pytest.approx(about + 2.0 * rotary, rel=1e-9)


def test_a_rectangle_turns_about_its_middle_with_its_moment_of_inertia():
    """``m (a^2 + b^2) / 12`` about z, ``m b^2 / 12`` about x, and the slab's own rotary inertia."""
    a, b = 2.0, 1.2
    corners = np.array([[-a, -b, 0], [a, -b, 0], [a, b, 0], [-a, b, 0]]) / 2.0
    inertia = rigid(corners).T @ shell_mass(corners[None], SLAB)[0] @ rigid(corners)
    mass, rotary = (2450.0 * 0.2 + 150.0) * a * b, 2450.0 * 0.2**3 / 12.0 * a * b
    expected = [mass] * 3 + [
        mass * b**2 / 12.0 + rotary, mass * a**2 / 12.0 + rotary,
        mass * (a**2 + b**2) / 12.0 + rotary,
    ]  # fmt: skip
    np.testing.assert_allclose(inertia, np.diag(expected), atol=1e-9 * mass)


def test_elements_that_are_folded_or_warped_are_told_by_their_number():
    """The second of three is the bad one; 0.1 % of warp is allowed, and twice that is not."""
    good = QUAD[None]
    bow_tie = QUAD[None, [0, 1, 3, 2]]
    with pytest.raises(InputError, match=r"shell element 1 (is turned inside out|has no area)"):
        shell_stiffness(np.concatenate([good, bow_tie, good]), SLAB)
    dented = np.array([[0.0, 0, 0], [2, 0, 0], [0.3, 0.3, 0], [0, 2, 0]])
    with pytest.raises(InputError, match="shell element 1 is turned inside out"):
        shell_stiffness(np.concatenate([good, dented[None], good]), SLAB)
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    for lift, refused in ((0.003, False), (0.012, True)):
        warped = square.copy()
        warped[2, 2] = lift  # a quarter of it is the warp of each corner; the size is sqrt 2
        if refused:
            with pytest.raises(InputError, match=r"shell element 0 is warped by 0.21 %"):
                shell_stiffness(warped[None], SLAB)
        else:
            assert shell_stiffness(warped[None], SLAB).shape == (1, 24, 24)


def test_a_needle_is_no_triangle():
    """Three corners on a line, to round-off: it has no frame and no area."""
    line = np.array([[[0.0, 0, 0], [1, 1, 0], [3, 3, 1e-13]]])
    with pytest.raises(InputError, match="shell element 0 has no area"):
        triangle_stiffness(line, SLAB)


def test_laws_of_an_isotropic_plate_by_hand():
    """E t / (1 - nu^2), E t^3 / 12 (1 - nu^2), nu of both, G t, 5/6 G t: 30 GPa, 0.2, 0.2 m."""
    laws = SLAB.laws(np.eye(3)[None])
    stretch, bend = 30e9 * 0.2 / 0.96, 30e9 * 0.2**3 / 12.0 / 0.96
    shear = 12.5e9 * 0.2
    np.testing.assert_allclose(laws.membrane, [[stretch, 0.2 * stretch, 0],
                                               [0.2 * stretch, stretch, 0], [0, 0, shear]])  # fmt: skip
    np.testing.assert_allclose(laws.bending, [[bend, 0.2 * bend, 0], [0.2 * bend, bend, 0],
                                              [0, 0, 12.5e9 * 0.2**3 / 12.0]])  # fmt: skip
    np.testing.assert_allclose(laws.shear, 5.0 / 6.0 * shear * np.eye(2))
    assert SLAB.mass_per_area == pytest.approx(640.0)
    with pytest.raises(InputError, match=r"poisson_ratio must be in \[0, 0\.4999\]; got 0\.5"):
        Material(elastic_modulus=1.0, poisson_ratio=0.5, density=1.0)
