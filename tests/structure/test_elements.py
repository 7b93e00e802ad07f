"""Elements against closed forms: patch tests, rigid motions, beams, plates."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

from models import simple_beam
from trundle.dynamics import natural_modes
from trundle.errors import InputError
from trundle.structure import (
    CONCRETE,
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    PointMasses,
    ShellGroup,
    ShellSection,
    SpringGroup,
)
from trundle.structure.elements.beam import beam_mass, beam_stiffness
from trundle.structure.elements.quad_shell import shell_mass, shell_stiffness

STEEL = Material(elastic_modulus=210e9, poisson_ratio=0.3, density=7850.0)
SLAB = ShellSection(thickness=0.2, material=CONCRETE)

# MacNeal and Harder's patch (Finite Elements in Analysis and Design 1 (1985) 3-20): a
# rectangle of 0.24 x 0.12 with four inner nodes that distort all five elements.
PATCH = np.array(
    [
        [0.0, 0.0], [0.24, 0.0], [0.24, 0.12], [0.0, 0.12],
        [0.04, 0.02], [0.18, 0.03], [0.16, 0.08], [0.08, 0.08],
    ]
)  # fmt: skip
PATCH_ELEMENTS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])


def rotation(seed: int) -> np.ndarray:
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def rigid_motions(nodes: np.ndarray) -> np.ndarray:
    """Return six rigid-body motions over (ux uy uz rx ry rz) of each node."""
    motions = np.zeros((len(nodes), 6, 6))
    motions[:, :3, :3] = np.eye(3)
    motions[:, 3:, 3:] = np.eye(3)
    for axis in range(3):
        motions[:, :3, 3 + axis] = np.cross(np.eye(3)[axis], nodes)
    return motions.reshape(-1, 6)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_distorted_shell_has_exactly_six_rigid_motions(seed):
    """In any orientation: six motions without energy, and no seventh (no hourglass)."""
    flat = np.array([[0.0, 0.0, 0.0], [1.3, 0.1, 0.0], [1.1, 0.9, 0.0], [-0.1, 1.2, 0.0]])
    nodes = flat @ rotation(seed).T + seed
    stiffness = shell_stiffness(nodes[None], SLAB)[0]
    assert np.abs(stiffness @ rigid_motions(nodes)).max() < 1e-9 * np.abs(stiffness).max()
    values = np.linalg.eigvalsh(stiffness)
    assert np.count_nonzero(values < 1e-8 * values[-1]) == 6


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_offset_beam_has_exactly_six_rigid_motions(seed):
    nodes = np.array([[0.0, 0.0, 0.0], [2.0, 1.0, 0.5]]) @ rotation(seed).T
    section = BeamSection.rectangle(0.3, 0.7, CONCRETE)
    stiffness = beam_stiffness(
        nodes[None], section, offset=np.array([0.2, -0.1, -0.45]), up=np.array([0.0, 0.0, 1.0])
    )[0]
    assert np.abs(stiffness @ rigid_motions(nodes)).max() < 1e-9 * np.abs(stiffness).max()
    values = np.linalg.eigvalsh(stiffness)
    assert np.count_nonzero(values < 1e-9 * values[-1]) == 6


def test_masses_move_as_rigid_bodies_do():
    """r^T M r is the mass for a translation, and m (L^2/12 + d^2) + rotary for a rotation."""
    ends = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]])
    section = BeamSection.rectangle(0.3, 0.7, CONCRETE)
    drop = np.array([0.0, 0.0, -0.45])
    mass = beam_mass(ends, section, offset=drop, up=np.array([0.0, 0.0, 1.0]))[0]
    inertia = rigid_motions(ends[0]).T @ mass @ rigid_motions(ends[0])
    m = 2450.0 * 0.21 * 2.0
    assert np.diag(inertia)[:3] == pytest.approx(m, rel=1e-12)
    assert inertia[0, 4] == pytest.approx(m * -0.45, rel=1e-12)  # u_x = ry z of the centroid
    assert inertia[1, 3] == pytest.approx(m * 0.45, rel=1e-12)
    about_x = m * 0.45**2 + 2450.0 * (section.inertia_y + section.inertia_z) * 2.0
    assert inertia[3, 3] == pytest.approx(about_x, rel=1e-12)
    # about y through the first node: m L^2/3 + m d^2 + rotary
    about_y = m * (2.0**2 / 3.0 + 0.45**2) + 2450.0 * section.inertia_y * 2.0
    assert inertia[4, 4] == pytest.approx(about_y, rel=1e-12)
    corners = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]]])
    loaded = ShellSection(thickness=0.2, material=CONCRETE, superimposed_mass=500.0)
    plate = shell_mass(corners, loaded)[0]
    inertia = rigid_motions(corners[0]).T @ plate @ rigid_motions(corners[0])
    assert np.diag(inertia)[:3] == pytest.approx((0.2 * 2450 + 500) * 2.0, rel=1e-12)


def solve_patch(prescribed: np.ndarray) -> np.ndarray:
    """Hold the outer nodes of the patch at a field and solve for the inner ones."""
    nodes = np.column_stack([PATCH, np.zeros(8)])
    section = ShellSection(
        thickness=0.001, material=Material(elastic_modulus=1e6, poisson_ratio=0.25, density=1.0)
    )
    blocks = shell_stiffness(nodes[PATCH_ELEMENTS], section)
    dofs = (PATCH_ELEMENTS[:, :, None] * 6 + np.arange(6)).reshape(len(PATCH_ELEMENTS), -1)
    rows = np.repeat(dofs, 24, axis=1).ravel()
    columns = np.tile(dofs, (1, 24)).ravel()
    stiffness = sparse.csr_array((blocks.ravel(), (rows, columns)), shape=(48, 48)).toarray()
    outer, inner = np.arange(24), np.arange(24, 48)
    solution = prescribed.ravel().copy()
    solution[inner] = np.linalg.solve(
        stiffness[np.ix_(inner, inner)], -stiffness[np.ix_(inner, outer)] @ solution[outer]
    )
    return solution.reshape(8, 6)


def test_membrane_patch():
    """Constant strain on a distorted mesh comes out at every inner node."""
    x, y = PATCH.T
    field = np.zeros((8, 6))
    field[:, 0] = 1e-3 * (x + y / 2)
    field[:, 1] = 1e-3 * (y + x / 2)
    np.testing.assert_allclose(solve_patch(field), field, atol=1e-14)


def test_membrane_patch_with_shear_and_rotation():
    """A shear with a rigid rotation: the drilling dofs must turn by (v,x - u,y) / 2."""
    x, y = PATCH.T
    field = np.zeros((8, 6))
    field[:, 0], field[:, 1] = 2e-3 * y, -1e-3 * x
    field[:, 5] = 0.5 * (-1e-3 - 2e-3)
    np.testing.assert_allclose(solve_patch(field), field, atol=1e-14)


def test_bending_patch():
    """Constant curvature: w = (x^2 + xy + y^2) / 2 with slopes to match."""
    x, y = PATCH.T
    field = np.zeros((8, 6))
    field[:, 2] = 1e-3 * (x**2 + x * y + y**2) / 2
    field[:, 3] = 1e-3 * (y + x / 2)  # rx = dw/dy
    field[:, 4] = -1e-3 * (x + y / 2)  # ry = -dw/dx
    solved = solve_patch(field)
    # deflections within an element are not quadratic; the rotations must be exact
    np.testing.assert_allclose(solved[:, 3:5], field[:, 3:5], atol=1e-12)
    np.testing.assert_allclose(solved[:, 2], field[:, 2], atol=1e-8)


def test_transverse_shear_energy_on_a_distorted_mesh():
    """w linear without rotation is a constant shear strain: the energy is G k t gamma^2 A / 2."""
    nodes = np.column_stack([PATCH, np.zeros(8)])
    field = np.zeros((8, 6))
    field[:, 2] = 2 * PATCH[:, 0] - PATCH[:, 1]
    blocks = shell_stiffness(nodes[PATCH_ELEMENTS], SLAB)
    u = field[PATCH_ELEMENTS].reshape(5, 24)
    energy = 0.5 * np.einsum("ei,eij,ej->", u, blocks, u)
    shear = 5 / 6 * CONCRETE.shear_modulus * 0.2
    assert energy == pytest.approx(0.5 * shear * (2**2 + 1**2) * 0.24 * 0.12, rel=1e-10)


def cantilever(section: BeamSection, length: float, n: int, load: np.ndarray) -> np.ndarray:
    x = np.linspace(0.0, length, n + 1)
    fixed = np.zeros((n + 1, 6), dtype=bool)
    fixed[0] = True
    floor = Floor(
        nodes=np.column_stack([x, 0 * x, 0 * x]),
        fixed=fixed,
        beams=(
            BeamGroup(
                elements=np.column_stack([np.arange(n), np.arange(1, n + 1)]), section=section
            ),
        ),
    )
    force = np.zeros(floor.n_dofs)
    force[floor.dof_index[-1]] = load
    return spsolve(floor.stiffness, force)[floor.dof_index[-1]]


@pytest.mark.parametrize("n", [1, 3])
def test_timoshenko_cantilever(n):
    """P L^3 / 3 E I + P L / G As at the tip, exact with one element, in both planes; torsion."""
    section, length, p = BeamSection.rectangle(0.3, 0.7, STEEL), 2.0, 1e4
    e, g = STEEL.elastic_modulus, STEEL.shear_modulus
    tip = cantilever(section, length, n, np.array([0.0, p, p, p, 0.0, 0.0]))
    shear = p * length / (g * 5 / 6 * 0.21)
    assert tip[2] == pytest.approx(p * length**3 / (3 * e * 0.3 * 0.7**3 / 12) + shear, rel=1e-9)
    assert tip[1] == pytest.approx(p * length**3 / (3 * e * 0.7 * 0.3**3 / 12) + shear, rel=1e-9)
    assert tip[4] == pytest.approx(-p * length**2 / (2 * e * 0.3 * 0.7**3 / 12), rel=1e-9)
    assert tip[3] == pytest.approx(p * length / (g * section.torsion_constant), rel=1e-9)


def test_torsion_constant_of_rectangles():
    """Timoshenko and Goodier, Theory of Elasticity, table 7: J = k1 b^3 d."""
    for ratio, k1 in ((1.0, 0.1406), (1.5, 0.196), (2.0, 0.229), (3.0, 0.263), (10.0, 0.312)):
        section = BeamSection.rectangle(0.3, 0.3 * ratio, CONCRETE)
        assert section.torsion_constant == pytest.approx(k1 * 0.3**3 * 0.3 * ratio, rel=0.005)


def test_in_plane_bending_of_one_row_of_shells():
    """The incompatible modes carry in-plane bending: a strip of square elements, tip load."""
    n, size, thickness, load = 10, 0.5, 0.2, 1e5
    x = np.linspace(0.0, n * size, n + 1)
    nodes = np.vstack([np.column_stack([x, 0 * x + y, 0 * x]) for y in (0.0, size)])
    row = np.arange(n)
    elements = np.column_stack([row, row + 1, row + n + 2, row + n + 1])
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    fixed[:, 2:5] = True
    fixed[[0, n + 1]] = True
    section = ShellSection(thickness=thickness, material=STEEL)
    floor = Floor(
        nodes=nodes, fixed=fixed, shells=(ShellGroup(elements=elements, section=section),)
    )
    force = np.zeros(floor.n_dofs)
    force[floor.dof_index[[n, 2 * n + 1], 1]] = load / 2
    tip = spsolve(floor.stiffness, force)[floor.dof_index[n, 1]]
    length, inertia = n * size, thickness * size**3 / 12
    exact = load * length**3 / (3 * STEEL.elastic_modulus * inertia)
    exact += load * length / (STEEL.shear_modulus * 5 / 6 * thickness * size)
    assert tip == pytest.approx(exact, rel=0.02)


def test_springs_to_the_ground_and_between_nodes():
    """Two springs in series under a beam's free end: the stiffness of one half."""
    section = BeamSection.rectangle(0.1, 0.1, STEEL)
    nodes = np.array([[0.0, 0, 0], [1.0, 0, 0], [1.0, 0, -1.0], [2.0, 0, -1.0]])
    fixed = np.zeros((4, 6), dtype=bool)
    fixed[[0, 3]] = True
    soft = np.array([0.0, 0.0, 10.0, 0.0, 0.0, 0.0])
    floor = Floor(
        nodes=nodes,
        fixed=fixed,
        beams=(
            BeamGroup(elements=np.array([[2, 3]]), section=section),
            BeamGroup(elements=np.array([[0, 1]]), section=section),
        ),
        springs=(SpringGroup(elements=np.array([[1, -1]]), stiffness=soft * 1e9),),
    )
    force = np.zeros(floor.n_dofs)
    force[floor.dof_index[1, 2]] = 1e6
    u = spsolve(floor.stiffness, force)[floor.dof_index[1, 2]]
    bending = 3 * STEEL.elastic_modulus * section.inertia_z
    flexibility = 1 / bending + 1 / (STEEL.shear_modulus * 5 / 6 * 0.01)
    assert u == pytest.approx(1e6 / (1e10 + 1 / flexibility), rel=1e-9)


