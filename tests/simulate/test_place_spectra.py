"""Blocks of places and runs, however small, leave what one block leaves."""

import importlib

import numpy as np
import pytest

from models import small_floor
from trundle.road import RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Modal,
    lay_out,
    lay_out_places,
    place_spectra,
    prepare,
)
from trundle.structure import Spots
from trundle.vehicle import container_truck_40ft

module = importlib.import_module("trundle.simulate.spectral.place_spectra")


@pytest.fixture(scope="module")
def laid_out():
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    prepared = prepare(small_floor(mesh_size=1.5), method.integration, method.damping)
    way = Crossing(
        container_truck_40ft(), Route.straight((0.0, 3.0), (12.0, 3.0), speed=7.0),
        RoadClass("B"), band=RoughnessBand(n_min=0.05, n_max=2.0), entry=DriveIn(length=2.0),
    )  # fmt: skip
    layout = lay_out(prepared, way, method=method, points={"p": (3.0, 3.0)}, duration=4.0)
    places = np.random.default_rng(2).uniform(0.5, 5.5, (7, 2))
    forces = np.random.default_rng(3).standard_normal((len(layout.time), 3, 5)) * 1e4
    return lay_out_places(prepared, layout, Spots(xy=places), single=False), forces


def collected(laid_out, *, acceleration):
    responses, forces = laid_out
    shape = (1 + acceleration, forces.shape[2], len(responses.places), len(responses.frequencies))
    found, told, blocks = np.full(shape, np.nan, dtype=complex), [], 0
    for places, runs, velocity, more in place_spectra(
        responses, forces, acceleration=acceleration, progress=told.append
    ):
        found[0, runs, places] = velocity
        if more is not None:
            found[1, runs, places] = more
        blocks += 1
    assert np.isfinite(found).all()
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
    return found, blocks


@pytest.mark.parametrize("acceleration", [False, True])
def test_small_blocks_leave_what_a_large_one_leaves(laid_out, acceleration, monkeypatch):
    """Every place and run once, whether responses, loads or answers are what has no room."""
    whole, blocks = collected(laid_out, acceleration=acceleration)
    assert blocks == 1
    responses, _ = laid_out
    line_bytes = 16 * len(responses.frequencies)
    of_dofs = line_bytes * responses.route_shapes.shape[1]
    for sizes in (
        {"_RESPONSE_BYTES": 4.0 * of_dofs},
        {"_SPECTRUM_BYTES": 2.0 * of_dofs},
        {"_ANSWER_BYTES": 12.0 * line_bytes, "_PLACES": 4},
        {"_RESPONSE_BYTES": 8.0 * of_dofs, "_SPECTRUM_BYTES": 3.0 * of_dofs, "_PLACES": 2},
    ):
        with monkeypatch.context() as patch:
            for name, value in sizes.items():
                patch.setattr(module, name, value)
            found, blocks = collected(laid_out, acceleration=acceleration)
        assert blocks > 1
        np.testing.assert_allclose(found, whole, rtol=1e-9, atol=1e-12 * np.abs(whole).max())
