"""Compute what a force at one place of a study's floor does at another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, get_args

import numpy as np

from trundle._checks import one_of
from trundle._csv import write_csv
from trundle.cli.aside import check_file, written_aside
from trundle.cli.quantities import quantity_of
from trundle.cli.saying import say
from trundle.cli.screen import print_table, progress_bar
from trundle.cli.show import Show, say_json, warn
from trundle.errors import InputError
from trundle.run.transfers import method_of, transfer_of
from trundle.structure import Spot, Structure
from trundle.study.model import Study
from trundle.study.plans import MethodPlan
from trundle.study_file.build import load_study
from trundle.units import to_si
from trundle.views.transfer import Curve, Peak, Quantity, curves, heading, largest_peaks, rows
from trundle.views.words import written

__all__ = ["Asked", "transfer"]

_TOP = 80.0  # Hz: where vibration criteria end
_LOWEST, _HIGHEST = 1e-3, 2e3  # Hz


@dataclass(frozen=True, kw_only=True)
class Asked:
    """Hold what the options of the command ask for; empty texts for nothing."""

    loads: Sequence[str]
    points: Sequence[str] = ()
    method: str = ""
    f_min: str = "1 Hz"
    f_max: str = ""
    lines: int = 800
    quantity: str = "mobility"
    out: Path | None = None
    figure: Path | None = None


def transfer(path: Path, asked: Asked, *, show: Show = "tables") -> None:
    """Compute transfer functions, print their largest peaks, and write what is asked for."""
    quantity: Quantity = one_of("--quantity", asked.quantity, get_args(Quantity))  # pyright: ignore
    if asked.out is not None:
        check_file("--out", asked.out, [".csv"])
    if asked.figure is not None:
        check_file("--figure", asked.figure, [".png", ".svg", ".pdf"])
    study = load_study(path)
    method = _method(study, asked.method)
    loads = {name: _place(study, "--from", name) for name in asked.loads}
    names = asked.points or tuple(study.points)
    points = {name: _place(study, "--to", name) for name in names}
    lines = _lines(asked, method)
    with progress_bar(quiet=show == "nothing") as tell:
        found = transfer_of(
            study, loads, points, lines, method=method, progress=lambda s: tell("modes", 0.9 * s)
        )
        tell("transfer functions", 1.0)
    some, read = curves(found, quantity), curves(found, quantity, study.report)
    title = f"{study.title}: {quantity}, method {method.name}"
    _write(asked, some, quantity, read, title)
    doubts = [*map(str, found.doubts), *_isolated(study, {**loads, **points})]
    if show == "json":
        say_json(_data(asked, some, quantity, method, doubts))
        return
    if show == "tables":
        _print(title, read)
    for doubt in doubts:
        warn(doubt, show)
    if show == "tables":
        for file in (asked.out, asked.figure):
            if file is not None:
                say(f"written: {file}")


def _method(study: Study, name: str) -> MethodPlan:
    try:
        return method_of(study, name or None)
    except InputError as error:
        raise InputError(f"--method {name!r}: {error}") from None


def _place(study: Study, option: str, text: str) -> Spot:
    """Return a point of the study by its name, or a place of its plan."""
    if text in study.points:
        return study.points[text]
    place, _, surface = (part.strip() for part in text.rpartition("@"))
    if "@" not in text:
        place, surface = text, ""
    if place.count(",") != 1:
        near = get_close_matches(text, study.points, n=1)
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        raise InputError(
            f"{option} {text!r}: is no point of the study{hint}, which has "
            f"{', '.join(map(repr, study.points))}; or write a place of the plan with units, "
            "'3 m, 4.5 m', and its surface where there are several, '3 m, 4.5 m @ deck'"
        )
    try:
        x, y = (to_si(one.strip(), "length") for one in place.split(","))
        return _spot(study.floor, x, y, surface or None)
    except InputError as error:
        raise InputError(f"{option} {text!r}: {error}") from None


def _spot(floor: Structure, x: float, y: float, on: str | None) -> Spot:
    """Return a place of the plan as one of a surface, which must have a floor there."""
    surface = floor.surface(on)
    place = surface.frame.from_plan(np.array([[x, y]]))
    for _ in surface.find(place):
        pass  # refused where nothing is
    return Spot(float(place[0, 0]), float(place[0, 1]), on)


def _lines(asked: Asked, method: MethodPlan) -> np.ndarray:
    """Return the frequencies, each as far above the last one as a share of it."""
    low = _frequency("--f-min", asked.f_min)
    shown = method.interaction.integration.f_resolved
    high = _frequency("--f-max", asked.f_max) if asked.f_max else min(_TOP, shown)
    if high <= low:
        raise InputError(
            f"--f-min {asked.f_min!r}: must be below the highest frequency, {high:.4g} Hz"
            + ("" if asked.f_max else f", to which method {method.name!r} shows it; lower --f-min")
        )
    return np.geomspace(low, high, asked.lines)


def _frequency(option: str, text: str) -> float:
    value = quantity_of(option, text, "frequency")
    if not _LOWEST <= value <= _HIGHEST:
        raise InputError(f"{option} {text!r}: must be {_LOWEST:g} to {_HIGHEST:g} Hz")
    return value


def _isolated(study: Study, places: Mapping[str, Spot]) -> list[str]:
    """Say of which points the floor is meant, and not what stands on an isolator there."""
    return [
        f"point {name!r}: what is given is the floor, not what stands behind its isolator"
        for name in places
        if name in study.isolations
    ]


def _write(
    asked: Asked, some: list[Curve], quantity: Quantity, read: list[Curve], title: str
) -> None:
    """Write table and picture, each in its units; neither appears before both are whole."""
    with ExitStack() as stack:
        if asked.out is not None:
            aside = stack.enter_context(written_aside("--out", asked.out))
            write_csv(aside, heading(quantity), rows(some))
        if asked.figure is not None:
            _draw(
                stack.enter_context(written_aside("--figure", asked.figure)), read, quantity, title
            )


def _draw(file: Path, some: list[Curve], quantity: str, title: str) -> None:
    from matplotlib import rc_context

    from trundle.report.canvas import STYLE
    from trundle.report.figures.transfer import transfer_figure

    with rc_context(STYLE):
        transfer_figure(some, quantity, title).savefig(file, dpi=150)


def _print(title: str, some: list[Curve]) -> None:
    print_table(
        f"{title}: largest peaks",
        ("from", "to", "f [Hz]", f"magnitude [{some[0].unit}]"),
        (
            (p.load, p.point, _where(p), written(p.value))
            for curve in some
            for p in largest_peaks(curve)
        ),
        text_columns=2,
    )


def _where(peak: Peak) -> str:
    """Write a peak's frequency; beyond the range's end a curve may rise further."""
    return f"{peak.frequency:.4g}" + (" (end of the range)" if peak.at_end else "")


def _data(
    asked: Asked, some: list[Curve], quantity: str, method: MethodPlan, doubts: list[str]
) -> dict[str, Any]:
    """Return what was found, for programs."""
    return {
        "quantity": quantity,
        "unit": some[0].unit,
        "method": method.name,
        "pairs": [
            {
                "from": curve.load,
                "to": curve.point,
                "peaks": [
                    {"frequency_hz": p.frequency, "magnitude": p.value, "at_end": p.at_end}
                    for p in largest_peaks(curve)
                ],
            }
            for curve in some
        ],
        "warnings": doubts,
        "table": None if asked.out is None else str(asked.out),
        "figure": None if asked.figure is None else str(asked.figure),
    }
