"""Draw transfer functions: magnitude over phase."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from trundle.report.canvas import COLOURS, make_logarithmic, new_figure
from trundle.views.transfer import Curve

__all__ = ["transfer_figure"]

_WIDE = 6.0  # times its lowest frequency must a range reach to be drawn by its logarithm
_LINES = ("-", "--", ":", "-.")
_SHORT = 300.0  # ratio of magnitudes up to which 2 and 5 are written on the axis too
_ROW = 0.17  # inch, for a line of the legend
_LETTERS = 95  # in a row of the legend


def transfer_figure(some: Sequence[Curve], quantity: str, title: str) -> Figure:
    """Draw magnitude and phase of transfer functions over frequency.

    Parameters
    ----------
    some : sequence of Curve
        The functions, all of one quantity.
    quantity : str
        What it is called.
    title : str
        What stands above.
    """
    names = [f"{curve.load} → {curve.point}" for curve in some]
    columns = max(1, min(len(names), _LETTERS // (max(map(len, names)) + 6)))
    height = 5.0 + _ROW * -(-len(names) // columns)
    figure, (size, phase) = new_figure(7.2, height, rows=2, share="x")
    for i, (curve, name) in enumerate(zip(some, names, strict=True)):
        colour = COLOURS[i % len(COLOURS)]
        line = _LINES[i // len(COLOURS) % len(_LINES)]
        f = curve.frequencies
        size.plot(f, curve.magnitude, color=colour, linestyle=line, label=name)
        phase.plot(f, _unjoined(curve.phase), color=colour, linestyle=line)
    make_logarithmic(size, "y")
    _write_more(size)
    size.set_ylabel(f"{quantity} [{some[0].unit}]")
    size.set_title(title, loc="left", fontsize=9)
    phase.set(ylabel="phase [deg]", ylim=(-190.0, 190.0), xlabel="frequency [Hz]")
    phase.set_yticks([-180, -90, 0, 90, 180])
    _frequency_axis(phase, some[0].frequencies)
    figure.legend(loc="outside lower center", ncols=columns)
    return figure


def _frequency_axis(axes: Axes, frequencies: np.ndarray) -> None:
    low, high = float(frequencies[0]), float(frequencies[-1])
    if low > 0.0 and high > _WIDE * low:
        axes.set_xscale("log")
        decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
        ticks = np.outer(decades, [1.0, 2.0, 5.0]).ravel()
        ticks = ticks[(ticks >= 0.999 * low) & (ticks <= 1.001 * high)]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
    axes.set_xlim(low, high)


def _write_more(axes: Axes) -> None:
    """Write 2 and 5 beside powers of ten where these alone would be few."""
    low, high = axes.get_ylim()
    if axes.get_yscale() == "log" and high < _SHORT * low:
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))


def _unjoined(phase: np.ndarray) -> np.ndarray:
    """Return phases with a gap where they go from -180 to 180 degrees."""
    shown = phase.copy()
    shown[1:][np.abs(np.diff(phase)) > 180.0] = np.nan
    return shown
