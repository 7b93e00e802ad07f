"""The table in a text is found whole: no row of numbers is lost above it, in it or behind it."""

from pathlib import Path

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.records.cells import as_array, cells_of, is_comment, is_number
from trundle.records.lines import find_table, text_of
from trundle.records.table import read_table

PATH = Path("r.csv")


def table_of(text, rate=None):
    return read_table(text.encode(), PATH, rate=rate)


@pytest.mark.parametrize("mark", [";", "\t", ",", " "])
def test_the_delimiter_is_that_of_most_rows(mark):
    """Lines 1 to 3 are titles, 4 the heading, 5 to 8 the table, by whichever delimiter."""
    rows = [mark.join((f"{i / 10:.1f}", str(i), "3")) for i in range(4)]
    title = "Site: hall 3\nRemarks, many; and odd\n\n"
    found = find_table(title + mark.join(("t", "a", "b")) + "\n" + "\n".join(rows), PATH)
    assert (found.mark, found.width) == (mark, 3)
    assert found.heading == ("t", "a", "b")
    assert found.numbers.tolist() == [5, 6, 7, 8]
    assert found.lines == rows
    assert found.above == ("Site: hall 3", "Remarks, many; and odd")
    assert found.left_out == []


def test_words_behind_a_table_are_told_with_their_lines():
    """Two lines of words close the file; the blank one between them counts as a line of it."""
    found = find_table("a,b\n1,2\n3,4\nend\n\nof file\n", PATH)
    assert found.lines == ["1,2", "3,4"]
    assert found.left_out == [(4, "end"), (6, "of file")]


def test_a_line_of_units_is_no_heading_and_no_row():
    """Names stand above it, whatever their number; a unit alone does not name a column."""
    found = find_table("time;z;T\n(s);(mm/s2);(%)\n0;1;2\n1;2;3\n", PATH)
    assert found.heading == ("time", "z", "T")
    assert found.units == ("(s)", "(mm/s2)", "(%)")
    assert find_table("0;1\n1;2\n", PATH).heading == ()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "no two lines of numbers stand together"),
        ("just\nwords\n", "no two lines of numbers stand together"),
        ("z [mm/s]\n1\n", "no two lines of numbers stand together"),
        ("1,2,3\nt,z\n0,1\n1,2\n", "line 1 has 3 columns of numbers, and the table below it 2"),
        (
            "t [s],z [m/s]\n0.0,1\n0.1,2\n0.2\n",
            "line 4, its last, has 1 of 2 columns: the file is cut",
        ),
        ("t [s],z [m/s]\n0,1\noverload\n1,2\n2,3\n3,4\n", r"line 3, 'overload', is no row"),
        ("t [s],z [m/s]\n0,1\noverload,x\n1,2\n2,3\n3,4\n", r"line 3, 'overload,x', is no row"),
        ("z [m/s]\n1\n2\noverload\n1\n2\n3\n", r"line 4, 'overload', is no row .* line 2 above"),
        ("z [m/s]\n1.5\n2.5\n1_0\n1.5\n2.5\n3.5\n", r"line 4, '1_0', is no row of numbers"),
        ("z [m/s]\n1\n#N/A\n2\n1\n", r"line 3, '#N/A', is no row of numbers"),
        ("a [m/s];b [m/s]\n1;2\n#NV;2\n1;3\n2;3\n", r"line 3, '#NV;2', is no row of numbers"),
        ("t [ms],z [mm/s2]\n0,500\n4,507\n8\n", r"line 4, its last, has 1 of 2 columns"),
        ("time [s],z [mm/s2]\n0,002,1,25\n0,004,1,50\n", r"names 2 columns.* have 4.*delimiter"),
        ("# time [s],z [mm/s2]\n0,002,1,25\n0,004,1,50\n", r"names 2 columns, and .* have 4"),
        ("t [s];a [m/s];b [m/s]\n0;1\n1;2\n", r"line 1 names 3 columns, and .* below it have 2"),
        ("a [m/s],b [m/s]\n1.5,2\n\n1.5,3\n1.5,4\n", r"line 3 is empty, among samples without"),
        ("a [m/s]\tb [m/s]\n1\t2\n\t\n1\t3\n2\t4\n", r"line 3 is empty, among samples without"),
        (
            "Levels\n0,500\n4,507\n8,514\n",
            r"'0,500' may be one number with a decimal comma, or two",
        ),
        ("0,500\n4,507\n8\n", r"'0,500' may be one number with a decimal comma, or two"),
        ("t [s],z [m/s]\n0,1\n1,2\n1.5,1,2\n2,3\n", r"line 4 has 3 columns, the table has 2"),
        ("t [s],z [m/s]\n0,1\n1,2\n2,3,a,b\n", r"line 4 has 4 columns"),
    ],
)
def test_what_would_lose_samples_is_refused_with_its_line(text, told):
    """Counted by hand in the text; the first line of a file is line 1."""
    with pytest.raises(InputError, match=told) as refused:
        table_of(text)
    assert str(refused.value).startswith("r.csv: ")


