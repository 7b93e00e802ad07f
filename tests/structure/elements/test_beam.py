"""Straight members: invariance under rotation, eccentric axes, shear, twist, hinges."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.structure import BeamGroup, BeamSection, Floor, Material
from trundle.structure.elements import ReleasedBeams
from trundle.structure.elements.beam import beam_mass, beam_stiffness
from trundle.structure.frames import beam_frames

STEEL = Material(elastic_modulus=210e9, poisson_ratio=0.3, density=7850.0)
SECTION = BeamSection.rectangle(0.3, 0.7, STEEL)
SLENDER = replace(SECTION, shear_area_y=np.inf, shear_area_z=np.inf)
LENGTH = 2.5
ALONG_X = np.array([[[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0]]])
UP, NONE = np.array([0.0, 0.0, 1.0]), np.zeros(3)
E, G = STEEL.elastic_modulus, STEEL.shear_modulus
I_Y, I_Z = 0.3 * 0.7**3 / 12.0, 0.7 * 0.3**3 / 12.0


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def released(pins, section=SECTION, *, offset=NONE, up=UP):
    group = BeamGroup(elements=np.array([[0, 1]]), section=section, offset=offset, up=up)
    return ReleasedBeams(beams=group, released=np.array(pins, dtype=bool))


FREE = [[False] * 3] * 2
PIN, BOTH = [[False] * 3, [False, True, False]], [[False, True, True]] * 2


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_a_member_turned_in_space_is_the_member_turned(seed):
    """Invariant: matrices of the turned member are ``R K R^T``, offset, depth and hinges with it."""
    turn = rotation(seed)
    whole = np.kron(np.eye(4), turn)
    offset, up = np.array([0.2, -0.1, -0.45]), np.array([0.1, 0.3, 0.9])
    ends = ALONG_X + np.array([[[0.0, 0.0, 0.0], [0.3, -0.8, 0.4]]])
    for make in (beam_stiffness, beam_mass):
        level = make(ends, SECTION, offset=offset, up=up)[0]
        turned = make(ends @ turn.T, SECTION, offset=turn @ offset, up=turn @ up)[0]
        np.testing.assert_allclose(turned, whole @ level @ whole.T, atol=1e-9 * abs(level).max())
    one = released(PIN, offset=offset, up=up)
    other = released(PIN, offset=turn @ offset, up=turn @ up)
    for kind in ("stiffness_blocks", "mass_blocks"):
        level, turned = getattr(one, kind)(ends)[0], getattr(other, kind)(ends @ turn.T)[0]
        np.testing.assert_allclose(turned, whole @ level @ whole.T, atol=1e-9 * abs(level).max())


def test_a_member_named_from_its_other_end_is_the_same():
    """Invariant: start and end exchanged exchange the blocks; the depth points to the same side."""
    order = [*range(6, 12), *range(6)]
    ends = ALONG_X + np.array([[[0.0, 0.0, 0.0], [0.3, -0.8, 0.4]]])
    offset = np.array([0.0, 0.1, -0.4])
    for make in (beam_stiffness, beam_mass):
        one = make(ends, SECTION, offset=offset, up=UP)[0]
        other = make(ends[:, ::-1], SECTION, offset=offset, up=UP)[0]
        np.testing.assert_allclose(other[np.ix_(order, order)], one, atol=1e-9 * abs(one).max())


def test_every_entry_of_a_clamped_member_is_the_slope_deflection_formula():
    """Przemieniecki's table 5.1 with Phi = 12 E I / (G A_s L^2), in both planes, by hand."""
    k = beam_stiffness(ALONG_X, SECTION, offset=NONE, up=UP)[0]
    shear = G * 5.0 / 6.0 * 0.21
    for inertia, moved, turned, sign in ((I_Y, 2, 4, -1.0), (I_Z, 1, 5, 1.0)):
        phi = 12.0 * E * inertia / (shear * LENGTH**2)
        unit = E * inertia / (1.0 + phi) / LENGTH**3
        assert k[moved, moved] == pytest.approx(12.0 * unit, rel=1e-12)
        assert k[moved, moved + 6] == pytest.approx(-12.0 * unit, rel=1e-12)
        assert k[moved, turned] == pytest.approx(sign * 6.0 * unit * LENGTH, rel=1e-12)
        assert k[turned, turned] == pytest.approx((4.0 + phi) * unit * LENGTH**2, rel=1e-12)
        assert k[turned, turned + 6] == pytest.approx((2.0 - phi) * unit * LENGTH**2, rel=1e-12)
    assert k[0, 6] == pytest.approx(-E * 0.21 / LENGTH, rel=1e-12)
    assert k[3, 9] == pytest.approx(-G * SECTION.torsion_constant / LENGTH, rel=1e-12)


