"""V5: the paper's container truck on a beam, decoupled and coupled.

Values computed independently with 16 modes and 6001 samples. The beam is undamped and the axles'
arrivals excite every mode, so peak accelerations belong to those 16 modes alone: the same modes
are kept here, nothing stands for the rest, and the mesh of 128 elements and the time step are so
fine that the sixteenth mode (1047 Hz) keeps its phase over the crossing. Tolerances: 0.5 % on
displacement, 2 % on RMS velocity and on peak acceleration.
"""

import numpy as np
import pytest
from crossings import V2_BEAM, V2_F1, cross, undamped

from models import simple_beam
from trundle.simulate import Coupled, Decoupled
from trundle.vehicle import Axle, Body, build_vehicle, damping_coefficient

CASE = "V5"
SOURCE = "ODE solver, 16 modes (verification list)"
FINER = 8  # steps to a sample
STATICS = (52.876, 121.546, 224.747)  # kN
# method, km/h: largest deflection [mm], RMS velocity [um/s], peak acceleration [gal]
LISTED = {
    (Coupled, 15): (2.12153, 867.05, 4.864), (Decoupled, 15): (2.12954, 829.24, 4.114),
    (Coupled, 40): (2.13315, 1739.64, 11.671), (Decoupled, 40): (2.14967, 1846.96, 12.263),
}  # fmt: skip


def truck():
    mass, length = 35.30e3, 9.0
    springs = (1.306667e6, 1.809231e6, 3.618462e6)
    loads, ratios = (5390.0, 12390.0, 22910.0), (0.1, 0.02, 0.02)
    places = (0.0, 4.048, 13.048)
    return build_vehicle(
        name="V5",
        bodies=(
            Body(mass=loads[0]),
            Body(
                mass=mass,
                pitch_inertia=mass * 12.19**2 / 12,
                centre=places[1] + loads[2] / mass * length,
            ),
        ),
        axles=tuple(
            Axle(
                body=min(i, 1), setback=places[i], stiffness=springs[i],
                damping=damping_coefficient(ratios[i], springs[i], loads[i]),
            )
            for i in range(3)
        ),
    )  # fmt: skip


def test_static_loads(record):
    for i, force in enumerate(STATICS):
        computed = truck().static_forces[i] / 1e3
        record.row(f"static load of axle {i + 1}", force, computed, unit="kN", rtol=1e-5)


@pytest.mark.parametrize(("kind", "kmh"), LISTED)
def test_container_truck_on_a_beam(record, kind, kmh):
    deflection, rms, peak = LISTED[kind, kmh]
    beam = simple_beam(**V2_BEAM, n_elements=128)
    speed = kmh / 3.6
    duration = (25.0 + 13.048) / speed
    method = undamped(kind, f_max=16.5**2 * V2_F1, dt=duration / 6000 / FINER, residual=False)
    runs = cross(beam, 25.0, truck(), method, duration=duration, speed=speed)
    name = f"{kind.__name__.lower()}, {kmh} km/h"
    u = -1e3 * runs.displacement.min()
    record.row(f"{name}, largest deflection", deflection, u, unit="mm", rtol=5e-3)
    velocity = 1e6 * np.sqrt(np.mean(runs.velocity[:, ::FINER] ** 2))
    record.row(f"{name}, RMS velocity", rms, velocity, unit="um/s", rtol=0.02)
    acceleration = 100 * np.abs(runs.acceleration[:, ::FINER]).max()
    record.row(f"{name}, peak acceleration", peak, acceleration, unit="gal", rtol=0.02)
