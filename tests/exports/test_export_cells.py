"""What viewers draw, read back by decoders of their own: cells, values, scenes, frames."""

import base64
import json
import struct
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from trundle.dynamics import Modes
from trundle.exports import Subject, export
from trundle.exports.cells import cells_of, shapes_at_nodes
from trundle.run.playback import Playback, Wheels
from trundle.structure import (
    CONCRETE,
    BeamGroup,
    BeamSection,
    Floor,
    PointMasses,
    RigidLinks,
    ShellGroup,
    ShellSection,
    SpringGroup,
    TriangleGroup,
)
from trundle.structure.elements import GROUND

NODES = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [4, 0, 0], [0, 0, -3]])
SLAB = ShellSection(thickness=0.2, material=CONCRETE)
UP = np.array([0.0, 0.0, 1e6, 0.0, 0.0, 0.0])
HOSTILE = "Süd <&\"'> --> ]]> \n 1, 2"


def floor(name="slab"):
    """A quadrilateral, a triangle, a column, springs to the ground and a mass."""
    fixed = np.zeros((6, 6), dtype=bool)
    fixed[5] = True
    return Floor(
        nodes=NODES,
        fixed=fixed,
        shells=(ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=SLAB, name=name),),
        beams=(
            BeamGroup(
                elements=np.array([[5, 0]]), section=BeamSection.rectangle(0.3, 0.5, CONCRETE)
            ),
        ),
        springs=(SpringGroup(elements=np.array([[2, GROUND], [3, GROUND]]), stiffness=UP),),
        masses=(PointMasses(nodes=np.array([1]), mass=300.0),),
        others=(TriangleGroup(connectivity=np.array([[1, 4, 2]]), section=SLAB, name="corner"),),
    )


def modes_of(structure, frequencies=(4.25, 9.5)):
    """Shapes that are no modes, of numbers that tell every dof apart."""
    n = structure.n_dofs
    shapes = np.arange(1.0, n * len(frequencies) + 1.0).reshape(len(frequencies), n).T
    return Modes(
        omega=2.0 * np.pi * np.array(frequencies), shapes=shapes,
        residuals=np.zeros(len(frequencies)), f_max=10.0,
    )  # fmt: skip


KINDS = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}


def arrays_of(path):
    """Decode all arrays of a grid by the file format alone: 8 bytes of length, then numbers."""
    found = {}
    for one in ET.parse(path).getroot().iter("DataArray"):
        raw = base64.b64decode(one.text)
        (length,) = struct.unpack("<Q", raw[:8])
        assert len(raw) == 8 + length
        values = np.frombuffer(raw[8:], dtype=KINDS[one.get("type")])
        found[one.get("Name")] = values.reshape(-1, int(one.get("NumberOfComponents", 1)))
    return found


def test_every_element_is_a_cell_of_its_corners(tmp_path):
    """By hand: quad, line, two points under springs, a point of the mass, a triangle."""
    export(Subject(structure=floor()), tmp_path / "a.vtu")
    found = arrays_of(tmp_path / "a.vtu")
    np.testing.assert_array_equal(found["points"], NODES)
    assert found["types"].ravel().tolist() == [9, 3, 1, 1, 1, 5]
    assert found["offsets"].ravel().tolist() == [4, 6, 7, 8, 9, 12]
    assert found["connectivity"].ravel().tolist() == [0, 1, 2, 3, 5, 0, 2, 3, 1, 1, 4, 2]
    assert found["group"].ravel().tolist() == [0, 1, 2, 2, 3, 4]
    assert cells_of(floor()).groups == ("slab", "beam", "spring", "point mass", "corner")


def test_springs_of_one_group_are_lines_and_points():
    """Between nodes a line, to the ground the point that it holds, whichever end is ground."""
    ends = np.array([[2, GROUND], [0, 4], [GROUND, 3]])
    one = replace(floor(), springs=(SpringGroup(elements=ends, stiffness=UP),))
    found = cells_of(one)
    blocks = {(name, block.shape[1]): block.tolist() for name, block in
              zip(found.groups, found.blocks, strict=True)}  # fmt: skip
    assert blocks["spring", 2] == [[0, 4]]
    assert blocks["spring", 1] == [[2], [3]]


def test_a_scene_without_modes_stands_still(tmp_path):
    """The same bodies, and neither targets nor animations; of no modes found alike."""
    one = floor()
    none = Modes(
        omega=np.zeros(0), shapes=np.zeros((one.n_dofs, 0)), residuals=np.zeros(0), f_max=1.0
    )
    for modes in (None, none):
        export(Subject(structure=one, modes=modes), tmp_path / "still.glb")
        document, _ = scene(tmp_path / "still.glb")
        assert "animations" not in document
        assert "targets" not in document["meshes"][0]["primitives"][0]
    export(Subject(structure=one, modes=modes_of(one)), tmp_path / "a.glb")
    moving, _ = scene(tmp_path / "a.glb")
    assert len(document["meshes"]) == len(moving["meshes"])


