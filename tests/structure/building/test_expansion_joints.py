"""Joints between buildings: springs that rigid motions do not stretch, and two halves that feel each other."""

import numpy as np
import pytest

import trundle as tr
from trundle.errors import InputError, StudyError
from trundle.structure import Floor
from trundle.structure.building import Joint
from trundle.structure.elements import JointSprings, SpringGroup
from trundle.structure.superelements import Cuts, Parting

HALVES = """
title = "Two halves"
seed = 1
runs = 2

[building]
mesh_size = "1.5 m"

[building.materials.c]
elastic_modulus = "30 GPa"
density = "2500 kg/m3"

[building.sections.col]
shape = "rectangle"
width = "0.4 m"
depth = "0.4 m"
material = "c"

[building.plates.slab]
thickness = "0.25 m"
material = "c"

[[building.storey]]
name = "base"
level = "-4 m"

[[building.storey]]
name = "floor"
level = "0 m"

[[building.slab]]
on = "floor"
plate = "slab"
outline = [["0 m", "0 m"], ["6 m", "0 m"], ["6 m", "6 m"], ["0 m", "6 m"]]

[[building.slab]]
on = "floor"
plate = "slab"
outline = [["6.02 m", "0 m"], ["12.02 m", "0 m"], ["12.02 m", "6 m"], ["6.02 m", "6 m"]]

[[building.column]]
section = "col"
at = [["1 m", "1 m"], ["5 m", "1 m"], ["5 m", "5 m"], ["1 m", "5 m"],
      ["7.02 m", "1 m"], ["11.02 m", "1 m"], ["11.02 m", "5 m"], ["7.02 m", "5 m"]]
from = "base"
to = "floor"
base = "fixed"

[vehicle.truck]
kind = "container_truck_40ft"

[[route]]
name = "main"
on = "floor"
vehicle = "truck"
path = [["0 m", "3 m"], ["6 m", "3 m"]]
speed = "15 km/h"

[[road]]
class = "B"

[[point]]
name = "tool"
on = "floor"
at = ["9 m", "3 m"]

[[method]]
name = "coupled"
interaction = "coupled"
f_max = "40 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
"""
JOINT = """
[[building.joint]]
on = "floor"
along = [["6 m", "0 m"], ["6 m", "6 m"]]
to = [["6.02 m", "6 m"], ["6.02 m", "0 m"]]
springs = { SPRINGS }
"""


def study_with(springs=None, **changes):
    text = HALVES
    if springs is not None:
        joint = JOINT.replace("SPRINGS", springs)
        for old, new in changes.get("instead", ()):
            assert joint.count(old) == 1
            joint = joint.replace(old, new)
        at = text.index("[vehicle.truck]")
        text = text[:at] + joint + "\n" + text[at:]
    return tr.study_from_text(text)


def some_springs(n=5):
    rng = np.random.default_rng(3)
    return (
        JointSprings(elements=np.arange(2 * n).reshape(n, 2), stiffness=rng.uniform(1, 9, (n, 3))),
        rng.normal(size=(n, 2, 3)),
    )


def test_rigid_motions_stretch_nothing():
    """Both nodes moved as one body, along and about any axis: no force, to round-off."""
    group, xyz = some_springs()
    blocks = group.stiffness_blocks(xyz)
    np.testing.assert_allclose(blocks, np.swapaxes(blocks, 1, 2), atol=1e-12)
    for axis in range(3):
        unit = np.eye(3)[axis]
        moved = np.concatenate([np.tile(unit, (len(xyz), 2, 1)), np.zeros_like(xyz)], axis=2)
        turned = np.concatenate([np.cross(unit, xyz), np.tile(unit, (len(xyz), 2, 1))], axis=2)
        for motion in (moved, turned):
            forces = np.einsum("nij,nj->ni", blocks, motion.reshape(len(xyz), 12))
            np.testing.assert_allclose(forces, 0.0, atol=1e-12)
    assert (np.linalg.matrix_rank(blocks) == 3).all()


def test_what_is_stretched_holds_the_energy_of_its_springs():
    """One end moved by d: sum of k d^2; turned by a small angle: the arm's end moves by theta x r."""
    group, xyz = some_springs()
    blocks = group.stiffness_blocks(xyz)
    d, theta = np.array([0.3, -0.2, 0.5]), np.array([0.1, 0.4, -0.2])
    motion = np.zeros((len(xyz), 12))
    motion[:, :3], motion[:, 3:6] = d, theta
    energy = np.einsum("ni,nij,nj->n", motion, blocks, motion)
    ends = d + np.cross(theta, 0.5 * (xyz[:, 1] - xyz[:, 0]))
    np.testing.assert_allclose(energy, np.sum(group.stiffness * ends**2, axis=1), rtol=1e-12)


