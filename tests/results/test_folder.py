"""What is kept of a result: read back whole, and refused by name where anything is not as it was."""

import copy
import hashlib
import pickle
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from made_results import (
    BANDS,
    POINTS,
    SECOND,
    cell,
    class_map,
    curve,
    history,
    levels,
    made_result,
    made_study,
    spectra,
    verdict,
)
from trundle._face import read_results
from trundle.criteria import BandOutcomes
from trundle.errors import FitnessWarning, InputError
from trundle.results import folder as kept_folder
from trundle.results.cells import CellKey, DayKey
from trundle.results.codec import keep_value
from trundle.results.folder import files_of, index_of, keep_result, read_result
from trundle.results.maps import MapKey, StudyMap
from trundle.results.mesh_change import MeshChange
from trundle.results.modes import FirstModes
from trundle.results.owned import MARK, record_owned
from trundle.simulate import Coverage, TruncationChange
from trundle.traffic import Day, Loudest, Meeting

SOUTH = "=Zufahrt, Süd"


MORE = """
[map]
spacing = "3 m"
criterion = "VC-A"
speeds = ["12 km/h"]

[[schedule]]
name = "Tag & Nacht"
route = "main"
times = ["8:00"]
"""


def a_day():
    """A day with who was there, one of whom has left, and a curve without a running level."""
    there = Meeting(route=SOUTH, departed=30600.0, x=3.0, y=np.nan, rms_velocity=2e-4)
    loudest = Loudest(
        criterion="one", point="tool", ratio=np.inf, band=np.nan, time=86399.5, present=(there,)
    )
    seconds = np.arange(48.0).reshape(24, 1, 2)
    seconds[3] = np.nan
    return Day(
        schedule="Tag & Nacht", n_passages=2, counts={SOUTH: 2}, busy=24.5, at_once=2,
        point_names=tuple(POINTS), criteria=("one",), complete=(False,), seconds_above=seconds,
        events=np.arange(48).reshape(24, 1, 2), loudest=(loudest,), dose_day=np.array([0.1, 0.2]),
        dose_night=np.array([0.3, np.nan]), meeting_error=np.nan,
    )  # fmt: skip


def a_map(factor):
    return StudyMap(
        classes=class_map(factor * np.array([[0.5, np.nan, 2.0]]), [curve()]),
        numbers={"rms_velocity": factor * np.array([1e-6, 2e-6, np.nan])},
        band_levels=factor * np.arange(60.0).reshape(3, 20),
        seconds_above={"one": np.array([0.0, 1.5, np.nan])},
    )


def full_result():
    """Every kind of thing that a result may hold, with numbers that are none in most of them."""
    study = made_study(SECOND + MORE, runs=3)
    result = made_result(study)
    first, second, *_ = result.cells
    bands = BandOutcomes(
        frequencies=BANDS[:2], values=np.array([np.nan, 1e-6]), limits=np.array([1e-4, np.nan]),
        statuses=("not assessed", "pass"),
    )  # fmt: skip
    cells = dict(result.cells)
    cells[first] = cell(
        first,
        reduced=levels(
            base=-0.1,
            more={
                "narrow_band_acceleration": spectra(
                    np.zeros((3, 2, 4)), mid_band=np.arange(1.0, 5.0), resolved=np.array([True, False] * 2)
                )
            },
            above={"one": np.full((3, 2), np.nan)},
        ),
        truncation=TruncationChange(f_max=15.0, velocity=np.array([0.1, 0.2]), acceleration=np.array([0.3, np.inf])),
        coverage=Coverage(excited_to=np.inf, leaves=-np.inf, ends=4.0, by="forces", partly_to=None),
        exact_peaks=np.array([[1.0, 2.0], [3.0, 4.0]]),
        warnings=(FitnessWarning(subject="Maß <1>", message="é, \"quoted\"\t\u2028"),),
    )  # fmt: skip
    return replace(
        result,
        cells=cells,
        verdicts={
            first: (
                verdict(bands=bands, interval=(0.0, np.inf), time=np.nan),
                verdict(status="not assessed", reasons=("weil, warum",), unexcited=(80.0,)),
            ),
            second: (),
        },
        maps={MapKey("main", "B"): a_map(1.0), MapKey("main", "B", study.map.speeds[0]): a_map(3.0)},
        days={DayKey("Tag & Nacht", "B"): a_day()},
        modes=FirstModes(frequencies=np.array([4.0, 7.5]), vertical=np.arange(6.0).reshape(3, 2)),
        mesh=MeshChange(
            sizes=(3.0, 1.5), frequencies=np.array([[4.0], [5.0]]), cases=("main",),
            points=("tool",), bands=BANDS[:1], levels=np.array([[[[1.0]]], [[[np.nan]]]]),
        ),
        provenance={"program": "trundle", "seed": 1, "methods": {"coupled": "Newmark, ½"}},
    )  # fmt: skip


