"""The commands that show something: a study looked over, a new one, modes and criteria."""

import json

import numpy as np
import pytest

from studies import GOOD, run_main
from trundle.cli import commands
from trundle.cli.commands import _known
from trundle.criteria import all_criteria, find_criterion
from trundle.study_file import study_from_text
from trundle.study_file.build import load_study
from trundle.views.words import limit_words


@pytest.fixture
def command(tmp_path, monkeypatch, capsys):
    """Return what runs a command in a folder of its own that holds a study."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments, text=GOOD):
        (tmp_path / "s.toml").write_text(text, encoding="utf-8")
        return run_main(monkeypatch, capsys, *arguments)

    return run


def test_a_study_looked_over_says_what_would_be_run(command):
    """1 case, 2 roads, 1 method: 2 cells of 2 runs, of 4 s; the floor's mass to a tonne."""
    text = GOOD.replace('class = "B"', 'class = "B"\n\n[[road]]\nclass = "D"')
    text = text.replace('title = "Small"', 'title = "Größe <b>"')
    code, said = command("check", "s.toml", text=text)
    assert code == 0
    lines = said.out.splitlines()
    assert lines[0] == "s.toml: no mistakes"
    assert "Größe <b>" in lines
    study = study_from_text(text)
    assert "work:  2 cells of 2 runs, records of up to 4 s" in lines
    assert f"{study.floor.moving_mass() / 1e3:.0f} t moving vertically" in said.out
    assert f"{len(study.floor.nodes)} nodes, {study.floor.n_dofs} degrees of freedom" in said.out
    assert any(
        "it leaves at" in line for line in lines if line.startswith("warning: duration, main")
    )
    assert said.err == ""


def test_what_programs_read_of_a_study_is_the_same(command):
    """Cells, runs, length and mass as a study's own numbers; doubts as on the screen."""
    code, said = command("check", "s.toml", "--json")
    assert code == 0
    found = json.loads(said.out)
    study = study_from_text(GOOD)
    assert (found["cells"], found["runs"], found["longest_record_s"]) == (1, 2, 4.0)
    assert found["moving_mass_kg"] == pytest.approx(study.floor.moving_mass())
    assert found["mistakes"] == []
    assert found["too_much"] == ""
    _, screen = command("check", "s.toml")
    told = [
        line.removeprefix("warning: ") for line in screen.out.splitlines() if "warning: " in line
    ]
    assert sorted(found["warnings"]) == sorted(told)
    assert len(told) == 2  # a coarse mesh, and a record that ends early


def test_mistakes_come_all_at_once_with_line_and_remedy(command):
    """Three slips in one file are three mistakes, on the lines where they stand."""
    text = (
        GOOD.replace("runs = 2", "runs = 0").replace('"4 s"', '"4 kg"').replace('"3 %"', '"300 %"')
    )
    code, said = command("check", "s.toml", text=text)
    assert code == 2
    assert said.out == ""
    assert said.err.startswith("error: s.toml: 3 mistakes\n")
    rows = text.splitlines()
    for row in ("runs = 0", 'duration = "4 kg"', 'damping = { ratio = "300 %" }'):
        assert f"line {rows.index(row) + 1}, " in said.err
    assert said.err.count("remedy:") == 3


def test_work_that_is_long_is_told_and_is_no_mistake(command, monkeypatch):
    """Looking it over costs nothing: exit code 0, and the word that 'run' will ask for."""
    monkeypatch.setattr(commands, "what_is_dear", lambda _: "it would take a week")
    code, said = command("check", "s.toml")
    assert code == 0
    assert "warning: it would take a week; 'trundle run' asks for --yes" in said.out
    _, said = command("check", "s.toml", "--json")
    assert json.loads(said.out)["too_much"] == "it would take a week"


def test_meshes_and_json_do_not_go_together(command):
    """One prints tables and the other a document: refused before any work."""
    code, said = command("check", "s.toml", "--mesh", "--json")
    assert code == 2
    assert "give one of them" in json.loads(said.out)["error"]


