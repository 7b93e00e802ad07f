"""Ways to lose a file of one's own in a results folder: each stops with a message instead."""

import os

import pytest

from trundle.errors import InputError
from trundle.study.store import check_target, new_results_folder


def results(place, kind="study"):
    with new_results_folder(place, kind=kind) as folder:
        (folder / "summary.json").write_text("{}")
        (folder / "figures").mkdir()
        (folder / "figures" / "plan.svg").write_text("<svg/>")
        (folder / "study.toml").write_text("seed = 1")


@pytest.fixture
def place(tmp_path):
    results(tmp_path / "out")
    return tmp_path / "out"


def test_results_may_be_replaced_by_results(place):
    check_target(place)
    results(place)
    assert (place / "summary.json").exists()
    assert [entry.name for entry in place.parent.iterdir()] == ["out"]


@pytest.mark.parametrize(
    "lose",
    [
        lambda place: (place / "figures" / "mine.svg").write_text("mine"),
        lambda place: (place / "study.toml").write_text("seed = 2  # mine"),
        lambda place: (place / "notes").mkdir(),
        lambda place: (place / "link").symlink_to(place.parent),
        lambda place: (place / ".hidden").write_text("mine"),
        lambda place: (place / ".trundle-results").unlink(),
        lambda place: (place / ".trundle-results").write_text("[]"),
    ],
)
def test_what_was_added_or_changed_is_kept(place, lose):
    lose(place)
    before = sorted(str(path) for path in place.rglob("*"))
    with pytest.raises(InputError, match="trundle did not write"):
        check_target(place)
    assert sorted(str(path) for path in place.rglob("*")) == before


def test_what_is_added_while_a_run_is_under_way_is_kept(place):
    check_target(place)
    with (
        pytest.raises(InputError, match="the new results are in") as told,
        new_results_folder(place) as folder,
    ):
        (folder / "summary.json").write_text("new")
        (place / "thesis.tex").write_text("mine")
    assert (place / "thesis.tex").read_text() == "mine"
    beside = str(told.value).rpartition("the new results are in ")[2]
    with open(os.path.join(beside, "summary.json")) as file:
        assert file.read() == "new"


def test_results_of_another_kind_are_kept(place):
    """``assess unit.csv`` does not replace what ``run unit.toml`` left in the same folder."""
    with pytest.raises(InputError, match="holds results of a study"):
        check_target(place, "record")


def test_steps_back_in_a_path_lead_to_the_same_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("o/../o", "./o", "o/"):
        results(type(tmp_path)(name))
        assert sorted(entry.name for entry in tmp_path.iterdir()) == ["o"]
        assert (tmp_path / "o" / "summary.json").exists()
