"""A study from file to results folder: what is in it, that it repeats, that it is never half."""

import csv
import html
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from studies import GOOD
from trundle.report import write_report
from trundle.results.cells import CellKey
from trundle.results.owned import record_owned
from trundle.results.results_folder import check_target, new_results_folder, uninterrupted
from trundle.results.store import write_results
from trundle.results.study_result import positions_at
from trundle.run.whole_study import run_study
from trundle.study_file.build import load_study
from trundle.views.printed import bound_rows, comparison_rows

EXTRA = """
[[route]]
name = "<b>cross & $1$"
vehicle = "truck"
path = [["6 m", "0 m"], ["6 m", "6 m"]]
speed = "10 km/h"

[[traffic]]
name = "both"
routes = ["main", "<b>cross & $1$"]

[[printed]]
case = "main"
road = "B"
method = "coupled"
peak_acceleration = "1 gal"
rms_velocity = "10 um/s"

[[printed_bound]]
bound = "absolute maximum"
road = "B"
method = "coupled"
peak_acceleration = "1 gal"
rms_velocity = "10 um/s"

[[note]]
title = "A note with <script>alert(1)</script>"
text = "Escaped & shown"
"""

pytestmark = pytest.mark.filterwarnings("ignore:.*Consolidated metadata.*")


