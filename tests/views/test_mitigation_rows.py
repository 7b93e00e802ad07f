"""What would help, as rows: what is met, what is not known, every margin with its combination."""

import numpy as np
import pytest

from made_results import POINTS, curve, made_study, verdict
from trundle.mitigate.outcome import Outcome, Sweep
from trundle.views.mitigation import (
    MARGIN_HEADINGS,
    NONE,
    UNKNOWN,
    margin_rows,
    middle_curve,
    mitigation_rows,
    strictest,
)

CAGE = list(POINTS)[1]
WIDE = curve("weit", limits=np.array([4e-4, 4e-4]))
STRICT = curve("eng, <b>")
PEAK = curve("Spitze", quantity="peak_acceleration", limits=np.array([1e-9, 1e-9]))


@pytest.fixture(scope="module")
def study():
    return made_study()


def outcome(*verdicts, **changes):
    values = {
        "change": "Platte, 0.3 m", "case": "main", "speed": 5.0, "road": "B", "verdicts": verdicts,
        "excited_to": 11.8, "warnings": (),
    }  # fmt: skip
    return Outcome(**{**values, **changes})


def sweep(study, *outcomes):
    return Sweep(
        study=study, changes=("Platte, 0.3 m",), speeds=(5.0,), roads=("B",), runs=2,
        outcomes=outcomes, resonances={},
    )  # fmt: skip


@pytest.mark.parametrize(
    ("statuses", "said"),
    [
        (("pass", "pass"), "eng, <b>, titled"),
        (("pass", "fail"), "weit, titled"),
        (("pass", "not assessed"), "weit, titled"),
        (("fail", "fail"), NONE),
        (("not assessed", "fail"), UNKNOWN),
        (("not assessed", "not assessed"), UNKNOWN),
    ],
)
def test_what_is_not_known_is_neither_met_nor_failed(statuses, said):
    """Wide and strict curve by hand: "none" only where all are failed, a title only where passed."""
    wide, strict = statuses
    one = outcome(
        verdict(WIDE, status=wide, margin=9.0), verdict(STRICT, status=strict, margin=9.0)
    )
    assert strictest(one, "tool") == said


def test_peaks_and_other_points_decide_no_class():
    """A pass by peaks or at the other point is no class here."""
    one = outcome(verdict(PEAK), verdict(WIDE, point=CAGE), verdict(WIDE, status="fail"))
    assert strictest(one, "tool") == NONE
    assert strictest(one, CAGE) == "weit, titled"


def test_every_point_of_every_combination_has_a_row(study):
    """5 m/s are 18 km/h; the study's two points, in its order, with their own class."""
    some = outcome(verdict(WIDE), verdict(WIDE, point=CAGE, status="fail"))
    rows = mitigation_rows(sweep(study, some, outcome(verdict(STRICT), road="C")))
    assert [(r["road"], r["point"], r["strictest"]) for r in rows] == [
        ("B", "tool", "weit, titled"), ("B", CAGE, NONE), ("C", "tool", "eng, <b>, titled"), ("C", CAGE, NONE),
    ]  # fmt: skip
    assert [r["speed_kmh"] for r in rows] == pytest.approx([18.0] * 4)
    assert {r["change"] for r in rows} == {"Platte, 0.3 m"}


def test_margins_stand_under_their_headings(study):
    """By hand, six digits; a number that nobody knows is nan, and no 0 that would fail or pass."""
    lost = verdict(
        STRICT, point=CAGE, status="not assessed", margin=np.nan, governing_band=np.nan,
        share_exceeding=np.nan,
    )  # fmt: skip
    some = outcome(verdict(WIDE, margin=1.23456789, share_exceeding=1 / 3), lost)
    first, second = (
        dict(zip(MARGIN_HEADINGS, r, strict=True)) for r in margin_rows(sweep(study, some))
    )
    assert first == {
        "change": "Platte, 0.3 m", "case": "main", "speed_kmh": "18", "road": "B", "point": "tool",
        "criterion": "weit", "verdict": "pass", "margin": "1.23457", "governing_band_hz": "7.94328",
        "share_exceeding": "0.333333", "excited_to_hz": "11.8",
    }  # fmt: skip
    assert (second["point"], second["verdict"], second["margin"]) == (CAGE, "not assessed", "nan")


def test_the_curve_that_is_drawn_is_passed_by_about_half(study):
    """Wide: four of four; strict: one of four; between: two of four, which says most."""
    middle = curve("mittel", limits=np.array([2e-4, 2e-4]))
    margins = {WIDE: (4, 3, 2, 1), middle: (2, 1, 0.9, 0.5), STRICT: (1, 0.8, 0.5, 0.2)}
    some = [
        outcome(
            *(verdict(c, margin=float(m[i])) for c, m in margins.items()), verdict(PEAK, margin=0.1)
        )
        for i in range(4)
    ]
    assert middle_curve(sweep(study, *some)) == "mittel"
    assert middle_curve(sweep(study, outcome(verdict(PEAK)))) == ""
    assert middle_curve(sweep(study, outcome(verdict(WIDE, margin=np.nan)))) == ""
