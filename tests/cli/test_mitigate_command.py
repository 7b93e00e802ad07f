"""The command that tries changes: what it reads between commas, and where each outcome is printed."""

import json

import numpy as np
import pytest

from studies import GOOD, run_main
from trundle.cli import mitigate_command as command
from trundle.criteria import Verdict, find_criterion
from trundle.errors import FitnessWarning, InputError
from trundle.mitigate.outcome import Outcome, Sweep
from trundle.study_file import study_from_text
from trundle.units import KMH
from trundle.views.mitigation import PARTLY

STATUS = {
    # (change, speed, road): of VC-A and VC-E
    ("as in the study", 10, "A"): ("pass", "pass"),
    ("as in the study", 10, "B"): ("pass", "fail"),
    ("as in the study", 20, "A"): ("fail", "fail"),
    ("as in the study", 20, "B"): ("fail", "not assessed"),
    ("[red]slab", 10, "A"): ("pass", "fail"),
    ("[red]slab", 10, "B"): ("pass", "pass"),
    ("[red]slab", 20, "A"): ("pass", "fail"),
    ("[red]slab", 20, "B"): ("fail", "fail"),
}


def sweep(status=STATUS):
    study = study_from_text(GOOD)
    return Sweep(
        study=study, changes=("as in the study", "[red]slab"), speeds=(10 * KMH, 20 * KMH),
        roads=("A", "B"), runs=2, resonances={},
        outcomes=tuple(
            Outcome(
                change=change, case="main", speed=speed * KMH, road=road, excited_to=12.0,
                warnings=(FitnessWarning(subject="doubt", message="x"),) if speed == 20 else (),
                verdicts=tuple(
                    Verdict(criterion=find_criterion(name), point="tool", status=one,
                            percentile=95.0, unresolved=(), averaging="max_1s")
                    for name, one in zip(("VC-A", "VC-E"), statuses, strict=True)
                ),
            )
            for (change, speed, road), statuses in status.items()
        ),
    )  # fmt: skip


def tables(text):
    """Cells of the rows of each table, by its title."""
    found, title = {}, ""
    for line in text.splitlines():
        if "Strictest criterion met" in line:
            title = line.strip()
        if line.startswith("│"):
            found.setdefault(title, []).append([c.strip() for c in line.strip("│").split("│")])
    return found


def test_each_outcome_stands_under_its_change_in_the_row_of_its_speed_and_column_of_its_class(
    tmp_path, capsys
):
    """Eight outcomes, all but two of them different from their neighbours; labels are no markup."""
    command._say(sweep(), tmp_path / "report.html", "tables")
    said = capsys.readouterr()
    a, e = (find_criterion(name).title for name in ("VC-A", "VC-E"))
    assert tables(said.out) == {
        "Strictest criterion met at tool: as in the study": [
            ["main", "10", e, a], ["main", "20", "none", "not assessed"],
        ],
        "Strictest criterion met at tool: [red]slab": [
            ["main", "10", a, e], ["main", "20", a, "none"],
        ],
    }  # fmt: skip
    lines = said.out.splitlines()
    assert PARTLY in said.out
    assert "warning: 20 km/h: doubt: x" in lines
    assert lines[-1] == f"report: {tmp_path / 'report.html'}"
    assert said.err == ""


def test_why_something_is_not_assessed_is_said_only_where_it_is(tmp_path, capsys):
    """All are known: no word on waves that end."""
    known = {key: tuple(s.replace("not assessed", "fail") for s in v) for key, v in STATUS.items()}
    command._say(sweep(known), tmp_path / "report.html", "tables")
    assert "not assessed" not in capsys.readouterr().out


def test_as_json_and_in_silence(tmp_path, capsys):
    """One document with a row a combination; doubts go to the error stream beside it."""
    command._say(sweep(), tmp_path / "report.html", "json")
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert len(found["outcomes"]) == 8
    by = {
        (r["change"], round(r["speed_kmh"]), r["road"]): r["strictest"] for r in found["outcomes"]
    }
    assert by["as in the study", 20, "B"] == "not assessed"
    assert by["[red]slab", 10, "B"] == find_criterion("VC-E").title
    assert found["warnings"] == ["20 km/h: doubt: x"]
    assert found["report"].endswith("report.html")
    assert said.err == "warning: 20 km/h: doubt: x\n"
    command._say(sweep(), tmp_path / "report.html", "nothing")
    said = capsys.readouterr()
    assert (said.out, said.err) == ("", "warning: 20 km/h: doubt: x\n")


