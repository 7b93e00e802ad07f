"""Say who drives when, and how much of a day lies above a limit."""

from trundle.traffic.day import Day, Loudest, Meeting
from trundle.traffic.expected import Expected, OnePassage, expected_day
from trundle.traffic.meeting import closest_meeting, lay_out_meeting, meeting_error
from trundle.traffic.superpose import on_one_day
from trundle.traffic.timetable import DAY, Departures, Poisson, Schedule, Stream, Times, evenly

__all__ = [
    "DAY",
    "Day",
    "Departures",
    "Expected",
    "Loudest",
    "Meeting",
    "OnePassage",
    "Poisson",
    "Schedule",
    "Stream",
    "Times",
    "closest_meeting",
    "evenly",
    "expected_day",
    "lay_out_meeting",
    "meeting_error",
    "on_one_day",
]