@pytest.fixture(scope="module")
def study_path(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.toml"
    path.write_text(GOOD.replace('"4 s"', '"6 s"') + EXTRA)
    return path


@pytest.fixture(scope="module")
def result(study_path):
    return run_study(load_study(study_path))


@pytest.fixture(scope="module")
def folder(result, tmp_path_factory):
    place = tmp_path_factory.mktemp("out") / "results"
    with new_results_folder(place) as aside:
        write_results(result, aside)
        write_report(result, aside)
    return place


def test_the_folder_holds_what_is_promised(folder):
    names = {entry.name for entry in folder.iterdir()}
    assert names == {
        ".trundle-results", "figures", "kept", "report.html", "results.zarr", "study.toml", "summary.csv",
        "summary.json", "together.csv", "verdicts.csv",
    }  # fmt: skip
    figures = {entry.name for entry in (folder / "figures").iterdir()}
    assert {"plan.png", "plan.svg", "mesh.png", "modes.png", "comparison.png"} <= figures
    assert [entry.name for entry in folder.parent.iterdir()] == ["results"]


def test_the_store_holds_the_numbers_with_units_and_provenance(folder, result):
    tree = xr.open_datatree(folder / "results.zarr", engine="zarr")
    assert tree["peak_acceleration"].dims == ("case", "road", "method_name", "run", "point")
    assert tree["peak_acceleration"].attrs["units"] == "m/s2"
    assert tree["band_velocity"].sizes["band"] == 20
    for key in ("version", "study_hash", "floor_hash", "seed", "study_text"):
        assert key in tree.attrs
    cell = result.cells[CellKey("both", "B", "coupled")]
    stored = tree["rms_velocity"].sel(case="both", road="B", method_name="coupled").to_numpy()
    assert np.array_equal(stored, cell.rms_velocity)
    history = tree["histories/coupled"]["acceleration"]
    assert history.dims == ("case", "road", "time", "point")
    assert np.array_equal(
        history.sel(case="main", road="B").to_numpy(),
        result.cells[CellKey("main", "B", "coupled")].history.acceleration,
    )
    forces = tree["contacts/both"]["peak_contact_force"]
    assert forces.attrs["units"] == "N"
    assert forces.sizes["contact"] == 6
    history = tree["contacts/both/coupled"]["contact_force"]
    assert history.dims == ("road", "time", "contact")
    assert np.array_equal(history.sel(road="B").to_numpy(), cell.history.contact_forces)


def test_the_summaries_agree_with_the_store(folder, result):
    rows = list(csv.DictReader((folder / "summary.csv").read_text().splitlines()))
    assert len(rows) == len(result.cells)
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["provenance"]["seed"] == 1
    first = rows[0]
    cell = result.cells[CellKey(first["case"], first["road"], first["method"])]
    assert float(first["peak_acceleration_p50_m_s2"]) == pytest.approx(
        np.median(cell.peak_acceleration[:, 0])
    )
    assert {v["verdict"] for v in summary["verdicts"]} <= {"pass", "fail", "not assessed"}


def test_the_report_is_self_contained_and_escaped(folder, result):
    """No address to fetch, no markup from the study, every warning, every picture inline."""
    page = (folder / "report.html").read_text()
    assert not re.search(r'(src|href)="https?:', page)
    assert "<script>alert" not in page  # scripts are the page's own
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in page
    assert "<b>cross" not in page
    assert page.count("data:image/png;base64,") == len(list((folder / "figures").glob("*.png")))
    for found in result.warnings().values():
        for warning in found:
            assert html.escape(warning.subject) in page
    assert 'alt="Plan' in page


def test_modal_results_below_30_hz_do_not_pass_to_80_hz(result):
    verdict = result.verdicts[CellKey("main", "B", "coupled")][0]
    assert verdict.status in {"fail", "not assessed"}
    assert 31.5 in verdict.unresolved


def test_printed_values_stand_beside_ours(result):
    row = comparison_rows(result)[0]
    cell = result.cells[CellKey("main", "B", "coupled")]
    assert row.printed_peak == pytest.approx(1.0)
    assert row.peak[1] == pytest.approx(100 * np.median(cell.peak_acceleration))
    bound = bound_rows(result)[0]
    singles = [
        np.median(result.cells[CellKey(case, "B", "coupled")].peak_acceleration) * 100
        for case in ("main", "<b>cross & $1$")
    ]
    assert bound.peak == pytest.approx(sum(singles))


def test_a_second_run_gives_the_same_bits(study_path, result):
    again = run_study(load_study(study_path))
    for key, cell in result.cells.items():
        assert np.array_equal(cell.peak_acceleration, again.cells[key].peak_acceleration)
        assert np.array_equal(cell.history.velocity, again.cells[key].history.velocity)


def test_results_replace_results_but_nothing_else(tmp_path, result):
    place = tmp_path / "out"
    for _ in range(2):
        check_target(place)
        with new_results_folder(place) as aside:
            write_results(result, aside)
    (place / "my_notes.txt").write_text("keep me")
    from trundle.errors import InputError

    with pytest.raises(InputError, match=r"my_notes\.txt"):
        check_target(place)


def test_a_failure_leaves_what_was_there(tmp_path):
    place = tmp_path / "deep" / "out"
    with pytest.raises(RuntimeError), new_results_folder(place) as aside:
        (aside / "half").write_text("half")
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_waits_for_the_end_of_a_write():
    steps = []
    with pytest.raises(KeyboardInterrupt), uninterrupted():
        os.kill(os.getpid(), signal.SIGINT)
        steps.append("written")
    assert steps == ["written"]


HEARING = (
    "import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); "
    "os.execv(sys.executable, [sys.executable, *sys.argv[1:]])"
)
"""Starts Python with Ctrl-C heard: shells have what runs in the background ignore it."""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("stage", ["coupled", "writing results", "figure"])
def test_an_interrupted_run_leaves_no_half_results(tmp_path, number, stage):
    """Ctrl-C in the runs, while writing, while drawing: exit 130, the folder as it was."""
    study = tmp_path / "study.toml"
    study.write_text(GOOD)
    out = tmp_path / "out"
    out.mkdir()
    (out / "summary.json").write_text("{}")
    record_owned(out, "study")
    process = subprocess.Popen(
        [sys.executable, "-c", HEARING, "-m", "trundle", "run", str(study), "--out", str(out)],
        stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=tmp_path,
    )  # fmt: skip
    assert process.stderr is not None
    for line in process.stderr:
        if stage in line:
            time.sleep(0.02)
            process.send_signal(number)
            break
    _, error = process.communicate(timeout=120)
    assert process.returncode == 130, error
    assert "interrupted" in error
    left = {entry.name for entry in tmp_path.iterdir()} - {"out.unfinished"}
    assert left == {"out", "study.toml"}
    assert sorted(entry.name for entry in out.iterdir()) == [".trundle-results", "summary.json"]


def test_the_papers_study_is_sound():
    study = load_study(Path(__file__).parents[2] / "examples" / "paper" / "study.toml")
    names = [case.name for case in study.cases]
    assert names[:4] == ["aerial", "front", "side", "rear"]
    assert names[4:] == ["rear, 6 axles", "all four"]
    assert set(study.points) == {"centre", "bay"}
    assert study.runs >= 50
    assert len(study.printed) == 16
    assert len(study.printed_bounds) == 10


def test_the_vehicle_stands_where_its_speed_has_brought_it(tmp_path):
    """15 km/h from the entry: at the time of the largest level, metres along the route."""
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    result = run_study(load_study(path))
    ((key, (verdict,)),) = result.verdicts.items()
    place = positions_at(result, key, 1.8)["main"]
    assert place == pytest.approx([15 / 3.6 * 1.8, 3.0])
    assert positions_at(result, key, 100.0) == {"main": None}
    assert positions_at(result, key, float("nan")) == {}
    assert 0.0 < verdict.time < 4.0
