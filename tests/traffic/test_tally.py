"""What a day counts, from readings that are written down by hand; streams by hour; expectations."""

import numpy as np
import pytest
from scipy import stats

from trundle.errors import ComputationError, InputError
from trundle.response import CurveLimit, Reading
from trundle.traffic import (
    OnePassage,
    Poisson,
    Schedule,
    Times,
    expected_day,
)
from trundle.traffic.tally import Present, Tally

FS = 10.0
HOUR = 3600.0
CURVES = (
    CurveLimit(name="VC-A", quantity="band_rms_velocity", limits=np.full(20, 1e-5)),
    CurveLimit(name="dose", quantity="vdv", limits=np.array([0.4])),
)


def part(n_steps, squares=None, *, band=3, who=(), felt=0.0):
    """Return a reading of two curves at two points, and who is there."""
    square = np.zeros((2, 2, n_steps), dtype=np.float32)
    for (curve, point, step), value in (squares or {}).items():
        square[curve, point, step] = value
    motion = {name: np.zeros((2, n_steps)) for name in ("displacement", "velocity", "acceleration")}
    motion["felt"] = np.full((2, n_steps), felt)
    reading = Reading(square=square, band=np.full(square.shape, band, dtype=np.int16))
    return reading, lambda start: Present(start=start, motion=motion, who=tuple(who))


def take(tally, start, *made):
    reading, present = made
    tally.take(start, reading, present(start))


def test_time_above_is_counted_in_its_hour():
    """Three steps above just before 8:00 and two behind it, at the second point alone."""
    tally = Tally(CURVES, ("a", "b"), FS)
    start = round(8 * HOUR * FS) - 50
    above = dict.fromkeys([(0, 1, 47), (0, 1, 48), (0, 1, 49), (0, 1, 50), (0, 1, 51)], 1.5)
    take(tally, start, *part(100, above))
    tally.end()
    assert tally.seconds_above[7, 0].tolist() == [0.0, pytest.approx(0.3)]
    assert tally.seconds_above[8, 0].tolist() == [0.0, pytest.approx(0.2)]
    assert tally.seconds_above[:, 0].sum() == pytest.approx(0.5)
    assert np.isnan(tally.seconds_above[:, 1]).all()  # a dose has no running level
    assert tally.busy == pytest.approx(10.0)


@pytest.mark.parametrize(("gap", "events"), [(49, 1), (50, 1), (51, 2)])
def test_times_less_than_five_seconds_apart_are_one_event(gap, events):
    """50 steps of 0.1 s between two steps above are one event, 51 are two; across parts as within."""
    whole = Tally(CURVES, ("a", "b"), FS)
    take(whole, 1000, *part(200, {(0, 0, 20): 2.0, (0, 0, 20 + gap): 2.0}))
    parts = Tally(CURVES, ("a", "b"), FS)
    take(parts, 1000, *part(40, {(0, 0, 20): 2.0}))
    take(parts, 1040, *part(160, {(0, 0, gap - 20): 2.0}))
    for tally in (whole, parts):
        assert tally.events[0, 0, 0] == events
        assert tally.events.sum() == events


def test_an_event_belongs_to_the_hour_in_which_it_begins():
    """Above from 9:59:59.8 to 10:00:00.2: one event, of 9 o'clock; a level at its limit is none."""
    tally = Tally(CURVES, ("a", "b"), FS)
    start = round(10 * HOUR * FS) - 10
    steps = {(0, 0, k): 1.01 for k in range(8, 13)} | {(0, 1, 5): 1.0}
    take(tally, start, *part(20, steps))
    assert tally.events[9, 0, 0] == 1
    assert tally.events.sum() == 1
    assert tally.seconds_above[:, 0, 1].sum() == 0.0


def test_doses_are_of_day_and_night():
    """0.5 m/s2 for 2 s before and 3 s behind 23:00: sums of the fourth power, 7 to 23 h are day."""
    tally = Tally(CURVES, ("a", "b"), FS)
    take(tally, round(23 * HOUR * FS) - 20, *part(50, felt=0.5))
    day, night = tally.dose[:, 0]
    assert (day, night) == pytest.approx((0.5**4 * 2.0, 0.5**4 * 3.0))
    early = Tally(CURVES, ("a", "b"), FS)
    take(early, round(7 * HOUR * FS) - 10, *part(40, felt=0.5))
    assert early.dose[:, 1] == pytest.approx([0.5**4 * 3.0, 0.5**4 * 1.0])


def test_the_largest_level_keeps_who_was_there():
    """The second part is the louder: its step, its band, and the share of each in its last second.

    One stood still for half of that second: its RMS is that of the other half.
    """
    tally = Tally(CURVES, ("a", "b"), FS)
    take(tally, 500, *part(50, {(0, 0, 10): 4.0}, band=2))
    constant = ("north <1>", 49.0, 520, np.full((2, 60), 3e-5))
    half = ("south", 52.0, 525, np.concatenate([np.zeros((2, 11)), np.full((2, 40), 8e-5)], axis=1))
    gone = ("east", 10.0, 100, np.ones((2, 60)))
    made = part(50, {(0, 0, 10): 9.0, (0, 0, 30): 8.0}, band=5, who=(constant, half, gone))
    take(tally, 530, *made)
    peak = tally.peaks[0][0]
    assert (peak.square, peak.band, peak.step) == (9.0, 5, 540)
    names = [name for name, _, _ in peak.who]
    assert names == ["south", "north <1>"]
    # steps 531 to 540 are looked at; "south" moves from step 536 on
    assert peak.who[0][2] == pytest.approx(8e-5 * np.sqrt(0.5))
    assert peak.who[1][1:] == (49.0, pytest.approx(3e-5))
    assert tally.peaks[0][1].square == 0.0


