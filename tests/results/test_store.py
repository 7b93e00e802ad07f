"""Tables and summary of a results folder: names, units, what is not known, what a sheet would run."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from made_results import (
    POINTS,
    SECOND,
    cell,
    curve,
    levels,
    made_result,
    made_study,
    verdict,
    with_assessment,
)
from trundle.results.cells import CellKey
from trundle.results.store import csv_rows, write_results
from trundle.simulate import TruncationChange

SOUTH = "=Zufahrt, Süd"
KEY = CellKey(SOUTH, "B", "coupled")
CAGE = list(POINTS)[1]


def some_verdicts():
    """Verdicts at two points on one cell: pass, fail, not assessed, and a fail of which more is unknown."""
    narrow = curve("Kurve, schmal", limits=np.array([1e-5, 1e-5]))
    return {
        KEY: (
            verdict(time=1.0),
            verdict(narrow, status="fail", margin=0.2, interval=(0.0, np.inf), time=np.nan,
                    share_exceeding=2 / 3, point=CAGE, axis="vertical"),
            verdict(narrow, status="not assessed", margin=np.nan, interval=(np.nan, np.nan),
                    governing_band=np.nan, value=np.nan, limit=np.nan, share_exceeding=np.nan,
                    time=np.nan, unresolved=(63.0, 80.0), unexcited=(50.0,),
                    reasons=("zu kurz; wirklich", "=1+1"), point=CAGE),
            verdict(status="fail", margin=0.5, reasons=("the record ends",)),
        )
    }  # fmt: skip


@pytest.fixture(scope="module")
def study():
    return with_assessment(made_study(SECOND), [curve()])


@pytest.fixture(scope="module")
def result(study):
    made = made_result(study)
    reduced = levels(
        peak_acceleration=np.array([[0.01, 1.0], [0.02, 2.0], [0.03, 3.0]]),
        rms_velocity=np.array([[1e-5, 1.0], [2e-5, 2.0], [6e-5, 6.0]]),
    )
    change = TruncationChange(
        f_max=15.0, velocity=np.array([0.1, 0.2]), acceleration=np.array([0.3, 0.4])
    )
    cells = {**made.cells, KEY: cell(KEY, reduced=reduced, truncation=change)}
    return replace(made, cells=cells, verdicts=some_verdicts())


@pytest.fixture(scope="module")
def out(result, tmp_path_factory):
    folder = tmp_path_factory.mktemp("out")
    write_results(result, folder)
    return folder


def table(out, name):
    with (out / name).open(newline="", encoding="utf-8") as opened:
        return list(csv.DictReader(opened))


def test_percentiles_are_those_of_the_runs_in_si(result):
    """By hand: of 1, 2 and 3 gal 5 % lie at 1.1, half at 2, 95 % at 2.9 gal, here in m/s2."""
    row = next(r for r in csv_rows(result) if (r["case"], r["point"]) == (SOUTH, "tool"))
    assert row["runs"] == 3
    shares = [row[f"peak_acceleration_p{n}_m_s2"] for n in ("05", "50", "95")]
    assert shares == pytest.approx([0.011, 0.02, 0.029])
    shares = [row[f"rms_velocity_p{n}_m_s"] for n in ("05", "50", "95")]
    assert shares == pytest.approx([1.1e-5, 2e-5, 5.6e-5])


def test_three_runs_bound_no_high_percentile(result):
    """0.95^3 is far above 2.5 %: the upper end of the 95 % level is open, and said to be."""
    row = next(csv_rows(result))
    assert row["peak_acceleration_p95_high_m_s2"] == np.inf


def test_each_point_has_its_own_row_and_numbers(result):
    """The second point moves a hundred times as much, and its row says so; cells in their order."""
    rows = list(csv_rows(result))
    assert [r["point"] for r in rows] == list(POINTS) * 6
    assert [r["case"] for r in rows[::4]] == ["main", SOUTH, "both"]
    both = {r["point"]: r for r in rows if (r["case"], r["road"]) == (SOUTH, "B")}
    assert both[CAGE]["peak_acceleration_p50_m_s2"] == pytest.approx(2.0)
    assert both["tool"]["truncation_change_velocity"] == 0.1
    assert both[CAGE]["truncation_change_acceleration"] == 0.4
    other = next(r for r in rows if r["case"] == "main")
    assert np.isnan(other["truncation_change_velocity"])


def test_the_table_of_summaries_is_what_the_rows_say(result, out):
    """Read back from the file, number by number, in the same columns; names are not run by a sheet."""
    rows, read = list(csv_rows(result)), table(out, "summary.csv")
    assert list(read[0]) == list(rows[0])
    for row, one in zip(rows, read, strict=True):
        assert one["case"] == (f"'{SOUTH}" if row["case"] == SOUTH else row["case"])
        assert one["point"] == row["point"]
        for name in list(row)[5:]:
            np.testing.assert_equal(float(one[name]), row[name])


def test_verdicts_stand_in_the_table_with_what_they_are_of(out):
    """Status, margin, limits and places by hand; what is not known is no number that compares."""
    passed, failed, unknown, doubtful = table(out, "verdicts.csv")
    assert [v["verdict"] for v in (passed, failed, unknown)] == ["pass", "fail", "not assessed"]
    assert (passed["margin"], passed["limit_si"], passed["value_si"]) == ("2.0", "0.0001", "5e-05")
    assert (passed["margin_low"], passed["margin_high"]) == ("1.5", "2.5")
    assert float(passed["governing_band_hz"]) == pytest.approx(10**0.9)
    assert (failed["point"], failed["criterion"]) == (CAGE, "Kurve, schmal")
    assert (failed["margin"], failed["margin_high"]) == ("0.2", "inf")
    assert float(failed["share_exceeding"]) == pytest.approx(2 / 3)
    for name in ("margin", "margin_low", "value_si", "limit_si", "share_exceeding", "time_s"):
        assert np.isnan(float(unknown[name])), name
    assert unknown["unresolved_bands_hz"] == "63.0; 80.0"
    assert unknown["unexcited_bands_hz"] == "50.0"
    assert unknown["reasons"] == "zu kurz; wirklich; =1+1"
    # a failure stands, whatever more is unknown: reasons would read as an excuse
    assert (doubtful["verdict"], doubtful["reasons"]) == ("fail", "")
    assert "front_axles_m" not in passed


def test_json_has_null_for_what_is_not_known_and_names_as_they_are(out, result):
    """Strict JSON: no NaN, no Infinity; and the same verdicts as the table, lists as lists."""
    text = (out / "summary.json").read_text("utf-8")

    def refuse(word):
        raise AssertionError(word)

    found = json.loads(text, parse_constant=refuse)
    passed, failed, unknown, doubtful = found["verdicts"]
    assert (passed["case"], failed["point"]) == (SOUTH, CAGE)
    assert failed["margin_high"] is None
    assert [unknown[n] for n in ("margin", "value_si", "time_s")] == [None] * 3
    assert unknown["unresolved_bands_hz"] == [63.0, 80.0]
    assert unknown["reasons"] == ["zu kurz; wirklich", "=1+1"]
    assert doubtful["reasons"] == []
    assert len(found["cells"]) == 12
    assert set(found["warnings"]) == {"coupled"}
    assert [str(w) for w in result.warnings()["coupled"]] == found["warnings"]["coupled"]


def test_front_axles_stand_where_speed_has_brought_them(out):
    """36 km/h for 1 s from x = 12 m towards 0 along y = 2 m: at 2 m; nowhere without a time."""
    passed, failed, *_ = json.loads((out / "summary.json").read_text("utf-8"))["verdicts"]
    ((name, place),) = passed["front_axles_m"].items()
    assert name == SOUTH
    assert place == pytest.approx([2.0, 2.0])
    assert failed["front_axles_m"] == {}


def test_tables_of_what_there_is_not_are_not_written(result, tmp_path):
    """Without verdicts and days there are no files of them that look like an empty answer."""
    write_results(replace(result, verdicts={}), tmp_path)
    names = {p.name for p in tmp_path.iterdir()}
    assert names == {"kept", "results.zarr", "study.toml", "summary.csv", "summary.json"}
    assert json.loads((tmp_path / "summary.json").read_text("utf-8"))["verdicts"] == []


@pytest.mark.filterwarnings("ignore:.*Consolidated metadata.*")
def test_the_store_holds_names_units_and_study_as_they_are(out, result):
    """Opened by xarray: labels with commas and umlauts, the study's text, methods as JSON."""
    with xr.open_datatree(out / "results.zarr", engine="zarr") as tree:
        assert list(tree["point"].values) == list(POINTS)
        found = tree["peak_acceleration"].sel(case=SOUTH, road="B", method_name="coupled")
        np.testing.assert_array_equal(found, result.cells[KEY].peak_acceleration)
        assert tree.attrs["study_text"] == result.study.text
        assert json.loads(tree.attrs["methods"]) == {"coupled": "x"}
        assert set(tree["contacts"].children) == {"main", SOUTH, "both"}
