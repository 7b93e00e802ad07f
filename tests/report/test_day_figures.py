"""Days in pictures and on the page: events hour by hour, over the floor, and what is not known."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made import BANDS, Page, class_map_of, result_of, study_of
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgba
from matplotlib.patches import StepPatch

from trundle.criteria import find_criterion
from trundle.report.figures import day as figures
from trundle.report.pages.study import _render
from trundle.results.cells import DayKey
from trundle.results.expected_days import DayRow
from trundle.results.maps import MapKey, StudyMap
from trundle.traffic import Day, Expected, Loudest, Meeting
from trundle.views.day_map import day_maps

SCHEDULE = """
[[schedule]]
name = "Früh & <spät>"
route = "main"
times = ["6:30", "8:10", "8:50", "22:15"]
"""
MAP = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
CURVES = ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-C"]')
NO_END = ('duration = "4 s"\n', "")
KEY = DayKey("Früh & <spät>", "B")


def expected(by_hour, **more):
    values = {
        "events": float(np.sum(by_hour)), "events_interval": (0.0, 1.0),
        "events_on_days": (0.0, 4.0), "any_event": 0.5, "by_hour": np.asarray(by_hour, float),
        "minutes": 1.0, "minutes_interval": (0.5, 2.0),
    }  # fmt: skip
    return Expected(**{**values, **more})


def day_of(points, criteria, events, seconds):
    """A day that was run, with events and seconds by hour, criterion and point."""
    return Day(
        schedule=KEY.schedule, n_passages=4, counts={"main": 4}, busy=90.0, at_once=1,
        point_names=points, criteria=criteria, complete=(True,) * len(criteria),
        seconds_above=np.asarray(seconds, float), events=np.asarray(events, int), loudest=(),
        dose_day=np.array([0.2] * len(points)), dose_night=np.array([0.1] * len(points)),
        meeting_error=np.nan,
    )  # fmt: skip


def row_of(point, name, by_hour, day=None):
    return DayRow(
        key=KEY, point=point, criterion=find_criterion(name), expected=expected(by_hour),
        complete=True, day=day,
    )  # fmt: skip


def test_hours_are_steps_and_what_was_run_are_marks_in_their_middle():
    """Each hour's own height from its beginning to its end; a mark where something was, at half past."""
    hours = np.arange(24.0) / 10.0
    events = np.zeros((24, 2, 2))
    events[8, 1, 1], events[17, 1, 1], events[9, 0, 1] = 3, 1, 7
    day = day_of(("other", "tool"), ("VC-A", "VC-C"), events, np.ones((24, 2, 2)))
    figure = figures.hours_figure([row_of("tool", "VC-C", hours, day)])
    (panel,) = figure.axes
    (steps,) = [patch for patch in panel.patches if isinstance(patch, StepPatch)]
    heights, edges, _ = steps.get_data()
    np.testing.assert_allclose(heights, hours)
    np.testing.assert_allclose(edges, np.arange(25))
    (marks,) = panel.lines
    np.testing.assert_allclose(np.column_stack(marks.get_data()), [[8.5, 3.0], [17.5, 1.0]])
    assert panel.get_title() == "tool"
    assert panel.get_ylabel() == "events an hour"
    assert (panel.get_xlabel(), panel.get_xlim()) == ("hour of the day", (0.0, 24.0))
    assert panel.get_ylim()[0] == 0.0


def test_a_criterion_without_a_running_level_has_no_marks():
    """Nothing counts events of it on the day that was run: nought would be a number, it is unknown."""
    seconds = np.ones((24, 1, 1))
    seconds[:, 0, 0] = np.nan
    day = day_of(("tool",), ("VC-A",), np.full((24, 1, 1), 5), seconds)
    (panel,) = figures.hours_figure([row_of("tool", "VC-A", np.ones(24), day)]).axes
    assert len(panel.lines) == 0


def test_each_point_has_a_panel_with_its_own_rows():
    """Heights of a point's curves are in its panel, in the order of the criteria, one colour each."""
    rows = [
        row_of(point, name, np.full(24, height))
        for point, name, height in (
            ("a", "VC-A", 1.0), ("a", "VC-C", 2.0), ("b", "VC-A", 3.0), ("b", "VC-C", 4.0),
        )
    ]  # fmt: skip
    figure = figures.hours_figure(rows)
    assert [panel.get_title() for panel in figure.axes] == ["a", "b"]
    shown = [[float(p.get_data().values[0]) for p in panel.patches] for panel in figure.axes]
    assert shown == [[1.0, 2.0], [3.0, 4.0]]
    (legend,) = figure.legends
    labels = [text.get_text() for text in legend.get_texts()]
    colours = [to_rgba(handle.get_color()) for handle in legend.legend_handles]
    for panel in figure.axes:
        for patch, colour in zip(panel.patches, colours, strict=True):
            assert patch.get_edgecolor() == colour
    assert labels == ["VC-A", "VC-C"]


