"""Structures known by matrices or modes alone, bridges and sagging: closed forms and refusals."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from models import small_floor
from trundle.dynamics import natural_modes
from trundle.errors import InputError, UnrestrainedModeError
from trundle.structure import (
    FaceGroup,
    MatrixModel,
    ModalModel,
    beam_bridge,
    can_move,
    node_motion,
    self_weight_deflection,
)
from trundle.structure.mechanisms import loose_parts

NODES = np.array([[0.0, 0, 0], [2, 0, 0]])
LINE = (FaceGroup(connectivity=np.array([[0, 1]])),)
UPRIGHT = np.full((2, 6), -1)
UPRIGHT[:, 2] = [1, 0]  # rows in another order than nodes


def matrices(**changes):
    """Two masses on springs of their own, 200 kg on 8 kN/m and 50 kg on 18 kN/m."""
    values = {
        "nodes": NODES, "dof_index": UPRIGHT, "faces": LINE, "decks": (),
        "mass": sparse.csc_array(np.diag([50.0, 200.0])),
        "stiffness": sparse.csc_array(np.diag([18e3, 8e3])),
    }  # fmt: skip
    return MatrixModel(**{**values, **changes})


def modal(**changes):
    values = {
        "nodes": NODES, "dof_index": UPRIGHT, "faces": LINE, "decks": (), "reach": 5.0,
        "omega": 2.0 * np.pi * np.array([1.0, 3.0, 4.0]), "shapes": np.arange(6.0).reshape(2, 3),
        "name": "a <test>",
    }  # fmt: skip
    return ModalModel(**{**values, **changes})


def test_two_masses_on_springs_by_their_matrices():
    """sqrt(k / m): sqrt 40 and sqrt 360 rad/s; 250 kg move up; m g / k sink, node by node."""
    model = matrices()
    found = model.modes(10.0)
    np.testing.assert_allclose(found.omega, np.sqrt([40.0, 360.0]), rtol=1e-9)
    assert (model.moving_mass(), model.moving_mass(0)) == (250.0, 0.0)
    np.testing.assert_allclose(
        self_weight_deflection(model, gravity=10.0), [-0.25, -500.0 / 18e3], rtol=1e-9
    )
    np.testing.assert_allclose(model.damped_stiffness(0.03).toarray(), np.diag([540.0, 240.0]))
    assert (can_move(model, 2), can_move(model, 0)) == (True, False)
    moved = node_motion(model, 2) @ np.array([5.0, 7.0])
    assert moved.tolist() == [7.0, 5.0]


def test_matrices_that_do_not_fit_are_refused():
    """Of two sizes, not square, and a row that they do not have, told as counted from 1."""
    small = sparse.csc_array(np.eye(1))
    with pytest.raises(InputError, match=r"mass \(1, 1\) and stiffness \(2, 2\) must be square"):
        matrices(mass=small)
    beyond = np.array(UPRIGHT)
    beyond[0, 2] = 2
    with pytest.raises(InputError, match="row 3 of a node, and the matrices have 2"):
        matrices(dof_index=beyond)


def test_hashes_of_matrices_tell_stiffness_from_mass():
    """Exchanged, the two are another structure; a name makes none."""
    one, same = matrices(), matrices(name="another")
    other = matrices(mass=one.stiffness, stiffness=one.mass)
    assert one.content_hash == same.content_hash != other.content_hash


def test_hashes_of_matrices_tell_whose_rows_they_are():
    """Exchanged rows are two masses at each other's places; a face or a place is told, too."""
    one = matrices()
    exchanged = np.array(UPRIGHT)
    exchanged[:, 2] = [0, 1]
    others = [
        matrices(dof_index=exchanged),
        matrices(nodes=NODES + 1.0),
        matrices(faces=(FaceGroup(connectivity=np.array([[1, 0]])),)),
        matrices(faces=(FaceGroup(connectivity=np.array([[0, 1]]), smooth=False),)),
    ]
    assert len({one.content_hash, *(other.content_hash for other in others)}) == 5
    assert modal().content_hash != modal(nodes=NODES + 1.0).content_hash


