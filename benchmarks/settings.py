"""What several benchmarks share: the reference unit, and the truck on its rear road."""

import time

import numpy as np

import trundle as tr
from trundle.run.mode_cache import modes_of
from trundle.simulate import Coupled, Crossing, Modal, lay_out, prepare

POINT = (32.5, 62.5)


def rear_crossing(*, speed_kmh: float = 15.0) -> Crossing:
    route = tr.route.Route.straight((0, 76.5), (52, 76.5), speed=speed_kmh / 3.6, name="rear")
    return Crossing(tr.vehicle.container_truck_40ft(), route, tr.road.RoadClass("B"))


def rear_layout(*, dt: float, duration: float, f_max: float = 0.0, n_modes: int = 0, **modal):
    """Lay the rear road out in the modes below a frequency, or in the first so many."""
    floor = tr.structure.reference_unit(mesh_size=1.0)
    modes = modes_of(floor, f_max=100.0 if n_modes else f_max)
    if n_modes:
        f_max = float(modes.frequencies[n_modes]) - 1e-9
    method = Coupled(integration=Modal(f_max=f_max, dt=dt, **modal))
    prepared = prepare(floor, method.integration, method.damping, modes=modes)
    return lay_out(prepared, rear_crossing(), method=method, points={"p": POINT}, duration=duration)


def dgemm_rate() -> float:
    """Return the operations a second of a product of large matrices, on all threads."""
    a = np.random.default_rng(0).standard_normal((2000, 2000))
    a @ a
    start = time.perf_counter()
    for _ in range(4):
        a @ a
    return 4 * 2 * 2000**3 / (time.perf_counter() - start)
