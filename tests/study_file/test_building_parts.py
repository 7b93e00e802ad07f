"""Parts of a [building] from its tables: places on the grid, names, holds, and mistakes."""

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.errors import StudyError
from trundle.study_file.building_makes import materials_of
from trundle.study_file.building_parts import parts_of
from trundle.study_file.read import read_text

CAR = "[vehicle.car]"
COLUMN = BUILDING[BUILDING.index("[[building.column]]") : BUILDING.index("[[building.wall]]")]
WALL = BUILDING[BUILDING.index("[[building.wall]]") : BUILDING.index(CAR)]
BEAM = BUILDING[BUILDING.index("[[building.beam]]") : BUILDING.index("[[building.column]]")]


def text_of(*changes, more=""):
    text = BUILDING
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text.replace(CAR, f"{more}\n{CAR}")


def made(*changes, more=""):
    """Return the parts of a building that is not meshed, and its mistakes by their places."""
    file, problems = read_text(text_of(*changes, more=more), "s")
    assert not problems, [str(p) for p in problems]
    section = file.tables["building"]
    building, _, found = parts_of(section, materials_of(section))
    return building, {p.place: p for p in found}


def building(*changes, more=""):
    found, mistakes = made(*changes, more=more)
    assert not mistakes, [str(p) for p in mistakes.values()]
    return found


def told(*changes, more=""):
    """Return all mistakes of the study by their places."""
    with pytest.raises(StudyError) as caught:
        tr.study_from_text(text_of(*changes, more=more))
    return {p.place: p for p in caught.value.problems}


def test_a_building_in_other_units_is_the_same_building():
    """Levels, lines and sizes once more in mm, cm and dm."""
    other = building(
        ('level = "6.5 m"', 'level = "650 cm"'),
        ('B = "8 m"', 'B = "8000 mm"'),
        ('thickness = "0.25 m"', 'thickness = "2.5 dm"'),
        ('width = "0.4 m"', 'width = "400 mm"'),
        ('["10 m", "2 m"]', '["1000 cm", "2 m"]'),
    )
    plain = building()
    assert [s.level for s in other.storeys] == [s.level for s in plain.storeys] == [0.0, 3.0, 6.5]
    np.testing.assert_array_equal(other.slabs[0].openings[0], plain.slabs[0].openings[0])
    assert other.slabs[0].section.thickness == pytest.approx(0.25)
    profiles = other.columns[0].profile, plain.columns[0].profile
    assert profiles[0].section.inertia_y == pytest.approx(profiles[1].section.inertia_y)


def test_a_crossing_is_an_x_and_a_y_whichever_stands_first():
    """A is at x = 0 and 2 at y = 6 m: A/2 and 2/A are one place, blanks around the stroke too."""
    lines = [
        building(('along = ["B/1", "B/2"]', f'along = ["{a}", "C/1"]')).beams[0].along[0]
        for a in ("A/2", "2/A", " A / 2 ")
    ]
    assert [line.tolist() for line in lines] == [[0.0, 6.0]] * 3


def test_lines_that_lean_cross_where_geometry_says():
    """From (0, 0) to (8, 6): at x = 4 m it is at y = 3 m; and with y = 1.5 m at x = 2 m."""
    lean = ("[building.grid.y]", 'M = "4 m"\n[building.grid.lines]\nQ = [["0 m", "0 m"], ["800 cm", "6 m"]]\n[building.grid.y]\nh = "1.5 m"')  # fmt: skip
    beam = building(lean, ('along = ["B/1", "B/2"]', 'along = ["M/Q", "Q/h"]')).beams[0]
    np.testing.assert_allclose(beam.along, [[4.0, 3.0], [2.0, 1.5]], atol=1e-9)


