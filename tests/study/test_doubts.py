"""Doubts about a study before it runs: each kind is raised where it belongs and nowhere else."""

from pathlib import Path

import pytest

from trundle.study import load_study
from trundle.study.doubts import study_doubts

ON_WALLS = """
title = "Composite floor on two walls"
seed = 1
runs = 2
duration = "20 s"
[floor]
kind = "plan"
mesh_size = "0.5 m"
x_lines = ["0 m", "12 m"]
y_lines = ["0.75 m", "2.25 m"]
y_extent = ["0 m", "3 m"]
slab_thickness = "0.2 m"
material = { elastic_modulus = "33 GPa", poisson_ratio = 0.0, density = "2450 kg/m3" }
beams_x = { width = "0.4 m", depth = "0.8 m" }
edges = { x_min = "simple", x_max = "simple" }
[vehicle.truck]
kind = "container_truck_40ft"
[[route]]
name = "lane"
vehicle = "truck"
path = [["0 m", "1.5 m"], ["12 m", "1.5 m"]]
speed = "15 km/h"
[[road]]
class = "B"
[[point]]
name = "mid"
at = ["6 m", "1.5 m"]
[[method]]
name = "coupled"
interaction = "coupled"
f_max = "100 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
[criteria]
method = "coupled"
curves = ["VC-A"]
"""


@pytest.fixture
def doubts(tmp_path):
    """Return what gives the doubts about a study in which texts are replaced, by subject."""

    def find(*changes):
        text = ON_WALLS
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = Path(tmp_path) / "study.toml"
        path.write_text(text, encoding="utf-8")
        return {doubt.subject: doubt.message for doubt in study_doubts(load_study(path))}

    return find


def test_edges_that_take_thrust_are_doubted(doubts):
    """The closed forms with both ends held and with one that slides are 14.93 and 12.11 Hz."""
    found = doubts(('x_min = "simple", x_max = "simple"', 'x_min = "pinned", x_max = "pinned"'))
    assert f"{100 * ((14.93 / 12.11) ** 2 - 1):.0f} % too high" in found["edges along x"]
    assert '"simple"' in found["edges along x"]
    assert "edges along x" not in doubts()
    found = doubts(('x_min = "simple", x_max = "simple"', 'x_min = "clamped", x_max = "clamped"'))
    assert "clamped" in found["edges along x"]
