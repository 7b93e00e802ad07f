"""Whole things from Python: what the commands do, and results that are read back bit by bit."""

import json
import pickle
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trundle as tr
from studies import GOOD, MAP
from trundle.errors import FitnessWarning, InputError, StudyError
from trundle.mitigate import Change
from trundle.report.html import embedded
from trundle.results import folder as kept_folder
from trundle.results.codec import keep_value, kept_value, pack, unpack
from trundle.results.field_kinds import fields_hold
from trundle.results.kept import write_kept
from trundle.results.maps import MapKey
from trundle.results.modes import FirstModes
from trundle.run.fingerprint import digest_of

CURVES = """
[[curve]]
name = "OWN"
quantity = "band_rms_velocity"
source = "made up"
points = [["4 Hz", "30 um/s"], ["80 Hz", "30 um/s"]]
"""


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A study with a map, two points, own criteria and an isolator, run into a folder."""
    here = tmp_path_factory.mktemp("face")
    (here / "own.toml").write_text(CURVES)
    text = GOOD.replace('["VC-A"]', '["VC-A", "OWN"]\nfiles = ["own.toml"]') + MAP
    text += (
        '\n[[point]]\nname = "b & c"\nat = ["8 m", "2 m"]\n'
        'isolator = { frequency = "2 Hz", damping = "10 %" }\n'
    )
    (here / "study.toml").write_text(text)
    study = tr.load_study(here / "study.toml")
    return study, tr.run_study(study, here / "out"), here / "out"


def test_a_result_is_read_back_bit_by_bit(done, tmp_path):
    """All values, and the report with all its pictures, from the folder alone."""
    _, result, out = done
    (out.parent / "own.toml").rename(tmp_path / "gone.toml")  # the folder has its own
    try:
        again = tr.read_results(out)
    finally:
        (tmp_path / "gone.toml").rename(out.parent / "own.toml")
    for name in ("cells", "verdicts", "maps", "modes"):
        assert digest_of(getattr(again, name)) == digest_of(getattr(result, name)), name
    assert again.provenance == result.provenance
    assert again.warnings() == result.warnings()
    tr.write_report(again, tmp_path)
    drawn = {p.relative_to(tmp_path): p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}
    assert len(drawn) > 20
    for path, content in drawn.items():
        assert content == (out / path).read_bytes(), path


def test_who_may_read_the_report_may_read_what_is_kept(done):
    _, _, out = done
    modes = {path.stat().st_mode for path in (out / "kept").iterdir()}
    assert modes == {(out / "report.html").stat().st_mode}


def test_what_is_saved_again_is_the_same_folder(done, tmp_path):
    _, _, out = done
    tr.save(tr.read_results(out), tmp_path / "copy")
    first = {p.relative_to(out): p.read_bytes() for p in out.rglob("*") if p.is_file()}
    again = {p.relative_to(tmp_path / "copy"): p for p in (tmp_path / "copy").rglob("*")}
    assert first.keys() == {path for path, where in again.items() if where.is_file()}
    assert all(again[path].read_bytes() == content for path, content in first.items())


@pytest.mark.parametrize("name", ["kept/cell0000", "kept/index", "study.toml", "kept/file00.toml"])
def test_results_that_were_changed_are_refused_by_name(done, tmp_path, name):
    shutil.copytree(done[2], tmp_path / "out")
    file = tmp_path / "out" / name
    old, new = (b"seed = 1", b"seed = 2") if name == "study.toml" else (b"0", b"1")
    file.write_bytes(file.read_bytes().replace(old, new, 1))
    told = "is not the study that was run" if name == "study.toml" else file.name
    with pytest.raises(InputError, match=told):
        tr.read_results(tmp_path / "out")
    (tmp_path / "out" / ".trundle-results").unlink()  # as an archive may leave it
    if name != "kept/file00.toml":
        with pytest.raises(InputError, match=told):
            tr.read_results(tmp_path / "out")


def test_a_folder_without_results_is_named(tmp_path):
    with pytest.raises(InputError, match="no results that can be read back"):
        tr.read_results(tmp_path)


def test_a_study_from_text_is_that_of_the_file(tmp_path):
    (tmp_path / "study.toml").write_text(GOOD)
    ours, theirs = tr.study_from_text(GOOD), tr.load_study(tmp_path / "study.toml")
    assert ours.content_hash == theirs.content_hash
    assert ours.floor.content_hash == theirs.floor.content_hash
    with pytest.raises(StudyError, match="road"):
        tr.study_from_text(GOOD.replace('class = "B"', 'class = "Z"'))
    with pytest.raises(InputError, match="text"):
        tr.study_from_text(Path("study.toml"))
    with pytest.raises(InputError, match="half a character"):
        tr.study_from_text(GOOD.replace("Small", "\ud800"))


def test_values_say_what_they_are(done, tmp_path):
    study, result, _ = done
    assert repr(study).startswith("<Study 'Small': 1 cases on 1 roads")
    assert "verdicts: " in repr(result)
    for value in (study, result):
        page = value._repr_html_()
        assert page.startswith("<table>")
    assert "b &amp; c" in result._repr_html_()
    assert "b & c" not in result._repr_html_()


def test_results_are_xarray(done):
    """The arrays of the cells with their names: a number found by its labels."""
    _, result, _ = done
    tree = result.to_xarray()
    (key, cell), *_ = result.cells.items()
    found = tree["/rms_velocity"].sel(
        case=key.case, road=key.road, method_name=key.method, point="tool"
    )
    np.testing.assert_array_equal(found, cell.rms_velocity[:, 0])
    assert found.attrs["units"] == "m/s"


def test_changes_from_python(done):
    study, result, _ = done
    sweep = tr.try_changes(study, [Change()], speeds=[15 / 3.6], roads=["B"], runs=study.runs)
    (verdicts,) = result.verdicts.values()
    margins = {(v.point, v.criterion.name): v.margin for v in verdicts}
    for verdict in sweep.outcomes[0].verdicts:
        # a record that lasts until the floor is at rest, where the study's ends after 4 s
        assert verdict.margin <= margins[verdict.point, verdict.criterion.name] * (1 + 1e-9)
    assert "1 changes at 1 speeds" in repr(sweep)
    assert "<caption>Small</caption>" in sweep._repr_html_()


def test_lists_are_those_of_the_library():
    assert "container_truck_40ft" in tr.list_vehicles()
    assert {"VC-A", "VC-E"} <= {c.name for c in tr.list_criteria()}


def test_other_classes_are_neither_packed_nor_made():
    """A file can name no class but those on the list, and no field but theirs."""
    with pytest.raises(TypeError, match="not on the list"):
        pack((Path("x"),))
    for said in (
        {"class": "Path", "fields": {}},
        {"class": "FitnessWarning", "fields": {"subject": "a"}},
        {"class": "FitnessWarning", "fields": {"subject": "a", "message": "b", "more": 1}},
        {"array": "nowhere"},
        {"what": 1},
    ):
        with pytest.raises(ValueError, match="no value of results"):
            unpack({}, said)


def test_a_file_of_another_kind_is_no_value(tmp_path):
    file = tmp_path / "a"
    keep_value(file, (1.5, float("nan"), None, "x"), "a label")
    assert kept_value(file, "a label")[::2] == (1.5, None)
    assert kept_value(file, "another") is None
    write_kept(file, {}, "a label", {"class": "Cell", "fields": {}})
    assert kept_value(file, "a label") is None
    file.write_bytes(pickle.dumps("x") + json.dumps("x").encode())
    assert kept_value(file, "a label") is None


def test_pictures_go_into_a_new_folder(tmp_path):
    assert embedded([], tmp_path / "figures") == []
    assert (tmp_path / "figures").is_dir()


def test_results_that_a_stranger_made_up_are_refused_by_name(done, tmp_path):
    """Checksums and lists are right, and what is in the files is of another kind."""
    _, result, written = done
    (cell, *_), (pair, *_) = result.cells.values(), result.maps.items()
    forged = {
        "index": (5, ("index",), cell),
        "cell0000": (
            "x",
            (cell,),
            (replace(cell, f_resolved="80"), None),
            (replace(cell, key=None), ()),
        ),
        "map0000": (pair[::-1], (pair[0], None)),
    }
    for name, values in forged.items():
        for i, value in enumerate(values):
            out = tmp_path / f"{name}-{i}"
            shutil.copytree(written, out)
            (out / ".trundle-results").unlink()
            keep_value(out / "kept" / name, value, kept_folder._LABEL)
            with pytest.raises(InputError, match=name):
                tr.read_results(out)


def test_fields_hold_what_their_annotations_say():
    """Each of the kinds that values of results have, and what only looks like it."""
    cell = {"subject": "a", "message": "b"}
    assert fields_hold(FitnessWarning, cell)
    assert not fields_hold(FitnessWarning, cell | {"message": 5})
    key = {"case": "a", "road": "B", "speed": None}
    assert fields_hold(MapKey, key)
    assert fields_hold(MapKey, key | {"speed": 3})
    assert not fields_hold(MapKey, key | {"speed": True})
    assert not fields_hold(MapKey, key | {"speed": "3"})
    arrays = {"frequencies": np.zeros(3), "vertical": np.zeros((4, 2))}
    assert fields_hold(FirstModes, arrays)
    assert not fields_hold(FirstModes, arrays | {"vertical": np.zeros(4)})  # an axis is missing
    assert not fields_hold(FirstModes, arrays | {"vertical": [[0.0]]})
    assert not fields_hold(FirstModes, arrays | {"vertical": np.array([["x"]])})
