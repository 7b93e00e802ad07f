"""Check what no section can know alone: names that refer, places on the floor, time steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from trundle.criteria import find_criterion
from trundle.dynamics import Modal
from trundle.errors import InputError, Problem
from trundle.road import RoadClass, RoughnessBand
from trundle.simulate import Crossing
from trundle.simulate.ensembles import LEAST_BATCH
from trundle.simulate.step_limits import longest_step, step_problem
from trundle.structure import FloorPlan
from trundle.study.model import Drive, MethodPlan
from trundle.study_file.convert import road_label
from trundle.study_file.read import StudyFile

__all__ = ["relation_problems"]

_MAX_STEPS = 1_000_000
_MAX_HISTORY = 4e9  # bytes of histories held at once for one cell
_EDGE = 1e-6  # m
_TOP = 80.0  # Hz: bands are assessed up to here


def relation_problems(
    file: StudyFile,
    plan: FloorPlan | None,
    drives: Mapping[str, Drive],
    methods: Mapping[str, MethodPlan],
    *,
    band: RoughnessBand | None,
    follows_dt: bool,
) -> list[Problem]:
    """Return the problems of sections that are sound by themselves."""
    found = list(_references(file))
    if plan is not None:
        found += _places(file, plan)
        found += _on_held_edges(file, plan)
        found += _supports(plan)
    found += _time_steps(file, methods)
    if band is not None:
        found += _roughness(drives, methods, band, follows_dt=follows_dt)
    found += _sizes(file, drives, methods)
    found += _entries(drives, methods)
    found += _short_routes(drives, methods)
    found += _vehicle_steps(drives, methods)
    return found


def _references(file: StudyFile) -> Iterator[Problem]:
    declared = file.declared
    names = {
        "route": declared["route"],
        "method": declared["method"],
        "case": declared["route"] | declared["traffic"],
        "road": {road_label(s) for s in file.items("road")},
    }
    for i, section in file.lists.get("traffic", []):
        for j, route in enumerate(section.routes):
            yield from _refer(f"traffic[{i + 1}].routes[{j + 1}]", route, names, "route")
        if len(set(section.routes)) < len(section.routes):
            yield Problem(
                place=f"traffic[{i + 1}].routes",
                value=", ".join(section.routes),
                rule="a route can carry one vehicle at a time",
                remedy="name each route once",
            )
    criteria = file.tables.get("criteria")
    if criteria is not None:
        for name in sorted({c for c in criteria.curves if criteria.curves.count(c) > 1}):
            yield Problem(
                place="criteria.curves",
                value=f"{name!r} {criteria.curves.count(name)} times",
                rule="each curve is held against once",
                remedy="name it once",
            )
        yield from _refer("criteria.method", criteria.method, names, "method")
    printed = {"printed": ("case", "road", "method"), "printed_bound": ("road", "method")}
    for kind, keys in printed.items():
        for i, section in file.lists.get(kind, []):
            for key in keys:
                if key == "road" and file.has_bad("road"):
                    continue  # a road with mistakes has no label to compare with
                yield from _refer(f"{kind}[{i + 1}].{key}", getattr(section, key), names, key)


def _refer(place: str, value: str, names: Mapping[str, set[str]], kind: str) -> Iterator[Problem]:
    if value not in names[kind]:
        yield Problem(
            place=place,
            value=repr(value),
            rule=f"must be the name of a {kind} in this study",
            remedy=f"there are: {', '.join(sorted(names[kind])) or 'none'}",
        )


def _places(file: StudyFile, plan: FloorPlan) -> Iterator[Problem]:
    (x0, x1), (y0, y1) = plan.x_extent, plan.y_extent
    covered = f"the floor covers x {x0:g} to {x1:g} m and y {y0:g} to {y1:g} m"

    def off(place: tuple[float, float]) -> bool:
        x, y = place
        return not (x0 - _EDGE <= x <= x1 + _EDGE and y0 - _EDGE <= y <= y1 + _EDGE)

    for i, section in file.lists.get("route", []):
        for j, place in enumerate(section.path):
            if off(place):
                yield Problem(
                    place=f"route[{i + 1}].path[{j + 1}]",
                    value=f"({place[0]:g}, {place[1]:g}) m",
                    rule=f"a route must stay on the floor; {covered}",
                    remedy="start and end it at the floor's edges; 'trundle check' draws the plan",
                )
    for i, section in file.lists.get("point", []):
        if off(section.at):
            yield Problem(
                place=f"point[{i + 1}].at",
                value=f"({section.at[0]:g}, {section.at[1]:g}) m",
                rule=f"a point must lie on the floor; {covered}",
                remedy="move it onto the floor",
            )


def _on_held_edges(file: StudyFile, plan: FloorPlan) -> Iterator[Problem]:
    """Give routes that run along an edge that is held: their wheels load nothing."""
    for i, section in file.lists.get("route", []):
        for edge, (axis, position) in plan.held_edges().items():
            if all(abs(place[axis] - position) < _EDGE for place in section.path):
                yield Problem(
                    place=f"route[{i + 1}].path",
                    value=f"a way along {edge}, which is {plan.edges[edge]}",
                    rule="wheels on an edge that is held load the floor nowhere",
                    remedy="move the route onto the floor, or hold the edge otherwise",
                )


def _short_routes(
    drives: Mapping[str, Drive], methods: Mapping[str, MethodPlan]
) -> Iterator[Problem]:
    """Give routes that a wheel is on for less than two steps."""
    for name, drive in drives.items():
        time = drive.route.law.time_to(drive.route.length)
        for method in methods.values():
            dt = method.interaction.integration.dt
            if time < 2.0 * dt:
                yield Problem(
                    place=f"route {name!r}.path",
                    value=f"{drive.route.length:g} m",
                    rule=f"a wheel is on it for {1e3 * time:.3g} ms, and method {method.name!r} "
                    f"looks every {1e3 * dt:g} ms",
                    remedy="lengthen the route; 'trundle check' draws the plan",
                )


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
    yield from _assessed_step(file, methods)


def _assessed_step(file: StudyFile, methods: Mapping[str, MethodPlan]) -> Iterator[Problem]:
    criteria = file.tables.get("criteria")
    if criteria is None or criteria.method not in methods:
        return
    top = 0.0
    for name in criteria.curves:
        try:
            curve = find_criterion(name)
        except InputError:
            continue  # reported where the curves are read, or the user's own
        top = max(top, min(float(curve.frequencies[-1]), _TOP))
    dt = methods[criteria.method].interaction.integration.dt
    if top and dt > 1.0 / (2.5 * top) * (1 + 1e-9):
        yield Problem(
            place="criteria.method",
            value=f"{criteria.method!r} with dt = {1e3 * dt:g} ms",
            rule=f"curves that reach {top:g} Hz need a time step of at most {400.0 / top:g} ms",
            remedy="shorten dt, or assess by another method of this study",
        )


def _supports(plan: FloorPlan) -> Iterator[Problem]:
    storeys = plan.storey_below > 0.0 or plan.storey_above > 0.0
    if (plan.column is not None) != storeys:
        yield Problem(
            place="floor.column" if plan.column else "floor.storey_below",
            value="columns without a storey" if plan.column else "a storey without columns",
            rule="columns need storey_below or storey_above, and storeys need a column",
            remedy="give both, or neither",
        )
    elif plan.column is None and not _stands(plan.edges):
        yield Problem(
            place="floor.edges",
            value=", ".join(f"{e} {kind}" for e, kind in plan.edges.items() if kind != "free")
            or "no columns, and no simple, pinned or clamped edge",
            rule="nothing holds this floor: it would sink, or tip over about a lone edge",
            remedy="add column and storey_below, or hold another edge: simple, pinned or clamped",
        )


def _stands(edges: Mapping[str, str]) -> bool:
    """Return whether edges alone hold a floor up, and against tipping."""
    bearing = [edge for edge, kind in edges.items() if kind in ("simple", "pinned")]
    level = {edge[0] for edge, kind in edges.items() if kind == "symmetry"}
    if "clamped" in edges.values() or len(bearing) > 1:
        return True
    return bool(bearing) and bearing[0][0] in level


def _roughness(
    drives: Mapping[str, Drive],
    methods: Mapping[str, MethodPlan],
    band: RoughnessBand,
    *,
    follows_dt: bool,
) -> Iterator[Problem]:
    for name, drive in drives.items():
        speed = float(drive.route.law.speed(0.0))
        for method in methods.values():
            dt = method.interaction.integration.dt
            limit = 0.5 / (speed * dt)
            if follows_dt and limit <= band.n_min:
                yield Problem(
                    place=f"method {method.name!r}.dt",
                    value=f"{1e3 * dt:g} ms",
                    rule=f"at {3.6 * speed:g} km/h on route {name!r} this step follows waves to "
                    f"{limit:.3g} 1/m only, and the road's begin at {band.n_min:g} 1/m",
                    remedy="shorten dt, or lower n_min or the speed",
                )
            elif not follows_dt and (method.band or band).n_max > limit * (1 + 1e-9):
                yield Problem(
                    place="roughness.n_max",
                    value=f"{band.n_max:g} 1/m",
                    rule=f"method {method.name!r} on route {name!r} can follow waves to "
                    f"{limit:.3g} 1/m (dt = {1e3 * dt:g} ms)",
                    remedy="shorten dt, lower n_max, or set n_max_follows_dt = true",
                )


def _sizes(
    file: StudyFile, drives: Mapping[str, Drive], methods: Mapping[str, MethodPlan]
) -> Iterator[Problem]:
    if file.general is None:
        return
    contacts = sum(drive.vehicle.n_contacts for drive in drives.values())
    points = max(1, len(file.items("point")))
    # Histories are held for a batch at a time; of every run a few numbers a point are kept.
    per_step = 8 * LEAST_BATCH * (6 * points + 4 * max(1, contacts)) + 1200 * max(1, contacts)
    cells = len(methods) * max(1, len(file.items("road"))) * (len(drives) + 1)
    kept = 8 * cells * (24 * points + 2 * max(1, contacts))
    if file.general.runs * kept > _MAX_HISTORY:
        yield Problem(
            place="runs",
            value=str(file.general.runs),
            rule="what is kept of every run would not fit in memory",
            remedy=f"use at most {int(_MAX_HISTORY / kept)} runs, or fewer points",
        )
    ways = (d.route.law.time_to(d.route.length + 2.0 * d.vehicle.length) for d in drives.values())
    duration = file.general.duration or max(ways, default=0.0) + 5.0
    before = max(map(_run_in_time, drives.values()), default=0.0)
    for method in methods.values():
        steps = (before + duration) / method.interaction.integration.dt
        if steps > _MAX_STEPS:
            yield Problem(
                place="duration",
                value=f"{duration:g} s",
                rule=f"method {method.name!r} would take {steps:.3g} steps, those of the "
                f"{before:.3g} s of run-in included; "
                f"the limit is {_MAX_STEPS}",
                remedy="shorten the duration or run_in, or lengthen dt",
            )
        elif steps * per_step > _MAX_HISTORY:
            yield Problem(
                place="duration",
                value=f"{duration:g} s",
                rule=f"the histories of method {method.name!r} would not fit in memory, even of "
                f"{LEAST_BATCH} runs at a time",
                remedy="use fewer points, a shorter record, or a longer dt",
            )


def _run_in_time(drive: Drive) -> float:
    """Return how long a vehicle drives on rigid ground before the record begins [s]."""
    anywhere = RoadClass("A")
    return Crossing(drive.vehicle, drive.route, anywhere, run_in=drive.run_in).run_in_time


def _vehicle_steps(
    drives: Mapping[str, Drive], methods: Mapping[str, MethodPlan]
) -> Iterator[Problem]:
    """Give the vehicles whose own vibration is too fast for a method's steps."""
    vehicles = {drive.vehicle.name: drive.vehicle for drive in drives.values()}
    for method in methods.values():
        integration = method.interaction.integration
        for vehicle in vehicles.values() if isinstance(integration, Modal) else ():
            if problem := step_problem(vehicle, integration.dt):
                yield Problem(
                    place=f"method {method.name!r}.dt",
                    value=f"{1e3 * integration.dt:g} ms",
                    rule=problem.partition(": shorten")[0],
                    remedy=f"shorten dt to {1e3 * longest_step(vehicle):.2g} ms, or see whether a "
                    "stiffness or a mass has the wrong unit",
                )


def _entries(drives: Mapping[str, Drive], methods: Mapping[str, MethodPlan]) -> Iterator[Problem]:
    for name, drive in drives.items():
        for method in methods.values():
            length = getattr(method.entry, "length", None)
            if length is not None and length > 0.5 * drive.route.length:
                yield Problem(
                    place=f"method {method.name!r}.entry_length",
                    value=f"{length:g} m",
                    rule=f"entry and exit must both fit on route {name!r} of "
                    f"{drive.route.length:g} m",
                    remedy=f"use at most {0.5 * drive.route.length:g} m",
                )
            if method.entry.lead(drive.vehicle.length) > drive.route.length:
                yield Problem(
                    place=f"method {method.name!r}.entry",
                    value="static",
                    rule=f"the whole vehicle must stand on route {name!r}, "
                    f"{drive.route.length:g} m long, at the start; it needs "
                    f"{drive.vehicle.length:g} m",
                    remedy='lengthen the route, or use entry = "drive_in"',
                )
