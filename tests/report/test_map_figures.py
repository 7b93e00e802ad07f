"""Maps in pictures: each place its own value, grey where nothing is assessed, white where no floor is."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made import BANDS, class_map_of, result_of, study_of
from matplotlib import rc_context
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex

import trundle as tr
from studies import BUILDING
from trundle.report.canvas import STYLE, class_colours
from trundle.report.figures import map as figures
from trundle.results.maps import MapKey, StudyMap
from trundle.units import GAL

MAP = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
TWO_ROADS = '\n[[road]]\nclass = "C"\n'
BACK = """
[[route]]
name = "back $1$ <b>"
vehicle = "truck"
path = [["9 m", "0 m"], ["9 m", "6 m"]]
speed = "15 km/h"
"""
CURVES = ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-B", "stepper-B"]')
STOREYS = """
[criteria]
method = "coupled"
curves = ["VC-A", "VC-B"]

[map]
spacing = "2 m"
on = ["lab", "deck"]
criterion = "VC-B"
"""


def mapped(study, margin, **numbers):
    """The study's results with one map for each case and road, whose margins a function gives."""
    n = study.map.n_places
    maps = {}
    for case in study.cases:
        for road in study.roads:
            key = MapKey(case.name, road)
            first = np.asarray(margin(key), float)
            names = [c.name for c in study.map.criteria]
            given = {name: first / 2.0**i for i, name in enumerate(names)}
            empty = ("rms_velocity", "peak_acceleration", "response_factor", "vdv")
            values = {name: np.full(n, np.nan) for name in empty} | {
                name: np.asarray(one(key), float) for name, one in numbers.items()
            }
            maps[key] = StudyMap(
                classes=class_map_of(study.map.grids, given), numbers=values,
                band_levels=np.zeros((n, len(BANDS))),
            )  # fmt: skip
    return replace(result_of(study), maps=maps)


def drawn(result):
    return {drawing.name: drawing for drawing in figures.drawings(result)}


def image_of(panel):
    """The values of a panel: its mesh that is not the one of grey."""
    images = [c for c in panel.collections if isinstance(c, QuadMesh)]
    return images[0]


def values_of(image):
    return np.ma.filled(np.ma.masked_invalid(image.get_array()), np.nan)


@pytest.fixture(scope="module")
def plan():
    """Eight places of a floor of 12 by 6 m, two routes and two roads; the second place is unknown."""
    study = study_of(TWO_ROADS + BACK + MAP, CURVES)

    def margin(key):
        m = np.array([0.4, np.nan, 1.5, 2.5, 40.0, 0.01, 3.0, 5.0])
        return m * (1.0 if key.road == "B" else 0.5) * (1.0 if key.case == "main" else 3.0)

    def level(key):
        return np.arange(1.0, 9.0) * 1e-6 * (1.0 if key.road == "B" else 10.0)

    return mapped(study, margin, rms_velocity=level)


def test_every_case_and_road_has_a_panel_and_the_worst_is_last(plan):
    """Two cases on two roads, and the smallest margin of all: where one is unknown, of the others."""
    figure = drawn(plan)["map_margin"].draw()
    panels = [axes for axes in figure.axes if axes.get_title() and axes.get_visible()]
    assert [panel.get_title() for panel in panels] == [
        "main, class B", "main, class C", "back $1$ <b>, class B", "back $1$ <b>, class C",
        "worst of all single routes",
    ]  # fmt: skip
    first = np.array([0.4, np.nan, 1.5, 2.5, 10.0, 0.1, 3.0, 5.0])
    np.testing.assert_allclose(values_of(image_of(panels[0])).ravel(), first)
    worst = np.array([0.2, np.nan, 0.75, 1.25, 10.0, 0.1, 1.5, 2.5])
    np.testing.assert_allclose(values_of(image_of(panels[-1])).ravel(), worst)


