"""CONTRIBUTING's doors: a toy of each kind, added to a copy of the source as one file or entry."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import trundle
from studies import GOOD, MAP

SOURCE = Path(trundle.__file__).parent
ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    """A copy of the source with one toy of each kind in it."""
    root = tmp_path_factory.mktemp("house")
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(SOURCE, root / "trundle", ignore=ignore)
    for name, text in TOYS.items():
        file = root / "trundle" / name
        assert not file.exists()
        file.write_text(text)
    for name, (after, text) in ENTRIES.items():
        file = root / "trundle" / name
        old = file.read_text("utf-8")
        assert old.count(after) == 1
        file.write_text(old.replace(after, text + after), "utf-8")
    return root


def said(house, script, *arguments):
    """Run a script on the copy, and return what it prints as JSON."""
    done = subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)],
        cwd=house, env=os.environ | {"PYTHONPATH": str(house), "TRUNDLE_CACHE": ""},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


TOYS = {
    "structure/elements/truss.py": '''
"""Bars that stretch and do nothing else."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True, eq=False)
class TrussGroup:
    connectivity: np.ndarray
    rigidity: float  # E A [N]
    name: str = "truss"
    stands_on_ground: bool = False

    @property
    def carried(self):
        return np.array([True] * 3 + [False] * 3)

    def stiffness_blocks(self, xyz):
        along = xyz[:, 1] - xyz[:, 0]
        length = np.linalg.norm(along, axis=1)
        t = np.zeros((len(xyz), 12))
        t[:, :3], t[:, 6:9] = -along / length[:, None], along / length[:, None]
        return (self.rigidity / length)[:, None, None] * t[:, :, None] * t[:, None, :]

    def mass_blocks(self, xyz):
        return None
''',
    "vehicle/data/toy_cart.toml": """
title = "a cart"
source = "made up"
confidence = "low"

[[body]]
mass = 300.0
pitch_inertia = 50.0
centre = 0.6
source = "made up"

[[axle]]
body = 0
setback = 0.0
stiffness = 1e5
damping = 500.0
source = "made up"

[[axle]]
body = 0
setback = 1.2
stiffness = 1e5
damping = 500.0
source = "made up"
""",
    "simulate/sources/shaker.py": '''
"""A force that shakes a floor at one place."""

from dataclasses import dataclass

import numpy as np

from trundle.route import Track
from trundle.simulate.sources.source import KnownForces


@dataclass(frozen=True, kw_only=True)
class Shaker(KnownForces):
    name: str
    at: tuple
    amplitude: float
    frequency: float
    contact_names = ("foot",)
    leaves = 0.0
    on = None

    def track(self, time, begins):
        one = np.ones((len(time), 1))
        place = np.broadcast_to(self.at, (len(time), 1, 2))
        way = np.broadcast_to([1.0, 0.0], place.shape)
        return Track(on=None, place=place, direction=way, speed=0 * one, share=one, share_slope=0 * one)

    def way(self):
        yield np.array([self.at]), np.array([[1.0, 0.0]])

    def inputs(self, time, begins, seed):
        force = self.amplitude * np.sin(2 * np.pi * self.frequency * np.maximum(time, 0.0))
        return Known(force[:, None])

    def excited_to(self, ends):
        return self.frequency


@dataclass(frozen=True)
class Known:
    forces: np.ndarray

    def draw(self, run):
        return self.forces, np.zeros(1)

    def still(self):
        return self.draw(0)
''',
    "study_file/sections/shaker.py": '''
"""Shakers."""

from dataclasses import replace

from trundle.simulate.sources.shaker import Shaker
from trundle.study_file.fields import Frequency, GroupName, Place, Section
from trundle.study_file.kinds import SectionKind


class ShakerSection(Section):
    name: GroupName
    at: Place
    frequency: Frequency


SHAKER = SectionKind(name="shaker", schema=ShakerSection, form="list")


def build(draft):
    shakers = {s.name: Shaker(name=s.name, at=s.at, amplitude=500.0, frequency=s.frequency) for s in draft.file.items("shaker")}
    return replace(draft, sources={**draft.sources, **shakers}), []
''',
    "imports/formats/toy.py": '''
"""Plates: a line of length, width, thickness behind the word PLATE."""

import numpy as np

from trundle.errors import Problem
from trundle.imports.model_format import ModelFormat, ReadModel
from trundle.structure import CONCRETE, FloorPlan, ShellSection, build_floor


def read(path, asked):
    word, *sizes = path.read_text().split()
    if len(sizes) != 3:
        return ReadModel(structure=None, problems=(Problem(
            place=f"{path.name}, line 1", value=word, rule="a plate has three sizes",
            remedy="give length, width and thickness"),))
    length, width, thickness = map(float, sizes)
    plan = FloorPlan(
        x_lines=np.array([0.0, length]), y_lines=np.array([0.0, width]), x_extent=(0.0, length),
        y_extent=(0.0, width), slab=ShellSection(thickness=thickness, material=CONCRETE),
        material=CONCRETE, edges=dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "simple"),
    )
    return ReadModel(structure=build_floor(plan, mesh_size=1.0))


