"""Time of a run and step when direct runs share one factorisation, against runs one by one.

The reference unit at 1 m, Newmark's method, coupled and decoupled, 1 to 64 runs together; beside
them as many right-hand sides through the same factor, which is what nothing can beat.
"""

import json
import time
from dataclasses import replace

import numpy as np
from direct_step import DAMPING, NEWMARK
from settings import POINT, rear_crossing

import trundle as tr
from trundle.simulate import Coupled, Decoupled, lay_out, prepare
from trundle.simulate.wheels.roads import roads_under_wheels

STEPS = 100
TOGETHER = (1, 8, 64)


def per_run(layout, n_runs: int) -> float:
    road = roads_under_wheels(layout.sources, layout.timeline, range(n_runs), seed=1)
    layout.over(road)
    start = time.perf_counter()
    layout.over(road)
    return (time.perf_counter() - start) / STEPS / n_runs


def back_substitution(solver, n_dofs: int, columns: int) -> float:
    load = np.random.default_rng(0).standard_normal((n_dofs, columns))
    solver.solve(load)
    start = time.perf_counter()
    for _ in range(10):
        solver.solve(load)
    return (time.perf_counter() - start) / 10 / columns


def main() -> None:
    floor = tr.structure.reference_unit(mesh_size=1.0)
    prepared = prepare(floor, NEWMARK, DAMPING)
    crossing = replace(rear_crossing(), run_in=0.0)
    rows = []
    for n_runs in TOGETHER:
        row = {"runs": n_runs}
        bare = back_substitution(prepared.propagator.solver, floor.n_dofs, n_runs)
        row["back_substitution_ms"] = round(1e3 * bare, 2)
        for kind in (Decoupled, Coupled):
            method = kind(integration=NEWMARK, damping=DAMPING)
            layout = lay_out(
                prepared, crossing, method=method, points={"p": POINT},
                duration=STEPS * NEWMARK.dt,
            )  # fmt: skip
            name = kind.__name__.lower()
            row[f"{name}_ms"] = round(1e3 * per_run(layout, n_runs), 2)
        rows.append(row)
    gain = {n: round(rows[0][n] / rows[-1][n], 2) for n in ("decoupled_ms", "coupled_ms")}
    print(json.dumps({"per_run_and_step": rows, "gain_of_64_together": gain}))


if __name__ == "__main__":
    main()
