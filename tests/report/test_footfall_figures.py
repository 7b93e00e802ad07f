"""People who walk, in maps and tables: where it is largest, who walks there, and in what unit."""

import csv
import json

import numpy as np
import pytest
from hand_made import study_of
from matplotlib.collections import QuadMesh
from matplotlib.contour import ContourSet

import trundle as tr
from studies import BUILDING
from trundle.errors import FitnessWarning
from trundle.footfall import footfall_load
from trundle.report.figures import footfall as figures
from trundle.report.pages.footfall import footfall_summary, write_footfall
from trundle.run.footfall import FootfallAsked, StudyFootfall
from trundle.simulate import FootfallResponse, footfall_rule
from trundle.simulate.spectral.footfall_response import FootfallLevels
from trundle.study.map_plan import grids_over
from trundle.views.footfall import FootfallDose


def levels_of(level, walker=None, harmonic=2):
    n = len(level)
    return FootfallLevels(
        level=np.asarray(level, float),
        pace=np.full(n, 1.95),
        harmonic=np.full(n, harmonic),
        mode=np.zeros(n, int),
        frequency=np.full(n, 5.4321),
        walker=np.arange(n) if walker is None else np.asarray(walker),
    )


def found_of(study, spacing, level, *, guide="p354", walker=None, transient=None, **asked):
    grids = grids_over(study.floor.surfaces, spacing)
    n = sum(len(grid.spots) for grid in grids)
    level = np.broadcast_to(np.asarray(level, float), (n,))
    return StudyFootfall(
        study=study,
        asked=FootfallAsked(guide=guide, spacing=spacing, **asked),
        method=study.methods[0],
        grids=grids,
        response=FootfallResponse(
            load=footfall_load(guide),
            rule=footfall_rule(guide),
            paces=np.array([1.8, 2.0, 2.2]),
            steady=levels_of(level, walker),
            transient=None if transient is None else levels_of(transient, walker, harmonic=0),
            doubts=(FitnessWarning(subject="a <b>", message="say so"),),
        ),
    )


@pytest.fixture(scope="module")
def plan():
    return study_of()


LEVELS = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 12.5, 8.0])
"""Row by row from y = 1.5 m on: the largest at x = 7.5 m, y = 4.5 m."""


def image_of(panel):
    (image,) = [c for c in panel.collections if isinstance(c, QuadMesh)]
    return image


def marks(panel, marker):
    return [
        (float(line.get_xdata()[0]), float(line.get_ydata()[0]))
        for line in panel.lines
        if line.get_marker() == marker
    ]


def test_levels_are_drawn_where_they_are_and_the_worst_is_marked(plan):
    """The largest, 12.5, is the seventh of 4 by 2 places; it is walked at the second for it."""
    walker = np.arange(8)
    walker[6] = 1
    found = found_of(plan, 3.0, LEVELS, walker=walker)
    (drawing,) = figures.drawings(found)
    assert drawing.name == "footfall_map"
    panel, bar = drawing.draw().axes
    np.testing.assert_allclose(np.ma.getdata(image_of(panel).get_array()).ravel(), LEVELS)
    np.testing.assert_allclose(image_of(panel).get_coordinates()[0, :, 0], [0, 3, 6, 9, 12])
    assert marks(panel, "X") == [(7.5, 4.5)]
    assert marks(panel, "o") == [(4.5, 1.5)]
    assert panel.get_title() == "largest 12.5 at (7.50, 4.50) m"
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("x [m]", "y [m]")
    assert bar.get_xlabel() == f"response factor, {found.response.load.name}"


def test_lines_are_at_response_factors_that_people_know(plan):
    """Between 1 and 12.5: at 2, 4, 8 and 10; a peak acceleration has no such steps, and no line."""
    panel = next(figures.drawings(found_of(plan, 3.0, LEVELS))).draw().axes[0]
    (lines,) = [c for c in panel.collections if isinstance(c, ContourSet)]
    assert lines.levels.tolist() == [2.0, 4.0, 8.0, 10.0]
    panel, bar = (
        next(figures.drawings(found_of(plan, 3.0, 0.01 * LEVELS, guide="dg11"))).draw().axes
    )
    assert not [c for c in panel.collections if isinstance(c, ContourSet)]
    assert bar.get_xlabel().startswith("peak acceleration [m/s2], ")


def test_a_scale_has_two_decades_at_most(plan):
    """Edges hardly move: from a hundredth of the largest on; where nothing moves nothing is drawn."""
    level = np.array([0.0, 1e-6, 0.2, 1.0, 2.0, 3.0, 4.0, 5.0])
    panel = next(figures.drawings(found_of(plan, 3.0, level))).draw().axes[0]
    image = image_of(panel)
    assert (image.norm.vmin, image.norm.vmax) == (pytest.approx(0.05), 5.0)
    shown = np.ma.filled(np.ma.masked_invalid(image.get_array()).ravel(), np.nan)
    assert np.isnan(shown[0])
    np.testing.assert_allclose(shown[1:], level[1:])


def test_one_level_everywhere_is_drawn(plan):
    """A floor that answers alike at every place has a scale of a tenth to both sides."""
    panel = next(figures.drawings(found_of(plan, 3.0, 2.0))).draw().axes[0]
    image = image_of(panel)
    assert (image.norm.vmin, image.norm.vmax) == (pytest.approx(1.8), pytest.approx(2.2))