def test_a_force_goes_through_a_joint_as_through_springs_in_series():
    """Node 0 on k1, node 1 on k2, kj between: u1 / u0 = kj / (k2 + kj), u0 by the sum of both ways."""
    k1, k2, kj, force = 3e6, 5e6, 2e6, 1e3
    floor = Floor(
        nodes=np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.02]]),
        fixed=np.array([[1, 1, 0, 1, 1, 1]] * 2, dtype=bool),
        springs=(
            SpringGroup(elements=np.array([[0, -1]]), stiffness=np.array([0, 0, k1, 0, 0, 0])),
            SpringGroup(elements=np.array([[1, -1]]), stiffness=np.array([0, 0, k2, 0, 0, 0])),
        ),
        others=(JointSprings(elements=np.array([[0, 1]]), stiffness=np.array([[0, 0, kj]])),),
    )
    _, stiffness = floor.matrices()
    moved = np.linalg.solve(stiffness.toarray(), np.array([force, 0.0]))
    series = 1.0 / (1.0 / k2 + 1.0 / kj)
    np.testing.assert_allclose(moved[0], force / (k1 + series), rtol=1e-12)
    np.testing.assert_allclose(moved[1] / moved[0], kj / (k2 + kj), rtol=1e-12)


def test_a_soft_joint_leaves_two_buildings_and_a_stiff_one_makes_one():
    """Alone, both halves have each frequency twice; held together nothing comes before them (Rayleigh)."""
    alone = study_with().floor.modes(30.0).frequencies
    soft = study_with('uz = "1 N/m/m"').floor.modes(30.0).frequencies
    stiff = study_with('ux = "1e10 N/m/m", uy = "1e10 N/m/m", uz = "1e10 N/m/m"').floor
    np.testing.assert_allclose(soft, alone, rtol=1e-6)
    together = stiff.modes(30.0).frequencies
    assert (together >= alone[: len(together)] * (1.0 - 1e-9)).all()
    assert len(together) < len(alone)


def test_nothing_comes_through_without_a_joint_and_more_through_a_stiffer_one():
    """The tool stands on the other half: still without a joint, louder the stiffer it is."""
    levels = []
    for springs in ('uz = "1e4 N/m/m"', 'uz = "1e6 N/m/m"'):
        cell = next(iter(tr.run_study(study_with(springs)).cells.values()))
        levels.append(float(np.median(cell.rms_velocity)))
    assert 0.0 < levels[0] < levels[1]
    still = next(iter(tr.run_study(study_with()).cells.values()))
    assert np.max(still.rms_velocity) < 1e-9 * levels[0]


def test_a_building_cut_along_its_joint_has_the_modes_of_the_whole():
    """Springs belong to the cut; parts kept far above what is asked for leave frequencies as they are."""
    floor = study_with('ux = "1e7 N/m/m", uz = "5e7 N/m/m"').floor
    whole = floor.modes(20.0).frequencies
    parting = Parting(cuts=Cuts(x=np.array([6.01])), f_parts=400.0, f_seams=1000.0)
    np.testing.assert_allclose(parting.of(floor).modes(20.0).frequencies, whole, rtol=1e-4)


@pytest.mark.parametrize(
    ("instead", "place", "rule"),
    [
        ([('uz = "1 MN/m/m"', "")], "building.joint[1].springs", "a spring at least"),
        ([('"6.02 m", "6 m"', '"9 m", "6 m"')], "building.joint[1].to", "face each other"),
        ([('"6 m", "0 m"', '"6 m", "2 m"')], "building.joint[1].to", "face each other"),
        ([('on = "floor"', 'on = "roof"')], "building.joint[1].on", "name of a storey"),
        ([('["6.02 m", "6 m"]', '["6.01 m", "6 m"]')], "building.joint[1].to", "on a slab"),
    ],
)
def test_joints_that_cannot_be_are_refused(instead, place, rule):
    with pytest.raises(StudyError) as caught:
        study_with('uz = "1 MN/m/m"', instead=instead)
    found = [p for p in caught.value.problems if p.place.startswith(place)]
    assert found, [str(p) for p in caught.value.problems]
    assert rule in found[0].rule


def test_values_are_checked():
    line = np.array([[0.0, 0.0], [0.0, 1.0]])
    with pytest.raises(InputError, match="0 or more"):
        Joint(on="a", along=line, to=line, springs=(-1.0, 0.0, 0.0))
    with pytest.raises(InputError, match="0 or more"):
        JointSprings(elements=np.array([[0, 1]]), stiffness=np.array([[-1.0, 0, 0]]))
