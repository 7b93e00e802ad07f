"""What is read off a run: motions that agree with each other, names, times, limits."""

import dataclasses

import numpy as np
import pytest

from models import small_floor
from trundle.response import BandSpectra, velocity_spectra
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    ModalRatio,
    Newmark,
    Rayleigh,
    Runs,
    contact_forces,
    ensemble,
    lay_out,
)
from trundle.units import KMH
from trundle.vehicle import quarter_car

DT = 0.002


def car(body=4000.0):
    return quarter_car(
        body_mass=body, axle_mass=400.0, stiffness=4e5, damping=8e3, tyre_stiffness=2e6,
        tyre_damping=1e3,
    )  # fmt: skip


def way(*, y=2.6, name="way", road=None, vehicle=None):
    s = np.linspace(-20.0, 40.0, 6001)
    sine = Profile(station=s, elevation=0.004 * np.sin(1.7 * s), slope=0.0068 * np.cos(1.7 * s))
    return Crossing(
        vehicle=vehicle or car(), route=Route.straight((0.0, y), (12.0, y), speed=8.0, name=name),
        road=road or sine, band=RoughnessBand(n_min=0.05, n_max=2.0), entry=DriveIn(length=2.0),
        run_in=4.0,
    )  # fmt: skip


def rms(values):
    return np.sqrt(np.mean(values**2))


@pytest.mark.parametrize("f_max", [12.0, 60.0])
@pytest.mark.parametrize("kind", [Coupled, Decoupled])
def test_acceleration_is_the_rate_of_velocity_and_that_of_displacement(kind, f_max):
    """By central differences; with 20 % damping, and with few modes, whose rest answers statically."""
    method = kind(integration=Modal(f_max=f_max, dt=DT), damping=ModalRatio(ratio=0.2))
    runs = ensemble(
        small_floor(mesh_size=1.5), way(), method=method, n_runs=1, seed=0, duration=2.0,
        points={"under the wheel": (6.0, 2.6), "beside": (7.0, 4.0)},
    )  # fmt: skip
    # the wheel leaves at once, which differences over two steps smear
    for rate, motion, tolerance in (
        ("velocity", "displacement", 0.05),
        ("acceleration", "velocity", 0.08),
    ):
        differences = np.gradient(getattr(runs, motion)[0], DT, axis=0)[2:-2]
        values = getattr(runs, rate)[0, 2:-2]
        assert rms(differences - values) < tolerance * rms(values)


def test_few_modes_with_their_rest_carry_a_wheel_like_all_dofs():
    """Contact forces on a thin slab: the residual under the wheels brings them to the full floor's."""
    from trundle.structure import CONCRETE, ShellSection

    floor = small_floor(mesh_size=1.5, slab=ShellSection(thickness=0.08, material=CONCRETE))
    damping = Rayleigh(alpha=1.0, beta=5e-4)
    settings = {"points": {"p": (3.0, 3.0)}, "n_runs": 1, "seed": 0, "duration": 1.7}
    heavy = way(vehicle=car(body=12000.0))
    full = ensemble(
        floor, heavy, method=Coupled(integration=Newmark(dt=DT), damping=damping), **settings
    ).contact_forces
    errors = {}
    for residual in (True, False):
        modal = Modal(f_max=12.0, dt=DT, residual=residual)
        method = Coupled(integration=modal, damping=damping)
        errors[residual] = rms(
            ensemble(floor, heavy, method=method, **settings).contact_forces - full
        )
    assert errors[True] < 0.25 * errors[False]


def test_the_last_wheel_leaves_at_the_exit_time():
    crossing = way()
    truck = dataclasses.replace(crossing, vehicle=long_car())
    travelled = truck.lead + truck.route.law.distance(truck.exit_time)
    assert travelled - truck.vehicle.setback[-1] == pytest.approx(truck.route.length)


def long_car():
    from trundle.vehicle import library_vehicle

    return library_vehicle("tractor_3axle_semitrailer_6_axle_worn")


