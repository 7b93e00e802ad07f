"""Say how hard a walking person presses on a floor, harmonic by harmonic of the pace.

A walker presses ``W (1 + sum_h alpha_h cos(2 pi h f_p t + phi_h))``, with the weight W, the pace
f_p in steps a second and the load factors alpha_h of a guide. The guides stop at the fourth
harmonic or so, and give for floors above an effective impulse of every step instead: what a mode of
frequency f gets from one step is an impulse ``I = a f_p^b / f^c (W / W0)``. A step whose Fourier
transform has that size at every frequency, repeated at the pace, is a series of harmonics of
amplitude ``2 f_p I(h f_p)``: so the impulse continues the series to as many bands as are asked for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._checks import non_negative, positive, set_frozen, within
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = ["FootfallLoad", "Harmonic", "Impulse"]

_EDGE = 1e-9  # Hz


@dataclass(frozen=True, kw_only=True)
class Harmonic:
    """Hold one harmonic of the pace: ``alpha = min(constant + slope f, most)``, f its frequency.

    Attributes
    ----------
    number : int
        Times the pace.
    f_from, f_to : float
        Frequencies that it is given for [Hz]; beyond them the value at the nearer end is taken.
    constant, slope : float
        Of the load factor [1], [s].
    most : float
        What it never exceeds.
    phase : float
        Phase of a cosine at the time of a step [rad].
    """

    number: int
    f_from: float
    f_to: float
    constant: float
    slope: float = 0.0
    most: float = np.inf
    phase: float = 0.0

    def factor(self, f: ArrayLike) -> Float[Array, ...]:
        """Return the load factor at frequencies of the harmonic [Hz]."""
        held = np.clip(np.asarray(f, dtype=float), self.f_from, self.f_to)
        return np.clip(self.constant + self.slope * held, 0.0, self.most)

    def covers(self, f: float) -> bool:
        """Return whether the guide gives it at a frequency [Hz]."""
        return self.f_from - _EDGE <= f <= self.f_to + _EDGE


@dataclass(frozen=True, kw_only=True)
class Impulse:
    """Hold the effective impulse of one step: ``factor f_p^pace_power / f^power``.

    Attributes
    ----------
    factor : float
        For a walker of the guide's weight [N s at 1 Hz].
    pace_power, power : float
        How it grows with the pace, and falls with the frequency of what it meets.
    """

    factor: float
    pace_power: float
    power: float

    def __post_init__(self) -> None:
        """Check the factor."""
        set_frozen(self, factor=positive("impulse factor", self.factor))

    def size(self, pace: float, f: ArrayLike) -> Float[Array, ...]:
        """Return the impulse that a mode of some frequency [Hz] gets from a step [N s]."""
        return self.factor * pace**self.pace_power / np.asarray(f, dtype=float) ** self.power


@dataclass(frozen=True, kw_only=True, eq=False)
class FootfallLoad:
    """Hold the load function of a guide.

    Attributes
    ----------
    name, title : str
        Name in study files, and title in reports.
    source, confidence, assumption : str
        Where the numbers come from, how sure they are, and what was assumed.
    weight : float
        Weight of the walker that it is for [N].
    paces : tuple of float
        Lowest and highest pace that it is for [steps/s].
    harmonics : tuple of Harmonic
        In their order, without gaps.
    impulse : Impulse or None
        Effective impulse of a step; None if the guide gives none.
    speed : tuple of float
        Walking speed as a polynomial of the pace, constant first [m/s]; empty if none is given.
    """

    name: str
    title: str
    source: str
    confidence: str
    weight: float
    paces: tuple[float, float]
    harmonics: tuple[Harmonic, ...]
    impulse: Impulse | None = None
    speed: tuple[float, ...] = ()
    assumption: str = ""

    def __post_init__(self) -> None:
        """Check weight, paces and the order of harmonics."""
        set_frozen(self, weight=positive("weight", self.weight))
        low, high = self.paces
        if not 0.0 < low < high:
            raise InputError(f"footfall {self.name!r}: paces must rise; got {low:g} and {high:g}")
        if [h.number for h in self.harmonics] != list(range(1, len(self.harmonics) + 1)):
            raise InputError(f"footfall {self.name!r}: harmonics must be 1, 2, 3 and so on")

    def walking_speed(self, pace: float) -> float:
        """Return how fast somebody walks at a pace [m/s]: by the guide, or 0.75 m a step."""
        if not self.speed:
            return _STEP * pace
        return float(np.polynomial.polynomial.polyval(pace, self.speed))

    def highest(self, pace: float) -> float:
        """Return the frequency at which the guide's own harmonics end [Hz]."""
        return pace * len(self.harmonics)

    def n_harmonics(self, pace: float, f_max: float) -> int:
        """Return how many harmonics reach a frequency [Hz]: the guide's, and those of impulses."""
        if self.impulse is None:
            return len(self.harmonics)
        return max(len(self.harmonics), int(np.floor(f_max / pace + _EDGE)))

    def amplitudes(
        self, pace: float, n: int | None = None, *, weight: float | None = None
    ) -> Float[Array, " harmonics"]:
        """Return the amplitude of each harmonic about the weight [N].

        Parameters
        ----------
        pace : float
            Steps a second [Hz].
        n : int, optional
            How many; those behind the guide's continue by its impulse. The guide's unless given.
        weight : float, optional
            Weight of the walker [N]; the guide's unless given.

        Raises
        ------
        InputError
            More harmonics than the guide gives, which has no impulse.

        Notes
        -----
        A series of steps, each of Fourier transform F at the frequencies of the harmonics, has
        Fourier coefficients ``f_p F``, amplitudes ``2 f_p |F|``.

        Examples
        --------
        >>> from trundle.footfall import footfall_load
        >>> footfall_load("p354").amplitudes(2.0).round(1)
        array([341.5,  73. ,  58.5,  52.2])
        """
        own = len(self.harmonics)
        wanted = own if n is None else n
        if wanted > own and self.impulse is None:
            raise InputError(
                f"footfall {self.name!r} gives {own} harmonics and no impulse; got {wanted}"
            )
        heavy = self.weight if weight is None else non_negative("weight", weight)
        within("pace", pace, 0.2, 10.0, remedy="steps a second")
        out = np.zeros(wanted)
        for i, harmonic in enumerate(self.harmonics[:wanted]):
            out[i] = heavy * harmonic.factor(pace * harmonic.number)
        if wanted > own and self.impulse is not None:
            f = pace * np.arange(own + 1, wanted + 1)
            out[own:] = 2.0 * pace * self.impulse.size(pace, f) * heavy / self.weight
        return out

    def phases(self, n: int | None = None) -> Float[Array, " harmonics"]:
        """Return the phase of each harmonic [rad]; those of impulses fall on the step."""
        out = np.zeros(len(self.harmonics) if n is None else n)
        own = [harmonic.phase for harmonic in self.harmonics][: len(out)]
        out[: len(own)] = own
        return out


_STEP = 0.75  # m
