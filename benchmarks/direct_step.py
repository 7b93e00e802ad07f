"""Time a direct step, decoupled and coupled, against a back-substitution and against OpenSeesPy.

The reference unit, its mesh of 1 m, Newmark's method with Rayleigh damping and steps of 25 ms. A
step is that of one run, vehicle and readings included. OpenSeesPy builds the same floor of its
own elements and moves a constant force over it; both accelerations are compared.
"""

import argparse
import importlib
import json
import sys
import time
from pathlib import Path

import numpy as np

import trundle as tr
from trundle.dynamics import available_backends
from trundle.road import Profile
from trundle.route import Ramp, Route
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Newmark,
    Rayleigh,
    ensemble,
    lay_out,
    prepare,
)
from trundle.simulate.wheels.roads import roads_under_wheels
from trundle.structure import Hat
from trundle.vehicle import sprung_mass

STEPS = 400
PEER_STEPS = 160
NEWMARK, DAMPING = Newmark(dt=0.025), Rayleigh(alpha=0.8587, beta=0.001)
POINT = (32.5, 62.5)


def back_substitution(prepared) -> float:
    solver = prepared.propagator.solver
    load = np.random.default_rng(0).standard_normal((prepared.floor.n_dofs, 1))
    solver.solve(load)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(60):
            solver.solve(load)
        times.append((time.perf_counter() - start) / 60)
    return float(np.median(times))


def step(prepared, kind) -> float:
    """Return the time of a step; what a layout does once is not part of it."""
    route = Route.straight((0, 76.5), (52, 76.5), speed=15 / 3.6, name="rear")
    crossing = Crossing(
        vehicle=tr.vehicle.container_truck_40ft(), route=route, road=tr.road.RoadClass("B"),
        run_in=0.0,
    )  # fmt: skip
    method = kind(integration=NEWMARK, damping=DAMPING)
    duration = STEPS * NEWMARK.dt
    layout = lay_out(prepared, crossing, method=method, points={"p": POINT}, duration=duration)
    road = roads_under_wheels(layout.sources, layout.timeline, range(1), seed=1)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        layout.over(road)
        times.append((time.perf_counter() - start) / STEPS)
    return float(np.median(times))


def peer(floor, prepared) -> dict[str, float]:
    """Return OpenSeesPy's time a step, and how far its acceleration is from ours."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))
    model = importlib.import_module("opensees_model")
    start, end, speed = (0.0, 76.5), (52.0, 76.5), 15 / 3.6
    nodes, shares, ramp = model.hat_loads(
        floor, start=start, end=end, speed=speed, dt=NEWMARK.dt, n_steps=PEER_STEPS
    )
    crossing = Crossing(
        sprung_mass(mass=10e3, stiffness=1e6), Route.straight(start, end, speed=speed),
        Profile.smooth(), entry=Ramp(length=ramp), run_in=0.0,
    )  # fmt: skip
    method = Decoupled(integration=NEWMARK, damping=DAMPING, contact=Hat())
    ours = ensemble(
        prepared, crossing, method=method, points={"p": POINT}, n_runs=1, seed=0,
        duration=PEER_STEPS * NEWMARK.dt,
    )  # fmt: skip
    node = int(np.abs(floor.nodes - [*POINT, 0.0]).sum(axis=1).argmin())
    force = float(ours.contact_forces[0, 0, 0])
    times = []
    for count in (4, PEER_STEPS):
        begun = time.perf_counter()
        theirs = model.accelerations(
            floor, (nodes, force * shares[: count + 1]), dt=NEWMARK.dt,
            damping=DAMPING, read_at=[node],
        )  # fmt: skip
        times.append(time.perf_counter() - begun)
    a, b = ours.acceleration[0, :, 0], theirs[:, 0]
    return {
        "opensees_step_ms": 1e3 * (times[1] - times[0]) / (PEER_STEPS - 4),
        "peak_against_opensees": float(np.abs(a).max() / np.abs(b).max() - 1),
        "rms_against_opensees": float(np.sqrt(np.mean(a**2) / np.mean(b**2)) - 1),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--no-opensees", action="store_true", help="leave the peer out")
    options = parser.parse_args()
    floor = tr.structure.reference_unit(mesh_size=1.0)
    prepared = prepare(floor, NEWMARK, DAMPING)
    bare = back_substitution(prepared)
    decoupled, coupled = step(prepared, Decoupled), step(prepared, Coupled)
    found = {
        "backend": available_backends()[0],
        "n_dofs": floor.n_dofs,
        "back_substitution_ms": 1e3 * bare,
        "decoupled_step_ms": 1e3 * decoupled,
        "coupled_step_ms": 1e3 * coupled,
        "decoupled_over_back_substitution": decoupled / bare,
        "coupled_over_decoupled": coupled / decoupled,
    }
    if not options.no_opensees:
        found |= peer(floor, prepare(floor, NEWMARK, DAMPING))
        found["opensees_over_decoupled"] = found["opensees_step_ms"] / found["decoupled_step_ms"]
    print(json.dumps({k: round(v, 4) if isinstance(v, float) else v for k, v in found.items()}))


if __name__ == "__main__":
    main()
