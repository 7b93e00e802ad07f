"""Draw how a record's level runs, beside criteria, with its events."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trundle._typing import Array
from trundle.records.assess import RecordResult
from trundle.report.canvas import COLOURS, legend_below, make_logarithmic, new_figure
from trundle.study.report_plan import ReportPlan
from trundle.views.words import shown

__all__ = ["running_figure", "time_scale"]

_COLUMNS = 4000  # of a line: more than a page shows
_AT = 8.0  # Hz, from which generic curves are level
_MINUTES, _HOURS = 600.0, 7200.0  # s, from which time is shown in them


def time_scale(duration: float) -> tuple[str, float]:
    """Return the unit that a time is read in, and its size [s]."""
    if duration >= _HOURS:
        return "h", 3600.0
    return ("min", 60.0) if duration >= _MINUTES else ("s", 1.0)


def running_figure(result: RecordResult, report: ReportPlan, most: int) -> Figure:
    """Draw running RMS of the first channels, with criteria at 8 Hz and events."""
    names = result.record.channel_names[:most]
    figure, axes = new_figure(7.2, 2.4 * len(names) + 0.5, rows=len(names), columns=1, share="x")
    running = result.survey.running
    unit, scale = time_scale(result.record.duration)
    v_unit, size = shown("m/s", report)
    for i, (panel, name) in enumerate(zip(axes, names, strict=True)):
        loudest = _largest_band(running.bands[i][running.shown], len(running.time))
        for number, (label, level) in enumerate(
            (("all motion", running.whole[i]), ("loudest band", loudest))
        ):
            time, held = _thinned(running.time / scale, level / size)
            panel.plot(time, held, color=COLOURS[number], linewidth=0.8, label=label)
        panel.broken_barh(
            [(event.start / scale, event.duration / scale) for event in result.events[i].events],
            (0.0, 1.0),
            transform=panel.get_xaxis_transform(),
            color=COLOURS[4],
            alpha=0.25,
        )
        panel.set(ylabel=f"RMS velocity [{v_unit}]")
        make_logarithmic(panel, "y")
        _draw_limits(panel, result, i, size)
        n = len(result.events[i].events)
        panel.set_title(f"{name}: {n} event{'' if n == 1 else 's'}", loc="left", fontsize=9)
    axes[-1].set(xlabel=f"time [{unit}]", xlim=(0.0, result.record.duration / scale))
    handles, labels = axes[0].get_legend_handles_labels()
    legend_below(figure, handles, labels, columns=2)
    return figure


def _largest_band(bands: Float[Array, "bands times"], n: int) -> Float[Array, " times"]:
    """Return the level of the loudest band at each time; nothing where none is shown."""
    return bands.max(axis=0) if len(bands) else np.full(n, np.nan)


def _thinned(
    time: Float[Array, " times"], level: Float[Array, " times"]
) -> tuple[Float[Array, " columns"], Float[Array, " columns"]]:
    """Return the largest level of every few, so many as are seen."""
    group = -(-len(time) // _COLUMNS)
    if group <= 1:
        return time, level
    at = np.arange(0, len(time), group)
    return time[at], np.maximum.reduceat(level, at)


def _draw_limits(panel: Axes, result: RecordResult, channel: int, size: float) -> None:
    """Draw the limits at 8 Hz that lie among the levels, and the next above, in a unit [m/s]."""
    way = result.record.axes[channel] or "vertical"
    low, high = panel.get_ylim()
    above = list[float]()
    limits = {
        c.title: float(c.limit(np.array([_AT]))[0]) / size
        for c in result.criteria
        if c.quantity == "band_rms_velocity" and c.axis in {way, "each axis"}
    }
    for title, limit in sorted(limits.items(), key=lambda pair: pair[1]):
        if not np.isfinite(limit) or limit < low or len(above) > 0:
            continue
        if limit > high:
            above.append(limit)
        panel.axhline(limit, color="black", linewidth=0.8, linestyle="--")
        panel.annotate(
            title,
            (1.0, limit),
            xycoords=("axes fraction", "data"),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=7.5,
            annotation_clip=False,
        )
    panel.set_ylim(low, max(high, 1.5 * max(above, default=0.0)))
