"""The block solver: its answers do not depend on how time and runs are cut."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from models import small_floor
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import DriveIn, Ramp, Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    ModalRatio,
    Newmark,
    Rayleigh,
    batches,
    ensemble,
    lay_out,
    mean_response,
)
from trundle.simulate.modal import block_march as march
from trundle.simulate.modal import kept_maps, powers
from trundle.simulate.modal.kept_maps import KeptMaps
from trundle.vehicle import container_truck_40ft, quarter_car

POINTS = {"a": (3.0, 3.0), "b": (7.3, 1.9)}


def way(vehicle=None, *, y=3.0, speed=7.0, name="way", entry=None, level="geometric_mean"):
    return Crossing(
        vehicle=vehicle or container_truck_40ft(),
        route=Route.straight((0.0, y), (12.0, y), speed=speed, name=name),
        road=RoadClass("B", level=level), band=RoughnessBand(n_min=0.05, n_max=2.0),
        entry=entry or DriveIn(length=2.0),
    )  # fmt: skip


def difference(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.mark.parametrize("kind", [Coupled, Decoupled])
@pytest.mark.parametrize("length", [1, 5, 64])
def test_any_length_of_block_gives_the_same(monkeypatch, kind, length):
    """One step at a time is the plain recursion; blocks only gather it: to round-off."""
    floor = small_floor(mesh_size=2.0)
    method = kind(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=0.02))
    settings = {"method": method, "points": POINTS, "n_runs": 3, "seed": 4, "duration": 3.1}
    reference = ensemble(floor, way(), **settings)
    monkeypatch.setattr(march, "block_length", lambda _: length)
    other = ensemble(floor, way(), **settings)
    for name in ("displacement", "velocity", "acceleration", "contact_forces"):
        assert difference(getattr(other, name), getattr(reference, name)) < 1e-9


@pytest.mark.parametrize("kind", [Coupled, Decoupled])
@pytest.mark.parametrize("room", [0.0, 1e5, 1e9])
def test_a_second_drive_over_a_layout_gives_the_same_bits(monkeypatch, kind, room):
    """It finds maps of blocks that the first formed: all, some, or none where there is no room."""
    monkeypatch.setattr(kept_maps, "_ROOM", room)
    method = kind(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=0.02))
    floor = small_floor(mesh_size=2.0)
    layout = lay_out(floor, way(), method=method, points=POINTS, duration=3.1)
    first, second = (next(batches(layout, runs=range(3), seed=4)) for _ in range(2))
    for name in ("displacement", "velocity", "acceleration", "contact_forces"):
        assert np.array_equal(getattr(first, name), getattr(second, name))


def test_maps_are_kept_while_there_is_room_and_travel_without(monkeypatch):
    """What is kept is not formed again; what has no room is; a copy elsewhere starts empty."""
    monkeypatch.setattr(kept_maps, "_ROOM", 100.0)
    kept, formed = KeptMaps(), []

    def form(number):
        formed.append(number)
        return (np.full(10, float(number)),)  # 80 bytes

    for number in (1, 2, 1, 2):
        assert kept.of(number, lambda number=number: form(number))[0][0] == number
    assert formed == [1, 2, 2]
    pickle.loads(pickle.dumps(kept)).of(1, lambda: form(1))
    assert formed == [1, 2, 2, 1]


def test_both_ways_to_carry_a_force_through_a_block_agree(monkeypatch):
    """A product over all pairs of steps, or lag by lag where damping forbids the way back."""
    floor = small_floor(mesh_size=2.0)
    for ratio, rtol in ((0.02, 1e-11), (0.5, 1e-9)):
        method = Coupled(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=ratio))
        settings = {"method": method, "points": POINTS, "n_runs": 2, "seed": 4, "duration": 3.0}
        monkeypatch.setattr(powers, "_MOST_DECAY", 60.0)
        at_once = ensemble(floor, way(), **settings)
        monkeypatch.setattr(powers, "_MOST_DECAY", 0.0)
        by_lags = ensemble(floor, way(), **settings)
        for name in ("displacement", "velocity", "acceleration", "contact_forces"):
            assert difference(getattr(at_once, name), getattr(by_lags, name)) < rtol


@pytest.mark.longest
def test_damping_that_kills_a_mode_within_a_step():
    """Rayleigh damping far beyond critical: against Newmark's method in all dofs, finely stepped."""
    floor = small_floor(mesh_size=2.0)
    damping = Rayleigh(alpha=0.0, beta=0.5)
    settings = {"points": POINTS, "n_runs": 1, "seed": 2, "duration": 2.5}
    modal, direct = (
        ensemble(floor, way(), method=Coupled(integration=step, damping=damping), **settings)
        for step in (Modal(f_max=300.0, dt=0.005), Newmark(dt=0.001))
    )
    every = direct.displacement[:, ::5]
    assert difference(modal.displacement, every) < 2e-2
    assert difference(modal.contact_forces, direct.contact_forces[:, ::5]) < 2e-2


