"""Values as arrays and JSON, and back: what is the same, and what is never made."""

import json

import numpy as np
import pytest

from made_results import BANDS, cell, curve, verdict
from trundle.errors import FitnessWarning
from trundle.results.cells import CellKey, DayKey
from trundle.results.codec import keep_value, kept_value, pack, unpack
from trundle.results.kept import write_kept
from trundle.results.maps import MapKey
from trundle.simulate import Coverage


def back(value):
    """Return a value that went through JSON text, as a file keeps it."""
    arrays, said = pack(value)
    return unpack(arrays, json.loads(json.dumps(said)))


def test_plain_values_come_back_of_the_same_kind():
    """True is no 1 and 1 no 1.0; infinities and NaN stay what they are; text is whole."""
    value = (True, 1, 1.0, None, 'ü, "<b>"\n\u2028\\', -np.inf, 2**70, -0.0, "")
    again = back(value)
    assert [type(v) for v in again] == [type(v) for v in value]
    assert repr(again) == repr(value)
    assert np.isnan(back(np.nan))


def test_floats_come_back_to_the_last_bit():
    """The shortest decimal text of a double names it alone, the smallest and largest too."""
    values = (0.1, 1 / 3, 5e-324, 1.7976931348623157e308, np.nextafter(1.0, 2.0))
    assert [v.hex() for v in back(values)] == [float(v).hex() for v in values]


@pytest.mark.parametrize(
    "array",
    [
        np.zeros((0, 3)),
        np.array([np.nan, -0.0, np.inf]),
        np.array([1 + 2j]),
        np.array([True, False]),
        np.arange(6, dtype=np.int16)[::2],
        np.asfortranarray(np.arange(6.0).reshape(2, 3)),
        np.array(["ä", "bcd"]),
        np.arange(3, dtype=">f4"),
    ],
)
def test_arrays_come_back_from_a_file_with_shape_kind_and_values(tmp_path, array):
    """Against the array itself: empty, strided, turned, complex, text, of another byte order."""
    keep_value(tmp_path / "a", {"one": array}, "label")
    (again,) = kept_value(tmp_path / "a", "label").values()
    assert (again.dtype, again.shape) == (array.dtype, array.shape)
    np.testing.assert_array_equal(again, array)


def test_keys_of_mappings_may_be_values_and_keep_their_order():
    """A cell's key is no text; two that differ in one part stay two; order is that of writing."""
    keys = [
        CellKey("b", "B", "m"), CellKey("a", "B", "m"), DayKey("a", "B"), MapKey("a", "B"),
        MapKey("a", "B", 3.0), "a", 1, ("a", 1),
    ]  # fmt: skip
    value = {key: np.array([float(i)]) for i, key in enumerate(keys)}
    again = back(value)
    assert list(again) == keys
    assert [float(a[0]) for a in again.values()] == list(range(8))


def test_arrays_of_one_name_in_two_values_do_not_meet():
    """Each array is named by its place in the tree: equal field names of two cells are two arrays."""
    one, other = cell(CellKey("a", "B", "m")), cell(CellKey("b", "B", "m"))
    other.history.velocity[:] = -1.0
    first, second = back((one, other))
    assert (second.history.velocity == -1.0).all()
    np.testing.assert_array_equal(first.history.velocity, one.history.velocity)
    assert (first.key.case, second.key.case) == ("a", "b")


def test_numbers_of_numpy_become_plain_ones():
    """A scalar of numpy is a number and no array: 2.5, 3 and True, as JSON takes them."""
    again = back((np.float64(2.5), np.int32(3), np.bool_(True)))
    assert again == (2.5, 3, True)
    assert [type(v) for v in again] == [float, int, bool]


def test_lists_come_back_as_tuples():
    """What fields hold are tuples; a list is one of them after it was kept."""
    assert back([1, [2, []]]) == (1, (2, ()))


def test_a_verdict_comes_back_with_its_limit_checked():
    """The curve inside is made by its own class: its limit at 8 Hz is the one that was kept."""
    again = back(verdict(curve(limits=np.array([2e-4, 1e-4])), reasons=("a; b",)))
    assert again.reasons == ("a; b",)
    # straight on log-log axes between 4 and 80 Hz: 2e-4 (8 / 4)^-(ln 2 / ln 20)
    assert again.criterion.limit(np.array([8.0]))[0] == pytest.approx(
        2e-4 * 2 ** -(np.log(2) / np.log(20))
    )


def test_a_class_of_a_name_on_the_list_that_is_another_is_not_packed():
    """A name is not enough: a stranger's class called Verdict is not written as ours."""
    named = type("Verdict", (), {})
    with pytest.raises(TypeError, match="a Verdict is not on the list"):
        pack({"a": named()})


@pytest.mark.parametrize("value", [{1, 2}, b"bytes", 1j, object(), len])
def test_what_json_does_not_know_is_refused_when_it_is_written(value, tmp_path):
    """Before a file is there that nobody could read: and none is left."""
    with pytest.raises(TypeError, match="is not on the list of what results hold"):
        keep_value(tmp_path / "a", (1, value), "label")
    assert list(tmp_path.iterdir()) == []


WARNING = {"class": "FitnessWarning", "fields": {"subject": "a", "message": "b"}}


@pytest.mark.parametrize(
    "said",
    [
        {**WARNING, "more": 1},
        {"class": "FitnessWarning"},
        {"class": "os.system", "fields": {"command": "x"}},
        {"class": "fitnesswarning", "fields": WARNING["fields"]},
        {"class": "FitnessWarning", "fields": {"subject": "a", "message": 1}},
        {"class": "FitnessWarning", "fields": {"subject": "a", "message": None}},
        {"class": "MapKey", "fields": {"case": "a", "road": "B", "speed": "3"}},
        {"class": "KeptIndex", "fields": {}},
        {"array": "value", "class": "x"},
        {"map": [], "fields": {}},
        {},
        [[WARNING, {"array": "value.1"}]],
    ],
)
def test_what_pack_does_not_write_is_not_read(said):
    """One key more, one less, another name, a field of another kind: no value, however it looks."""
    with pytest.raises(ValueError, match="no value of results"):
        unpack({"value": np.zeros(2)}, said)
    assert unpack({}, WARNING) == FitnessWarning(subject="a", message="b")


@pytest.mark.parametrize(
    "said",
    [
        {"map": [[{"map": []}, 1]]},
        {"map": [[1]]},
        {"map": 3},
        {"class": [], "fields": {}},
        {"class": "Coverage", "fields": []},
        {"array": []},
    ],
)
def test_damage_of_any_kind_is_no_value_and_no_traceback(tmp_path, said):
    """Whatever error the tree leads to, a file with it is one that was not written so."""
    write_kept(tmp_path / "a", {}, "label", said)
    assert kept_value(tmp_path / "a", "label") is None


def test_a_curve_that_its_class_refuses_is_no_value(tmp_path):
    """A limit below 0 would pass nothing and fail nothing: the class refuses it, read or written."""
    arrays, said = pack(curve())
    arrays["value.limits"] = -arrays["value.limits"]
    write_kept(tmp_path / "a", arrays, "label", said)
    assert kept_value(tmp_path / "a", "label") is None


def test_coverage_is_what_it_was():
    """How far a result reaches decides passes: every field, the infinite and the absent ones too."""
    for reach in (
        Coverage(),
        Coverage(excited_to=11.8, leaves=5.9, ends=4.0, by="forces", partly_to=80.0),
    ):
        again = back(reach)
        assert again == reach
        np.testing.assert_array_equal(again.excites(BANDS), reach.excites(BANDS))
        assert again.left == reach.left
