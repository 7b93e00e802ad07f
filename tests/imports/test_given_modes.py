"""Modes of tables by hand: scales, orders, what is known of each node, how far they reach."""

import numpy as np
import pytest

from trundle.imports import SurfaceChoice, units_of
from trundle.imports.modes import ModeFiles, read_modes

SI = units_of("N, m")
NODES = "node,x,y,z\nA,0,0,0\nB,4,0,0\nC,0,4,0\nD,4,4,0\n"


def read(tmp_path, frequencies, shapes, nodes=NODES, elements=None, **more):
    for name, text in (("f.csv", frequencies), ("s.csv", shapes), ("n.csv", nodes)):
        (tmp_path / name).write_text(text)
    if elements is not None:
        (tmp_path / "e.csv").write_text(elements)
    files = ModeFiles(
        frequencies=tmp_path / "f.csv", shapes=tmp_path / "s.csv", nodes=tmp_path / "n.csv",
        elements=None if elements is None else tmp_path / "e.csv",
    )  # fmt: skip
    return read_modes(files, **{"units": SI, **more})


def wide(*columns, names="ABCD"):
    heading = ",".join(["node", *(f"mode {i}" for i in range(1, len(columns) + 1))])
    rows = [
        ",".join([n, *map(str, c)]) for n, c in zip(names, zip(*columns, strict=True), strict=True)
    ]
    return "\n".join([heading, *rows]) + "\n"


def test_a_shape_is_divided_by_the_root_of_its_modal_mass(tmp_path):
    """1, 2, 3, 4 of 400 kg is 0.05 to 0.2 of unit mass; of mode 2, 2500 kg, a fiftieth."""
    found = read(
        tmp_path, "mode,frequency,modal_mass\n1,5,400\n2,8,2500\n",
        wide([1, 2, 3, 4], [5, 0, 0, 10]),
    )  # fmt: skip
    model = found.structure
    np.testing.assert_allclose(model.shapes[:, 0], [0.05, 0.1, 0.15, 0.2])
    np.testing.assert_allclose(model.shapes[:, 1], [0.1, 0.0, 0.0, 0.2])
    np.testing.assert_allclose(model.omega, 2.0 * np.pi * np.array([5.0, 8.0]))


def test_masses_of_a_model_in_kilonewtons_and_millimetres_are_a_million_kilograms(tmp_path):
    """0.0004 units of mass are 400 kg: shapes as of metres; places a thousandth."""
    millimetres = "node,x,y,z\nA,0,0,0\nB,4000,0,0\nC,0,4000,0\nD,4000,4000,0\n"
    found = read(
        tmp_path, "mode,frequency,modal_mass\n1,5,0.0004\n", wide([1, 2, 3, 4]),
        nodes=millimetres, units=units_of("kN, mm"),
    )  # fmt: skip
    np.testing.assert_allclose(found.structure.shapes[:, 0], [0.05, 0.1, 0.15, 0.2])
    np.testing.assert_allclose(found.structure.nodes[3], [4.0, 4.0, 0.0])


def test_rotations_of_a_model_in_millimetres_are_by_the_metre(tmp_path):
    """A slope of 0.002 a millimetre of deflection is 2 rad a metre, before the mass is taken."""
    shapes = "node,mode,uz,rx,ry\n" + "".join(f"{n},1,1,0.002,0\n" for n in "ABCD")
    millimetres = NODES.replace("4", "4000")
    found = read(
        tmp_path, "mode,frequency,modal_mass\n1,5,0.0001\n", shapes, nodes=millimetres,
        units=units_of("kN, mm"),
    )  # fmt: skip
    model = found.structure
    ratio = model.shapes[model.dof_index[:, 3], 0] / model.shapes[model.dof_index[:, 2], 0]
    np.testing.assert_allclose(ratio, 2.0)


def test_modes_given_in_any_order_rise(tmp_path):
    """Numbers name shapes, not their rank: mode 7 at 3 Hz is the first, with its own mass."""
    found = read(
        tmp_path, "mode,frequency,modal_mass\n2,8,100\n7,3,400\n",
        "node,mode,uz\n" + "".join(f"{n},2,1\n{n},7,6\n" for n in "ABCD"),
    )  # fmt: skip
    model = found.structure
    np.testing.assert_allclose(model.omega / 2.0 / np.pi, [3.0, 8.0])
    np.testing.assert_allclose(model.shapes[0], [6.0 / 20.0, 1.0 / 10.0])
    assert found.told[0] == "modes: 2, 3 to 8 Hz, taken to be all below 8 Hz"


