"""Draw responses: histories, spectra on criteria, ours beside the printed values."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from trundle.criteria import Criterion
from trundle.report.canvas import (
    COLOURS,
    Drawing,
    legend_below,
    line_look,
    make_logarithmic,
    new_figure,
)
from trundle.report.figures.passing import draw_passing, passing_handles
from trundle.response import BandSpectra
from trundle.results.cells import CellKey
from trundle.results.study_result import StudyResult
from trundle.study.model import Study
from trundle.study.plans import Assessment
from trundle.study.report_plan import ReportPlan
from trundle.views.printed import ComparisonRow, comparison_rows
from trundle.views.words import USUAL, rule_name, shown

__all__ = ["draw_criterion", "drawings"]


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give histories, levels on criteria, and ranges beside published values.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    yield from _histories(result)
    study = result.study
    if study.assessment is not None:
        yield from _criteria(result, study.assessment)
    rows = comparison_rows(result)
    if rows:
        yield Drawing(
            name="comparison",
            title="Published values on our ranges",
            caption="Median (dot) and 5-95 % (bar) of our runs; crosses are published values.",
            draw=lambda: comparison_figure(rows, study.report),
        )


def _histories(result: StudyResult) -> Iterator[Drawing]:
    """Give the first run of every case at every point, by each method on each road."""
    study = result.study
    for (i, case), (j, point) in itertools.product(enumerate(study.cases), enumerate(study.points)):
        together = len(case.routes) > 1
        alone = f"route {case.name}" if case.name in study.drives else case.name
        what = "several vehicles at once" if together else alone
        yield Drawing(
            name=f"history_{i + 1}" + (f"_{j + 1}" if j else ""),
            title=f"Acceleration at {point}: {what}",
            caption="First realisation by each method, on the same road; bars above it while each "
            "source is on the floor, with a mark where its front axle is nearest to the point.",
            draw=lambda name=case.name, point=point: history_figure(result, name, point),
        )


def _criteria(result: StudyResult, assessment: Assessment) -> Iterator[Drawing]:
    """Give peaks and levels of every point on the curves, the levels for each road."""
    study, method = result.study, assessment.method
    for j, point in enumerate(study.points):
        end = f"_{j + 1}" if j else ""
        if _limits(study, point, "peak_acceleration"):
            yield Drawing(
                name=f"criteria_acceleration{end}",
                title=f"Peak acceleration at {point} against equipment limits",
                caption="Zero-to-peak limits of precision equipment.",
                draw=lambda point=point: acceleration_criteria_figure(result, method, point),
            )
        for k, road in enumerate(study.roads):
            yield Drawing(
                name=f"criteria_velocity_{k + 1}{end}",
                title=f"Velocity spectra at {point} against criteria, class {road}",
                caption="One-third-octave RMS velocity on the velocity criteria; hatched where a "
                "criterion asks for a band that a case does not tell.",
                draw=lambda road=road, point=point: velocity_criteria_figure(
                    result, road, method, point
                ),
            )


def _limits(study: Study, point: str, quantity: str) -> list[Criterion]:
    """Return the criteria of a quantity that are for the motion of a point."""
    ways = study.point_ways or ("vertical",) * len(study.points)
    mine = {ways[list(study.points).index(point)], "each axis"}
    criteria = study.assessment.criteria if study.assessment else ()
    return [c for c in criteria if c.quantity == quantity and c.axis in mine]


def history_figure(result: StudyResult, case: str, point: str) -> Figure:
    """Draw the first run's acceleration, a row a method, a column a road."""
    study = result.study
    roads, methods = list(study.roads), [method.name for method in study.methods]
    figure, axes = new_figure(
        max(7.2, 3.6 * len(roads)),
        1.6 * len(methods) + 0.4,
        rows=len(methods),
        columns=len(roads),
        share="x",
    )
    i = list(study.points).index(point)
    unit, size = shown("m/s2", study.report)
    for panel, (method, road) in zip(axes, itertools.product(methods, roads), strict=True):
        key = CellKey(case, road, method)
        history = result.cells[key].history
        values = history.acceleration[:, i] / size
        colour = COLOURS[methods.index(method) % len(COLOURS)]
        panel.plot(history.time, values, color=colour, linewidth=0.8)
        panel.set(xlim=(0.0, history.time[-1]))
        panel.margins(y=0.2)
        draw_passing(panel, result, key, point, float(history.time[-1]))
        panel.set_title(
            f"{method}, class {road}: peak {np.abs(values).max():.3g} {unit}",
            loc="left",
            fontsize=8,
        )
    for panel in axes[:: len(roads)]:
        panel.set_ylabel(f"a [{unit}]")
    for panel in axes[-len(roads) :]:
        panel.set_xlabel("time [s]")
    first = CellKey(case, roads[0], methods[0])
    legend_below(figure, *passing_handles(result, first), columns=2)
    return figure


