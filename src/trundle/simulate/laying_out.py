"""Lay out a set of crossings over a floor."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

import numpy as np
from scipy import sparse

from trundle._checks import positive
from trundle._kinds import kinds_checked
from trundle._typing import SparseMatrix
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.route import contact_rows, level_rows
from trundle.simulate.fitness import fitness_warnings
from trundle.simulate.ground import Integration, PreparedFloor
from trundle.simulate.interaction import Decoupled, Interaction
from trundle.simulate.layout import Layout
from trundle.simulate.prepared import prepare
from trundle.simulate.sources.crossing import TAIL, Crossing
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.sources.source import Source
from trundle.simulate.wheels.standing import StandingWheels
from trundle.simulate.wheels.timeline import timeline_of
from trundle.structure import Hermite, Spot, Spots, Structure

__all__ = ["Place", "lay_out", "lay_out_on_rigid_ground", "point_rows", "spot_rows"]

Place: TypeAlias = tuple[float, float] | Spot
"""Where something is read: (x, y) [m], or a spot that names its surface too."""


@kinds_checked
def lay_out(
    floor: Structure | PreparedFloor,
    crossings: Crossing | Source | Sequence[Crossing | Source],
    *,
    method: Interaction,
    points: Mapping[str, Place],
    duration: float | None = None,
) -> Layout:
    """Lay out crossings over a floor: all that their runs share.

    Parameters
    ----------
    floor : Structure or PreparedFloor
        The floor; prepare it once where several layouts share it.
    crossings : Crossing, Source, or a sequence of them
        One vehicle or other source, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y) or Spot
        Where the response is read [m]; a Spot names its surface where there are several.
    duration : float, optional
        Length of the record [s]; until 5 s after the last wheel has left unless given.

    Raises
    ------
    InputError
        A point or wheel off the floor, no point or no crossing, a floor prepared otherwise.
    """
    sources = as_sources(crossings)
    if not sources:
        raise InputError("an ensemble needs at least one crossing")
    if not points:
        raise InputError("name at least one point where the response is to be read")
    dt = method.integration.dt
    _check_vehicles(sources, method.integration)
    doubts = [doubt for source in sources for doubt in source.check(dt, duration)]
    if not isinstance(floor, PreparedFloor):
        floor = prepare(floor, method.integration, method.damping)
    _check_prepared(floor, method)
    length = duration if duration is not None else _natural_duration(sources)
    timeline = timeline_of(sources, dt, positive("duration", length))
    rows = StandingWheels(floor.floor, sources, timeline, method.contact)
    if not len(rows.used_dofs()):
        raise InputError(
            "no wheel loads the floor at any step: the route runs along an edge that is held, or "
            "is shorter than a step; move it onto the floor, or lengthen it"
        )
    ground = floor.under(rows, point_rows(floor.floor, points), coupled=method.moves)
    layout = Layout(
        sources=sources,
        method=method,
        doubts=(*fitness_warnings(sources, floor, method.contact), *doubts, *ground.doubts),
        point_names=tuple(points),
        timeline=timeline,
        rows=rows,
        ground=ground,
        horizontal=tuple(i for i, spot in enumerate(_spots(points)) if spot.axis != "z"),
    )
    layout.ground.check(layout.wheels)
    return layout


def lay_out_on_rigid_ground(
    crossing: Crossing | Source, integration: Integration, duration: float
) -> Layout:
    """Lay out a crossing over rigid ground."""
    sources = as_sources(crossing)
    _check_vehicles(sources, integration)
    return Layout(
        sources=sources,
        method=Decoupled(integration=integration, damping=ModalRatio(ratio=0.0)),
        doubts=(),
        point_names=(),
        timeline=timeline_of(sources, integration.dt, duration),
        rows=None,
        ground=integration.rigid(),
    )


def point_rows(floor: Structure, points: Mapping[str, Place]) -> SparseMatrix:
    """Return rows of weights that read the response at points."""
    return sparse.vstack([spot_rows(floor, spots) for spots in _by_surface(points)], format="csr")


def spot_rows(floor: Structure, spots: Spots) -> SparseMatrix:
    """Return rows of weights that read the response at places of one surface."""
    if spots.axis != "z":
        return level_rows(floor, spots.xy, spots.axis, on=spots.on)
    along_x = np.broadcast_to([1.0, 0.0], spots.xy.shape)
    rows = contact_rows(floor, spots.xy, along_x, shape=Hermite(), on=spots.on)
    return rows.matrix(rows.value)


def _spots(points: Mapping[str, Place]) -> list[Spot]:
    return [place if isinstance(place, Spot) else Spot(*place) for place in points.values()]


def _by_surface(points: Mapping[str, Place]) -> Iterator[Spots]:
    """Give points in their order, those that follow each other on one surface and axis together."""
    spots = _spots(points)
    for (on, axis), some in itertools.groupby(spots, key=lambda spot: (spot.on, spot.axis)):
        yield Spots(xy=np.array([(spot.x, spot.y) for spot in some]), on=on, axis=axis)


def _check_vehicles(sources: tuple[Source, ...], integration: Integration) -> None:
    for source in sources:
        if source.oscillator is not None:
            integration.check_vehicle(source.oscillator, level=source.level)


def _check_prepared(prepared: PreparedFloor, method: Interaction) -> None:
    if (prepared.integration, prepared.damping) != (method.integration, method.damping):
        raise InputError(
            f"the floor is prepared for {prepared.integration} with {prepared.damping}; "
            f"the method asks for {method.integration} with {method.damping}"
        )


def _natural_duration(sources: tuple[Source, ...]) -> float:
    last = max(source.leaves for source in sources)
    if not np.isfinite(last):
        raise InputError("a vehicle stops on its route; give a duration")
    return last + TAIL
