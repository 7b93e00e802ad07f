"""Maps to look at: whose they are, in which order classes rank, and readings in people's units."""

import json
from dataclasses import replace

import numpy as np
import pytest

from made_results import class_map, curve, made_result, made_study
from trundle.results.cells import DayKey
from trundle.results.maps import MapKey, StudyMap
from trundle.structure import Spots
from trundle.study.map_plan import MapGrid
from trundle.study.plans import Case
from trundle.traffic import Schedule, Times
from trundle.views.day_map import day_maps
from trundle.views.map import class_names, class_ranks, map_payload, map_views

WIDE = curve("weit", title="Weit <b>", limits=np.array([4e-4, 4e-4]))
MIDDLE = curve("mittel", limits=np.array([2e-4, 2e-4]))
STRICT = curve("eng")
PEAK = curve("Spitze", quantity="peak_acceleration", limits=np.array([1.0, 1.0]))
CRITERIA = (MIDDLE, PEAK, STRICT, WIDE)  # in no order
NUMBERS = ("rms_velocity", "peak_acceleration", "response_factor", "vdv")


def grid(on=None, axis="z"):
    """Two columns by two rows, without a floor at the second place."""
    x, y = np.array([1.0, 2.0]), np.array([5.0, 6.0])
    there = np.array([[True, False], [True, True]])
    return MapGrid(
        x=x,
        y=y,
        there=there,
        spots=Spots(xy=np.stack(np.meshgrid(x, y), -1)[there], on=on, axis=axis),
    )


@pytest.fixture(scope="module")
def study():
    text = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
    made = made_study(text)
    cases = (
        Case(name="main", routes=("main",)), Case(name="other", routes=("main",)),
        Case(name="both", routes=("main", "main")),
    )  # fmt: skip
    plan = replace(made.map, grids=(grid(),), criteria=CRITERIA, criterion="eng")
    return replace(made, cases=cases, map=plan)


def mapped(margin, **changes):
    """A map of margins for the strict curve; the wide has four times that, peaks never fail."""
    margin = np.asarray(margin, dtype=float)
    rows = np.array([2 * margin, np.full_like(margin, 9.0), margin, 4 * margin])
    n = margin.size
    values = {
        "classes": class_map(rows, CRITERIA),
        "numbers": {name: 10.0**-k * np.arange(1.0, n + 1.0) for k, name in enumerate(NUMBERS, 1)},
        "band_levels": np.zeros((n, 20)),
    }
    return StudyMap(**{**values, **changes})


def result_of(study, maps, **changes):
    return made_result(study, cells={}, maps=maps, **changes)


def test_ranks_go_from_not_assessed_over_none_to_the_strictest():
    """By hand: 0 unknown, 1 none, 2 wide, 3 middle, 4 strict, whatever order the curves came in.

    Margins to the strict curve of 0.2, 0.3, 0.6, 1 and NaN; the middle has twice, the wide four
    times as much: none; wide; middle; strict; unknown.
    """
    classes = mapped([0.2, 0.3, 0.6, 1.0, np.nan]).classes
    assert class_names(classes) == [
        "not assessed",
        "none",
        "Weit <b>",
        "mittel, titled",
        "eng, titled",
    ]
    assert class_ranks(classes).tolist() == [1, 2, 3, 4, 0]
    assert [class_names(classes)[r] for r in class_ranks(classes)][-1] == "not assessed"


def test_a_class_of_which_something_is_missing_is_not_given():
    """The strict curve asks for bands that nobody computed: it is not passed, and the middle is."""
    one = replace(mapped([2.0]).classes, complete=(True, True, False, True))
    assert class_ranks(one).tolist() == [3]
    nothing = replace(mapped([2.0]).classes, complete=(False,) * 4)
    assert class_ranks(nothing).tolist() == [0]