def test_every_route_has_a_road_of_its_own():
    settings = {"integration": Modal(f_max=1.0, dt=0.01), "n_runs": 1, "seed": 4, "duration": 2.0}
    one, other, again = (
        contact_forces(way(name=name, road=RoadClass("B")), **settings)[1]
        for name in ("north", "south", "north")
    )
    assert np.array_equal(one, again)
    assert abs(np.corrcoef(one[0, :, 0], other[0, :, 0])[0, 1]) < 0.6


def test_a_wheel_beside_the_centre_line_drives_there():
    """A vehicle shifted to the left on a route is the vehicle on a route shifted to the left."""
    method = Coupled(integration=Modal(f_max=40.0, dt=0.005))
    settings = {
        "method": method,
        "points": {"p": (6.0, 4.5)},
        "n_runs": 1,
        "seed": 1,
        "duration": 1.5,
    }
    shifted = dataclasses.replace(car(), lateral=np.array([1.25]))
    floor = small_floor(mesh_size=2.0)
    left = ensemble(floor, way(y=2.0, vehicle=shifted), **settings).velocity
    route = ensemble(floor, way(y=3.25), **settings).velocity
    np.testing.assert_allclose(left, route, atol=1e-12 * np.abs(route).max())


def made_up(acceleration, *, f_max=50.0, fs=200.0):
    values = np.asarray(acceleration, float)[None, :, None]
    return Runs(
        time=np.arange(values.shape[1]) / fs, displacement=values, velocity=values,
        acceleration=values, contact_forces=np.ones_like(values), point_names=("p",),
        contact_names=("c",), seed=0, method="", f_max=f_max,
    )  # fmt: skip


def test_a_peak_has_no_sign():
    assert made_up([0.0, 1.0, -3.0, 2.0]).peak_acceleration()[0, 0] == 3.0


def test_bands_are_resolved_up_to_their_upper_edge():
    """The 10 Hz band ends at 11.22 Hz: modes to 11 Hz do not show it, modes to 11.5 Hz do."""
    sine = np.sin(2 * np.pi * 5 * np.arange(2000) / 200.0)
    for f_max, seen in ((11.0, False), (11.5, True)):
        spectra = velocity_spectra(made_up(sine, f_max=f_max))
        band = np.argmin(np.abs(spectra.mid_band - 10.0))
        assert spectra.resolved[band] == seen
        assert np.isfinite(spectra.values[0, 0, band]) == seen


def test_a_percentile_of_spectra_covers_that_share_of_runs():
    spectra = BandSpectra(
        mid_band=np.array([10.0]), values=np.arange(101.0)[:, None, None], averaging="event",
        times=np.zeros((101, 1, 1)),
        resolved=np.array([True]), point_names=("p",),
    )  # fmt: skip
    assert spectra.percentile(95.0)[0, 0] == pytest.approx(95.0)


@pytest.mark.parametrize(("f_max", "dt", "reach"), [(400.0, 0.01, 45.0), (30.0, 0.01, 24.0)])
def test_a_computation_reaches_to_its_modes_or_its_time_step(f_max, dt, reach):
    """0.45 of the sampling frequency: what filters that complete a motion are fitted to; and 0.8
    of the modes, whose neighbours above answer more than their statics say."""
    method = Decoupled(integration=Modal(f_max=f_max, dt=dt))
    layout = lay_out(small_floor(mesh_size=2.0), way(), method=method, points={"p": (3.0, 3.0)})
    assert layout.f_max == reach


def test_thirty_six_kilometres_an_hour():
    assert pytest.approx(10.0) == 36.0 * KMH


def test_the_run_in_lets_the_slowest_motion_decay_to_five_per_cent():
    crossing = dataclasses.replace(way(), run_in=None)
    decay = np.exp(-crossing.vehicle.decay_rates().min() * crossing.run_in_time)
    assert decay == pytest.approx(0.05, rel=0.01)
