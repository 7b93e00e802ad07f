"""What the screen shows: sketches, tables, progress, and what work costs."""

import io
import json
import sys
from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from studies import GOOD
from trundle.cli import afford, screen
from trundle.cli.result_tables import print_result
from trundle.cli.show import error_as_json, say_json, show_of, warn
from trundle.cli.sketch import plan_sketch
from trundle.errors import InputError, Problem, StudyError
from trundle.run.estimate import Estimate


@pytest.fixture(scope="module")
def study():
    return tr.study_from_text(GOOD)


@pytest.fixture(scope="module")
def result(study):
    return tr.run_study(study)


def rows_of(sketch):
    """The characters inside the border, y upwards."""
    lines = sketch.splitlines()
    inside = [line[1:-1] for line in lines if line.startswith("|")]
    return np.array([list(line) for line in inside[::-1]])


def test_a_sketch_puts_everything_where_it_is(study):
    """Columns at the corners and middles, the point a quarter across, the route half way up."""
    grid = rows_of(plan_sketch(study))
    height, width = grid.shape
    assert width == 66
    assert height == pytest.approx(66 * 0.5 * 6.0 / 12.0, abs=1)
    for row in (0, height - 1):
        assert [grid[row, c] for c in (0, round((width - 1) / 2), width - 1)] == ["+"] * 3
    middle = round((height - 1) / 2)
    assert grid[middle, round(0.25 * (width - 1))] == "1"
    assert grid[middle, -1] == ">"
    assert "a" in grid[middle]
    assert "a  route main: 15 km/h, ends at >" in plan_sketch(study)
    assert "1  point tool at (3, 3) m" in plan_sketch(study)


def test_a_long_floor_stays_on_the_screen(study):
    """At least 8 lines for a strip, 48 at most for a tower."""
    for lengths, lines in (((100.0, 4.0), 8), ((4.0, 100.0), 48)):
        plan = replace(study.plan, x_extent=(0.0, lengths[0]), y_extent=(0.0, lengths[1]),
                       x_lines=np.array([0.0, 4.0]), y_lines=np.array([0.0, 4.0]))  # fmt: skip
        assert len(rows_of(plan_sketch(replace(study, plan=plan)))) == lines


def test_names_in_brackets_are_shown_as_they_are(capsys):
    """A unit is no markup: ``[m/s]`` stands there, and a name cannot colour the screen."""
    screen.print_table("A [bold]title", ("name", "v [m/s]"), [("[red]x", "1.5")])
    shown = capsys.readouterr().out
    for text in ("A [bold]title", "v [m/s]", "[red]x", "1.5"):
        assert text in shown


def test_progress_on_a_pipe_is_a_line_a_stage(capsys, monkeypatch):
    """Each stage once, with its share; quiet says nothing."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False, raising=False)
    with screen.progress_bar() as tell:
        for share in (0.0, 0.25, 0.5):
            tell("modes", share)
        tell("runs", 0.75)
    said = capsys.readouterr().err.splitlines()
    assert [line.partition("] ")[2] for line in said] == ["modes", "runs"]
    assert said[0].startswith("[  0 %")
    assert said[1].startswith("[ 75 %")
    with screen.progress_bar(quiet=True) as tell:
        tell("modes", 0.5)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("elapsed", "done", "left", "said"),
    [
        (1.0, 0.5, 0.5, ""), (10.0, 0.01, 0.99, ""), (10.0, 0.5, 0.5, ", 10 s left"),
        (60.0, 0.25, 0.75, ", 3 min left"), (30.0, 0.3, 0.7, ", 70 s left"),
    ],
)  # fmt: skip
def test_time_left_is_in_proportion_once_enough_is_known(elapsed, done, left, said):
    assert screen._time_left(elapsed, done, left) == said


def estimate(seconds, memory):
    return Estimate(seconds=seconds, memory=memory, slowest="main, coupled")


def test_dear_work_is_asked_for(monkeypatch):
    """More than half an hour, or more memory than there is; --yes takes it as it is."""
    monkeypatch.setattr(afford, "memory_there_is", lambda: 4e9)
    assert afford.what_is_dear(estimate(60.0, 1e9)) == ""
    long, large = estimate(7200.0, 1e9), estimate(60.0, 9e9)
    assert "that is long" in afford.what_is_dear(long)
    assert "there are 4 GB" in afford.what_is_dear(large)
    for dear in (long, large):
        with pytest.raises(InputError, match=r"most of it is for main, coupled.*--yes"):
            afford.check_affordable("study.toml", dear, yes=False)
        afford.check_affordable("study.toml", dear, yes=True)


def test_json_has_no_not_a_number(capsys):
    say_json({"a": np.float64(1.5), "b": [float("nan"), np.inf], "c": (1, "x")})
    assert json.loads(capsys.readouterr().out) == {"a": 1.5, "b": [None, None], "c": [1, "x"]}


def test_doubts_stand_beside_what_is_read_by_programs(capsys):
    """Among tables on the output; beside JSON and silence on the error stream."""
    for show, stream in (("tables", "out"), ("json", "err"), ("nothing", "err")):
        warn("the mesh is coarse", show)
        assert getattr(capsys.readouterr(), stream) == "warning: the mesh is coarse\n"
    assert show_of(as_json=True, quiet=False) == "json"
    assert show_of(as_json=False, quiet=True) == "nothing"
    with pytest.raises(InputError, match="give one of them"):
        show_of(as_json=True, quiet=True)


def test_mistakes_as_json_are_one_by_one():
    problem = Problem(
        place="route[1].speed", value="'x'", rule="a speed", remedy="write one", line=7
    )
    said = json.loads(error_as_json(StudyError("s.toml", [problem, problem])))
    assert [m["line"] for m in said["mistakes"]] == [7, 7]
    assert said["mistakes"][0]["place"] == "route[1].speed"
    assert json.loads(error_as_json(InputError("no such file"))) == {"error": "no such file"}


def test_tables_of_a_result_hold_its_numbers(result, capsys):
    """Median of the runs in gal and um/s, the exact value beside it, verdict with its margin."""
    print_result(result)
    shown = capsys.readouterr().out
    (cell,) = result.cells.values()
    median = np.median(cell.rms_velocity[:, 0]) * 1e6
    assert f"{float(f'{median:.3g}'):g}" in shown
    assert "Median (5-95 %) of 2 runs" in shown
    assert "Exact statistics over all roads, beside 2 runs" in shown
    assert f"{cell.exact.rms()[0] * 1e6:.4g}" in shown
    ((verdict,),) = result.verdicts.values()
    assert f"{verdict.status} {verdict.margin:.3g}" in shown or verdict.status in shown
    assert "road B" in shown


def test_a_bar_is_drawn_on_a_terminal(monkeypatch):
    """The description and the share that were told last."""
    file = io.StringIO()
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    real = screen.Console
    monkeypatch.setattr(
        screen, "Console", lambda **_: real(file=file, force_terminal=True, width=100)
    )
    with screen.progress_bar() as tell:
        tell("modes below 90 Hz", 0.5)
    assert "modes below 90 Hz" in file.getvalue()
    assert "50 %" in file.getvalue()
