"""Cards of bulk data field by field: what a line holds, where cards end, what files include."""

import pytest

from trundle.errors import InputError
from trundle.imports import read_model
from trundle.imports.nastran_cards import Card, cards_of, case_control, real, whole


def cards(tmp_path, text, name="deck.bdf"):
    path = tmp_path / name
    path.write_text(text)
    return list(cards_of(path))


def in_fields(*fields, width=8):
    """Return a line of fixed fields, as wide as they are said to be behind the first."""
    return fields[0].ljust(8) + "".join(field.ljust(width) for field in fields[1:])


def test_the_tenth_field_names_the_next_line_and_is_no_value(tmp_path):
    """Columns 73 to 80 hold a mark: the ninth value of a card stands on its second line."""
    text = "\n".join(
        [
            in_fields("CORD2R", "7", "0", "1.", "2.", "3.", "4.", "5.", "6.", "+C1"),
            in_fields("+C1", "7.", "8.", "9."),
        ]
    )
    (card,) = cards(tmp_path, text)
    assert card.name == "CORD2R"
    # two rows of eight fields, of which the second holds three
    assert card.fields[:8] == ("7", "0", "1.", "2.", "3.", "4.", "5.", "6.")
    assert [real(card.get(i)) for i in range(4, 13)] == [float(k) for k in range(1, 10)]


def test_a_line_of_large_fields_has_four_of_sixteen_columns(tmp_path):
    """A GRID by hand: its third place stands on the line that a star continues."""
    text = in_fields("GRID*", "12", "", "1.5", "-2.25", width=16) + "\n" + in_fields(
        "*", "3.125", "", width=16
    )  # fmt: skip
    (card,) = cards(tmp_path, text)
    assert (card.name, card.get(2)) == ("GRID", "12")
    assert [real(card.get(i)) for i in (4, 5, 6)] == [1.5, -2.25, 3.125]


def test_tabs_go_to_the_next_eighth_column(tmp_path):
    """A typist's tabs stand for blanks up to the next field."""
    (card,) = cards(tmp_path, "GRID\t3\t\t1.\t2.\t3.\n")
    assert [card.get(i) for i in range(2, 7)] == ["3", "", "1.", "2.", "3."]


def test_comments_blank_lines_and_what_stands_behind_the_end_are_no_cards(tmp_path):
    """A dollar ends a line wherever it stands, and ENDDATA the deck."""
    text = (
        "ID a model, with commas\nCEND\nBEGIN BULK\n$ all of it\n\nGRID,1,,1.,2.,3. $ a corner\n"
        "ENDDATA\nGRID,2\n"
    )
    (card,) = cards(tmp_path, text)
    assert card.place == "deck.bdf, line 6"
    assert [card.get(i) for i in range(2, 7)] == ["1", "", "1.", "2.", "3."]


def test_a_card_of_commas_goes_on_in_its_tenth_field(tmp_path):
    """Nine fields behind commas, then those of the next line: the tenth value of a PBAR is C1."""
    text = "PBAR,1,2,.01,2.-5,8.-6,1.-5,3.,,+\n+,.1,.2,,,,,,,+\n+,.8,.7\nGRID,5\n"
    bar, grid = cards(tmp_path, text)
    assert [bar.get(i) for i in (8, 10, 11, 18, 19)] == ["3.", ".1", ".2", ".8", ".7"]
    assert (grid.name, grid.get(2)) == ("GRID", "5")


@pytest.mark.parametrize(
    ("line", "beyond"),
    [
        ("SPC1,1,123456,1,2,3,4,5,6,7,8", "'7' behind"),
        ("SPC1,1,123456,1,2,3,4,5,6,7", "'7' behind"),
        ("SPC1,1,123456,1,2,3,4,5,6,+,7,8", "'\\+' behind"),
        ("GRID*,2,,0.,0.,1.", "'1.' behind"),
    ],
)
def test_what_stands_behind_the_last_field_of_a_line_is_told(tmp_path, line, beyond):
    """A line has ten fields, and the tenth names the next line: grids 7 and 8 would stay free."""
    with pytest.raises(InputError, match=f"deck.bdf, line 2: a line holds . fields .*{beyond}"):
        cards(tmp_path, f"GRID,1\n{line}\n")


def test_commas_at_the_end_of_a_line_are_no_fields(tmp_path):
    """Programs fill lines with them; nothing is lost with what is blank."""
    (card,) = cards(tmp_path, "GRID,1,,1.,2.,3.,,,,,,,\n")
    assert card.get(6) == "3."


def test_large_fields_between_commas_are_four_a_line(tmp_path):
    """A star at the name: four values, a mark, and the rest on the line that a star continues."""
    first, second = cards(tmp_path, "GRID*,2,,0.,-1.5,*\n*,3.\nGRID*,3,,1.,2.,*G3\n*G3,4.,7\n")
    assert (first.name, [first.get(i) for i in range(2, 8)]) == (
        "GRID", ["2", "", "0.", "-1.5", "3.", ""],
    )  # fmt: skip
    assert [second.get(i) for i in range(2, 8)] == ["3", "", "1.", "2.", "4.", "7"]


def test_a_line_that_continues_nothing_is_told_with_its_place(tmp_path):
    """A deck whose first line was lost begins with a continuation."""
    with pytest.raises(InputError, match=r"deck\.bdf, line 1: a line that continues no card: '\+"):
        cards(tmp_path, "+,1.,2.\n")


