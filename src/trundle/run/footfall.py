"""Answer for people who walk on a study's floor, by a guide, storey by storey."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from trundle._progress import Progress, Tell, silent
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.footfall import footfall_load
from trundle.run.mode_cache import modes_of
from trundle.run.parts import with_kept_parts
from trundle.simulate import FootfallResponse, footfall_floor, footfall_response, prepare
from trundle.simulate import footfall_rule as rule_of
from trundle.study.map_plan import MapGrid, grids_over
from trundle.study.model import Study
from trundle.study.plans import MethodPlan

__all__ = ["FootfallAsked", "StudyFootfall", "study_footfall"]

_MOST, _MOST_ALONE = 4_000, 20_000  # places: every pair of them is answered for, or each alone


@dataclass(frozen=True, kw_only=True)
class FootfallAsked:
    """Hold what is asked about footfall.

    Attributes
    ----------
    guide : str
        Name of a load function, one of `trundle.footfall.FOOTFALLS`.
    paces : tuple of float or None
        Lowest and highest pace [steps/s]; the guide's own unless given.
    spacing : float or None
        Distance of places, at most [m]; so that each surface has 300 unless given.
    method : str or None
        Method of the study whose modes and damping are taken; that of its verdict unless given.
    everywhere : bool
        Whether every place is walked on for every place where it is felt, or each is felt alone.
    length : float
        How far is walked [m], for the guides that ask.
    """

    guide: str = "p354"
    paces: tuple[float, float] | None = None
    spacing: float | None = None
    method: str | None = None
    everywhere: bool = True
    length: float = np.inf


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyFootfall:
    """Hold what people who walk give the floor of a study.

    Attributes
    ----------
    study : Study
        The study.
    asked : FootfallAsked
        What was asked.
    method : MethodPlan
        Whose modes and damping were taken.
    grids : tuple of MapGrid
        Places of every surface.
    response : FootfallResponse
        Levels at all of them, one grid after the other.
    """

    study: Study
    asked: FootfallAsked
    method: MethodPlan
    grids: tuple[MapGrid, ...]
    response: FootfallResponse

    def parts(self) -> Iterator[tuple[MapGrid, slice]]:
        """Give each grid that has places, with where they stand among all."""
        ends = np.cumsum([0, *(len(grid.spots) for grid in self.grids)])
        for grid, (start, end) in zip(self.grids, pairwise(ends.tolist()), strict=True):
            if end > start:
                yield grid, slice(start, end)

    @cached_property
    def xy(self) -> Float[Array, "places 2"]:
        """Where all places are in plan [m]."""
        return np.concatenate([grid.xy for grid in self.grids])

    @cached_property
    def labels(self) -> list[str]:
        """The surface of every place; empty for the only one."""
        return [grid.label for grid in self.grids for _ in range(len(grid.spots))]

    def where(self, place: int) -> tuple[float, float, str]:
        """Return where one of all places is in plan [m], and its surface."""
        x, y = self.xy[place]
        return float(x), float(y), self.labels[place]


def study_footfall(study: Study, asked: FootfallAsked, *, tell: Tell = silent) -> StudyFootfall:
    """Answer for people who walk on a study's floor.

    Parameters
    ----------
    study : Study
        Has the floor, and the method whose modes and damping are taken.
    asked : FootfallAsked
        Guide, paces, places.
    tell : callable
        Told what is being done, and the share of the whole that is done.

    Raises
    ------
    InputError
        No modal method, more places than can be answered for, a guide that is not known.
    """
    load, rule = footfall_load(asked.guide), rule_of(asked.guide, asked.length)
    method = _method(study, asked.method)
    _check_size(_about(study, asked.spacing), asked)
    grids = grids_over(study.floor.surfaces, asked.spacing)
    if not any(len(grid.spots) for grid in grids):
        raise InputError("--spacing: no place lies on the floor; use a smaller one")
    integration, damping = method.interaction.integration, method.interaction.damping
    f_max = integration.f_max
    assert f_max is not None  # the method has modes
    structure = with_kept_parts(study.floor)
    modes = modes_of(structure, f_max=f_max, progress=_part(tell, "modes", 0.0, 0.4))
    prepared = prepare(structure, integration, damping, modes=modes)
    spots = [grid.spots for grid in grids if len(grid.spots)]
    statics = _part(tell, "static deflections", 0.4, 0.6)
    statics(0.0)
    floor = footfall_floor(prepared, spots, spots if asked.everywhere else None, progress=statics)
    walking = _part(tell, "walking", 0.6, 1.0)
    walking(0.0)
    response = footfall_response(floor, load, rule, paces=asked.paces, progress=walking)
    more = (*response.doubts, *_mirror_doubt(study))
    return StudyFootfall(
        study=study,
        asked=asked,
        method=method,
        grids=grids,
        response=replace(response, doubts=more),
    )


def _method(study: Study, name: str | None) -> MethodPlan:
    """Return the method asked for, that of the verdict, or the first, of those with modes."""
    modal = {m.name: m for m in study.methods if m.interaction.integration.f_max is not None}
    there = ", ".join(map(repr, modal)) or "none"
    if name is not None and name not in {m.name for m in study.methods}:
        raise InputError(f"--method {name!r}: the study has no such method; with modes: {there}")
    wanted = name
    if wanted is None and study.assessment is not None and study.assessment.method in modal:
        wanted = study.assessment.method
    if not modal or (wanted is not None and wanted not in modal):
        raise InputError(
            f"--method {wanted or ''!r}: footfall is answered in modes; with modes: {there}; add a "
            '[[method]] with integration = "modal", f_max and damping'
        )
    return next(iter(modal.values())) if wanted is None else modal[wanted]


def _about(study: Study, spacing: float | None) -> float:
    """Return how many places lie in the rectangles round all surfaces, before they are laid."""
    if spacing is None:
        return 0.0  # few enough
    spans = [np.subtract(*surface.extent[::-1]) for surface in study.floor.surfaces.values()]
    return float(sum(np.prod(np.maximum(2.0, np.ceil(span / spacing))) for span in spans))


def _check_size(n: float, asked: FootfallAsked) -> None:
    most = _MOST if asked.everywhere else _MOST_ALONE
    if n > most:
        other = ", or --excitation self" if asked.everywhere else ""
        raise InputError(
            f"--spacing: it would be {n:.4g} places, and at most {most} are answered for: use a "
            f"larger one{other}"
        )


def _part(tell: Tell, what: str, low: float, high: float) -> Progress:
    """Return what tells a part of the whole."""
    return lambda share: tell(what, low + share * (high - low))


def _mirror_doubt(study: Study) -> Iterator[FitnessWarning]:
    if study.floor.mirrors:
        yield FitnessWarning(
            subject="planes of symmetry",
            message="every walker has a mirror image beyond each plane, in step, and modes that "
            "are not symmetric are missing: close to a plane a single walker gives another level",
        )
