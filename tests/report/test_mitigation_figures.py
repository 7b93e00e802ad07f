"""What would help, in pictures: each cell of a matrix is its own, each curve at its own speeds."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made import Page, study_of
from matplotlib.colors import to_rgba

from trundle.criteria import Verdict, find_criterion
from trundle.errors import FitnessWarning
from trundle.mitigate.outcome import Outcome, Sweep
from trundle.report import write_mitigation_report
from trundle.report.canvas import COLOURS
from trundle.report.figures import mitigation as figures
from trundle.report.html import template
from trundle.study.plans import Case
from trundle.units import KMH
from trundle.views.mitigation import NONE, PARTLY, UNKNOWN, mitigation_rows

TWO_POINTS = '\n[[point]]\nname = "stage <2>"\nat = ["8 m", "4 m"]\n'
CURVES = ("VC-A", "VC-B", "VC-C")
SPEEDS = (10 * KMH, 15 * KMH, 20 * KMH)
ROADS = ("A", "B")


def verdict_of(name, point, margin, status=None):
    status = status or ("pass" if margin >= 1.0 else "fail")
    return Verdict(
        criterion=find_criterion(name), point=point, status=status, percentile=95.0,
        unresolved=(), averaging="max_1s", margin=margin, governing_band=12.6,
        share_exceeding=0.25,
    )  # fmt: skip


def sweep_of(changes, margin, *, cases=("main",), text="", speeds=SPEEDS, roads=ROADS, **more):
    """A sweep whose margin to VC-A a function of change, case, speed, road and point says.

    Each next curve is half as high, and so are the margins to them.
    """
    study = study_of(text)
    study = replace(study, cases=tuple(Case(name=name, routes=("main",)) for name in cases))
    outcomes = []
    for change in changes:
        for case in cases:
            for speed in speeds:
                for road in roads:
                    verdicts = []
                    for point in study.points:
                        m = margin(change, case, speed, road, point)
                        verdicts += [
                            verdict_of(name, point, m / 2.0**i) for i, name in enumerate(CURVES)
                        ]
                    outcomes.append(
                        Outcome(
                            change=change, case=case, speed=speed, road=road,
                            verdicts=tuple(verdicts), excited_to=11.8, warnings=(),
                        )
                    )  # fmt: skip
    return Sweep(
        study=study, changes=tuple(changes), speeds=tuple(speeds), roads=tuple(roads), runs=7,
        outcomes=tuple(outcomes),
        resonances={(change, case): () for change in changes for case in cases},
        **more,
    )  # fmt: skip


def by_place(change, case, speed, road, point):
    """Margins to VC-A that differ in every direction: 4 passes all curves, below 1 none."""
    value = {10: 4.0, 15: 2.0, 20: 1.0}[round(speed / KMH)]
    value *= {"A": 1.0, "B": 0.5}[road]
    value *= {"as it is": 1.0, "slab": 2.0}.get(change, 1.0)
    return 1.001 * value


def cells(panel):
    """Words of a matrix by column and row, from the lower left, and their colours."""
    return {(int(t.get_position()[0]), int(t.get_position()[1])): t.get_text() for t in panel.texts}


def test_a_cell_of_a_matrix_is_its_speed_and_road():
    """Rows are speeds, columns road classes; by hand 4, 2, 1 on A and half of that on B."""
    sweep = sweep_of(["as it is", "slab"], by_place)
    figure = figures.class_matrix_figure(sweep, "tool")
    first, second = figure.axes
    assert [t.get_text() for t in first.get_yticklabels()] == ["10", "15", "20"]
    assert [t.get_text() for t in second.get_xticklabels()] == ["A", "B"]
    assert cells(first) == {
        (0, 0): "VC-C", (0, 1): "VC-B", (0, 2): "VC-A", (1, 0): "VC-B", (1, 1): "VC-A",
        (1, 2): NONE,
    }  # fmt: skip
    assert cells(second)[1, 2] == "VC-A"
    assert first.get_title() == "main\nas it is"
    assert second.get_title() == "main\nslab"
    assert second.get_xlabel() == "road class"
    assert first.get_ylabel() == "speed [km/h]"
    low, high = first.get_ylim()
    assert low < high  # the slowest below


def test_colours_of_a_matrix_are_ranks_in_one_order():
    """Not met, not known, then curves from the widest on; the same word has the same colour."""
    sweep = sweep_of(["as it is", "slab"], by_place)
    for panel in figures.class_matrix_figure(sweep, "tool").axes:
        (image,) = panel.images
        names = [NONE, UNKNOWN, "VC-A", "VC-B", "VC-C"]
        ranks = np.asarray(image.get_array())
        for (column, row), word in cells(panel).items():
            assert ranks[row, column] == names.index(word)
        assert image.norm(0) != image.norm(1)
        assert image.origin == "lower"


def test_what_is_not_assessed_is_neither_met_nor_failed():
    """Nothing is passed and something is unknown: its word stands there, in its own colour."""
    sweep = sweep_of(["as it is"], lambda *_: 0.5, speeds=SPEEDS[:1], roads=("B",))
    (one,) = sweep.outcomes
    unknown = replace(one.verdicts[2], status="not assessed")
    sweep = replace(sweep, outcomes=(replace(one, verdicts=(*one.verdicts[:2], unknown)),))
    (panel,) = figures.class_matrix_figure(sweep, "tool").axes
    assert cells(panel) == {(0, 0): "not ass."}
    assert np.asarray(panel.images[0].get_array()).item() == 1


def test_every_point_has_its_own_matrix_and_curve():
    """Margins at the second point are a quarter: 4 meets VC-C at the first, and VC-A at the second."""
    names = ("tool", "stage <2>")

    def margin(change, case, speed, road, point):
        return 4.004 if point == names[0] else 1.001

    sweep = sweep_of(["as it is"], margin, text=TWO_POINTS, roads=("B",))
    drawn = {one.name: one for one in figures.drawings(sweep)}
    assert set(drawn) == {"matrix_1", "speed_1", "matrix_2", "speed_2"}
    assert drawn["matrix_2"].title == "Strictest criterion met, stage <2>"
    words = [set(cells(drawn[f"matrix_{i}"].draw().axes[0]).values()) for i in (1, 2)]
    assert words == [{"VC-C"}, {"VC-A"}]
    levels = [drawn[f"speed_{i}"].draw().axes[0].lines[0].get_ydata()[0] for i in (1, 2)]
    assert levels[1] / levels[0] == pytest.approx(4.0)
    assert PARTLY in drawn["matrix_1"].caption


def test_many_changes_are_rows_in_their_order():
    """Five changes: a panel a case and road, the first change at the top, a column a speed."""
    changes = [f"change {i}" for i in range(5)]

    def margin(change, case, speed, road, point):
        return {0: 0.5, 1: 1.001, 2: 2.001, 3: 4.001, 4: 8.0}[int(change[-1])]

    sweep = sweep_of(changes, margin, cases=("in", "out"))
    figure = figures.class_matrix_figure(sweep, "tool")
    assert [panel.get_title() for panel in figure.axes] == [
        "in, class A", "in, class B", "out, class A", "out, class B",
    ]  # fmt: skip
    panel = figure.axes[0]
    assert [t.get_text() for t in panel.get_yticklabels()] == changes
    assert [cells(panel)[0, i] for i in range(5)] == [NONE, "VC-A", "VC-B", "VC-C", "VC-C"]
    for one in figure.axes:
        bottom, top = one.get_ylim()
        assert top < bottom  # the first at the top
    assert [t.get_text() for t in figure.axes[-1].get_xticklabels()] == ["10", "15", "20"]


def test_a_curve_is_level_over_limit_at_every_speed():
    """One over the margin, in km/h; a colour a road class, a style a change; the line of 1."""
    sweep = sweep_of(["as it is", "slab"], by_place)
    figure = figures.speed_figure(sweep, "tool", "VC-B")
    (panel,) = figure.axes
    curves = [line for line in panel.lines if line.get_marker() == "o"]
    assert len(curves) == 2 * 2
    by_look = {(line.get_color(), line.get_linestyle()): line for line in curves}
    for i, change in enumerate(("as it is", "slab")):
        for j, road in enumerate(ROADS):
            line = by_look[COLOURS[j], ("-", "--")[i]]
            np.testing.assert_allclose(line.get_xdata(), [10.0, 15.0, 20.0])
            expected = [2.0 / by_place(change, "main", v, road, "tool") for v in SPEEDS]
            np.testing.assert_allclose(line.get_ydata(), expected)
    (one,) = [line for line in panel.lines if list(line.get_ydata()) == [1.0, 1.0]]
    assert to_rgba(one.get_color()) == (0.0, 0.0, 0.0, 1.0)
    assert panel.get_yscale() == "log"
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("speed [km/h]", "level / VC-B")
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["class A", "class B", "as it is", "slab"]


def test_speeds_in_resonance_are_marked_once_in_the_panel_of_their_case():
    """12.5 km/h of both changes is one dotted line; the other case has none."""
    sweep = sweep_of(["as it is", "slab"], by_place, cases=("in", "out"))
    resonances = dict.fromkeys(sweep.resonances, ())
    resonances |= {("as it is", "in"): (12.5 * KMH,), ("slab", "in"): (12.5 * KMH, 17 * KMH)}
    figure = figures.speed_figure(replace(sweep, resonances=resonances), "tool", "VC-A")
    found = [
        sorted(float(line.get_xdata()[0]) for line in panel.lines if len(line.get_xdata()) == 2
               and line.get_xdata()[0] == line.get_xdata()[1])
        for panel in figure.axes
    ]  # fmt: skip
    assert found == [[pytest.approx(12.5), pytest.approx(17.0)], []]
    assert [panel.get_title() for panel in figure.axes] == ["in", "out"]


def test_many_changes_have_a_panel_each_with_a_line_for_every_case():
    """Five changes and two cases: titles are the changes, those that are left over are not seen."""
    changes = [f"change {i}" for i in range(5)]

    def margin(change, case, speed, road, point):
        return (1.0 + int(change[-1])) * (1.0 if case == "in" else 3.0)

    sweep = sweep_of(changes, margin, cases=("in", "out"), roads=("B",))
    figure = figures.speed_figure(sweep, "tool", "VC-A")
    seen = [panel for panel in figure.axes if panel.get_visible()]
    assert [panel.get_title() for panel in seen] == changes
    for i, panel in enumerate(seen):
        lines = [line for line in panel.lines if line.get_marker() == "o"]
        values = {line.get_linestyle(): float(line.get_ydata()[0]) for line in lines}
        assert values == {"-": pytest.approx(1.0 / (1 + i)), "--": pytest.approx(1 / (3 + 3 * i))}
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["class B", "in", "out"]


def test_a_margin_that_nobody_knows_leaves_a_gap():
    """NaN at one speed: no point there, and the others where they are."""
    sweep = sweep_of(["as it is"], lambda change, case, speed, road, point: 2.0, roads=("B",))
    outcomes = list(sweep.outcomes)
    lost = tuple(replace(v, margin=np.nan, status="not assessed") for v in outcomes[1].verdicts)
    outcomes[1] = replace(outcomes[1], verdicts=lost)
    sweep = replace(sweep, outcomes=tuple(outcomes))
    (panel,) = figures.speed_figure(sweep, "tool", "VC-A").axes
    (line,) = [line for line in panel.lines if line.get_marker() == "o"]
    np.testing.assert_allclose(line.get_ydata(), [0.5, np.nan, 0.5])


def test_the_curves_are_of_the_criterion_that_is_met_by_half():
    """VC-A by all, VC-C by none, VC-B by half of the combinations: margins of 1.2 and 2.4 to VC-A."""
    sweep = sweep_of(
        ["as it is"], lambda change, case, speed, road, point: 1.2 if road == "A" else 2.4
    )
    drawn = {one.name: one for one in figures.drawings(sweep)}
    assert drawn["speed_1"].draw().axes[0].get_ylabel() == "level / VC-B"
    assert "the limit of VC-B" in drawn["speed_1"].caption


def test_without_any_margin_there_is_no_curve():
    """Only limits on peaks: a matrix that says so, and no level against speed."""
    sweep = sweep_of(["as it is"], lambda *_: np.nan, speeds=SPEEDS[:1], roads=("B",))
    assert [one.name for one in figures.drawings(sweep)] == ["matrix_1"]


def test_the_page_has_a_row_for_every_combination_and_names_as_text():
    """2 changes, 3 speeds and 2 roads; tags in names stay text; doubts stand below."""
    changes = ["<b>as it is", "slab & beams"]
    sweep = sweep_of(changes, by_place, cases=("<i>main",))
    warned = FitnessWarning(subject="a & b", message="<u>doubt")
    outcomes = tuple(replace(o, warnings=(warned,)) for o in sweep.outcomes)
    sweep = replace(sweep, outcomes=outcomes)
    page = Page(
        template("mitigation.html.j2").render(
            sweep=sweep, rows=mitigation_rows(sweep), partly=PARTLY, pictures=[], version="9"
        )
    )
    assert {"b", "i", "u"}.isdisjoint(page.tags)
    head, *rows = page.tables["table"][0]
    assert head == [
        "change", "vehicle on", "speed [km/h]", "road class", "point", "strictest criterion met",
    ]  # fmt: skip
    assert len(rows) == 2 * 3 * 2
    assert rows[0] == ["<b>as it is", "<i>main", "10", "A", "tool", "VC-C"]
    assert rows[-1] == ["slab & beams", "<i>main", "20", "B", "tool", NONE]
    assert "a & b: <u>doubt" in page.said("limits")
    assert "7 runs a combination" in page.said("header")
    assert PARTLY in page.said("table")


def test_the_folder_has_page_pictures_and_every_margin(tmp_path):
    """Pictures stand in the page; a margin that nobody knows is written as such, and is no pass."""
    sweep = sweep_of(["as it is"], lambda *_: 1.25, speeds=SPEEDS[:1], roads=("B",))
    (one,) = sweep.outcomes
    lost = replace(one.verdicts[2], margin=np.nan, status="not assessed")
    sweep = replace(sweep, outcomes=(replace(one, verdicts=(*one.verdicts[:2], lost)),))
    path = write_mitigation_report(sweep, tmp_path)
    page = Page(path.read_text(encoding="utf-8"))
    assert [image["alt"].partition(".")[0] for image in page.images] == [
        "Strictest criterion met, tool", "Level against speed, tool",
    ]  # fmt: skip
    assert all(image["src"].startswith("data:image/png;base64,iVBOR") for image in page.images)
    head, *rows = [line.split(",") for line in (tmp_path / "summary.csv").read_text().splitlines()]
    table = [dict(zip(head, row, strict=True)) for row in rows]
    assert [row["criterion"] for row in table] == list(CURVES)
    assert [row["verdict"] for row in table] == ["pass", "fail", "not assessed"]
    assert [row["margin"] for row in table] == ["1.25", "0.625", "nan"]
    assert {row["speed_kmh"] for row in table} == {"10"}
    assert {row["excited_to_hz"] for row in table} == {"11.8"}


def test_cells_of_a_matrix_tell_criteria_apart():
    """Titles of AISC DG11 differ behind their eighth letter: short names, as study files have them."""
    sweep = sweep_of(["as it is"], lambda *_: 1.0, speeds=SPEEDS[:2], roads=("B",))
    names = ("DG11-200", "DG11-50")
    outcomes = tuple(
        replace(one, verdicts=tuple(
            verdict_of(name, "tool", margin) for name, margin in zip(names, margins, strict=True)
        ))
        for one, margins in zip(sweep.outcomes, ((2.0, 0.5), (8.0, 2.0)), strict=True)
    )  # fmt: skip
    (panel,) = figures.class_matrix_figure(replace(sweep, outcomes=outcomes), "tool").axes
    assert cells(panel) == {(0, 0): "DG11-200", (0, 1): "DG11-50"}


def test_titles_that_begin_alike_are_written_by_their_names():
    """Neither title nor name is short: beginnings that are the same say nothing."""
    sweep = sweep_of(["as it is"], lambda *_: 4.0, speeds=SPEEDS[:1], roads=("B",))
    some = tuple(
        replace(v, criterion=replace(v.criterion, name=f"microscope {i}", title=f"Microscope no {i}"))
        for i, v in enumerate(sweep.outcomes[0].verdicts)
    )  # fmt: skip
    outcomes = (replace(sweep.outcomes[0], verdicts=some),)
    (panel,) = figures.class_matrix_figure(replace(sweep, outcomes=outcomes), "tool").axes
    assert cells(panel) == {(0, 0): "microscope 2"}


def test_lines_of_many_cases_are_told_apart():
    """Four styles and eight marks, for colours are those of roads: nine cases look differently."""
    cases = tuple(f"case {i}" for i in range(9))
    sweep = sweep_of([f"change {i}" for i in range(5)], lambda *_: 2.0, cases=cases, roads=("B",))
    figure = figures.speed_figure(sweep, "tool", "VC-A")
    handles = figure.legends[0].legend_handles[1:]
    assert len({(h.get_linestyle(), h.get_marker()) for h in handles}) == 9
    drawn = [line for line in figure.axes[0].lines if len(line.get_xdata()) == len(SPEEDS)]
    assert len({(line.get_linestyle(), line.get_marker()) for line in drawn}) == 9
