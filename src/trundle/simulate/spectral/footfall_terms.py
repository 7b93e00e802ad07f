"""Form what a pace does to each mode: harmonics in their steady state, and impulses of steps.

Both are sums over modes of ``felt scale walked`` whose squares make the square of the level, so
that one computation over walkers and places serves both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from trundle._checks import positive
from trundle._typing import Array
from trundle.errors import InputError
from trundle.footfall import FootfallLoad
from trundle.simulate.spectral.footfall_floor import FootfallFloor
from trundle.simulate.spectral.footfall_rules import FootfallRule

__all__ = ["Terms", "footfall_paces", "steady_terms", "transient_terms"]

_NOUGHT = 1e-12  # of the largest share of energy, below which one is left out
_FINEST = 1e-3  # of a pace


@dataclass(frozen=True, kw_only=True, eq=False)
class Terms:
    """Hold what makes the level at one pace.

    Attributes
    ----------
    scales : ndarray of complex or float, shape (n_terms, n_modes)
        By which modes are summed; the squares of all sums make the square of the level.
    static : ndarray of float, shape (n_terms,)
        By which the flexibility of the modes left out is added [N/m].
    named : ndarray of complex or float, shape (n_parts, n_modes)
        The same by harmonics, or in one row by modes: what is said to govern is the largest of it.
    harmonics : bool
        Whether `named` has a row for each harmonic; they are those of `scales` then.
    together : bool
        Whether terms add up by their squares; the largest alone counts otherwise.
    """

    scales: Complex[Array, "terms modes"] | Float[Array, "terms modes"]
    static: Float[Array, " terms"]
    named: Complex[Array, "parts modes"] | Float[Array, "parts modes"]
    harmonics: bool
    together: bool = True

    def squared(self, floor: FootfallFloor, block: slice) -> Float[Array, "places some"]:
        """Return the square of the level at all places for some walkers."""
        total: Array | None = None
        for scale, static in zip(self.scales, self.static, strict=True):
            if not scale.any():
                continue
            found = floor.carried(np.ascontiguousarray(scale.real), block)
            if static and floor.residual is not None:
                found += static * floor.residual[:, block]
            found *= found
            if np.iscomplexobj(scale):
                found += floor.carried(np.ascontiguousarray(scale.imag), block) ** 2
            if total is None:
                total = found
            elif self.together:
                total += found
            else:
                np.maximum(total, found, out=total)
        if total is None:
            return np.zeros((len(floor.felt), block.stop - block.start))
        return total


def steady_terms(
    floor: FootfallFloor, load: FootfallLoad, rule: FootfallRule, pace: float
) -> Terms:
    """Return the harmonics of a pace in their steady state.

    Notes
    -----
    A unit force at omega gives a mode the acceleration
    ``-omega^2 / (omega_m^2 - omega^2 + 2 i zeta omega omega_m)``, of which it reaches a share by
    the guide. The modes left out follow at once, ``-omega^2`` times their static flexibility.
    """
    f = pace * np.arange(1, len(load.harmonics) + 1)
    level = rule.amplitudes(load, pace) * rule.steady_weight(f)
    omega = 2.0 * np.pi * f[:, None]
    below = floor.omega**2 - omega**2 + 2j * floor.ratios * omega * floor.omega
    scales = -(level[:, None] * omega**2) * rule.build_up(load, pace, floor.ratios) / below
    return Terms(
        scales=scales,
        static=-level * omega[:, 0] ** 2,
        named=scales,
        harmonics=True,
        together=rule.together,
    )


def transient_terms(
    floor: FootfallFloor, load: FootfallLoad, rule: FootfallRule, pace: float
) -> Terms:
    """Return the RMS over one step of what its impulse leaves in the modes.

    Raises
    ------
    InputError
        The load function has no impulse.

    Notes
    -----
    A mode gets the velocity ``I(f_m) phi_e phi_r exp(-zeta omega t) sin(omega_d t)`` of an
    effective impulse I. The mean square over a step is a quadratic form of the modes' sizes, whose
    matrix is integrated in closed form; its eigenvectors make as many sums as it has rank.
    """
    if load.impulse is None:
        raise InputError(f"footfall {load.name!r} gives no impulse")
    decay, turn = floor.ratios * floor.omega, floor.omega * np.sqrt(1.0 - floor.ratios**2)
    size = load.impulse.size(pace, floor.frequencies) * rule.transient_weight(turn)
    matrix = _mean_products(decay, turn, 1.0 / pace) * np.outer(size, size)
    shares, vectors = np.linalg.eigh(matrix)
    kept = shares > _NOUGHT * max(float(shares[-1]), np.finfo(float).tiny)
    return Terms(
        scales=(vectors[:, kept] * np.sqrt(shares[kept])).T,
        static=np.zeros(np.count_nonzero(kept)),
        named=np.sqrt(np.maximum(np.diag(matrix), 0.0))[None],
        harmonics=False,
    )


def footfall_paces(
    floor: FootfallFloor, load: FootfallLoad, low: float, high: float
) -> Float[Array, " paces"]:
    """Return paces that miss no resonance of the guide's harmonics.

    They are as far apart as a quarter of the half-power bandwidth of the least damped mode, and
    those that put a harmonic on a mode are among them.

    Parameters
    ----------
    floor : FootfallFloor
        Has the modes.
    load : FootfallLoad
        Has the harmonics.
    low, high : float
        Lowest and highest pace [steps/s]; they may be the same.
    """
    low, high = positive("lowest pace", low), positive("highest pace", high)
    if high < low:
        raise InputError(f"paces must rise; got {low:g} to {high:g} steps/s")
    step = low * max(0.5 * float(floor.ratios.min()), _FINEST)
    even = np.linspace(low, high, int(np.ceil((high - low) / step)) + 1 if high > low else 1)
    on = floor.frequencies[:, None] / np.arange(1, len(load.harmonics) + 1)
    return np.unique(np.concatenate([even, on[(on > low) & (on < high)]]))


def _mean_products(decay: Array, turn: Array, period: float) -> Float[Array, "modes modes"]:
    """Return the means over a period of products of two modes' ``exp(-decay t) sin(turn t)``."""
    slow = -(decay[:, None] + decay)
    apart = slow + 1j * (turn[:, None] - turn)
    summed = slow + 1j * (turn[:, None] + turn)
    both = np.expm1(apart * period) / apart - np.expm1(summed * period) / summed
    return 0.5 * both.real / period
