"""Answer for people who walk on a study's floor, and write maps of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trundle.cli.quantities import quantity_of
from trundle.cli.saying import say
from trundle.cli.screen import print_table, progress_bar
from trundle.cli.show import Show, say_json, warn
from trundle.errors import InputError
from trundle.footfall import FOOTFALLS
from trundle.report.pages.footfall import footfall_summary, write_footfall
from trundle.results.results_folder import check_target, new_results_folder
from trundle.run.footfall import FootfallAsked, StudyFootfall, study_footfall
from trundle.simulate import footfall_rule
from trundle.study_file.build import load_study
from trundle.views.footfall import FootfallDose, level_unit, level_words, worst_rows

__all__ = ["FootfallOptions", "footfall"]

_KIND = "footfall"
_HEADINGS = (
    "surface", "level", "at x, y [m]", "pace [steps/s]", "by", "mode [Hz]", "walker at x, y [m]",
)  # fmt: skip
_SLOWEST, _FASTEST = 0.5, 5.0  # steps/s


@dataclass(frozen=True, kw_only=True)
class FootfallOptions:
    """Hold what the options of the command say; empty texts for nothing."""

    guide: str = "p354"
    pace: tuple[float, float] | None = None
    spacing: str = ""
    method: str = ""
    excitation: str = "full"
    length: str = ""
    passages: float | None = None
    duration: str = ""


def footfall(path: Path, out: Path, *, options: FootfallOptions, show: Show) -> None:
    """Write table and maps, and say what is worst on every storey."""
    asked, dose = _asked(options), _dose(options)
    check_target(out, _KIND)
    study = load_study(path)
    with progress_bar(quiet=show == "nothing") as tell:
        found = study_footfall(study, asked, tell=tell)
        with new_results_folder(out, kind=_KIND) as folder:
            tell("maps", 1.0)
            write_footfall(found, folder, dose)
    for doubt in found.response.doubts if show != "json" else ():
        warn(doubt, show)
    if show == "json":
        say_json(footfall_summary(found) | {"folder": str(out.resolve())})
    elif show == "tables":
        _print(found, out)


def _print(found: StudyFootfall, out: Path) -> None:
    response = found.response
    title = f"{found.study.title}: {level_words(found)} by {response.load.title}"
    print_table(title, _HEADINGS, worst_rows(found))
    x, y, on = found.where(response.worst)
    level = response.governing.level[response.worst] / level_unit(found)[1]
    say(f"worst: {level:.3g} at ({x:.2f}, {y:.2f}) m{f' on {on}' if on else ''}")
    say(f"source: {response.load.source}\n        confidence: {response.load.confidence}")
    say(f"\ntable and maps: {out.resolve()}")


def _asked(options: FootfallOptions) -> FootfallAsked:
    """Return what is asked for, every option checked before any work."""
    if options.guide not in FOOTFALLS:
        raise InputError(f"--guide {options.guide!r}: must be one of {', '.join(FOOTFALLS)}")
    if options.excitation not in {"self", "full"}:
        raise InputError(
            f"--excitation {options.excitation!r}: must be self (each place walked on is felt "
            "alone) or full (every place is walked on for every place)"
        )
    return FootfallAsked(
        guide=options.guide,
        paces=_paces(options.pace),
        spacing=_quantity("--spacing", options.spacing, "length"),
        method=options.method or None,
        everywhere=options.excitation == "full",
        length=_quantity("--length", options.length, "length") or np.inf,
    )


def _paces(pace: tuple[float, float] | None) -> tuple[float, float] | None:
    if pace is None:
        return None
    low, high = pace
    if not _SLOWEST <= low <= high <= _FASTEST:
        raise InputError(
            f"--pace {low:g} {high:g}: lowest and highest pace in steps a second, rising, from "
            f"{_SLOWEST:g} to {_FASTEST:g}; such as --pace 1.8 2.2"
        )
    return pace


def _dose(options: FootfallOptions) -> FootfallDose | None:
    """Return what a dose is for, if it is asked for."""
    if options.passages is None and not options.duration:
        return None
    if options.passages is None or not options.duration:
        raise InputError("--passages and --duration go together: 300 passages of '10 s' each")
    if footfall_rule(options.guide).quantity != "response_factor":
        raise InputError(
            f"--passages: {options.guide} gives a peak acceleration, which has no dose"
        )
    if not 0.0 < options.passages < np.inf:
        raise InputError(f"--passages {options.passages:g}: must be greater than 0")
    duration = _quantity("--duration", options.duration, "time")
    assert duration is not None  # there is a text
    return FootfallDose(passages=options.passages, duration=duration)


def _quantity(option: str, text: str, kind: str) -> float | None:
    """Return what an option gives in SI; None if it is not given."""
    if not text:
        return None
    value = quantity_of(option, text, kind)
    if not 0.0 < value < np.inf:
        raise InputError(f"{option} {text!r}: must be greater than 0")
    return value
