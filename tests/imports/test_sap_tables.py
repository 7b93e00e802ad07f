"""Rows of SAP2000's text: keys, quotes, lines that go on, numbers, and ends that are missing."""

import pytest

from trundle.errors import InputError
from trundle.imports.sap_tables import read_tables

END = "\nEND TABLE DATA\n"


def tables(tmp_path, text):
    path = tmp_path / "m.s2k"
    path.write_text(text, encoding="utf-8")
    return read_tables(path)


def rows(tmp_path, *lines):
    return tables(tmp_path, "\n".join(['TABLE:  "T"', *lines]) + END)["T"].rows


def test_values_in_quotes_keep_blanks_equals_and_quotes(tmp_path):
    """A doubled quote is one, as the manual writes it; a key is told in any letters."""
    (row,) = rows(tmp_path, '   Name="Decke über EG, 1=A"   Note="6"" pipe"   t3=0.5')
    assert row.text("NAME") == "Decke über EG, 1=A"
    assert row.text("note") == '6" pipe'
    assert row.number("T3") == 0.5


def test_a_line_that_ends_in_a_mark_goes_on(tmp_path):
    """Three lines are one row, told by the first of them."""
    one, other = rows(tmp_path, "Joint=1 _", "   XorR=2 _", "   Y=3", "Joint=2")
    assert [one.number(key) for key in ("Joint", "XorR", "Y")] == [1.0, 2.0, 3.0]
    assert (one.place, other.place) == ("m.s2k, line 2", "m.s2k, line 5")


def test_a_table_that_stands_twice_goes_on(tmp_path):
    """Large models break tables: rows of both parts count."""
    text = 'File made by hand\nTABLE:  A\nK=1\n$ mark\nTABLE:  "B"\nK=2\n\nTABLE:  "a"\nK=3'
    found = tables(tmp_path, text + END + "after=the end")
    assert [row.number("K") for row in found["A"].rows] == [1.0, 3.0]
    assert list(found) == ["A", "B"]


def test_empty_values_are_missing_ones(tmp_path):
    """``Key=""`` says nothing: the default counts, and without one it is told."""
    (row,) = rows(tmp_path, 'Name=B1 Mass="" Angle=0')
    assert row.number("Mass", 4.0) == 4.0
    with pytest.raises(InputError, match="line 2: Mass is missing"):
        row.number("Mass")
    assert row.number("Angle", 30.0) == 0.0  # nought is a value


def test_a_value_that_is_missing_leaves_the_next_pair_alone(tmp_path):
    """A blank behind ``=`` may stand before a value, and never before a key: AutoMesh stays No."""
    (row,) = rows(tmp_path, "Frame=1 Notes= AutoMesh=No  Story = Roof  Last= ")
    assert row.cells == {
        "frame": "1", "notes": "", "automesh": "No", "story": "Roof", "last": "",
    }  # fmt: skip
    (row,) = rows(tmp_path, 'A =  B = 2 C=x=y D= "one, two"')
    assert row.cells == {"a": "", "b": "2", "c": "x=y", "d": "one, two"}


@pytest.mark.parametrize(
    ("cell", "ask", "said"),
    [
        ("K=abc", lambda row: row.number("K"), "K must be a number; got 'abc'"),
        ("K=1e999", lambda row: row.number("K"), "K must be a number"),
        ("K=nan", lambda row: row.number("K"), "K must be a number"),
        ("K=1.5", lambda row: row.whole("K"), "K must be a whole number; got 1.5"),
        ("K=Perhaps", lambda row: row.yes("K"), "K must be Yes or No; got 'Perhaps'"),
    ],
)
def test_cells_that_are_not_what_they_should_be_are_told(tmp_path, cell, ask, said):
    """With the line of their row, whatever was asked for."""
    (row,) = rows(tmp_path, cell)
    with pytest.raises(InputError, match=f"m.s2k, line 2: {said}"):
        ask(row)


def test_yes_and_no_in_any_letters(tmp_path):
    """YES, true, No and FALSE; what is missing is the default."""
    (row,) = rows(tmp_path, "A=YES B=true C=No D=FALSE")
    assert [row.yes(key) for key in "ABCDE"] == [True, True, False, False, False]
    assert row.yes("E", default=True)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('TABLE:  "T"\nK=1\n', "does not end with END TABLE DATA: it is cut short"),
        ("K=1" + END, "line 1: must begin a table; got 'K=1'"),
        ('TABLE:  "T"\nK=1 K=2' + END, "line 2: K is there twice"),
        ('TABLE:  "T"\nK=1 k=2' + END, "line 2: k is there twice"),
        ('TABLE:  "T"\nK=1 loose' + END, "line 2: must be Key=Value pairs; got 'loose'"),
        ('TABLE:  "T"\nK="open' + END, "line 2: must be Key=Value pairs"),
        ('TABLE:  "T"\nK=1 _\n', "line 2: goes on, and the file ends"),
        ("", "holds no table"),
    ],
)
def test_damaged_texts_are_refused_with_their_line(tmp_path, text, said):
    """A file that was cut, a row without its table, a key that stands twice."""
    with pytest.raises(InputError, match=said):
        tables(tmp_path, text)


def test_keys_that_nobody_asked_for_are_known(tmp_path):
    """Asked for in any row is asked for; the rest is told in the order of the file."""
    text = 'TABLE:  "T"\nA=1 B=2 C=3\nA=4 D=5' + END
    found = tables(tmp_path, text)["T"]
    found.rows[0].number("a")
    found.rows[1].number("D")
    assert found.unused == ("b", "c")
