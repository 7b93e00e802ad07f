"""What a model comes to: masses, centre, areas and frequencies by hand."""

import json

import numpy as np
import pytest

from mode_tables import SI, files, mode_tables
from models import small_floor
from studies import run_main
from trundle.imports import ReadModel, read_modes
from trundle.imports.summary import summary_of
from trundle.structure import BeamGroup, BeamSection, Floor, Material, PointMasses, SpringGroup
from trundle.structure.elements import GROUND

STUFF = Material(elastic_modulus=2e11, poisson_ratio=0.3, density=0.0)
STICK = BeamSection.rectangle(width=0.1, depth=0.1, material=STUFF)


def stick(**more):
    """Two masses at the ends of a stiff stick without weight, 4 m along x, at y = 1, z = 2."""
    nodes = np.array([[0.0, 1.0, 2.0], [4.0, 1.0, 2.0]])
    return Floor(
        nodes=nodes,
        fixed=np.array([[True] * 6, [False] * 6]),
        beams=(BeamGroup(elements=np.array([[0, 1]]), section=STICK, name="stick"),),
        masses=(PointMasses(nodes=np.array([0, 1]), mass=np.array([300.0, 100.0])),),
        **more,
    )


def test_masses_are_those_without_supports():
    """400 kg at x = 1; about y and z 300 x 1 + 100 x 9 kg m2, about x nothing."""
    found = summary_of(stick())
    assert found.mass == pytest.approx([400.0, 400.0, 400.0, 0.0, 1200.0, 1200.0], abs=1e-6)
    assert found.centre == pytest.approx([1.0, 1.0, 2.0])
    assert found.rigid.max() < 1e-12
    assert [(g.name, g.count, g.size, g.mass) for g in found.groups] == [
        ("stick", 1, 4.0, 0.0),
        ("point mass", 2, 0.0, 400.0),
    ]
    first = np.sqrt(3.0 * 2e11 * 0.1**4 / 12.0 / 4.0**3 / 100.0) / (2.0 * np.pi)
    assert found.frequencies[:2] == pytest.approx([first, first], rel=2e-3)  # shear: 0.1 %


def test_springs_to_the_ground_are_seen():
    """1 kN/m at one end, against the largest stiffness on the diagonal, E A / L."""
    spring = SpringGroup(
        elements=np.array([[1, GROUND]]), stiffness=np.array([0, 0, 1e3, 0, 0, 0]), name="pad"
    )
    found = summary_of(stick(springs=(spring,)))
    assert found.rigid[2] == pytest.approx(1e3 / (2e11 * 0.01 / 4.0))
    assert found.rigid[[0, 1, 5]].max() < 1e-12


def test_a_floor_is_summed_up():
    """A slab of 12 x 6 m: its area, surface, and the mass of every group."""
    floor = small_floor(mesh_size=1.5)
    found = summary_of(floor, ReadModel(structure=floor, told=("passed over: LOADS",)))
    slab = next(g for g in found.groups if g.kind == "quadrilaterals")
    assert slab.size == pytest.approx(72.0)
    assert [(s.name, s.area) for s in found.surfaces] == [("floor", pytest.approx(72.0))]
    assert sum(g.mass for g in found.groups) == pytest.approx(found.mass[2])
    assert found.told == ("passed over: LOADS",)


def test_modes_alone_weigh_nothing(tmp_path):
    floor = small_floor(mesh_size=3.0)
    mode_tables(tmp_path, floor, 60.0)
    found = summary_of(read_modes(files(tmp_path), units=SI).structure)
    assert found.mass is None
    assert found.frequencies == pytest.approx(floor.modes(60.0).frequencies[:10])


DECK = """BEGIN BULK
MAT1,1,2.+11,,0.3,7850.
PBAR,1,1,.01,2.-5,8.-6,1.-5
GRID,1,,0.,0.,3.,,123456
GRID,2,,4.,0.,3.
CBAR,1,1,1,2,0.,0.,1.
EIGRL,1,,,3
"""


def test_the_command_says_it(tmp_path, monkeypatch, capsys):
    """Mass of a bar by hand: half of it at its free end moves, all of it is there."""
    path = tmp_path / "bar.bdf"
    path.write_text(DECK)
    code, said = run_main(monkeypatch, capsys, "model", path)
    assert code == 0
    for words in ("units: N and m are assumed", "passed over: EIGRL (1)", "property 1", "floor"):
        assert words in said.out
    code, said = run_main(monkeypatch, capsys, "model", path, "--units", "N, mm", "--json")
    found = json.loads(said.out)
    assert found["units"] == "N, mm"
    assert found["mass_kg_and_kg_m2"][2] == pytest.approx(0.01 * 4.0 * 7850.0 * 1e3)  # in tonnes
    code, said = run_main(monkeypatch, capsys, "model", path, "--units", "parsec")
    assert (code, "--units: units 'parsec' are not understood" in said.err) == (2, True)
    path.write_text(DECK + "CHEXA,1,1,1\n")
    code, said = run_main(monkeypatch, capsys, "model", path)
    assert (code, "CHEXA" in said.err) == (2, True)
    code, said = run_main(monkeypatch, capsys, "model", path, "--ignore", "CHEXA")
    assert (code, "passed over: CHEXA (1)" in said.out) == (0, True)
