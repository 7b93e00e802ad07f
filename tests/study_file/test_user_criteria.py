"""A user's own criteria, from files beside the study."""

import os

import numpy as np
import pytest

from studies import GOOD
from trundle.criteria import find_criterion
from trundle.errors import InputError, StudyError
from trundle.run.whole_study import run_study
from trundle.study_file.build import load_study
from trundle.study_file.user_criteria import read_criteria

TOML = """
[[curve]]
name = "maker A"
quantity = "narrow_band_acceleration"
points = [["1 Hz", "0.02 gal"], ["100 Hz", "0.2 gal"]]
source = "data sheet of maker A"
"""
CSV = """# quantity = band_rms_velocity
# title = Maker B, stage
frequency [Hz], limit [um/s]
1, 50
8, 25
80, 25
"""


def written(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_curves_come_with_their_units(tmp_path):
    (curve,) = read_criteria(written(tmp_path, "a.toml", TOML))
    assert (curve.name, curve.quantity) == ("maker A", "narrow_band_acceleration")
    np.testing.assert_allclose(curve.limits, [2e-4, 2e-3])
    (curve,) = read_criteria(written(tmp_path, "stage.csv", CSV))
    assert (curve.name, curve.title) == ("stage", "Maker B, stage")
    np.testing.assert_allclose(curve.limits, [50e-6, 25e-6, 25e-6])
    np.testing.assert_allclose(curve.frequencies, [1, 8, 80])


def test_units_of_data_sheets(tmp_path):
    """g is gravity in a limit of acceleration; a dose has a unit of its own."""
    text = "# quantity = band_rms_acceleration\nfrequency [Hz], limit [mg]\n1, 2\n80, 4\n"
    (curve,) = read_criteria(written(tmp_path, "g.csv", text))
    np.testing.assert_allclose(curve.limits, [2 * 9.80665e-3, 4 * 9.80665e-3])
    for unit in ("m/s^1.75", "1"):
        text = f"# quantity = vdv\nfrequency [Hz], limit [{unit}]\n1, 0.5\n80, 0.5\n"
        (curve,) = read_criteria(written(tmp_path, "dose.csv", text))
        np.testing.assert_allclose(curve.limits, 0.5)


def test_generic_curves_of_a_study_may_be_flat(tmp_path):
    text = GOOD.replace('["VC-A"]', '["VC-A", "VC-C", "NIST-A"]\nshape = "flat"')
    flat, low, other = load_study(written(tmp_path, "s.toml", text)).assessment.criteria
    np.testing.assert_allclose(flat.limit(np.array([1.0, 4.0, 8.0, 80.0])), 50e-6)
    np.testing.assert_allclose(low.limit(np.array([1.0, 80.0])), 12.5e-6, rtol=1e-2)
    np.testing.assert_allclose(other.limits, find_criterion("NIST-A").limits)


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.toml", TOML.replace("narrow_band", "narow_band"), "must be one of band_rms_velocity"),
        ("a.toml", TOML.replace('"0.02 gal"', '"0.02 um/s"'), "not one of acceleration"),
        ("a.toml", TOML.replace('"0.02 gal"', '"-0.02 gal"'), "greater than 0"),
        ("a.toml", TOML.replace("source", "sauce"), "unknown key 'sauce'"),
        ("a.toml", TOML.replace("[[curve]]", "[curve]"), "holds no criterion"),
        ("a.toml", "curve = 3 4", "a line ends behind its value"),
        ("a.toml", TOML + 'axis = "sideways"', "axis must be one of"),
        ("a.toml", TOML + "aliases = 5", "must be a list of names"),
        ("a.toml", TOML.replace('"1 Hz"', '"-1 Hz"'), "must be above 0"),
        ("b.csv", CSV.replace("[um/s]", ""), "needs its unit in brackets"),
        ("b.csv", CSV.replace("8, 25\n", "8, 25, 7\n"), "two columns"),
        ("b.csv", CSV.replace("8, 25", "x, 25"), "points[2]"),
        ("b.csv", CSV.replace("8, 25", "100, 25"), "frequencies must rise"),
    ],
)
def test_what_is_no_curve_is_refused(tmp_path, name, text, told):
    with pytest.raises(InputError) as error:
        read_criteria(written(tmp_path, name, text))
    assert told in str(error.value)
    assert name in str(error.value)


def test_a_study_is_held_against_them(tmp_path):
    written(tmp_path, "stage.csv", CSV)
    text = GOOD.replace('["VC-A"]', '["VC-A", "stage"]\nfiles = ["stage.csv"]')
    result = run_study(load_study(written(tmp_path, "s.toml", text)))
    (verdicts,) = set(result.verdicts.values())
    assert [v.criterion.name for v in verdicts] == ["VC-A", "stage"]


