"""Parts far from routes and points are kept to less, and what is near is as it was."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from towers import tower
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.road import RoadClass
from trundle.route import Route
from trundle.simulate import Coupled, Crossing, Modal, ensemble
from trundle.simulate.laying_out import point_rows
from trundle.structure import Spot
from trundle.structure.superelements import Cuts, Parting, reduced_here
from trundle.structure.superelements.nearness import Nearness
from trundle.vehicle import library_vehicle

BAYS = 8
CUTS = Cuts(x=6.0 * np.arange(1, BAYS))
POINTS = {"beside": Spot(x=8.0, y=4.0, on="level 1"), "next": Spot(x=15.0, y=2.5, on="level 1")}


@functools.cache
def building():
    return tower(storeys=1, bays_x=BAYS, bays_y=1, mesh_size=1.5)


def parted(near):
    parting = Parting(cuts=CUTS, f_parts=100.0, f_seams=250.0, near=near).of(building())
    route = Route.straight((0.0, 3.0), (12.0, 3.0), speed=4.0)
    dofs = np.unique(
        point_rows(building(), {**POINTS, "on": Spot(x=3.0, y=3.0, on="level 1")}).indices
    )
    return parting.near_to(dofs), replace(route, on="level 1")


def test_shares_fall_with_the_square_of_the_distance_in_steps():
    """Within 10 m all; at 20 m a quarter; at 14.1 m a half; never less than a tenth (rounded up)."""
    near = Nearness(places=np.zeros((1, 3)), near=10.0)
    boxes = [
        np.array([[d, -5.0, 0.0], [d + 6.0, 5.0, 3.0]]) for d in (-3.0, 9.0, 14.2, 20.0, 500.0)
    ]
    np.testing.assert_allclose(near.shares(boxes)[:4], [1.0, 1.0, 0.5, 0.25])
    assert 0.1 <= near.shares(boxes)[4] <= 0.1 * 2**0.25


def test_without_nearness_nothing_changes():
    """A parting that says nothing of it gives the structure back, kept alike everywhere."""
    structure, _ = parted(None)
    assert structure.nearness is None
    assert structure.joined.n_far == 0


def test_levels_near_the_route_are_those_of_parts_kept_alike():
    """Coupled, on seven bays: RMS within 5 % at two points, with fewer coordinates and modes."""
    found, modes = [], []
    for near in (None, 10.0):
        structure, route = parted(near)
        method = Coupled(integration=Modal(f_max=50.0, dt=0.008), damping=ModalRatio(ratio=0.05))
        crossing = Crossing(library_vehicle("forklift_fl3_laden"), route, RoadClass("B"))
        runs = ensemble(
            structure, crossing, method=method, points=POINTS, n_runs=2, seed=1, duration=4.0
        )
        found.append(np.sqrt((np.asarray(runs.velocity) ** 2).mean(axis=1)))
        modes.append(structure.joined.pencil.n_modes)
        if near is not None:
            assert structure.joined.n_far >= 3
            assert "far from routes and points" in structure.joined.told
    np.testing.assert_allclose(found[1], found[0], rtol=0.05)
    assert modes[1] < 0.8 * modes[0]


def test_far_parts_are_reduced_no_further_than_they_are_kept():
    """As far as the nearest copy of each needs; own modes are those of parts that were reduced all
    the way and cut."""
    parting = Parting(cuts=CUTS, f_parts=100.0, f_seams=250.0, near=4.0).of(building())
    middle = {"middle": Spot(x=BAYS * 3.0, y=3.0, on="level 1")}  # both ends are far, and alike
    structure = parting.near_to(point_rows(building(), middle).indices)
    most = structure.pieces.reach(structure.nearness)
    assert most.max() == 1.0
    assert most.min() < 0.5
    reached = [part.f_max for part in structure.joined.parts]
    np.testing.assert_allclose(reached, 100.0 * most)

    def all_the_way(pieces, f_parts, tell):
        return reduced_here(pieces, [100.0] * len(f_parts), tell)

    alike = replace(structure, reducer=all_the_way)
    np.testing.assert_allclose(structure.joined.pencil.omega, alike.joined.pencil.omega, rtol=1e-9)


def test_what_it_is_near_to_decides_its_content():
    """Modes of one nearness are not another's: the cache must not mix them."""
    hashes = {parted(near)[0].content_hash for near in (None, 10.0, 12.0)}
    assert len(hashes) == 3


def test_no_distance_is_refused():
    """Zero metres hold no part."""
    with pytest.raises(InputError, match="near"):
        Nearness(places=np.zeros((1, 3)), near=0.0)
