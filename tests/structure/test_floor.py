"""Floors by their public face: matrices against a dense sum of their elements, rows, hashes."""

from dataclasses import replace

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    MirrorPlane,
    PointMasses,
    RigidLinks,
    ShellGroup,
    ShellSection,
    SpringGroup,
    TriangleGroup,
    can_move,
    node_motion,
)
from trundle.structure.elements import GROUND, NodeInertia, ReleasedBeams

STUFF = Material(elastic_modulus=3e10, poisson_ratio=0.2, density=2500.0, damping_ratio=0.02)
STEEL = Material(elastic_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
BAR = BeamSection.rectangle(0.3, 0.5, STEEL)


def everything(**changes):
    """A table of every kind of part, two supports turned, one node in a plane, one as a whole."""
    nodes = np.array(
        [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 3], [4, 0, 3], [4, 4, 3], [0, 4, 3],
         [8, 0, 3], [8, 4, 3], [2, 2, 3.5]]
    ).astype(float)  # fmt: skip
    fixed = np.zeros((11, 6), dtype=bool)
    fixed[:2] = True
    fixed[2:4, [0, 2]] = True
    angles = np.zeros((11, 2))
    angles[2:4] = 0.3
    hinged = BeamGroup(elements=np.array([[4, 7]]), section=BAR)
    values = {
        "nodes": nodes, "fixed": fixed, "angles": angles,
        "shells": (
            ShellGroup(elements=np.array([[4, 5, 6, 7]]),
                       section=ShellSection(thickness=0.2, material=STUFF, superimposed_mass=90.0)),
        ),
        "beams": (
            BeamGroup(elements=np.array([[0, 4], [1, 5], [2, 6], [3, 7]]), section=BAR),
            BeamGroup(elements=np.array([[4, 5]]), section=BAR, offset=np.array([0.0, 0, -0.4])),
        ),
        "springs": (
            SpringGroup(elements=np.array([[8, GROUND]]),
                        stiffness=np.array([0, 0, 3e7, 0, 2e6, 0.0])),
            SpringGroup(elements=np.array([[8, 9], [6, 8]]), stiffness=np.full(6, 1e6)),
        ),
        "masses": (PointMasses(nodes=np.array([6, 9, 6]), mass=np.array([700.0, 30.0, 5.0])),),
        "others": (
            TriangleGroup(connectivity=np.array([[5, 8, 6], [8, 9, 6]]),
                          section=ShellSection(thickness=0.15, material=STUFF)),
            ReleasedBeams(beams=hinged, released=np.array([[False, True, False]] * 2)),
            NodeInertia(nodes=np.array([10]), inertia=np.array([[50, 60, 70, 5, 6, 7.0]])),
        ),
        "links": (
            RigidLinks(leads=np.array([5]), follows=np.array([9]),
                       dofs=np.array([True, True, False, False, False, True])),
            RigidLinks(leads=np.array([4]), follows=np.array([10])),
        ),
    }  # fmt: skip
    return Floor(**{**values, **changes})


def dense(floor, kind):
    """Add up the blocks of all elements one by one, over all dofs of all nodes."""
    whole = np.zeros((6 * len(floor.nodes),) * 2)
    for group in floor.elements:
        blocks = getattr(group, kind)(floor.nodes[group.connectivity])
        for block, ends in zip(
            blocks if blocks is not None else (), group.connectivity, strict=False
        ):
            rows = [(6 * node + dof, 6 * k + dof) for k, node in enumerate(ends) if node >= 0
                    for dof in range(6)]  # fmt: skip
            into, out_of = (np.array(one) for one in zip(*rows, strict=True))
            whole[np.ix_(into, into)] += block[np.ix_(out_of, out_of)]
    return whole


