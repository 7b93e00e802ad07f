"""March through a spectrum shift by shift, with a block Lanczos iteration at each.

At a shift sigma the iteration runs on ``(K - sigma M)^-1 M`` with full reorthogonalisation in the
mass inner product: the eigenvalues nearest the shift come first, on both of its sides. Some three
hundred modes a shift keep the subspace in cache, where one subspace for a thousand modes would be
read from memory at every step. Each factorisation counts the eigenvalues below its shift
(Sylvester's law of inertia), so that none is missed between two shifts.

A block of b vectors shows b copies of an eigenvalue; further ones, as equal columns and bays have
them, do not appear in its space. Where inertia counts more than were found, the search begins anew
from other vectors, M-orthogonal to those found, until the count is met.

References
----------
R. G. Grimes, J. G. Lewis and H. D. Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228-272.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics.krylov import BLOCK
from trundle.dynamics.near_shift import EQUAL, EigenSlice, hunted, near
from trundle.dynamics.pencil import Pencil, Shift, shift_near
from trundle.errors import ConvergenceError

__all__ = ["EigenSlice", "Interval", "march", "march_within"]

_SLICE = 320  # modes looked for at one shift
_SHIFT = 1.0  # rad2/s2: keeps K + s M definite for a free body, far below any floor mode
_SHORTEST = 80  # modes of a slice below which a march is given up
_EDGES = 16  # last modes of a slice among which the widest gap is its end
_MIDDLE = 0.62  # of the highest frequency: as many modes above as below, with what each costs
_SEEN = 0.2  # of the modes ahead, which if seen tell how far the others reach
_LARGEST = 2400  # modes that one shift may be left with where no shift parts them


def march(
    pencil: Pencil,
    wanted: int,
    limit: float,
    *,
    keep: Callable[[int, EigenSlice], None],
) -> None:
    """Find the lowest eigenpairs of ``K x = lambda M x``, a slice at a time.

    Parameters
    ----------
    pencil : Pencil
        Symmetric M [kg] and K [N/m].
    wanted : int
        How many eigenvalues lie below `limit`, by inertia.
    limit : float
        End of the part of the spectrum that is looked for [rad2/s2].
    keep : callable
        Given the number of eigenvalues below the next slice, and the slice; called from two
        threads where the spectrum is long.

    Raises
    ------
    ConvergenceError
        A slice holds more or fewer eigenvalues than inertia counts.
    """
    lowest = _lowest(pencil)
    if wanted <= 2 * _SLICE:
        whole = Interval(first=0, edge=0.0, end=wanted, limit=limit)
        march_within(pencil, whole, shift=lowest, keep=keep)
        return
    # Floors have about twice as many modes in an octave as in the one below; this halves the work.
    middle = shift_near(pencil, _MIDDLE * np.sqrt(limit))
    lower = Interval(first=0, edge=0.0, end=middle.below, limit=middle.value)
    upper = Interval(first=middle.below, edge=middle.value, end=wanted, limit=limit)
    del middle
    with ThreadPoolExecutor(2) as pool:
        above = pool.submit(march_within, pencil, upper, keep=keep)
        march_within(pencil, lower, shift=lowest, keep=keep)
        above.result()


def _lowest(pencil: Pencil) -> Shift:
    """Factorise just below all eigenvalues."""
    return Shift(value=-_SHIFT, factor=pencil.factorise(-_SHIFT))


@dataclass(frozen=True, kw_only=True, eq=False)
class Interval:
    """Hold a part of a spectrum, whose eigenvalues inertia has counted.

    Attributes
    ----------
    first, end : int
        How many eigenvalues lie below it, and below its end.
    edge, limit : float
        Where it begins and ends [rad2/s2]; neither is an eigenvalue.
    """

    first: int
    edge: float
    end: int
    limit: float


def march_within(
    pencil: Pencil,
    interval: Interval,
    *,
    keep: Callable[[int, EigenSlice], None],
    shift: Shift | None = None,
    most: int = _SLICE,
) -> None:
    """Find the eigenpairs of one part of a spectrum, a slice at a time.

    Parameters
    ----------
    pencil : Pencil
        Symmetric M [kg] and K [N/m].
    interval : Interval
        The part of the spectrum.
    keep : callable
        Given the number of eigenvalues below the next slice, and the slice.
    shift : Shift, optional
        Where the first slice is looked for, if that is known.
    most : int
        How many one shift is to find; fewer where factors are cheap against products.

    Raises
    ------
    ConvergenceError
        A slice holds more or fewer eigenvalues than inertia counts.
    """
    if shift is None and interval.first == 0:
        shift = _lowest(pencil)
    start = _Reached(found=interval.first, edge=interval.edge, last=np.array([interval.edge]))
    reached = [start]
    while reached[-1].found < interval.end:
        try:
            part, edge = _next_slice(pencil, interval, reached[-1], shift, most)
        except ConvergenceError:
            # inertia counts others than were found, here or in the slice before: both anew, shorter
            most //= 2
            if most < _SHORTEST:
                raise
            if len(reached) > 1:
                reached.pop()
            shift = None
            continue
        shift = None  # its factor goes before the next is made
        found = reached[-1].found
        keep(found, part)
        reached.append(
            _Reached(
                found=found + len(part.eigenvalues),
                edge=edge,
                last=part.eigenvalues,
                beyond=part.beyond,
            )
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Reached:
    """How far a march has come: eigenvalues below `edge`, the last slice's, and some beyond."""

    found: int
    edge: float
    last: Float[Array, " modes"]
    beyond: Float[Array, " beyond"] = field(default_factory=lambda: np.zeros(0))


