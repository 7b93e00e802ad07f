"""Elements under places: graded meshes, openings, edges, many places, and what is said of others."""

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.structure import (
    CONCRETE,
    BeamGroup,
    BeamSection,
    Floor,
    Frame,
    ShellGroup,
    ShellSection,
    Surface,
    TriangleGroup,
)

SLAB = ShellSection(thickness=0.2, material=CONCRETE)


def grid(x, y, name="floor", *, without=()):
    """Return a level surface of rectangles between lines, some of them left out."""
    xx, yy = np.meshgrid(x, y)
    at = np.arange(xx.size).reshape(xx.shape)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    quads = np.delete(quads, list(without), axis=0)
    nodes = np.column_stack([xx.ravel(), yy.ravel(), np.zeros(xx.size)])
    group = ShellGroup(elements=quads, section=SLAB)
    return Surface(name=name, nodes=nodes, groups=(group,), frame=Frame.level(0.0))


def test_on_a_graded_mesh_the_element_need_not_be_the_nearest():
    """A bay of 10 m beside strips of 1 cm: thirteen centres are nearer than its own, yet it holds."""
    surface = grid(np.concatenate([[0.0], 10.0 + 0.01 * np.arange(40)]), np.array([0.0, 0.3]))
    places = np.array([[9.9, 0.2], [10.003, 0.1], [5.0, 0.15]])
    part, rows, elements, local = next(surface.find(places))
    assert (rows.tolist(), elements.tolist()) == ([0, 1, 2], [0, 1, 0])
    np.testing.assert_allclose(local[:, 0], [2 * 9.9 / 10 - 1, 2 * 0.3 - 1, 0.0], atol=1e-9)
    assert part.group.section is SLAB


def test_edges_belong_to_the_surface_and_a_millimetre_beyond_does_not():
    """Corners and sides are held, openings and what is outside are not."""
    surface = grid(np.arange(4.0), np.arange(4.0), without=[4])
    places = np.array(
        [[0.0, 0.0], [3.0, 1.7], [1.0, 1.5], [1.5, 1.5], [3.001, 1.0], [-0.001, 1.0], [np.pi, 9]]
    )
    assert surface.holds(places).tolist() == [True, True, True, False, False, False, False]
    low, high = surface.extent
    assert (low.tolist(), high.tolist()) == ([0.0, 0.0], [3.0, 3.0])


def test_what_is_not_on_it_is_said_with_the_reason():
    """Beyond its box the box is told; within it there is an opening; names are told as they are."""
    surface = grid(np.arange(4.0), np.arange(4.0), name="Süd <b>", without=[4])
    with pytest.raises(
        InputError, match=r"point \(1\.5, 1\.4\) m is not on 'Süd <b>': there is an"
    ):
        next(surface.find(np.array([[0.5, 0.5], [1.5, 1.4]])))
    with pytest.raises(
        InputError, match=r"\(4, 1\) m is not on 'Süd <b>', which covers x 0 to 3 m"
    ):
        next(surface.find(np.array([[4.0, 1.0]])))
    with pytest.raises(InputError, match="is not on the floor, which"):
        next(grid(np.arange(3.0), np.arange(3.0)).find(np.array([[4.0, 1.0]])))


def test_many_places_are_found_as_each_alone():
    """More than one block of 20,000: element and place in it by hand, on squares of a metre."""
    surface = grid(np.arange(8.0), np.arange(6.0))
    places = np.random.default_rng(1).uniform([0.01, 0.01], [6.99, 4.99], (20_500, 2))
    ((_, rows, elements, local),) = surface.find(places)
    np.testing.assert_array_equal(rows, np.arange(20_500))
    column, row = np.floor(places).astype(int).T
    np.testing.assert_array_equal(elements, column + 7 * row)
    np.testing.assert_allclose(local, 2.0 * (places - np.floor(places)) - 1.0, atol=1e-9)


def test_groups_of_both_shapes_number_their_elements_each_from_nought():
    """A square and a triangle beside it: each place on its own group's first element."""
    nodes = np.array(
        [[0.0, 0, 2], [1, 0, 2], [1, 1, 2], [0, 1, 2], [2, 0, 2], [0, 0, 9], [1, 0, 9]]
    )
    square = ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=SLAB)
    corner = TriangleGroup(connectivity=np.array([[1, 4, 2], [5, 6, 1]]), section=SLAB)
    surface = Surface(
        name="s", nodes=nodes, groups=(square, corner), frame=Frame.level(2.0)
    )  # fmt: skip
    found = {
        part.group: (rows.tolist(), elements.tolist())
        for part, rows, elements, _ in surface.find(np.array([[1.2, 0.1], [0.5, 0.5], [1.7, 0.2]]))
    }
    assert found == {square: ([1], [0]), corner: ([0, 2], [0, 0])}
    assert [len(elements) for _, elements in surface.parts] == [1, 1]
    assert repr(surface) == "<Surface 's': 2 elements>"


def test_the_size_of_elements_is_their_usual_side():
    """Strips of 0.5 m along x, one of 3 m: the median is 0.5 m."""
    surface = grid(np.array([0.0, 0.5, 1.0, 1.5, 4.5]), np.array([0.0, 1.0]))
    assert surface.element_size == pytest.approx(0.5)


def test_the_floor_of_a_plan_is_its_slab_and_not_its_columns():
    """Level beams lie under the slab's lines; what is stood on are shells alone."""
    floor = small_floor(mesh_size=3.0)
    surface = floor.surface()
    assert list(floor.surfaces) == ["floor"]
    assert [group for group, _ in surface.parts] == list(floor.shells)
    columns = Floor(
        nodes=np.array([[0.0, 0, 0], [0, 0, 3]]), fixed=np.zeros((2, 6), dtype=bool),
        beams=(BeamGroup(elements=np.array([[0, 1]]),
                         section=BeamSection.rectangle(0.3, 0.3, CONCRETE)),), name="a post",
    )  # fmt: skip
    with pytest.raises(InputError, match="a post: no level element for a wheel to stand on"):
        columns.surface()