def test_how_many_are_there_at_once():
    """Three records overlap two by two: two at once, not three; parts are looked at by themselves."""
    tally = Tally(CURVES, ("a", "b"), FS)
    who = [("r", 0.0, first, np.zeros((2, 40))) for first in (100, 130, 160)]
    take(tally, 100, *part(120, who=who))
    assert tally.at_once == 2
    take(tally, 220, *part(50))
    assert tally.at_once == 2
    assert tally.busy == pytest.approx(17.0)


def test_a_day_that_overflows_stops():
    """A motion that is no number compares as quiet."""
    tally = Tally(CURVES, ("a", "b"), FS)
    reading, present = part(10, felt=np.nan)
    with pytest.raises(ComputationError, match="the felt is not a finite number 40 s after"):
        tally.take(400, reading, present(400))


def test_a_stream_is_shared_out_over_hours_and_routes():
    """12 from 8:30 to 9:30 and 6 from 9:30 to 12:30: 6 of them in the first hour, 6 + 1 in the next.

    2 to 1 on two routes; shares need not add up to 1.
    """
    stream = Poisson(
        edges=HOUR * np.array([8.5, 9.5, 12.5]), means=np.array([12.0, 6.0]),
        mix={"Nord": 4.0, "Süd": 2.0},
    )  # fmt: skip
    hours = stream.expected()
    total = hours["Nord"] + hours["Süd"]
    np.testing.assert_allclose(total[8:13], [6.0, 7.0, 2.0, 2.0, 1.0])
    np.testing.assert_allclose(hours["Nord"], 2.0 * hours["Süd"])
    even = Poisson.through(start=6 * HOUR, end=10 * HOUR, rate=5.0, mix={"r": 1.0})
    np.testing.assert_allclose(even.expected()["r"][6:10], 5.0)
    assert even.expected()["r"].sum() == pytest.approx(20.0)
    known = Times(route="r", times=np.array([86399.9, 0.0, 3600.0])).expected()["r"]
    assert known.nonzero()[0].tolist() == [0, 1, 23]


def test_a_schedule_adds_its_streams_by_route():
    """Times on one route and a stream on both; a timetable alone is not random."""
    stream = Poisson.through(start=0.0, end=24 * HOUR, rate=2.0, mix={"a": 1.0, "b": 3.0})
    table = Times(route="b", times=np.array([1800.0, 5400.0]))
    both = Schedule(name="Werktag", streams=(table, stream))
    assert both.routes == ("b", "a")
    assert both.per_day == pytest.approx(50.0)
    assert both.expected()["b"][:3].tolist() == [2.5, 2.5, 1.5]
    assert both.is_random
    assert not Schedule(name="t", streams=(table,)).is_random
    with pytest.raises(InputError, match=r"schedule 'leer <0>': nobody drives"):
        Schedule(name="leer <0>", streams=(Times(route="a", times=np.zeros(0)),))


def passage(exceeding, n, seconds=0.0):
    exceeds = np.arange(n) < exceeding
    return OnePassage(exceeds=exceeds, seconds=np.where(exceeds, seconds, 0.0))


@pytest.mark.parametrize("random", [True, False])
def test_the_chance_of_any_event_is_that_of_all_passages(random):
    """2 of 10 runs exceed, 5 passages: 1 - 0.8^5 of a timetable, 1 - exp(-1) of a stream.

    Numbers on days are those of the binomial and the Poisson law.
    """
    counts = {"r": np.eye(24)[7] * 5.0}
    found = expected_day({"r": passage(2, 10, 3.0)}, counts, random=random)
    assert found.events == pytest.approx(1.0)
    assert found.any_event == pytest.approx(1.0 - (np.exp(-1.0) if random else 0.8**5))
    law = stats.poisson(1.0) if random else stats.binom(5, 0.2)
    assert found.events_on_days == tuple(law.ppf([0.025, 0.975]))
    assert found.by_hour[7] == pytest.approx(1.0)
    assert found.minutes == pytest.approx(5.0 * 0.2 * 3.0 / 60.0)


def test_routes_add_their_events_and_not_their_intervals():
    """Distances of limits from estimates add by squares: by hand for 1 of 10 and 3 of 20 runs."""
    passages = {"a": passage(1, 10), "b": passage(3, 20)}
    counts = {"a": np.full(24, 1.0), "b": np.full(24, 2.0)}
    found = expected_day(passages, counts, random=True)
    parts = []
    for k, n, total in ((1, 10, 24.0), (3, 20, 48.0)):
        p = k / n
        low = stats.beta.ppf(0.025, k, n - k + 1)
        high = stats.beta.ppf(0.975, k + 1, n - k)
        parts.append((total * p, total * (p - low), total * (high - p)))
    mean = sum(m for m, _, _ in parts)
    assert found.events == pytest.approx(mean)
    below = np.hypot(*(low for _, low, _ in parts))
    above = np.hypot(*(high for _, _, high in parts))
    assert found.events_interval == pytest.approx((max(0.0, mean - below), mean + above))
    np.testing.assert_allclose(found.by_hour, 0.1 + 2.0 * 0.15)


def test_no_event_of_few_runs_is_no_promise():
    """None of 3 runs: the mean may be 71 % of all passages (Clopper and Pearson: 1 - 0.025^(1/3))."""
    found = expected_day({"r": passage(0, 3)}, {"r": np.full(24, 1.0)}, random=True)
    assert found.events == 0.0
    assert found.events_interval == pytest.approx((0.0, 24.0 * (1.0 - 0.025 ** (1 / 3))))
    assert found.any_event == 0.0
    assert np.isnan(found.minutes_interval[1])
