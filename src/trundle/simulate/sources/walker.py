"""Make people who walk sources of vibration: forces of known shape that move along a way."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._checks import count, non_negative, positive, set_frozen, within
from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.errors import FitnessWarning, InputError
from trundle.footfall import FootfallLoad
from trundle.route import Route, Track
from trundle.signals import TOP_FREQUENCY
from trundle.simulate.sources.random_road import run_generator
from trundle.simulate.sources.source import KnownForces
from trundle.structure import ContactShape, Structure

__all__ = ["Gait", "StandsAt", "Walker"]

_SHOWN = 0.4  # of the sampling frequency, up to which a step shows a wave
_PLACES_A_METRE = 50  # of a way, where the dofs under it are looked for
_STEPS_TO_BEGIN = 2.0  # over which a force comes on, and goes off again
_TOP = 1.125 * TOP_FREQUENCY  # Hz: behind the end of the 80 Hz band


@dataclass(frozen=True, kw_only=True)
class Gait:
    """Hold how people walk, and how they differ from one another.

    Attributes
    ----------
    pace : float
        Steps a second, the mean of all [Hz].
    weight : float
        Mean weight [N].
    pace_spread, weight_spread : float
        Standard deviation between people over the mean; drawn anew for everybody in every run.
    step_scatter : float
        Standard deviation of single steps' durations over their mean.
    random_phase : bool
        Whether the first step of everybody falls at a random time of a step, or all at once.
    """

    pace: float
    weight: float
    pace_spread: float = 0.0
    weight_spread: float = 0.0
    step_scatter: float = 0.0
    random_phase: bool = True

    def __post_init__(self) -> None:
        """Check every number."""
        set_frozen(
            self,
            pace=within("pace", self.pace, 0.5, 5.0, remedy="steps a second"),
            weight=positive("weight", self.weight),
            pace_spread=within("pace_spread", self.pace_spread, 0.0, 0.3),
            weight_spread=within("weight_spread", self.weight_spread, 0.0, 0.5),
            step_scatter=within("step_scatter", self.step_scatter, 0.0, 0.2),
        )

    @property
    def varies(self) -> bool:
        """Whether anything of it is random."""
        spread = self.pace_spread + self.weight_spread + self.step_scatter
        return self.random_phase or spread > 0.0


@dataclass(frozen=True, kw_only=True)
class StandsAt:
    """Hold a place where somebody walks to and fro, or on the spot.

    Attributes
    ----------
    x, y : float
        The place on its surface [m].
    on : str or None
        Name of the surface; None for the only one.
    lasts : float
        How long it lasts [s].
    """

    x: float
    y: float
    on: str | None = None
    lasts: float = 10.0

    def __post_init__(self) -> None:
        """Check the time."""
        set_frozen(self, lasts=positive("lasts", self.lasts))


@dataclass(frozen=True, kw_only=True, eq=False)
class Walker(KnownForces):
    """People who walk along a way one behind the other, or stay at a place.

    Everybody is one force that moves with walking speed, not single footprints, pressing with the
    load function of a guide. The steady weight is left out: it moves far too slowly to shake
    anything from 1 Hz on.

    Attributes
    ----------
    name : str
        Name; what is random depends on the seed, this name and the run alone.
    load : FootfallLoad
        Load function of a guide.
    gait : Gait
        How they walk.
    where : Route or StandsAt
        Their way with its walking speed, or the place where they stay.
    people : int
        How many.
    headway : float
        Time between them [s].
    depart : float
        When the first begins [s].
    f_max : float
        Frequency to which impulses continue the guide's harmonics [Hz].
    """

    name: str
    load: FootfallLoad
    gait: Gait
    where: Route | StandsAt
    people: int = 1
    headway: float = 2.0
    depart: float = 0.0
    f_max: float = _TOP
    complete = False

    def __post_init__(self) -> None:
        """Check counts and times."""
        set_frozen(
            self,
            people=count("people", self.people),
            headway=non_negative("headway", self.headway),
            depart=non_negative("depart", self.depart),
            f_max=positive("f_max", self.f_max),
        )
        if isinstance(self.where, Route):
            if self.where.surfaces:
                raise InputError(f"walker {self.name!r}: a way lies on one surface")
            if not np.isfinite(self.where.law.time_to(self.where.length)):
                raise InputError(f"walker {self.name!r} never reaches the end of the way")

    @property
    def varies(self) -> bool:
        """Whether its forces differ from run to run."""
        return self.gait.varies

    @property
    def on(self) -> str | None:
        """Name of the surface."""
        return self.where.on

    @property
    def lasts(self) -> float:
        """How long each of them walks [s]."""
        if isinstance(self.where, StandsAt):
            return self.where.lasts
        return float(self.where.law.time_to(self.where.length))

    @property
    def leaves(self) -> float:
        """Time at which the last has left [s]."""
        return self.depart + (self.people - 1) * self.headway + self.lasts

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Name of what everybody presses with."""
        if self.people == 1:
            return ("feet",)
        return tuple(f"feet {i + 1}" for i in range(self.people))

    def later(self, by: float) -> Walker:
        """Return the same people, put off by some time [s]."""
        return replace(self, depart=self.depart + by)

    def _clocks(self, time: Float[Array, " times"]) -> Float[Array, "times people"]:
        """Return how long each has walked at some times [s]; negative before."""
        return time[:, None] - self.depart - self.headway * np.arange(self.people)

    def track(self, time: Float[Array, " times"], begins: float) -> Track:
        """Return where they are."""
        del begins
        clock = self._clocks(time)
        there = ((clock >= 0.0) & (clock <= self.lasts)).astype(float)
        if isinstance(self.where, StandsAt):
            place = np.broadcast_to([self.where.x, self.where.y], (*clock.shape, 2))
            direction, speed = np.broadcast_to([1.0, 0.0], place.shape), np.zeros_like(clock)
        else:
            law = self.where.law
            held = np.clip(clock, 0.0, self.lasts)
            station = np.clip(law.distance(held.ravel()), 0.0, self.where.length)
            place, direction = (a.reshape(*clock.shape, 2) for a in self.where.locate(station))
            speed = law.speed(held.ravel()).reshape(clock.shape) * there
        return Track(
            on=self.on, place=place, direction=direction, speed=speed, share=there,
            share_slope=np.zeros_like(clock),
        )  # fmt: skip

    def way(self) -> Iterator[tuple[Float[Array, "places 2"], Float[Array, "places 2"]]]:
        """Give places all along the way, with directions.

        Yields
        ------
        tuple of ndarray, shape (n_places, 2)
            Places [m], and unit directions.
        """
        if isinstance(self.where, StandsAt):
            yield np.array([[self.where.x, self.where.y]]), np.array([[1.0, 0.0]])
            return
        length = self.where.length
        yield self.where.locate(np.linspace(0.0, length, _PLACES_A_METRE * int(length) + 2))

    def inputs(self, time: Float[Array, " times"], begins: float, seed: int) -> WalkerInputs:
        """Return what they press on the floor with."""
        del begins
        return WalkerInputs(self, self._clocks(time), seed)

    def excited_to(self, ends: float) -> float:
        """Return where the guide's harmonics end [Hz]; its impulses go on to the top."""
        del ends
        own = self.load.highest(self.gait.pace)
        return own if self.load.impulse is None else max(own, self.f_max)

    def check(self, dt: float, duration: float | None) -> tuple[FitnessWarning, ...]:
        """Refuse a step that does not show the guide's own harmonics."""
        del duration
        highest = self.load.highest(self.gait.pace * (1.0 + 3.0 * self.gait.pace_spread))
        if highest > _SHOWN / dt:
            raise InputError(
                f"walker {self.name!r}: harmonics to {highest:.3g} Hz, and steps of "
                f"{1e3 * dt:g} ms show {_SHOWN / dt:.3g} Hz at most: shorten dt to "
                f"{1e3 * _SHOWN / highest:.2g} ms"
            )
        return ()

    def doubts(
        self, structure: Structure, modes: Modes | None, contact: ContactShape
    ) -> tuple[FitnessWarning, ...]:
        """Return what a result must say of people."""
        del structure, modes, contact
        load, pace = self.load, self.gait.pace
        low, high = load.paces
        said = f"{load.title}; confidence: {load.confidence}"
        if load.impulse is None:
            said += f"; nothing is excited above {load.highest(pace):.3g} Hz"
        else:
            said += (
                f"; above {load.highest(pace):.3g} Hz every step gives the guide's effective "
                "impulse, at a steady pace unless step_scatter is given"
            )
        found = [FitnessWarning(subject=f"walker, {self.name}", message=said)]
        if not low <= pace <= high:
            message = (
                f"{pace:.3g} steps a second are outside the {low:g} to {high:g} that the guide "
                "is for; load factors are those at the nearest end"
            )
            found.append(FitnessWarning(subject=f"pace, {self.name}", message=message))
        return tuple(found)