def test_the_depth_points_up_or_along_x_where_the_member_stands():
    """Local z by hand: level, on a slope, upright; upright members have their depth along x."""
    ends = np.array(
        [[[0, 0, 0], [0, 2, 0]], [[0, 0, 0], [3, 0, 4]], [[0, 0, 0], [0, 0, 5]]], dtype=float
    )
    lengths, frames = beam_frames(ends, UP)
    assert lengths.tolist() == [2.0, 5.0, 5.0]
    np.testing.assert_allclose(frames[:, 2], [[0, 0, 1], [-0.8, 0, 0.6], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0)
    # depth along x is none for a member along x: its depth is along z, whatever its sense
    level = np.array([[[0.0, 0, 0], [2, 0, 0]], [[2, 0, 0], [0, 0, 0]], [[0, 0, 0], [0, 2, 0]]])
    _, frames = beam_frames(level, np.array([1e-7, 0.0, 0.0]))
    np.testing.assert_allclose(frames[:, 2], [[0, 0, 1], [0, 0, 1], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0)
    with pytest.raises(InputError, match="up must be a direction"):
        beam_frames(ends, np.zeros(3))
    with pytest.raises(InputError, match="beam element 1 has no length"):
        beam_frames(np.concatenate([ends[:1], np.zeros((1, 2, 3))]), UP)


def tip_of(offset, load):
    """Deflect a cantilever by a load at its end node."""
    fixed = np.zeros((2, 6), dtype=bool)
    fixed[0] = True
    group = BeamGroup(elements=np.array([[0, 1]]), section=SLENDER, offset=offset)
    floor = Floor(nodes=ALONG_X[0], fixed=fixed, beams=(group,))
    return np.linalg.solve(floor.stiffness.toarray(), load)


def test_a_force_beside_the_axis_bends_by_its_lever():
    """Pull along x at a node 0.4 m above the axis: M = P e, so theta = P e L / E I.

    The node goes along by P L / E A and by theta times the lever, and down by M L^2 / 2 E I.
    """
    pull, lever = 1e5, 0.4
    tip = tip_of(np.array([0.0, 0.0, -lever]), np.array([pull, 0, 0, 0, 0, 0]))
    turned = pull * lever * LENGTH / (E * I_Y)
    assert tip[4] == pytest.approx(turned, rel=1e-9)
    assert tip[0] == pytest.approx(pull * LENGTH / (E * 0.21) + turned * lever, rel=1e-9)
    assert tip[2] == pytest.approx(-turned * LENGTH / 2.0, rel=1e-9)


def test_a_web_that_hangs_below_twists_about_the_nodes_without_shear():
    """Nodes turn about x and do not move: the energy is G J theta^2 / 2 L, however far it hangs."""
    twist = np.zeros(12)
    twist[9] = 1e-3
    energies = [
        0.5 * twist @ beam_stiffness(ALONG_X, SECTION, offset=np.array([0.0, 0, -e]), up=UP)[0]
        @ twist for e in (0.0, 0.45, 2.0)
    ]  # fmt: skip
    assert energies == pytest.approx(
        [0.5 * G * SECTION.torsion_constant * 1e-6 / LENGTH] * 3, rel=1e-9
    )


def test_the_mass_of_a_slender_member_is_the_textbooks():
    """156, 22 L, 54, -13 L over 420 without rotary inertia: Clough and Penzien, equation 10-29."""
    light = replace(SLENDER, inertia_y=1e-12, inertia_z=1e-12)
    m = beam_mass(ALONG_X, light, offset=NONE, up=UP)[0]
    unit = 7850.0 * 0.21 * LENGTH / 420.0
    plane = m[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])] / unit
    a = LENGTH
    expected = [
        [156, 22 * a, 54, -13 * a],
        [22 * a, 4 * a**2, 13 * a, -3 * a**2],
        [54, 13 * a, 156, -22 * a],
        [-13 * a, -3 * a**2, -22 * a, 4 * a**2],
    ]
    np.testing.assert_allclose(plane, expected, rtol=1e-6)
    assert m[0, 6] / (420.0 * unit) == pytest.approx(1.0 / 6.0, rel=1e-12)


