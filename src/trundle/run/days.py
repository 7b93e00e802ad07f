"""Run a day of a schedule, on every road of a job."""

from __future__ import annotations

import numpy as np

from trundle._progress import Progress
from trundle.criteria import watched
from trundle.results.parts import DayPart
from trundle.run.departures import departures_of
from trundle.run.jobs import Job, PreparedJob
from trundle.signals import mid_band_frequencies
from trundle.simulate import Coverage, coverage_of
from trundle.traffic import Day, Departures, Loudest, Meeting, meeting_error, on_one_day
from trundle.traffic.tally import Tally

__all__ = ["day_part"]


def day_part(job: Job, laid_out: PreparedJob, *, progress: Progress | None = None) -> DayPart:
    """Run a day, and keep what lay above which limit, when, and who was there.

    Parameters
    ----------
    job : Job
        With a schedule.
    laid_out : PreparedJob
        With one passage on each route.
    progress : callable, optional
        Told the share done.
    """
    assert job.schedule is not None  # else it is no day
    departures = departures_of(job.schedule, job.sources, job.seed)
    error = meeting_error(laid_out.alone, departures, laid_out.meeting, seed=job.seed)
    layout, reaches = laid_out.layout, _reaches(laid_out)
    read = {"f_max": layout.f_max, "sampling_frequency": 1.0 / layout.integration.dt}
    # bands are read as far as anybody excites them; all is known only as far as everybody does
    widest = max(reaches, key=lambda one: one.excited_to)
    curves, _ = watched(job.watched, coverage=widest, **read)
    each = [watched(job.watched, coverage=one, **read)[1] for one in reaches]
    complete = tuple(all(flags) for flags in zip(*each, strict=True))
    days = []
    for i, factor in enumerate(job.factors.values()):

        def tell(share: float, i: int = i) -> None:
            """Tell the share of all roads."""
            if progress is not None:
                progress((i + share) / len(job.factors))

        tally = on_one_day(
            laid_out.alone, departures, curves, seed=job.seed, factor=factor,
            isolations=job.isolations, sideways=job.sideways, progress=tell,
        )  # fmt: skip
        days.append(_day(job, departures, tally, complete, error))
    return DayPart(days=tuple(days))


def _reaches(laid_out: PreparedJob) -> list[Coverage]:
    """Return how far one passage on each route of a day reaches."""
    return [coverage_of(one.sources, float(one.time[-1])) for one in laid_out.alone.values()]


def _day(
    job: Job, departures: Departures, tally: Tally, complete: tuple[bool, ...], error: float
) -> Day:
    """Return what a tally holds as a value of results."""
    assert job.schedule is not None
    dose = tally.dose**0.25
    return Day(
        schedule=job.schedule.name,
        n_passages=len(departures),
        counts=departures.counts(),
        busy=tally.busy,
        at_once=tally.at_once,
        point_names=tally.point_names,
        criteria=tuple(curve.name for curve in tally.curves),
        complete=complete,
        seconds_above=tally.seconds_above,
        events=tally.events,
        loudest=tuple(_loudest(job, tally)),
        dose_day=dose[0],
        dose_night=dose[1],
        meeting_error=error,
    )


def _loudest(job: Job, tally: Tally) -> list[Loudest]:
    """Return the largest level beside every criterion at every point, and who was there."""
    bands = mid_band_frequencies()
    sources = {source.name: source for source in job.sources}
    found = []
    for curve, row in zip(tally.curves, tally.peaks, strict=True):
        if not curve.is_read:
            continue
        for point, peak in zip(tally.point_names, row, strict=True):
            time = peak.step / tally.fs
            present = []
            for route, departed, rms in peak.who:
                place, _ = sources[route].stands_at(time - departed)
                x, y = place or (np.nan, np.nan)
                present.append(Meeting(route=route, departed=departed, x=x, y=y, rms_velocity=rms))
            found.append(
                Loudest(
                    criterion=curve.name,
                    point=point,
                    ratio=float(np.sqrt(peak.square)),
                    band=float(bands[peak.band]) if len(curve.limits) > 1 else np.nan,
                    time=time,
                    present=tuple(present),
                )
            )
    return found