def test_a_tuned_mass_on_a_spring_is_part_of_the_floor():
    """A damper mass hung on a spring splits a beam's mode: two frequencies by hand.

    One-mode beam (modal mass m L / 2) with a mass on a spring: the 2 x 2 eigenproblem, within
    the small share of the beam's other modes.
    """
    length, line_mass, rigidity = 10.0, 1000.0, 3.7e7
    beam = simple_beam(length=length, rigidity=rigidity, line_mass=line_mass, n_elements=20)
    omega = (np.pi / length) ** 2 * np.sqrt(rigidity / line_mass)
    mass, stiffness = 100.0, 100.0 * omega**2
    nodes = np.vstack([beam.nodes, [[length / 2, 0.0, -1.0]]])
    fixed = np.vstack([beam.fixed, [[True, True, False, True, True, True]]])
    floor = Floor(
        nodes=nodes,
        fixed=fixed,
        beams=beam.beams,
        springs=(
            SpringGroup(
                elements=np.array([[10, 21]]), stiffness=np.array([0, 0, stiffness, 0, 0, 0.0])
            ),
        ),
        masses=(PointMasses(nodes=np.array([21]), mass=mass),),
    )
    modal = line_mass * length / 2
    k = np.array([[modal * omega**2 + stiffness, -stiffness], [-stiffness, stiffness]])
    by_hand = np.sqrt(np.linalg.eigvals(k / np.array([[modal], [mass]]))) / (2 * np.pi)
    computed = natural_modes(floor.mass, floor.stiffness, f_max=20.0).frequencies[:2]
    np.testing.assert_allclose(computed, np.sort(by_hand.real), rtol=2e-3)


