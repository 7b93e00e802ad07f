"""Kept modes are the same modes, and a spoiled cache is never believed."""

import errno
import io
import os

import numpy as np
import pytest

from models import small_floor
from studies import spoilt
from trundle.dynamics import Modes, modes_as_arrays
from trundle.run import mode_cache
from trundle.run.mode_cache import modes_of
from trundle.structure import Floor

NAMES = ("omega", "shapes", "residuals", "f_max")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("TRUNDLE_CACHE", str(tmp_path / "modes"))
    return tmp_path / "modes"


@pytest.fixture
def counted(monkeypatch):
    calls = []
    original = Floor.modes

    def counting(floor, f_max, **kwargs):
        calls.append(f_max)
        return original(floor, f_max, **kwargs)

    monkeypatch.setattr(Floor, "modes", counting)
    return calls


def test_found_once_and_bit_identical(folder, counted):
    floor = small_floor(mesh_size=2.0)
    first, again = modes_of(floor, f_max=40.0), modes_of(floor, f_max=40.0)
    assert counted == [40.0]
    np.testing.assert_array_equal(first.shapes, again.shapes)
    modes_of(small_floor(mesh_size=1.5), f_max=20.0)
    assert counted == [40.0, 20.0]
    assert len(list(folder.iterdir())) == 2


def test_what_another_study_left_changes_nothing(folder, counted):
    """Modes kept to 40 Hz are not cut to 30: they would differ in their last digits."""
    floor = small_floor(mesh_size=2.0)
    alone = modes_of(floor, f_max=30.0)
    for file in folder.iterdir():
        file.unlink()
    modes_of(floor, f_max=40.0)
    beside = modes_of(floor, f_max=30.0)
    assert counted == [30.0, 40.0, 30.0]
    assert (beside.f_max, beside.n_modes) == (30.0, alone.n_modes)
    np.testing.assert_array_equal(alone.shapes, beside.shapes)
    modes_of(floor, f_max=40.0)
    assert counted == [30.0, 40.0, 30.0]  # neither took the other's place


