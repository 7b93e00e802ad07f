"""What is written for other programs, read back by others' readers and by our own."""

import json
import os
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from models import small_floor
from studies import BUILDING, GOOD, MAP, run_main
from trundle import read_results, run_study, study_from_text
from trundle.errors import InputError
from trundle.exports import Subject, all_exports, export
from trundle.imports import Asked, read_model
from trundle.imports.modes_uff import read_universal_modes
from trundle.results.store import write_results
from trundle.run.playback import _blocks, playback_of
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    OrthotropicSection,
    PointMasses,
    RigidLinks,
    ShellGroup,
    SpringGroup,
    TriangleGroup,
)
from trundle.structure.elements import GROUND, NodeInertia, ReleasedBeams

STUFF = Material(elastic_modulus=3e10, poisson_ratio=0.2, density=2500.0)
VALIDATOR = Path(__file__).parents[2] / "build" / "node" / "node_modules" / "gltf-validator"


@pytest.fixture(scope="module")
def floor():
    return small_floor(mesh_size=2.0)


@pytest.fixture(scope="module")
def modes(floor):
    return floor.modes(40.0)


def test_a_grid_of_paraview_holds_mesh_and_modes(tmp_path, floor, modes):
    """Read by meshio: every node, every element, every mode's motion to single precision."""
    meshio = pytest.importorskip("meshio")
    export(Subject(structure=floor, modes=modes), tmp_path / "a.vtu")
    mesh = meshio.read(tmp_path / "a.vtu")
    np.testing.assert_array_equal(mesh.points, floor.nodes)
    counts = {
        kind: sum(len(b.data) for b in mesh.cells if b.type == kind) for kind in ("quad", "line")
    }
    assert counts["quad"] == sum(len(g.elements) for g in floor.shells)
    assert counts["line"] == sum(len(g.elements) for g in floor.beams)
    names = [name for name in mesh.point_data if "Hz" in name]
    assert len(names) == modes.n_modes
    vertical = floor.dof_index[:, 2]
    expected = np.where(vertical >= 0, modes.shapes[vertical, 3], 0.0)
    np.testing.assert_allclose(
        mesh.point_data[names[3]][:, 2], expected, atol=1e-6 * abs(expected).max()
    )


def test_a_scene_is_valid_and_moves_as_its_modes(tmp_path, floor, modes):
    """Khronos' validator finds nothing; nodes move by a twentieth of the floor's size."""
    (file,) = export(Subject(structure=floor, modes=modes), tmp_path / "a.glb")
    data = file.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    document = json.loads(data[20 : 20 + length])
    assert len(document["animations"]) == modes.n_modes
    moves = [
        max(map(abs, accessor["min"] + accessor["max"]))
        for mesh in document["meshes"]
        for accessor in [document["accessors"][mesh["primitives"][0]["targets"][0]["POSITION"]]]
    ]
    assert 0.6 * (1.0 - 1e-5) <= max(moves) < 0.62  # edges of bodies move by rotations too
    if not (VALIDATOR.is_dir() and shutil.which("node")):
        pytest.skip("no glTF validator: sh scripts/setup_gltf_validator.sh")
    script = (
        "const v = require('gltf-validator'); const fs = require('fs');"
        "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1])))"
        ".then(r => console.log(JSON.stringify(r.issues)));"
    )
    done = subprocess.run(
        ["node", "-e", script, str(file)], capture_output=True, text=True, check=True, timeout=60,
        cwd=VALIDATOR.parents[1], env=os.environ,
    )  # fmt: skip
    issues = json.loads(done.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"][:3]


def test_modes_come_back_from_a_universal_file(tmp_path, floor, modes):
    """Our own reader and pyuff's: frequencies and shapes to the file's six digits."""
    pyuff = pytest.importorskip("pyuff")
    export(Subject(structure=floor, modes=modes), tmp_path / "a.uff")
    sets = pyuff.UFF(str(tmp_path / "a.uff")).read_sets()
    shapes = [one for one in sets if one["type"] == 55]
    assert [one["freq"] for one in shapes] == pytest.approx(modes.frequencies.tolist(), rel=1e-5)
    read = read_universal_modes(tmp_path / "a.uff", reach=40.0)
    assert read.problems == ()
    model = read.structure
    assert len(model.surface().nodes) == len(floor.nodes)
    rows, theirs = floor.dof_index[:, 2], model.dof_index[:, 2]
    moving = rows >= 0
    np.testing.assert_allclose(
        model.shapes[theirs[moving]],
        modes.shapes[rows[moving]],
        atol=2e-5 * np.abs(modes.shapes).max(),
    )


def portal():
    """Everything that has a card: plates of two kinds, pins, offsets, springs, ties, inertia."""
    nodes = np.array(
        [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 3], [4, 0, 3], [4, 4, 3], [0, 4, 3],
         [8, 0, 3], [8, 4, 3], [2, 2, 3.5]]
    ).astype(float)  # fmt: skip
    ribbed = OrthotropicSection(
        bending=(4e7, 2e7, 3e6, 5e6), membrane=(6e9, 5e9, 1e9, 2e9), shear=(2e9, 1.5e9),
        mass_per_area=400.0, thickness=0.3, axis=np.array([0.6, 0.8, 0.0]),
    )  # fmt: skip
    column = BeamSection.rectangle(width=0.4, depth=0.6, material=STUFF)
    beam = replace(
        BeamSection.rectangle(width=0.3, depth=0.5, material=STUFF),
        shear_area_y=np.inf,
        shear_area_z=np.inf,
    )
    hinged = BeamGroup(elements=np.array([[4, 7]]), section=beam, name="hinged")
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    fixed[:2] = True
    fixed[2:4, [0, 2]] = True  # along turned axes
    angles = np.zeros((len(nodes), 2))
    angles[2:4] = 0.3
    return Floor(
        nodes=nodes,
        fixed=fixed,
        angles=angles,
        shells=(ShellGroup(elements=np.array([[4, 5, 6, 7]]), section=ribbed, name="ribs"),),
        beams=(
            BeamGroup(elements=np.array([[0, 4], [1, 5], [2, 6], [3, 7]]), section=column, name="columns"),
            BeamGroup(elements=np.array([[4, 5]]), section=beam, offset=np.array([0, 0, -0.4])),
        ),
        springs=(
            SpringGroup(elements=np.array([[8, GROUND]]), stiffness=np.array([0, 0, 3e7, 0, 2e6, 0])),
            SpringGroup(elements=np.array([[8, 9]]), stiffness=np.array([1e6, 0, 0, 0, 0, 0])),
        ),
        masses=(PointMasses(nodes=np.array([6]), mass=np.array([700.0])),),
        others=(
            TriangleGroup(connectivity=np.array([[5, 8, 6], [8, 9, 6]]), section=replace(ribbed, axis=np.array([1.0, 0, 0]))),
            ReleasedBeams(beams=hinged, released=np.array([[False, True, False], [False, True, True]])),
            NodeInertia(nodes=np.array([10]), inertia=np.array([[50, 60, 70, 5, 6, 7.0]])),
        ),
        links=(
            RigidLinks(leads=np.array([5]), follows=np.array([9]), dofs=np.array([1, 1, 0, 0, 0, 1], dtype=bool)),
            RigidLinks(leads=np.array([4]), follows=np.array([10])),
        ),
    )  # fmt: skip


