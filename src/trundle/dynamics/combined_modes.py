"""Find the few combinations of modes by which forces at some places are felt at others.

A large building has thousands of modes, many within the width of one resonance. Between a route and
a point they cannot be told apart: in steady motion at omega they answer together, as

    H(omega) = C diag(h) B,      h_i = 1 / (omega_i^2 - omega^2 + 2 i zeta_i omega_i omega),

with B the modes on the route and C those at the points. What the motions ``diag(h) B`` and
``diag(h) C^T`` of all frequencies have in common is found from the sum of their squares,

    G = sum over omega of  Re(h h*) o (w_B B B^T + w_C C^T C)      (o: entry by entry),

weighted so that every frequency counts alike. The eigenvectors V of its largest eigenvalues span
them best (proper orthogonal decomposition); motions from both ends make the error of H of second
order (Galerkin). ``V^T diag(omega_i^2) V`` is diagonalised again, so that whatever steps modes
steps these. The modes are known, so the true H is, and with it the error.

References
----------
K. Willcox and J. Peraire, AIAA J. 40 (2002) 2323-2330.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._typing import Array
from trundle.dynamics.same_bits import repeatable

__all__ = ["ResponseBasis", "response_basis"]

_FINE = 0.7  # spacing of frequencies, against the damping ratio: half a resonance's half width
_LEAST_RATIO = 0.002  # of the ratio, for the spacing
_BESIDE = 40  # further columns of a random start
_AHEAD = 5  # times the vectors first asked for are found: sizes grow until they do
_SWEEPS = 2  # of subspace iteration
_PROBES = 12  # combinations of the route's dofs by which its own motion is tried
_BAND = 2.0 ** (1.0 / 3.0)  # width of the bands in which errors are told
_GROWTH = 1.6  # of the basis, while it does not do
_CLOSE = 0.1  # of its size, within which it is the least that does
_WORTHWHILE = 0.7  # of all modes: a basis that is larger saves nothing


@dataclass(frozen=True, kw_only=True, eq=False)
class ResponseBasis:
    """Hold combinations of modes, themselves the modes of a smaller system.

    Attributes
    ----------
    combined : ndarray of float, shape (n_modes, n_basis)
        Orthonormal columns: how much of each mode.
    omega : ndarray of float, shape (n_basis,)
        Circular frequencies, rising [rad/s].
    ratios : ndarray of float, shape (n_basis,)
        Damping ratios.
    error : float
        Largest error of any band between route and any point, and of the route's own motion,
        against the RMS of the response there.
    """

    combined: Float[Array, "modes basis"]
    omega: Float[Array, " basis"]
    ratios: Float[Array, " basis"]
    error: float


def response_basis(
    omega: Float[Array, " modes"],
    ratios: Float[Array, " modes"],
    route: Float[Array, "dofs modes"],
    points: Float[Array, "points modes"],
    *,
    f_max: float,
    tolerance: float,
) -> ResponseBasis | None:
    """Return a basis for what a route does to points; None where all modes serve as well.

    Parameters
    ----------
    omega, ratios : ndarray of float, shape (n_modes,)
        Circular frequencies, rising [rad/s], and damping ratios of all modes.
    route, points : ndarray of float, shapes (n_dofs, n_modes), (n_points, n_modes)
        Modes at the dofs that wheels load, and where the response is read.
    f_max : float
        Highest frequency at which the response matters [Hz].
    tolerance : float
        Error that is allowed, see `ResponseBasis`.
    """
    with repeatable():
        return _searched(omega, ratios, route, points, (_lines(omega, ratios, f_max), tolerance))


def _searched(
    omega: Array, ratios: Array, route: Array, points: Array, wanted: tuple[Array, float]
) -> ResponseBasis | None:
    """Return the smallest basis that does, by halving; `wanted` is where, and within what error."""
    lines, tolerance = wanted
    h = _receptance(omega, ratios, lines)
    route, points = _of_rank(route), points[np.any(points != 0.0, axis=1)]
    leading = _Leading(_gram(h, route) + _gram(h, points))
    middles = np.sqrt(lines[1:] * lines[:-1])
    trial = _Trial.of(omega, ratios, route, points, middles)
    too_small, enough = 0, int(_WORTHWHILE * len(omega))
    size, best = 2 * min(len(points) + len(route), 40), None
    while too_small < size <= enough:
        found = _diagonal(leading.first(size), omega, ratios)
        error = trial.error_of(found)
        if error <= tolerance:
            best, enough = replace(found, error=error), size
        else:
            too_small = size
        if best is None:
            size = int(_GROWTH * size) + 1
        elif enough - too_small > _CLOSE * enough:
            size = (enough + too_small) // 2
        else:
            break
    return best


def _lines(omega: Array, ratios: Array, f_max: float) -> Array:
    """Return circular frequencies, so close that no resonance lies between two [rad/s]."""
    step = _FINE * max(float(np.min(ratios)), _LEAST_RATIO)
    low, high = 0.5 * omega[0], 2.0 * np.pi * f_max
    return np.geomspace(low, high, max(2, int(np.ceil(np.log(high / low) / step))))


def _receptance(omega: Array, ratios: Array, lines: Array) -> Array:
    """Return how each mode answers at each line, (n_modes, n_lines) [s2]."""
    omega, ratios = omega[:, None], ratios[:, None]
    return 1.0 / (omega**2 - lines**2 + 2j * ratios * omega * lines)


def _of_rank(rows: Array) -> Array:
    """Return fewer rows with the same ``rows^T rows``, what is round-off left out."""
    _, sizes, right = np.linalg.svd(rows, full_matrices=False)
    kept = sizes > 1e-10 * sizes[0]
    return sizes[kept, None] * right[kept]


def _gram(h: Array, rows: Array) -> Array:
    """Return the sum of squares of motions by forces on rows, every line counted alike."""
    power = np.einsum("ij,ij->j", rows, rows)  # of each mode
    weighted = h / np.sqrt(power @ np.abs(h) ** 2)
    both = np.concatenate([weighted.real, weighted.imag], axis=1)
    out = both @ both.T
    out *= rows.T @ rows
    return out


class _Leading:
    """Orthonormal vectors of the largest eigenvalues; what larger sizes found serves smaller ones.

    `gram` (n, n) is symmetric.
    """

    def __init__(self, gram: Float[Array, "modes modes"]) -> None:
        self._gram = gram
        self._known = np.zeros((len(gram), 0))

    def first(self, size: int) -> Float[Array, "modes size"]:
        """Return so many, largest eigenvalue first."""
        if size > self._known.shape[1]:
            ahead = 1 if self._known.shape[1] else _AHEAD
            self._known = self._found(min(len(self._gram), ahead * size))
        return self._known[:, :size]

    def _found(self, size: int) -> Array:
        """Return vectors by subspace iteration, from those that are known and some at random."""
        n, known = len(self._gram), self._known
        more = min(n, size + _BESIDE) - known.shape[1]
        drawn = np.random.default_rng(n).standard_normal((n, more))
        span = np.hstack([known, drawn])
        for _ in range(_SWEEPS):
            span, _ = linalg.qr(self._gram @ span, mode="economic")
        _, vectors = linalg.eigh(span.T @ (self._gram @ span))
        return span @ vectors[:, ::-1][:, :size]


def _diagonal(span: Array, omega: Array, ratios: Array) -> ResponseBasis:
    """Return the modes of what is left within a span, whose error nobody has looked at."""
    square, vectors = linalg.eigh(span.T @ (omega[:, None] ** 2 * span))
    combined = span @ vectors
    new = np.sqrt(np.maximum(square, 0.0))
    damped = np.einsum("ij,i,ij->j", combined, 2.0 * ratios * omega, combined)
    return ResponseBasis(
        combined=combined, omega=new, ratios=damped / (2.0 * new), error=float("inf")
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Trial:
    """Frequencies between those of the basis, with the true response there."""

    lines: Array
    bands: Array  # the number of each line's band
    route: Array
    read: Array
    expected: Array  # (n_lines, n_read, n_route)

    @classmethod
    def of(cls, omega: Array, ratios: Array, route: Array, points: Array, lines: Array) -> _Trial:
        """Compute the true response at some lines."""
        probes = np.random.default_rng(len(route)).standard_normal((_PROBES, len(route)))
        read = np.concatenate([points, probes @ route / np.sqrt(len(route))])
        return cls(
            lines=lines,
            bands=np.floor(np.log(lines / lines[-1]) / np.log(_BAND) + 1e-9).astype(int),
            route=route,
            read=read,
            expected=_response(_receptance(omega, ratios, lines), read, route),
        )

    def error_of(self, found: ResponseBasis) -> float:
        """Return the largest error in any band at any reading."""
        h = _receptance(found.omega, found.ratios, self.lines)
        off = _response(h, self.read @ found.combined, self.route @ found.combined) - self.expected
        wrong, size = (np.sum(np.abs(x) ** 2, axis=2) for x in (off, self.expected))
        worst = 0.0
        for band in np.unique(self.bands):
            here = self.bands == band
            worst = max(worst, float((wrong[here].sum(axis=0) / size[here].sum(axis=0)).max()))
        return float(np.sqrt(worst))


def _response(h: Array, read: Array, route: Array) -> Array:
    """Return the response of readings to the route at every line: (n_lines, n_read, n_route)."""
    return np.stack([(read * column) @ route.T for column in h.T])
