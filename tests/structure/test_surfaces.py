"""Surfaces: several, sloping, of several kinds of elements."""

from dataclasses import dataclass

import numpy as np
import pytest

from models import small_floor
from trundle.dynamics import factorise
from trundle.errors import InputError
from trundle.route import contact_rows
from trundle.structure import (
    CONCRETE,
    Floor,
    Frame,
    Hat,
    Hermite,
    ShellGroup,
    ShellSection,
    Surface,
)
from trundle.structure.elements import Located, Weights

SECTION = ShellSection(thickness=0.2, material=CONCRETE)


LEVEL = np.eye(3)


def plate(turn=LEVEL, origin=(0.0, 0.0, 0.0), n=6, size=(6.0, 4.0)):
    """A plate clamped all round, turned in space, with its surface."""
    x, y = np.meshgrid(np.linspace(0.0, size[0], n + 1), np.linspace(0.0, size[1], n + 1))
    flat = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    edge = (flat[:, 0] % size[0] == 0.0) | (flat[:, 1] % size[1] == 0.0)
    at = np.arange(x.size).reshape(x.shape)
    corners = (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1])
    slab = ShellGroup(elements=np.stack([c.ravel() for c in corners], axis=1), section=SECTION)
    nodes = np.array(origin) + flat @ turn.T
    frame = Frame(origin=np.array(origin), x_axis=turn[:, 0], y_axis=turn[:, 1])
    return Floor(
        nodes=nodes,
        fixed=np.repeat(edge[:, None], 6, axis=1),
        shells=(slab,),
        decks=(Surface(name="ramp", nodes=nodes, groups=(slab,), frame=frame),),
    )


def sinking(floor, load=(2.3, 1.4), at=(3.7, 2.2)):
    """Normal deflection at one place under a normal force of 1 N at another."""
    rows = contact_rows(floor, np.array([load, at]), np.array([[1.0, 0.0]] * 2), shape=Hermite())
    both = rows.matrix(rows.value).toarray()
    return float(both[1] @ factorise(floor.stiffness).solve(-both[0]))


def about(axis, angle):
    """A rotation about a horizontal axis."""
    c, s = np.cos(angle), np.sin(angle)
    if axis == "y":
        return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def test_a_slope_answers_as_the_level_plate_does():
    """Stiffness, contact and reading turn together: nothing depends on where space's axes are."""
    level = sinking(plate())
    turn = about("y", -0.14) @ about("x", 0.3)
    assert sinking(plate(turn, (5.0, -2.0, 7.0))) == pytest.approx(level, rel=1e-9, abs=0.0)
    assert level < 0.0


def test_the_slope_along_a_turned_way_is_the_derivative():
    """On a ramp the weights for dw/ds are those of w, differentiated."""
    floor = plate(about("y", -0.14) @ about("x", 0.3))
    u = np.random.default_rng(3).standard_normal(floor.n_dofs)
    way, h = np.array([0.6, 0.8]), 1e-6
    places = np.array([[1.2, 0.7], [3.9, 2.8]])

    def at(shift):
        rows = contact_rows(floor, places + shift * way, np.array([way] * 2), shape=Hermite())
        return rows.matrix(rows.value) @ u, rows.matrix(rows.slope) @ u

    np.testing.assert_allclose(at(0.0)[1], (at(h)[0] - at(-h)[0]) / (2 * h), rtol=1e-6)


def two_storeys():
    """One floor over another, each found by its height."""
    low = small_floor()
    n = len(low.nodes)
    nodes = np.vstack([low.nodes, low.nodes + np.array([0.0, 0.0, 4.0])])
    (slab,) = low.shells
    slabs = tuple(ShellGroup(elements=slab.elements + k * n, section=SECTION) for k in (0, 1))
    decks = tuple(
        Surface(name=f"level {k + 1}", nodes=nodes, groups=slabs, frame=Frame.level(4.0 * k))
        for k in (0, 1)
    )
    return {"nodes": nodes, "fixed": np.vstack([low.fixed] * 2), "shells": slabs}, decks


