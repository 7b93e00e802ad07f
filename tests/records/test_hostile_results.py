"""A results folder from a stranger: nothing in it is executed, and what is odd is named."""

import json
import os
import pickle
import shutil
import zlib

import numpy as np
import pytest

from studies import GOOD
from trundle.errors import InputError
from trundle.records.assess import read_simulated
from trundle.results.owned import MARK, record_owned
from trundle.results.store import write_results
from trundle.run.whole_study import run_study
from trundle.study_file.build import load_study


class Payload:
    """What runs a command when it is unpickled."""

    def __init__(self, trace):
        self.trace = trace

    def __reduce__(self):
        return os.system, (f"touch {self.trace}",)


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sound")
    (folder / "study.toml").write_text(GOOD)
    (folder / "out").mkdir()
    write_results(run_study(load_study(folder / "study.toml")), folder / "out")
    return folder / "out"


@pytest.fixture
def results(sound, tmp_path):
    shutil.copytree(sound, tmp_path / "out")
    return tmp_path / "out"


def change(results, array, **changes):
    """Change the description of an array where it stands, and where it is consolidated."""
    store = results / "results.zarr"
    for file in (store / array / ".zarray", store / ".zmetadata"):
        said = json.loads(file.read_text())
        entry = said if file.name == ".zarray" else said["metadata"][f"{array}/.zarray"]
        entry.update(changes)
        file.write_text(json.dumps(said))


def put(results, array, data):
    for chunk in (results / "results.zarr" / array).iterdir():
        if not chunk.name.startswith("."):
            chunk.write_bytes(data)


def test_a_sound_folder_is_read(results):
    (one,) = read_simulated(results)
    assert one.levels.shape == (3, 20)


@pytest.mark.parametrize("where", ["compressor", "filter", "object codec", "type alone"])
@pytest.mark.parametrize("array", ["band_velocity", "point"])
def test_codecs_that_execute_are_never_asked(results, tmp_path, where, array):
    trace = tmp_path / "trace"
    data, codec = pickle.dumps(Payload(trace)), {"id": "pickle", "protocol": 4}
    if where == "compressor":
        change(results, array, compressor=codec)
    if where == "filter":
        change(results, array, compressor={"id": "zlib", "level": 1}, filters=[codec])
        data = zlib.compress(data)
    if where == "object codec":
        change(results, array, dtype="|O", compressor=None, filters=[codec])
    if where == "type alone":
        change(results, array, dtype="|O", compressor=None, filters=None)
    put(results, array, data)
    with pytest.raises(InputError, match=r"codec|neither numbers nor text"):
        read_simulated(results)
    assert not trace.exists()
    pickle.loads(data if where != "filter" else zlib.decompress(data))
    assert trace.exists()  # it would have left one


def test_a_store_whose_consolidated_text_alone_is_hostile_is_refused(results, tmp_path):
    file = results / "results.zarr" / ".zmetadata"
    said = json.loads(file.read_text())
    said["metadata"]["case/.zarray"]["filters"] = [{"id": "pickle"}]
    file.write_text(json.dumps(said))
    with pytest.raises(InputError, match="codec 'pickle'"):
        read_simulated(results)


def test_another_format_is_not_opened(results):
    (results / "results.zarr" / "zarr.json").write_text('{"zarr_format": 3, "node_type": "group"}')
    with pytest.raises(InputError, match="does not write"):
        read_simulated(results)


@pytest.mark.parametrize(
    "changes",
    [
        {"shape": [10**12]},
        {"chunks": [-1]},
        {"shape": "all"},
        {"chunks": None},
        {"dtype": 7},
        {"chunks": [2**29]},
    ],
)
def test_absurd_sizes_are_refused(results, changes):
    change(results, "band_velocity", **changes)
    with pytest.raises(InputError, match=r"no results have|neither numbers"):
        read_simulated(results)


@pytest.mark.parametrize(
    "changes",
    [
        {"filters": 1.5},
        {"filters": [{"id": {}}]},
        {"compressor": [None]},
        {"compressor": {"id": "zlib"}},  # unpacks to a thousand times its size
        {"dimension_separator": "/"},
    ],
)
def test_odd_descriptions_are_refused(results, changes):
    change(results, "band_velocity", **changes)
    with pytest.raises(InputError, match=r"codec|names its chunks"):
        read_simulated(results)


@pytest.mark.parametrize("array", ["band_velocity", "case", "road", "method_name", "point", "band"])
@pytest.mark.parametrize("what", ["a chunk", "all"])
def test_what_is_missing_is_no_zero(results, array, what):
    """Readers of zarr take a missing chunk for numbers; here it is named."""
    folder = results / "results.zarr" / array
    for file in [f for f in folder.iterdir() if what == "all" or not f.name.startswith(".")]:
        file.unlink()
    with pytest.raises(InputError, match=rf"is missing|holds no {array.replace('_', ' ')}"):
        read_simulated(results)


def test_a_changed_number_is_named_where_the_results_have_their_list(results):
    record_owned(results, "study")
    assert read_simulated(results)
    chunk = results / "results.zarr" / "band" / "0"
    data = bytearray(chunk.read_bytes())
    data[-1] ^= 1
    chunk.write_bytes(data)
    with pytest.raises(InputError, match=r"band/0: is not as trundle wrote it"):
        read_simulated(results)
    chunk.unlink()
    with pytest.raises(InputError, match="is missing"):
        read_simulated(results)
    (results / MARK).write_text("[]")
    with pytest.raises(InputError, match=r"is damaged|is missing"):
        read_simulated(results)


def test_names_that_would_steer_a_terminal_are_refused(results):
    store = results / "results.zarr" / "point"
    names = np.array(["\x1b[2J"])
    change(results, "point", dtype=names.dtype.str, compressor=None, shape=[1], chunks=[1])
    (store / "0").write_bytes(names.tobytes())
    with pytest.raises(InputError, match="control characters"):
        read_simulated(results)


@pytest.mark.parametrize("name", ["case", "road", "run", "point", "band"])
def test_levels_along_other_axes_are_no_traceback(results, name):
    file = results / "results.zarr" / "band_velocity" / ".zattrs"
    said = json.loads(file.read_text())
    said["_ARRAY_DIMENSIONS"] = ["x" if d == name else d for d in said["_ARRAY_DIMENSIONS"]]
    file.write_text(json.dumps(said))
    with pytest.raises(InputError, match="are damaged"):
        read_simulated(results)


def test_links_and_damage_are_refused(results, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    link = results / "results.zarr" / "link"
    link.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="is a link"):
        read_simulated(results)
    link.unlink()
    os.mkfifo(link)
    with pytest.raises(InputError, match="a pipe"):
        read_simulated(results)
    link.unlink()
    (results / "results.zarr" / ".zmetadata").write_text("{" * 100_000)
    with pytest.raises(InputError, match="is damaged"):
        read_simulated(results)


def test_spoiled_chunks_are_named(results):
    for chunk in (results / "results.zarr" / "band_velocity").iterdir():
        if not chunk.name.startswith("."):
            chunk.write_bytes(np.random.default_rng(1).bytes(chunk.stat().st_size))
    with pytest.raises(InputError, match="are damaged"):
        read_simulated(results)
