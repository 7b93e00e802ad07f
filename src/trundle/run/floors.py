"""Prepare a floor for the methods of some jobs."""

from __future__ import annotations

from collections.abc import Sequence

from trundle.dynamics import Modes
from trundle.run.jobs import Job
from trundle.simulate import PreparedFloor, StaticFlexibility, prepare
from trundle.simulate.wheels.standing import route_dofs
from trundle.structure import Structure
from trundle.study.plans import MethodPlan

__all__ = ["Floors"]


class Floors:
    """Prepare the floor for each method once, and hold one of them at a time."""

    def __init__(self, floor: Structure, modes: Modes | None, jobs: Sequence[Job]) -> None:
        self._floor, self._modes = floor, modes
        self._flexibility = StaticFlexibility(floor)
        # All routes, whatever is missing: a resumed run must solve for the same things together.
        coupled = [job for job in jobs if job.modal and job.method.interaction.moves]
        self._ways = {source.name: source for job in coupled for source in job.sources}
        self._held: tuple[MethodPlan, PreparedFloor] | None = None

    def of(self, job: Job) -> PreparedFloor:
        """Return the floor as a job's method needs it."""
        method, interaction = job.method, job.method.interaction
        if self._ways:
            self._flexibility.cover(route_dofs(self._floor, tuple(self._ways.values())))
            self._ways = {}
        if self._held is None or self._held[0] is not method:
            self._held = None  # lets go of the last one's factor first
            prepared = prepare(
                self._floor,
                interaction.integration,
                interaction.damping,
                modes=self._modes,
                flexibility=self._flexibility,
            )
            self._held = (method, prepared)
        return self._held[1]
