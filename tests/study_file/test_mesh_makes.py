"""Groups of a mesh in a study file: what each is made of or held by, or that it is nothing."""

import tomllib

import numpy as np
import pytest
from pydantic import TypeAdapter

from trundle.study_file.building_models import GmshSection
from trundle.study_file.mesh_makes import makes_of

HEAD = """
kind = "gmsh"
file = "hall.msh"
units = "N, m"
[materials.concrete]
elastic_modulus = "30 GPa"
density = "2.5 t/m3"
[plates.floor]
thickness = "200 mm"
material = "concrete"
superimposed_mass = "100 kg/m2"
[sections.girder]
shape = "rectangle"
width = "300 mm"
depth = "50 cm"
material = "concrete"
"""


def made(*groups):
    text = HEAD + "".join(f"[[group]]\n{one}\n" for one in groups)
    section = TypeAdapter(GmshSection).validate_python(tomllib.loads(text))
    makes, found = makes_of(section, section.group)
    return makes, {p.place: p for p in found}


def one(group):
    makes, found = made(f'name = "g"\n{group}')
    assert not found, found
    return makes["g"]


def test_a_plate_and_a_section_are_those_of_their_names():
    """200 mm of 2.5 t/m3 and 100 kg/m2 are 600 kg/m2; 300 mm by 50 cm are 0.15 m2."""
    assert one('plate = "floor"').plate.mass_per_area == pytest.approx(600.0)
    make = one('section = "girder"')
    assert make.section.area == pytest.approx(0.15)
    assert make.plate is None


def test_offset_and_up_are_vectors_x_first():
    """Three lengths of units of their own; up is along z unless said."""
    make = one('section = "girder"\noffset = ["0 m", "25 cm", "-350 mm"]\nup = [0, 1, 0]')
    np.testing.assert_allclose(make.offset, [0.0, 0.25, -0.35])
    np.testing.assert_array_equal(make.up, [0.0, 1.0, 0.0])
    plain = one('section = "girder"')
    np.testing.assert_array_equal(plain.offset, np.zeros(3))
    np.testing.assert_array_equal(plain.up, [0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("hold", "held"),
    [
        ('"roller"', [0, 0, 1, 0, 0, 0]),
        ('"pinned"', [1, 1, 1, 0, 0, 0]),
        ('"fixed"', [1, 1, 1, 1, 1, 1]),
        ('["uy", "rz"]', [0, 1, 0, 0, 0, 1]),
    ],
)
def test_what_is_held_is_in_the_order_of_dofs(hold, held):
    """ux, uy, uz, rx, ry, rz; a group without the key is held by nothing."""
    np.testing.assert_array_equal(one(f"hold = {hold}").held, np.array(held, dtype=bool))
    assert not one('plate = "floor"').held.any()


def test_springs_are_six_of_which_those_not_named_are_nought():
    """5 MN/m along z, 2 kN m/rad about y."""
    springs = one('springs = { uz = "5 MN/m", ry = "2 kN m/rad" }').springs
    np.testing.assert_allclose(springs, [0, 0, 5e6, 0, 2e3, 0])


def test_a_group_that_is_nothing_is_said_to_be():
    """Left out on purpose, and not by a slip."""
    make = one("nothing = true")
    assert (make.plate, make.section) == (None, None)
    assert not make.held.any()
    assert not make.springs.any()


@pytest.mark.parametrize(
    ("group", "place", "words"),
    [
        ("", "building.group[1]", "nothing = true alone"),
        ('plate = "floor"\nnothing = true', "building.group[1]", "nothing = true alone"),
        ('hold = "pinned"\nnothing = true', "building.group[1]", "nothing = true alone"),
        ("hold = []", "building.group[1]", "nothing = true alone"),
        ('plate = "roof"', "building.group[1].plate", "there are: floor"),
        ('section = "Girder"', "building.group[1].section", "there are: girder"),
        ('section = "girder"\nup = [0, 0.0, 0]', "building.group[1].up", "[0, 0, 1]"),
    ],
)
def test_a_group_that_would_not_carry_is_told_with_its_remedy(group, place, words):
    """A floor whose edge is held by nothing falls; one whose slab is nothing is no floor."""
    makes, found = made(f'name = "g"\n{group}')
    assert "g" not in makes
    assert words in found[place].remedy


def test_a_group_that_is_said_twice_is_told_at_its_second_place():
    """The first stays what it is."""
    makes, found = made('name = "a, <ü>"\nplate = "floor"', 'name = "a, <ü>"\nhold = "fixed"')
    assert list(found) == ["building.group[2].name"]
    assert makes["a, <ü>"].plate is not None
