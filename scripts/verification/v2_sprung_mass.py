"""V2: a sprung mass with a damper on a beam, over a ramp, at steady and at rising speed.

Equations of `beam`: 20 modes, one body, one wheel; the road rises by a straight line from 0 at L/3
to 10 mm at L/2 and is level on both sides. ``x = v0 t + a t^2 / 2``. All is read at 4001 even times
over the crossing, of which that on the kink at L/2 counts as behind it.
"""

from __future__ import annotations

import numpy as np

from verification.beam import GRAVITY, Beam, Car, Histories, cross
from verification.value import Value

BEAM = Beam(length=25.0, rigidity=3.5e10 * 1.3901, line_mass=18358.0, n_modes=20)
MASS, STIFFNESS, DAMPING, SPEED = 5750.0, 1595e3, 400e3, 25.0
# acceleration: largest deflection [mm], its time [s], least and largest force [kN]
PRINTED = {
    0.0: ("0.46191", "0.4228", "32.38", "79.92"),
    10.0: ("0.46832", "0.4125", "28.73", "83.29"),
}


def ramp(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return height and slope of the road."""
    third, half = BEAM.length / 3, BEAM.length / 2
    slope = 0.01 / (half - third)
    height = np.clip((x - third) * slope, 0.0, 0.01)
    return height, np.where((x >= third) & (x < half), slope, 0.0)


def drive(acceleration: float) -> Histories:
    """Cross once."""

    def place(t: float) -> tuple[float, float]:
        return SPEED * t + 0.5 * acceleration * t * t, SPEED + acceleration * t

    def time_to(x: float) -> float:
        # in this form an acceleration of zero is no special case
        return 2 * x / (SPEED + np.sqrt(SPEED**2 + 2 * acceleration * x))

    car = Car(
        mass=np.array([[MASS]]), rows=np.ones((1, 1)), stiffness=np.array([STIFFNESS]),
        damping=np.array([DAMPING]), static=np.array([MASS * GRAVITY]), setback=np.zeros(1),
    )  # fmt: skip
    end = time_to(BEAM.length)
    breaks = np.array([time_to(BEAM.length / 3), time_to(BEAM.length / 2)])
    return cross(BEAM, car, time=np.linspace(0.0, end, 4001), place=place, breaks=breaks, road=ramp)


def values() -> list[Value]:
    """Return the case's values."""
    found = [
        Value(case="V2", quantity="first angular frequency", printed="25.7078",
              computed=BEAM.omega[0], unit="rad/s"),
    ]  # fmt: skip
    for acceleration, (deflection, when, least, largest) in PRINTED.items():
        runs = drive(acceleration)
        u = -1e3 * runs.displacement
        # the last sample stands on the far support, as the wheel leaves
        forces = runs.forces[:-1, 0] / 1e3
        for name, printed, computed, unit in (
            ("largest midspan deflection", deflection, u.max(), "mm"),
            ("its time", when, runs.time[u.argmax()], "s"),
            ("least contact force", least, forces.min(), "kN"),
            ("largest contact force", largest, forces.max(), "kN"),
        ):
            quantity = f"{name}, {acceleration:g} m/s2"
            found.append(
                Value(case="V2", quantity=quantity, printed=printed, computed=computed, unit=unit)
            )
    return found
