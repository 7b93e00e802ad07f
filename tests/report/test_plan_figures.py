"""Plans and elevations: routes, feet, machines, points and members where they are, and named."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from hand_made import result_of, study_of
from matplotlib.collections import FillBetweenPolyCollection, LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patches import Polygon

import trundle as tr
from models import small_plan
from studies import BUILDING
from trundle.report.canvas import COLOURS, new_figure
from trundle.report.figures import building as storeys
from trundle.report.figures import floor as floors
from trundle.report.figures.routes import draw_route
from trundle.report.figures.sources import draw_sources
from trundle.structure import Rectangle

WALKER = """
[[walker]]
name = "guard & <i>"
guide = "p354"
pace = "2 Hz"
path = [["0 m", "1 m"], ["12 m", "1 m"]]
"""
MACHINE = """
[[machine]]
name = "pump"
at = ["9 m", "4 m"]
rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }
"""


@functools.cache
def built():
    """The laboratory over a deck, meshed once."""
    return tr.study_from_text(BUILDING)


def plan_of(study):
    (drawing,) = [one for one in floors.drawings(result_of(study)) if one.name == "plan"]
    (axes,) = drawing.draw().axes
    return axes


def words(axes):
    return [text.get_text() for text in axes.texts]


def label_of(axes, text):
    (found,) = [one for one in axes.texts if one.get_text() == text]
    return found


@pytest.mark.parametrize(
    ("end", "turn"),
    [((10.0, 0.0), 0.0), ((0.0, 10.0), 90.0), ((-10.0, 0.0), 0.0), ((0.0, -10.0), 90.0),
     ((-10.0, -10.0), 45.0), ((10.0, -10.0), -45.0)],
)  # fmt: skip
def test_names_of_routes_are_read_from_below_and_from_the_right(end, turn):
    """Along its leg, but never upside down: from -90 degrees, left out, to 90."""
    _, (axes,) = new_figure()
    draw_route(axes, np.array([[0.0, 0.0], end]), "way", 0)
    label = label_of(axes, "way")
    assert (label.get_rotation() - turn) % 360.0 == pytest.approx(0.0)
    np.testing.assert_allclose(label.xy, 0.6 * np.array(end))


def test_a_route_is_named_along_its_longest_leg_and_its_arrow_is_at_its_end():
    """Three legs of 2, 9 and 3 m: the name at six tenths of the second, the arrow into the last."""
    line = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 9.0], [5.0, 9.0]])
    _, (axes,) = new_figure()
    draw_route(axes, line, "way", 7)
    np.testing.assert_allclose(label_of(axes, "way").xy, [2.0, 5.4])
    (arrow,) = [text for text in axes.texts if not text.get_text()]
    assert tuple(arrow.xy) == (5.0, 9.0)
    assert tuple(arrow.get_position()) == (2.0, 9.0)
    assert arrow.arrowprops["arrowstyle"] == "-|>"
    (drawn,) = axes.lines
    np.testing.assert_allclose(np.column_stack(drawn.get_data()), line)
    assert drawn.get_color() == COLOURS[1]  # six colours, round and round


def test_who_walks_and_what_stands_are_drawn_and_named():
    """A dotted way of 12 m at y = 1 m, a square at (9, 4) m, in colours of their own."""
    axes = plan_of(study_of(WALKER + MACHINE))
    assert {"guard & <i>", "pump", "tool", "main, 15 km/h"} <= set(words(axes))
    (way,) = [
        line
        for line in axes.lines
        if line.get_linestyle() == ":"
        and line.get_color() != "white"
        and line.get_color() != "black"
    ]
    places = np.column_stack(way.get_data())
    np.testing.assert_allclose(places[:, 1], 1.0)
    assert (places[:, 0].min(), places[:, 0].max()) == (
        pytest.approx(0.0, abs=0.8),
        pytest.approx(12.0, abs=0.8),
    )
    (spot,) = [
        line for line in axes.lines if line.get_marker() == "s" and line.get_markersize() == 6
    ]
    np.testing.assert_allclose(np.unique(np.column_stack(spot.get_data()), axis=0), [[9.0, 4.0]])
    assert way.get_color() != spot.get_color()


def test_only_sources_that_are_named_are_drawn():
    """A map of one case shows who acts in it; routes and names that are no source are passed over."""
    study = study_of(WALKER + MACHINE)
    _, (axes,) = new_figure()
    draw_sources(axes, study, ["main", "pump"], on=None, labels=True)
    assert words(axes) == ["pump"]
    _, (axes,) = new_figure()
    draw_sources(axes, study, study.sources, on="another floor")
    assert len(axes.lines) == 2 + 1  # a study of one surface: they are on it, whatever it is called
    assert words(axes) == []


def test_sources_of_another_storey_are_not_on_this_plan():
    """A machine in the laboratory is on its plan, and not on the deck's."""
    machine = MACHINE.replace('at = ["9 m", "4 m"]', 'on = "lab"\nat = ["9 m", "4 m"]')
    study = tr.study_from_text(BUILDING + machine)
    deck, lab = (storeys.storey_figure(study, study.building, name) for name in ("deck", "lab"))
    assert "pump" not in words(deck.axes[0])
    assert "pump" in words(lab.axes[0])


