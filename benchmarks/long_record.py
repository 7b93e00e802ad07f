"""Show that a layout does not grow with its record: half a minute to an hour of one crossing.

Memory is that of the process above what it had with the floor prepared. What is laid out is where
wheels stand at every step; histories of runs grow with a record, for they are its result.
"""

import argparse
import json
import resource
import time

import numpy as np

from trundle.road import RoadClass, RoughnessBand
from trundle.route import Route
from trundle.simulate import Crossing, Decoupled, lay_out, prepare
from trundle.structure import CONCRETE, FloorPlan, Rectangle, ShellSection, build_floor
from trundle.vehicle import container_truck_40ft

SECONDS = (36.0, 360.0, 3600.0)


def main() -> None:
    argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0]).parse_args()
    plan = FloorPlan(
        x_lines=np.array([0.0, 6.0, 12.0]), y_lines=np.array([0.0, 6.0]), x_extent=(0.0, 12.0),
        y_extent=(0.0, 6.0), slab=ShellSection(thickness=0.2, material=CONCRETE),
        material=CONCRETE, column=Rectangle(width=0.4, depth=0.4), storey_below=4.0,
    )  # fmt: skip
    method = Decoupled()
    prepared = prepare(build_floor(plan, mesh_size=1.5), method.integration, method.damping)
    route = Route.straight((0.0, 3.0), (12.0, 3.0), speed=4.0)
    band = RoughnessBand(n_max=22.0, contact_patch=0.2)
    truck = Crossing(container_truck_40ft(), route, RoadClass("B"), band=band)
    before, rows = _memory(), []
    for seconds in SECONDS:
        start = time.perf_counter()
        lay_out(prepared, truck, method=method, points={"a": (4.0, 3.0)}, duration=seconds)
        rows.append(
            {
                "record_s": seconds,
                "layout_s": round(time.perf_counter() - start, 2),
                "above_mb": round(_memory() - before),
            }
        )
    print(json.dumps({"records": rows}))


def _memory() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


if __name__ == "__main__":
    main()