def test_without_hinges_nothing_is_released():
    """Invariant: a member that lets nothing go is the member."""
    one = released(FREE, offset=np.array([0.1, 0.0, -0.4]))
    xyz = ALONG_X
    for kind in ("stiffness_blocks", "mass_blocks"):
        ours, plain = getattr(one, kind)(xyz), getattr(one.beams, kind)(xyz)
        np.testing.assert_allclose(ours, plain, atol=1e-12 * abs(plain).max())


def test_a_hinge_at_one_end_leaves_three_quarters_of_the_rest():
    """Propped: a cantilever that the hinged end pushes, and the moment of that at the other end.

    By statics L^3 / 3 E I and L / G A_s are its flexibility, and L times its force the moment.
    """
    k = released(PIN).stiffness_blocks(ALONG_X)[0]
    flexibility = LENGTH**3 / (3.0 * E * I_Y) + LENGTH / (G * 5.0 / 6.0 * 0.21)
    assert k[8, 8] == pytest.approx(1.0 / flexibility, rel=1e-9)
    assert k[4, 4] == pytest.approx(LENGTH**2 / flexibility, rel=1e-9)
    assert np.abs(k[10]).max() < 1e-9 * abs(k).max()  # nothing acts on the released rotation
    plain = released(FREE).stiffness_blocks(ALONG_X)[0]
    other = np.array([0, 1, 3, 5, 6, 7, 9, 11])  # what the hinge does not touch
    np.testing.assert_allclose(
        k[np.ix_(other, other)], plain[np.ix_(other, other)], atol=1e-9 * abs(plain).max()
    )


def test_a_member_hinged_at_both_ends_is_a_bar_whose_mass_follows_its_ends():
    """Straight between its ends: m / 3 and m / 6 across it, and no stiffness across."""
    one = released(BOTH)
    k, m = one.stiffness_blocks(ALONG_X)[0], one.mass_blocks(ALONG_X)[0]
    across = np.array([1, 2, 7, 8])
    assert np.abs(k[across]).max() < 1e-9 * abs(k).max()
    assert k[0, 0] == pytest.approx(E * 0.21 / LENGTH, rel=1e-12)
    mass = 7850.0 * 0.21 * LENGTH
    # sections turn with the line between the ends: rotary inertia rho I / L on top
    turned = 7850.0 * I_Y / LENGTH
    assert m[2, 2] == pytest.approx(mass / 3.0 + turned, rel=1e-9)
    assert m[2, 8] == pytest.approx(mass / 6.0 - turned, rel=1e-9)


@pytest.mark.parametrize("pins", [PIN, BOTH, [[True] * 3] * 2, [[True, False, True], [False] * 3]])
def test_hinges_take_no_mass_and_resist_no_rigid_motion(pins):
    """Invariant: six motions without energy, and the whole mass in each translation.

    In the local frame of a member aslant, hung below its nodes.
    """
    ends = ALONG_X + np.array([[[0.0, 0.0, 0.0], [0.3, -0.8, 0.4]]])
    one = released(pins, offset=np.array([0.1, 0.2, -0.4]))
    k, m = one.stiffness_blocks(ends)[0], one.mass_blocks(ends)[0]
    rigid = np.zeros((2, 6, 6))
    rigid[:, range(6), range(6)] = 1.0
    for axis in range(3):
        rigid[:, :3, 3 + axis] = np.cross(np.eye(3)[axis], ends[0])
    rigid = rigid.reshape(12, 6)
    assert np.abs(k @ rigid).max() < 1e-8 * abs(k).max()
    mass = 7850.0 * 0.21 * np.linalg.norm(ends[0, 1])
    np.testing.assert_allclose((rigid.T @ m @ rigid)[:3, :3], mass * np.eye(3), atol=1e-9 * mass)
    assert np.linalg.eigvalsh(m)[0] > -1e-9 * abs(m).max()


def test_torsion_that_both_ends_let_go_is_none_and_one_end_alone_is_none_either():
    """A bar that one end lets turn carries no torque at all: a moment has to go somewhere."""
    for ends in ([True, True], [True, False], [False, True]):
        pins = [[let, False, False] for let in ends]
        k = released(pins).stiffness_blocks(ALONG_X)[0]
        assert np.abs(k[[3, 9]]).max() < 1e-9 * abs(k).max()
        assert k[4, 4] > 0.0


def test_rotations_count_as_carried_while_one_end_holds_them():
    """All three let go at both ends: the nodes' rotations have no stiffness from it."""
    assert released([[True] * 3] * 2).carried.tolist() == [True] * 3 + [False] * 3
    assert released([[True] * 3, [True, True, False]]).carried.all()