@pytest.fixture(scope="module")
def full():
    return full_result()


@pytest.fixture(scope="module")
def sound(full, tmp_path_factory):
    place = tmp_path_factory.mktemp("sound") / "out"
    place.mkdir()
    keep_result(full, place)
    record_owned(place, "study")
    return place


@pytest.fixture
def out(sound, tmp_path):
    return Path(shutil.copytree(sound, tmp_path / "out"))


def same(one, other, where="result"):
    """Hold two values against each other: classes, keys in order, and every bit of every array."""
    assert type(one) is type(other), where
    if isinstance(one, np.ndarray):
        assert (one.dtype, one.shape) == (other.dtype, other.shape), where
        assert one.tobytes() == other.tobytes(), where
    elif isinstance(one, dict):
        assert list(one) == list(other), where
        for key in one:
            same(one[key], other[key], f"{where}[{key}]")
    elif isinstance(one, tuple):
        assert len(one) == len(other), where
        for i, (a, b) in enumerate(zip(one, other, strict=True)):
            same(a, b, f"{where}[{i}]")
    elif hasattr(one, "__dataclass_fields__"):
        for name in one.__dataclass_fields__:
            same(getattr(one, name), getattr(other, name), f"{where}.{name}")
    else:
        assert repr(one) == repr(other), where


def test_every_part_comes_back_bit_by_bit_in_its_order(full, sound):
    """Held against the values that were kept, NaN, infinities, umlauts, empty tuples and all."""
    again = read_results(sound)
    for name in ("cells", "verdicts", "maps", "days", "modes", "mesh", "provenance"):
        same(getattr(again, name), getattr(full, name), name)
    assert again.study.content_hash == full.study.content_hash


def test_a_cell_without_verdicts_has_none_and_one_with_nothing_has_nothing(full, sound):
    """No key where nothing was assessed; an empty tuple where no curve fits: both as they were."""
    again = read_results(sound)
    assert list(again.verdicts) == list(full.verdicts)
    assert again.verdicts[list(full.verdicts)[1]] == ()
    assert len(again.cells) == 6  # three cases on two roads


def test_a_result_read_again_and_kept_again_is_the_same_files(sound, tmp_path):
    """What is written depends on the result alone: the bytes of every file."""
    keep_result(read_results(sound), tmp_path)
    first = {p.name: p.read_bytes() for p in (sound / "kept").iterdir()}
    assert {p.name: p.read_bytes() for p in (tmp_path / "kept").iterdir()} == first


def test_files_of_the_study_are_kept_under_names_of_our_own(full, tmp_path):
    """A name that leads elsewhere leads nowhere: the content lies in the folder, and is found there."""
    files = {"../../etc/pässe.toml": b"one", "own, 1.CSV": b"\x00\xff", "sub/own.csv": b"two"}
    keep_result(replace(full, study=replace(full.study, files=files)), tmp_path)
    where = files_of(tmp_path, index_of(tmp_path))
    assert list(where) == list(files)
    assert {name: path.read_bytes() for name, path in where.items()} == files
    assert {path.parent for path in where.values()} == {tmp_path / "kept"}
    assert [path.suffix for path in where.values()] == [".toml", ".CSV", ".csv"]


def test_an_index_that_names_files_elsewhere_leads_into_the_folder(sound):
    """Only the last part of a path counts, so that a made-up index opens no file of the reader's."""
    index = replace(index_of(sound), files={"a": "/etc/passwd", "b": "../../b.toml"})
    assert files_of(sound, index) == {
        "a": sound / "kept" / "passwd",
        "b": sound / "kept" / "b.toml",
    }


def read(out, full):
    """Read a folder back as `read_results` does, by the study at hand instead of its text."""
    return read_result(out, index_of(out), full.study)


KEPT = ["cell0000", "cell0005", "map0001", "day0000", "index"]


@pytest.mark.parametrize("name", KEPT)
@pytest.mark.parametrize("listed", [True, False])
def test_a_file_that_is_gone_is_named(full, out, name, listed):
    """With the list of files, and where an archive has lost it: no cell is left out in silence."""
    (out / "kept" / name).unlink()
    if not listed:
        (out / MARK).unlink()
    told = "no results that can be read back" if name == "index" else f"{name}: is "
    with pytest.raises(InputError, match=told):
        read(out, full)


