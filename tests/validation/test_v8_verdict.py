"""V8 verdict: weightings, maps of whole floors and measured records against what is known of them."""

import numpy as np
import pytest

from models import small_floor
from trundle.criteria import VC
from trundle.records.assess import assess_record
from trundle.response import floor_map, reduce_runs
from trundle.road import RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.signals import Record, mid_band_frequencies, nominal_frequency, weighting_response
from trundle.simulate import (
    Coupled,
    Crossing,
    Modal,
    ModalRatio,
    ensemble,
    lay_out,
    lay_out_places,
    prepare,
)
from trundle.structure import Spots
from trundle.vehicle import container_truck_40ft

CASE = "V8 verdict"
SOURCE = "ISO 8041-1:2017, tables of annex B"
F = 10.0 ** (np.array([0, 3, 6, 9, 12, 15, 19]) / 10.0)
LISTED = {
    "Wb": [0.385, 0.417, 0.885, 1.026, 0.814, 0.491, 0.173],
    "Wk": [0.4825, 0.531, 0.965, 1.037, 0.774, 0.403, 0.134],
    "Wd": [1.011, 0.891, 0.514, 0.255, 0.127, 0.063, 0.021],
    "Wm": [0.833, 0.932, 0.818, 0.582, 0.338, 0.176, 0.060],
}


@pytest.mark.parametrize("name", LISTED)
def test_weightings(record, name):
    """1 % of the listed magnitudes, and half of the last digit that they are listed with."""
    for f, listed in zip(F, LISTED[name], strict=True):
        found = float(np.abs(weighting_response(name, np.array([f]))[0]))
        label = f"|{name}| at {nominal_frequency(f):g} Hz"
        record.row(label, listed, found, rtol=0.01 + 0.0005 / listed)


def test_a_map_against_histories(record):
    """20 random nodes, 3 runs: largest difference of any level from that of a history."""
    method = Coupled(integration=Modal(f_max=112.0, dt=0.005), damping=ModalRatio(ratio=0.08))
    prepared = prepare(small_floor(mesh_size=1.5), method.integration, method.damping)
    way = Crossing(
        container_truck_40ft(), Route.straight((0.0, 3.0), (12.0, 3.0), speed=7.0),
        RoadClass("B"), band=RoughnessBand(n_min=0.05, n_max=2.0), entry=DriveIn(length=2.0),
    )  # fmt: skip
    level = prepared.floor.nodes[np.abs(prepared.floor.nodes[:, 2]) < 1e-9]
    nodes = np.random.default_rng(4).choice(level, size=20, replace=False)[:, :2]
    settings = {
        "method": method, "points": {f"n{i}": tuple(p) for i, p in enumerate(nodes)}, "duration": 12.0,
    }  # fmt: skip
    runs = ensemble(prepared, way, n_runs=3, seed=6, **settings)
    responses = lay_out_places(
        prepared, lay_out(prepared, way, **settings), Spots(xy=nodes), single=False
    )
    forces = np.transpose(runs.contact_forces, (1, 2, 0))
    source = "band levels, RMS and peaks of histories at the same nodes"
    for rule in ("event", "max_1s"):
        found = floor_map(responses, forces, f_max=90.0, averaging=rule, every_step=True)
        expected = reduce_runs(runs, averaging=rule).spectra.values
        known = found.resolved & (found.mid_band > 3.0)  # lower filters ring on behind the record
        # filters that complete a motion answer 60 ms before it, which the map's period holds
        apart = np.abs(found.band_levels - expected)[..., known]
        worst = (apart / expected[..., known].max(axis=-1, keepdims=True)).max()
        name = f"map against histories, band levels by {rule}, over the loudest band"
        record.row(name, 0.0, worst, atol=2e-5, source=source)
    worst = np.abs(found.rms_velocity / runs.record_rms_velocity() - 1.0).max()
    record.row("map against histories, RMS velocity", 0.0, worst, atol=1e-6, source=source)
    worst = np.abs(found.peak_acceleration / runs.peak_acceleration() - 1.0).max()
    record.row("map against histories, peak acceleration", 0.0, worst, atol=1e-6, source=source)


@pytest.mark.parametrize("quantity", ["acceleration", "velocity"])
@pytest.mark.parametrize("fs", [200.0, 400.0, 1000.0])
def test_a_record_of_known_levels(record, quantity, fs):
    """Steady tones at mid-band with an offset and a drift; neighbouring bands hold a ten-thousandth."""
    t = np.arange(round(60.0 * fs)) / fs
    ease = np.clip(np.minimum(t, 60.0 - t) / 8.0, 0.0, 1.0)
    samples = 0.05 + 0.001 * t
    tones = {3: 60e-6, 9: 100e-6, 15: 40e-6}
    for k, rms in tones.items():
        f = 10.0 ** (k / 10.0)
        size = np.sqrt(2) * rms * (2 * np.pi * f if quantity == "acceleration" else 1.0)
        samples += size * ease**2 * (3 - 2 * ease) * np.sin(2 * np.pi * f * t + k)
    made = Record(
        samples=samples[None], sampling_frequency=fs, quantity=quantity, channel_names=("z",)
    )
    levels = assess_record(made, VC).reduced.spectra.values[0, 0]
    for k, rms in tones.items():
        name = f"tone of {rms * 1e6:g} um/s at {nominal_frequency(mid_band_frequencies()[k]):g} Hz in a record of {quantity}"
        error = 20 * np.log10(levels[k] / rms)
        record.row(
            f"{name}, fs = {fs:g} Hz", 0.0, error, unit="dB", atol=0.2, source="the tone itself"
        )
