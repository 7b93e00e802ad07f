"""Tables as spreadsheets write them: lines in messages, marks, commas, units, empty cells."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.number_tables import read_table


def table(tmp_path, text, name="t.csv"):
    path = tmp_path / name
    path.write_bytes(text.encode("utf-8"))
    return read_table(path)


@pytest.mark.parametrize(
    "text",
    [
        "node,x,y\nA,1.5,-2\nB,0,3e-1\n",
        "node;x;y\nA;1,5;-2\nB;0;0,3\n",
        "node\tx\ty\nA\t1.5\t-2\nB\t0\t0.3\n",
        "node  x   y\nA  1.5  -2\nB 0    0.3\n",
        '\ufeff"Node","X","Y"\r\n"A","1.5","-2"\r\n"B","0","0.3"\r\n',
        "TABLE:  Joints\nnode,x,y\nText,m,m\nA,1.5,-2\nB,0,.3\n",
        "# a survey\n! by hand\nnode,x,y\n# first\nA,1.5,-2\n,,\nB,0,0.3\n\n",
        "Node [-], X [m], Y (m)\nA, 1.5, -2\nB, 0, 0.3\n",
    ],
)
def test_the_same_two_nodes_in_every_dialect(tmp_path, text):
    """A at (1.5, -2) and B at (0, 0.3), written by hand in eight ways."""
    found = table(tmp_path, text)
    assert found.labels(("node",)).tolist() == ["A", "B"]
    np.testing.assert_allclose(found.need(("x",)), [1.5, 0.0])
    np.testing.assert_allclose(found.need(("y",)), [-2.0, 0.3])
    assert found.unused == ()


def test_lines_in_messages_are_those_of_the_file(tmp_path):
    """Comments, blank lines and a line of units are counted, as editors count them."""
    text = "TABLE:  Joints\nnode,x\ntext,m\n# one\nA,1\n\nB,two\n"
    with pytest.raises(InputError, match=r"t\.csv, line 7: x must be a number; got 'two'"):
        table(tmp_path, text).need(("x",))
    with pytest.raises(InputError, match=r"t\.csv, line 4: has 3 columns, and the heading 2"):
        table(tmp_path, "TABLE:  Joints\nnode,x\nA,1\nC,3,4\nD,5\n")


def test_an_empty_cell_is_not_a_number_and_not_nought(tmp_path):
    """Where a column may have gaps they are NaN; where it must be whole they are told."""
    found = table(tmp_path, "node,rx\nA,1\nB,\nC,0\n")
    column = found.find(("rx",))
    assert np.isnan(column).tolist() == [False, True, False]
    with pytest.raises(InputError, match="line 3: rx is empty"):
        found.need(("rx",))
    assert found.texts(("rx",)).tolist() == ["1", "", "0"]
    assert found.find(("rz",)) is None


@pytest.mark.parametrize("cell", ["NA", "nan", "inf", "-", "NULL", "1,5"])
def test_words_for_nothing_are_not_taken_for_empty(tmp_path, cell):
    """A spreadsheet's word for a missing number is told, and never read as one that is missing."""
    with pytest.raises(InputError, match="line 3: uz must be a number"):
        table(tmp_path, f"node;uz\nA;2.0\nB;{cell}\n").find(("uz",))


def test_units_of_headings_and_of_a_line_below_them(tmp_path):
    """Both say it; a column without one says nothing."""
    found = table(tmp_path, "node, X [mm], f (Hz), m\nA, 1, 2, 3\n")
    assert [found.unit_of((word,)) for word in ("x", "f", "m", "q")] == ["mm", "hz", "", ""]
    found = table(tmp_path, "node,X,f\nText,in,Cyc/sec\nA,1,2\n")
    assert [found.unit_of((word,)) for word in ("x", "f")] == ["in", "cyc/sec"]
    assert len(found) == 1


@pytest.mark.parametrize(
    ("first", "units"),
    [
        ("Text,in,Cyc/sec,KN-s2/m", {"x": "in", "f": "cyc/sec", "m": "kn-s2/m"}),
        ("-,[mm],1/s,kg", {"x": "mm", "f": "1/s", "m": "kg"}),
        (",m,Hz,", {"x": "m", "f": "hz"}),
    ],
)
def test_a_line_of_units_holds_nothing_else(tmp_path, first, units):
    """As SAP2000 writes them, in brackets, or blank where there is none."""
    found = table(tmp_path, f"node,x,f,m\n{first}\nA,1,2,3\n")
    assert len(found) == 1
    assert {word: found.unit_of((word,)) for word in units} == units


