"""Examples that the manual's build runs: once for what they are, with what they say; who runs the others."""

import re
from pathlib import Path

import pytest

pytest.importorskip("sphinx")

import example_runs
import gallery

import trundle as tr
from studies import GOOD, MAP
from trundle.views.conclusions import concluded, conclusion_of_all

ROOT = Path(__file__).parents[2]
SHORT = GOOD.replace('duration = "4 s"', 'duration = "2 s"')


def example_in(folder, text=SHORT):
    folder.mkdir()
    (folder / "study.toml").write_text(text, "utf-8")
    return folder


def no_run(*_):
    raise AssertionError("it was run again")


def test_every_example_is_run_by_the_build_or_says_by_what():
    quick, others = set(example_runs.QUICK), set(example_runs.NOT_HERE)
    names = {folder.name for folder in gallery.examples()}
    assert not quick & others
    assert quick | others | {"clusters"} == names  # whose files start a study elsewhere
    for name in quick:
        assert (ROOT / "examples" / name / "study.toml").exists()


def test_all_studies_are_run_where_that_is_asked_for(monkeypatch):
    """Quick ones always; clusters and a script, which are no studies, never."""
    folders = list(gallery.examples())
    monkeypatch.delenv("GALLERY", raising=False)
    assert {one.name for one in folders if example_runs.runs_here(one)} == set(example_runs.QUICK)
    monkeypatch.setenv("GALLERY", "all")
    not_run = {one.name for one in folders if not example_runs.runs_here(one)}
    assert not_run == {"clusters", "quick_start"}


@pytest.mark.parametrize("name", example_runs.NOT_HERE)
def test_what_runs_another_example_names_it(name):
    said = example_runs.NOT_HERE[name]
    files = re.findall(r"`(tests/\S+\.py)`", said)
    texts = [(ROOT / file).read_text("utf-8") for file in files]
    if "make demo" in said:
        texts.append((ROOT / "Makefile").read_text("utf-8"))
    assert texts
    assert all(name in text for text in texts)


def test_an_example_is_run_once_until_it_changes(tmp_path, monkeypatch):
    """The sentence and the picture are those of its result; a byte more in its file, and it is run again."""
    folder, kept = example_in(tmp_path / "one"), tmp_path / "kept"
    found = example_runs.outcome_of(folder, kept)
    result = tr.run_study(tr.study_from_text(SHORT))
    assert found.sentence == conclusion_of_all(concluded(result))
    assert found.sentence.startswith("tool: VC-A")
    assert found.runs == 2
    assert found.title == "Velocity spectra at tool against criteria, class B"
    assert "VC-A" in found.picture.read_text("utf-8")
    monkeypatch.setattr(example_runs.trundle, "run_study", no_run)
    assert example_runs.outcome_of(folder, kept) == found
    with (folder / "study.toml").open("a", encoding="utf-8") as file:
        file.write("# more\n")
    with pytest.raises(AssertionError, match="run again"):
        example_runs.outcome_of(folder, kept)


def test_another_version_runs_it_again(tmp_path, monkeypatch):
    folder = example_in(tmp_path / "one")
    before = example_runs.content_of(folder)
    monkeypatch.setattr(example_runs.trundle, "__version__", "99.0")
    assert example_runs.content_of(folder) != before


def test_a_run_that_stopped_half_way_is_done_again(tmp_path, monkeypatch):
    """A picture without its sentence is none."""
    folder, kept = example_in(tmp_path / "one"), tmp_path / "kept"
    kept.mkdir()
    (kept / f"one-{example_runs.content_of(folder)}.svg").write_text("<svg/>")
    monkeypatch.setattr(example_runs.trundle, "run_study", no_run)
    with pytest.raises(AssertionError, match="run again"):
        example_runs.outcome_of(folder, kept)


def test_a_study_with_a_map_shows_its_classes_on_the_plan(tmp_path):
    found = example_runs.outcome_of(example_in(tmp_path / "one", SHORT + MAP), tmp_path / "kept")
    drawn = found.picture.read_text("utf-8")
    assert "worst: " in drawn
    assert "class" in found.title.lower()


def test_an_entry_says_what_came_out_or_who_runs_it(monkeypatch, tmp_path):
    picture = tmp_path / "a.svg"
    picture.write_text("<svg/>")
    monkeypatch.setattr(gallery, "GENERATED", tmp_path)
    outcome = example_runs.Outcome(picture=picture, title="Levels", sentence="tool: met.", runs=7)
    monkeypatch.setattr(gallery, "outcome_of", lambda _: outcome)
    quick = "\n".join(gallery._outcome(ROOT / "examples" / example_runs.QUICK[0]))
    assert f"![Levels](gallery/{example_runs.QUICK[0]}-result.svg)" in quick
    assert "**Run by this build**, 7 runs a case: tool: met." in quick
    assert (tmp_path / "gallery" / f"{example_runs.QUICK[0]}-result.svg").exists()
    other = "\n".join(gallery._outcome(ROOT / "examples" / "hospital"))
    assert other.startswith("Not run by this build: `tests/examples/test_buildings.py`")