@pytest.mark.parametrize(
    ("text", "kmh"),
    [
        ("20 km/h, 5 km/h", [5.0, 20.0]),
        ("5 km/h,, 5 km/h ,", [5.0]),
        ("2.5 m/s", [9.0]),
        ("1000 mm/s, 3.6 km/h", [3.6]),
    ],
)
def test_speeds_rise_and_each_stands_once(text, kmh):
    """By hand in km/h; what is said twice, in whatever unit, is driven once."""
    np.testing.assert_allclose(np.array(command._speeds(text)) / KMH, kmh)


def test_classes_keep_their_order_and_stand_once():
    """The first is the one that is run; the others are scaled from it."""
    assert command._classes("C, A,C ,H") == ["C", "A", "H"]


def test_changes_between_commas_become_those_of_their_kind():
    """Millimetres, percent and hertz of each option; slabs first, isolators last."""
    levers = command._levers("car_bmw_320i", "0.25 m, 300 mm", "2 %, 0.05", "2 Hz / 10 %")
    labels = [[change.label for change in lever] for lever in levers]
    assert labels[:3] == [["car bmw 320i"], ["slab 250 mm", "slab 300 mm"],
                          ["damping 2 %", "damping 5 %"]]  # fmt: skip
    assert [c.slab_thickness for c in levers[1]] == pytest.approx([0.25, 0.3])
    assert [c.damping_ratio for c in levers[2]] == pytest.approx([0.02, 0.05])
    (isolator,) = (c.isolation for c in levers[3])
    assert (isolator.frequency, isolator.damping_ratio) == pytest.approx((2.0, 0.1))
    assert command._levers("", "", "", "") == [[], [], [], []]


@pytest.mark.parametrize(
    ("which", "text", "told"),
    [
        ("slabs", "0.2", "--slab '0.2': the unit is missing"),
        ("slabs", "0.2 m, 19 mm", "--slab '19 mm': a slab is 20 mm to 3 m thick; got 0.019 m"),
        ("slabs", "3.1 m", "a slab is 20 mm to 3 m thick"),
        ("dampings", "100 %", "--damping '100 %': a ratio is above 0 and below 1"),
        ("dampings", "-2 %", "--damping '-2 %'"),
        ("isolators", "2 Hz / 10 % / 3", "--isolator '2 Hz / 10 % / 3'"),
        ("isolators", "0 Hz / 10 %", "--isolator '0 Hz / 10 %'"),
        ("isolators", "2 Hz / 1 Hz", "--isolator '2 Hz / 1 Hz'"),
        ("isolators", "2 Hz / 10 %, 2.0 Hz / 0.1", "stands there 2 times; once is enough"),
        ("vehicles", "car_bmw_320i, car_bmw_320i", "--vehicle: car bmw 320i stands there 2 times"),
    ],
)
def test_a_slip_is_told_with_its_option_and_place(which, text, told):
    """The part between commas that is wrong, and not the whole option."""
    asked = dict.fromkeys(("vehicles", "slabs", "dampings", "isolators"), "") | {which: text}
    with pytest.raises(InputError) as refused:
        command._levers(**asked)
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--workers", "1", "--scheduler", "tcp://h:1"), "give one of them"),
        (("--json", "--quiet"), "give one of them"),
        (("--speeds", ","), "--speeds ',': give speeds above 0"),
        (("--speeds", "0 km/h"), "give speeds above 0"),
        (("--roads", " , "), "give road classes, such as 'A, B'"),
        (("--roads", "a"), "must be one of A, B, C"),
        (("--out", "mine"), "mine"),
    ],
)
def test_mistakes_stop_the_command_before_any_work(monkeypatch, capsys, tmp_path, options, told):
    """Exit code 2, the reason on the error stream, and nothing new in the folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(GOOD)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("mine")
    before = sorted(tmp_path.rglob("*"))
    code, said = run_main(monkeypatch, capsys, "mitigate", "s.toml", *options)
    assert code == 2
    assert told in said.err
    assert "Traceback" not in said.err
    assert sorted(tmp_path.rglob("*")) == before
