"""Look at methods beside the record, the routes and the vehicles of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from trundle.errors import Problem
from trundle.simulate.step_limits import longest_step, step_problem
from trundle.study.plans import MethodPlan
from trundle.study_file.document import StudyFile
from trundle.study_file.draft import Draft

__all__ = ["method_problems"]


def method_problems(draft: Draft) -> Iterator[Problem]:
    """Give steps and entries that do not suit a record, a vehicle or a route.

    Parameters
    ----------
    draft : Draft
        A study with its methods and all that drives.
    """
    yield from _time_steps(draft.file, draft.methods)
    yield from _entries(draft)
    yield from _vehicle_steps(draft)


def _time_steps(file: StudyFile, methods: Mapping[str, MethodPlan]) -> Iterator[Problem]:
    for i, section in file.lists.get("method", []):
        plan = methods.get(section.name)
        if plan is None:
            continue
        integration = plan.interaction.integration
        duration = None if file.general is None else file.general.duration
        if duration is not None and integration.dt > duration / 10.0:
            yield Problem(
                place=f"method[{i + 1}].dt",
                value=f"{1e3 * integration.dt:g} ms",
                rule=f"a record of {duration:g} s needs at least 10 steps",
                remedy="shorten dt; 5 ms shows bands up to 80 Hz",
            )


def _entries(draft: Draft) -> Iterator[Problem]:
    for name, drive in draft.drives.items():
        for method in draft.methods.values():
            place = draft.file.place_of(method.name, "method")
            length = getattr(method.entry, "length", None)
            if length is not None and length > 0.5 * drive.route.length:
                yield Problem(
                    place=f"{place}.entry_length",
                    value=f"{length:g} m",
                    rule=f"entry and exit must both fit on route {name!r} of "
                    f"{drive.route.length:g} m",
                    remedy=f"use at most {0.5 * drive.route.length:g} m",
                )
            if method.entry.lead(drive.vehicle.length) > drive.route.length:
                yield Problem(
                    place=f"{place}.entry",
                    value="static",
                    rule=f"the whole vehicle must stand on route {name!r}, "
                    f"{drive.route.length:g} m long, at the start; it needs "
                    f"{drive.vehicle.length:g} m",
                    remedy='lengthen the route, or use entry = "drive_in"',
                )


def _vehicle_steps(draft: Draft) -> Iterator[Problem]:
    """Give the vehicles whose own vibration is too fast for a method's steps."""
    # two of one kind bear one name
    vehicles = {id(drive.vehicle): drive.vehicle for drive in draft.drives.values()}
    for method in draft.methods.values():
        place = draft.file.place_of(method.name, "method")
        integration = method.interaction.integration
        for vehicle in vehicles.values() if integration.f_max is not None else ():
            if not vehicle.is_linear:
                yield Problem(
                    place=f"{place}.integration",
                    value="modal",
                    rule=f"vehicle {vehicle.name!r} is not linear (friction, stops, or lifting "
                    "off), and modal steps are of linear vehicles",
                    remedy='integration = "newmark" steps it run by run; or leave these parts out',
                )
            if problem := step_problem(vehicle, integration.dt):
                yield Problem(
                    place=f"{place}.dt",
                    value=f"{1e3 * integration.dt:g} ms",
                    rule=problem.partition(": shorten")[0],
                    remedy=f"shorten dt to {1e3 * longest_step(vehicle):.2g} ms, or see whether a "
                    "stiffness or a mass has the wrong unit",
                )
