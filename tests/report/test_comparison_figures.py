"""Ranges beside published values, transfer functions, histories by several methods, and their looks."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hand_made import BANDS, result_of, study_of
from matplotlib import rc_context
from matplotlib.colors import to_rgb

from trundle.criteria import find_criterion
from trundle.report.canvas import (
    COLOURS,
    STYLE,
    Drawing,
    class_colours,
    make_logarithmic,
    new_figure,
)
from trundle.report.figures import response as figures
from trundle.report.figures.transfer import transfer_figure
from trundle.study.plans import Case, Printed
from trundle.units import GAL, MICROMETRE_PER_SECOND
from trundle.views.printed import ComparisonRow
from trundle.views.transfer import Curve

TWO_POINTS = '\n[[point]]\nname = "stage"\nat = ["8 m", "4 m"]\n'
TWO_ROADS = '\n[[road]]\nclass = "C"\n'
METHODS = """
[[method]]
name = "stiff floor <2>"
interaction = "decoupled"
f_max = "30 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
"""


def words(axes):
    return [text.get_text() for text in axes.texts]


def row_of(case, method, middle, printed):
    return ComparisonRow(
        case=case, road="B", method=method, peak=(0.5 * middle, middle, 3.0 * middle),
        rms=(5.0 * middle, 10.0 * middle, 30.0 * middle), printed_peak=printed,
        printed_rms=10.0 * printed, peak_rank=50.0, rms_rank=50.0,
    )  # fmt: skip


def test_published_values_lie_on_our_ranges_row_by_row():
    """Bar from 5 to 95 %, dot at the median, cross at what is printed; peaks left, RMS right."""
    rows = [
        row_of("front", "a", 1.0, 2.0),
        row_of("rear", "a", 4.0, 0.2),
        row_of("rear", "b", 6.0, 7.0),
    ]
    figure = figures.comparison_figure(rows)
    peaks, levels = figure.axes
    for panel, scale in ((peaks, 1.0), (levels, 10.0)):
        found = {}
        for line in panel.lines:
            x, y = (np.asarray(one, float) for one in line.get_data())
            if len(y):
                kind = {"o": "dot", "x": "cross"}.get(line.get_marker(), "bar")
                found[kind, float(y[0])] = x.tolist()
        for y, (middle, printed) in enumerate(((1.0, 2.0), (4.0, 0.2), (6.0, 7.0))):
            assert found["bar", y] == pytest.approx([0.5 * scale * middle, 3.0 * scale * middle])
            assert found["dot", y] == pytest.approx([scale * middle])
            assert found["cross", y] == pytest.approx([scale * printed])
    assert [t.get_text() for t in peaks.get_yticklabels()] == [
        "front B, a", "rear B, a", "rear B, b",
    ]  # fmt: skip
    low, high = peaks.get_ylim()
    assert low > high  # the first row at the top
    assert peaks.get_xlabel() == "peak acceleration [gal]"
    assert levels.get_xlabel() == "record RMS velocity [um/s]"
    words_of = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words_of == ["ours: median, 5-95 %", "published"]


def test_a_picture_of_published_values_is_drawn_only_where_there_are_some():
    """From the study's own printed cells, at its first point, in gal and um/s."""
    study = study_of()
    assert "comparison" not in {one.name for one in figures.drawings(result_of(study))}
    printed = (
        Printed(case="main", road="B", method="coupled", peak_acceleration=0.02, rms_velocity=3e-5),
    )
    drawn = {one.name: one for one in figures.drawings(result_of(replace(study, printed=printed)))}
    panel = drawn["comparison"].draw().axes[0]
    crosses = [line for line in panel.lines if line.get_marker() == "x" and len(line.get_xdata())]
    assert [float(line.get_xdata()[0]) for line in crosses] == [pytest.approx(2.0)]


