"""Run the command line inside the tests' own process."""

import sys

import pytest

from trundle.cli.app import main


@pytest.fixture
def trundle(monkeypatch):
    """Return what runs the command with some arguments, and returns its exit code."""

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["trundle", *map(str, arguments)])
        try:
            main()
        except SystemExit as stop:
            return stop.code or 0
        return 0

    return run
