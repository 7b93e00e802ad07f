"""Say what a reader of transfer functions must know of modes, damping, mirror planes and lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trundle._typing import Array
from trundle.dynamics import ModalRecursion
from trundle.errors import FitnessWarning
from trundle.simulate.ground import PreparedFloor
from trundle.simulate.modal.method import MODES_BEYOND
from trundle.structure import Structure

__all__ = ["FAR_ENOUGH", "transfer_doubts"]

FAR_ENOUGH = 3.0
"""Times the highest line must modes reach, for 1.5 % of the largest answer there."""

_DOUBTED = 2.0  # times: reaching less far, the uppermost lines are in doubt
_SHOWN = 0.95  # of a peak that lies between two lines


def transfer_doubts(
    lines: Array, prepared: PreparedFloor, steps: ModalRecursion
) -> tuple[FitnessWarning, ...]:
    """Return the doubts about transfer functions of a floor at some lines.

    Parameters
    ----------
    lines : ndarray of float, shape (n_lines,)
        Frequencies, rising [Hz].
    prepared : PreparedFloor
        The floor in its modes.
    steps : ModalRecursion
        Frequencies and damping of these.
    """
    of_steps = prepared.integration.doubts()  # of bands and wheels; here nothing is stepped
    return (
        *(one for one in prepared.doubts() if one not in of_steps),
        *prepared.damping.doubts(),
        *_reach_doubts(lines, prepared),
        *_mirror_doubts(prepared.floor),
        *_line_doubts(lines, steps),
    )


def _reach_doubts(lines: Array, prepared: PreparedFloor) -> Iterator[FitnessWarning]:
    """Say where modes left out are too close to the uppermost lines to answer statically.

    Small floors of some 15 and 45 modes and the reference unit (9,071 dofs, 391 modes), against all
    their dofs solved at every line, were off by up to 0.7, 1.2, 5, 27 and 40 % of the largest
    answer at the line where modes reach 4, 3, 2, 1.5 and 1.25 times as far. Combinations that
    answer in place of modes hold what modes above f_max do as well.
    """
    if prepared.modes is not None and prepared.modes.answering:
        return
    f_max, top = prepared.integration.f_max, float(lines[-1])
    if f_max is not None and top * _DOUBTED > f_max:
        yield FitnessWarning(
            subject="modal truncation",
            message=f"lines above {f_max / _DOUBTED:.3g} Hz lie close to modes left out: "
            "floors were up to 5 % off (of the largest answer at that line) at half of f_max, and "
            f"40 % at {1.0 / MODES_BEYOND:.1f} of it; f_max = {FAR_ENOUGH * top:.3g} Hz brings all "
            "lines to some 1 %",
        )


def _mirror_doubts(structure: Structure) -> Iterator[FitnessWarning]:
    """Say that loads have images."""
    if structure.mirrors:
        planes = " and ".join(str(mirror) for mirror in structure.mirrors)
        yield FitnessWarning(
            subject="mirror planes",
            message=f"the model ends at mirror planes ({planes}): each force acts together with "
            "its images behind them; what one force does by itself needs a model of the whole",
        )


def _line_doubts(lines: Array, steps: ModalRecursion) -> Iterator[FitnessWarning]:
    """Say where lines are too far apart to show how high a mode's peak is."""
    f = np.sqrt(steps.square) / (2.0 * np.pi)
    half_width = steps.double / (4.0 * np.pi)  # zeta f
    inside = (f >= lines[0]) & (f <= lines[-1])
    if len(lines) < 2 or not inside.any():
        return
    f, half_width = f[inside], half_width[inside]
    after = np.clip(np.searchsorted(lines, f), 1, len(lines) - 1)
    apart = lines[after] - lines[after - 1]
    shown = half_width / np.hypot(half_width, 0.5 * apart)  # of a peak in the middle of two lines
    worst = int(shown.argmin())
    if shown[worst] < _SHOWN:
        yield FitnessWarning(
            subject="frequency lines",
            message=f"lines are {apart[worst]:.3g} Hz apart at {f[worst]:.3g} Hz, where the peak of"
            f" a mode is {2.0 * half_width[worst]:.2g} Hz wide: its height may be shown at "
            f"{100 * shown[worst]:.0f} %; ask for more lines, or for a shorter range",
        )