def test_every_route_and_point_of_a_plan_is_there():
    """Two routes in two colours with their own speeds, two points at their own places."""
    text = (
        '\n[[route]]\nname = "back"\nvehicle = "truck"\npath = [["12 m", "5 m"], ["0 m", "5 m"]]\n'
    )
    text += 'speed = "7.5 km/h"\n\n[[point]]\nname = "stage <2>"\nat = ["8 m", "4 m"]\n'
    axes = plan_of(study_of(text))
    assert {"main, 15 km/h", "back, 7.5 km/h", "tool", "stage <2>"} <= set(words(axes))
    assert label_of(axes, "main, 15 km/h").get_color() == COLOURS[0]
    assert label_of(axes, "back, 7.5 km/h").get_color() == COLOURS[1]
    ways = {
        line.get_color(): np.column_stack(line.get_data()).tolist()
        for line in axes.lines
        if line.get_linewidth() == 2.0
    }
    assert ways[COLOURS[0]] == [[0.0, 3.0], [12.0, 3.0]]
    assert ways[COLOURS[1]] == [[12.0, 5.0], [0.0, 5.0]]
    arrows = [tuple(text.xy) for text in axes.texts if not text.get_text()]
    assert arrows == [(12.0, 3.0), (0.0, 5.0)]
    assert tuple(label_of(axes, "stage <2>").xy) == (8.0, 4.0)
    assert label_of(axes, "back, 7.5 km/h").get_rotation() % 360.0 == pytest.approx(0.0)


def test_ways_to_hold_an_edge_are_told_apart():
    """Four sides of four kinds: each line where its side is, its look its own, and in the legend."""
    study = study_of()
    kinds = {"x_min": "clamped", "x_max": "symmetry", "y_min": "simple"}
    study = replace(study, plan=small_plan(edges=kinds))
    axes = plan_of(study)
    sides = {
        "clamped": ([0, 0], [0, 6]), "symmetry": ([12, 12], [0, 6]), "simple": ([0, 12], [0, 0]),
        "free": ([0, 12], [6, 6]),
    }  # fmt: skip
    looks = set()
    for kind, (x, y) in sides.items():
        (line,) = [line for line in axes.lines if line.get_label() == f"{kind} edge"]
        assert (list(line.get_xdata()), list(line.get_ydata())) == (x, y)
        looks.add((line.get_linestyle(), line.get_linewidth()))
    assert len(looks) == 4
    (legend,) = axes.get_figure().legends
    assert {text.get_text() for text in legend.get_texts()} == {f"{kind} edge" for kind in sides}


def test_an_edge_of_one_kind_has_one_line_in_the_legend():
    """All four are free: it is said once."""
    axes = plan_of(study_of())
    (legend,) = axes.get_figure().legends
    assert [text.get_text() for text in legend.get_texts()] == ["free edge"]


def test_members_that_a_plan_lacks_are_not_drawn():
    """Without beams across and columns: lines along x alone, no square; secondary beams dashed."""
    plan = small_plan(beams_y=None, column=None)
    axes = plan_of(replace(study_of(), plan=plan))
    segments = [
        np.array(s)
        for c in axes.collections
        if isinstance(c, LineCollection)
        for s in c.get_segments()
    ]
    assert len(segments) == 2
    assert all(s[0, 1] == s[1, 1] for s in segments)
    assert [line for line in axes.lines if line.get_marker() == "s"] == []


def test_a_section_is_to_scale():
    """Slab 0.2 m about z = 0; beams 0.6 m below it, as wide as they are; bays with their length."""
    (axes,) = floors.section_figure(small_plan(beams_x=Rectangle(width=0.3, depth=0.6))).axes
    boxes = set()
    for one in axes.collections:
        if isinstance(one, FillBetweenPolyCollection):
            corners = one.get_paths()[0].vertices
            low, high = corners.min(axis=0), corners.max(axis=0)
            boxes.add(tuple(np.round([low[0], high[0], low[1], high[1]], 6)))
    assert (0.0, 6.0, -0.1, 0.1) in boxes
    assert {(-0.15, 0.15, -0.7, -0.1), (5.85, 6.15, -0.7, -0.1)} <= boxes
    assert {(-0.2, 0.2, -4.0, 4.0), (5.8, 6.2, -4.0, 4.0)} <= boxes
    assert "6 m" in words(axes)


