"""V1: a constant force moving over a simply supported Bernoulli-Euler beam.

Closed form by 21 odd modes, L. Fryba, Vibration of Solids and Structures under Moving Loads
(1972), section 1.3. The floor's own beam element carries the beam, so what is checked is what
production uses. Tolerance 0.1 %: the sum over modes is truncated after 21, the mesh of 32
cubic elements and the 2000 steps are finer than that.
"""

import numpy as np
import pytest
from crossings import UNDAMPED, G, cross, undamped

from models import simple_beam
from trundle.simulate import Decoupled, Newmark
from trundle.vehicle import sprung_mass

CASE = "V1"
SOURCE = "Fryba (1972), 1.3"
FACTORS = {
    0.05: 1.04825, 0.20: 1.06527, 0.25: 1.25761, 0.40: 1.61289, 0.50: 1.70545, 0.61704: 1.73167,
    0.70: 1.72040, 0.80: 1.67617, 1.00: 1.54807, 1.50: 1.02383, 2.00: 0.67097,
}  # fmt: skip
AFTER_THE_EXIT = {0.2: 0.0, 0.5: 1.31015, 1.0: 1.54807, 2.0: 0.94890}


def unit_beam():
    return simple_beam(length=1.0, rigidity=1.0, line_mass=1.0, n_elements=32)


def method(integration, dt):
    if integration == "modal":
        return undamped(Decoupled, f_max=400.0, dt=dt)
    return Decoupled(integration=Newmark(dt=dt), damping=UNDAMPED)


@pytest.mark.parametrize(("alpha", "factor"), FACTORS.items())
@pytest.mark.parametrize("integration", ["modal", "newmark"])
def test_amplification_while_the_force_is_on(record, alpha, factor, integration):
    speed = alpha * np.pi
    runs = cross(
        unit_beam(), 1.0, sprung_mass(mass=1.0, stiffness=1.0),
        method(integration, 1.0 / speed / 2000), duration=1.0 / speed, speed=speed,
    )  # fmt: skip
    computed = -runs.displacement.min() / (G / 48)
    record.row(f"DAF at alpha = {alpha:g}, {integration}", factor, computed, rtol=1e-3)


@pytest.mark.parametrize(("alpha", "factor"), AFTER_THE_EXIT.items())
def test_free_vibration_after_the_exit(record, alpha, factor):
    """At alpha = 0.2 it cancels; what is left is 0.1 % of the static deflection at most."""
    speed = alpha * np.pi
    runs = cross(
        unit_beam(), 1.0, sprung_mass(mass=1.0, stiffness=1.0), method("modal", 1.0 / speed / 2000),
        duration=1.0 / speed + 1.0, speed=speed,
    )  # fmt: skip
    peak = np.abs(runs.displacement[0, 2001:, 0]).max() / (G / 48)
    tolerance = {"rtol": 1e-3} if factor else {"atol": 1e-3}
    record.row(f"free vibration after alpha = {alpha:g}", factor, peak, **tolerance)
