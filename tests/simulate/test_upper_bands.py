"""Forces, levels and limits up to 80 Hz at the production step."""

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.response import velocity_spectra
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
    contact_forces,
    ensemble,
    lay_out,
)
from trundle.simulate.step_limits import longest_step
from trundle.units import KMH
from trundle.vehicle import VEHICLES, quarter_car, sprung_mass

SPEED = 15 * KMH


def lorry():
    return quarter_car(
        body_mass=5000.0, axle_mass=600.0, stiffness=8e5, damping=1e4, tyre_stiffness=3e6,
        tyre_damping=1e3,
    )  # fmt: skip


@pytest.mark.parametrize("f", [4.0, 12.0, 20.0, 40.0, 63.0, 80.0])
@pytest.mark.parametrize("make", [lorry, VEHICLES["tractor_3axle_semitrailer_6_axle_worn"]])
def test_forces_of_a_sine_road_are_those_of_the_transfer_function(make, f):
    """Steady sine under every axle at 5 ms: amplitudes in closed form, 1 % to 40 Hz, 3 % to 80."""
    vehicle, n = make(), f / SPEED
    s = np.arange(-400.0, 150.0, 0.02 / n)
    road = Profile(
        station=s, elevation=1e-4 * np.sin(2 * np.pi * n * s),
        slope=2e-4 * np.pi * n * np.cos(2 * np.pi * n * s), beyond="level",
    )  # fmt: skip
    way = Crossing(vehicle, Route.straight((0, 0), (40, 0), speed=SPEED), road, run_in=80.0)
    _, forces = contact_forces(
        way, integration=Modal(f_max=112.0, dt=0.005), n_runs=1, seed=0, duration=9.0
    )
    dynamic = (forces[0] - vehicle.static_forces)[200:1700]
    expected = 1e-4 * np.abs(vehicle.contact_force_transfer(np.array([f]), speed=SPEED)[0])
    found = np.sqrt(2.0) * dynamic.std(axis=0)
    np.testing.assert_allclose(found, expected, rtol=0.01 if f <= 40.0 else 0.03)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [Coupled, Decoupled])
def test_levels_at_the_production_step_are_those_of_a_tenth_of_it(kind):
    """Band by band against 0.5 ms: 1 % to 40 Hz, 3 % to 80 Hz; straight steps gave 0.6 at 80 Hz."""
    floor = small_floor(mesh_size=1.5)
    way = Crossing(
        lorry(), Route.straight((0.0, 2.6), (12.0, 2.6), speed=SPEED), RoadClass("B"),
        band=RoughnessBand(n_min=0.05, n_max=22.0, contact_patch=0.05), entry=DriveIn(length=3.0),
    )  # fmt: skip
    coarse, fine = (
        ensemble(
            floor, way, method=kind(integration=Modal(f_max=112.0, dt=dt)), n_runs=4, seed=1,
            points={"a": (3.1, 3.3), "b": (9.0, 4.4)}, duration=8.0,
        )
        for dt in (0.005, 0.0005)
    )  # fmt: skip
    found, expected = (velocity_spectra(runs) for runs in (coarse, fine))
    assert found.resolved.all()
    ratio = (found.values / expected.values).mean(axis=0)
    low = found.mid_band < 41.0
    assert np.abs(ratio[:, low] - 1.0).max() < 0.01
    assert np.abs(ratio[:, ~low] - 1.0).max() < 0.03


def test_modes_above_half_the_sampling_frequency_do_not_fold_into_the_bands():
    """Modes to 180 Hz of a lightly damped floor at 5 ms, against 0.5 ms: 2 % in every band.

    Stepped, their resonances come back folded at 100: the 80 Hz band is 11 and 15 % too high.
    """
    floor, points = small_floor(mesh_size=1.5), {"a": (3.1, 3.3), "b": (9.0, 4.4)}
    way = Crossing(
        lorry(), Route.straight((0.0, 2.6), (12.0, 2.6), speed=SPEED), RoadClass("B"),
        band=RoughnessBand(n_min=0.05, n_max=22.0, contact_patch=0.05), entry=DriveIn(length=3.0),
    )  # fmt: skip
    found, expected = (
        velocity_spectra(
            ensemble(
                floor, way, n_runs=4, seed=1, points=points, duration=8.0,
                method=Decoupled(
                    integration=Modal(f_max=180.0, dt=dt), damping=ModalRatio(ratio=0.005)
                ),
            )
        ).values.mean(axis=0)
        for dt in (0.005, 0.0005)
    )  # fmt: skip
    np.testing.assert_allclose(found, expected, rtol=0.02)


