"""Methods: interaction, integration, damping, contact and entry."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Literal

from trundle.dynamics import ByMaterial, Damping, ModalRatio, Rayleigh
from trundle.errors import Problem
from trundle.road import RoughnessBand
from trundle.route import entry_named
from trundle.simulate import Coupled, Decoupled, Integration, Modal, Newmark
from trundle.structure import Hat, Hermite, ModalModel
from trundle.structure.elements import Damped
from trundle.study.plans import MethodPlan
from trundle.study_file.attempt import attempt
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import Draft, unique
from trundle.study_file.fields import (
    Flag,
    Frequency,
    GroupName,
    NonNegativeLength,
    PositiveLength,
    Rate,
    Ratio,
    Section,
    Time,
    Wavenumber,
)
from trundle.study_file.kinds import SectionKind
from trundle.study_file.method_checks import method_problems

__all__ = ["METHOD", "build", "fields", "problems"]


class DampingSection(Section):
    """Damping of the floor: a ratio in every mode, by material, or Rayleigh's two coefficients."""

    by_material: Flag = False
    """Whether a mode is damped by what it strains; ratio is then of what has none."""
    ratio: Ratio | None = None
    """Ratio of critical damping of every mode."""
    rayleigh_alpha: Rate | None = None
    """Rayleigh's coefficient of the mass."""
    rayleigh_beta: Time | None = None
    """Rayleigh's coefficient of the stiffness."""


class MethodSection(Section):
    """How vehicle and floor are computed."""

    name: GroupName
    """How results and criteria call it."""
    interaction: Literal["decoupled", "coupled"]
    """Whether the floor's motion acts back on the vehicle (coupled), or not."""
    integration: Literal["modal", "newmark"] = "modal"
    """Modal superposition with exact steps, or direct integration by Newmark's method."""
    f_max: Frequency | None = None
    """Modes are kept to this frequency; needed by modal superposition."""
    precision: Literal["double", "single"] = "double"
    """Of modal steps; direct integration is always double."""
    response_tolerance: Ratio | None = None
    """Error within which modes are combined, 0.05 at most; all unless given."""
    dt: Time
    """Time step; 5 ms shows bands up to 80 Hz."""
    n_max: Wavenumber | None = None
    """Shortest waves of the road, in place of those of [roughness]."""
    contact_patch: NonNegativeLength | None = None
    """Length over which a tyre averages, in place of that of [roughness]."""
    damping: DampingSection
    """Of the floor."""
    contact: Literal["smooth", "hat"] = "smooth"
    """How a wheel between nodes presses on the mesh: by Hermite's or by linear shapes."""
    entry: Literal["drive_in", "ramp", "static", "abrupt"] = "drive_in"
    """How wheels come onto the floor: gently, by a ramp before it, standing on it, or at once."""
    entry_length: PositiveLength | None = None
    """Over which wheels come on and go off: 3 m of drive_in, mesh_size else, unless given."""


_COARSEST = 0.05  # error of combined modes that is allowed

METHOD = SectionKind(name="method", schema=MethodSection, form="list", required=True)


def build(draft: Draft) -> tuple[Draft, list[Problem]]:
    """Return the draft with its methods."""
    reach = draft.model.reach if isinstance(draft.model, ModalModel) else None
    methods, found = methods_of(draft.file, draft.mesh_size, draft.band, reach)
    return replace(draft, methods=methods), found


def fields(draft: Draft) -> dict[str, Any]:
    """Return what a study takes from the section."""
    return {"methods": tuple(draft.methods.values())}


def problems(draft: Draft) -> Iterator[Problem]:
    """Give steps and entries that do not suit a record, a vehicle or a route."""
    yield from method_problems(draft)
    yield from unique((f"{place}.name", name) for place, name in draft.file.names("method"))
    yield from _without_damping(draft)


def methods_of(
    file: StudyFile, mesh_size: float, band: RoughnessBand | None, reach: float | None = None
) -> tuple[dict[str, MethodPlan], list[Problem]]:
    """Return the methods of a study by name, and what is wrong with them.

    Parameters
    ----------
    file : StudyFile
        Its sections.
    mesh_size : float
        Of the floor [m]: the length of a ramp unless another is given.
    band : RoughnessBand, optional
        The waves of the study; methods may name their own.
    reach : float, optional
        To which frequency a structure is known that is known by its modes alone [Hz].
    """
    methods: dict[str, MethodPlan] = {}
    problems: list[Problem] = []
    for i, section in file.lists.get("method", []):
        place = f"method[{i + 1}]"
        damping, integration = _damping(section, place), _integration(section, place, reach)
        own = None if band is None else _own_band(section, place, band)
        found = [one for one in (damping, integration, own) if isinstance(one, Problem)]
        known = None if isinstance(damping, Problem) else damping
        if section.integration == "newmark" and known is not None and known.rayleigh is None:
            found.append(_ratio_with_newmark(place))
        if section.entry == "abrupt" and section.entry_length is not None:
            found.append(_length_of_nothing(place, section.entry_length))
        problems += found
        if (
            isinstance(damping, Problem)
            or isinstance(integration, Problem)
            or isinstance(own, Problem)
            or found
        ):
            continue
        kind = Coupled if section.interaction == "coupled" else Decoupled
        contact = Hat() if section.contact == "hat" else Hermite()
        default = {"drive_in": None, "abrupt": None}.get(section.entry, mesh_size)
        methods[section.name] = MethodPlan(
            name=section.name,
            interaction=kind(integration=integration, damping=damping, contact=contact),
            entry=entry_named(section.entry, section.entry_length or default),
            band=own,
        )
    return methods, problems


