"""Moving loads, masses and vehicles on beams: V1, V2, V3 and V5 of the verification list.

The floor's own beam element carries the beam, and the contact solver the vehicle: what is
checked is what production uses.

Sources: L. Fryba, Vibration of Solids and Structures under Moving Loads (1972), 1.3 (V1, closed
form by 21 odd modes); the other values were computed independently of this project with a
high-order solver on 15 to 20 modes.
"""

import numpy as np
import pytest

from models import simple_beam
from trundle.road import Profile
from trundle.route import Ramp, Route, SteadyAcceleration
from trundle.simulate import Coupled, Crossing, Decoupled, Modal, ModalRatio, Newmark, ensemble
from trundle.vehicle import Axle, Body, build_vehicle, damping_coefficient, sprung_mass

UNDAMPED = ModalRatio(ratio=0.0)
G = 9.81


def cross(beam, length, vehicle, method, *, duration, speed=None, law=None, road=None):
    """Drive over the beam from rest at x = 0 and return the runs at midspan."""
    route = Route.straight((0, 0), (length, 0), speed=speed or 1.0)
    if law is not None:
        route = Route(points=route.points, law=law)
    # a ramp so short that it ends before the first step; at the support it does no work anyway
    entry = Ramp(length=1e-9 * length)
    crossing = Crossing(
        vehicle=vehicle, route=route, road=road or Profile.smooth(), entry=entry, run_in=0.0
    )
    return ensemble(
        beam, crossing, method=method, points={"mid": (length / 2, 0.0)}, n_runs=1, seed=0,
        duration=duration,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("alpha", "factor"),
    [
        (0.05, 1.04825), (0.20, 1.06527), (0.25, 1.25761), (0.40, 1.61289), (0.50, 1.70545),
        (0.61704, 1.73167), (0.70, 1.72040), (0.80, 1.67617), (1.00, 1.54807), (1.50, 1.02383),
        (2.00, 0.67097),
    ],
)  # fmt: skip
@pytest.mark.parametrize("integration", ["modal", "newmark"])
def test_v1_moving_force(alpha, factor, integration):
    """Dynamic amplification at midspan while the force is on the beam, within 0.1 %."""
    length = rigidity = line_mass = 1.0
    beam = simple_beam(length=length, rigidity=rigidity, line_mass=line_mass, n_elements=32)
    speed = alpha * np.pi
    steps = 2000
    dt = length / speed / steps
    method = Modal(f_max=400.0, dt=dt) if integration == "modal" else Newmark(dt=dt)
    force = sprung_mass(mass=1.0, stiffness=1.0)
    runs = cross(
        beam, length, force, Decoupled(integration=method, damping=UNDAMPED),
        duration=length / speed, speed=speed,
    )  # fmt: skip
    static = 1.0 * G * length**3 / (48 * rigidity)
    assert -runs.displacement.min() / static == pytest.approx(factor, rel=1e-3)


def test_v1_cancellation_after_the_exit():
    """At alpha = 0.2 the free vibration after the exit vanishes; at 0.5 it is 1.31015."""
    beam = simple_beam(length=1.0, rigidity=1.0, line_mass=1.0, n_elements=32)
    for alpha, factor in ((0.2, 0.0), (0.5, 1.31015), (2.0, 0.94890)):
        speed = alpha * np.pi
        dt = 1.0 / speed / 2000
        runs = cross(
            beam, 1.0, sprung_mass(mass=1.0, stiffness=1.0),
            Decoupled(integration=Modal(f_max=400.0, dt=dt), damping=UNDAMPED),
            duration=1.0 / speed + 1.0, speed=speed,
        )  # fmt: skip
        after = runs.displacement[0, 2001:, 0]
        assert np.abs(after).max() / (G / 48) == pytest.approx(factor, abs=2e-3)


V2_BEAM = {"length": 25.0, "rigidity": 3.5e10 * 1.3901, "line_mass": 18358.0}


