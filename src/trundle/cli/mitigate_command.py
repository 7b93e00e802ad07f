"""Try what would help, from the command line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from trundle._checks import one_of
from trundle.cli.afford import check_affordable
from trundle.cli.executors import check_executor, executor_of
from trundle.cli.saying import say
from trundle.cli.screen import print_table, progress_bar
from trundle.cli.show import Show, say_json, warn
from trundle.errors import InputError
from trundle.mitigate.changes import Change, each_change, every_combination
from trundle.mitigate.estimate import estimate_of_changes
from trundle.mitigate.mitigation import check_changes, check_speeds, try_changes
from trundle.mitigate.outcome import Sweep
from trundle.report import write_mitigation_report
from trundle.results.results_folder import check_target, new_results_folder
from trundle.road import CLASS_NAMES
from trundle.run.checkpoint import unfinished_of
from trundle.signals import Isolator
from trundle.study_file.build import load_study
from trundle.units import KMH, to_si
from trundle.vehicle import library_vehicle
from trundle.views.mitigation import PARTLY, UNKNOWN, mitigation_rows

__all__ = ["mitigate"]

T = TypeVar("T")


def mitigate(
    path: Path,
    *,
    speeds: str,
    roads: str,
    vehicles: str,
    slabs: str,
    dampings: str,
    isolators: str,
    combine: bool,
    runs: int,
    workers: int | None,
    scheduler: str | None,
    fresh: bool,
    yes: bool,
    out: Path,
    show: Show = "tables",
) -> None:
    """Run every combination, print matrices and write a results folder."""
    check_executor(workers, scheduler)
    study = load_study(path)
    check_target(out, "comparison")
    at, classes = _speeds(speeds), _classes(roads)
    levers = _levers(vehicles, slabs, dampings, isolators)
    changes = every_combination(levers) if combine else each_change(levers)
    check_changes(study, changes)
    check_speeds(study, at)
    estimate = estimate_of_changes(study, changes, at, runs, classes)
    check_affordable(str(path), estimate, yes=yes)
    with (
        unfinished_of(study, out, fresh=fresh, also=(changes, at, classes, runs)) as store,
        executor_of(workers, scheduler) as executor,
        progress_bar(quiet=show == "nothing") as tell,
        new_results_folder(out, within=store.folder, kind="comparison") as folder,
    ):
        if store.n_found:
            tell(f"going on from {store.n_found} finished pieces of an earlier run", 0.0)
        sweep = try_changes(
            study,
            changes=changes,
            speeds=at,
            roads=classes,
            runs=runs,
            tell=tell,
            store=store,
            executor=executor,
        )
        write_mitigation_report(sweep, folder)
    _say(sweep, out.resolve() / "report.html", show)


def _say(sweep: Sweep, report: Path, show: Show) -> None:
    """Say what came out, as it was asked for."""
    if show == "tables":
        _print(sweep)
    for warning in sweep.warnings():
        warn(warning, show)
    if show == "tables":
        say(f"\nreport: {report}")
    elif show == "json":
        warnings = [str(warning) for warning in sweep.warnings()]
        rows = mitigation_rows(sweep)
        say_json({"outcomes": rows, "warnings": warnings, "report": str(report)})


def _speeds(text: str) -> list[float]:
    """Return the speeds that are asked for [m/s]."""
    at = sorted(set(_each("--speeds", text, lambda part: to_si(part, "speed"))))
    if not at or at[0] <= 0.0:
        raise InputError(f"--speeds {text!r}: give speeds above 0, such as '5 km/h, 15 km/h'")
    return at


def _classes(text: str) -> list[str]:
    """Return the road classes that are asked for, each once."""
    letters = _each("--roads", text, lambda part: one_of("--roads", part, CLASS_NAMES))
    if not letters:
        raise InputError(f"--roads {text!r}: give road classes, such as 'A, B'")
    return list(dict.fromkeys(letters))


def _levers(vehicles: str, slabs: str, dampings: str, isolators: str) -> list[list[Change]]:
    """Return the changes of each kind together."""
    levers = [
        _each("--vehicle", vehicles, _vehicle),
        [
            Change(label=f"slab {1e3 * slab:g} mm", slab_thickness=slab)
            for slab in _each("--slab", slabs, _slab)
        ],
        [
            Change(label=f"damping {100 * ratio:g} %", damping_ratio=ratio)
            for ratio in _each("--damping", dampings, _damping)
        ],
        [
            Change(label=str(isolator), isolation=isolator)
            for isolator in _each("--isolator", isolators, _isolator)
        ],
    ]
    for option, lever in zip(
        ("--vehicle", "--slab", "--damping", "--isolator"), levers, strict=True
    ):
        for label, times in Counter(change.label for change in lever).items():
            if times > 1:
                raise InputError(f"{option}: {label} stands there {times} times; once is enough")
    return levers


def _vehicle(text: str) -> Change:
    return Change(label=text.replace("_", " "), vehicle=library_vehicle(text))


def _slab(text: str) -> float:
    slab = to_si(text, "length")
    if not 0.02 <= slab <= 3.0:
        raise InputError(f"a slab is 20 mm to 3 m thick; got {slab:g} m")
    return slab


def _damping(text: str) -> float:
    ratio = to_si(text, "ratio")
    if not 0.0 < ratio < 1.0:
        raise InputError(f"a ratio is above 0 and below 1; got {ratio:g}")
    return ratio


def _isolator(text: str) -> Isolator:
    frequency, slash, damping = text.partition("/")
    if not slash:
        raise InputError("write frequency / damping, such as '2 Hz / 10 %'")
    return Isolator(
        frequency=to_si(frequency.strip(), "frequency"),
        damping_ratio=to_si(damping.strip(), "ratio"),
    )


def _each(option: str, text: str, read: Callable[[str], T]) -> list[T]:
    """Read what stands between commas."""
    found: list[T] = []
    for part in filter(None, (part.strip() for part in text.split(","))):
        try:
            found.append(read(part))
        except InputError as error:
            raise InputError(f"{option} {part!r}: {error}") from None
    return found


def _print(sweep: Sweep) -> None:
    rows = mitigation_rows(sweep)
    found = {
        (r["change"], r["case"], r["point"], round(r["speed_kmh"], 6), r["road"]): r["strictest"]
        for r in rows
    }
    for change in sweep.changes:
        for point in sweep.study.points:
            print_table(
                f"Strictest criterion met at {point}: {change}",
                ("vehicle on", "speed [km/h]", *(f"class {road}" for road in sweep.roads)),
                (
                    (
                        case.name,
                        f"{speed / KMH:.3g}",
                        *(
                            found[change, case.name, point, round(speed / KMH, 6), road]
                            for road in sweep.roads
                        ),
                    )
                    for case in sweep.study.cases
                    for speed in sweep.speeds
                ),
            )
    if UNKNOWN in found.values():
        say(PARTLY)
