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


BUILDING = """
title = "A laboratory over a deck"
seed = 1
runs = 2

[building]
mesh_size = "1.5 m"

[building.materials.concrete]
elastic_modulus = "34 GPa"
density = "2500 kg/m3"

[building.sections.post]
shape = "rectangle"
width = "0.4 m"
depth = "0.6 m"
material = "concrete"

[building.sections.steel]
shape = "rolled"
rolled = "IPE 400"
material = "steel"

[building.plates.deck]
thickness = "0.25 m"
material = "concrete"
superimposed_mass = "100 kg/m2"
imposed_load = "5 kN/m2"
imposed_share = 0.3

[building.plates.wall]
thickness = "0.2 m"
material = "concrete"

[building.grid.x]
A = "0 m"
B = "8 m"
C = "16 m"

[building.grid.y]
1 = "0 m"
2 = "6 m"

[[building.storey]]
name = "ground"
level = "0 m"

[[building.storey]]
name = "deck"
level = "3 m"

[[building.storey]]
name = "lab"
level = "6.5 m"

[[building.slab]]
on = "deck"
plate = "deck"
outline = ["A/1", "C/1", "C/2", "A/2"]
openings = [[["10 m", "2 m"], ["12 m", "2 m"], ["12 m", "4 m"], ["10 m", "4 m"]]]

[[building.slab]]
on = "lab"
plate = "deck"
outline = ["A/1", "C/1", "C/2", "A/2"]

[[building.beam]]
on = "deck"
section = "steel"
along = ["B/1", "B/2"]
hinged = "both"

[[building.column]]
section = "post"
at = "grid"
from = "ground"
to = "lab"
base = "fixed"

[[building.wall]]
plate = "wall"
along = ["A/1", "A/2"]
from = "ground"
to = "lab"
base = "pinned"

[vehicle.car]
kind = "car_bmw_320i"

[[route]]
name = "aisle"
vehicle = "car"
on = "deck"
path = [["0 m", "5 m"], ["16 m", "5 m"]]
speed = "20 km/h"

[[road]]
class = "B"

[[point]]
name = "tool"
on = "lab"
at = ["4 m", "3 m"]

[[method]]
name = "coupled"
interaction = "coupled"
integration = "modal"
f_max = "60 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
entry = "drive_in"
"""
