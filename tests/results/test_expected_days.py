"""Days from runs of passages: what counts as above, what is a bound, and whose numbers they are."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import (
    BANDS,
    POINTS,
    cell,
    curve,
    history,
    levels,
    made_result,
    made_study,
    spectra,
    with_assessment,
)
from trundle.results.cells import CellKey, DayKey
from trundle.results.day_tables import day_table, dose_table, hour_table
from trundle.results.expected_days import day_doses, day_rows
from trundle.simulate import Coverage
from trundle.traffic import Day, Loudest, Meeting
from trundle.views.days import day_views

CAGE = list(POINTS)[1]
DAY = """
[[route]]
name = "rück, wärts"
vehicle = "truck"
path = [["12 m", "2 m"], ["0 m", "2 m"]]
speed = "15 km/h"

[[schedule]]
name = "Tag <1>"
route = "main"
times = ["6:30", "8:00", "8:30", "23:00"]
"""
BY_BAND = curve("Band")
PEAK = curve("Spitze", quantity="peak_acceleration", limits=np.array([0.02, 0.02]))
LINES = curve("Linien", quantity="narrow_band_acceleration")
LEVEL = curve("waagrecht", axis="horizontal")
DOSE = curve("Dosis", quantity="vdv")


@pytest.fixture(scope="module")
def study():
    return made_study(DAY, runs=4)


def bands(loud, point=0, band=9):
    """Levels of 60 um/s in all bands of four runs, 150 um/s in one band where a run is loud."""
    values = np.full((4, 2, 20), 6e-5)
    values[np.array(loud), point, band] = 1.5e-4
    return spectra(values)


def result_of(study, criteria, *, days=None, **changes):
    values = {
        "spectra": bands([False, True, True, False]),
        "above": {c.name: np.array([[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [0.0, 0.0]]) for c in criteria},
        "peak_acceleration": np.array([[0.01, 0.03], [0.03, 0.03], [0.01, 0.03], [0.02, 0.03]]),
    }  # fmt: skip
    reach = changes.pop("coverage", Coverage())
    f_resolved = changes.pop("f_resolved", 80.0)
    reduced = levels(n_runs=4, **{**values, **changes})
    keys = [CellKey(c.name, "B", "coupled") for c in study.cases]
    cells = {k: cell(k, reduced=reduced, coverage=reach, f_resolved=f_resolved) for k in keys}
    asked = with_assessment(study, criteria)
    return made_result(asked, cells=cells, days=days or {})


def test_events_are_passages_times_the_share_of_runs_above(study):
    """Two of four runs lie above in the 8 Hz band, four trucks a day: two events, at their hours."""
    rows = list(day_rows(result_of(study, [BY_BAND])))
    assert [(r.key, r.point) for r in rows] == [
        (DayKey("Tag <1>", "B"), "tool"), (DayKey("Tag <1>", "B"), CAGE),
    ]  # fmt: skip
    loud, quiet = (row.expected for row in rows)
    assert loud.events == 2.0
    assert np.flatnonzero(loud.by_hour).tolist() == [6, 8, 23]
    assert loud.by_hour[[6, 8, 23]].tolist() == [0.5, 1.0, 0.5]
    # 0, 2, 4 and 0 s above: 1.5 s a passage, four of them
    assert loud.minutes == pytest.approx(4 * 1.5 / 60.0)
    assert (quiet.events, quiet.minutes) == (0.0, 0.0)


def test_a_level_on_its_limit_is_not_above_it(study):
    """100 um/s beside 100 um/s: met, as in a verdict, whose margin is 1 there."""
    values = np.full((4, 2, 20), 1e-4)
    (row, _) = day_rows(result_of(study, [BY_BAND], spectra=spectra(values)))
    assert row.expected.events == 0.0


def test_single_numbers_are_held_by_themselves(study):
    """0.02 m/s2: of four runs one lies above at the first point, all at the second."""
    first, second = day_rows(result_of(study, [PEAK]))
    assert (first.expected.events, second.expected.events) == (1.0, 4.0)
    assert first.complete


def test_by_another_rule_a_day_is_read_by_the_running_level(study):
    """Levels of whole events say nothing of 1 s: runs with time above count, here two of four."""
    one = replace(bands([False] * 4), averaging="event")
    (row, _) = day_rows(result_of(study, [BY_BAND], spectra=one))
    assert row.expected.events == 2.0


INCOMPLETE = {
    "a band is not excited": {"coverage": Coverage(excited_to=70.0)},
    "vehicles have not left": {"coverage": Coverage(leaves=6.0, ends=5.0)},
    "a band is not resolved": {"spectra": replace(bands([True] * 4), resolved=BANDS < 50.0)},
}


@pytest.mark.parametrize("why", INCOMPLETE)
def test_what_is_not_known_makes_a_lower_bound_and_never_a_whole_day(study, why):
    """Each of three reasons alone: what lies above still counts, and is told to be a bound."""
    whole, *_ = day_rows(result_of(study, [BY_BAND]))
    row, *_ = day_rows(result_of(study, [BY_BAND], **INCOMPLETE[why]))
    assert (whole.complete, row.complete) == (True, False)
    assert row.expected.events >= 2.0
    table = list(day_table(result_of(study, [BY_BAND], **INCOMPLETE[why])))
    assert {line["bound"] for line in table} == {"lower"}
    assert {line["bound"] for line in day_table(result_of(study, [BY_BAND]))} == {""}


def test_a_band_that_nothing_excites_is_not_held(study):
    """Loud only at 63 Hz, where the road's waves have ended: no event, and a lower bound."""
    some = {"spectra": bands([True] * 4, band=18), "coverage": Coverage(excited_to=40.0)}
    row, *_ = day_rows(result_of(study, [BY_BAND], **some))
    assert (row.expected.events, row.complete) == (0.0, False)


