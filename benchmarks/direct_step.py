"""Time a direct step, decoupled and coupled, against one bare back-substitution."""

import json
import time

import numpy as np

import trundle as tr
from trundle.dynamics import available_backends
from trundle.simulate import Coupled, Crossing, Decoupled, Newmark, Rayleigh, ensemble, prepare

STEPS = 400


def main() -> None:
    floor = tr.structure.reference_unit(mesh_size=1.0)
    newmark = Newmark(dt=0.025)
    damping = Rayleigh(alpha=0.8587, beta=0.001)
    prepared = prepare(floor, newmark, damping)
    load = np.random.default_rng(0).standard_normal((floor.n_dofs, 1))
    solver = prepared.propagator.solver
    solver.solve(load)
    start = time.perf_counter()
    for _ in range(STEPS // 4):
        solver.solve(load)
    bare = (time.perf_counter() - start) / (STEPS // 4)
    route = tr.route.Route.straight((0, 76.5), (52, 76.5), speed=15 / 3.6, name="rear")
    crossing = Crossing(
        vehicle=tr.vehicle.container_truck_40ft(),
        route=route,
        road=tr.road.RoadClass("B"),
        run_in=0.0,
    )
    seconds = {}
    for kind in (Decoupled, Coupled):
        times = []
        for steps in (2, STEPS):  # the difference leaves out what is done once
            start = time.perf_counter()
            ensemble(
                prepared, crossing, method=kind(integration=newmark, damping=damping),
                points={"p": (32.5, 62.5)}, n_runs=1, seed=1, duration=steps * newmark.dt,
            )  # fmt: skip
            times.append(time.perf_counter() - start)
        seconds[kind.__name__] = (times[1] - times[0]) / (STEPS - 2)
    print(
        json.dumps(
            {
                "backend": available_backends()[0],
                "n_dofs": floor.n_dofs,
                "back_substitution_ms": round(1e3 * bare, 3),
                "decoupled_over_back_substitution": round(seconds["Decoupled"] / bare, 3),
                "coupled_over_decoupled": round(seconds["Coupled"] / seconds["Decoupled"], 3),
            }
        )
    )


if __name__ == "__main__":
    main()
