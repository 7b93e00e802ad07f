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