def test_a_curve_beyond_the_bands_is_never_whole(study):
    """From 4 to 100 Hz: the 100 Hz band is never computed, so that a day has a lower bound."""
    far = curve("weit", frequencies=np.array([4.0, 100.0]), limits=np.array([1e-4, 1e-4]))
    row, *_ = day_rows(result_of(study, [far]))
    assert not row.complete


@pytest.mark.parametrize(
    ("f_resolved", "excited", "whole"),
    [(80.0, 80.0, True), (79.0, 80.0, False), (80.0, 79.0, False)],
)
def test_a_single_number_is_whole_as_far_as_its_curve_reaches(study, f_resolved, excited, whole):
    """A limit on peaks to 80 Hz, computed and excited to 80 Hz, or one of both 1 Hz less."""
    some = {"f_resolved": f_resolved, "coverage": Coverage(excited_to=excited)}
    row, *_ = day_rows(result_of(study, [PEAK], **some))
    assert row.complete is whole


def test_curves_for_another_motion_and_doses_are_left_out(study):
    """Vertical points have nothing of a level limit, and doses have rows of their own."""
    rows = list(day_rows(result_of(study, [LEVEL, BY_BAND, DOSE])))
    assert {r.criterion.name for r in rows} == {"Band"}


def test_without_an_assessment_there_is_no_day(study):
    """Nothing to hold a day against: no rows, no doses, no tables."""
    result = result_of(study, [BY_BAND])
    bare = replace(result, study=replace(result.study, assessment=None))
    assert [*day_rows(bare), *day_doses(bare), *day_table(bare), *hour_table(bare)] == []


def a_day(seconds=None):
    """A day of three hours above at the second point, by two curves; the first in the 8 Hz band."""
    above = np.zeros((24, 2, 2)) if seconds is None else seconds
    events = np.zeros((24, 2, 2), dtype=int)
    above[[8, 9], 1, 1], events[[8, 9, 23], 1, 1] = (30.0, 90.0), (1, 2, 4)
    who = (
        Meeting(route="main", departed=28800.0, x=3.0, y=2.5, rms_velocity=2e-4),
        Meeting(route="rück, wärts", departed=28790.0, x=np.nan, y=np.nan, rms_velocity=1.25e-5),
    )
    return Day(
        schedule="Tag <1>", n_passages=4, counts={"main": 4}, busy=60.0, at_once=1,
        point_names=tuple(POINTS), criteria=("anderer", "Band"), complete=(True, True),
        seconds_above=above, events=events,
        loudest=(
            Loudest(criterion="Band", point="tool", ratio=0.5, band=8.0, time=1.0, present=()),
            Loudest(criterion="Band", point=CAGE, ratio=3.0, band=10**0.9, time=28805.0, present=who),
        ),
        dose_day=np.array([0.1, 0.2]), dose_night=np.array([0.3, 0.4]), meeting_error=np.nan,
    )  # fmt: skip


