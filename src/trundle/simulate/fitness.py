"""Raise the doubts that a result must carry with it."""

from __future__ import annotations

import numpy as np

from trundle._words import in_kmh
from trundle.dynamics import TOP, Modal, Modes, Newmark, Rayleigh
from trundle.errors import FitnessWarning
from trundle.road import FITTED_RANGE, RoadClass
from trundle.signals import TOP_FREQUENCY
from trundle.simulate.crossing import Crossing, Integration, Interaction
from trundle.simulate.vehicle_fitness import axle_hop_warnings
from trundle.structure import Floor

__all__ = ["LOST_CONTACT", "contact_warnings", "fitness_warnings", "resolved_to"]

LOST_CONTACT = "loss of contact"
"""Subject of the warning about wheels that would have to pull."""

_MODES_BEYOND = 1.25  # times a band's upper edge must the modes reach, for 3 % in its level
_NEWMARK = 0.075  # of the sampling frequency, that Newmark's method shows as it is
_HARMONICS = 4  # multiples of V / h that the hat function excites noticeably
_NEAR = 0.05  # relative distance within which such a frequency counts as on a mode
_TOP_EDGE = 89.2  # Hz: where the 80 Hz band ends
_HEAVY = 0.10  # damping ratio above which Rayleigh damping suppresses what it should show


def fitness_warnings(
    crossings: tuple[Crossing, ...],
    method: Interaction,
    floor: Floor,
    modes: Modes | None,
) -> tuple[FitnessWarning, ...]:
    """Return the doubts about a method on a floor, whatever the road.

    Parameters
    ----------
    crossings : tuple of Crossing
        What drove.
    method : Decoupled or Coupled
        How it was computed.
    floor : Floor
        The floor.
    modes : Modes or None
        Modes used, where the method used modes.
    """
    found = [
        *_time_step(method),
        *_truncation(method),
        *_rayleigh(method),
        *axle_hop_warnings(crossings),
        *(warning for crossing in crossings for warning in _extrapolation(crossing)),
    ]
    if method.contact.kinks:
        found += [w for crossing in crossings for w in _mesh_passing(crossing, floor, modes)]
    return tuple(dict.fromkeys(found))


def contact_warnings(share: float) -> tuple[FitnessWarning, ...]:
    """Return the doubt about runs in which a wheel would pull on the floor.

    Parameters
    ----------
    share : float
        Share of such runs, 0 to 1.
    """
    if share == 0.0:
        return ()
    return (
        FitnessWarning(
            subject=LOST_CONTACT,
            message=f"a wheel would pull on the floor in {_percent(share)} % of the runs; "
            "the linear vehicle cannot lift off, so those runs are not what would happen",
        ),
    )


def _percent(share: float) -> str:
    """Write a share as people do: 0.4, 12, 100."""
    return f"{100.0 * share:.1f}" if share < 0.01 else f"{100.0 * share:.0f}"


def resolved_to(integration: Integration) -> float:
    """Return the highest frequency that modes and step show as it is [Hz].

    Modes are right to 0.45 of the sampling frequency (`dynamics.sampling`) and ``f_max / 1.25``:
    those above answer statically, and the nearest of them do more. On the reference unit the 80 Hz
    band, which ends at 89 Hz, was up to 30 % off with modes to 90 Hz, 7 % with modes to 100 Hz, 3 %
    to 112 Hz, 2 % to 125 Hz; the 63 Hz band with modes to 90 Hz 1.5 %. Newmark's average
    acceleration shows at f what belongs to ``tan(pi f dt) / (pi dt)``: by ``(pi f dt)^2 / 3`` too
    low. Levels follow: at 5 ms they were 0.85 of the right ones at 25 Hz, 0.27 at 80 Hz. Up to
    0.075 of the sampling frequency the shift is below 1.9 % and levels are within 5 %.
    """
    if isinstance(integration, Modal):
        return min(integration.f_max / _MODES_BEYOND, TOP / integration.dt)
    return _NEWMARK / integration.dt


