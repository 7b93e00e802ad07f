"""The command that walks on a study's floor: its table, maps and messages."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from studies import BUILDING, GOOD, run_main
from trundle.footfall import footfall_load
from trundle.run.footfall import FootfallAsked, study_footfall
from trundle.signals import weighting_response
from trundle.simulate import footfall_floor, prepare
from trundle.structure import Spots
from trundle.study_file import study_from_text

STUDY = Path(__file__).parents[2] / "scripts" / "small_study.toml"


def rows_of(folder):
    with (folder / "footfall.csv").open(encoding="utf-8") as opened:
        return list(csv.DictReader(opened))


def test_table_and_maps_of_every_storey(monkeypatch, capsys, tmp_path):
    """Two storeys: a row a place, none in the opening, a picture each, the worst on the screen."""
    study = tmp_path / "lab.toml"
    study.write_text(BUILDING)
    out = tmp_path / "out"
    code, said = run_main(
        monkeypatch, capsys, "footfall", study, "--spacing", "2 m", "--pace", "1.8", "2.0",
        "--length", "9 m", "--passages", "300", "--duration", "10 s", "--out", out,
    )  # fmt: skip
    assert code == 0
    names = {f.name for f in out.iterdir()}
    for number in (1, 2):
        assert {f"footfall_map_{number}.png", f"footfall_map_{number}.svg"} <= names
        picture = (out / f"footfall_map_{number}.png").read_bytes()
        assert picture[:4] == b"\x89PNG"
        assert len(picture) > 5000
    rows = rows_of(out)
    per_storey = {name: [r for r in rows if r["surface"] == name] for name in ("deck", "lab")}
    assert (len(per_storey["deck"]), len(per_storey["lab"])) == (23, 24)  # one is in the opening
    levels = np.array([float(r["response_factor"]) for r in rows])
    larger = [max(float(r["steady_state"]), float(r["transient"])) for r in rows]
    np.testing.assert_allclose(levels, larger, rtol=1e-9)
    doses = np.array([float(r["vdv_m_s1.75"]) for r in rows])
    np.testing.assert_allclose(doses, 0.68 * 0.005 * levels * 3000.0**0.25, rtol=1e-4)
    assert all(1.8 <= float(r["pace_hz"]) <= 2.0 for r in rows)
    kept = json.loads((out / "footfall.json").read_text())
    assert kept["walked_length_m"] == 9.0
    for worst in kept["worst"]:
        here = [float(r["response_factor"]) for r in per_storey[worst["surface"]]]
        assert worst["response_factor"] == max(here)
        assert f"{max(here):.3g}" in said.out
    assert f"worst: {levels.max():.3g} at" in said.out


def test_a_place_by_its_mode_alone():
    """Modes, places, damping and weights come together rightly: one harmonic on one mode by hand.

    In the middle of the two bays, of modes below 18 Hz only that at 10.2 Hz moves. At the pace that
    puts the fourth harmonic on it, it gives ``phi^2 alpha_4 Q W / (2 sqrt2 zeta)`` over 0.005 (unit
    modal mass); a tenth covers the other harmonics and modes.
    """
    study = study_from_text(GOOD)
    method = study.methods[0].interaction
    prepared = prepare(study.floor, method.integration, method.damping)
    seen = footfall_floor(prepared, Spots(xy=np.array([[6.0, 1.5]])))
    mode = int(np.argmax(np.where(seen.frequencies < 18.0, np.abs(seen.felt[0]), 0.0)))
    f = seen.frequencies[mode]
    asked = FootfallAsked(paces=(f / 4.0, f / 4.0), spacing=4.0, everywhere=False)
    found = study_footfall(study, asked)
    i = [found.where(k)[:2] for k in range(6)].index((6.0, 1.5))
    steady = found.response.steady
    force = footfall_load("p354").amplitudes(f / 4.0)[3]
    weight = abs(weighting_response("Wb", np.array([f])))[0]
    wanted = seen.felt[0, mode] ** 2 * force * weight / (2.0 * np.sqrt(2.0) * 0.03) / 0.005
    assert steady.level[i] == pytest.approx(wanted, rel=0.1)
    assert (steady.harmonic[i], steady.mode[i]) == (4, mode)


def test_dg11_as_json(monkeypatch, capsys, tmp_path):
    """A peak acceleration, and no dose."""
    out = tmp_path / "out"
    code, said = run_main(
        monkeypatch, capsys, "footfall", STUDY, "--guide", "dg11", "--spacing", "3 m",
        "--excitation", "self", "--json", "--out", out,
    )  # fmt: skip
    assert code == 0
    found = json.loads(said.out)
    assert (found["quantity"], found["excitation"]) == ("peak_acceleration", "self")
    worst = found["worst"][0]
    assert (worst["x_m"], worst["y_m"]) == (worst["walker_x_m"], worst["walker_y_m"])
    levels = [float(r["peak_acceleration_m_s2"]) for r in rows_of(out)]
    assert worst["peak_acceleration_m_s2"] == max(levels)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--guide", "p345"], "--guide 'p345': must be one of"),
        (["--pace", "2.2", "1.8"], "--pace 2.2 1.8: lowest and highest pace"),
        (["--spacing", "1 kg"], "--spacing '1 kg': unit 'kg'"),
        (["--spacing", "1 mm"], "use a larger one, or --excitation self"),
        (["--method", "x"], "with modes: 'coupled'"),
        (["--excitation", "some"], "--excitation 'some': must be self"),
        (["--length", "-1 m"], "must be greater than 0"),
        (["--passages", "3"], "--passages and --duration go together"),
        (["--passages", "-3", "--duration", "1 s"], "--passages -3: must be greater than 0"),
        (["--guide", "dg11", "--passages", "3", "--duration", "1 s"], "has no dose"),
    ],
)
def test_mistakes_are_told_before_work(monkeypatch, capsys, tmp_path, options, words):
    """Exit code 2, the option named, nothing written."""
    out = tmp_path / "out"
    code, said = run_main(monkeypatch, capsys, "footfall", STUDY, *options, "--out", out)
    assert code == 2
    assert words in said.err
    assert not out.exists()


def test_other_results_are_not_replaced(monkeypatch, capsys, tmp_path):
    """A folder that something else stands in is left as it is."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("mine")
    code, said = run_main(
        monkeypatch, capsys, "footfall", STUDY, "--spacing", "3 m", "--out", tmp_path / "out"
    )
    assert code == 2
    assert "out" in said.err
    assert [f.name for f in (tmp_path / "out").iterdir()] == ["mine.txt"]