def velocity_criteria_figure(result: StudyResult, road: str, method: str, point: str) -> Figure:
    """Draw band levels of every case on the velocity criteria."""
    figure, (axes,) = new_figure(7.2, 4.6)
    unit, size = shown("m/s", result.study.report)
    for criterion in _limits(result.study, point, "band_rms_velocity"):
        draw_criterion(axes, criterion, size)
    hatch = _draw_unknown(axes, result, CellKey("", road, method), point)
    i = list(result.study.points).index(point)
    spectra_rule = result.study.assessment.averaging if result.study.assessment else "max_1s"
    for number, case in enumerate(result.study.cases):
        spectra = result.cells[CellKey(case.name, road, method)].spectra
        _draw_levels(axes, (spectra, i, size), case.name, line_look(number))
    make_logarithmic(axes, "xy")
    ticks = [1, 2, 4, 8, 16, 31.5, 63]
    axes.set(
        xlim=(0.9, 130.0),
        xlabel="mid-band frequency [Hz]",
        ylabel=f"RMS velocity in one-third octaves [{unit}]\n({rule_name(spectra_rule)})",
    )
    axes.set_ylim(bottom=max(axes.get_ylim()[0], 0.01))
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    axes.set_title(
        f"class {road}, {point}, method {method!r}: median and 5-95 % of the runs", fontsize=9
    )
    handles, labels = axes.get_legend_handles_labels()
    if hatch is not None:
        handles, labels = [*handles, hatch], [*labels, "not assessed for a case or all"]
    legend_below(figure, handles, labels, columns=len(labels))
    return figure


def _draw_unknown(axes: Axes, result: StudyResult, which: CellKey, point: str) -> Patch | None:
    """Hatch bands that a criterion asks for and some case does not tell; return the look."""
    bands = {
        f
        for key, verdicts in result.verdicts.items()
        if (key.road, key.method) == (which.road, which.method)
        for v in verdicts
        if v.point == point and v.criterion.quantity == "band_rms_velocity"
        for f in (*v.unresolved, *v.unexcited)
    }
    look = Patch(facecolor="none", edgecolor="#9A9A9A", hatch="////", linewidth=0.0)
    for f in bands:
        low, high = f * 10.0**-0.05, f * 10.0**0.05
        axes.axvspan(low, high, zorder=0.5, fc="none", ec="#9A9A9A", hatch="////", lw=0.0)
    return look if bands else None


def _draw_levels(
    axes: Axes, what: tuple[BandSpectra, int, float], name: str, look: tuple[str, str]
) -> None:
    """Draw median and range of the band levels of a case at a point, in a unit of that size."""
    colour, dashes = look
    spectra, point, size = what
    low, middle, high = (spectra.percentile(p)[point] / size for p in (5.0, 50.0, 95.0))
    axes.fill_between(spectra.mid_band, low, high, color=colour, alpha=0.18, linewidth=0)
    axes.plot(
        spectra.mid_band,
        middle,
        color=colour,
        linestyle=dashes,
        marker="o",
        markersize=3,
        label=name,
    )


