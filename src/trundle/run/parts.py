"""Reduce the parts of a structure, and find its modes, as tasks that any executor computes.

Every distinct part is a task, and so is every part of the spectrum; they depend on nothing but what
they are given, so that results have the same bits whoever computes them. A part that has landed is
kept (`run.kept_parts`): what dies, or is killed, loses the parts in work.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from trundle._progress import Progress, Tell
from trundle.dynamics import (
    Interval,
    Modes,
    Superelement,
    dense_is_better,
    intervals_below,
    modes_by_shifts,
    modes_within,
    repeatable,
    together,
)
from trundle.run.executor import Executor
from trundle.run.jobs import Job
from trundle.run.kept_parts import keep_part, kept_part
from trundle.run.loose_tasks import compute_loose
from trundle.run.seen import map_rows, seen_by_jobs
from trundle.structure import Structure
from trundle.structure.superelements import PartedStructure, Sorted, reduced_here

__all__ = ["IntervalTask", "ReductionTask", "modes_by_parts", "near_to_jobs", "with_kept_parts"]

_TOGETHER = 900  # modes of a part of the spectrum
_REDUCED, _COUNTED = 0.3, 0.35  # of the whole, what is done by then, for progress


@dataclass(frozen=True, kw_only=True, eq=False)
class ReductionTask:
    """Reduce a part.

    Attributes
    ----------
    name : str
        Of the part, by its content.
    f_max : float
        Its own modes are kept to this frequency [Hz].
    alone : bool
        Never: parts are reduced beside each other.
    """

    name: str
    f_max: float
    alone: bool = False

    def compute(self, shared: Any, progress: Progress | None = None) -> Superelement:  # noqa: ANN401
        """Reduce it; `shared` is the part."""
        return shared.reduced(self.f_max, progress=progress)


@dataclass(frozen=True, kw_only=True, eq=False)
class IntervalTask:
    """Find the modes of one part of a spectrum.

    Attributes
    ----------
    name : str
        Which part.
    interval : Interval
        From where to where.
    alone : bool
        Never: parts of a spectrum are searched beside each other.
    """

    name: str
    interval: Interval
    alone: bool = False

    def compute(self, shared: Any, progress: Progress | None = None) -> Modes:  # noqa: ANN401
        """Find them; `shared` is the structure by its parts."""
        return modes_within(shared, self.interval, progress=progress)


def with_kept_parts(structure: Structure, executor: Executor | None = None) -> Structure:
    """Return a structure whose parts are reduced by an executor, and kept on disk.

    Parameters
    ----------
    structure : Structure
        Any; one that is not cut into parts is given back.
    executor : Executor, optional
        Who reduces; threads of this process unless given.
    """
    if not isinstance(structure, PartedStructure) or structure.reducer is not reduced_here:
        return structure  # not cut, or somebody reduces it already

    def reduce(pieces: Sorted, f_max: Sequence[float], tell: Tell) -> tuple[Superelement, ...]:
        """Reduce all distinct parts."""
        return _reduced(pieces, f_max, executor, tell)

    return replace(structure, reducer=reduce)


def near_to_jobs(structure: Structure, jobs: Sequence[Job]) -> Structure:
    """Return a structure of which parts far from all that jobs drive over and read keep less.

    Parameters
    ----------
    structure : Structure
        Any; one that is not cut into parts, or all of whose parts are kept alike, is given back.
    jobs : sequence of Job
        What is computed on it.
    """
    if not isinstance(structure, PartedStructure) or structure.parting.near is None:
        return structure
    if structure.nearness is not None:
        return structure  # what it is near to is known
    dofs, read = seen_by_jobs(structure, jobs)
    found = [dofs, read.indices, map_rows(structure, jobs).indices]
    return structure.near_to(np.unique(np.concatenate(found)))


def modes_by_parts(
    structure: PartedStructure,
    f_max: float,
    *,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> Modes:
    """Return all modes of a structure by its parts below a frequency, found by an executor.

    Parameters
    ----------
    structure : PartedStructure
        The structure.
    f_max : float
        End of the spectrum that is looked for [Hz].
    executor : Executor, optional
        Who searches; threads of this process unless given.
    progress : callable, optional
        Told about how much of the work is done, 0 to 1.
    """
    told = progress or _nobody
    structure.check_reach(f_max)
    pencil = structure.reduced(tell=lambda _, share: told(_REDUCED * share)).pencil
    told(_REDUCED)
    with repeatable():
        parts = intervals_below(pencil, f_max, most=_TOGETHER)
        count, n = parts[-1].end, pencil.n_coordinates
        if dense_is_better(n, count):
            return replace(modes_by_shifts(pencil, f_max=f_max), basis=structure.joined)
    tasks = [
        IntervalTask(name=f"modes {part.first + 1} to {part.end} of {count}", interval=part)
        for part in parts
    ]
    found = compute_loose(
        [(task, pencil) for task in tasks],
        executor,
        lambda share: told(_COUNTED + (1.0 - _COUNTED) * share),
    )
    modes = together([found[task.name] for task in tasks], n_coordinates=n, f_max=f_max)
    return replace(modes, basis=structure.joined)


def _nobody(share: float) -> None:
    """Tell nobody."""
    del share


def _reduced(
    pieces: Sorted, f_max: Sequence[float], executor: Executor | None, tell: Tell
) -> tuple[Superelement, ...]:
    """Return the distinct parts reduced: kept ones, and all others by an executor."""
    parts = [pieces.part(number) for number in range(len(pieces.distinct))]
    reach = dict[str, float]()  # equal contents are reduced once, as far as any of them is needed
    names = [part.content_hash for part in parts]
    for name, f in zip(names, f_max, strict=True):
        reach[name] = max(f, reach.get(name, 0.0))
    tell("parts that were kept", 0.0)
    by_name = dict(zip(names, parts, strict=True))
    with repeatable():
        kept = {name: kept_part(by_name[name], f) for name, f in reach.items()}
    missing = [
        (ReductionTask(name=name, f_max=f), by_name[name])
        for name, f in reach.items()
        if kept[name] is None
    ]
    label = f"{len(missing)} of {len(parts)} distinct parts"
    found = compute_loose(
        missing,
        executor,
        lambda share: tell(label, share),
        lambda name, reduced: keep_part(by_name[name], reduced),
    )
    return tuple(kept[name] or found[name] for name in names)