@pytest.mark.parametrize(
    ("place", "words"),
    [("A/9", "there is no grid line '9'"), ("a/1", "there is no grid line 'a'"), ("A/C", "do not cross"), ("A/A", "do not cross")],
)  # fmt: skip
def test_a_crossing_that_is_none_is_told_at_its_place(place, words):
    """Names are looked for as they are written; lines side by side never meet."""
    _, found = made(
        ('["A/1", "C/1", "C/2", "A/2"]\nopenings', f'["A/1", "C/1", "{place}", "A/2"]\nopenings')
    )
    assert list(found) == ["building.slab[1].outline[3]"]
    assert words in found["building.slab[1].outline[3]"].rule


def test_columns_on_the_grid_stand_where_lines_cross():
    """Three lines at an x and two at a y are six columns; lines that lean make none."""
    lean = ("[building.grid.y]", '[building.grid.lines]\nQ = [["0 m", "0 m"], ["8 m", "6 m"]]\n[building.grid.y]')  # fmt: skip
    places = {tuple(c.at) for c in building(lean).columns}
    assert places == {(x, y) for x in (0.0, 8.0, 16.0) for y in (0.0, 6.0)}


def test_a_column_stands_between_its_storeys_turned_and_held_as_it_says():
    """30 deg stay 30 deg; springs keep their axes, in MN/m and kN m/rad."""
    column = COLUMN.replace('at = "grid"', 'at = ["B/1", ["100 cm", "2 m"]]\nangle = "30 deg"')
    column = column.replace(
        'base = "fixed"',
        'base = { uz = "50 MN/m", rx = "3 kN m/rad" }\ncap = "pinned"\nhead = "point"',
    )
    first, second = building((COLUMN, column)).columns
    assert (first.at.tolist(), second.at.tolist()) == ([8.0, 0.0], [1.0, 2.0])
    assert first.angle == pytest.approx(30.0)
    assert (first.bottom, first.top, first.head) == ("ground", "lab", "point")
    assert first.base == pytest.approx((0.0, 0.0, 5e7, 3e3, 0.0, 0.0))
    assert first.cap == "pinned"
    plain = building().columns[0]
    assert (plain.angle, plain.base, plain.cap, plain.head) == (0.0, "fixed", None, "rigid")


def test_a_wall_of_several_legs_is_a_wall_a_leg():
    """Three corners are two walls, end to end."""
    walls = building(('along = ["A/1", "A/2"]', 'along = ["A/1", "A/2", "B/2"]')).walls
    assert [w.along.tolist() for w in walls] == [
        [[0.0, 0.0], [0.0, 6.0]],
        [[0.0, 6.0], [8.0, 6.0]],
    ]


@pytest.mark.parametrize(
    ("word", "hinged"),
    [
        ("none", (False, False)),
        ("start", (True, False)),
        ("end", (False, True)),
        ("both", (True, True)),
    ],
)
def test_a_beam_is_hinged_where_it_says(word, hinged):
    """At its first place, its last one, both or neither; below the slab unless told otherwise."""
    beam = building(('hinged = "both"', f'hinged = "{word}"')).beams[0]
    assert beam.hinged == hinged
    assert beam.below
    assert not building(('hinged = "both"', "below = false")).beams[0].below


@pytest.mark.parametrize(
    ("hold", "held"),
    [
        ('"roller"', [0, 0, 1, 0, 0, 0]),
        ('"pinned"', [1, 1, 1, 0, 0, 0]),
        ('"fixed"', [1, 1, 1, 1, 1, 1]),
        ('["ry", "ux"]', [1, 0, 0, 0, 1, 0]),
    ],
)
def test_a_support_holds_what_its_word_or_list_says(hold, held):
    """In the order ux, uy, uz, rx, ry, rz, whatever the order of the list."""
    table = f'[[building.support]]\non = "deck"\nalong = ["C/1", "C/2"]\nhold = {hold}\nangle = "-15 deg"\n'
    (support,) = building(more=table).supports
    assert [int(one) for one in support.held] == held
    assert support.angle == pytest.approx(-15.0)
    np.testing.assert_array_equal(support.along, [[16.0, 0.0], [16.0, 6.0]])


