"""Run one crossing and keep the motion of whole surfaces, to be looked at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._progress import Progress, Tell, silent
from trundle._typing import Array
from trundle.errors import InputError
from trundle.run.mode_cache import modes_of
from trundle.run.parts import with_kept_parts
from trundle.simulate import PreparedFloor, Runs, Source, lay_out, prepare
from trundle.simulate.ensembles import batches
from trundle.simulate.laying_out import point_rows
from trundle.simulate.layout import Layout
from trundle.simulate.modal.field import field_motion
from trundle.simulate.modal.method import FloorInModes
from trundle.simulate.wheels.surfaces import tracks_on
from trundle.simulate.wheels.timeline import starts_standing
from trundle.structure import Spot, Structure
from trundle.study.model import Study
from trundle.study.plans import Case, MethodPlan

__all__ = ["Playback", "Wheels", "playback_of"]

_BYTES = 300e6  # of histories held at once
_AFTER = 2.0  # s shown after the last wheel has left


@dataclass(frozen=True, kw_only=True, eq=False)
class Wheels:
    """Hold the wheels of a source while it passes.

    Attributes
    ----------
    name : str
        Of the source.
    contact_names : tuple of str
        Its contacts.
    places : ndarray of float, shape (n_frames, n_contacts, 3)
        Where they stand on the floor at rest [m].
    on : ndarray of bool, shape (n_frames, n_contacts)
        Whether the floor carries them.
    forces : ndarray of float, shape (n_frames, n_contacts)
        Positive when pressing on the floor [N].
    """

    name: str
    contact_names: tuple[str, ...]
    places: Float[Array, "frames contacts 3"]
    on: Bool[Array, "frames contacts"]
    forces: Float[Array, "frames contacts"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Playback:
    """Hold a crossing frame by frame.

    Attributes
    ----------
    case, road, method : str
        What is shown: the first run of this cell.
    time : ndarray of float, shape (n_frames,)
        [s].
    nodes : ndarray of int, shape (n_places,)
        Nodes of the structure whose motion is held: those of its surfaces.
    normals : ndarray of float, shape (n_places, 3)
        Direction in which each moves.
    motion : ndarray of float, shape (n_frames, n_places)
        Displacement along it [m].
    wheels : tuple of Wheels
        Of every source.
    """

    case: str
    road: str
    method: str
    time: Float[Array, " frames"]
    nodes: Int[Array, " places"]
    normals: Float[Array, "places 3"]
    motion: Float[Array, "frames places"]
    wheels: tuple[Wheels, ...]


def playback_of(
    study: Study,
    *,
    case: str | None = None,
    road: str | None = None,
    method: str | None = None,
    n_frames: int = 240,
    tell: Tell | None = None,
) -> Playback:
    """Run the first run of a cell again, and keep how all surfaces move.

    Parameters
    ----------
    study : Study
        The study.
    case, road, method : str, optional
        Which of its cells; the first case and road, and the method that is assessed, unless given.
    n_frames : int
        Frames of the whole crossing.
    tell : callable, optional
        Told what is being done, and the share done.

    Raises
    ------
    InputError
        No such case, road or method.
    """
    tell = tell or silent
    which, on_road, plan = _chosen(study, case, road, method)
    sources = study.acting(which, on_road, plan)
    prepared = _prepared(study, plan, lambda s: tell("modes", 0.4 * s))
    nodes, spots, normals = surface_nodes(study.floor)
    crossing = _Crossing(
        prepared=prepared,
        sources=sources,
        plan=plan,
        seed=study.seed,
        duration=study.record_length(sources),
    )
    first = crossing.laid_out(spots[:1])
    forces = _run(first, study.seed, lambda s: tell("one crossing", 0.4 + 0.2 * s)).contact_forces
    steps = _frames(sources, plan.interaction.integration.dt, crossing.duration, n_frames)
    motion = crossing.motion(
        first, forces[0], spots, steps, lambda s: tell("its motion", 0.6 + 0.4 * s)
    )
    return Playback(
        case=which.name,
        road=on_road,
        method=plan.name,
        time=plan.interaction.integration.dt * steps,
        nodes=nodes,
        normals=normals,
        motion=motion,
        wheels=tuple(_wheels(prepared, first, forces[0], steps)),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Crossing:
    """Hold what the first run of a cell is computed from."""

    prepared: PreparedFloor
    sources: tuple[Source, ...]
    plan: MethodPlan
    seed: int
    duration: float

    def laid_out(self, spots: Sequence[Spot]) -> Layout:
        """Return the run as it is computed with histories at some places."""
        return lay_out(
            self.prepared,
            self.sources,
            method=self.plan.interaction,
            points=_numbered(spots),
            duration=self.duration,
        )

    def motion(
        self,
        first: Layout,
        forces: Float[Array, "steps contacts"],
        spots: Sequence[Spot],
        steps: Int[Array, " frames"],
        progress: Progress,
    ) -> Float[Array, "frames places"]:
        """Return how all places move [m], by modes from the forces, or by the run once more."""
        if isinstance(self.prepared, FloorInModes) and first.rows is not None:
            return field_motion(
                self.prepared,
                first.rows,
                forces,
                point_rows(self.prepared.floor, _numbered(spots)),
                steps,
                at_rest=starts_standing(self.sources),
                progress=progress,
            )
        return self._motion_step_by_step(spots, steps, progress)

    def _motion_step_by_step(
        self, spots: Sequence[Spot], steps: Int[Array, " frames"], progress: Progress
    ) -> Float[Array, "frames places"]:
        """Return how all places move [m]: the run is repeated for each block of them."""
        motion = np.empty((len(steps), len(spots)))
        n_steps = round(self.duration / self.plan.interaction.integration.dt)
        for part in _blocks(len(spots), n_steps):
            done, share = part.start / len(spots), (part.stop - part.start) / len(spots)

            def so_far(s: float, done: float = done, share: float = share) -> None:
                progress(done + share * s)

            runs = _run(self.laid_out(spots[part]), self.seed, so_far)
            motion[:, part] = runs.displacement[0, steps]
        return motion


def _numbered(spots: Sequence[Spot]) -> dict[str, Spot]:
    return {str(i): spot for i, spot in enumerate(spots)}


def _prepared(study: Study, plan: MethodPlan, progress: Progress) -> PreparedFloor:
    """Return the floor as a method computes it, its modes kept from earlier runs."""
    integration = plan.interaction.integration
    floor, modes = with_kept_parts(study.floor), None
    if integration.f_max is not None:
        modes = modes_of(floor, f_max=integration.f_max, progress=progress)
    return prepare(floor, integration, plan.interaction.damping, modes=modes)


def _chosen(
    study: Study, case: str | None, road: str | None, method: str | None
) -> tuple[Case, str, MethodPlan]:
    cases = {one.name: one for one in study.cases}
    methods = {one.name: one for one in study.methods}
    usual = study.assessment.method if study.assessment is not None else next(iter(methods))
    picked = (case or next(iter(cases)), road or next(iter(study.roads)), method or usual)
    kinds = (("case", cases), ("road", study.roads), ("method", methods))
    for (what, known), name in zip(kinds, picked, strict=True):
        if name not in known:
            raise InputError(f"there is no {what} {name!r}; there are: {', '.join(known)}")
    return cases[picked[0]], picked[1], methods[picked[2]]


def surface_nodes(
    floor: Structure,
) -> tuple[Int[Array, " places"], list[Spot], Float[Array, "places 3"]]:
    """Return the nodes of all surfaces, where they are on them, and which way those face."""
    nodes, spots, normals = list[Array](), list[Spot](), list[Array]()
    seen = np.zeros(len(floor.nodes), dtype=bool)
    several = len(floor.surfaces) > 1
    for name, surface in floor.surfaces.items():
        some = np.unique(np.concatenate([elements.ravel() for _, elements in surface.parts]))
        some = some[~seen[some]]
        seen[some] = True
        flat = surface.frame.coordinates(floor.nodes[some])
        on = name if several else None
        spots += [Spot(float(x), float(y), on) for x, y, _ in flat]
        nodes.append(some)
        normals.append(np.tile(surface.frame.normal, (len(some), 1)))
    return np.concatenate(nodes), spots, np.concatenate(normals)


def _run(layout: Layout, seed: int, progress: Progress) -> Runs:
    return next(batches(layout, runs=range(1), seed=seed, progress=progress))


def _frames(
    sources: tuple[Source, ...], dt: float, duration: float, n_frames: int
) -> Int[Array, " frames"]:
    """Return the steps that are shown: from the first to a while after the last wheel has left."""
    ends = min(duration, max(source.leaves for source in sources) + _AFTER)
    last = max(1, round(ends / dt))
    return np.unique(np.round(np.linspace(0, last, min(n_frames, last + 1))).astype(int))


def _blocks(n_places: int, n_steps: int) -> Iterator[slice]:
    """Give places block by block, so that histories stay within bounds."""
    size = max(1, int(_BYTES / (3 * 8 * (n_steps + 1))))
    for start in range(0, n_places, size):
        yield slice(start, min(start + size, n_places))


def _wheels(
    prepared: PreparedFloor, layout: Layout, forces: Array, steps: Array
) -> Iterator[Wheels]:
    at = 0
    for source, begins in zip(layout.sources, layout.timeline.begins, strict=True):
        track = source.track(layout.timeline.record[steps], begins)
        n = len(source.contact_names)
        places = np.zeros((track.share.size, 3))
        for part in tracks_on(prepared.floor, track):
            frame = prepared.floor.surface(part.on).frame
            places[part.there] = frame.in_space(part.place[part.there])
        places = places.reshape(len(steps), n, 3)
        yield Wheels(
            name=source.name,
            contact_names=source.contact_names,
            places=places,
            on=track.share > 0.0,
            forces=forces[steps][:, at : at + n],
        )
        at += n