@pytest.fixture(scope="module")
def result():
    """Four passages, three of them by day; a map of 8 places of which one does not move."""
    study = study_of(SCHEDULE + MAP, CURVES, NO_END)
    n = study.map.n_places
    share = np.linspace(0.0, 0.7, n)
    share[3] = np.nan
    classes = class_map_of(study.map.grids, {"VC-A": 2.0, "VC-C": 0.5})
    shares = np.stack([share, np.full(n, 0.9)])
    classes = replace(classes, share_exceeding=shares)
    one = StudyMap(
        classes=classes,
        numbers={
            name: np.ones(n)
            for name in ("rms_velocity", "peak_acceleration", "response_factor", "vdv")
        },
        band_levels=np.zeros((n, len(BANDS))),
        seconds_above={"VC-A": np.arange(n) * 3.0, "VC-C": np.zeros(n)},
    )
    made = result_of(study, 2e-5)
    cells = {}
    for key, cell in made.cells.items():
        above = {"VC-A": np.array([[0.0], [0.0], [6.0]]), "VC-C": np.array([[1.0], [3.0], [8.0]])}
        cells[key] = replace(cell, reduced=replace(cell.reduced, above=above))
    return replace(made, cells=cells, maps={MapKey("main", "B"): one})


def test_a_day_over_the_floor_is_passages_times_their_chance(result):
    """Four a day times the share of runs above; four times the seconds of one, in minutes."""
    drawn = {one.name: one for one in figures.drawings(result)}
    assert set(drawn) == {"day_hours", "day_map"}
    figure = drawn["day_map"].draw()
    panels = [axes for axes in figure.axes if axes.get_title()]
    assert [panel.get_title() for panel in panels] == ["events a day", "minutes a day"]
    images = [next(c for c in panel.collections if isinstance(c, QuadMesh)) for panel in panels]
    share = np.linspace(0.0, 0.7, 8)
    events = np.ma.filled(np.ma.masked_invalid(images[0].get_array()).ravel(), np.nan)
    np.testing.assert_allclose(events[[0, 1, 2, 4, 5, 6, 7]], 4.0 * share[[0, 1, 2, 4, 5, 6, 7]])
    assert np.isnan(events[3])
    np.testing.assert_allclose(
        np.ma.getdata(images[1].get_array()).ravel(), 4.0 * np.arange(8) * 3.0 / 60.0
    )
    assert (images[0].norm.vmin, images[0].norm.vmax) == (0.0, pytest.approx(2.8))
    assert (images[1].norm.vmin, images[1].norm.vmax) == (0.0, pytest.approx(1.4))
    bars = [axes.get_xlabel() for axes in figure.axes if axes not in panels]
    assert bars == ["passages a day above VC-A", "minutes a day above VC-A"]


def test_where_nothing_is_known_of_a_day_the_scale_still_stands(result):
    """All minutes unknown and no event: scales from 0 to 1, cells empty, no number made up."""
    maps = [
        replace(one, events=np.zeros(8), minutes=np.full(8, np.nan))
        for one in day_maps(result, KEY)
    ]
    figure = figures.day_map_figure(result, maps)
    images = [c for axes in figure.axes for c in axes.collections if isinstance(c, QuadMesh)]
    shown = [image for image in images if np.size(image.get_array()) == 8]
    assert [(one.norm.vmin, one.norm.vmax) for one in shown] == [(0.0, 1.0), (0.0, 1.0)]
    assert np.ma.getmaskarray(np.ma.masked_invalid(shown[1].get_array())).all()


def test_without_a_map_of_every_route_there_is_no_map_of_the_day(result):
    """A route that nobody mapped would be left out of the sum: nothing is drawn instead."""
    names = [one.name for one in figures.drawings(replace(result, maps={}))]
    assert names == ["day_hours"]


def test_the_page_says_of_a_day_what_was_computed(result):
    """By hand: one of three runs is above VC-A, so 4/3 of an event; 4 x (0 + 0 + 6) / 3 = 8 s.

    All three are above VC-C (12.5 um/s) but the least, of 10: 8/3, and 4 x 12 / 3 = 16 s.
    """
    page = Page(_render(result, []))
    assert "Früh & <spät>, road B" in page.headings
    first, second = page.rows("days")
    assert (first["point"], first["criterion"]) == ("tool", "VC-A")
    assert first["events a day"].startswith("1.33 (")
    assert first["minutes a day"].startswith("0.133 (")
    assert second["events a day"].startswith("2.67 (")
    assert second["minutes a day"].startswith("0.267 (")
    assert first["day that was run"] == ""  # none was
    assert first["its largest level, and who was there"] == ""
    assert "4 passages a day (main 4)" in page.said("days")


