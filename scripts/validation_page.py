"""Make docs/validation.md and its figures from what the validation tests recorded.

Usage: python scripts/validation_page.py RECORD.json [FAULTS.json]

Nothing on the page is typed here: rows, orders and notes come from the run, and a case's heading
from the docstring of its test file.
"""

from __future__ import annotations

import ast
import json
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("svg")
from matplotlib import pyplot as plt

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation.md"
FIGURES = ROOT / "docs" / "images"
# Wong's colours, told apart without red and green; markers say the same again
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
MARKERS = "os^Dv*"
# the same picture for the same numbers, byte for byte
mpl.rcParams.update({"svg.hashsalt": "trundle", "svg.fonttype": "none", "font.size": 10})

INTRODUCTION = """\
# Validation

Every link of the chain against closed forms, published values, other methods and an independent
program. This page is made by `make validate` from a run of `tests/validation`; a case is run again
by its name, for instance `make validate ONLY=V1`, which prints the same rows.

An error is relative where it is in per cent, and in the row's unit otherwise. What each tolerance
rests on stands in the docstring of the test that the row names.
"""


def main() -> int:
    """Write the page and its figures; say where they are."""
    record = json.loads(Path(sys.argv[1]).read_text("utf-8"))
    for kept in (record["rows"], record["curves"]):
        kept.sort(key=lambda item: item["test"])  # tests end in any order
    record["notes"].sort(key=lambda note: note["text"])
    faults = json.loads(Path(sys.argv[2]).read_text("utf-8")) if len(sys.argv) > 2 else []
    FIGURES.mkdir(parents=True, exist_ok=True)
    parts = [INTRODUCTION, summary(record, faults), *not_met(record["rows"])]
    parts += figures(record["curves"])
    for case in sorted({row["case"] for row in record["rows"]}):
        parts += section(case, record)
    parts += fault_table(faults)
    PAGE.write_text("\n".join(parts), encoding="utf-8")
    print(f"validation page: {PAGE.relative_to(ROOT)}")
    return 0


def is_met(row: dict) -> bool:
    """Return whether a row is within its tolerance."""
    return abs(error_of(row)) <= row["tolerance"]


def error_of(row: dict) -> float:
    """Return the relative or absolute error of a row."""
    difference = row["computed"] - row["expected"]
    return difference / abs(row["expected"]) if row["relative"] else difference


def summary(record: dict, faults: list[dict]) -> str:
    """Say how much was compared, and what was left out."""
    rows, curves = record["rows"], record["curves"]
    lines = ["", f"{sum(map(is_met, rows))} of {len(rows)} comparisons meet their tolerance. "]
    right = sum(abs(c["observed"] - c["order"]) <= c["tolerance"] for c in curves)
    lines[-1] += f"{right} of {len(curves)} orders of convergence are observed as expected."
    if faults:
        caught = sum(fault["caught"] for fault in faults)
        lines[-1] += f" {caught} of {len(faults)} deliberate faults are caught by the tests."
    lines += [f"\nSkipped: `{s['test']}`: {s['why']}" for s in record["skipped"]]
    return "\n".join(lines) + "\n"


def not_met(rows: list[dict]) -> list[str]:
    """List what did not meet its tolerance, with the reason."""
    missed = [row for row in rows if not is_met(row)]
    if not missed:
        return ["Nothing that is asked for is left unmet.\n"]
    lines = [
        "## Not met\n",
        "| case | quantity | error | tolerance | reason |",
        "|---|---|---:|---:|---|",
    ]
    for row in missed:
        reason = row["reason"] or "unexplained"
        cells = (row["case"], row["quantity"], shown_error(row), shown_limit(row), reason)
        lines.append(f"| {' | '.join(cells)} |")
    return [*lines, ""]


def section(case: str, record: dict) -> list[str]:
    """Return one case: its docstring's first paragraph, notes, and the table."""
    rows = [row for row in record["rows"] if row["case"] == case]
    file = rows[0]["test"].split("::")[0]
    text = ast.get_docstring(ast.parse((ROOT / file).read_text("utf-8"))) or ""
    lines = [f"## {case}\n", text.strip(), f"\nFrom `{file}`.\n"]
    lines += [note["text"] + "\n" for note in record["notes"] if note["case"] == case]
    lines += [
        "| quantity | expected | computed | unit | error | tolerance | source |",
        "|---|---:|---:|---|---:|---:|---|",
    ]
    for row in condensed(rows):
        cells = (
            row["quantity"].replace("|", "\\|"), f"{row['expected']:.6g}",
            f"{round_off(row):.6g}", row["unit"], shown_error(row), shown_limit(row), row["source"],
        )  # fmt: skip
        mark = "" if is_met(row) else " **not met**"
        lines.append(f"| {' | '.join(cells)}{mark} |")
    return [*lines, ""]