def test_the_last_mode_is_among_all_that_are_known():
    """Known to the frequency of the last, asked for to it: 4 Hz of 1, 3 and 4 is all of them.

    Half a hertz below it the last is left out, and none is added above.
    """
    for reach in (4.0, 4.0 * (1.0 + 1e-9)):
        model = modal(reach=reach)
        assert model.modes(4.0).n_modes == 3
        assert model.modes(reach).n_modes == 3
        assert model.modes(3.5).n_modes == 2
        with pytest.raises(InputError, match="modes are known to 4 Hz"):
            model.modes(4.0001)


def test_modes_are_those_below_a_frequency_as_far_as_they_are_known():
    """1, 3 and 4 Hz, known to 5 Hz: two lie below 3.5 Hz, none at 1 Hz is below it."""
    model = modal()
    found = model.modes(3.5)
    np.testing.assert_allclose(found.frequencies, [1.0, 3.0])
    np.testing.assert_array_equal(found.shapes, [[0.0, 1.0], [3.0, 4.0]])
    assert model.modes(1.0).n_modes == 0
    assert model.modes(5.0).n_modes == 3
    with pytest.raises(InputError, match="a <test>: modes are known to 5 Hz; f_max may be no high"):
        model.modes(5.001)


def test_modes_alone_say_neither_weight_nor_sinking_nor_damping_of_materials():
    """What is not known is refused or None: nothing is made of it."""
    model = modal()
    assert (model.moving_mass(), model.inertia_of(2), model.flexibility()) == (None, None, None)
    assert model.has_matrices is False
    with pytest.raises(InputError, match="a <test> is known by its modes: it has no matrices"):
        model.matrices()
    with pytest.raises(InputError, match="give damping as a ratio"):
        model.damped_stiffness(0.02)
    with pytest.raises(InputError, match="a <test> is known by its modes: nothing says how it si"):
        self_weight_deflection(model)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"omega": np.array([6.0, 5.0, 7.0])}, "must be above 0, and rise"),
        ({"omega": np.array([0.0, 5.0, 7.0])}, "must be above 0, and rise"),
        ({"omega": np.zeros(0), "shapes": np.zeros((2, 0))}, "must be above 0, and rise"),
        ({"shapes": np.zeros((1, 3))}, "row 1 of a node, and the shapes have 1"),
        ({"reach": 0.0}, "reach must be greater than 0"),
    ],
)
def test_modes_that_cannot_be_are_refused(changes, said):
    """A frequency of 0 is a motion that nothing holds; shapes must be there for every row."""
    with pytest.raises(InputError, match=said):
        modal(**changes)


def test_hashes_of_modes_tell_how_far_they_reach():
    """The same modes, known to another frequency, answer other studies."""
    assert len({modal().content_hash, modal(reach=6.0).content_hash,
                modal(omega=2.0 * np.pi * np.array([1.0, 3.0, 4.5])).content_hash}) == 3  # fmt: skip
    assert modal().content_hash == modal(name="another").content_hash


RIGID, LINE_MASS, SPAN = 3.7e7, 1000.0, 12.0


def bridge(**changes):
    return beam_bridge(
        length=SPAN, bending_stiffness=RIGID, line_mass=LINE_MASS, **changes
    )  # fmt: skip


@pytest.mark.parametrize(
    ("ends", "roots", "share"),
    [
        ("simple", [np.pi, 2 * np.pi, 3 * np.pi], 5.0 / 384.0),
        ("clamped", [4.73004074, 7.85320462, 10.9956079], 1.0 / 384.0),
        ("cantilever", [1.87510407, 4.69409113, 7.85475744], 1.0 / 8.0),
    ],
)
def test_bridges_vibrate_and_sag_as_eulers_beams(ends, roots, share):
    """(root / L)^2 sqrt(E I / m), roots by Blevins table 8-1; q L^4 / E I times 5/384, 1/384, 1/8."""
    floor = bridge(ends=ends)
    expected = (np.array(roots) / SPAN) ** 2 * np.sqrt(RIGID / LINE_MASS)
    omega = natural_modes(floor.mass, floor.stiffness, f_max=30.0).omega
    np.testing.assert_allclose(omega[:3], expected, rtol=2e-5)
    sag = self_weight_deflection(floor)
    sunk = share * LINE_MASS * 9.81 * SPAN**4 / RIGID
    assert sag.min() == pytest.approx(-sunk, rel=1e-3)  # 40 elements leave that
    assert sag.max() <= 0.0
    place = {"simple": SPAN / 2, "clamped": SPAN / 2, "cantilever": SPAN}[ends]
    assert floor.nodes[sag.argmin(), 0] == pytest.approx(place)
    np.testing.assert_allclose(self_weight_deflection(floor, gravity=1.0) * 9.81, sag, rtol=1e-9)


