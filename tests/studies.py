"""Small studies that several tests use, and what is done with them."""

import sys
from pathlib import Path

import pytest

from trundle.errors import StudyError
from trundle.study_file.build import load_study

GOOD = (Path(__file__).parents[1] / "scripts" / "small_study.toml").read_text("utf-8")
LIBRARY = 'kind = "container_truck_40ft"'
LONG = GOOD.replace('duration = "4 s"', 'duration = "14 s"').replace('"30 Hz"', '"90 Hz"')
MAP = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'


def run_main(monkeypatch, capsys, *arguments):
    """Run the command in this process; return its exit code and what it printed."""
    from trundle.cli.app import main

    monkeypatch.setattr(sys, "argv", ["trundle", *map(str, arguments)])
    with pytest.raises(SystemExit) as stop:
        main()
    return stop.value.code, capsys.readouterr()


def problems(tmp_path, *changes):
    """Return the problems of the good study with some texts replaced."""
    text = GOOD
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = tmp_path / "study.toml"
    path.write_text(text)
    with pytest.raises(StudyError) as told:
        load_study(path)
    return told.value.problems


def spoilt(data):
    """Give a file with single bits flipped, its end cut off, something added, and zeros in it."""
    for at in range(0, len(data), max(1, len(data) // 60)):
        flipped = bytearray(data)
        flipped[at] ^= 1 << at % 8
        yield bytes(flipped)
        yield data[:at]
    yield data + b"\0"
    yield data[:-40] + bytes(40)  # a block that never reached the disk
    yield bytes(len(data))
