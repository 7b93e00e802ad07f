"""Doubts about a study before it runs: each kind is raised where it belongs and nowhere else."""

from pathlib import Path

import pytest

from trundle.run.meshes import compare_meshes
from trundle.study.doubts import study_doubts
from trundle.study_file.build import load_study

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
f_max = "112 Hz"
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


def test_a_usual_study_is_not_doubted(doubts):
    """What a data sheet would give: concrete, a lorry at 15 km/h, 3 %."""
    assert doubts() == {}


VAN = """kind = "planar"
bodies = [{ mass = "3000 kg", pitch_inertia = "6000 kg m2", centre = "1.8 m" }]
axles = [
  { body = 0, setback = "0 m", stiffness = "160 kN/m", damping = "6 kN s/m" },
  { body = 0, setback = "3.3 m", stiffness = "220 kN/m", damping = "8 kN s/m" },
]"""
TRUCK = 'kind = "container_truck_40ft"'

SLIPS = [
    ('"33 GPa"', '"33 MPa"', "floor.material.elastic_modulus", "33 GPa"),
    ('"33 GPa"', '"3.3 TPa"', "floor.material.elastic_modulus", "33 GPa"),
    ('"33 GPa"', '"100 MPa"', "floor.material.elastic_modulus", "10 GPa"),
    ('"2450 kg/m3"', '"2.45 kg/m3"', "floor.material.density", "2450 kg/m3"),
    ('"2450 kg/m3"', '"24.5 kg/m3"', "floor.material.density", "2450 kg/m3"),
    ('"33 GPa"', '"210 GPa"', "floor.material, elastic_modulus over density", "10 times smaller"),
    ('slab_thickness = "0.2 m"', 'slab_thickness = "1 mm"', "floor.slab_thickness", "100 mm"),
    ('slab_thickness = "0.2 m"', 'slab_thickness = "0.2 mm"', "floor.slab_thickness", "200 mm"),
    ('slab_thickness = "0.2 m"', 'slab_thickness = "0.9 m"',
     "floor.slab_thickness over its span", "10 times smaller"),
    ('width = "0.4 m"', 'width = "4 mm"', "floor.beams_x.width", "400 mm"),
    ('depth = "0.8 m"', 'depth = "8 m"', "floor.beams_x.depth", "800 mm"),
    ('depth = "0.8 m"', 'depth = "0.2 m"', "floor.beams_x.depth over its span", "10 times as large"),
    ('slab_thickness = "0.2 m"', 'slab_thickness = "0.2 m"\nsuperimposed_mass = "0.3 kg/m2"',
     "floor.superimposed_mass", "300 kg/m2"),
    ('slab_thickness = "0.2 m"', 'slab_thickness = "0.2 m"\nsuperimposed_mass = "30 t/m2"',
     "floor.superimposed_mass", "300 kg/m2"),
    ('ratio = "3 %"', 'ratio = "0.03 %"', "method 'coupled'.damping.ratio", "3 %"),
    ('ratio = "3 %"', "ratio = 0.3", "method 'coupled'.damping.ratio", "3 %"),
    ('ratio = "3 %"', 'rayleigh_alpha = "0.8 1/s", rayleigh_beta = "0.01 s"',
     "method 'coupled'.damping at 16 Hz", "15 %"),
    ('speed = "15 km/h"', 'speed = "150 km/h"', "route 'lane'.speed", "15 km/h"),
    ('speed = "15 km/h"', 'speed = "15 m/s"', "route 'lane'.speed", "15 km/h"),
    ('class = "B"', 'class = "G"', "road G", "A to D"),
    ('class = "B"', 'class = "B"\nwaviness = 3.9', "waviness", "1.5"),
    ('f_max = "112 Hz"', 'f_max = "10 Hz"', "method 'coupled'.f_max", "100 Hz"),
    ('at = ["6 m", "1.5 m"]', 'at = ["0 m", "1.5 m"]', "point 'mid'", "cannot move"),
    ('at = ["6 m", "1.5 m"]',
     'at = ["6 m", "1.5 m"]\nisolator = { frequency = "2 Hz", damping = "0.1 %" }',
     "point 'mid'.isolator.damping", "1 %"),
    ('speed = "15 km/h"', 'speed = "15 km/h"\nrun_in = "0.5 m"', "route 'lane'.run_in", "5 m"),
    (TRUCK, VAN.replace("3000 kg", "3 kg"), "vehicle.truck", "1000 times as large"),
    (TRUCK, VAN.replace("3000 kg", "300 t"), "vehicle.truck", "10 times smaller"),
    (TRUCK, VAN.replace("kN/m\"", "N/m\""), "vehicle.truck, stiffness", "1000 times as large"),
    (TRUCK, VAN.replace("kN s/m", "N s/m"), "vehicle.truck, damping", "1000 times as large"),
    (TRUCK, VAN.replace("3.3 m", "33 m").replace("1.8 m", "18 m"), "vehicle.truck, setback", "3.3 m"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "subject", "hint"), SLIPS)
