"""Hold what a day of passages gave, one after the other and at once."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float, Int

from trundle._typing import Array

__all__ = ["Day", "Loudest", "Meeting"]


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """Hold who was on the floor when a level was largest, and what each alone gave then.

    Attributes
    ----------
    route : str
        Name of the route.
    departed : float
        When it departed [s of the day].
    x, y : float
        Where its front axle stood in its surface [m]; NaN where it had left already.
    rms_velocity : float
        RMS velocity that it gave by itself over the second of the largest level [m/s].
    """

    route: str
    departed: float
    x: float
    y: float
    rms_velocity: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Loudest:
    """Hold the largest running level of a day at one point, beside one criterion.

    Attributes
    ----------
    criterion, point : str
        Names.
    ratio : float
        Level over limit in the worst band: above 1 the limit was exceeded.
    band : float
        Mid-band frequency of it [Hz]; NaN for single numbers.
    time : float
        End of the second that it was taken over [s of the day].
    present : tuple of Meeting
        Who was there, the loudest first.
    """

    criterion: str
    point: str
    ratio: float
    band: float
    time: float
    present: tuple[Meeting, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Day:
    """Hold one day of a schedule, run passage by passage and added up in time.

    Attributes
    ----------
    schedule : str
        Name of the schedule.
    n_passages : int
        How many departed.
    counts : dict of str to int
        How many on each route.
    busy : float
        For how long anybody was there, or the floor still rang [s].
    at_once : int
        How many were on the floor at once at most.
    point_names, criteria : tuple of str
        Names along the axes below.
    complete : tuple of bool
        Whether everything that each criterion asks for was computed; where not, what lies above it
        is a lower bound.
    seconds_above : ndarray of float, shape (24, n_criteria, n_points)
        For how long the running level of 1 s lay above the limit in each hour [s]; NaN for
        criteria without a running level.
    events : ndarray of int, shape (24, n_criteria, n_points)
        How often it came to lie above, in each hour; times less than 5 s apart are one event.
    loudest : tuple of Loudest
        The largest levels, by criterion and point.
    dose_day, dose_night : ndarray of float, shape (n_points,)
        Vibration dose values from 7 to 23 h and of the other hours [m/s^1.75] (BS 6472-1).
    meeting_error : float
        Largest relative difference of the RMS velocity at a point if the two that meet closest were
        run together, each feeling what the other does to the floor; NaN if nobody meets.
    """

    schedule: str
    n_passages: int
    counts: dict[str, int]
    busy: float
    at_once: int
    point_names: tuple[str, ...]
    criteria: tuple[str, ...]
    complete: tuple[bool, ...]
    seconds_above: Float[Array, "24 criteria points"]
    events: Int[Array, "24 criteria points"]
    loudest: tuple[Loudest, ...]
    dose_day: Float[Array, " points"]
    dose_night: Float[Array, " points"]
    meeting_error: float
