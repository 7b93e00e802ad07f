"""Sources that act together: margins by energy and by sum, and shares, from the levels of each."""

import numpy as np
import pytest

from studies import GOOD
from trundle.results.cells import CellKey
from trundle.results.together import together_rows
from trundle.run.whole_study import run_study
from trundle.study_file.build import study_from_text

MACHINES = """
[[machine]]
name = "fan"
at = ["9 m", "4 m"]
harmonics = [["8 Hz", "30 N"]]

[[machine]]
name = "pump"
at = ["9 m", "4 m"]
harmonics = [["8 Hz", "40 N"], ["16 Hz", "5 N"]]

[[traffic]]
name = "both"
routes = ["fan", "pump"]
"""


@pytest.fixture(scope="module")
def result():
    text = GOOD.partition("[vehicle.truck]")[0] + GOOD[GOOD.index("[[point]]") :]
    text = text.replace('duration = "4 s"', 'duration = "14 s"').replace("runs = 2", "runs = 30")
    text = text.replace('["VC-A"]', '["VC-A", "R-office", "electron-microscope-vertical"]')
    return run_study(study_from_text(text + MACHINES))


def test_energies_of_two_machines_are_three_four_five(result):
    """30 and 40 N at one place and frequency: levels as 3 to 4, by energy 5, by sum 7; 36 and 64 %."""
    (row,) = [r for r in together_rows(result) if r.verdict.criterion.name == "VC-A"]
    assert row.by_energy == pytest.approx(row.alone["fan"] * 3.0 / 5.0, rel=1e-3)
    assert row.by_energy == pytest.approx(row.alone["pump"] * 4.0 / 5.0, rel=1e-3)
    assert row.by_sum == pytest.approx(row.alone["fan"] * 3.0 / 7.0, rel=1e-3)
    assert row.shares == pytest.approx({"fan": 0.36, "pump": 0.64}, abs=1e-3)
    assert (row.governs, row.band) == ("pump", pytest.approx(10**0.9))


def test_the_band_of_a_machines_own_line_is_held_against_limits(result):
    """The fan's 8 Hz lie far above VC-A: it fails there, whatever bands it does not excite."""
    verdicts = result.verdicts[CellKey("fan", "no road", "coupled")]
    (vc,) = [v for v in verdicts if v.criterion.name == "VC-A"]
    levels = result.cells[CellKey("fan", "no road", "coupled")].spectra.values[:, 0, 9]
    assert vc.governing_band == pytest.approx(10**0.9)
    assert vc.value == pytest.approx(np.percentile(levels, vc.percentile))
    assert vc.status == ("fail" if vc.value > 50e-6 else "not assessed")


def test_together_they_lie_between_their_difference_and_their_sum(result):
    """Phases are random: over the runs levels of both reach from 1 to 7 tenths of 10 N, not beyond."""
    cells = {n: result.cells[CellKey(n, "no road", "coupled")] for n in ("fan", "pump", "both")}
    levels = {n: c.spectra.values[:, 0, 9] for n, c in cells.items()}  # the 8 Hz band
    ten = levels["fan"].mean() / 3.0
    assert (levels["both"] < 7.05 * ten).all()
    assert (levels["both"] > 0.95 * ten).all()
    # the mean square over random phases is the sum of squares; 30 runs leave some 10 %
    assert np.mean(levels["both"] ** 2) == pytest.approx(25.0 * ten**2, rel=0.35)


def test_single_numbers_add_up_alike(result):
    """Response factors and peaks have one level each: the same rules, and no band."""
    for row in together_rows(result):
        if row.verdict.criterion.name == "VC-A":
            continue
        inverse = sum(1.0 / m**2 for m in row.alone.values())
        assert row.by_energy == pytest.approx(inverse**-0.5)
        assert row.by_sum == pytest.approx(1.0 / sum(1.0 / m for m in row.alone.values()))
        assert np.isnan(row.band)