def test_a_new_study_is_one_that_passes_and_replaces_nothing(command, tmp_path):
    """The template is sound; what stands there is kept to the last byte."""
    code, said = command("new", "Größe.toml")
    assert code == 0
    assert said.out == "Größe.toml: written; next: trundle check Größe.toml\n"
    assert load_study(tmp_path / "Größe.toml").title
    before = (tmp_path / "s.toml").read_bytes()
    for place, told in (
        ("s.toml", "s.toml: this file exists; choose another name"),
        (".", "this file exists"),
        ("nowhere/s.toml", f"there is no folder {tmp_path / 'nowhere'}; make it first"),
    ):
        code, said = command("new", place)
        assert code == 2
        assert told in said.err
    assert (tmp_path / "s.toml").read_bytes() == before
    assert {file.name for file in tmp_path.iterdir()} == {"s.toml", "Größe.toml"}


@pytest.mark.parametrize(
    ("f_max", "told"),
    [
        ("10", "--f-max '10': the unit is missing"),
        ("0 Hz", "--f-max '0 Hz': must be greater than 0"),
        ("-1 Hz", "must be greater than 0, and at most 2000 Hz"),
        ("2001 Hz", "at most 2000 Hz"),
        ("nan Hz", "--f-max 'nan Hz'"),
        ("10 m", "--f-max '10 m'"),
    ],
)
def test_a_highest_frequency_that_is_none_is_refused_with_its_option(command, f_max, told):
    """No modes are looked for below nought, without a unit, or without an end."""
    code, said = command("modes", "s.toml", "--f-max", f_max)
    assert code == 2
    assert told in said.err
    assert said.out == ""


def test_modes_are_those_of_the_floor_in_hertz_and_tonnes(command):
    """The floor's own modes: frequencies to a mHz, vertical effective masses as sums say.

    Masses of all modes below a limit are at most what moves; 0.02 kHz is 20 Hz.
    """
    code, said = command("modes", "s.toml", "--f-max", "0.02 kHz", "--json")
    assert code == 0
    rows = json.loads(said.out)
    floor = study_from_text(GOOD).floor
    modes = floor.modes(20.0)
    np.testing.assert_allclose([r["frequency_hz"] for r in rows], modes.frequencies, rtol=1e-9)
    masses = np.array([r["vertical_effective_mass_kg"] for r in rows])
    assert np.all(masses >= 0.0)
    assert masses.sum() <= floor.moving_mass()
    assert masses.sum() > 0.3 * floor.moving_mass()
    code, said = command("modes", "s.toml", "--f-max", "20 Hz")
    assert f"{len(rows)} modes below 20 Hz" in said.out
    first = next(line for line in said.out.splitlines() if line.startswith("│ 1 "))
    cells = [cell.strip() for cell in first.strip("│").split("│")]
    assert cells[1] == f"{modes.frequencies[0]:.3f}"
    assert cells[2] == f"{masses[0] / 1e3:.1f}"
    assert "Sylvester's law of inertia: none is missing" in said.out


def test_what_is_not_known_is_a_dash():
    """A mass that a given model does not say is no nought."""
    assert _known(float("nan"), ".1f") == "-"
    assert _known(0.04, ".1f") == "0.0"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("VC-A", "100 um/s at 4 Hz, 50 um/s at 8 Hz, 50 um/s at 80 Hz"),
        ("DG11-200", "200 um/s at 4 Hz, 200 um/s at 80 Hz"),
        ("R-office", "4"),
    ],
)
def test_limits_are_printed_in_the_units_of_people(name, text):
    """VC-A is 50 um/s from 8 Hz (Gordon 1991); DG11's name is its limit in um/s; offices have R = 4."""
    assert limit_words(find_criterion(name)) == text


def test_criteria_for_programs_are_in_si_with_source_and_confidence(command):
    """VC-A's limit from 8 Hz is 50e-6 m/s; each has its source, and none its limit in um/s."""
    code, said = command("criteria", "--json")
    assert code == 0
    found = {one["name"]: one for one in json.loads(said.out)}
    assert len(found) == len(all_criteria())
    curve = found["VC-A"]
    at = curve["frequencies_hz"].index(8.0)
    assert curve["limits_si"][at] == pytest.approx(50e-6)
    for one in found.values():
        assert one["source"], one["name"]
        assert one["confidence"], one["name"]
        assert len(one["frequencies_hz"]) == len(one["limits_si"])