def test_storeys_are_told_apart_by_their_names():
    """The same (x, y) is read on the dofs of the storey that is named."""
    parts, decks = two_storeys()
    floor = Floor(**parts, decks=decks)
    half = floor.n_dofs // 2
    place, way = np.array([[3.3, 2.1]]), np.array([[1.0, 0.0]])
    rows = [contact_rows(floor, place, way, shape=Hermite(), on=d.name) for d in decks]
    assert rows[0].used_dofs().max() < half <= rows[1].used_dofs().min()
    np.testing.assert_array_equal(rows[0].value, rows[1].value)
    with pytest.raises(InputError, match="say on which surface: 'level 1', 'level 2'"):
        contact_rows(floor, place, way, shape=Hermite())
    with pytest.raises(InputError, match="no surface 'level 3'; choose 'level 1', 'level 2'"):
        floor.surface("level 3")


def test_unnamed_storeys_and_doubled_names_are_refused():
    parts, decks = two_storeys()
    with pytest.raises(InputError, match="level elements at 0 and 4 m; name the surfaces"):
        Floor(**parts).surface()
    with pytest.raises(InputError, match="two surfaces are called 'level 1'"):
        Floor(**parts, decks=(decks[0], decks[0]))
    with pytest.raises(InputError, match="no element of its groups lies in its plane"):
        Surface(name="roof", nodes=parts["nodes"], groups=parts["shells"], frame=Frame.level(8.0))


@pytest.mark.parametrize(
    ("x", "y", "said"),
    [
        ([1.0, 0.0, 0.1], [0.0, 1.0, 0.0], "unit length and at right angles"),
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], "must look up"),
    ],
)
def test_frames_that_are_none_are_refused(x, y, said):
    with pytest.raises(InputError, match=said):
        Frame(x_axis=np.array(x), y_axis=np.array(y))


@dataclass(frozen=True)
class Triangles:
    """Three nodes, stood on by area coordinates; no stiffness of its own here."""

    connectivity: np.ndarray
    name: str = "triangles"
    stands_on_ground: bool = False

    @property
    def carried(self):
        return np.ones(6, dtype=bool)

    def stiffness_blocks(self, xyz):
        return None

    def mass_blocks(self, xyz):
        return None

    def locate(self, corners, places):
        sides = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
        local = np.linalg.solve(sides, (places - corners[:, 0])[:, :, None])[:, :, 0]
        return Located(local, np.maximum(-local.min(axis=1), local.sum(axis=1) - 1.0))

    def weights(self, local, corners, shape):
        value = np.zeros((len(local), 3, 3))
        value[:, :, 0] = np.column_stack([1.0 - local.sum(axis=1), local])
        sides = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
        by_local = np.zeros((len(local), 2, 3, 3))
        by_local[:, :, :, 0] = [[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]]
        gradient = np.linalg.solve(sides.transpose(0, 2, 1), by_local.reshape(len(local), 2, 9))
        return Weights(value.reshape(len(local), 9), gradient)


def test_kinds_of_elements_make_one_surface():
    """A plane is a plane over quadrilaterals and triangles alike, in value and in slope."""
    nodes = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [4, 0.5, 0], [3.5, 2, 0]], float)
    quads = ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=SECTION)
    triangles = Triangles(np.array([[1, 4, 2], [4, 5, 2]]))
    floor = Floor(
        nodes=nodes, fixed=np.zeros((6, 6), dtype=bool), shells=(quads,), others=(triangles,)
    )
    u = np.zeros(floor.n_dofs)
    u[floor.dof_index[:, 2]] = 2.0 + 3.0 * nodes[:, 0] - 4.0 * nodes[:, 1]
    u[floor.dof_index[:, 3]], u[floor.dof_index[:, 4]] = -4.0, -3.0
    places = np.array([[0.4, 1.7], [2.5, 0.6], [3.2, 1.6], [1.9, 0.1], [3.8, 0.6]])
    for shape in (Hermite(), Hat()):
        rows = contact_rows(floor, places, np.array([[0.6, 0.8]] * 5), shape=shape)
        x, y = places.T
        np.testing.assert_allclose(rows.matrix(rows.value) @ u, 2.0 + 3.0 * x - 4.0 * y)
        np.testing.assert_allclose(rows.matrix(rows.slope) @ u, 3.0 * 0.6 - 4.0 * 0.8)
    with pytest.raises(InputError, match="not on the floor"):
        contact_rows(floor, np.array([[3.9, 1.8]]), np.array([[1.0, 0.0]]), shape=Hat())