def _own_band(
    section: MethodSection, place: str, band: RoughnessBand
) -> RoughnessBand | Problem | None:
    """Return the waves of a method that names its own."""
    own = {
        name: value
        for name in ("n_max", "contact_patch")
        if (value := getattr(section, name)) is not None
    }
    if not own:
        return None
    return attempt(f"{place}.{next(iter(own))}", lambda: replace(band, **own))


def _damping(section: MethodSection, place: str) -> Damping | Problem:
    d = section.damping
    alpha, beta = d.rayleigh_alpha, d.rayleigh_beta
    if d.ratio is not None and alpha is None and beta is None:
        if d.by_material:
            return ByMaterial(other=d.ratio)
        return ModalRatio(ratio=d.ratio)
    if d.ratio is None and alpha is not None and beta is not None:
        return Rayleigh(alpha=alpha, beta=beta)
    names = ("ratio", "rayleigh_alpha", "rayleigh_beta")
    return Problem(
        place=f"{place}.damping",
        value=", ".join(n for n in names if getattr(d, n) is not None) or "nothing",
        rule="damping is a ratio, also of what has none by its material, or both Rayleigh "
        "coefficients",
        remedy='write { ratio = "3 %" }, { by_material = true, ratio = "3 %" } or '
        '{ rayleigh_alpha = "0.8587 1/s", rayleigh_beta = "0.001 s" }',
    )


def _without_damping(draft: Draft) -> Iterator[Problem]:
    """Give damping by material of a floor whose materials have none."""
    if draft.model is None and "building" in draft.file.given:
        return  # its own mistakes are told
    groups = () if draft.model is None else draft.model.elements
    if any(isinstance(g, Damped) and g.damping_ratio is not None for g in groups):
        return
    for i, section in draft.file.lists.get("method", []):
        if section.damping.by_material:
            yield Problem(
                place=f"method[{i + 1}].damping.by_material",
                value="true",
                rule="no material has a damping_ratio; those of a [building] can",
                remedy='add one, such as [building.materials.concrete] damping_ratio = "2 %", or '
                'write { ratio = "3 %" }',
            )


def _integration(section: MethodSection, place: str, reach: float | None) -> Integration | Problem:
    if reach is not None and section.integration == "newmark":
        return Problem(
            place=f"{place}.integration",
            value="'newmark'",
            rule="what is known by its modes has no matrices to integrate",
            remedy='write integration = "modal"',
        )
    if reach is not None and section.f_max is not None and section.f_max > reach * (1.0 + 1e-6):
        return Problem(
            place=f"{place}.f_max",
            value=f"{section.f_max:g} Hz",
            rule=f"the modes that are given reach {reach:.6g} Hz",
            remedy="remove f_max, or give modes that reach further",
        )
    if section.integration == "newmark":
        return _step_by_step(section, place)
    f_max = section.f_max if reach is None else min(section.f_max or reach, reach)
    if f_max is None:
        return Problem(
            place=f"{place}.f_max",
            value="nothing",
            rule="modal superposition needs the frequency up to which modes are kept",
            remedy='add f_max = "112 Hz": 1.25 times the end of the 80 Hz band',
        )
    tolerance = section.response_tolerance or 0.0
    if tolerance > _COARSEST:
        return Problem(
            place=f"{place}.response_tolerance",
            value=f"{tolerance:g}",
            rule=f"modes are combined within {_COARSEST:g} at the coarsest: levels would be off",
            remedy="write 0.005, or leave it out and all modes are stepped",
        )
    return Modal(
        f_max=f_max,
        dt=section.dt,
        single=section.precision == "single",
        response_tolerance=tolerance,
    )


def _step_by_step(section: MethodSection, place: str) -> Newmark | Problem:
    remedy = 'or set integration = "modal"'
    if section.f_max is not None:
        return Problem(
            place=f"{place}.f_max",
            value=f"{section.f_max:g} Hz",
            rule="direct integration has no modes to cut off",
            remedy=f"remove f_max, {remedy}",
        )
    if section.precision == "single":
        return Problem(
            place=f"{place}.precision",
            value="'single'",
            rule="direct integration is in double precision",
            remedy=f"remove precision, {remedy}",
        )
    if section.response_tolerance is not None:
        return Problem(
            place=f"{place}.response_tolerance",
            value=f"{section.response_tolerance:g}",
            rule="direct integration has no modes to combine",
            remedy=f"remove response_tolerance, {remedy}",
        )
    return Newmark(dt=section.dt)


def _length_of_nothing(place: str, length: float) -> Problem:
    return Problem(
        place=f"{place}.entry_length",
        value=f"{length:g} m",
        rule="an abrupt entry has no length",
        remedy='remove entry_length, or set entry = "drive_in" or "ramp"',
    )


def _ratio_with_newmark(place: str) -> Problem:
    return Problem(
        place=f"{place}.damping",
        value="a ratio",
        rule="direct integration needs Rayleigh damping: a ratio for every mode would fill the "
        "whole matrix",
        remedy='write { rayleigh_alpha = "0.8587 1/s", rayleigh_beta = "0.001 s" }, which is 3 % '
        'at 3.75 and 5.8 Hz, or integration = "modal"',
    )
