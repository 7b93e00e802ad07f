"""Workbooks: the numbers of the results, texts that stay texts, and a library that may be missing."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from hand_made import result_of, study_of

from trundle.errors import InputError
from trundle.report.workbook import check_workbooks, write_workbook
from trundle.study.report_plan import ReportPlan

CURVES = ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-B"]')


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    """Flat 10 um/s at a point whose name would be a formula, read back by the library."""
    openpyxl = pytest.importorskip("openpyxl")
    study = study_of("", CURVES, ('name = "tool"', 'name = "@SUM tool"'))
    study = replace(study, report=ReportPlan(client="=1+1", velocity="mm/s"))
    file = write_workbook(result_of(study, 1e-5), tmp_path_factory.mktemp("book") / "t.xlsx")
    return openpyxl.load_workbook(file)


def rows(sheet):
    head, *rest = [[cell.value for cell in row] for row in sheet.iter_rows()]
    return [dict(zip(head, row, strict=True)) for row in rest]


def test_every_table_has_a_sheet_with_a_heading_that_stays(book):
    assert book.sheetnames == ["About", "Conclusion", "Lights", "Verdicts", "Levels", "Bands"]
    assert all(sheet.freeze_panes == "A2" for sheet in book)


def test_no_cell_is_a_formula(book):
    kinds = {cell.data_type for sheet in book for row in sheet.iter_rows() for cell in row}
    assert "f" not in kinds
    about = {row["what"]: row["value"] for row in rows(book["About"])}
    assert about["Client"] == "=1+1"


def test_numbers_are_numbers_by_hand(book):
    """95 % of 0.5, 1, 4 times 10 um/s is 37: margins 50/37 and 25/37; bands in mm/s."""
    first, second = rows(book["Verdicts"])
    np.testing.assert_allclose([first["margin"], second["margin"]], [50 / 37, 25 / 37], rtol=1e-12)
    assert (first["status"], second["status"]) == ("pass", "fail")
    (one, *_) = rows(book["Bands"])
    np.testing.assert_allclose(one["v 50 % [mm/s]"], 0.01, rtol=1e-12)
    np.testing.assert_allclose(one["v 95 % [mm/s]"], 0.037, rtol=1e-12)
    assert len(rows(book["Bands"])) == 20  # bands from 1 to 80 Hz


def test_what_is_not_resolved_is_not_among_the_bands(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    result = result_of(study_of("", CURVES), 1e-5, shown_to=35.0)
    book = openpyxl.load_workbook(write_workbook(result, tmp_path / "t.xlsx"))
    assert [row["band [Hz]"] for row in rows(book["Bands"])][-1] == 31.5


def test_without_the_library_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(InputError, match=r"trundle\[xlsx\]"):
        check_workbooks()
