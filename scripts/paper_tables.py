"""Run the cells of the paper's tables, and keep ours for the manual.

Usage: PYTHONPATH=src python scripts/paper_tables.py

A minute of processor time. It writes docs/data/paper_tables.json; the manual's page of the paper
(docs/_ext/paper_page.py) sets it beside what is printed, and tests/examples/test_paper_tables.py
says when it is out of date.
"""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import trundle
from trundle.study.model import Study
from trundle.views.printed import bound_rows, comparison_rows

ROOT = Path(__file__).resolve().parent.parent
STUDY = ROOT / "examples" / "paper" / "study.toml"
KEPT = ROOT / "docs" / "data" / "paper_tables.json"
_DIGITS = 5  # that every machine agrees on; printed are two to five
_THEIRS = ("printed_peak", "printed_rms")  # stand in the study


def main() -> None:
    """Write the file; say where it is."""
    study = trundle.load_study(STUDY)
    text = json.dumps(ours(study), indent=1)
    KEPT.parent.mkdir(exist_ok=True)
    KEPT.write_text(f"{text}\n", encoding="utf-8")
    print(f"tables of the paper: {KEPT.relative_to(ROOT)}")


def ours(study: Study) -> dict[str, Any]:
    """Return what the cells of Tables 2 and 3 give, with what they were computed from."""
    methods = {one.method for one in study.printed}
    few = replace(
        study,
        methods=tuple(one for one in study.methods if one.name in methods),
        assessment=None,
        map=None,
    )
    result = trundle.run_study(few)
    return {
        "made_by": "scripts/paper_tables.py",
        "version": trundle.__version__,
        "study_hash": study.content_hash,
        "seed": study.seed,
        "runs": study.runs,
        "cells": [_kept(asdict(row)) for row in comparison_rows(result)],
        "bounds": [_kept(asdict(row)) for row in bound_rows(result)],
    }


def _kept(row: dict[str, Any]) -> dict[str, Any]:
    return {name: _rounded(value) for name, value in row.items() if name not in _THEIRS}


def _rounded(value: object) -> object:
    if isinstance(value, tuple):
        return [_rounded(one) for one in value]
    return float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value


if __name__ == "__main__":
    main()
