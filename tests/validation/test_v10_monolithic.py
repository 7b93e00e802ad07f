"""V10: a coupled crossing on a given road, against one system stepped by Runge and Kutta.

The production method drives the container truck over a road of 120 cosines (class B, 0.05 to 21.6
cycle/m: to 90 Hz at 15 km/h) and is read at two points. Beside it stands a solver of its own
(`monolithic.py`): modes by shift and invert, closed by Sylvester's count, its own interpolation
under the wheels, modes and vehicle in one state, classical Runge-Kutta steps of 0.25 ms, and band
levels by Fourier's transform. Its own error is below 1e-4: at half its step nothing changes by more.

On the reference unit both keep the modes below 90 Hz and nothing else, so that what differs is the
stepping. On a smaller plan, where every mode can be found, the method stands as it is by default:
modes to 112 Hz and the static flexibility of the rest, against modes to 800 Hz and theirs.

Tolerances are what is asked of a step of 5 ms: 1 % to 40 Hz and 3 % to 80 Hz. Levels are those of
velocity over the whole record, the same lines of both.
"""

from dataclasses import dataclass

import monolithic
import numpy as np
import pytest
from random_road import BANDS, band_rms, class_b
from scipy.linalg import eigh

from models import small_floor
from trundle.route import Route
from trundle.signals import nominal_frequency
from trundle.simulate import Coupled, Crossing, Decoupled, Modal, ensemble
from trundle.structure import reference_unit
from trundle.vehicle import container_truck_40ft, library_vehicle

CASE = "V10 crossing"
SOURCE = "Runge-Kutta of order 4 on the whole system, 0.25 ms"
SPEED = 15 / 3.6
RATIO = 0.03
FINE = 0.25e-3
RING_DOWN = 1.5  # s after the last wheel
WAVES = class_b(0.05, 90 / SPEED, n_waves=120, seed=3, fade=2.0)


@dataclass(frozen=True, kw_only=True)
class Case:
    floor: object
    length: float
    y: float
    points: dict
    vehicle: object
    coupled: bool = True

    @property
    def duration(self):
        return 5e-3 * round(((self.length + self.vehicle.length) / SPEED + RING_DOWN) / 5e-3)

    @property
    def crossing(self):
        far = SPEED * self.duration + 1.0
        route = Route.straight((0.0, self.y), (self.length, self.y), speed=SPEED)
        road = WAVES.profile(-self.vehicle.length - 1.0, far)
        return Crossing(vehicle=self.vehicle, route=route, road=road, run_in=0.0)

    def drive(self):
        entry = self.crossing.entry
        return monolithic.Drive(
            vehicle=self.vehicle, speed=SPEED, y=self.y, road=WAVES.at, coupled=self.coupled,
            share=lambda s: entry.share(s, self.length),
        )  # fmt: skip

    def expected(self, basis, *, step=FINE, rest=False):
        deck, places = monolithic.Deck(self.floor), list(self.points.values())
        motion = monolithic.integrate(
            deck, basis, self.drive(), points=places, duration=self.duration, dt=step,
            damping_ratio=RATIO,
        )  # fmt: skip
        if not rest:
            return motion
        return monolithic.with_static_rest(
            motion, deck, basis, self.drive(), stiffness=self.floor.stiffness, points=places
        )

    def computed(self, method):
        return ensemble(
            self.floor, self.crossing, method=method, points=self.points, n_runs=1, seed=0,
            duration=self.duration,
        )  # fmt: skip


def compare(record, runs, motion, *, name, tolerance, peak):
    """Compare peak and RMS on the same samples, and velocity levels band by band."""
    every = round(runs.dt / (motion.time[1] - motion.time[0]))
    for p, point in enumerate(runs.point_names):
        where = f"{name}, {point}"
        for quantity, unit, scale in (("velocity", "um/s", 1e6), ("acceleration", "gal", 100.0)):
            ours = scale * getattr(runs, quantity)[0, :, p]
            theirs = scale * getattr(motion, quantity)[::every, p][: len(ours)]
            record.row(
                f"{where}, peak {quantity}", np.abs(theirs).max(), np.abs(ours).max(), unit=unit,
                rtol=peak,
            )  # fmt: skip
            record.row(f"{where}, RMS {quantity}", rms(theirs), rms(ours), unit=unit, rtol=peak)
        ours = 1e6 * band_rms(runs.velocity[0, :, p], runs.dt)
        theirs = 1e6 * band_rms(motion.velocity[:, p], motion.time[1])
        for f, level, wanted in zip(BANDS, ours, theirs, strict=True):
            nominal = nominal_frequency(f)
            name = f"{where}, {nominal:g} Hz band"
            record.row(name, wanted, level, unit="um/s", rtol=tolerance(f))


