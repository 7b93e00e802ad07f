"""Show that memory does not grow with the number of runs: 100 to 100,000 runs of one crossing.

Every size runs in a process of its own; the reference unit in its modes below 20 Hz, steps of
25 ms, 25 s. What is kept of each run are its peaks and levels.
"""

import argparse
import json
import resource
import subprocess
import sys
import time

import trundle as tr
from trundle.response import join, reduce_on_scaled_roads
from trundle.run.mode_cache import modes_of
from trundle.simulate import Coupled, Crossing, Modal, batches, lay_out, mean_response, prepare

SIZES = (100, 1000, 10_000, 100_000)


def run(n_runs: int) -> None:
    floor = tr.structure.reference_unit(mesh_size=1.0)
    method = Coupled(integration=Modal(f_max=20.0, dt=0.025))
    modes = modes_of(floor, f_max=20.0)
    prepared = prepare(floor, method.integration, method.damping, modes=modes)
    route = tr.route.Route.straight((0, 76.5), (52, 76.5), speed=15 / 3.6, name="rear")
    crossing = Crossing(tr.vehicle.container_truck_40ft(), route, tr.road.RoadClass("B"))
    points = {"p": (32.5, 62.5)}
    layout = lay_out(prepared, crossing, method=method, points=points, duration=25.0)
    del floor, modes, prepared  # the layout holds what it needs of them
    start = time.perf_counter()
    kept, mean = [], mean_response(layout)
    for part in batches(layout, runs=range(n_runs), seed=1):
        kept.append(reduce_on_scaled_roads(part, mean, [1.0])[0])
        del part  # before the next is computed
    seconds = time.perf_counter() - start
    assert len(join(kept).peak_acceleration) == n_runs
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(json.dumps({"runs": n_runs, "seconds": round(seconds, 1), "resident_mb": round(memory)}))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--runs", type=int, help="one size, in this process")
    options = parser.parse_args()
    if options.runs:
        run(options.runs)
        return
    rows = []
    for size in SIZES:
        done = subprocess.run(
            [sys.executable, __file__, "--runs", str(size)], check=True, stdout=subprocess.PIPE
        )
        rows.append(json.loads(done.stdout))
        print(rows[-1], file=sys.stderr, flush=True)
    growth = rows[-1]["resident_mb"] / rows[1]["resident_mb"]
    print(json.dumps({"sizes": rows, "growth_from_1000_to_100000": round(growth, 3)}))


if __name__ == "__main__":
    main()
