"""Maps of whole floors against histories, and against a closed form."""

from dataclasses import replace

import numpy as np
import pytest

from models import small_floor, small_plan
from trundle.criteria import VC, class_map, envelope_of, find_criterion, watched
from trundle.dynamics import natural_modes
from trundle.errors import InputError
from trundle.response import FloorMap, floor_map, reduce_runs
from trundle.road import RoadClass, RoughnessBand
from trundle.route import DriveIn, Route, StaticStart
from trundle.signals import mid_band_frequencies
from trundle.simulate import (
    Coupled,
    Coverage,
    Crossing,
    Decoupled,
    Modal,
    ModalRatio,
    Newmark,
    Rayleigh,
    batches,
    ensemble,
    lay_out,
    lay_out_places,
    prepare,
)
from trundle.structure import Spots, build_floor
from trundle.vehicle import container_truck_40ft, sprung_mass

DURATION, SEED, RUNS = 12.0, 3, 3  # the floor is at rest again: 8 % damping, 6 s after the exit


def way(entry=None):
    return Crossing(
        container_truck_40ft(), Route.straight((0.0, 3.0), (12.0, 3.0), speed=7.0),
        RoadClass("B"), band=RoughnessBand(n_min=0.05, n_max=2.0), entry=entry or DriveIn(length=2.0),
    )  # fmt: skip


def prepared_floor(method):
    return prepare(small_floor(mesh_size=1.5), method.integration, method.damping)


def random_nodes(floor, count):
    level = floor.nodes[np.abs(floor.nodes[:, 2]) < 1e-9]
    nodes = np.random.default_rng(1).choice(level, size=count, replace=False)[:, :2]
    return nodes, {f"n{i}": tuple(node) for i, node in enumerate(nodes)}


def assert_levels(found, expected):
    """To 1e-6, and to 2e-5 of the loudest band: filters that complete a motion answer before it.

    What they answer before the record counts in the map alone, whose period holds it.
    """
    loudest = expected.max(axis=-1, keepdims=True)
    assert np.all(np.abs(found - expected) < 1e-6 * expected + 2e-5 * loudest)


@pytest.mark.parametrize("kind", [Coupled, Decoupled])
def test_a_map_is_what_histories_at_its_places_give(kind):
    """20 random nodes, run by run, to 1e-6; quicker, the largest second within 1.5 %."""
    method = kind(integration=Modal(f_max=112.0, dt=0.005), damping=ModalRatio(ratio=0.08))
    prepared = prepared_floor(method)
    nodes, points = random_nodes(prepared.floor, 20)
    settings = {"method": method, "points": points, "duration": DURATION}
    runs = ensemble(prepared, way(), n_runs=RUNS, seed=SEED, **settings)
    layout = lay_out(prepared, way(), **settings)
    responses = lay_out_places(prepared, layout, Spots(xy=nodes), single=False)
    forces = np.transpose(runs.contact_forces, (1, 2, 0))
    found = floor_map(responses, forces, f_max=layout.f_max, averaging="event")
    histories = reduce_runs(runs, averaging="event")
    np.testing.assert_allclose(found.rms_velocity, runs.record_rms_velocity(), rtol=1e-6)
    known = found.resolved & (found.mid_band > 3.0)  # lower filters still ring at the record's end
    assert_levels(found.band_levels[..., known], histories.spectra.values[..., known])
    np.testing.assert_allclose(found.peak_acceleration, runs.peak_acceleration(), rtol=1e-6)

    expected = reduce_runs(runs).spectra.values
    exact = floor_map(responses, forces, f_max=layout.f_max, every_step=True)
    assert_levels(exact.band_levels[..., known], expected[..., known])
    seconds = floor_map(responses, forces, f_max=layout.f_max)
    low = found.mid_band < 1.9
    np.testing.assert_allclose(
        seconds.band_levels[..., found.resolved & ~low], expected[..., found.resolved & ~low],
        rtol=0.015,
    )  # fmt: skip
    np.testing.assert_allclose(seconds.band_levels[..., low], expected[..., low], rtol=0.06)