@pytest.mark.parametrize("spoil", ["cut", "empty", "foreign"])
def test_a_spoiled_file_is_found_anew(folder, counted, spoil):
    floor = small_floor(mesh_size=2.0)
    modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    data = file.read_bytes()
    if spoil == "foreign":
        np.savez(file, omega=np.ones(2), shapes=np.ones((3, 2)), residuals=np.ones(2), f_max=99.0)
    else:
        file.write_bytes(data[: len(data) // 2] if spoil == "cut" else b"")
    assert modes_of(floor, f_max=20.0).n_modes > 2
    assert counted == [20.0, 20.0]


@pytest.mark.parametrize(
    "what",
    ["omega", "shapes", "one number", "fewer dofs", "negative", "a mode less", "the highest less",
     "f_max", "residuals"],
)  # fmt: skip
def test_finite_nonsense_is_not_believed(folder, counted, what):
    """Whole files of other numbers: other frequencies, other shapes, a single entry changed."""
    floor = small_floor(mesh_size=2.0)
    right = modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    kept = {n: np.array(getattr(right, n)) for n in NAMES}
    if what == "omega":
        kept["omega"] *= 1.001
    if what == "shapes":
        kept["shapes"] *= 1.001
    if what == "one number":
        at = np.unravel_index(np.abs(kept["shapes"]).argmax(), kept["shapes"].shape)
        kept["shapes"][at] *= 1.01
    if what == "fewer dofs":
        kept["shapes"] = kept["shapes"][:-1]
    if what == "negative":
        kept["omega"] *= -1.0
    if what == "a mode less":
        kept = {n: values[..., 1:] if values.ndim else values for n, values in kept.items()}
    if what == "the highest less":
        kept = {n: values[..., :-1] if values.ndim else values for n, values in kept.items()}
    if what == "f_max":
        kept["f_max"] = np.array(19.0)
    if what == "residuals":
        kept["residuals"][0] = np.nan
    write_with_a_right_sum(file, kept)
    again = modes_of(floor, f_max=20.0)
    assert counted == [20.0, 20.0]
    np.testing.assert_array_equal(again.shapes, right.shapes)


def write_with_a_right_sum(file, arrays):
    modes = Modes(**{n: arrays[n] for n in NAMES[:3]}, f_max=float(arrays["f_max"]))
    digest = modes_as_arrays(modes)["digest"].tobytes()
    np.savez(file, **arrays, digest=np.frombuffer(digest, dtype=np.uint8))


def test_modes_with_a_right_sum_are_believed(folder, counted):
    """What the nonsense above is told from."""
    floor = small_floor(mesh_size=2.0)
    right = modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    write_with_a_right_sum(file, {n: np.array(getattr(right, n)) for n in NAMES})
    modes_of(floor, f_max=20.0)
    assert counted == [20.0]


def test_no_bit_and_no_end_of_kept_modes_may_change_a_number(folder, counted):
    """Bits of the archive that say nothing, such as a date, may; the smallest of a shape may not."""
    floor = small_floor(mesh_size=2.0)
    right = modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    data = file.read_bytes()
    for spoiled in spoilt(data):
        file.write_bytes(spoiled)
        found = mode_cache._read(file, floor)
        for name in NAMES if found is not None else ():
            np.testing.assert_array_equal(getattr(found, name), getattr(right, name))
    with np.load(io.BytesIO(data)) as kept:
        start = data.index(kept["shapes"].tobytes())
        for at in range(start, start + kept["shapes"].nbytes, kept["shapes"].nbytes // 40):
            file.write_bytes(data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])
            assert mode_cache._read(file, floor) is None


def test_a_full_disk_leaves_no_half_of_them(folder, counted, monkeypatch):
    def full(number):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("trundle.run.mode_cache.os.fsync", full)
    assert modes_of(small_floor(mesh_size=2.0), f_max=20.0).n_modes > 2
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("name", ["omega", "shapes", "residuals"])
def test_a_last_digit_that_is_off_is_not_believed(folder, counted, name):
    """The archive is whole and its modes hold, but for a digit that nobody computed."""
    floor = small_floor(mesh_size=2.0)
    right = modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    with np.load(file) as kept:
        arrays = {n: kept[n] for n in kept.files}
    arrays[name].flat[3] *= 1.0 + 1e-12
    np.savez(file, **arrays)
    again = modes_of(floor, f_max=20.0)
    assert counted == [20.0, 20.0]
    np.testing.assert_array_equal(getattr(again, name), getattr(right, name))


class Payload:
    """What leaves a trace when it is unpickled."""

    def __init__(self, trace):
        self.trace = str(trace)

    def __reduce__(self):
        return os.mkdir, (self.trace,)


@pytest.mark.parametrize("name", ["omega", "shapes", "residuals", "f_max", "digest"])
def test_pickled_arrays_are_not_unpickled(folder, counted, tmp_path, name):
    floor = small_floor(mesh_size=2.0)
    modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    with np.load(file) as kept:
        arrays = {n: kept[n] for n in kept.files}
    arrays[name] = np.array([Payload(tmp_path / "trace")], dtype=object)
    np.savez(file, **arrays)
    modes_of(floor, f_max=20.0)
    assert counted == [20.0, 20.0]
    assert not (tmp_path / "trace").exists()


def test_switched_off_or_not_writable_it_still_works(tmp_path, monkeypatch, counted):
    floor = small_floor(mesh_size=2.0)
    monkeypatch.setenv("TRUNDLE_CACHE", "")
    modes_of(floor, f_max=20.0)
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("TRUNDLE_CACHE", str(tmp_path / "file" / "modes"))
    modes_of(floor, f_max=20.0)
    assert counted == [20.0, 20.0]


def test_what_would_unpack_to_a_thousand_times_its_size_is_not_unpacked(folder, counted):
    floor = small_floor(mesh_size=2.0)
    modes_of(floor, f_max=20.0)
    (file,) = folder.iterdir()
    with np.load(file) as kept:
        arrays = {n: kept[n] for n in kept.files}
    np.savez_compressed(file, **arrays, more=np.zeros(10**7))
    modes_of(floor, f_max=20.0)
    assert counted == [20.0, 20.0]
