"""Places in elements: found where they were put, and weights against finite differences."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.structure import Hat, Hermite
from trundle.structure.elements import FaceGroup, NodeInertia, SpringGroup
from trundle.structure.elements.standing import (
    ETA,
    XI,
    line_locate,
    line_weights,
    quad_locate,
    quad_weights,
    triangle_locate,
    triangle_weights,
)

QUAD = np.array([[0.0, 0.0], [2.1, 0.2], [1.8, 1.5], [-0.2, 1.1]])
TRIANGLE, LINE = QUAD[:3], QUAD[[0, 2]]
RNG = np.random.default_rng(7)


def repeat(corners, n):
    return np.repeat(corners[None], n, axis=0)


def in_quad(local):
    shape = 0.25 * (1 + local[:, :1] * XI) * (1 + local[:, 1:] * ETA)
    return shape @ QUAD


def turn(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def test_a_place_in_a_quadrilateral_is_found_where_it_was_put():
    """Bilinear map and its inverse, within, on corners and outside, to round-off."""
    local = np.vstack([RNG.uniform(-1, 1, (40, 2)), np.stack([XI, ETA], axis=1), [[1.3, -0.2]]])
    found = quad_locate(repeat(QUAD, len(local)), in_quad(local))
    np.testing.assert_allclose(found.local[:-1], local[:-1], atol=1e-12)
    np.testing.assert_allclose(found.outside, np.abs(local).max(axis=1) - 1.0, atol=1e-12)
    assert found.local[-1].tolist() == pytest.approx([1.0, -0.2])  # moved onto its side


def test_a_place_outside_a_quadrilateral_is_never_found_within():
    """Newton wanders from some places outside: the first ended at (-0.60, -0.88), 4 m from it.

    Of the others the sides decide: within a convex element all of them lie on the left.
    """
    beside = np.array([[[14.0, 3.0], [12.0, 2.0], [12.0, 0.0], [15.7, 0.2]]])
    assert quad_locate(beside, np.array([[11.0, 3.9]])).outside[0] > 0.0
    corners = RNG.uniform(-1, 1, (20_000, 4, 2))
    sides = np.roll(corners, -1, axis=1) - corners
    turns = turn(sides, np.roll(sides, -1, axis=1))
    corners, sides = corners[keep := (turns > 0.05).all(axis=1)], sides[keep]
    places = corners.mean(axis=1) + RNG.uniform(-1.5, 1.5, (len(corners), 2))
    left = turn(sides, places[:, None] - corners).min(axis=1)
    outside = quad_locate(corners, places).outside
    clear = np.abs(left) > 1e-9  # nobody decides of places on a side
    assert clear.sum() > 1000
    assert ((outside > 0.0) == (left < 0.0))[clear].all()


def test_a_place_in_a_triangle_is_found_by_its_areas():
    """Area coordinates of (1, 0, 0), of the middle, and of a place beyond a side."""
    places = np.array([TRIANGLE[0], TRIANGLE.mean(axis=0), 0.7 * (TRIANGLE[1] + TRIANGLE[2])
                       - 0.4 * TRIANGLE[0]])  # fmt: skip
    found = triangle_locate(repeat(TRIANGLE, 3), places)
    np.testing.assert_allclose(found.local, [[0, 0], [1 / 3, 1 / 3], [0.5, 0.5]], atol=1e-12)
    np.testing.assert_allclose(found.outside, [0.0, -1.0 / 3.0, 0.4], atol=1e-12)


def test_a_place_beside_a_line_is_not_on_it():
    """A quarter along is -0.5; 0.9 millionths of the length beside is on it, and two are not."""
    along = LINE[1] - LINE[0]
    across = np.array([-along[1], along[0]])
    places = LINE[0] + np.array([0.25, 0.25, 0.25, 1.1])[:, None] * along
    places += np.array([0.0, 9e-7, 2e-6, 0.0])[:, None] * across
    found = line_locate(repeat(LINE, 4), places)
    np.testing.assert_allclose(found.local[:2, 0], -0.5, atol=1e-12)
    assert found.outside[:2] == pytest.approx([-0.5, -0.5])
    assert found.outside[2] == np.inf
    assert found.outside[3] == pytest.approx(0.2)


KINDS = [
    (QUAD, quad_locate, quad_weights),
    (TRIANGLE, triangle_locate, triangle_weights),
]


@pytest.mark.parametrize("shape", [Hermite(), Hat()])
@pytest.mark.parametrize(("corners", "locate", "weights"), KINDS, ids=["quad", "triangle"])
def test_gradients_are_the_derivatives_of_values(corners, locate, weights, shape):
    """Central differences in x and y of what any motion of the nodes gives, at places within."""
    n, h = 12, 1e-6
    share = RNG.dirichlet(np.full(len(corners), 3.0), n)
    places, motion = share @ corners, RNG.standard_normal(3 * len(corners))
    many = repeat(corners, n)

    def value(at):
        return weights(locate(many, at).local, many, shape).value @ motion

    gradient = weights(locate(many, places).local, many, shape).gradient @ motion
    for axis in (0, 1):
        step = h * np.eye(2)[axis]
        np.testing.assert_allclose(
            gradient[:, axis], (value(places + step) - value(places - step)) / (2 * h), atol=1e-6
        )


@pytest.mark.parametrize("shape", [Hermite(), Hat()])
@pytest.mark.parametrize(("corners", "locate", "weights"), KINDS, ids=["quad", "triangle"])
def test_a_node_gives_its_own_motion(corners, locate, weights, shape):
    """At a corner the deflection is that node's alone, and smooth slopes are its rotations."""
    n = len(corners)
    many = repeat(corners, n)
    found = weights(locate(many, corners).local, many, shape)
    expected = np.zeros((n, 3 * n))
    expected[range(n), 3 * np.arange(n)] = 1.0
    np.testing.assert_allclose(found.value, expected, atol=1e-12)
    if not shape.kinks:
        slopes = np.zeros((n, 2, 3 * n))
        slopes[range(n), 0, 3 * np.arange(n) + 2] = -1.0  # dw/dx = -ry
        slopes[range(n), 1, 3 * np.arange(n) + 1] = 1.0  # dw/dy = rx
        np.testing.assert_allclose(found.gradient, slopes, atol=1e-9)


