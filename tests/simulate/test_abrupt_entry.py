"""Loads that are put on at once: what they add does not grow with the road."""

import numpy as np
import pytest

from models import small_floor
from trundle.dynamics import ModalRatio
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import Abrupt, DriveIn, Route, entry_named
from trundle.simulate import Crossing, Decoupled, Modal, ensemble
from trundle.vehicle import container_truck_40ft

METHOD = Decoupled(integration=Modal(f_max=90.0, dt=0.005), damping=ModalRatio(ratio=0.03))


def velocities(entry, road):
    crossing = Crossing(
        container_truck_40ft(),
        Route.straight((0.0, 2.5), (12.0, 2.5), speed=15 / 3.6),
        road,
        band=RoughnessBand(n_max=2.83),
        entry=entry,
        run_in=5.0,
    )
    runs = ensemble(
        small_floor(), crossing, method=METHOD, points={"p": (6.0, 2.5)}, n_runs=4, seed=3
    )
    return runs.velocity[:, :, 0]


def test_a_sudden_load_adds_a_part_that_does_not_grow_with_the_road():
    """Linear: with the road of class B twice that of A (same seed), v_B - s = 2 (v_A - s)."""
    smooth = velocities(Abrupt(), Profile.smooth())[0]
    a, b = (velocities(Abrupt(), RoadClass(name)) - smooth for name in "AB")
    np.testing.assert_allclose(b, 2.0 * a, atol=1e-9 * np.abs(b).max())


def test_a_sudden_load_shakes_a_floor_that_a_truck_driving_in_does_not():
    """At the step an acceleration of F phi^2 / m appears, which no smooth entry has."""
    sudden, driven = (
        velocities(entry, Profile.smooth())[0] for entry in (Abrupt(), DriveIn(length=3.0))
    )
    jolt, rise = (np.abs(np.diff(v)).max() for v in (sudden, driven))
    assert jolt > 5.0 * rise
    assert np.abs(sudden).max() > 2.0 * np.abs(driven).max()


def test_its_words():
    assert str(Abrupt()) == "abrupt: each axle's whole load at once"
    with pytest.raises(TypeError):
        Abrupt(length=1.0)
    assert isinstance(entry_named("abrupt"), Abrupt)