def test_places_are_drawn_where_they_are(plan):
    """Rows of y, x running along them: the fourth value lies at x = 10.5 m, y = 1.5 m."""
    image = image_of(drawn(plan)["map_margin"].draw().axes[0])
    corners = image.get_coordinates()
    assert corners.shape == (3, 5, 2)
    np.testing.assert_allclose(corners[0, :, 0], [0.0, 3.0, 6.0, 9.0, 12.0])
    np.testing.assert_allclose(corners[:, 0, 1], [0.0, 3.0, 6.0])
    assert values_of(image).reshape(2, 4)[0, 3] == pytest.approx(2.5)


def test_margins_keep_their_colours_beyond_the_scale(plan):
    """Clipped to 0.1 and 10, the ends of the bar, whose middle is 1; the unknown has no colour."""
    figure = drawn(plan)["map_margin"].draw()
    image = image_of(figure.axes[0])
    assert image.norm(1.0) == pytest.approx(0.5)
    shown = values_of(image).ravel()
    assert (np.nanmin(shown), np.nanmax(shown)) == (0.1, 10.0)
    assert to_hex(figure.axes[0].get_facecolor()).upper() == "#D9D9D9"
    assert "below 1 fails" in figure.axes[-1].get_xlabel()
    assert "VC-A" in figure.axes[-1].get_xlabel()


def test_ranks_of_a_class_map_are_those_of_its_margins(plan):
    """By hand: VC-B is met from a margin of 2 to VC-A on, VC-A from 1, none below; 0 is unknown."""
    figure = drawn(plan)["map_classes"].draw()
    panel = figure.axes[0]
    np.testing.assert_array_equal(
        values_of(image_of(panel)).ravel(), [1, 0, 2, 3, 3, 1, 3, 3]
    )  # none, not assessed, VC-A, VC-B
    assert len(class_colours([50e-6, 25e-6])) == image_of(panel).cmap.N
    (legend,) = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words == ["VC-B", "VC-A", "none", "not assessed"]
    faces = [to_hex(handle.get_facecolor()) for handle in legend.legend_handles]
    assert faces == list(reversed(class_colours([50e-6, 25e-6])))
    assert faces[-1] == "#d9d9d9"  # as the ground of a panel: nothing is assessed there
    assert legend.get_title().get_text() == "strictest criterion met, vertical"


def test_an_incomplete_map_passes_nothing():
    """Margins above 1 in the bands that are known, others missing: no class, grey and so named."""
    study = study_of(MAP, CURVES)
    result = mapped(study, lambda key: np.full(8, 50.0))
    (key,) = result.maps
    one = result.maps[key]
    classes = replace(one.classes, complete=(False,) * len(one.classes.criteria))
    result = replace(result, maps={key: replace(one, classes=classes)})
    figure = drawn(result)["map_classes"].draw()
    np.testing.assert_array_equal(values_of(image_of(figure.axes[0])).ravel(), np.zeros(8))
    assert [t.get_text() for t in figure.legends[0].get_texts()] == ["not assessed"]


def test_the_line_of_one_is_drawn_only_between_both_sides(plan):
    """Where all pass, or all fail, there is nothing to divide."""
    study = study_of(MAP, CURVES)
    sides = (
        (np.array([0.5, 0.5, 2.0, 2.0] * 2), True),
        (np.full(8, 2.0), False),
        (np.full(8, 0.5), False),
    )
    for margin, there in sides:
        figure = drawn(mapped(study, lambda key, m=margin: m))["map_margin"].draw()
        panel = figure.axes[0]
        lines = [c for c in panel.collections if not isinstance(c, QuadMesh)]
        assert bool(lines) == there
        if there:  # on a logarithm-free grid: halfway in margin from 0.5 to 2, 4.5 m to 7.5 m
            places = np.concatenate([path.vertices for path in lines[0].get_paths()])
            np.testing.assert_allclose(places[:, 0], 4.5 + 3.0 * (1.0 - 0.5) / 1.5)