def test_a_map_of_what_people_feel_and_of_time_above_is_what_histories_give():
    """R and VDV of 12 nodes to 1e-3; time above curves to some steps of 1/20 s.

    Both weight by lines; a history's end is cut, where the map's rings on, so that a response that
    is not quite at rest leaves the little that differs.
    """
    method = Decoupled(integration=Modal(f_max=112.0, dt=0.005), damping=ModalRatio(ratio=0.08))
    prepared = prepared_floor(method)
    nodes, points = random_nodes(prepared.floor, 12)
    settings = {"method": method, "points": points, "duration": DURATION}
    runs = ensemble(prepared, way(), n_runs=RUNS, seed=SEED, **settings)
    layout = lay_out(prepared, way(), **settings)
    responses = lay_out_places(prepared, layout, Spots(xy=nodes), single=False)
    forces = np.transpose(runs.contact_forces, (1, 2, 0))
    some = (*VC[:6:2], find_criterion("R-office"))
    curves, _ = watched(
        some, f_max=layout.f_max, sampling_frequency=200.0, coverage=Coverage(excited_to=90.0)
    )
    found = floor_map(responses, forces, f_max=layout.f_max, people=True, curves=curves)
    histories = reduce_runs(runs, curves=curves)
    np.testing.assert_allclose(
        found.numbers["response_factor"], histories.response_factor, rtol=1e-3
    )
    np.testing.assert_allclose(found.numbers["vdv"], histories.vdv, rtol=1e-3)
    seen = 0
    for curve in curves:
        expected = histories.above[curve.name]
        np.testing.assert_allclose(found.above[curve.name], expected, atol=0.25)
        seen += ((expected > 0.5) & (expected < 8.0)).any()
    assert seen > 1  # some curves are exceeded for a while, and not for ever
    without = floor_map(responses, forces, f_max=layout.f_max, curves=curves)
    assert np.isnan(without.numbers["vdv"]).all()
    assert np.isnan(without.above["R-office"]).all()


def test_a_map_of_a_floor_that_rings_long_is_what_histories_give():
    """0.1 % damping rings for minutes; what is left must not come round to the record's start."""
    method = Coupled(integration=Modal(f_max=112.0, dt=0.005), damping=ModalRatio(ratio=0.001))
    prepared = prepared_floor(method)
    nodes, points = random_nodes(prepared.floor, 5)
    settings = {"method": method, "points": points, "duration": DURATION}
    runs = ensemble(prepared, way(), n_runs=2, seed=SEED, **settings)
    layout = lay_out(prepared, way(), **settings)
    responses = lay_out_places(prepared, layout, Spots(xy=nodes), single=False)
    forces = np.transpose(runs.contact_forces, (1, 2, 0))
    found = floor_map(responses, forces, f_max=layout.f_max, averaging="event")
    np.testing.assert_allclose(found.rms_velocity, runs.record_rms_velocity(), rtol=0.01)
    np.testing.assert_allclose(found.peak_acceleration, runs.peak_acceleration(), rtol=0.01)


def test_single_precision_keeps_four_digits():
    method = Coupled(integration=Modal(f_max=112.0, dt=0.005))
    prepared = prepared_floor(method)
    nodes, points = random_nodes(prepared.floor, 5)
    layout = lay_out(prepared, way(), method=method, points=points, duration=DURATION)
    forces = np.random.default_rng(0).standard_normal((len(layout.time), 3, 2)) * 1e4
    one, two = (
        floor_map(
            lay_out_places(prepared, layout, Spots(xy=nodes), single=kind), forces, f_max=90.0
        )
        for kind in (True, False)
    )
    np.testing.assert_allclose(one.band_levels, two.band_levels, rtol=1e-4)
    np.testing.assert_allclose(one.peak_acceleration, two.peak_acceleration, rtol=1e-3)


def test_what_cannot_be_mapped_is_refused():
    direct = Decoupled(integration=Newmark(dt=0.01), damping=Rayleigh(alpha=0.8, beta=1e-3))
    places, settings = np.array([[3.0, 3.0]]), {"points": {"p": (3.0, 3.0)}, "duration": 1.0}
    prepared = prepared_floor(direct)
    layout = lay_out(prepared, way(), method=direct, **settings)
    with pytest.raises(InputError, match="Modal"):
        lay_out_places(prepared, layout, Spots(xy=places))
    car = replace(way(StaticStart(exit_length=1.0)), vehicle=sprung_mass(mass=1e4, stiffness=1e6))
    modal = Coupled(integration=Modal(f_max=112.0, dt=0.005))
    prepared = prepared_floor(modal)
    layout = lay_out(prepared, car, method=modal, **settings)
    with pytest.raises(InputError, match="at rest"):
        lay_out_places(prepared, layout, Spots(xy=places))