def draw_criterion(axes: Axes, criterion: Criterion, size: float) -> None:
    """Draw a velocity criterion with its name at its end, in a unit of that size [m/s]."""
    limits = criterion.limits / size
    axes.plot(criterion.frequencies, limits, color="black", linewidth=0.9)
    axes.annotate(
        criterion.title,
        (criterion.frequencies[-1], limits[-1]),
        xytext=(4, 0),
        textcoords="offset points",
        va="center",
        fontsize=7.5,
        annotation_clip=False,
    )


def acceleration_criteria_figure(result: StudyResult, method: str, point: str) -> Figure:
    """Draw the peak accelerations of every case on the limits."""
    unit, size = shown("m/s2", result.study.report)
    figure, (axes,) = new_figure(7.2, 3.8)
    i = list(result.study.points).index(point)
    labels: list[str] = []
    for case in result.study.cases:
        for number, road in enumerate(result.study.roads):
            peaks = result.cells[CellKey(case.name, road, method)].peak_acceleration[:, i] / size
            low, middle, high = np.percentile(peaks, [5.0, 50.0, 95.0])
            x = len(labels)
            colour = COLOURS[number % len(COLOURS)]
            axes.plot([x, x], [low, high], color=colour, linewidth=5.0, alpha=0.35)
            axes.plot([x], [middle], marker="o", color=colour)
            labels.append(f"{case.name}, {road}")
    for criterion in _limits(result.study, point, "peak_acceleration"):
        limit = float(criterion.limits[0]) / size
        axes.axhline(limit, color="black", linewidth=0.9)
        axes.annotate(
            f"{criterion.title.split(' (')[0]}, {limit:.4g} {unit}",
            (1.0, limit),
            xycoords=("axes fraction", "data"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=8,
        )
    make_logarithmic(axes, "y")
    axes.set(ylabel=f"peak acceleration, 0-peak [{unit}]")
    axes.set_xticks(
        range(len(labels)), labels, fontsize=8, rotation=35, ha="right", rotation_mode="anchor"
    )
    axes.set_title(f"{point}, method {method!r}: median and 5-95 % of the runs", fontsize=9)
    return figure


def comparison_figure(rows: Sequence[ComparisonRow], report: ReportPlan = USUAL) -> Figure:
    """Draw our ranges with the printed values on them."""
    methods = list(dict.fromkeys(row.method for row in rows))
    figure, axes = new_figure(7.2, 0.30 * len(rows) + 1.2, columns=2, share="y")
    for panel, what, unit in (
        (axes[0], "peak", f"peak acceleration [{report.acceleration}]"),
        (axes[1], "rms", f"record RMS velocity [{report.velocity}]"),
    ):
        for y, row in enumerate(rows):
            low, middle, high = getattr(row, what)
            colour = COLOURS[2 * (methods.index(row.method) % 4)]
            panel.plot([low, high], [y, y], color=colour, linewidth=5.0, alpha=0.35)
            panel.plot([middle], [y], marker="o", color=colour, markersize=4)
            panel.plot(
                [getattr(row, f"printed_{what}")],
                [y],
                marker="x",
                color=COLOURS[1],
                markersize=6,
                markeredgewidth=1.6,
            )
        make_logarithmic(panel, "x")
        panel.set(xlabel=unit)
    axes[0].set_yticks(
        range(len(rows)), [f"{row.case} {row.road}, {row.method}" for row in rows], fontsize=8
    )
    axes[0].invert_yaxis()
    axes[0].plot([], [], marker="o", color=COLOURS[7], label="ours: median, 5-95 %")
    axes[0].plot([], [], marker="x", linestyle="none", color=COLOURS[1], label="published")
    figure.legend(loc="outside upper center", ncols=2)
    return figure
