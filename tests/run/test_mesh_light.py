"""Whether results have settled: levels on a mesh twice as coarse, and what is said of it."""

from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.errors import InputError
from trundle.results.mesh_change import MeshChange, mesh_warnings, mesh_words
from trundle.run.tasks import ExactTask

CRITERIA = '\n[criteria]\nmethod = "coupled"\ncurves = ["VC-A"]\n'


@pytest.fixture(scope="module")
def result():
    return tr.run_study(tr.study_from_text(BUILDING + CRITERIA))


def test_the_coarse_mesh_is_twice_the_studys_and_both_are_its_levels(result):
    """Levels of the study's own mesh are those of its cells; the coarse ones are its own study's."""
    change = result.mesh
    assert change.sizes == (3.0, 1.5)
    (cell,) = result.cells.values()
    there = np.isfinite(change.levels[1, 0, 0])
    own = np.sqrt(np.mean(cell.spectra.values[:2, 0] ** 2, axis=0))
    np.testing.assert_allclose(change.levels[1, 0, 0, there], own[there], rtol=1e-12)
    coarse = tr.run_study(replace(result.study.meshed(2.0), building=None))
    (other,) = coarse.cells.values()
    own = np.sqrt(np.mean(other.spectra.values[:2, 0] ** 2, axis=0))
    np.testing.assert_allclose(change.levels[0, 0, 0, there], own[there], rtol=1e-9)
    np.testing.assert_allclose(change.frequencies[0], coarse.modes.frequencies[:8], rtol=1e-9)


def test_exact_statistics_are_for_the_studys_own_mesh_alone(monkeypatch):
    """They take most of the time of a few runs, and only levels of runs are compared."""
    asked = []
    compute = ExactTask.compute
    monkeypatch.setattr(
        ExactTask, "compute", lambda task, *rest: asked.append(task.name) or compute(task, *rest)
    )
    found = tr.run_study(tr.study_from_text(BUILDING + CRITERIA))
    assert found.mesh is not None
    (cell,) = found.cells.values()
    assert cell.exact is not None
    assert len(asked) == 1


def test_what_a_coarser_mesh_changes_stands_in_the_report_and_is_read_back(result, tmp_path):
    tr.save(result, tmp_path / "out")
    words = mesh_words(result.mesh)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert words in page.replace("&#39;", "'")
    again = tr.read_results(tmp_path / "out")
    assert mesh_words(again.mesh) == words
    np.testing.assert_array_equal(again.mesh.levels, result.mesh.levels)


def change_of(frequencies=(5.0, 5.0), levels=(1.0, 1.0)):
    """One mode, one case, one point; three bands of which the last is a whisper."""
    both = np.array([[[[level, 0.5, 0.01]]] for level in levels])
    both[0, 0, 0, 2] = 1.0  # a hundred times off, and a hundredth of the loudest
    return MeshChange(
        sizes=(2.0, 1.0),
        frequencies=np.array(frequencies)[:, None],
        cases=("aisle",),
        points=("tool",),
        bands=np.array([4.0, 8.0, 16.0]),
        levels=both,
    )


@pytest.mark.parametrize(
    ("change", "settled"),
    [
        (change_of(), True),
        (change_of(levels=(1.09, 1.0)), True),
        (change_of(levels=(1.11, 1.0)), False),
        (change_of(levels=(0.89, 1.0)), False),
        (change_of(frequencies=(5.14, 5.0)), True),
        (change_of(frequencies=(5.16, 5.0)), False),
    ],
)
def test_as_much_as_the_change_may_be_left(change, settled):
    """Errors that go with h, as round columns under flat slabs: (2 - 1) e from 2 h to h, e at h.

    10 % of a level, 3 % of a mode.
    """
    assert (mesh_warnings(change) == ()) is settled


def test_words_name_the_band_that_changes_most():
    words = mesh_words(change_of(levels=(1.31, 1.0)))
    assert "31 % (aisle, tool, 4 Hz)" in words
    assert "elements of 2 m to 1 m" in words
    (warning,) = mesh_warnings(change_of(levels=(1.6, 1.0)))
    assert "below 1.6 is relied on" in warning.message


def test_a_floor_of_bays_is_not_looked_at_unasked():
    from studies import GOOD

    assert tr.run_study(tr.study_from_text(GOOD)).mesh is None


def fails(*_):
    raise InputError("no mesh fits")


def test_a_coarse_mesh_that_cannot_be_made_is_told_and_leaves_what_is_computed(monkeypatch):
    """Elements twice as large may find no room: levels stand, and nobody has looked."""
    monkeypatch.setattr("trundle.run.mesh_light.few_runs", fails)
    found = tr.run_study(tr.study_from_text(BUILDING + CRITERIA))
    assert found.mesh is None
    assert len(found.cells) == 1
    told = [w.message for some in found.warnings().values() for w in some if w.subject == "mesh"]
    assert len(told) == 1
    assert "was not looked at" in told[0]


def test_a_study_by_time_steps_is_looked_at_too():
    """Without modes there are levels to compare, and no frequencies."""
    steps = (
        'integration = "newmark"\ndamping = { rayleigh_alpha = "1 1/s", rayleigh_beta = "0.1 ms" }'
    )
    head, tail = (BUILDING + CRITERIA).split('integration = "modal"')
    text = head + steps + '\ndt = "5 ms"' + tail[tail.index("\nentry") :]
    change = tr.run_study(tr.study_from_text(text)).mesh
    assert change.frequencies.shape == (2, 0)
    assert np.isfinite(change.levels).any()