def test_a_deck_says_all_of_a_model(tmp_path):
    """Every kind of part, written and read: both matrices to the fields' ten digits."""
    floor = portal()
    export(Subject(structure=floor), tmp_path / "a.bdf")
    read = read_model(tmp_path / "a.bdf", Asked(ignore=frozenset()))
    assert read.problems == ()
    again = read.structure
    for ours, theirs in zip(floor.matrices(), again.matrices(), strict=True):
        # rotary inertia of a plate has no field: what is compared besides is stiffness
        assert abs(ours - theirs).max() <= 2e-9 * abs(ours).max()


def test_buildings_come_back_from_their_decks(tmp_path):
    """Hinges, walls, heads that follow columns: the same modes."""
    building = study_from_text(BUILDING).floor
    export(Subject(structure=building), tmp_path / "b.bdf")
    again = read_model(tmp_path / "b.bdf").structure
    theirs, ours = (one.modes(40.0).frequencies for one in (again, building))
    np.testing.assert_allclose(theirs, ours, rtol=1e-6)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results") / "out"
    folder.mkdir()
    write_results(run_study(study_from_text(GOOD + MAP)), folder)  # without the report's pictures
    return folder


def test_a_crossing_is_the_first_run_of_its_study(tmp_path, results):
    """At a node where a point stands its displacement is the history's to 0.2 %; forces too."""
    result = read_results(results)
    study = result.study
    play = playback_of(study, n_frames=50)
    cell = next(iter(result.cells.values()))
    node = play.nodes.tolist().index(at_point(study.floor, 3.0, 3.0))
    steps = np.round(play.time / (cell.history.time[1] - cell.history.time[0])).astype(int)
    np.testing.assert_allclose(
        play.motion[:, node],
        cell.history.displacement[steps, 0],
        atol=2e-3 * np.abs(cell.history.displacement).max(),
    )
    np.testing.assert_allclose(
        play.wheels[0].forces, cell.history.contact_forces[steps], rtol=1e-6, atol=1.0
    )
    files = export(Subject(structure=study.floor, playback=play), tmp_path / "c.pvd")
    assert len(files) == 1 + 2 * len(play.time)
    meshio = pytest.importorskip("meshio")
    frame = meshio.read(tmp_path / "c-0025.vtu").point_data["displacement [m]"]
    np.testing.assert_allclose(frame[play.nodes, 2], play.motion[25], rtol=1e-6, atol=1e-12)


