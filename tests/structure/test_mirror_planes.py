"""Planes of symmetry, frames of surfaces, and places: by trigonometry and by going there and back."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.structure import Frame, MirrorPlane, Spot, Spots
from trundle.structure.building.held import Support, share_inside

ACROSS_X, ACROSS_Y = MirrorPlane.across(0, 2.0), MirrorPlane.across(1, -1.0)


def test_a_plane_through_two_places_holds_both_and_knows_its_sides():
    """45 degrees through (1, 0) and (3, 2): (3, 0) lies sqrt 2 away on the side of (1, -1)."""
    plane = MirrorPlane.through(np.array([[1.0, 0.0], [3.0, 2.0]]))
    np.testing.assert_allclose(plane.away(np.array([[1.0, 0], [3, 2], [5, 4]])), 0.0, atol=1e-12)
    np.testing.assert_allclose(plane.away(np.array([[3.0, 0.0, 9.0]])), np.sqrt(2.0))
    assert str(plane) == "through (0.5, -0.5) m along 45 degrees"
    longer = MirrorPlane(normal=np.array([3.0, -3.0]), position=plane.position)
    np.testing.assert_allclose(longer.normal, plane.normal)


def test_a_plane_faces_the_side_on_which_most_of_a_model_is():
    """Turned round its normal and its position change sign; the plane stays where it is."""
    left = ACROSS_X.facing(np.array([[0.0, 5.0], [1.0, 9.0], [2.5, 0.0]]))
    np.testing.assert_array_equal(left.normal, [-1.0, 0.0])
    np.testing.assert_allclose(left.away(np.array([[2.0, 7.0], [0.0, 0.0]])), [0.0, 2.0])
    assert (str(left), str(ACROSS_X), str(ACROSS_Y)) == ("x = 2 m", "x = 2 m", "y = -1 m")
    assert ACROSS_X.facing(np.array([[3.0, 0.0]])) is ACROSS_X


def test_planes_at_an_angle_leave_that_share_of_what_stands_where_they_meet():
    """Two at a right angle leave a quarter, at 45 degrees an eighth, one alone a half, none all.

    The model lies between them, where both normals point.
    """
    axis = np.array([[[0.0, 0.0]]])
    for degrees, share in ((90.0, 0.25), (45.0, 0.125), (120.0, 1.0 / 3.0)):
        turn = np.radians(degrees)
        one = MirrorPlane(normal=np.array([0.0, 1.0]), position=0.0)
        other = MirrorPlane(normal=np.array([np.sin(turn), -np.cos(turn)]), position=0.0)
        assert one.angle_to(other) == pytest.approx(turn)
        assert share_inside(axis, [one, other]).tolist() == pytest.approx([share])
    along = np.array([[[1.0, 0.0], [4.0, 0.0]], [[0.0, 0.0], [0.0, 3.0]], [[1.0, 0.0], [1, 3.0]]])
    assert share_inside(along, [MirrorPlane.across(1, 0.0)]).tolist() == [0.5, 1.0, 1.0]
    assert share_inside(along, []).tolist() == [1.0] * 3


@pytest.mark.parametrize("normal", [np.zeros(2), np.array([np.nan, 1.0])])
def test_a_plane_without_a_direction_is_refused(normal):
    """Nought has no direction, nor has what is not a number."""
    with pytest.raises(InputError, match="normal"):
        MirrorPlane(normal=normal, position=0.0)


SLOPE = Frame.through(np.array([3.0, 0.3, -0.4]))


def test_a_slope_is_the_plane_that_it_is_said_to_be():
    """Places of z = 3 + 0.3 x - 0.4 y have height 0 over it, and a metre above it is a metre."""
    xy = np.random.default_rng(2).uniform(-5, 5, (20, 2))
    on = np.column_stack([xy, 3.0 + xy @ [0.3, -0.4]])
    np.testing.assert_allclose(SLOPE.coordinates(on)[:, 2], 0.0, atol=1e-12)
    above = SLOPE.coordinates(on + 2.5 * SLOPE.normal)
    np.testing.assert_allclose(above[:, 2], 2.5)
    np.testing.assert_allclose(above[:, :2], SLOPE.coordinates(on)[:, :2], atol=1e-12)
    assert SLOPE.x_axis[1] == 0.0  # its x runs along that of the plan


@pytest.mark.parametrize(
    "frame",
    [SLOPE, Frame.level(7.0), Frame(origin=np.array([1.0, 2.0, 3.0]), x_axis=np.array([0, 1.0, 0]),
                                    y_axis=np.array([-1.0, 0, 0]))],
)  # fmt: skip
def test_places_go_to_a_surface_and_back(frame):
    """Straight up from the plan, into space, down again: the place one began with."""
    xy = np.random.default_rng(4).uniform(-9, 9, (20, 2))
    there = frame.from_plan(xy)
    np.testing.assert_allclose(frame.to_plan(there), xy, atol=1e-12)
    np.testing.assert_allclose(frame.coordinates(frame.in_space(there))[:, :2], there, atol=1e-12)
    apart = np.linalg.norm(np.diff(frame.in_space(there), axis=0), axis=1)
    np.testing.assert_allclose(apart, np.linalg.norm(np.diff(there, axis=0), axis=1), rtol=1e-9)


def test_motion_in_a_frame_is_along_its_normal_and_about_its_axes():
    """A frame turned by 90 degrees about z: rx there is the plan's ry, ry there its -rx."""
    turned = Frame(x_axis=np.array([0.0, 1.0, 0.0]), y_axis=np.array([-1.0, 0.0, 0.0]))
    six = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    assert (turned.motion @ six).tolist() == [3.0, 5.0, -4.0]
    on_slope = SLOPE.motion @ np.concatenate([SLOPE.normal, SLOPE.y_axis])
    np.testing.assert_allclose(on_slope, [1.0, 0.0, 1.0], atol=1e-12)


def test_places_that_are_none_are_refused_by_name():
    """Not finite, with the number of the place; none at all are no mistake."""
    with pytest.raises(InputError, match="y must be finite; got inf"):
        Spot(1.0, np.inf)
    with pytest.raises(InputError, match=r"places must be finite; element \(1, 0\)"):
        Spots(xy=np.array([[0.0, 1.0], [np.nan, 2.0]]))
    assert len(Spots(xy=np.zeros((0, 2)))) == 0


def test_springs_of_a_support_do_not_turn_and_are_not_below_nought():
    """Axes turned by half a turn are the same axes; by anything else springs cannot follow."""
    line = np.array([[0.0, 0.0], [1.0, 0.0]])
    stiff = (0.0, 0.0, 1e6, 0.0, 0.0, 0.0)
    Support(on="a", along=line, springs=stiff, angle=180.0)
    with pytest.raises(InputError, match="springs act along x, y and z"):
        Support(on="a", along=line, springs=stiff, angle=30.0)
    with pytest.raises(InputError, match="springs must be 0 or more"):
        Support(on="a", along=line, springs=(0.0, -1.0, 0.0, 0.0, 0.0, 0.0))
