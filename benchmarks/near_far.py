"""One unit and its neighbours to high bands: near and far by parts, against the whole stepped directly.

Reference units side by side and on each other, the paper's truck on the driveway of the one in the
middle, tools in it, in the unit beside it and on the storey below. Parts near these are kept to the
whole band, others to less, and what answers stands for all modes. The reference is Newmark's
integration of the unreduced matrices over the same roads, in steps of half a millisecond (--dt): at
80 Hz its periods are 0.5 % too long, 2 % in steps of one. At 90 km/h the crossing takes 2.2 s, for
the integration takes 0.35 s a step; --speed 15 --duration 14 is the paper's, and takes hours. Both
have the same damping, Rayleigh's with 3 % at 15 and 60 Hz.

The direct integration may be left out (--no-reference), or kept in a file and read from it.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from parts import DEPTH, HEIGHT, WIDTH, stacked, with_decks

from trundle.dynamics import Rayleigh, answering_modes, repeatable
from trundle.response import reduce_runs
from trundle.road import RoadClass
from trundle.route import Route
from trundle.run.kept_answers import Asked, keep_answers, kept_answers
from trundle.run.parts import with_kept_parts
from trundle.simulate import Coupled, Crossing, Modal, Newmark, lay_out, prepare, runs_with_mean
from trundle.simulate.laying_out import point_rows
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.wheels.standing import route_dofs
from trundle.structure import Floor, Spot
from trundle.structure.superelements import (
    Cuts,
    PartedStructure,
    Parting,
    as_modes_of,
    questions_of,
)
from trundle.vehicle import library_vehicle

DAMPING = Rayleigh.through(0.03, 15.0, 60.0)
SEED = 1
CROSSING = 14.0  # s that the paper's truck is on the driveway at 15 km/h, and the floor sounds on


def crossing_of(nx: int, ny: int, nz: int, speed: float) -> tuple[Crossing, dict[str, Spot]]:
    """Return the truck in the middle unit of the upper storey, and the tools."""
    x, y = WIDTH * (nx // 2), DEPTH * (ny // 2)
    top = f"storey {nz - 1}"
    road = Route.straight((x, y + 76.5), (x + WIDTH, y + 76.5), speed=speed / 3.6)
    truck = library_vehicle("container_truck_40ft")
    crossing = Crossing(truck, replace(road, on=top), RoadClass("B"))
    tools = {
        "same unit": Spot(x=x + 32.5, y=y + 62.5, on=top),
        "unit beside it": Spot(x=x + 32.5 - (WIDTH if nx > 1 else 0.0), y=y + 62.5, on=top),
        "storey below": Spot(x=x + 32.5, y=y + 62.5, on=f"storey {max(0, nz - 2)}"),
    }
    return crossing, tools


def levels(prepared, method, crossing, tools, given):
    """Return the third-octave levels of every run and tool [m/s], and the bands."""
    layout = lay_out(prepared, crossing, method=method, points=tools, duration=given.duration)
    some, _ = runs_with_mean(layout, runs=range(given.runs), seed=SEED)
    spectra = reduce_runs(some, averaging="max_1s").spectra
    return spectra.mid_band, spectra.values, layout.doubts


def reduced(parted: PartedStructure, crossing: Crossing, tools, given) -> dict[str, object]:
    """Return the levels by parts, and what they took."""
    start = time.process_time()
    dofs, read = route_dofs(parted, as_sources(crossing)), point_rows(parted, tools)
    parted = parted.near_to(np.unique(np.concatenate([dofs, read.indices])))
    pencil = parted.joined.pencil
    joined = time.process_time()
    questions = questions_of(parted, dofs, read)
    asked = Asked(structure=parted, questions=questions, ratios=DAMPING.ratios, f_max=given.f_max)
    found = kept_answers(asked) or answering_modes(
        pencil, questions, DAMPING.ratios, f_max=given.f_max, tolerance=given.answers
    )
    keep_answers(asked, found)
    answered = time.process_time()
    modes = as_modes_of(parted, found)
    method = Coupled(integration=Modal(f_max=given.f_max, dt=given.dt), damping=DAMPING)
    prepared = prepare(parted, method.integration, DAMPING, modes=modes)
    bands, values, _ = levels(prepared, method, crossing, tools, given)
    end = time.process_time()
    return {
        "bands": bands,
        "values": values,
        "told": {
            "distinct parts": len(parted.pieces.distinct),
            "coordinates of parts and seams": [pencil.n_modes, pencil.n_seams],
            "CPU s of parts": round(joined - start, 1),
            "CPU s of answers": round(answered - joined, 1),
            "CPU s of the crossing": round(end - answered, 1),
            "answers": modes.answering,
        },
        "CPU s of the crossing": end - answered,
        "CPU s": end - start,
    }


def direct(floor: Floor, crossing: Crossing, tools, given) -> dict[str, np.ndarray]:
    """Return the levels by direct integration of the whole, from a file if they are there."""
    file = None if given.reference is None else Path(given.reference)
    if file is not None and file.is_file():
        with np.load(file, allow_pickle=False) as kept:
            return {name: kept[name] for name in kept.files}
    start = time.process_time()
    method = Coupled(integration=Newmark(dt=given.dt), damping=DAMPING)
    prepared = prepare(floor, method.integration, DAMPING)
    bands, values, _ = levels(prepared, method, crossing, tools, given)
    found = {"bands": bands, "values": values, "cpu": np.array(time.process_time() - start)}
    if file is not None:
        np.savez(file, **found)
    return found


def compared(
    ours: dict[str, object], theirs: dict[str, np.ndarray], tools, given
) -> dict[str, object]:
    """Return by how much levels differ, RMS of runs, in bands to 40 and to 80 Hz, and the times."""
    bands = theirs["bands"]
    mine, other = (
        np.sqrt(np.mean(np.asarray(v) ** 2, axis=0)) for v in (ours["values"], theirs["values"])
    )
    found: dict[str, object] = {}
    for name, a, b in zip(tools, mine, other, strict=True):
        for low, high in ((3.0, 41.0), (41.0, 81.0)):
            shown = (bands > low) & (bands < high) & np.isfinite(a) & np.isfinite(b)
            off = np.abs(a[shown] / b[shown] - 1.0)
            worst = int(off.argmax())
            found[f"{name}, {low:.0f} to {high:.0f} Hz"] = (
                f"largest {100 * off[worst]:.2g} % at {bands[shown][worst]:.3g} Hz, "
                f"middle {100 * np.median(off):.2g} %, "
                f"levels {1e6 * b[shown].min():.2g} to {1e6 * b[shown].max():.2g} um/s"
            )
    spent, own = float(theirs["cpu"]), float(ours["CPU s"])
    step, longer = spent / (given.duration / given.dt), CROSSING / given.duration
    whole = own + (longer - 1.0) * float(ours["CPU s of the crossing"])
    return {
        "CPU s of the reference": round(spent, 1),
        "CPU s a step of it": round(step, 3),
        "ours over the reference": round(own / spent, 3),
        f"both by their steps for {CROSSING:g} s": round(whole / (longer * spent), 3),
        "levels apart": found,
    }


def arguments() -> argparse.Namespace:
    """Read what is asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--units", default="3x3", help="units along x and along y")
    parser.add_argument("--storeys", type=int, default=2)
    parser.add_argument("--mesh", type=float, default=1.0, help="largest element edge [m]")
    parser.add_argument("--f-max", type=float, default=112.0, help="112 Hz shows bands to 80 Hz")
    parser.add_argument("--band", type=float, default=1.2, help="of near parts, times f_max")
    parser.add_argument("--seam-band", type=float, default=1.6, help="of seams, times f_max")
    parser.add_argument("--near", type=float, default=5.0, help="distance of near parts [m]")
    parser.add_argument("--answers", type=float, default=0.1, help="error that is allowed")
    parser.add_argument("--speed", type=float, default=90.0, help="of the truck [km/h]")
    parser.add_argument("--dt", type=float, default=5e-4, help="step of both [s]")
    parser.add_argument("--duration", type=float, default=2.2, help="of the record [s]")
    parser.add_argument("--runs", type=int, default=1, help="roads")
    parser.add_argument("--no-reference", action="store_true", help="leave the whole out")
    parser.add_argument("--reference", help="file in which the whole's levels are kept")
    return parser.parse_args()


