"""Run a day: every passage on its own, added up in time, read by a meter part by part.

The floor is linear, so the motion under a schedule is the sum of the motions under its passages,
each put off by its departure. Passages of a route share a layout: a few dozen of them are run at
once, as an ensemble is, and let go of when the last of their motion has been read. Time passes in
parts of some thousand steps; where nobody is there and the floor has come to rest it is passed
over. So cost and memory follow what is on the floor, not the length of the schedule. What is left
out is that a vehicle feels what another does to the floor; `meeting_error` says how much that is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._progress import Progress
from trundle._typing import Array
from trundle.errors import InputError
from trundle.response import behind_isolators
from trundle.response.meter import CurveLimit, Meter
from trundle.signals import Isolation, mid_band_frequencies, weight
from trundle.simulate import Layout, MeanResponse, Runs, batches, runs_with_mean
from trundle.simulate.ensembles import batch_size
from trundle.traffic.tally import Present, Tally
from trundle.traffic.timetable import Departures

__all__ = ["on_one_day"]

_TOGETHER = 64  # passages of a route that are run at once at most
_PART = 4096  # steps read at once
_FADE = 1.0  # s, over which the motion of a passage fades out at its end
_RINGS = 10.0  # s that filters ring on when nobody is there any more
_FIELDS = ("displacement", "velocity", "acceleration", "felt")


def on_one_day(
    layouts: Mapping[str, Layout],
    departures: Departures,
    curves: Sequence[CurveLimit],
    *,
    seed: int,
    factor: float = 1.0,
    isolations: Mapping[str, Isolation] | None = None,
    sideways: Sequence[int] = (),
    progress: Progress | None = None,
) -> Tally:
    """Run a day, and tell what lay above which limit, when.

    Parameters
    ----------
    layouts : mapping of str to Layout
        One passage on each route, with the same points and the same step.
    departures : Departures
        Who departs when; a departure falls on the nearest step.
    curves : sequence of CurveLimit
        What is watched.
    seed : int
        Seed of all roads; the k-th passage of a route drives on the road of its k-th run.
    factor : float
        How many times rougher the road is than that of the layouts.
    isolations : mapping of str to Isolation, optional
        What stands between floor and tool at some of the points.
    sideways : sequence of int
        Points that read level motion, which people feel otherwise.
    progress : callable, optional
        Told the share of passages done.
    """
    first = next(iter(layouts.values()))
    fs = 1.0 / first.integration.dt
    if any(one.integration.dt != first.integration.dt for one in layouts.values()):
        raise InputError("passages of a day need one time step")
    tally = Tally(curves, first.point_names, fs)
    meter = Meter(curves, mid_band_frequencies(), fs)
    passages = _Passages(layouts, departures, seed, (factor, isolations or {}, sideways))
    for start, stop in passages.busy(round(_RINGS * fs)):
        meter.rest()
        for at in range(start, stop, _PART):
            there = passages.between(at, min(at + _PART, stop))
            tally.take(at, meter.take(there.motion), there)
            if progress is not None:
                progress(passages.share_done)
    tally.end()
    return tally


@dataclass(frozen=True, kw_only=True, eq=False)
class _Passage:
    """One passage with its motion, each (n_points, n_steps)."""

    route: str
    departs: float
    first: int
    motion: Mapping[str, Float[Array, "points steps"]]

    @property
    def behind(self) -> int:
        """Step behind its last."""
        return self.first + self.motion["velocity"].shape[-1]


class _Passages:
    """The motion of all passages, run when their time has come."""

    def __init__(
        self,
        layouts: Mapping[str, Layout],
        departures: Departures,
        seed: int,
        to: tuple[float, Mapping[str, Isolation], Sequence[int]],
    ) -> None:
        self._layouts = layouts
        self._fs = 1.0 / next(iter(layouts.values())).integration.dt
        self._departures = departures
        self._first = np.round(departures.time * self._fs).astype(np.int64)
        lengths = np.array([len(layouts[name].time) for name in departures.route])
        self._length = lengths[departures.which]
        counts = departures.counts()
        self._coming = {
            name: _runs_of(layouts[name], counts[name], seed, to) for name in departures.route
        }
        self._next, self._there = 0, list[_Passage]()

    @property
    def share_done(self) -> float:
        """Share of the passages that have departed."""
        return self._next / max(1, len(self._first))

    def busy(self, rings: int) -> Iterator[tuple[int, int]]:
        """Give the steps during which somebody is there, or filters still ring."""
        ends = np.maximum.accumulate(self._first + self._length) + rings
        breaks = np.flatnonzero(self._first[1:] > ends[:-1]) + 1
        for some in np.split(np.arange(len(self._first)), breaks):
            if len(some):
                yield int(self._first[some[0]]), int(ends[some[-1]])

    def between(self, start: int, stop: int) -> Present:
        """Return the motion of all that are there between two steps."""
        self._there = [one for one in self._there if one.behind > start]
        while self._next < len(self._first) and self._first[self._next] < stop:
            which = int(self._departures.which[self._next])
            name = self._departures.route[which]
            self._there.append(
                _Passage(
                    route=name,
                    departs=float(self._departures.time[self._next]),
                    first=int(self._first[self._next]),
                    motion=next(self._coming[name]),
                )
            )
            self._next += 1
        points = len(next(iter(self._layouts.values())).point_names)
        motion = {name: np.zeros((points, stop - start)) for name in _FIELDS}
        here: list[_Passage] = []
        for one in self._there:
            low, high = max(start, one.first), min(stop, one.behind)
            if high <= low:
                continue
            for name, total in motion.items():
                total[:, low - start : high - start] += one.motion[name][
                    :, low - one.first : high - one.first
                ]
            here.append(one)
        return Present(
            start=start,
            motion=motion,
            who=tuple((p.route, p.departs, p.first, p.motion["velocity"]) for p in here),
        )


def _runs_of(
    layout: Layout,
    n_runs: int,
    seed: int,
    to: tuple[float, Mapping[str, Isolation], Sequence[int]],
) -> Iterator[dict[str, Float[Array, "points steps"]]]:
    """Give the motion of one run after the other, some run at once."""
    factor, isolations, sideways = to
    mean: MeanResponse | None = None
    if factor != 1.0 and any(source.random for source in layout.sources):
        mean = runs_with_mean(layout, runs=range(1), seed=seed)[1]
    size = min(_TOGETHER, batch_size(layout))
    for runs in batches(layout, runs=range(n_runs), seed=seed, batch=size):
        some = runs if mean is None else runs.on_scaled_road(mean, factor)
        yield from _motions(behind_isolators(some, isolations), list(sideways))


def _motions(runs: Runs, sideways: list[int]) -> Iterator[dict[str, Float[Array, "points steps"]]]:
    """Give the motion of each of some runs, faded out at its end: a sudden one would be a blow."""
    fs = runs.sampling_frequency
    n_fade = min(round(_FADE * fs), len(runs.time))
    fade = 0.5 + 0.5 * np.cos(np.pi * np.arange(1, n_fade + 1) / n_fade)
    moved = {
        name: np.ascontiguousarray(np.moveaxis(getattr(runs, name), 1, -1))
        for name in ("displacement", "velocity", "acceleration")
    }
    moved["felt"] = weight(moved["acceleration"], fs, "Wb")
    if sideways:
        moved["felt"][:, sideways] = weight(moved["acceleration"][:, sideways], fs, "Wd")
    for values in moved.values():
        values[..., -n_fade:] *= fade
    for i in range(runs.n_runs):
        yield {name: values[i] for name, values in moved.items()}