def test_histories_are_a_row_a_method_and_a_column_a_road():
    """The second point swings ten times as far as the first: 10 gal, in each of four panels."""
    study = study_of(METHODS + TWO_POINTS + TWO_ROADS)
    drawn = {one.name: one for one in figures.drawings(result_of(study))}
    figure = drawn["history_1_2"].draw()
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == [
        f"{method}, class {road}: peak 10 gal"
        for method in ("coupled", "stiff floor <2>")
        for road in "BC"
    ]
    for axes in figure.axes:
        line = axes.lines[0]
        t, a = line.get_data()
        np.testing.assert_allclose(a, 10.0 * np.sin(2.0 * np.pi * t), atol=1e-9)
        assert axes.get_xlim() == (0.0, 4.0)
    assert [bool(axes.get_ylabel()) for axes in figure.axes] == [True, False, True, False]
    assert [bool(axes.get_xlabel()) for axes in figure.axes] == [False, False, True, True]
    colours = [axes.lines[0].get_color() for axes in figure.axes]
    assert colours == [COLOURS[0], COLOURS[0], COLOURS[1], COLOURS[1]]


def test_who_acts_at_once_is_said_above_a_history():
    """A case of one route says which; one of several says so, for its name is the traffic's."""
    text = (
        '\n[[route]]\nname = "back"\nvehicle = "truck"\npath = [["12 m", "3 m"], ["0 m", "3 m"]]\n'
    )
    text += 'speed = "15 km/h"\n\n[[traffic]]\nname = "both"\nroutes = ["main", "back"]\n'
    drawn = [one for one in figures.drawings(result_of(study_of(text))) if "history" in one.name]
    assert [one.name for one in drawn] == ["history_1", "history_2", "history_3"]
    assert [one.title for one in drawn] == [
        "Acceleration at tool: route main", "Acceleration at tool: route back",
        "Acceleration at tool: several vehicles at once",
    ]  # fmt: skip


