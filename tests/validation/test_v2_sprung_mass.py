"""V2: a sprung mass with a damper on a beam, over a ramp profile, steady and accelerating.

Values computed independently of this project with 20 modes at rtol 1e-8. The largest and
smallest contact forces stand at the ramp's kinks, where the force jumps; the source reads them at
4001 even times, and so does this test. Tolerance 0.3 %.
"""

import navier
import numpy as np
import pytest
from crossings import V2_BEAM, cross, kirchhoff_plate, undamped

from models import simple_beam
from trundle.road import Profile
from trundle.route import SteadyAcceleration
from trundle.simulate import Coupled
from trundle.vehicle import sprung_mass

CASE = "V2"
SOURCE = "ODE solver, 20 modes (verification list)"
FINER = 16  # steps to a sample: the slope over a kink is a mean over a step, which is then narrow
# The source's sample at the kink lies behind it; half a step keeps all of ours there.
ROAD = Profile.piecewise_linear(
    [0.0, 25.0 / 3, 12.5 - 2.2e-4, 25.0], [0.0, 0.0, 0.01, 0.01], beyond="level"
)
# acceleration: largest deflection [mm], its time [s], least and largest contact force [kN]
LISTED = {0.0: (0.46191, 0.4228, 32.38, 79.92), 10.0: (0.46832, 0.4125, 28.73, 83.29)}


def drive(acceleration):
    vehicle = sprung_mass(mass=5750.0, stiffness=1595e3, damping=400e3)
    law = SteadyAcceleration(initial=25.0, acceleration=acceleration)
    dt = law.time_to(25.0) / 4000 / FINER
    method = undamped(Coupled, f_max=1600.0, dt=dt)
    beam = simple_beam(**V2_BEAM, n_elements=40)
    return cross(beam, 25.0, vehicle, method, duration=(4000 * FINER - 1) * dt, law=law, road=ROAD)


@pytest.mark.parametrize("acceleration", LISTED)
def test_damped_sprung_mass_over_a_ramp(record, acceleration):
    deflection, time, *forces = LISTED[acceleration]
    runs = drive(acceleration)
    u = -1e3 * runs.displacement[0, :, 0]
    name = "steady" if acceleration == 0.0 else "at 10 m/s2"
    record.row(f"largest midspan deflection, {name}", deflection, u.max(), unit="mm", rtol=3e-3)
    when = runs.time[u.argmax()]
    record.row(f"time of it, {name}", time, when, unit="s", atol=5e-4)
    sampled = runs.contact_forces[:, ::FINER] / 1e3
    low, high = sampled.min(), sampled.max()
    record.row(f"least contact force, {name}", forces[0], low, unit="kN", rtol=3e-3)
    record.row(f"largest contact force, {name}", forces[1], high, unit="kN", rtol=3e-3)


def test_sprung_mass_on_a_plate(record):
    """The same contact on a plate, against its sine modes and a general ODE solver.

    A mass of a tenth of the plate on a spring tuned to the first mode: coupling moves the
    deflection by 9 %. Tolerance 0.5 %, that of V4, for mesh and modes.
    """
    length = width = 8.5
    thickness, speed = 0.2, 8.0
    rigidity = 30e9 * thickness**3 / 12 / (1 - 0.2**2)
    track = navier.plate(
        length=length, width=width, rigidity=rigidity, area_mass=500.0, n_x=24, n_y=24
    )
    mass = 0.1 * 500.0 * length * width
    stiffness, damping = mass * (2 * np.pi * 8.8758) ** 2, 1.5e4
    time = np.linspace(0.0, length / speed, 1001)
    car = navier.one_mass(mass=mass, stiffness=stiffness, damping=damping)
    wanted = navier.solve(track, car, time=time, place=lambda t: (speed * t, speed), rtol=1e-6)
    floor = kirchhoff_plate(length=length, width=width, thickness=thickness, mesh=length / 32)
    runs = cross(
        floor, length, sprung_mass(mass=mass, stiffness=stiffness, damping=damping),
        undamped(Coupled, f_max=300.0, dt=time[1]), duration=time[-1], speed=speed, y=width / 2,
    )  # fmt: skip
    source = "sine modes (24 x 12) and ODE solver, rtol 1e-6"
    for name, ours, theirs in (
        ("largest deflection", -runs.displacement.min() * 1e3, -wanted.displacement.min() * 1e3),
        ("RMS velocity", rms(runs.velocity) * 1e3, rms(wanted.velocity) * 1e3),
    ):
        unit = "mm" if "deflection" in name else "mm/s"
        record.row(f"plate, sprung mass, {name}", theirs, ours, unit=unit, rtol=5e-3, source=source)


def rms(values):
    return np.sqrt(np.mean(values**2))
