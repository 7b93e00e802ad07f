"""The map of a study: what it holds, what it is refused for, and that it is not another verdict."""

import numpy as np
import pytest

from studies import BUILDING, LONG, MAP
from trundle.criteria import ClassMap, Criterion
from trundle.errors import StudyError
from trundle.results.map_datasets import map_groups
from trundle.results.maps import MapKey
from trundle.run.whole_study import run_study
from trundle.simulate import ensemble
from trundle.study_file.build import load_study, study_from_text
from trundle.units import KMH
from trundle.views.map import map_views


def study_of(tmp_path, text):
    path = tmp_path / "study.toml"
    path.write_text(text)
    return load_study(path)


def test_a_place_of_the_map_is_what_a_point_there_gives(tmp_path):
    """A point of the study at a place of the map: the same runs, the same verdict within 1 %."""
    text = LONG.replace('at = ["3 m", "3 m"]', 'at = ["1.5 m", "4.5 m"]')
    study = study_of(tmp_path, text + MAP)
    at = int(np.abs(study.map.grids[0].xy - [1.5, 4.5]).sum(axis=1).argmin())
    np.testing.assert_allclose(study.map.grids[0].xy[at], [1.5, 4.5])
    result = run_study(study)
    (mapped,), ((verdict,),) = result.maps.values(), result.verdicts.values()
    assert mapped.classes.margin[0, at] == pytest.approx(verdict.margin, rel=0.01)
    assert mapped.classes.share_exceeding[0, at] == verdict.share_exceeding
    assert mapped.classes.governing_band[0, at] == pytest.approx(verdict.governing_band)
    (cell,) = result.cells.values()
    expected = np.percentile(cell.rms_velocity[:, 0], 95.0)
    assert mapped.numbers["rms_velocity"][at] == pytest.approx(expected, rel=1e-3)


def test_a_rougher_road_has_its_own_map(tmp_path):
    """Class C shares the runs of class B: against an ensemble that drives over class C."""
    text = LONG.replace("[[point]]", '[[road]]\nclass = "C"\n\n[[point]]', 1)
    study = study_of(tmp_path, text.replace('["VC-A"]', '["VC-A", "stepper-B"]') + MAP)
    result = run_study(study)
    case, method = study.cases[0], study.methods[0]
    points = {f"p{i}": tuple(p) for i, p in enumerate(study.map.grids[0].xy)}
    alone = ensemble(
        study.floor, study.acting(case, "C", method), method=method.interaction,
        points=points, n_runs=study.runs, seed=study.seed, duration=study.duration,
    )  # fmt: skip
    (mapped,) = (m for key, m in result.maps.items() if key.road == "C")
    peaks = np.percentile(alone.peak_acceleration(), 95.0, axis=0)
    np.testing.assert_allclose(mapped.numbers["peak_acceleration"], peaks, rtol=1e-3)
    stepper = mapped.classes.index("stepper-B")
    np.testing.assert_allclose(mapped.classes.margin[stepper], 0.001 / peaks, rtol=1e-3)


def test_a_map_at_another_speed_is_that_of_its_own_study(tmp_path):
    """12 km/h named by the map against a route at 12 km/h; the worst of both holds the larger."""
    text = LONG + MAP + 'speeds = ["12 km/h"]\n'
    result = run_study(study_of(tmp_path, text))
    slow = LONG.replace('"15 km/h"', '"12 km/h"') + MAP
    (expected,) = run_study(study_of(tmp_path, slow)).maps.values()
    found = result.maps[MapKey("main", "B", 12 * KMH)]
    np.testing.assert_allclose(
        found.numbers["rms_velocity"], expected.numbers["rms_velocity"], rtol=1e-5
    )
    np.testing.assert_allclose(found.classes.margin, expected.classes.margin, rtol=1e-5)
    own = result.maps[MapKey("main", "B")]
    assert np.abs(own.numbers["rms_velocity"] / found.numbers["rms_velocity"] - 1).max() > 0.1
    groups = map_groups(result)
    assert set(groups) == {"/maps/main", "/map_speeds/main", "/map_envelope"}
    there = groups["/map_speeds/main"]["margin"].sel(speed=12 * KMH, road="B", criterion="VC-A")
    np.testing.assert_allclose(there.values.ravel(), found.classes.margin[0])
    worst = groups["/map_envelope"]["margin"].sel(criterion="VC-A").values.ravel()
    np.testing.assert_allclose(worst, np.minimum(own.classes.margin, found.classes.margin)[0])
    views = map_views(result)
    assert [(view.title, view.printed) for view in views] == [
        ("main, class B", True), ("main, class B at 12 km/h", False),
        ("worst at 12 km/h", True), ("worst of all single routes", True),
    ]  # fmt: skip


