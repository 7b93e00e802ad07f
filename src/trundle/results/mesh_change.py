"""Hold what a mesh twice as coarse changes, and say whether results have settled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning
from trundle.results.level_change import level_shares, worst_words

__all__ = ["MeshChange", "mesh_warnings", "mesh_words"]

_LEFT = 1.0  # of a change from 2 h to h: the error at h, if it goes with h, as at columns' heads
_SETTLED_LEVEL = 0.10
_SETTLED_FREQUENCY = 0.03


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshChange:
    """Hold levels and frequencies on a study's mesh, and on one twice as coarse.

    Attributes
    ----------
    sizes : tuple of float
        Largest element edge of the coarse mesh and of the study's own [m].
    frequencies : ndarray of float, shape (2, n_modes)
        First natural frequencies on both [Hz].
    cases, points : tuple of str
        What drove, and where.
    bands : ndarray of float, shape (n_bands,)
        Mid-band frequencies [Hz].
    levels : ndarray of float, shape (2, n_cases, n_points, n_bands)
        Root mean square over the same few runs of band levels on both [m/s]; NaN in bands that
        are not excited, or not resolved.
    """

    sizes: tuple[float, float]
    frequencies: Float[Array, "2 modes"]
    cases: tuple[str, ...]
    points: tuple[str, ...]
    bands: Float[Array, " bands"]
    levels: Float[Array, "2 cases points bands"]

    @property
    def frequency_change(self) -> float:
        """Largest change of the first frequencies, as a share."""
        coarse, fine = self.frequencies
        return float(np.abs(coarse / fine - 1.0).max(initial=0.0))

    def level_changes(self) -> Float[Array, "cases points bands"]:
        """Return by what share each level differs; of bands near the loudest of their point.

        NaN stands where nothing moves, and where no level is known.
        """
        return level_shares(self.levels)


def mesh_words(change: MeshChange) -> str:
    """Say what the coarser mesh changes, and what is left."""
    coarse, fine = change.sizes
    levels = change.level_changes()
    n = change.frequencies.shape[1]
    worst = worst_words(levels, change.cases, change.points, change.bands)
    text = f"from elements of {coarse:g} m to {fine:g} m "
    if n:
        most = 100.0 * change.frequency_change
        text += f"the first {n} frequencies change by up to {most:.2g} %, and "
    else:  # none was looked for
        worst = worst.replace(" by", " change by", 1)
    nothing = "no band level is known on both, so that none was compared"
    return f"{text}{worst or nothing}; as much again may be left"


def mesh_warnings(change: MeshChange | None) -> tuple[FitnessWarning, ...]:
    """Return the doubt about results that have not settled on the mesh of a study of a building.

    Errors of smooth floors go with the size squared, and a third of a change would be left; round
    the heads of columns in a flat slab they go with the size itself, and all of it is.
    """
    if change is None:
        return (
            FitnessWarning(
                subject="mesh",
                message="whether levels have settled was not looked at, as the study could not be "
                "run on a mesh twice as coarse; run it with half the mesh_size before a small "
                "margin is relied on",
            ),
        )
    levels = change.level_changes()
    if not np.isfinite(levels).any():
        return (
            FitnessWarning(
                subject="mesh",
                message=f"whether levels have settled is not known: {mesh_words(change)}; run the "
                "study with half the mesh_size before a small margin is relied on",
            ),
        )
    worst = float(np.nanmax(levels))
    settled = _LEFT * worst <= _SETTLED_LEVEL
    if settled and _LEFT * change.frequency_change <= _SETTLED_FREQUENCY:
        return ()
    return (
        FitnessWarning(
            subject="mesh",
            message=f"levels have not settled: {mesh_words(change)}; halve mesh_size, or refine "
            "near routes and points, before a margin below "
            f"{1.0 + max(_LEFT * worst, 0.1):.2g} is relied on",
        ),
    )