def test_doses_add_by_their_fourth_powers_by_day_and_by_night(result):
    """7 to 23 h: three of four passages, (3 m)^(1/4); the one at 6:30 by night, m^(1/4).

    m is the mean fourth power of 0.1, 0.2 and 0.8 mm/s^1.75, ten times levels of 10, 20, 80 um/s.
    """
    page = Page(_render(result, []))
    (row,) = page.rows("days", 1)
    mean = np.mean(np.array([1e-4, 2e-4, 8e-4]) ** 4)
    assert row["point"] == "tool"
    assert row["VDV, 7 to 23 h [m/s^1.75]"] == f"{(3.0 * mean) ** 0.25:.3g}"
    assert row["night"] == f"{mean**0.25:.3g}"
    # estimated: 1.4 times an RMS of 0.05, 0.1 and 0.4 mm/s2 times the fourth root of 4 s
    rms = np.mean((1.4 * np.array([5e-5, 1e-4, 4e-4]) * 4.0**0.25) ** 4)
    assert row["eVDV, 7 to 23 h"] == f"{(3.0 * rms) ** 0.25:.3g}"


def test_a_day_that_was_run_stands_beside_what_is_expected(result):
    """Five events in 90 s: 1.5 min; the loudest with its place, its time, and who was there."""
    events, seconds = np.zeros((24, 2, 1)), np.zeros((24, 2, 1))
    events[8, 0, 0], events[22, 0, 0] = 3, 2
    seconds[8, 0, 0], seconds[22, 0, 0] = 60.0, 30.0
    one = Meeting(route="main", departed=29400.0, x=3.25, y=4.5, rms_velocity=7.5e-5)
    loudest = Loudest(
        criterion="VC-A", point="tool", ratio=1.75, band=10**1.2, time=29403.2, present=(one,)
    )
    day = replace(
        day_of(("tool",), ("VC-A", "VC-C"), events, seconds), loudest=(loudest,), busy=120.0
    )
    page = Page(_render(replace(result, days={KEY: day}), []))
    first, second = page.rows("days")
    assert first["day that was run"] == "5, 1.5 min"
    assert second["day that was run"] == "0, 0 min"
    said = first["its largest level, and who was there"]
    assert said == (
        "1.75 times the limit at 16 Hz, 08:10:03: main of 08:10:00 at (3.2, 4.5) m, alone 75 um/s"
    )
    assert second["its largest level, and who was there"] == ""
    (row,) = page.rows("days", 1)
    assert (row["VDV of the day that was run"], row["its night"]) == ("0.2", "0.1")
    assert "no two vehicles meet on the floor" in page.said("days")


def test_a_criterion_has_one_colour_in_all_panels_and_stands_in_the_legend():
    """A point that moves sideways has other limits: they are the second and third, as in the legend."""
    rows = [
        row_of("up", "electron-microscope-vertical", np.full(24, 1.0)),
        row_of("side", "electron-microscope-horizontal", np.full(24, 2.0)),
        row_of("side", "VC-A", np.full(24, 3.0)),
        row_of("last", "VC-A", np.full(24, 4.0)),
    ]
    figure = figures.hours_figure(rows)
    legend = figure.legends[0]
    assert [t.get_text() for t in legend.get_texts()] == [
        "Electron microscope, vertical", "Electron microscope, horizontal", "VC-A",
    ]  # fmt: skip
    steps = [
        [(s.get_edgecolor(), s.get_data().values[0]) for s in axes.patches if isinstance(s, StepPatch)]
        for axes in figure.axes
    ]  # fmt: skip
    assert [[value for _, value in panel] for panel in steps] == [[1.0], [2.0, 3.0], [4.0]]
    assert steps[1][1][0] == steps[2][0][0]
    assert len({colour for panel in steps for colour, _ in panel}) == 3


def test_hours_of_what_is_not_known_are_left_empty():
    """No number, and no line at zero that would look like none."""
    (axes,) = figures.hours_figure([row_of("tool", "VC-A", np.full(24, np.nan))]).axes
    (steps,) = (s for s in axes.patches if isinstance(s, StepPatch))
    assert np.isnan(steps.get_data().values).all()
    axes.figure.canvas.draw()
