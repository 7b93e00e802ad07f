"""What a building answers is kept, and believed only if it answers."""

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.results.kept import read_kept, write_kept
from trundle.run import answering as run_answering
from trundle.run.answering import answers_to_jobs
from trundle.run.jobs import plan_jobs

TEXT = BUILDING + "\n[parts]\nnodes = 100\nband = 4\nresponse_tolerance = 0.02\n"


def answers(text=TEXT):
    study = tr.study_from_text(text)
    return answers_to_jobs(study.floor, plan_jobs(study), f_max=60.0)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A folder where answers are kept, and the answers."""
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRUNDLE_CACHE", str(folder))
        return folder, answers()


@pytest.fixture
def nobody_solves(kept, monkeypatch):
    """The folder; who finds answers again says so."""
    monkeypatch.setenv("TRUNDLE_CACHE", str(kept[0]))

    def refuse(*_, **__):
        raise RuntimeError("found again")

    monkeypatch.setattr(run_answering, "answering_modes", refuse)
    return kept[0]


def file_of(folder):
    (file,) = (folder / "answers").glob("*.npz")
    return file


def test_kept_answers_are_the_same_bits_and_words(kept, nobody_solves):
    again = answers()
    assert again.omega.tobytes() == kept[1].omega.tobytes()
    assert again.shapes.tobytes() == kept[1].shapes.tobytes()
    np.testing.assert_array_equal(again.residuals, kept[1].residuals)
    assert again.answering == kept[1].answering
    assert "in place of the" in again.answering


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("response_tolerance = 0.02", "response_tolerance = 0.03"),
        ('ratio = "3 %"', 'ratio = "4 %"'),
        ("nodes = 100", "nodes = 110"),
        ('superimposed_mass = "100 kg/m2"', 'superimposed_mass = "101 kg/m2"'),
    ],
)
def test_what_asks_for_something_else_finds_it_itself(nobody_solves, old, new):
    """Another tolerance, damping, cut or mass."""
    assert old in TEXT
    with pytest.raises(RuntimeError, match="found again"):
        answers(TEXT.replace(old, new))


def test_another_place_is_another_question(nobody_solves):
    """A point moved by a metre reads other rows."""
    text = TEXT.replace('at = ["4 m", "3 m"]', 'at = ["5 m", "3 m"]')
    assert text != TEXT
    with pytest.raises(RuntimeError, match="found again"):
        answers(text)


def spoil_shape(arrays):
    arrays["shapes"][3, 2] += np.abs(arrays["shapes"]).max()


def spoil_omega(arrays):
    arrays["omega"][4] *= 1.001


def lose_some(arrays):
    """All that is left is right, but does not answer."""
    arrays["omega"], arrays["shapes"] = arrays["omega"][10:], arrays["shapes"][:, 10:]


def count_wrong(arrays):
    arrays["n_below"] = arrays["n_below"] + 1


def boast(arrays):
    arrays["error"] = np.array(0.5)


def no_number(arrays):
    arrays["shapes"][0, 0] = np.nan


def forget(arrays):
    del arrays["omega"]


@pytest.mark.parametrize(
    "spoil", [spoil_shape, spoil_omega, lose_some, count_wrong, boast, no_number, forget]
)
def test_what_does_not_answer_is_not_believed(nobody_solves, spoil):
    """Each with the checksum of what it is: as whoever knows how may write."""
    file = file_of(nobody_solves)
    before = file.read_bytes()
    arrays, _ = read_kept(file, file.stem)
    spoil(arrays)
    try:
        write_kept(file, arrays, file.stem)
        with pytest.raises(RuntimeError, match="found again"):
            answers()
    finally:
        file.write_bytes(before)


def test_a_damaged_file_is_not_believed(nobody_solves):
    file = file_of(nobody_solves)
    before = file.read_bytes()
    try:
        file.write_bytes(before[:-100] + bytes(100))
        with pytest.raises(RuntimeError, match="found again"):
            answers()
    finally:
        file.write_bytes(before)


def test_nothing_is_kept_where_keeping_is_switched_off(monkeypatch, tmp_path):
    monkeypatch.setenv("TRUNDLE_CACHE", "")
    monkeypatch.chdir(tmp_path)
    answers()
    assert not list(tmp_path.iterdir())
