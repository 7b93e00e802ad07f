"""Time of a full-floor map of 1000 coupled runs of the reference unit, and its memory.

Modes below 90 Hz, steps of 5 ms, 25 s, a grid of 4 m (273 places). Contact forces of all runs are
computed first and timed apart. Beside it what histories at as many places would cost by the
products alone, at the rate of DGEMM in the same run: displacement and velocity of all modes at
every step, before any filter.
"""

import argparse
import json
import resource
import time

import numpy as np
from settings import dgemm_rate, rear_crossing

import trundle as tr
from trundle.response import floor_map
from trundle.run.mode_cache import modes_of
from trundle.simulate import (
    Coupled,
    Modal,
    contact_force_histories,
    lay_out,
    lay_out_places,
    prepare,
)
from trundle.structure import Spots


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--spacing", type=float, default=4.0, help="of the grid [m]")
    options = parser.parse_args()
    floor = tr.structure.reference_unit(mesh_size=1.0)
    method = Coupled(integration=Modal(f_max=90.0, dt=0.005))
    modes = modes_of(floor, f_max=90.0)
    prepared = prepare(floor, method.integration, method.damping, modes=modes)
    layout = lay_out(
        prepared, rear_crossing(), method=method, points={"p": (32.5, 62.5)}, duration=25.0
    )
    x, y = (np.arange(0.5 * options.spacing, end, options.spacing) for end in (52.0, 83.5))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    rate = dgemm_rate()
    start = time.perf_counter()
    forces, _ = contact_force_histories(layout, runs=range(options.runs), seed=1)
    forces_s = time.perf_counter() - start
    found = {"runs": options.runs, "places": len(places), "forces_s": round(forces_s, 1)}
    responses = lay_out_places(prepared, layout, Spots(xy=places))
    for name, averaging, peaks in (
        ("event", "event", False), ("max_1s", "max_1s", False), ("max_1s_and_peaks", "max_1s", True),
    ):  # fmt: skip
        start = time.perf_counter()
        floor_map(responses, forces, f_max=90.0, averaging=averaging, peaks=peaks)
        found[f"{name}_s"] = round(time.perf_counter() - start, 1)
    operations = 4.0 * modes.n_modes * len(places) * len(layout.time) * options.runs
    found["histories_by_dgemm_s"] = round(operations / rate, 1)
    found["resident_gb"] = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6, 2)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
