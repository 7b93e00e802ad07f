"""Pages of records, of people who walk and of what would help, in the units that are asked for.

Numbers are turned by hand: an inch has 25.4 mm, a thousandth of gravity 9.80665 mm/s2.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from hand_made import Page, result_of, study_of
from test_footfall_figures import found_of
from test_mitigation_figures import by_place, sweep_of
from test_record_page import TIME, record_of

from trundle.criteria import find_criterion
from trundle.records.assess import assess_record
from trundle.report import write_mitigation_report, write_record_report
from trundle.report.figures import footfall, record
from trundle.report.pages.footfall import write_footfall
from trundle.report.pages.record import record_page
from trundle.report.pages.study import _render
from trundle.study import ReportPlan
from trundle.views.footfall import worst_rows

INCHES = ReportPlan(velocity="in/s", acceleration="in/s2")
USUAL_UNITS = re.compile(r"\b(um/s|gal)\b")
ASKED = '\n[report]\nacceleration = "{}"\nvelocity = "in/s"\n'


@pytest.fixture(scope="module")
def result():
    curves = [find_criterion(name) for name in ("VC-A", "VC-B", "VC-E")]
    return assess_record(record_of(), curves)


@pytest.fixture(scope="module")
def folder(result, tmp_path_factory):
    """A record's folder in inches."""
    place = tmp_path_factory.mktemp("inches")
    write_record_report(result, place, report=INCHES)
    return place


def words_of(folder):
    """All that is read on pages and figures of a folder, by file."""
    return {
        path.name: re.sub(r"base64,[^\"]*", "", path.read_text("utf-8"))
        for path in [*folder.rglob("*.html"), *folder.rglob("*.svg")]
    }


def test_a_record_in_inches_has_no_other_unit_on_page_and_figures(folder):
    """Every drawing says its unit in words that are looked for, as those of the usual page do."""
    found = words_of(folder)
    assert len(found) == 7
    assert [name for name, text in found.items() if USUAL_UNITS.search(text)] == []
    assert all("in/s" in text for text in found.values())


def test_numbers_of_a_page_in_inches_are_those_of_a_hand(folder, result):
    """40 um/s at 10 Hz: a = 2 pi 10 x 40e-6 m/s2 = 0.0989 in/s2; RMS of the samples over 25.4 mm/s."""
    page = Page((folder / "report.html").read_text("utf-8"))
    numbers = page.rows("numbers")[0]
    assert float(numbers["peak acceleration [in/s2]"]) == pytest.approx(0.0989, rel=0.02)
    rms = np.sqrt(np.mean(result.record.samples[0] ** 2)) / 25.4e-3
    assert float(numbers["record RMS velocity [in/s]"]) == pytest.approx(rms, rel=0.02)


def test_limits_stand_in_the_units_of_the_page():
    """VC-A is 50 um/s at 8 Hz, 1.969e-3 in/s; 0.3 gal are 3 / 25.4 in/s2. No title has a unit."""
    curves = [find_criterion(name) for name in ("VC-A", "0.3 gal")]
    text = record_page(assess_record(record_of(), curves), [], INCHES)
    assert [row["limit"] for row in Page(text).rows("criteria")] == [
        "0.003937 in/s at 4 Hz, 0.001969 in/s at 8 Hz, 0.001969 in/s at 80 Hz", "0.1181 in/s2",
    ]  # fmt: skip
    assert not USUAL_UNITS.search(text)
    study = study_of(ASKED.format("in/s2"), ('curves = ["VC-A"]', 'curves = ["VC-A", "0.3 gal"]'))
    page = Page(_render(result_of(study), []))
    (table,) = [t for t in page.tables["inputs"] if t[0][0] == "criterion"]
    assert [row[1] for row in table[1:]] == [row["limit"] for row in Page(text).rows("criteria")]
    assert not USUAL_UNITS.search(page.said("verdict"))


def test_an_event_is_told_in_inches():
    """4 s of 40 um/s amid a hundredth of it: 40 / sqrt 2 = 28.28 um/s are 1.1135e-3 in/s."""
    gate = np.where((TIME >= 6.0) & (TIME < 10.0), 1.0, 0.01)
    samples = np.array([40e-6 * gate * np.sin(20.0 * np.pi * TIME)] * 2)
    some = assess_record(replace(record_of(), samples=samples), [find_criterion("VC-B")])
    event = Page(record_page(some, [], INCHES)).rows("events")[0]
    assert float(event["largest running level [in/s]"]) == pytest.approx(1.1135e-3, rel=0.05)


