"""Say what paces, load function and modes do not show of footfall."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trundle.errors import FitnessWarning
from trundle.footfall import FootfallLoad
from trundle.simulate.spectral.footfall_floor import FootfallFloor

__all__ = ["footfall_doubts"]

_MOVES = 0.05  # of the largest product of squared shapes, above which a mode is spoken of


def footfall_doubts(
    floor: FootfallFloor, load: FootfallLoad, low: float, high: float
) -> Iterator[FitnessWarning]:
    """Give what a report must say of paces, impulses and modes.

    Parameters
    ----------
    floor : FootfallFloor
        Has the modes.
    load : FootfallLoad
        Load function.
    low, high : float
        Lowest and highest pace that were tried [steps/s].

    Yields
    ------
    FitnessWarning
        One a doubt.
    """
    if low < load.paces[0] - 1e-9 or high > load.paces[1] + 1e-9:
        yield FitnessWarning(
            subject="paces",
            message=f"{load.title}: it is for {load.paces[0]:g} to {load.paces[1]:g} steps/s; "
            f"from {low:g} to {high:g} its load factors are held at their ends",
        )
    yield from _missed(floor, load, low, high)
    first, last = floor.frequencies[0], floor.frequencies[-1]
    if load.impulse is None:
        yield FitnessWarning(
            subject="impulses",
            message=f"{load.title}: it gives no impulse of a step; floors whose first frequency "
            f"is above {load.highest(high):.3g} Hz are hardly excited by it",
        )
    elif last < 2.0 * max(first, load.highest(high)):
        yield FitnessWarning(
            subject="modes",
            message=f"modes to {last:.3g} Hz are kept; the guides ask for those to twice the "
            "first frequency or more in transients: raise f_max",
        )


def _missed(
    floor: FootfallFloor, load: FootfallLoad, low: float, high: float
) -> Iterator[FitnessWarning]:
    """Name the first mode that moves and lies between two harmonics of the paces."""
    f, numbers = floor.frequencies[:, None], np.arange(1, len(load.harmonics) + 1)
    hit = ((f >= low * numbers) & (f <= high * numbers)).any(axis=1)
    size = np.max(floor.felt**2, axis=0) * np.max(floor.walked**2, axis=0)
    between = (f[:, 0] > high) & (f[:, 0] < low * numbers[-1]) & ~hit
    found = np.flatnonzero(between & (size > _MOVES * size.max()))
    if found.size:
        first = float(f[found[0], 0])
        number = int(np.ceil(first / high))
        yield FitnessWarning(
            subject="paces",
            message=f"the mode at {first:.3g} Hz lies between harmonics of {low:g} to {high:g} "
            f"steps/s; harmonic {number} of {first / number:.3g} steps/s would meet it",
        )
