"""Places of maps: where they lie, how many, and how values find back to them."""

import numpy as np
import pytest

from models import small_floor
from studies import BUILDING
from trundle.criteria import VC
from trundle.study.map_plan import MapGrid, MapPlan, grids_over, map_places
from trundle.study_file import study_from_text


@pytest.mark.parametrize(
    ("extent", "spacing", "lines"),
    [
        ((0.0, 12.0), 3.0, [1.5, 4.5, 7.5, 10.5]),
        ((-6.0, 0.0), 2.5, [-5.0, -3.0, -1.0]),
        ((0.0, 1.0), 10.0, [0.25, 0.75]),
        ((0.0, 0.3 * 3), 0.3, [0.15, 0.45, 0.75]),
    ],
)
def test_lines_stand_half_a_step_inside_and_no_further_apart_than_asked(extent, spacing, lines):
    """By hand; two lines at least, and 0.9 m by 0.3 m is three steps in spite of round-off."""
    np.testing.assert_allclose(map_places(extent, spacing, (0.0, 1.0)), lines, atol=1e-12)


def test_without_a_spacing_a_floor_has_about_300_places_that_are_square():
    """On 60 m by 20 m the step is sqrt(1200 / 300) = 2 m: 30 by 10 lines."""
    x = map_places((0.0, 60.0), None, (0.0, 20.0))
    y = map_places((0.0, 20.0), None, (0.0, 60.0))
    assert (len(x), len(y)) == (30, 10)
    np.testing.assert_allclose(np.diff(x), 2.0)
    np.testing.assert_allclose(np.diff(y), 2.0)


def test_places_run_along_x_fastest_and_values_find_back():
    """Values that are 10 x + y at their places are so on the grid, rows being y."""
    x, y = np.array([1.0, 2.0, 3.0]), np.array([5.0, 7.0])
    grid = MapGrid.over(x, y, None, None)
    np.testing.assert_array_equal(grid.xy, [[1, 5], [2, 5], [3, 5], [1, 7], [2, 7], [3, 7]])
    on_grid = grid.filled(10.0 * grid.xy[:, 0] + grid.xy[:, 1])
    np.testing.assert_array_equal(on_grid, [[15, 25, 35], [17, 27, 37]])


@pytest.fixture(scope="module")
def building():
    return study_from_text(BUILDING)


def test_openings_have_no_places(building):
    """The deck's opening is 10 to 12 m by 2 to 4 m: one of 2 m squares of the deck is missing."""
    deck, lab = grids_over(building.floor.surfaces, 2.0)
    assert (deck.on, lab.on) == ("deck", "lab")
    assert deck.there.shape == lab.there.shape == (3, 8)
    missing = np.argwhere(~deck.there)
    assert [(deck.x[c], deck.y[r]) for r, c in missing] == [(11.0, 3.0)]
    assert lab.there.all()
    values = deck.filled(np.ones(23))
    assert np.isnan(values[1, 5])
    assert np.nansum(values) == 23.0


def test_a_floor_of_one_surface_needs_no_name():
    """Nothing stands before a map's label where there is only one surface."""
    (grid,) = grids_over(small_floor().surfaces, 3.0)
    assert grid.on is None
    assert grid.label == ""
    assert len(grid.spots) == 4 * 2


def plan(*grids):
    return MapPlan(
        grids=grids, runs=10, criteria=VC, criterion="VC-A", percentile=95.0, averaging="max_1s",
        traffic=False, every_step=False, peaks=False, people=False, speeds=(),
    )  # fmt: skip


@pytest.fixture(scope="module")
def mapped(building):
    """Deck upright, deck along x, lab upright: 23, 23 and 24 places."""
    deck, lab = grids_over(building.floor.surfaces, 2.0)
    level = MapGrid.over(deck.x, deck.y, building.floor.surfaces["deck"], "deck", "x")
    return plan(deck, level, lab)


def test_places_of_all_surfaces_are_numbered_through(mapped):
    """23 + 23 + 24 places; the slices of each grid tile them without a gap."""
    assert mapped.n_places == 70
    parts = [(grid.label, part.start, part.stop) for grid, part in mapped.parts()]
    assert parts == [("deck", 0, 23), ("deck, along x", 23, 46), ("lab", 46, 70)]
    np.testing.assert_array_equal(np.flatnonzero(mapped.level), np.arange(23, 46))
    assert mapped.motion == "vertical, along x"


@pytest.mark.parametrize(
    ("place", "where"),
    [
        (0, (1.0, 1.0, "deck")),
        (12, (9.0, 3.0, "deck")),
        (13, (13.0, 3.0, "deck")),  # (11, 3) is in the opening
        (22, (15.0, 5.0, "deck")),
        (23, (1.0, 1.0, "deck, along x")),
        (46, (1.0, 1.0, "lab")),
        (69, (15.0, 5.0, "lab")),
    ],
)
def test_a_place_is_found_by_its_number(mapped, place, where):
    """Counted by hand: eight squares a row, the sixth of the second row left out on the deck."""
    x, y, label = mapped.where(place)
    assert (x, y) == pytest.approx(where[:2])
    assert label == where[2]


def test_no_place_is_beyond_the_last(mapped):
    """70 places are numbered 0 to 69."""
    with pytest.raises(IndexError):
        mapped.where(70)
    upright = plan(mapped.grids[0], mapped.grids[2])
    with pytest.raises(IndexError):
        upright.where(47)
    assert upright.motion == "vertical"
    assert not upright.level.any()