class WalkerInputs:
    """What people press on a floor with, about their weight."""

    def __init__(self, walker: Walker, clock: Float[Array, "times people"], seed: int) -> None:
        self._walker, self._clock, self._seed = walker, clock, seed
        self._shown = min(walker.f_max, _SHOWN / float(clock[1, 0] - clock[0, 0]))

    def draw(self, run: int) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return the forces of a run [N], and no heights."""
        rng = run_generator(self._seed, self._walker.name, run)
        people = range(self._clock.shape[1])
        forces = np.stack([self._force(self._clock[:, i], rng) for i in people], axis=1)
        return forces, np.zeros(forces.shape[1])

    def still(self) -> tuple[Float[Array, "times contacts"], Float[Array, " contacts"]]:
        """Return those of a run in which everybody is the mean, or nothing where any is random."""
        if self._walker.varies:
            return np.zeros_like(self._clock), np.zeros(self._clock.shape[1])
        return self.draw(0)

    def _force(self, clock: Float[Array, " times"], rng: np.random.Generator) -> Array:
        """Return the force of one of them: harmonics of a phase that counts their steps."""
        gait, load = self._walker.gait, self._walker.load
        normal = np.clip(rng.standard_normal(2), -3.0, 3.0)
        pace = gait.pace * (1.0 + gait.pace_spread * normal[0])
        weight = gait.weight * (1.0 + gait.weight_spread * normal[1])
        first = rng.random() if gait.random_phase else 0.0
        steps = first + _steps_done(clock, pace, gait.step_scatter, self._walker.lasts, rng)
        n = load.n_harmonics(pace, self._shown)
        series = load.amplitudes(pace, n, weight=weight) * np.exp(1j * load.phases(n))
        turning = np.exp(2j * np.pi * steps)
        pressed = np.real(turning * np.polynomial.polynomial.polyval(turning, series))
        return pressed * _on_and_off(clock, self._walker.lasts, _STEPS_TO_BEGIN / pace)


def _steps_done(
    clock: Array, pace: float, scatter: float, lasts: float, rng: np.random.Generator
) -> Float[Array, " times"]:
    """Return how many steps somebody has done, parts of them in proportion to time."""
    if scatter == 0.0:
        return pace * clock
    n = int(np.ceil(1.5 * lasts * pace)) + 8
    durations = (1.0 + scatter * np.clip(rng.standard_normal(n), -3.0, 3.0)) / pace
    at = np.concatenate([[0.0], np.cumsum(durations)])
    return np.interp(clock, at, np.arange(n + 1.0))


def _on_and_off(clock: Array, lasts: float, over: float) -> Float[Array, " times"]:
    """Return a factor that rises to 1 within some time and falls again at the end, smoothly."""
    over = min(over, 0.5 * lasts)
    nearest = np.clip(np.minimum(clock, lasts - clock) / over, 0.0, 1.0)
    return 0.5 - 0.5 * np.cos(np.pi * nearest)
