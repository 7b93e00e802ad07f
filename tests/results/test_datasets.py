"""Results as labelled arrays: each number is found by its labels, on its own axes, in its unit."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from made_results import POINTS, SECOND, cell, history, levels, made_result, made_study
from trundle.response import ExactStatistics
from trundle.results.cells import CellKey
from trundle.results.datasets import result_groups

SOUTH = "=Zufahrt, Süd"
MORE = """
[[method]]
name = "zweite, Methode"
interaction = "decoupled"
f_max = "30 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
"""


@pytest.fixture(scope="module")
def study():
    """Three cases on two roads by two methods at two points, three runs."""
    return made_study(SECOND + MORE)


@pytest.fixture(scope="module")
def result(study):
    return made_result(study)


@pytest.fixture(scope="module")
def groups(result):
    return result_groups(result)


def keys():
    """Give cells in the order in which results are made up: cell k has k times the levels."""
    names = ("main", SOUTH, "both"), ("B", "C"), ("coupled", "zweite, Methode")
    return list(enumerate(product(*names), start=1))


def test_every_number_stands_under_its_own_labels(groups):
    """By hand: cell k, quantity q, run r and point p have k (100 q + 10 r + p) 1e-6."""
    summary = groups["/"]
    place = {"peak_acceleration": 1, "rms_velocity": 3}  # in the list of all quantities
    for (k, (case, road, method)), (name, q) in product(keys(), place.items()):
        found = summary[name].sel(case=case, road=road, method_name=method)
        assert found.dims == ("run", "point")
        expected = k * 1e-6 * (100 * q + 10 * np.arange(3)[:, None] + np.arange(2))
        np.testing.assert_allclose(found, expected, rtol=1e-12)
        assert list(found["point"].values) == list(POINTS)


def test_axes_stand_in_one_order_with_units(groups):
    """Case, road, method, run, point, band: the order of the documentation, in SI."""
    summary = groups["/"]
    cell_axes = ("case", "road", "method_name", "run", "point")
    assert summary["rms_velocity"].dims == cell_axes
    assert summary["band_velocity"].dims == (*cell_axes, "band")
    assert summary["exact_band_velocity"].dims == (*cell_axes[:3], "point", "band")
    units = {name: one.attrs["units"] for name, one in summary.data_vars.items()}
    assert units == {
        "peak_acceleration": "m/s2", "rms_velocity": "m/s", "band_velocity": "m/s",
        "exact_rms_velocity": "m/s", "exact_band_velocity": "m/s",
    }  # fmt: skip
    assert summary["band_velocity"].attrs["long_name"].endswith(", max_1s")


def test_band_levels_stand_under_their_frequencies(groups):
    """By hand 1e-6 k (10 + r + 0.1 p + 0.01 b), and mid-bands 10^(b/10) Hz."""
    summary = groups["/"]
    np.testing.assert_allclose(summary["band"], 10.0 ** (np.arange(20) / 10.0))
    found = summary["band_velocity"].sel(case=SOUTH, road="C", method_name="coupled", run=2)
    k = {key: k for k, key in keys()}[SOUTH, "C", "coupled"]
    expected = k * 1e-6 * (12.0 + 0.1 * np.arange(2)[:, None] + 0.01 * np.arange(20))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_points_have_their_places(groups):
    """Those of the study: 3, 3 and 9, 1.5 m."""
    assert groups["/"]["point_x"].values.tolist() == [3.0, 9.0]
    assert groups["/"]["point_y"].values.tolist() == [3.0, 1.5]
    assert groups["/"]["point_x"].attrs["units"] == "m"


def test_what_is_not_exact_is_no_number(groups):
    """Without exact statistics there stand NaN, and no zeros that would pass anything."""
    assert np.isnan(groups["/"]["exact_rms_velocity"]).all()
    assert np.isnan(groups["/"]["exact_band_velocity"]).all()


def exact(value):
    """Statistics of one step: mean 3, variance 16 times a value squared, so that the RMS is 5."""
    mean = np.full((4, 2), 3.0 * value)
    variance = np.full((4, 2), 16.0 * value**2)
    resolved = np.zeros(20, dtype=bool)
    resolved[3] = True
    return ExactStatistics(
        time=0.005 * np.arange(4), mean={"velocity": mean, "acceleration": mean},
        variance={"velocity": variance, "acceleration": variance}, largest={},
        mid_band=10.0 ** (np.arange(20) / 10.0), resolved=resolved,
        band_mean=np.full((1, 2, 4), 3.0 * value), band_variance=np.full((1, 2, 4), 16.0 * value**2),
        quadrature_error=0.0, n_waves=1, point_names=tuple(POINTS),
    )  # fmt: skip


def test_exact_statistics_stand_in_their_own_cell_alone(result):
    """Mean 3 and variance 16 have an RMS of 5, in the resolved band too; all other cells have none."""
    key = CellKey("both", "B", "zweite, Methode")
    cells = {**result.cells, key: replace(result.cells[key], exact=exact(2e-6))}
    summary = result_groups(replace(result, cells=cells))["/"]
    labels = {"case": "both", "road": "B", "method_name": "zweite, Methode"}
    np.testing.assert_allclose(summary["exact_rms_velocity"].sel(labels), 1e-5)
    bands = summary["exact_band_velocity"].sel(labels)
    np.testing.assert_allclose(bands.isel(band=3), 1e-5)
    assert int(np.isfinite(bands).sum()) == 2
    assert int(np.isfinite(summary["exact_rms_velocity"]).sum()) == 2


def test_histories_stand_by_case_road_and_time(groups):
    """By hand: cell k at step s and point p moves k (s + p / 10), 10 and 100 times that."""
    for k, (case, road, method) in keys():
        found = groups[f"/histories/{method}"].sel(case=case, road=road)
        expected = k * (np.arange(5.0)[:, None] + 0.1 * np.arange(2))
        for name, factor in (("displacement", 1.0), ("velocity", 10.0), ("acceleration", 100.0)):
            assert found[name].dims == ("time", "point")
            np.testing.assert_allclose(found[name], factor * expected, rtol=1e-12)
    units = {n: v.attrs["units"] for n, v in groups["/histories/coupled"].data_vars.items()}
    assert units == {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2"}


def test_behind_a_shorter_record_stands_no_number(result):
    """Two steps of one case beside five of the others: three NaN, and times of the longest."""
    short = {key: one for key, one in result.cells.items() if key.case == "main"}
    short = {key: replace(one, history=history(n_steps=2)) for key, one in short.items()}
    cells = {**result.cells, **short}
    found = result_groups(replace(result, cells=cells))["/histories/coupled"]
    np.testing.assert_allclose(found["time"], 0.005 * np.arange(5))
    ended = found["velocity"].sel(case="main", road="B")
    np.testing.assert_allclose(ended[:2], history(n_steps=2).velocity)
    assert np.isnan(ended[2:]).all()
    assert not np.isnan(found["velocity"].sel(case=SOUTH)).any()


def test_forces_stand_by_contact(study):
    """Cases of two and of three wheels beside each other: each has its own names and forces."""
    cells = {}
    for k, (case, road, method) in keys():
        n = {"main": 2, SOUTH: 3, "both": 5}[case]
        key = CellKey(case, road, method)
        cells[key] = cell(
            key,
            reduced=levels(n_contacts=n, base=float(k)),
            history=history(n_contacts=n, base=float(k)),
            contact_names=tuple(f"Rad {i}" for i in range(n)),
        )
    groups = result_groups(made_result(study, cells=cells))
    for k, (case, road, method) in keys():
        peaks = groups[f"/contacts/{case}"]["peak_contact_force"].sel(road=road, method_name=method)
        n = peaks.sizes["contact"]
        assert peaks.dims == ("run", "contact")
        expected = k * 1e-6 * (700 + 10 * np.arange(3)[:, None] + np.arange(n))
        np.testing.assert_allclose(peaks, expected, rtol=1e-12)
        forces = groups[f"/contacts/{case}/{method}"]["contact_force"].sel(road=road)
        assert forces.dims == ("time", "contact")
        assert list(forces["contact"].values) == [f"Rad {i}" for i in range(n)]
        np.testing.assert_allclose(forces, k * (np.arange(5.0)[:, None] + 0.5 * np.arange(n)))
        assert (forces.attrs["units"], peaks.attrs["units"]) == ("N", "N")


def test_there_is_a_group_for_every_case_and_method_and_no_map_unasked(groups):
    """The paths of the documentation."""
    methods = ("coupled", "zweite, Methode")
    expected = {"/", *(f"/histories/{m}" for m in methods)}
    for case in ("main", SOUTH, "both"):
        expected |= {f"/contacts/{case}", *(f"/contacts/{case}/{m}" for m in methods)}
    assert set(groups) == expected


def test_a_tree_finds_the_same_by_labels(result):
    """What xarray makes of the groups: names with commas and signs are paths and labels alike."""
    tree = result.to_xarray()
    found = tree[f"/contacts/{SOUTH}/coupled"]["contact_force"].sel(road="C", contact="axle 2")
    k = {key: k for k, key in keys()}[SOUTH, "C", "coupled"]
    np.testing.assert_allclose(found, k * (np.arange(5.0) + 0.5))
