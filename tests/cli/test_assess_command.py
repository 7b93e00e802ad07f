"""The command that assesses records: which folders, what is printed, and nothing by halves."""

import json

import numpy as np
import pytest

from studies import run_main
from trundle.cli import assess_command
from trundle.criteria import VC
from trundle.errors import InputError

T = np.arange(0.0, 20.0, 1.0 / 200.0)
TONE = np.sqrt(2.0) * np.sin(2.0 * np.pi * 10.0 * T)  # RMS 1


def write(path, rms, heading="time [s],z [um/s]"):
    """A steady tone of 10 Hz, the middle of a third octave, in um/s."""
    rows = "\n".join(f"{t:.4f},{1e6 * rms * v:.9g}" for t, v in zip(T, TONE, strict=True))
    path.write_text(f"{heading}\n{rows}\n", encoding="utf-8")


@pytest.fixture
def command(tmp_path, monkeypatch, capsys):
    """Return what runs 'assess' where two records of 30 and 5 um/s lie."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "loud.csv", 30e-6)
    write(tmp_path / "still.csv", 5e-6)

    def run(*arguments):
        return run_main(monkeypatch, capsys, "assess", *arguments)

    return run


def rows_of(text, title):
    """Cells of the rows of the table under a title."""
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if title in line)
    found = []
    for line in lines[start:]:
        if line.startswith("└"):
            break
        if line.startswith("│"):
            found.append([cell.strip() for cell in line.strip("│").split("│")])
    return found


def test_numbers_on_the_screen_are_those_of_the_tone(command, tmp_path):
    """30 um/s at 10 Hz: peak acceleration sqrt2 2 pi 10 30e-6 = 0.267 gal, crest 1.41, margins.

    VC-A allows 50 um/s, VC-C 12.5 um/s: 1.67 and 0.417. The name stands as it is, escaped on a page.
    """
    write(tmp_path / "loud.csv", 30e-6, heading="time [s],<b>größe</b> z [um/s]")
    code, said = command("loud.csv", "-c", "VC-A, VC-C")
    assert code == 0
    (levels,) = rows_of(said.out, "loud.csv: 20 s of velocity at 200 Hz")
    assert levels[0] == "<b>größe</b> z"
    peak, rms, crest = map(float, levels[1:4])
    assert peak == pytest.approx(np.sqrt(2.0) * 2.0 * np.pi * 10.0 * 30e-6 / 0.01, rel=0.02)
    assert rms == pytest.approx(30.0, rel=0.01)
    assert crest == pytest.approx(np.sqrt(2.0), rel=0.02)
    verdicts = rows_of(said.out, "Verdict, averaging max_1s; margin = limit / level")
    assert [(row[0], row[1], row[3], row[5]) for row in verdicts] == [
        ("<b>größe</b> z", "vertical", "pass", "10"),
        ("<b>größe</b> z", "vertical", "fail", "10"),
    ]
    assert [float(row[4]) for row in verdicts] == pytest.approx([50 / 30, 12.5 / 30], rel=0.02)
    assert said.out.splitlines()[-1].endswith("loud-results/report.html")
    page = (tmp_path / "loud-results" / "report.html").read_text("utf-8")
    assert "<b>größe" not in page
    assert "&lt;b&gt;größe&lt;/b&gt; z" in page


def test_several_records_have_a_folder_each_and_one_document(command, tmp_path):
    """In the order that they are named; exit code 3 if any of them is above what was asked for."""
    code, said = command("loud.csv", "still.csv", "--json", "-c", "VC-C", "--fail-on", "vc-c")
    assert code == 3
    found = json.loads(said.out)
    assert [one["source"] for one in found] == ["loud.csv", "still.csv"]
    assert [one["verdicts"][0]["verdict"] for one in found] == ["fail", "pass"]
    for one in found:
        assert (tmp_path / one["source"].replace(".csv", "-results") / "report.html").samefile(
            one["report"]
        )
    unmet = [line for line in said.err.splitlines() if line.startswith("not met: ")]
    assert len(unmet) == 1
    assert unmet[0].startswith("not met: loud.csv, z, VC-C: fail, margin 0.4")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("loud.csv", "nothing.csv"), "nothing.csv: no such file"),
        (("loud.csv", "bare.csv"), "bare.csv: channel 'z' has no unit"),
        (("loud.csv", "sub/loud.csv"), "two records would have one results folder"),
        (("loud.csv", "still.csv", "--out", "o"), "--out names the folder of one record"),
        (("loud.csv", "--out", "still.csv"), "still.csv"),
        (("loud.csv", "--out", "mine"), "mine"),
        (("loud.csv", "--out", "."), "must not be the current folder"),
        (("loud.csv", "-c", "VC-Z"), "no criterion 'VC-Z'"),
        (("loud.csv", "-c", "none.toml"), "none.toml: cannot be read"),
        (("loud.csv", "-c", "mine"), "no criterion 'mine'"),
        (("loud.csv", "-c", "VC-A", "--fail-on", "VC-C"), "there are VC-A"),
        (("loud.csv", "--averaging", "max_2s"), "--averaging"),
        (("loud.csv", "--shape", "round"), "--shape"),
        (("loud.csv", "--high-pass", "0.4"), "--high-pass '0.4': the unit is missing"),
        (("loud.csv", "--rate", "400"), "--rate '400': the unit is missing"),
        (("loud.csv", "--events", "inf"), "--events inf: must be a number"),
        (("loud.csv", "--events", "nan"), "--events"),
        (("loud.csv", "--channel", "x"), "no channel is 'x'; there are 1 'z' [um/s]"),
        (("loud.csv", "--simulation", "mine"), "mine: is no results folder of trundle"),
        (("loud.csv", "--simulation", "loud-results"), "would be replaced; choose another --out"),
        (("loud.csv", "--json", "--quiet"), "give one of them"),
    ],
)
def test_a_mistake_in_any_record_or_option_leaves_nothing_behind(
    command, tmp_path, arguments, told
):
    """Everything is read before the first folder is made: exit code 2 and no results of any."""
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("mine")
    (tmp_path / "sub").mkdir()
    write(tmp_path / "sub" / "loud.csv", 1e-6)
    write(tmp_path / "bare.csv", 1e-6, heading="time [s],z")
    before = sorted(tmp_path.rglob("*"))
    code, said = command(*arguments)
    assert code == 2
    assert told in said.err
    assert "Traceback" not in said.err
    assert sorted(tmp_path.rglob("*")) == before


def test_a_mistake_keeps_the_results_of_an_earlier_record(command, tmp_path):
    """In silence and with exit code 0; then the file is damaged, and what stood there stands."""
    code, said = command("still.csv", "-q", "-c", "VC-C", "--fail-on", "VC-C")
    assert (code, said.out) == (0, "")
    assert "not met" not in said.err
    folder = tmp_path / "still-results"
    kept = {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    (tmp_path / "still.csv").write_text("damaged")
    assert command("still.csv", "-q", "-c", "VC-C")[0] == 2
    assert {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()} == kept


def test_why_a_criterion_is_not_assessed_is_said_once(command, tmp_path):
    """200 Hz shows bands to 63 Hz or so: VC-C and VC-E ask for 80 Hz, and the reason is one."""
    write(tmp_path / "slow.csv", 1e-8)
    rows = (tmp_path / "slow.csv").read_text().splitlines()
    (tmp_path / "slow.csv").write_text("\n".join([rows[0], *rows[1::2]]))
    code, said = command("slow.csv", "-c", "VC-C,VC-E", "--fail-on", "VC-E")
    assert code == 3
    reasons = [x for x in said.out.splitlines() if x.startswith("not assessed: ")]
    assert len(reasons) == len(set(reasons)) >= 1
    assert any("80" in reason for reason in reasons)
    verdicts = rows_of(said.out, "Verdict, averaging")
    assert {row[3] for row in verdicts} == {"not assessed"}


def test_criteria_come_by_name_and_from_files_in_their_order(tmp_path):
    """Blanks and empty parts between commas are nothing; nothing at all is workshop to VC-E."""
    own = tmp_path / "own.csv"
    own.write_text("# quantity = band_rms_velocity\nfrequency [Hz],limit [um/s]\n1,10\n80,10\n")
    found = assess_command._curves(f"VC-C, ,{own},VC-A,")
    assert [one.name for one in found] == ["VC-C", "own", "VC-A"]
    np.testing.assert_allclose(found[1].limits, 10e-6)
    assert assess_command._curves(" , ") == VC
    with pytest.raises(InputError, match="no criterion"):
        assess_command._curves("VC-A VC-C")


def test_the_answer_stands_first_and_in_json(command):
    """30 um/s at 10 Hz meets VC-A (50) with 1.67 and exceeds VC-B (25): the first line says both."""
    code, said = command("loud.csv", "-c", "VC-A,VC-B,VC-C")
    assert code == 0
    first = said.out.splitlines()[0]
    assert first.startswith("channel z: VC-A is met with margin 1.6")
    assert "; governing 10 Hz; VC-B is exceeded (margin 0.83" in first
    assert "events of z: " in said.out
    _, said = command("loud.csv", "-c", "VC-A,VC-B,VC-C", "--json")
    (answer,) = json.loads(said.out)[0]["answers"]
    assert (answer["channel"], answer["class"], answer["verdict"]) == ("z", "VC-A", "pass")
    assert answer["margin"] == pytest.approx(50.0 / 30.0, rel=0.02)
    assert answer["sentence"] == first


def test_a_start_gives_days_and_nights_and_a_wrong_one_is_refused(command, tmp_path):
    """From 22:59:50, 20 s: 10 s of day and 10 s of night."""
    code, said = command("loud.csv", "-c", "VC-A", "--start", "2024-05-03 22:59:50", "--json")
    assert code == 0
    doses = json.loads(said.out)[0]["vibration_doses"]
    assert [d["period"][:5] for d in doses] == ["day, ", "night"]
    assert [3600.0 * d["measured_h"] for d in doses] == pytest.approx([10.0, 10.0])
    assert doses[0]["vdv"] == pytest.approx(doses[1]["vdv"], rel=0.05)
    code, said = command("loud.csv", "--start", "yesterday", "--out", "other")
    assert code == 2
    assert "--start 'yesterday': must be a local time" in said.err
    assert not (tmp_path / "other").exists()


def test_units_of_the_screen_are_those_asked_for(command):
    """0.267 gal are 0.272 mg, 30 um/s are 1.18 mil/s; JSON keeps the units that its names say."""
    code, said = command("loud.csv", "--velocity", "mil/s", "--acceleration", "mg")
    assert code == 0
    assert "um/s" not in said.out
    assert " gal" not in said.out
    assert "peak [mg]" in said.out
    (levels,) = rows_of(said.out, "loud.csv: 20 s of velocity at 200 Hz")
    peak, rms = map(float, levels[1:3])
    assert peak == pytest.approx(0.2666 / 0.980665, rel=0.02)
    assert rms == pytest.approx(30.0 / 25.4, rel=0.01)
    _, said = command("loud.csv", "--velocity", "mil/s", "--json")
    (found,) = json.loads(said.out)
    assert found["channels"][0]["rms_um_s"] == pytest.approx(30.0, rel=0.01)


def test_words_of_no_list_are_refused_together(command, tmp_path):
    """Two units and a rule: each with its option, what there is, and what may have been meant."""
    code, said = command(
        "loud.csv", "--velocity", "mils/s", "--acceleration", "g", "--averaging", "fastt"
    )
    assert code == 2
    told = " ".join(said.err.split())
    assert "--velocity must be one of in/s, m/s, mil/s, mm/s, um/s; got 'mils/s'" in told
    assert "(did you mean 'mil/s'?)" in told
    assert "--acceleration must be one of gal, in/s2, m/s2, mg, mm/s2; got 'g'" in told
    assert "(did you mean 'fast'?)" in told
    assert not (tmp_path / "loud-results").exists()