def test_a_hole_in_a_column_stays_a_hole():
    """An empty cell is no zero and moves nothing: the third of four samples is not a number."""
    found = table_of("t [s],a [m/s],b [m/s]\n0,1,2\n0.1,1,2\n0.2,,2\n0.3,1,2\n")
    np.testing.assert_array_equal(found.samples, [[1, 1, np.nan, 1], [2, 2, 2, 2]])
    assert found.rate == pytest.approx(10.0)


def test_more_samples_said_than_there_are_is_a_file_cut_short():
    """Five are said and four are there; fewer said than there are is the logger's affair."""
    rows = "t [s],z [m/s]\n0,1\n0.1,1\n0.2,3\n0.3,1\n"
    with pytest.raises(InputError, match=r"says 5 samples above its table and holds 4: it is cut"):
        table_of("Samples: 5\n" + rows)
    assert table_of("Samples: 3\n" + rows).samples.shape == (1, 4)


@pytest.mark.parametrize(
    ("said", "ok"), [("10 Hz", True), ("10.4 Hz", True), ("9.4 Hz", False), ("100 Hz", False)]
)
def test_a_rate_above_the_table_may_be_nominal_and_no_more(said, ok):
    """Stamps every 0.1 s are 10 Hz: a rate said to be within 5 % of it stands, the stamps count."""
    rows = "".join(f"{i / 10:.1f},{i % 3}\n" for i in range(50))
    text = f"Sample rate: {said}\nt [s],z [m/s]\n{rows}"
    if ok:
        assert table_of(text).rate == pytest.approx(10.0)
        return
    with pytest.raises(InputError, match="above its table, and its time 10 Hz; one is wrong"):
        table_of(text)


def test_a_first_column_that_counts_is_no_channel_where_the_rate_is_said():
    """0, 1, 2 beside a rate of 100 Hz numbers the samples; at 1 Hz it could be the seconds."""
    rows = "".join(f"{i},{i % 3}\n" for i in range(20))
    found = table_of("a,b\n" + rows, rate=100.0)
    assert found.names == ("b",)
    assert found.notes == ("column 'a' counts the samples, and is passed over",)
    with pytest.raises(InputError, match=r"rises evenly as time does.*or 'count'"):
        table_of("a,b\n" + rows)


def test_units_above_the_table_go_to_the_channels_in_their_order():
    """Two units for two channels behind a column of time, or three that count it as well."""
    rows = "t,a,b\n0,1,2\n0.1,2,3\n0.2,1,2\n"
    for said in ("Units: mg, mm/s2", "Units: s, mg, mm/s2"):
        assert table_of(f"{said}\n{rows}").units == ("mg", "mm/s2")
    assert table_of(f"Units: mg\n{rows}").units == ("mg", "mg")
    # four units fit neither: nothing is guessed
    assert table_of(f"Units: s, mg, mg, mg\n{rows}").units == ("", "")


def test_cells_and_numbers_as_spreadsheets_write_them():
    """Quoted delimiters stay in their cell; a name and its unit are one word between blanks."""
    assert cells_of('"a, b", 2 ,"say ""x"""', ",") == ["a, b", "2 ", 'say "x"']
    assert cells_of("time [s]  acc z [mm / s2] 3", " ") == ["time [s]", "acc", "z [mm / s2]", "3"]
    assert [is_number(c) for c in ("1,5", " -2e-3 ", "nan", "1.2.3", "", "x", "1_0")] == [
        True, True, True, False, False, False, False,
    ]  # fmt: skip
    np.testing.assert_array_equal(
        as_array([["1,5", "x"], ["1_0", "-2"]], comma=True), [[1.5, np.nan], [np.nan, -2.0]]
    )


def test_text_is_told_from_bytes_that_are_none():
    """The same umlaut in three encodings; a zero byte stands in no text but UTF-16."""
    for encoding in ("utf-8", "utf-8-sig", "cp1252", "utf-16"):
        assert text_of("größe".encode(encoding), PATH) == "größe"
    for data in (b"a\0b", "größe".encode("utf-16")[:-1]):
        with pytest.raises(InputError, match=r"r.csv: is not text"):
            text_of(data, PATH)