def test_a_crossing_step_by_step_is_its_run_too(monkeypatch):
    """Without modes the run is repeated for blocks of places: what a later block gives is the run.

    The point's history is computed in a run of the study by itself, with no other point.
    """
    direct = (
        GOOD.split("[criteria]")[0]
        .replace('f_max = "30 Hz"', 'integration = "newmark"')
        .replace('ratio = "3 %"', 'rayleigh_alpha = "0.5 1/s", rayleigh_beta = "0.2 ms"')
        .replace("runs = 2", "runs = 1")
        .replace('dt = "5 ms"', 'dt = "20 ms"')
    )
    study = study_from_text(direct)
    history = next(iter(run_study(study).cells.values())).history
    monkeypatch.setattr("trundle.run.playback._BYTES", 3 * 8 * len(history.time) * 20)
    play = playback_of(study, n_frames=50)
    node = play.nodes.tolist().index(at_point(study.floor, 3.0, 3.0))
    first, *others = _blocks(len(play.nodes), len(history.time) - 1)
    assert (len(others), node >= first.stop) == (2, True)
    steps = np.round(play.time / (history.time[1] - history.time[0])).astype(int)
    largest = np.abs(history.displacement[:, 0]).max()
    assert largest > 1e-5
    np.testing.assert_allclose(
        play.motion[:, node], history.displacement[steps, 0], atol=1e-9 * largest
    )
    np.testing.assert_allclose(play.wheels[0].forces, history.contact_forces[steps], rtol=1e-9)


def at_point(floor, x, y):
    """Return the node of the floor's slab nearest to a place."""
    away = np.hypot(floor.nodes[:, 0] - x, floor.nodes[:, 1] - y) + 10 * np.abs(floor.nodes[:, 2])
    return int(away.argmin())


def test_maps_are_polygons_with_classes(tmp_path, results):
    """Cells fill the floor of 12 x 6 m; 12 m towards the east are as many degrees of longitude."""
    result = read_results(results)
    subject = Subject(structure=result.study.floor, result=result)
    (file,) = export(subject, tmp_path / "m.geojson")
    found = json.loads(file.read_text())
    corners = np.array([f["geometry"]["coordinates"][0] for f in found["features"]])
    area = 0.5 * np.sum(
        corners[:, :-1, 0] * corners[:, 1:, 1] - corners[:, 1:, 0] * corners[:, :-1, 1], axis=1
    )
    maps = {f["properties"]["map"] for f in found["features"]}
    assert area.sum() == pytest.approx(72.0 * len(maps))
    assert {f["properties"]["class"] for f in found["features"]} <= {"none", "not assessed", "VC-A"}
    placed = replace(subject, origin=(8.5, 60.0), north=np.pi / 2.0)  # north along -x
    (file,) = export(placed, tmp_path / "m.geojson")
    corners = np.array(
        [f["geometry"]["coordinates"][0] for f in json.loads(file.read_text())["features"]]
    )
    assert np.ptp(corners[..., 1]) * np.pi / 180.0 * 6371008.8 == pytest.approx(12.0, rel=1e-4)
    assert np.ptp(corners[..., 0]) * np.pi / 180.0 * 6371008.8 * 0.5 == pytest.approx(6.0, rel=1e-4)


def test_what_cannot_be_written_is_told(tmp_path, floor, modes):
    with pytest.raises(InputError, match="needs modes"):
        export(Subject(structure=floor), tmp_path / "a.uff")
    with pytest.raises(InputError, match="of no format that is written; there are: "):
        export(Subject(structure=floor), tmp_path / "a.dwg")
    with pytest.raises(InputError, match="cannot be written"):
        export(Subject(structure=floor), tmp_path / "none" / "a.bdf")
    assert {one.kind for one in all_exports()} == {
        "geojson",
        "gltf",
        "nastran",
        "pvd",
        "uff",
        "vtu",
    }
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes(tmp_path, monkeypatch, capsys, results):
    (tmp_path / "s.toml").write_text(GOOD)
    for name in ("m.vtu", "m.glb", "m.bdf", "m.uff"):
        code, said = run_main(monkeypatch, capsys, "export", tmp_path / "s.toml", tmp_path / name)
        assert (code, str(tmp_path / name) in said.out) == (0, True)
    code, said = run_main(
        monkeypatch, capsys, "export", results, tmp_path / "p.pvd", "--frames", "3"
    )
    assert (code, "with 6 files beside it" in said.out) == (0, True)
    code, said = run_main(monkeypatch, capsys, "export", tmp_path / "m.bdf", tmp_path / "m.geojson")
    assert (code, "needs results of a study" in said.err) == (2, True)
    code, said = run_main(monkeypatch, capsys, "export", tmp_path / "m.bdf", tmp_path / "m.xyz")
    assert (code, "of no format that is written" in said.err) == (2, True)
