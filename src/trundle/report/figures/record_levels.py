"""Draw the band levels of a record on criteria: the largest, and those exceeded for a share."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trundle.records.assess import RecordResult
from trundle.report.canvas import COLOURS, legend_below, make_logarithmic, new_figure
from trundle.report.figures.response import draw_criterion
from trundle.study.report_plan import ReportPlan
from trundle.views.record_survey import SHARES
from trundle.views.words import USUAL, rule_name, shown

__all__ = ["percentiles_figure", "record_spectra_figure"]

_MOST_SIMULATED = 6


def record_spectra_figure(
    result: RecordResult, report: ReportPlan = USUAL, most: int = 6
) -> Figure:
    """Draw band levels on the velocity criteria, over the ranges of simulations."""
    figure, (axes,) = new_figure(7.2, 4.8)
    ways = {axis or "vertical" for axis in result.record.axes}
    _draw_criteria(axes, result, ways, report)
    scale = 1.0 / shown("m/s", report)[1]
    for number, simulated in enumerate(result.simulated[:_MOST_SIMULATED]):
        low, middle, high = scale * simulated.levels
        colour = COLOURS[(number + 2) % len(COLOURS)]
        axes.fill_between(simulated.mid_band, low, high, color=colour, alpha=0.18, linewidth=0)
        label = f"simulated: {simulated.title}"
        axes.plot(simulated.mid_band, middle, color=colour, linestyle="--", label=label)
    spectra = result.reduced.spectra
    for i, name in enumerate(spectra.point_names[:most]):
        levels = scale * spectra.values[0, i]
        marker = "os^vDP"[i]
        axes.plot(spectra.mid_band, levels, color=COLOURS[i % 2], marker=marker, label=name)
    known = spectra.values[np.isfinite(spectra.values)]
    _set_bands(axes, float(known.min(initial=1e-6)), (rule_name(result.averaging), report))
    title, n = "measured levels", len(result.simulated)
    if n:
        title += ", on simulated 5-95 %"
    if n > _MOST_SIMULATED:
        title += f" of the first {_MOST_SIMULATED} of {n} cases"
    axes.set_title(title)
    legend_below(figure, *axes.get_legend_handles_labels(), columns=2)
    return figure


def percentiles_figure(result: RecordResult, report: ReportPlan = USUAL, most: int = 6) -> Figure:
    """Draw the largest level, L10, L50 and the mean of the first channels on the criteria."""
    names = result.record.channel_names[:most]
    figure, axes = new_figure(7.2, 3.6 * len(names) + 0.4, rows=len(names), columns=1, share="x")
    running = result.survey.running
    shares = {name: running.exceeded(share) for name, share in SHARES.items()}
    scale = 1.0 / shown("m/s", report)[1]
    for i, (panel, name) in enumerate(zip(axes, names, strict=True)):
        _draw_criteria(panel, result, {result.record.axes[i] or "vertical"}, report)
        curves = {
            f"largest ({rule_name(result.averaging)})": result.reduced.spectra.values[0, i],
            **{share: values[i] for share, values in shares.items()},
            "mean": result.survey.mean_levels[i],
        }
        for number, (label, levels) in enumerate(curves.items()):
            panel.plot(
                running.mid_band,
                scale * levels,
                color=COLOURS[number],
                marker="os^v"[number],
                markersize=4,
                linestyle=("-", "--", "-.", ":")[number],
                label=label,
            )
        known = np.concatenate([levels[np.isfinite(levels)] for levels in curves.values()])
        _set_bands(panel, float(known.min(initial=1e-6)), ("", report))
        panel.set_title(name, loc="left", fontsize=9)
        if i < len(names) - 1:
            panel.set_xlabel("")
    legend_below(figure, *axes[0].get_legend_handles_labels(), columns=4)
    return figure


def _draw_criteria(axes: Axes, result: RecordResult, ways: set[str], report: ReportPlan) -> None:
    """Draw the curves of velocity for motion in some directions."""
    for criterion in result.criteria:
        if criterion.quantity == "band_rms_velocity" and criterion.axis in {*ways, "each axis"}:
            draw_criterion(axes, criterion, shown("m/s", report)[1])


def _set_bands(axes: Axes, lowest: float, told: tuple[str, ReportPlan]) -> None:
    """Set logarithmic axes of bands and levels, down to about the lowest level [m/s]."""
    rule, (unit, size) = told[0], shown("m/s", told[1])
    make_logarithmic(axes, "xy")
    ticks = [1, 2, 4, 8, 16, 31.5, 63]
    axes.set(
        xlim=(0.9, 130.0),
        xlabel="mid-band frequency [Hz]",
        ylabel=f"RMS velocity in one-third octaves [{unit}]" + (f"\n({rule})" if rule else ""),
    )
    axes.set_ylim(bottom=max(axes.get_ylim()[0], 0.3 * lowest / size))
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
