"""Time stamps become seconds: by the clock, over midnight and noon, rounded, with gaps."""

from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.records.stamps import clock_begin, clock_seconds, even_rate, is_stamp, on_even_time

PATH = Path("logger.csv")


def since_first(stamps, form):
    """Seconds since the first stamp, by Python's own calendar."""
    times = [datetime.strptime(stamp, form) for stamp in stamps]
    return [(time - times[0]).total_seconds() for time in times]


@pytest.mark.parametrize(
    ("stamps", "form"),
    [
        (["2024-02-28T23:59:59.500", "2024-02-29T00:00:00.500", "2024-03-01T00:00:00.250"],
         "%Y-%m-%dT%H:%M:%S.%f"),
        (["31.12.2023 23:59:59.750", "01.01.2024 00:00:00.250"], "%d.%m.%Y %H:%M:%S.%f"),
        (["11.05.2024 23:59:58.000", "12.05.2024 00:00:01.000", "13.05.2024 00:00:01.000"],
         "%d.%m.%Y %H:%M:%S.%f"),
        (["2024/07/01 08:00:00.125", "2024/07/01 20:00:00.375"], "%Y/%m/%d %H:%M:%S.%f"),
        (["05/11/2024 23:59:59.000", "05/12/2024 00:00:01.000"], "%m/%d/%Y %H:%M:%S.%f"),
        (["05/12/2024 23:59:59.000", "05/13/2024 00:00:01.000"], "%m/%d/%Y %H:%M:%S.%f"),
        (["05/11/2024 23:59:59.000", "06/11/2024 00:00:01.000"], "%d/%m/%Y %H:%M:%S.%f"),
        (["05.11.2024 23:59:59.000", "05.12.2024 00:00:01.000"], "%d.%m.%Y %H:%M:%S.%f"),
        (["24-05-03 23:59:59.000", "24-05-04 00:00:01.000"], "%y-%m-%d %H:%M:%S.%f"),
        (["2024-05-11 23:59:59.000", "2024-06-11 00:00:01.000"], "%Y-%m-%d %H:%M:%S.%f"),
    ],
)  # fmt: skip
def test_dates_are_counted_over_midnights_leap_days_and_years(stamps, form):
    """Python's calendar gives the same distances: a leap day, a year's end, days 11 to 13.

    All dates of a record stand in one order: that by which it is shortest, where several may be;
    between points the day stands first, and four digits are a year.
    """
    found = clock_seconds([stamps], PATH)
    np.testing.assert_allclose(found, since_first(stamps, form), atol=1e-9)


def test_a_date_and_a_time_of_day_may_stand_in_two_columns():
    """The same instants as in one column: 1.5 s apart over midnight."""
    date = ["30.11.2024", "01.12.2024"]
    clock = ["23:59:59,000", "00:00:00,500"]
    np.testing.assert_allclose(clock_seconds([date, clock], PATH), [0.0, 1.5])


@pytest.mark.parametrize(
    ("first", "second", "apart"),
    [
        ("11:59:59 AM", "12:00:00 PM", 1.0),
        ("12:59:59 PM", "01:00:00 PM", 1.0),
        ("12:00:00 AM", "12:30:00 PM", 12.5 * 3600.0),
        ("11:59:59 PM", "12:00:01 AM", 2.0),
        ("23:59:59.9", "00:00:00.1", 0.2),
        ("10:00:00:250", "10:00:01:125", 0.875),
        ("9:58", "10:01", 180.0),
    ],
)
def test_times_of_day_pass_noon_and_midnight(first, second, apart):
    """By hand on a clock with twelve and with twenty-four hours; 12 AM is the day's beginning."""
    np.testing.assert_allclose(clock_seconds([[first, second]], PATH), [0.0, apart], atol=1e-9)


def test_every_midnight_of_a_record_without_dates_counts():
    """Four stamps twelve hours apart pass two midnights: 0, 12, 24 and 36 h."""
    stamps = ["18:00:00", "06:00:00", "18:00:00", "06:00:00"]
    with_days = clock_seconds([["20:00:00", "04:00:00", "12:00:00", "20:00:00", "04:00:00"]], PATH)
    np.testing.assert_allclose(with_days, 8.0 * 3600.0 * np.arange(5))
    # exactly half a day back is not told from a stamp that went wrong
    assert np.any(np.diff(clock_seconds([stamps], PATH)) <= 0.0)


@pytest.mark.parametrize("bad", ["2024-13-40 10:00:00", "30.02.2024 10:00:00"])
def test_a_day_that_no_calendar_has_is_named_with_its_place(bad):
    """There is no 30 February, and no month 13; the second of two stamps is the one to mend."""
    with pytest.raises(InputError, match=r"logger.csv: time stamp 2, .* cannot be read"):
        clock_seconds([["2024-02-01 10:00:00", bad]], PATH)


