"""Put the contacts of a way onto its surfaces: one, or several with a ramp between them.

A way through several surfaces is known in plan. On a slope a wheel moves further than its plan
does; its direction, its speed and the slope of its share are turned into those along the surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._typing import Array
from trundle.route import ContactRows, Track, contact_rows
from trundle.structure import ContactShape, Structure

__all__ = ["PartOfTrack", "tracks_on"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PartOfTrack:
    """Hold what of a track lies on one surface; contacts and times run together.

    Attributes
    ----------
    track : Track
        The whole track.
    on : str or None
        Name of the surface.
    there : ndarray of bool, shape (n_times * n_contacts,)
        Which contacts are on it, when.
    place, direction : ndarray of float, shape (n_times * n_contacts, 2)
        Places on it [m], and unit directions.
    stretch : ndarray of float, shape (n_times * n_contacts,)
        How far a contact moves over how far it moves in plan.
    """

    track: Track
    on: str | None
    there: Bool[Array, " all"]
    place: Float[Array, "all 2"]
    direction: Float[Array, "all 2"]
    stretch: Float[Array, " all"]

    def rows(
        self, structure: Structure, some: Int[Array, " some"], shape: ContactShape
    ) -> ContactRows:
        """Return the rows of some of its contacts, with their shares."""
        rows = contact_rows(
            structure, self.place[some], self.direction[some], shape=shape, on=self.on
        )
        share, slope = self.track.share.ravel()[some], self.track.share_slope.ravel()[some]
        return rows.scaled(share, slope / self.stretch[some])


def tracks_on(structure: Structure, track: Track) -> Iterator[PartOfTrack]:
    """Give what of a track lies on each of its surfaces.

    Parameters
    ----------
    structure : Structure
        Has the surfaces.
    track : Track
        Where contacts are.

    Yields
    ------
    PartOfTrack
        One a surface.
    """
    place, direction = track.place.reshape(-1, 2), track.direction.reshape(-1, 2)
    if track.which is None:
        all_of_them = np.ones(len(place), dtype=bool)
        yield PartOfTrack(
            track=track, on=track.on, there=all_of_them, place=place, direction=direction,
            stretch=np.ones(len(place)),
        )  # fmt: skip
        return
    which = track.which.ravel()
    for i, name in enumerate(track.surfaces):
        frame = structure.surface(name).frame
        here = frame.from_plan(place)
        along = frame.from_plan(place + direction) - here
        stretch = np.linalg.norm(along, axis=1)
        yield PartOfTrack(
            track=track, on=name, there=which == i, place=here,
            direction=along / stretch[:, None], stretch=stretch,
        )  # fmt: skip
