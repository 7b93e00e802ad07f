"""V3: a moving mass with all convective terms, as the limit of a stiff sprung mass.

Values computed independently with 15 modes. Two more methods stand beside them: the ODE of the
rigid mass, with and without its Coriolis and centrifugal terms, gives both printed columns; and
the contact solver must tend to the column with all terms as the spring stiffens. Tolerance 1 %:
15 modes truncate the centrifugal term, and the spring is 60 times the beam's first frequency.
"""

import navier
import numpy as np
import pytest
from crossings import G, cross, undamped

from models import simple_beam
from trundle.simulate import Coupled
from trundle.vehicle import sprung_mass

CASE = "V3"
SOURCE = "ODE solver, 15 modes (verification list)"
FACTORS = {
    (0.1, 0.1): (1.0759, 1.0842), (0.1, 0.25): (1.2872, 1.3038), (0.1, 0.5): (1.7629, 1.7540),
    (0.1, 0.75): (1.8035, 1.7136), (0.5, 0.1): (1.0722, 1.0998), (0.5, 0.25): (1.4179, 1.4739),
    (0.5, 0.5): (2.0221, 1.8844), (0.5, 0.75): (2.2310, 1.7539),
}  # fmt: skip
TRACK = navier.beam(length=1.0, rigidity=1.0, line_mass=1.0, n_modes=15)


def stiff_crossing(ratio, alpha, stiffening, *, steps=4000):
    """Return midspan over static deflection under a mass on a spring so many times stiffer."""
    beam = simple_beam(length=1.0, rigidity=1.0, line_mass=1.0, n_elements=24)
    speed = alpha * np.pi
    stiffness = ratio * (stiffening * np.pi**2) ** 2
    runs = cross(
        beam, 1.0, sprung_mass(mass=ratio, stiffness=stiffness),
        undamped(Coupled, f_max=400.0, dt=1.0 / speed / steps), duration=1.0 / speed, speed=speed,
    )  # fmt: skip
    return -runs.displacement[0, :, 0] / (ratio * G / 48)


@pytest.mark.parametrize(("ratio", "alpha"), FACTORS)
def test_moving_mass(record, ratio, alpha):
    computed = stiff_crossing(ratio, alpha, 60.0).max()
    name = f"DAF, mass ratio {ratio:g}, alpha = {alpha:g}"
    record.row(name, FACTORS[ratio, alpha][0], computed, rtol=0.01)


@pytest.mark.parametrize("convective", [True, False])
@pytest.mark.parametrize(("ratio", "alpha"), [(0.1, 0.5), (0.5, 0.25), (0.5, 0.75)])
def test_the_terms_that_make_the_difference(record, ratio, alpha, convective):
    """The rigid mass's own equation gives both columns, so the printed values are understood."""
    _, u = navier.rigid_mass(TRACK, mass=ratio, speed=alpha * np.pi, convective=convective)
    terms = "all terms" if convective else "no convective terms"
    record.row(
        f"rigid mass equation, {terms}, ratio {ratio:g}, alpha = {alpha:g}",
        FACTORS[ratio, alpha][0 if convective else 1], -u.min() / (ratio * G / 48), rtol=1e-3,
    )  # fmt: skip


def test_a_stiffening_spring_tends_to_the_rigid_mass(record):
    """The mass lags by the spring's deflection: the whole history's error falls as 1 / k."""
    ratio, alpha = 0.5, 0.5
    _, u = navier.rigid_mass(TRACK, mass=ratio, speed=alpha * np.pi, n_samples=4001)
    rigid = -u / (ratio * G / 48)
    stiffening = np.array([5.0, 10.0, 20.0, 40.0])
    histories = [stiff_crossing(ratio, alpha, s) for s in stiffening]
    errors = [np.linalg.norm(h - rigid) / np.linalg.norm(rigid) for h in histories]
    record.convergence(
        "sprung mass to rigid mass, whole history", stiffening**2, errors, order=-1.0,
        tolerance=0.2, figure="stiffness", y_label="error of the displacement, RMS", last=3,
        x_label="contact stiffness / (mass x first frequency squared)",
    )  # fmt: skip