@pytest.mark.parametrize("n_elements", [2, 4, 16])
def test_beams_sag_exactly_at_their_nodes(n_elements):
    """5 q L^4 / 384 E I on any mesh: cubics with a consistent load are exact at nodes.

    A load that leaves out what lies beside supports gives two thirds of it with two elements.
    """
    sag = self_weight_deflection(bridge(n_elements=n_elements))
    assert sag.min() == pytest.approx(-5.0 / 384.0 * LINE_MASS * 9.81 * SPAN**4 / RIGID, rel=1e-9)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"n_elements": 1}, "n_elements must be a whole number of at least 2"),
        ({"line_mass": 0.0}, "line_mass must be greater than 0"),
        ({"bending_stiffness": np.inf}, "bending_stiffness must be finite"),
        ({"length": -3.0}, "length must be greater than 0"),
    ],
)
def test_bridges_that_cannot_be_are_refused(changes, said):
    """By the name of what is wrong, before any matrix."""
    values = {"length": 3.0, "bending_stiffness": 1.0, "line_mass": 1.0}
    with pytest.raises(InputError, match=said):
        beam_bridge(**{**values, **changes})


def loose(fixed=None, springs=()):
    """A plate alone, held as is said."""
    plan = small_floor(
        mesh_size=3.0, column=None, storey_below=0.0, storey_above=0.0, beams_x=None, beams_y=None
    )
    held = np.zeros_like(plan.fixed) if fixed is None else fixed
    return replace(plan, fixed=held, springs=springs)


def corners_held(*dofs, n=4):
    floor = loose()
    fixed = np.zeros_like(floor.fixed)
    x, y = floor.nodes[:, 0], floor.nodes[:, 1]
    at = [np.flatnonzero((x == a) & (y == b))[0] for a, b in ((0, 0), (12, 0), (0, 6), (12, 6))]
    fixed[np.ix_(at[:n], list(dofs))] = True
    return fixed


def test_what_can_move_is_said_with_how():
    """By statics: nothing, uprights alone, one corner pinned, two along one edge, all of it."""
    whole = "the part of slab at x 0 to 12, y 0 to 6, z 0 m "
    cases = {
        "is held by nothing": None,
        "is not held: it moves along x and moves along y and turns about z": corners_held(2),
        "is not held: it turns about x": corners_held(0, 1, 2, n=2),
    }
    for said, fixed in cases.items():
        assert loose_parts(loose(fixed)) == [whole + said]
    assert loose_parts(loose(corners_held(0, 1, 2, n=3))) == []
    assert loose_parts(loose(corners_held(0, 1, 2, 3, n=1)))[0].startswith(whole + "is not held")
    assert loose_parts(loose(corners_held(0, 1, 2, 3, 4, 5, n=1))) == []


@pytest.mark.parametrize(
    ("fixed", "count"),
    [((), 6), ((2,), 3), ((0, 1, 2), 0), ((2, 3, 4), 3)],
    ids=["free", "uprights", "pinned", "no tilting"],
)
def test_what_is_loose_has_no_modes(fixed, count):
    """The solver counts the same motions without strain as statics does, and names their number."""
    floor = loose(corners_held(*fixed) if fixed else None)
    if not count:
        assert floor.modes(20.0).n_modes > 0
        return
    with pytest.raises(UnrestrainedModeError, match=f"^{count} motions without strain"):
        floor.modes(20.0)


@pytest.mark.parametrize("fixed", [(), (2,), (2, 3, 4), (0, 1)])
def test_what_is_loose_does_not_sink_to_some_depth(fixed):
    """By statics each can move; a factor of its stiffness may be found, and is of round-off.

    Even where the weight itself is carried (uprights alone), as modes are refused there.
    """
    floor = loose(corners_held(*fixed) if fixed else None)
    with pytest.raises(UnrestrainedModeError, match="can move without strain"):
        self_weight_deflection(floor)
    held = loose(corners_held(0, 1, 2))
    assert -1.0 < self_weight_deflection(held).min() < 0.0
