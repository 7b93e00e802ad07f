"""Form the contact operator of all wheels, window by window.

A row of the operator takes some hundred bytes for each wheel and step. Those of a record of usual
length are formed once and held; of a longer one they are formed anew wherever a window of steps is
asked for, so that memory does not grow with the record. Rows do not depend on which are formed
together, so both give the same bits.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._typing import Array
from trundle.route import ContactRows, contact_rows
from trundle.simulate.sources.passage import Passage
from trundle.simulate.sources.source import Source
from trundle.simulate.wheels.surfaces import tracks_on
from trundle.simulate.wheels.timeline import Timeline, columns_of
from trundle.structure import ContactShape, Hermite, Structure

__all__ = ["StandingWheels", "route_dofs"]

_HELD = 256e6  # bytes of rows that are held
_A_ROW = 300.0  # bytes
_WINDOW = 4096  # steps formed together at most


class StandingWheels:
    """How wheels stand on a structure at every step of a record."""

    def __init__(
        self,
        structure: Structure,
        sources: tuple[Source, ...],
        timeline: Timeline,
        shape: ContactShape,
    ) -> None:
        self._structure, self._shape, self._timeline = structure, shape, timeline
        self._parts = tuple(columns_of(sources, timeline))
        self.n_steps, self.n_dofs = len(timeline.record), structure.n_dofs
        self.n_contacts = sum(len(source.contact_names) for source in sources)
        self._rows: ContactRows | None = None
        self._speed: Float[Array, "steps contacts"] | None = None
        if _A_ROW * self.n_steps * self.n_contacts <= _HELD:
            self._rows, self._speed = self._form(0, self.n_steps)

    def window(self, start: int, stop: int) -> tuple[ContactRows, Float[Array, "steps contacts"]]:
        """Return the rows of some steps, contact running fastest, and the wheels' speeds [m/s]."""
        if self._rows is None or self._speed is None:
            return self._form(start, stop)
        part = slice(start * self.n_contacts, stop * self.n_contacts)
        return self._rows.part(part), self._speed[start:stop]

    def windows(self) -> list[tuple[int, int]]:
        """Return the record's steps in windows, the first of each and that behind its last."""
        return list(pairwise([*range(0, self.n_steps, _WINDOW), self.n_steps]))

    @property
    def whole(self) -> ContactRows:
        """The rows of all steps."""
        return self.window(0, self.n_steps)[0]

    @cached_property
    def _seen(self) -> tuple[Array, Array, float]:
        """Dofs with a weight, which wheels stand on the structure when, and the largest weight."""
        used: set[int] = set()
        stands, largest = [], 0.0
        for start, stop in self.windows():
            rows, _ = self.window(start, stop)
            used |= set(rows.used_dofs().tolist())
            on = (rows.value != 0.0) | (rows.slope != 0.0)
            stands.append(on.any(axis=1).reshape(-1, self.n_contacts))
            largest = max(largest, float(np.abs(rows.value).max(initial=0.0)))
        return np.array(sorted(used), dtype=np.intp), np.concatenate(stands), largest

    def used_dofs(self) -> Int[Array, " dofs"]:
        """Return the dofs on which any row has a weight, rising."""
        return self._seen[0]

    @property
    def stands(self) -> Bool[Array, "steps contacts"]:
        """True where a wheel stands on the structure."""
        return self._seen[1]

    @property
    def largest(self) -> float:
        """Largest weight on a dof."""
        return self._seen[2]

    def _form(self, start: int, stop: int) -> tuple[ContactRows, Array]:
        time = self._timeline.record[start:stop]
        n_rows = len(time) * self.n_contacts
        speed = np.empty((len(time), self.n_contacts))
        found: list[tuple[Array, ContactRows]] = []
        for source, begins, columns in self._parts:
            track = source.track(time, begins)
            speed[:, columns] = track.speed
            standing = ((track.share != 0.0) | (track.share_slope != 0.0)).ravel()
            for part in tracks_on(self._structure, track):
                on = np.flatnonzero(standing & part.there)
                step, contact = np.divmod(on, track.share.shape[1])
                speed[step, columns.start + contact] *= part.stretch[on]
                rows = part.rows(self._structure, on, self._shape)
                found.append((step * self.n_contacts + columns.start + contact, rows))
        return _laid_in(found, n_rows, self.n_dofs), speed


def _laid_in(found: list[tuple[Array, ContactRows]], n_rows: int, n_dofs: int) -> ContactRows:
    """Lay rows of some contacts in among all; the others have no weight."""
    width = max(rows.dofs.shape[1] for _, rows in found)
    dofs = np.zeros((n_rows, width), dtype=np.intp)
    value, slope = np.zeros((n_rows, width)), np.zeros((n_rows, width))
    load_share = np.ones(n_rows)
    for at, rows in found:
        columns = slice(rows.dofs.shape[1])
        dofs[at, columns], value[at, columns] = rows.dofs, rows.value
        slope[at, columns], load_share[at] = rows.slope, rows.load_share
    return ContactRows(dofs=dofs, value=value, slope=slope, load_share=load_share, n_dofs=n_dofs)


def route_dofs(structure: Structure, sources: tuple[Source, ...]) -> Int[Array, " dofs"]:
    """Return the dofs that wheels load on their way over a structure, rising."""
    found: list[Array] = []
    for source in sources:
        if isinstance(source, Passage) and source.crossing.route.surfaces:
            for part in tracks_on(structure, source.swept()):
                on = np.flatnonzero(part.there & (part.track.share.ravel() != 0.0))
                found.append(part.rows(structure, on, Hermite()).used_dofs())
            continue
        found += [
            contact_rows(structure, places, directions, shape=Hermite(), on=source.on).used_dofs()
            for places, directions in source.way()
        ]
    return np.unique(np.concatenate(found))
