"""What the headline says of each case, road and point; and every verdict under its own column."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import (
    POINTS,
    SECOND,
    cell,
    class_map,
    curve,
    levels,
    made_result,
    made_study,
    spectra,
    verdict,
    with_assessment,
)
from trundle.results.cells import CellKey
from trundle.results.maps import MapKey, StudyMap
from trundle.structure import Spots
from trundle.study.map_plan import MapGrid
from trundle.views.verdicts import headline, strictest_passed, verdict_matrix

SOUTH = "=Zufahrt, Süd"
CAGE = list(POINTS)[1]
WIDE = curve("weit", limits=np.array([4e-4, 4e-4]))
MIDDLE = curve("mittel", limits=np.array([2e-4, 2e-4]))
STRICT = curve("eng", limits=np.array([1e-4, 1e-4]))
PEAK = curve("Spitze", quantity="peak_acceleration", limits=np.array([1e-9, 1e-9]))
KEY = CellKey("main", "B", "coupled")


@pytest.fixture(scope="module")
def study():
    text = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
    return with_assessment(made_study(SECOND + text), [WIDE, MIDDLE, STRICT])


def result_of(study, verdicts, **changes):
    return made_result(study, verdicts=verdicts, **changes)


def line_of(study, *verdicts, point="tool", key=KEY, **changes):
    lines = headline(result_of(study, {key: verdicts}, **changes))
    (one,) = (line for line in lines if line["point"] == point)
    return one


def test_the_strictest_that_is_passed_is_that_of_the_lowest_limit():
    """Whatever the order: 200 um/s of those passed, for 100 um/s is failed."""
    some = [verdict(WIDE), verdict(STRICT, status="fail"), verdict(MIDDLE)]
    for order in (some, some[::-1]):
        assert strictest_passed(order).criterion.name == "mittel"
    assert strictest_passed([]) is None


@pytest.mark.parametrize("status", ["fail", "not assessed"])
def test_nothing_is_passed_that_was_not(status):
    """Margins far above 1 are no pass where the verdict is none."""
    assert strictest_passed([verdict(WIDE, status=status, margin=50.0)]) is None


def test_best_is_the_strictest_met_and_first_the_widest_failed(study):
    """Met: 400 um/s; failed: 200 and 100 um/s, of which 200 is the first to be failed."""
    some = verdict(STRICT, status="fail"), verdict(WIDE), verdict(MIDDLE, status="fail")
    line = line_of(study, *some)
    assert (line["best"].criterion.name, line["first"].criterion.name) == ("weit", "mittel")


def test_a_limit_on_peaks_is_no_class(study):
    """A pass by the strictest limit of all on another quantity does not head the page."""
    line = line_of(study, verdict(PEAK), verdict(WIDE, status="fail"))
    assert line["best"] is None
    assert line["first"].criterion.name == "weit"
    assert line["road_passed"] == ""


def test_each_point_has_its_own_line(study):
    """A pass at one point and a fail at the other: neither stands for the other."""
    some = {KEY: (verdict(WIDE), verdict(WIDE, point=CAGE, status="fail"))}
    first, second = headline(result_of(study, some))
    assert (first["point"], first["best"].point, first["first"]) == ("tool", "tool", None)
    assert (second["point"], second["best"], second["first"].point) == (CAGE, None, CAGE)


def test_cases_and_roads_have_lines_of_their_own(study):
    """In the order of the verdicts, each with its own."""
    other = CellKey(SOUTH, "C", "coupled")
    lines = headline(result_of(study, {KEY: (verdict(WIDE),), other: (verdict(MIDDLE),)}))
    found = [
        (x["case"], x["road"], x["point"], x["best"] and x["best"].criterion.name) for x in lines
    ]
    assert found == [
        ("main", "B", "tool", "weit"), ("main", "B", CAGE, None),
        (SOUTH, "C", "tool", "mittel"), (SOUTH, "C", CAGE, None),
    ]  # fmt: skip


def test_reasons_are_those_of_the_point_each_once(study):
    """Of what is not assessed alone, of any quantity: not of another point, or of what is failed."""
    lost = {"status": "not assessed", "margin": np.nan}
    line = line_of(
        study,
        verdict(WIDE, reasons=("eins", "zwei"), **lost),
        verdict(MIDDLE, reasons=("zwei", "drei"), **lost),
        verdict(STRICT, status="fail", reasons=("vier",)),
        verdict(PEAK, reasons=("fünf",), **lost),
        verdict(WIDE, point=CAGE, reasons=("sechs",), **lost),
    )
    assert line["reasons"] == "eins; zwei; drei; fünf"
    assert line["best"] is None


def test_the_road_that_is_passed_goes_with_the_best(study):
    """Margin 2 on class B: 4 times 64e-6 m3, all of class B; nothing where nothing is passed."""
    line = line_of(study, verdict(WIDE, margin=2.0), verdict(STRICT, status="fail", margin=0.5))
    assert line["road_passed"] == "at least 256e-6 m3 (all of class B)"
    assert line_of(study, verdict(STRICT, status="fail"))["road_passed"] == ""


def test_where_is_the_place_at_the_time_of_what_failed_first(study):
    """15 km/h for 1.2 s are 5 m along y = 3 m; what failed decides, not what passed at another time."""
    failed = verdict(STRICT, status="fail", time=1.2)
    assert line_of(study, verdict(WIDE, time=2.0), failed)["where"] == "1.2 s, main at (5.0, 3.0) m"
    assert line_of(study, verdict(WIDE, time=0.6))["where"] == "0.6 s, main at (2.5, 3.0) m"
    assert line_of(study, verdict(WIDE, time=np.nan))["where"] == ""
    assert line_of(study)["where"] == ""


def test_an_axle_beyond_the_floor_is_told_from_a_vehicle_that_has_left(study):
    """At 4 s the front has gone 16.7 m of 12: wheels whose own way is 0 to 12 m are still there."""
    setback = study.drives["main"].vehicle.setback
    on = int(np.sum((16.0 + 2 / 3 - setback >= 0.0) & (16.0 + 2 / 3 - setback <= 12.0)))
    assert 0 < on < len(setback)
    said = line_of(study, verdict(WIDE, time=4.0))["where"]
    counted = "1 wheel is" if on == 1 else f"{on} wheels are"
    assert said == f"4.0 s, main's front axle is off, {counted} on the floor"
    assert line_of(study, verdict(WIDE, time=60.0))["where"] == "60.0 s, main is off the floor"


def test_vehicles_that_meet_stand_beside_each_other(study):
    """From both ends: 5 m after 1.2 s at 15 km/h, and 12 - 12 m at 36 km/h."""
    said = line_of(study, verdict(WIDE, time=0.6), key=CellKey("both", "B", "coupled"))["where"]
    assert said == f"0.6 s, main at (2.5, 3.0) m, {SOUTH} at (6.0, 2.0) m"


def bands(level):
    values = np.zeros((3, 2, 20))
    values[:, :, 9] = level
    return cell(KEY, reduced=levels(spectra=spectra(values)))


def test_who_governs_is_said_of_several_alone(study):
    """30 and 40 um/s: the second has 64 % of the energy; a source by itself governs nothing."""
    keys = {name: CellKey(name, "B", "coupled") for name in ("main", SOUTH, "both")}
    cells = dict(made_result(study).cells)
    for name, level in (("main", 3e-5), (SOUTH, 4e-5), ("both", 5e-5)):
        cells[keys[name]] = replace(bands(level), key=keys[name])
    some = {keys["both"]: (verdict(WIDE),), keys["main"]: (verdict(WIDE),)}
    lines = {
        x["case"]: x for x in headline(result_of(study, some, cells=cells)) if x["point"] == "tool"
    }
    assert lines["both"]["governs"] == f"governed by {SOUTH}, 64 % of the energy"
    assert lines["main"]["governs"] == ""


def grid(on=None):
    x, y = np.array([1.0, 2.0]), np.array([5.0])
    xy = np.array([[1.0, 5.0], [2.0, 5.0]])
    return MapGrid(x=x, y=y, there=np.ones((1, 2), dtype=bool), spots=Spots(xy=xy, on=on))


def mapped(study, margin, grids):
    one = StudyMap(
        classes=class_map(margin, [WIDE, STRICT]), numbers={}, band_levels=np.zeros((len(margin[0]), 20))
    )  # fmt: skip
    return replace(study, map=replace(study.map, grids=grids)), {MapKey("main", "B"): one}


def test_the_worst_place_is_by_the_curve_that_decides(study):
    """By the failed curve 0.4 at the second place of the second surface; not by the other's 0.1."""
    margin = np.array([[0.1, 2.0, 3.0, 4.0], [0.9, np.nan, 0.8, 0.4]])
    there, maps = mapped(study, margin, (grid("Hof"), grid("2. OG")))
    line = line_of(there, verdict(STRICT, status="fail"), verdict(WIDE), maps=maps)
    assert line["worst"] == "0.4 at (2.0, 5.0) m (2. OG)"
    line = line_of(there, verdict(WIDE), maps=maps)
    assert line["worst"] == "0.1 at (1.0, 5.0) m (Hof)"


