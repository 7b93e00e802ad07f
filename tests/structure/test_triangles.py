"""Three-node shells against closed forms, and how a wheel stands on them beside quadrilaterals."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from trundle.dynamics import natural_modes
from trundle.errors import InputError
from trundle.route import contact_rows
from trundle.structure import (
    CONCRETE,
    Floor,
    Hat,
    Hermite,
    Material,
    ShellGroup,
    ShellSection,
    TriangleGroup,
)
from trundle.structure.elements.standing import triangle_locate, triangle_weights
from trundle.structure.elements.triangle_shell import triangle_mass, triangle_stiffness

SLAB = ShellSection(thickness=0.2, material=CONCRETE)
SOFT = ShellSection(
    thickness=0.001, material=Material(elastic_modulus=1e6, poisson_ratio=0.25, density=1.0)
)
# MacNeal and Harder's patch (Finite Elements in Analysis and Design 1 (1985) 3-20), its five
# quadrilaterals cut along one diagonal each
PATCH = np.array(
    [
        [0.0, 0.0], [0.24, 0.0], [0.24, 0.12], [0.0, 0.12],
        [0.04, 0.02], [0.18, 0.03], [0.16, 0.08], [0.08, 0.08],
    ]
)  # fmt: skip
QUADS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])
TRIANGLES = np.vstack([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def rigid_motions(nodes):
    """Six rigid-body motions over (ux uy uz rx ry rz) of each node."""
    motions = np.zeros((len(nodes), 6, 6))
    motions[:, :3, :3] = np.eye(3)
    motions[:, 3:, 3:] = np.eye(3)
    for axis in range(3):
        motions[:, :3, 3 + axis] = np.cross(np.eye(3)[axis], nodes)
    return motions.reshape(-1, 6)


def assembled(nodes, triangles, section):
    stiffness = np.zeros((6 * len(nodes), 6 * len(nodes)))
    for corners, block in zip(
        triangles, triangle_stiffness(nodes[triangles], section), strict=True
    ):
        dofs = (corners[:, None] * 6 + np.arange(6)).ravel()
        stiffness[np.ix_(dofs, dofs)] += block
    return stiffness


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_triangle_has_exactly_six_rigid_motions(seed):
    """In any orientation: six motions without energy, and no seventh."""
    flat = np.array([[0.0, 0.0, 0.0], [1.3, 0.1, 0.0], [0.4, 0.9, 0.0]])
    nodes = flat @ rotation(seed).T + seed
    stiffness = triangle_stiffness(nodes[None], SLAB)[0]
    assert np.abs(stiffness @ rigid_motions(nodes)).max() < 1e-12 * np.abs(stiffness).max()
    values = np.linalg.eigvalsh(stiffness)
    assert np.count_nonzero(values < 1e-8 * values[-1]) == 6
    mass = triangle_mass(nodes[None], SLAB)[0]
    inertia = rigid_motions(nodes).T @ mass @ rigid_motions(nodes)
    area = 0.5 * np.linalg.norm(np.cross(flat[1], flat[2]))
    np.testing.assert_allclose(np.diag(inertia)[:3], 0.2 * 2450.0 * area, rtol=1e-12)


def patched(field):
    """Hold the outer nodes of the patch at a field and solve for the inner ones."""
    stiffness = assembled(np.column_stack([PATCH, np.zeros(8)]), TRIANGLES, SOFT)
    outer, inner = np.arange(24), np.arange(24, 48)
    solution = field.ravel().copy()
    solution[inner] = np.linalg.solve(
        stiffness[np.ix_(inner, inner)], -stiffness[np.ix_(inner, outer)] @ solution[outer]
    )
    return solution.reshape(8, 6)


def test_patches():
    """Constant strain with a rotation, and constant curvature, come out at every inner node."""
    x, y = PATCH.T
    field = np.zeros((8, 6))
    field[:, 0], field[:, 1] = 1e-3 * (x + 2.0 * y), 1e-3 * (y - x)
    field[:, 5] = 0.5e-3 * (-1.0 - 2.0)
    field[:, 2] = 1e-3 * (x**2 + x * y + y**2) / 2.0
    field[:, 3], field[:, 4] = 1e-3 * (y + x / 2.0), -1e-3 * (x + y / 2.0)
    np.testing.assert_allclose(patched(field), field, atol=1e-13)


@pytest.mark.parametrize("poisson", [0.0, 0.2, 0.3])
@pytest.mark.parametrize("aspect", [1.0, 3.0, 10.0])
@pytest.mark.parametrize("cut", [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]])
def test_a_rectangle_bends_in_its_plane_with_the_energy_of_a_beam(poisson, aspect, cut):
    """Pure bending of two triangles, whatever their aspect: ``E I kappa^2 L / 2`` (Felippa 2003)."""
    section = ShellSection(
        thickness=0.3, material=Material(elastic_modulus=1e7, poisson_ratio=poisson, density=1.0)
    )
    half = np.array([aspect, 1.0]) / 2.0
    flat = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    x, y = flat.T
    u = np.zeros((4, 6))
    u[:, 0], u[:, 1], u[:, 5] = -x * y, 0.5 * x**2 + 0.5 * poisson * y**2, x
    stiffness = assembled(np.column_stack([flat, np.zeros(4)]), np.array(cut), section)
    energy = 0.5 * u.ravel() @ stiffness @ u.ravel()
    assert energy == pytest.approx(0.5 * 1e7 * 0.3 / 12.0 * aspect, rel=1e-9)


def plate(n, *, seed=None):
    """A simply supported square plate of triangles, in rows or scattered."""
    x, y = (g.ravel() for g in np.meshgrid(*[np.linspace(0.0, 6.0, n + 1)] * 2))
    edge = (x % 6.0 == 0.0) | (y % 6.0 == 0.0)
    flat = np.column_stack([x, y])
    if seed is not None:
        shift = np.random.default_rng(seed).uniform(-0.25, 0.25, flat.shape) * 6.0 / n
        flat = flat + np.where(edge[:, None], 0.0, shift)
    found = Delaunay(flat + 1e-9 * np.column_stack([y, -x]))
    triangles = found.simplices
    area = np.linalg.det(flat[triangles][:, 1:] - flat[triangles][:, :1])
    triangles = triangles[np.abs(area) > 1e-6]
    turn = np.linalg.det(flat[triangles][:, 1:] - flat[triangles][:, :1]) < 0.0
    triangles[turn] = triangles[turn][:, [0, 2, 1]]
    fixed = np.zeros((len(flat), 6), dtype=bool)
    fixed[edge, 2] = True
    fixed[:, [0, 1, 5]] = True  # bending alone
    group = TriangleGroup(
        connectivity=triangles, section=ShellSection(thickness=0.1, material=CONCRETE)
    )
    nodes = np.column_stack([flat, np.zeros(len(flat))])
    return Floor(nodes=nodes, fixed=fixed, others=(group,))


def exact(m, n):
    rigidity = CONCRETE.elastic_modulus * 0.1**3 / 12.0 / (1.0 - CONCRETE.poisson_ratio**2)
    wave = (m**2 + n**2) * (np.pi / 6.0) ** 2
    return wave * np.sqrt(rigidity / (CONCRETE.density * 0.1)) / (2.0 * np.pi)


@pytest.mark.parametrize("seed", [None, 4])
def test_plate_frequencies_converge_with_the_square_of_the_size(seed):
    """Kirchhoff's simply supported plate: modes (1,1) to (2,2), regular and scattered meshes."""
    expected = np.array([exact(1, 1), exact(1, 2), exact(2, 1), exact(2, 2)])
    errors = []
    for n in (8, 16):
        floor = plate(n, seed=seed)
        found = natural_modes(floor.mass, floor.stiffness, f_max=60.0).frequencies[:4]
        errors.append(np.abs(found / expected - 1.0).max())
    assert errors[1] < 0.006
    assert errors[0] / errors[1] > 3.0