def test_every_node_at_every_step_is_what_a_point_there_gives(tmp_path):
    """The map of all nodes of the mesh; the default rule as exact there as a history."""
    exact = '\n[map]\nplaces = "nodes"\nevery_step = true\npeaks = true\ncriterion = "VC-A"\n'
    study = study_of(tmp_path, LONG + exact)
    nodes = study.floor.nodes
    level = nodes[np.abs(nodes[:, 2]) < 1e-9][:, :2]
    assert {tuple(p) for p in np.round(study.map.grids[0].xy, 6)} == {
        tuple(p) for p in np.round(level, 6)
    }
    result = run_study(study)
    (mapped,), ((verdict,),) = result.maps.values(), result.verdicts.values()
    (at,) = np.flatnonzero(np.abs(study.map.grids[0].xy - [3.0, 3.0]).sum(axis=1) < 1e-9)
    # single precision, and a record that ends before the lowest bands are at rest
    assert mapped.classes.margin[0, at] == pytest.approx(verdict.margin, rel=1e-4)
    (cell,) = result.cells.values()
    expected = np.percentile(cell.peak_acceleration[:, 0], 95.0)
    assert mapped.numbers["peak_acceleration"][at] == pytest.approx(expected, rel=1e-3)


@pytest.mark.longest
def test_traffic_is_mapped_when_asked_for(tmp_path):
    """Both trucks at once are louder everywhere than the quieter of them alone."""
    more = LONG.replace(
        "[[road]]",
        '[[route]]\nname = "other"\nvehicle = "truck"\npath = [["12 m", "4 m"], ["0 m", "4 m"]]\n'
        'speed = "15 km/h"\n\n[[traffic]]\nname = "both"\nroutes = ["main", "other"]\n\n[[road]]',
        1,
    )
    result = run_study(study_of(tmp_path, more + MAP))
    assert {key.case for key in result.maps} == {"main", "other"}
    result = run_study(study_of(tmp_path, more + MAP + "traffic = true\n"))
    levels = {key.case: one.numbers["rms_velocity"] for key, one in result.maps.items()}
    assert set(levels) == {"main", "other", "both"}
    assert np.all(levels["both"] > np.minimum(levels["main"], levels["other"]))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (LONG + MAP.replace('"VC-A"', '"VC-Z"'), "map.criterion"),
        (LONG + MAP.replace('"3 m"', '"1 mm"'), "20000 places"),
        (LONG.replace('["VC-A"]', '["VC-A"]\naveraging = "slow"') + MAP, "max_1s or event"),
        (LONG.replace('["VC-A"]', '["VDV-office-low"]') + "\n[map]\n", "no curve that can be mapped"),
        (LONG[: LONG.index("[criteria]")] + MAP, "add \\[criteria\\]"),
        (
            LONG.replace(
                'f_max = "90 Hz"', 'integration = "newmark"'
            ).replace('{ ratio = "3 %" }', '{ rayleigh_alpha = "0.8 1/s", rayleigh_beta = "0.001 s" }')
            + MAP,
            "modal superposition",
        ),
        (LONG + MAP.replace("spacing", "spacin"), "did you mean 'spacing'"),
        (LONG + MAP + 'places = "nodes"\n', "nodes of the mesh have a spacing of their own"),
        (LONG.replace("runs = 2", "runs = 100000") + MAP.replace('"3 m"', '"0.1 m"\nruns = 100000'), "would not fit in memory"),
        (
            LONG.replace("[[point]]", '[roughness]\nn_min = "0.05 1/m"\nn_max = "10 1/m"\nn_max_follows_dt = false\n\n[[point]]')
            + MAP + 'speeds = ["10 km/h", "60 km/h"]\n',
            "map.speeds\\[2\\]",
        ),
    ],
)  # fmt: skip
def test_maps_that_cannot_be_are_refused(tmp_path, text, told):
    with pytest.raises(StudyError, match=told):
        study_of(tmp_path, text)


