"""Run an ensemble: one set of crossings, one method, many random roads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from jaxtyping import Float

from trundle._checks import count
from trundle._kinds import kinds_checked
from trundle._progress import Progress
from trundle._typing import Array
from trundle.simulate.fitness import contact_warnings
from trundle.simulate.ground import Integration, PreparedFloor
from trundle.simulate.interaction import Interaction
from trundle.simulate.laying_out import Place, lay_out, lay_out_on_rigid_ground
from trundle.simulate.layout import Layout
from trundle.simulate.runs import MeanResponse, Runs
from trundle.simulate.sources.crossing import Crossing
from trundle.simulate.sources.source import Source
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.simulate.wheels.timeline import Timeline, timeline_of
from trundle.structure import Structure

__all__ = [
    "LEAST_BATCH",
    "batches",
    "contact_force_histories",
    "contact_forces",
    "ensemble",
    "runs_with_mean",
]


_BATCH_BYTES = 400e6  # histories and roads held at once
LEAST_BATCH = 16  # runs held at once however long their histories are
_MOST_RUNS = 1024  # in a batch; more would gain nothing


@kinds_checked
def ensemble(
    floor: Structure | PreparedFloor,
    crossings: Crossing | Source | Sequence[Crossing | Source],
    *,
    method: Interaction,
    points: Mapping[str, Place],
    n_runs: int,
    seed: int,
    duration: float | None = None,
    progress: Progress | None = None,
) -> Runs:
    """Run vehicles over a floor on many random roads.

    Parameters
    ----------
    floor : Structure or PreparedFloor
        The floor; prepare it once where several ensembles share it.
    crossings : Crossing, Source, or a sequence of them
        One vehicle or other source, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y) or Spot
        Where the response is read [m].
    n_runs : int
        Number of runs; each draws its own roads.
    seed : int
        Seed of all roads; the same seed gives the same bits.
    duration : float, optional
        Length of the record [s]; until 5 s after the last wheel has left unless given.
    progress : callable, optional
        Told the share of steps done.

    Returns
    -------
    Runs
        Histories at the points and under the wheels.

    Raises
    ------
    InputError
        A point or wheel off the floor, a time step too long for the road's shortest wave.
    UnstableStepError
        A number stopped being finite.
    """
    layout = lay_out(floor, crossings, method=method, points=points, duration=duration)
    runs = range(count("n_runs", n_runs))
    return next(batches(layout, runs=runs, seed=seed, batch=n_runs, progress=progress))


@kinds_checked
def batches(
    layout: Layout,
    *,
    runs: range,
    seed: int,
    batch: int | None = None,
    progress: Progress | None = None,
) -> Iterator[Runs]:
    """Run an ensemble batch by batch, so that memory does not grow with the number of runs.

    Parameters
    ----------
    layout : Layout
        What the runs share, from `lay_out`.
    runs : range
        Numbers of the runs; a run's road depends on the seed and its number alone.
    seed : int
        Seed of all roads.
    batch : int, optional
        Runs in a batch; as many as 400 MB of histories hold unless given.
    progress : callable, optional
        Told the share of all runs' steps done.

    Yields
    ------
    Runs
        The next runs, with their histories.
    """
    size = batch_size(layout) if batch is None else count("batch", batch)
    for start in range(0, len(runs), size):
        part = runs[start : start + size]
        share = (start / len(runs), len(part) / len(runs))
        yield _drive(layout, part, seed, part_of(progress, *share))


def _drive(layout: Layout, runs: range, seed: int, progress: Progress | None) -> Runs:
    """Run some runs; their roads are let go of with the end of this call."""
    road = roads_under_wheels(layout.sources, layout.timeline, runs, seed)
    return _runs_of(layout, layout.over(road, progress=progress), seed)


def runs_with_mean(
    layout: Layout, *, runs: range, seed: int, progress: Progress | None = None
) -> tuple[Runs, MeanResponse]:
    """Run some runs and, beside them, what the static loads give without random roads.

    Parameters
    ----------
    layout : Layout
        What the runs share, from `lay_out`.
    runs : range
        Numbers of the runs.
    seed : int
        Seed of all roads.
    progress : callable, optional
        Told the share of steps done.
    """
    road = roads_under_wheels(layout.sources, layout.timeline, runs, seed, smooth=1)
    record = layout.over(road, progress=progress)
    return _runs_of(layout, record.columns(slice(0, -1)), seed), mean_of(layout, record)


def contact_force_histories(
    layout: Layout, *, runs: range, seed: int
) -> tuple[Float[Array, "steps contacts runs"], Float[Array, "steps contacts 1"]]:
    """Return the contact forces of some runs, and those without random roads [N].

    Parameters
    ----------
    layout : Layout
        What the runs share, from `lay_out`.
    runs : range
        Numbers of the runs.
    seed : int
        Seed of all roads.
    """
    road = roads_under_wheels(layout.sources, layout.timeline, runs, seed, smooth=1)
    forces = layout.over(road).forces
    return forces[:, :, :-1], forces[:, :, -1:]


def mean_of(layout: Layout, record: Driven) -> MeanResponse:
    """Return the last column of a record as a mean response."""
    return MeanResponse(
        time=layout.time,
        displacement=record.displacement[:, :, -1].copy(),
        velocity=record.velocity[:, :, -1].copy(),
        acceleration=record.acceleration[:, :, -1].copy(),
        contact_forces=record.forces[:, :, -1].copy(),
        point_names=layout.point_names,
    )


def _runs_of(layout: Layout, record: Driven, seed: int) -> Runs:
    lifts = tuple(s.oscillator is not None for s in layout.sources for _ in s.contact_names)
    tension = np.any(record.forces[:, np.array(lifts)] < 0.0, axis=(0, 1))
    return Runs(
        time=layout.time,
        displacement=np.transpose(record.displacement, (2, 0, 1)),
        velocity=np.transpose(record.velocity, (2, 0, 1)),
        acceleration=np.transpose(record.acceleration, (2, 0, 1)),
        contact_forces=np.transpose(record.forces, (2, 0, 1)),
        point_names=layout.point_names,
        contact_names=layout.contact_names,
        seed=seed,
        method=str(layout.method),
        f_max=layout.f_max,
        coverage=layout.coverage,
        lifts=lifts,
        horizontal=layout.horizontal,
        warnings=(*contact_warnings(float(np.mean(tension))), *layout.doubts),
    )


def batch_size(layout: Layout) -> int:
    """Return how many runs 400 MB hold, a number that does not depend on the machine."""
    return _batch_size(layout.timeline, len(layout.contact_names), len(layout.point_names))


def runs_at_once(sources: tuple[Source, ...], dt: float, duration: float, n_points: int) -> int:
    """Return the batch size of a layout that is not laid out yet."""
    contacts = sum(len(source.contact_names) for source in sources)
    return _batch_size(timeline_of(sources, dt, duration), contacts, n_points)


def _batch_size(timeline: Timeline, n_contacts: int, n_points: int) -> int:
    n_all = len(timeline.time)
    values = n_all * n_contacts + (n_all - timeline.n_run_in) * (3 * n_points + n_contacts)
    return int(np.clip(_BATCH_BYTES / (8.0 * values), LEAST_BATCH, _MOST_RUNS))


@kinds_checked
def contact_forces(
    crossing: Crossing, *, integration: Integration, n_runs: int, seed: int, duration: float
) -> tuple[Array, Array]:
    """Return times [s] and contact forces [N] of a vehicle on rigid ground.

    Returns
    -------
    time : ndarray of float, shape (n_steps,)
        Time since the front axle stood at the start [s].
    forces : ndarray of float, shape (n_runs, n_steps, n_contacts)
        Static and dynamic together, positive when pressing on the ground.
    """
    layout = lay_out_on_rigid_ground(crossing, integration, duration)
    road = roads_under_wheels(layout.sources, layout.timeline, range(n_runs), seed)
    return layout.time, np.transpose(layout.over(road).forces, (2, 0, 1))


def part_of(progress: Progress | None, start: float, length: float) -> Progress | None:
    """Return a callable that tells shares of a part of the whole."""
    if progress is None:
        return None
    return lambda share: progress(start + length * share)
