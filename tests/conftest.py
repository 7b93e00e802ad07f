"""Switch on the run-time check of array shapes, and keep numerics on one thread a worker."""

import os
import sys

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")
os.environ["TRUNDLE_CACHE"] = ""  # tests find modes, and leave none behind

import pytest  # noqa: E402  (threads are set before numpy loads)
from jaxtyping import install_import_hook  # noqa: E402

NUMERIC = (
    "dynamics", "signals", "road", "vehicle", "structure", "route", "simulate", "response",
    "criteria",
)  # fmt: skip
install_import_hook([f"trundle.{name}" for name in NUMERIC], "shape_checker.check")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--record", help="write the validation tests' comparisons to this JSON file")


def pytest_configure(config: pytest.Config) -> None:
    from validation_record import Collector

    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(Collector(config.getoption("--record")))


@pytest.fixture
def trundle(monkeypatch):
    """Return what runs the command in this process, and returns its exit code."""
    from trundle.cli.app import main

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["trundle", *map(str, arguments)])
        try:
            main()
        except SystemExit as stop:
            return stop.code or 0
        return 0

    return run
