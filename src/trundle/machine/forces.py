"""Describe what machines press on a floor: rotors, harmonics, run-ups, strokes.

A machine force is a function of time; how it changes between runs is its phase alone, for nobody
knows where a rotor stands when a truck arrives.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, non_negative, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Harmonics", "MachineForce", "RunUp", "Strokes", "Unbalance"]

_REACH = 96  # steps on both sides of a blow, that its share below the cut spreads over
_FINE = 32  # parts of a step
_CUT = 0.475  # of the sampling frequency; what is passed ends between 0.46 and 0.49
_KAISER = 8.0  # of a window that holds 80 dB back beyond


@runtime_checkable
class MachineForce(Protocol):
    """A force that a machine makes."""

    @property
    def reaches(self) -> float:
        """Frequency at which it ends [Hz]."""
        ...

    @property
    def shows(self) -> float:
        """Frequency that a time step must show, or it would look slower [Hz]."""
        ...

    @property
    def sudden(self) -> bool:
        """Whether it comes on by itself, and not smoothly."""
        ...

    def at(self, time: Float[Array, " times"], phase: float) -> Float[Array, " times"]:
        """Return the force at some times [N], with the phase of a run in turns, 0 to 1."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Harmonics:
    """A steady force of some frequencies.

    Attributes
    ----------
    frequencies, amplitudes, phases : ndarray of float, shape (n,)
        Of each cosine [Hz], [N], [rad].
    """

    frequencies: Float[Array, " n"]
    amplitudes: Float[Array, " n"]
    phases: Float[Array, " n"]

    sudden = False

    def __post_init__(self) -> None:
        """Check and freeze all three."""
        f = frozen_array("frequencies", self.frequencies, shape=(None,))
        if not len(f) or np.any(f <= 0.0):
            raise InputError("a machine's frequencies must be greater than 0")
        set_frozen(
            self,
            frequencies=f,
            amplitudes=frozen_array("amplitudes", self.amplitudes, shape=f.shape),
            phases=frozen_array("phases", self.phases, shape=f.shape),
        )

    @property
    def reaches(self) -> float:
        """Highest of its frequencies [Hz]."""
        return float(self.frequencies.max())

    shows = reaches

    def at(self, time: Float[Array, " times"], phase: float) -> Float[Array, " times"]:
        """Return the force; the phase is that of a turn of the lowest frequency."""
        turns = np.outer(time, self.frequencies) + phase * self.frequencies / self.frequencies.min()
        return np.cos(2.0 * np.pi * turns + self.phases) @ self.amplitudes


@dataclass(frozen=True, kw_only=True)
class Unbalance:
    """A rotor out of balance at a steady speed: ``m e omega^2``, its vertical part.

    Attributes
    ----------
    mass_radius : float
        Unbalance m e [kg m].
    frequency : float
        Turns a second [Hz].
    """

    mass_radius: float
    frequency: float

    sudden = False

    def __post_init__(self) -> None:
        """Check both."""
        set_frozen(
            self,
            mass_radius=positive("mass_radius", self.mass_radius),
            frequency=positive("frequency", self.frequency),
        )

    @classmethod
    def of_grade(cls, *, grade: float, rotor_mass: float, frequency: float) -> Unbalance:
        """Return the unbalance that a balance quality grade allows.

        Parameters
        ----------
        grade : float
            Speed of the centre of mass e omega [m/s]: 6.3e-3 for G 6.3.
        rotor_mass : float
            Mass of the rotor [kg].
        frequency : float
            Turns a second [Hz].

        References
        ----------
        ISO 21940-11:2016, clause 6: G = e omega, at the highest service speed.
        """
        eccentricity = positive("grade", grade) / (2.0 * np.pi * positive("frequency", frequency))
        mass = positive("rotor_mass", rotor_mass)
        return cls(mass_radius=mass * eccentricity, frequency=frequency)

    @property
    def amplitude(self) -> float:
        """Amplitude of its force [N]."""
        return self.mass_radius * (2.0 * np.pi * self.frequency) ** 2

    @property
    def reaches(self) -> float:
        """Frequency of its turns [Hz]."""
        return self.frequency

    shows = reaches

    def at(self, time: Float[Array, " times"], phase: float) -> Float[Array, " times"]:
        """Return the force."""
        return self.amplitude * np.cos(2.0 * np.pi * (self.frequency * time + phase))