def measured(given: argparse.Namespace) -> dict[str, object]:
    """Compute both and compare them."""
    nx, ny = map(int, given.units.split("x"))
    nz = given.storeys
    floor = with_decks(stacked(nx, ny, nz, mesh_size=given.mesh), nz)
    cuts = Cuts(
        x=WIDTH * np.arange(1, nx),
        y=DEPTH * np.arange(1, ny),
        z=HEIGHT * (np.arange(1, nz) - 0.5),
    )
    parting = Parting(
        cuts=cuts,
        f_parts=given.band * given.f_max,
        f_seams=given.seam_band * given.f_max,
        near=given.near,
        response_tolerance=given.answers,
    )
    crossing, tools = crossing_of(nx, ny, nz, given.speed)
    ours = reduced(with_kept_parts(parting.of(floor)), crossing, tools, given)
    found: dict[str, object] = {"degrees of freedom": floor.n_dofs, **ours["told"]}
    found["CPU s of near and far"] = round(float(ours["CPU s"]), 1)
    found["peak GB of near and far"] = _peak()
    if not given.no_reference:
        found |= compared(ours, direct(floor, crossing, tools, given), tools, given)
        found["peak GB"] = _peak()
    return found


def _peak() -> float:
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6, 2)


if __name__ == "__main__":
    os.environ.setdefault("TRUNDLE_CACHE", "")
    with repeatable():  # as a run holds it
        print(json.dumps(measured(arguments())))