def test_levels_of_all_views_are_on_one_scale(plan):
    """1 to 8 um/s on B and ten times that on C: all panels from 1 to 80 um/s."""
    figure = drawn(plan)["map_rms"].draw()
    panels = [axes for axes in figure.axes if axes.get_title() and axes.get_visible()]
    for panel in panels:
        image = image_of(panel)
        assert (image.norm.vmin, image.norm.vmax) == (pytest.approx(1.0), pytest.approx(80.0))
    np.testing.assert_allclose(values_of(image_of(panels[1])).ravel(), 10.0 * np.arange(1, 9))
    np.testing.assert_allclose(values_of(image_of(panels[-1])).ravel(), 10.0 * np.arange(1, 9))


def test_the_caption_says_where_the_largest_is_and_under_what(plan):
    """80 um/s at the last of the places, x = 10.5 m and y = 4.5 m, on class C."""
    caption = drawn(plan)["map_rms"].caption
    assert caption.startswith("Largest: 80 um/s at (10.5, 4.5) m, main, class C.")
    assert "8 places" in caption
    assert "95 % of 2 runs" in caption


def test_peaks_are_mapped_in_gal_and_only_where_asked_for(plan):
    """A limit on peaks asks for them; what people feel nobody asked for, and it is not drawn."""
    study = plan.study
    peak = np.linspace(1.0, 2.4, 8)
    result = mapped(study, lambda key: np.ones(8), peak_acceleration=lambda key: GAL * peak)
    pictures = drawn(result)
    assert {"map_peak", "map_rms"} <= set(pictures)
    assert {"map_vdv", "map_response_factor"}.isdisjoint(pictures)
    figure = pictures["map_peak"].draw()
    np.testing.assert_allclose(values_of(image_of(figure.axes[0])).ravel(), peak)
    assert figure.axes[-1].get_xlabel() == "peak acceleration [gal]"


def test_one_level_everywhere_has_a_scale_round_it():
    """No range to spread colours over: a tenth to both sides, and every cell drawn."""
    study = study_of(MAP, CURVES)
    result = mapped(study, lambda key: np.ones(8), rms_velocity=lambda key: np.full(8, 5e-6))
    image = image_of(drawn(result)["map_rms"].draw().axes[0])
    assert (image.norm.vmin, image.norm.vmax) == (pytest.approx(4.5), pytest.approx(5.5))
    assert np.isfinite(values_of(image)).all()


def test_levels_that_nobody_knows_are_not_drawn_as_numbers():
    """Not-a-number everywhere: no cell has a colour, and the caption names no largest."""
    study = study_of(MAP, CURVES)
    one = drawn(mapped(study, lambda key: np.ones(8)))["map_rms"]
    assert np.isnan(values_of(image_of(one.draw().axes[0]))).all()
    assert "Largest" not in one.caption


def test_a_panel_shows_who_drives_there_and_every_point(plan):
    """The own route of the case dashed, both in the worst; the point as a cross in each panel."""
    figure = drawn(plan)["map_margin"].draw()
    panels = [axes for axes in figure.axes if axes.get_title() and axes.get_visible()]
    ways = {"main": [[0.0, 3.0], [12.0, 3.0]], "back": [[9.0, 0.0], [9.0, 6.0]]}
    seen = {0: ["main"], 2: ["back"], 4: ["main", "back"]}
    for number, names in seen.items():
        panel = panels[number]
        dashed = [line for line in panel.lines if line.get_linestyle() == "--"]
        found = [np.column_stack(line.get_data())[[0, -1]].tolist() for line in dashed]
        assert found == [ways[name] for name in names]
        crosses = [line for line in panel.lines if line.get_marker() == "X"]
        assert [(line.get_xdata()[0], line.get_ydata()[0]) for line in crosses] == [(3.0, 3.0)]
        assert (panel.get_xlim(), panel.get_ylim()) == ((0.0, 12.0), (0.0, 6.0))


