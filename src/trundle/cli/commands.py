"""Do what each command does; imported only once a command is known, to start quickly."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from trundle.cli.afford import what_is_dear
from trundle.cli.quantities import quantity_of
from trundle.cli.saying import say
from trundle.cli.screen import print_table, progress_bar
from trundle.cli.show import say_json
from trundle.cli.sketch import plan_sketch
from trundle.criteria import all_criteria
from trundle.errors import InputError
from trundle.run.estimate import estimate_of
from trundle.run.parts import with_kept_parts
from trundle.study.assumptions import early_end_warnings
from trundle.study.doubts import study_doubts
from trundle.study.model import Study
from trundle.study_file.build import load_study
from trundle.views.words import limit_words

_HIGHEST = 2e3  # Hz

__all__ = ["check", "criteria", "modes", "new"]


def check(path: Path, *, as_json: bool = False) -> None:
    """Check a study and print what it would do."""
    study = load_study(path)
    if as_json:
        say_json(_checked(study))
        return
    cells = len(study.cases) * len(study.roads) * len(study.methods)
    say(f"{path}: no mistakes")
    for warning in study_doubts(study):
        say(f"warning: {warning}")
    say(f"\n{study.title}")
    mass = study.floor.moving_mass()
    say(
        f"floor: {study.floor.name}, {len(study.floor.nodes)} nodes, "
        f"{study.floor.n_dofs} degrees of freedom, "
        + ("known by its modes" if mass is None else f"{mass / 1e3:.0f} t moving vertically")
    )
    say(f"work:  {cells} cells of {study.runs} runs, records of up to {study.longest_record:g} s")
    if study.schedules:
        days = (f"{name} of {one.per_day:.4g} passages" for name, one in study.schedules.items())
        say(f"days:  {'; '.join(days)}")
    estimate = estimate_of(study)
    say(f"takes: {estimate}")
    if dear := what_is_dear(estimate):
        say(f"warning: {dear}; 'trundle run' asks for --yes")
    for method in study.methods:
        say(f"method {method.name!r}: {method.interaction}; entry: {method.entry}")
    for case in study.cases:
        for warning in early_end_warnings(study, case):
            say(f"warning: {warning}")
    say(plan_sketch(study))


def _checked(study: Study) -> dict[str, Any]:
    """Return what `check` finds, for programs."""
    early = [w for case in study.cases for w in early_end_warnings(study, case)]
    estimate = estimate_of(study)
    return {
        "title": study.title,
        "source": study.source,
        "mistakes": [],
        "warnings": [str(warning) for warning in (*study_doubts(study), *early)],
        "nodes": len(study.floor.nodes),
        "degrees_of_freedom": study.floor.n_dofs,
        "moving_mass_kg": study.floor.moving_mass(),
        "cells": len(study.cases) * len(study.roads) * len(study.methods),
        "runs": study.runs,
        "longest_record_s": study.longest_record,
        "methods": {method.name: str(method.interaction) for method in study.methods},
        "estimated_time_s": estimate.seconds,
        "estimated_memory_bytes": estimate.memory,
        "too_much": what_is_dear(estimate),
    }


def new(path: Path) -> None:
    """Write the template study."""
    template = resources.files("trundle.study_file").joinpath("template.toml").read_text("utf-8")
    try:
        if path.exists():
            raise InputError(f"{path}: this file exists; choose another name")
        if not path.absolute().parent.is_dir():
            raise InputError(f"{path}: there is no folder {path.absolute().parent}; make it first")
        path.write_text(template, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    say(f"{path}: written; next: trundle check {path}")


def modes(path: Path, f_max: str, *, as_json: bool = False) -> None:
    """Print the natural frequencies of a study's floor."""
    limit = _frequency(f_max)
    floor = with_kept_parts(load_study(path).floor)
    with progress_bar() as tell:
        found = floor.modes(limit, progress=lambda share: tell(f"modes below {limit:g} Hz", share))
    inertia = floor.inertia_of(2)
    unknown = np.full(found.n_modes, np.nan)
    masses = unknown if inertia is None else found.forces(inertia) ** 2
    if as_json:
        columns = (found.frequencies, masses, found.residuals)
        names = ("frequency_hz", "vertical_effective_mass_kg", "residual")
        rows = zip(*columns, strict=True)
        say_json([dict(zip(names, map(float, row), strict=True)) for row in rows])
        return
    print_table(
        f"{floor.name}: {found.n_modes} modes below {limit:g} Hz",
        ("mode", "f [Hz]", "vertical effective mass [t]", "residual"),
        (
            (str(i + 1), f"{f:.3f}", _known(masses[i] / 1e3, ".1f"), _known(residual, ".0e"))
            for i, (f, residual) in enumerate(zip(found.frequencies, found.residuals, strict=True))
        ),
    )
    if floor.has_matrices:
        say("The count agrees with Sylvester's law of inertia: none is missing.")
    else:
        say("They were given: that none is missing is their giver's word.")


def _known(value: float, form: str) -> str:
    """Return a number, or a dash for one that nothing says."""
    return "-" if np.isnan(value) else f"{value:{form}}"


def criteria(*, as_json: bool = False) -> None:
    """Print the criteria that ship with trundle."""
    if as_json:
        say_json(
            [
                {
                    "name": c.name,
                    "aliases": list(c.aliases),
                    "quantity": c.quantity,
                    "axis": c.axis,
                    "frequencies_hz": c.frequencies.tolist(),
                    "limits_si": c.limits.tolist(),
                    "source": c.source,
                    "confidence": c.confidence,
                }
                for c in all_criteria()
            ]
        )
        return
    print_table(
        "Vibration criteria",
        ("name", "also", "limits", "quantity", "axis"),
        (
            (
                criterion.name,
                ", ".join(criterion.aliases),
                limit_words(criterion),
                criterion.quantity.replace("_", " "),
                criterion.axis,
            )
            for criterion in all_criteria()
        ),
        text_columns=5,
    )
    for source, confidence in dict.fromkeys((c.source, c.confidence) for c in all_criteria()):
        say(f"source: {source}\n        confidence: {confidence}")


def _frequency(text: str) -> float:
    value = quantity_of("--f-max", text, "frequency")
    if not 0.0 < value <= _HIGHEST:
        raise InputError(f"--f-max {text!r}: must be greater than 0, and at most {_HIGHEST:g} Hz")
    return value