def test_what_nobody_asked_for_is_known_by_its_number():
    """Fields count from 2: of 1, blank, 3 and 4 the last is field 5, and a blank one is none."""
    card = Card(name="GRID", fields=("1", "", "3", "4"), place="here")
    assert card.unread == (2, 4, 5)
    assert (card.get(2), card.get(4), card.get(9)) == ("1", "3", "")
    assert card.unread == (5,)


def test_included_cards_stand_where_they_are_included(tmp_path):
    """The order of a deck, with the place in the file where each card really stands."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "middle.inc").write_text("$ in the middle\nGRID,2\nINCLUDE 'last.inc'\n")
    (tmp_path / "parts" / "last.inc").write_text("GRID,3\n")
    files = {}
    path = tmp_path / "deck.bdf"
    path.write_text("BEGIN BULK\nGRID,1\nINCLUDE 'parts/middle.inc'\nGRID,4\n")
    found = [(card.get(2), card.place) for card in cards_of(path, files)]
    assert found == [
        ("1", "deck.bdf, line 2"),
        ("2", "middle.inc, line 2"),
        ("3", "last.inc, line 1"),
        ("4", "deck.bdf, line 4"),
    ]
    assert [one.name for one in files] == ["deck.bdf", "middle.inc", "last.inc"]


def test_files_that_include_each_other_and_files_elsewhere_are_refused(tmp_path):
    """A ring of two, and a path that leads out of the model's folder."""
    (tmp_path / "ring.inc").write_text("INCLUDE 'deck.bdf'\n")
    with pytest.raises(InputError, match="files include each other"):
        cards(tmp_path, "INCLUDE 'ring.inc'\n")
    with pytest.raises(InputError, match=r"line 1: '\.\./hosts' is not beside the model"):
        cards(tmp_path, "INCLUDE '../hosts'\n")


@pytest.mark.parametrize("text", ["1.5", "1+2", "", "12345678901", "--3", "ten"])
def test_what_is_no_whole_number_is_refused(text):
    """Ten digits or more, or anything but digits, is no number of a grid."""
    with pytest.raises(InputError, match="must be a whole number"):
        whole(text)


def test_numbers_beyond_all_bounds_are_refused():
    """1e999 would be infinity; the least exponents are zero, which is a number."""
    with pytest.raises(InputError, match="too large a number"):
        real("1.+999")
    assert real("1.-999") == 0.0
    assert (real("", 4.0), whole("", 4), whole("-7")) == (4.0, 4, -7)


def test_case_control_ends_where_bulk_begins(tmp_path):
    """An SPC card of the bulk is no request, nor is one that is commented out."""
    path = tmp_path / "deck.bdf"
    path.write_text("SOL 103\n$ SPC = 9\nspc = 12\nBEGIN BULK\nSPC = 4\n")
    assert case_control(path) == {"SPC": 12}
    path.write_text("SPC = 1\nSUBCASE 2\nSPC = 1\n")
    assert case_control(path) == {"SPC": 1}


LINE = "\n".join(
    ["BEGIN BULK", "MAT1,1,2.+11,,.3,7800.", "PBAR,1,1,.01,2.-5,8.-6,1.-5"]
    + [f"GRID,{i},,{i}.,0.,0." for i in range(1, 9)]
    + [f"CBAR,{i},1,{i},{i + 1},0.,0.,1." for i in range(1, 8)]
)


def test_a_list_that_goes_on_holds_every_grid_of_it(tmp_path):
    """SPC1 over two lines: all but grid 3, which neither names, are held along x and z alone."""
    path = tmp_path / "line.bdf"
    path.write_text(f"{LINE}\nSPC1,1,13,1,2,4,5,6,7\n+,8\n")
    floor = read_model(path).structure
    held = [True, True, False, True, True, True, True, True]
    assert floor.fixed[:, 0].tolist() == held
    assert floor.fixed[:, 2].tolist() == held
    assert not floor.fixed[:, [1, 3, 4, 5]].any()


def test_a_support_of_a_grid_that_is_not_there_is_told(tmp_path):
    """A single grid must exist; of a range those count that do."""
    path = tmp_path / "line.bdf"
    path.write_text(f"{LINE}\nSPC1,1,123456,1,99\n")
    assert "a support names grid 99, which is not there" in str(read_model(path).problems[0])
    path.write_text(f"{LINE}\nSPC1,1,123456,6,THRU,99\n")
    floor = read_model(path).structure
    assert floor.fixed.all(axis=1).tolist() == [False] * 5 + [True] * 3


def test_numbers_that_stand_twice_and_numbers_that_name_nothing_are_told(tmp_path):
    """Of two grids or materials of one number nobody knows which is meant."""
    for more, said in (
        ("GRID,8,,9.,0.,0.", "grid 8 is there twice"),
        ("MAT1,1,3.+10,,.2", "material 1 is there twice"),
        ("CBAR,7,1,1,2,0.,0.,1.", "element 7 is there twice"),
        ("CBAR,20,1,1,77,0.,0.,1.", "names grid 77, which is not there"),
        ("CBAR,20,5,1,2,0.,0.,1.", "names property 5, which is not there"),
        ("CBAR,20,1,3,3,0.,0.,1.", "both ends are at one place"),
        ("CBAR,20,1,1,2,1.,0.,0.", "the orientation lies along the bar"),
        ("PBAR,2,9,.01,2.-5,8.-6,1.-5\nCBAR,20,2,1,2,0.,0.,1.", "names material 9"),
    ):
        path = tmp_path / "line.bdf"
        path.write_text(f"{LINE}\nSPC1,1,123456,1\n{more}\n")
        read = read_model(path)
        assert read.structure is None
        assert said in str(read.problems[0]), more
