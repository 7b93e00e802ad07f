"""Pieces of a job put together: runs behind each other, each road its own, doubts each once."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import history, levels, spectra
from trundle.errors import FitnessWarning
from trundle.response import ExactStatistics, LargestValues
from trundle.results.cells import EXACT_SHARES, CellKey
from trundle.results.parts import RunsPart, cell_of, exact_part, joined, runs_part
from trundle.simulate import Coverage, Runs, TruncationChange
from trundle.simulate.fitness import LOST_CONTACT

KEY = CellKey("a, Süd", "C", "m")
MESH = FitnessWarning(subject="mesh passing", message="once")


def part(first_run, n_runs=2, **changes):
    """Two roads; run r of the job moves r on the first road and 10 r on the second."""
    runs = np.arange(first_run, first_run + n_runs, dtype=float)[:, None]
    rms = np.tile(runs, (1, 2))
    values = {
        "reduced": tuple(
            levels(n_runs=n_runs, rms_velocity=factor * rms, above={"VC": factor * rms},
                   spectra=spectra(factor * np.tile(rms[:, :, None], (1, 1, 20))))
            for factor in (1.0, 10.0)
        ),
        "histories": tuple(history(base=b) for b in (1.0, 10.0)) if first_run == 0 else (),
        "contact_names": ("axle 1", "axle 2"),
        "truncation": TruncationChange(f_max=15.0, velocity=np.zeros(2), acceleration=np.zeros(2)) if first_run == 0 else None,
        "coverage": Coverage(excited_to=11.8),
        "f_resolved": 24.0,
        "ends": 4.0,
        "warnings": (MESH,),
    }  # fmt: skip
    return RunsPart(**{**values, **changes})


def test_runs_of_parts_stand_behind_each_other_in_their_order():
    """Runs 0 to 4 in three parts: 0, 1, 2, 3, 4 on the first road, ten times that on the second."""
    whole = joined([part(0), part(2), part(4, n_runs=1)])
    for road, factor in enumerate((1.0, 10.0)):
        reduced = whole.reduced[road]
        assert reduced.rms_velocity[:, 1].tolist() == [factor * r for r in range(5)]
        assert reduced.spectra.values[:, 0, 7].tolist() == [factor * r for r in range(5)]
        assert reduced.above["VC"][:, 0].tolist() == [factor * r for r in range(5)]
    assert len(whole.histories) == 2
    assert whole.truncation is not None


@pytest.mark.parametrize(("road", "factor"), [(0, 1.0), (1, 10.0)])
def test_a_cell_is_of_its_own_road(road, factor):
    """Levels and history of road C are those that lie at its place in the job, and no others."""
    found = cell_of(KEY, road, factor, [part(0), part(2)])
    assert found.key == KEY
    assert found.rms_velocity[:, 0].tolist() == [0.0, factor, 2 * factor, 3 * factor]
    assert found.history.velocity[3, 0] == 30.0 * factor
    assert (found.f_resolved, found.coverage.excited_to) == (24.0, 11.8)
    assert found.exact is None
    assert found.exact_peaks is None


def exact(error=0.0):
    """Mean 3 and deviation 4 everywhere; two drawn histories whose largest values are 1 + 4, 1 + 8."""
    mean, variance = np.full((4, 2), 3.0), np.full((4, 2), 16.0)
    drawn = LargestValues(mean=np.ones((1, 2, 2)), random=np.array([[[4.0, 4.0], [8.0, 8.0]]]))
    return ExactStatistics(
        time=0.005 * np.arange(4), mean={"velocity": mean}, variance={"velocity": variance},
        largest={"acceleration": drawn}, mid_band=10.0 ** (np.arange(20) / 10.0),
        resolved=np.zeros(20, dtype=bool), band_mean=np.zeros((0, 2, 4)),
        band_variance=np.zeros((0, 2, 4)), quadrature_error=error, n_waves=3, point_names=("a", "b"),
    )  # fmt: skip


def test_exact_statistics_grow_with_the_road_and_loads_do_not():
    """Twice as rough: variance 64 beside a mean of 3, so sqrt(9 + 64); peaks 1 + 8 and 1 + 16.

    50 and 95 % of two draws lie half-way and 95 % of the way between them.
    """
    whole = exact_part(exact(), [1.0, 2.0])
    assert EXACT_SHARES == (50.0, 95.0)
    np.testing.assert_allclose(whole.peaks[0], [[7.0, 7.0], [8.8, 8.8]])
    np.testing.assert_allclose(whole.peaks[1], [[13.0, 13.0], [16.6, 16.6]])
    found = cell_of(KEY, 1, 2.0, [part(0), whole])
    np.testing.assert_allclose(found.exact.rms(), np.sqrt(9.0 + 64.0))
    np.testing.assert_allclose(found.exact_peaks, whole.peaks[1])
    np.testing.assert_allclose(cell_of(KEY, 0, 1.0, [part(0), whole]).exact.rms(), 5.0)


@pytest.mark.parametrize(("error", "doubts"), [(0.05, 0), (0.0501, 1), (0.26, 1)])
def test_sparse_waves_are_a_doubt_with_their_case(error, doubts):
    """Above 5 % half of the waves changes too much: said in percent, with the case's name."""
    found = cell_of(KEY, 0, 1.0, [part(0), exact_part(exact(error), [1.0])]).warnings
    some = [w for w in found if w.subject == "exact statistics, a, Süd"]
    assert len(some) == doubts
    assert all(f"by {100 * error:.0f} %" in w.message for w in some)
    assert MESH in found


