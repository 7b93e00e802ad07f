"""Departures: known times, headways, and random streams whose counts are Poisson's."""

import numpy as np
import pytest
from scipy import stats

from trundle.errors import InputError
from trundle.traffic import DAY, Poisson, Schedule, Times, evenly


def rng(seed=0):
    return np.random.default_rng(seed)


def test_headways_are_even_and_end_before_the_last():
    """Every 90 s from 8:00 to 8:06: five, the one at 8:06 left out."""
    stream = evenly("main", first=8 * 3600.0, last=8 * 3600.0 + 360.0, headway=90.0)
    np.testing.assert_allclose(stream.times, 8 * 3600.0 + 90.0 * np.arange(4))
    times, names = stream.draw(rng())
    assert (len(times), set(names)) == (4, {"main"})
    assert stream.expected()["main"][8] == 4.0


@pytest.mark.parametrize("headway", [1.0, 7.0, 0.1])
def test_headways_that_divide_the_time_have_no_passage_at_its_end(headway):
    """n headways fit into n times the headway, whatever is lost by rounding."""
    stream = evenly("main", first=0.0, last=70.0 * headway, headway=headway)
    assert len(stream.times) == 70


def test_counts_by_hour_are_poisson():
    """Over 2000 days, numbers in an hour of mean 7 have mean and variance 7, and Poisson's shares.

    A chi-square over the classes 0-3 .. 11+ stays below its 99.9 % value for a fixed seed.
    """
    by_hour = np.zeros(24)
    by_hour[9] = 7.0
    stream = Poisson.by_hour(by_hour, {"a": 1.0})
    generator = rng(5)
    counts = np.array([len(stream.draw(generator)[0]) for _ in range(2000)])
    assert counts.mean() == pytest.approx(7.0, abs=3 * np.sqrt(7.0 / 2000))
    assert counts.var() == pytest.approx(7.0, rel=0.12)
    edges = np.array([-0.5, 3.5, 5.5, 6.5, 7.5, 8.5, 10.5, 1e3])
    seen = np.histogram(counts, edges)[0]
    expected = 2000 * np.diff(stats.poisson(7.0).cdf(edges))
    assert ((seen - expected) ** 2 / expected).sum() < stats.chi2(6).ppf(0.999)


def test_gaps_of_a_stream_are_exponential():
    """Between passages of an even stream times are exponential (Kolmogorov and Smirnov, 0.1 %)."""
    stream = Poisson.through(start=0.0, end=DAY, rate=400.0, mix={"a": 1.0})
    times = np.sort(stream.draw(rng(2))[0])
    gaps = np.diff(times)
    assert stats.kstest(gaps, stats.expon(scale=9.0).cdf).pvalue > 1e-3


def test_a_mix_has_its_shares_and_a_stream_its_hours():
    """6 to 4 among 20,000 within three standard deviations; none before 8:30, none after 17:00."""
    stream = Poisson.through(
        start=8.5 * 3600, end=17 * 3600.0, rate=2000.0, mix={"truck": 6.0, "van": 4.0}
    )
    times, names = stream.draw(rng(1))
    share = np.mean(np.array(names) == "truck")
    assert share == pytest.approx(0.6, abs=3 * np.sqrt(0.24 / len(names)))
    assert times.min() >= 8.5 * 3600
    assert times.max() <= 17 * 3600.0
    expected = stream.expected()
    assert expected["truck"][8] == pytest.approx(600.0)  # half an hour of it
    assert sum(e.sum() for e in expected.values()) == pytest.approx(17_000.0)


def test_a_schedule_puts_its_parts_in_the_order_of_time():
    """Streams interleave; every route counts its own passages; the same seed draws the same day."""
    schedule = Schedule(
        name="day",
        streams=(
            Times(route="a", times=np.array([30.0, 10.0, 20.0])),
            Times(route="b", times=np.array([15.0, 25.0])),
        ),
    )
    departures = schedule.draw(rng())
    np.testing.assert_array_equal(departures.time, [10.0, 15.0, 20.0, 25.0, 30.0])
    assert [departures.route[i] for i in departures.which] == ["a", "b", "a", "b", "a"]
    np.testing.assert_array_equal(departures.numbers, [0, 0, 1, 1, 2])
    assert departures.counts() == {"a": 3, "b": 2}
    assert (schedule.per_day, schedule.is_random) == (5.0, False)
    stream = Schedule(name="r", streams=(Poisson.by_hour(np.full(24, 3.0), {"a": 1, "b": 2}),))
    first, again = stream.draw(rng(9)), stream.draw(rng(9))
    np.testing.assert_array_equal(first.time, again.time)
    np.testing.assert_array_equal(first.which, again.which)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Times(route="a", times=np.array([-1.0])), "within a day"),
        (lambda: Times(route="a", times=np.array([DAY])), "within a day"),
        (lambda: evenly("a", first=10.0, last=5.0, headway=1.0), "must come after"),
        (lambda: evenly("a", first=0.0, last=DAY, headway=0.1), "lengthen the headway"),
        (lambda: Poisson.by_hour(np.zeros(23), {"a": 1.0}), "shape"),
        (lambda: Poisson.by_hour(np.full(24, -1.0), {"a": 1.0}), "0 or more"),
        (lambda: Poisson.by_hour(np.full(24, 1e6), {"a": 1.0}), "at most"),
        (lambda: Poisson.by_hour(np.ones(24), {}), "at least one route"),
        (lambda: Poisson.by_hour(np.ones(24), {"a": 0.0}), "share of a"),
        (lambda: Poisson.through(start=9.0, end=8.0, rate=1.0, mix={"a": 1.0}), "must rise"),
        (lambda: Schedule(name="d", streams=()), "nobody drives"),
        (lambda: Schedule(name="d", streams=(Times(route="a", times=np.array([])),)), "nobody"),
    ],
)
def test_what_is_no_schedule_is_refused(make, words):
    """Every mistake names what is wrong."""
    with pytest.raises(InputError, match=words):
        make()
