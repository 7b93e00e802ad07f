"""The scene of a page: packed numbers unpacked again, beside those that they were packed from."""

import base64
import json
from dataclasses import replace

import numpy as np
import pytest

from made_results import SECOND, made_study
from models import small_floor
from studies import BUILDING
from trundle.run.playback import Playback, Wheels
from trundle.structure import node_motion
from trundle.study_file.build import study_from_text
from trundle.views.scene import scene_of


def unpacked(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=kind)


@pytest.fixture(scope="module")
def floor():
    return small_floor(mesh_size=3.0)


@pytest.fixture(scope="module")
def building():
    return study_from_text(BUILDING.replace('mesh_size = "1.5 m"', 'mesh_size = "3 m"'))


def test_nodes_and_their_box_are_those_of_the_model(floor):
    """In single precision, x, y, z behind each other; corners of the box to the last digit."""
    scene = scene_of(floor, title="Ä, <b>")
    json.dumps(scene, allow_nan=False)
    nodes = unpacked(scene["nodes"], "<f4").reshape(-1, 3)
    np.testing.assert_allclose(nodes, floor.nodes, rtol=1e-6)
    assert scene["low"] == floor.nodes.min(axis=0).tolist()
    assert scene["high"] == floor.nodes.max(axis=0).tolist()
    assert scene["title"] == "Ä, <b>"
    assert (scene["modes"], scene["routes"], scene["points"], scene["crossing"]) == (
        [],
        [],
        [],
        None,
    )


@pytest.mark.parametrize("turned", [1.0, 100.0])
def test_modes_have_a_largest_translation_of_one(floor, turned):
    """Unpacked and scaled: shapes of the modes over their largest translation, sign and all.

    Where nodes turn by more than they move, rotations are whole too.
    """
    modes = floor.modes(40.0)
    shapes = modes.shapes.copy()
    rows = floor.dof_index[:, 3:]
    shapes[rows[rows >= 0]] *= turned
    modes = replace(modes, shapes=shapes)
    scene = scene_of(floor, title="a", modes=modes)
    assert [m["frequency"] for m in scene["modes"]] == modes.frequencies[:24].tolist()
    motions = np.stack([modes.seen(node_motion(floor, dof)) for dof in range(6)], axis=1)
    for i, mode in enumerate(scene["modes"]):
        found = unpacked(mode["motion"], "<i2").reshape(-1, 6) / 32767.0 * mode["scale"]
        expected = motions[:, :, i] / np.abs(motions[:, :3, i]).max()
        np.testing.assert_allclose(found, expected, atol=0.6 * mode["scale"] / 32767.0)
        assert np.abs(found[:, :3]).max() == pytest.approx(1.0, abs=1e-3)
        assert mode["scale"] == pytest.approx(max(1.0, np.abs(expected).max()))
    assert (max(mode["scale"] for mode in scene["modes"]) > 1.0) is (turned > 1.0)


def test_bodies_lie_on_the_storey_at_or_above_them(building):
    """Deck at 3 m and lab at 6.5 m: nodes of each part's triangles lie between the levels in the mean."""
    floor = building.floor
    scene = scene_of(floor, title="a")
    assert scene["storeys"] == ["deck", "lab"]
    assert scene["heights"] == [3.0, 6.5]
    for part in scene["solids"]:
        at = floor.nodes[unpacked(part["node"], "<u4")]
        middle = at[unpacked(part["triangles"], "<u4").reshape(-1, 3)][..., 2].mean(axis=1)
        low, high = ((-np.inf, 3.0), (3.0, 6.5))[part["storey"]]
        assert (middle > low + 0.05).all(), part["name"]
        if part["storey"] == 0:
            assert (middle <= high + 0.05).all(), part["name"]


def test_bodies_cut_by_storeys_are_whole_together(building):
    """Triangles of all parts are as many as those of the bodies, and no vertex is left over."""
    from trundle.views.solids import solids_of

    floor = building.floor
    scene = scene_of(floor, title="a")
    parts = {}
    for part in scene["solids"]:
        triangles = unpacked(part["triangles"], "<u4")
        n = len(unpacked(part["node"], "<u4"))
        assert set(triangles) == set(range(n))
        parts[part["name"]] = parts.get(part["name"], 0) + len(triangles) // 3
    whole = {}
    for solid in solids_of(floor):
        whole[solid.name] = whole.get(solid.name, 0) + len(solid.triangles)
    assert parts == whole


