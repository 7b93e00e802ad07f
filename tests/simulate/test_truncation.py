"""What is said of the modes left out."""

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.road import RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    Newmark,
    Rayleigh,
    ensemble,
    lay_out,
    truncation_change,
)
from trundle.vehicle import container_truck_40ft

POINTS = {"a": (3.0, 3.0), "b": (7.3, 1.9)}
DURATION, SEED = 3.0, 5


def way():
    return Crossing(
        container_truck_40ft(), Route.straight((0.0, 3.0), (12.0, 3.0), speed=7.0),
        RoadClass("B"), band=RoughnessBand(n_min=0.05, n_max=2.0), entry=DriveIn(length=2.0),
    )  # fmt: skip


def rms(values):
    return np.sqrt(np.mean(values**2, axis=(0, 1)))


@pytest.mark.parametrize("kind", [Coupled, Decoupled])
@pytest.mark.parametrize("residual", [True, False])
@pytest.mark.parametrize("f_max", [100.0, 230.0])
def test_fewer_modes_are_what_a_floor_prepared_with_them_gives(kind, residual, f_max):
    """Two ways to leave modes out: of a layout, and of the floor from the start.

    Steps of 4 ms reach to 125 Hz: to 230 Hz and to 138 Hz some modes are not stepped.
    """
    floor = small_floor(mesh_size=2.0)
    settings = {"points": POINTS, "duration": DURATION}
    full, fewer = (
        kind(integration=Modal(f_max=f, dt=0.004, residual=residual)) for f in (f_max, 0.6 * f_max)
    )
    runs = ensemble(floor, way(), method=full, n_runs=2, seed=SEED, **settings)
    other = ensemble(floor, way(), method=fewer, n_runs=2, seed=SEED, **settings)
    layout = lay_out(floor, way(), method=full, **settings)
    change = truncation_change(layout, runs, range(2), share=0.6)
    assert change.f_max == pytest.approx(0.6 * f_max)
    for name in ("velocity", "acceleration"):
        a, b = getattr(other, name), getattr(runs, name)
        np.testing.assert_allclose(getattr(change, name), rms(a - b) / rms(b), rtol=1e-6)


def test_the_estimate_is_of_the_size_of_what_further_modes_change():
    """Against a basis that reaches four times as far: no more than twice the estimate."""
    floor = small_floor(mesh_size=1.0)
    settings = {"points": POINTS, "duration": DURATION}
    few, many = (Coupled(integration=Modal(f_max=f, dt=0.001)) for f in (90.0, 360.0))
    runs = ensemble(floor, way(), method=few, n_runs=2, seed=SEED, **settings)
    true = ensemble(floor, way(), method=many, n_runs=2, seed=SEED, **settings)
    layout = lay_out(floor, way(), method=few, **settings)
    change = truncation_change(layout, runs, range(2))
    for name in ("velocity", "acceleration"):
        error = rms(getattr(true, name) - getattr(runs, name)) / rms(getattr(true, name))
        assert np.all(getattr(change, name) < 1.0)
        assert np.all(error < 2.0 * getattr(change, name))


def test_direct_integration_leaves_no_modes_out():
    method = Decoupled(integration=Newmark(dt=0.01), damping=Rayleigh(alpha=0.8, beta=0.001))
    settings = {"points": POINTS, "duration": 1.0}
    floor = small_floor(mesh_size=2.0)
    runs = ensemble(floor, way(), method=method, n_runs=1, seed=SEED, **settings)
    with pytest.raises(InputError, match="no modes out"):
        truncation_change(lay_out(floor, way(), method=method, **settings), runs, range(1))