@pytest.mark.parametrize("first", ["A,B,C,D", "N0,N1,N2,N3", "m,N,s,t", "in,m,kg,Text"])
def test_a_row_of_names_is_no_line_of_units(tmp_path, first):
    """A face between nodes that are called by words is one, whatever the words: below it are more.

    Taken for units, the first face of a floor would be lost without a word.
    """
    found = table(tmp_path, f"node 1,node 2,node 3,node 4\n{first}\nB,E,F,C\n")
    assert found.labels(("node_1",)).tolist() == [first.split(",")[0], "B"]
    assert found.units == {}


def test_a_shorter_row_of_names_is_below_its_heading(tmp_path):
    """A triangle first, among quadrilaterals: the heading of four columns is no title."""
    found = table(tmp_path, "node 1,node 2,node 3,node 4\nA,B,C\nB,E,F,C\n")
    assert found.texts(("node_4",)).tolist() == ["", "C"]


def test_words_that_are_no_units_are_told_where_numbers_belong(tmp_path):
    """A line of units that nobody knows is no line of nothing: its first word is shown."""
    with pytest.raises(InputError, match="line 2: x must be a number; got 'furlong'"):
        table(tmp_path, "node,x\nText,furlong\nA,1\n").need(("x",))


@pytest.mark.parametrize(
    "title",
    ["Modal survey", "Survey of 2024-05-01, by hand", "Modal shapes of the floor", "Hall, west"],
)
@pytest.mark.parametrize("rows", ["node,x,y\nA,1,2\n", "node;x;y\nA;1;2\n", "node\tx\ty\nA\t1\t2"])
def test_titles_of_any_words_are_passed_over(tmp_path, title, rows):
    """A title has other columns than the heading below it."""
    found = table(tmp_path, f"{title}\n\n{rows}")
    assert found.headings == ("node", "x", "y")
    assert found.need(("y",)).tolist() == [2.0]


def test_a_longer_row_is_told_by_its_own_line(tmp_path):
    """Comments and blank lines above it are lines of the file: the row of three is on line 6."""
    with pytest.raises(InputError, match=r"t\.csv, line 6: has 3 columns, and the heading 2"):
        table(tmp_path, "node,x\nA,1\n# a comment\n\nB,2\nC,3,4\n")


def test_names_of_nodes_keep_their_noughts(tmp_path):
    """Node 007 and node 7 are two; neither is made a number."""
    found = table(tmp_path, "node,x\n007,1\n7,2\n7.0,3\n")
    assert found.labels(("node",)).tolist() == ["007", "7", "7.0"]


def test_what_nobody_asked_for_is_told_by_its_name(tmp_path):
    """Columns that were never looked at could hold what matters."""
    found = table(tmp_path, "node,x,Höhe <z>,temperature\nA,1,2,3\n")
    found.need(("x",))
    assert found.unused == ("not used of t.csv: node, höhe_<z>, temperature",)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "holds no table"),
        ("1,2\n3,4\n", "holds no table"),
        ("node,x\n", "has a heading, and no rows"),
        ("node,x,X [m]\nA,1,2\n", "line 1: two columns have one heading"),
        ("node,x\nA,1\n\0\n", "is binary"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, text, said):
    """Numbers without a heading could be in any order."""
    with pytest.raises(InputError, match=said):
        table(tmp_path, text)


def test_whole_numbers_are_whole(tmp_path):
    """Mode 3.0 is mode 3, and 3.5 is none."""
    found = table(tmp_path, "mode,f\n3.0,1\n4,2\n")
    assert found.whole(("mode",)).tolist() == [3, 4]
    with pytest.raises(InputError, match=r"line 3: mode must be a whole number; got 3\.5"):
        table(tmp_path, "mode,f\n1,2\n3.5,1\n").whole(("mode",))
    with pytest.raises(InputError, match="no column 'mode'; there are: step, f"):
        table(tmp_path, "step,f\n1,2\n").whole(("mode",))