def test_supports_are_the_nodes_held_upwards(building):
    """Feet of the columns are fixed, those of the wall pinned: all at level 0, told apart."""
    scene = scene_of(building.floor, title="a")
    nodes = unpacked(scene["supports"]["node"], "<u4")
    fixed = np.array(scene["supports"]["fixed"])
    floor = building.floor
    assert set(nodes) == set(np.flatnonzero(floor.fixed[:, 2]))
    np.testing.assert_allclose(floor.nodes[nodes][:, 2], 0.0)
    np.testing.assert_array_equal(fixed, floor.fixed[nodes].all(axis=1))
    assert 0 < fixed.sum() < len(fixed)


def test_routes_and_points_are_where_the_study_has_them():
    """By hand: 12 m along y = 3 m, and back along y = 2 m; points with their names as they are."""
    study = made_study(SECOND)
    scene = scene_of(study.floor, title="a", study=study)
    level = study.floor.surface(None).frame.in_space(np.zeros((1, 2)))[0, 2]
    first, second = scene["routes"]
    assert (first["name"], second["name"]) == ("main", "=Zufahrt, Süd")
    np.testing.assert_allclose(
        [first["places"][0], first["places"][-1]], [[0, 3, level], [12, 3, level]]
    )
    np.testing.assert_allclose(
        [second["places"][0], second["places"][-1]], [[12, 2, level], [0, 2, level]]
    )
    assert [p["name"] for p in scene["points"]] == list(study.points)
    np.testing.assert_allclose(
        [p["place"] for p in scene["points"]], [[3, 3, level], [9, 1.5, level]]
    )


def test_a_crossing_is_packed_by_its_largest_motion(floor):
    """16 bits of the largest: 2 mm down is -1 of it; times, places and forces rounded, by hand."""
    motion = np.array([[0.0, 1e-3], [-2e-3, 5e-4], [2e-3, 0.0]])
    wheels = Wheels(
        name="main", contact_names=("axle 1",), places=np.array([[[0.12345, 3.0, 0.0]]] * 3),
        on=np.array([[True], [False], [True]]), forces=np.array([[1234.56], [0.0], [-5.4]]),
    )  # fmt: skip
    play = Playback(
        case="main", road="B", method="coupled", time=np.array([0.0, 0.123456, 0.2]),
        nodes=np.array([7, 3]), normals=np.array([[0.0, 0.0, 1.0]] * 2), motion=motion, wheels=(wheels,),
    )  # fmt: skip
    found = scene_of(floor, title="a", playback=play)["crossing"]
    assert (found["title"], found["largest"]) == ("main, class B, coupled", 2e-3)
    raw = unpacked(found["motion"], "<i2").reshape(3, 2)
    assert raw.tolist() == [[0, 16384], [-32767, 8192], [32767, 0]]
    assert found["time"] == [0.0, 0.1235, 0.2]
    assert unpacked(found["nodes"], "<u4").tolist() == [7, 3]
    (one,) = found["wheels"]
    assert one["places"][0] == [[0.123, 3.0, 0.0]]
    assert one["forces"] == [[1235.0], [0.0], [-5.0]]
    assert one["on"] == [[True], [False], [True]]


def test_a_crossing_in_which_nothing_moves_is_no_division_by_nothing(floor):
    """A still floor is drawn still: zeros, and numbers that JSON has."""
    play = Playback(
        case="a", road="B", method="m", time=np.zeros(1), nodes=np.zeros(1, int),
        normals=np.array([[0.0, 0.0, 1.0]]), motion=np.zeros((1, 1)), wheels=(),
    )  # fmt: skip
    found = scene_of(floor, title="a", playback=play)["crossing"]
    json.dumps(found, allow_nan=False)
    assert unpacked(found["motion"], "<i2").tolist() == [0]
