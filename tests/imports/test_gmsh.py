"""Meshes of gmsh: closed forms, the same mesh in both formats, and files that are damaged."""

import os
from pathlib import Path

import numpy as np
import pytest

from meshes import as_msh_2, as_msh_4, plate_mesh
from trundle.imports import Asked, GroupMake, SurfaceChoice, read_model, units_of
from trundle.structure import BeamSection, Material, ShellSection

STUFF = Material(elastic_modulus=30e9, poisson_ratio=0.2, density=2500.0)
PLATE = ShellSection(thickness=0.1, material=STUFF)
BEAM = BeamSection.rectangle(width=0.3, depth=0.5, material=STUFF)
SIMPLE = np.array([True, True, True, False, False, False])
NOTHING = GroupMake()
PLAIN = {
    "slab": GroupMake(plate=PLATE),
    "edge": GroupMake(held=SIMPLE),
    "beam": NOTHING,
    "corner": NOTHING,
}
DATA = Path(__file__).parents[3] / "shared" / "data" / "models" / "msh"


def read(tmp_path, text, **asked):
    path = tmp_path / "plate.msh"
    path.write_text(text)
    return read_model(path, Asked(**{"units": units_of("N, m"), "groups": PLAIN, **asked}))


@pytest.mark.parametrize(("triangles", "error"), [(False, 0.004), (True, 0.004)])
@pytest.mark.parametrize("form", [as_msh_2, as_msh_4])
def test_a_plate_vibrates_as_naviers(tmp_path, form, triangles, error):
    """Simply supported: f = pi/2 (1/a2 + 1/b2) sqrt(D/m); shear and mesh leave 0.4 %."""
    found = read(tmp_path, form(*plate_mesh(24, 16, triangles=triangles)))
    assert found.problems == ()
    rigidity = 30e9 * 0.1**3 / 12 / (1 - 0.2**2)
    navier = 0.5 * np.pi * (1 / 36 + 1 / 16) * np.sqrt(rigidity / 250.0)
    frequency = found.structure.modes(1.5 * navier).frequencies[0]
    assert frequency == pytest.approx(navier, rel=error)


def test_both_formats_and_units_give_one_model(tmp_path):
    """The same mesh in metres and millimetres, 2.2 and 4.1: the same matrices."""
    nodes, groups = plate_mesh(6, 4)
    makes = {**PLAIN, "beam": GroupMake(section=BEAM, offset=np.array([0.0, 0.0, -0.3]))}
    first = read(tmp_path, as_msh_4(nodes, groups), groups=makes).structure
    other = read(tmp_path, as_msh_4(1e3 * nodes, groups), groups=makes, units=units_of("N, mm"))
    for a, b in zip(first.matrices(), other.structure.matrices(), strict=True):
        assert abs(a - b).max() <= 1e-10 * abs(a).max()
    second = read(tmp_path, as_msh_2(nodes, groups), groups=makes).structure
    assert second.modes(60.0).frequencies == pytest.approx(first.modes(60.0).frequencies, rel=1e-9)


def test_a_column_and_springs_stand_as_said(tmp_path):
    """A stiff line on a spring: f = sqrt(k/m) / 2 pi; a column along z has its depth along x."""
    nodes = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [1.0, 0.0, 3.0]])
    groups = {(1, 1, "column"): np.array([[0, 1]]), (1, 2, "beam"): np.array([[1, 2]]),
              (0, 3, "base"): np.array([[0]])}  # fmt: skip
    held = np.array([True, True, False, True, True, True])
    makes = {
        "column": GroupMake(section=BEAM),
        "beam": GroupMake(section=BEAM),
        "base": GroupMake(held=held, springs=np.array([0.0, 0.0, 1e5, 0.0, 0.0, 0.0])),
    }
    floor = read(tmp_path, as_msh_4(nodes, groups), groups=makes).structure
    mass = 0.15 * 2500.0 * 4.0
    expected = np.sqrt(1e5 / mass) / (2.0 * np.pi)  # 1 mm of the members' own give leaves 0.1 %
    assert floor.modes(3.0).frequencies[0] == pytest.approx(expected, rel=1e-3)
    column, beam = floor.beams
    assert (column.name, beam.name) == ("column", "beam")
    np.testing.assert_array_equal(column.up, [1.0, 0.0, 0.0])
    np.testing.assert_array_equal(beam.up, [0.0, 0.0, 1.0])
    assert list(floor.surfaces) == ["floor"]


def test_levels_are_found_or_chosen(tmp_path):
    """Two storeys of one mesh: both are surfaces; a height chooses one, with a name."""
    nodes, groups = plate_mesh(4, 4)
    upper, above = plate_mesh(4, 4, z=3.2)
    both = {key: np.concatenate([groups[key], above[key] + len(nodes)]) for key in groups}
    text = as_msh_4(np.concatenate([nodes, upper]), both)
    assert list(read(tmp_path, text).structure.surfaces) == ["z = 0 m", "z = 3.2 m"]
    named = (SurfaceChoice(name="roof", height=3.21, groups=("slab",)),)
    surface = read(tmp_path, text, surfaces=named).structure.surface()
    assert (surface.name, surface.frame.origin[2]) == ("roof", 3.2)
    for choice, words in (
        (SurfaceChoice(name="a", height=1.0), "levels at 0 m, 3.2 m"),
        (SurfaceChoice(name="a", groups=("slab",)), "add the height of one of its levels"),
        (SurfaceChoice(name="a", groups=("roof",)), "there are: slab"),
    ):
        assert words in str(read(tmp_path, text, surfaces=(choice,)).problems[0])