@pytest.mark.parametrize("name", KEPT)
def test_a_bit_that_turned_is_named_without_the_list_too(full, out, name):
    """Each file holds a checksum of itself."""
    (out / MARK).unlink()
    data = bytearray((out / "kept" / name).read_bytes())
    data[len(data) // 2] ^= 4
    (out / "kept" / name).write_bytes(data)
    with pytest.raises(
        InputError, match=f"{name}: is not as trundle wrote it; run the study again"
    ):
        read(out, full)


def test_a_file_that_was_added_is_named(full, out):
    """The list says what was written: a seventh cell is not among it."""
    shutil.copy(out / "kept" / "cell0000", out / "kept" / "cell0006")
    with pytest.raises(InputError, match="cell0006: is not as trundle wrote it"):
        read(out, full)


def test_two_cells_in_each_other_s_place_are_named(full, out):
    """Sound files under each other's names are not what was written, by the list."""
    first, second = out / "kept" / "cell0000", out / "kept" / "cell0001"
    one, other = first.read_bytes(), second.read_bytes()
    first.write_bytes(other)
    second.write_bytes(one)
    with pytest.raises(InputError, match="cell0000: is not as trundle wrote it"):
        read(out, full)


def test_a_link_in_the_place_of_a_cell_is_not_followed(full, out, tmp_path):
    """The same bytes behind a link: with the list it is refused, for a link was not written."""
    (out / "kept" / "cell0000").rename(tmp_path / "elsewhere")
    (out / "kept" / "cell0000").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="cell0000: is not as trundle wrote it"):
        read(out, full)


@pytest.mark.parametrize(
    "said", ["[]", "{", '{"files": 3, "kind": "study"}', '{"kind": "study"}', ""]
)
def test_a_list_that_is_damaged_is_no_list_that_allows_everything(full, out, said):
    """Where there is a list it must be one: else altered results would pass as old ones do."""
    (out / MARK).write_text(said)
    with pytest.raises(InputError, match=r"\.trundle-results: is damaged"):
        read(out, full)


def test_results_of_another_version_are_refused_and_not_misread(full, out):
    """The label is part of the checksum: what another version wrote is not believed."""
    (out / MARK).unlink()
    index = index_of(out)
    keep_value(out / "kept" / "index", index, "trundle result 1")
    with pytest.raises(InputError, match="index: is not as trundle wrote it"):
        read(out, full)


def forge(out, name, value):
    """Write a value as trundle would, label and checksum right, and without the list."""
    (out / MARK).unlink()
    keep_value(out / "kept" / name, value, kept_folder._LABEL)


def odd(value, **changes):
    """Return a copy of a value with fields that its class would never take."""
    other = copy.copy(value)
    for name, change in changes.items():
        object.__setattr__(other, name, change)
    return other


def made_up(full):
    """Values of other kinds than belong in each file, by its name."""
    first, *_ = full.cells.values()
    key, one = next(iter(full.maps.items()))
    day = next(iter(full.days.items()))
    index = kept_folder.KeptIndex(
        source="s",
        study="s",
        files={},
        cells=6,
        maps=2,
        days=1,
        modes=None,
        mesh=None,
        provenance={},
    )
    return [
        ("cell0000", first),
        ("cell0000", (first,)),
        ("cell0000", (first, (first,))),
        ("cell0000", (first, [verdict()], None)),
        ("cell0000", (replace(first, f_resolved="80"), None)),
        ("cell0000", (replace(first, f_resolved=True), None)),
        ("cell0000", (replace(first, key=key), None)),
        ("cell0000", (replace(first, warnings=("a",)), None)),
        ("cell0000", (replace(first, history=replace(history(), time=np.zeros((2, 2)))), None)),
        ("cell0000", (first, (odd(verdict(), margin="2"),))),
        ("cell0000", (first, (odd(verdict(), status="passed"),))),
        ("map0000", (one, key)),
        ("map0000", (key, None)),
        ("map0000", (replace(key, speed="3"), one)),
        ("day0000", (day[0],)),
        ("day0000", (key, day[1])),
        ("day0000", (day[0], odd(day[1], n_passages=2.5))),
        ("index", (index,)),
        ("index", first),
        ("index", replace(index, cells="6")),
        ("index", replace(index, files={"a": 3})),
    ]


@pytest.mark.parametrize("i", range(21))
def test_values_of_another_kind_are_refused_by_name(full, out, i):
    """Label and checksum as trundle writes them, and what is inside is not what belongs there.

    The sound value, forged in the same way, is read: so it is the kind that is refused.
    """
    name, value = made_up(full)[i]
    first, *_ = full.cells.values()
    own = {"cell0000": (first, full.verdicts[first.key]), "map0000": next(iter(full.maps.items())),
           "day0000": next(iter(full.days.items())), "index": index_of(out)}  # fmt: skip
    forge(out, name, own[name])
    read(out, full)
    keep_value(out / "kept" / name, value, kept_folder._LABEL)
    with pytest.raises(InputError, match=f"{name}: is not as trundle wrote it"):
        read(out, full)