LEVEL = """
[criteria]
method = "coupled"
curves = ["VC-A", "electron-microscope-horizontal"]

[map]
on = ["lab", "deck"]
axes = ["z", "x"]
spacing = "4 m"
runs = 2
peaks = true
"""


@pytest.fixture(scope="module")
def swaying():
    """A building with a map of vertical motion and of that along x, and a point on one place."""
    text = BUILDING + LEVEL
    x, y = study_from_text(text).map.grids[0].xy[3]
    point = f'axes = ["z", "x"]\nat = ["{x} m", "{y} m"]'
    return run_study(study_from_text(text.replace('at = ["4 m", "3 m"]', point)))


def test_a_map_along_x_is_what_points_read_along_x(swaying):
    """The four maps are of two storeys and two axes; places of each are those of the other."""
    plan = swaying.study.map
    assert [(g.on, g.axis) for g in plan.grids] == [
        ("lab", "z"), ("lab", "x"), ("deck", "z"), ("deck", "x"),
    ]  # fmt: skip
    assert plan.motion == "vertical, along x"
    ((cell,), (mapped,)) = swaying.cells.values(), swaying.maps.values()
    for (grid, part), column in zip(list(plan.parts())[:2], (0, 1), strict=True):
        here = mapped.part(part)
        rms = np.percentile(cell.rms_velocity[:, column], 95.0)
        assert here.numbers["rms_velocity"][3] == pytest.approx(rms, rel=1e-3)
        assert plan.where(part.start + 3)[2] == grid.label
    levels = [mapped.part(part).numbers["rms_velocity"] for _, part in plan.parts()]
    assert np.abs(levels[1] / levels[0] - 1.0).min() > 0.2


def test_curves_hold_for_the_motion_that_they_are_for(swaying):
    """VC-A is for each axis; the microscope's limit along x is on no vertical map."""
    (mapped,), plan = swaying.maps.values(), swaying.study.map
    vc, microscope = (mapped.classes.index(c.name) for c in plan.criteria)
    for grid, part in plan.parts():
        here = mapped.part(part).classes
        assert here.applies[vc].all()
        assert np.isfinite(here.margin[vc]).all()
        assert (here.applies[microscope] == (grid.axis == "x")).all()
        assert (np.isfinite(here.margin[microscope]) == (grid.axis == "x")).all()


def test_maps_along_x_have_titles_and_datasets_of_their_own(swaying):
    name = swaying.study.cases[0].name
    titles = [view.title for view in map_views(swaying)]
    assert titles == [
        f"{name}, class B, {where}" for where in ("lab", "lab, along x", "deck", "deck, along x")
    ]
    groups = map_groups(swaying)
    assert {f"/maps/{name}/lab", f"/maps/{name}/lab/along x"} <= set(groups)
    assert groups[f"/maps/{name}/deck/along x"].attrs["motion"] == "along x"


def test_a_class_is_none_only_where_the_widest_curve_for_that_motion_fails():
    """A wide curve for vertical motion says nothing of level motion: -1 there, by the other alone."""
    wide, strict = (
        Criterion(
            name=name, title=name, quantity="band_rms_velocity", axis=axis, source="test",
            frequencies=np.array([8.0, 80.0]), limits=np.array([limit, limit]),
            averaging="none", confidence="test",
        )
        for name, axis, limit in (("wide", "vertical", 1e-3), ("strict", "each axis", 1e-4))
    )  # fmt: skip
    classes = ClassMap(
        places=np.zeros((3, 2)), criteria=(wide, strict),
        margin=np.array([[2.0, np.nan, np.nan], [0.5, 0.5, np.nan]]),
        governing_band=np.full((2, 3), 8.0), share_exceeding=np.zeros((2, 3)),
        applies=np.array([[True, False, True], [True, True, True]]),
        complete=(True, True), percentile=95.0,
    )  # fmt: skip
    assert classes.classes().tolist() == [0, -1, -2]