@dataclass(frozen=True, kw_only=True)
class RunUp:
    """A rotor whose speed goes evenly from one to another, and stays there: a sweep.

    Attributes
    ----------
    f_from, f_to : float
        Turns a second at first and at last [Hz]; a run-down ends lower.
    takes : float
        Time from one to the other [s].
    mass_radius : float
        Unbalance m e [kg m], whose force grows with the speed squared; 0 for a steady amplitude.
    amplitude : float
        Amplitude of a force that does not grow with speed [N].
    """

    f_from: float
    f_to: float
    takes: float
    mass_radius: float = 0.0
    amplitude: float = 0.0

    sudden = False

    def __post_init__(self) -> None:
        """Check that it is one of the two."""
        set_frozen(
            self,
            f_from=non_negative("f_from", self.f_from),
            f_to=non_negative("f_to", self.f_to),
            takes=positive("takes", self.takes),
            mass_radius=non_negative("mass_radius", self.mass_radius),
            amplitude=non_negative("amplitude", self.amplitude),
        )
        if (self.mass_radius > 0.0) == (self.amplitude > 0.0):
            raise InputError("a run-up has an unbalance or an amplitude, one of them")
        if self.f_from == self.f_to:
            raise InputError("a run-up goes from one speed to another; give frequency for one")

    @property
    def reaches(self) -> float:
        """Highest of its frequencies [Hz]."""
        return max(self.f_from, self.f_to)

    shows = reaches

    def speed(self, time: Float[Array, " times"]) -> Float[Array, " times"]:
        """Return the turns a second at some times [Hz]."""
        return np.interp(time, [0.0, self.takes], [self.f_from, self.f_to])

    def at(self, time: Float[Array, " times"], phase: float) -> Float[Array, " times"]:
        """Return the force; what the angle gains by the change of speed is in it."""
        within = np.clip(time, 0.0, self.takes)
        turns = self.f_from * np.minimum(time, self.takes)
        turns += 0.5 * (self.f_to - self.f_from) / self.takes * within**2
        turns += self.f_to * np.maximum(time - self.takes, 0.0)
        omega = 2.0 * np.pi * self.speed(time)
        size = self.mass_radius * omega**2 if self.mass_radius else self.amplitude
        return size * np.cos(2.0 * np.pi * (turns + phase))


@dataclass(frozen=True, kw_only=True)
class Strokes:
    """Blows of half a sine each, one or one every so often: presses, punches, dropped parts.

    Attributes
    ----------
    impulse : float
        Of one blow, downwards [N s].
    contact_time : float
        How long a blow lasts [s].
    every : float
        Time from one to the next [s]; infinity for a single one.
    first : float
        When the first falls [s].
    """

    impulse: float
    contact_time: float
    every: float = np.inf
    first: float = 0.0

    sudden = True

    def __post_init__(self) -> None:
        """Check times; blows may not overlap."""
        set_frozen(
            self,
            impulse=finite("impulse", self.impulse),
            contact_time=positive("contact_time", self.contact_time),
            first=non_negative("first", self.first),
        )
        if not self.every > self.contact_time:
            raise InputError(
                f"blows of {self.contact_time:g} s cannot follow each other every {self.every:g} s"
            )

    @property
    def reaches(self) -> float:
        """Where the spectrum of a blow is 0 for the first time: ``1.5 / contact_time`` [Hz]."""
        return 1.5 / self.contact_time

    @property
    def shows(self) -> float:
        """How fast blows follow each other; of a short one what a step can show is left."""
        return 0.0 if np.isinf(self.every) else 0.8 / self.every

    def at(self, time: Float[Array, " times"], phase: float) -> Float[Array, " times"]:
        """Return what steps show of the force; the phase puts off all blows by part of a period.

        Every blow keeps its impulse and its time: what lies above 0.46 of the sampling frequency
        is taken off, so that samples hold the rest as it is, however short the blow.
        """
        dt = float(time[1] - time[0])
        middle = self._blows(float(time[-1]) + _REACH * dt, phase) + 0.5 * self.contact_time
        late, shape = self._as_shown(dt)
        reach = int(np.ceil(late[-1] / dt)) + 1
        out = np.zeros(len(time))
        nearest = np.round((middle - time[0]) / dt).astype(int)
        at = nearest[:, None] + np.arange(-reach, reach + 1)
        inside = (at >= 0) & (at < len(time))
        since = time[0] + at * dt - middle[:, None]
        np.add.at(out, at[inside], np.interp(since[inside], late, shape, left=0.0, right=0.0))
        return out

    def _blows(self, ends: float, phase: float) -> Float[Array, " blows"]:
        """Return when blows begin, until some time [s]."""
        if np.isinf(self.every):
            return np.array([self.first])
        first = self.first + phase * self.every
        return first + self.every * np.arange(max(0.0, np.floor((ends - first) / self.every) + 1))

    def _as_shown(self, dt: float) -> tuple[Float[Array, " fine"], Float[Array, " fine"]]:
        """Return one blow about its middle, without what steps cannot show: times, and forces."""
        fine = dt / _FINE
        n = int(np.ceil(0.5 * self.contact_time / fine)) + 1
        edges = np.clip((np.arange(-n, n + 2) - 0.5) * fine / self.contact_time, -0.5, 0.5)
        given = 0.5 * self.impulse * np.diff(np.sin(np.pi * edges))  # impulse of each fine step
        u = np.arange(-_REACH * _FINE, _REACH * _FINE + 1) / _FINE
        low = 2.0 * _CUT * np.sinc(2.0 * _CUT * u) * np.kaiser(len(u), _KAISER)
        low /= low.sum() / _FINE * dt  # a blow's sum over steps is its impulse
        shape = np.convolve(given, low)
        half = len(shape) // 2
        return fine * np.arange(-half, half + 1), shape