FORMAT = ModelFormat(
    kind="plate", name="PLATE", suffixes=(".plate",), claims=lambda data: data.startswith(b"PLATE"), read=read
)
''',
    "records/formats/toy.py": '''
"""A format of two numbers a line behind the word TOY."""

import numpy as np

from trundle.records.raw import RawRecord
from trundle.records.record_format import RecordFormat


def read(data, path, wanted):
    samples = np.array([[float(line) for line in data.split()[1:]]])
    return RawRecord(names=("z",), units=("m/s2",), samples=samples, rate=500.0)


FORMAT = RecordFormat(
    name="TOY", suffixes=(".toy",), claims=lambda data: data.startswith(b"TOY"), read=read
)
''',
}
ENTRIES = {
    "criteria/data/vc.toml": (
        '[[curve]]\nname = "VC-A"',
        '[[curve]]\nname = "TOY"\ntitle = "Toy"\naliases = ["plaything"]\n'
        "points = [[1.0, 1e-3], [80.0, 1e-3]]\n\n",
    ),
    "response/quantities.py": (
        '    Quantity(\n        name="peak_contact_force",',
        """    Quantity(
        name="mean_square_velocity",
        units="m2/s2",
        long_name="mean square velocity over the record",
        heading="mean square velocity",
        measure=lambda h: np.mean(h.velocity**2, axis=1),
        mapped=Mapped(
            of="velocity", measure=lambda v, _: np.mean(v**2, axis=-1), figure="map_square",
            title="Mean square velocity over the floor", word="mean square",
        ),
    ),
""",
    ),
}


def test_the_page_names_what_is_there():
    """Every path in CONTRIBUTING's instructions exists."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    section = text.partition("## How to add")[2].partition("## Tests")[0]
    paths = [p for p in re.findall(r"`([\w/.]+)`", section) if "/" in p]
    assert len(paths) > 10
    for path in paths:
        assert (SOURCE / path).exists() or (ROOT / path).exists(), path


def test_an_element_is_one_file(house):
    """The tip of a cantilever on a bar sinks by ``P / (3 E I / L^3 + E A / h)``."""
    script = """
import json
import numpy as np
from scipy.sparse.linalg import spsolve
from trundle.structure import BeamGroup, BeamSection, Floor, Material
from trundle.structure.elements.truss import TrussGroup
steel = Material(elastic_modulus=2e11, poisson_ratio=0.3, density=7800.0)
section = BeamSection(
    material=steel, area=1e-2, inertia_y=1e-5, inertia_z=1e-5, torsion_constant=1e-5,
    shear_area_y=np.inf, shear_area_z=np.inf,
)
nodes = np.array([[0.0, 0, 0], [3.0, 0, 0], [3.0, 0, -2.0]])
fixed = np.zeros((3, 6), dtype=bool)
fixed[[0, 2]] = True
floor = Floor(
    nodes=nodes, fixed=fixed, beams=(BeamGroup(elements=np.array([[0, 1]]), section=section),),
    others=(TrussGroup(connectivity=np.array([[1, 2]]), rigidity=4e5),),
)
load = np.zeros(floor.n_dofs)
load[floor.dof_index[1, 2]] = -1e3
print(json.dumps([spsolve(floor.stiffness, load)[floor.dof_index[1, 2]], section.inertia_y]))
"""
    sinking, inertia = said(house, script)
    assert sinking == pytest.approx(-1e3 / (3 * 2e11 * inertia / 27.0 + 4e5 / 2.0), rel=1e-9)


def test_a_vehicle_is_one_file(house, tmp_path):
    """The library, the study file and the command know it; it bounces at sqrt(2 k / m)."""
    (tmp_path / "study.toml").write_text(GOOD.replace("container_truck_40ft", "toy_cart"))
    script = """
import json, sys
import trundle as tr
study = tr.load_study(sys.argv[1])
vehicle = next(iter(study.drives.values())).vehicle
print(json.dumps([list(tr.list_vehicles()), vehicle.natural_frequencies().tolist()]))
"""
    names, frequencies = said(house, script, tmp_path / "study.toml")
    assert "toy_cart" in names
    assert any(
        f == pytest.approx((2e5 / 300.0) ** 0.5 / 6.283185307, rel=1e-3) for f in frequencies
    )


SHAKEN = """
[[shaker]]
name = "pump"
at = ["4 m", "2 m"]
frequency = "7 Hz"

[[traffic]]
name = "both"
routes = ["main", "pump"]
"""


@pytest.mark.slow
def test_a_source_is_one_file_and_one_of_a_study(house, tmp_path):
    """Alone and beside the truck, to report and arrays; decoupled they add up at every point."""
    text = GOOD.replace('interaction = "coupled"', 'interaction = "decoupled"')
    (tmp_path / "study.toml").write_text(text + SHAKEN)
    (tmp_path / "bad.toml").write_text(text + SHAKEN.replace('"7 Hz"', '"7 m"'))
    script = """
import json, sys
from pathlib import Path
import trundle as tr
out = Path(sys.argv[2])
study = tr.load_study(sys.argv[1])
tr.run_study(study, out)
tree = tr.read_results(out).to_xarray()
found = {}
for case in ("main", "pump", "both"):
    histories = next(g for g in tree.groups if g.startswith("/histories/"))
    found[case] = tree[histories]["acceleration"].sel(case=case).values.ravel().tolist()
try:
    tr.load_study(sys.argv[3])
except tr.errors.StudyError as error:
    told = str(error)
print(json.dumps([found, told, [case.name for case in study.cases]]))
"""
    found, told, cases = said(
        house, script, tmp_path / "study.toml", tmp_path / "out", tmp_path / "bad.toml"
    )
    assert cases == ["main", "pump", "both"]
    assert "shaker[1].frequency" in told
    main, pump, both = (np.array(found[case]) for case in cases)
    assert np.abs(pump).max() > 0.0
    np.testing.assert_allclose(both, main + pump, atol=1e-9 * np.abs(both).max())
    assert (tmp_path / "out" / "report.html").stat().st_size > 1e5


def test_a_criterion_is_one_entry(house):
    script = """
import json
from trundle.criteria import find_criterion
print(json.dumps(find_criterion("plaything").limits.tolist()))
"""
    assert said(house, script) == [1e-3, 1e-3]


def test_a_format_of_records_is_one_file(house, tmp_path):
    (tmp_path / "a.toy").write_text("TOY\n" + "\n".join(["0.5", "-0.5"] * 1000))
    script = """
import json, sys
from pathlib import Path
import trundle as tr
record = tr.read_record(Path(sys.argv[1]), tr.records.RecordOptions())
print(json.dumps([record.sampling_frequency, float(record.samples.max())]))
"""
    assert said(house, script, tmp_path / "a.toy") == [500.0, 0.5]


def test_a_format_of_models_is_one_file(house, tmp_path):
    """A study stands on what it reads, and its problems stand with the study's."""
    start, end = GOOD.index("[floor]"), GOOD.index("[vehicle.truck]")
    text = GOOD[:start] + '[floor]\nkind = "model"\nfile = "m.plate"\n\n' + GOOD[end:]
    (tmp_path / "study.toml").write_text(text)
    (tmp_path / "m.plate").write_text("PLATE 12 6 0.25\n")
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "study.toml").write_text(text)
    (tmp_path / "bad" / "m.plate").write_text("PLATE 12 6\n")
    script = """
import json, sys
import numpy as np
import trundle as tr
study = tr.load_study(sys.argv[1])
first = study.floor.modes(20.0).frequencies[0]
try:
    tr.load_study(sys.argv[2])
except tr.errors.StudyError as error:
    told = str(error)
print(json.dumps([first, study.extent, told]))
"""
    first, extent, told = said(
        house, script, tmp_path / "study.toml", tmp_path / "bad" / "study.toml"
    )
    rigidity = 30e9 * 0.25**3 / 12.0 / (1.0 - 0.2**2)
    navier = 0.5 * np.pi * (1 / 144.0 + 1 / 36.0) * np.sqrt(rigidity / (2450.0 * 0.25))
    assert first == pytest.approx(navier, rel=0.03)  # six elements a half wave
    assert extent == [[0.0, 12.0], [0.0, 6.0]]
    assert "m.plate, line 1" in told
    assert "give length, width and thickness" in told


@pytest.mark.longest
def test_a_quantity_is_one_row(house, tmp_path):
    """In arrays, table, report and map; the square of the RMS that stands beside it."""
    (tmp_path / "study.toml").write_text(GOOD + MAP)
    script = """
import csv, json, sys
from pathlib import Path
import trundle as tr
out = Path(sys.argv[2])
result = tr.run_study(tr.load_study(sys.argv[1]), out)
tree = tr.read_results(out).to_xarray()
row = next(csv.DictReader((out / "summary.csv").open()))
page = (out / "report.html").read_text()
found = tree["/mean_square_velocity"]
print(json.dumps([
    found.values.ravel().tolist(), tree["/rms_velocity"].values.ravel().tolist(),
    tree["/maps/main/mean_square_velocity"].values.ravel().tolist(),
    tree["/maps/main/rms_velocity"].values.ravel().tolist(),
    (out / "figures" / "map_square.png").exists(),
    found.attrs["units"], "mean_square_velocity_p50_m2_s2" in row, "mean square velocity [m2/s2]" in page,
]))
"""
    squares, rms, mapped, mapped_rms, drawn, units, in_table, in_report = said(
        house, script, tmp_path / "study.toml", tmp_path / "out"
    )
    # a percentile of squares is between the squares of the runs that it lies between
    assert mapped == pytest.approx([v**2 for v in mapped_rms], rel=0.1)
    assert drawn
    assert squares == pytest.approx([v**2 for v in rms], rel=1e-12)
    assert units == "m2/s2"
    assert in_table
    assert in_report
