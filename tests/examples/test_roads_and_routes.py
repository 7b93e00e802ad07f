"""The examples with joints, a survey and a curve, at small size, each checked on one number."""

import functools
import re
from pathlib import Path

import numpy as np
import pytest

import trundle as tr
from trundle.road import MeasuredRoad, Tread

FOLDER = Path(__file__).parents[2] / "examples"


def small(name, *changes):
    text = (FOLDER / name / "study.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return tr.study_from_text(re.sub(r"(?m)^runs = \d+", "runs = 2", text), folder=FOLDER / name)


@functools.cache
def forklift():
    return tr.run_study(
        small(
            "forklift_joints",
            ('mesh_size = "0.75 m"', 'mesh_size = "2 m"'),
            ('f_max = "112 Hz"', 'f_max = "25 Hz"'),
            ('interaction = "coupled"', 'interaction = "decoupled"'),
            ('n_max = "42 1/m"', 'n_max = "10 1/m"'),
            ('dt = "2.5 ms"', 'dt = "4 ms"'),
            ('track_width = "1 m"\n', ""),
        )
    )


@pytest.mark.longest
def test_joints_govern_a_flat_floor(tmp_path):
    """Stepped joints are felt more than dowelled ones, those more than none; in every run.

    All three roads are drawn from the same seed: what differs is the joints alone.
    """
    result = forklift()
    levels = result.to_xarray()["rms_velocity"].squeeze()
    felt = {road: float(levels.sel(road=road).median()) for road in result.study.roads}
    assert felt["stepped"] > 1.1 * felt["dowelled"] > 1.1 * 1.1 * felt["no joints"] > 0.0
    tr.save(result, tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "4 x expansion joint" in page


def test_a_joint_lifts_a_forklift_by_what_its_tyre_sinks():
    """The front tyre sinks by g / w^2 laden (6 Hz): 6.9 mm of a 12 mm gap over a patch of 100 mm."""
    study = small("forklift_joints")
    vehicle = study.drives["aisle"].vehicle
    sinking = vehicle.static_forces[0] / vehicle.contact_stiffness[0]
    assert sinking == pytest.approx(9.81 / (2 * np.pi * 6.0) ** 2, rel=1e-6)
    gap = study.roads["dowelled"].under(0.5, Tread(sinking=sinking)).averaged(0.1)
    assert gap.at(4.5 + 0.006)[0] == pytest.approx(-sinking * 0.010 / 0.1, rel=1e-9)


@pytest.mark.longest
def test_a_survey_is_driven_over_beside_its_class(tmp_path):
    """544 m of it from 478 m; its deck is felt as on the classes about it, in every run the same."""
    study = small("measured_profile", ('mesh_size = "1 m"', 'mesh_size = "2 m"'))
    road = study.roads["surveyed"]
    assert isinstance(road, MeasuredRoad)
    assert (road.start, road.tracks[0].length) == (530.0, 544.0)
    result = tr.run_study(study)
    levels = result.to_xarray()["rms_velocity"].squeeze()
    ours = levels.sel(road="surveyed").values
    assert np.ptp(ours) < 1e-9 * ours.max()
    assert 0.2 * float(levels.sel(road="A").min()) < ours[0] < float(levels.sel(road="B").max())
    tr.save(result, tmp_path / "out")
    kept = tr.read_results(tmp_path / "out").study
    np.testing.assert_array_equal(
        kept.roads["surveyed"].tracks[0].elevation, road.tracks[0].elevation
    )


@pytest.mark.longest
def test_a_semitrailer_cuts_the_corner_and_stops_at_the_dock():
    """Its trailer runs up to 2.5 m inside of the path, and all axles stand on the deck at last.

    On an endless circle of 12 m it would cut in by ``R - sqrt(R^2 - l1^2 + d^2 - l2^2)`` = 4.1 m.
    """
    study = small(
        "curve_into_dock",
        ('mesh_size = "1.2 m"', 'mesh_size = "3 m"'),
        ('f_max = "80 Hz"', 'f_max = "15 Hz"'),
        ('class = "A"', "smooth = true"),
        ('speeds = [["0 m", "12 km/h"], ["14 m", "8 km/h"], ["40 m", "8 km/h"], ["52 m", "0 km/h"]]',
         'speeds = [["0 m", "36 km/h"], ["14 m", "24 km/h"], ["40 m", "24 km/h"], ["52 m", "0 km/h"]]'),
    )  # fmt: skip
    (passage,) = study.acting(study.cases[0], "smooth", study.methods[0])
    time = np.linspace(0.0, passage.leaves, 400)
    track = passage.track(time, -10.0)
    last = track.place[:, -3:-1].mean(axis=1)  # between the wheels of the last axle
    on = track.share[:, -2] > 0.99
    crossing = passage.crossing
    middle = crossing.along(time, -10.0).station[:, -2]
    path, direction = crossing.route.locate(middle)
    left = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    inside = ((last - path) * left).sum(axis=1)[on]
    assert 1.5 < inside.max() < 4.1
    assert crossing.stays
    np.testing.assert_allclose(track.speed[-1], 0.0, atol=1e-6)
    assert (track.share[-1, : -crossing.vehicle.inner] == 1.0).all()
    result = tr.run_study(study)
    assert float(result.to_xarray()["rms_velocity"].min()) > 0.0
    (cell,) = result.cells.values()
    assert cell.coverage.left
