"""Draw the narrow-band spectra of a record: of the whole, and over time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from trundle._typing import Array
from trundle.records.assess import RecordResult
from trundle.report.canvas import legend_below, line_look, make_logarithmic, new_figure
from trundle.report.figures.record_time import time_scale
from trundle.study.report_plan import ReportPlan
from trundle.views.words import shown

__all__ = ["psd_figure", "spectrogram_figure"]

_TICKS = (1, 2, 4, 8, 16, 31.5, 63)
_LOWEST = 0.7  # Hz: what lies below the lowest band is not shown
_RANGE = 1e4  # of amplitudes that colours tell apart: 80 dB


def psd_figure(result: RecordResult, report: ReportPlan, most: int) -> Figure:
    """Draw the one-sided PSD of velocity of the first channels."""
    figure, (axes,) = new_figure(7.2, 3.8)
    spectrum, (unit, size) = result.survey.spectrum, shown("m/s", report)
    f = spectrum.frequencies
    kept = (f >= 0.5) & (f <= 125.0) & (f < f[-1])  # half the rate holds half a line
    for i, name in enumerate(result.record.channel_names[:most]):
        colour, dashes = line_look(i)
        values = spectrum.psd[i, kept] / size**2
        axes.plot(f[kept], values, color=colour, linestyle=dashes, linewidth=0.9, label=name)
    axes.set(xlabel="frequency [Hz]", ylabel=f"PSD of velocity [({unit})\N{SUPERSCRIPT TWO}/Hz]")
    make_logarithmic(axes, "xy")
    _set_frequencies(axes, "x")
    legend_below(figure, *axes.get_legend_handles_labels(), columns=3)
    return figure


def spectrogram_figure(result: RecordResult, report: ReportPlan, most: int) -> Figure:
    """Draw the spectrograms of the first channels, their colours on one scale."""
    names = result.record.channel_names[:most]
    figure, axes = new_figure(7.2, 2.4 * len(names) + 0.4, rows=len(names), columns=1, share="xy")
    gram = result.survey.spectrogram
    unit, scale = time_scale(result.record.duration)
    v_unit, size = shown("m/s", report)
    levels = np.sqrt(gram.psd[: len(names)]) / size
    top = float(levels.max()) or 1.0
    norm = LogNorm(max(top / _RANGE, float(np.quantile(levels, 0.02)), 1e-12 * top), top)
    meshes = list[QuadMesh]()
    for panel, name, level in zip(axes, names, levels, strict=True):
        mesh = panel.pcolormesh(
            gram.edges / scale,
            _edges(gram.frequencies),
            level,
            norm=norm,
            cmap="viridis",
            rasterized=True,
        )
        panel.set(ylabel="frequency [Hz]", yscale="log")
        _set_frequencies(panel, "y")
        panel.set_title(name, loc="left", fontsize=9)
        panel.grid(visible=False)
        meshes.append(mesh)
    axes[-1].set(xlabel=f"time [{unit}]", xlim=(0.0, result.record.duration / scale))
    axes[-1].set_ylim(bottom=max(_LOWEST, float(gram.frequencies[0])))
    label = f"velocity [{v_unit}/\N{SQUARE ROOT}Hz]"
    bar = figure.colorbar(
        meshes[0], ax=axes, label=label, pad=0.02, format=StrMethodFormatter("{x:g}")
    )
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    return figure


def _edges(frequencies: Float[Array, " lines"]) -> Float[Array, " edges"]:
    """Return where lines begin and end [Hz]."""
    step = float(frequencies[0])  # lines are its multiples
    return np.append(frequencies - 0.5 * step, frequencies[-1] + 0.5 * step)


def _set_frequencies(axes: Axes, which: str) -> None:
    """Put the names of bands on a logarithmic axis of frequencies."""
    low, high = axes.get_xlim() if which == "x" else axes.get_ylim()
    ticks = [t for t in _TICKS if low <= t <= high]
    getattr(axes, f"set_{which}ticks")(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
