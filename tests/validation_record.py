"""Keep what the validation tests compare, so that a page can be made of it.

A test states a comparison with the `record` fixture; the comparison is kept and asserted in
one call. Rows travel with the test reports, so they arrive whatever the number of workers.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pytest


@dataclass(frozen=True, kw_only=True)
class Row:
    """One comparison: a line of the table."""

    case: str
    quantity: str
    unit: str
    expected: float
    computed: float
    tolerance: float
    relative: bool
    source: str
    test: str
    reason: str = ""  # why a tolerance is not met, where that is known

    @property
    def error(self) -> float:
        difference = self.computed - self.expected
        return difference / abs(self.expected) if self.relative else difference

    @property
    def met(self) -> bool:
        return bool(abs(self.error) <= self.tolerance)


@dataclass(frozen=True, kw_only=True)
class Curve:
    """An error that shrinks: a figure, with the order expected and the order observed."""

    case: str
    figure: str
    label: str
    x_label: str
    y_label: str
    x: list[float]
    y: list[float]
    order: float
    observed: float
    tolerance: float
    source: str
    test: str


class Record:
    """State comparisons of one test."""

    def __init__(self, request: pytest.FixtureRequest) -> None:
        self._kept = request.node.user_properties
        self._case = request.module.CASE
        self._source = request.module.SOURCE
        self._test = request.node.nodeid

    def row(
        self, quantity, expected, computed, *, rtol=None, atol=None, unit="", source=None,
        case=None, not_met="",
    ):  # fmt: skip
        """Keep a comparison and assert it.

        `not_met` is the reason why the tolerance is known not to be met: the row stands on the
        page as such, and the test fails as soon as the reason is out of date.
        """
        row = Row(
            case=case or self._case, quantity=quantity, unit=unit, expected=float(expected),
            computed=float(computed), tolerance=float(rtol if atol is None else atol),
            relative=atol is None, source=source or self._source, test=self._test, reason=not_met,
        )  # fmt: skip
        self._kept.append(("validation row", json.dumps(asdict(row))))
        said = f"{quantity}: expected {row.expected:.6g}, computed {row.computed:.6g} {unit}, "
        said += f"error {row.error:+.3g}, tolerance {row.tolerance:g}"
        if not_met:
            assert not row.met, f"{said}; it is met now: {not_met!r} is out of date"
        else:
            assert row.met, said

    def convergence(
        self, label, x, error, *, order, tolerance, figure, x_label, y_label="relative error",
        source=None, last=2,
    ):  # fmt: skip
        """Keep an error over a step or size, and assert the order of the last points.

        `order` is the slope expected in the log-log figure, negative where more is better.
        """
        x, error = np.asarray(x, dtype=float), np.asarray(error, dtype=float)
        slope = np.polyfit(np.log(x[-last:]), np.log(error[-last:]), 1)[0]
        curve = Curve(
            case=self._case, figure=figure, label=label, x_label=x_label, y_label=y_label,
            x=x.tolist(), y=error.tolist(), order=order, observed=float(slope),
            tolerance=tolerance, source=source or self._source, test=self._test,
        )  # fmt: skip
        self._kept.append(("validation curve", json.dumps(asdict(curve))))
        assert abs(slope - order) <= tolerance, (
            f"{label}: order {slope:.2f}, expected {order} +- {tolerance}; errors {error}"
        )

    def explain(self, text):
        """Keep a paragraph that the page prints with the case."""
        self._kept.append(("validation note", json.dumps({"case": self._case, "text": text})))


class Collector:
    """Gather what the tests kept, in the process that reports."""

    def __init__(self, path: str | None) -> None:
        self.path = path
        self.rows: list[Row] = []
        self.curves: list[Curve] = []
        self.notes: list[dict] = []
        self.skipped: list[dict] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.skipped and "tests/validation/" in report.nodeid:
            why = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
            self.skipped.append({"test": report.nodeid, "why": why.removeprefix("Skipped: ")})
        if report.when != "call":
            return
        for name, value in report.user_properties:
            if name == "validation row":
                self.rows.append(Row(**json.loads(value)))
            elif name == "validation curve":
                self.curves.append(Curve(**json.loads(value)))
            elif name == "validation note":
                self.notes.append(json.loads(value))

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if self.path is None:
            return
        out = terminalreporter
        out.section("validation")
        for row in sorted(self.rows, key=lambda row: (row.case, row.test)):
            sign = "met" if row.met else "NOT MET"
            error = f"{100 * row.error:+.3f} %" if row.relative else f"{row.error:+.3g}"
            limit = f"{100 * row.tolerance:g} %" if row.relative else f"{row.tolerance:g}"
            out.line(
                f"{row.case:8} {row.quantity[:58]:58} {row.expected:12.6g} {row.computed:12.6g} "
                f"{row.unit:8} {error:>11} of {limit:<9} {sign}"
            )
        for curve in sorted(self.curves, key=lambda c: (c.case, c.label)):
            out.line(
                f"{curve.case:8} {curve.label[:58]:58} order {curve.observed:.2f}, expected "
                f"{curve.order:g} +- {curve.tolerance:g}"
            )
        Path(self.path).parent.mkdir(parents=True, exist_ok=True)
        values = {
            "rows": [asdict(row) for row in self.rows],
            "curves": [asdict(curve) for curve in self.curves],
            "notes": self.notes,
            "skipped": self.skipped,
        }
        Path(self.path).write_text(json.dumps(values, indent=1), encoding="utf-8")
