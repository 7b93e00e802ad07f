"""Sources beside each other, from levels made up by hand: who governs, in which band, by which limit."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import (
    BANDS,
    POINTS,
    SECOND,
    cell,
    curve,
    levels,
    made_result,
    made_study,
    spectra,
    verdict,
    with_assessment,
)
from trundle.results.cells import CellKey
from trundle.results.day_tables import together_table
from trundle.results.together import together_rows
from trundle.study.plans import Case
from trundle.views.days import together_lines

SOUTH = "=Zufahrt, Süd"
CAGE = list(POINTS)[1]
VC = curve("Band")
PEAK = curve("Spitze", quantity="peak_acceleration", limits=np.array([1.0, 1.0]))


@pytest.fixture(scope="module")
def study():
    return made_study(SECOND)


def bands(**levels_of):
    """Levels [um/s] of three equal runs in some bands, by their number; nothing elsewhere."""
    values = np.zeros((3, 2, 20))
    for band, (tool, cage) in levels_of.items():
        values[:, :, int(band[1:])] = 1e-6 * np.array([tool, cage])
    return spectra(values)


def result_of(study, main, south, *, found=None, case="both", **changes):
    """A result with two sources alone and together on road B; verdicts on those together."""
    keys = {name: CellKey(name, "B", "coupled") for name in ("main", SOUTH, case)}
    cells = {
        keys["main"]: cell(keys["main"], reduced=main),
        keys[SOUTH]: cell(keys[SOUTH], reduced=south),
        keys[case]: cell(keys[case], reduced=main),
    }
    verdicts = {keys[case]: tuple(found or (verdict(VC),))}
    return replace(made_result(study, cells=cells, verdicts=verdicts), **changes)


def test_the_band_of_the_least_margin_by_energy_governs(study):
    """30 and 40 um/s at 8 Hz are 50; 60 and 0 at 16 Hz are 60: margin 100 / 60, all of it main's.

    By sum 70 um/s at 8 Hz are more: 100 / 70. Alone: 100 / 60 and 100 / 40.
    """
    main = levels(spectra=bands(b9=(30, 1), b12=(60, 1)))
    south = levels(spectra=bands(b9=(40, 1), b12=(0, 1)))
    (row,) = together_rows(result_of(study, main, south))
    assert row.by_energy == pytest.approx(100 / 60)
    assert row.by_sum == pytest.approx(100 / 70)
    assert row.band == pytest.approx(BANDS[12])
    assert row.alone == pytest.approx({"main": 100 / 60, SOUTH: 100 / 40})
    assert row.shares == pytest.approx({"main": 1.0, SOUTH: 0.0})
    assert row.governs == "main"


def test_a_point_is_found_by_its_name(study):
    """At the second point the second source is three times as loud as the first: 0.9 of the energy."""
    main, south = levels(spectra=bands(b9=(90, 10))), levels(spectra=bands(b9=(9, 30)))
    (row,) = together_rows(result_of(study, main, south, found=(verdict(VC, point=CAGE),)))
    assert row.shares == pytest.approx({"main": 0.1, SOUTH: 0.9})
    assert (row.point, row.governs) == (CAGE, SOUTH)
    assert row.by_energy == pytest.approx(100 / np.sqrt(1000.0))


def test_a_source_that_is_there_twice_counts_twice(study):
    """Two of 30 and one of 40 um/s: sqrt(900 + 900 + 1600), and a sum of 100: on its limit."""
    cases = (*study.cases[:2], Case(name="both", routes=("main", SOUTH, "main")))
    main, south = levels(spectra=bands(b9=(30, 0))), levels(spectra=bands(b9=(40, 0)))
    (row,) = together_rows(result_of(replace(study, cases=cases), main, south))
    assert row.by_energy == pytest.approx(100 / np.sqrt(3400.0))
    assert row.by_sum == pytest.approx(1.0)
    assert row.shares["main"] == pytest.approx(1800 / 3400)
    assert row.alone["main"] == pytest.approx(100 / 30)  # of one alone


def test_levels_are_those_that_the_share_of_runs_stays_below(study):
    """Of runs of 10, 20 and 30 um/s half lie below 20: a verdict for 50 % holds that."""
    values = np.zeros((3, 2, 20))
    values[:, 0, 9] = [1e-5, 3e-5, 2e-5]
    main = levels(spectra=spectra(values))
    (row,) = together_rows(result_of(study, main, main, found=(verdict(VC, percentile=50.0),)))
    assert row.alone["main"] == pytest.approx(5.0)


def test_bands_outside_the_curve_decide_nothing(study):
    """900 um/s at 2 Hz, below the curve's 4 Hz: the margin is that at 8 Hz."""
    one = levels(spectra=bands(b3=(900, 0), b9=(25, 0)))
    (row,) = together_rows(result_of(study, one, one))
    assert row.band == pytest.approx(BANDS[9])
    assert row.alone == pytest.approx({"main": 4.0, SOUTH: 4.0})


