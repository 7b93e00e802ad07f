"""Where results may be written, what is left of an attempt that failed, and how disks are named."""

import errno
import json
import os
import threading
from pathlib import Path

import pytest

from trundle.errors import InputError
from trundle.results.disk import named_disk_errors, true_path
from trundle.results.owned import MARK, check_owned, check_unchanged, record_owned
from trundle.results.results_folder import check_target, new_results_folder, uninterrupted


def test_a_list_names_every_file_with_its_sha256(tmp_path):
    """SHA-256 of nothing and of "abc", as FIPS 180 prints them; empty folders are named, full ones not."""
    (tmp_path / "a, ü").mkdir()
    (tmp_path / "a, ü" / "leer.txt").touch()
    (tmp_path / "abc").write_bytes(b"abc")
    (tmp_path / "hohl").mkdir()
    record_owned(tmp_path, "study")
    said = json.loads((tmp_path / MARK).read_text("utf-8"))
    assert said["kind"] == "study"
    assert said["files"] == {
        "a, ü/leer.txt": "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
        "abc": "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
        "hohl": "folder",
    }
    check_owned(tmp_path, "study")
    check_unchanged(tmp_path, "a, ü")


def test_what_is_gone_keeps_nothing_from_being_replaced_and_cannot_be_read(tmp_path):
    """A file less loses nobody a file: it may be replaced. To be read it must be there."""
    (tmp_path / "kept").mkdir()
    for name in ("a", "b"):
        (tmp_path / "kept" / name).write_text(name)
    record_owned(tmp_path, "study")
    (tmp_path / "kept" / "b").unlink()
    check_owned(tmp_path, "study")
    with pytest.raises(InputError, match="kept/b: is missing; run the study again"):
        check_unchanged(tmp_path, "kept")


def test_only_the_folder_that_is_read_is_looked_at(tmp_path):
    """A note beside the kept files changes no number; one among them is named."""
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "a").write_text("a")
    (tmp_path / "kept.txt").write_text("x")
    record_owned(tmp_path, "study")
    (tmp_path / "kept.txt").write_text("y")
    (tmp_path / "notes.txt").write_text("mine")
    check_unchanged(tmp_path, "kept")
    (tmp_path / "kept" / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match=r"kept/notes\.txt: is not as trundle wrote it"):
        check_unchanged(tmp_path, "kept")


def test_many_odd_files_are_named_by_the_first_three(tmp_path):
    """Five of a user's own: three names in order and dots, and none of ours."""
    (tmp_path / "ours").write_text("x")
    record_owned(tmp_path, "study")
    for name in "edcba":
        (tmp_path / name).write_text("mine")
    with pytest.raises(InputError, match=r"changed since \(a, b, c \.\.\.\); choose another"):
        check_owned(tmp_path, "study")


def test_an_empty_folder_may_be_filled(tmp_path):
    """Nothing is lost in it, whoever made it."""
    (tmp_path / "out").mkdir()
    check_target(tmp_path / "out")


def refused(tmp_path, monkeypatch, what):
    if what == "the current folder":
        (tmp_path / "out").mkdir()
        monkeypatch.chdir(tmp_path / "out")
        return Path(), "must not be the current folder"
    if what == "a link":
        (tmp_path / "real").mkdir()
        (tmp_path / "out").symlink_to(tmp_path / "real")
        return tmp_path / "out", "is a link"
    (tmp_path / "out").write_text("mine")
    if what == "a file":
        return tmp_path / "out", "a file has this name"
    return tmp_path / "out" / "deeper" / "still", "out is not a folder"


@pytest.mark.parametrize("what", ["the current folder", "a link", "a file", "below a file"])
def test_places_that_cannot_hold_results_are_refused_before_any_work(tmp_path, monkeypatch, what):
    """Each with its own reason; and nothing is made in trying."""
    place, words = refused(tmp_path, monkeypatch, what)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError, match=words):
        check_target(place)
    assert sorted(tmp_path.rglob("*")) == before


def test_folders_that_were_made_on_the_way_go_with_a_failure_and_stay_with_results(tmp_path):
    """Two levels made for nothing are removed; one that was there before, or was used, is not."""
    (tmp_path / "there").mkdir()
    place = tmp_path / "there" / "one" / "two" / "out"
    with pytest.raises(ZeroDivisionError), new_results_folder(place) as aside:
        (aside / "half").write_text("half")
        raise ZeroDivisionError
    assert list((tmp_path / "there").iterdir()) == []
    with new_results_folder(place) as aside:
        (aside / "whole").write_text("whole")
        assert not place.exists()  # not before it is whole
    assert sorted(p.name for p in place.iterdir()) == [MARK, "whole"]
    assert [p.name for p in place.parent.iterdir()] == ["out"]


def test_a_failure_leaves_earlier_results_as_they_were(tmp_path):
    """Byte by byte, and with nothing beside them."""
    place = tmp_path / "out"
    for text in ("first", "second"):
        try:
            with new_results_folder(place) as aside:
                (aside / "a").write_text(text)
                1 / (text == "first")
        except ZeroDivisionError:
            pass
    assert (place / "a").read_text() == "first"
    assert [p.name for p in tmp_path.iterdir()] == ["out"]
    check_target(place)


def test_what_is_filled_within_another_folder_takes_its_place_too(tmp_path):
    """Filled where the pieces of a run lie; in place it is complete, and nothing is left there."""
    (tmp_path / "pieces").mkdir()
    with new_results_folder(tmp_path / "out", within=tmp_path / "pieces") as aside:
        assert aside.parent == tmp_path / "pieces"
        (aside / "a").write_text("x")
    assert (tmp_path / "out" / "a").read_text() == "x"
    assert list((tmp_path / "pieces").iterdir()) == []


def test_errors_of_disks_are_told_with_what_to_do_and_others_are_left_alone():
    """A full disk wants space, a forbidden one a look; a mistake of ours is no disk's."""
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "/data/ä")
    with (
        pytest.raises(
            InputError, match=r"/data/ä cannot be written \(No space.*; all stands; free some"
        ),
        named_disk_errors(Path("out"), "all stands"),
    ):
        raise full
    with (
        pytest.raises(
            InputError, match=r"^out cannot be written \(Perm.*see whether disk and folder"
        ),
        named_disk_errors(Path("out"), "all stands"),
    ):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES))
    for other in (OSError(errno.EINVAL, "x"), OSError("no number"), ValueError("x")):
        with pytest.raises(type(other)) as told, named_disk_errors(Path("out"), "x"):
            raise other
        assert told.value is other


def test_a_path_is_that_of_the_system_and_a_link_stays_one(tmp_path, monkeypatch):
    """Steps back are taken, links above followed; the folder itself is not, so that it is seen as a link."""
    (tmp_path / "real" / "deep").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "real" / "deep")
    monkeypatch.chdir(tmp_path)
    assert true_path(Path("x/../out")) == tmp_path / "out"
    assert true_path(Path("link/out")) == tmp_path / "real" / "deep" / "out"
    assert true_path(Path("link/../out")) == tmp_path / "real" / "out"
    assert true_path(Path("link")) == tmp_path / "link"
    assert true_path(Path()) == tmp_path
    assert true_path(Path("..")) == tmp_path.parent


def test_writing_in_a_thread_needs_no_signals():
    """Only the main thread may set handlers: another writes without, and comes to its end."""
    done = []

    def write():
        with uninterrupted():
            done.append("written")

    thread = threading.Thread(target=write)
    thread.start()
    thread.join()
    assert done == ["written"]
