"""Edges of a plan dof by dof, the middle of a floor, and what holds its plane: by the table."""

import numpy as np
import pytest

from models import small_plan
from trundle.structure import build_floor
from trundle.structure.edges import hold_edge, hold_plane, middle_of

UX, UY, UZ, RX, RY, RZ = range(6)
GRID = np.array([[x, y, 0.0] for y in (0.0, 3.0, 6.0) for x in (0.0, 4.0, 8.0)])


@pytest.mark.parametrize(
    ("kind", "across_x", "across_y"),
    [
        ("free", [], []),
        ("symmetry", [UX, RY, RZ], [UY, RX, RZ]),
        ("simple", [UY, UZ, RX], [UX, UZ, RY]),
        ("pinned", [UX, UY, UZ, RX], [UX, UY, UZ, RY]),
        ("clamped", [UX, UY, UZ, RX, RY, RZ], [UX, UY, UZ, RX, RY, RZ]),
    ],
)
def test_each_kind_of_edge_holds_what_its_table_says(kind, across_x, across_y):
    """By hand: of an edge across x the bearing turns about y; it does not twist about x.

    A mirror lets nothing cross it and turns about its own normal alone.
    """
    for edge, held in (("x_min", across_x), ("x_max", across_x), ("y_min", across_y),
                       ("y_max", across_y)):  # fmt: skip
        fixed = np.zeros((3, 6), dtype=bool)
        hold_edge(fixed, np.array([0, 2]), edge, kind)
        assert np.flatnonzero(fixed[0]).tolist() == sorted(held)
        assert fixed[2].tolist() == fixed[0].tolist()
        assert not fixed[1].any()


def test_a_built_plan_holds_its_edges_where_they_are():
    """Clamped along x = 0 and free elsewhere: the nodes there and no others of the slab."""
    plan = small_plan(
        edges={"x_min": "clamped"}, column=None, storey_below=0.0, storey_above=0.0
    )  # fmt: skip
    floor = build_floor(plan, mesh_size=3.0)
    np.testing.assert_array_equal(floor.fixed.all(axis=1), floor.nodes[:, 0] == 0.0)
    assert not floor.fixed[floor.nodes[:, 0] > 0.0].any()


@pytest.mark.parametrize(
    ("edges", "middle"),
    [
        ({}, (4.0, 5.0)),
        ({"x_min": "symmetry"}, (0.0, 5.0)),
        ({"x_max": "symmetry", "y_max": "symmetry"}, (8.0, 10.0)),
        ({"x_min": "symmetry", "x_max": "symmetry", "y_min": "symmetry"}, (4.0, 0.0)),
        ({"x_min": "clamped"}, (4.0, 5.0)),
    ],
)
def test_the_middle_is_that_of_the_floor_with_its_images(edges, middle):
    """One plane of symmetry is the middle; two on opposite sides leave it half-way between them."""
    assert middle_of(((0.0, 8.0), (0.0, 10.0)), edges) == middle


def strained_motions(fixed):
    """Count by another method which of the plane's three rigid motions supports resist."""
    rows = []
    for node, dof in zip(*np.nonzero(fixed), strict=True):
        x, y, _ = GRID[node]
        rows += {UX: [[1, 0, -y]], UY: [[0, 1, x]], RZ: [[0, 0, 1]]}.get(dof, [])
    return np.linalg.matrix_rank(np.array(rows, dtype=float).reshape(-1, 3))


@pytest.mark.parametrize(
    ("held", "added"),
    [
        ([], 3),
        ([(0, UX)], 2),
        ([(0, UX), (6, UX)], 1),  # at two heights: no turning either
        ([(0, UX), (2, UX)], 2),  # on one line: it still turns
        ([(0, UX), (0, UY)], 1),
        ([(0, UX), (0, UY), (8, UX)], 0),
        ([(0, UX), (0, UY), (0, RZ)], 0),
        ([(0, UZ), (8, UZ), (2, RX)], 3),
    ],
)
def test_what_holds_the_plane_is_as_much_as_is_missing(held, added):
    """Statically determinate: afterwards all three motions are held, each by one more dof."""
    fixed = np.zeros((9, 6), dtype=bool)
    for node, dof in held:
        fixed[node, dof] = True
    before = fixed.copy()
    hold_plane(fixed, GRID, (4.0, 3.0))
    assert strained_motions(fixed) == 3
    assert np.count_nonzero(fixed) - np.count_nonzero(before) == added
    assert not (before & ~fixed).any()
    assert set(np.nonzero(fixed & ~before)[1].tolist()) <= {UX, UY}
