"""What to expect of a day, against tables, closed forms and days that are drawn."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.traffic import OnePassage, expected_day
from trundle.traffic.expected import binomial_interval


def passage(n_above, n, seconds=2.0):
    """n runs, of which so many exceed for some seconds each."""
    exceeds = np.arange(n) < n_above
    return OnePassage(exceeds=exceeds, seconds=np.where(exceeds, seconds, 0.0))


def hours(total, *some):
    out = np.zeros(24)
    out[list(some)] = total / len(some)
    return out


@pytest.mark.parametrize(
    ("k", "n", "low", "high"),
    [
        (0, 10, 0.0, 0.3085),  # 1 - 0.025^(1/10)
        (1, 10, 0.0025, 0.4450),
        (5, 10, 0.1871, 0.8129),
        (10, 10, 0.6915, 1.0),
        (2, 30, 0.0082, 0.2207),
    ],
)
def test_the_interval_of_a_chance_is_the_tabulated_one(k, n, low, high):
    """Clopper and Pearson's 95 % limits, as tables of exact binomial limits print them."""
    assert binomial_interval(k, n) == pytest.approx((low, high), abs=6e-5)


def test_events_are_passages_times_their_chance():
    """30 of 100 runs exceed; 400 passages: 120 events, 4 minutes of 2 s each; by hour alike."""
    found = expected_day({"a": passage(30, 100)}, {"a": hours(400.0, 8, 9)}, random=True)
    assert found.events == pytest.approx(120.0)
    assert found.minutes == pytest.approx(120.0 * 2.0 / 60.0)
    assert found.by_hour[8] == pytest.approx(60.0)
    low, high = binomial_interval(30, 100)
    assert found.events_interval == pytest.approx((400 * low, 400 * high))


def test_limits_of_one_route_are_those_of_the_sum():
    """A second route that never exceeds adds its own uncertainty above, and nothing below."""
    one = expected_day({"a": passage(30, 100)}, {"a": hours(400.0, 8)}, random=True)
    both = expected_day(
        {"a": passage(30, 100), "b": passage(0, 100)},
        {"a": hours(400.0, 8), "b": hours(100.0, 9)}, random=True,
    )  # fmt: skip
    assert both.events == one.events
    assert both.events_interval[0] == pytest.approx(one.events_interval[0])
    above = one.events_interval[1] - 120.0
    other = 100.0 * binomial_interval(0, 100)[1]
    assert both.events_interval[1] == pytest.approx(120.0 + np.hypot(above, other))


@pytest.mark.parametrize("random", [True, False])
def test_days_scatter_as_days_that_are_drawn(random):
    """20,000 days: shares of days within the limits, and with any event, by brute force."""
    passages = {"a": passage(3, 100), "b": passage(20, 100)}
    counts = {"a": hours(40.0, 8), "b": hours(10.0, 9)}
    found = expected_day(passages, counts, random=random)
    rng = np.random.default_rng(4)
    n_a = rng.poisson(40.0, 20_000) if random else np.full(20_000, 40)
    n_b = rng.poisson(10.0, 20_000) if random else np.full(20_000, 10)
    events = rng.binomial(n_a, 0.03) + rng.binomial(n_b, 0.2)
    assert found.any_event == pytest.approx(np.mean(events > 0), abs=0.01)
    low, high = found.events_on_days
    assert 0.94 < np.mean((events >= low) & (events <= high)) <= 1.0
    # no narrower limits would do: one less at the top leaves more out than a normal law may
    assert np.mean(events <= high - 2) < 0.99


def test_the_interval_of_the_mean_holds_the_truth_as_often_as_it_says():
    """100 runs of a passage whose chance is 0.1: over 600 studies at least 93 % hold 40 events."""
    rng = np.random.default_rng(8)
    held = 0
    for _ in range(600):
        exceeds = rng.random(100) < 0.1
        one = OnePassage(exceeds=exceeds, seconds=exceeds * rng.exponential(2.0, 100))
        found = expected_day({"a": one}, {"a": hours(400.0, 8)}, random=True)
        low, high = found.events_interval
        held += low <= 40.0 <= high
    assert held / 600 > 0.93


def test_where_no_run_exceeds_nobody_knows_how_long_one_would():
    """No event of 50 runs: at most 7 % of 100 passages, and no upper limit of minutes."""
    found = expected_day({"a": passage(0, 50)}, {"a": hours(100.0, 8)}, random=True)
    assert (found.events, found.minutes, found.any_event) == (0.0, 0.0, 0.0)
    assert found.events_interval[1] == pytest.approx(100.0 * (1.0 - 0.025 ** (1 / 50)))
    assert np.isnan(found.minutes_interval[1])


def test_routes_without_runs_are_refused():
    """What was not computed is no zero."""
    with pytest.raises(InputError, match="no runs of b"):
        expected_day({"a": passage(1, 2)}, {"b": hours(1.0, 0)}, random=True)
