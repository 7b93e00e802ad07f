"""The example buildings, at small size: they run to their reports, and their floors are what they say."""

import functools
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trundle as tr

FOLDER = Path(__file__).parents[2] / "examples"
SMALL = {
    "hospital": ('"0.8 m"', '"1.6 m"'),
    "car_park": ('mesh_size = "1 m"', 'mesh_size = "2 m"'),
    "steel_floor": ('"0.75 m"', '"1.5 m"'),
    "flat_slab": ('"0.75 m"', '"1.5 m"'),
    "from_drawing": ('"0.8 m"', '"1.6 m"'),
}
SURFACES = {
    "hospital": {"level 1"},
    "car_park": {"deck", "laboratory", "ramp"},
    "steel_floor": {"floor"},
    "flat_slab": {"slab"},
    "from_drawing": {"floor"},
}


def small(name):
    """The study with two runs, larger elements, and a map of few places."""
    text = (FOLDER / name / "study.toml").read_text(encoding="utf-8")
    assert SMALL[name][0] in text
    text = text.replace(*SMALL[name]).replace('f_max = "112 Hz"', 'f_max = "40 Hz"')
    text = re.sub(r"(?m)^runs = \d+", "runs = 2", text)
    text = re.sub(r'spacing = "[\d.]+ m"\nruns', 'spacing = "4 m"\nruns', text)
    if name in {"hospital", "car_park"}:  # the others are mapped
        text = text[: text.index("[map]")]
        # three times as fast, a record a third as long; its waves excite the same bands
        text = text.replace('"5 km/h"', '"15 km/h"').replace('"60 1/m"', '"20 1/m"')
    return tr.study_from_text(text.replace('size_at_points = "0.4 m"\n', ""), folder=FOLDER / name)


@functools.cache
def ran(name):
    return tr.run_study(small(name))


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.longest] * (name not in {"steel_floor"}))
        for name in SMALL
    ],
)
def test_an_example_runs_to_its_report(tmp_path, name):
    """Every case is felt at every point, and the report has a plan of every storey."""
    result = ran(name)
    assert set(result.study.floor.surfaces) == SURFACES[name]
    tr.save(result, tmp_path / "out")
    levels = result.to_xarray()["rms_velocity"].values
    assert np.isfinite(levels).all()
    assert levels.min() > 0.0
    plans = list((tmp_path / "out" / "figures").glob("plan_*.png"))
    assert len(plans) == len(SURFACES[name])
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert all(f"Plan of {surface}" in page for surface in SURFACES[name])


def test_what_the_example_of_a_hospital_weighs():
    """Slabs by area (ward, imaging), with what lies on them, edge beams, walls and columns by half."""
    study = small("hospital")
    ward = 28.8 * 7.2 + 14.4 * 14.4 - 3.5 * 4.5 - 7.2 * 7.2
    slabs = ward * (0.26 * 2500 + 150 + 0.1 * 2000 / 9.80665)
    slabs += 7.2 * 7.2 * (0.40 * 2500 + 150 + 0.3 * 5000 / 9.80665)
    beams = 36.0 * 0.3 * 0.5 * 2500
    upright = 4.2 * 2500 * (16 * 0.45**2 + 8.0 * 0.25)
    moving = study.floor.moving_mass()
    # consistent masses of uprights: those near the fixed foot stay, the rest moves
    assert slabs + beams + 0.5 * upright < moving < slabs + beams + upright


@pytest.mark.longest
def test_a_van_on_the_ramp_is_felt_less_than_one_under_the_tool():
    """The ramp stands on the ground and on its own walls; the aisle hangs from the tool's columns."""
    rms = ran("car_park").to_xarray()["rms_velocity"].sel(point="tool").mean(dim="run").squeeze()
    assert float(rms.sel(case="aisle")) > 2.0 * float(rms.sel(case="ramp up"))


@pytest.mark.longest
def test_the_level_on_a_flat_slab_settles_as_its_mesh_is_refined():
    """The van's RMS velocity at the stepper, same roads: 5 % from 0.75 to 0.375 m, 2 % to 0.19 m.

    All modes to 112 Hz, at the example's own step; the first six frequencies too.
    """
    study = tr.load_study(FOLDER / "flat_slab" / "study.toml")
    rms, frequencies = [], []
    for factor in (1.0, 0.5, 0.25):
        one = replace(study.meshed(factor), building=None, runs=4, map=None, cases=study.cases[:1])
        result = tr.run_study(one)
        (cell,) = result.cells.values()
        rms.append(np.sqrt(np.mean(np.square(cell.rms_velocity))))
        frequencies.append(result.modes.frequencies[:6])
    for values in (rms, frequencies):
        np.testing.assert_allclose(values[1], values[0], rtol=0.05)
        np.testing.assert_allclose(values[2], values[1], rtol=0.02)
