"""Tables of a finished study: every number in the row and column where it belongs."""

from dataclasses import replace

import numpy as np
import pytest

from studies import GOOD
from trundle.cli import result_tables
from trundle.cli.fail_on import check_fail_on, say_unmet
from trundle.cli.result_tables import print_result
from trundle.criteria import Verdict, find_criterion
from trundle.errors import InputError
from trundle.results.cells import CellKey
from trundle.run.whole_study import run_study
from trundle.study_file import study_from_text
from trundle.views.tables import summary_headings

TEXT = (
    GOOD.replace('[[point]]\nname = "tool"',
                 '[[point]]\nname = "[b]größe"\nat = ["9 m", "3 m"]\n\n[[point]]\nname = "tool"')
    .replace('class = "B"', 'class = "A"\n\n[[road]]\nclass = "D"')
    .replace('["VC-A"]', '["VC-A", "VC-E"]')
    .replace('"4 s"', '"2 s"')
)  # fmt: skip


@pytest.fixture(scope="module")
def result():
    """Two roads and two points; verdicts are put in their places by hand where they matter."""
    return run_study(study_from_text(TEXT))


def verdict(name, point, status, margin=np.nan, interval=(np.nan, np.nan), reasons=()):
    return Verdict(
        criterion=find_criterion(name), point=point, status=status, percentile=95.0,
        unresolved=(), averaging="max_1s", margin=margin, interval=interval, reasons=reasons,
    )  # fmt: skip


def tables(text):
    """Heading and rows of each table, by its title."""
    found, title, inside = {}, "", False
    for line in text.splitlines():
        if line[:1] in {"│", "┃"}:
            cells = [c.strip() for c in line.strip("│┃").replace("┃", "│").split("│")]
            found.setdefault(title, []).append(cells)
            inside = True
        elif line.strip() and line[0] not in "┏┡├└":
            title = line.strip() if inside else f"{title} {line.strip()}".strip()
            inside = False
    return found


def table(text, start):
    (rows,) = (rows for title, rows in tables(text).items() if start in title)
    return rows


def test_medians_stand_in_the_row_of_their_road_and_point(result, capsys):
    """Median of the runs' RMS velocity in um/s, three digits, from each cell's own numbers."""
    print_result(result)
    _, *rows = table(capsys.readouterr().out, "Median (5-95 %) of 2 runs")
    (column,) = (4 + i for i, name in enumerate(summary_headings()) if "[um/s]" in name)
    found = {(row[1], row[3]): float(row[column].split(" ")[0]) for row in rows if row[1]}
    for road in "AD":
        cell = result.cells[CellKey("main", road, "coupled")]
        for p, point in enumerate(("[b]größe", "tool")):
            wanted = float(np.median(cell.rms_velocity[:, p])) * 1e6
            assert found[road, point] == pytest.approx(wanted, rel=6e-3)


def test_verdicts_stand_under_their_road_and_point(result, capsys):
    """Eight verdicts of different margins in a matrix of two criteria by four columns."""
    margins = iter(np.arange(1.5, 9.5))
    made = {}
    for road in "AD":
        made[CellKey("main", road, "coupled")] = tuple(
            verdict(name, point, "pass", margin=float(next(margins)))
            for point in ("[b]größe", "tool")
            for name in ("VC-A", "VC-E")
        )
    print_result(replace(result, verdicts=made))
    heading, *rows = table(capsys.readouterr().out, "Verdict on vertical motion at 95 %")
    wanted = {
        (key.road, v.point, v.criterion.title): f"pass {v.margin:.3g}"
        for key, many in made.items() for v in many
    }  # fmt: skip
    found = {}
    for title, *cells in rows:
        for name, cell in zip(heading[1:], cells, strict=True):
            road = "A" if "A" in name.replace("[b]größe", "").replace("tool", "") else "D"
            found[road, "tool" if "tool" in name else "[b]größe", title] = cell
    assert found == wanted