def test_the_day_that_was_run_is_read_at_its_own_curve_and_point(study):
    """7 events and 2 minutes at the second point by the second curve; none at the first."""
    result = result_of(study, [BY_BAND], days={DayKey("Tag <1>", "B"): a_day()})
    first, second = day_rows(result)
    assert (first.events_run, first.minutes_run) == (0.0, 0.0)
    assert (second.events_run, second.minutes_run) == (7.0, 2.0)
    hours = [line for line in hour_table(result) if line["point"] == CAGE]
    assert [line["hour"] for line in hours] == list(range(24))
    assert [hours[h]["seconds_of_day_run"] for h in (7, 8, 9)] == [0.0, 30.0, 90.0]
    assert [hours[h]["events_of_day_run"] for h in (8, 9, 23)] == [1.0, 2.0, 4.0]


def test_without_a_running_level_a_day_that_was_run_says_nothing(study):
    """NaN for seconds: events are NaN too, for 0 would be a quiet day that nobody looked at."""
    key = DayKey("Tag <1>", "B")
    result = result_of(study, [BY_BAND], days={key: a_day(np.full((24, 2, 2), np.nan))})
    row, _ = day_rows(result)
    assert np.isnan([row.events_run, row.minutes_run]).all()
    other, _ = day_rows(result_of(study, [BY_BAND]))
    assert np.isnan([other.events_run, other.minutes_run]).all()
    hours = next(hour_table(result_of(study, [BY_BAND])))
    assert np.isnan([hours["events_of_day_run"], hours["seconds_of_day_run"]]).all()


def test_the_table_says_who_was_there(study):
    """Place where one still drove, leaving where not; the ratio, band and time of that curve."""
    result = result_of(study, [BY_BAND], days={DayKey("Tag <1>", "B"): a_day()})
    _, row = day_table(result)
    assert (row["largest_level_over_limit"], row["largest_at_s"]) == (3.0, 28805.0)
    assert row["largest_in_band_hz"] == pytest.approx(10**0.9)
    assert row["present"] == [
        "main departed 28800.0 s, at (3.00, 2.50) m, 0.0002 m/s",
        "rück, wärts departed 28790.0 s, leaving, 1.25e-05 m/s",
    ]
    quiet = next(day_table(result_of(study, [BY_BAND])))
    assert quiet["present"] == []
    assert np.isnan(quiet["largest_level_over_limit"])


def test_doses_add_by_fourth_powers_by_day_and_by_night(study):
    """Two of four passages are of the night: two doses of 1 give 2^0.25, by day and by night."""
    vdv = np.array([[1.0, 2.0]] * 4)
    rms = np.array([[0.5, 0.5]] * 4)
    result = result_of(study, [BY_BAND], vdv=vdv, weighted_rms=rms)
    first, second = day_doses(result)
    # two passages by day (8:00, 8:30), two by night (6:30, 23:00)
    assert (first.vdv_day, first.vdv_night) == pytest.approx((2**0.25, 2**0.25))
    assert second.vdv_day == pytest.approx(2.0 * 2**0.25)
    # eVDV = 1.4 a_rms T^0.25 of a record of 20 ms, twice
    assert first.evdv_day == pytest.approx(2**0.25 * 1.4 * 0.5 * 0.02**0.25)
    assert np.isnan([first.run_day, first.run_night]).all()


def test_a_dose_is_of_the_mean_fourth_power_and_not_of_the_mean(study):
    """Runs of 0 and 2: the mean fourth power is 8, and of the mean it would be 1."""
    vdv = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 0.0], [2.0, 0.0]])
    first, _ = day_doses(result_of(study, [BY_BAND], vdv=vdv))
    assert first.vdv_day == pytest.approx((2 * 8.0) ** 0.25)


def test_doses_of_the_day_that_was_run_stand_in_their_own_columns(study):
    """By point: 0.1 and 0.2 by day, 0.3 and 0.4 by night."""
    result = result_of(study, [BY_BAND], days={DayKey("Tag <1>", "B"): a_day()})
    rows = list(dose_table(result))
    assert [r["vdv_of_day_run_m_s1.75"] for r in rows] == [0.1, 0.2]
    assert [r["vdv_of_night_run_m_s1.75"] for r in rows] == [0.3, 0.4]
    assert {(r["schedule"], r["road"]) for r in rows} == {("Tag <1>", "B")}


