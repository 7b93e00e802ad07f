"""Bodies of elements: their corners by hand, where they hang, and how they move."""

import numpy as np
import pytest

from models import small_floor
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    PointMasses,
    ShellGroup,
    ShellSection,
    SpringGroup,
)
from trundle.structure.elements import GROUND
from trundle.views.solids import moved, solids_of

STUFF = Material(elastic_modulus=2e11, poisson_ratio=0.3, density=1000.0)


def floor_of(nodes, **parts):
    nodes = np.array(nodes, dtype=float)
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    fixed[0] = True
    return Floor(nodes=nodes, fixed=fixed, **parts)


def corners(solid, nodes):
    """Return where all vertices are, each place once, in order."""
    at = moved(solid, np.zeros((len(nodes), 6)), nodes)
    return np.unique(np.round(at, 9), axis=0)


def box(x, y, z):
    return np.array([[a, b, c] for a in x for b in y for c in z])


def test_a_member_is_a_bar_of_its_section_along_its_axis():
    """0.2 wide along y and 0.4 deep along z over 3 m of x: eight corners by hand."""
    section = BeamSection.rectangle(width=0.2, depth=0.4, material=STUFF)
    floor = floor_of(
        [[0, 0, 0], [3, 0, 0]],
        beams=(BeamGroup(elements=np.array([[0, 1]]), section=section, name="Träger"),),
    )
    (solid,) = solids_of(floor)
    assert (solid.name, solid.kind, len(solid.triangles)) == ("Träger", "member", 12)
    np.testing.assert_allclose(
        corners(solid, floor.nodes), box((0.0, 3.0), (-0.1, 0.1), (-0.2, 0.2)), atol=1e-9
    )


def test_a_member_hangs_where_its_centroid_is_put_off_to():
    """0.5 m below its nodes: all eight corners lie 0.5 m lower."""
    section = BeamSection.rectangle(width=0.2, depth=0.4, material=STUFF)
    group = BeamGroup(
        elements=np.array([[0, 1]]), section=section, offset=np.array([0.0, 0.0, -0.5])
    )
    floor = floor_of([[0, 0, 0], [3, 0, 0]], beams=(group,))
    (solid,) = solids_of(floor)
    np.testing.assert_allclose(
        corners(solid, floor.nodes), box((0.0, 3.0), (-0.1, 0.1), (-0.7, -0.3)), atol=1e-9
    )


def plate(thickness=0.2):
    nodes = [[0, 0, 1], [2, 0, 1], [2, 1, 1], [0, 1, 1]]
    section = ShellSection(thickness=thickness, material=STUFF)
    return floor_of(
        nodes,
        shells=(ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=section, name="Platte"),),
    )


def test_a_plate_has_half_of_its_thickness_on_each_side():
    """2 x 1 x 0.2 m at a height of 1 m: from 0.9 to 1.1 m, six faces of two triangles."""
    floor = plate()
    (solid,) = solids_of(floor)
    np.testing.assert_allclose(corners(solid, floor.nodes), box((0.0, 2.0), (0.0, 1.0), (0.9, 1.1)))
    assert (solid.kind, len(solid.triangles)) == ("plate", 12)


def outward(solid, nodes):
    """Return normals of triangles, and their middles seen from the body's middle."""
    at = moved(solid, np.zeros((len(nodes), 6)), nodes)
    a, b, c = (at[solid.triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3.0 - at.mean(axis=0))


def test_faces_look_outwards():
    """Of convex bodies each face's normal points away from the middle: else a page draws the inside."""
    section = BeamSection.rectangle(width=0.2, depth=0.4, material=STUFF)
    bar = floor_of(
        [[0, 0, 0], [1, 2, 3]], beams=(BeamGroup(elements=np.array([[0, 1]]), section=section),)
    )
    for floor in (plate(), bar):
        (solid,) = solids_of(floor)
        assert (outward(solid, floor.nodes) > 0.0).all()


def test_two_plates_side_by_side_have_no_wall_between_them():
    """2 x 2 upper and lower triangles, and 6 free edges of two triangles each: 8 + 12."""
    nodes = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]]
    section = ShellSection(thickness=0.2, material=STUFF)
    group = ShellGroup(elements=np.array([[0, 1, 4, 3], [1, 2, 5, 4]]), section=section)
    (solid,) = solids_of(floor_of(nodes, shells=(group,)))
    assert len(solid.triangles) == 8 + 12
    assert len(solid.node) == 12


def test_springs_to_the_ground_and_masses_are_marks_at_their_nodes():
    """Boxes of 15 cm and of 5 cm about the node; a spring between two nodes has no body."""
    section = BeamSection.rectangle(width=0.2, depth=0.4, material=STUFF)
    floor = floor_of(
        [[0, 0, 0], [1, 2, 3]],
        beams=(BeamGroup(elements=np.array([[0, 1]]), section=section),),
        springs=(
            SpringGroup(elements=np.array([[1, GROUND]]), stiffness=np.ones(6), name="Feder"),
            SpringGroup(elements=np.array([[0, 1]]), stiffness=np.ones(6), name="zwischen"),
        ),
        masses=(PointMasses(nodes=np.array([1]), mass=np.array([5.0])),),
    )  # fmt: skip
    found = {solid.kind: solid for solid in solids_of(floor)}
    assert set(found) == {"member", "spring", "mass"}
    assert found["spring"].name == "Feder"
    assert set(found["spring"].node) == {1}
    for kind, half in (("spring", 0.075), ("mass", 0.025)):
        expected = box((1 - half, 1 + half), (2 - half, 2 + half), (3 - half, 3 + half))
        np.testing.assert_allclose(corners(found[kind], floor.nodes), expected)


def test_vertices_move_as_a_rigid_body_about_their_node():
    """A turn of 0.01 about y takes what is 0.1 m above its node 1 mm along x; translation adds."""
    floor = plate()
    (solid,) = solids_of(floor)
    motion = np.zeros((4, 6))
    motion[:, 1], motion[:, 4] = 0.5, 0.01
    shift = moved(solid, motion)
    up = solid.arm[:, 2] > 0.0
    np.testing.assert_allclose(shift[up], np.tile([0.001, 0.5, 0.0], (4, 1)), atol=1e-15)
    np.testing.assert_allclose(shift[~up], np.tile([-0.001, 0.5, 0.0], (4, 1)), atol=1e-15)
    np.testing.assert_allclose(
        moved(solid, motion, floor.nodes), floor.nodes[solid.node] + solid.arm + shift
    )


def test_groups_of_one_name_are_one_body():
    """Beams of a storey are one group or several: each name is there once, with all triangles."""
    floor = small_floor(mesh_size=3.0)
    names = [(solid.name, solid.kind) for solid in solids_of(floor)]
    assert len(names) == len(set(names))
    members = sum(len(group.elements) for group in floor.beams)
    drawn = sum(len(s.triangles) for s in solids_of(floor) if s.kind == "member")
    assert drawn == pytest.approx(12 * members)