def test_stamps_are_told_from_numbers_and_words():
    """A version, a ratio and a decimal comma are no time; dates and clocks of any order are."""
    for stamp in ("10:00", "10:00:00.5", "3.5.24", "2024-05-03", '"10:00:00,5"',
                  "2024-05-03T10:00:00+02:00", "5/3/2024 1:00:00 PM"):  # fmt: skip
        assert is_stamp(stamp), stamp
    for other in ("1.5", "-0,25", "10", "a:b", "1:2", "12:345", "2024-05", "1e-3", ""):
        assert not is_stamp(other), other


@pytest.mark.parametrize("decimals", [1, 2, 3])
def test_the_rate_is_that_of_the_whole_record_and_not_of_one_step(decimals):
    """30 Hz written to tenths gives steps of 0 and 0.1 s: 3000 intervals in 100 s are 30 a second."""
    time = np.round(np.arange(3001) / 30.0, decimals)
    assert even_rate(time, PATH) == pytest.approx(30.0, rel=1e-3)


def test_coarse_stamps_take_a_stated_rate_only_where_they_allow_it():
    """Whole seconds over 20 s leave a doubt of 5 %: 49 Hz may be stated, 60 Hz contradicts."""
    time = np.floor(np.arange(1000) / 50.0)
    seen = 999 / 19.0
    assert even_rate(time, PATH, stated=51.0) == 51.0
    for stated in (None, seen * 1.2):
        with pytest.raises(InputError, match=r"may be 5.* % off; say it by --rate"):
            even_rate(time, PATH, stated=stated)
    long = np.floor(np.arange(50_000) / 50.0)
    assert even_rate(long, PATH) == pytest.approx(50.0, rel=0.002)


def test_time_that_stands_or_falls_is_refused():
    """A sorted record is told from one that is not by a single step back."""
    time = np.arange(200) / 100.0
    back = time.copy()
    back[50] = back[48]
    back[49] = back[51]
    for wrong in (back, np.full(200, 3.0), time[::-1]):
        with pytest.raises(InputError, match="time does not rise; sort the record"):
            even_rate(wrong, PATH)
    with pytest.raises(InputError, match=r"logger\.csv: "):
        even_rate(np.where(np.arange(200) == 7, np.nan, time), PATH)


def test_the_gap_is_named_where_it_is():
    """0.3 s are lost behind 1.99 s of a record at 100 Hz: its step is 0.31 s instead of 0.01 s."""
    time = np.arange(400) / 100.0
    time[200:] += 0.3
    with pytest.raises(InputError, match=r"widest after 1.99 s \(0.31 s instead of 0.01 s\)"):
        even_rate(time, PATH)


def test_samples_at_stray_stamps_are_put_on_an_even_time():
    """A cubic spline gives back a cubic exactly, wherever it was sampled; NaN stays a hole alone."""
    rng = np.random.default_rng(3)
    time = np.sort(np.arange(300) / 100.0 + 2e-3 * rng.uniform(-1, 1, 300))
    cubic = 1.0 + 2.0 * time - 3.0 * time**2 + 0.5 * time**3
    holed = np.where(np.arange(300) == 9, np.nan, cubic)
    rate, samples, note = on_even_time(time, np.stack([cubic, holed]))
    assert rate == pytest.approx(299.0 / (time[-1] - time[0]))
    even = time[0] + np.arange(300) / rate
    np.testing.assert_allclose(samples[0], 1.0 + 2 * even - 3 * even**2 + 0.5 * even**3, rtol=1e-9)
    assert np.isnan(samples[1]).all()
    assert f"{1e3 * np.abs(time - even).max():.3g} ms from an even time" in note


@pytest.mark.parametrize(
    ("columns", "begin"),
    [
        (
            [["2024-05-03 22:59:50.5", "2024-05-03 22:59:50.6"]],
            datetime(2024, 5, 3, 22, 59, 50, 500000),
        ),
        ([["03.05.2024", "03.05.2024"], ["08:00:00", "08:00:01"]], datetime(2024, 5, 3, 8)),
        ([["23:59:59", "00:00:00"]], datetime(1, 1, 2, 23, 59, 59)),
        ([["11:00:00 PM", "11:00:01 PM"]], datetime(1, 1, 2, 23)),
        ([["2024-05-03T22:00:00Z", "2024-05-03T22:00:01Z"]], None),
        ([["2024-05-03", "2024-05-04"]], None),
        ([["25:00:00", "25:00:01"]], None),
        ([["99/99/2024 10:00:00", "99/99/2024 10:00:01"]], None),
    ],
)
def test_the_time_of_the_first_stamp_is_known_where_it_is_told(columns, begin):
    """By date or by time of day; not by Greenwich's clock, a date alone, or what is no time."""
    assert clock_begin(columns) == begin