def asked_for(f):
    return 0.01 if f < 45.0 else 0.03


def rms(values):
    return np.sqrt(np.mean(values**2))


@pytest.fixture(scope="module")
def unit():
    return Case(
        floor=reference_unit(mesh_size=2.0), length=52.0, y=76.5,
        points={"3.5 m beside": (32.5, 73.0), "two bays on": (19.5, 52.0)},
        vehicle=container_truck_40ft(),
    )  # fmt: skip


@pytest.fixture(scope="module")
def unit_basis(unit):
    return monolithic.modes_below(unit.floor.mass, unit.floor.stiffness, 90.0)


def semitrailer():
    """A documented truck with unsprung masses: stiff tyres, axle hop."""
    return library_vehicle("tractor_3axle_semitrailer_6_axle")


def small(vehicle, **changes):
    return Case(
        floor=small_floor(mesh_size=1.5), length=12.0, y=2.3,
        points={"beside": (4.2, 3.1), "next bay": (8.7, 4.2)}, vehicle=vehicle, **changes,
    )  # fmt: skip


def modes_below(floor, f_max):
    square, shapes = eigh(floor.stiffness.toarray(), floor.mass.toarray())
    kept = square < (2 * np.pi * f_max) ** 2
    return monolithic.Basis(omega=np.sqrt(square[kept]), shapes=shapes[:, kept])


@pytest.mark.longest
def test_reference_unit_at_the_default_step(record, unit, unit_basis):
    """The stepping alone: the same modes in both, nothing for the rest."""
    runs = unit.computed(Coupled(integration=Modal(f_max=90.0, dt=5e-3, residual=False)))
    motion = unit.expected(unit_basis)
    compare(record, runs, motion, name="reference unit, 5 ms", tolerance=asked_for, peak=0.01)
    forces = runs.contact_forces[0]
    dynamic = motion.forces[::20][: len(forces)] - unit.vehicle.static_forces
    for i, axle in enumerate(unit.vehicle.contact_names):
        error = rms(forces[:, i] - unit.vehicle.static_forces[i] - dynamic[:, i])
        record.row(
            f"reference unit, 5 ms, {axle}, contact force, RMS of the difference over RMS", 0.0,
            error / rms(dynamic[:, i]), atol=0.01,
        )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("vehicle", [container_truck_40ft, semitrailer])
@pytest.mark.parametrize("kind", [Coupled, Decoupled])
def test_small_plan_by_default(record, kind, vehicle):
    """The method as it is by default, its modes to 112 Hz and its step, against all there is."""
    case = small(vehicle(), coupled=kind is Coupled)
    motion = case.expected(modes_below(case.floor, 800.0), rest=True)
    method, axles = kind.__name__.lower(), case.vehicle.n_contacts
    compare(
        record, case.computed(kind()), motion, tolerance=asked_for, peak=0.03,
        name=f"small plan, {method}, {axles} axles",
    )  # fmt: skip


@pytest.mark.longest
def test_a_fine_step_leaves_nothing(record):
    """At 0.5 ms and with the same modes the two methods are one, to 0.1 % in every band."""
    case = small(container_truck_40ft())
    motion = case.expected(modes_below(case.floor, 90.0))
    runs = case.computed(Coupled(integration=Modal(f_max=90.0, dt=0.5e-3, residual=False)))
    name = "small plan, same modes, 0.5 ms"
    compare(record, runs, motion, name=name, tolerance=lambda _: 1e-3, peak=1e-3)


@pytest.mark.longest
def test_the_other_solver_has_converged(record):
    """Half its step changes no band by more than 1e-4."""
    case = small(container_truck_40ft())
    basis = modes_below(case.floor, 800.0)
    coarse, fine = (case.expected(basis, step=step).velocity for step in (FINE, FINE / 2))
    for p, point in enumerate(case.points):
        change = band_rms(coarse[:, p], FINE) / band_rms(fine[:, p], FINE / 2) - 1
        record.row(
            f"small plan, {point}, change of any band at half the step", 0.0,
            np.abs(change).max(), atol=1e-4, source="Runge-Kutta of order 4 against itself",
        )  # fmt: skip