def condensed(rows: list[dict]) -> list[dict]:
    """Merge rows of one test that expect and found exactly nothing into one line."""
    kept, merged = [], defaultdict(list)
    for row in rows:
        if row["expected"] == 0.0 and row["computed"] == 0.0:
            merged[row["test"].split("[")[0]].append(row)
        else:
            kept.append(row)
    for same in merged.values():
        first = dict(same[0])
        if len(same) > 1:
            first["quantity"] += f", and {len(same) - 1} more alike"
        kept.append(first)
    return kept


def round_off(row: dict) -> float:
    """Return the computed value without digits that depend on the machine."""
    scale = max(abs(row["expected"]), row["tolerance"] if not row["relative"] else 0.0, 1e-30)
    return round(row["computed"] / scale, 6) * scale


def shown_error(row: dict) -> str:
    """Return an error as the table shows it."""
    error = error_of(row)
    if row["relative"]:
        return "0.000 %" if abs(error) < 5e-6 else f"{100 * error:+.3f} %"
    return "0" if abs(error) < 1e-3 * row["tolerance"] or error == 0.0 else f"{error:+.2g}"


def shown_limit(row: dict) -> str:
    """Return a tolerance as the table shows it."""
    return f"{100 * row['tolerance']:g} %" if row["relative"] else f"{row['tolerance']:g}"


def figures(curves: list[dict]) -> list[str]:
    """Draw one figure for each kind of convergence, and list the orders."""
    lines = ["## Orders of convergence\n"]
    groups = defaultdict(list)
    for curve in sorted(curves, key=lambda c: c["label"]):
        groups[curve["figure"]].append(curve)
    for name, group in sorted(groups.items()):
        file = FIGURES / f"convergence_{name}.svg"
        draw(group, file)
        title = name.replace("_", " ")
        lines.append(f"![Convergence: {title}](images/{file.name})\n")
    lines += [
        "| what | observed order | expected | tolerance | source |", "|---|---:|---:|---:|---|",
    ]  # fmt: skip
    for curve in sorted(curves, key=lambda c: (c["figure"], c["label"])):
        lines.append(
            f"| {curve['label']} | {curve['observed']:.2f} | {curve['order']:g} | "
            f"{curve['tolerance']:g} | {curve['source']} |"
        )
    return [*lines, ""]


def draw(group: list[dict], file: Path) -> None:
    """Draw errors in log-log axes, each with a line of the order expected."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    for i, curve in enumerate(group):
        x, y = np.array(curve["x"]), np.array(curve["y"])
        label = f"{curve['label']}: order {curve['observed']:.2f}"
        axes.loglog(x, y, MARKERS[i % 6], color=COLOURS[i % 6], label=label)
        expected = y[-1] * (x / x[-1]) ** curve["order"]
        axes.loglog(x, expected, "-", color=COLOURS[i % 6], linewidth=0.9)
    axes.set_xlabel(group[0]["x_label"])
    axes.set_ylabel(group[0]["y_label"])
    ticks = sorted({value for curve in group for value in curve["x"]})
    if len(ticks) <= 8:
        axes.set_xticks(ticks, [f"{value:g}" for value in ticks], minor=False)
        axes.xaxis.set_minor_formatter(mpl.ticker.NullFormatter())
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend(title="markers: computed; lines: expected order", fontsize=8, title_fontsize=8)
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)


def fault_table(faults: list[dict]) -> list[str]:
    """List the deliberate faults and the test that caught each."""
    if not faults:
        return []
    lines = [
        "## Deliberate faults\n",
        "Each is put into a copy of the source by `make faults`; a test must then fail.\n",
        "| fault | caught by |", "|---|---|",
    ]  # fmt: skip
    for fault in faults:
        by = f"`{fault['by']}`" if fault["caught"] else "**not caught**"
        lines.append(f"| {fault['name']} | {by} |")
    return [*lines, ""]


if __name__ == "__main__":
    sys.exit(main())