def _time_step(method: Interaction) -> list[FitnessWarning]:
    dt, top = method.integration.dt, TOP_FREQUENCY
    newmark = isinstance(method.integration, Newmark)
    shown = (_NEWMARK if newmark else TOP) / dt
    if shown > top:
        return []
    extra = ""
    if newmark:
        # Period of average acceleration, verification case V8: omega_num = 2/dt atan(omega dt/2)
        x = np.pi * 10.0 * dt
        extra = (
            f"; its Newmark step stretches a 10 Hz period by {100 * (x / np.arctan(x) - 1):.0f} %"
        )
    return [
        FitnessWarning(
            subject="time step",
            message=f"dt = {1e3 * dt:g} ms shows frequencies to {shown:.3g} Hz as they are; bands "
            f"that reach above are not assessed{extra}",
        )
    ]


def _truncation(method: Interaction) -> list[FitnessWarning]:
    if not isinstance(method.integration, Modal):
        return []
    top = method.integration.f_max
    return [
        FitnessWarning(
            subject="modal truncation",
            message=f"modes above {top:g} Hz are left out; they follow the wheels without delay "
            "(static residual flexibility), not with their own resonance: levels to "
            f"{top / _MODES_BEYOND:.3g} Hz were within 3 % on the reference unit, and bands that "
            "reach above are not assessed",
        )
    ]


def _rayleigh(method: Interaction) -> list[FitnessWarning]:
    if not isinstance(method.damping, Rayleigh):
        return []
    f = np.array([10.0, 20.0, 40.0, 80.0])
    ratios = method.damping.ratios(2.0 * np.pi * f)
    if ratios.max() < _HEAVY:
        return []
    text = ", ".join(f"{100 * z:.2g} % at {x:g} Hz" for x, z in zip(f, ratios, strict=True))
    return [FitnessWarning(subject="damping", message=f"Rayleigh damping grows: {text}")]


def _extrapolation(crossing: Crossing) -> list[FitnessWarning]:
    if not isinstance(crossing.road, RoadClass):
        return []
    speed = float(crossing.route.law.speed(0.0))
    n_max = crossing.band.n_max
    if n_max > FITTED_RANGE[1] * (1 + 1e-9):
        message = (
            f"waves to {n_max:.3g} cycle/m are beyond ISO 8608's fitted range "
            f"({FITTED_RANGE[1]:g}); the road above {speed * FITTED_RANGE[1]:.3g} Hz at "
            f"{in_kmh(speed)} is extrapolated"
        )
    else:
        message = (
            f"waves end at {n_max:.3g} cycle/m, which is {speed * n_max:.3g} Hz at "
            f"{in_kmh(speed)}; the road excites nothing above it, and bands there are not "
            f"assessed: n_max = {_TOP_EDGE / speed:.3g} 1/m with a contact patch reaches 80 Hz"
        )
    return [FitnessWarning(subject=f"roughness band, {crossing.route.name}", message=message)]


def _mesh_passing(crossing: Crossing, floor: Floor, modes: Modes | None) -> list[FitnessWarning]:
    size = _element_size(floor)
    speed = float(crossing.route.law.speed(0.0))
    passing = speed / size * np.arange(1, _HARMONICS + 1)
    note = f"hat functions of {size:.3g} m are passed at {speed / size:.3g} Hz and its multiples"
    if modes is not None:
        f = modes.frequencies[:, None]
        hits = np.unique(np.round(passing[(np.abs(f - passing) < _NEAR * f).any(axis=0)], 2))
        if hits.size:
            note += "; " + ", ".join(f"{hit:g} Hz" for hit in hits) + " lies on a mode"
    return [FitnessWarning(subject=f"mesh passing, {crossing.route.name}", message=note)]


def _element_size(floor: Floor) -> float:
    groups = floor.shells or floor.beams
    ends = floor.nodes[groups[0].elements[:, :2]]
    return float(np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))
