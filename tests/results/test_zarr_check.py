"""A store's description looked at before anything is decoded, and its chunks counted."""

import json

import numpy as np
import pytest
import xarray as xr

from trundle.errors import InputError
from trundle.results.zarr_check import check_whole, check_zarr

SOUND = {
    "zarr_format": 2, "shape": [5, 3], "chunks": [2, 3], "dtype": "<f8", "compressor": {"id": "blosc"},
    "filters": None, "fill_value": None, "order": "C",
}  # fmt: skip


def store(tmp_path, name="a", there=("0.0", "1.0", "2.0"), **changes):
    """A store of one array of 5 x 3 numbers in three chunks, or what a stranger made of it."""
    folder = tmp_path / "s.zarr" / name
    folder.mkdir(parents=True)
    (folder / ".zarray").write_text(json.dumps(SOUND | changes))
    for chunk in there:
        (folder / chunk).write_bytes(b"x")
    return tmp_path / "s.zarr"


def test_what_xarray_writes_for_us_passes(tmp_path):
    """Numbers, truths and texts with umlauts, in groups: written in format 2, all of it is known."""
    data = xr.Dataset(
        {"a": (("x", "y"), np.zeros((5, 3))), "b": ("x", np.ones(5, bool)), "c": ((), 1.0)},
        {"y": ["ä", "b, c", "<d>"]},
    )
    tree = xr.DataTree.from_dict({"/": data, "/deep/er": data})
    tree.to_zarr(tmp_path / "s", mode="w", consolidated=True, zarr_format=2)
    check_zarr(tmp_path / "s")
    check_whole(tmp_path / "s", "y")  # a label that groups below share
    for name in ("a", "b", "c"):
        check_whole(tmp_path / "s", name)
        check_whole(tmp_path / "s" / "deep" / "er", name)


@pytest.mark.parametrize("gone", ["0.0", "1.0", "2.0"])
def test_each_chunk_is_missed_by_its_name(tmp_path, gone):
    """5 rows by twos are three chunks: 0.0, 1.0 and 2.0; zarr would read zeros for one of them."""
    there = store(tmp_path, there=[c for c in ("0.0", "1.0", "2.0") if c != gone])
    with pytest.raises(InputError, match=rf"a/{gone}: is missing, and its numbers with it"):
        check_whole(there, "a")


def test_the_last_column_of_chunks_is_looked_for_too(tmp_path):
    """5 x 3 in chunks of 3 x 2: four of them, the last only half filled."""
    there = store(tmp_path, there=("0.0", "0.1", "1.0"), chunks=[3, 2])
    with pytest.raises(InputError, match=r"a/1\.1: is missing"):
        check_whole(there, "a")
    (there / "a" / "1.1").write_bytes(b"x")
    check_whole(there, "a")


def test_a_folder_is_no_chunk(tmp_path):
    """What is read as missing by others must be missed here."""
    there = store(tmp_path, there=("0.0", "1.0"))
    (there / "a" / "2.0").mkdir()
    with pytest.raises(InputError, match=r"a/2\.0: is missing"):
        check_whole(there, "a")


def test_arrays_that_are_not_there_are_named_in_words(tmp_path):
    """A store without levels is not one with levels of nothing."""
    with pytest.raises(InputError, match="holds no band velocity"):
        check_whole(store(tmp_path), "band_velocity")


def test_more_chunks_than_anybody_writes_are_not_counted_one_by_one(tmp_path):
    """10^9 chunks of one byte would take hours to look for: refused at once."""
    there = store(tmp_path, dtype="|u1", shape=[10**9], chunks=[1])
    with pytest.raises(InputError, match="1000000000 chunks"):
        check_whole(there, "a")


@pytest.mark.parametrize(
    "changes",
    [
        {"dtype": "|O"},
        {"dtype": "<f8\n"},
        {"dtype": [["x", "<f8"]]},
        {"dtype": "<M8[ns]"},
        {"dtype": "|V8"},
        {"compressor": {"id": "pickle"}},
        {"filters": {"id": "pickle"}},
        {"filters": ["pickle"]},
        {"filters": [{"id": "blosc"}, {"id": "vlen-utf8"}]},
        {"compressor": "zlib"},
        {"shape": [2**16, 2**17]},
        {"shape": [True, 2.0]},
        {"shape": None},
        {"dimension_separator": "/"},
    ],
)
def test_a_description_that_we_never_write_is_refused_wherever_it_hides(tmp_path, changes):
    """Beside a sound one, two groups down: the store is walked whole, by file and by consolidated text."""
    there = store(tmp_path)
    store(tmp_path, "deep/er/b", **changes)
    with pytest.raises(InputError, match=r"deep/er/b"):
        check_zarr(there)
    (there / "deep" / "er" / "b" / ".zarray").unlink()
    check_zarr(there)
    text = json.dumps(
        {"metadata": {"deep/b/.zarray": SOUND | changes, ".zgroup": {"zarr_format": 2}}}
    )
    (there / ".zmetadata").write_text(text)
    with pytest.raises(InputError, match=r"\.zmetadata, deep/b/\.zarray"):
        check_zarr(there)


@pytest.mark.parametrize("text", ["[]", "7", '"x"', "null", "{", "\xff", "[" * 50_000])
def test_a_description_that_is_none_is_damage(tmp_path, text):
    """Anything but a table of keys: named as damaged, without a traceback."""
    there = store(tmp_path)
    (there / "a" / ".zarray").write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match=r"a/\.zarray: is damaged"):
        check_zarr(there)


def test_a_store_that_is_none_is_named(tmp_path):
    """A file, nothing, a link to a sound store."""
    there = store(tmp_path)
    (tmp_path / "file").write_text("x")
    (tmp_path / "link").symlink_to(there)
    for name in ("file", "link", "none"):
        with pytest.raises(InputError, match=f"{name}: is no folder of results"):
            check_zarr(tmp_path / name)