def test_shapes_are_in_the_order_of_mode_node_and_dof(tmp_path):
    """A number that tells mode, node and dof apart comes out where they say; held dofs are 0."""
    one = floor()
    modes = modes_of(one)
    at_nodes = shapes_at_nodes(one, modes)
    assert at_nodes.shape == (2, 6, 6)
    for mode, node, dof in ((0, 0, 2), (1, 4, 0), (1, 2, 5)):
        expected = 1.0 + one.dof_index[node, dof] + mode * one.n_dofs
        assert at_nodes[mode, node, dof] == expected
    assert not at_nodes[:, 5].any()
    export(Subject(structure=one, modes=modes), tmp_path / "a.vtu")
    found = arrays_of(tmp_path / "a.vtu")
    np.testing.assert_array_equal(found["mode 2, 9.5000 Hz"], at_nodes[1, :, :3])
    np.testing.assert_array_equal(found["mode 1, rotations"], at_nodes[0, :, 3:])


def test_a_node_that_follows_moves_in_the_file_too(tmp_path):
    """A rigid arm of 1 m along x under a rotation about y: the end sinks by the rotation."""
    one = floor()
    tied = Floor(
        nodes=np.vstack([NODES, [[3.0, 2.0, 0.0]]]), fixed=np.vstack([one.fixed, [[False] * 6]]),
        shells=one.shells, beams=one.beams,
        links=(RigidLinks(leads=np.array([2]), follows=np.array([6])),),
    )  # fmt: skip
    shape = np.zeros((tied.n_dofs, 1))
    shape[tied.dof_index[2, 4]] = 0.25
    modes = Modes(omega=np.array([30.0]), shapes=shape, residuals=np.zeros(1), f_max=10.0)
    export(Subject(structure=tied, modes=modes), tmp_path / "a.vtu")
    found = arrays_of(tmp_path / "a.vtu")["mode 1, 4.7746 Hz"]
    np.testing.assert_allclose(found[6], [0.0, 0.0, -0.25], atol=1e-7)
    np.testing.assert_allclose(found[2], 0.0, atol=1e-7)


def test_names_that_break_texts_break_no_file(tmp_path):
    """Marks of XML, the end of a comment, quotes and line ends in names of groups and of files."""
    stem = 'Halle <1> & "B" --'
    export(Subject(structure=floor(HOSTILE)), tmp_path / f"{stem}.vtu")
    assert len(arrays_of(tmp_path / f"{stem}.vtu")["types"]) == 6
    files = export(Subject(structure=floor(HOSTILE), playback=crossing()), tmp_path / f"{stem}.pvd")
    named = [one.get("file") for one in ET.parse(files[0]).getroot().iter("DataSet")]
    assert named == [one.name for one in files[1:]]
    odd = floor(HOSTILE)
    export(Subject(structure=odd, modes=modes_of(odd)), tmp_path / f"{stem}.glb")
    document, _ = scene(tmp_path / f"{stem}.glb")
    assert document["scenes"][0]["name"] == stem
    assert HOSTILE in [one["name"] for one in document["meshes"]]


def crossing():
    """Two frames of the motion of two nodes along a slope, and two wheels of which one has left."""
    return Playback(
        case="main", road="B", method="coupled", time=np.array([0.0, 0.125]),
        nodes=np.array([2, 0]), normals=np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]]),
        motion=np.array([[1e-3, -2e-3], [3e-3, 5e-3]]),
        wheels=(
            Wheels(
                name="car", contact_names=("front", "rear"),
                places=np.array([[[0.5, 1, 0], [1.5, 1, 0]], [[1.5, 1, 0], [2.5, 1, 0]]]),
                on=np.array([[True, True], [True, False]]),
                forces=np.array([[4e3, 5e3], [6e3, 0.0]]),
            ),
        ),
    )  # fmt: skip


def test_frames_hold_motion_along_the_normals_and_forces_that_press_down(tmp_path):
    """By hand: 5 mm along (0.6, 0, 0.8) is 3 and 4 mm; a wheel that has left is not drawn."""
    files = export(Subject(structure=floor(), playback=crossing()), tmp_path / "c.pvd")
    assert [one.name for one in files] == [
        "c.pvd", "c-0000.vtu", "c-0000-wheels.vtu", "c-0001.vtu", "c-0001-wheels.vtu",
    ]  # fmt: skip
    sets = list(ET.parse(files[0]).getroot().iter("DataSet"))
    assert [float(one.get("timestep")) for one in sets] == [0.0, 0.0, 0.125, 0.125]
    moved = arrays_of(files[3])["displacement [m]"]
    np.testing.assert_allclose(moved[[0, 2]], [[3e-3, 0, 4e-3], [0, 0, 3e-3]], rtol=1e-6)
    assert not moved[[1, 3, 4, 5]].any()
    both, last = (arrays_of(files[i]) for i in (2, 4))
    np.testing.assert_allclose(both["force on the floor [N]"][:, 2], [-4e3, -5e3])
    np.testing.assert_allclose(last["points"], [[1.5, 1.0, 0.0]])
    assert last["types"].ravel().tolist() == [1]