def test_unit_masses_that_are_given_may_be_said_too_and_others_may_not(tmp_path):
    """Modal masses of 1 are what unit mass says; of 2 they contradict it."""
    one = "mode,frequency,modal_mass\n1,5,1\n"
    found = read(tmp_path, one, wide([1, 2, 3, 4]), unit_mass=True)
    np.testing.assert_allclose(found.structure.shapes[:, 0], [1, 2, 3, 4])
    found = read(tmp_path, one.replace("5,1", "5,2"), wide([1, 2, 3, 4]), unit_mass=True)
    assert found.structure is None
    assert "modal masses are given, and are not 1" in str(found.problems[0])


def test_how_far_modes_reach_is_said_or_is_that_of_the_last(tmp_path):
    """Said to reach 6 Hz, the mode of 8 Hz is not asked for; below the first none are known."""
    both = "mode,frequency,modal_mass\n1,5,1\n2,8,1\n"
    shapes = wide([1, 2, 3, 4], [1, 1, 1, 1])
    model = read(tmp_path, both, shapes, reach=6.0).structure
    assert model.modes(6.0).frequencies == pytest.approx([5.0])
    model = read(tmp_path, both, shapes).structure
    assert model.reach == pytest.approx(8.0, rel=1e-6)
    assert model.modes(model.reach).n_modes == 2
    found = read(tmp_path, both, shapes, reach=4.0)
    assert "no mode lies below 4 Hz; the first is at 5 Hz" in str(found.problems[0])


def test_what_is_known_in_one_mode_alone_is_asked_for(tmp_path):
    """A node with a shape in mode 1 and none in mode 2: zero would be a guess."""
    shapes = "node,mode,uz\n" + "".join(f"{n},1,1\n{n},2,2\n" for n in "ABC") + "D,1,4\n"
    found = read(tmp_path, "mode,frequency,modal_mass\n1,5,1\n2,8,1\n", shapes)
    assert "known in some modes and not in others" in str(found.problems[0])


def test_a_node_that_is_stood_on_must_have_been_measured(tmp_path):
    """A face with a corner of which nothing is known has no deflection there."""
    found = read(
        tmp_path, "mode,frequency,modal_mass\n1,5,1\n", wide([1, 2, 3], names="123"),
        nodes="node,x,y,z\n1,0,0,0\n2,4,0,0\n3,0,4,0\n4,4,4,0\n",
        elements="node 1,node 2,node 3,node 4\n1,2,4,3\n",
    )  # fmt: skip
    assert "node 4 is stood on, and its vertical motion is not known" in str(found.problems[0])


def test_level_motion_that_is_known_in_part_is_not_used(tmp_path):
    """ux at two of four nodes: between them and the rest it would be too small, so it is none."""
    shapes = "node,mode,ux,uz\nA,1,1,1\nB,1,1,1\nC,1,,1\nD,1,,1\n"
    model = read(tmp_path, "mode,frequency,modal_mass\n1,5,1\n", shapes).structure
    assert (model.dof_index[:, 0] == -1).all()
    assert (model.dof_index[:, 2] >= 0).all()
    whole = shapes.replace("1,,1", "1,3,1")
    model = read(tmp_path, "mode,frequency,modal_mass\n1,5,1\n", whole).structure
    assert model.shapes[model.dof_index[:, 0], 0].tolist() == [1.0, 1.0, 3.0, 3.0]


def test_two_levels_are_two_surfaces_and_one_may_be_chosen(tmp_path):
    """Nodes at 0 and at 3 m are joined each with those of its own level."""
    upper = "".join(f"{n},{x},{y},3\n" for n, x, y in (("E", 0, 0), ("F", 4, 0), ("G", 0, 4)))
    shapes = wide([1, 2, 3, 4, 5, 6, 7], names="ABCDEFG")
    frequencies = "mode,frequency,modal_mass\n1,5,1\n"
    model = read(tmp_path, frequencies, shapes, nodes=NODES + upper).structure
    assert list(model.surfaces) == ["z = 0 m", "z = 3 m"]
    upstairs = model.surface("z = 3 m").holds(np.array([[1.0, 1.0], [3.5, 3.5]]))
    assert upstairs.tolist() == [True, False]
    choice = (SurfaceChoice(name="lab", height=3.0),)
    model = read(tmp_path, frequencies, shapes, nodes=NODES + upper, surfaces=choice).structure
    assert list(model.surfaces) == ["lab"]
