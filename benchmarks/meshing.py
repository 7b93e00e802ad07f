"""How long a large building takes to mesh and to assemble, and in how much memory.

A tower of four storeys, 64 m by 64 m, flat slabs with openings on 81 columns a storey and a core of
walls: 200,000 degrees of freedom at 0.75 m. The limit it is held against is the assembly alone,
K and M of all elements, which no mesher can go below.
"""

from __future__ import annotations

import json
import resource
import time

import numpy as np

from trundle.structure import CONCRETE, ShellSection
from trundle.structure.building import (
    Building,
    Column,
    Meshing,
    Profile,
    Slab,
    Storey,
    Wall,
    build_building,
)


def box(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def tower(storeys: int = 4, bays: int = 8, bay: float = 8.0) -> Building:
    side = bays * bay
    levels = [Storey(name=f"level {i}", level=4.0 * i) for i in range(storeys + 1)]
    section = ShellSection(thickness=0.3, material=CONCRETE)
    middle = 0.5 * side
    core = box(middle + 1.5, middle + 1.5, middle + 6.5, middle + 6.5)
    post = Profile.rectangle(0.6, 0.6, CONCRETE)
    span = {"bottom": "level 0", "top": f"level {storeys}", "base": "fixed"}
    return Building(
        name="tower",
        storeys=tuple(levels),
        slabs=tuple(
            Slab(
                on=s.name,
                section=section,
                outline=box(-1, -1, side + 1, side + 1),
                openings=(core,),
            )
            for s in levels[1:]
        ),
        columns=tuple(
            Column(profile=post, at=np.array([bay * i, bay * j]), **span)
            for i in range(bays + 1)
            for j in range(bays + 1)
        ),
        walls=tuple(
            Wall(section=section, along=np.stack([core[i], core[(i + 1) % 4]]), **span)
            for i in range(4)
        ),
    )


def main() -> None:
    building = tower()
    start = time.perf_counter()
    floor = build_building(building, Meshing(mesh_size=0.75))
    meshed = time.perf_counter()
    floor.matrices()
    end = time.perf_counter()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    found = {
        "degrees of freedom": floor.n_dofs,
        "nodes": len(floor.nodes),
        "s to check and mesh": round(meshed - start, 2),
        "s to assemble": round(end - meshed, 2),
        "meshing over assembly": round((meshed - start) / (end - meshed), 2),
        "peak GB": round(peak, 2),
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