def test_files_for_programs_keep_the_units_that_they_name(folder, result, tmp_path):
    """CSV and JSON are the same bytes whatever people read."""
    write_record_report(result, tmp_path)
    names = [path.name for path in folder.iterdir() if path.suffix in {".csv", ".json"}]
    assert len(names) == 6
    for name in names:
        assert (folder / name).read_bytes() == (tmp_path / name).read_bytes()


def test_drawings_of_a_record_are_in_their_unit_with_their_curves(result):
    """VC-A is 50 um/s, 1.969e-3 in/s; a PSD of 1 (um/s)2/Hz is one of 1550e-12 (in/s)2/Hz."""
    drawn = {d.name: d.draw().axes for d in record.drawings(result, INCHES)}
    usual = {d.name: d.draw().axes for d in record.drawings(result)}
    for name in ("spectra", "percentiles"):
        (curve, *_) = [line for line in drawn[name][0].lines if line.get_color() == "black"]
        assert curve.get_ydata()[-1] == pytest.approx(50.0 / 25400.0)
    for name, factor in {
        "spectra": 25400.0, "percentiles": 25400.0, "running": 25400.0, "psd": 25400.0**2,
        "history": 25400.0,
    }.items():  # fmt: skip
        mine, other = (line_of(axes) for axes in (drawn[name][0], usual[name][0]))
        np.testing.assert_allclose(factor * mine, other, rtol=1e-6)  # levels are singles
    mine, other = (axes[0].collections[0] for axes in (drawn["spectrogram"], usual["spectrogram"]))
    np.testing.assert_allclose(25400.0 * mine.get_array(), other.get_array(), rtol=1e-6)
    acceleration = drawn["history"][1].lines[0].get_ydata()
    np.testing.assert_allclose(2.54 * acceleration, usual["history"][1].lines[0].get_ydata())


def line_of(axes):
    """Heights of the first line that is no criterion's."""
    return next(np.asarray(x.get_ydata()) for x in axes.lines if x.get_color() != "black")


def test_people_who_walk_are_told_in_the_study_s_acceleration(tmp_path):
    """0.04 m/s2 are 4.08 mg, on the map and on the screen; in the table they stay what they are."""
    study = study_of(ASKED.format("mg"))
    found = found_of(study, 3.0, np.linspace(0.005, 0.04, 8), guide="dg11")
    panel, bar = next(footfall.drawings(found)).draw().axes
    assert panel.get_title().startswith("largest 4.08 at")
    assert bar.get_xlabel().startswith("peak acceleration [mg], ")
    assert float(panel.collections[0].get_array().max()) == pytest.approx(40.0 / 9.80665)
    assert next(worst_rows(found))[1] == "4.08"
    write_footfall(found, tmp_path)
    head, *rows = (tmp_path / "footfall.csv").read_text("utf-8").splitlines()
    assert "peak_acceleration_m_s2" in head
    assert float(rows[-1].split(",")[3]) == 0.04
    assert "m/s2" not in words_of(tmp_path)["footfall_map.svg"]


@pytest.mark.parametrize(("asked", "unit"), [("gal", "gal"), (None, "m/s2")])
def test_only_a_unit_that_is_asked_for_changes_what_guides_are_told_in(asked, unit):
    """Reports are in gal unless they say so, guides in m/s2: a study that says gal has gal of both."""
    study = study_of(ASKED.format(asked) if asked else "")
    found = found_of(study, 3.0, 0.04, guide="dg11")
    assert next(worst_rows(found))[1] == {"gal": "4", "m/s2": "0.04"}[unit]
    _, bar = next(footfall.drawings(found)).draw().axes
    assert bar.get_xlabel().startswith(f"peak acceleration [{unit}], ")


def test_a_response_factor_has_no_unit_whatever_is_asked_for():
    found = found_of(study_of(ASKED.format("mg")), 3.0, 4.0)
    _, bar = next(footfall.drawings(found)).draw().axes
    assert bar.get_xlabel().startswith("response factor, ")
    assert next(worst_rows(found))[1] == "4"


def test_what_would_help_is_told_without_a_unit_of_motion(tmp_path):
    """Margins and classes have none: the page is the same in inches, but for the study's hash."""
    texts = []
    for name, text in (("inches", ASKED.format("in/s2")), ("usual", "")):
        sweep = sweep_of(["as it is", "slab"], by_place, text=text)
        sweep = replace(sweep, study=replace(sweep.study, content_hash="same"))
        (tmp_path / name).mkdir()
        write_mitigation_report(sweep, tmp_path / name)
        texts.append(words_of(tmp_path / name))
    assert texts[0] == texts[1]
    assert not any(USUAL_UNITS.search(text) for text in texts[0].values())
