"""V5: the container truck over a beam, decoupled and coupled.

Equations of `beam` with 16 modes. Bodies: the mass over axle 1 alone; one rigid body over axles 2
and 3, with lift and pitch about its centre of mass, which divides its wheelbase by the static
shares. All coordinates and rates are zero as axle 1 comes to x = 0; 6001 even samples to the time
at which axle 3 leaves. Decoupled, every axle presses with its static force.
"""

from __future__ import annotations

import numpy as np

from verification.beam import GRAVITY, Beam, Car, Histories, cross
from verification.value import Value

BEAM = Beam(length=25.0, rigidity=3.5e10 * 1.3901, line_mass=18358.0, n_modes=16)
LOADS, RATIOS = np.array([5390.0, 12390.0, 22910.0]), np.array([0.1, 0.02, 0.02])
STIFFNESS = np.array([1.306667e6, 1.809231e6, 3.618462e6])
SETBACK = np.array([0.0, 4.048, 13.048])
STATICS = ("52.876", "121.546", "224.747")
# km/h, coupled: largest deflection [mm], RMS velocity [um/s], peak acceleration [gal]
PRINTED = {
    (15, True): ("2.12153", "867.05", "4.864"), (15, False): ("2.12954", "829.24", "4.114"),
    (40, True): ("2.13315", "1739.64", "11.671"), (40, False): ("2.14967", "1846.96", "12.263"),
}  # fmt: skip


def truck() -> Car:
    """Return the truck: lift of body 1, lift and pitch of body 2 (positive lifts axle 2)."""
    mass, wheelbase = 35.30e3, SETBACK[2] - SETBACK[1]
    front = LOADS[2] / mass * wheelbase  # from axle 2 back to the centre of mass
    inertia = mass * 12.19**2 / 12
    return Car(
        mass=np.diag([LOADS[0], mass, inertia]),
        rows=np.array([[1.0, 0.0, 0.0], [0.0, 1.0, front], [0.0, 1.0, front - wheelbase]]),
        stiffness=STIFFNESS, damping=2 * RATIOS * np.sqrt(STIFFNESS * LOADS),
        static=GRAVITY * LOADS, setback=SETBACK,
    )  # fmt: skip


def drive(kmh: float, *, coupled: bool) -> Histories:
    """Cross once."""
    speed = kmh / 3.6
    breaks = np.concatenate([SETBACK, SETBACK + BEAM.length]) / speed
    end = (BEAM.length + SETBACK[-1]) / speed
    return cross(
        BEAM, truck(), time=np.linspace(0.0, end, 6001), breaks=breaks, coupled=coupled,
        place=lambda t: (speed * t, speed),
    )  # fmt: skip


def crossing_values(kmh: int, *, coupled: bool) -> list[Value]:
    """Return the values of one crossing."""
    runs = drive(kmh, coupled=coupled)
    computed = (
        -1e3 * runs.displacement.min(),
        1e6 * np.sqrt(np.mean(runs.velocity**2)),
        100 * np.abs(runs.acceleration).max(),
    )
    name = f"{'coupled' if coupled else 'decoupled'}, {kmh} km/h"
    kinds = (
        ("largest deflection", "mm", None, ""),
        ("RMS velocity", "um/s", None, ""),
        (
            "peak acceleration",
            "gal",
            2e-3,
            "the fourth digit of modes to 1 kHz is the solver's tolerance",
        ),
    )
    return [
        Value(case="V5", quantity=f"{name}, {quantity}", printed=printed, computed=float(value),
              unit=unit, tolerance=tolerance, note=note)
        for (quantity, unit, tolerance, note), printed, value in zip(
            kinds, PRINTED[kmh, coupled], computed, strict=True
        )
    ]  # fmt: skip


def values() -> list[Value]:
    """Return the case's values; a minute's work."""
    found = [
        Value(case="V5", quantity=f"static force of axle {i + 1}", printed=printed, unit="kN",
              computed=GRAVITY * LOADS[i] / 1e3)
        for i, printed in enumerate(STATICS)
    ]  # fmt: skip
    for kmh, coupled in PRINTED:
        found += crossing_values(kmh, coupled=coupled)
    return found
