"""Rate of the ensemble kernel against DGEMM, and its memory, in one run.

1000 coupled runs of the container truck over the reference unit: 1000 modes, 4000 steps. Counted
are the products that the method needs: contact rows and modal state 4 n_c each, points 12 n_p
operations a mode, step and run; forming the maps and the free motion of the modes are not counted.
"""

import json
import resource
import time

import numpy as np
from threadpoolctl import ThreadpoolController

import trundle as tr
from trundle.simulate import Coupled, Crossing, Modal, lay_out, prepare
from trundle.simulate._roads import roads_under_wheels
from trundle.simulate.ensemble import batch_size
from trundle.study.mode_cache import modes_of

MODES, STEPS, RUNS, DT = 1000, 4000, 1000, 0.005


def dgemm_rate() -> float:
    a = np.random.default_rng(0).standard_normal((2000, 2000))
    a @ a
    start = time.perf_counter()
    for _ in range(4):
        a @ a
    return 4 * 2 * 2000**3 / (time.perf_counter() - start)


def main() -> None:
    floor = tr.structure.reference_unit(mesh_size=1.0)
    modes = modes_of(floor, f_max=100.0)
    method = Coupled(integration=Modal(f_max=float(modes.frequencies[MODES]) - 1e-9, dt=DT))
    prepared = prepare(floor, method.integration, method.damping, modes=modes)
    route = tr.route.Route.straight((0, 76.5), (52, 76.5), speed=15 / 3.6, name="rear")
    crossing = Crossing(tr.vehicle.container_truck_40ft(), route, tr.road.RoadClass("B"))
    layout = lay_out(
        prepared, crossing, method=method, points={"p": (32.5, 62.5)}, duration=STEPS * DT
    )
    n_modes = prepared.modes.n_modes
    del floor, modes, prepared  # a layout holds what it needs of them
    before = dgemm_rate()
    kernel = 0.0
    start = time.perf_counter()
    size = batch_size(layout)
    for first in range(0, RUNS, size):
        runs = range(first, min(first + size, RUNS))
        road = roads_under_wheels(layout.crossings, layout.timeline, runs, seed=1)
        begun = time.perf_counter()
        layout.over(road)
        kernel += time.perf_counter() - begun
    whole = time.perf_counter() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6  # of the whole process
    dgemm = 0.5 * (before + dgemm_rate())
    on_floor = np.mean(
        [layout.floor.loads(i, i + 1).any(axis=(0, 2)).sum() for i in range(0, STEPS, 40)]
    )
    operations = (8 * on_floor + 12) * n_modes * STEPS * RUNS
    blas = [pool["internal_api"] for pool in ThreadpoolController().info()]
    print(
        json.dumps(
            {
                "modes": n_modes,
                "wheels_on_floor_mean": round(float(on_floor), 2),
                "kernel_s": round(kernel, 2),
                "kernel_and_roads_s": round(whole, 2),
                "kernel_gflops": round(operations / kernel / 1e9, 1),
                "dgemm_gflops": round(dgemm / 1e9, 1),
                "kernel_over_dgemm": round(operations / kernel / dgemm, 3),
                "resident_gb": round(memory, 2),
                "blas": blas,
            }
        )
    )


if __name__ == "__main__":
    main()