@pytest.fixture(scope="module")
def storeys():
    """Deck and laboratory of 4 by 2 places each; in the deck's opening there is none."""
    return tr.study_from_text(BUILDING)


def test_each_storey_has_its_own_worst_on_the_scale_of_both(storeys):
    """The second storey's largest, 3, is named with its storey; colours reach to the first's, 9."""
    grids = grids_over(storeys.floor.surfaces, 3.0)
    sizes = [len(grid.spots) for grid in grids]
    level = np.concatenate([np.linspace(1.0, 9.0, sizes[0]), np.linspace(0.5, 3.0, sizes[1])])
    walker = np.arange(len(level))
    walker[-1] = 0  # felt in the laboratory, walked on the deck
    found = found_of(storeys, 3.0, level, walker=walker)
    drawn = list(figures.drawings(found))
    assert [one.name for one in drawn] == ["footfall_map_1", "footfall_map_2"]
    assert drawn[1].title.endswith(", lab")
    panels = [one.draw().axes[0] for one in drawn]
    assert panels[0].get_title().startswith("deck: largest 9 at")
    x, y = grids[1].xy[-1]
    assert panels[1].get_title() == f"lab: largest 3 at ({x:.2f}, {y:.2f}) m"
    for panel in panels:
        image = image_of(panel)
        assert (image.norm.vmin, image.norm.vmax) == (pytest.approx(0.5), pytest.approx(9.0))
    assert marks(panels[1], "o") == []  # who walks is on another storey
    assert marks(panels[1], "X") == [(pytest.approx(x), pytest.approx(y))]
    assert len(marks(panels[0], "o")) == 1


def test_the_larger_of_harmonics_and_impulses_is_what_is_told(plan):
    """Impulses are larger at one place alone: there they govern, and both stand in the table."""
    impulses = np.full(8, 1.5)
    impulses[0] = 20.0
    found = found_of(plan, 3.0, LEVELS, transient=impulses)
    summary = footfall_summary(found)
    (worst,) = summary["worst"]
    assert (worst["x_m"], worst["y_m"]) == (1.5, 1.5)
    assert (worst["response_factor"], worst["steady_state"], worst["transient"]) == (
        20.0,
        1.0,
        20.0,
    )
    assert worst["harmonic"] == 0
    panel = next(figures.drawings(found)).draw().axes[0]
    assert panel.get_title() == "largest 20 at (1.50, 1.50) m"


def test_the_summary_says_what_was_asked_and_by_whom(plan):
    """Guide with its source, the ends of the paces, how far is walked, and every doubt."""
    found = found_of(plan, 3.0, LEVELS, everywhere=False, length=9.0)
    summary = footfall_summary(found)
    load = footfall_load("p354")
    assert (summary["guide"], summary["source"]) == (load.title, load.source)
    assert summary["paces_hz"] == [1.8, 2.2]
    assert summary["excitation"] == "self"
    assert summary["walked_length_m"] == 9.0
    assert summary["quantity"] == "response_factor"
    assert summary["warnings"] == ["a <b>: say so"]
    assert footfall_summary(found_of(plan, 3.0, LEVELS))["excitation"] == "full"


def test_the_folder_has_every_place_in_its_own_row(plan, tmp_path):
    """x runs first; an endless way is null in JSON, and no number that JSON does not have."""
    found = found_of(plan, 3.0, 0.01 * LEVELS, guide="dg11")
    write_footfall(found, tmp_path)
    assert {entry.name for entry in tmp_path.iterdir()} == {
        "footfall.csv", "footfall.json", "footfall_map.png", "footfall_map.svg",
    }  # fmt: skip
    with (tmp_path / "footfall.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(float(r["x_m"]), float(r["y_m"])) for r in rows[:5]] == [
        (1.5, 1.5), (4.5, 1.5), (7.5, 1.5), (10.5, 1.5), (1.5, 4.5),
    ]  # fmt: skip
    np.testing.assert_allclose([float(r["peak_acceleration_m_s2"]) for r in rows], 0.01 * LEVELS)
    assert {r["frequency_hz"] for r in rows} == {"5.4321"}
    assert {r["transient"] for r in rows} == {""}  # the guide has none
    text = (tmp_path / "footfall.json").read_text(encoding="utf-8")
    kept = json.loads(text, parse_constant=pytest.fail)
    assert kept["walked_length_m"] is None
    assert kept["worst"][0]["peak_acceleration_m_s2"] == pytest.approx(0.125)


def test_doses_have_a_column_of_their_own_where_they_are_asked_for(plan, tmp_path):
    """Sixteen times the passages double a dose: the fourth root of their number."""
    found = found_of(plan, 3.0, LEVELS)
    doses = []
    for name, passages in (("one", 1.0), ("many", 16.0)):
        (tmp_path / name).mkdir()
        write_footfall(found, tmp_path / name, FootfallDose(passages=passages, duration=10.0))
        with (tmp_path / name / "footfall.csv").open(encoding="utf-8", newline="") as file:
            doses.append([float(row["vdv_m_s1.75"]) for row in csv.DictReader(file)])
    np.testing.assert_allclose(doses[1], 2.0 * np.array(doses[0]), rtol=1e-5)
    # 0.68 times the RMS that a response factor of 1 has, 0.005 m/s2, over 10 s
    assert doses[0][0] == pytest.approx(0.68 * 0.005 * 10.0**0.25, rel=1e-5)
