"""What pictures of floor, mesh, modes and maps show, against the numbers that they are drawn from."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import LineCollection, QuadMesh
from mpl_toolkits.mplot3d.art3d import Line3DCollection

import trundle as tr
from models import small_floor, small_plan
from studies import GOOD, MAP
from trundle.report.figures import floor as floor_figures
from trundle.report.figures import map as map_figures
from trundle.report.figures import model as model_figures
from trundle.response.quantities import mapped
from trundle.structure import Floor, TriangleGroup
from trundle.units import GAL, MICROMETRE_PER_SECOND
from trundle.views.map import class_names, class_ranks, map_views


@pytest.fixture(scope="module")
def result():
    """The small study with a map of 8 places, one of them where nothing moves."""
    text = GOOD.replace('"30 Hz"', '"90 Hz"').replace('duration = "4 s"', 'duration = "14 s"')
    return tr.run_study(tr.study_from_text(text + MAP + "peaks = true\n"))


def drawn(module, result):
    return {drawing.name: drawing for drawing in module.drawings(result)}


def test_a_plan_shows_beams_columns_routes_and_points_where_they_are(result):
    """Beams on the y lines over the whole extent, a square on every crossing, arrow and label."""
    (axes,) = drawn(floor_figures, result)["plan"].draw().axes
    lines = [c for c in axes.collections if isinstance(c, LineCollection)]
    beams = np.concatenate([np.array(c.get_segments()) for c in lines if len(c.get_segments())])
    level = {float(s[0, 1]) for s in beams if s[0, 1] == s[1, 1]}
    assert level == {0.0, 6.0}
    squares = [line for line in axes.lines if line.get_marker() == "s"]
    places = np.column_stack(squares[0].get_data())
    assert {tuple(p) for p in places} == {(x, y) for x in (0.0, 6.0, 12.0) for y in (0.0, 6.0)}
    texts = [t.get_text() for t in axes.texts]
    assert "main, 15 km/h" in texts
    assert "tool" in texts
    cross = next(line for line in axes.lines if line.get_marker() == "X")
    assert (float(cross.get_xdata()[0]), float(cross.get_ydata()[0])) == (3.0, 3.0)
    assert axes.get_xlabel() == "x [m]"
    assert axes.get_aspect() == 1.0


def test_a_model_without_a_plan_is_drawn_by_its_outline(result):
    """The edges that one element alone has: together the perimeter, here 36 m."""
    bare = replace(result, study=replace(result.study, plan=None))
    assert {"section", "plan"}.isdisjoint(drawn(floor_figures, bare))
    (axes,) = drawn(model_figures, bare)["plan"].draw().axes
    ends = next(
        c
        for c in axes.collections
        if isinstance(c, LineCollection) and np.allclose(c.get_color(), [0, 0, 0, 1])
    )
    length = sum(float(np.linalg.norm(np.diff(one, axis=0))) for one in ends.get_segments())
    assert length == pytest.approx(36.0, rel=1e-9)


def segments(figure):
    """Segments of each collection of a picture in perspective."""
    (axes,) = figure.axes
    return [c._segments3d for c in axes.collections if isinstance(c, Line3DCollection)]


def test_a_mesh_shows_every_edge_once():
    """Euler: a grid of n by m quadrilaterals has n (m + 1) + m (n + 1) edges."""
    floor = small_floor(mesh_size=1.5, column=None, beams_x=None, beams_y=None)
    (edges,) = segments(floor_figures.mesh_figure(floor))
    assert len(edges) == 8 * 5 + 4 * 9
    triangles = TriangleGroup(
        connectivity=np.array([[0, 1, 9], [1, 10, 9]]), section=floor.shells[0].section
    )
    both = Floor(nodes=floor.nodes, fixed=floor.fixed, others=(triangles,))
    (few,) = segments(floor_figures.mesh_figure(both))
    assert len(few) == 5


def test_beams_are_drawn_where_their_centroids_are():
    """Beams hang half of both depths below the slab; columns run from head to foot."""
    floor = small_floor(mesh_size=3.0)
    _, *members = segments(floor_figures.mesh_figure(floor))
    heights = {round(float(z), 9) for part in members for z in np.array(part)[:, :, 2].ravel()}
    assert -0.4 in heights  # 0.2 m of slab and 0.6 m of beam
    assert {4.0, -4.0} <= heights
    (axes,) = floor_figures.mesh_figure(floor).axes
    assert f"{floor.n_dofs} degrees of freedom" in axes.texts[0].get_text()


def test_modes_are_drawn_to_the_same_height(result):
    """Each panel is a mode's deflection over its largest, its frequency above it."""
    figure = drawn(floor_figures, result)["modes"].draw()
    panels = [axes for axes in figure.axes if axes.get_title()]
    assert len(panels) == 8
    for i, panel in enumerate(panels):
        shown = panel.collections[0].get_array()
        assert np.abs(shown).max() == pytest.approx(1.0, rel=1e-12)
        assert panel.get_title() == f"{i + 1}: {result.modes.frequencies[i]:.2f} Hz"


