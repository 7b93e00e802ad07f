"""What answers to a study in place of all modes: the same levels, said so, whoever computes it."""

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.run import answering as run_answering
from trundle.run.answering import answers_to_jobs, asks_for_answers
from trundle.run.dask_cluster import local_cluster
from trundle.run.jobs import plan_jobs

ASSESSED = (
    BUILDING + '\n[criteria]\nmethod = "coupled"\ncurves = ["VC-A"]\n[map]\nspacing = "2 m"\n'
)
ALL = "\n[parts]\nnodes = 100\nband = 4\n"
ANSWERING = ALL + "response_tolerance = 0.02\n"


@pytest.fixture(scope="module")
def both():
    """The study with all modes and with what answers."""
    return [tr.run_study(tr.study_from_text(ASSESSED + parts)) for parts in (ALL, ANSWERING)]


def test_levels_are_those_of_all_modes(both):
    """Bands that the method resolves, every run and point; maps at every place."""
    for key, cell in both[0].cells.items():
        other = both[1].cells[key]
        shown = cell.spectra.resolved & cell.coverage.excites(cell.spectra.mid_band)
        assert shown.any()
        ours, theirs = (np.asarray(c.spectra.values)[..., shown] for c in (other, cell))
        loudest = theirs.max(axis=-1, keepdims=True)
        assert np.all(np.abs(ours - theirs) <= 0.03 * np.maximum(theirs, 0.03 * loudest))
    assert both[0].maps
    for key, drawn in both[0].maps.items():
        other = both[1].maps[key]
        assert len(drawn.numbers) > 0
        for name, values in drawn.numbers.items():
            np.testing.assert_allclose(other.numbers[name], values, rtol=0.03)


def test_results_say_what_stands_for_the_modes(both):
    """A doubt with both counts and the error; no pictures of modes that are none."""
    (cell,) = both[1].cells.values()
    (told,) = [doubt.message for doubt in cell.warnings if doubt.subject == "answers"]
    n_modes = both[0].modes.n_modes
    assert f"in place of the {n_modes} modes below" in told
    assert told.endswith("without response_tolerance")  # so few modes cost less
    assert both[1].modes is None
    assert not [doubt for doubt in both[0].cells[cell.key].warnings if doubt.subject == "answers"]


def test_answers_have_the_same_bits_whoever_solves(monkeypatch):
    """Two threads or one, all frequencies of a round at once or two by two."""
    study = tr.study_from_text(ASSESSED + ANSWERING)
    assert asks_for_answers(study.floor)
    jobs, found = plan_jobs(study), []
    for threads, at_once in (("1", 1e9), ("2", 1e9), ("2", 1.0)):
        monkeypatch.setenv("TRUNDLE_THREADS", threads)
        monkeypatch.setattr(run_answering, "_AT_ONCE", at_once)
        modes = answers_to_jobs(study.floor, jobs, f_max=60.0)
        found.append((modes.omega.tobytes(), modes.shapes.tobytes(), modes.answering))
    assert found[0] == found[1] == found[2]


@pytest.mark.longest
def test_answers_have_the_same_bits_by_workers():
    study = tr.study_from_text(ASSESSED + ANSWERING)
    jobs = plan_jobs(study)
    here = answers_to_jobs(study.floor, jobs, f_max=60.0)
    with local_cluster(2) as cluster:
        there = answers_to_jobs(study.floor, jobs, f_max=60.0, executor=cluster)
    assert there.shapes.tobytes() == here.shapes.tobytes()


def test_the_least_damped_material_decides_how_close_frequencies_lie():
    """What has no ratio of its own takes the method's; the smallest of all counts."""
    by_material = 'damping = { ratio = "3 %", by_material = true }'
    text = (ASSESSED + ANSWERING).replace('damping = { ratio = "3 %" }', by_material)
    omega = np.array([10.0, 100.0])
    for own, least in (("0.5 %", 0.005), ("5 %", 0.03)):
        damped = f'density = "2500 kg/m3"\ndamping_ratio = "{own}"'
        study = tr.study_from_text(text.replace('density = "2500 kg/m3"', damped))
        for job in plan_jobs(study):
            damping = job.method.interaction.damping
            found = run_answering._least_ratios(study.floor, damping, omega)
            np.testing.assert_allclose(found, least)


def test_all_modes_are_found_where_nothing_else_is_asked_for():
    study = tr.study_from_text(ASSESSED + ALL)
    assert not asks_for_answers(study.floor)
    assert not asks_for_answers(study.floor.whole)