def test_only_outer_panels_are_labelled():
    """Five panels in rows of four: y at the left, x at each column's lowest."""
    figure, panels = figures.draw_panels(study_of(MAP), [f"m{i}" for i in range(5)])
    assert len(panels) == 5
    assert [bool(panel.get_ylabel()) for panel in panels] == [True, False, False, False, True]
    assert [panel.get_xlabel() for panel in panels] == ["", "x [m]", "x [m]", "x [m]", "x [m]"]
    assert [axes.get_visible() for axes in figure.axes] == [True] * 5 + [False] * 3


@pytest.fixture(scope="module")
def storeys():
    """A laboratory over a deck with an opening: 24 places and 23, margins counted up through both."""
    study = tr.study_from_text(BUILDING + STOREYS)
    return mapped(study, lambda key: 1.0 + np.arange(47.0))


def test_each_storey_has_its_own_places_and_white_where_no_floor_is(storeys):
    """The deck's 23 places begin where the lab's end; its opening has no value and is no grey."""
    result = storeys
    figure = drawn(result)["map_margin"].draw()
    panels = [axes for axes in figure.axes if axes.get_title()]
    assert [panel.get_title() for panel in panels] == [
        "aisle, class B, lab",
        "aisle, class B, deck",
    ]
    lab, deck = panels
    np.testing.assert_allclose(
        values_of(image_of(lab)).ravel(), np.clip(0.5 * (1.0 + np.arange(24.0)), 0.1, 10.0)
    )
    shown = values_of(image_of(deck)).reshape(3, 8)
    assert np.isnan(shown[1, 5])  # 10 to 12 m, 2 to 4 m
    assert np.isnan(shown).sum() == 1
    assert shown[0, 0] == pytest.approx(10.0)
    assert to_hex(deck.get_facecolor()) == "#ffffff"
    assert to_hex(lab.get_facecolor()).upper() == "#D9D9D9"
    grey = [c for c in deck.collections if isinstance(c, QuadMesh)][1]
    under = values_of(grey).reshape(3, 8)
    np.testing.assert_array_equal(np.isnan(under), np.isnan(shown))


def test_routes_and_points_are_on_the_map_of_their_storey(storeys):
    """The aisle crosses the deck, the tool stands in the laboratory; neither on the other's map."""
    result = storeys
    panels = [axes for axes in drawn(result)["map_margin"].draw().axes if axes.get_title()]
    found = [
        (
            sum(line.get_linestyle() == "--" for line in panel.lines),
            sum(line.get_marker() == "X" for line in panel.lines),
        )
        for panel in panels
    ]
    assert found == [(0, 1), (1, 0)]


def test_outlines_of_a_storey_have_its_openings(storeys):
    """The deck is drawn round its slab and its opening, 44 m and 8 m; the lab has no opening."""
    result = storeys
    panels = [axes for axes in drawn(result)["map_margin"].draw().axes if axes.get_title()]
    lengths = []
    for panel in panels:
        rings = [line for line in panel.lines if line.get_color() == "#555555"]
        around = [np.column_stack(line.get_data()) for line in rings]
        lengths.append(
            sorted(float(np.linalg.norm(np.diff(r, axis=0), axis=1).sum()) for r in around)
        )
        assert all((ring[0] == ring[-1]).all() for ring in around)
    assert lengths == [[pytest.approx(44.0)], [pytest.approx(8.0), pytest.approx(44.0)]]


def test_long_names_of_classes_are_in_the_picture():
    """Four of AISC DG11's curves in a row would run over both edges."""
    curves = 'curves = ["VC-A", "DG11-200", "DG11-100", "DG11-50", "DG11-25"]'
    study = study_of(MAP, ('curves = ["VC-A"]', curves))
    result = mapped(study, lambda key: np.array([0.4, 1.2, 2.2, 4.5, 8.9, 17.0, np.nan, 3.0]))
    with rc_context(STYLE):
        figure = drawn(result)["map_classes"].draw()
        figure.canvas.draw()
        box = figure.legends[0].get_window_extent()
    assert box.x0 >= 0.0
    assert box.x1 <= figure.bbox.width