def test_spectra_of_every_case_are_in_one_picture_of_their_point_and_road():
    """Levels of cases, points and roads differ: each median line is its own, by hand 1 of 0.5, 1, 4."""
    text = TWO_POINTS + TWO_ROADS
    study = study_of(text, ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-E"]'))
    cases = (*study.cases, replace(study.cases[0], name="again"))
    study = replace(study, cases=cases)

    def level(key):
        base = 1e-6 * (1.0 if key.road == "B" else 10.0) * (1.0 if key.case == "main" else 3.0)
        return [base, 2.0 * base]

    drawn = {one.name: one for one in figures.drawings(result_of(study, level))}
    figure = drawn["criteria_velocity_2_2"].draw()
    (axes,) = figure.axes
    medians = {line.get_label(): line for line in axes.lines if line.get_marker() == "o"}
    np.testing.assert_allclose(medians["main"].get_ydata(), 20.0)
    np.testing.assert_allclose(medians["again"].get_ydata(), 60.0)
    np.testing.assert_allclose(medians["main"].get_xdata(), BANDS)
    assert "class C, stage" in axes.get_title()
    spans = [one.get_paths()[0].vertices[:, 1] for one in axes.collections]
    assert (spans[0].min(), spans[0].max()) == (pytest.approx(0.55 * 20), pytest.approx(3.7 * 20))
    assert [text for text in words(axes) if text.startswith("VC")] == ["VC-A", "VC-E"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["main", "again"]


def test_bands_that_are_not_computed_are_left_out_of_a_spectrum():
    """Nothing above 31.5 Hz: the line ends there instead of running on at some number."""
    result = result_of(study_of(), 1e-5, shown_to=35.0)
    drawn = {one.name: one for one in figures.drawings(result)}
    (axes,) = drawn["criteria_velocity_1"].draw().axes
    (line,) = [line for line in axes.lines if line.get_marker() == "o"]
    f, levels = line.get_data()
    np.testing.assert_array_equal(np.isnan(levels), f > 35.0)
    assert axes.get_xlim() == (0.9, 130.0)


def test_a_single_number_has_no_picture_of_bands_and_bands_none_of_peaks():
    """Peaks are drawn only where a limit on them is asked for."""
    names = {one.name for one in figures.drawings(result_of(study_of()))}
    assert "criteria_acceleration" not in names
    study = study_of("", ('curves = ["VC-A"]', 'curves = ["stepper-B", "VC-A"]'))
    drawn = {one.name: one for one in figures.drawings(result_of(study))}
    (axes,) = drawn["criteria_acceleration"].draw().axes
    limit = find_criterion("stepper-B").limits[0] / GAL
    assert words(axes) == [f"Stepper, maker B, {limit:g} gal"]
    assert "criteria_velocity_1" in drawn
    (plain,) = drawn["criteria_velocity_1"].draw().axes
    assert not any("Stepper" in text for text in words(plain))


def test_without_criteria_there_are_histories_alone():
    """Nothing to hold levels against, and no picture of it."""
    names = [one.name for one in figures.drawings(result_of(replace(study_of(), assessment=None)))]
    assert names == ["history_1"]


def curve_of(f, values, name="tool"):
    return Curve(
        load="<b>shaker", point=name, frequencies=np.asarray(f, float),
        values=np.asarray(values, complex), unit="(um/s)/N",
    )  # fmt: skip


def test_a_transfer_function_is_its_size_over_its_phase():
    """One degree of freedom: at its frequency the size is 1 / c and a velocity is in step."""
    f = np.linspace(1.0, 10.0, 181)
    m, k, c = 2.0, 2.0 * (2.0 * np.pi * 4.0) ** 2, 12.0
    w = 2.0 * np.pi * f
    values = 1j * w / (k - m * w**2 + 1j * w * c)
    figure = transfer_figure([curve_of(f, values)], "mobility", "shaken")
    size, phase = figure.axes
    at = int(np.argmin(np.abs(f - 4.0)))
    (line,) = size.lines
    assert line.get_ydata()[at] == pytest.approx(1.0 / c, rel=1e-9)
    assert np.argmax(line.get_ydata()) == at
    (turn,) = phase.lines
    assert turn.get_ydata()[at] == pytest.approx(0.0, abs=1e-9)
    assert turn.get_ydata()[0] > 45.0  # below it is ahead, above behind
    assert turn.get_ydata()[-1] < -45.0
    assert size.get_ylabel() == "mobility [(um/s)/N]"
    assert size.get_title(loc="left") == "shaken"
    assert phase.get_xlim() == (1.0, 10.0)


def test_a_phase_that_wraps_has_no_line_across():
    """From -170 to 170 degrees is a step of 20: the line is broken there, and nowhere else."""
    degrees = np.array([-100.0, -150.0, -170.0, 170.0, 120.0])
    values = np.exp(1j * np.radians(degrees))
    _, phase = transfer_figure([curve_of(np.arange(1.0, 6.0), values)], "mobility", "").axes
    shown = phase.lines[0].get_ydata()
    assert np.isnan(shown).tolist() == [False, False, False, True, False]
    np.testing.assert_allclose(shown[[0, 1, 2, 4]], degrees[[0, 1, 2, 4]])


def test_ten_curves_are_told_apart_by_colour_and_line():
    """Eight colours; the ninth curve has the first colour again, and another line."""
    f = np.linspace(2.0, 20.0, 10)
    some = [curve_of(f, np.full(10, 1.0 + i), name=f"p{i}") for i in range(10)]
    size, _ = transfer_figure(some, "mobility", "").axes
    looks = [(line.get_color(), line.get_linestyle()) for line in size.lines]
    assert len(set(looks)) == 10
    assert looks[8][0] == looks[0][0]


def test_names_with_dollar_signs_are_written_as_they_are(tmp_path):
    """Mathematics between dollars would swallow them: the picture says $x^2$, letter by letter."""

    def draw():
        figure, (axes,) = new_figure(2.0, 1.0)
        axes.set_title("5 $x^2$ <&>")
        return figure

    Drawing(name="one", title="", caption="", draw=draw).save(tmp_path)
    text = (tmp_path / "one.svg").read_text(encoding="utf-8")
    assert "5 $x^2$ &lt;&amp;&gt;" in re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)


@pytest.mark.parametrize("share", ["", "x", "y", "xy"])
def test_panels_share_the_axes_that_are_named(share):
    """In reading order: the second of two by two is to the right, the third below."""
    with rc_context(STYLE):
        _, axes = new_figure(rows=2, columns=2, share=share)
    axes[0].set(xlim=(1.0, 2.0), ylim=(3.0, 4.0))
    assert (axes[3].get_xlim() == (1.0, 2.0)) == ("x" in share)
    assert (axes[3].get_ylim() == (3.0, 4.0)) == ("y" in share)
    positions = [one.get_subplotspec().colspan.start for one in axes]
    assert positions == [0, 1, 0, 1]


def test_logarithmic_axes_have_plain_numbers():
    """0.1 and 1000, not powers of ten; an axis that is not named stays linear."""
    _, (axes,) = new_figure()
    axes.plot([0.1, 1000.0], [0.1, 1000.0])
    make_logarithmic(axes, "x")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    written = axes.xaxis.get_major_formatter()
    assert [written(value, 0) for value in (0.1, 1.0, 1000.0)] == ["0.1", "1", "1000"]


LIMITS = [8e-4, 4e-4, 2e-4, 1e-4, 5e-5, 25e-6, 125e-7, 6e-6, 3e-6]
"""Workshop to operating theatre, VC-A to VC-E [m/s]."""


def test_none_workshop_and_vc_a_are_told_apart_by_everybody():
    """As those see who have no green or no red cones (Vienot, Brettel and Mollon, 1999): far apart.

    Their transformation of linear RGB; 0.25 is a quarter of the way from black to white.
    """
    blind = {
        "nobody": np.eye(3),
        "red": np.array([[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1]]),
        "green": np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1]]),
    }  # fmt: skip
    colours = class_colours(LIMITS)
    some = np.array([to_rgb(colours[i]) for i in (0, 1, 2, 6)])  # unknown, none, workshop, VC-A
    for eye in blind.values():
        seen = np.clip(some**2.2 @ eye.T, 0.0, 1.0) ** (1 / 2.2)
        apart = np.linalg.norm(seen[:, None] - seen[None], axis=2) / np.sqrt(3.0)
        assert apart[np.triu_indices(4, 1)].min() > 0.1
        assert apart[1:, 1:][np.triu_indices(3, 1)].min() > 0.25


