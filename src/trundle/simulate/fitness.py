"""Raise the doubts that a result must carry with it."""

from __future__ import annotations

import numpy as np

from trundle._words import in_kmh
from trundle.errors import FitnessWarning
from trundle.road import FITTED_RANGE, RoadClass
from trundle.simulate.crossing import Crossing
from trundle.simulate.ground import PreparedFloor
from trundle.simulate.vehicle_fitness import axle_hop_warnings
from trundle.structure import ContactShape

__all__ = ["LOST_CONTACT", "contact_warnings", "fitness_warnings"]

LOST_CONTACT = "loss of contact"
"""Subject of the warning about wheels that would have to pull."""

_HARMONICS = 4  # multiples of V / h that the hat function excites noticeably
_NEAR = 0.05  # relative distance within which such a frequency counts as on a mode
_TOP_EDGE = 89.2  # Hz: where the 80 Hz band ends


def fitness_warnings(
    crossings: tuple[Crossing, ...], prepared: PreparedFloor, contact: ContactShape
) -> tuple[FitnessWarning, ...]:
    """Return the doubts about a method on a floor, whatever the road.

    Parameters
    ----------
    crossings : tuple of Crossing
        What drove.
    prepared : PreparedFloor
        The floor, as the method needs it.
    contact : ContactShape
        Interpolation of loads between nodes.
    """
    found = [
        *prepared.doubts(),
        *prepared.damping.doubts(),
        *axle_hop_warnings(crossings),
        *(warning for crossing in crossings for warning in _extrapolation(crossing)),
    ]
    if contact.kinks:
        found += [_mesh_passing(crossing, prepared) for crossing in crossings]
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


def _mesh_passing(crossing: Crossing, prepared: PreparedFloor) -> FitnessWarning:
    size = prepared.floor.surface(crossing.route.on).element_size
    speed = float(crossing.route.law.speed(0.0))
    passing = speed / size * np.arange(1, _HARMONICS + 1)
    note = f"hat functions of {size:.3g} m are passed at {speed / size:.3g} Hz and its multiples"
    if prepared.modes is not None:
        f = prepared.modes.frequencies[:, None]
        hits = np.unique(np.round(passing[(np.abs(f - passing) < _NEAR * f).any(axis=0)], 2))
        if hits.size:
            note += "; " + ", ".join(f"{hit:g} Hz" for hit in hits) + " lies on a mode"
    return FitnessWarning(subject=f"mesh passing, {crossing.route.name}", message=note)