def motion_of(floor):
    """Return all dofs of all nodes by the free ones, from the rules of supports and links."""
    n = len(floor.nodes)
    turn = np.zeros((6 * n, 6 * n))
    for node in range(n):
        for kind in (0, 1):
            a = 0.0 if floor.angles is None else floor.angles[node, kind]
            block = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
            at = slice(6 * node + 3 * kind, 6 * node + 3 * kind + 3)
            turn[at, at] = block
    own = turn.copy()
    behind = np.zeros(6 * n, dtype=bool)
    ways = np.eye(6 * n)
    for link in floor.links:
        for lead, node in zip(link.leads, link.follows, strict=True):
            x, y, z = floor.nodes[node] - floor.nodes[lead]
            arm = np.eye(6)
            arm[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]  # theta x r
            for dof in np.flatnonzero(link.dofs):
                ways[6 * node + dof] = 0.0
                ways[6 * node + dof, 6 * lead : 6 * lead + 6] = arm[dof]
                behind[6 * node + dof] = True
    free = np.flatnonzero(~floor.fixed.ravel() & ~behind)
    return (ways @ own)[:, free], free


@pytest.mark.parametrize(
    "changes", [{}, {"angles": None}, {"links": ()}, {"angles": None, "links": ()}],
    ids=["all", "not turned", "not linked", "plain"],
)  # fmt: skip
def test_matrices_are_the_sum_of_all_elements(changes):
    """Another method: element by element into a dense matrix, then by what follows what."""
    floor = everything(**changes)
    if "links" in changes:  # node 10 has no element that is stiff
        fixed = np.array(floor.fixed)
        fixed[10, 3:] = True
        floor = replace(floor, fixed=fixed)
    ways, free = motion_of(floor)
    rows = floor.dof_index.ravel()
    np.testing.assert_array_equal(np.flatnonzero(rows >= 0), free)
    np.testing.assert_array_equal(rows[free], np.arange(len(free)))
    for matrix, kind in zip(
        floor.matrices(), ("mass_blocks", "stiffness_blocks"), strict=True
    ):  # fmt: skip
        expected = ways.T @ dense(floor, kind) @ ways
        np.testing.assert_allclose(
            matrix.toarray(), expected, atol=1e-12 * np.abs(expected).max(), rtol=1e-9
        )


def test_motion_of_every_node_is_that_of_the_free_dofs():
    """Rows of weights for each dof against the rules of supports and links, for any motion."""
    floor = everything()
    ways, _ = motion_of(floor)
    q = np.random.default_rng(3).standard_normal(floor.n_dofs)
    expected = (ways @ q).reshape(-1, 6)
    found = np.stack([node_motion(floor, dof) @ q for dof in range(6)], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-12)
    plain = replace(floor, angles=None, links=())
    for dof in range(6):
        rows = plain.dof_index[:, dof]
        moved = node_motion(plain, dof) @ np.arange(1.0, plain.n_dofs + 1.0)
        np.testing.assert_array_equal(moved, np.where(rows >= 0, rows + 1.0, 0.0))


def test_matrices_are_symmetric_and_hold_their_whole_diagonal():
    """What solvers take for granted, of a dof without mass too: its diagonal is there, and 0."""
    floor = small_floor(mesh_size=3.0)
    for matrix in floor.matrices():
        assert abs(matrix - matrix.T).max() <= 1e-12 * abs(matrix).max()
        assert matrix.format == "csc"
        entries = matrix.tocoo()
        on = entries.coords[0] == entries.coords[1]
        assert np.unique(entries.coords[0][on]).size == floor.n_dofs
        at = np.stack(entries.coords)
        assert len(np.unique(at, axis=1).T) == len(entries.data)  # each place once


def test_elements_that_stand_twice_count_twice():
    """Two springs between the same nodes, in one group or in two, are one of twice the stiffness."""
    one = everything()
    first, second = one.springs
    alike = replace(second, elements=np.array([[8, 9], [6, 8], [8, 9], [8, 6]]))
    apart = replace(one, springs=(first, second, second))
    together = replace(one, springs=(first, alike))
    double = replace(one, springs=(first, replace(second, stiffness=2.0 * second.stiffness)))
    for other in (apart, together):
        difference = abs(other.stiffness - double.stiffness).max()
        assert difference <= 1e-15 * abs(double.stiffness).max()
    assert abs(one.stiffness - double.stiffness).max() > 1e5


