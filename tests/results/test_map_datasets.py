"""Maps as labelled arrays: rows along y, columns along x, nothing where there is no floor."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import class_map, curve, made_result, made_study
from trundle.results.map_datasets import known_forces, map_groups, single_maps
from trundle.results.maps import MapKey, StudyMap
from trundle.structure import Spots
from trundle.study.map_plan import MapGrid, MapPlan
from trundle.study.plans import Case

X, Y = np.array([1.0, 2.0, 4.0]), np.array([10.0, 20.0])
WIDE = curve("weit", limits=np.array([2e-4, 2e-4]))
NARROW = curve("eng, <b>")


def grid(on=None, axis="z", hole=(0, 1)):
    """Three columns and two rows, without a floor at one place."""
    there = np.ones((2, 3), dtype=bool)
    there[hole] = False
    xy = np.stack(np.meshgrid(X, Y), axis=-1)[there]
    return MapGrid(x=X, y=Y, there=there, spots=Spots(xy=xy, on=on, axis=axis))


def plan(*grids, **changes):
    values = {
        "grids": grids or (grid(),), "runs": 7, "criteria": (WIDE, NARROW), "criterion": "eng, <b>",
        "percentile": 90.0, "averaging": "max_1s", "traffic": False, "every_step": False,
        "peaks": True, "people": False, "speeds": (),
    }  # fmt: skip
    return MapPlan(**{**values, **changes})


def study_map(factor=1.0, n=5):
    """A map whose margins, levels and numbers count up place by place."""
    margin = factor * np.array([np.arange(1.0, n + 1.0), 0.1 * np.arange(1.0, n + 1.0)])
    return StudyMap(
        classes=class_map(margin, [WIDE, NARROW]),
        numbers={
            name: factor * k * np.arange(1.0, n + 1.0)
            for k, name in enumerate(
                ("rms_velocity", "peak_acceleration", "response_factor", "vdv"), 1
            )
        },
        band_levels=np.zeros((n, 20)),
    )


@pytest.fixture(scope="module")
def study():
    """Two single routes and both together, on two roads."""
    made = made_study()
    cases = (
        Case(name="main", routes=("main",)),
        Case(name="other", routes=("main",)),
        Case(name="both", routes=("main", "main")),
    )
    return replace(made, cases=cases, roads={"B": made.roads["B"], "C, rauh": made.roads["B"]})


def result_of(study, maps, **changes):
    return replace(
        made_result(study, cells={}), study=replace(study, map=plan(**changes)), maps=maps
    )


def test_places_lie_where_their_grid_says_and_nothing_lies_in_a_hole(study):
    """Places count along x first; the second of the first row is a hole: 1, -, 2 and 3, 4, 5."""
    maps = {MapKey("main", road): study_map(k) for k, road in ((1.0, "B"), (10.0, "C, rauh"))}
    found = map_groups(result_of(study, maps))["/maps/main"]
    expected = np.array([[1.0, np.nan, 2.0], [3.0, 4.0, 5.0]])
    for k, road in ((1.0, "B"), (10.0, "C, rauh")):
        margin = found["margin"].sel(road=road)
        assert margin.dims == ("criterion", "y", "x")
        np.testing.assert_allclose(margin.sel(criterion="weit"), k * expected)
        np.testing.assert_allclose(margin.sel(criterion="eng, <b>"), 0.1 * k * expected)
        np.testing.assert_allclose(found["peak_acceleration"].sel(road=road), 2.0 * k * expected)
    assert float(found["margin"].sel(road="B", criterion="weit", x=4.0, y=10.0)) == 2.0
    assert (found["x"].values.tolist(), found["y"].values.tolist()) == (X.tolist(), Y.tolist())
    assert found["x"].attrs["units"] == found["y"].attrs["units"] == "m"


def test_numbers_have_their_units_and_the_share_that_they_cover(study):
    """SI, and 90 % of the 7 runs of the map, not those of the study."""
    found = map_groups(result_of(study, {MapKey("main", r): study_map() for r in study.roads}))
    attributes = {name: one.attrs for name, one in found["/maps/main"].data_vars.items()}
    units = {name: one["units"] for name, one in attributes.items()}
    assert units == {
        "margin": "1", "share_exceeding": "1", "governing_band": "Hz", "class_index": "1",
        "rms_velocity": "m/s", "peak_acceleration": "m/s2", "response_factor": "1", "vdv": "m/s1.75",
    }  # fmt: skip
    assert attributes["rms_velocity"]["long_name"].endswith("that 90 % of 7 runs stay below")


def test_classes_are_indices_of_criteria_and_holes_have_none(study):
    """Margins 0.5, 1.2 and 2 to a curve, half of that to the other: none met, wide, both."""
    margin = np.array([[0.5, 1.2, 2.0, 3.0, np.nan], [0.25, 0.6, 1.0, 1.5, np.nan]])
    one = replace(study_map(), classes=class_map(margin, [WIDE, NARROW]))
    found = map_groups(result_of(study, {MapKey("main", r): one for r in study.roads}))
    index = found["/maps/main"]["class_index"].sel(road="B")
    np.testing.assert_array_equal(index, [[-1, np.nan, 0], [1, 1, -2]])


def test_speeds_stand_along_an_axis_of_their_own(study):
    """In the order in which the map names them, in m/s; roads beside each other at every speed."""
    maps, speeds = {}, (4.0, 2.0)
    for i, v in enumerate((None, *speeds)):
        for j, road in enumerate(study.roads):
            maps[MapKey("main", road, v)] = study_map(10.0**i * (j + 1))
    groups = map_groups(result_of(study, maps, speeds=speeds))
    found = groups["/map_speeds/main"]["margin"]
    assert found.dims == ("speed", "road", "criterion", "y", "x")
    assert found["speed"].attrs["units"] == "m/s"
    assert found["speed"].values.tolist() == [4.0, 2.0]
    for i, v in enumerate(speeds, start=1):
        for j, road in enumerate(study.roads):
            value = found.sel(speed=v, road=road, criterion="weit", x=1.0, y=20.0)
            assert float(value) == 3.0 * 10.0**i * (j + 1)
    own = groups["/maps/main"]["margin"].sel(road="B", criterion="weit", x=1.0, y=20.0)
    assert float(own) == 3.0


def test_the_worst_is_of_single_vehicles_alone(study):
    """Traffic with margins a tenth as large is no single vehicle: the worst is that of the two."""
    maps = {}
    for case, k in (("main", 2.0), ("other", 3.0), ("both", 0.1)):
        for road in study.roads:
            maps[MapKey(case, road)] = study_map(k)
    result = result_of(study, maps)
    assert {key.case for key in single_maps(result)} == {"main", "other"}
    worst = map_groups(result)["/map_envelope"]
    assert worst["margin"].dims == ("criterion", "y", "x")
    assert float(worst["margin"].sel(criterion="weit", x=1.0, y=10.0)) == 2.0
    assert worst.attrs["description"].startswith("worst of 4 maps of single vehicles")
    assert set(map_groups(result)) == {"/maps/main", "/maps/other", "/maps/both", "/map_envelope"}


def test_a_case_that_is_not_mapped_has_no_group(study):
    """Traffic that nobody asked for leaves no empty map that would look like a quiet floor."""
    groups = map_groups(result_of(study, {MapKey("main", r): study_map() for r in study.roads}))
    assert set(groups) == {"/maps/main", "/map_envelope"}


def test_surfaces_and_axes_have_groups_of_their_own(study):
    """The second surface begins behind the five places of the first: 6 to 10, its own names."""
    grids = (grid("Hof"), grid("Hof", "x"), grid("2. OG, Süd", "z", hole=(1, 2)))
    maps = {MapKey("main", r): study_map(n=15) for r in study.roads}
    groups = map_groups(result_of(study, maps, grids=grids))
    paths = ("/Hof", "/Hof/along x", "/2. OG, Süd")
    assert set(groups) == {f"{top}{p}" for top in ("/maps/main", "/map_envelope") for p in paths}
    firsts = [groups[f"/maps/main{p}"]["margin"].values[0, 0] for p in paths]
    np.testing.assert_allclose(firsts[0], [[1, np.nan, 2], [3, 4, 5]])
    np.testing.assert_allclose(firsts[1], [[6, np.nan, 7], [8, 9, 10]])
    np.testing.assert_allclose(firsts[2], [[11, 12, 13], [14, 15, np.nan]])
    said = [
        (groups[f"/maps/main{p}"].attrs["surface"], groups[f"/maps/main{p}"].attrs["motion"])
        for p in paths
    ]
    assert said == [("Hof", "vertical"), ("Hof", "along x"), ("2. OG, Süd", "vertical")]


def test_without_maps_there_are_none(study):
    """Neither where nothing is asked for, nor where nothing was computed."""
    assert map_groups(made_result(study, cells={})) == {}
    assert map_groups(result_of(study, {})) == {}


def test_forces_of_vehicles_are_never_known_altogether(study):
    """A road's waves end somewhere: a map of a vehicle binds what can be passed."""
    result = result_of(study, {})
    assert known_forces(result, [MapKey("main", "B"), MapKey("other", "B")]) == [False, False]


def test_a_part_of_a_map_is_those_places_in_everything():
    """Places 2 and 3 of five: margins, numbers, levels and times above, all of the same places."""
    one = replace(
        study_map(), band_levels=np.arange(100.0).reshape(5, 20), seconds_above={"weit": np.arange(5.0)}
    )  # fmt: skip
    part = one.part(slice(2, 4))
    assert part.classes.margin[0].tolist() == [3.0, 4.0]
    assert part.numbers["rms_velocity"].tolist() == [3.0, 4.0]
    assert part.band_levels[:, 0].tolist() == [40.0, 60.0]
    assert part.seconds_above["weit"].tolist() == [2.0, 3.0]
