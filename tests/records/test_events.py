"""Events of a record: made bursts are found when they are, by the rule that is told."""

from datetime import datetime

import numpy as np
import pytest

from trundle.criteria import VC, find_criterion
from trundle.records.assess import assess_record
from trundle.records.doses import doses
from trundle.signals import Record
from trundle.views.record_survey import event_rows

FS = 200.0
SECONDS = 60.0


def assessed(bursts, *, quiet=0.02e-6, criteria=VC, seconds=SECONDS, **more):
    """A hum of 16 Hz, and bursts of 10 Hz: from, to [s], RMS [m/s]."""
    t = np.arange(round(seconds * FS)) / FS
    row = np.sqrt(2.0) * quiet * np.sin(2.0 * np.pi * 15.85 * t)
    for start, end, rms in bursts:
        row += np.where((t >= start) & (t < end), np.sqrt(2.0) * rms, 0.0) * np.sin(
            20.0 * np.pi * t
        )
    record = Record(
        samples=row[None], sampling_frequency=FS, quantity="velocity", channel_names=("z",), **more
    )
    return assess_record(record, criteria)


def test_a_burst_above_a_curve_is_found_where_it_is():
    """40 um/s exceeds VC-B (25), the widest exceeded: start and end within half a window of 1 s."""
    (found,) = assessed([(20.0, 26.0, 40e-6)]).events
    assert (found.criterion.name, found.exceeded, found.threshold) == ("VC-B", True, 1.0)
    (event,) = found.events
    # a window holds enough of the burst once (25 / 40)^2 = 0.39 s are in it; the filter rises in 0.3 s
    assert event.start == pytest.approx(20.0 - 0.5 + 0.39, abs=0.35)
    assert event.end == pytest.approx(26.0 + 0.5 - 0.20, abs=0.35)
    assert event.level == pytest.approx(40e-6, rel=0.05)
    assert event.band == pytest.approx(10.0)
    assert event.ratio == pytest.approx(40.0 / 25.0, rel=0.05)
    assert (event.begins_before, event.ends_after) == (False, False)
    assert "above VC-B, the first curve that is exceeded" in found.rule


def test_pauses_shorter_than_a_window_do_not_end_an_event_and_longer_ones_do():
    """0.6 s of rest within: one; 6 s: two, each at its time."""
    (one,) = assessed([(20.0, 23.0, 40e-6), (23.6, 26.0, 40e-6)]).events
    assert len(one.events) == 1
    (two,) = assessed([(20.0, 23.0, 40e-6), (29.0, 32.0, 45e-6)]).events
    assert [round(e.start) for e in two.events] == [20, 29]
    assert two.events[1].level > two.events[0].level


def test_a_quiet_record_has_events_6_db_above_its_median():
    """Nothing exceeds VC-E (3.12 um/s): a burst of 1 um/s over a hum of 0.1 is 20 dB above it."""
    (found,) = assessed([(20.0, 24.0, 1e-6)], quiet=0.1e-6).events
    assert (found.criterion.name, found.exceeded) == ("VC-E", False)
    assert found.median == pytest.approx(0.1 / 3.12, rel=0.05)
    assert found.threshold == pytest.approx(2.0 * found.median)
    assert [round(e.start) for e in found.events] == [20]
    assert "6 dB above its median, beside VC-E, not exceeded" in found.rule


def test_a_steady_hum_is_no_event_even_above_a_curve():
    """30 um/s all the time exceeds VC-B all the time, and never stands out of itself."""
    (found,) = assessed([], quiet=30e-6).events
    assert found.events == ()
    assert found.share_above == pytest.approx(1.0, abs=0.02)
    assert "is exceeded 1" in found.rule  # 100 % of the time
    (loud,) = assessed([(20.0, 24.0, 200e-6)], quiet=30e-6).events
    assert [e.start for e in loud.events] == pytest.approx([20.0], abs=0.7)


def test_events_that_the_record_s_ends_cut_are_told():
    result = assessed([(0.0, 4.0, 40e-6), (57.0, 60.0, 40e-6)])
    first, last = result.events[0].events
    assert (first.begins_before, first.ends_after) == (True, False)
    assert (last.begins_before, last.ends_after) == (False, True)
    assert [row["cut"] for row in event_rows(result)] == ["beginning", "end"]


def test_without_a_curve_of_velocity_all_motion_counts():
    """A limit on peaks has no running level: 6 dB above the median of the RMS of all motion."""
    peaks = [find_criterion("electron-microscope-vertical")]
    (found,) = assessed([(20.0, 24.0, 40e-6)], quiet=1e-6, criteria=peaks).events
    assert found.criterion is None
    assert found.threshold == pytest.approx(2e-6, rel=0.05)
    (event,) = found.events
    assert event.level == pytest.approx(40e-6, rel=0.03)
    assert np.isnan(event.band)
    assert "running RMS velocity 6 dB above its median" in found.rule


def test_events_say_the_time_of_day_where_it_is_known():
    begin = datetime(2024, 5, 3, 22, 59, 50)
    (row,) = event_rows(assessed([(20.0, 26.0, 40e-6)], begin=begin))
    assert row["clock"].startswith("2024-05-03 23:00:0") or row["clock"].startswith(
        "2024-05-03 23:00:1"
    )
    (row,) = event_rows(assessed([(20.0, 26.0, 40e-6)], begin=datetime(1, 1, 2, 12, 0, 0)))
    assert row["clock"][:7] in {"12:00:1", "12:00:2"}
    assert row["criterion"] == "VC-B"
    assert row["margin"] == pytest.approx(25.0 / 40.0, rel=0.05)


def test_doses_fall_into_days_and_nights_and_add_up_by_fourth_powers():
    """22 to 8 h, a constant 1 m4/s7 a second: 1 h of day, 8 h of night, 1 h of the next day."""
    hours = 10
    dose = np.ones((1, hours * 3600))
    evening, night, morning = doses(dose, hours * 3600.0, datetime(2024, 5, 3, 22, 0, 0))
    assert [p.period for p in (evening, night, morning)] == [
        "day, 7 to 23 h, 2024-05-03", "night, 23 to 7 h, 2024-05-03", "day, 7 to 23 h, 2024-05-04",
    ]  # fmt: skip
    assert [p.measured / 3600.0 for p in (evening, night, morning)] == [1.0, 8.0, 1.0]
    assert [p.length / 3600.0 for p in (evening, night, morning)] == [16.0, 8.0, 16.0]
    np.testing.assert_allclose(evening.values, 3600.0**0.25)
    np.testing.assert_allclose(night.values, (8 * 3600.0) ** 0.25)
    total = sum(p.values[0] ** 4 for p in (evening, night, morning))
    assert total == pytest.approx(hours * 3600.0)


def test_a_night_before_midnight_needs_no_date():
    """Times of day alone: from 23:30 for an hour, all of it night; from 6:30, half of it."""
    dose = np.ones((2, 3600))
    (night,) = doses(dose, 3600.0, datetime(1, 1, 2, 23, 30, 0))
    assert night.period == "night, 23 to 7 h"
    first, second = doses(dose, 3600.0, datetime(1, 1, 2, 6, 30, 0))
    assert (first.period, second.period) == ("night, 23 to 7 h", "day, 7 to 23 h")
    assert (first.measured, second.measured) == (1800.0, 1800.0)
    assert first.values.shape == (2,)
