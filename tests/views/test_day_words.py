"""A day in words from numbers made up by hand: bounds, busy hours, what was not run, who met."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import (
    POINTS,
    cell,
    curve,
    history,
    levels,
    made_result,
    made_study,
    with_assessment,
)
from trundle.results.cells import CellKey, DayKey
from trundle.simulate import Coverage
from trundle.traffic import Day, Loudest, Meeting
from trundle.views.days import clock, day_views, loudest_words

CAGE = list(POINTS)[1]
KEY = DayKey("Tag <1>", "B")
VC = curve("Band")
DAY = """
[[schedule]]
name = "Tag <1>"
route = "main"
times = ["8:00", "8:30", "23:00", "23:30"]
"""


@pytest.fixture(scope="module")
def study():
    return with_assessment(made_study(DAY, runs=4), [VC])


def result_of(study, *, seconds=(0.0, 0.0, 0.0, 0.0), day=None, **changes):
    """Four runs that lie above for so many seconds, at the first point; none at the second."""
    above = np.column_stack([np.array(seconds), np.zeros(4)])
    spectra = levels(n_runs=4).spectra
    values = np.zeros((4, 2, 20))
    values[:, 0, 9] = np.where(np.array(seconds) > 0.0, 2e-4, 1e-5)
    reduced = levels(n_runs=4, spectra=replace(spectra, values=values), above={"Band": above})
    key = CellKey("main", "B", "coupled")
    one = cell(key, reduced=reduced, history=history(n_steps=3), **changes)
    return made_result(study, cells={key: one}, days={} if day is None else {KEY: day})


def a_day(**changes):
    seconds, events = np.zeros((24, 1, 2)), np.zeros((24, 1, 2), dtype=int)
    seconds[8, 0, 0], events[8, 0, 0] = 90.0, 3
    values = {
        "schedule": KEY.schedule, "n_passages": 4, "counts": {"main": 4}, "busy": 7530.0, "at_once": 2,
        "point_names": tuple(POINTS), "criteria": ("Band",), "complete": (True,), "seconds_above": seconds,
        "events": events, "dose_day": np.zeros(2), "dose_night": np.zeros(2), "meeting_error": np.nan,
        "loudest": (
            Loudest(criterion="Band", point=CAGE, ratio=0.0, band=np.nan, time=1.0, present=()),
            Loudest(
                criterion="Band", point="tool", ratio=2.5, band=10**1.5, time=30615.0,
                present=(Meeting(route="main", departed=30600.0, x=1.0, y=3.0, rms_velocity=2.5e-4),),
            ),
        ),
    }  # fmt: skip
    return Day(**{**values, **changes})


def lines(result):
    (view,) = day_views(result)
    return view, {line.point: line for line in view.lines}


def test_a_day_above_is_told_with_its_intervals(study):
    """Two of four runs exceed, four passages: 2 events, between 0.27 and 3.73.

    Clopper and Pearson's 95 % limits of 2 of 4 are 0.0676 and 0.9324 (tabulated). Minutes: 4 passages of (0 + 0 + 30 + 30) / 4 s each.
    The chance of a day with any is 1 - 0.5^4.
    """
    _, by_point = lines(result_of(study, seconds=(0.0, 30.0, 0.0, 30.0)))
    loud = by_point["tool"]
    assert loud.events == "2 (0.27-3.73)"
    assert loud.minutes.startswith("1 (")
    assert loud.chance == "93.8 %"
    assert (loud.quiet, loud.criterion) == (False, "Band, titled")


def test_a_day_of_which_nothing_exceeds_is_bounded_and_not_nought(study):
    """None of four runs: up to 60 % of passages might, 1 - 0.025^(1/4), which is 2.41 of four."""
    _, by_point = lines(result_of(study, seconds=(0.0, 30.0, 0.0, 30.0)))
    quiet = by_point[CAGE]
    assert quiet.events == "none (below 2.41)"
    assert quiet.minutes == "none"
    assert (quiet.quiet, quiet.chance, quiet.days) == (True, "0 %", "0 to 0")


def test_what_is_not_wholly_known_is_at_least_so_much(study):
    """Waves that end at 40 Hz: every number of events and minutes stands as a lower bound."""
    _, by_point = lines(
        result_of(study, seconds=(0.0, 30.0, 0.0, 30.0), coverage=Coverage(excited_to=40.0))
    )
    assert by_point["tool"].events.startswith("at least 2 (")
    assert by_point["tool"].minutes.startswith("at least 1 (")
    assert by_point[CAGE].events.startswith("at least none")


def test_the_day_that_was_run_is_told_beside_what_is_expected(study):
    """3 times above for 90 s in all; loudest 2.5 times the limit at 31.5 Hz, with who was there."""
    view, by_point = lines(result_of(study, day=a_day()))
    assert by_point["tool"].run == "3, 1.5 min"
    assert by_point["tool"].loudest == (
        "2.5 times the limit at 31.5 Hz, 08:30:15: main of 08:30:00 at (1.0, 3.0) m, alone 250 um/s"
    )
    assert (by_point[CAGE].run, by_point[CAGE].loudest) == ("0, 0 min", "")
    assert view.passages == (
        "4 passages a day (main 4); on the day that was run 4, up to 2 at once, somebody there or "
        "the floor ringing for 126 min"
    )


def test_a_row_that_was_above_on_the_day_that_was_run_is_not_quiet(study):
    """Nothing expected by the runs, and three events on the day: it is not left out as quiet."""
    _, by_point = lines(result_of(study, day=a_day()))
    assert (by_point["tool"].events[:4], by_point["tool"].quiet) == ("none", False)
    assert by_point[CAGE].quiet


def test_a_day_that_was_not_run_says_nothing_of_it(study):
    """No events of a day, no loudest: empty, and no noughts that nobody counted."""
    view, by_point = lines(result_of(study))
    assert (by_point["tool"].run, by_point["tool"].loudest) == ("", "")
    assert "on the day that was run" not in view.passages
    assert view.meeting == "no two vehicles meet on the floor"


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (np.nan, "no two vehicles meet on the floor"),
        (0.0, "vehicles do not feel the floor, so that their sum is exact"),
        (0.0312, "differ by 3.1 % of the RMS velocity"),
    ],
)
def test_what_adding_up_leaves_out_is_said(study, error, words):
    """Nobody meets, nothing is left out, or a share of the RMS: three different things."""
    view, _ = lines(result_of(study, day=a_day(meeting_error=error)))
    assert view.meeting.endswith(words)


def test_passages_that_fill_an_hour_are_told(study):
    """Records of 10 minutes, two in each of two hours: 20 of 60 minutes, a third of the hour."""
    long = replace(history(n_steps=3), time=np.array([0.0, 300.0, 600.0]))
    result = result_of(study)
    ((key, one),) = result.cells.items()
    view, _ = lines(replace(result, cells={key: replace(one, history=long)}))
    assert "in the busiest hour they fill 33 % of it and overlap" in view.passages
    shorter = replace(long, time=np.array([0.0, 300.0, 500.0]))  # 28 %
    view, _ = lines(replace(result, cells={key: replace(one, history=shorter)}))
    assert "overlap" not in view.passages


def test_single_numbers_are_loudest_without_a_band():
    """A peak has no band, and none is named."""
    one = Loudest(criterion="c", point="p", ratio=1.234, band=np.nan, time=3661.0, present=())
    assert loudest_words(one) == "1.23 times the limit, 01:01:01: "


def test_the_end_of_a_day_is_told_by_the_clock():
    """A level may end a second after midnight: it is no 0 o'clock of the same day."""
    assert clock(86401.0) == "24:00:01"


def test_doses_of_each_point_stand_in_the_view(study):
    """Once each, in the order of the points, whatever the criteria."""
    view, _ = lines(result_of(study))
    assert [d.point for d in view.doses] == list(POINTS)