def test_stiffness_damped_by_materials_is_theirs_and_the_rest_the_other():
    """Concrete of 2 % and all else of 5 %: 2 % of the slabs' stiffness and 5 % of the rest."""
    floor = everything()
    slabs = replace(floor, beams=(), springs=(), masses=(), others=floor.others[:1])
    ways, _ = motion_of(floor)
    of_slabs = dense(slabs, "stiffness_blocks")
    rest = dense(floor, "stiffness_blocks") - of_slabs
    expected = ways.T @ (0.02 * of_slabs + 0.05 * rest) @ ways
    found = floor.damped_stiffness(0.05).toarray()
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_hashes_tell_what_moves_apart_and_names_together():
    """A modulus, a mass or a support changes it; a name, or the same floor built again, does not."""
    floor = everything()
    same = everything(name="<another>, größer")
    assert floor.content_hash == same.content_hash
    softer = replace(BAR, material=replace(STEEL, elastic_modulus=2.1e11 * (1.0 + 1e-12)))
    fixed = np.array(floor.fixed)
    fixed[9, 2] = True
    others = [
        everything(beams=(replace(floor.beams[0], section=softer), floor.beams[1])),
        everything(masses=(PointMasses(nodes=np.array([6]), mass=735.0),)),
        everything(fixed=fixed),
        everything(links=floor.links[1:]),
    ]
    assert len({floor.content_hash, *(one.content_hash for one in others)}) == 5


def test_a_unit_acceleration_takes_what_is_held_along():
    """All masses of all nodes by their whole matrix, turned supports and nodes that follow or not.

    The matrix is added up element by element (`dense`); `motion_of` gives how free dofs move it.
    """
    floor = everything()
    ways, _ = motion_of(floor)
    for dof in range(6):
        everywhere = np.zeros(floor.fixed.size)
        everywhere[dof::6] = 1.0
        expected = ways.T @ dense(floor, "mass_blocks") @ everywhere
        np.testing.assert_allclose(
            floor.inertia_of(dof), expected, rtol=1e-12, atol=1e-9 * np.abs(expected).max()
        )


def test_hashes_tell_places_and_damping_apart():
    """What moves alike and stands elsewhere, or is damped otherwise, answers other questions.

    Moved as a whole by 16 m a floor has the same matrices, and a route at x = 5 m misses it.
    """
    floor = everything()
    moved = floor.nodes + np.array([16.0, 0.0, 0.0])
    damped = replace(BAR, material=replace(BAR.material, damping_ratio=0.04))
    whole = floor.surface()
    named = replace(whole, name="yard")
    higher = replace(whole, flat=0.01)
    others = [
        everything(nodes=moved),
        everything(beams=(replace(floor.beams[0], section=damped), *floor.beams[1:])),
        everything(decks=(named,)),
        everything(decks=(higher,)),
        everything(mirrors=(MirrorPlane.across(0, 0.0),)),
        everything(mirrors=(MirrorPlane.across(1, 0.0),)),
    ]
    assert len({floor.content_hash, *(one.content_hash for one in others)}) == 7
    np.testing.assert_allclose(others[0].stiffness.toarray(), floor.stiffness.toarray(), atol=1e-3)


def test_a_unit_motion_is_along_space_whatever_supports_are_turned():
    """Turned by 0.3 rad, a support that holds across lets 1 m along x go by cos 0.3 m along."""
    floor = everything(links=())
    along = floor.rigid_vector(0)
    free = floor.dof_index[2, 1]
    assert along[free] == pytest.approx(-np.sin(0.3), rel=1e-12)
    assert floor.rigid_vector(1)[free] == pytest.approx(np.cos(0.3), rel=1e-12)
    straight = replace(floor, angles=None)
    assert (
        straight.rigid_vector(0).tolist()
        == (
            (straight.dof_index[:, 0, None] == np.arange(straight.n_dofs)).any(axis=0).astype(float)
        ).tolist()
    )