def test_what_is_not_assessed_says_why_once(result, capsys):
    """Two reasons, the first of two verdicts: two lines, and no pass anywhere."""
    keys = [CellKey("main", road, "coupled") for road in "AD"]
    both = ("the record ends too early", "waves end at 12 Hz")
    made = {
        key: tuple(
            verdict(name, point, "not assessed", reasons=both[: 1 + (name == "VC-E")])
            for point in ("[b]größe", "tool")
            for name in ("VC-A", "VC-E")
        )
        for key in keys
    }
    print_result(replace(result, verdicts=made))
    said = capsys.readouterr().out
    told = [line for line in said.splitlines() if line.startswith("not assessed: ")]
    assert told == [f"not assessed: {reason}" for reason in both]
    rows = table(said, "Verdict on vertical motion")
    assert {cell for row in rows[1:] for cell in row[1:]} == {"not assessed"}


@pytest.mark.parametrize(
    ("status", "margin", "interval", "cell"),
    [
        ("pass", 1.2, (1.1, 1.4), "pass 1.2"),
        ("pass", 1.2, (0.9, 1.4), "pass 1.2?"),
        ("fail", 0.4567, (0.4, 0.5), "fail 0.457"),
        ("not assessed", np.nan, (np.nan, np.nan), "not assessed"),
        ("not assessed", 3.0, (2.0, 4.0), "not assessed 3"),
    ],
)
def test_a_question_mark_stands_behind_a_pass_that_is_not_sure(status, margin, interval, cell):
    """A 95 % interval that reaches below 1, and that of a pass alone."""
    assert result_tables._outcome(verdict("VC-A", "p", status, margin, interval)) == cell


def test_without_criteria_there_is_no_word_of_verdicts(result, capsys):
    """Nothing is held against, so nothing is passed; the levels are printed all the same."""
    bare = replace(result, study=replace(result.study, assessment=None), verdicts={})
    print_result(bare)
    said = capsys.readouterr().out
    assert "Median (5-95 %)" in said
    assert "Verdict" not in said
    assert "pass" not in said


@pytest.mark.parametrize(
    ("wanted", "unmet"),
    [
        (("VC-A",), []),
        (("vc-e",), ["not met: A, tool, {E}: fail, margin 0.5"]),
        (("VC-E", "VC-A"), ["not met: A, tool, {E}: fail, margin 0.5"]),
        (("VC-C",), ["not met: A, tool, {C}: not assessed", "not met: B, tool, {C}: not assessed, margin 4"]),
        ((), []),
    ],
)  # fmt: skip
def test_what_is_failed_or_not_assessed_is_unmet(capsys, wanted, unmet):
    """A margin of 4 that is not assessed is no pass; names in any case; nothing asked, nothing told."""
    verdicts = [
        ("A, ", verdict("VC-A", "tool", "pass", 2.0)),
        ("A, ", verdict("VC-E", "tool", "fail", 0.5)),
        ("A, ", verdict("VC-C", "tool", "not assessed")),
        ("B, ", verdict("VC-C", "tool", "not assessed", 4.0)),
    ]
    titles = {letter: find_criterion(f"VC-{letter}").title for letter in "CE"}
    lines = [line.format(**titles) for line in unmet]
    for show, stream in (("tables", "out"), ("json", "err"), ("nothing", "err")):
        assert say_unmet(wanted, show, verdicts) == bool(unmet)
        said = capsys.readouterr()
        assert getattr(said, stream).splitlines() == lines
        assert said.out + said.err == getattr(said, stream)


def test_a_criterion_that_nothing_is_held_against_cannot_be_met():
    """A slip in a name must not end with exit code 0; the names that there are follow."""
    curves = [find_criterion("VC-A"), find_criterion("VC-C")]
    check_fail_on(["vc-a", "VC-C"], curves)
    check_fail_on([], [])
    with pytest.raises(InputError, match=r"--fail-on 'VC-E': .*; there are VC-A, VC-C"):
        check_fail_on(["VC-A", "VC-E"], curves)
    with pytest.raises(InputError, match=r"add \[criteria\] to the study"):
        check_fail_on(["VC-A"], [])
