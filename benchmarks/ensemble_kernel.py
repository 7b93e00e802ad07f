"""Rate of the ensemble kernel against DGEMM and against numpy, and its memory, in one run.

1000 coupled runs of the container truck over the reference unit: 1000 modes, 4000 steps. Counted
are the products that the method needs: contact rows and modal state 4 n_c each, points 12 n_p
operations a mode, step and run; forming the maps and the free motion of the modes are not counted.

The numpy peer steps all runs together too, a step at a time, as one would write it: arrays of
modes by runs, a contact system of three wheels each step. It drives the first steps alone, and its
accelerations must be the kernel's.
"""

import argparse
import json
import resource
import time
from dataclasses import replace

import numpy as np
from settings import dgemm_rate, rear_layout
from threadpoolctl import ThreadpoolController

from trundle.dynamics import ExactRecursion
from trundle.simulate.ensembles import batch_size
from trundle.simulate.modal.block_march import drive_in_blocks
from trundle.simulate.wheels.roads import roads_under_wheels

MODES, STEPS, RUNS, DT = 1000, 4000, 1000, 0.005
PEER_STEPS = 200


def kernel(layout) -> tuple[float, float]:
    """Return the seconds of the kernel alone, and with the drawing of roads."""
    spent, start, size = 0.0, time.perf_counter(), batch_size(layout)
    for first in range(0, RUNS, size):
        runs = range(first, min(first + size, RUNS))
        road = roads_under_wheels(layout.sources, layout.timeline, runs, seed=1)
        begun = time.perf_counter()
        layout.over(road)
        spent += time.perf_counter() - begun
    return spent, time.perf_counter() - start


def numpy_steps(layout, road):
    """Step all runs in plain numpy; return accelerations at the point, and seconds a step."""
    contacts, floor = layout.wheels.contacts, layout.ground.floor
    springs, modal = contacts.springs, floor.propagator
    vehicle, e = ExactRecursion(contacts.standing, DT), springs.contact_map
    felt = np.hstack([springs.stiffness * e, springs.damping * e])
    start_v, end_v = vehicle.from_start @ e.T, vehicle.from_end @ e.T
    left = np.eye(len(e)) - felt @ end_v  # of a push at the held vehicle
    phi = modal.phi[..., None]
    start, end = (g.T[..., None] for g in (modal.from_start, modal.from_end))
    rigid = replace(layout, ground=layout.integration.rigid()).over(road).forces
    z, push = np.zeros((len(vehicle.phi), road.n_runs)), np.zeros((len(e), road.n_runs))
    u, forces = np.zeros((floor.n_modes, road.n_runs)), rigid[0]
    v, load = np.zeros_like(u), floor.loads(0, 1)[0]
    read, found = floor.points[0], []
    begun = time.perf_counter()
    for step in range(1, PEER_STEPS + 1):
        pressing = load.T @ forces
        uf = phi[:, 0, 0] * u + phi[:, 0, 1] * v - start[0] * pressing
        vf = phi[:, 1, 0] * u + phi[:, 1, 1] * v - start[1] * pressing
        load = floor.loads(step, step + 1)[0]
        value, slope = (part[0] for part in floor.shapes(step, step + 1))
        speed = floor.speed[step][:, None]
        on_u = springs.stiffness * value + springs.damping * speed * slope
        on_v = springs.damping * value
        sink = (on_u * end[0].T + on_v * end[1].T) @ load.T
        free, known = vehicle.phi @ z + start_v @ push, on_u @ uf + on_v @ vf
        right = rigid[step] + left @ known - felt @ free
        forces = np.linalg.solve(np.eye(len(e)) + left @ sink, right)
        push = known - sink @ forces
        z = free + end_v @ push
        pressing = load.T @ forces
        u, v = uf - end[0] * pressing, vf - end[1] * pressing
        held = modal.square[:, None] * u + modal.double[:, None] * v
        found.append(-read @ (held + pressing))
    return np.array(found), (time.perf_counter() - begun) / PEER_STEPS


def peer() -> dict[str, float]:
    layout = rear_layout(n_modes=MODES, dt=DT, duration=PEER_STEPS * DT, residual=False)
    road = roads_under_wheels(layout.sources, layout.timeline, range(RUNS), seed=1)
    theirs, seconds = numpy_steps(layout, road)
    recorded = drive_in_blocks(  # the peer completes no motion
        layout.wheels, layout.ground.floor, road, weight=np.ones(RUNS), coupled=True
    )
    ours = recorded.acceleration[1 : PEER_STEPS + 1, 0]
    return {
        "numpy_step_ms": 1e3 * seconds,
        "numpy_largest_difference": float(np.abs(theirs - ours).max() / np.abs(ours).max()),
    }


def single() -> dict[str, float]:
    """Return the kernel's time in single precision, and how far it is from double."""
    layouts = [
        rear_layout(n_modes=MODES, dt=DT, duration=STEPS * DT, single=kind)
        for kind in (False, True)
    ]
    road = roads_under_wheels(layouts[0].sources, layouts[0].timeline, range(16), seed=1)
    double, other = (layout.over(road).acceleration for layout in layouts)
    return {
        "single_kernel_s": kernel(layouts[1])[0],
        "single_largest_difference": float(np.abs(other - double).max() / np.abs(double).max()),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--no-numpy", action="store_true", help="leave the peer out")
    options = parser.parse_args()
    layout = rear_layout(n_modes=MODES, dt=DT, duration=STEPS * DT)
    n_modes = layout.ground.floor.n_modes
    before = dgemm_rate()
    alone, whole = kernel(layout)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6  # of the whole process
    dgemm = 0.5 * (before + dgemm_rate())
    on_floor = np.mean(
        [layout.ground.floor.loads(i, i + 1).any(axis=(0, 2)).sum() for i in range(0, STEPS, 40)]
    )
    operations = (8 * on_floor + 12) * n_modes * STEPS * RUNS
    found = {
        "modes": n_modes,
        "wheels_on_floor_mean": float(on_floor),
        "kernel_s": alone,
        "kernel_and_roads_s": whole,
        "kernel_gflops": operations / alone / 1e9,
        "dgemm_gflops": dgemm / 1e9,
        "kernel_over_dgemm": operations / alone / dgemm,
        "resident_gb": memory,
        "blas": [pool.get("architecture", "") for pool in ThreadpoolController().info()],
    }
    found |= single()
    if not options.no_numpy:
        found |= peer()
        found["numpy_over_kernel"] = found["numpy_step_ms"] / (1e3 * alone / STEPS)
    short = {k: float(f"{v:.4g}") if isinstance(v, float) else v for k, v in found.items()}
    print(json.dumps(short))


if __name__ == "__main__":
    main()
