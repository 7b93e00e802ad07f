"""Build the manual once for all tests that look at it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "_ext"))


@pytest.fixture(scope="session")
def manual():
    """Return the folder of the built manual; every worker of one run of the tests shares it."""
    fcntl = pytest.importorskip("fcntl")
    pytest.importorskip("furo")
    pytest.importorskip("myst_parser")
    run = os.environ.get("PYTEST_XDIST_TESTRUNUID", f"alone {os.getpid()}")
    built = ROOT / "build" / "docs"
    built.parent.mkdir(exist_ok=True)
    told = ROOT / "build" / "docs-built"
    with (ROOT / "build" / "docs-lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not told.exists() or told.read_text("utf-8").partition("\n")[0] != run:
            told.write_text(f"{run}\n{_build(built)}", encoding="utf-8")
    said = told.read_text("utf-8").partition("\n")[2]
    assert not said, said
    return built


def _build(built):
    """Build, and return what there is to complain about."""
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-j",
        "auto",
        "-b",
        "html",
    ]
    places = ["-d", str(ROOT / "build" / "docs-kept"), str(ROOT / "docs"), str(built)]
    done = subprocess.run([*command, *places], capture_output=True, text=True, check=False)
    return done.stderr or ("" if done.returncode == 0 else f"ended with {done.returncode}")
