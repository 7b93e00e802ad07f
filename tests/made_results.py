"""Results made up by hand: every number in them is known to the test that asks for it."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from studies import GOOD
from trundle.criteria import ClassMap, Criterion, Verdict
from trundle.response import BandSpectra, RunLevels
from trundle.response.quantities import QUANTITIES
from trundle.results.cells import Cell, CellKey, History
from trundle.results.study_result import StudyResult
from trundle.signals import mid_band_frequencies
from trundle.simulate import Coverage
from trundle.study_file.build import study_from_text

BANDS = mid_band_frequencies()

POINTS = {"tool": ("3 m", "3 m"), 'Käfig, "<b>&': ("9 m", "1.5 m")}
"""Two points, the second with a name that needs care in HTML, CSV and JSON."""

SECOND = """
[[route]]
name = "=Zufahrt, Süd"
vehicle = "truck"
path = [["12 m", "2 m"], ["0 m", "2 m"]]
speed = "36 km/h"

[[traffic]]
name = "both"
routes = ["main", "=Zufahrt, Süd"]

[[road]]
class = "C"
"""
"""A second route, both together, and a second road."""


def study_text(more: str = "", *, runs: int = 3) -> str:
    """Return a small study of two points whose records last as long as they must."""
    text = GOOD.replace("runs = 2", f"runs = {runs}")
    name, (x, y) = list(POINTS.items())[1]
    text += f'\n[[point]]\nname = \'{name}\'\nat = ["{x}", "{y}"]\n'
    return text + more


def made_study(more: str = "", *, runs: int = 3):
    """Build that study."""
    return study_from_text(study_text(more, runs=runs))


def curve(name: str = "one", **changes: object) -> Criterion:
    """Return a flat limit of 100 um/s from 4 to 80 Hz, or another."""
    values: dict = {
        "name": name,
        "title": f"{name}, titled",
        "quantity": "band_rms_velocity",
        "frequencies": np.array([4.0, 80.0]),
        "limits": np.array([1e-4, 1e-4]),
        "axis": "each axis",
        "averaging": "none",
        "source": "made up",
        "confidence": "sure",
    }
    return Criterion(**{**values, **changes})


def spectra(values, *, points=tuple(POINTS), **changes: object) -> BandSpectra:
    """Return band levels of shape (n_runs, n_points, n_bands) that are all resolved."""
    values = np.asarray(values, dtype=float)
    given: dict = {
        "mid_band": BANDS[: values.shape[2]],
        "values": values,
        "times": np.full(values.shape, 1.5),
        "resolved": np.ones(values.shape[2], dtype=bool),
        "averaging": "max_1s",
        "point_names": tuple(points),
    }
    return BandSpectra(**{**given, **changes})


def levels(
    *, n_runs: int = 3, base: float = 1.0, points=tuple(POINTS), n_contacts: int = 2, **numbers
):
    """Return levels of which the single numbers differ by quantity, run and point.

    Quantity q (from 1), run r and point p have ``base * (100 q + 10 r + p) * 1e-6``.
    """
    found = {}
    for q, quantity in enumerate(QUANTITIES, start=1):
        n = len(points) if quantity.per == "point" else n_contacts
        run, place = np.ogrid[:n_runs, :n]
        found[quantity.name] = base * (100.0 * q + 10.0 * run + place) * 1e-6
    found["tension"] = np.zeros((n_runs, n_contacts), dtype=bool)
    run, place, band = np.ogrid[:n_runs, : len(points), : len(BANDS)]
    bands = base * 1e-6 * (10.0 + run + 0.1 * place + 0.01 * band)
    more = numbers.pop("more", {})
    above = numbers.pop("above", {})
    own = numbers.pop("spectra", spectra(bands, points=points))
    return RunLevels(numbers={**found, **numbers}, spectra=own, more=more, above=above)


def history(
    *, n_steps: int = 5, n_points: int = 2, n_contacts: int = 2, base: float = 1.0
) -> History:
    """Return histories that rise from step to step, tenfold from quantity to quantity."""
    ramp = base * (np.arange(float(n_steps))[:, None] + 0.1 * np.arange(n_points))
    forces = base * (np.arange(float(n_steps))[:, None] + 0.5 * np.arange(n_contacts))
    return History(
        time=0.005 * np.arange(n_steps), displacement=ramp, velocity=10.0 * ramp,
        acceleration=100.0 * ramp, contact_forces=forces,
    )  # fmt: skip


def cell(key: CellKey, **changes: object) -> Cell:
    """Return a cell whose levels are all known and whose vehicles have left."""
    values: dict = {
        "key": key,
        "reduced": levels(),
        "contact_names": ("axle 1", "axle 2"),
        "exact": None,
        "exact_peaks": None,
        "truncation": None,
        "history": history(),
        "f_resolved": 80.0,
        "coverage": Coverage(),
        "warnings": (),
    }
    return Cell(**{**values, **changes})


def verdict(criterion: Criterion | None = None, **changes: object) -> Verdict:
    """Return a verdict that passes with a margin of 2 at 8 Hz, or another."""
    values: dict = {
        "criterion": criterion or curve(),
        "point": "tool",
        "status": "pass",
        "percentile": 95.0,
        "unresolved": (),
        "averaging": "max_1s",
        "margin": 2.0,
        "interval": (1.5, 2.5),
        "governing_band": 10**0.9,
        "value": 5e-5,
        "limit": 1e-4,
        "share_exceeding": 0.0,
        "time": 1.2,
    }
    return Verdict(**{**values, **changes})


def made_result(study, *, verdicts=None, cells=None, **changes: object) -> StudyResult:
    """Return a result of a study: cell number k has levels k times those of the first."""
    names = [case.name for case in study.cases], study.roads, [m.name for m in study.methods]
    keys = [CellKey(*key) for key in product(*names)]
    made = cells or {
        key: cell(
            key,
            reduced=levels(n_runs=study.runs, base=float(k)),
            history=history(base=float(k)),
        )
        for k, key in enumerate(keys, start=1)
    }
    values: dict = {
        "study": study, "cells": made, "verdicts": verdicts or {}, "maps": {}, "days": {},
        "modes": None, "mesh": None, "provenance": {"program": "trundle", "methods": {"coupled": "x"}},
    }  # fmt: skip
    return StudyResult(**{**values, **changes})


def class_map(margin, criteria, *, places=None, **changes: object) -> ClassMap:
    """Return a map of margins of shape (n_criteria, n_places) that is complete."""
    margin = np.asarray(margin, dtype=float)
    values: dict = {
        "places": np.zeros((margin.shape[1], 2)) if places is None else places,
        "criteria": tuple(criteria),
        "margin": margin,
        "governing_band": np.where(np.isnan(margin), np.nan, 10**0.9),
        "share_exceeding": np.where(np.isnan(margin), np.nan, (margin < 1.0).astype(float)),
        "applies": np.ones(margin.shape, dtype=bool),
        "complete": (True,) * len(margin),
        "percentile": 95.0,
    }
    return ClassMap(**{**values, **changes})


def with_assessment(study, criteria, **changes: object):
    """Return a study that is held against other criteria."""
    return replace(study, assessment=replace(study.assessment, criteria=tuple(criteria), **changes))
