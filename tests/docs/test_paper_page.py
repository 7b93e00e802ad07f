"""The manual's page of the paper: every printed number stands beside ours, with their difference."""

import json
import re
import tomllib

import pytest

pytest.importorskip("sphinx")

import paper_page

STUDY = tomllib.loads(paper_page._STUDY.read_text("utf-8"))
KEPT = json.loads(paper_page._KEPT.read_text("utf-8"))


@pytest.fixture
def tables(tmp_path, monkeypatch):
    """Rows of the tables of the page by the headings above them."""
    monkeypatch.setattr(paper_page, "GENERATED", tmp_path)
    paper_page.write_paper()
    text = (tmp_path / "paper.md").read_text("utf-8")
    found = {}
    for heading, body in re.findall(r"^### (.+?)\n(.*?)(?=^##|\Z)", text, re.M | re.S):
        rows = [line.strip("| ").split(" | ") for line in body.splitlines() if line[:2] == "| "]
        found[heading] = rows[1:]
    return found


def test_every_printed_number_stands_there(tables):
    """16 cells and 10 bounds, of peak and RMS; an absolute maximum has two rules."""
    assert [len(rows) for rows in tables.values()] == [16, 16, 14, 14]
    for heading, key in (
        ("Peak acceleration [gal]", "peak_acceleration"),
        ("RMS velocity [um/s]", "rms_velocity"),
    ):
        cells = [(row[0], row[1], row[2], row[3]) for row in tables[f"Table 2: {heading}"]]
        assert cells == [
            (p["case"], p["road"], p["method"], p[key].split()[0]) for p in STUDY["printed"]
        ]
        bounds = {(row[0], row[2], row[3], row[4]) for row in tables[f"Table 3: {heading}"]}
        assert bounds == {
            (p["bound"], p["road"], p["method"], p[key].split()[0]) for p in STUDY["printed_bound"]
        }


def test_a_difference_is_that_of_the_numbers_in_its_row(tables):
    for heading, rows in tables.items():
        for row in rows:
            theirs, ours = (
                float(x) for x in ((row[3], row[4]) if "Table 2" in heading else (row[4], row[5]))
            )
            told = float(row[6].removesuffix(" %"))
            assert told == pytest.approx(100.0 * (ours / theirs - 1.0), rel=0.01, abs=0.6)


def test_ours_are_those_of_the_kept_run_and_nothing_else(tables, tmp_path, monkeypatch):
    """Ten times the median of a cell: its row says so, and no other row moves."""
    other = json.loads(json.dumps(KEPT))
    (cell,) = [
        r for r in other["cells"] if (r["case"], r["road"], r["method"]) == ("rear", "B", "coupled")
    ]
    cell["rms"][1] = 494.2
    file = tmp_path / "other.json"
    file.write_text(json.dumps(other), "utf-8")
    monkeypatch.setattr(paper_page, "_KEPT", file)
    paper_page.write_paper()
    text = (tmp_path / "paper.md").read_text("utf-8")
    assert "| rear | B | coupled | 49.42 | 494 | " in text
    assert " | +900 % | " in text
    lines = {" | ".join(row) for rows in tables.values() for row in rows}
    now = {line.strip("| ") for line in text.splitlines() if line[:2] == "| "}
    assert len(lines - now) == 1


def test_a_printed_number_in_another_unit_is_refused():
    with pytest.raises(ValueError, match="neither in gal nor in um/s"):
        paper_page._number("3 mm/s")


def test_its_notes_are_those_of_the_study(tables, tmp_path):
    text = (tmp_path / "paper.md").read_text("utf-8")
    for title in paper_page._SAID:
        (note,) = [one["text"] for one in STUDY["note"] if one["title"] == title]
        assert note in text
    assert str(KEPT["study_hash"]) in text
    assert "make demo" in text
