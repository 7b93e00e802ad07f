"""Set up .venv with everything that is asked for, from a local store of wheels if it can.

Usage: python3 scripts/setup_environment.py [EXTRA ...]

Packages are downloaded once into a folder of wheels (TRUNDLE_WHEELS, by default under the
user's cache), and installed from there; so a second set-up needs no network.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = ROOT / ".venv"
BUILD = ["hatchling", "editables"]


def wheel_folder() -> Path:
    """Return the folder that keeps downloaded wheels."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(os.environ.get("TRUNDLE_WHEELS") or cache / "trundle" / "wheels")


def wanted(extras: list[str]) -> list[str]:
    """Return the requirements of the project and of the extras named."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    optional = project["optional-dependencies"]
    return BUILD + project["dependencies"] + [name for extra in extras for name in optional[extra]]


def pip(*arguments: str | Path, quiet: bool = False) -> bool:
    """Run pip inside the environment; return whether it succeeded."""
    python = ENVIRONMENT / "bin" / "python"
    command = [str(python), "-m", "pip", "--disable-pip-version-check", *map(str, arguments)]
    hidden = subprocess.DEVNULL if quiet else None
    return subprocess.run(command, check=False, stdout=hidden, stderr=hidden).returncode == 0


def main() -> int:
    """Make the environment, install packages, install the project itself for editing."""
    requirements = wanted(sys.argv[1:])
    wheels = wheel_folder()
    wheels.mkdir(parents=True, exist_ok=True)
    if not (ENVIRONMENT / "bin" / "python").exists():
        print("making .venv", flush=True)
        venv.create(ENVIRONMENT, with_pip=True)
    constraints = ("--constraint", ROOT / "constraints.txt")
    offline = ("install", "-qq", "--no-index", "--find-links", wheels, *constraints)
    if not pip(*offline, *requirements, quiet=True):
        print("downloading packages (once)", flush=True)
        download = ("download", "-qq", "--only-binary", ":all:", "--dest", wheels)
        if not pip(*download, *constraints, *requirements) or not pip(*offline, *requirements):
            print("set-up failed: see pip's message above", file=sys.stderr)
            return 1
    editable = ("install", "-qq", "--no-index", "--no-deps", "--no-build-isolation")
    return 0 if pip(*editable, "--editable", ROOT) else 1


if __name__ == "__main__":
    sys.exit(main())
