"""Find how large a response becomes on all roads of a class, by drawing roads from its answers.

A response to a Gaussian road is a sum of its answers to single waves, each times an independent
normal number. So histories can be drawn from answers at hand, without stepping anything again;
what they reach is distributed as what runs reach, clumps, bursts and the ends of passages included.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from threadpoolctl import threadpool_limits

from trundle._threads import n_threads
from trundle._typing import Array, ArrayLike
from trundle.simulate import Harmonics, MeanResponse

__all__ = ["DrawnHistories", "LargestValues"]

_QUANTITIES = ("velocity", "acceleration")
_MOST_DRAWS, _LEAST_DRAWS = 1000, 200
_BYTES = 4e8  # that drawn histories may hold, as batches of runs do
_STRIP = 4096  # columns of a product at once, whatever the number of threads
# The draws belong to the rule as the nodes of a quadrature do: the same answers, the same bits.
_SEED = 8608
# Between two of these factors of roughness the largest value is off by less than 1 %.
_FACTORS = 2.0 ** (0.5 * np.arange(-6, 11))


@dataclass(frozen=True, kw_only=True, eq=False)
class LargestValues:
    """Hold where drawn histories are largest, on roads of any roughness.

    Attributes
    ----------
    mean, random : ndarray of float, shape (n_candidates, n_draws, n_points)
        What the static loads and the road give, at the times when a history is largest on the
        road at hand or one that is 1/8 to 32 times as rough.
    """

    mean: Float[Array, "candidates draws points"]
    random: Float[Array, "candidates draws points"]

    def on_scaled_road(self, factor: float) -> LargestValues:
        """Return the values on a road whose elevation is so many times larger."""
        return LargestValues(mean=self.mean, random=factor * self.random)

    def levels(self, shares: ArrayLike) -> Float[Array, "shares points"]:
        """Return levels that the largest absolute value stays below in given shares of all roads.

        Parameters
        ----------
        shares : array_like of float
            Shares [%], 0 to 100.
        """
        largest = np.abs(self.mean + self.random).max(axis=0)
        return np.percentile(largest, np.ravel(np.asarray(shares, float)), axis=0)


@dataclass(kw_only=True, eq=False)
class DrawnHistories:
    """Sum drawn histories over waves.

    Attributes
    ----------
    mean : MeanResponse
        Response to the static loads alone.
    n_draws : int
        Roads: 1000, or the fewer, down to 200, that 400 MB hold.
    random : dict of str to ndarray of float32, shape (n_draws, n_steps * n_points)
        Sums so far.
    """

    mean: MeanResponse
    n_draws: int = field(init=False)
    random: dict[str, Array] = field(init=False)
    _rng: np.random.Generator = field(init=False)

    def __post_init__(self) -> None:
        size = self.mean.velocity.size
        held = _BYTES / (4.0 * len(_QUANTITIES) * size)
        self.n_draws = int(np.clip(held, _LEAST_DRAWS, _MOST_DRAWS))
        self.random = {
            name: np.zeros((self.n_draws, size), dtype=np.float32) for name in _QUANTITIES
        }
        self._rng = np.random.default_rng(_SEED)

    def add(self, answer: Harmonics) -> None:
        """Add some waves, each with a cosine and a sine of its own random amplitude."""
        n_waves = len(answer.power)
        amplitude = self._rng.standard_normal((self.n_draws, 2, n_waves))
        amplitude *= np.sqrt(answer.power)
        normal = amplitude.reshape(self.n_draws, -1).astype(np.float32)
        strips = range(0, self.mean.velocity.size, _STRIP)
        for name, total in self.random.items():
            values = getattr(answer, name).reshape(n_waves, -1)

            def strip(start: int, values: Array = values, total: Array = total) -> None:
                """Add to some columns."""
                part = values[:, start : start + _STRIP]
                both = np.concatenate([np.real(part), -np.imag(part)]).astype(np.float32)
                total[:, start : start + _STRIP] += normal @ both

            with threadpool_limits(limits=1, user_api="blas"):
                _each(strip, strips)

    def largest(self) -> dict[str, LargestValues]:
        """Return where velocity and acceleration are largest."""
        return {name: self._largest(name) for name in _QUANTITIES}

    def _largest(self, name: str) -> LargestValues:
        mean = np.asarray(getattr(self.mean, name), dtype=np.float32)
        random = self.random[name].reshape(self.n_draws, *mean.shape)
        shape = (len(_FACTORS), self.n_draws, mean.shape[1])
        found = LargestValues(mean=np.zeros(shape), random=np.zeros(shape))
        still = np.ascontiguousarray(mean.T)

        def draw(i: int) -> None:
            """Look through one history at every point."""
            points, own = np.arange(mean.shape[1]), np.ascontiguousarray(random[i].T)
            for k, factor in enumerate(_FACTORS):
                history = np.float32(factor) * own
                history += still
                at = np.abs(history, out=history).argmax(axis=1)
                found.mean[k, i], found.random[k, i] = mean[at, points], own[points, at]

        _each(draw, range(self.n_draws))
        return found


def _each(work: Callable[[int], None], items: range) -> None:
    with ThreadPoolExecutor(n_threads()) as pool:
        list(pool.map(work, items))
