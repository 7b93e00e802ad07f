"""Ways to lose a file of one's own in a results folder: each stops with a message instead."""

import errno
import os
from pathlib import Path

import pytest

from trundle.errors import InputError
from trundle.results.owned import check_owned
from trundle.results.results_folder import check_target, new_results_folder
from trundle.run.checkpoint import unfinished_folder


def results(place, kind="study"):
    with new_results_folder(place, kind=kind) as folder:
        (folder / "summary.json").write_text("{}")
        (folder / "figures").mkdir()
        (folder / "figures" / "plan.svg").write_text("<svg/>")
        (folder / "study.toml").write_text("seed = 1")


@pytest.fixture
def place(tmp_path):
    results(tmp_path / "out")
    return tmp_path / "out"


def test_results_may_be_replaced_by_results(place):
    check_target(place)
    results(place)
    assert (place / "summary.json").exists()
    assert [entry.name for entry in place.parent.iterdir()] == ["out"]


@pytest.mark.parametrize(
    "lose",
    [
        lambda place: (place / "figures" / "mine.svg").write_text("mine"),
        lambda place: (place / "study.toml").write_text("seed = 2  # mine"),
        lambda place: (place / "notes").mkdir(),
        lambda place: (place / "link").symlink_to(place.parent),
        lambda place: (place / ".hidden").write_text("mine"),
        lambda place: (place / ".trundle-results").unlink(),
        lambda place: (place / ".trundle-results").write_text("[]"),
    ],
)
def test_what_was_added_or_changed_is_kept(place, lose):
    lose(place)
    before = sorted(str(path) for path in place.rglob("*"))
    with pytest.raises(InputError, match="trundle did not write"):
        check_target(place)
    assert sorted(str(path) for path in place.rglob("*")) == before


def test_what_is_added_while_a_run_is_under_way_is_kept(place):
    check_target(place)
    with (
        pytest.raises(InputError, match="the new results are in") as told,
        new_results_folder(place) as folder,
    ):
        (folder / "summary.json").write_text("new")
        (place / "thesis.tex").write_text("mine")
    assert (place / "thesis.tex").read_text() == "mine"
    assert beside_of(told).joinpath("summary.json").read_text() == "new"


def beside_of(told):
    return Path(str(told.value).rpartition("the new results are in ")[2])


@pytest.mark.parametrize("what", ["link", "dangling link", "file", "full folder", "mount"])
def test_what_takes_the_place_while_a_run_is_under_way_is_kept(tmp_path, monkeypatch, what):
    place, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    elsewhere.mkdir()
    with (
        pytest.raises(InputError, match="the new results are in") as told,
        new_results_folder(place) as folder,
    ):
        (folder / "summary.json").write_text("new")
        if "link" in what:
            place.symlink_to(elsewhere if what == "link" else tmp_path / "nowhere")
        if what == "file":
            place.write_text("mine")
        if what == "full folder":
            place.mkdir()
            (place / "thesis.tex").write_text("mine")
        if what == "mount":
            place.mkdir()
            monkeypatch.setattr("trundle.results.results_folder.os.rename", busy(place))
    assert beside_of(told).joinpath("summary.json").read_text() == "new"
    assert not list(elsewhere.iterdir())
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(
        ["elsewhere", "out", beside_of(told).name]
    )


def busy(place):
    """Return a renaming that refuses one folder, as the system does where a disk is mounted."""
    rename = os.rename

    def refuse(old, new):
        if old == place:
            raise OSError(errno.EBUSY, os.strerror(errno.EBUSY), str(old))
        rename(old, new)

    return refuse


def test_a_file_that_comes_while_hashes_are_taken_is_kept(place, monkeypatch):
    def slow(folder, kind):
        check_owned(folder, kind)
        (place / "figures" / "thesis.tex").write_text("mine")

    monkeypatch.setattr("trundle.results.results_folder.check_owned", slow)
    with pytest.raises(InputError, match="changed by somebody else") as told:
        results(place)
    assert (place / "figures" / "thesis.tex").read_text() == "mine"
    assert beside_of(told).joinpath("study.toml").exists()
    assert len(list(place.parent.iterdir())) == 2


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS])
def test_a_full_disk_ends_in_a_message_and_leaves_earlier_results(place, code):
    with (
        pytest.raises(InputError, match="cannot be written") as told,
        new_results_folder(place) as folder,
    ):
        (folder / "half").write_text("half")
        raise OSError(code, os.strerror(code))
    assert os.strerror(code) in str(told.value)
    assert [entry.name for entry in place.parent.iterdir()] == ["out"]
    check_target(place)


def test_a_pipe_that_breaks_is_no_full_disk(tmp_path):
    with pytest.raises(BrokenPipeError), new_results_folder(tmp_path / "out"):
        raise BrokenPipeError(errno.EPIPE, "Broken pipe")


def test_steps_back_behind_a_link_lead_where_the_system_says(tmp_path):
    """``link/../o`` stands beside what the link points to, not beside the link."""
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "a" / "b")
    results(tmp_path / "link" / ".." / "o")
    assert (tmp_path / "a" / "o" / "summary.json").exists()
    assert unfinished_folder(tmp_path / "link" / ".." / "o") == tmp_path / "a" / "o.unfinished"


def test_results_of_another_kind_are_kept(place):
    """``assess unit.csv`` does not replace what ``run unit.toml`` left in the same folder."""
    with pytest.raises(InputError, match="holds results of a study"):
        check_target(place, "record")


def test_steps_back_in_a_path_lead_to_the_same_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("o/../o", "./o", "o/"):
        results(type(tmp_path)(name))
        assert sorted(entry.name for entry in tmp_path.iterdir()) == ["o"]
        assert (tmp_path / "o" / "summary.json").exists()