def test_triangles_that_are_lines_are_refused():
    line = np.array([[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]])
    with pytest.raises(InputError, match="shell element 0 has no area"):
        triangle_stiffness(line, SLAB)


CORNERS = np.array([[0.2, 0.1], [1.7, 0.4], [0.6, 1.5]])


def nodal(w, w_x, w_y, at):
    """(w, rx, ry) at places, with rx = dw/dy and ry = -dw/dx."""
    x, y = at.T
    return np.column_stack([w(x, y), w_y(x, y), -w_x(x, y)]).ravel()


def test_quadratic_deflections_are_exact_on_a_triangle():
    """Value and gradient of w = 1 + 2x - y + x^2 + 3xy - 2y^2, everywhere in it."""
    rng = np.random.default_rng(2)
    area = rng.dirichlet([1.0, 1.0, 1.0], 40)
    places = area @ CORNERS
    many = np.broadcast_to(CORNERS, (40, 3, 2))
    local, outside = triangle_locate(many, places)
    assert outside.max() <= 1e-12
    weights, gradient = triangle_weights(local, many, Hermite())
    x, y = places.T
    u = nodal(
        lambda x, y: 1 + 2 * x - y + x**2 + 3 * x * y - 2 * y**2,
        lambda x, y: 2 + 2 * x + 3 * y, lambda x, y: -1 + 3 * x - 4 * y, CORNERS,
    )  # fmt: skip
    np.testing.assert_allclose(weights @ u, 1 + 2 * x - y + x**2 + 3 * x * y - 2 * y**2, atol=1e-12)
    np.testing.assert_allclose(gradient[:, 0] @ u, 2 + 2 * x + 3 * y, atol=1e-11)
    np.testing.assert_allclose(gradient[:, 1] @ u, -1 + 3 * x - 4 * y, atol=1e-11)


def mixed():
    """A quadrilateral beside two triangles."""
    nodes = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [4, 0.5, 0], [3.5, 2, 0]], float)
    return Floor(
        nodes=nodes, fixed=np.zeros((6, 6), dtype=bool),
        shells=(ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=SLAB),),
        others=(TriangleGroup(connectivity=np.array([[1, 4, 2], [4, 5, 2]]), section=SLAB),),
    )  # fmt: skip


@pytest.mark.parametrize("shape", [Hermite(), Hat()])
def test_a_wheel_meets_no_step_between_quadrilaterals_and_triangles(shape):
    """Deflection is continuous over every side, and its slope is its derivative beside it."""
    floor = mixed()
    u = np.random.default_rng(8).standard_normal(floor.n_dofs)

    def height(x, y):
        rows = contact_rows(floor, np.array([[x, y]]), np.array([[1.0, 0.0]]), shape=shape)
        return (rows.matrix(rows.value) @ u)[0], (rows.matrix(rows.slope) @ u)[0]

    for y in (0.3, 0.9, 1.6):
        side = 2.0
        assert height(side - 1e-9, y)[0] == pytest.approx(height(side + 1e-9, y)[0], abs=1e-6)
        other = 2.0 + 2.0 * (2.0 - y) / 1.5 if y > 0.5 else None
        if other is not None:
            before, behind = height(other - 1e-9, y)[0], height(other + 1e-9, y)[0]
            assert before == pytest.approx(behind, abs=1e-6)
    for x in (0.7, 2.6):
        h = 1e-6
        difference = (height(x + h, 0.9)[0] - height(x - h, 0.9)[0]) / (2 * h)
        assert height(x, 0.9)[1] == pytest.approx(difference, abs=1e-6)
