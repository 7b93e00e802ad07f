"""Sum answers to single waves up to the exact statistics of a response."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float
from scipy import signal

from trundle._typing import Array
from trundle.response.peaks import Process, peak_levels
from trundle.signals import band_edges, band_filter, mid_band_frequencies, usable_bands
from trundle.simulate import Harmonics, MeanResponse

__all__ = ["ExactStatistics", "exact_statistics"]

_WINDOW = 1.0  # s


@dataclass(frozen=True, kw_only=True, eq=False)
class ExactStatistics:
    """Hold the exact mean and variance of a response over all roads of a class.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time of the record [s].
    mean : dict of str to ndarray, shape (n_steps, n_points)
        Response to the static loads alone; keys ``displacement``, ``velocity``,
        ``acceleration``.
    std : dict of str to ndarray, shape (n_steps, n_points)
        Standard deviation at each time; same keys.
    contact_mean, contact_std : ndarray of float, shape (n_steps, n_contacts)
        Contact forces [N].
    mid_band : ndarray of float, shape (n_bands,)
        Exact mid-band frequencies [Hz].
    resolved : ndarray of bool, shape (n_bands,)
        True where time step and modes reach over the whole band.
    band_event : ndarray of float, shape (n_points, n_bands)
        Root of the mean square velocity in each band, over record and roads [m/s].
    band_running : ndarray of float, shape (n_points, n_bands)
        Root of the largest mean square over 1 s, averaged over roads before the maximum is
        taken [m/s]: below the median of each run's own maximum.
    peaks : dict of str to Process
        What decides the peaks of ``velocity`` and ``acceleration``.
    quadrature_error : float
        Largest relative change of an RMS over the record if only every other wave stood for the
        road: above what more waves would change.
    n_waves : int
        Waves summed.
    point_names : tuple of str
        Names of the points.
    """

    time: Float[Array, " steps"]
    mean: dict[str, Array]
    std: dict[str, Array]
    contact_mean: Float[Array, "steps contacts"]
    contact_std: Float[Array, "steps contacts"]
    mid_band: Float[Array, " bands"]
    resolved: Bool[Array, " bands"]
    band_event: Float[Array, "points bands"]
    band_running: Float[Array, "points bands"]
    peaks: dict[str, Process]
    quadrature_error: float
    n_waves: int
    point_names: tuple[str, ...]

    def rms(self, quantity: str = "velocity") -> Float[Array, " points"]:
        """Return the root of the mean square over record and roads."""
        return np.sqrt(np.mean(self.mean[quantity] ** 2 + self.std[quantity] ** 2, axis=0))

    def peak(self, share: float, quantity: str = "acceleration") -> Float[Array, " points"]:
        """Return the largest absolute value that a share (0 to 100) of all roads stays below.

        An approximation, unlike the rest: see `peak_levels`.
        """
        process = self.peaks[quantity]
        return np.array(
            [peak_levels(process.at(i), [share])[0] for i in range(len(self.point_names))]
        )


@dataclass(kw_only=True, eq=False)
class _Sums:
    """Sums over waves so far, for the fine and the coarse set of waves."""

    fine: dict[str, Array] = field(default_factory=dict[str, Array])
    n_waves: int = 0

    def add(self, name: str, value: Array) -> None:
        self.fine[name] = self.fine.get(name, 0.0) + value


def exact_statistics(
    mean: MeanResponse, answers: Iterable[Harmonics], *, f_max: float = np.inf
) -> ExactStatistics:
    """Sum answers to all waves.

    Parameters
    ----------
    mean : MeanResponse
        Response to the static loads alone.
    answers : iterable of Harmonics
        Answers to the waves, some at a time.
    f_max : float
        Highest frequency that the computation contains [Hz].

    Returns
    -------
    ExactStatistics
        Exact but for the quadrature over waves, whose error it states.

    References
    ----------
    J. H. Lin, W. S. Zhang, F. W. Williams, Pseudo-excitation algorithm for nonstationary
    random seismic responses, Engineering Structures 16 (1994) 270-276.
    """
    fs = 1.0 / float(mean.time[1] - mean.time[0])
    mid_band = mid_band_frequencies()
    resolved = usable_bands(mid_band, fs) & (band_edges(mid_band)[:, 1] <= f_max)
    filters = [band_filter(f, fs) for f in mid_band[resolved]]
    sums = _Sums()
    for answer in answers:
        _add(sums, answer, filters)
    still = np.moveaxis(mean.velocity, 0, -1)
    event, running = _bands(sums.fine.get("bands", np.zeros(0)), still, filters, fs)
    n_points = len(mean.point_names)
    levels = np.full((2, n_points, len(mid_band)), np.nan)
    levels[:, :, resolved] = event, running
    names = ("displacement", "velocity", "acceleration")
    return ExactStatistics(
        time=mean.time,
        mean={name: getattr(mean, name) for name in names},
        std={name: np.sqrt(sums.fine[name]) for name in names},
        contact_mean=mean.contact_forces,
        contact_std=np.sqrt(sums.fine["contact_forces"]),
        mid_band=mid_band,
        resolved=resolved,
        band_event=levels[0],
        band_running=levels[1],
        peaks={name: _process(sums, mean, name) for name in names[1:]},
        quadrature_error=_quadrature_error(sums),
        n_waves=sums.n_waves,
        point_names=mean.point_names,
    )


def _add(sums: _Sums, answer: Harmonics, filters: list[Array]) -> None:
    power = answer.power[:, None, None]
    coarse = answer.coarse_power[:, None, None]
    for name in ("displacement", "velocity", "acceleration", "contact_forces"):
        square = np.abs(getattr(answer, name)) ** 2
        sums.add(name, np.sum(power * square, axis=0))
        sums.add(f"coarse {name}", np.sum(coarse * square, axis=0))
    for name in ("velocity", "acceleration"):
        value = getattr(answer, name)
        rate = _derivative(value, answer.phase, answer.time)
        both = np.conj(value) * rate
        sums.add(f"rate {name}", np.sum(power * np.abs(rate) ** 2, axis=0))
        sums.add(f"cross {name}", np.sum(power * both.real, axis=0))
        sums.add(f"turn {name}", np.sum(power * both.imag, axis=0))
    velocity = np.moveaxis(answer.velocity, 1, -1)
    energy = [
        np.sum(power * np.abs(signal.sosfilt(sos, velocity, axis=-1)) ** 2, axis=0)
        for sos in filters
    ]
    sums.add("bands", np.array(energy).reshape(len(filters), *velocity.shape[1:]))
    sums.n_waves += len(answer.power)


def _derivative(value: Array, phase: Array, time: Array) -> Array:
    """Differentiate in time: the wave's own turning exactly, the slow rest by differences."""
    turn = np.exp(-1j * phase)[:, :, None]
    slow = value * turn
    speed = np.gradient(phase, time, axis=1)[:, :, None]
    return (np.gradient(slow, time, axis=1) + 1j * speed * slow) / turn


