"""Materials, cross-sections and plates by name: keys each shape needs, and numbers by hand."""

import numpy as np
import pytest

from studies import BUILDING
from trundle.study_file.building_makes import (
    _PLATES,
    _SHAPES,
    PlateSection,
    ProfileSection,
    materials_of,
    plates_of,
    profiles_of,
)
from trundle.study_file.read import read_text

SIZES = {
    "width": "0.3 m", "depth": "0.5 m", "diameter": "0.4 m", "wall": "10 mm", "web": "12 mm",
    "flange": "15 mm", "radius": "20 mm", "rolled": "HEB 200", "area": "84.5 cm2",
    "inertia_y": "23130 cm4", "inertia_z": "1318 cm4", "torsion_constant": "51 cm4",
    "shear_area_y": "50 cm2", "shear_area_z": "40 cm2",
}  # fmt: skip
PLATE_SIZES = {
    "thickness": "0.3 m", "plate": "0.1 m", "rib_width": "0.15 m", "rib_depth": "0.3 m",
    "spacing": "0.9 m", "spacing_y": "1.2 m", "depth": "0.14 m", "void": "0.2 m",
    "topping": "5 cm", "deck_height": "0.06 m", "deck_mass": "12 kg/m2",
}  # fmt: skip


def section_of(kind, keys):
    """Return a [building] with one section or plate of its own."""
    table = "\n".join(f'{k} = "{v}"' for k, v in keys.items())
    name = f"[building.{kind}.x]\n{table}\n"
    file, problems = read_text(
        BUILDING.replace("[building.grid.x]", name + "[building.grid.x]"), "s"
    )
    assert not problems, [str(p) for p in problems]
    return file.tables["building"]


def profile(shape, **sizes):
    section = section_of("sections", {"shape": shape, "material": "concrete", **sizes})
    return profiles_of(section, materials_of(section))


def plate(kind, **keys):
    section = section_of("plates", {"kind": kind, "material": "concrete", **keys})
    return plates_of(section, materials_of(section))


@pytest.mark.parametrize("shape", _SHAPES)
def test_a_shape_needs_its_sizes_and_takes_no_others(shape):
    """With all it is made; without one that one is named; one of another shape is not wanted."""
    needs, may = _SHAPES[shape]
    made, found = profile(shape, **{k: SIZES[k] for k in (*needs, *may)})
    assert "x" in made
    assert not found
    for key in needs:
        made, found = profile(shape, **{k: SIZES[k] for k in needs if k != key})
        assert "x" not in made
        assert [p.place for p in found] == [f"building.sections.x.{key}"]
    stranger = next(k for k in SIZES if k not in (*needs, *may))
    made, found = profile(shape, **{k: SIZES[k] for k in (*needs, stranger)})
    assert [(p.place, p.value) for p in found] == [(f"building.sections.x.{stranger}", "given")]


@pytest.mark.parametrize("kind", _PLATES)
def test_a_plate_needs_its_sizes_and_takes_no_others(kind):
    """As of shapes: what is dropped in silence would be a stiffer or lighter floor."""
    needs, _ = _PLATES[kind]
    made, found = plate(kind, **{k: PLATE_SIZES[k] for k in needs})
    assert "x" in made
    assert not found
    for key in needs:
        made, found = plate(kind, **{k: PLATE_SIZES[k] for k in needs if k != key})
        assert "x" not in made
        assert [p.place for p in found] == [f"building.plates.x.{key}"]


def test_every_key_of_a_section_belongs_to_a_shape():
    """A key that no shape takes could never be given."""
    always = {"shape", "material", "stiffness_factor"}
    assert {k for both in _SHAPES.values() for k in (*both[0], *both[1])} == (
        set(ProfileSection.model_fields) - always
    )
    always = {"kind", "material", "stiffness_factor", "superimposed_mass", "imposed_load", "imposed_share"}  # fmt: skip
    assert {k for both in _PLATES.values() for k in (*both[0], *both[1])} == (
        set(PlateSection.model_fields) - always
    )


def test_a_rectangle_bends_by_its_depth_cubed():
    """b h3 / 12 about the level axis, h b3 / 12 about the other, by hand."""
    made, _ = profile("rectangle", width="30 cm", depth="500 mm")
    section = made["x"].section
    assert section.area == pytest.approx(0.15)
    assert section.inertia_y == pytest.approx(0.3 * 0.5**3 / 12)
    assert section.inertia_z == pytest.approx(0.5 * 0.3**3 / 12)


def test_a_section_of_ones_own_keeps_each_of_its_numbers():
    """In cm2 and cm4; without shear areas it does not shear."""
    own = {k: SIZES[k] for k in _SHAPES["own"][0]}
    section = profile("own", **own)[0]["x"].section
    assert section.area == pytest.approx(84.5e-4)
    assert section.inertia_y == pytest.approx(23130e-8)
    assert section.inertia_z == pytest.approx(1318e-8)
    assert section.torsion_constant == pytest.approx(51e-8)
    assert np.isinf([section.shear_area_y, section.shear_area_z]).all()
    sheared = profile("own", **own, shear_area_z="40 cm2")[0]["x"].section
    assert sheared.shear_area_z == pytest.approx(40e-4)
    assert np.isinf(sheared.shear_area_y)


def test_a_rolled_section_has_the_numbers_of_its_table():
    """IPE 400 in EN 10365: 84.5 cm2, 23130 cm4, 1318 cm4, to the rounding of the table."""
    made, _ = profile("rolled", rolled="IPE 400")
    section = made["x"].section
    assert section.area == pytest.approx(84.5e-4, rel=5e-3)
    assert section.inertia_y == pytest.approx(23130e-8, rel=5e-3)
    assert section.inertia_z == pytest.approx(1318e-8, rel=5e-3)


def test_a_cracked_section_is_softer_and_as_heavy():
    """Half of every stiffness; rho A stays."""
    sizes = {"width": "0.3 m", "depth": "0.5 m"}
    whole = profile("rectangle", **sizes)[0]["x"].section
    half = profile("rectangle", **sizes, stiffness_factor="50 %")[0]["x"].section
    assert half.material.elastic_modulus * half.inertia_y == pytest.approx(
        0.5 * whole.material.elastic_modulus * whole.inertia_y
    )
    assert half.material.density * half.area == pytest.approx(whole.material.density * whole.area)


@pytest.mark.parametrize(
    ("keys", "extra"),
    [
        ({}, 0.0),
        ({"superimposed_mass": "0.1 t/m2"}, 100.0),
        ({"imposed_load": "5 kN/m2"}, 0.1 * 5000 / 9.80665),
        ({"imposed_load": "5 kPa", "superimposed_mass": "100 kg/m2"}, 100 + 500 / 9.80665),
    ],
)
def test_mass_that_lies_on_a_plate_moves_with_it(keys, extra):
    """Its own 0.3 m of 2500 kg/m3, what is permanent, and a tenth of the imposed load over g."""
    made, found = plate("solid", thickness="30 cm", **keys)
    assert not found
    assert made["x"].mass_per_area == pytest.approx(750.0 + extra)


def test_every_part_that_names_an_unknown_material_is_told_with_those_there_are():
    """Steel is always there; those of the file come behind it."""
    section = section_of("plates", {"material": "beton", "thickness": "0.3 m"})
    _, found = plates_of(section, materials_of(section))
    (problem,) = found
    assert problem.place == "building.plates.x.material"
    assert problem.remedy.startswith("there are: steel, concrete;")
