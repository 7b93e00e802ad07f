"""Cases whose vehicles leave at different times have records of different lengths."""

import numpy as np
import pytest
import xarray as xr

from studies import GOOD
from trundle.results.cells import CellKey
from trundle.results.store import write_results
from trundle.run.whole_study import run_study
from trundle.study_file.build import load_study

SLOW = """
[[route]]
name = "slow"
vehicle = "truck"
path = [["0 m", "2 m"], ["12 m", "2 m"]]
speed = "10 km/h"

[[traffic]]
name = "both"
routes = ["main", "slow"]
"""


@pytest.mark.longest
def test_shorter_records_are_stored_beside_longer_ones(tmp_path, monkeypatch):
    """Behind their ends stands no number, and before them every one that was computed."""
    monkeypatch.setenv("TRUNDLE_CACHE", "")
    path = tmp_path / "study.toml"
    path.write_text(GOOD.replace('duration = "4 s"\n', "") + SLOW)
    result = run_study(load_study(path))
    write_results(result, tmp_path)
    lengths = {}
    with xr.open_datatree(tmp_path / "results.zarr", engine="zarr") as stored:
        histories = stored["histories/coupled"]
        for case in ("main", "slow", "both"):
            history = result.cells[CellKey(case, "B", "coupled")].history
            n = lengths[case] = len(history.time)
            for name in ("displacement", "velocity", "acceleration"):
                values = histories[name].sel(case=case, road="B").values
                np.testing.assert_array_equal(values[:n], getattr(history, name))
                assert np.isnan(values[n:]).all()
            np.testing.assert_array_equal(histories["time"].values[:n], history.time)
            assert stored[f"contacts/{case}/coupled"]["contact_force"].sizes["time"] == n
        assert histories.sizes["time"] == lengths["slow"] == lengths["both"] > lengths["main"]
