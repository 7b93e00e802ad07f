"""Hold what all runs of an ensemble share, and drive them over any roads."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float
from threadpoolctl import ThreadpoolController

from trundle._progress import Progress
from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.simulate.coverage import Coverage, coverage_of
from trundle.simulate.ground import Ground, Integration
from trundle.simulate.interaction import Interaction
from trundle.simulate.sources.source import Source
from trundle.simulate.wheels.contacts import Contacts, Wheels
from trundle.simulate.wheels.driven import Driven
from trundle.simulate.wheels.roads import RoadUnderWheels
from trundle.simulate.wheels.standing import StandingWheels
from trundle.simulate.wheels.timeline import Timeline, starts_standing

__all__ = ["Layout"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Layout:
    """Hold what all runs of an ensemble share: everything but the road.

    Attributes
    ----------
    sources : tuple of Source
        What drives where.
    method : Decoupled or Coupled
        By what method.
    doubts : tuple of FitnessWarning
        Doubts about the method on this floor, whatever the road.
    point_names : tuple of str
        Where the response is read.
    timeline : Timeline
        Where the wheels are.
    rows : StandingWheels or None
        How they stand on the floor; None on rigid ground.
    ground : Ground
        What lies under them.
    horizontal : tuple of int
        Numbers of the points that are read along an axis of the plan.
    """

    sources: tuple[Source, ...]
    method: Interaction
    doubts: tuple[FitnessWarning, ...]
    point_names: tuple[str, ...]
    timeline: Timeline
    rows: StandingWheels | None
    ground: Ground
    horizontal: tuple[int, ...] = ()

    @property
    def integration(self) -> Integration:
        """Time integration."""
        return self.method.integration

    @property
    def contact_names(self) -> tuple[str, ...]:
        """All contacts by name, with their source's where there are several."""
        if len(self.sources) == 1:
            return self.sources[0].contact_names
        return tuple(
            f"{source.name} {name}" for source in self.sources for name in source.contact_names
        )

    @property
    def f_max(self) -> float:
        """Highest frequency that modes and step show as it is [Hz]."""
        return self.integration.f_resolved

    @property
    def coverage(self) -> Coverage:
        """Which bands the roads excite, and whether the vehicles have left at the end."""
        return coverage_of(self.sources, float(self.time[-1]))

    @property
    def time(self) -> Float[Array, " steps"]:
        """Time of the record [s]."""
        return self.timeline.record

    @cached_property
    def wheels(self) -> Wheels:
        """What a drive needs of vehicles and time."""
        return Wheels(
            contacts=Contacts.of(self.sources),
            timeline=self.timeline,
            static=starts_standing(self.sources),
        )

    def with_modes_below(self, f: float) -> Layout:
        """Return the same with fewer modes: those left out answer statically, if any do.

        Parameters
        ----------
        f : float
            Highest frequency of the modes kept [Hz], at most that of the layout.

        Raises
        ------
        InputError
            The floor is not stepped in its modes, or has none below f.
        """
        return replace(self, ground=self.ground.with_modes_below(f))

    def over(
        self,
        road: RoadUnderWheels,
        *,
        weight: Float[Array, " runs"] | None = None,
        progress: Progress | None = None,
    ) -> Driven:
        """Drive over a road for every run; `weight` scales each run's static wheel loads."""
        weight = np.ones(road.n_runs) if weight is None else weight
        # Work is shared out in columns or by the sparse solver; threads of small products that
        # wait for each other would only take the cores.
        with ThreadpoolController().select(internal_api="openblas").limit(limits=1):
            driven = self.ground.drive(self.wheels, road, weight=weight, progress=progress)
        for column in self._inner:
            driven.forces[:, column] = 0.0  # it acts within a vehicle, and on no floor
        return driven

    @property
    def _inner(self) -> list[int]:
        """Numbers of the contacts that touch nothing."""
        found, at = list[int](), 0
        for vehicle in self.wheels.contacts.vehicles:
            at += vehicle.n_contacts
            found += range(at - vehicle.inner, at)
        return found