def test_a_file_that_is_not_there_is_named(tmp_path):
    text = GOOD.replace('["VC-A"]', '["VC-A"]\nfiles = ["none.csv"]')
    with pytest.raises(StudyError, match=r"criteria.files\[1\]"):
        load_study(written(tmp_path, "s.toml", text))


def test_a_point_behind_an_isolator(tmp_path):
    """A tool at the same place, on a spring of 1 Hz: quieter above 2 Hz by its transmissibility."""
    assert GOOD.count("[[point]]") == 1
    at = GOOD[GOOD.index("[[point]]") :].split("\n\n")[0]
    isolated = at.replace('name = "', 'name = "isolated ', 1)
    isolated += '\nisolator = { frequency = "1 Hz", damping = "10 %" }\n\n'
    text = GOOD.replace("[[point]]", isolated + "[[point]]", 1)
    text = text.replace('duration = "4 s"', 'duration = "14 s"')
    study = load_study(written(tmp_path, "s.toml", text))
    (cell,) = run_study(study).cells.values()
    with_it, without = np.median(cell.spectra.values, axis=0)
    mid = cell.spectra.mid_band
    known = cell.spectra.resolved & (mid > 4.0) & (mid < 9.0)  # above, skirts of lower bands count
    assert known.any()
    (isolator,) = study.isolations.values()
    ratio = np.abs(isolator.response(mid[known]))
    np.testing.assert_allclose(with_it[known] / without[known], ratio, rtol=0.1)
    assert np.all(cell.exact.rms() > 0)
    assert cell.exact.rms("acceleration")[0] < cell.exact.rms("acceleration")[1]


@pytest.mark.parametrize(
    "isolator", ['{ frequency = "1 Hz" }', '{ table = [["2 Hz", 1.0], ["1 Hz", 1.0]] }', "{}"]
)
def test_isolators_that_cannot_be(tmp_path, isolator):
    text = GOOD.replace("[[point]]", f"[[point]]\nisolator = {isolator}", 1)
    with pytest.raises(StudyError, match=r"point\[1\].isolator"):
        load_study(written(tmp_path, "s.toml", text))


@pytest.mark.parametrize("suffix", [".csv", ".toml"])
def test_a_pipe_is_not_waited_for(tmp_path, suffix):
    path = tmp_path / f"own{suffix}"
    os.mkfifo(path)
    with pytest.raises(InputError, match="a device or a pipe"):
        read_criteria(path)


