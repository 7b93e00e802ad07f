"""Let no damaged file end in anything else than a refusal.

Readers check what they read; what nobody thought of (a number that overflows, a row cut short) is
caught here, once, and told as what it is: a file that cannot be right.
"""

from __future__ import annotations

import warnings
from collections.abc import Generator
from contextlib import contextmanager

import numpy as np

from trundle._typing import SparseMatrix
from trundle.errors import InputError
from trundle.structure import Floor

__all__ = ["check_sound", "guarded"]

_FAR = 1e5  # m: no building reaches further
_DAMAGE = (
    ArithmeticError,
    LookupError,
    ValueError,
    TypeError,
    RecursionError,
    MemoryError,
    OSError,
)


@contextmanager
def guarded(name: str) -> Generator[None]:
    """Turn whatever damage leads to into an `InputError` with the file's name."""
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore", RuntimeWarning)
            yield
    except InputError:
        raise
    except _DAMAGE as error:
        raise InputError(
            f"{name}: is damaged, or a number in it is out of all bounds ({type(error).__name__})"
        ) from None


def check_sound(floor: Floor) -> None:
    """Refuse a model whose places or matrices cannot be right.

    Parameters
    ----------
    floor : Floor
        In SI.

    Raises
    ------
    InputError
        Places that are not finite or far away, matrices that are not finite or not positive, plates
        that are there twice.
    """
    if not np.all(np.abs(floor.nodes) < _FAR):
        raise InputError(f"a node lies further than {_FAR / 1e3:g} km away, or nowhere")
    mass, stiffness = floor.matrices()
    for what, matrix in (("mass", mass), ("stiffness", stiffness)):
        _check_matrix(what, matrix)
    for corners in (3, 4):
        plates = [g.connectivity for g in floor.elements if g.connectivity.shape[1] == corners]
        every = np.sort(np.concatenate(plates), axis=1) if plates else np.zeros((0, 1))
        twice = len(every) - len(np.unique(every, axis=0))
        if twice:
            raise InputError(f"{twice} plates stand twice on the same nodes")


def _check_matrix(what: str, matrix: SparseMatrix) -> None:
    if not np.isfinite(matrix.data).all():
        raise InputError(f"its {what} is not finite: a number in it is out of all bounds")
    if matrix.diagonal().min() < 0.0:
        raise InputError(f"its {what} is below 0 in some dof")