def test_a_slip_of_unit_or_point_is_doubted_with_what_was_meant(doubts, old, new, subject, hint):
    """A prefix left out or a point moved; the hint is the value without the slip."""
    found = doubts((old, new))
    assert subject in " ".join(found), found
    about = " ".join(message for at, message in found.items() if subject in at)
    assert hint in about, about


@pytest.mark.parametrize("order", [("1 t", "900 t"), ("900 t", "1 t")])
def test_each_vehicle_of_one_kind_is_doubted_by_its_own_name(doubts, order):
    """900 t are 7.5 times the heaviest vehicle that is usual, whichever route comes first."""
    payload = 'payload = {{ mass = "{}", body = 0, setback = "5 m" }}'
    first, second = (f"{TRUCK}\n{payload.format(mass)}" for mass in order)
    lane = ON_WALLS[ON_WALLS.index("[[route]]") : ON_WALLS.index("[[road]]")]
    again = lane.replace('"lane"', '"back"').replace('"truck"', '"other"')
    found = doubts((TRUCK, f"{first}\n[vehicle.other]\n{second}"), (lane, lane + again))
    heavy = ("truck", "other")[order.index("900 t")]
    assert "10 times smaller" in found[f"vehicle.{heavy}"]
    assert {"vehicle.truck", "vehicle.other"} & {*found} == {f"vehicle.{heavy}"}


def test_check_prints_doubts_and_still_finds_no_mistake(tmp_path, trundle, capsys):
    """A doubt does not stop anything: exit code 0, the doubt on a line of its own."""
    path = tmp_path / "study.toml"
    path.write_text(ON_WALLS.replace('"33 GPa"', '"33 MPa"'), encoding="utf-8")
    assert trundle("check", path) == 0
    head, *doubts = capsys.readouterr().out.split("\n\n")[0].splitlines()
    assert head.endswith("no mistakes")
    assert any(
        line.startswith("warning: floor.material.elastic_modulus: 33 MPa") for line in doubts
    )
    assert all(line.startswith("warning: ") for line in doubts)


WITH_COLUMNS = """column = { width = "0.4 m", depth = "0.4 m" }
storey_below = "4 m"
edges = { x_min = "free", x_max = "free" }"""
BEARINGS = 'edges = { x_min = "simple", x_max = "simple" }'
BEAMS = 'beams_x = { width = "0.4 m", depth = "0.8 m" }\n'


def test_columns_that_meet_no_beam_are_doubted(doubts):
    """One beam at each column is enough; secondary beams stand between the columns."""
    columns = (BEARINGS, WITH_COLUMNS)
    assert "columns" not in doubts(columns)
    assert "one node" in doubts(columns, (BEAMS, ""))["columns"]
    secondary = (BEAMS, 'secondary_y = { width = "0.2 m", depth = "0.4 m" }\n')
    assert "between the columns" in doubts(columns, secondary)["columns"]
    along_y = (BEAMS, BEAMS.replace("beams_x", "beams_y"))
    assert "columns" not in doubts(columns, along_y)
    assert "columns" not in doubts((BEAMS, ""))


FULL = '[[method]]\nname = "coupled"\nn_max = "25 1/m"'


def test_a_mesh_too_coarse_for_the_highest_band_is_doubted(doubts):
    """By hand: 2 pi sqrt(D / m) / (7 h)^2 with D = 22 MN m and m = 490 kg/m2 is 27.2 Hz at 1 m.

    Waves to 25 cycle/m at 15 km/h excite the bands to 80 Hz, waves to 2.83 those to 10 Hz.
    """
    waves = ('[[method]]\nname = "coupled"', FULL)
    coarse = ('mesh_size = "0.5 m"', 'mesh_size = "0.75 m"')
    speed = 2 * 3.141592653589793 * (33e9 * 0.2**3 / 12 / 490) ** 0.5
    told = doubts(waves, coarse)["mesh"]
    assert f"{speed / (7 * 0.75) ** 2:.3g} Hz" in told
    assert "bands above 40 Hz" in told
    assert f"mesh_size of {int(100 * (speed / 10**1.9) ** 0.5 / 7) / 100:g} m" in told
    assert "mesh" not in doubts(waves)
    assert "mesh" not in doubts(coarse)


@pytest.mark.longest
def test_half_the_mesh_changes_what_the_doubt_says_it_changes(tmp_path):
    """Another mesh: bands of the floor that 0.75 m carries agree; those above are off by more.

    Below 48 Hz a wave's frequency is at most 11 % high, half a band: levels from 6.3 Hz, where the
    floor answers, move by less than a quarter. Above it modes fall into other bands.
    """
    path = tmp_path / "study.toml"
    text = ON_WALLS.replace('[[method]]\nname = "coupled"', FULL).replace('"0.5 m"', '"0.75 m"')
    path.write_text(text.replace('"20 s"', '"8 s"'), encoding="utf-8")
    study = load_study(path)
    assert "mesh" in {doubt.subject for doubt in study_doubts(study)}
    found = compare_meshes(study)
    assert found.sizes == (0.75, 0.375)
    off = abs(found.ratios[0] - 1.0)
    carried = off[(found.bands > 6.0) & (found.bands < 41.0)]
    assert carried.max() < 0.25
    assert off[found.bands > 48.0].mean() > 1.5 * carried.mean()
