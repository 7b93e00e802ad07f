"""Histories, spectra, peaks and roads in pictures: the numbers, units and names that they show."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hand_made import result_of, study_of
from jinja2 import UndefinedError
from matplotlib import rc_context

import trundle as tr
from studies import BUILDING, GOOD
from trundle.criteria import find_criterion
from trundle.report.canvas import STYLE, Drawing, class_colours, make_logarithmic, new_figure
from trundle.report.figures import response, road
from trundle.report.html import embedded, template
from trundle.road import CLASS_NAMES, RoadClass
from trundle.study.plans import Case
from trundle.units import GAL, MICROMETRE_PER_SECOND

TWO = """
[[road]]
class = "C"

[[point]]
name = "stage <2>"
at = ["8 m", "4 m"]
"""


@pytest.fixture(scope="module")
def result():
    """Two roads and two points, a velocity curve and a peak limit."""
    text = GOOD.replace('["VC-A"]', '["VC-A", "stepper-B"]') + TWO
    return tr.run_study(tr.study_from_text(text))


@pytest.fixture(scope="module")
def drawn(result):
    return {drawing.name: drawing for drawing in response.drawings(result)}


def test_every_point_and_road_has_its_pictures(drawn):
    """A history a point, peaks a point, spectra a point and road; numbers behind the first."""
    assert set(drawn) == {
        "history_1", "history_1_2", "criteria_acceleration", "criteria_acceleration_2",
        "criteria_velocity_1", "criteria_velocity_2", "criteria_velocity_1_2",
        "criteria_velocity_2_2",
    }  # fmt: skip
    assert drawn["criteria_velocity_2_2"].title.endswith("at stage <2> against criteria, class C")


def test_a_history_is_the_first_run_in_gal(drawn, result):
    """A panel for each road, its peak above it."""
    figure = drawn["history_1_2"].draw()
    for panel, label in zip(figure.axes, ("B", "C"), strict=True):
        (cell,) = [c for key, c in result.cells.items() if key.road == label]
        expected = cell.history.acceleration[:, 1] / GAL
        np.testing.assert_allclose(panel.lines[0].get_ydata(), expected)
        assert f"class {label}: peak {np.abs(expected).max():.3g} gal" in panel.get_title(
            loc="left"
        )
        assert panel.get_xlabel() == "time [s]"
    assert figure.axes[0].get_ylabel() == "a [gal]"


def test_spectra_are_the_median_of_the_runs_beside_the_curve(drawn, result):
    """In um/s on both axes logarithmic; the criterion's own limits, its name at its end."""
    (axes,) = drawn["criteria_velocity_2"].draw().axes
    (cell,) = [c for key, c in result.cells.items() if key.road == "C"]
    marked = next(line for line in axes.lines if line.get_marker() == "o")
    expected = cell.spectra.percentile(50.0)[0] / MICROMETRE_PER_SECOND
    np.testing.assert_allclose(marked.get_ydata(), expected)
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    curve = find_criterion("VC-A")
    black = next(line for line in axes.lines if line.get_color() == "black")
    np.testing.assert_allclose(black.get_ydata(), curve.limits / MICROMETRE_PER_SECOND)
    assert curve.title in [t.get_text() for t in axes.texts]
    assert "um/s" in axes.get_ylabel()


def test_peaks_stand_beside_their_limit(drawn, result):
    """A bar a road from 5 to 95 %, the limit of the stepper as a line with its number."""
    (axes,) = drawn["criteria_acceleration"].draw().axes
    assert [t.get_text() for t in axes.get_xticklabels()] == ["main, B", "main, C"]
    for x, label in enumerate("BC"):
        (cell,) = [c for key, c in result.cells.items() if key.road == label]
        peaks = cell.peak_acceleration[:, 0] / GAL
        bars = [line for line in axes.lines if list(line.get_xdata()) == [x, x]]
        np.testing.assert_allclose(bars[0].get_ydata(), np.percentile(peaks, [5.0, 95.0]))
    limit = find_criterion("stepper-B").limits[0] / GAL
    assert any(re.search(rf", {limit:g} gal$", t.get_text()) for t in axes.texts)


def test_roughness_is_drawn_as_the_standard_gives_it(result):
    """Eight classes over three decades of n: ``Gd(n0) (n / n0)^-2``."""
    figure = next(iter(road.drawings(result))).draw()
    (axes,) = figure.axes
    lines = [line for line in axes.lines if len(line.get_xdata()) == 2]
    assert len(lines) == len(CLASS_NAMES)
    for line, name in zip(lines, CLASS_NAMES, strict=True):
        n, psd = line.get_data()
        np.testing.assert_allclose(psd, RoadClass(name).roughness * (n / 0.1) ** -2.0)
    assert [t.get_text() for t in axes.texts][:8] == list(CLASS_NAMES)


def test_profiles_grow_with_their_class(result):
    """Each class is twice as high as the one before: the same phases, four times the power.

    The variance of the lowest is its PSD's integral, ``G n0^2 (1 / n1 - 1 / n2)``, in cm2; a hundred
    metres hold few of the longest waves, hence the fifth.
    """
    drawings = {drawing.name: drawing for drawing in road.drawings(result)}
    (axes,) = drawings["profiles"].draw().axes
    heights = [np.std(line.get_ydata()) for line in axes.lines]
    np.testing.assert_allclose(np.array(heights[:-1]) / heights[1:], 2.0, rtol=1e-9)
    band, roughness = result.study.band, RoadClass("A", level="upper").roughness
    variance = roughness * 0.1**2 * (1.0 / band.n_min - 1.0 / band.n_max)
    assert heights[-1] == pytest.approx(100.0 * np.sqrt(variance), rel=0.2)
    assert axes.get_ylabel() == "elevation [cm]"
    assert [t.get_text() for t in axes.get_legend().get_texts()] == [f"class {c}" for c in "DCBA"]