@pytest.mark.parametrize("hole", ["800,", "800, ", ",507"])
@pytest.mark.parametrize("at", [0, 1, 200, 999])
def test_whole_numbers_with_a_hole_are_not_one_column_of_decimal_commas(at, hole):
    """Milliseconds and mm/s2 between commas: 4,507 is 4 ms and 507, whatever one row lacks."""
    rows = [f"{4 * i},{(i * 7) % 50 + 500}" for i in range(1000)]
    rows[at] = hole.replace("800", str(4 * at))
    text = "t [ms],z [mm/s2]\n" + "\n".join(rows)
    if not hole.startswith(","):
        found = table_of(text)
        assert found.rate == pytest.approx(250.0)
        assert np.flatnonzero(np.isnan(found.samples[0])).tolist() == [at]
        return
    with pytest.raises(InputError, match=f"time stamp {at + 1} is not a number"):
        table_of(text)


@pytest.mark.parametrize("heading", ["z [mm/s2]", "Weg, mm/s2", "z", ""])
def test_one_column_of_decimal_commas_is_one(heading):
    """Two whole numbers are not written 0,05 or -0,25: those say what a heading leaves open."""
    values = [0.05, -0.25, 1.5, 10.25, 3.75]
    rows = "\n".join(f"{value:.2f}".replace(".", ",") for value in values)
    np.testing.assert_array_equal(table_of(f"{heading}\n{rows}").samples, [values])
    with_whole = f"{heading}\n{rows}\n8"
    np.testing.assert_array_equal(table_of(with_whole).samples, [[*values, 8.0]])


@pytest.mark.parametrize("mark", [";", ",", "\t"])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_a_hole_stays_where_it_is_in_any_column(mark, column):
    """The third of five rows lacks one cell: no sample moves up, whatever begins a comment."""
    rows = [["1.5", "2.5", "3.5"] for _ in range(5)]
    rows[2][column] = ""
    text = mark.join(("a [m/s]", "b [m/s]", "c [m/s]")) + "\n" + "\n".join(map(mark.join, rows))
    expected = np.repeat([[1.5], [2.5], [3.5]], 5, axis=1)
    expected[column, 2] = np.nan
    np.testing.assert_array_equal(table_of(text).samples, expected)


def test_comments_and_rows_between_semicolons_are_told_apart():
    """A number behind the semicolon, or nothing at all, is a row; words alone are a comment."""
    for row in (";2.5", ";", "; ;", "#N/A;2", "#DIV/0!", "#WERT!"):
        assert not is_comment(row, ";"), row
    for line in (
        "; restarted",
        ";Title; logger",
        "# 1;2",
        "#",
        "%",
        "// x",
        "#Notes",
        "#NAME",
        "#Stop! 5",
    ):
        assert is_comment(line, ";"), line
    assert is_comment(";2.5", ",")


@pytest.mark.parametrize("end", ["\n\n", "\r\r\n"])
def test_an_empty_line_behind_every_row_is_how_the_file_ends_lines(end):
    """None is a sample then; beside a time, which shows what is missing, any empty line may be."""
    assert table_of(end.join(["z [m/s]", "1", "2", "3", "4"])).samples.tolist() == [[1, 2, 3, 4]]
    spaced = table_of("t [s],z [m/s]\n0.0,1\n0.1,2\n\n0.2,3\n0.3,4\n")
    assert spaced.rate == pytest.approx(10.0)


def test_names_that_rows_leave_out_are_comments_where_they_have_no_unit():
    """So has LabVIEW's last column; a title that speaks of units has no other number of names."""
    for heading in (
        "t [s],z [m/s],Comment",
        "All in mm/s2\nt [s],z [m/s]",
        "# g, mm/s2\nt [s],z [m/s]",
    ):
        assert table_of(heading + "\n0.0,1.5\n0.1,2.5\n0.2,2.5").samples.shape == (1, 3)


@pytest.mark.parametrize("said", ["12,800 Hz", "1,000 Hz", "25.600 Hz", "12 800 Hz", "51'200 Hz"])
def test_a_rate_with_thousands_is_asked_back_where_no_time_says_it(said):
    """12,800 Hz is 12.8 Hz or 12800 Hz; the user's word or a column of time decides."""
    with pytest.raises(InputError, match=r"Sampling rate: .*thousands; say it by --rate"):
        table_of(f"Sampling rate: {said}\nz [m/s]\n1\n2\n1\n")
    assert table_of(f"Sampling rate: {said}\nz [m/s]\n1\n2\n1\n", rate=12800.0).rate is None
    rows = "".join(f"{i / 12800:.7f},{i % 3}\n" for i in range(2000))
    found = table_of(f"Sampling rate: {said}\nt [s],z [m/s]\n{rows}")
    assert found.rate == pytest.approx(12800.0, rel=1e-4)