def test_a_sloping_group_is_a_ramp(tmp_path):
    """Nodes on z = 0.1 x: a surface in that plane, places measured along it."""
    nodes, groups = plate_mesh(4, 4)
    nodes[:, 2] = 0.1 * nodes[:, 0]
    choice = (SurfaceChoice(name="ramp", groups=("slab",)),)
    ramp = read(tmp_path, as_msh_4(nodes, groups), surfaces=choice).structure.surface()
    np.testing.assert_allclose(ramp.frame.normal, np.array([-0.1, 0, 1]) / np.sqrt(1.01))
    assert ramp.extent[1][0] == pytest.approx(6.0 * np.sqrt(1.01))


GOOD = as_msh_4(*plate_mesh(2, 2))
OLD = as_msh_2(*plate_mesh(2, 2))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GOOD.replace("4.1 0 8", "4.1 1 8"), "line 2: a binary mesh is not read"),
        (GOOD.replace("4.1 0 8", "3.0 0 8"), "line 2: format 3 is not read; 2.2 and 4.1 are"),
        (GOOD[: GOOD.index("$EndElements") - 30], "$Elements does not end: the file is cut short"),
        (GOOD[: GOOD.index("$Elements")], "no $Elements; it may be cut short"),
        (GOOD.replace("3.0 2.0 0.0", "3.0 two 0.0"), "must be 3 numbers; got '3.0 two 0.0'"),
        (GOOD.replace("3.0 2.0 0.0", "3.0 2.0"), "must be 3 numbers; got '3.0 2.0'"),
        (GOOD.replace("3.0 2.0 0.0", "3.0 nan 0.0"), "is not finite"),
        (GOOD.replace("2 21 3 4", "2 21 10 4"), "quadrilaterals of second order are not read"),
        (GOOD.replace("\n1 1 4 5 2 \n", "\n1 1 4 5 77 \n"), "names node 77, which is not there"),
        (GOOD.replace("2 21 3 4", "2 21 nan 4"), "is damaged"),
        (GOOD.replace("\n1 1 4 5 2 \n", "\n1 1.5 4 5 2 \n"), "must be whole"),
        (GOOD.replace("$EndElements", "7 7 7\n$EndElements"), "is left over"),
        (OLD.replace("$EndNodes", "7 7 7 7\n$EndNodes"), "is left over"),
        (GOOD.replace("3.0 2.0 0.0", "1e300 2.0 0.0"), "further than 100 km away"),
        (GOOD.replace('"beam"', '"girder"'), "nothing says what 'girder' of the mesh is"),
        (GOOD.replace("$Nodes", "$Nods").replace("$EndNodes", "$EndNods"), "$Nods is not read"),
        (GOOD.replace("$EndNodes\n", ""), "$Elements ends or begins in another section"),
        (OLD.replace("1 3 2 1 1 34 25 22 31", "1 3 2 1 1 34 25 22"), "has 3 nodes, and its type 4"),
        (OLD.replace("1 3 2 1 1 34", "1 16 2 1 1 34"), "second order are not read"),
        (OLD.replace("$Elements\n15", "$Elements\n99"), "says 99 elements, and has"),
        (OLD.replace("\n34 0.0", "\n31 0.0"), "node 31 is there twice"),
    ],
)  # fmt: skip
def test_damaged_meshes_are_refused_with_their_place(tmp_path, text, words):
    assert text not in (GOOD, OLD)
    found = read(tmp_path, text)
    assert found.structure is None
    assert words in str(found.problems[0])
    assert "plate.msh" in str(found.problems[0])


@pytest.mark.parametrize(
    ("group", "make", "words"),
    [
        ("edge", GroupMake(plate=PLATE), "has a plate, and no triangles"),
        ("slab", GroupMake(section=BEAM), "has a section, and no lines"),
        ("wall", GroupMake(plate=PLATE), "there is no group 'wall'"),
    ],
)
def test_makes_that_do_not_suit_are_refused(tmp_path, group, make, words):
    found = read(tmp_path, GOOD, groups={**PLAIN, group: make})
    assert words in str(found.problems[0])


def test_an_element_of_two_groups_is_made_once(tmp_path):
    """A group beside another on the same elements: stiff twice if both had a plate."""
    nodes, groups = plate_mesh(2, 2)
    groups[2, 9, "loaded"] = groups[2, 1, "slab"][:1]
    text = as_msh_4(nodes, groups)
    found = read(tmp_path, text, groups={**PLAIN, "loaded": GroupMake(plate=PLATE)})
    assert "'slab' and 'loaded': 1 quadrilaterals are there twice" in str(found.problems[0])
    assert read(tmp_path, text, groups={**PLAIN, "loaded": NOTHING}).problems == ()


@pytest.mark.skipif(not DATA.is_dir(), reason="models of other programs are not here")
def test_a_mesh_of_solids_is_refused_by_name():
    """gmsh's own file: tetrahedra; its surface alone can be read where the volume is nothing."""
    path = DATA / "example1.msh"
    makes = {"Load": NOTHING, "Fixed": GroupMake(plate=PLATE), "Solid": GroupMake(plate=PLATE)}
    asked = Asked(units=units_of("N, m"), groups=makes)
    assert "tetrahedra are not read" in str(read_model(path, asked).problems[0])
    asked = Asked(units=units_of("N, m"), groups={**makes, "Solid": NOTHING})
    floor = read_model(path, asked).structure
    assert floor.moving_mass() == pytest.approx(250.0)  # a face of 1 m2
    assert os.path.getsize(path) > 1000
