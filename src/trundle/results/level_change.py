"""Hold levels by two models of one structure, and say by how much they differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.signals import nominal_frequency

__all__ = ["LevelChange", "level_shares", "worst_words"]


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelChange:
    """Hold levels and frequencies by a coarser model, and by a study's own.

    Attributes
    ----------
    frequencies : ndarray of float, shape (2, n_modes)
        First natural frequencies by both [Hz].
    cases, points : tuple of str
        What drove, and where.
    bands : ndarray of float, shape (n_bands,)
        Mid-band frequencies [Hz].
    levels : ndarray of float, shape (2, n_cases, n_points, n_bands)
        Root mean square over the same few runs of band levels by both [m/s]; NaN in bands that
        are not excited, or not resolved.
    """

    frequencies: Float[Array, "2 modes"]
    cases: tuple[str, ...]
    points: tuple[str, ...]
    bands: Float[Array, " bands"]
    levels: Float[Array, "2 cases points bands"]

    @property
    def largest(self) -> float:
        """Largest change of a level that matters, as a share; NaN where none is known."""
        shares = level_shares(self.levels)
        return float(np.nanmax(shares)) if np.isfinite(shares).any() else float("nan")


def level_shares(
    levels: Float[Array, "2 cases points bands"],
) -> Float[Array, "cases points bands"]:
    """Return by what share each level differs; of bands near the loudest of their point.

    NaN stands where nothing moves, and where no level is known.
    """
    coarse, fine = levels
    loudest = np.fmax.reduce(fine, axis=2, keepdims=True)
    matters = fine > 0.1 * loudest  # what is a tenth of the loudest decides nothing
    share = np.full(fine.shape, np.nan)
    np.divide(coarse, fine, out=share, where=matters)
    return np.abs(share - 1.0)


def worst_words(
    shares: Float[Array, "cases points bands"],
    cases: tuple[str, ...],
    points: tuple[str, ...],
    bands: Float[Array, " bands"],
) -> str:
    """Say which of some shares is largest; nothing where none is known."""
    if not np.isfinite(shares).any():
        return ""
    case, point, band = np.unravel_index(np.nanargmax(shares), shares.shape)
    f = nominal_frequency(float(bands[band]))
    return (
        f"band levels by up to {100.0 * np.nanmax(shares):.2g} % "
        f"({cases[case]}, {points[point]}, {f:g} Hz)"
    )
