"""What walking gives a floor, as rows: each place with its own walker, surface and dose."""

import numpy as np
import pytest

from made_results import made_study
from trundle.errors import InputError
from trundle.footfall import footfall_load
from trundle.run.footfall import FootfallAsked, StudyFootfall
from trundle.simulate import FootfallResponse, footfall_rule
from trundle.simulate.spectral.footfall_response import FootfallLevels
from trundle.structure import Spots
from trundle.study.map_plan import MapGrid
from trundle.views.footfall import (
    FootfallDose,
    footfall_rows,
    level_words,
    worst_places,
    worst_rows,
)


def grid(x, y, on=None):
    xy = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    there = np.ones((len(y), len(x)), dtype=bool)
    return MapGrid(x=x, y=y, there=there, spots=Spots(xy=xy, on=on))


def found(level, *, transient=None, walker=(3, 3, 0, 1), guide="p354", names=("Süd, <b>", "lab")):
    """Four places: (1, 5), (2, 5) on one surface and (10, 7), (20, 7) on another."""
    level = np.array(level, dtype=float)

    def levels(values, harmonic):
        return FootfallLevels(
            level=values, pace=np.array([1.8, 1.9, 2.0, 2.123456]), harmonic=np.full(4, harmonic),
            mode=np.zeros(4, int), frequency=np.array([3.6, 5.7, 8.0, 4.2469]), walker=np.array(walker),
        )  # fmt: skip

    response = FootfallResponse(
        load=footfall_load(guide), rule=footfall_rule(guide), paces=np.array([1.8, 2.2]),
        steady=levels(level, 2), doubts=(),
        transient=None if transient is None else levels(np.array(transient, dtype=float), 0),
    )  # fmt: skip
    study = made_study()
    grids = (
        grid(np.array([1.0, 2.0]), np.array([5.0]), names[0]),
        grid(np.array([10.0, 20.0]), np.array([7.0]), names[1]),
    )
    return StudyFootfall(
        study=study, asked=FootfallAsked(guide=guide), method=study.methods[0], grids=grids, response=response
    )  # fmt: skip


def table(some, dose=None):
    headings, rows = footfall_rows(some, dose)
    return [dict(zip(headings, row, strict=True)) for row in rows]


def test_each_place_stands_with_its_own_walker():
    """The first is felt from the last, on the other surface; the fourth from the second: by hand."""
    rows = table(found([3.0, 1.0, 2.0, 4.0]))
    assert [(r["surface"], r["x_m"], r["y_m"]) for r in rows] == [
        ("Süd, <b>", 1.0, 5.0), ("Süd, <b>", 2.0, 5.0), ("lab", 10.0, 7.0), ("lab", 20.0, 7.0),
    ]  # fmt: skip
    assert [(r["walker_surface"], r["walker_x_m"], r["walker_y_m"]) for r in rows] == [
        ("lab", 20.0, 7.0), ("lab", 20.0, 7.0), ("Süd, <b>", 1.0, 5.0), ("Süd, <b>", 2.0, 5.0),
    ]  # fmt: skip
    assert [r["response_factor"] for r in rows] == [3.0, 1.0, 2.0, 4.0]
    assert rows[3]["pace_hz"] == 2.12346
    assert {r["transient"] for r in rows} == {""}


def test_the_larger_of_steady_state_and_impulses_governs_each_place():
    """3, 1, 2, 4 beside 2, 5, 2, 1: harmonics at the first, third and last, impulses at the second."""
    rows = table(found([3.0, 1.0, 2.0, 4.0], transient=[2.0, 5.0, 2.0, 1.0]))
    assert [r["response_factor"] for r in rows] == [3.0, 5.0, 2.0, 4.0]
    assert [r["harmonic"] for r in rows] == [2, 0, 2, 2]
    assert [r["steady_state"] for r in rows] == [3.0, 1.0, 2.0, 4.0]
    assert [r["transient"] for r in rows] == [2.0, 5.0, 2.0, 1.0]


def test_a_dose_is_that_of_the_guide_for_all_passages():
    """SCI P354: 0.68 a (n T)^0.25, and a = 0.005 R: of R = 4, 16 passages of 10 s: 0.0484."""
    rows = table(found([3.0, 1.0, 2.0, 4.0]), FootfallDose(passages=16.0, duration=10.0))
    assert rows[3]["vdv_m_s1.75"] == pytest.approx(0.68 * 0.02 * 160.0**0.25, rel=1e-5)
    assert "vdv_m_s1.75" not in table(found([3.0, 1.0, 2.0, 4.0]))[0]


def test_peak_accelerations_are_said_with_their_unit_and_have_no_dose():
    """Chapter 7 of DG11 gives m/s2; a response factor has no unit; a peak makes no dose."""
    peak = found([0.03, 0.01, 0.02, 0.04], guide="dg11")
    assert level_words(peak) == "peak acceleration [m/s2]"
    assert table(peak)[0]["peak_acceleration_m_s2"] == 0.03
    assert level_words(found([1.0] * 4)) == "response factor"
    with pytest.raises(InputError, match="no vibration dose"):
        footfall_rows(peak, FootfallDose(passages=16.0, duration=10.0))


def test_the_worst_place_is_looked_for_on_each_surface():
    """The first of the one, the last of the other, as numbers among all places."""
    some = found([3.0, 1.0, 2.0, 4.5678], transient=[1.0, 1.0, 9.0, 1.0])
    assert worst_places(some) == [0, 2]
    first, second = worst_rows(some)
    assert first == (
        "Süd, <b>",
        "3",
        "1.00, 5.00",
        "1.800",
        "harmonic 2",
        "3.60",
        "20.00, 7.00 on lab",
    )
    assert second == (
        "lab",
        "9",
        "10.00, 7.00",
        "2.000",
        "impulses",
        "8.00",
        "1.00, 5.00 on Süd, <b>",
    )


def test_a_walker_on_the_same_surface_is_not_told_where():
    """The surface is named once; the only one of a floor is called the floor."""
    some = found([3.0, 1.0, 2.0, 4.0], walker=(1, 1, 2, 2), names=(None, None))
    first, second = worst_rows(some)
    assert (first[0], first[-1]) == ("floor", "2.00, 5.00")
    assert (second[0], second[-1]) == ("floor", "10.00, 7.00")
