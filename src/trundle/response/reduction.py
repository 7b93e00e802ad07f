"""Reduce batches of runs to what is kept of each, so that histories can go."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy import stats

from trundle._checks import within
from trundle._kinds import kinds_checked
from trundle._typing import Array, ArrayLike
from trundle.response.meter import CurveLimit, Meter
from trundle.response.quantities import QUANTITIES, Histories
from trundle.response.spectra import BandSpectra, SpectrumQuantity, spectra_of
from trundle.signals import (
    BASE_ACCELERATION,
    BASE_SIDEWAYS,
    Averaging,
    mid_band_frequencies,
    weight,
)
from trundle.simulate import MeanResponse, Runs

__all__ = [
    "RunLevels",
    "felt_of",
    "histories_of",
    "join",
    "percentile_interval",
    "reduce_on_scaled_roads",
    "reduce_runs",
]

_TOGETHER = 16  # runs whose filtered histories are held at once: they stay in cache


@dataclass(frozen=True, kw_only=True, eq=False)
class RunLevels:
    """Hold what is kept of every run.

    Attributes
    ----------
    numbers : mapping of str to ndarray, shape (n_runs, n_points) or (n_runs, n_contacts)
        Single numbers, one array for each of `QUANTITIES`.
    spectra : BandSpectra
        One-third-octave velocity levels [m/s].
    more : mapping of str to BandSpectra
        Other spectra that were asked for, by their quantity.
    above : mapping of str to ndarray, shape (n_runs, n_points)
        For how long the running level of 1 s lay above each curve that was watched [s], by its
        name; NaN of a curve without a running level.
    """

    numbers: Mapping[str, Array]
    spectra: BandSpectra
    more: Mapping[SpectrumQuantity, BandSpectra]
    above: Mapping[str, Array] = field(default_factory=dict[str, Array])

    @property
    def peak_acceleration(self) -> Float[Array, "runs points"]:
        """Largest absolute acceleration [m/s2]."""
        return self.numbers["peak_acceleration"]

    @property
    def peak_time(self) -> Float[Array, "runs points"]:
        """When it was [s]."""
        return self.numbers["peak_time"]

    @property
    def rms_velocity(self) -> Float[Array, "runs points"]:
        """RMS velocity over the record [m/s]."""
        return self.numbers["rms_velocity"]

    @property
    def response_factor(self) -> Float[Array, "runs points"]:
        """Largest 1 s RMS of weighted acceleration over 0.005 m/s2; 0.00357 m/s2 sideways."""
        return self.numbers["response_factor"]

    @property
    def vdv(self) -> Float[Array, "runs points"]:
        """Vibration dose value of one event, weighted alike [m/s^1.75]."""
        return self.numbers["vdv"]

    @property
    def peak_contact_force(self) -> Float[Array, "runs contacts"]:
        """Largest contact force, static load included [N]."""
        return self.numbers["peak_contact_force"]

    @property
    def tension(self) -> Bool[Array, "runs contacts"]:
        """Whether a contact would have had to pull: it would have left the floor."""
        return self.numbers["tension"]


@kinds_checked
def reduce_runs(
    runs: Runs,
    *,
    averaging: Averaging = "max_1s",
    quantities: Iterable[SpectrumQuantity] = (),
    record: slice | None = None,
    horizontal: Sequence[int] | None = None,
    curves: Sequence[CurveLimit] = (),
) -> RunLevels:
    """Reduce the histories of some runs.

    Parameters
    ----------
    runs : Runs
        Runs with histories.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the band levels.
    quantities : iterable of SpectrumQuantity
        Spectra wanted beside that of velocity.
    record : slice, optional
        Steps that are looked at; those before and behind fill and empty the filters.
    horizontal : sequence of int, optional
        Points that move sideways: weighted by Wd, and held against its base; those that the runs
        name unless given.
    curves : sequence of CurveLimit
        What is watched: for how long levels lie above.
    """
    felt, base = felt_of(runs, horizontal)
    wanted: dict[SpectrumQuantity, None] = dict.fromkeys(quantities)
    wanted.pop("band_rms_velocity", None)
    histories = histories_of(runs, felt, base, record or slice(None))
    return RunLevels(
        numbers={quantity.name: quantity.measure(histories) for quantity in QUANTITIES},
        spectra=spectra_of(runs, "band_rms_velocity", averaging=averaging, record=record),
        more={name: spectra_of(runs, name, averaging=averaging, record=record) for name in wanted},
        above=_above(runs, histories.felt, curves) if curves else {},
    )


def felt_of(
    runs: Runs, horizontal: Sequence[int] | None = None
) -> tuple[Float[Array, "runs points steps"], Float[Array, " points"]]:
    """Return acceleration weighted as people feel it, and what has a response factor of 1 [m/s2].

    Parameters
    ----------
    runs : Runs
        Runs with histories.
    horizontal : sequence of int, optional
        Points that move sideways, see `reduce_runs`.
    """
    fs, moved = runs.sampling_frequency, np.moveaxis(runs.acceleration, 1, -1)
    sideways = list(runs.horizontal if horizontal is None else horizontal)
    felt = weight(moved, fs, "Wb")
    if sideways:
        felt[:, sideways] = weight(moved[:, sideways], fs, "Wd")
    base = np.full(len(runs.point_names), BASE_ACCELERATION)
    base[sideways] = BASE_SIDEWAYS
    return felt, base


def histories_of(
    runs: Runs,
    felt: Float[Array, "runs points steps"],
    base: Float[Array, " points"],
    seen: slice,
) -> Histories:
    """Return what single numbers are measured on: the steps of some runs that are looked at.

    Parameters
    ----------
    runs : Runs
        Runs with histories.
    felt : ndarray of float, shape (n_runs, n_points, n_steps)
        Weighted acceleration, see `felt_of` [m/s2].
    base : ndarray of float, shape (n_points,)
        What has a response factor of 1 [m/s2].
    seen : slice
        The steps.
    """
    return Histories(
        time=runs.time[seen],
        sampling_frequency=runs.sampling_frequency,
        acceleration=runs.acceleration[:, seen],
        velocity=runs.velocity[:, seen],
        felt=felt[..., seen],
        base=base,
        contact_forces=runs.contact_forces,
        lifts=runs.lifting,
    )


def _above(runs: Runs, felt: Array, curves: Sequence[CurveLimit]) -> dict[str, Array]:
    """Return for how long running levels lie above curves, those of the second behind counted."""
    fs = runs.sampling_frequency
    rest = ((0, 0), (0, 0), (0, round(fs)))
    motion = {
        name: np.pad(np.moveaxis(getattr(runs, name), 1, -1), rest)
        for name in ("displacement", "velocity", "acceleration")
    }
    motion["felt"] = np.pad(felt, rest)
    square = Meter(curves, mid_band_frequencies(), fs).take(motion).square
    seconds = (square > 1.0).sum(axis=-1) / fs
    return {
        curve.name: seconds[i] if curve.is_read else np.full(seconds.shape[1:], np.nan)
        for i, curve in enumerate(curves)
    }


def reduce_on_scaled_roads(
    runs: Runs,
    mean: MeanResponse,
    factors: Sequence[float],
    *,
    averaging: Averaging = "max_1s",
    quantities: Iterable[SpectrumQuantity] = (),
    horizontal: Sequence[int] | None = None,
    curves: Sequence[CurveLimit] = (),
) -> list[RunLevels]:
    """Reduce some runs as they are on roads of other roughness.

    Parameters
    ----------
    runs : Runs
        Runs with histories.
    mean : MeanResponse
        Response without roughness.
    factors : sequence of float
        How many times larger the elevations are on each road.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the band levels.
    quantities : iterable of SpectrumQuantity
        Spectra wanted beside that of velocity.
    horizontal : sequence of int, optional
        Points that move sideways, see `reduce_runs`.
    curves : sequence of CurveLimit
        What is watched: for how long levels lie above.

    Returns
    -------
    list of RunLevels
        One for each factor.
    """
    found: list[list[RunLevels]] = [[] for _ in factors]
    for start in range(0, runs.n_runs, _TOGETHER):
        some = runs.part(slice(start, start + _TOGETHER))
        for kept, factor in zip(found, factors, strict=True):
            rougher = some.on_scaled_road(mean, factor)
            levels = reduce_runs(
                rougher,
                averaging=averaging,
                quantities=quantities,
                horizontal=horizontal,
                curves=curves,
            )
            kept.append(levels)
    return [join(parts) for parts in found]


def join(parts: Sequence[RunLevels]) -> RunLevels:
    """Put the runs of several parts behind each other."""
    first = parts[0]
    return RunLevels(
        numbers={
            name: np.concatenate([part.numbers[name] for part in parts]) for name in first.numbers
        },
        spectra=_join_spectra([part.spectra for part in parts]),
        more={name: _join_spectra([part.more[name] for part in parts]) for name in first.more},
        above={name: np.concatenate([part.above[name] for part in parts]) for name in first.above},
    )


def _join_spectra(parts: Sequence[BandSpectra]) -> BandSpectra:
    return replace(
        parts[0],
        values=np.concatenate([part.values for part in parts]),
        times=np.concatenate([part.times for part in parts]),
    )


def percentile_interval(
    values: ArrayLike, share: float, *, confidence: float = 0.95
) -> tuple[float, float]:
    """Return an interval that holds the true percentile with some confidence.

    Parameters
    ----------
    values : array_like of float, shape (n_runs,)
        Independent values.
    share : float
        Percentile, 0 to 100.
    confidence : float
        Probability that the interval holds it.

    Returns
    -------
    tuple of float
        Two of the values in their order; infinite where there are too few of them.

    Notes
    -----
    Whatever the distribution, the number of values below the percentile is binomial.

    References
    ----------
    H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed. (2003), section 7.1.
    """
    ordered = np.sort(np.asarray(values, float).ravel())
    n, p = len(ordered), within("share", share, 0.0, 100.0) / 100.0
    low = int(stats.binom.ppf(0.5 * (1.0 - confidence), n, p))
    high = int(stats.binom.ppf(0.5 * (1.0 + confidence), n, p)) + 1
    bounds = np.concatenate([[-np.inf], ordered, [np.inf]])
    return float(bounds[max(low, 0)]), float(bounds[min(high, n + 1)])