def test_no_worst_place_is_named_where_none_is_known(study):
    """No number on the map, no map of this road, a curve that is not on it."""
    there, maps = mapped(study, np.array([[np.nan, np.nan], [1.0, 2.0]]), (grid(),))
    assert line_of(there, verdict(WIDE), maps=maps)["worst"] == ""
    assert line_of(there, verdict(STRICT), maps=maps)["worst"] == "1 at (1.0, 5.0) m"
    assert line_of(there, verdict(MIDDLE), maps=maps)["worst"] == ""
    assert (
        line_of(there, verdict(STRICT), key=CellKey("main", "C", "coupled"), maps=maps)["worst"]
        == ""
    )


def test_every_verdict_stands_under_its_own_column(study):
    """Two cells by two points are four columns; each row has the four verdicts of its own curve."""
    other = CellKey(SOUTH, "C", "coupled")
    some = {
        key: tuple(
            verdict(c, point=p, margin=m + i + 10 * j)
            for i, p in enumerate(POINTS)
            for j, c in enumerate((WIDE, STRICT))
        )
        for m, key in ((1.0, KEY), (3.0, other))
    }
    columns, rows = verdict_matrix(result_of(study, some))
    assert columns == [
        "main, B, tool",
        f"main, B, {CAGE}",
        f"{SOUTH}, C, tool",
        f"{SOUTH}, C, {CAGE}",
    ]
    assert [title for title, _ in rows] == ["weit, titled", "eng, titled"]
    assert [[v.margin for v in found] for _, found in rows] == [[1, 2, 3, 4], [11, 12, 13, 14]]


