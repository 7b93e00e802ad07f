"""Class maps as plans: classes reach as far as their margins say, and the worst place is named."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made import class_map_of, result_of, study_of
from matplotlib import rc_context
from matplotlib.colors import to_rgb

from trundle.report.canvas import STYLE, class_colours, new_figure
from trundle.report.figures import class_plan
from trundle.report.figures.class_plan import fill_classes
from trundle.report.figures.passing import draw_passing, passing_handles
from trundle.results.cells import CellKey
from trundle.results.maps import MapKey, StudyMap
from trundle.views.map import map_payload, map_views
from trundle.views.plan_lines import dimensions, plan_lines

MAP = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
CURVES = ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-B"]')
COLOURS = class_colours([50e-6, 25e-6])


def view_of(margin):
    """The one map of a floor of 12 by 6 m, eight places 3 m apart, the first at (1.5, 1.5) m."""
    study = study_of(MAP, CURVES)
    names = ("rms_velocity", "peak_acceleration", "response_factor", "vdv")
    one = StudyMap(
        classes=class_map_of(study.map.grids, {"VC-A": margin, "VC-B": 0.5 * margin}),
        numbers={name: np.full(study.map.n_places, np.nan) for name in names},
        band_levels=np.zeros((study.map.n_places, 20)),
    )
    result = replace(result_of(study), maps={MapKey("main", "B"): one})
    (view,) = map_views(result)
    return result, view


def colour_at(figure, axes, x, y):
    """The colour that is drawn at a place [m]."""
    figure.canvas.draw()
    column, row = axes.transData.transform((x, y))
    pixels = np.asarray(figure.canvas.buffer_rgba())[..., :3] / 255.0
    return pixels[int(pixels.shape[0] - row), int(column)]


def test_a_class_ends_where_its_margin_is_one_on_a_logarithmic_scale():
    """From 4 at x = 1.5 m to 1/4 at 4.5 m: VC-A ends halfway, at 3 m; VC-B, half of it, at 2.25 m."""
    margin = np.tile([4.0, 0.25, 0.25, 0.25], 2)
    _, view = view_of(margin)
    with rc_context(STYLE):
        figure, (axes,) = new_figure(6.0, 4.0)
        fill_classes(axes, view)
        axes.set(xlim=(0.0, 12.0), ylim=(0.0, 6.0))
        seen = [colour_at(figure, axes, x, 3.0) for x in (0.5, 2.15, 2.35, 2.9, 3.1, 8.0)]
    expected = [COLOURS[i] for i in (3, 3, 2, 2, 1, 1)]
    np.testing.assert_allclose(seen, [to_rgb(c) for c in expected], atol=0.02)


def test_where_nothing_is_known_the_ground_stays_grey():
    margin = np.full(8, 4.0)
    margin[0] = np.nan
    _, view = view_of(margin)
    with rc_context(STYLE):
        figure, (axes,) = new_figure(6.0, 4.0)
        fill_classes(axes, view)
        axes.set(xlim=(0.0, 12.0), ylim=(0.0, 6.0))
        unknown, known = colour_at(figure, axes, 0.7, 0.7), colour_at(figure, axes, 8.0, 3.0)
    np.testing.assert_allclose(unknown, to_rgb(COLOURS[0]), atol=0.02)
    np.testing.assert_allclose(known, to_rgb(COLOURS[3]), atol=0.02)


def test_what_is_not_complete_is_not_filled():
    """Margins of 4 and 2, bands of VC-B missing: VC-A is what is known; without either nothing is."""
    _, view = view_of(np.full(8, 4.0))
    seen = []
    for complete in ((True, False), (False, False)):
        some = replace(view, classes=replace(view.classes, complete=complete))
        with rc_context(STYLE):
            figure, (axes,) = new_figure(6.0, 4.0)
            fill_classes(axes, some)
            axes.set(xlim=(0.0, 12.0), ylim=(0.0, 6.0))
            seen.append(colour_at(figure, axes, 8.0, 3.0))
    np.testing.assert_allclose(seen, [to_rgb(COLOURS[i]) for i in (2, 0)], atol=0.02)


def test_the_plan_has_grid_dimensions_points_routes_and_the_worst_place():
    """Column lines at 0, 6, 12 m by 0, 6 m: 1 to 3 by A and B, 6 m apart; the least margin is told."""
    margin = np.full(8, 2.0)
    margin[5] = 0.25  # second of four in the second row
    result, _ = view_of(margin)
    (drawing,) = class_plan.drawings(result)
    with rc_context(STYLE):
        (axes,) = drawing.draw().axes
    words = [text.get_text() for text in axes.texts]
    assert {"1", "2", "3", "A", "B"} <= set(words)
    assert words.count("6 m") == 3
    assert "tool" in words
    assert "main" in words
    assert "worst: (4.5, 4.5) m, 0.25 of VC-A" in words
    assert "95 % of" in drawing.caption


@pytest.mark.parametrize("named", ["points", "routes", "map"])
def test_the_only_surface_need_not_be_named_and_may_be(named):
    """A point, a route or a map that names it lies on it as one that does not."""
    result, _ = view_of(np.full(8, 2.0))
    study, (on,) = result.study, result.study.floor.surfaces
    if named == "points":
        points = {name: replace(spot, on=on) for name, spot in study.points.items()}
        study = replace(study, points=points)
    elif named == "routes":
        drives = {
            name: replace(drive, route=replace(drive.route, on=on))
            for name, drive in study.drives.items()
        }
        study = replace(study, drives=drives)
    else:
        (grid,) = study.map.grids
        there = replace(grid, spots=replace(grid.spots, on=on))
        study = replace(study, map=replace(study.map, grids=(there,)))
    result = replace(result, study=study)
    (drawing,) = class_plan.drawings(result)
    with rc_context(STYLE):
        (axes,) = drawing.draw().axes
    assert {"tool", "main"} <= {text.get_text() for text in axes.texts}
    told = map_payload(result)
    assert [view["points"] for view in told["views"]] == [["tool"]]
    assert [view["routes"] for view in told["views"]] == [["main"]]


def test_dimensions_are_between_neighbours():
    lines = plan_lines(study_of(), None)
    assert dimensions(lines) == [(0, 3.0, 6.0), (0, 9.0, 6.0), (1, 3.0, 6.0)]
    (ring,) = lines.rings
    np.testing.assert_array_equal(ring.min(axis=0), [0.0, 0.0])
    np.testing.assert_array_equal(ring.max(axis=0), [12.0, 6.0])
    assert len(lines.columns) == 6


def test_a_bar_lasts_as_long_as_a_vehicle_is_on_the_floor():
    """A truck of 12.19 m at 15 km/h over 12 m: from 0 to (12 + its length) / V; nearest at x = 3 m.

    The point stands at x = 3 m: 3 / (15 / 3.6) = 0.72 s after the front axle has come.
    """
    study = study_of()
    result = result_of(study)
    drive = study.drives["main"]
    with rc_context(STYLE):
        _, (axes,) = new_figure()
        draw_passing(axes, result, CellKey("main", "B", "coupled"), "tool", 12.0)
    bar, mark = axes.lines
    on = bar.get_xdata()[np.isfinite(bar.get_ydata())]
    speed, step = drive.route.law.fastest, 12.0 / 119
    leaves = (drive.route.length + drive.vehicle.length) / speed
    assert on[0] <= 2 * step
    assert on[-1] == pytest.approx(leaves, abs=2 * step)
    assert mark.get_xdata()[0] == pytest.approx(3.0 / speed, abs=2 * step)
    _, words = passing_handles(result, CellKey("main", "B", "coupled"))
    assert words == ["main on the floor, front axle nearest"]