def _bands(energy: Array, still: Array, filters: list[Array], fs: float) -> tuple[Array, Array]:
    """Return event and running levels of each point and band."""
    width = round(_WINDOW * fs)
    event, running = [], []
    for sos, variance in zip(filters, energy, strict=True):
        square = variance + signal.sosfilt(sos, still, axis=-1) ** 2
        event.append(np.sqrt(square.mean(axis=-1)))
        total = np.cumsum(square, axis=-1)
        total[..., width:] = total[..., width:] - total[..., :-width]
        running.append(np.sqrt(total.max(axis=-1) / width))
    shape = (len(filters), still.shape[0])
    return np.reshape(event, shape).T, np.reshape(running, shape).T


def _process(sums: _Sums, mean: MeanResponse, name: str) -> Process:
    return Process(
        time=mean.time,
        mean=getattr(mean, name),
        variance=sums.fine[name],
        rate_variance=sums.fine[f"rate {name}"],
        covariance=sums.fine[f"cross {name}"],
        turning=sums.fine[f"turn {name}"],
    )


def _quadrature_error(sums: _Sums) -> float:
    """Compare the RMS over the record that the two sets of waves give, in every quantity."""
    worst = 0.0
    for name in ("displacement", "velocity", "acceleration", "contact_forces"):
        fine, coarse = (sums.fine[key].mean(axis=0) for key in (name, f"coarse {name}"))
        held = fine > 0.0
        if held.any():
            worst = max(worst, float(np.max(np.abs(np.sqrt(coarse[held] / fine[held]) - 1.0))))
    return worst
