"""How a study's mistakes are told: with their line, in this program's words."""

import tomllib

import pytest

from studies import GOOD, LIBRARY, problems
from trundle.errors import StudyError
from trundle.study_file import study_from_text
from trundle.study_file.lines import line_of, lines_of

PLANAR = """kind = "planar"
bodies = [{ mass = "3 t", pitch_inertia = "3000 kg m2" }]
axles = [
  { setback = "0 m", stiffness = "160 kN/m" },
  { setback = "2 m", stiffness = "3 kN/m", AXLE },
]"""


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ('speed = "15 km/h"', 'speed = "15 km/h', "with the quote that it begins with"),
        ('speed = "15 km/h"', "speed = 15 km/h", "a line ends behind its value"),
        ('speed = "15 km/h"', "speed = fast", "or text in quotes"),
        ('speed = "15 km/h"', 'speed "15 km/h"', "followed by ="),
        ('speed = "15 km/h"', 'speed = "15\\km/h"', "written twice"),
        ('speed = "15 km/h"', 'speed = "1"\nspeed = "2"', "a key stands once"),
        ('["12 m", "3 m"]]', '["12 m", "3 m"]', "a list ends with ]"),
        ('curves = ["VC-A"]', 'curves = ["VC-A"', "a list ends with ]"),
        ('curves = ["VC-A"]', 'curves = """VC-A"', "the quote that it begins with"),
        ('damping = { ratio = "3 %" }', 'damping = { ratio = "3 %"', "ends with }"),
        ("[criteria]", "[criteria", "between brackets"),
        ("[criteria]", "[floor]", "a table [name] stands once"),
    ],
)
def test_what_is_no_toml_is_told_with_its_line_in_own_words(tmp_path, old, new, rule):
    """Also what is still open at the end, whose line the TOML reader does not know."""
    (problem,) = problems(tmp_path, (old, new))
    with pytest.raises(tomllib.TOMLDecodeError) as raw:
        tomllib.loads(GOOD.replace(old, new))
    assert rule in problem.rule
    assert str(raw.value) not in str(problem)
    begun = GOOD[: GOOD.index(old)].count("\n") + 1
    assert 0 <= problem.line - begun <= 1  # an open list shows in the line behind it
    assert f"line {problem.line}, " in str(problem)


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("runs = 2", "runs = -2", "runs"),
        ('speed = "15 km/h"', 'speed = "15 kg"', "route[1].speed"),
        ('["12 m", "3 m"]]', '["12 m", "3 kg"]]', "route[1].path[2][2]"),
        ('density = "2450 kg/m3"', 'density = "2450"', "floor.material.density"),
        ('at = ["3 m", "3 m"]', 'at = ["3 m", "300 m"]', "point[1].at"),
        ("[vehicle.truck]\n" + LIBRARY, "[vehicle.truck]", "vehicle.truck.kind"),
    ],
)
def test_values_are_told_with_their_line(tmp_path, old, new, place):
    """What is missing stands, if it stood, below its table's heading."""
    (problem,) = problems(tmp_path, (old, new))
    assert problem.place == place
    assert problem.line == GOOD[: GOOD.index(old)].count("\n") + 1


def test_mistakes_come_in_the_order_of_the_file(tmp_path):
    found = problems(tmp_path, ("15 km/h", "15"), ("4 s", "4 kg"))
    assert [p.place for p in found] == ["duration", "route[1].speed"]


def test_lines_behind_texts_of_several_lines_and_in_sub_tables():
    text = '''
title = """of
[no] = heading
key = "none" """
list = [
  "a]", # ]
  { inner = "x" },
]
[[route]]
name = "a"
[[route]]
"name" = 'b'
[route.far]
speed = 3
[ vehicle . "the truck" ]
kind = 1
'''
    lines = lines_of(text)
    assert set(tomllib.loads(text)) == {"title", "list", "route", "vehicle"}
    assert lines["list"] == 5
    assert "key" not in lines
    assert (lines["route[1].name"], lines["route[2].name"]) == (10, 12)
    assert (lines["route[2].far.speed"], lines["vehicle.the truck"]) == (14, 15)
    assert line_of("list[2].inner", lines) == 5
    assert line_of("vehicle.the truck.bodies[1]", lines) == 15
    assert line_of("nowhere", lines) is None