def test_single_numbers_have_their_own_limit(study):
    """Peaks of 0.3 and 0.4 m/s2 beside 1 m/s2: 2 by energy, 1 / 0.7 by sum, and no band."""
    main = levels(peak_acceleration=np.full((3, 2), 0.3))
    south = levels(peak_acceleration=np.full((3, 2), 0.4))
    (row,) = together_rows(result_of(study, main, south, found=(verdict(PEAK, limit=1.0),)))
    assert (row.by_energy, row.by_sum) == (pytest.approx(2.0), pytest.approx(1 / 0.7))
    assert np.isnan(row.band)
    assert row.shares[SOUTH] == pytest.approx(0.64)


def test_a_source_that_moves_nothing_has_no_finite_margin_alone(study):
    """Nothing at this point from the second: any limit is met, and all energy is the first's."""
    main, south = levels(spectra=bands(b9=(50, 0))), levels(spectra=bands())
    (row,) = together_rows(result_of(study, main, south))
    assert row.alone[SOUTH] == np.inf
    assert (row.by_energy, row.governs) == (pytest.approx(2.0), "main")


def test_what_is_held_against_nothing_has_no_row(study):
    """A verdict without a margin, by a curve for another motion, says nothing of sources."""
    one = levels(spectra=bands(b9=(50, 0)))
    some = (verdict(VC, status="not assessed", margin=np.nan), verdict(VC))
    assert len(list(together_rows(result_of(study, one, one, found=some)))) == 1


def test_a_source_alone_has_no_row(study):
    """Verdicts of single cases are not held beside themselves."""
    one = levels(spectra=bands(b9=(50, 0)))
    result = result_of(study, one, one)
    alone = {CellKey("main", "B", "coupled"): (verdict(VC),)}
    assert list(together_rows(replace(result, verdicts=alone))) == []


def test_a_row_of_the_table_and_of_the_page_say_the_same(study):
    """64 % of the energy at 8 Hz, margins of three digits; the name of the curve, or its title."""
    main, south = levels(spectra=bands(b9=(30, 1))), levels(spectra=bands(b9=(40, 1)))
    found = (verdict(VC, status="fail", margin=0.987654),)
    result = result_of(study, main, south, found=found)
    (row,), (line,) = together_table(result), together_lines(result)
    assert (row["case"], row["road"], row["point"], row["criterion"]) == (
        "both",
        "B",
        "tool",
        "Band",
    )
    assert row["margin_together"] == 0.987654
    assert row["margin_by_energy"] == pytest.approx(2.0)
    assert row["governed_by"] == SOUTH
    assert row["share_of_energy"] == pytest.approx(0.64)
    assert row["margins_alone"] == ["main 3.333", f"{SOUTH} 2.5"]
    assert (line.together, line.energy, line.total) == ("fail 0.988", "2", "1.43")
    assert line.alone == f"main 3.33, {SOUTH} 2.5"
    assert line.governs == f"{SOUTH}, 64 % of the energy at 8 Hz"
    assert line.criterion == "Band, titled"


def test_doses_are_of_as_many_events_as_the_verdict(study):
    """16 events double a dose of 0.1: margin 5 to 1 of each alone, and 5 / sqrt(2) by energy."""
    dose = curve("Dosis", quantity="vdv", limits=np.array([1.0, 1.0]))
    study = with_assessment(study, [dose], events=16.0)
    one = levels(vdv=np.full((3, 2), 0.1))
    found = (verdict(dose, margin=5.0, limit=1.0, value=0.2),)
    (row,) = together_rows(result_of(study, one, one, found=found))
    assert row.alone == pytest.approx({"main": 5.0, SOUTH: 5.0})
    assert row.by_energy == pytest.approx(5.0 / np.sqrt(2.0))
    assert row.by_sum == pytest.approx(2.5)


@pytest.mark.parametrize(("line", "said"), [(7, "7 Hz"), (31, "31 Hz"), (16, "16 Hz")])
def test_a_line_is_called_by_its_own_frequency(study, line, said):
    """Lines lie at every Hz: 7 Hz is no band of 6.3 Hz, and 31 Hz none of 31.5 Hz."""
    lines = curve("L", quantity="narrow_band_acceleration", frequencies=np.array([1.0, 40.0]))
    values = np.full((3, 2, 40), 1e-9)
    values[:, :, line - 1] = 1e-5
    some = spectra(values, mid_band=np.arange(1.0, 41.0), quantity="narrow_band_acceleration")
    one = levels(more={"narrow_band_acceleration": some})
    (shown,) = together_lines(result_of(study, one, one, found=(verdict(lines),)))
    assert shown.governs.endswith(f" of the energy at {said}")
