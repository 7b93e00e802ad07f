"""A study file as a file: its bytes, what it must hold, keys that are unknown, tables and lists."""

import codecs

import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.study_file import load_study, study_from_text
from trundle.study_file.read import read_study, read_text

HEAD = GOOD.partition("[vehicle.truck]")[0]
TAIL = GOOD[GOOD.index("[[point]]") :]
WALKER = """
[[walker]]
name = "guard"
guide = "p354"
pace = "2 Hz"
at = ["3 m", "3 m"]
"""


def told(text):
    """Return the problems of a text, place by place."""
    with pytest.raises(StudyError) as caught:
        study_from_text(text)
    places = [p.place for p in caught.value.problems]
    assert len(set(places)) == len(places)
    return {p.place: p for p in caught.value.problems}


def without(heading, behind):
    """Return the good study without what stands between two of its lines."""
    assert heading in GOOD
    return GOOD[: GOOD.index(heading)] + GOOD[GOOD.index(behind) :]


def test_a_byte_order_mark_and_foreign_line_ends_change_nothing(tmp_path):
    """Notepad writes both; the numbers are those of the plain file."""
    (tmp_path / "a.toml").write_bytes(codecs.BOM_UTF8 + GOOD.replace("\n", "\r\n").encode())
    study = load_study(tmp_path / "a.toml")
    assert (study.title, study.seed, study.runs, study.duration) == ("Small", 1, 2, 4.0)


@pytest.mark.parametrize("encoding", ["utf-16", "latin-1"])
def test_text_of_another_encoding_is_refused_and_not_guessed(tmp_path, encoding):
    """An umlaut in Latin-1 is no UTF-8: read otherwise, a name would not be what was typed."""
    path = tmp_path / "a.toml"
    path.write_bytes(GOOD.replace("Small", "Gebäude").encode(encoding))
    with pytest.raises(StudyError) as caught:
        load_study(path)
    (problem,) = caught.value.problems
    assert "not UTF-8 text" in problem.value
    assert problem.remedy.startswith("save it as UTF-8")


def test_a_study_is_named_as_it_is_called_and_hashed_by_its_text(tmp_path):
    """SHA-256 of the bytes, its first 64 bits; another comment is another hash."""
    import hashlib

    (tmp_path / "a.toml").write_text(GOOD)
    study = load_study(tmp_path / "a.toml", source="dir/my study.toml")
    assert study.source == "dir/my study.toml"
    assert study.text == GOOD
    assert study.content_hash == hashlib.sha256(GOOD.encode()).hexdigest()[:16]
    assert study_from_text(GOOD + "# more\n").content_hash != study.content_hash


def test_the_error_counts_its_mistakes_and_names_the_file():
    """One mistake is one, two are two."""
    one = GOOD.replace('"15 km/h"', '"15"')
    for text, head in (
        (one, "my.toml: 1 mistake"),
        (one.replace("runs = 2", "runs = 0"), "my.toml: 2 mistakes"),
    ):
        with pytest.raises(StudyError) as caught:
            study_from_text(text, source="my.toml")
        assert str(caught.value).splitlines()[0] == head


@pytest.mark.parametrize(
    ("heading", "behind", "name", "remedy"),
    [
        ("[vehicle.truck]", "[[route]]", "vehicle", "add [vehicle.NAME]"),
        ("[[route]]", "[[road]]", "route", "add [[route]]"),
        ("[[point]]", "[[method]]", "point", "add [[point]]"),
    ],
)
def test_what_a_study_cannot_be_without_is_asked_for_as_it_is_written(
    heading, behind, name, remedy
):
    """A road nobody gives would be a smooth one, and pass: each part must stand there."""
    found = told(without(heading, behind))
    assert found[name].value == "nothing"
    assert found[name].remedy == remedy
    others = set(found) - {name}
    assert others <= {"route[1].vehicle"}  # of a vehicle that is not there


