"""The examples of a day's trucks and of a laboratory corridor, at small size, to report and tables."""

import csv
import functools
import json
import re
from pathlib import Path

import numpy as np
import pytest

import trundle as tr
from trundle.results.cells import CellKey, DayKey
from trundle.results.expected_days import day_doses, day_rows
from trundle.results.together import together_rows
from trundle.views.verdicts import headline

FOLDER = Path(__file__).parents[2] / "examples"


def small(name, runs, *changes):
    text = (FOLDER / name / "study.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return tr.study_from_text(
        re.sub(r"(?m)^runs = \d+", f"runs = {runs}", text), folder=FOLDER / name
    )


@functools.cache
def trucks():
    """The two lanes with a coarse mesh and a quiet day of some ten passages."""
    return tr.run_study(
        small(
            "two_lanes", 6, ('mesh_size = "0.75 m"', 'mesh_size = "3 m"'),
            ('f_max = "112 Hz"', 'f_max = "25 Hz"'), ('spacing = "2 m"', 'spacing = "8 m"'),
            ("4.0, 12.0, 24.0, 30.0, 28.0, 24.0, 20.0, 16.0, 22.0, 26.0, 28.0, 22.0, 14.0, 8.0, 4.0",
             "0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0"),
        )
    )  # fmt: skip


@functools.cache
def corridor():
    return tr.run_study(
        small(
            "laboratory_corridor", 5, ('mesh_size = "0.75 m"', 'mesh_size = "3 m"'),
            ('f_max = "112 Hz"', 'f_max = "30 Hz"'), ('dt = "2.5 ms"', 'dt = "5 ms"'),
            ('n_max = "75 1/m"', 'n_max = "24 1/m"'), ('spacing = "1.5 m"', 'spacing = "6 m"'),
            ("runs = 20", "runs = 5"), ("per_hour = 30.0", "per_hour = 1.0"),
            ("per_hour = 6.0", "per_hour = 0.5"), ('"20 min"', '"4 h"'),
        )
    )  # fmt: skip


def table(file):
    with file.open(encoding="utf-8") as opened:
        return list(csv.DictReader(opened))


@pytest.mark.longest
def test_a_days_events_are_counts_times_shares():
    """For every criterion on both roads: the sum over routes of passages times runs that exceed."""
    result = trucks()
    counts = {n: h.sum() for n, h in result.study.schedules["working day"].expected().items()}
    rows = [row for row in day_rows(result) if row.key.schedule == "working day"]
    assert len(rows) == 2 * 5
    for row in rows:
        expected = 0.0
        for route, n in counts.items():
            verdicts = result.verdicts[CellKey(route, row.key.road, "coupled")]
            (one,) = [v for v in verdicts if v.criterion.name == row.criterion.name]
            expected += n * one.share_exceeding
        assert row.expected.events == pytest.approx(expected)
        assert row.minutes_run >= 0.0
    night = result.days[DayKey("night", "B")]
    assert (night.n_passages, night.at_once) == (3, 1)
    assert np.isnan(night.meeting_error)
    assert set(np.flatnonzero(night.seconds_above.sum(axis=(1, 2)))) <= {1, 3, 23}


