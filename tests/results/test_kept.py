"""Files of arrays with a checksum: whole or not at all, and only to who asks for the same."""

import hashlib
import io
import json
import os
import zipfile

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.results.kept import read_kept, refuse_links, stored_as_they_are, write_kept

ARRAYS = {"a b, ü": np.arange(3.0), "x.y": np.zeros((0, 2), dtype=np.int32)}


def sealed(data, label="label"):
    """Return bytes with the checksum in front that a sound file has: SHA-256 of label, 0, data."""
    return hashlib.sha256(label.encode() + b"\0" + data).digest() + data


def archive(save=np.savez, **arrays):
    packed = io.BytesIO()
    save(packed, **arrays)
    return packed.getvalue()


def said(value):
    return np.frombuffer(json.dumps(value).encode(), dtype=np.uint8)


def test_a_file_is_the_checksum_of_label_and_content_before_the_content(tmp_path):
    """The format by hand: what this test seals itself is read, and what is written is so sealed."""
    write_kept(tmp_path / "a", ARRAYS, "a label", {"k": [1, None]})
    data = (tmp_path / "a").read_bytes()
    assert data == sealed(data[32:], "a label")
    (tmp_path / "b").write_bytes(sealed(archive(x=np.arange(2), **{"said as JSON": said("y")})))
    arrays, text = read_kept(tmp_path / "b", "label")
    assert (text, list(arrays)) == ("y", ["x"])
    np.testing.assert_array_equal(arrays["x"], [0, 1])


def test_names_and_empty_arrays_are_kept(tmp_path):
    """Against what was written: names with spaces, commas and umlauts; an array of no numbers."""
    write_kept(tmp_path / "a", ARRAYS, "label", None)
    arrays, text = read_kept(tmp_path / "a", "label")
    assert text is None
    assert list(arrays) == list(ARRAYS)
    for name, array in ARRAYS.items():
        assert (arrays[name].dtype, arrays[name].shape) == (array.dtype, array.shape)


@pytest.mark.parametrize("label", ["", "label 2", "LABEL", "label\0", "labe"])
def test_another_label_opens_nothing(tmp_path, label):
    """What is kept of one study, or by another version, is not given to who asks for another."""
    write_kept(tmp_path / "a", ARRAYS, "label", 1)
    assert read_kept(tmp_path / "a", label) is None
    assert read_kept(tmp_path / "a", "label") is not None


def test_an_archive_that_is_compressed_is_not_unpacked(tmp_path):
    """It could unpack to a thousand times its size; its checksum is right, and it is not ours."""
    zeros = np.zeros(10**6)
    data = archive(np.savez_compressed, x=zeros, **{"said as JSON": said(1)})
    assert len(data) < zeros.nbytes / 100
    (tmp_path / "a").write_bytes(sealed(data))
    assert read_kept(tmp_path / "a", "label") is None
    assert not stored_as_they_are(io.BytesIO(data))
    plain = io.BytesIO(archive(x=zeros[:3]))
    assert stored_as_they_are(plain)
    assert plain.tell() == 0  # it can be read from its beginning


def test_objects_in_an_archive_are_not_unpickled(tmp_path):
    """An array of objects is a pickle: with a right checksum it leaves no trace, and is refused."""
    trace = tmp_path / "trace"

    class Payload:
        def __reduce__(self):
            return os.mkdir, (str(trace),)

    bad = np.array([Payload()], dtype=object)
    for arrays in ({"x": bad, "said as JSON": said(1)}, {"x": np.zeros(1), "said as JSON": bad}):
        (tmp_path / "a").write_bytes(sealed(archive(**arrays)))
        assert read_kept(tmp_path / "a", "label") is None
    assert not trace.exists()
    np.load(io.BytesIO(archive(x=bad)), allow_pickle=True)["x"]
    assert trace.exists()  # it would have left one


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"no archive",
        archive(x=np.zeros(1)),
        archive(**{"said as JSON": np.frombuffer(b"{", np.uint8)}),
        archive(**{"said as JSON": np.frombuffer(b"[" * 100_000, np.uint8)}),
    ],
)
def test_sealed_nonsense_is_nothing_and_no_traceback(tmp_path, data):
    """No archive, no text beside the arrays, text that is no JSON or too deep: None, each of them."""
    (tmp_path / "a").write_bytes(sealed(data))
    assert read_kept(tmp_path / "a", "label") is None


