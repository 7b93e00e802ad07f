"""Run an ensemble: one set of crossings, one method, many random roads."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from trundle._checks import count
from trundle._typing import Array
from trundle.dynamics import Modal
from trundle.errors import InputError
from trundle.simulate._drive import Drive, lay_out_drive, rigid_drive
from trundle.simulate._schedule import roads_under_wheels
from trundle.simulate.crossing import Crossing, Integration, Interaction
from trundle.simulate.fitness import fitness_warnings
from trundle.simulate.prepared import PreparedFloor, prepare
from trundle.simulate.runs import Runs
from trundle.structure import Floor

__all__ = ["batches", "contact_forces", "ensemble"]

Progress = Callable[[float], None]

_BATCH_BYTES = 256e6  # histories and roads held at once
_MOST_RUNS = 1024  # in a batch; more would gain nothing


def ensemble(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    n_runs: int,
    seed: int,
    duration: float | None = None,
    progress: Progress | None = None,
) -> Runs:
    """Run vehicles over a floor on many random roads.

    Parameters
    ----------
    floor : Floor or PreparedFloor
        The floor; prepare it once where several ensembles share it.
    crossings : Crossing or sequence of Crossing
        One vehicle, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y)
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
    whole = batches(
        floor, crossings, method=method, points=points, runs=range(count("n_runs", n_runs)),
        seed=seed, duration=duration, batch=n_runs, progress=progress,
    )  # fmt: skip
    return next(whole)


def batches(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    runs: range,
    seed: int,
    duration: float | None = None,
    batch: int | None = None,
    progress: Progress | None = None,
) -> Iterator[Runs]:
    """Run an ensemble batch by batch, so that memory does not grow with the number of runs.

    Parameters
    ----------
    floor : Floor or PreparedFloor
        The floor.
    crossings : Crossing or sequence of Crossing
        One vehicle, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y)
        Where the response is read [m].
    runs : range
        Numbers of the runs; a run's road depends on the seed and its number alone.
    seed : int
        Seed of all roads.
    duration : float, optional
        Length of the record [s], as in `ensemble`.
    batch : int, optional
        Runs in a batch; as many as 256 MB of histories hold unless given.
    progress : callable, optional
        Told the share of all runs' steps done.

    Yields
    ------
    Runs
        The next runs, with their histories.
    """
    many = as_tuple(crossings)
    if not points:
        raise InputError("name at least one point where the response is to be read")
    if isinstance(floor, Floor):
        floor = prepare(floor, method.integration, method.damping)
    drive = lay_out_drive(floor, many, method=method, points=points, duration=duration)
    size = batch or batch_size(drive, len(points))
    done, total = 0, len(runs)
    for start in range(0, total, size):
        part = runs[start : start + size]
        road = roads_under_wheels(many, drive.timeline, part, seed)
        share = (done / total, len(part) / total)
        record = drive.over(road, progress=_part_of(progress, *share))
        yield Runs(
            time=drive.time,
            displacement=np.transpose(record.displacement, (2, 0, 1)),
            velocity=np.transpose(record.velocity, (2, 0, 1)),
            acceleration=np.transpose(record.acceleration, (2, 0, 1)),
            contact_forces=np.transpose(record.forces, (2, 0, 1)),
            point_names=tuple(points),
            contact_names=contact_names(many),
            seed=seed,
            method=str(method),
            f_max=highest_frequency(method.integration),
            warnings=fitness_warnings(many, method, floor.floor, floor.modes, record.forces),
        )
        done += len(part)


def batch_size(drive: Drive, n_points: int) -> int:
    """Return how many runs 256 MB hold, a number that does not depend on the machine."""
    n_all, n_contacts = drive.timeline.station.shape
    values = 2 * n_all * n_contacts + len(drive.time) * (3 * n_points + n_contacts)
    return int(np.clip(_BATCH_BYTES / (8.0 * values), 16, _MOST_RUNS))


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
    drive = rigid_drive(crossing, integration, duration)
    road = roads_under_wheels((crossing,), drive.timeline, range(n_runs), seed)
    return drive.time, np.transpose(drive.over(road).forces, (2, 0, 1))


def highest_frequency(integration: Integration) -> float:
    """Return the highest frequency that a computation contains [Hz]."""
    nyquist = 0.5 / integration.dt
    return min(integration.f_max, nyquist) if isinstance(integration, Modal) else nyquist


def contact_names(crossings: tuple[Crossing, ...]) -> tuple[str, ...]:
    """Return the names of all contacts, with their route's where several drive."""
    if len(crossings) == 1:
        return crossings[0].vehicle.contact_names
    return tuple(
        f"{crossing.route.name} {name}"
        for crossing in crossings
        for name in crossing.vehicle.contact_names
    )


def _part_of(progress: Progress | None, start: float, length: float) -> Progress | None:
    if progress is None:
        return None
    return lambda share: progress(start + length * share)


def as_tuple(crossings: Crossing | Sequence[Crossing]) -> tuple[Crossing, ...]:
    """Return crossings as a tuple, at least one."""
    many = (crossings,) if isinstance(crossings, Crossing) else tuple(crossings)
    if not many:
        raise InputError("an ensemble needs at least one crossing")
    return many
