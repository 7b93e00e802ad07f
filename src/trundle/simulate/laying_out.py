"""Lay out a set of crossings over a floor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from trundle._checks import positive
from trundle._kinds import kinds_checked
from trundle._typing import SparseMatrix
from trundle.dynamics import (
    Modal,
    ModalRatio,
    ModalRecursion,
)
from trundle.errors import InputError
from trundle.route import ContactRows, contact_rows
from trundle.simulate.crossing import TAIL, Coupled, Crossing, Decoupled, Integration, Interaction
from trundle.simulate.direct.floors import FullFloor
from trundle.simulate.fitness import fitness_warnings
from trundle.simulate.layout import Layout, springs_of
from trundle.simulate.modal.floor import ModalFloor
from trundle.simulate.modal.followers import followers_of
from trundle.simulate.modal.point_motion import point_filters
from trundle.simulate.modal.residual import point_residual
from trundle.simulate.prepared import PreparedFloor, prepare
from trundle.simulate.step_limits import check_contact_loop, step_problem
from trundle.simulate.wheels.given_road import given_road_doubts
from trundle.simulate.wheels.timeline import Timeline, operator_rows, timeline_of
from trundle.structure import Floor, Hermite

__all__ = ["lay_out", "lay_out_on_rigid_ground"]


@kinds_checked
def lay_out(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    duration: float | None = None,
) -> Layout:
    """Lay out crossings over a floor: all that their runs share.

    Parameters
    ----------
    floor : Floor or PreparedFloor
        The floor; prepare it once where several layouts share it.
    crossings : Crossing or sequence of Crossing
        One vehicle, or several at once.
    method : Decoupled or Coupled
        Interaction, integration, damping and contact.
    points : mapping of str to (x, y)
        Where the response is read [m].
    duration : float, optional
        Length of the record [s]; until 5 s after the last wheel has left unless given.

    Raises
    ------
    InputError
        A point or wheel off the floor, no point or no crossing, a floor prepared otherwise.
    """
    many = (crossings,) if isinstance(crossings, Crossing) else tuple(crossings)
    if not many:
        raise InputError("an ensemble needs at least one crossing")
    if not points:
        raise InputError("name at least one point where the response is to be read")
    _check_vehicles(many, method.integration)
    doubts = given_road_doubts(many, method.integration.dt, duration)
    if isinstance(floor, Floor):
        floor = prepare(floor, method.integration, method.damping)
    _check_prepared(floor, method)
    dt = method.integration.dt
    length = duration if duration is not None else _natural_duration(many)
    timeline = timeline_of(many, dt, positive("duration", length))
    rows = operator_rows(floor.floor, many, timeline, method.contact)
    if not len(rows.used_dofs()):
        raise InputError(
            "no wheel loads the floor at any step: the route runs along an edge that is held, or "
            "is shorter than a step; move it onto the floor, or lengthen it"
        )
    reader = _point_rows(floor.floor, points)
    coupled = isinstance(method, Coupled)
    residual = None
    if floor.modes is not None and floor.residual:
        residual = point_residual(floor.flexibility, floor.modes, reader, rows.used_dofs())
    followers = followers_of(floor, reader, rows.used_dofs())
    under_wheels = _floor_under_wheels(floor, rows, timeline, reader, coupled=coupled)
    layout = Layout(
        crossings=many,
        method=method,
        doubts=(*fitness_warnings(many, method, floor.floor, floor.modes), *doubts),
        point_names=tuple(points),
        timeline=timeline,
        floor=under_wheels,
        residual=residual,
        followers=followers,
        filters=(
            point_filters(under_wheels, residual, followers)
            if isinstance(under_wheels, ModalFloor)
            else None
        ),
    )
    if coupled and isinstance(under_wheels, ModalFloor):
        check_contact_loop(
            under_wheels.for_one_drive(), springs_of(many), layout.steps_of(many), len(layout.time)
        )
    return layout


def lay_out_on_rigid_ground(
    crossing: Crossing, integration: Integration, duration: float
) -> Layout:
    """Lay out a crossing over rigid ground."""
    _check_vehicles((crossing,), integration)
    return Layout(
        crossings=(crossing,),
        method=Decoupled(integration=integration, damping=ModalRatio(ratio=0.0)),
        doubts=(),
        point_names=(),
        timeline=timeline_of((crossing,), integration.dt, duration),
        floor=None,
        residual=None,
        followers=None,
        filters=None,
    )


def _floor_under_wheels(
    prepared: PreparedFloor,
    rows: ContactRows,
    timeline: Timeline,
    points: SparseMatrix,
    *,
    coupled: bool,
) -> ModalFloor | FullFloor:
    speed = timeline.speed[timeline.n_run_in :]
    if isinstance(prepared.propagator, ModalRecursion):
        assert prepared.modes is not None  # a modal recursion is only made with modes
        return ModalFloor(
            prepared.modes.first(prepared.n_stepped),
            prepared.propagator.part(slice(prepared.n_stepped)),
            rows,
            speed,
            points,
            flexibility=prepared.flexibility if coupled and prepared.residual else None,
            single=prepared.single,
        )
    return FullFloor(
        prepared.propagator,
        rows,
        speed,
        points,
        flexibility=prepared.flexibility,
        coupled=coupled,
    )


def _point_rows(floor: Floor, points: Mapping[str, tuple[float, float]]) -> SparseMatrix:
    places = np.array(list(points.values()), dtype=float).reshape(-1, 2)
    along_x = np.broadcast_to([1.0, 0.0], places.shape)
    rows = contact_rows(floor, places, along_x, shape=Hermite())
    return rows.matrix(rows.value)


def _check_vehicles(crossings: tuple[Crossing, ...], integration: Integration) -> None:
    for crossing in crossings:
        if not isinstance(integration, Modal):
            if crossing.start == "level":
                raise InputError(
                    'direct integration starts vehicles in equilibrium: choose Modal for "level"'
                )
        elif problem := step_problem(crossing.vehicle, integration.dt):
            raise InputError(problem)


def _check_prepared(prepared: PreparedFloor, method: Interaction) -> None:
    if (prepared.integration, prepared.damping) != (method.integration, method.damping):
        raise InputError(
            f"the floor is prepared for {prepared.integration} with {prepared.damping}; "
            f"the method asks for {method.integration} with {method.damping}"
        )


def _natural_duration(crossings: tuple[Crossing, ...]) -> float:
    last = max(crossing.exit_time for crossing in crossings)
    if not np.isfinite(last):
        raise InputError("a vehicle stops on its route; give a duration")
    return last + TAIL
