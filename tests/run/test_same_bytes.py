"""The same study gives the same bytes on a floor of the demo's size, whatever computes it."""

import hashlib
import os
import subprocess
import sys

import pytest

STUDY = """
title = "Same bytes"
seed = 3
runs = 20
[floor]
kind = "reference_unit"
mesh_size = "1 m"
[vehicle.truck]
kind = "container_truck_40ft"
[[route]]
name = "rear"
vehicle = "truck"
path = [["0 m", "76.5 m"], ["52 m", "76.5 m"]]
speed = "40 km/h"
[[road]]
class = "B"
[roughness]
n_max = "2 1/m"
[[point]]
name = "centre"
at = ["32.5 m", "62.5 m"]
[[method]]
name = "coupled"
interaction = "coupled"
f_max = "15 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
[criteria]
method = "coupled"
curves = ["office"]
[map]
spacing = "13 m"
runs = 4
"""
RUN = "from trundle.cli.app import main; main()"


def bytes_of(folder):
    """Return a hash of every file that numbers stand in."""
    names = [f for f in sorted(folder.rglob("*")) if f.is_file()]
    kept = [f for f in names if "results.zarr" in f.parts or f.name.startswith("summary")]
    whole = hashlib.sha256()
    for file in kept:
        whole.update(str(file.relative_to(folder)).encode() + file.read_bytes())
    return whole.hexdigest()


@pytest.mark.longest
def test_threads_workers_and_what_other_studies_left_change_no_byte(tmp_path):
    """One thread, two, two workers, three; a cold cache of modes, and one that holds them.

    Sums that threads share differ in their last digits by who adds what; so nothing is shared.
    """
    (tmp_path / "study.toml").write_text(STUDY)
    found = {}
    for name, threads, cache, options in (
        ("one thread", "1", "cold", []),
        ("two threads", "2", "another", []),
        ("kept modes", "2", "cold", []),
        ("two workers", "2", "third", ["--workers", "2"]),
        ("three workers", "2", "cold", ["--workers", "3"]),
    ):
        out = tmp_path / name.replace(" ", "_")
        environment = os.environ | {
            "TRUNDLE_THREADS": threads, "OPENBLAS_NUM_THREADS": threads,
            "MKL_NUM_THREADS": threads, "OMP_NUM_THREADS": threads,
            "TRUNDLE_CACHE": str(tmp_path / cache),
        }  # fmt: skip
        command = [sys.executable, "-c", RUN, "run", "study.toml", "--out", str(out), *options]
        subprocess.run(
            command, cwd=tmp_path, env=environment, check=True, capture_output=True, timeout=240
        )
        found[name] = bytes_of(out)
    assert len(set(found.values())) == 1, found
