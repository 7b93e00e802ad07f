"""Matrices of a structure are the sums of its elements', each distinct element formed once."""

import numpy as np
import pytest
from scipy import sparse

from models import small_plan
from trundle.structure import CONCRETE, Floor, Rectangle, ShellSection, build_floor
from trundle.structure.assembly import assembled, blocks_of
from trundle.structure.elements.quad_shell import ShellGroup


def added_up(floor, form):
    """Add every element's matrix entry by entry into a dense one."""
    out = np.zeros((floor.n_dofs + 1, floor.n_dofs + 1))  # the last row takes what is held
    for group in floor.elements:
        blocks = form(group, floor.nodes[group.connectivity])
        if blocks is None:
            continue
        for nodes, block in zip(group.connectivity, blocks, strict=True):
            dofs = np.where(nodes[:, None] < 0, -1, floor.dof_index[nodes]).ravel()
            np.add.at(out, np.ix_(dofs, dofs), block)
    return out[:-1, :-1]


@pytest.mark.parametrize("mesh_size", [0.75, 1.7])
def test_sums_are_those_of_all_elements_one_by_one(mesh_size):
    """Slab, beams of both ways, columns, ends held, edges: each entry, by a loop over elements."""
    plan = small_plan(
        secondary_y=Rectangle(width=0.2, depth=0.4), edges={"x_min": "symmetry", "y_max": "simple"}
    )
    floor = build_floor(plan, mesh_size=mesh_size)
    for matrix, name in ((floor.stiffness, "stiffness_blocks"), (floor.mass, "mass_blocks")):
        expected = added_up(floor, lambda group, xyz, name=name: getattr(group, name)(xyz))
        size = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        assert np.abs(matrix.toarray() - expected).max() <= 1e-9 * size.max()
        assert np.all(np.abs(matrix.toarray() - expected) <= 1e-12 * size + 1e-30)


def test_each_shape_is_formed_once():
    """A grid of equal rectangles beside one of another width has two shapes, however many."""
    x = np.concatenate([np.arange(11.0), 10.0 + 0.5 * np.arange(1, 11)])
    grid = np.arange(21 * 6).reshape(6, 21)
    nodes = np.column_stack([np.tile(x, 6), np.repeat(1.3 * np.arange(6.0), 21), np.zeros(21 * 6)])
    corners = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1)
    shells = ShellGroup(
        elements=corners.reshape(-1, 4), section=ShellSection(thickness=0.2, material=CONCRETE)
    )
    formed = []

    def form(group, xyz):
        formed.append(len(xyz))
        return group.stiffness_blocks(xyz)

    (blocks,) = blocks_of([shells], nodes, form)
    assert formed == [2]
    assert len(blocks.which) == 100
    widths = nodes[shells.elements[:, 1], 0] - nodes[shells.elements[:, 0], 0]
    assert len(set(zip(blocks.which, np.round(widths, 9), strict=True))) == 2


def test_elements_of_several_sections_are_each_formed():
    """Masses of their own are no repetition of one: each node has the one that it was given."""
    from trundle.structure.elements.point_mass import PointMasses

    section = ShellSection(thickness=0.2, material=CONCRETE)
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    shells = ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=section)
    fixed = np.zeros((4, 6), dtype=bool)
    bare = Floor(nodes=nodes, fixed=fixed, shells=(shells,))
    many = np.tile(np.arange(4), 20)
    given = np.arange(80.0)
    laden = Floor(
        nodes=nodes, fixed=fixed, shells=(shells,), masses=(PointMasses(nodes=many, mass=given),)
    )
    added = (laden.mass - bare.mass).diagonal()[laden.dof_index[:, 2]]
    np.testing.assert_allclose(added, given.reshape(20, 4).sum(axis=0), rtol=1e-9)


def test_rows_must_rise_along_the_nodes():
    """Entries are placed by order; another numbering would put them elsewhere in silence."""
    shells = ShellGroup(
        elements=np.array([[0, 1, 2, 3]]), section=ShellSection(thickness=0.2, material=CONCRETE)
    )
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    blocks = blocks_of([shells], nodes, lambda group, xyz: group.mass_blocks(xyz))
    with pytest.raises(ValueError, match="rise"):
        assembled(blocks, np.arange(24).reshape(4, 6)[::-1], 24)
    whole = assembled(blocks, np.arange(24).reshape(4, 6), 24)
    assert sparse.issparse(whole)
    assert whole.sum() == pytest.approx(3 * 0.2 * CONCRETE.density, rel=0.01)