def test_one_point_is_not_named_in_every_column(study):
    """A study of one point has columns of case and road."""
    one = replace(study, points={"tool": study.points["tool"]})
    columns, ((_, found),) = verdict_matrix(result_of(one, {KEY: (verdict(WIDE),)}))
    assert columns == ["main, B"]
    assert len(found) == 1


def test_without_criteria_there_is_no_matrix(study):
    """Nothing was held against anything: no columns that would look like empty passes."""
    assert verdict_matrix(result_of(replace(study, assessment=None), {})) == ([], [])


def test_two_curves_of_one_title_have_a_row_each(study):
    """A user's curve may be titled as another: every verdict must stand under its own column."""
    one = replace(WIDE, title="VC-A")
    other = replace(STRICT, title="VC-A")
    some = tuple(
        verdict(c, point=p, status=s) for p in POINTS for c, s in ((one, "pass"), (other, "fail"))
    )
    columns, rows = verdict_matrix(result_of(study, {KEY: some}))
    assert len(columns) == 2
    assert [title for title, _ in rows] == ["VC-A", "VC-A"]
    for (_, found), status in zip(rows, ("pass", "fail"), strict=True):
        assert [v.point for v in found] == list(POINTS)
        assert {v.status for v in found} == {status}


@pytest.mark.parametrize(
    ("some", "said"),
    [
        ([], "none asked for"),
        ([verdict(PEAK)], "none asked for"),
        ([verdict(WIDE, status="fail")], "none"),
        ([verdict(WIDE, status="fail"), verdict(STRICT, status="not assessed")], "not assessed"),
    ],
)
def test_where_no_velocity_criterion_is_met_is_said_why(study, some, said):
    """None was asked for, one is not known, or all are failed: three things, of which one is bad."""
    assert line_of(study, *some)["unmet"] == said