def _next_slice(
    pencil: Pencil, interval: Interval, reached: _Reached, shift: Shift | None, most: int
) -> tuple[EigenSlice, float]:
    """Return the next slice, of so many modes at most, and where it ends."""
    found, wanted = reached.found, interval.end
    if shift is None:
        shift = _next_shift(pencil, interval, reached, most)
    left, right = shift.below - found, wanted - shift.below
    bounds = (reached.edge, interval.limit)
    part = near(pencil.mass, shift, left, right, bounds, aim=_share(wanted - found, most))
    whole, edge = len(part.eigenvalues) == left + right, interval.limit
    if not whole and len(part.eigenvalues) == left and part.eigenvalues[-1] < shift.value:
        edge = shift.value  # all below the shift, which inertia has counted, and nothing above
    elif not whole:
        part, edge = _up_to_a_gap(part, interval.limit)
        if _copies(part.eigenvalues) >= BLOCK:
            part = _completed(pencil, shift, part, (reached.last[-1], edge), found)
    _check(part, reached.last[-1], edge)
    return part, edge


def _share(remaining: int, most: int) -> int:
    """Return how many of the remaining modes one shift is to find, so many at most."""
    return -(-remaining // max(1, -(-remaining // most)))


def _check(part: EigenSlice, before: float, edge: float) -> None:
    """Hold a slice against what lies before it and behind it."""
    values = part.eigenvalues
    if values[0] < before or values[-1] >= edge:
        place = np.sqrt(max(before if values[0] < before else edge, 0.0)) / (2.0 * np.pi)
        raise ConvergenceError(
            f"near {place:.6g} Hz inertia counts other modes than were found",
            residual=float("nan"),
        )


def _up_to_a_gap(part: EigenSlice, limit: float) -> tuple[EigenSlice, float]:
    """Cut a slice in the widest gap near its end, so that equal modes stay together."""
    values = part.eigenvalues
    gaps = np.diff(values) / values[1:]
    # of many equal modes all of the last ones may be copies: then the last gap before them
    late = max(0, len(gaps) - _EDGES + 1)
    wide = np.flatnonzero(gaps > EQUAL)
    above = part.beyond[part.beyond > values[-1] * (1.0 + EQUAL)]
    if not len(wide):  # copies of one mode: the gap behind them
        return part, float(0.5 * (values[-1] + above[0])) if len(above) else limit
    if len(wide) and wide[-1] < late:
        late = int(wide[-1])
    cut = late + 1 + int(np.argmax(gaps[late:]))
    edge = float(0.5 * (values[cut - 1] + values[cut]))
    beyond = np.concatenate([values[cut:], part.beyond])
    return EigenSlice(eigenvalues=values[:cut], shapes=part.shapes[:, :cut], beyond=beyond), edge


def _copies(eigenvalues: Array) -> int:
    """Return how many eigenvalues at most lie together."""
    apart = np.diff(eigenvalues) > EQUAL * np.abs(eigenvalues[1:])
    ends = np.concatenate([[-1], np.flatnonzero(apart), [len(eigenvalues) - 1]])
    return int(np.diff(ends).max())


def _completed(
    pencil: Pencil, shift: Shift, part: EigenSlice, bounds: tuple[float, float], found: int
) -> EigenSlice:
    """Return a slice with all copies that inertia counts up to its end."""
    wanted = shift_near(pencil, float(np.sqrt(bounds[1]))).below - found
    return hunted(pencil.mass, shift, part, bounds, wanted)


def _next_shift(pencil: Pencil, interval: Interval, reached: _Reached, most: int) -> Shift:
    """Place a shift in the middle of the modes that it is to find."""
    found, start = reached.found, float(np.sqrt(reached.edge))
    ahead = 0.5 * _share(interval.end - found, most)
    distance = min(_distance(interval, reached, ahead), 0.5 * (np.sqrt(interval.limit) - start))
    shift = shift_near(pencil, start + distance)
    for _ in range(40):
        if shift.below - found <= 1.5 * ahead + BLOCK:
            return shift
        distance *= max(0.25, ahead / (shift.below - found))
        shift = shift_near(pencil, start + distance)
    if shift.below - found <= _LARGEST:
        return shift  # so many equal modes: one slice takes them all
    raise ConvergenceError(
        f"no shift above {start / (2.0 * np.pi):.6g} Hz parts the modes that lie close together",
        residual=float("nan"),
    )


def _distance(interval: Interval, reached: _Reached, ahead: float) -> float:
    """Return how far above what is reached about so many modes lie [rad/s].

    What the last shift saw beyond its slice tells that best: modes of a building of equal parts
    lie in clusters, so that the spacing of the last ones says little of the next.
    """
    start, before = np.sqrt(reached.edge), max(1, int(ahead))
    beyond = np.sqrt(reached.beyond[reached.beyond > reached.edge])
    if len(beyond) > before:
        return float(0.5 * (beyond[before - 1] + beyond[before]) - start)
    if len(beyond) > _SEEN * ahead:
        return float((beyond[-1] - start) * ahead / len(beyond))
    return float((np.sqrt(interval.limit) - start) / (interval.end - reached.found) * ahead)
