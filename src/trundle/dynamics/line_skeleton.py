"""Say of which few frequencies the answers at many are combinations.

A mode with damping ratio zeta answers smoothly over a width of 2 zeta f. Many lines of a fine
spectrum lie within it, and what all modes do there is spanned, to round-off, by what they do at a
few of the lines: an interpolative decomposition finds these and the weights,

    h(line) = sum over picked lines of  weight(line, picked) h(picked),

by a QR factorisation that takes the line next which those before tell least of. Whatever is linear
in the modes, such as the response between any two places, follows by the same weights.

References
----------
H. Cheng, Z. Gimbutas, P. G. Martinsson and V. Rokhlin, SIAM J. Sci. Comput. 26 (2005) 1389-1404.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Complex, Float, Int
from scipy import linalg

from trundle._typing import Array

__all__ = ["few_lines"]

_EXACT = 1e-13  # of the largest answer of every mode: what is left out is round-off
_WORTHWHILE = 0.7  # of the lines: where more are needed, all are


def few_lines(
    answers: Complex[Array, "quantities lines modes"],
) -> tuple[Int[Array, " picked"], Float[Array, "lines picked"]] | None:
    """Return lines that tell of all others, and by which weights; None where nearly all are needed.

    Parameters
    ----------
    answers : ndarray of complex, shape (n_quantities, n_lines, n_modes)
        What every mode answers at every line: of some quantities, velocity and acceleration say.
        Every mode counts alike, however little it moves in this band.
    """
    n_lines = answers.shape[1]
    if not np.any(answers):
        return None
    largest = np.abs(answers).max(axis=1, keepdims=True)
    alike = answers / np.where(largest > 0.0, largest, 1.0)
    rows = np.concatenate([np.real(alike), np.imag(alike)], axis=2)  # real weights serve both
    rows = rows.transpose(0, 2, 1).reshape(-1, n_lines)
    (short,) = linalg.qr(rows, mode="r")  # as much in far fewer rows, which pivoting is slow on
    triangle, order = linalg.qr(short[:n_lines], mode="r", pivoting=True)
    sizes = np.abs(np.diag(triangle))
    n_picked = int(np.count_nonzero(sizes > _EXACT * sizes[0]))
    if n_picked > _WORTHWHILE * n_lines:
        return None
    weights = np.zeros((n_lines, n_picked))
    weights[order[:n_picked], np.arange(n_picked)] = 1.0
    weights[order[n_picked:]] = linalg.solve_triangular(
        triangle[:n_picked, :n_picked], triangle[:n_picked, n_picked:]
    ).T
    return order[:n_picked], weights
