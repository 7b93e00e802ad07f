"""What a study will take is told before it is taken."""

from dataclasses import replace
from pathlib import Path

import pytest

from studies import BUILDING, GOOD, run_main
from trundle import study_file
from trundle.cli import afford
from trundle.dynamics import natural_modes
from trundle.errors import StudyError
from trundle.mitigate.changes import Change
from trundle.mitigate.estimate import estimate_of_changes
from trundle.run import estimate
from trundle.run.estimate import estimate_of
from trundle.run.jobs import plan_jobs
from trundle.simulate import Newmark, Rayleigh
from trundle.study_file.build import load_study, study_from_text


@pytest.fixture
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TRUNDLE_CACHE", "")

    def written(*changes):
        text = GOOD
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "study.toml"
        path.write_text(text)
        return path

    return written


def test_the_number_of_modes_is_weyl_s(study):
    """Two bays in closed form: ``A f sqrt(m / D) / 2`` against all modes of the mesh."""
    template = Path(study_file.__file__).with_name("template.toml")
    found = load_study(template)
    (job,) = plan_jobs(found)
    floor = found.floor
    counted = natural_modes(floor.mass, floor.stiffness, f_max=112.0).n_modes
    assert estimate.n_modes_of(found, job) == pytest.approx(counted, rel=0.25)


def test_answers_are_counted_by_frequencies_not_by_modes():
    """A building of nine times the area has nine times the modes: all of them cost 81 times as much
    (dofs times modes), what answers 27 times (a factor a frequency, to the power 1.5) and its parts
    9 times; half the damping costs twice the frequencies."""
    parts = "\n[parts]\nnodes = 100\nband = 2\nresponse_tolerance = 0.05\n"
    study = study_from_text(BUILDING + parts)
    (job,) = plan_jobs(study)
    n, dofs = estimate.n_modes_of(study, job), study.floor.n_dofs
    spent = [estimate._answer_seconds(study, job, k * n, 60.0) for k in (1, 9)]
    assert spent[1] - 1e-4 * dofs == pytest.approx(27.0 * (spent[0] - 1e-4 * dofs))
    half = study_from_text((BUILDING + parts).replace('ratio = "3 %"', 'ratio = "1.5 %"'))
    (other,) = plan_jobs(half)
    more = estimate._answer_seconds(half, other, n, 60.0) - 1e-4 * dofs
    assert more == pytest.approx(1.9 * (spent[0] - 1e-4 * dofs), rel=0.06)
    assert estimate.seconds_of_modes(study, [job]) == spent[0]


def test_direct_integration_beside_parts_takes_the_factor_of_the_whole():
    """480 bytes a degree of freedom and doubling of them, however the modes of others are found."""
    study = study_from_text(BUILDING + "\n[parts]\nnodes = 100\n")
    jobs, n = plan_jobs(study), 1_000_000
    direct = replace(
        jobs[0],
        method=replace(
            jobs[0].method,
            interaction=replace(
                jobs[0].method.interaction,
                integration=Newmark(dt=0.01),
                damping=Rayleigh.through(0.03, 5.0, 20.0),
            ),
        ),
    )
    few, more = (estimate.peak_memory([job], n, 0.0, parted=True) for job in (jobs[0], direct))
    assert more - few == pytest.approx(480.0 * n * 19.93, rel=0.05)


def test_time_grows_with_what_is_asked_for(study):
    few = estimate_of(load_study(study()))
    many = estimate_of(load_study(study(("runs = 2", "runs = 200000"))))
    assert many.seconds > 50.0 * few.seconds
    assert many.memory < 20.0 * few.memory  # batches are let go of
    loaded = load_study(study())
    one = estimate_of_changes(loaded, [Change()], [5.0], 60)
    assert estimate_of_changes(loaded, [Change()], [5.0] * 9, 60).seconds > one.seconds
    slabs = [Change(slab_thickness=0.2), Change(slab_thickness=0.3)]
    assert estimate_of_changes(loaded, slabs, [5.0], 60).seconds > one.seconds


@pytest.mark.parametrize("why", ["time", "memory"])
def test_what_is_too_much_asks_before_work(study, monkeypatch, capsys, why):
    if why == "time":
        path = study(("runs = 2", "runs = 1000000"))
    else:
        path = study()
        monkeypatch.setattr(afford, "memory_there_is", lambda: 1e7)
    code, output = run_main(monkeypatch, capsys, "run", path)
    assert code == 2
    assert "say --yes" in output.err
    assert ("that is long" if why == "time" else "there are 0.01 GB") in output.err
    assert [p.name for p in path.parent.iterdir()] == ["study.toml"]
    code, output = run_main(monkeypatch, capsys, "check", path)
    assert code == 0
    assert "'trundle run' asks for --yes" in output.out


def test_with_yes_it_is_computed(study, monkeypatch, capsys):
    monkeypatch.setattr(afford, "_LONG", 0.0)
    path = study()
    assert run_main(monkeypatch, capsys, "run", path)[0] == 2
    code, output = run_main(monkeypatch, capsys, "run", path, "--yes", "--quiet")
    assert (code, output.out) == (0, "")
    assert (path.parent / "study-results" / "report.html").exists()


def test_the_run_in_counts(study):
    """A record of a few steps, before which a vehicle drives for seconds of tiny ones."""
    path = study(('dt = "5 ms"', 'dt = "10 ns"'))
    text = path.read_text().replace('duration = "', 'duration = "1 us" #')
    path.write_text(text if "1 us" in text else 'duration = "1 us"\n' + text)
    with pytest.raises(StudyError, match="run-in included"):
        load_study(path)


def test_two_meshes_ask_too(study, monkeypatch, capsys):
    monkeypatch.setattr(afford, "memory_there_is", lambda: 1e7)
    path = study()
    code, output = run_main(monkeypatch, capsys, "check", path, "--meshes")
    assert code == 2
    assert "on half its mesh size: it would take" in output.err
    assert run_main(monkeypatch, capsys, "check", path, "--mesh", "--json")[0] == 2