@pytest.mark.parametrize("north", [0.0, 90.0, -30.0])
def test_north_is_where_the_building_says(north):
    """Counterclockwise from y: 0 is up the page, 90 to the left; the letter at the arrow's tip."""
    study = built()
    building = replace(study.building, north=north)
    (axes,) = storeys.storey_figure(study, building, "deck").axes
    letter = label_of(axes, "N")
    along = np.array(letter.get_position()) - np.array(letter.xy)
    angle = np.degrees(np.arctan2(along[1], along[0]))
    assert angle == pytest.approx(90.0 + north)
    assert letter.arrowprops["arrowstyle"] == "<|-"  # its head at the letter
    assert "N" not in words(storeys.storey_figure(study, study.building, "deck").axes[0])


def test_grid_lines_are_named_and_their_distances_told():
    """A, B, C at 0, 8, 16 m and 1, 2 at 0, 6 m: names above and to the right, 8, 8 and 6 between."""
    study = built()
    (axes,) = storeys.storey_figure(study, study.building, "lab").axes
    at = {t.get_text(): t.get_position() for t in axes.texts if t.get_text() in set("ABC12")}
    assert [at[name][0] for name in "ABC"] == [0.0, 8.0, 16.0]
    assert all(at[name][1] > 6.0 for name in "ABC")
    assert [at[name][1] for name in "12"] == [0.0, 6.0]
    assert all(at[name][0] > 16.0 for name in "12")
    spans = [(t.get_text(), t.get_position()) for t in axes.texts if t.get_text() in {"8", "6"}]
    assert [(text, place[0]) for text, place in spans if text == "8"] == [("8", 4.0), ("8", 12.0)]
    assert [(text, place[1]) for text, place in spans if text == "6"] == [("6", 3.0)]


def test_elevations_show_both_sides_of_the_building():
    """Seen along y: 16 m wide, columns from ground to laboratory; seen along x: 6 m wide."""
    study = built()
    for axis, (panel, width) in enumerate(
        zip(storeys.elevation_figure(study.building).axes, (16.0, 6.0), strict=True)
    ):
        assert panel.get_xlabel() == f"{'xy'[axis]} [m]"
        assert panel.get_title() == f"seen along {'yx'[axis]}"
        boxes = [
            (one.get_paths()[0].vertices.min(axis=0), one.get_paths()[0].vertices.max(axis=0), one)
            for one in panel.collections
            if isinstance(one, FillBetweenPolyCollection)
        ]
        slabs = [
            (a, b) for a, b, one in boxes if np.allclose(one.get_facecolor()[0], to_rgba("#555555"))
        ]
        assert [(a[0], b[0]) for a, b in slabs] == [(0.0, width)] * 2
        assert sorted((a[1] + b[1]) / 2.0 for a, b in slabs) == [
            pytest.approx(3.0),
            pytest.approx(6.5),
        ]
        assert all(b[1] - a[1] == pytest.approx(0.25) for a, b in slabs)
        columns = [
            (a, b) for a, b, one in boxes if np.allclose(one.get_facecolor()[0], to_rgba("#B0B0B0"))
        ]
        assert len(columns) == 6
        assert {(a[1], b[1]) for a, b in columns} == {(0.0, 6.5)}
        across = (0.6, 0.4)[axis]  # its depth lies along x
        assert all(b[0] - a[0] == pytest.approx(across) for a, b in columns)


def test_panels_and_ramps_are_drawn_over_their_slabs():
    """What is thicker lies over the slab it belongs to: last drawn, and darker."""
    text = BUILDING.replace(
        '[[building.slab]]\non = "lab"',
        '[[building.slab]]\non = "deck"\nplate = "wall"\npanel = true\n'
        'outline = [["2 m", "1 m"], ["5 m", "1 m"], ["5 m", "4 m"], ["2 m", "4 m"]]\n\n'
        '[[building.slab]]\non = "lab"',
    )
    study = tr.study_from_text(text)
    slabs = storeys._slabs(study.building, "deck")
    assert [slab.panel for slab in slabs] == [False, True]
    patches = [storeys._area(slab) for slab in slabs]
    assert [patch.get_facecolor() for patch in patches] == [to_rgba("#E8E8E8"), to_rgba("#CFCFCF")]
    (axes,) = storeys.storey_figure(study, study.building, "deck").axes
    assert not [patch for patch in axes.patches if isinstance(patch, Polygon) and patch.get_hatch()]
