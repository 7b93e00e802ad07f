"""Groups of a mesh: what holds, carries and springs, and groups that say too little or too much."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.mesh_groups import GroupedMesh, GroupMake, floor_of_mesh
from trundle.structure import CONCRETE, BeamSection, ShellSection

PLATE = ShellSection(thickness=0.2, material=CONCRETE)
BAR = BeamSection.rectangle(0.3, 0.5, CONCRETE)
NODES = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [4, 0, 0], [0, 0, -3], [2, 0, -3]])
QUAD, TRIANGLE = np.array([[0, 1, 2, 3]]), np.array([[1, 4, 2]])
FOOT = np.array([True, True, True, False, False, False])


def mesh(**groups):
    return GroupedMesh(nodes=NODES, groups=dict(groups.items()))


def test_a_group_of_both_shapes_is_a_slab_of_both():
    """4 m2 of quadrilateral and 2 m2 of triangle, 490 kg/m2: what moves weighs 2940 kg."""
    floor = floor_of_mesh(mesh(slab=(QUAD, TRIANGLE)), {"slab": GroupMake(plate=PLATE)}, "n")
    assert [len(g.connectivity) for g in floor.elements] == [1, 1]
    assert floor.moving_mass() == pytest.approx(2450.0 * 0.2 * 6.0, rel=1e-12)


def test_lengths_are_scaled_and_what_groups_are_is_not():
    """A mesh in millimetres: places a thousandth, an offset of the beam in metres as it is said."""
    make = GroupMake(section=BAR, offset=np.array([0.0, 0.0, -0.35]))
    one = GroupedMesh(nodes=1e3 * NODES, groups={"beam": (np.array([[0, 4]]),)})
    floor = floor_of_mesh(one, {"beam": make}, "n", length=1e-3)
    np.testing.assert_allclose(floor.nodes, NODES, atol=1e-12)
    np.testing.assert_array_equal(floor.beams[0].offset, [0.0, 0.0, -0.35])


def test_nodes_that_several_groups_hold_are_held_in_all_that_any_holds():
    """A node of two edges: one holds x, y and z, the other all rotations."""
    makes = {
        "slab": GroupMake(plate=PLATE),
        "a": GroupMake(held=FOOT),
        "b": GroupMake(held=~FOOT),
    }
    found = mesh(slab=(QUAD,), a=(np.array([[0, 1]]),), b=(np.array([[1, 2]]),))
    floor = floor_of_mesh(found, makes, "n")
    assert floor.fixed.sum(axis=1).tolist() == [3, 6, 3, 0, 0, 0, 0]
    assert floor.fixed[2].tolist() == (~FOOT).tolist()


def test_springs_stand_at_each_node_once():
    """Three nodes of two lines, the middle one of both: three springs, of the stiffness said."""
    spring = np.array([0.0, 0.0, 5e6, 0.0, 0.0, 0.0])
    makes = {"slab": GroupMake(plate=PLATE), "bed": GroupMake(springs=spring)}
    floor = floor_of_mesh(
        mesh(slab=(QUAD,), bed=(np.array([[0, 1], [1, 2]]),)), makes, "n"
    )  # fmt: skip
    (group,) = floor.springs
    assert group.elements.tolist() == [[0, -1], [1, -1], [2, -1]]
    up = floor.rigid_vector(2)
    # a plate that moves up as a whole strains nothing else
    assert up @ (floor.stiffness @ up) == pytest.approx(3 * 5e6, rel=1e-9)


def test_columns_of_a_group_of_beams_have_their_depth_along_x():
    """``up`` is z for both; along the upright one no depth can point, so x takes its place."""
    lines = np.array([[0, 1], [0, 5], [6, 1]])
    floor = floor_of_mesh(mesh(frame=(lines,)), {"frame": GroupMake(section=BAR)}, "n")
    beams = {tuple(b.up): b.elements.tolist() for b in floor.beams}
    assert beams == {(0.0, 0.0, 1.0): [[0, 1]], (1.0, 0.0, 0.0): [[0, 5], [6, 1]]}


@pytest.mark.parametrize(
    ("groups", "makes", "said"),
    [
        ({"slab": (QUAD,), "rest": (TRIANGLE,)}, {"slab": GroupMake(plate=PLATE)},
         "nothing says what 'rest' of the mesh is"),
        ({"slab": (QUAD,)}, {"slab": GroupMake(plate=PLATE), "<b>": GroupMake(section=BAR)},
         "there is no group '<b>' in the mesh; there are: 'slab'"),
        ({"slab": (QUAD,), "again": (QUAD[:, [2, 3, 0, 1]],)},
         {"slab": GroupMake(plate=PLATE), "again": GroupMake(plate=PLATE)},
         "'slab' and 'again': 1 quadrilaterals are there twice"),
        ({"beam": (np.array([[0, 1], [1, 0]]),)}, {"beam": GroupMake(section=BAR)},
         "'beam': 1 lines are there twice"),
        ({"beam": (np.array([[2, 2]]),)}, {"beam": GroupMake(section=BAR)},
         "group 'beam': a line without a length"),
        ({"beam": (QUAD,)}, {"beam": GroupMake(section=BAR)}, "has a section, and no lines"),
        ({"slab": (np.array([[0, 1]]),)}, {"slab": GroupMake(plate=PLATE)},
         "has a plate, and no triangles or quadrilaterals"),
    ],
)  # fmt: skip
def test_groups_that_are_not_what_is_said_are_refused(groups, makes, said):
    """An element made twice would be twice as stiff; a group of which nothing is said is lost."""
    with pytest.raises(InputError, match=said.replace("(", r"\(")):
        floor_of_mesh(mesh(**groups), makes, "n")


def test_a_group_that_is_nothing_may_be_absent_and_may_stand_on_others():
    """``nothing`` of a group that is not there is no mistake, nor one over elements of another."""
    makes = {"slab": GroupMake(plate=PLATE), "load": GroupMake(), "gone": GroupMake()}
    floor = floor_of_mesh(mesh(slab=(QUAD,), load=(QUAD,)), makes, "n")
    assert len(floor.elements) == 1
    assert makes["load"].nothing
    assert not GroupMake(held=FOOT).nothing
