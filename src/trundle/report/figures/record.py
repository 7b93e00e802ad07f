"""Draw a measured record: its levels on criteria, and its motion in time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from trundle.records.assess import RecordResult
from trundle.report.canvas import COLOURS, Drawing, new_figure
from trundle.report.figures.record_levels import percentiles_figure, record_spectra_figure
from trundle.report.figures.record_spectra import psd_figure, spectrogram_figure
from trundle.report.figures.record_time import running_figure, time_scale
from trundle.study.report_plan import ReportPlan
from trundle.views.words import USUAL, shown

__all__ = ["drawings"]

_MOST_CHANNELS = 6


def drawings(result: RecordResult, report: ReportPlan = USUAL) -> Iterator[Drawing]:
    """Give the levels on the criteria, then how the record runs, as they stand on the page.

    Parameters
    ----------
    result : RecordResult
        What is said of the record.
    report : ReportPlan
        Has the units that they are drawn in.

    Yields
    ------
    Drawing
        One after the other.
    """
    yield from _levels(result, report)
    yield from _frequencies(result, report)
    yield _history(result, report)


def _levels(result: RecordResult, report: ReportPlan) -> Iterator[Drawing]:
    """Give band levels on the criteria, and how they run."""
    running = result.survey.running
    yield Drawing(
        name="spectra",
        title="Velocity spectra on criteria",
        caption=f"RMS velocity in one-third octaves of {_channels(result)}.",
        draw=lambda: record_spectra_figure(result, report, _MOST_CHANNELS),
    )
    yield Drawing(
        name="percentiles",
        title="Levels exceeded for shares of the time",
        caption=(
            f"RMS velocity in one-third octaves of {_channels(result)}: the largest, L10 and L50 "
            f"(running levels exceeded 10 % and 50 % of the time, {running.step:.3g} s apart, "
            f"{_rule(running.averaging)}), and the mean over the whole record."
        ),
        draw=lambda: percentiles_figure(result, report, _MOST_CHANNELS),
    )
    yield Drawing(
        name="running",
        title="Running RMS and events",
        caption=(
            f"Running {_rule(running.averaging)} of velocity of {_channels(result)}: of all "
            "motion, and in the band that is loudest. Events are shaded. A criterion's line is its "
            "limit at 8 Hz and above; below, and for all motion together, its limit is another."
        ),
        draw=lambda: running_figure(result, report, _MOST_CHANNELS),
    )


def _frequencies(result: RecordResult, report: ReportPlan) -> Iterator[Drawing]:
    """Give the power spectral density, and how it goes over time."""
    spectrum, gram = result.survey.spectrum, result.survey.spectrogram
    yield Drawing(
        name="psd",
        title="Power spectral density",
        caption=(
            f"One-sided PSD of velocity of {_channels(result)} by Welch's method: "
            f"{spectrum.n_windows} Hann windows of {spectrum.width:.3g} s, half overlapping, lines "
            f"{spectrum.resolution:.3g} Hz apart. Its integral is the mean square."
        ),
        draw=lambda: psd_figure(result, report, _MOST_CHANNELS),
    )
    many = "" if gram.per_column == 1 else f", the largest of {gram.per_column} in each column"
    yield Drawing(
        name="spectrogram",
        title="Spectrogram",
        caption=(
            f"Velocity of {_channels(result)} over time and frequency: root of the PSD of Hann "
            f"windows of {gram.width:.3g} s{many}."
        ),
        draw=lambda: spectrogram_figure(result, report, _MOST_CHANNELS),
    )


def _history(result: RecordResult, report: ReportPlan) -> Drawing:
    """Return the motion in time."""
    n = result.survey.outline.per_column
    rate = result.record.sampling_frequency
    hull = "" if n == 1 else f", smallest and largest value of every {n / rate:.3g} s"
    return Drawing(
        name="history",
        title="Motion in time",
        caption=(
            f"Velocity and acceleration of {_channels(result)} above {result.high_pass:g} Hz{hull}."
        ),
        draw=lambda: record_history_figure(result, report),
    )


def _rule(averaging: str) -> str:
    """Return a running average in words."""
    names = {"slow": "RMS by 1 s (slow)", "fast": "RMS by 0.125 s (fast)"}
    return names.get(averaging, "RMS over 1 s")


def _channels(result: RecordResult) -> str:
    """Say which channels are drawn."""
    n = len(result.record.channel_names)
    if n <= _MOST_CHANNELS:
        return "every channel"
    return f"the first {_MOST_CHANNELS} of {n} channels"


def record_history_figure(result: RecordResult, report: ReportPlan = USUAL) -> Figure:
    """Draw velocity with its running RMS, and acceleration, of the first channels."""
    outline, running = result.survey.outline, result.survey.running
    names = result.record.channel_names[:_MOST_CHANNELS]
    figure, axes = new_figure(
        7.2, 1.5 * 2 * len(names) + 0.5, rows=2 * len(names), columns=1, share="x"
    )
    kept = slice(0, 1) if outline.per_column == 1 else slice(0, 2)
    (v_unit, v_size), (a_unit, a_size) = shown("m/s", report), shown("m/s2", report)
    unit, scale = time_scale(result.record.duration)
    time = np.repeat(outline.time, kept.stop) / scale
    for i, name in enumerate(names):
        velocity = outline.velocity[i, :, kept].ravel() / v_size
        acceleration = outline.acceleration[i, :, kept].ravel() / a_size
        upper, lower = axes[2 * i], axes[2 * i + 1]
        upper.plot(time, velocity, color=COLOURS[0], linewidth=0.6)
        level = running.whole[i] / v_size
        label = f"running {_rule(running.averaging)}"
        upper.plot(running.time / scale, level, color=COLOURS[1], label=label)
        upper.set(ylabel=f"v [{v_unit}]")
        upper.set_title(name, loc="left", fontsize=9)
        upper.legend(loc="upper right")
        lower.plot(time, acceleration, color=COLOURS[2], linewidth=0.6)
        lower.set(ylabel=f"a [{a_unit}]")
    axes[-1].set(xlabel=f"time [{unit}]", xlim=(0.0, result.record.duration / scale))
    return figure
