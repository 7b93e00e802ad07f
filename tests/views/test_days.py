"""What is said of a day in words: numbers as people write them, what overlaps, who was there."""

import numpy as np
import pytest

from studies import GOOD
from trundle.run.whole_study import run_study
from trundle.study_file.build import study_from_text
from trundle.traffic import Loudest, Meeting
from trundle.views.days import clock, day_views, loudest_words

DAY = """
[[schedule]]
name = "day"
route = "main"
{how}
"""


def views(how):
    text = GOOD.replace('duration = "4 s"', "").replace(
        'interaction = "coupled"', 'interaction = "decoupled"'
    )
    return day_views(run_study(study_from_text(text + DAY.format(how=how))))


def test_a_quiet_day_overlaps_nowhere():
    """Two passages: as many are said, and nothing of overlaps; decoupled their sum is exact."""
    (one,) = views('times = ["8:00", "8:00:20"]')
    assert one.passages.startswith("2 passages a day (main 2); on the day that was run 2, up to")
    assert "overlap" not in one.passages
    assert all("nan" not in f"{line.events}{line.minutes}{line.run}" for line in one.lines)


def test_a_crowded_hour_is_named():
    """A truck every 12 s, each on record for some 12 s and more: the hour is filled by them."""
    (one,) = views('headway = "12 s"\nfrom = "8:00"\nto = "8:20"')
    assert "100 passages a day" in one.passages
    filled = int(one.passages.partition("they fill ")[2].partition(" %")[0])
    assert 30 < filled < 100  # a third of an hour's seconds, records beside each other


@pytest.mark.parametrize(
    ("seconds", "said"), [(0.0, "00:00:00"), (30615.9, "08:30:15"), (86399.0, "23:59:59")]
)
def test_times_are_told_by_the_clock(seconds, said):
    """Whole seconds of the day."""
    assert clock(seconds) == said


def test_who_was_there_is_told_with_place_and_share():
    """Band by its name, ratio, time; who has left its route is leaving."""
    present = (
        Meeting(route="main", departed=30600.0, x=3.0, y=2.0, rms_velocity=2e-4),
        Meeting(route="lane", departed=30590.0, x=np.nan, y=np.nan, rms_velocity=5e-6),
    )
    one = Loudest(
        criterion="VC-A", point="p", ratio=4.2, band=10**0.9, time=30604.5, present=present
    )
    assert loudest_words(one) == (
        "4.2 times the limit at 8 Hz, 08:30:04: main of 08:30:00 at (3.0, 2.0) m, alone 200 um/s; "
        "lane of 08:29:50 leaving, alone 5 um/s"
    )
