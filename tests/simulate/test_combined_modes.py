"""Crossings on few combinations of modes, against the same on all of them."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from towers import tower
from trundle.dynamics import ModalRatio
from trundle.road import RoadClass
from trundle.route import Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    harmonics,
    lay_out,
    prepare,
)
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.structure import Spot
from trundle.vehicle import library_vehicle

F_MAX = 40.0
POINTS = {"near": Spot(x=5.0, y=2.0, on="level 2"), "below": Spot(x=21.0, y=4.0, on="level 1")}


@functools.cache
def building():
    return tower(storeys=3, bays_x=12, bays_y=2, mesh_size=1.5)


@functools.cache
def modes():
    return building().modes(F_MAX)


def crossing():
    route = replace(Route.straight((0.0, 3.0), (12.0, 3.0), speed=4.0), on="level 2")
    return Crossing(library_vehicle("forklift_fl3_laden"), route, RoadClass("B"))


def laid_out(kind, tolerance):
    method = kind(
        integration=Modal(f_max=F_MAX, dt=0.01, response_tolerance=tolerance),
        damping=ModalRatio(ratio=0.1),
    )
    prepared = prepare(building(), method.integration, method.damping, modes=modes())
    return lay_out(prepared, crossing(), method=method, points=POINTS, duration=6.0)


@pytest.mark.parametrize("kind", [pytest.param(Decoupled, marks=pytest.mark.longest), Coupled])
def test_a_crossing_moves_points_as_on_all_modes(kind):
    """RMS of the difference against that of the motion: of the order of the error that is told."""
    full, fewer = laid_out(kind, 0.0), laid_out(kind, 0.02)
    told = [doubt for doubt in fewer.doubts if doubt.subject == "response basis"]
    assert len(told) == 1
    assert not [doubt for doubt in full.doubts if doubt.subject == "response basis"]
    assert fewer.ground.floor.n_modes < 0.5 * full.ground.floor.n_modes
    assert f"{modes().n_modes} modes" in told[0].message
    runs = [_velocity(layout) for layout in (full, fewer)]
    off = np.sqrt(np.mean((runs[1] - runs[0]) ** 2, axis=0))
    size = np.sqrt(np.mean(runs[0] ** 2, axis=0))
    assert np.all(off < 0.02 * size)


def _velocity(layout):
    """Return the velocity of points over some roads, (steps, points * runs)."""
    road = roads_under_wheels(layout.sources, layout.timeline, range(2), 1)
    driven = layout.over(road)
    return driven.velocity.reshape(len(driven.velocity), -1)


def test_exact_statistics_are_those_of_all_modes():
    """Answers to waves of the road, which stand for all roads: variances within 2 %."""
    found = []
    for tolerance in (0.0, 0.02):
        layout = laid_out(Coupled, tolerance)
        total = 0.0
        for answer in harmonics(layout, n_waves=12):
            total = total + np.abs(np.asarray(answer.velocity)) ** 2
        found.append(np.sum(total, axis=tuple(range(total.ndim - 1))))
    np.testing.assert_allclose(found[1], found[0], rtol=0.02)


def test_without_a_tolerance_nothing_changes():
    """All modes are stepped, to the last bit as before: the default."""
    assert Modal(f_max=40.0, dt=0.01).response_tolerance == 0.0
    layout = laid_out(Decoupled, 0.0)
    assert layout.ground.floor.n_modes == modes().n_modes
