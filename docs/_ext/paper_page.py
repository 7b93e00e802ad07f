"""Make the page of the paper: its Tables 2 and 3 beside what the study of it gives."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from typing import Any

from pages import DOCS, GENERATED, ROOT, table, write_page

from trundle.views.words import rank, written

__all__ = ["write_paper"]

_KEPT = DOCS / "data" / "paper_tables.json"
_STUDY = ROOT / "examples" / "paper" / "study.toml"
_QUANTITIES = (
    ("peak", "peak_acceleration", "Peak acceleration [gal]"),
    ("rms", "rms_velocity", "RMS velocity [um/s]"),
)
"""Ours by its name in the kept file, theirs by its name in the study, and a heading."""
_SAID = (
    "The floor is a stand-in",
    "One realisation a cell",
    "Decoupled far above coupled",
    "Class C barely above class B",
    "Table 3",
)
"""Notes of the study that explain the differences."""


def write_paper() -> None:
    """Write the page."""
    kept = json.loads(_KEPT.read_text("utf-8"))
    study = tomllib.loads(_STUDY.read_text("utf-8"))
    parts = [_WORDS.format(source=study["publication"]["sources"][0], **kept)]
    for ours, theirs, heading in _QUANTITIES:
        parts.append(f"\n### Table 2: {heading}\n")
        parts.append(table(_CELLS, _cells(kept, study, (ours, theirs)), kind="numbers"))
    for ours, theirs, heading in _QUANTITIES:
        parts.append(f"\n### Table 3: {heading}\n")
        parts.append(table(_BOUNDS, _bounds(kept, study, (ours, theirs)), kind="numbers"))
    parts.append("\n## Why they differ\n")
    notes = {note["title"]: note["text"] for note in study["note"]}
    parts += [f"**{title}.** {notes[title]}\n" for title in _SAID]
    write_page(GENERATED / "paper.md", "\n".join(parts))


_WORDS = """\
# The paper's tables

{source}: the study that the project began with, set up again as a study file.

```sh
make demo
```

or `trundle run examples/paper/study.toml` computes all of it (four minutes on two cores), and its report sets every printed number beside ours.
Theirs are one random road each; ours are the median and the 5-95 % range of {runs} roads (seed {seed}, study `{study_hash}`, trundle {version}).
A difference is that of our median, and the last column says how many of our runs lie below the printed number. `scripts/paper_tables.py` runs the cells of
these tables alone, in a minute.

## Ours beside theirs
"""

_CELLS = (
    "road",
    "class",
    "method",
    "theirs",
    "ours: median",
    "5-95 %",
    "difference",
    "of our runs below theirs",
)
_BOUNDS = ("bound", "our rule", "class", "method", "theirs", "ours", "difference")


def _cells(
    kept: dict[str, Any], study: dict[str, Any], names: tuple[str, str]
) -> Iterator[tuple[str, ...]]:
    """Give a row of Table 2 for each cell that is printed."""
    ours, theirs = names
    found = {(row["case"], row["road"], row["method"]): row for row in kept["cells"]}
    for printed in study["printed"]:
        row = found[printed["case"], printed["road"], printed["method"]]
        low, middle, high = row[ours]
        value = _number(printed[theirs])
        between = f"{written(low)} - {written(high)}"
        yield (
            *(row[name] for name in ("case", "road", "method")),
            printed[theirs].split()[0], written(middle), between, difference(middle, value),
            rank(row[f"{ours}_rank"]).replace("below all", "none").replace("above all", "all"),
        )  # fmt: skip


def _bounds(
    kept: dict[str, Any], study: dict[str, Any], names: tuple[str, str]
) -> Iterator[tuple[str, ...]]:
    """Give a row of Table 3 for each bound that is printed and each rule that is ours."""
    ours, theirs = names
    found = {(p["bound"], p["road"], p["method"]): p for p in study["printed_bound"]}
    for row in kept["bounds"]:
        printed = found[row["bound"], row["road"], row["method"]][theirs]
        yield (
            *(row[name] for name in ("bound", "rule", "road", "method")),
            printed.split()[0], written(row[ours]), difference(row[ours], _number(printed)),
        )  # fmt: skip


def _number(text: str) -> float:
    """Return the number of a printed quantity; all are in the units of the headings."""
    number, unit = text.split()
    if unit not in {"gal", "um/s"}:
        raise ValueError(f"{_STUDY}: {text!r} is neither in gal nor in um/s")
    return float(number)


def difference(ours: float, theirs: float) -> str:
    """Write how far ours lies from theirs.

    Examples
    --------
    >>> difference(3.0, 2.0), difference(1.0, 2.0)
    ('+50 %', '-50 %')
    """
    share = 100.0 * (ours / theirs - 1.0)
    return f"{'+' if share >= 0.0 else '-'}{written(abs(share))} %"