def scene(path):
    """Return the document and the numbers of a binary scene, by the container's own lengths."""
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    version, whole, length, kind = struct.unpack("<III4s", data[4:20])
    assert (version, whole, kind) == (2, len(data), b"JSON")
    assert length % 4 == 0
    rest = data[20 + length :]
    size, mark = struct.unpack("<I4s", rest[:8])
    assert (mark, len(rest) - 8) == (b"BIN\0", size)
    return json.loads(data[20 : 20 + length]), rest[8:]


def values(document, binary, number):
    one = document["accessors"][number]
    view = document["bufferViews"][one["bufferView"]]
    raw = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    kind = {5126: "<f4", 5125: "<u4"}[one["componentType"]]
    return np.frombuffer(raw, dtype=kind).reshape(one["count"], -1)


def test_a_scene_stands_upright_and_is_as_thick_as_its_slab(tmp_path):
    """The quaternion turns z into y; a slab of 0.2 m reaches from -0.1 to 0.1 m."""
    one = floor()
    export(Subject(structure=one, modes=modes_of(one)), tmp_path / "a.glb")
    document, binary = scene(tmp_path / "a.glb")
    x, y, z, w = document["nodes"][0]["rotation"]
    turned = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    np.testing.assert_allclose(turned, [0.0, 1.0, 0.0], atol=1e-12)
    slab = next(one for one in document["meshes"] if one["name"] == "slab")["primitives"][0]
    places = values(document, binary, slab["attributes"]["POSITION"])
    np.testing.assert_allclose([places[:, 2].min(), places[:, 2].max()], [-0.1, 0.1], rtol=1e-6)
    bounds = document["accessors"][slab["attributes"]["POSITION"]]
    np.testing.assert_allclose(bounds["max"], places.max(axis=0))
    assert values(document, binary, slab["indices"]).max() == len(places) - 1


def test_animations_swing_one_mode_each_through_a_whole_period(tmp_path):
    """A sine of one second: nought at its ends, and nothing of the other mode."""
    one = floor()
    export(Subject(structure=one, modes=modes_of(one)), tmp_path / "a.glb")
    document, binary = scene(tmp_path / "a.glb")
    assert [a["name"] for a in document["animations"]] == ["mode 1, 4.25 Hz", "mode 2, 9.50 Hz"]
    for i, animation in enumerate(document["animations"]):
        sampler = animation["samplers"][0]
        time = values(document, binary, sampler["input"]).ravel()
        weights = values(document, binary, sampler["output"]).reshape(len(time), 2)
        np.testing.assert_allclose(weights[:, i], np.sin(2 * np.pi * time), atol=1e-6)
        assert not weights[:, 1 - i].any()
        assert (time[0], time[-1]) == (0.0, 1.0)


def lines_of(path):
    return path.read_text().splitlines()


def test_a_universal_file_by_its_columns(tmp_path):
    """Columns of the datasets: places of 25 digits each, shapes six of 13, frequency and mass."""
    pytest.importorskip("pyuff")
    one = floor()
    modes = modes_of(one)
    export(Subject(structure=one, modes=modes), tmp_path / "a.uff")
    lines = lines_of(tmp_path / "a.uff")
    starts = [i for i, line in enumerate(lines) if line == "    -1"]
    kinds = [int(lines[i + 1]) for i in starts[::2]]
    assert kinds == [164, 2411, 2412, 55, 55]
    at = starts[2] + 2  # nodes: two lines each
    node = lines[at + 2 * 4 + 1]
    np.testing.assert_array_equal([float(node[25 * k : 25 * k + 25]) for k in range(3)], NODES[4])
    last = starts[-2] + 2
    assert lines[last].endswith("mode 2")
    header = lines[last + 7]
    assert [float(header[13 * k : 13 * k + 13]) for k in range(2)] == [9.5, 1.0]
    row = lines[last + 8 + 2 * 4 + 1]  # the fifth node
    found = [float(row[13 * k : 13 * k + 13]) for k in range(6)]
    np.testing.assert_allclose(found, shapes_at_nodes(one, modes)[1, 4], rtol=1e-5)
    faces = lines[starts[4] + 2 : starts[5]]
    assert [[int(w) for w in line.split()] for line in faces[1::2]] == [[1, 2, 3, 4], [2, 5, 3]]
    assert [int(line.split()[1]) for line in faces[::2]] == [94, 91]