@pytest.mark.longest
def test_a_coupled_block_is_the_floor_under_its_own_forces():
    """Coupled response = the response of the decoupled floor to the coupled contact forces.

    The floor's part of a block is formed twice, in the contact solution and at the points; here
    the forces are put onto the same floor by Newmark's method in all dofs, at a tenth of the step.
    """
    floor = small_floor(mesh_size=2.0)
    car = quarter_car(
        body_mass=4000.0, axle_mass=400.0, stiffness=4e5, damping=8e3, tyre_stiffness=2e6,
        tyre_damping=1e3,
    )  # fmt: skip
    crossing = way(car)
    damping = Rayleigh(alpha=0.5, beta=0.0005)
    settings = {"points": POINTS, "n_runs": 1, "seed": 2, "duration": 2.5}
    modal = ensemble(
        floor, crossing, method=Coupled(integration=Modal(f_max=300.0, dt=5e-4), damping=damping),
        **settings,
    )  # fmt: skip
    direct = ensemble(
        floor, crossing, method=Coupled(integration=Newmark(dt=5e-4), damping=damping), **settings
    )
    assert difference(modal.contact_forces, direct.contact_forces) < 2e-3
    assert difference(modal.velocity, direct.velocity) < 5e-3


def test_batches_are_parts_of_the_ensemble():
    """A run's road depends on its number alone: cut as you like, bits stay within a batch size."""
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    layout = lay_out(small_floor(mesh_size=2.0), way(), method=method, points=POINTS, duration=2.0)
    whole = next(batches(layout, runs=range(7), seed=3, batch=7))
    parts = list(batches(layout, runs=range(7), seed=3, batch=3))
    assert [part.n_runs for part in parts] == [3, 3, 1]
    joined = np.concatenate([part.acceleration for part in parts])
    assert difference(joined, whole.acceleration) < 1e-10
    later = next(batches(layout, runs=range(4, 7), seed=3))
    assert difference(later.acceleration, whole.acceleration[4:]) < 1e-10


def test_a_rougher_road_is_the_same_run_scaled_about_the_smooth_one():
    """Linearity: the upper limit's road is sqrt(2) times the mean's, wave by wave."""
    floor = small_floor(mesh_size=2.0)
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    settings = {"method": method, "points": POINTS, "duration": 2.5}
    layout = lay_out(floor, way(), **settings)
    runs = next(batches(layout, runs=range(3), seed=1))
    scaled = runs.on_scaled_road(mean_response(layout), np.sqrt(2.0))
    direct = ensemble(floor, way(level="upper"), **settings, n_runs=3, seed=1)
    for name in ("velocity", "acceleration", "contact_forces"):
        assert difference(getattr(scaled, name), getattr(direct, name)) < 1e-9


def test_vehicles_that_come_and_go_leave_blocks_without_wheels():
    """Two trucks, one long after the other: superposition of each alone, decoupled."""
    floor = small_floor(mesh_size=2.0)
    early, late = way(name="early", speed=12.0), way(name="late", y=1.0, speed=9.0)
    late = Crossing(
        vehicle=late.vehicle, route=late.route, road=late.road, band=late.band, entry=late.entry,
        depart=6.0,
    )  # fmt: skip
    method = Decoupled(integration=Modal(f_max=60.0, dt=0.01))
    settings = {"method": method, "points": POINTS, "n_runs": 2, "seed": 5, "duration": 10.0}
    both = ensemble(floor, [early, late], **settings).velocity
    alone = sum(ensemble(floor, one, **settings).velocity for one in (early, late))
    assert difference(both, alone) < 1e-9


def test_a_vehicle_that_departs_later_does_the_same_later():
    """The record of one that departs at 2 s is that of one that departs at once, 2 s behind."""
    floor, dt, late = small_floor(mesh_size=2.0), 0.01, 2.0
    method = Decoupled(integration=Modal(f_max=60.0, dt=dt))
    settings = {"method": method, "points": POINTS, "n_runs": 2, "seed": 5}
    now = ensemble(floor, way(), duration=4.0, **settings).velocity
    then = ensemble(floor, replace(way(), depart=late), duration=4.0 + late, **settings).velocity
    shift = round(late / dt)
    assert np.abs(then[:, : shift - 20]).max() < 1e-9 * np.abs(then).max()
    assert difference(then[:, shift:], now) < 1e-9


def test_smooth_road_and_ramp_make_no_variance():
    """Without roughness every run is the mean response."""
    floor = small_floor(mesh_size=2.0)
    crossing = Crossing(
        vehicle=container_truck_40ft(), route=Route.straight((0.0, 3.0), (12.0, 3.0), speed=7.0),
        road=Profile.smooth(), entry=Ramp(length=1.0),
    )  # fmt: skip
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    layout = lay_out(floor, crossing, method=method, points=POINTS, duration=2.0)
    runs = next(batches(layout, runs=range(2), seed=1))
    mean = mean_response(layout)
    np.testing.assert_allclose(runs.velocity[1], mean.velocity, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("kind", [Coupled, Decoupled])
def test_single_precision_keeps_four_digits(kind):
    """Against double precision: round-off of 6e-8 times e^5, what a way back over a frame loses."""
    floor = small_floor(mesh_size=2.0)
    settings = {"points": POINTS, "n_runs": 3, "seed": 4, "duration": 3.1}
    double, single = (
        ensemble(floor, way(), method=kind(integration=step), **settings)
        for step in (Modal(f_max=112.0, dt=0.005), Modal(f_max=112.0, dt=0.005, single=True))
    )
    for name in ("displacement", "velocity", "acceleration", "contact_forces"):
        apart = difference(getattr(single, name), getattr(double, name))
        assert 0.0 < apart < 1e-4 or (kind is Decoupled and name == "contact_forces")
        assert getattr(single, name).dtype == np.float64