def test_a_method_is_asked_for():
    """Without one nothing would be computed; the criteria name one too."""
    found = told(without("[[method]]", "[criteria]"))
    assert found["method"].remedy == "add [[method]]"
    assert found["criteria.method"].value == "'coupled'"


@pytest.mark.parametrize("extra", ["vehicle", "route", "road"])
def test_who_begins_with_a_vehicle_needs_all_that_drives(extra):
    """Walkers alone need none of the three; with one of them the other two are missing."""
    parts = {
        "vehicle": '[vehicle.car]\nkind = "car_bmw_320i"\n',
        "route": GOOD[GOOD.index("[[route]]") : GOOD.index("[[road]]")],
        "road": '[[road]]\nclass = "B"\n',
    }
    assert list(study_from_text(HEAD + TAIL + WALKER).roads) == ["no road"]
    found = told(HEAD + TAIL + WALKER + parts[extra])
    assert set(parts) - {extra} <= set(found)


def test_a_walker_with_a_mistake_still_shakes_the_floor():
    """Its mistake is one; that there is no vehicle is none."""
    assert list(told(HEAD + TAIL + WALKER.replace('"2 Hz"', '"2 m"'))) == ["walker[1].pace"]


@pytest.mark.parametrize(
    ("text", "place", "rule"),
    [
        ('title = 3\n[floor]\nkind = "plan"\n', "title", "must be text, in quotes"),
        ("floor = 3\n", "floor", "must be a table"),
        ('vehicle = "truck"\n', "vehicle", "must hold one table a name"),
        ("vehicle = { truck = 3 }\n", "vehicle.truck", "must be a table"),
        ("route = 3\n", "route", "must be a list of tables"),
        ("route = [3]\n", "route[1]", "must be a table"),
        ("criteria = []\n", "criteria", "must be a table"),
    ],
)
def test_a_value_where_a_table_belongs_is_told_there(text, place, rule):
    """Each in a file of little else: the place names the key that was given."""
    assert told(text)[place].rule == rule


def test_unknown_keys_are_told_with_the_nearest_or_with_all_that_there_are():
    """One letter off is a slip; what is like nothing gets the list."""
    found = told("runz = 3\nquux = 1\n" + GOOD)
    assert found["runz"].remedy == "did you mean 'runs'?"
    assert found["quux"].remedy.startswith("known keys: title, seed, runs, duration, floor")
    for name in ("vehicle", "road", "feature", "traffic", "walker", "machine", "schedule"):
        assert f" {name}" in found["quux"].remedy


@pytest.mark.parametrize(
    ("old", "new", "place", "remedy"),
    [
        ("speed =", "sped =", "route[1].sped", "did you mean 'speed'?"),
        ("class =", "clas =", "road[1].clas", "did you mean 'class'?"),
        ("ratio =", "ration =", "method[1].damping.ration", "did you mean 'ratio'?"),
        ("beams_x = { width", "beams_x = { widht", "floor.beams_x.widht", "did you mean 'width'?"),
        ("curves =", "curvs =", "criteria.curvs", "did you mean 'curves'?"),
        ("at =", "ad =", "point[1].ad", "known keys: name, at, drawn, on, axes, isolator"),
    ],
)
def test_a_slip_in_a_key_is_told_by_the_keys_of_its_own_table(old, new, place, remedy):
    """A key is looked for among those that its table may have, and not elsewhere."""
    assert told(GOOD.replace(old, new, 1))[place].remedy == remedy


def test_values_are_shown_in_at_most_80_characters():
    """A long text is cut with three dots, so that a message stays a message."""
    found = told(GOOD.replace('"15 km/h"', '"' + "9" * 500 + ' kg"'))
    value = found["route[1].speed"].value
    assert value == "'" + "9" * 76 + "..."
    assert len(value) == 80


