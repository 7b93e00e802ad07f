"""Tables of the screen: the same numbers as the runs, in gal and um/s, beside what is exact or printed."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import POINTS, SECOND, cell, levels, made_result, made_study
from trundle.response import ExactStatistics
from trundle.results.cells import CellKey
from trundle.simulate import TruncationChange
from trundle.study.plans import Case, Printed, PrintedBound
from trundle.views.printed import bound_rows, comparison_rows
from trundle.views.tables import exact_rows, summary_headings, summary_rows, truncation_rows

SOUTH = "=Zufahrt, Süd"
CAGE = list(POINTS)[1]
KEY = CellKey("main", "B", "coupled")


@pytest.fixture(scope="module")
def study():
    return made_study(SECOND)


def peaks(*gal, rms=(1.0, 1.0, 1.0)):
    """Runs whose peaks are so many gal at the first point, a hundred times that at the second."""
    values = 0.01 * np.array(gal, dtype=float)[:, None] * np.array([1.0, 100.0])
    speeds = 1e-6 * np.array(rms, dtype=float)[:, None] * np.array([1.0, 100.0])
    return levels(peak_acceleration=values, rms_velocity=speeds)


def result_of(study, **cells):
    """A result in which some cases have levels of their own on both roads."""
    made = made_result(study)
    return replace(
        made,
        cells={k: replace(c, reduced=cells.get(k.case, c.reduced)) for k, c in made.cells.items()},
    )


def test_headings_and_ranges_belong_together(study):
    """1, 2, 3 gal and 1, 2, 6 um/s: 5 % at 1.1, half at 2, 95 % at 2.9 gal and 5.6 um/s."""
    rows = summary_rows(result_of(study, main=peaks(1, 2, 3, rms=(1, 2, 6))))
    assert summary_headings() == ["peak acceleration [gal]", "record RMS velocity [um/s]"]
    first, second = (row for row in rows if (row.case, row.road) == ("main", "B"))
    assert (first.point, second.point) == tuple(POINTS)
    assert first.ranges[0] == pytest.approx((1.1, 2.0, 2.9))
    assert first.ranges[1] == pytest.approx((1.1, 2.0, 5.6))
    assert second.ranges[0] == pytest.approx((110.0, 200.0, 290.0))
    assert len(rows) == 3 * 2 * 2


def exact():
    """Mean 3 um/s and deviation 4 um/s at the first point, ten times that at the second."""
    scale = 1e-6 * np.array([1.0, 10.0])
    mean, variance = np.ones((4, 1)) * 3.0 * scale, np.ones((4, 1)) * (4.0 * scale) ** 2
    return ExactStatistics(
        time=0.005 * np.arange(4), mean={"velocity": mean}, variance={"velocity": variance}, largest={},
        mid_band=np.ones(1), resolved=np.zeros(1, bool), band_mean=np.zeros((0, 2, 4)),
        band_variance=np.zeros((0, 2, 4)), quadrature_error=0.03, n_waves=3, point_names=tuple(POINTS),
    )  # fmt: skip


def test_exact_numbers_stand_beside_those_of_the_runs(study):
    """RMS sqrt(9 + 16) = 5 um/s; of runs of 1, 2 and 2 um/s sqrt(9 / 3); peaks in gal, each its own."""
    one = cell(
        KEY, reduced=peaks(1, 2, 3, rms=(1, 2, 2)), exact=exact(),
        exact_peaks=np.array([[0.02, 0.5], [0.03, 0.7]]),
    )  # fmt: skip
    result = made_result(study)
    rows = exact_rows(replace(result, cells={**result.cells, KEY: one}))
    assert [(r.case, r.road, r.point) for r in rows] == [("main", "B", p) for p in POINTS]
    first, second = rows
    assert (first.rms, second.rms) == (pytest.approx(5.0), pytest.approx(50.0))
    assert first.sampled_rms == pytest.approx(np.sqrt(3.0))
    assert first.peak == pytest.approx((2.0, 3.0))
    assert second.peak == pytest.approx((50.0, 70.0))
    assert first.sampled_peak == pytest.approx((2.0, 2.9))
    assert second.sampled_peak == pytest.approx((200.0, 290.0))
    assert first.quadrature_error == 0.03
    assert first.between == "above 2"  # of three runs: the second is below the 95 % level in 97.5 %


def test_cells_without_exact_statistics_have_no_row(study):
    """Neither a row of zeros nor one of the runs twice."""
    assert exact_rows(made_result(study)) == []
    result = made_result(study)
    half = {**result.cells, KEY: replace(result.cells[KEY], exact=exact())}
    assert exact_rows(replace(result, cells=half)) == []


def test_the_largest_change_of_all_points_stands_for_modes_left_out(study):
    """0.1 and 0.4 of velocity, 0.3 and 0.2 of acceleration: 0.4 and 0.3, against half of 30 Hz."""
    change = TruncationChange(
        f_max=15.0, velocity=np.array([0.1, 0.4]), acceleration=np.array([0.3, 0.2])
    )
    result = made_result(study)
    some = {**result.cells, KEY: replace(result.cells[KEY], truncation=change)}
    (row,) = truncation_rows(replace(result, cells=some))
    assert (row.case, row.method, row.f_max, row.fewer) == ("main", "coupled", 30.0, 15.0)
    assert (row.velocity, row.acceleration) == (0.4, 0.3)


def printed(study, **changes):
    values = {
        "case": "main",
        "road": "B",
        "method": "coupled",
        "peak_acceleration": 0.025,
        "rms_velocity": 2e-6,
    }
    return replace(study, printed=(Printed(**{**values, **changes}),))


def test_printed_values_stand_with_the_share_of_runs_below_them(study):
    """2.5 gal above two of 1, 2, 3 gal; 2 um/s equal to one of 1, 2, 6, which counts half: 50 %."""
    there = printed(study)
    (row,) = comparison_rows(result_of(there, main=peaks(1, 2, 3, rms=(1, 2, 6))))
    assert (row.printed_peak, row.printed_rms) == (pytest.approx(2.5), pytest.approx(2.0))
    assert row.peak_rank == pytest.approx(100 * 2 / 3)
    assert row.rms_rank == pytest.approx(50.0)
    assert row.peak == pytest.approx((1.1, 2.0, 2.9))
    assert row.rms[1] == pytest.approx(2.0)


def test_a_printed_cell_is_its_own(study):
    """On road C and of the second route: levels of no other cell stand beside it."""
    there = printed(study, case=SOUTH, road="C")
    (row,) = comparison_rows(result_of(there, **{SOUTH: peaks(7, 8, 9)}))
    assert (row.case, row.road, row.peak[1]) == (SOUTH, "C", pytest.approx(8.0))
    assert row.peak_rank == 0.0


def bounds(study, bound, **changes):
    one = PrintedBound(
        bound=bound, road="B", method="coupled", peak_acceleration=0.1, rms_velocity=1e-5
    )
    return replace(study, printed_bounds=(one,), **changes)


def three(study):
    return {
        "main": peaks(1, 3, 5, rms=(1, 3, 5)),
        SOUTH: peaks(1, 4, 9, rms=(1, 4, 9)),
        "both": peaks(1, 6, 9, rms=(2, 6, 7)),
    }


def test_bounds_are_of_the_medians_of_single_routes(study):
    """Medians of 3 and 4 gal and um/s: the largest 4, the sum 7, the root sum of squares 5."""
    (row,) = bound_rows(result_of(bounds(study, "single"), **three(study)))
    assert (row.rule, row.peak, row.rms) == (
        "largest single route",
        pytest.approx(4.0),
        pytest.approx(4.0),
    )
    total, root = bound_rows(result_of(bounds(study, "absolute maximum"), **three(study)))
    assert (total.rule, total.peak, total.rms) == ("sum", pytest.approx(7.0), pytest.approx(7.0))
    assert (root.rule, root.peak) == ("root sum of squares", pytest.approx(5.0))
    assert (total.printed_peak, total.printed_rms) == (pytest.approx(10.0), pytest.approx(10.0))


def test_what_is_simulated_together_is_its_own_median(study):
    """Of any other bound both at once stand beside it: 6 gal and 6 um/s; nothing without traffic."""
    (row,) = bound_rows(result_of(bounds(study, "all at once"), **three(study)))
    assert (row.rule, row.peak, row.rms) == (
        "simulated: both",
        pytest.approx(6.0),
        pytest.approx(6.0),
    )
    alone = bounds(study, "all at once", cases=study.cases[:2])
    assert bound_rows(result_of(alone, **three(study))) == []


def test_a_bound_is_of_the_published_vehicle(study):
    """A second vehicle that no printed cell has is in no bound: 3 and not 3 + 4 gal."""
    drives = dict(study.drives)
    other = replace(drives[SOUTH].vehicle, name="bus")
    drives[SOUTH] = replace(drives[SOUTH], vehicle=other)
    there = printed(bounds(study, "absolute maximum", drives=drives))
    total, _ = bound_rows(result_of(there, **three(study)))
    assert total.peak == pytest.approx(3.0)
    everybody = replace(there, printed=())
    total, _ = bound_rows(result_of(everybody, **three(study)))
    assert total.peak == pytest.approx(7.0)


def test_a_case_of_one_route_twice_is_no_single_route(study):
    """Twice the same truck at once is traffic: its median is in no sum of single routes."""
    twice = Case(name="both", routes=("main", "main"))
    there = bounds(study, "absolute maximum", cases=(*study.cases[:2], twice))
    total, _ = bound_rows(result_of(there, **three(study)))
    assert total.peak == pytest.approx(7.0)
    there = bounds(study, "all at once", cases=(*study.cases[:2], twice))
    (row,) = bound_rows(result_of(there, **three(study)))
    assert (row.rule, row.peak) == ("simulated: both", pytest.approx(6.0))
