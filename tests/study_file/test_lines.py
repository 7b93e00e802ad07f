"""Lines of places in a study file, found without a TOML reader: headings, keys, odd names."""

import tomllib

import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.study_file.lines import line_of, lines_of, parse


def test_every_key_of_a_study_is_found_on_the_line_that_holds_it():
    """The TOML reader gives the keys, and the text the line: each key's line begins with it."""
    rows, lines = GOOD.splitlines(), lines_of(GOOD)
    data = tomllib.loads(GOOD)
    places = [key for key, value in data.items() if not isinstance(value, dict | list)]
    places += [f"floor.{key}" for key in data["floor"]]
    places += ["vehicle.truck.kind", *(f"criteria.{key}" for key in data["criteria"])]
    for kind in ("route", "road", "point", "method"):
        places += [f"{kind}[1].{key}" for key in data[kind][0]]
    assert len(places) == 4 + 10 + 1 + 2 + 4 + 1 + 2 + 5
    for place in places:
        assert rows[lines[place] - 1].startswith(place.rpartition(".")[2] + " ="), place


def test_lines_are_counted_alike_whatever_ends_them():
    """CR LF of another system ends one line, not two."""
    assert lines_of(GOOD.replace("\n", "\r\n")) == lines_of(GOOD)


def test_comments_before_a_table_are_no_tables():
    """A heading or a key behind # is not there; those behind count from the top."""
    lines = lines_of("# [floor]\n#runs = 2\n\n  [floor] # the floor\n\tmesh_size = '1 m' # = 2\n")
    assert lines == {"floor": 4, "floor.mesh_size": 5}


def test_headings_of_lists_are_counted_and_tables_below_them_belong_to_the_last():
    """As TOML has it: [a.b] below a second [[a]] is of the second."""
    text = "[[a]]\n[a.b]\nx = 1\n[[a]]\n[a.b]\nx = 1\n[[a.c]]\ny = 1\n[[a.c]]\ny = 2\n"
    data = tomllib.loads(text)
    assert [one["y"] for one in data["a"][1]["c"]] == [1, 2]
    lines = lines_of(text)
    assert (lines["a[1].b.x"], lines["a[2].b.x"]) == (3, 6)
    assert (lines["a[2].c[1].y"], lines["a[2].c[2].y"]) == (8, 10)


def test_dotted_and_quoted_keys_are_found_by_their_names():
    """material.density is a key of a table within; quotes are no part of a name."""
    text = (
        "[floor]\nmaterial.density = '1 kg/m3'\nmaterial . \"elastic modulus\" = 1\n"
        "[building.grid.x]\n\"A'\" = '0 m'\n1 = '6 m'\n"
    )
    lines = lines_of(text)
    assert lines["floor.material.density"] == 2
    assert lines["floor.material.elastic modulus"] == 3
    assert lines["building.grid.x.1"] == 6


@pytest.mark.parametrize(
    "value",
    [
        '"a # b ] ["',
        "'a \" b ['",
        '"a \\" ["',
        "'''[\n[x]\nno = 1'''",
        '"""a \\" "" [\nno = 1 """',
        '[\n"]", # ]\n["a",\n"b"],\n]',
        "{ a = [1, 2], b = '}' }",
        '[["0 m", "]"], ["[", "1 m"]]',
    ],
)
def test_what_stands_in_texts_and_lists_opens_and_closes_nothing(value):
    """The key behind an odd value is on the next line, and is the only one beside it."""
    text = f"first = {value}\nlast = 2\n"
    assert tomllib.loads(text)["last"] == 2
    assert lines_of(text) == {"first": 1, "last": text.count("\n")}


def test_a_text_ends_with_its_last_quotes():
    """Four quotes end a text that ends in one; an escaped one ends none, on its first row or later.

    What stands behind the end on its row is of the study again.
    """
    texts = (
        '"""a \\""" [ no = 1 """', '"""a \n \\""" [\nno = 1 """', '["""a"""", "]", "["]',
        '["""\na"""]', "['\'\'\na'\'\', [\n'\'\'b'\'\']]", '"""a \\\n[ """',
    )  # fmt: skip
    for value in texts:
        text = f"first = {value}\nlast = 2\n"
        assert tomllib.loads(text)["last"] == 2
        assert lines_of(text) == {"first": 1, "last": text.count("\n")}, value


@pytest.mark.parametrize("sign", ["\u2028", "\u2029", "\x85"])
def test_lines_are_those_that_editors_count(sign):
    """Only LF and CR LF end a line of TOML; str.splitlines ends them at these signs too."""
    text = f"a = 1  # one{sign}two\n[b]\nc = '{sign}'\nd = 1\n"
    assert tomllib.loads(text)["b"]["d"] == 1
    assert lines_of(text) == {"a": 1, "b": 2, "b.c": 3, "b.d": 4}
    with pytest.raises(StudyError) as caught:
        parse(text + "e = fast\n", "s")
    assert [(p.line, p.value) for p in caught.value.problems] == [(5, "'e = fast'")]


@pytest.mark.parametrize(
    ("heading", "name"),
    [
        ('"a]b"', "a]b"), ("'a[b'", "a[b"), ('"tr\\u00fcck"', "trück"), ('"a \\" b"', 'a " b'),
        ("'\"'", '"'), ('"a.b"', "a.b"), ('"a\\tb"', r"'a\tb'"),
    ],
)  # fmt: skip
def test_a_key_in_quotes_is_found_whatever_stands_in_them(heading, name):
    """Brackets, quotes and escapes are of the name; what does not show is told as it is escaped."""
    text = f"[vehicle.{heading}]\nkind = 1\n[other]\n{heading} = 2\n"
    assert len(tomllib.loads(text)) == 2
    assert lines_of(text) == {
        f"vehicle.{name}": 1, f"vehicle.{name}.kind": 2, "other": 3, f"other.{name}": 4,
    }  # fmt: skip


def test_a_place_within_a_list_has_the_line_of_the_key_that_holds_it():
    """What no line begins with stands where the nearest key around it does."""
    lines = {"route[1]": 4, "route[1].path": 6, "route[2]": 9}
    assert line_of("route[1].path[2][1]", lines) == 6
    assert line_of("route[1].speed", lines) == 4
    assert line_of("route[2].path", lines) == 9
    assert line_of("route[3].path", lines) is None
    assert line_of("", lines) is None


def test_toml_is_read_as_the_standard_library_does():
    """Another reader: dates, dotted keys, texts of several lines."""
    text = 'a.b = 1\nc = """x\ny"""\n[[d]]\ne = [1, {f = true}]\n'
    assert parse(text, "s") == tomllib.loads(text)
