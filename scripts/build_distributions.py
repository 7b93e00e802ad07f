"""Build wheel and source archive into dist, in an environment of their own, and check them.

Usage: python3 scripts/build_distributions.py
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = ROOT / "build" / "dist-environment"
DIST = ROOT / "dist"


def main() -> int:
    """Make the environment once; build, check metadata; return the first code that is not 0."""
    python = ENVIRONMENT / "bin" / "python"
    if not python.exists():
        venv.create(ENVIRONMENT, with_pip=True)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    needed = [
        *project["build-system"]["requires"],
        *project["project"]["optional-dependencies"]["dist"],
    ]
    shutil.rmtree(DIST, ignore_errors=True)
    constraints = ("--constraint", ROOT / "constraints.txt")
    steps = (
        ("pip", "--disable-pip-version-check", "install", "-qq", *constraints, *needed),
        ("build", "--no-isolation", "--outdir", DIST, ROOT),
    )
    for step in steps:
        if code := subprocess.run([python, "-m", *map(str, step)], check=False).returncode:
            return code
    files = sorted(map(str, DIST.iterdir()))
    return subprocess.run(
        [python, "-m", "twine", "check", "--strict", *files], check=False
    ).returncode


if __name__ == "__main__":
    sys.exit(main())