def test_each_case_has_its_map_and_the_worst_is_of_single_routes(study):
    """Margins of 3, 2 and 0.1 in three cases, of which the last is traffic: the worst is 2."""
    maps = {
        MapKey(c, "B"): mapped([m, m, m]) for c, m in (("main", 3.0), ("other", 2.0), ("both", 0.1))
    }
    views = map_views(result_of(study, maps))
    assert [v.title for v in views] == [
        "main, class B", "other, class B", "both, class B", "worst of all single routes",
    ]  # fmt: skip
    assert views[-1].classes.margin[2].tolist() == [2.0] * 3
    assert [v.routes for v in views[:3]] == [("main",)] * 3
    assert all(v.printed for v in views)


def test_the_worst_has_the_largest_numbers_of_each(study):
    """Levels of either map by place: the larger of both, quantity by quantity."""
    one, other = mapped([1.0, 1.0, 1.0]), mapped([1.0, 1.0, 1.0])
    for name in NUMBERS:
        one.numbers[name][:], other.numbers[name][:] = [1.0, 5.0, 3.0], [2.0, 4.0, 3.0]
    worst = map_views(result_of(study, {MapKey("main", "B"): one, MapKey("other", "B"): other}))[-1]
    assert all(worst.numbers[name].tolist() == [2.0, 5.0, 3.0] for name in NUMBERS)


def test_one_single_map_has_no_worst_of_several(study):
    """The worst of one is itself, and is not drawn twice."""
    titles = [
        v.title for v in map_views(result_of(study, {MapKey("main", "B"): mapped([1.0] * 3)}))
    ]
    assert titles == ["main, class B"]


def test_maps_at_other_speeds_are_drawn_by_their_worst(study):
    """18 km/h is 5 m/s; of each speed the worst is printed, and single maps at it are not."""
    plan = replace(study.map, speeds=(5.0, 2.5))
    maps = {
        MapKey(c, "B", v): mapped([m] * 3)
        for v, f in ((None, 1.0), (5.0, 2.0), (2.5, 3.0))
        for c, m in (("main", f), ("other", 10 * f))
    }
    views = map_views(result_of(replace(study, map=plan), maps))
    assert [(v.title, v.printed, v.classes.margin[2, 0]) for v in views] == [
        ("main, class B", True, 1.0), ("other, class B", True, 10.0),
        ("main, class B at 18 km/h", False, 2.0), ("other, class B at 18 km/h", False, 20.0),
        ("worst at 18 km/h", True, 2.0),
        ("main, class B at 9 km/h", False, 3.0), ("other, class B at 9 km/h", False, 30.0),
        ("worst at 9 km/h", True, 3.0), ("worst of all single routes", True, 1.0),
    ]  # fmt: skip


def test_without_maps_there_is_nothing_to_look_at(study):
    """No maps computed, none asked for."""
    assert map_views(result_of(study, {})) == []
    assert map_payload(result_of(study, {})) == {}
    assert (
        map_payload(result_of(replace(study, map=None), {MapKey("main", "B"): mapped([1.0])})) == {}
    )


def test_readings_are_in_units_of_people_and_nothing_where_there_is_no_floor(study):
    """By hand: 0.1 m/s are 100000 um/s, 0.01 m/s2 1 gal; share in percent; the band by its name.

    Three digits of each; places count along x, and the second of the first row is a hole.
    """
    one = mapped([0.51234, 2.0, np.nan])
    payload = map_payload(result_of(study, {MapKey("main", "B"): one}))
    json.dumps(payload, allow_nan=False)
    (view,) = payload["views"]
    words = [word for word, _ in payload["levels"]]
    units = dict(payload["levels"])
    assert units["record RMS"] == "um/s"
    assert units["peak"] == "gal"
    margin, band, share, *levels = view["readings"]
    assert margin == [[0.512, None], [2.0, None]]
    assert band == [[8.0, None], [8.0, None]]
    assert share == [[100.0, None], [0.0, None]]
    by_word = dict(zip(words, levels, strict=True))
    assert by_word["record RMS"] == [[1e5, None], [2e5, 3e5]]
    assert by_word["peak"] == [[1.0, None], [2.0, 3.0]]
    assert by_word["R"] == [[0.001, None], [0.002, 0.003]]
    assert view["ranks"] == [[3, None], [4, 0]]
    assert (view["x"], view["y"]) == ([1.0, 2.0], [5.0, 6.0])
    assert payload["criterion"] == "eng"