def test_colours_of_people_lighten_and_those_of_equipment_darken():
    """From each group's widest to its strictest; none is darker than all of people's."""
    shades = [
        np.array(to_rgb(colour)) @ np.array([0.2126, 0.7152, 0.0722])
        for colour in class_colours(LIMITS)[1:]
    ]
    assert (np.diff(shades[:5]) > 0.0).all()
    assert (np.diff(shades[5:]) < 0.0).all()


def test_a_case_that_is_no_route_is_called_by_its_name():
    """A machine is a case of its own; it does not drive, and no route is spoken of."""
    text = '\n[[machine]]\nname = "pump"\nat = ["9 m", "4 m"]\n'
    text += 'rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }\n'
    study = study_of(text)
    assert Case(name="pump", routes=("pump",)) in study.cases
    titles = [one.title for one in figures.drawings(result_of(study)) if "history" in one.name]
    assert "Acceleration at tool: pump" in titles
    assert "Acceleration at tool: route main" in titles


def test_a_curve_ends_with_its_name_at_its_last_limit():
    """In um/s: VC-A of 50 um/s at 80 Hz, with its rise to 100 um/s at 4 Hz."""
    _, (axes,) = new_figure()
    figures.draw_criterion(axes, find_criterion("VC-A"), 1e-6)
    (line,) = axes.lines
    np.testing.assert_allclose(line.get_xydata(), [[4.0, 100.0], [8.0, 50.0], [80.0, 50.0]])
    (name,) = axes.texts
    assert name.get_text() == "VC-A"
    np.testing.assert_allclose(name.xy, (80.0, 50e-6 / MICROMETRE_PER_SECOND))
