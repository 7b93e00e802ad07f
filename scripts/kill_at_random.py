"""Kill workers and the main process of a run at random moments, and see that nothing changes.

Usage: python scripts/kill_at_random.py [--kills N] [--seed N]

A study runs in two workers; 20 times a worker or the main process is killed (kill -9) after some
random time, and the same command is given again where the main process died. What is left in the
end must be, byte for byte, what one undisturbed process leaves. Exit code 0 if it is.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil
from study_texts import DIRECT, ROAD_C, SMALL


def start(folder: Path, *options: str) -> subprocess.Popen[bytes]:
    """Start the run, or let it go on."""
    return subprocess.Popen(
        [sys.executable, "-m", "trundle", "run", "study.toml", "--out", "out", *options],
        cwd=folder,
        env=os.environ | {"TRUNDLE_CACHE": ""},
        stdout=subprocess.DEVNULL,
        stderr=(folder / "log").open("ab"),
    )


def left(folder: Path) -> dict[str, bytes]:
    """Return every file of the results' store by its name."""
    store = folder / "out" / "results.zarr"
    return {str(f.relative_to(store)): f.read_bytes() for f in store.rglob("*") if f.is_file()}


def family(process: subprocess.Popen[bytes]) -> list[psutil.Process]:
    """Return the workers of a run; none while they have not started."""
    try:
        children = psutil.Process(process.pid).children(recursive=True)
        return [c for c in children if "spawn_main" in " ".join(c.cmdline())]
    except psutil.Error:
        return []


def disturbed(folder: Path, kills: int, rng: random.Random) -> dict[str, int]:
    """Run to the end in two workers, with so many kills; return how many hit what."""
    hit = {"worker": 0, "main process": 0, "nothing: the run was over": 0}
    process = start(folder, "--workers", "2")
    while sum(hit.values()) < kills:
        time.sleep(rng.uniform(0.5, 8.0))
        workers = family(process)
        if process.poll() is not None:
            hit["nothing: the run was over"] += 1
            process = start(folder, "--workers", "2", "--fresh")
        elif workers and rng.random() < 0.6:
            rng.choice(workers).kill()
            hit["worker"] += 1
        else:
            for worker in workers:  # they would end by themselves, some seconds later
                worker.kill()
            process.kill()
            process.wait()
            hit["main process"] += 1
            process = start(folder, "--workers", "2")
        print(", ".join(f"{count} {what}" for what, count in hit.items()), flush=True)
    for _ in range(3):  # a run whose workers were killed too often ends with a message, and goes on
        if process.wait(timeout=600) == 0:
            return hit
        process = start(folder, "--workers", "2")
    raise SystemExit((folder / "log").read_text("utf-8")[-2000:])


def main() -> int:
    """Read the command line, run undisturbed and disturbed, and compare."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    text = SMALL + ROAD_C + DIRECT
    text = text.replace("runs = 2", "runs = 60").replace('"4 s"', '"8 s"')
    with tempfile.TemporaryDirectory(prefix="trundle-kills-") as name:
        folders = [Path(name) / part for part in ("whole", "disturbed")]
        for folder in folders:
            folder.mkdir()
            (folder / "study.toml").write_text(text, encoding="utf-8")
        if start(folders[0]).wait() != 0:
            raise SystemExit((folders[0] / "log").read_text("utf-8"))
        disturbed(folders[1], asked.kills, random.Random(asked.seed))
        same = left(folders[0]) == left(folders[1])
    print("the same bytes" if same else "other bytes")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
