"""How long the modes of a large building take by its parts, against all of it at once.

Four storeys of the reference unit stand on each other (117,000 degrees of freedom), cut halfway up
their columns: modes below 20 Hz, parts kept to twice that. The limit it is held against is the
project's own block Lanczos iteration on the whole. ``--units 2x5`` puts so many units side by side
on every storey, as far as memory goes, and leaves the whole out.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from dataclasses import replace

import numpy as np

from trundle.dynamics import modes_by_shifts
from trundle.structure import Floor, build_floor, reference_plan
from trundle.structure.superelements import Cuts, Parting

HEIGHT, WIDTH, DEPTH = 8.5, 52.0, 83.5
F_MAX = 20.0


def stacked(nx: int, ny: int, nz: int, *, mesh_size: float = 1.0) -> Floor:
    """Stand units beside and on each other; half a column reaches up and down from each."""
    half = 0.5 * HEIGHT
    unit = build_floor(
        replace(reference_plan(), storey_below=half, storey_above=half), mesh_size=mesh_size
    )
    at, n = unit.nodes, len(unit.nodes)
    feet = np.abs(at[:, 2] + half) < 1e-6
    # planes of symmetry are the building's, not each unit's
    edges = ((0, 0.0, 0, [0, 4, 5]), (0, WIDTH, nx - 1, [0, 4, 5]), (1, 0.0, 0, [1, 3, 5]))
    nodes, fixed = [], []
    places = [(i, j, k) for k in range(nz) for j in range(ny) for i in range(nx)]
    for place in places:
        nodes.append(at + np.array(place) * [WIDTH, DEPTH, HEIGHT])
        mine = np.zeros_like(unit.fixed)
        for axis, where, outer, dofs in edges:
            on = np.abs(at[:, axis] - where) < 1e-6
            mine[np.ix_(on, dofs)] |= place[axis] == outer
        mine[feet] |= place[2] == 0
        fixed.append(mine)
    every = np.vstack(nodes)
    _, first, which = np.unique(
        np.round(every * 1e5).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    number = rank[which.ravel()]
    joined = np.zeros((len(order), 6), dtype=bool)
    np.logical_or.at(joined, number, np.vstack(fixed))
    copies = np.arange(len(places))[:, None, None] * n

    def placed(group):
        ends = (group.elements[None] + copies).reshape(-1, group.elements.shape[1])
        return replace(group, elements=number[ends])

    return Floor(
        name="stacked units",
        nodes=every[first[order]],
        fixed=joined,
        shells=tuple(map(placed, unit.shells)),
        beams=tuple(map(placed, unit.beams)),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description="Time modes by parts against the whole.")
    parser.add_argument("--units", default="1x1", help="units along x and along y, such as 2x5")
    parser.add_argument("--storeys", type=int, default=4)
    parser.add_argument("--band", type=float, default=2.0, help="of parts, times 20 Hz")
    given = parser.parse_args()
    nx, ny = map(int, given.units.split("x"))
    floor = stacked(nx, ny, given.storeys)
    cuts = Cuts(
        x=WIDTH * np.arange(1, nx),
        y=DEPTH * np.arange(1, ny),
        z=HEIGHT * (np.arange(1, given.storeys) - 0.5),
    )
    parted = Parting(cuts=cuts, f_parts=given.band * F_MAX, f_seams=5 * F_MAX).of(floor)
    start = time.process_time()
    pieces = parted.pieces
    sorted_at = time.process_time()
    pencil = parted.joined.pencil
    reduced_at = time.process_time()
    count = pencil.factorise((2 * np.pi * F_MAX) ** 2).n_negative
    counted_at = time.process_time()
    modes = modes_by_shifts(pencil, f_max=F_MAX)
    end = time.process_time()
    found = {
        "degrees of freedom": floor.n_dofs,
        "parts": len(pieces.placed),
        "distinct parts": len(pieces.distinct),
        "coordinates of parts and seams": [pencil.n_modes, pencil.n_seams],
        "modes below 20 Hz, by inertia": count,
        "modes found": modes.n_modes,
        "CPU s to sort parts": round(sorted_at - start, 1),
        "CPU s to reduce": round(reduced_at - sorted_at, 1),
        "CPU s to count": round(counted_at - reduced_at, 2),
        "CPU s of modes": round(end - counted_at, 1),
        "peak GB": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6, 2),
    }
    if nx * ny == 1:
        start = time.process_time()
        whole = floor.modes(F_MAX).omega
        spent = time.process_time() - start
        error = modes.omega / whole[: modes.n_modes] - 1.0
        found |= {
            "modes of the whole": len(whole),
            "CPU s of the whole": round(spent, 1),
            "by parts over the whole": round((end - sorted_at) / spent, 2),
            "largest and middle error": [
                float(f"{x:.2g}") for x in (error.max(), np.median(error))
            ],
        }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
