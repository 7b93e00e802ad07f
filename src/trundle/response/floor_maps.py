"""Reduce the response of a whole floor, run by run, without storing a history."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Complex, Float
from scipy import fft, signal

from trundle._checks import one_of
from trundle._progress import Progress
from trundle._threads import n_threads
from trundle._typing import Array
from trundle.response.meter import CurveLimit
from trundle.response.quantities import mapped
from trundle.signals import (
    BASE_ACCELERATION,
    Averaging,
    band_edges,
    band_filter,
    mid_band_frequencies,
    running_rms,
    usable_bands,
    weighting_response,
)
from trundle.simulate import PlaceResponses, place_spectra

__all__ = ["FloorMap", "floor_map"]

_WINDOW = 1.0  # s
_SINGLE = {"response_factor": ("felt", BASE_ACCELERATION)}  # read of one running level
_BELOW, _ABOVE = 2.2, 1.8  # times a band's mid-frequency, beyond which its filter passes nothing
_EDGE = 1.3  # times its mid-frequency: where what a filter passes of its own band ends
_WIDTH = 0.65  # times its mid-frequency: samples a second of an envelope
_SLOW = 7.0  # Hz: below, 1 s holds so few periods that an envelope will not do
_LEAST_RATE = 20.0  # samples a second: a window of 1 s is moved in steps of 1/20 s


@dataclass(frozen=True, kw_only=True, eq=False)
class FloorMap:
    """Hold levels of every run at every place.

    Attributes
    ----------
    places : ndarray of float, shape (n_places, 2)
        Where [m].
    mid_band : ndarray of float, shape (n_bands,)
        Exact mid-band frequencies [Hz].
    resolved : ndarray of bool, shape (n_bands,)
        True where time step and modes reach over the whole band.
    averaging : {"max_1s", "event"}
        Averaging rule of the band levels.
    band_levels : ndarray of float, shape (n_runs, n_places, n_bands)
        RMS velocity in one-third octaves [m/s]; NaN in bands that are not resolved.
    numbers : mapping of str to ndarray, shape (n_runs, n_places)
        Quantities that are mapped, by their names; NaN where one was not asked for.
    above : mapping of str to ndarray, shape (n_runs, n_places)
        For how long the running level of 1 s lies above each curve that is watched [s], by its
        name; NaN of a curve that a map has no running level for.
    """

    places: Float[Array, "places 2"]
    mid_band: Float[Array, " bands"]
    resolved: Bool[Array, " bands"]
    averaging: Averaging
    band_levels: Float[Array, "runs places bands"]
    numbers: Mapping[str, Array]
    above: Mapping[str, Array] = field(default_factory=dict[str, Array])

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.band_levels)

    @property
    def rms_velocity(self) -> Float[Array, "runs places"]:
        """RMS velocity over the record [m/s]."""
        return self.numbers["rms_velocity"]

    @property
    def peak_acceleration(self) -> Float[Array, "runs places"]:
        """Largest absolute acceleration [m/s2]; NaN where it was not asked for."""
        return self.numbers["peak_acceleration"]

    def part(self, runs: slice) -> FloorMap:
        """Return some of the runs."""
        return replace(
            self,
            band_levels=self.band_levels[runs],
            numbers={name: values[runs] for name, values in self.numbers.items()},
            above={name: values[runs] for name, values in self.above.items()},
        )


def floor_map(
    responses: PlaceResponses,
    forces: Float[Array, "steps contacts runs"],
    *,
    f_max: float,
    averaging: Averaging = "max_1s",
    peaks: bool = True,
    people: bool = False,
    every_step: bool = False,
    curves: Sequence[CurveLimit] = (),
    progress: Progress | None = None,
) -> FloorMap:
    """Map the response to contact forces over a floor.

    Parameters
    ----------
    responses : PlaceResponses
        What leads from the forces to the places.
    forces : ndarray of float, shape (n_steps, n_contacts, n_runs)
        Contact forces [N].
    f_max : float
        Highest frequency that the computation contains [Hz].
    averaging : {"max_1s", "event"}
        Averaging rule of the band levels. Either lets the filters ring out behind the record;
        ``event`` divides their energy by its length.
    peaks : bool
        Whether peak accelerations are wanted; they take half as long again.
    people : bool
        Whether what people feel is wanted: response factors and doses; as long again as peaks.
    every_step : bool
        Move the window of the largest 1 s average by time steps instead of 1/20 s: several times
        slower, and equal to histories.
    curves : sequence of CurveLimit
        Curves above which time is counted, in steps of 1/20 s; those of velocity in bands, of
        response factors, if what people feel is wanted.
    progress : callable, optional
        Told the share done.

    Notes
    -----
    RMS velocity and peaks equal those of histories, and so do levels over the event of a floor that
    is at rest when the record ends: they are sums over spectral lines (Parseval), which count what
    still rings behind it too. The largest 1 s average is taken of each band's signal at a lower
    rate, above 7 Hz of its envelope, in steps of 1/20 s: within 1 % of that of histories in bands
    that matter, and within 4 % where next to nothing but the skirts of louder bands is left.
    """
    fs, n_runs, n_places = 1.0 / responses.dt, forces.shape[2], len(responses.places)
    mid_band = mid_band_frequencies()
    resolved = usable_bands(mid_band, fs) & (band_edges(mid_band)[:, 1] <= f_max)
    kind = np.float32 if responses.single else np.float64
    levels = np.full((n_runs, n_places, len(mid_band)), np.nan, dtype=kind)
    numbers = {quantity.name: np.full((n_runs, n_places), np.nan) for quantity, _ in mapped()}
    lines = _Lines(responses, mid_band[resolved], averaging, every_step=every_step)
    lines.watch(curves, resolved)
    wanted = {"velocity", *(["acceleration"] * peaks), *(["felt"] * people)}
    above = {curve.name: np.full((n_runs, n_places), np.nan) for curve in curves}
    with ThreadPoolExecutor(n_threads()) as pool:
        spectra = place_spectra(responses, forces, acceleration=peaks or people, progress=progress)
        for places, runs, velocity, acceleration in spectra:

            def reduce(
                run: int, velocity: Array = velocity, acceleration: Array | None = acceleration
            ) -> tuple[dict[str, Array], Array, dict[str, Array]]:
                """Reduce one run; its lines stay in cache."""
                accelerated = None if acceleration is None else acceleration[run]
                return lines.reduced(velocity[run], accelerated, wanted)

            found = list(pool.map(reduce, range(len(velocity))))
            for name in found[0][0]:
                numbers[name][runs, places] = [one[0][name] for one in found]
            levels[runs, places, resolved] = [one[1] for one in found]
            for name in found[0][2]:
                above[name][runs, places] = [one[2][name] for one in found]
    return FloorMap(
        places=responses.places,
        mid_band=mid_band,
        resolved=resolved,
        averaging=averaging,
        band_levels=levels,
        numbers=numbers,
        above=above,
    )


class _Lines:
    """What is made of the spectral lines of one run at some places."""

    def __init__(
        self, responses: PlaceResponses, mid_band: Array, averaging: Averaging, *, every_step: bool
    ) -> None:
        self._n, self._n_steps = responses.n_padded, responses.n_steps
        self._fs, self._watched = 1.0 / responses.dt, list[tuple[CurveLimit, Array]]()
        self._felt = weighting_response("Wb", responses.frequencies)
        self._averaging = one_of("averaging", averaging, ("event", "max_1s"))
        kind = np.complex64 if responses.single else np.complex128
        lines, fs = responses.frequencies, 1.0 / responses.dt
        filters = [signal.freqz_sos(band_filter(f, fs), worN=lines, fs=fs)[1] for f in mid_band]
        # of a real record: every line but the first and the last stands for two
        twice = np.full(len(lines), 2.0)
        twice[0] = 1.0
        if self._n % 2 == 0:
            twice[-1] = 1.0
        weights = np.stack([twice * np.abs(h) ** 2 for h in filters], axis=1)
        self._weights = (weights / (self._n * self._n_steps)).astype(kind(0).real.dtype)
        period = self._n / fs
        self._bands = [
            _whole_band(response, round(fs), kind)
            if every_step
            else _band(f, response, period, kind)
            for f, response in zip(mid_band, filters, strict=True)
        ]

    def watch(self, curves: Sequence[CurveLimit], resolved: Bool[Array, " bands"]) -> None:
        """Count the time above some curves too, with limits by the bands that are resolved."""
        of_bands = "band_rms_velocity"
        self._watched = [
            (curve, curve.limits[resolved] if curve.quantity == of_bands else curve.limits)
            for curve in curves
            if curve.is_read and curve.quantity in (of_bands, *_SINGLE)
        ]

    def reduced(
        self, rows: Complex[Array, "places lines"], acceleration: Array | None, wanted: set[str]
    ) -> tuple[dict[str, Array], Array, dict[str, Array]]:
        """Return the quantities of one run by name, its band levels, and times above curves."""
        numbers: dict[str, Array] = {}
        records = {"velocity": self._record(rows)}
        if acceleration is not None:
            records["acceleration"] = self._record(acceleration)
        if acceleration is not None and "felt" in wanted:
            records["felt"] = self._record(acceleration * self._felt)
        for quantity, how in mapped():
            if how.of in wanted:
                numbers[quantity.name] = how.measure(records[how.of], self._fs)
        squares = list(self._squares(rows))
        if self._averaging == "event":
            bands = np.sqrt((np.real(rows) ** 2 + np.imag(rows) ** 2) @ self._weights)
        else:
            bands = np.stack([np.sqrt(s.max(axis=-1)) for s in squares], axis=-1)
        return numbers, bands, self._above(squares, records)

    def _squares(self, rows: Array) -> Iterator[Float[Array, "places windows"]]:
        """Give the running mean square in every band, where anybody asks for it."""
        if self._averaging != "event" or self._watched:
            for band in self._bands:
                yield band.squares(rows)

    def _above(
        self, squares: list[Array], records: Mapping[str, Array]
    ) -> dict[str, Float[Array, " places"]]:
        """Return for how long running levels lie above the curves that are watched [s]."""
        out: dict[str, Float[Array, " places"]] = {}
        n = round(self._n / self._fs * _LEAST_RATE)
        for curve, limits in self._watched:
            if curve.quantity in _SINGLE:
                of, base = _SINGLE[curve.quantity]
                if of in records:
                    out[curve.name] = _time_above(records[of], self._fs, base * limits[0])
                continue
            above = np.zeros((len(records["velocity"]), n), dtype=bool)
            for band in np.flatnonzero(np.isfinite(limits)):
                size = squares[band].shape[-1]
                above |= squares[band][:, np.arange(n) * size // n] > limits[band] ** 2
            out[curve.name] = above.sum(axis=-1) / _LEAST_RATE
        return out

    def _record(self, rows: Complex[Array, "places lines"]) -> Float[Array, "places steps"]:
        """Return the history over the record, without what rings behind it."""
        return fft.irfft(rows, self._n, axis=-1)[:, : self._n_steps]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Band:
    """A band's signal at a rate that its width needs: itself if it is slow, else its envelope."""

    lines: slice
    response: Array  # (lines,), scaled so that the square's mean is that of the signal
    size: int  # samples over the whole period
    width: int  # samples in a second
    real: bool

    def squares(self, rows: Array) -> Float[Array, "places windows"]:
        """Return the mean square over the second from each sample on."""
        part = rows[:, self.lines] * self.response
        if self.real:
            whole = np.zeros((len(part), self.size // 2 + 1), dtype=part.dtype)
            whole[:, self.lines] = part
            square = fft.irfft(whole, self.size, axis=-1, norm="forward") ** 2
        else:
            envelope = fft.ifft(_folded(part, self.size), axis=-1, norm="forward")
            square = np.real(envelope) ** 2 + np.imag(envelope) ** 2
        return _window_sums(square, self.width) / self.width


def _time_above(record: Array, fs: float, limit: float) -> Float[Array, " places"]:
    """Return for how long the running RMS of 1 s of a record lies above a limit [s]."""
    longer = np.pad(record, ((0, 0), (0, round(fs))))
    return (running_rms(longer, fs) > limit).sum(axis=-1) / fs


def _window_sums(samples: Array, width: int) -> Array:
    """Return the sums over so many samples from each on, round the period, by doubling."""
    n_rows, n = samples.shape
    # as one row, whose last windows of every period are left out
    sums = np.concatenate([samples, samples[:, :width]], axis=1).reshape(-1)
    total, found, done, length = sums.size, np.zeros(sums.size, sums.dtype), 0, 1
    while done < width:
        if width & length:
            found[: total - done - length + 1] += sums[done:]
            done += length
        sums = sums[:-length] + sums[length:]
        length *= 2
    return found.reshape(n_rows, n + width)[:, :n]


def _folded(part: Array, size: int) -> Array:
    """Return lines for an envelope of so many samples.

    What a filter passes far from its band is weak; folded onto the band it keeps its energy.
    """
    whole = -(-part.shape[-1] // size) * size
    padded = np.zeros((len(part), whole), dtype=part.dtype)
    padded[:, : part.shape[-1]] = part
    return padded.reshape(len(part), -1, size).sum(axis=1)


def _band(f: float, response: Array, period: float, kind: type[np.complexfloating]) -> _Band:
    n_lines = len(response)
    lines = slice(max(1, round(f / _BELOW * period)), min(round(f * _ABOVE * period), n_lines - 1))
    real = bool(f < _SLOW)
    # a square has twice the frequencies of the signal
    least = (4.0 * _EDGE if real else _WIDTH) * f
    width = fft.next_fast_len(int(np.ceil(max(_LEAST_RATE, least))), real=real)
    size = round(width * period)
    scale = (1.0 if real else np.sqrt(2.0)) / (2.0 * (n_lines - 1))
    if real:
        lines = slice(lines.start, min(lines.stop, size // 2))
    scaled = (scale * response[lines]).astype(kind)
    return _Band(lines=lines, response=scaled, size=size, width=width, real=real)


def _whole_band(response: Array, fs: int, kind: type[np.complexfloating]) -> _Band:
    n = 2 * (len(response) - 1)
    scaled = (response / n).astype(kind)
    return _Band(lines=slice(0, len(response)), response=scaled, size=n, width=fs, real=True)