def test_what_moves_weighs_what_is_not_held():
    """Of a bar clamped at one end a third of its mass moves along it, and all of what hangs on it.

    Consistent mass: end to end (2, 1; 1, 2) m / 6, of which the free end keeps 2 / 6. Where both
    ends are accelerated, half the bar hangs on each: 2 / 6 and 1 / 6.
    """
    fixed = np.zeros((2, 6), dtype=bool)
    fixed[0] = True
    floor = Floor(
        nodes=np.array([[0.0, 0, 0], [2, 0, 0]]), fixed=fixed,
        beams=(BeamGroup(elements=np.array([[0, 1]]), section=BAR),),
        masses=(PointMasses(nodes=np.array([0, 1]), mass=np.array([900.0, 40.0])),),
    )  # fmt: skip
    bar = 7850.0 * 0.15 * 2.0
    assert floor.moving_mass(0) == pytest.approx(bar / 3.0 + 40.0, rel=1e-12)
    assert floor.inertia_of(0)[floor.dof_index[1, 0]] == pytest.approx(bar / 2.0 + 40.0)
    assert can_move(floor, 0)


def test_the_ground_may_be_named_at_either_end_of_a_spring():
    """A spring has no sense: ground first is ground second; between ground and ground is nothing."""
    first = SpringGroup(elements=np.array([[GROUND, 4], [2, 3]]), stiffness=np.ones(6))
    assert first.elements.tolist() == [[4, GROUND], [2, 3]]
    with pytest.raises(InputError, match="a spring needs a node at one end"):
        SpringGroup(elements=np.array([[GROUND, GROUND]]), stiffness=np.ones(6))


def test_a_node_that_follows_along_x_alone_has_no_axes_of_its_own():
    """Its own dof along y', turned by 0.3 rad, would move it along x too: the tie would not hold.

    Followed along both, or along z, it does.
    """
    ties = (RigidLinks(leads=np.array([6]), follows=np.array([2]),
                       dofs=np.array([1, 0, 0, 0, 0, 0], dtype=bool)),)  # fmt: skip
    fixed = np.zeros((11, 6), dtype=bool)
    fixed[:2] = True
    with pytest.raises(InputError, match="node 2 follows along x or y alone, and its own axes"):
        _ = everything(links=ties, fixed=fixed).stiffness
    both = replace(ties[0], dofs=np.array([1, 1, 1, 0, 0, 0], dtype=bool))
    assert everything(links=(both,), fixed=fixed).stiffness.shape[0] > 0


def test_the_nearest_node_is_sought_in_plan():
    """A column's node far below is as near as the one above it: the first of them counts."""
    floor = everything()
    assert floor.nearest_node(7.9, 0.2) == 8
    assert floor.nearest_node(0.1, -0.2) == 0
    assert floor.nearest_node(100.0, 100.0) == 9


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"shells": (), "beams": (), "others": ()}, "needs at least one group of shells, beams"),
        ({"beams": (BeamGroup(elements=np.array([[0, 11]]), section=BAR, name="Träger <1>"),)},
         "Träger <1>: node numbers must be 0 to 10; got 0 to 11"),
        ({"beams": (BeamGroup(elements=np.array([[0, GROUND]]), section=BAR),)},
         "beam: node numbers must be 0 to 10; got -1 to 0"),
        ({"springs": (SpringGroup(elements=np.array([[3, -2]]), stiffness=np.ones(6)),)},
         "spring: node numbers must be -1 to 10; got -2 to 3"),
        ({"masses": (PointMasses(nodes=np.array([12]), mass=1.0),)},
         "point mass: node numbers must be 0 to 10"),
    ],
)  # fmt: skip
def test_floors_that_cannot_be_are_refused(changes, said):
    """Before any work, by the name of the group and what numbers there may be."""
    with pytest.raises(InputError, match=said):
        everything(**changes)


def test_a_place_that_is_not_finite_is_refused_with_its_number():
    """Of eleven nodes the fourth has no height."""
    nodes = np.array(everything().nodes)
    nodes[3, 2] = np.nan
    with pytest.raises(InputError, match=r"nodes must be finite; element \(3, 2\) is nan"):
        everything(nodes=nodes)
