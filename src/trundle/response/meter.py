"""Watch running levels beside limits, at every step of a record of any length.

A meter takes motion part by part, as a sound level meter does: its filters and its windows of 1 s
remember what came before, so that a day can be read in parts without a seam.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float, Int
from scipy import ndimage, signal

from trundle._checks import positive
from trundle._threads import n_threads
from trundle._typing import Array
from trundle.signals import (
    BASE_ACCELERATION,
    band_filter,
)

__all__ = ["CurveLimit", "Meter", "Motion", "Reading"]

_WINDOW = 1.0  # s
_KINDS = {
    "band_rms_velocity": "velocity",
    "band_rms_acceleration": "acceleration",
    "band_rms_displacement": "displacement",
    "band_peak_acceleration": "acceleration",
    "peak_acceleration": "acceleration",
    "response_factor": "felt",
}

Motion: TypeAlias = Mapping[str, Array]
"""Motion of some signals: displacement, velocity, acceleration, and what is felt of it (weighted as
people feel it), each an array of shape (..., n_steps)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveLimit:
    """Hold a limit as a meter reads it.

    Attributes
    ----------
    name : str
        Name of the criterion.
    quantity : str
        What it limits, see `trundle.criteria.Criterion`.
    limits : ndarray of float, shape (n_bands,)
        Limit in each band, NaN where it has none or where nothing is known; of a single number
        the same in one element [SI].
    """

    name: str
    quantity: str
    limits: Float[Array, " bands"]

    @property
    def is_read(self) -> bool:
        """Whether there is a running level of its quantity: doses and narrow lines have none."""
        return self.quantity in _KINDS and bool(np.isfinite(self.limits).any())


@dataclass(frozen=True, kw_only=True, eq=False)
class Reading:
    """Hold how running levels lie to limits.

    Attributes
    ----------
    square : ndarray of float32, shape (n_curves, ..., n_steps)
        Largest square of level over limit in any band: above 1 the limit is exceeded.
    band : ndarray of int, shape (n_curves, ..., n_steps)
        Which band it is in.
    """

    square: Float[Array, "curves ... steps"]
    band: Int[Array, "curves ... steps"]


class Meter:
    """Running levels of some signals beside limits.

    Levels are linear averages over the second that ends at each step, of peaks the largest within
    it; by the causal filters of `signals.band_levels`, whose delay, up to 1 s in the lowest bands,
    shifts its band's time among the others'.
    """

    def __init__(
        self,
        curves: Sequence[CurveLimit],
        mid_band: Float[Array, " bands"],
        sampling_frequency: float,
    ) -> None:
        self._fs = positive("sampling_frequency", sampling_frequency)
        self._width = max(1, round(_WINDOW * self._fs))
        self._n = len(curves)
        self._watches = list(_watches(curves, mid_band, self._fs, self._width))

    def rest(self) -> None:
        """Forget what came before: nothing has moved for long."""
        for watch in self._watches:
            watch.rest()

    def take(self, motion: Motion) -> Reading:
        """Read the next part.

        Parameters
        ----------
        motion : mapping
            Motion of the signals, the same signals every time.

        Returns
        -------
        Reading
            At every step of the part.
        """
        shape = next(iter(motion.values())).shape
        square = np.zeros((self._n, *shape), dtype=np.float32)
        band = np.zeros((self._n, *shape), dtype=np.int16)
        with ThreadPoolExecutor(n_threads()) as pool:
            found = pool.map(lambda watch: watch.squares(motion), self._watches)
            for watch, level in zip(self._watches, found, strict=True):
                for curve, limit in watch.limits:
                    ratio = (level / limit**2).astype(np.float32)
                    louder = ratio > square[curve]
                    np.copyto(square[curve], ratio, where=louder)
                    np.copyto(band[curve], watch.band, where=louder)
        return Reading(square=square, band=band)


class _Watch:
    """One filter with the limits that are held against what it passes."""

    def __init__(
        self, which: tuple[str, int], sos: Array | None, limits: list[tuple[int, float]], width: int
    ) -> None:
        quantity, self.band = which
        self.limits, self._sos, self._width = limits, sos, width
        self._of = _KINDS[quantity]
        peaks = quantity in {"band_peak_acceleration", "peak_acceleration"}
        self._reduce = _largest_squares if peaks else _mean_squares
        self._state: Array | None = None
        self._before: Array | None = None

    def rest(self) -> None:
        """Forget."""
        self._state = self._before = None

    def squares(self, motion: Motion) -> Array:
        """Return the square of the running level at every step."""
        samples = motion[self._of]
        lead = samples.shape[:-1]
        if self._before is None:
            self._before = np.zeros((*lead, self._width))
            if self._sos is not None:
                self._state = np.zeros((len(self._sos), *lead, 2))
        passed = samples
        if self._sos is not None:
            passed, self._state = signal.sosfilt(self._sos, samples, axis=-1, zi=self._state)
        longer = np.concatenate([self._before, np.asarray(passed)], axis=-1)
        self._before = longer[..., -self._width :].copy()
        return self._reduce(longer, self._width)


def _mean_squares(longer: Array, width: int) -> Array:
    """Return the mean square over so many samples that end at each, those before left out."""
    energy = np.cumsum(longer**2, axis=-1)
    return np.maximum(energy[..., width:] - energy[..., :-width], 0.0) / width


def _largest_squares(longer: Array, width: int) -> Array:
    """Return the square of the largest value among so many samples that end at each."""
    found = ndimage.maximum_filter1d(np.abs(longer), width, axis=-1, origin=(width - 1) // 2)
    return found[..., width:] ** 2


def _watches(curves: Sequence[CurveLimit], mid_band: Array, fs: float, width: int) -> list[_Watch]:
    """Return one watch for each filter that any curve asks for."""
    wanted: dict[tuple[str, int], list[tuple[int, float]]] = {}
    for number, curve in enumerate(curves):
        if curve.is_read:
            for band in np.flatnonzero(np.isfinite(curve.limits)):
                limit = float(curve.limits[band])
                if curve.quantity == "response_factor":
                    limit *= BASE_ACCELERATION
                wanted.setdefault((curve.quantity, int(band)), []).append((number, limit))
    found = []
    for (quantity, band), limits in wanted.items():
        sos = band_filter(float(mid_band[band]), fs) if quantity.startswith("band_") else None
        found.append(_Watch((quantity, band), sos, limits, width))
    return found