@pytest.mark.parametrize(
    ("acceleration", "deflection", "time", "force"),
    [(0.0, 0.46191e-3, 0.4228, 32.38e3), (10.0, 0.46832e-3, 0.4125, None)],
)
def test_v2_damped_sprung_mass_over_a_ramp(acceleration, deflection, time, force):
    """Largest midspan deflection within 0.3 %, and where it is.

    The largest contact force stands at the ramp's kink, where it jumps; it is not compared.
    """
    beam = simple_beam(**V2_BEAM, n_elements=30)
    length = V2_BEAM["length"]
    vehicle = sprung_mass(mass=5750.0, stiffness=1595e3, damping=400e3)
    road = Profile.piecewise_linear([0.0, length / 3, length / 2, length], [0.0, 0.0, 0.01, 0.01])
    method = Coupled(integration=Modal(f_max=1000.0, dt=2.5e-4), damping=UNDAMPED)
    law = SteadyAcceleration(initial=25.0, acceleration=acceleration)
    duration = law.time_to(length) * 0.999
    runs = cross(beam, length, vehicle, method, duration=duration, law=law, road=road)
    u = -runs.displacement[0, :, 0]
    assert u.max() == pytest.approx(deflection, rel=3e-3)
    assert runs.time[u.argmax()] == pytest.approx(time, abs=2e-3)
    if force is not None:
        assert runs.contact_forces.min() == pytest.approx(force, rel=0.01)


@pytest.mark.parametrize(
    ("ratio", "alpha", "factor"),
    [
        (0.1, 0.1, 1.0759), (0.1, 0.25, 1.2872), (0.1, 0.5, 1.7629), (0.1, 0.75, 1.8035),
        (0.5, 0.1, 1.0722), (0.5, 0.25, 1.4179), (0.5, 0.5, 2.0221), (0.5, 0.75, 2.2310),
    ],
)  # fmt: skip
def test_v3_moving_mass(ratio, alpha, factor):
    """A mass on a spring so stiff that it follows the beam: all convective terms, within 1 %."""
    beam = simple_beam(length=1.0, rigidity=1.0, line_mass=1.0, n_elements=24)
    speed = alpha * np.pi
    dt = 1.0 / speed / 4000
    stiffness = ratio * (60 * np.pi**2) ** 2  # 60 times the beam's first frequency
    vehicle = sprung_mass(mass=ratio, stiffness=stiffness)
    runs = cross(
        beam, 1.0, vehicle, Coupled(integration=Modal(f_max=400.0, dt=dt), damping=UNDAMPED),
        duration=1.0 / speed, speed=speed,
    )  # fmt: skip
    static = ratio * G / 48.0
    assert -runs.displacement.min() / static == pytest.approx(factor, rel=0.01)


def v5_truck():
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


@pytest.mark.parametrize(
    ("kind", "kmh", "deflection", "rms"),
    [
        (Coupled, 15, 2.12153e-3, 867.05e-6),
        (Decoupled, 15, 2.12954e-3, 829.24e-6),
        (Coupled, 40, 2.13315e-3, 1739.64e-6),
        (Decoupled, 40, 2.14967e-3, 1846.96e-6),
    ],
)
def test_v5_container_truck_on_a_beam(kind, kmh, deflection, rms):
    """Deflection within 0.5 %, RMS velocity within 2 %; static loads as printed.

    The peak acceleration of an undamped beam grows with the modes kept, and is not compared.
    """
    truck = v5_truck()
    np.testing.assert_allclose(truck.static_forces, [52876, 121546, 224747], rtol=1e-5)
    beam = simple_beam(**V2_BEAM, n_elements=32)
    speed = kmh / 3.6
    duration = (25.0 + 13.048) / speed
    f_16 = 16.5**2 * 25.7078 / (2 * np.pi)  # sixteen modes
    method = kind(integration=Modal(f_max=f_16, dt=duration / 6000), damping=UNDAMPED)
    runs = cross(beam, 25.0, truck, method, duration=duration, speed=speed)
    assert runs.displacement.min() == pytest.approx(-deflection, rel=5e-3)
    assert runs.record_rms_velocity()[0, 0] == pytest.approx(rms, rel=0.02)