def test_supports_and_masses_at_places_are_one_each_and_along_a_line_one():
    """Springs by the metre along a line, by themselves at places; 0.25 t/m are 250 kg/m."""
    table = """
[[building.support]]
on = "lab"
at = ["A/1", ["3 m", "2 m"]]
springs = { uy = "4 MN/m", rz = "5 kN m/rad" }
[[building.support]]
on = "lab"
along = ["A/1", "C/1"]
springs = { uz = "2 kN/mm/m" }
[[building.mass]]
on = "deck"
at = ["A/1", "B/1"]
mass = "1.2 t"
[[building.mass]]
on = "lab"
along = ["A/1", "C/1"]
mass_per_metre = "0.25 t/m"
"""
    found = building(more=table)
    assert [s.springs for s in found.supports] == [
        (0, 4e6, 0, 0, 0, 5e3), (0, 4e6, 0, 0, 0, 5e3), (0, 0, 2e6, 0, 0, 0),
    ]  # fmt: skip
    assert [s.along.tolist() for s in found.supports] == [
        [[0.0, 0.0]], [[3.0, 2.0]], [[0.0, 0.0], [16.0, 0.0]],
    ]  # fmt: skip
    assert [m.mass for m in found.masses] == pytest.approx([1200.0, 1200.0, 250.0])
    assert [len(m.along) for m in found.masses] == [1, 1, 2]


@pytest.mark.parametrize(
    ("table", "place", "value"),
    [
        ('mass]]\non = "deck"\nat = ["A/1"]\nmass_per_metre = "9 kg/m"', "building.mass[1].mass", "nothing"),
        ('mass]]\non = "deck"\nat = ["A/1"]\nmass = "9 kg"\nmass_per_metre = "9 kg/m"', "building.mass[1].mass", "both"),
        ('mass]]\non = "deck"\nalong = ["A/1", "B/1"]\nmass = "9 kg"', "building.mass[1].mass_per_metre", "nothing"),
        ('mass]]\non = "deck"\nat = ["A/1"]\nmass = "0 kg"', "building.mass[1].mass", "nothing"),
        ('mass]]\non = "deck"\nat = ["A/1"]\nalong = ["A/1", "B/1"]\nmass = "9 kg"', "building.mass[1]", "both"),
        ('support]]\non = "deck"\nhold = "pinned"', "building.support[1]", "neither"),
        ('symmetry]]\naxis = "x"\nat = "0 m"\nalong = ["A/1", "A/2"]', "building.symmetry[1]", "both"),
        ('symmetry]]\nat = "0 m"', "building.symmetry[1]", "neither"),
        ('brace]]\nsection = "steel"\nstart = "A/1"\nend = "Z/1"\non = ["ground", "deck"]', "building.brace[1].end", "Z/1"),
        ('ramp]]\nname = "r"\nplate = "dock"\noutline = ["A/1", "B/1", "B/2", "A/2"]\nfrom = "ground"\nto = "deck"', "building.ramp[1].plate", "'dock'"),
    ],
)  # fmt: skip
def test_a_part_that_is_said_by_half_or_twice_is_told(table, place, value):
    """A mass of 0 kg, or a line whose mass is not by the metre, would be another mass."""
    _, found = made(more=f"[[building.{table}\n")
    assert found[place].value == value


def test_all_mistakes_of_parts_are_told_and_each_at_its_own_number():
    """The second of two beams, and the place of it; what is sound is not told."""
    second = BEAM.replace('["B/1", "B/2"]', '["A/1", "A/7"]').replace('"steel"', '"stel"')
    _, found = made((BEAM, BEAM + second), ('plate = "wall"', 'plate = "waal"'))
    assert set(found) == {
        "building.beam[2].along[2]", "building.beam[2].section", "building.wall[1].plate",
    }  # fmt: skip
    assert found["building.beam[2].section"].remedy == (
        "there are: post, steel; add [building.sections.stel]"
    )


