"""Answer for people who walk on a floor, by the guides, from its modes.

Every walker of some places is tried at every pace for every place where it is felt. In a steady
state, harmonics of the pace drive the modes for as long as the path lasts; in a transient, each
step is an impulse that has died away, or not, when the next one comes. The guides take the larger.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex, Float, Int

from trundle._progress import Progress
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.footfall import FootfallLoad
from trundle.signals import BASE_ACCELERATION
from trundle.simulate.spectral.footfall_doubts import footfall_doubts
from trundle.simulate.spectral.footfall_floor import FootfallFloor
from trundle.simulate.spectral.footfall_rules import FootfallQuantity, FootfallRule
from trundle.simulate.spectral.footfall_terms import (
    Terms,
    footfall_paces,
    steady_terms,
    transient_terms,
)

__all__ = ["FootfallLevels", "FootfallResponse", "footfall_response"]

_STEPS = 9  # paces at which impulses are tried: they grow smoothly with the pace
_TOLD = 2_000_000  # numbers held at once while what governs is looked for
_DOSE = 0.68  # of the RMS: intermittent walking, SCI P354; steady motion has 1.4 in BS 6472-1


@dataclass(frozen=True, kw_only=True, eq=False)
class FootfallLevels:
    """Hold the largest level at every place, and what gives it.

    Attributes
    ----------
    level : ndarray of float, shape (n_places,)
        Response factor, or peak acceleration [m/s2].
    pace : ndarray of float, shape (n_places,)
        Pace that gives it [steps/s].
    harmonic : ndarray of int, shape (n_places,)
        Harmonic that gives most of it; 0 for the impulses of steps.
    mode : ndarray of int, shape (n_places,)
        Mode that gives most of that, from 0.
    frequency : ndarray of float, shape (n_places,)
        Natural frequency of that mode [Hz].
    walker : ndarray of int, shape (n_places,)
        Where it is walked: the number of the place that is walked on, from 0.
    """

    level: Float[Array, " places"]
    pace: Float[Array, " places"]
    harmonic: Int[Array, " places"]
    mode: Int[Array, " places"]
    frequency: Float[Array, " places"]
    walker: Int[Array, " places"]

    def larger(self, other: FootfallLevels) -> FootfallLevels:
        """Return at each place the larger of both."""
        mine = self.level >= other.level
        names = ("level", "pace", "harmonic", "mode", "frequency", "walker")
        return FootfallLevels(
            **{name: np.where(mine, getattr(self, name), getattr(other, name)) for name in names}
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class FootfallResponse:
    """Hold what people who walk give a floor, by one guide.

    Attributes
    ----------
    load : FootfallLoad
        Load function.
    rule : FootfallRule
        How the guide makes levels of motion.
    paces : ndarray of float, shape (n_paces,)
        Paces that were tried [steps/s].
    steady : FootfallLevels
        Of harmonics in their steady state.
    transient : FootfallLevels or None
        Of the impulses of steps; None where the guide has none.
    doubts : tuple of FitnessWarning
        What a report must say.
    """

    load: FootfallLoad
    rule: FootfallRule
    paces: Float[Array, " paces"]
    steady: FootfallLevels
    transient: FootfallLevels | None
    doubts: tuple[FitnessWarning, ...]

    @property
    def quantity(self) -> FootfallQuantity:
        """What levels are."""
        return self.rule.quantity

    @cached_property
    def governing(self) -> FootfallLevels:
        """The larger of steady state and transient at each place."""
        return self.steady if self.transient is None else self.steady.larger(self.transient)

    @property
    def worst(self) -> int:
        """The place with the largest level, from 0."""
        return int(self.governing.level.argmax())

    def dose(self, duration: float, passages: float) -> Float[Array, " places"]:
        """Return the vibration dose value of some passages [m/s^1.75].

        ``0.68 a_w,rms (n T)^(1/4)`` (SCI P354, from memory, confidence high; the same person is
        taken to pass at the worst pace, by the worst place, every time).

        Parameters
        ----------
        duration : float
            Of one passage [s].
        passages : float
            How many there are.

        Raises
        ------
        InputError
            Levels are peak accelerations.
        """
        if self.quantity != "response_factor":
            raise InputError(f"{self.load.title}: a peak acceleration has no vibration dose")
        rms = BASE_ACCELERATION * self.governing.level
        return _DOSE * rms * (passages * duration) ** 0.25


def footfall_response(
    floor: FootfallFloor,
    load: FootfallLoad,
    rule: FootfallRule,
    *,
    paces: tuple[float, float] | None = None,
    progress: Progress | None = None,
) -> FootfallResponse:
    """Answer for people who walk on a floor.

    Parameters
    ----------
    floor : FootfallFloor
        The floor at the places that are walked on and at those where it is felt.
    load : FootfallLoad
        Load function of a guide.
    rule : FootfallRule
        How the guide makes levels of motion, see `footfall_rule`.
    paces : tuple of float, optional
        Lowest and highest pace [steps/s]; the guide's own unless given.
    progress : callable, optional
        Told the share done.

    Returns
    -------
    FootfallResponse
        Levels at every place, with the pace, the harmonic, the mode and the walker that give them.

    Notes
    -----
    Of each pace the harmonics that the guide prints are taken, and all modes with their phases. So
    many paces are tried that no resonance is missed, see `footfall_paces`; impulses, which grow
    smoothly with the pace, are tried at nine.
    """
    low, high = load.paces if paces is None else paces
    tried = footfall_paces(floor, load, low, high)
    steps = np.unique(np.linspace(low, high, _STEPS))
    stepped = steps if load.impulse is not None else steps[:0]
    work = [steady_terms(floor, load, rule, pace) for pace in tried]
    impulses = [transient_terms(floor, load, rule, pace) for pace in stepped]
    told = _Told(progress, sum(len(one.scales) for one in (*work, *impulses)))
    return FootfallResponse(
        load=load,
        rule=rule,
        paces=tried,
        steady=_largest(floor, tried, work, told),
        transient=_largest(floor, stepped, impulses, told) if impulses else None,
        doubts=tuple(footfall_doubts(floor, load, low, high)),
    )


class _Told:
    """Tells the share done, by the sums that were formed."""

    def __init__(self, progress: Progress | None, total: int) -> None:
        self._progress, self._total, self._done = progress, total, 0

    def more(self, n: int) -> None:
        self._done += n
        if self._progress is not None:
            self._progress(self._done / self._total)


def _largest(floor: FootfallFloor, paces: Array, work: list[Terms], told: _Told) -> FootfallLevels:
    """Return the largest level at each place over paces and walkers."""
    n, rows = len(floor.felt), np.arange(len(floor.felt))
    best, which, walker = np.full(n, -1.0), np.zeros(n, dtype=int), np.zeros(n, dtype=int)
    for i, terms in enumerate(work):
        for block in floor.blocks():
            squared = terms.squared(floor, block)
            column = squared.argmax(axis=1)
            found = squared[rows, column]
            better = found > best
            best = np.where(better, found, best)
            which = np.where(better, i, which)
            walker = np.where(better, floor.walkers(block, column), walker)
        told.more(len(terms.scales))
    harmonic, mode = _governing(floor, work, which, walker)
    return FootfallLevels(
        level=np.sqrt(best),
        pace=paces[which],
        harmonic=harmonic,
        mode=mode,
        frequency=floor.frequencies[mode],
        walker=walker,
    )


def _governing(
    floor: FootfallFloor, work: list[Terms], which: Array, walker: Array
) -> tuple[Array, Array]:
    """Return the harmonic that gives most at each place, and the mode that gives most of it."""
    harmonic, mode = np.zeros_like(which), np.zeros_like(which)
    for i in np.unique(which):
        terms = work[i]
        some = np.flatnonzero(which == i)
        step = max(1, _TOLD // terms.named.size)
        for start in range(0, len(some), step):
            part = some[start : start + step]
            parts = _parts(floor, terms, part, walker[part])
            if terms.harmonics:
                sums = np.abs(
                    parts.sum(axis=2) + terms.static * floor.static(part, walker[part])[:, None]
                )
                row = sums.argmax(axis=1)
                harmonic[part] = row + 1
            else:
                row = np.zeros(len(part), dtype=int)
            mode[part] = np.abs(parts[np.arange(len(part)), row]).argmax(axis=1)
    return harmonic, mode


def _parts(
    floor: FootfallFloor, terms: Terms, places: Array, walkers: Array
) -> Complex[Array, "some parts modes"] | Float[Array, "some parts modes"]:
    """Return what each mode gives to each part of the level at some places."""
    pairs = floor.felt[places] * floor.walked[walkers]
    return pairs[:, None, :] * terms.named
