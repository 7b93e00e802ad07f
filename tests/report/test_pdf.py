"""Printing: by the browser that is there or that is named, a whole PDF or none."""

import os
import shutil

import pytest

from trundle.errors import ComputationError, InputError
from trundle.report.pdf import find_browser, print_pdf

PAGE = "<!DOCTYPE html><html><body><h1>Größe &lt;b&gt;</h1></body></html>"


def program(folder, text):
    """A program that does what a text of shell says."""
    file = folder / "browser"
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(0o755)
    return str(file)


@pytest.fixture
def page(tmp_path):
    file = tmp_path / "a page.html"
    file.write_text(PAGE, "utf-8")
    return file


def test_a_page_is_printed(page, tmp_path):
    if not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))):
        pytest.skip("no Chromium: apt-get install chromium")
    pdf = print_pdf(page, tmp_path / "out.pdf")
    assert pdf.read_bytes().startswith(b"%PDF-")
    assert sorted(os.listdir(tmp_path)) == ["a page.html", "out.pdf"]


def test_a_browser_that_is_named_is_taken(monkeypatch, tmp_path, page):
    """It gets the page as an address, a profile of its own and no network; what it writes is moved."""
    seen = tmp_path / "seen"
    text = f'printf "%s\\n" "$@" > {seen}\n' + (
        'for a in "$@"; do case "$a" in --print-to-pdf=*) printf "%%PDF-1.4" > "${a#*=}";; esac; done'
    )
    monkeypatch.setenv("TRUNDLE_BROWSER", program(tmp_path, text))
    assert print_pdf(page, tmp_path / "out.pdf").read_bytes() == b"%PDF-1.4"
    given = seen.read_text().splitlines()
    assert given[-1] == page.as_uri()
    assert "--host-resolver-rules=MAP * ~NOTFOUND" in given
    assert any(one.startswith("--user-data-dir=") for one in given)


@pytest.mark.parametrize("text", ["exit 3", "exit 0"])
def test_a_browser_that_prints_nothing_leaves_no_file(monkeypatch, tmp_path, page, text):
    monkeypatch.setenv("TRUNDLE_BROWSER", program(tmp_path, text))
    with pytest.raises(ComputationError, match="gave no PDF"):
        print_pdf(page, tmp_path / "out.pdf")
    assert not (tmp_path / "out.pdf").exists()


def test_without_a_browser_the_ways_out_are_told(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("TRUNDLE_BROWSER", raising=False)
    with pytest.raises(InputError, match="TRUNDLE_BROWSER"):
        find_browser()
    monkeypatch.setenv("TRUNDLE_BROWSER", "nobody")
    with pytest.raises(InputError, match="no such program"):
        find_browser()
