"""What a command says: tables, JSON for programs, or nothing; and nothing that steers a terminal."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

STUDY = Path(__file__).parents[2] / "scripts" / "small_study.toml"


def trundle(*arguments, cwd):
    done = subprocess.run(
        [sys.executable, "-m", "trundle", *map(str, arguments)],
        check=False, capture_output=True, text=True, cwd=cwd,
        env={**os.environ, "TRUNDLE_CACHE": ""},
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def record(tmp_path):
    t = np.arange(4000) / 200.0
    path = tmp_path / "r.csv"
    table = np.column_stack([t, 1e-3 * np.sin(60.0 * t)])
    np.savetxt(path, table, delimiter=",", header="time [s],z [m/s2]", comments="")
    return path


@pytest.mark.parametrize("command", ["check", "modes", "criteria", "vehicles"])
def test_lists_and_checks_as_json(tmp_path, command):
    code, out, err = trundle(command, *([STUDY] if command in {"check", "modes"} else []),
                             "--json", cwd=tmp_path)  # fmt: skip
    assert (code, err) == (0, "")
    said = json.loads(out)
    if command == "check":
        assert said["mistakes"] == []
        assert said["estimated_time_s"] > 0.0
    else:
        assert len(said) > 2


def test_mistakes_as_json_come_with_place_and_line(tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text(STUDY.read_text().replace("runs = 2", "runs = -2").replace("15 km/h", "15 kg"))
    code, out, err = trundle("check", bad, "--json", cwd=tmp_path)
    assert code == 2
    assert "2 mistakes" in err
    found = [(m["place"], m["line"]) for m in json.loads(out)["mistakes"]]
    rows = bad.read_text().splitlines()
    assert found == [
        ("runs", rows.index("runs = -2") + 1),
        ("route[1].speed", rows.index('speed = "15 kg"') + 1),
    ]


@pytest.mark.longest
def test_a_run_as_json_and_in_silence(tmp_path):
    code, out, err = trundle("run", STUDY, "-o", "one", "--json", cwd=tmp_path)
    assert code == 0, err
    said = json.loads(out)
    assert Path(said["report"]).is_file()
    kept = json.loads((tmp_path / "one" / "summary.json").read_text())
    assert {**kept, "report": said["report"]} == said
    code, out, err = trundle("run", STUDY, "-o", "two", "--quiet", cwd=tmp_path)
    assert (code, out) == (0, "")
    assert all(line.startswith("warning: ") for line in err.splitlines())
    assert trundle("run", STUDY, "-q", "--json", cwd=tmp_path)[0] == 2


def test_a_record_as_json_and_in_silence(tmp_path, record):
    code, out, err = trundle("assess", record, "--json", "--fail-on", "VC-E", cwd=tmp_path)
    assert code in {0, 3}, err
    (said,) = json.loads(out)
    assert said["source"] == "r.csv"
    assert {v["criterion"] for v in said["verdicts"]} >= {"VC-A", "VC-E"}
    code, out, err = trundle("assess", record, "--quiet", cwd=tmp_path)
    assert (code, out) == (0, "")


def test_names_of_files_do_not_steer_the_terminal(tmp_path, record):
    hostile = tmp_path / "\x1b[31mr\x07.csv"
    os.rename(record, hostile)
    code, out, err = trundle("assess", hostile, "--out", "o", cwd=tmp_path)
    assert code == 0
    assert "?[31mr?.csv" in out
    code, more, err = trundle("assess", hostile.with_name("\x1b[2J.csv"), cwd=tmp_path)
    assert code == 2
    assert "\x1b" not in out + more + err


def test_a_record_without_motion_is_not_assessed_and_says_why(tmp_path, record):
    """A level of 1e-17 m/s is below every limit, and no sensor's."""
    t = np.arange(4000) / 200.0
    table = np.column_stack([t, 1e-15 * np.sin(60.0 * t)])
    np.savetxt(record, table, delimiter=",", header="time [s],z [m/s2]", comments="")
    code, out, _ = trundle("assess", record, "--criteria", "VC-E", cwd=tmp_path)
    assert code == 0
    assert "not assessed: nothing moves there" in out
    assert " pass " not in out


def test_numbers_of_figures_that_are_not_there_are_named(tmp_path):
    """A slip in a figure's name; the right one stands in the report."""
    (tmp_path / "study.toml").write_text(
        STUDY.read_text() + '\n[publication.numbers]\nplan = "Figure 8"\nsektion = "Figure 9"\n'
    )
    code, out, _ = trundle("run", "study.toml", "--out", "out", cwd=tmp_path)
    assert code == 0
    assert "publication.numbers.sektion: no figure or table" in out
    assert "numbers.plan" not in out
    page = (tmp_path / "out" / "report.html").read_text()
    assert "(Figure 8)" in page
    assert "Figure 9" not in page.partition("<h3>Study file</h3>")[0]