@pytest.mark.parametrize(
    ("corners", "match"),
    [
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], "no area|inside out"),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], "warped"),
    ],
)
def test_bad_shells_are_refused(corners, match):
    with pytest.raises(InputError, match=match):
        shell_stiffness(np.array([corners], dtype=float), SLAB)


def test_the_mass_of_a_shell_is_consistent():
    """Bilinear shapes on a rectangle: 4, 2, 1, 2 parts of 36 between its corners."""
    corners = np.array([[[0.0, 0, 0], [2.0, 0, 0], [2.0, 1.0, 0], [0.0, 1.0, 0]]])
    block = shell_mass(corners, SLAB)[0]
    total = SLAB.mass_per_area * 2.0
    for dof in range(3):
        np.testing.assert_allclose(
            block[dof, dof::6], total * np.array([4.0, 2.0, 1.0, 2.0]) / 36.0, rtol=1e-9
        )


def test_a_node_moves_in_what_its_elements_carry_alone():
    """Of a node on a spring that is stiff upright alone there is one dof, and none is singular."""
    steel = Material(elastic_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    section = BeamSection(
        area=1e-2, inertia_y=1e-5, inertia_z=1e-5, torsion_constant=1e-5,
        shear_area_y=np.inf, shear_area_z=np.inf, material=steel,
    )  # fmt: skip
    fixed = np.zeros((3, 6), dtype=bool)
    fixed[0] = True
    upright = np.array([0.0, 0.0, 1e6, 0.0, 0.0, 0.0])
    floor = Floor(
        nodes=np.array([[0.0, 0, 0], [2.0, 0, 0], [2.0, 0, -1.0]]),
        fixed=fixed,
        beams=(BeamGroup(elements=np.array([[0, 1]]), section=section),),
        springs=(SpringGroup(elements=np.array([[1, 2]]), stiffness=upright),),
    )
    assert (floor.dof_index[2] >= 0).tolist() == [False, False, True, False, False, False]
    assert floor.n_dofs == 6 + 1
    assert np.linalg.matrix_rank(floor.stiffness.toarray()) == floor.n_dofs


def test_masses_of_nodes_are_each_their_own():
    """Given by node or all at once; the mass matrix holds each three times, and none below 0."""
    group = PointMasses(nodes=np.array([4, 7]), mass=np.array([2.0, 5.0]))
    blocks = group.mass_blocks(np.zeros((2, 1, 3)))
    assert [np.diag(block).tolist() for block in blocks] == [
        [m] * 3 + [0.0] * 3 for m in (2.0, 5.0)
    ]
    assert PointMasses(nodes=np.array([4, 7]), mass=3.0).mass.tolist() == [3.0, 3.0]
    with pytest.raises(InputError, match="0 or more"):
        PointMasses(nodes=np.array([4]), mass=-1.0)
