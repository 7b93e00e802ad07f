"""The front of a report: texts, a date, a logo that is a picture, and units that are told apart."""

import datetime as dt

import pytest

import trundle as tr
from studies import GOOD
from trundle.errors import StudyError
from trundle.units import PRINTED, to_si
from trundle.views.words import shown

PNG = b"\x89PNG\r\n\x1a\n" + bytes(20)


def study_with(text, folder="."):
    return tr.study_from_text(GOOD + "\n[report]\n" + text, folder=folder)


def test_without_a_section_units_are_the_usual_ones():
    plan = tr.study_from_text(GOOD).report
    assert plan.heading == ()
    assert [shown(u, plan)[0] for u in ("m/s2", "m/s", "m")] == ["gal", "um/s", "um"]


def test_a_date_may_be_text_or_toml_s_own():
    assert study_with("date = 2026-11-27").report.date == dt.date(2026, 11, 27).isoformat()
    assert study_with('date = "27 November 2026"').report.date == "27 November 2026"


@pytest.mark.parametrize("unit", PRINTED)
def test_printed_units_have_the_sizes_that_study_files_read_them_with(unit):
    """The library of units is another source: 1 in/s2 and the rest, in SI."""
    dimension = {"/s2": "acceleration", "/s": "speed"}.get(unit[unit.find("/") :], "length")
    if unit in {"gal", "mg"}:
        dimension = "acceleration"
    words = {"mg": "0.001 g", "mil/s": "0.001 in/s", "mil": "0.001 in"}.get(unit, f"1 {unit}")
    assert PRINTED[unit] == pytest.approx(to_si(words, dimension), rel=1e-12)


def test_a_logo_is_kept_with_the_study(tmp_path):
    (tmp_path / "logo.png").write_bytes(PNG)
    study = study_with('logo = "logo.png"', tmp_path)
    assert study.files["logo.png"] == PNG


@pytest.mark.parametrize(
    ("data", "rule"),
    [
        (b"<svg onload='alert(1)'/>", "neither a PNG nor a JPEG"),
        (PNG + bytes(1_000_000), "1.0 MB"),
        (None, "cannot be read"),
    ],
)
def test_what_is_no_picture_is_refused(tmp_path, data, rule):
    if data is not None:
        (tmp_path / "logo.png").write_bytes(data)
    with pytest.raises(StudyError, match=rule):
        study_with('logo = "logo.png"', tmp_path)


def test_every_wrong_unit_is_told_at_once():
    with pytest.raises(StudyError) as caught:
        study_with('acceleration = "furlong"\nvelocity = "kn"\nload = "lb"')
    assert {p.place for p in caught.value.problems} == {
        "report.acceleration",
        "report.velocity",
        "report.load",
    }
