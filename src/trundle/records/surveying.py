"""Survey a record section by section: what is kept is small, and no history is."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from jaxtyping import Float
from scipy import signal

from trundle._threads import n_threads
from trundle._typing import Array
from trundle.records.survey import Outline, RunningLevels, Spectrogram, Spectrum, Survey
from trundle.signals import (
    Averaging,
    Record,
    Section,
    band_delay,
    band_filter,
    mid_band_frequencies,
    running_mean_square,
    usable_bands,
    window_psds,
)

__all__ = ["Surveyor"]

_WINDOW = 1.0  # s of a running average
_STEP = 0.125  # s between running levels
_LONGEST_STEP = 0.5  # s: half a window, so that no event lies between two levels
_MOST_LEVELS = 2**17  # of them, before the step grows
_PSD_WIDTH = 4.0  # s: lines 0.25 Hz apart, as far as the 1 Hz band is wide
_GRAM_WIDTH = 2.0  # s
_GRAM_TOP = 100.0  # Hz
_COLUMNS = 600  # of a spectrogram: what a page shows side by side
_OUTLINED = 3000  # columns of an outline
_WHOLE = 4  # times as many samples are kept as they are


class _Grid:
    """Windows of one width, evenly through a record, and which of them a section begins."""

    def __init__(self, width: int, hop: int, n: int) -> None:
        self.width, self.hop = width, hop
        self.n_windows = max(1, (n - width) // hop + 1)

    def of(self, section: Section) -> tuple[int, Array]:
        """Return the number of the first window that begins in a section, and all their starts.

        Starts are steps of the section's motion.
        """
        low = -(-section.first // self.hop)
        high = min(-(-(section.first + section.n_seen) // self.hop), self.n_windows)
        starts = np.arange(low, max(high, low)) * self.hop - section.first + section.seen.start
        return low, starts


class Surveyor:
    """Take the sections of a record one by one, and give its survey at the end."""

    def __init__(self, record: Record, averaging: Averaging) -> None:
        n, fs = record.samples.shape[1], record.sampling_frequency
        channels = len(record.samples)
        self._fs, self._n = fs, n
        self._averaging: Averaging = averaging
        self._mid_band = mid_band_frequencies()
        long = self._mid_band >= record.lowest_frequency * (1.0 - 1e-9)
        self._shown = usable_bands(self._mid_band, fs) & long
        step = np.clip(n / fs / _MOST_LEVELS, _STEP, _LONGEST_STEP)
        self._levels = _Grid(max(1, round(_WINDOW * fs)), max(1, round(float(step) * fs)), n)
        shape = (channels, len(self._mid_band), self._levels.n_windows)
        self._bands = np.full(shape, np.nan, dtype=np.float32)
        self._whole = np.zeros((channels, shape[2]), dtype=np.float32)
        self._squares = np.zeros(shape[:2])
        width = min(round(_PSD_WIDTH * fs), n // 2)
        self._psd = _Grid(width, width - width // 2, n)
        self._lines = np.zeros((channels, width // 2 + 1))
        width = min(round(_GRAM_WIDTH * fs), n // 4)
        hop = int(np.clip((n - width) // _COLUMNS, max(1, width // 8), max(1, width // 2)))
        self._gram = _Grid(width, hop, n)
        self._per_column = -(-self._gram.n_windows // _COLUMNS)
        lines = np.arange(width // 2 + 1) * fs / width
        self._gram_lines = np.flatnonzero((lines > 0.0) & (lines <= _GRAM_TOP))
        columns = -(-self._gram.n_windows // self._per_column)
        self._grams = np.zeros((channels, len(self._gram_lines), columns), dtype=np.float32)
        self._per_outline = 1 if n <= _WHOLE * _OUTLINED else -(-n // _OUTLINED)
        columns = -(-n // self._per_outline)
        self._outline = {
            name: np.tile([np.inf, -np.inf], (channels, columns, 1))
            for name in ("velocity", "acceleration")
        }
        self._dose = np.zeros((channels, int(np.ceil(n / fs))))
        self._acceleration_square = np.zeros(channels)

    def take(self, section: Section, felt: Float[Array, "channels wide"]) -> None:
        """Take the next section, with its weighted acceleration [m/s2]."""
        _, velocity, acceleration = section.motion
        self._take_levels(section, velocity)
        for _, psds in self._windows(section, velocity, self._psd):
            self._lines += psds.sum(axis=1)
        self._take_spectrogram(section, velocity)
        for name, motion in (("velocity", velocity), ("acceleration", acceleration)):
            self._take_outline(name, motion[:, section.seen], section.first)
        a = acceleration[:, section.seen]
        self._acceleration_square += np.einsum("ij,ij->i", a, a)
        seconds = np.arange(section.first, section.first + section.n_seen) / self._fs
        for i, row in enumerate(felt[:, section.seen]):
            n = self._dose.shape[1]
            self._dose[i] += np.bincount(seconds.astype(int), row**4, minlength=n) / self._fs

    def survey(self) -> Survey:
        """Return what was found in all sections."""
        fs, n = self._fs, self._n
        width, hop = self._levels.width, self._levels.hop
        back = running_mean_square(np.zeros(1), fs, self._averaging)[1]
        ends = width + hop * np.arange(self._levels.n_windows)
        peak = np.abs(self._outline["acceleration"]).max(axis=(1, 2))
        rms = np.sqrt(self._acceleration_square / n)
        squares = np.where(self._shown, self._squares / n, np.nan)
        starts = np.arange(self._grams.shape[2] + 1) * self._per_column
        middle = 0.5 * (self._gram.width - self._gram.hop)
        per_line = fs / self._gram.width
        return Survey(
            running=RunningLevels(
                time=ends / fs - back,
                bands=self._bands,
                whole=self._whole,
                mid_band=self._mid_band,
                shown=self._shown,
                averaging="max_1s" if self._averaging == "event" else self._averaging,
            ),
            spectrum=Spectrum(
                frequencies=np.arange(self._lines.shape[1]) * fs / self._psd.width,
                psd=self._lines / self._psd.n_windows,
                n_windows=self._psd.n_windows,
                width=self._psd.width / fs,
            ),
            spectrogram=Spectrogram(
                frequencies=self._gram_lines * per_line,
                edges=(np.minimum(starts, self._gram.n_windows) * self._gram.hop + middle) / fs,
                psd=self._grams,
                width=self._gram.width / fs,
                per_column=self._per_column,
            ),
            outline=Outline(
                time=np.arange(self._outline["velocity"].shape[1]) * self._per_outline / fs,
                per_column=self._per_outline,
                **self._outline,
            ),
            dose=self._dose,
            crest_factor=peak / np.maximum(rms, np.finfo(float).tiny),
            mean_levels=np.sqrt(squares),
        )

    def _take_levels(self, section: Section, velocity: Float[Array, "channels wide"]) -> None:
        """Take running levels whose window begins in a section."""
        first, starts = self._levels.of(section)
        columns = slice(first, first + len(starts))
        ends = starts + self._levels.width - 1
        fs, rule = self._fs, self._averaging
        self._whole[:, columns] = np.sqrt(running_mean_square(velocity, fs, rule)[0][:, ends])

        def take(band: int) -> None:
            """Filter into a band; its delay is taken off."""
            sos = band_filter(float(self._mid_band[band]), fs)
            delay = round(band_delay(float(self._mid_band[band]), fs) * fs)
            passed = np.asarray(signal.sosfilt(sos, velocity, axis=-1))
            squares = running_mean_square(passed, fs, rule)[0]
            at = np.minimum(ends + delay, passed.shape[1] - 1)
            self._bands[:, band, columns] = np.sqrt(squares[:, at])
            seen = passed[:, section.seen.start + delay : section.seen.stop + delay]
            self._squares[:, band] += np.einsum("ij,ij->i", seen, seen)

        with ThreadPoolExecutor(n_threads()) as pool:
            list(pool.map(take, np.flatnonzero(self._shown).tolist()))

    def _windows(
        self, section: Section, velocity: Array, grid: _Grid
    ) -> Iterator[tuple[Array, Array]]:
        """Give the PSDs of windows that begin in a section, by their numbers in the record."""
        first, starts = grid.of(section)
        found = window_psds(velocity, self._fs, width=grid.width, starts=starts)
        for part, psds in found:
            yield np.arange(first + part.start, first + part.start + psds.shape[1]), psds

    def _take_spectrogram(self, section: Section, velocity: Array) -> None:
        for numbers, psds in self._windows(section, velocity, self._gram):
            columns = numbers // self._per_column
            at = np.flatnonzero(np.diff(columns, prepend=-1))
            largest = np.maximum.reduceat(psds[..., self._gram_lines], at, axis=1)
            kept = self._grams[..., columns[at]]
            self._grams[..., columns[at]] = np.maximum(kept, np.moveaxis(largest, 1, -1))

    def _take_outline(self, name: str, motion: Float[Array, "channels seen"], first: int) -> None:
        columns = np.arange(first, first + motion.shape[1]) // self._per_outline
        at = np.flatnonzero(np.diff(columns, prepend=-1))
        kept = self._outline[name][:, columns[at]]
        kept[..., 0] = np.minimum(kept[..., 0], np.minimum.reduceat(motion, at, axis=1))
        kept[..., 1] = np.maximum(kept[..., 1], np.maximum.reduceat(motion, at, axis=1))
        self._outline[name][:, columns[at]] = kept