@pytest.mark.parametrize(
    ("axle", "place", "words"),
    [
        ('axle_mass = "200 kg"', "axles[2]", "give its tyre_stiffness"),
        ('tyre_stiffness = "3 MN/m"', "axles[2]", "carries an axle_mass"),
        ('tyre_damping = "3 kN s/m"', "axles[2]", "carries an axle_mass"),
        ('body_mass = "200 kg"', "axles[2].body_mass", "unknown key"),
    ],
)
def test_axles_are_checked_where_they_stand(tmp_path, axle, place, words):
    (problem,) = problems(tmp_path, (LIBRARY, PLANAR.replace("AXLE", axle)))
    assert problem.place == f"vehicle.truck.{place}"
    assert words in problem.rule


def test_keys_of_nested_tables_are_listed(tmp_path):
    (problem,) = problems(tmp_path, (LIBRARY, PLANAR.replace("AXLE", 'quux = "200 kg"')))
    for key in ("body", "setback", "stiffness", "damping", "axle_mass", "tyre_stiffness"):
        assert key in problem.remedy
    (problem,) = problems(tmp_path, ("density = ", "quux = 1, density = "))
    assert problem.remedy == "known keys: elastic_modulus, poisson_ratio, density"


def test_a_vehicle_without_a_kind_is_told_the_kinds_of_vehicles(tmp_path):
    (problem,) = problems(tmp_path, (LIBRARY, ""))
    assert problem.value == "nothing"
    assert "planar" in problem.rule
    assert "city_bus_2_axle" in problem.rule
    assert "reference_unit" not in problem.rule


ROAD = '[[road]]\nclass = "B"\n'
WALKER = '\n[[walker]]\nname = "main"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'
DAY = '\n[[schedule]]\nname = "d"\nroute = "main"\nper_hour = 2.0\n'
STEP = 'dt = "5 ms"'


def named(key):
    """Return the good study with a vehicle of a name that needs quotes, and no such kind."""
    text = GOOD.replace("[vehicle.truck]", f"[vehicle.{key}]")
    text = text.replace('vehicle = "truck"', f"vehicle = {key}")
    return text.replace("container_truck_40ft", "tank")


@pytest.mark.parametrize(
    ("text", "place", "begins"),
    [
        (GOOD.replace(STEP, f'{STEP}\nentry = "static"'), "method[1].entry", "entry"),
        (GOOD.replace(STEP, f'{STEP}\nentry_length = "9 m"'), "method[1].entry_length", "entry_l"),
        (GOOD + '[roughness]\nn_min = "30 1/m"\nn_max = "40 1/m"\n', "method[1].dt", "dt"),
        (GOOD.replace('["12 m", "3 m"]]', '["0.01 m", "3 m"]]'), "route[1].path", "path"),
        (GOOD.replace(ROAD, ROAD + ROAD), "road[2]", "[[road]]"),
        (GOOD + WALKER, "walker[1].name", "name"),
        (GOOD.partition("[criteria]")[0] + DAY, "schedule[1]", "[[schedule]]"),
        (named('"a]b"'), "vehicle.a]b.kind", "kind"),
        (named('"tr\\u00fcck"'), "vehicle.trück.kind", "kind"),
    ],
)
def test_whatever_can_be_found_in_the_file_has_its_line(text, place, begins):
    """Also what is found only when sections are held against each other."""
    with pytest.raises(StudyError) as caught:
        study_from_text(text)
    found = {p.place: p.line for p in caught.value.problems}
    assert all(found.values())
    assert text.splitlines()[found[place] - 1].startswith(begins)