@pytest.mark.longest
def test_a_day_is_in_report_tables_and_folder(tmp_path):
    """What is read back draws the same page; tables and JSON hold the day; maps have its events."""
    result = trucks()
    tr.save(result, tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "A day's traffic" in page
    assert "Sources together and alone" in page
    assert "working day, road A" in page
    rows = table(tmp_path / "out" / "days.csv")
    assert len(rows) == 2 * 2 * 5
    assert {row["schedule"] for row in rows} == {"working day", "night"}
    hours = table(tmp_path / "out" / "day_hours.csv")
    for row in rows:
        mine = [
            h for h in hours
            if all(h[k] == row[k] for k in ("schedule", "road", "point", "criterion"))
        ]  # fmt: skip
        total = sum(float(h["events_expected"]) for h in mine)
        assert total == pytest.approx(float(row["events_per_day"]), rel=1e-9)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert len(summary["days"]) == len(rows)
    for name in ("day_hours", "day_map", "map_share"):
        assert (tmp_path / "out" / "figures" / f"{name}.png").stat().st_size > 5000
    back = tr.read_results(tmp_path / "out")
    for key, day in result.days.items():
        np.testing.assert_array_equal(back.days[key].seconds_above, day.seconds_above)
        assert repr(back.days[key].loudest) == repr(day.loudest)
    tr.write_report(back, tmp_path)
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == page


@pytest.mark.longest
def test_doses_of_a_day_are_estimated_by_their_rms():
    """eVDV is within a factor of two of VDV for passages (crests below 6), and 1.4 is its constant.

    For a sine VDV is ``(3/8)^(1/4) sqrt(2) a_rms T^(1/4)`` = 1.107; for Gaussian motion 3^(1/4) =
    1.316; so 1.4 errs on the safe side where motion lasts, and below it where it comes in a burst.
    """
    found = list(day_doses(trucks()))
    assert len(found) == 4
    for one in found:
        assert one.vdv_day == 0.0 or 0.5 < one.evdv_day / one.vdv_day < 2.0
    night = next(one for one in found if one.key == DayKey("night", "A"))
    assert (night.vdv_day, night.run_day) == (0.0, 0.0)
    cell = trucks().cells[CellKey("articulated in", "A", "coupled")]
    one = np.mean(cell.reduced.vdv[:, 0] ** 4) ** 0.25
    assert night.vdv_night == pytest.approx(3**0.25 * one)


@pytest.mark.longest
def test_sources_of_a_laboratory_are_held_beside_each_other(tmp_path):
    """Energies of all sources bound those of each; who governs has the smallest margin of all.

    By energy no margin is larger than any alone, nor is one by sum larger than by energy.
    """
    result = corridor()
    rows = list(together_rows(result))
    assert {row.case for row in rows} == {"all at once"}
    for row in rows:
        known = [m for m in row.alone.values() if np.isfinite(m)]
        assert row.by_sum <= row.by_energy * (1 + 1e-12) <= min(known) * (1 + 1e-9)
        assert sum(row.shares.values()) == pytest.approx(1.0)
        assert row.shares[row.governs] == max(row.shares.values())
    tr.save(result, tmp_path / "out")
    rows = table(tmp_path / "out" / "together.csv")
    assert all(
        row["governed_by"] in {"delivery road", "trolley", "corridor", "pump"} for row in rows
    )
    for name in ("map_response_factor", "map_vdv"):
        assert (tmp_path / "out" / "figures" / f"{name}.png").exists()
    assert "Largest:" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


@pytest.mark.longest
def test_a_machine_alone_passes_nothing_that_it_does_not_excite():
    """The pump's force ends at 24 Hz: its own verdicts say so; the corridor's go to the top."""
    result = corridor()
    pump = result.verdicts[CellKey("pump", "laid floor", "coupled")]
    assert {v.status for v in pump if v.criterion.name.startswith("VC")} == {"not assessed"}
    assert any("forces that are given end at 24.2 Hz" in r for v in pump for r in v.reasons)
    both = result.cells[CellKey("all at once", "laid floor", "coupled")].coverage
    assert both.by == "road"
    assert both.excited_to > 24.2


@pytest.mark.longest
def test_the_verdict_says_who_governs():
    """Beside the verdict of all together stands the source with most of the energy; alone nothing."""
    result = corridor()
    rows = {(row.point, row.verdict.criterion.name): row.governs for row in together_rows(result)}
    for line in headline(result):
        if line["case"] != "all at once":
            assert line["governs"] == ""
            continue
        name = (line["first"] or line["best"]).criterion.name
        assert line["governs"].startswith(f"governed by {rows[line['point'], name]}, ")
