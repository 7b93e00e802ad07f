"""Raise the doubts about a vehicle that a result must carry with it."""

from __future__ import annotations

import numpy as np

from trundle.errors import FitnessWarning
from trundle.simulate.sources.crossing import Crossing
from trundle.vehicle import Vehicle

__all__ = ["axle_hop_warnings"]

_HOP = (8.0, 15.0)  # Hz; where the wheels of lorries and cars hop on their tyres


def axle_hop_warnings(crossings: tuple[Crossing, ...]) -> tuple[FitnessWarning, ...]:
    """Return the doubt about vehicles whose wheels cannot hop.

    A wheel between suspension and tyre hops at 8 to 15 Hz, where the generic vibration criteria
    are strictest. A vehicle without unsprung masses presses on the floor there with what its
    bodies let through.

    Parameters
    ----------
    crossings : tuple of Crossing
        What drove.

    Returns
    -------
    tuple of FitnessWarning
        One for each vehicle in question; none for a vehicle with suspensions of its own, or
        whose highest natural frequency reaches 8 Hz.
    """
    vehicles = {crossing.driven.name: crossing.driven for crossing in crossings}
    return tuple(
        _cannot_hop(vehicle, float(vehicle.natural_frequencies()[-1]))
        for vehicle in vehicles.values()
        if not _is_sprung(vehicle) and vehicle.natural_frequencies()[-1] < _HOP[0]
    )


def _is_sprung(vehicle: Vehicle) -> bool:
    """Return True where springs are left when the ground is taken away: suspensions."""
    left = np.asarray(vehicle.free_system.stiffness)
    return bool(np.abs(left).max() > 1e-9 * np.abs(np.asarray(vehicle.system.stiffness)).max())


def _cannot_hop(vehicle: Vehicle, highest: float) -> FitnessWarning:
    return FitnessWarning(
        subject=f"axle hop, {vehicle.name}",
        message=f"this vehicle has no unsprung masses and moves by itself at {highest:.3g} Hz at "
        f"most; axles that hop at {_HOP[0]:g} to {_HOP[1]:g} Hz press harder there, and margins "
        "that those bands govern may be 1.3 to 3 times too high; drive one with unsprung masses "
        "too: 'trundle vehicles' lists them, or give the axles an axle_mass and a tyre_stiffness",
    )