def test_what_is_no_toml_is_told_with_its_line(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text('[[curve]]\nname = "x"\npoints = [["1 Hz", "1 um/s"]\n')
    with pytest.raises(InputError, match=r"line 3: a list ends with \]; got 'points"):
        read_criteria(path)


def test_an_endless_field_is_named(tmp_path):
    path = tmp_path / "own.csv"
    path.write_text('# quantity = band_rms_velocity\nfrequency [Hz], "' + "a" * 140_000)
    with pytest.raises(InputError, match="no table of a criterion"):
        read_criteria(path)


LIMITS = {
    "band_rms_velocity": ("0.05 mm/s", 50e-6),
    "band_rms_acceleration": ("0.5 gal", 5e-3),
    "band_rms_displacement": ("0.3 um", 3e-7),
    "band_peak_acceleration": ("2 mm/s2", 2e-3),
    "narrow_band_acceleration": ("1 ug", 9.80665e-6),
    "peak_acceleration": ("1 gal", 1e-2),
    "response_factor": ("4", 4.0),
    "vdv": ("0.4", 0.4),
}


@pytest.mark.parametrize("quantity", LIMITS)
def test_every_quantity_has_its_unit_and_refuses_those_of_others(tmp_path, quantity):
    """1 gal is 0.01 m/s2, 1 g 9.80665 m/s2; a velocity is no acceleration and no length."""
    limit, si = LIMITS[quantity]
    text = TOML.replace("narrow_band_acceleration", quantity)
    mine = text.replace('"0.02 gal"', f'"{limit}"').replace('"0.2 gal"', f'"{limit}"')
    (curve,) = read_criteria(written(tmp_path, "a.toml", mine))
    np.testing.assert_allclose(curve.limits, si)
    assert curve.quantity == quantity
    other = text.replace('"0.02 gal"', '"1 kg"').replace('"0.2 gal"', '"1 kg"')
    with pytest.raises(InputError, match=r"points\[1\]: got '1 kg'; unit 'kg' is not one of"):
        read_criteria(written(tmp_path, "b.toml", other))


@pytest.mark.parametrize("quantity", ["peak_acceleration", "response_factor", "vdv"])
def test_a_single_number_has_one_limit_at_all_frequencies(tmp_path, quantity):
    """Two different ones: nobody knows which a floor is held against."""
    values = ('"1 gal"', '"2 gal"') if quantity == "peak_acceleration" else ("1.0", "2.0")
    text = TOML.replace("narrow_band_acceleration", quantity)
    text = text.replace('"0.02 gal"', values[0]).replace('"0.2 gal"', values[1])
    with pytest.raises(InputError, match="is a single number; all limits must be the same"):
        read_criteria(written(tmp_path, "a.toml", text))


def test_what_a_curve_does_not_say_of_itself_is_said_for_it(tmp_path):
    """Its title is its name, it is vertical, and comes from this file."""
    (curve,) = read_criteria(written(tmp_path, "Hersteller.toml", TOML.replace("source", "#")))
    assert (curve.title, curve.axis) == ("maker A", "vertical")
    assert curve.source == "the user's file Hersteller.toml"
    (said,) = read_criteria(
        written(tmp_path, "a.toml", TOML + 'axis = "Horizontal"\ntitle = "T, <ü>"\n')
    )
    assert (said.title, said.axis, said.source) == ("T, <ü>", "horizontal", "data sheet of maker A")


def test_several_curves_of_a_file_keep_their_order_and_aliases(tmp_path):
    """The second is found by its other name, in any case."""
    second = TOML.replace("maker A", "maker B").replace("0.02", "0.04") + 'aliases = ["Stufe 2"]\n'
    own = read_criteria(written(tmp_path, "a.toml", TOML + second))
    assert [curve.name for curve in own] == ["maker A", "maker B"]
    assert find_criterion("stufe 2", own) is own[1]


@pytest.mark.parametrize(
    "change", [("[[curve]]\n", "[[curve]]\ncolour = 1\n"), ("0.2 gal", "-1 gal")]
)
def test_the_curve_with_the_mistake_is_counted(tmp_path, change):
    """The first is sound; the second is told."""
    text = TOML + TOML.replace("maker A", "maker B").replace(*change)
    with pytest.raises(InputError, match=r"a.toml: curve\[2\]"):
        read_criteria(written(tmp_path, "a.toml", text))


def test_a_table_of_numbers_may_have_marks_of_its_encoding_and_empty_lines(tmp_path):
    """As a spreadsheet writes it; frequencies in kHz and limits in mm/s are converted by column."""
    text = "\ufeff# quantity = band_rms_velocity\r\n\r\nf [kHz] , v [mm/s]\r\n0.001, 0.05\r\n\r\n0.08 ,0.025\r\n"
    (curve,) = read_criteria(written(tmp_path, "Tisch 1.csv", text))
    assert curve.name == "Tisch 1"
    np.testing.assert_allclose(curve.frequencies, [1.0, 80.0])
    np.testing.assert_allclose(curve.limits, [50e-6, 25e-6])


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("# quantity = band_rms_velocity\n", "", "quantity: got ''"),
        ("8, 25\n80, 25\n", "", "two or more rows"),
        ("limit [um/s]", "limit um/s", "heading 'limit um/s' needs its unit"),
        ("[Hz]", "[rad/s]", "cycles, not radians"),
        ("8, 25", "8, nan", r"points\[2\]: got 'nan um/s'"),
        ("8, 25", "8, 0", "greater than 0"),
        ("8, 25", "1, 25", "must rise"),
        ("8, 25", "8; 25", "two columns"),
        ("# title", "# titel", "unknown key 'titel'"),
    ],
)
def test_a_table_that_is_no_limit_is_told_by_its_file(tmp_path, old, new, words):
    """A limit of 0 or of no number would fail or pass everything."""
    assert CSV.count(old) == 1
    with pytest.raises(InputError, match=words) as error:
        read_criteria(written(tmp_path, "b.csv", CSV.replace(old, new)))
    assert "b.csv" in str(error.value)


def test_a_criteria_file_is_at_most_a_megabyte(tmp_path):
    """A record by mistake is not read to its end."""
    path = tmp_path / "a.csv"
    with path.open("wb") as file:
        file.truncate(1_000_001)
    with pytest.raises(InputError, match="at most 1 MB"):
        read_criteria(path)


def test_lines_of_a_table_are_those_of_editors(tmp_path):
    """U+2028 in a title ends no line; the rest of the title would be a row of one column."""
    table = CSV.replace("Maker B, stage", "Maker B\u2028stage")
    assert read_criteria(written(tmp_path, "a.csv", table))[0].title == "Maker B\u2028stage"