def test_a_floor_of_one_mode_has_the_class_of_its_shape_at_every_node():
    """A simply supported plate below its second mode: levels are sin sin times those of the centre.

    The class at a node is then the strictest VC curve above the centre's level times sin sin,
    wherever that is not within 2 % of a limit (the mesh bends the shape by so much at most), and
    none on the edges, which do not move.
    """
    a = 8.0
    floor = build_floor(
        small_plan(
            x_lines=np.array([0.0, a]), y_lines=np.array([0.0, a]), x_extent=(0.0, a),
            y_extent=(0.0, a), beams_x=None, beams_y=None, column=None, storey_below=0.0,
            storey_above=0.0, edges=dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "pinned"),
        ),
        mesh_size=0.5,
    )  # fmt: skip
    method = Decoupled(integration=Modal(f_max=112.0, dt=0.005, residual=False))
    modes = natural_modes(floor.mass, floor.stiffness, f_max=112.0)
    one = replace(
        modes, omega=modes.omega[:1], shapes=modes.shapes[:, :1], residuals=modes.residuals[:1]
    )
    prepared = prepare(floor, method.integration, method.damping, modes=one)
    crossing = Crossing(
        container_truck_40ft(), Route.straight((0.0, 4.0), (a, 4.0), speed=7.0), RoadClass("A"),
        band=RoughnessBand(n_min=0.05, n_max=2.0), entry=DriveIn(length=2.0),
    )  # fmt: skip
    layout = lay_out(prepared, crossing, method=method, points={"c": (4.0, 4.0)}, duration=8.0)
    (runs,) = batches(layout, runs=range(4), seed=1)
    nodes = floor.nodes[:, :2]
    forces = np.transpose(runs.contact_forces, (1, 2, 0))
    forces *= 0.03  # so that the classes from workshop to VC-E all occur
    found = class_map(
        floor_map(lay_out_places(prepared, layout, Spots(xy=nodes)), forces, f_max=90.0),
        VC,
        f_max=90.0,
    )
    centre = int(np.abs(nodes - 4.0).sum(axis=1).argmin())
    shape = np.abs(np.sin(np.pi * nodes[:, 0] / a) * np.sin(np.pi * nodes[:, 1] / a))
    margin = found.margin[:, centre, None] / np.maximum(shape, 1e-12)
    expected = np.full(len(nodes), -1)
    for i in range(len(VC)):
        expected[margin[i] >= 1.0] = i
    expected[shape < 1e-9] = -2  # the held edges do not move, and nothing is assessed there
    sure = (np.abs(margin - 1.0) > 0.02).all(axis=0)
    assert sure.mean() > 0.9
    assert len(np.unique(expected)) >= 4
    np.testing.assert_array_equal(found.classes()[sure], expected[sure])


def test_a_map_is_no_pass_where_bands_are_missing():
    """To 60 Hz the 63 and 80 Hz bands are not there: no class anywhere; a failure still counts."""
    levels = np.full((3, 2, 20), 1e-9)
    levels[:, 1, 10] = [1e-3, 2e-3, 3e-3]
    resolved = mid_band_frequencies() < 55.0
    made = FloorMap(
        places=np.zeros((2, 2)), mid_band=mid_band_frequencies(), resolved=resolved,
        averaging="max_1s", band_levels=levels, numbers={n: np.zeros((3, 2)) for n in ("rms_velocity", "peak_acceleration")},
    )  # fmt: skip
    partial = class_map(made, VC, percentile=50.0, f_max=60.0)
    assert not any(partial.complete)
    # the first place passes what is known of it, the second fails the widest class
    assert partial.classes().tolist() == [-2, -1]
    whole = class_map(replace(made, resolved=resolved | True), VC, percentile=50.0, f_max=90.0)
    assert whole.classes().tolist() == [len(VC) - 1, -1]
    office = whole.index("office")
    assert whole.margin[office, 1] == pytest.approx(400e-6 / 2e-3)
    assert whole.governing_band[office, 1] == pytest.approx(10.0)
    assert whole.share_exceeding[office].tolist() == [0.0, 1.0]
    worst = envelope_of([whole, replace(whole, margin=whole.margin[:, ::-1])])
    np.testing.assert_allclose(worst.margin[office], 0.2)