def test_routes_and_points_are_named_where_they_lie(study):
    """The route from 0 to 12 m along y = 3 m; both points, with their names as they are."""
    payload = map_payload(result_of(study, {MapKey("main", "B"): mapped([1.0] * 3)}))
    (route,) = payload["routes"]
    assert (route["name"], route["x"][0], route["x"][-1]) == ("main", 0.0, 12.0)
    assert set(route["y"]) == {3.0}
    assert payload["points"] == [
        {"name": "tool", "x": 3.0, "y": 3.0}, {"name": 'Käfig, "<b>&', "x": 9.0, "y": 1.5},
    ]  # fmt: skip
    (view,) = payload["views"]
    assert view["routes"] == ["main"]
    assert view["points"] == list(study.points)


SCHEDULE = Schedule(
    name="Tag",
    streams=(Times(route="main", times=3600.0 * np.arange(1.0, 5.0)), Times(route="other", times=np.array([60.0]))),
)  # fmt: skip


def day_of(study, maps, **changes):
    there = replace(study, schedules={"Tag": SCHEDULE}, **changes)
    return day_maps(result_of(there, maps), DayKey("Tag", "B"))


def test_a_day_over_the_floor_is_passages_times_shares_and_times_above(study):
    """4 and 1 passages of which a share of 0.5, 0, 1 and 1, 0, 0 exceed; 30 s and 6 s above each."""
    some = {}
    for name, share, seconds in (("main", [0.5, 0.0, 1.0], 30.0), ("other", [1.0, 0.0, 0.0], 6.0)):
        one = mapped([1.0] * 3)
        one.classes.share_exceeding[2] = share
        one.classes.share_exceeding[[0, 1, 3]] = 7.0
        some[MapKey(name, "B")] = replace(
            one, seconds_above={"eng": np.full(3, seconds), "weit": np.ones(3)}
        )
    (found,) = day_of(study, some)
    assert found.events.tolist() == [3.0, 0.0, 4.0]
    assert found.minutes.tolist() == pytest.approx([(4 * 30.0 + 6.0) / 60.0] * 3)
    assert (found.criterion, found.routes) == ("eng", ("main", "other"))


def test_a_day_knows_no_minutes_where_one_route_has_none(study):
    """Without running levels of one route the sum is no number, and not the other's alone."""
    with_time = replace(mapped([1.0] * 3), seconds_above={"eng": np.ones(3)})
    (found,) = day_of(
        study, {MapKey("main", "B"): with_time, MapKey("other", "B"): mapped([1.0] * 3)}
    )
    assert np.isnan(found.minutes).all()
    assert np.isfinite(found.events).all()


def test_a_day_with_a_route_that_is_not_mapped_is_not_drawn(study):
    """Half of the traffic is no day: nothing, rather than a map that is too quiet."""
    assert day_of(study, {MapKey("main", "B"): mapped([1.0] * 3)}) == []
    assert (
        day_of(
            study, {MapKey("main", "C"): mapped([1.0] * 3), MapKey("other", "B"): mapped([1.0] * 3)}
        )
        == []
    )


def test_a_day_on_several_surfaces_has_a_map_of_each(study):
    """The places of the second surface begin behind those of the first."""
    plan = replace(study.map, grids=(grid("a"), grid("b")))
    one = mapped([1.0] * 6)
    one.classes.share_exceeding[2] = np.arange(6.0)
    maps = {MapKey(name, "B"): one for name in ("main", "other")}
    first, second = day_of(study, maps, map=plan)
    assert (first.grid.on, first.events.tolist()) == ("a", [0.0, 5.0, 10.0])
    assert (second.grid.on, second.events.tolist()) == ("b", [15.0, 20.0, 25.0])