def test_a_section_shows_storeys_and_bays():
    """Columns from the floor below to that above, a mark for each bay."""
    (axes,) = floor_figures.section_figure(small_plan()).axes
    tops = [c.get_datalim(axes.transData).y1 for c in axes.collections]
    assert max(tops) == pytest.approx(4.0)
    assert axes.get_ylabel() == "z [m]"


def image_of(axes):
    (image,) = [c for c in axes.collections if isinstance(c, QuadMesh)]
    return image


def test_levels_on_a_map_are_those_of_its_numbers(result):
    """In the units of people, on one logarithmic scale over all views, its label with the unit."""
    views = [view for view in map_views(result) if view.printed]
    names = drawn(map_figures, result)
    scales = {"map_rms": MICROMETRE_PER_SECOND, "map_peak": GAL}
    labels = {"map_rms": "record RMS velocity [um/s]", "map_peak": "peak acceleration [gal]"}
    moved = [(quantity, how) for quantity, how in mapped() if how.of != "felt"]
    assert {how.figure for _, how in moved} == set(scales)
    for quantity, how in moved:
        figure = names[how.figure].draw()
        panel, bar = figure.axes[0], figure.axes[-1]
        image = image_of(panel)
        expected = views[0].numbers[quantity.name] / scales[how.figure]
        np.testing.assert_allclose(np.ma.filled(image.get_array().ravel(), np.nan), expected)
        assert image.norm.vmin == pytest.approx(expected.min())
        assert image.norm.vmax == pytest.approx(expected.max())
        assert bar.get_xlabel() == labels[how.figure]


def test_where_nothing_moves_a_map_is_empty(result):
    """A place without motion has no logarithm: it is left out, and the scale is the others'."""
    views = [view for view in map_views(result) if view.printed]
    quantity = next(q for q, how in mapped() if how.figure == "map_rms")
    still = views[0].numbers["rms_velocity"].copy()
    still[2] = 0.0
    some = [replace(views[0], numbers={**views[0].numbers, "rms_velocity": still})]
    figure = map_figures.level_map_figure(result.study, some, quantity)
    array = image_of(figure.axes[0]).get_array().ravel()
    assert np.ma.getmaskarray(np.ma.masked_invalid(array)).sum() == 1
    assert image_of(figure.axes[0]).norm.vmin > 0.0


def test_a_class_map_names_what_it_shows_and_nothing_else(result):
    """The legend has the ranks that occur, in the words of the classes."""
    views = [view for view in map_views(result) if view.printed]
    figure = drawn(map_figures, result)["map_classes"].draw()
    ranks = class_ranks(views[0].classes)
    shown = image_of(figure.axes[0]).get_array().ravel()
    np.testing.assert_array_equal(shown, ranks)
    (legend,) = figure.legends
    words = {text.get_text() for text in legend.get_texts()}
    names = class_names(views[0].classes)
    assert words == {names[int(rank)] for rank in ranks}


def test_a_share_map_is_in_percent_of_the_runs(result):
    views = [view for view in map_views(result) if view.printed]
    figure = drawn(map_figures, result)["map_share"].draw()
    classes = views[0].classes
    expected = 100.0 * classes.share_exceeding[classes.index("VC-A")]
    image = image_of(figure.axes[0])
    np.testing.assert_allclose(image.get_array().ravel(), expected)
    assert (image.norm.vmin, image.norm.vmax) == (0.0, 100.0)
    assert figure.axes[-1].get_xlabel() == "runs above VC-A [%]"


def test_a_margin_map_has_its_line_at_one(result):
    """Margins between 0.1 and 10, the colour's middle at 1."""
    figure = drawn(map_figures, result)["map_margin"].draw()
    image = image_of(figure.axes[0])
    assert (image.norm.vmin, image.norm.vmax) == (0.1, 10.0)
    shown = image.get_array().ravel()
    view = map_views(result)[0]
    margin = view.classes.margin[view.classes.index("VC-A")]
    np.testing.assert_allclose(shown, np.clip(margin, 0.1, 10.0))
    assert "VC-A" in figure.axes[-1].get_xlabel()


def test_a_floor_without_columns_does_not_speak_of_them(result):
    """A plan that stands on its edges alone: neither its section nor the captions."""
    edges = dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "simple")
    plan = small_plan(column=None, edges=edges)
    (axes,) = floor_figures.section_figure(plan).axes
    assert "columns" not in axes.get_title()
    study = replace(result.study, plan=plan)
    found = {d.name: d for d in floor_figures.drawings(replace(result, study=study))}
    assert "columns" not in found["plan"].caption + found["section"].caption
    found = {d.name: d for d in floor_figures.drawings(result)}
    assert "columns (squares)" in found["plan"].caption