def test_what_is_not_there_is_nothing(tmp_path):
    """No file, a folder of that name: None, for there is nothing that was written."""
    assert read_kept(tmp_path / "none", "label") is None
    assert read_kept(tmp_path, "label") is None


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_a_disk_that_fails_leaves_the_earlier_file_and_nothing_beside(tmp_path, monkeypatch, step):
    """Written aside and renamed: at either step what stood there before still does, byte by byte."""
    write_kept(tmp_path / "a", ARRAYS, "label", "first")
    before = (tmp_path / "a").read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(f"trundle.results.kept.os.{step}", full)
    with pytest.raises(OSError, match="No space left"):
        write_kept(tmp_path / "a", {}, "label", "second")
    assert (tmp_path / "a").read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


def test_a_later_file_takes_the_place_of_an_earlier_one(tmp_path):
    """The second is read, alone, with none of the arrays of the first."""
    write_kept(tmp_path / "a", ARRAYS, "label", "first")
    write_kept(tmp_path / "a", {"z": np.ones(1)}, "label", "second")
    arrays, text = read_kept(tmp_path / "a", "label")
    assert (list(arrays), text) == (["z"], "second")


@pytest.mark.parametrize("what", ["link", "dangling", "pipe", "itself"])
def test_links_and_pipes_below_a_folder_are_refused_by_name(tmp_path, what):
    """Writing through a link reaches what it points to, and reading a pipe never ends."""
    folder = tmp_path / "in"
    (folder / "deep").mkdir(parents=True)
    (folder / "deep" / "file").write_text("x")
    refuse_links(folder)
    odd = folder / "deep" / "odd"
    if what == "pipe":
        os.mkfifo(odd)
    elif what == "itself":
        odd = tmp_path / "odd"
        odd.symlink_to(folder)
    else:
        odd.symlink_to(folder if what == "link" else tmp_path / "nowhere")
    with pytest.raises(InputError, match=rf"{odd} is a link, a device or a pipe"):
        refuse_links(odd if what == "itself" else folder)


def test_a_folder_that_is_not_there_holds_no_links(tmp_path):
    """Nothing to refuse before the first run of a study: the folder is made then."""
    refuse_links(tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_members_of_a_kept_archive_are_as_long_as_they_say(tmp_path):
    """Stored as they are: the file is as long as its arrays and their names, within a few kB."""
    write_kept(tmp_path / "a", {"x": np.zeros(10_000)}, "label", None)
    size = (tmp_path / "a").stat().st_size
    assert 80_000 < size < 82_000
    with zipfile.ZipFile(io.BytesIO((tmp_path / "a").read_bytes()[32:])) as members:
        assert {m.compress_type for m in members.infolist()} == {zipfile.ZIP_STORED}


@pytest.mark.parametrize("name", ["file", "allow_pickle", "args", "a.b 0k"])
def test_names_may_hold_anything_but_a_slash(tmp_path, name):
    """Some of them are names of arguments to numpy's own writer."""
    write_kept(tmp_path / "a", {name: np.arange(2.0)}, "label", 1)
    arrays, said = read_kept(tmp_path / "a", "label")
    assert list(arrays) == [name]
    np.testing.assert_array_equal(arrays[name], [0.0, 1.0])
    assert said == 1


@pytest.mark.parametrize("shape", [(), (0,), (1,), (2, 0, 3)])
def test_shapes_come_back_as_they_were(tmp_path, shape):
    """A number without axes is no list of one."""
    write_kept(tmp_path / "a", {"x": np.ones(shape)}, "label", 1)
    arrays, _ = read_kept(tmp_path / "a", "label")
    assert arrays["x"].shape == shape