def test_lost_contact_is_of_its_own_road_and_stands_first():
    """One of two runs pulls on the rough road alone: 50 % there, nothing on the smooth one."""
    one = part(0)
    pulling = np.array([[False, True], [False, False]])
    rough = replace(one.reduced[1], numbers={**one.reduced[1].numbers, "tension": pulling})
    some = [replace(one, reduced=(one.reduced[0], rough))]
    assert [w.subject for w in cell_of(KEY, 0, 1.0, some).warnings] == ["mesh passing"]
    first, second = cell_of(KEY, 1, 10.0, some).warnings
    assert (first.subject, second) == (LOST_CONTACT, MESH)
    assert "50 % of the runs" in first.message


def test_lost_contact_counts_runs_of_all_parts():
    """One run of four pulls, in the second part: a quarter, and not the half of that part."""
    pulling = np.array([[True, True], [False, False]])
    late = part(2)
    rough = replace(late.reduced[0], numbers={**late.reduced[0].numbers, "tension": pulling})
    some = [part(0), replace(late, reduced=(rough, late.reduced[1]))]
    (first, _) = cell_of(KEY, 0, 1.0, some).warnings
    assert "25 % of the runs" in first.message


def test_a_part_keeps_the_first_run_of_each_road_and_no_doubt_about_contact():
    """Histories of run 0 by road; contact is judged later, when all runs are there."""
    shape = (2, 6, 2)
    motion = np.arange(24.0).reshape(shape)
    runs = Runs(
        time=0.005 * np.arange(6), displacement=motion, velocity=2 * motion, acceleration=3 * motion,
        contact_forces=4 * motion, point_names=("a", "b"), contact_names=("axle 1", "axle 2"), seed=1,
        method="m", f_max=30.0, coverage=Coverage(ends=9.0),
        warnings=(FitnessWarning(subject=LOST_CONTACT, message="x"), MESH),
    )  # fmt: skip
    rough = replace(runs, velocity=20 * motion)
    found = runs_part(runs, [levels(n_runs=2)], [runs, rough], truncation=None)
    np.testing.assert_array_equal(found.histories[0].velocity, 2 * motion[0])
    np.testing.assert_array_equal(found.histories[1].velocity, 20 * motion[0])
    np.testing.assert_array_equal(found.histories[1].contact_forces, 4 * motion[0])
    assert found.warnings == (MESH,)
    assert found.ends == pytest.approx(0.025)
    # the least of what modes and step show (30 Hz) and the 80 Hz that 200 steps a second do
    assert found.f_resolved == 30.0