def test_a_line_gives_the_cubic_through_its_ends():
    """w = s^3 along a line of length L, s from its start: slopes 0 and 3 L^2 give it exactly."""
    along = LINE[1] - LINE[0]
    length = np.hypot(*along)
    unit = along / length
    share = np.array([0.0, 0.2, 0.65, 1.0])
    local = np.stack([2.0 * share - 1.0, np.zeros(4)], axis=1)
    found = line_weights(local, repeat(LINE, 4), Hermite())
    slope = 3.0 * length**2 * unit  # dw/dx, dw/dy at the end
    motion = np.array([0.0, 0.0, 0.0, length**3, slope[1], -slope[0]])
    np.testing.assert_allclose(found.value @ motion, (share * length) ** 3, atol=1e-12)
    expected = 3.0 * (share * length)[:, None] ** 2 * unit
    np.testing.assert_allclose(found.gradient @ motion, expected, atol=1e-12)
    with pytest.raises(InputError, match="must have a length in plan"):
        line_weights(local[:1], np.zeros((1, 2, 2)), Hat())


def test_faces_without_rotations_run_straight():
    """Hermite asked for, and nothing known of rotations: the middle is the mean of the corners."""
    corners, middle = repeat(QUAD, 1), np.zeros((1, 2))
    numbers = np.array([[0, 1, 2, 3]])
    stiff = FaceGroup(connectivity=numbers, smooth=False).weights(middle, corners, Hermite())
    np.testing.assert_allclose(stiff.value.reshape(4, 3), [[0.25, 0, 0]] * 4)
    smooth = FaceGroup(connectivity=numbers).weights(middle, corners, Hermite())
    assert np.abs(smooth.value.reshape(4, 3)[:, 1:]).min() > 0.01
    with pytest.raises(InputError, match="a face has two to four corners; got 5"):
        FaceGroup(connectivity=np.array([[0, 1, 2, 3, 4]]))


def test_springs_and_inertia_say_what_they_carry_and_refuse_what_cannot_be():
    """Dofs of a stiffness or an inertia of 0 are not carried; nothing may be below 0."""
    spring = SpringGroup(elements=np.array([[0, 1]]), stiffness=np.array([2.0, 0, 3, 0, 0, 5]))
    assert spring.carried.tolist() == [True, False, True, False, False, True]
    (block,) = spring.stiffness_blocks(np.zeros((1, 2, 3)))
    x = np.arange(1.0, 13.0)
    # both ends apart by 6 in every dof
    assert x @ block @ x == pytest.approx(36.0 * (2 + 3 + 5))
    inertia = NodeInertia(nodes=np.array([0, 1]), inertia=np.array([[1.0, 0, 0, 0, 0, 0],
                                                                    [0, 0, 0, 0, 4, 0]]))  # fmt: skip
    assert inertia.carried.tolist() == [True, False, False, False, True, False]
    for make in (
        lambda: SpringGroup(elements=np.array([[0, 1]]), stiffness=np.full(6, -1.0)),
        lambda: NodeInertia(nodes=np.array([0]), inertia=np.full((1, 6), -1.0)),
    ):
        with pytest.raises(InputError, match="must be 0 or more"):
            make()
