"""Keep what studies give, and see after a change of the code that not a bit of it is another.

Usage: python scripts/same_results.py keep FOLDER [--demo]
       python scripts/same_results.py compare FOLDER

`keep` runs three small studies (maps, several methods, traffic, isolators, direct integration) and,
with --demo, the study of `make demo`; `compare` runs them again, and compares ``summary.json``,
``summary.csv``, ``verdicts.csv`` and every file of ``results.zarr`` byte by byte. Exit code 0 if
all are the same. Results of another machine or other libraries differ in their last digits.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from study_texts import DIRECT, RAYLEIGH, ROAD_C, SMALL

ROOT = Path(__file__).resolve().parent.parent
TRAFFIC = """
[[route]]
name = "back"
vehicle = "car"
path = [["12 m", "1 m"], ["0 m", "1 m"]]
speed = "12 km/h"

[[traffic]]
name = "both"
routes = ["main", "back"]

[vehicle.car]
kind = "car_bmw_320i"

[[point]]
name = "stage"
at = ["8 m", "4 m"]
isolator = { frequency = "2 Hz", damping = "10 %" }
"""
METHODS = (
    """
[[method]]
name = "decoupled"
interaction = "decoupled"
f_max = "30 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
entry = "ramp"

[[method]]
name = "direct, decoupled"
interaction = "decoupled"
integration = "newmark"
dt = "5 ms"
damping = RAYLEIGH
contact = "hat"
""".replace("RAYLEIGH", RAYLEIGH)
    + DIRECT
)
MAP = """
[map]
runs = 4
traffic = true
peaks = true
speeds = ["10 km/h"]
"""
FILES = ("summary.json", "summary.csv", "verdicts.csv")


def studies(*, demo: bool) -> dict[str, str]:
    """Return the text of each study by its name."""
    small = SMALL.replace("runs = 2", "runs = 9")
    short, long = small.replace('"4 s"', '"8 s"'), small.replace('duration = "4 s"\n', "")
    curves = '["VC-A", "VC-C", "office", "operating-theatre"]\npercentile = 90.0'
    found = {
        "methods": short + METHODS,
        "traffic": long.replace('["VC-A"]', curves) + TRAFFIC + ROAD_C,
        "map": long.replace('"1.5 m"', '"1 m"') + TRAFFIC + ROAD_C + MAP,
    }
    if demo:
        found["demo"] = (ROOT / "examples" / "paper" / "study.toml").read_text("utf-8")
    return found


def run(folder: Path, texts: dict[str, str]) -> None:
    """Run studies into a folder, each by itself."""
    for name, text in texts.items():
        study = folder / f"{name}.toml"
        study.write_text(text, encoding="utf-8")
        print(f"running {name}", flush=True)
        subprocess.run(
            [sys.executable, "-m", "trundle", "run", study.name, "--out", name, "--quiet", "--yes"],
            cwd=folder,
            env=os.environ | {"TRUNDLE_CACHE": ""},
            stderr=subprocess.DEVNULL,
            check=True,
        )


def held(folder: Path) -> dict[str, bytes]:
    """Return what a results folder holds, but for pictures and pages."""
    store = folder / "results.zarr"
    files = [folder / name for name in FILES] + [f for f in store.rglob("*") if f.is_file()]
    return {str(f.relative_to(folder)): f.read_bytes() for f in files if f.exists()}


def compare(kept: Path) -> int:
    """Run all kept studies again and compare; return the exit code."""
    texts = {file.stem: file.read_text("utf-8") for file in sorted(kept.glob("*.toml"))}
    with tempfile.TemporaryDirectory(prefix="trundle-same-") as name:
        run(Path(name), texts)
        other = False
        for study in texts:
            before, now = held(kept / study), held(Path(name) / study)
            changed = sorted(k for k in before.keys() | now.keys() if before.get(k) != now.get(k))
            other |= bool(changed)
            print(f"{study}: {len(now)} files, {len(changed)} changed", *changed[:10])
    return int(other)


def main() -> int:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("what", choices=("keep", "compare"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--demo", action="store_true", help="with the study of 'make demo'")
    asked = parser.parse_args()
    if asked.what == "compare":
        return compare(asked.folder)
    asked.folder.mkdir(parents=True)
    run(asked.folder, studies(demo=asked.demo))
    return 0


if __name__ == "__main__":
    sys.exit(main())
