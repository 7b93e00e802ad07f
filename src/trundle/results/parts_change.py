"""Hold what keeping less of each part changes, and say whether results have settled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle.errors import FitnessWarning
from trundle.results.level_change import LevelChange, level_shares, worst_words

__all__ = ["PartsChange", "parts_warnings", "parts_words"]

_SETTLED = 0.05  # error of a level that matters
_LEFT = 2.0  # times the change, that may be left


@dataclass(frozen=True, kw_only=True, eq=False)
class PartsChange:
    """Hold levels of a study by parts, and of the same with less of each part kept.

    Attributes
    ----------
    kept : tuple of float
        To which frequency own modes of parts are kept, coarser first [Hz].
    change : LevelChange
        What that changes.
    """

    kept: tuple[float, float]
    change: LevelChange


def parts_words(change: PartsChange) -> str:
    """Say what less of each part changes, and what is left."""
    coarse, own = change.kept
    levels = change.change
    worst = worst_words(level_shares(levels.levels), levels.cases, levels.points, levels.bands)
    found = worst or "no band level, as none is known by both"
    return (
        f"keeping own modes of parts to {own:.4g} instead of {coarse:.3g} Hz changes {found}; "
        "twice as much may be left"
    )


def parts_warnings(change: PartsChange | None) -> tuple[FitnessWarning, ...]:
    """Return the doubt about results that have not settled in what is kept of each part.

    What parts leave out falls with at least the square of the frequency to which they are kept:
    from a narrower band to one 1.4 times as wide levels change by half of what is left, or more
    (towers drawn at random, held against the same in one piece).
    """
    if change is None:
        text = "whether enough of each part is kept was not looked at; run once with a wider band"
    elif not np.isfinite(change.change.largest):
        text = f"whether enough of each part is kept is not known: {parts_words(change)}"
    elif _LEFT * change.change.largest <= _SETTLED:
        return ()
    else:
        text = f"levels have not settled: {parts_words(change)}; widen band in [parts]"
    return (FitnessWarning(subject="parts", message=text),)
