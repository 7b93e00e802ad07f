"""Files that a command writes are whole or not there at all; where none can stand is told before."""

import pytest

from trundle.cli.aside import check_file, written_aside
from trundle.errors import InputError


def test_a_file_takes_its_place_only_when_it_is_whole(tmp_path):
    """While it is written the earlier one stands; then it is the new one, and nothing is beside it."""
    file = tmp_path / "größe.csv"
    file.write_text("earlier")
    with written_aside("--out", file) as aside:
        aside.write_text("new")
        assert aside.suffix == ".csv"  # writers of pictures go by it
        assert aside.parent == tmp_path
        assert file.read_text() == "earlier"
    assert file.read_text() == "new"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError, MemoryError])
def test_what_stops_the_writing_leaves_the_earlier_file(tmp_path, error):
    """Ctrl-C in the middle of a table: half of it is gone, and what stood there stands."""
    file = tmp_path / "t.csv"
    file.write_text("earlier")
    with pytest.raises(error), written_aside("--out", file) as aside:
        aside.write_text("half")
        raise error
    assert file.read_text() == "earlier"
    assert list(tmp_path.iterdir()) == [file]


def test_a_disk_that_refuses_is_told_with_option_file_and_reason(tmp_path):
    """Full while writing, and a folder in its place at the end: InputError, and no rest."""
    file = tmp_path / "t.csv"
    with (
        pytest.raises(InputError, match=r"--out '.*t.csv': cannot be written \(No space left\)"),
        written_aside("--out", file) as aside,
    ):
        aside.write_text("half")
        raise OSError(28, "No space left")
    assert list(tmp_path.iterdir()) == []
    file.mkdir()
    with (
        pytest.raises(InputError, match=r"--figure .* cannot be written"),
        written_aside("--figure", file) as aside,
    ):
        aside.write_text("whole")
    assert list(tmp_path.iterdir()) == [file]


def test_a_name_that_is_too_long_beside_the_file_is_told_and_not_raised(tmp_path):
    """255 letters are a name's most: 254 will do for the file, and not for what is beside it."""
    file = tmp_path / ("t" * 250 + ".csv")
    with (
        pytest.raises(InputError, match=r"cannot be written \(File name too long\)"),
        written_aside("--out", file) as aside,
    ):
        aside.write_text("new")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("t.txt", "must end with .csv or .png"),
        ("t", "must end with .csv or .png"),
        ("t.csv.gz", "must end with .csv or .png"),
        (".csv", "must end with .csv or .png"),
        ("folder.csv", "is a folder; name a file in it"),
        ("none/t.csv", "there is no folder"),
        ("file/t.csv", "there is no folder"),
        ("t" * 300 + ".csv", "cannot be written (File name too long)"),
    ],
)
def test_where_no_file_can_stand_is_told_before_any_work(tmp_path, monkeypatch, name, told):
    """An ending that says nothing, a folder, no folder, and a file in a folder's place."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError) as refused:
        check_file("--out", tmp_path / name, {".png", ".csv"})
    assert str(refused.value).startswith("--out '")
    assert told in str(refused.value)


@pytest.mark.parametrize("name", ["t.csv", "T.CSV", "a.b.png", "there.csv"])
def test_endings_of_any_case_and_files_that_exist_will_do(tmp_path, name):
    """What exists is replaced, as people expect of --out; only its ending and place are looked at."""
    (tmp_path / "there.csv").write_text("earlier")
    check_file("--out", tmp_path / name, {".png", ".csv"})
    assert (tmp_path / "there.csv").read_text() == "earlier"
