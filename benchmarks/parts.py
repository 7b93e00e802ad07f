"""How long the modes of a large building take by its parts, against all of it at once.

Four storeys of the reference unit stand on each other (117,000 degrees of freedom), cut halfway up
their columns: modes below 20 Hz, parts kept to twice that. The limit it is held against is the
project's own block Lanczos iteration on the whole. ``--units 2x5`` puts so many units side by side
on every storey, as far as memory goes, and leaves the whole out. ``--runs 1000`` drives the paper's
truck over so many roads along a driveway of the third storey, coupled, and reads tools on three.
``--count`` proves how many modes there are, and finds none of them. ``--answers 0.05`` finds what
answers between the driveway and the tools within that error, in place of all modes.
Parts are kept in the folder that ``TRUNDLE_CACHE`` names, and nowhere if it names none.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import time
from dataclasses import replace

import numpy as np

from trundle.dynamics import ModalRatio, Modes, answering_modes, repeatable
from trundle.response import join, reduce_runs
from trundle.road import RoadClass
from trundle.route import Route
from trundle.run.kept_answers import Asked, keep_answers, kept_answers
from trundle.run.parts import modes_by_parts, with_kept_parts
from trundle.simulate import Coupled, Crossing, Modal, lay_out, prepare, runs_with_mean
from trundle.simulate.laying_out import point_rows
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.wheels.standing import route_dofs
from trundle.structure import Floor, Frame, Spot, Surface, build_floor, reference_plan
from trundle.structure.superelements import (
    Cuts,
    PartedStructure,
    Parting,
    as_modes_of,
    questions_of,
)
from trundle.vehicle import library_vehicle

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


def with_decks(floor: Floor, nz: int) -> Floor:
    """Give every storey's slab a name to drive and stand on."""
    decks = tuple(
        Surface(
            name=f"storey {k}",
            nodes=floor.nodes,
            groups=floor.shells,
            frame=Frame.level(k * HEIGHT),
        )
        for k in range(nz)
    )
    return replace(floor, decks=decks)


ROUTE = replace(Route.straight((0.0, 76.5), (WIDTH, 76.5), speed=15 / 3.6), on="storey 2")
TRUCK = Crossing(library_vehicle("container_truck_40ft"), ROUTE, RoadClass("B"))
TOOLS = {f"storey {k}": Spot(x=32.5, y=62.5, on=f"storey {k}") for k in (1, 2, 3)}
DAMPING = ModalRatio(ratio=0.03)


def answering(parted: PartedStructure, tolerance: float) -> Modes:
    """Find what answers between the driveway and the tools, in place of all modes."""
    dofs, read = route_dofs(parted, as_sources(TRUCK)), point_rows(parted, TOOLS)
    questions = questions_of(parted, dofs, read)
    asked = Asked(structure=parted, questions=questions, ratios=DAMPING.ratios, f_max=F_MAX)
    found = kept_answers(asked)  # in TRUNDLE_CACHE, where that names a folder
    if found is None:
        pencil = parted.joined.pencil
        found = answering_modes(pencil, questions, DAMPING.ratios, f_max=F_MAX, tolerance=tolerance)
        keep_answers(asked, found)
    return as_modes_of(parted, found)


def crossing_levels(parted: PartedStructure, modes: Modes, runs: int) -> dict[str, object]:
    """Drive the paper's truck along one driveway, and read tools on three storeys."""
    method = Coupled(
        integration=Modal(f_max=F_MAX, dt=0.01, response_tolerance=0.005),
        damping=DAMPING,
    )
    start = time.process_time()
    prepared = prepare(parted, method.integration, method.damping, modes=modes)
    layout = lay_out(prepared, TRUCK, method=method, points=TOOLS)
    laid_out = time.process_time()
    found = []
    for first in range(0, runs, 100):
        some, _ = runs_with_mean(layout, runs=range(first, min(first + 100, runs)), seed=1)
        found.append(reduce_runs(some, averaging="max_1s"))
    spectra = join(found).spectra
    shown = np.flatnonzero(spectra.resolved)
    mean = np.sqrt(np.mean(spectra.values[:, :, shown] ** 2, axis=0))
    doubt = next((d.message for d in layout.doubts if d.subject == "response basis"), "all modes")
    return {
        "CPU s to lay out one crossing": round(laid_out - start, 1),
        f"CPU s of {runs} roads with levels": round(time.process_time() - laid_out, 1),
        "response basis": doubt,
        "loudest band of tools [um/s], RMS of runs": {
            name: [
                float(f"{1e6 * row.max():.3g}"),
                f"{spectra.mid_band[shown][int(row.argmax())]:.3g} Hz",
            ]
            for name, row in zip(TOOLS, mean, strict=True)
        },
    }