def test_a_pickle_in_the_place_of_a_cell_is_never_opened(full, out, tmp_path):
    """With a checksum that is right, an object that runs on unpickling leaves no trace."""
    trace = tmp_path / "trace"

    class Payload:
        def __reduce__(self):
            return Path.touch, (trace,)

    (out / MARK).unlink()
    for data in (pickle.dumps(Payload()), npz_of(np.array([Payload()], dtype=object), tmp_path)):
        digest = hashlib.sha256(kept_folder._LABEL.encode() + b"\0" + data).digest()
        (out / "kept" / "cell0000").write_bytes(digest + data)
        with pytest.raises(InputError, match="cell0000: is not as trundle wrote it"):
            read(out, full)
    assert not trace.exists()
    pickle.loads(pickle.dumps(Payload()))
    assert trace.exists()  # it would have left one


def npz_of(array, folder):
    """Return an archive of an array of objects, pickled in it as numpy does."""
    np.savez(folder / "a.npz", **{"value": array, "said as JSON": np.frombuffer(b"[]", np.uint8)})
    return (folder / "a.npz").read_bytes()


def test_another_study_in_the_folder_is_refused(out):
    """One seed further it is another study; its results are not those that are kept."""
    text = (out / "study.toml").read_text("utf-8")
    (out / "study.toml").write_text(text.replace("seed = 1", "seed = 2"), "utf-8")
    with pytest.raises(InputError, match=r"study\.toml: is not the study that was run there"):
        read_results(out)


def test_kept_files_are_read_by_whom_the_study_is(sound):
    """Written aside they are the writer's alone; in place they have the rights of study.toml."""
    rights = {p.stat().st_mode for p in (sound / "kept").iterdir()}
    assert rights == {(sound / "study.toml").stat().st_mode}
    assert not [p for p in (sound / "kept").iterdir() if p.name.startswith(".writing")]


def test_a_second_result_is_not_mixed_into_the_first(full, sound, tmp_path):
    """Into a folder that holds one already nothing is written: cells of two results never mix."""
    keep_result(full, tmp_path)
    with pytest.raises(FileExistsError):
        keep_result(full, tmp_path)


def test_cells_keep_their_own_numbers(sound, full):
    """Cell k has k times the levels of the first road, so that none can stand for another."""
    again = read_results(sound)
    for k, key in enumerate(full.cells, start=1):
        if k > 1:  # the first is made otherwise
            assert again.cells[key].rms_velocity[2, 1] == pytest.approx(k * 321e-6, rel=1e-12)
    assert CellKey("both", "C", "coupled") in again.cells


def test_a_study_file_that_is_gone_is_named(full, out):
    """Results say nothing without their study: what is missing is told, and what would help."""
    (out / "study.toml").unlink()
    (out / MARK).unlink()
    with pytest.raises(InputError, match=r"study\.toml: cannot be read.*put it back"):
        read(out, full)


@pytest.mark.parametrize("what", ["cell", "map"])
def test_a_sound_file_in_the_place_of_another_is_refused(full, out, what):
    """Checksums are right, and one of the files is lost: the rest is not the result."""
    (out / MARK).unlink()
    shutil.copy(out / "kept" / f"{what}0000", out / "kept" / f"{what}0001")
    with pytest.raises(
        InputError, match=rf"{what}0001: is of 'main, B.*is held by another file too"
    ):
        read(out, full)


@pytest.mark.parametrize(
    ("what", "key"),
    [
        ("cell", CellKey("main", "H", "coupled")),
        ("map", MapKey("main", "B", 99.0)),
        ("day", DayKey("Sonntag", "B")),
    ],
)
def test_what_is_of_no_part_of_the_study_is_refused(full, out, what, key):
    """A road, a speed and a schedule that the study does not have."""
    first, *_ = full.cells.values()
    values = {
        "cell": (replace(first, key=key), None),
        "map": (key, a_map(1.0)),
        "day": (key, a_day()),
    }
    forge(out, f"{what}0000", values[what])
    with pytest.raises(InputError, match=f"{what}0000: is of .* is none of the study"):
        read(out, full)


def test_a_result_of_fewer_cells_than_its_study_is_refused(full, out):
    """An index that counts fewer: what is not there must not look as if nobody had asked for it."""
    index = index_of(out)
    forge(out, "index", replace(index, cells=index.cells - 1))
    with pytest.raises(InputError, match="holds 5 of 6 cells of the study"):
        read(out, full)