def test_newmark_shows_what_its_dispersion_leaves():
    """Average acceleration shows at f what belongs to tan(pi f dt) / (pi dt): 1.9 % off at 0.075 / dt,
    15 Hz at 5 ms; the bands above are not resolved."""
    method = Decoupled(integration=Newmark(dt=0.005), damping=Rayleigh(alpha=0.5, beta=1e-3))
    way = Crossing(
        lorry(), Route.straight((0.0, 2.6), (12.0, 2.6), speed=7.0), RoadClass("B"),
        band=RoughnessBand(n_min=0.05, n_max=2.0),
    )  # fmt: skip
    runs = ensemble(
        small_floor(mesh_size=2.0), way, method=method, points={"p": (3, 3)}, n_runs=1, seed=1,
        duration=3.0,
    )  # fmt: skip
    assert runs.f_max == pytest.approx(15.0)
    assert np.tan(np.pi * 0.075) / (np.pi * 0.075) - 1.0 < 0.02
    spectra = velocity_spectra(runs)
    assert spectra.mid_band[spectra.resolved].max() == pytest.approx(12.59, abs=0.01)


def test_a_vehicle_too_quick_for_its_steps_is_refused():
    """A 400 kg cart on solid tyres of 2 MN/m vibrates at 11.3 Hz if carried by them alone; of 50
    MN/m at 56 Hz: 0.45 / 56 = 8 ms. Beyond, steps used to grow to 1e46 m/s2."""
    cart = sprung_mass(mass=400.0, stiffness=50e6, damping=1e3)
    f = np.sqrt(50e6 / 400.0) / (2 * np.pi)
    assert longest_step(cart) == pytest.approx(0.45 / f, rel=1e-3)
    way = Crossing(
        cart, Route.straight((0.0, 2.6), (12.0, 2.6), speed=1.5), RoadClass("A"),
        band=RoughnessBand(n_min=0.05, n_max=2.0),
    )  # fmt: skip
    settings = {"points": {"p": (3.0, 3.0)}, "duration": 3.0}
    slow, quick = (Coupled(integration=Modal(f_max=15.0, dt=dt)) for dt in (0.025, 0.005))
    with pytest.raises(InputError, match="shorten dt to 8 ms"):
        lay_out(small_floor(mesh_size=2.0), way, method=slow, **settings)
    runs = ensemble(small_floor(mesh_size=2.0), way, method=quick, n_runs=1, seed=1, **settings)
    assert np.abs(runs.acceleration).max() < 10.0


def test_a_contact_that_would_grow_from_step_to_step_is_refused():
    """A stiff spring between a heavy wheel and a light floor: k / m dt^2 far above 12."""
    from trundle.structure import CONCRETE, ShellSection

    thin = small_floor(mesh_size=1.0, slab=ShellSection(thickness=0.02, material=CONCRETE))
    heavy = sprung_mass(mass=60000.0, stiffness=5e8, damping=1e5)
    way = Crossing(
        heavy, Route.straight((0.0, 2.6), (12.0, 2.6), speed=1.5), RoadClass("A"),
        band=RoughnessBand(n_min=0.05, n_max=2.0),
    )  # fmt: skip
    method = Coupled(integration=Modal(f_max=45.0, dt=0.01, residual=False))
    with pytest.raises(InputError, match="need a time step of at most"):
        lay_out(thin, way, method=method, points={"p": (3.0, 3.0)}, duration=8.0)
