"""Draw a measured record: its history, and its spectra on criteria beside a simulation's."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from trundle.records.assess import RecordResult
from trundle.report.canvas import COLOURS, Drawing, legend_below, make_logarithmic, new_figure
from trundle.report.figures.response import draw_criterion
from trundle.signals import running_rms
from trundle.units import GAL, MICROMETRE_PER_SECOND
from trundle.views.words import rule_name

__all__ = ["drawings"]


def drawings(result: RecordResult) -> Iterator[Drawing]:
    """Give the spectra on the criteria, and the motion in time.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    yield Drawing(
        name="spectra",
        title="Velocity spectra on criteria",
        caption=f"RMS velocity in one-third octaves of {_channels(result)}.",
        draw=lambda: record_spectra_figure(result),
    )
    yield Drawing(
        name="history",
        title="Motion in time",
        caption=f"Velocity and acceleration of {_channels(result)} above {result.high_pass:g} Hz.",
        draw=lambda: record_history_figure(result),
    )


_MOST_CHANNELS = 6
_MOST_SIMULATED = 6


def _channels(result: RecordResult) -> str:
    """Say which channels are drawn."""
    n = len(result.runs.point_names)
    if n <= _MOST_CHANNELS:
        return "every channel"
    return f"the first {_MOST_CHANNELS} of {n} channels"


def record_history_figure(result: RecordResult) -> Figure:
    """Draw velocity with its running 1 s RMS, and acceleration, of the first channels."""
    runs = result.runs
    shown = runs.point_names[:_MOST_CHANNELS]
    figure, axes = new_figure(
        7.2, 1.5 * 2 * len(shown) + 0.5, rows=2 * len(shown), columns=1, share="x"
    )
    for i, name in enumerate(shown):
        velocity, acceleration = runs.velocity[0, :, i], runs.acceleration[0, :, i]
        upper, lower = axes[2 * i], axes[2 * i + 1]
        scale = 1.0 / MICROMETRE_PER_SECOND
        upper.plot(runs.time, scale * velocity, color=COLOURS[0], linewidth=0.6)
        rms = running_rms(velocity, runs.sampling_frequency)
        upper.plot(runs.time, scale * rms, color=COLOURS[1], label="running 1 s RMS")
        upper.set(ylabel="v [um/s]")
        upper.set_title(name, loc="left", fontsize=9)
        upper.legend(loc="upper right")
        lower.plot(runs.time, acceleration / GAL, color=COLOURS[2], linewidth=0.6)
        lower.set(ylabel="a [gal]")
    axes[-1].set(xlabel="time [s]", xlim=(0.0, float(runs.time[-1])))
    return figure


def record_spectra_figure(result: RecordResult) -> Figure:
    """Draw band levels on the velocity criteria, over the ranges of simulations."""
    figure, (axes,) = new_figure(7.2, 4.8)
    ways = {axis or "vertical" for axis in result.record.axes} | {"each axis"}
    for criterion in result.criteria:
        if criterion.quantity == "band_rms_velocity" and criterion.axis in ways:
            draw_criterion(axes, criterion)
    scale = 1.0 / MICROMETRE_PER_SECOND
    for number, simulated in enumerate(result.simulated[:_MOST_SIMULATED]):
        low, middle, high = scale * simulated.levels
        colour = COLOURS[(number + 2) % len(COLOURS)]
        axes.fill_between(simulated.mid_band, low, high, color=colour, alpha=0.18, linewidth=0)
        label = f"simulated: {simulated.title}"
        axes.plot(simulated.mid_band, middle, color=colour, linestyle="--", label=label)
    spectra = result.reduced.spectra
    for i, name in enumerate(spectra.point_names[:_MOST_CHANNELS]):
        levels = scale * spectra.values[0, i]
        marker = "os^vDP"[i]
        axes.plot(spectra.mid_band, levels, color=COLOURS[i % 2], marker=marker, label=name)
    make_logarithmic(axes, "xy")
    ticks = [1, 2, 4, 8, 16, 31.5, 63]
    axes.set(
        xlim=(0.9, 130.0),
        xlabel="mid-band frequency [Hz]",
        ylabel=f"RMS velocity in one-third octaves [um/s]\n({rule_name(result.averaging)})",
    )
    known = spectra.values[np.isfinite(spectra.values)]
    axes.set_ylim(bottom=max(axes.get_ylim()[0], 0.3 * scale * float(known.min(initial=1e-6))))
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    title, n = "measured levels", len(result.simulated)
    if n:
        title += ", on simulated 5-95 %"
    if n > _MOST_SIMULATED:
        title += f" of the first {_MOST_SIMULATED} of {n} cases"
    axes.set_title(title)
    legend_below(figure, *axes.get_legend_handles_labels(), columns=2)
    return figure