def test_all_that_is_wrong_with_every_section_is_told_at_once_in_the_order_of_the_file():
    """A mistake in each of ten tables: ten are told, no more, from the top to the bottom."""
    text = GOOD
    for old, new in (
        ("seed = 1", "seed = 1.5"),
        ('slab_thickness = "0.2 m"', 'slab_thickness = "0.2 kg"'),
        ('density = "2450 kg/m3"', 'density = "2450 kg/m2"'),
        ('"container_truck_40ft"', '"container_truck_40ft"\nlifts_off = "yes"'),
        ('speed = "15 km/h"', 'speed = "-15 km/h"'),
        ('class = "B"', 'class = "b"'),
        ('at = ["3 m", "3 m"]', 'at = ["3 m", "3 m", "0 m"]'),
        ('f_max = "30 Hz"', 'f_max = "30 rad/s"'),
        ('ratio = "3 %"', 'ratio = "103 %"'),
        ('curves = ["VC-A"]', 'curves = ["VC-A"]\nevents = 0.5'),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    with pytest.raises(StudyError) as caught:
        study_from_text(text)
    found = caught.value.problems
    assert [p.place for p in found] == [
        "seed", "floor.slab_thickness", "floor.material.density", "vehicle.truck.lifts_off",
        "route[1].speed", "road[1].class", "point[1].at", "method[1].f_max",
        "method[1].damping.ratio", "criteria.events",
    ]  # fmt: skip
    lines = [p.line for p in found]
    assert None not in lines
    assert lines == sorted(lines)
    rows = text.splitlines()
    assert all(p.place.rpartition(".")[2].partition("[")[0] in rows[p.line - 1] for p in found)


def test_a_reference_to_a_section_with_a_mistake_is_no_second_mistake():
    """Vehicle, route, point, method and road are named elsewhere; only their own slips are told."""
    text = GOOD.replace('"container_truck_40ft"', '"tank"').replace('"3 %"', '"3 m"')
    text += '[[traffic]]\nname = "two"\nroutes = ["main", "main"]\nheadway = "3 s"\n'
    assert list(told(text)) == ["vehicle.truck.kind", "method[1].damping.ratio"]


def test_a_table_within_another_is_the_same_as_one_of_its_own():
    """TOML's three ways to write a material give one study."""
    inline = 'material = { elastic_modulus = "30 GPa", density = "2450 kg/m3" }'
    assert inline in GOOD
    dotted = GOOD.replace(
        inline, 'material.elastic_modulus = "30 GPa"\nmaterial.density = "2450 kg/m3"'
    )
    tabled = GOOD.replace(inline, "").replace(
        "[vehicle.truck]",
        '[floor.material]\nelastic_modulus = "30 GPa"\ndensity = "2450 kg/m3"\n[vehicle.truck]',
    )
    hashes = {study_from_text(text).floor.content_hash for text in (GOOD, dotted, tabled)}
    assert len(hashes) == 1


def test_sections_keep_their_place_where_one_before_them_has_a_mistake():
    """The third road is road[3] to the reader of the file, though the second was not understood."""
    text = GOOD + '[[road]]\nclass = "Z"\n[[road]]\nclass = "C"\n'
    file, problems = read_text(text, "s")
    assert [p.place for p in problems] == ["road[2].class"]
    assert [(i, s.class_) for i, s in file.lists["road"]] == [(0, "B"), (2, "C")]
    assert file.has_bad("road")
    assert not file.has_bad("point")


def test_a_folder_is_told_what_to_name_instead(tmp_path):
    """The remedy names the folder that was given."""
    with pytest.raises(StudyError) as caught:
        read_study(tmp_path)
    (problem,) = caught.value.problems
    assert (problem.place, problem.value) == ("file", "a folder")
    assert problem.remedy == f"name the file in {tmp_path}"


def test_half_a_character_is_no_text():
    """A lone surrogate cannot be written as UTF-8, nor hashed: refused before anything is read."""
    with pytest.raises(ValueError, match="half a character"):
        study_from_text(GOOD.replace("Small", "Sm\ud800all"))
