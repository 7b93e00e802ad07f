"""The report of results again: page, PDF and workbook, with another heading; results stay as they are."""

import pytest

import trundle as tr
from studies import GOOD
from trundle.cli import report_command
from trundle.cli.report_command import Wanted
from trundle.errors import InputError


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("again") / "unit"
    tr.run_study(tr.study_from_text(GOOD), folder)
    return folder


def everything(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_the_page_is_drawn_again_byte_by_byte(results, tmp_path, capsys):
    before = everything(results)
    report_command.report(results, tmp_path / "new", Wanted())
    again = tmp_path / "new-report" / "report.html"
    assert again.read_bytes() == before["report.html"]
    assert str(again) in capsys.readouterr().out
    assert everything(results) == before


def test_another_heading_stands_on_the_page_alone(results, tmp_path):
    before = everything(results)
    heading = {"client": "<b>Client & Co", "revision": "C"}
    report_command.report(results, tmp_path / "new", Wanted(heading=heading), quiet=True)
    text = (tmp_path / "new-report" / "report.html").read_text("utf-8")
    assert "&lt;b&gt;Client &amp; Co" in text
    assert everything(results) == before


def test_a_workbook_and_nothing_else(results, tmp_path):
    pytest.importorskip("openpyxl")
    report_command.report(results, tmp_path / "new", Wanted(xlsx=True), quiet=True)
    assert [p.name for p in tmp_path.iterdir()] == ["new-tables.xlsx"]


def test_a_pdf_is_printed_from_the_page_that_is_there(results, tmp_path, monkeypatch):
    """The browser gets the page of the results, which are not drawn again."""
    printed = []
    monkeypatch.setattr(report_command, "find_browser", lambda: "browser")
    monkeypatch.setattr(
        report_command, "print_pdf", lambda page, pdf: (printed.append(page), pdf.touch())
    )
    report_command.report(results, tmp_path / "new", Wanted(pdf=True), quiet=True)
    assert printed == [(results / "report.html").resolve()]


@pytest.mark.parametrize("text", ["two\nlines", "x" * 101])
def test_a_heading_that_is_no_line_is_refused(results, tmp_path, text):
    with pytest.raises(InputError, match="--job"):
        report_command.report(results, tmp_path / "new", Wanted(heading={"job": text}), quiet=True)
    assert list(tmp_path.iterdir()) == []


def test_what_holds_no_results_is_refused(tmp_path):
    with pytest.raises(InputError, match="no results"):
        report_command.report(tmp_path, tmp_path / "new", Wanted(), quiet=True)
