"""Whole buildings: every figure of them in one JSON, with OpenSeesPy beside the largest it holds.

Each figure is measured by a process of its own, one after the other, so that none has the memory or
the caches of another:

- ``meshing``: a tower of 195,000 degrees of freedom, against assembling its matrices;
- ``one unit``: four storeys of the reference unit, modes by parts against the whole;
- ``from nothing``, ``parts kept``, ``answers kept``: forty units on four storeys, what answers
  below 20 Hz, one coupled crossing of 1000 roads with tools on three storeys;
- ``all modes``: the same with every mode found and counted (eight minutes);
- ``twenty storeys``: of them, the count of modes below 20 Hz;
- ``near and far``: one unit and its neighbours to 80 Hz, against Newmark's integration of the whole
  (half an hour; ``--reference FILE`` keeps that);
- ``opensees``: OpenSeesPy's time a step, on storeys of the unit, as many as it can hold within
  ``--opensees-gb`` and build and step within ten minutes, beside ours on the same model.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from parts import stacked

from trundle.dynamics import Rayleigh
from trundle.simulate import Newmark, prepare

HERE = Path(__file__).parent
FORTY = ["parts.py", "--units", "2x5", "--band", "1.5", "--runs", "1000"]
DAMPING = Rayleigh(alpha=0.8587, beta=0.001)
DT = 0.025
STEPS = 12
PATIENCE = 600.0  # s for one model of it
HEIGHTS = (2, 4, 8, 16)  # storeys of the unit that OpenSeesPy is given in turn


def figures(cache: str, given: argparse.Namespace) -> dict[str, tuple[list[str], str]]:
    """Return the commands of all figures, and which cache each has."""
    near = ["near_far.py", *(["--reference", given.reference] if given.reference else [])]
    parts, answers = f"{cache}/parts", f"{cache}/all"
    return {
        "meshing": (["meshing.py"], ""),
        "one unit": (["parts.py"], ""),
        "from nothing": ([*FORTY, "--answers", "0.1"], answers),
        "answers kept": ([*FORTY, "--answers", "0.1"], answers),
        "parts kept": ([*FORTY, "--answers", "0.1"], parts),
        "all modes": (FORTY, parts),
        "twenty storeys": (
            ["parts.py", "--units", "2x5", "--storeys", "20", "--band", "1.5", "--count"],
            parts,
        ),
        "near and far": (near, ""),
        "opensees": (["building.py", "--only-opensees", str(given.opensees_gb)], ""),
    }


def measured(given: argparse.Namespace) -> dict[str, object]:
    """Measure all that is asked for, one after the other."""
    found: dict[str, object] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, (command, cache) in figures(folder, given).items():
            if given.only and name not in given.only:
                continue
            if name == "parts kept" and (Path(folder) / "all" / "parts").is_dir():
                (Path(folder) / "all" / "parts").rename(_made(Path(folder) / "parts") / "parts")
            print(f"{name}: {' '.join(command)}", file=sys.stderr, flush=True)
            found[name] = said_by(command, cache)
    return found


def _made(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def said_by(command: list[str], cache: str, within: float | None = None) -> object:
    """Run a command of this folder, and return the JSON of its last line."""
    try:
        ran = subprocess.run(
            [sys.executable, str(HERE / command[0]), *command[1:]],
            env={**os.environ, "TRUNDLE_CACHE": cache},
            capture_output=True,
            text=True,
            check=False,
            timeout=within,
        )
    except subprocess.TimeoutExpired:
        return {"failed": f"not within {within:g} s"}
    lines = ran.stdout.strip().splitlines()
    if ran.returncode or not lines:
        return {"failed": (ran.stderr.strip().splitlines() or ["nothing was said"])[-1]}
    return json.loads(lines[-1])


def opensees(room: float) -> dict[str, object]:
    """Return the time of a step of the largest model that OpenSeesPy holds, and ours on it."""
    best: dict[str, object] = {"failed": "it holds none of them"}
    for storeys in HEIGHTS:
        said = said_by(
            ["building.py", "--storeys-of-opensees", str(storeys), str(room)], "", PATIENCE
        )
        if not isinstance(said, dict) or "failed" in said:
            return best | {"the next larger": said}
        best = said
    return best


def opensees_step(storeys: int, room: float) -> dict[str, object]:
    """Step some storeys of the unit by OpenSeesPy and by ours, within some gigabytes."""
    limit = int(room * 1e9)
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    sys.path.insert(0, str(HERE.parent / "tests" / "validation"))
    model = importlib.import_module("opensees_model")
    floor = stacked(1, 1, storeys)
    middle = [26.0, 42.0, 8.5 * (storeys - 1)]
    node = int(np.abs(floor.nodes - middle).sum(axis=1).argmin())
    times = []
    for count in (2, STEPS):
        start = time.perf_counter()
        force = 1e4 * np.ones((count + 1, 1))
        theirs = model.accelerations(
            floor, (np.array([node]), force), dt=DT, damping=DAMPING, read_at=[node]
        )
        times.append(time.perf_counter() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    step = (times[1] - times[0]) / (STEPS - 2)
    ours = own_step(floor)
    return {
        "degrees of freedom": floor.n_dofs,
        "opensees s a step": round(step, 3),
        "ours s a step": round(ours, 4),
        "opensees over ours": round(step / ours, 1),
        "peak GB with opensees": round(peak, 2),
        "opensees moves": bool(np.abs(theirs).max() > 0.0),
    }


def own_step(floor) -> float:
    """Return the time that our direct step takes: one solve, and the products beside it."""
    prepared = prepare(floor, Newmark(dt=DT), DAMPING)
    solver, n = prepared.propagator.solver, floor.n_dofs
    mass, stiffness = floor.matrices()
    load, moved = np.ones((n, 1)), np.ones((n, 1))
    solver.solve(load)
    start = time.perf_counter()
    for _ in range(20):
        moved = solver.solve(load + mass @ moved + stiffness @ moved)
    return (time.perf_counter() - start) / 20


def main() -> None:
    """Measure, and print one JSON."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", nargs="*", help="names of the figures, all unless given")
    parser.add_argument("--reference", help="file that keeps the levels of the whole")
    parser.add_argument("--opensees-gb", type=float, default=16.0, help="room for OpenSeesPy")
    parser.add_argument("--only-opensees", type=float, help=argparse.SUPPRESS)
    parser.add_argument("--storeys-of-opensees", nargs=2, type=float, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.only_opensees:
        found: object = opensees(given.only_opensees)
    elif given.storeys_of_opensees:
        storeys, room = given.storeys_of_opensees
        found = opensees_step(int(storeys), room)
    else:
        found = measured(given)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