def test_a_brace_runs_from_place_to_place_on_its_two_storeys():
    """Its start is on the first storey, its end on the second; hinged unless told otherwise."""
    table = '[[building.brace]]\nsection = "steel"\nstart = "B/1"\nend = ["10 m", "0 m"]\non = ["ground", "deck"]\n'
    (brace,) = building(more=table).braces
    np.testing.assert_array_equal(brace.ends, [[8.0, 0.0], [10.0, 0.0]])
    assert (brace.on, brace.hinged) == (("ground", "deck"), True)


def test_a_ramp_rises_from_its_storey_to_the_next():
    """Its first two corners are the lower edge."""
    table = (
        '[[building.ramp]]\nname = "Rampe <1>"\nplate = "deck"\nfrom = "ground"\nto = "deck"\n'
        'outline = [["16 m", "0 m"], ["16 m", "3 m"], ["20 m", "3 m"], ["20 m", "0 m"]]\n'
    )
    (ramp,) = building(more=table).ramps
    assert (ramp.name, ramp.bottom, ramp.top) == ("Rampe <1>", "ground", "deck")
    np.testing.assert_array_equal(ramp.outline[:2], [[16.0, 0.0], [16.0, 3.0]])


def test_a_plane_of_symmetry_is_across_its_axis_at_its_place():
    """Places at x = 12 m lie on it, those at x = 10 m two metres away."""
    (plane,) = building(more='[[building.symmetry]]\naxis = "x"\nat = "1200 cm"\n').symmetry
    away = np.abs(plane.away(np.array([[12.0, 5.0, 1.0], [10.0, 0.0, 3.0], [12.0, -9.0, 0.0]])))
    np.testing.assert_allclose(away, [0.0, 2.0, 0.0])


def test_north_is_in_degrees_and_absent_where_nobody_says():
    """A quarter turn."""
    size = 'mesh_size = "1.5 m"'
    assert building().north is None
    assert building((size, f'{size}\nnorth = "-90 deg"')).north == pytest.approx(-90.0)


def test_steel_is_known_and_another_may_take_its_name():
    """Steel has 210 GPa and 7850 kg/m3 (EN 1993-1-1, 3.2.6); a file's own comes first."""
    beam = building().beams[0].profile.section
    assert (beam.material.elastic_modulus, beam.material.density) == (210e9, 7850.0)
    own = '[building.materials.steel]\nelastic_modulus = "70 GPa"\ndensity = "2.7 t/m3"\n'
    beam = building(("[building.sections.post]", own + "[building.sections.post]")).beams[0]
    assert beam.profile.section.material.elastic_modulus == pytest.approx(70e9)


def test_names_of_storeys_grids_and_plates_may_be_anything():
    """Umlauts, commas and signs of HTML in quotes, kept as they are."""
    text = text_of().replace('"lab"', '"2. OG, Süd <Labor>"')
    text = text.replace('plate = "deck"', 'plate = "D 25; C30/37"').replace(
        "[building.plates.deck]", '[building.plates."D 25; C30-37"]'
    )
    text = text.replace("C30/37", "C30-37")
    study = tr.study_from_text(text)
    assert set(study.floor.surfaces) == {"deck", "2. OG, Süd <Labor>"}
    assert study.points["tool"].on == "2. OG, Süd <Labor>"


def test_a_mistake_of_one_leg_or_place_has_its_line():
    """A wall in the air, a column off its storey: line and table of the part that was written."""
    text = text_of(('to = "lab"\nbase = "pinned"', 'to = "loft"\nbase = "pinned"'))
    with pytest.raises(StudyError) as caught:
        tr.study_from_text(text)
    (problem,) = [p for p in caught.value.problems if "wall" in p.place]
    assert text.splitlines()[problem.line - 1] == 'to = "loft"'
