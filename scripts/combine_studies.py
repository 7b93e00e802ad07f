"""Combine whatever a study may say, and see that each is refused before work or ends in results.

Usage: python scripts/combine_studies.py [--first N] [--count N]

Seeded random studies of a small floor: edges, vehicles, routes and speeds, traffic, roads, waves,
points and isolators, methods of every kind, criteria, maps. Each is built, run, stored, reported,
read back, reported again and printed. A fault is a traceback, a raw warning, a refusal after the
work has begun, or another report from what was read back. Exit code 0 if there is none.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import random
import sys
import tempfile
import traceback
import warnings
from pathlib import Path

from study_texts import RAYLEIGH, SMALL

from trundle import load_study, read_results, run_study, save, write_report
from trundle.cli.result_tables import print_result
from trundle.errors import StudyError, TrundleError

RATIO = '{ ratio = "3 %" }'
PLANAR = """
[vehicle.planar]
kind = "planar"
bodies = [{ mass = "3 t", pitch_inertia = "5000 kg m2", centre = "1 m" }]
axles = [
  { setback = "0 m", stiffness = "0.2 MN/m", axle_mass = "200 kg", tyre_stiffness = "1 MN/m" },
  { setback = "2 m", stiffness = "0.2 MN/m", damping = "5 kN s/m" },
]
"""
ENTRIES = (
    "",
    'entry = "ramp"',
    'entry = "ramp"\nentry_length = "0.5 m"',
    'entry = "abrupt"',
    'entry = "static"\nentry_length = "1 m"',
    'entry = "drive_in"\nentry_length = "2 m"',
)
ISOLATORS = (
    'isolator = { frequency = "2 Hz", damping = "10 %" }',
    'isolator = { table = [["1 Hz", 1.0], ["10 Hz", 0.05]] }',
)
CURVES = ("VC-A", "VC-C", "VC-E", "office", "operating-theatre", "workshop")


def floor(rng: random.Random) -> str:
    """Return the head of a study: runs, duration, floor and edges."""
    text = SMALL[: SMALL.index("[vehicle.truck]")]
    text = text.replace("runs = 2", f"runs = {rng.choice([1, 2, 3, 17])}")
    text = text.replace('duration = "4 s"', rng.choice(["", "", 'duration = "15 s"']))
    if rng.random() < 0.3:
        x, y = (rng.choice(["free", "simple", "clamped", "pinned", "symmetry"]) for _ in "xy")
        held = f'storey_below = "4 m"\nedges = {{ x_min = "{x}", y_max = "{y}" }}'
        text = text.replace('storey_below = "4 m"', held)
    return text


def traffic(rng: random.Random) -> str:
    """Return vehicles, routes, and several at once."""
    kinds = ["container_truck_40ft", "car_bmw_320i", "city_bus_2_axle", "planar"]
    names, text = rng.sample(kinds, rng.randint(1, 3)), ""
    for name in names:
        text += PLANAR if name == "planar" else f'\n[vehicle.{name}]\nkind = "{name}"\n'
    n_routes = rng.randint(1, 3)
    for i in range(n_routes):
        y = rng.choice([1, 2.2, 3, 4.5])
        path = rng.choice(
            [
                f'[["0 m", "{y} m"], ["12 m", "{y} m"]]',
                f'[["12 m", "{y} m"], ["0 m", "{y} m"]]',
                f'[["0 m", "{y} m"], ["5 m", "{y} m"], ["9 m", "0 m"]]',
                f'[["2 m", "{y} m"], ["9 m", "{y} m"]]',
            ]
        )
        text += f'\n[[route]]\nname = "r{i}"\nvehicle = "{rng.choice(names)}"\npath = {path}\n'
        text += f'speed = "{rng.choice([4, 8, 15, 30])} km/h"\n'
        text += f'run_in = "{rng.choice([0, 3])} m"\n' if rng.random() < 0.3 else ""
    if n_routes > 1 and rng.random() < 0.6:
        routes = ", ".join(f'"r{i}"' for i in range(n_routes))
        text += f'\n[[traffic]]\nname = "all"\nroutes = [{routes}]\n'
    return text


def roads_and_points(rng: random.Random) -> str:
    """Return roads, waves, points and isolators."""
    text = ""
    for name in rng.sample("ABCDE", rng.randint(1, 3)):
        text += f'\n[[road]]\nclass = "{name}"\n'
        text += 'level = "upper"\n' if rng.random() < 0.3 else ""
        text += "waviness = 2.5\n" if rng.random() < 0.2 else ""
    if rng.random() < 0.6:
        text += f'\n[roughness]\nn_max = "{rng.choice([2.83, 11, 22])} 1/m"\n'
        text += f'contact_patch = "{rng.choice([0, 0.2])} m"\n'
        text += f"gaussian_amplitudes = {rng.choice(['true', 'false'])}\n"
    for i in range(rng.randint(1, 3)):
        x, y = rng.choice([1, 3, 6, 11.3]), rng.choice([1, 3, 5.2])
        text += f'\n[[point]]\nname = "p{i}"\nat = ["{x} m", "{y} m"]\n'
        text += rng.choice(ISOLATORS) + "\n" if rng.random() < 0.3 else ""
    return text


def methods(rng: random.Random) -> str:
    """Return methods, criteria and a map."""
    text, modal = "", []
    for i in range(rng.randint(1, 3)):
        modal.append(rng.random() < 0.75)
        text += f'\n[[method]]\nname = "m{i}"\ndt = "{rng.choice([4, 5, 5, 10])} ms"\n'
        text += f'interaction = "{rng.choice(["coupled", "decoupled"])}"\n'
        text += f'contact = "{rng.choice(["smooth", "hat"])}"\n{rng.choice(ENTRIES)}\n'
        if modal[-1]:
            text += f'f_max = "{rng.choice([30, 40, 60])} Hz"\n'
            text += f'precision = "{rng.choice(["double", "single"])}"\n'
        else:
            text += 'integration = "newmark"\n'
        text += f"damping = {rng.choice([RATIO, RAYLEIGH]) if modal[-1] else RAYLEIGH}\n"
    if rng.random() < 0.15:
        return text
    which = rng.randrange(len(modal))
    curves = ", ".join(f'"{c}"' for c in rng.sample(CURVES, rng.randint(1, 4)))
    text += f'\n[criteria]\nmethod = "m{which}"\ncurves = [{curves}]\n'
    text += f'averaging = "{rng.choice(["max_1s", "event", "slow", "fast"])}"\n'
    text += f"percentile = {rng.choice([50.0, 95.0, 100.0])}\n"
    if modal[which] and rng.random() < 0.5:
        text += f"\n[map]\nruns = {rng.choice([1, 2])}\n"
        text += rng.choice(["", 'spacing = "3 m"\n', 'places = "nodes"\n'])
        for more in ("traffic = true", "peaks = true", 'speeds = ["6 km/h"]', "every_step = true"):
            text += f"{more}\n" if rng.random() < 0.5 else ""
    return text


def outcome(text: str, folder: Path) -> str:
    """Run a study to the last table; return "right", "refused", or what went wrong."""
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = run_study(load_study(path))
            page = save(result, folder / "out").read_bytes()
            with tempfile.TemporaryDirectory(dir=folder) as empty:
                again = write_report(read_results(folder / "out"), Path(empty)).read_bytes()
            if again != page:
                return "what is read back gives another report"
            with contextlib.redirect_stdout(io.StringIO()):
                print_result(result)
    except StudyError:
        return "refused"
    except TrundleError as error:
        return f"refused after work had begun: {error}"
    except Exception:
        return traceback.format_exc(limit=-4)
    return "right"


def main() -> int:
    """Read the command line, try the studies, and count."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--first", type=int, default=0, help="seed of the first study")
    parser.add_argument("--count", type=int, default=40)
    asked = parser.parse_args()
    counts = {"right": 0, "refused": 0, "faults": 0}
    with tempfile.TemporaryDirectory(prefix="trundle-combined-") as name:
        os.environ["TRUNDLE_CACHE"] = str(Path(name) / "cache")
        for seed in range(asked.first, asked.first + asked.count):
            rng = random.Random(seed)
            text = floor(rng) + traffic(rng) + roads_and_points(rng) + methods(rng)
            found = outcome(text, Path(name))
            if found not in counts:
                print(f"study {seed}: {found}\n{text}", flush=True)
            counts[found if found in counts else "faults"] += 1
    print(", ".join(f"{count} {what}" for what, count in counts.items()))
    return int(counts["faults"] > 0)


if __name__ == "__main__":
    sys.exit(main())