def test_pages_escape_what_they_are_given(result):
    """A point's name with a tag in it is text, wherever it stands."""
    page = template("mitigation.html.j2")
    assert page.environment.autoescape is True
    shown = page.environment.from_string("<p>{{ name }}</p>").render(name="<script>x</script>")
    assert shown == "<p>&lt;script&gt;x&lt;/script&gt;</p>"
    with pytest.raises(UndefinedError):
        page.environment.from_string("{{ nothing }}").render()


def test_numbers_on_a_page_have_three_digits():
    page = template("report.html.j2").environment
    rendered = page.from_string("{{ a|sig }} {{ b|sig }} {{ c|sig }}").render(
        a=1234.5, b=0.012345, c=7.0
    )
    assert rendered == "1230 0.0123 7"


def test_pictures_are_told_and_kept(tmp_path):
    """PNG and SVG of each, the picture's data in the page, shares rising."""
    told = []
    one = Drawing(name="a", title="A", caption="c", draw=lambda: new_figure()[0])
    two = Drawing(name="b", title="B", caption="c", draw=lambda: new_figure()[0])
    pictures = embedded([one, two], tmp_path / "figures", tell=lambda *args: told.append(args))
    assert [p["name"] for p in pictures] == ["a", "b"]
    assert told == [("figure: A", 0.0), ("figure: B", 0.5)]
    assert sorted(f.name for f in (tmp_path / "figures").iterdir()) == [
        "a.png", "a.svg", "b.png", "b.svg",
    ]  # fmt: skip
    assert pictures[0]["data"].startswith("iVBOR")


def test_the_same_drawing_is_the_same_bytes(tmp_path):
    """No date, no random names: pictures can be compared."""

    def draw():
        figure, (axes,) = new_figure()
        axes.plot([0.0, 1.0], [1.0, 3.0])
        return figure

    files = []
    for name in ("x", "y"):
        (tmp_path / name).mkdir()
        Drawing(name="p", title="P", caption="", draw=draw).save(tmp_path / name)
        files.append([(tmp_path / name / f"p.{kind}").read_bytes() for kind in ("png", "svg")])
    assert files[0] == files[1]


def test_nothing_above_nought_stays_linear():
    """A logarithm has no place for what is all 0; it is drawn plainly instead of not at all."""
    _, (axes,) = new_figure()
    axes.plot([1.0, 2.0], [0.0, 0.0])
    make_logarithmic(axes, "xy")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")


@pytest.mark.parametrize("n", [3, 7, 10])
def test_classes_have_colours_of_their_own(n):
    """Grey for what is not assessed, and no two alike."""
    colours = class_colours(np.geomspace(8e-4, 1e-6, n - 2))
    assert len(set(colours)) == n
    assert colours[0] == "#d9d9d9"


SIDEWAYS = BUILDING.replace('at = ["4 m", "3 m"]', 'at = ["4 m", "3 m"]\naxes = ["z", "x"]')


def test_a_point_is_drawn_beside_the_limits_on_its_own_motion():
    """0.07 gal upright and 0.05 gal sideways; a curve for upright motion is not at a level point."""
    curves = '["electron-microscope-horizontal", "electron-microscope-vertical"]'
    study = tr.study_from_text(SIDEWAYS + f'\n[criteria]\nmethod = "coupled"\ncurves = {curves}\n')
    up = replace(find_criterion("VC-A"), name="up", title="up", axis="vertical")
    some = (*study.assessment.criteria, up)
    study = replace(study, assessment=replace(study.assessment, criteria=some))
    found = {one.name: one for one in response.drawings(result_of(study))}
    words = {
        name: [text.get_text() for text in one.draw().axes[0].texts]
        for name, one in found.items()
        if name.startswith("criteria")
    }
    assert words == {
        "criteria_acceleration": ["Electron microscope, vertical, 0.07 gal"],
        "criteria_velocity_1": ["up"],
        "criteria_acceleration_2": ["Electron microscope, horizontal, 0.05 gal"],
        "criteria_velocity_1_2": [],
    }


@pytest.fixture
def many():
    study = study_of()
    cases = tuple(Case(name=f"articulated route {i}", routes=("main",)) for i in range(12))
    with rc_context(STYLE):
        yield {d.name: d for d in response.drawings(result_of(replace(study, cases=cases)))}


def test_a_legend_of_many_cases_is_in_the_picture(many):
    """Twelve names in one row would be cut off at both ends."""
    figure = many["criteria_velocity_1"].draw()
    figure.canvas.draw()
    box = figure.legends[0].get_window_extent()
    assert box.x0 >= 0.0
    assert box.x1 <= figure.bbox.width
    assert len(figure.legends[0].get_texts()) == 12


def test_lines_of_many_cases_are_told_apart(many):
    """There are eight colours: from the ninth case on lines are dashed."""
    (axes,) = many["criteria_velocity_1"].draw().axes
    lines = [line for line in axes.lines if str(line.get_label()).startswith("articulated")]
    assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == 12
