"""Hold what 'trundle check' says a study will take against what 'trundle run' takes.

Each study is run by itself, with an empty cache of modes; the ratio is estimated over measured.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from importlib import resources
from pathlib import Path

from trundle.run.estimate import estimate_of
from trundle.study_file.build import load_study

VARIANTS: dict[str, list[tuple[str, str]]] = {
    "template": [],
    "half the mesh": [('mesh_size = "1 m"', 'mesh_size = "0.5 m"')],
    "1000 runs": [("runs = 50   ", "runs = 1000 ")],
    "5000 runs": [("runs = 50   ", "runs = 5000 ")],
    "1 ms": [('dt = "5 ms"', 'dt = "1 ms"')],
    "four roads": [
        ("[roughness]", "".join(f'[[road]]\nclass = "{c}"\n' for c in "ACD") + "[roughness]")
    ],
    "map of 0.5 m": [('spacing = "2 m"', 'spacing = "0.5 m"')],
    "16 bays": [
        ('"12 m", "24 m"]', '"12 m", "24 m", "36 m", "48 m"]'),
        ('"10 m", "20 m"]', '"10 m", "20 m", "30 m", "40 m"]'),
        ('["24 m", "15 m"]]', '["48 m", "15 m"]]'),
    ],
    "step by step": [
        ('integration = "modal"', 'integration = "newmark"'),
        ('f_max = "112 Hz"', ""),
        ('{ ratio = "3 %" }', '{ rayleigh_alpha = "0.8587 1/s", rayleigh_beta = "0.001 s" }'),
        ("[map]\n", "[map]\n#"),
    ],
}


def measure(study: Path, folder: Path) -> tuple[float, float]:
    """Return wall time [s] and peak resident memory [bytes] of a run."""
    start = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "trundle", "run", str(study), "-o", str(folder), "--yes"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "TRUNDLE_CACHE": ""},
    )
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{study} ended with {status}")
    return time.perf_counter() - start, 1024.0 * usage.ru_maxrss


def main() -> None:
    """Print estimate, measurement and ratio of every variant, JSON as the last line."""
    os.environ["TRUNDLE_CACHE"] = ""
    template = resources.files("trundle.study_file").joinpath("template.toml").read_text("utf-8")
    found = {}
    with tempfile.TemporaryDirectory() as place:
        for name, changes in VARIANTS.items():
            text = template
            for old, new in changes:
                assert old in text, old
                text = text.replace(old, new, 1)
            if name == "step by step":
                text = text[: text.index("[map]")]
            study = Path(place) / "study.toml"
            study.write_text(text)
            estimate = estimate_of(load_study(study))
            seconds, memory = measure(study, Path(place) / name)
            found[name] = {
                "seconds": round(seconds, 1),
                "time ratio": round(estimate.seconds / seconds, 2),
                "GB": round(memory / 1e9, 2),
                "memory ratio": round(estimate.memory / memory, 2),
            }
            print(f"{name:16}", found[name], flush=True)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