def apart(floor: Floor, whole: Modes, parted: PartedStructure, modes: Modes) -> dict[str, str]:
    """Return by how much a crossing of ten roads differs by parts: RMS, peaks, and bands."""
    found = []
    for structure, known in ((floor, whole), (parted, modes)):
        method = Coupled(integration=Modal(f_max=F_MAX, dt=0.01), damping=DAMPING)
        prepared = prepare(structure, method.integration, DAMPING, modes=known)
        layout = lay_out(prepared, TRUCK, method=method, points=TOOLS)
        some, _ = runs_with_mean(layout, runs=range(10), seed=1)
        found.append(reduce_runs(some, averaging="max_1s"))
    theirs, ours = found
    shown = theirs.spectra.resolved
    pairs = {
        "RMS": (ours.rms_velocity, theirs.rms_velocity),
        "peaks": (ours.peak_acceleration, theirs.peak_acceleration),
        "bands": (ours.spectra.values[..., shown], theirs.spectra.values[..., shown]),
    }
    off = {name: np.abs(a / b - 1.0) for name, (a, b) in pairs.items()}
    return {
        name: f"largest {100 * x.max():.2g} %, middle {100 * np.median(x):.2g} %"
        for name, x in off.items()
    }


def main() -> None:
    os.environ.setdefault("TRUNDLE_CACHE", "")
    with repeatable():  # as a run holds it
        measured()


def measured() -> None:
    """Measure what is asked for, and print it."""
    parser = argparse.ArgumentParser(description="Time modes by parts against the whole.")
    parser.add_argument("--units", default="1x1", help="units along x and along y, such as 2x5")
    parser.add_argument("--storeys", type=int, default=4)
    parser.add_argument("--band", type=float, default=2.0, help="of parts, times 20 Hz")
    parser.add_argument("--mesh", type=float, default=1.0, help="largest element edge [m]")
    parser.add_argument("--runs", type=int, default=0, help="roads of a coupled crossing")
    parser.add_argument("--answers", type=float, help="error within which what answers is found")
    parser.add_argument("--count", action="store_true", help="count modes, and find none of them")
    given = parser.parse_args()
    nx, ny = map(int, given.units.split("x"))
    floor = with_decks(stacked(nx, ny, given.storeys, mesh_size=given.mesh), given.storeys)
    cuts = Cuts(
        x=WIDTH * np.arange(1, nx),
        y=DEPTH * np.arange(1, ny),
        z=HEIGHT * (np.arange(1, given.storeys) - 0.5),
    )
    parted = Parting(
        cuts=cuts,
        f_parts=given.band * F_MAX,
        f_seams=5 * F_MAX,
        response_tolerance=given.answers or 0.0,
    ).of(floor)
    parted = with_kept_parts(parted)  # in TRUNDLE_CACHE, where that names a folder
    start = time.process_time()
    pieces = parted.pieces
    sorted_at = time.process_time()
    pencil = parted.joined.pencil
    reduced_at = time.process_time()
    count = pencil.factorise((2 * np.pi * F_MAX) ** 2).n_negative
    counted_at = time.process_time()
    modes = None
    if given.answers:
        modes = answering(parted, given.answers)
    elif not given.count:
        modes = modes_by_parts(parted, F_MAX)
    end = time.process_time()
    found = {
        "degrees of freedom": floor.n_dofs,
        "parts": len(pieces.placed),
        "distinct parts": len(pieces.distinct),
        "coordinates of parts and seams": [pencil.n_modes, pencil.n_seams],
        "modes below 20 Hz, by inertia": count,
        "CPU s to sort parts": round(sorted_at - start, 1),
        "CPU s to reduce": round(reduced_at - sorted_at, 1),
        "CPU s to count": round(counted_at - reduced_at, 2),
        "peak GB": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6, 2),
    }
    if modes is not None:
        found |= {"modes found": modes.n_modes, "CPU s of modes": round(end - counted_at, 1)}
        found |= {"answers": modes.answering} if modes.answering else {}
    if modes is not None and not given.answers and nx * ny == 1:
        start = time.process_time()
        known = floor.modes(F_MAX)
        whole = known.omega
        spent = time.process_time() - start
        found |= {"crossing by parts against the whole": apart(floor, known, parted, modes)}
        error = modes.omega / whole[: modes.n_modes] - 1.0
        found |= {
            "modes of the whole": len(whole),
            "CPU s of the whole": round(spent, 1),
            "by parts over the whole": round((end - sorted_at) / spent, 2),
            "largest and middle error": [
                float(f"{x:.2g}") for x in (error.max(), np.median(error))
            ],
        }
    if modes is not None and given.runs:
        found |= crossing_levels(parted, modes, given.runs)
        found["peak GB"] = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6, 2)
    found["CPU s of all"] = round(time.process_time(), 1)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
