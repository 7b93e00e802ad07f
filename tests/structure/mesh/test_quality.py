"""Shapes of elements and of outlines by hand: angles, aspects, boxes, faults, what lies on what."""

import re

import numpy as np
import pytest

from trundle.structure.mesh.planar import away_from, on_segment
from trundle.structure.mesh.polygons import (
    area_of,
    box_round,
    covers,
    fault_of,
    overlap,
    rings_of,
    shared_length,
    uncovered,
)
from trundle.structure.mesh.quality import angles, aspects, quality_of, signed_areas, squareness

SQUARE = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
RHOMBUS = np.array([[0.0, 0], [2, 0], [2 + np.sqrt(2), np.sqrt(2)], [np.sqrt(2), np.sqrt(2)]])
HALF = np.array([[0.0, 0], [3, 0], [0, 4]])


def box(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def test_angles_sides_and_areas_of_known_shapes():
    """A square, a rhombus of 45 degrees, and the triangle of 3, 4 and 5 m."""
    both = np.stack([SQUARE, RHOMBUS])
    np.testing.assert_allclose(np.degrees(angles(both)), [[90.0] * 4, [45, 135, 45, 135]])
    np.testing.assert_allclose(squareness(both), [1.0, 0.5], atol=1e-12)
    np.testing.assert_allclose(signed_areas(both), [4.0, 2.0 * np.sqrt(2.0)])
    np.testing.assert_allclose(signed_areas(both[:, ::-1]), [-4.0, -2.0 * np.sqrt(2.0)])
    np.testing.assert_allclose(aspects(HALF[None]), [5.0 / 3.0])
    np.testing.assert_allclose(
        np.degrees(angles(HALF[None])), [[90.0, np.degrees(np.arctan2(4, 3)),
                                         np.degrees(np.arctan2(3, 4))]]
    )  # fmt: skip


def test_a_corner_that_folds_in_is_above_180_degrees():
    """A dart: its inner corner has 270 degrees, and so the least squareness there is, -2."""
    dart = np.array([[0.0, 0], [4, 0], [1, 1], [0, 4]])
    turns = np.degrees(angles(dart[None]))[0]
    assert turns.sum() == pytest.approx(360.0)
    assert turns[2] > 180.0
    assert squareness(dart[None])[0] < 0.0


def test_quality_counts_areas_and_not_elements():
    """4 m2 of a square, 2.83 m2 of a rhombus and 6 m2 of a triangle, some groups empty."""
    found = quality_of([SQUARE[None], RHOMBUS[None], HALF[None], np.zeros((0, 4, 2))])
    whole = 4.0 + 2.0 * np.sqrt(2.0) + 6.0
    assert (found.n_quads, found.n_triangles) == (2, 1)
    assert found.share_of_quads == pytest.approx(1.0 - 6.0 / whole)
    assert found.share_of_rectangles == pytest.approx(4.0 / whole)
    assert (found.least_angle, found.largest_angle) == pytest.approx(
        (np.degrees(np.arctan2(3, 4)), 135.0)
    )
    assert found.largest_aspect == pytest.approx(5.0 / 3.0)


def test_a_polygon_covers_its_edge_and_not_its_opening():
    """Half a millimetre beyond is on it, two are not; within an opening nothing is."""
    places = np.array([[2, 1], [2.0005, 1], [2.002, 1], [1, 1], [0.5, 0.5], [0.7, 0.7]], float)
    found = covers(SQUARE, [box(0.5, 0.5, 1.5, 1.5)], places)
    assert found.tolist() == [True, True, False, False, True, False]
    assert area_of(SQUARE, [box(0.5, 0.5, 1.5, 1.5)]) == pytest.approx(3.0)


def test_what_polygons_share_is_their_common_area_without_slivers():
    """Squares that overlap by half; by a millimetre they only touch; one in another's opening."""
    assert overlap((SQUARE, ()), (SQUARE + np.array([1.0, 0.0]), ())) == pytest.approx(2.0)
    assert overlap((SQUARE, ()), (SQUARE + np.array([1.9995, 0.0]), ())) == 0.0
    hole = box(0.5, 0.5, 1.5, 1.5)
    assert overlap((SQUARE, [hole]), (hole, ())) == 0.0
    assert uncovered(box(1, 0, 3, 2), (SQUARE, ())) == pytest.approx(2.0, rel=2e-3)
    assert uncovered(hole, (SQUARE, ())) == 0.0
    line = np.array([[2.0, -1.0], [2.0, 1.5]])
    side = np.array([[2.0, 0.0], [2.0, 2.0]])
    assert shared_length(line, side) == pytest.approx(1.5, abs=1.1e-3)


@pytest.mark.parametrize(
    ("outline", "said"),
    [
        (SQUARE[:2], "has 3 corners or more; this one has 2"),
        (SQUARE[[0, 1, 1, 2, 3]], r"two corners in a row are the same, \(2, 0\) m"),
        (SQUARE[[0, 2, 1, 3]], r"must not cross or touch itself; this one does at \(1, 1\) m"),
        (np.array([[0.0, 0], [1, 0], [2, 0]]), "must enclose an area|cross or touch itself"),
        (SQUARE, None),
        (SQUARE[::-1], None),
    ],
)
def test_what_is_wrong_with_an_outline_is_said_with_its_place(outline, said):
    """A line, a corner twice, a bow tie; either way round is sound."""
    fault = fault_of(outline)
    if said is None:
        assert fault is None
    else:
        assert re.search(said, fault)


def test_lines_enclose_what_they_enclose_together():
    """Four sides drawn apart are one room; a wall across makes two; dead ends enclose nothing."""
    sides = [np.stack([SQUARE[i], SQUARE[(i + 1) % 4]]) for i in range(4)]
    across, loose = np.array([[1.0, 0.0], [1.0, 2.0]]), np.array([[2.0, 2.0], [5.0, 5.0]])
    (room,) = rings_of([*sides, loose])
    assert area_of(room) == pytest.approx(4.0)
    assert len(room) == 4
    assert sorted(area_of(one) for one in rings_of([*sides, across])) == pytest.approx([2.0, 2.0])
    assert rings_of(sides[:3]) == []
    assert rings_of([]) == []


@pytest.mark.parametrize("degrees", [0.0, 30.0, 90.0, 120.0])
def test_the_box_round_a_turned_rectangle_is_the_rectangle(degrees):
    """5 by 2 m, turned: its length, width and direction, which is one of 0 to 180 degrees."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turned = box(0, 0, 5, 2) @ np.array([[c, s], [-s, c]])
    length, width, along = box_round(turned)
    assert (length, width) == pytest.approx((5.0, 2.0))
    assert min(abs(along - degrees), 180.0 - abs(along - degrees)) < 1e-6


def test_places_on_a_segment_and_away_from_segments():
    """On it within a millimetre, its ends too; the nearest of two, and how far."""
    line = np.array([[0.0, 0.0], [3.0, 4.0]])
    across = np.array([-0.8, 0.6])
    places = np.array(
        [[1.5, 2.0], 0.9e-3 * across, [1.5, 2.0] + 1.1e-3 * across, [3.0, 4.0], [4, 5]]
    )
    assert on_segment(places, line).tolist() == [True, True, False, True, False]
    segments = np.array([[[0.0, 0.0], [10.0, 0.0]], [[0.0, 5.0], [10.0, 5.0]]])
    away, which = away_from(segments, np.array([[2.0, 1.5], [3.0, 4.0], [13.0, -4.0]]))
    np.testing.assert_allclose(away, [1.5, 1.0, 5.0])
    assert which.tolist() == [0, 1, 0]