def test_several_routes_count_each_by_its_own_runs():
    """One passage of a route always above, two of another in a quarter of its runs: 1.5 events."""
    text = DAY.partition("[[schedule]]")[0] + (
        '[[traffic]]\nname = "zwei"\nroutes = ["main", "rück, wärts"]\n\n'
        '[[schedule]]\nname = "alle"\nroute = "rück, wärts"\ntimes = ["8:00", "9:00"]\n'
    )
    study = made_study(text, runs=4)
    schedule = study.schedules["alle"]
    both = replace(
        schedule,
        streams=(
            *schedule.streams,
            replace(schedule.streams[0], route="main", times=np.array([100.0])),
        ),
    )
    study = with_assessment(replace(study, schedules={"alle": both}), [BY_BAND])
    cells = {}
    for case, loud in (
        ("main", [True] * 4),
        ("rück, wärts", [True, False, False, False]),
        ("zwei", [False] * 4),
    ):
        key = CellKey(case, "B", "coupled")
        reduced = levels(
            n_runs=4, spectra=bands(loud), above={"Band": np.array([[60.0 * x] * 2 for x in loud])}
        )
        cells[key] = cell(key, reduced=reduced, history=history(n_steps=3))
    row, _ = day_rows(made_result(study, cells=cells))
    assert row.expected.events == pytest.approx(1.0 + 2 * 0.25)
    assert row.expected.minutes == pytest.approx(1.0 + 2 * 0.25)
    assert row.expected.by_hour[[0, 8, 9]].tolist() == [1.0, 0.25, 0.25]


def test_narrow_lines_have_events_and_no_minutes(study):
    """Lines of 1 Hz: a run counts by its largest line; a running level they have not."""
    values = np.zeros((4, 2, 20))
    values[:3, 0, 6] = 2e-4
    lines = spectra(values, mid_band=np.arange(1.0, 21.0), quantity="narrow_band_acceleration")
    some = {
        "more": {"narrow_band_acceleration": lines},
        "above": {"Linien": np.full((4, 2), np.nan)},
    }
    row, other = day_rows(result_of(study, [LINES], **some))
    assert row.expected.events == 3.0
    assert np.isnan(row.expected.minutes)
    assert other.expected.events == 0.0


@pytest.mark.parametrize("averaging", ["event", "slow", "fast"])
def test_narrow_lines_have_events_by_every_rule_of_averaging(study, averaging):
    """All runs exceed on a line, by whatever rule bands are averaged: four passages, four events."""
    lines = spectra(
        np.ones((4, 2, 20)), mid_band=np.arange(1.0, 21.0),
        quantity="narrow_band_acceleration", averaging=averaging,
    )  # fmt: skip
    some = {
        "more": {"narrow_band_acceleration": lines},
        "above": {"Linien": np.full((4, 2), np.nan)},
    }
    row, _ = day_rows(result_of(study, [LINES], **some))
    assert row.expected.events == 4.0
    assert np.isnan(row.expected.minutes)


def test_of_what_nothing_is_known_no_number_of_events_is_said(study):
    """No band of the curve is excited: neither none nor some, on no hour, and no whole day."""
    result = result_of(study, [BY_BAND], coverage=Coverage(excited_to=2.0))
    row, _ = day_rows(result)
    expected = row.expected
    assert np.isnan([expected.events, expected.any_event, expected.minutes]).all()
    assert np.isnan(expected.by_hour).all()
    assert not row.complete
    (table, _), (line, _) = day_table(result), day_views(result)[0].lines
    assert np.isnan(table["events_per_day"])
    assert table["bound"] == ""  # a bound of what?
    assert (line.events, line.minutes, line.days, line.chance) == ("not assessed", "", "", "")
    assert not line.quiet


def test_events_of_a_day_that_nobody_counted_are_no_zeros(study):
    """A curve without a running level: the day that was run says nothing of it in any hour."""
    day = a_day()
    day = replace(day, seconds_above=np.full(day.seconds_above.shape, np.nan))
    rows = list(hour_table(result_of(study, [BY_BAND], days={DayKey("Tag <1>", "B"): day})))
    assert np.isnan([row["events_of_day_run"] for row in rows]).all()
