"""Systems of bulk data that stand in each other: places by trigonometry, axes, rings."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.nastran_deck import Grid, System
from trundle.imports.nastran_places import Places

Z_UP = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


def at(system, *place):
    return Grid(system=system, place=np.array(place, dtype=float))


def test_a_cylinder_under_a_turned_system_is_placed_by_both():
    """r = 2, 30 degrees, h = 5 in a system whose x runs along y from (10, 0, 1): by hand.

    The cylinder's own x is the turned system's x, so the place is 10 - 2 sin 30 along x and
    2 cos 30 along y.
    """
    turned = np.array([[10.0, 0.0, 1.0], [10.0, 0.0, 2.0], [10.0, 1.0, 1.0]])
    systems = {4: System(kind="R", points=turned), 5: System(kind="C", under=4, points=Z_UP)}
    places = Places({1: at(5, 2.0, 30.0, 5.0)}, Grid(), systems)
    np.testing.assert_allclose(places.of(1), [9.0, np.sqrt(3.0), 6.0], atol=1e-12)
    np.testing.assert_allclose(places.axes_of(4, "here"), [[0, 1, 0], [-1, 0, 0], [0, 0, 1]])


def test_a_sphere_counts_its_first_angle_from_its_axis():
    """r = 2, theta = 90 degrees lies in the plane across z; phi = 90 degrees points along y."""
    systems = {3: System(kind="S", points=Z_UP)}
    grids = {1: at(3, 2.0, 90.0, 90.0), 2: at(3, 2.0, 0.0, 45.0), 3: at(3, 2.0, 60.0, 0.0)}
    places = Places(grids, Grid(), systems)
    np.testing.assert_allclose(places.of(1), [0.0, 2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(places.of(2), [0.0, 0.0, 2.0], atol=1e-12)
    np.testing.assert_allclose(places.of(3), [np.sqrt(3.0), 0.0, 1.0], atol=1e-12)


def test_a_third_point_need_not_be_at_right_angles():
    """The third point says the plane of x and z alone: (5, 0, 7) makes the x of (1, 0, 0)."""
    slanted = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [5.0, 0.0, 7.0]])
    places = Places({1: at(8, 1.0, 2.0, 3.0)}, Grid(), {8: System(kind="R", points=slanted)})
    np.testing.assert_allclose(places.of(1), [1.0, 2.0, 3.0], atol=1e-12)


def test_systems_of_grids_follow_their_grids():
    """CORD1R by three grids at (1, 1, 0), (1, 1, 4), (1, 3, 0): x runs along y."""
    grids = {
        1: at(0, 1.0, 1.0, 0.0), 2: at(0, 1.0, 1.0, 4.0), 3: at(0, 1.0, 3.0, 0.0),
        4: at(6, 5.0, 0.0, 0.0),
    }  # fmt: skip
    places = Places(grids, Grid(), {6: System(kind="R", grids=(1, 2, 3))})
    np.testing.assert_allclose(places.of(4), [1.0, 6.0, 0.0], atol=1e-12)


def test_a_system_0_of_a_grid_wins_over_that_of_all_grids():
    """GRDSET names system 8 where a grid names none; 0 is a name, and the basic system."""
    moved = Z_UP + np.array([100.0, 0.0, 0.0])
    grids = {1: at(0, 1.0, 0.0, 0.0), 2: at(None, 1.0, 0.0, 0.0)}
    places = Places(grids, Grid(system=8), {8: System(kind="R", points=moved)})
    assert [places.of(n)[0] for n in (1, 2)] == [1.0, 101.0]


@pytest.mark.parametrize(
    ("systems", "said"),
    [
        ({}, "coordinate system 2 is not given"),
        ({2: System(kind="R", under=3, points=Z_UP), 3: System(kind="R", under=2, points=Z_UP)},
         "stands on itself"),
        ({2: System(kind="R", grids=(1, 8, 9))}, "stands on itself"),
        ({2: System(kind="R", grids=(7, 8, 9))}, "names grid 7, which is not there"),
        ({2: System(kind="R", points=np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2.0]]))},
         "its three points lie on one line"),
    ],
)  # fmt: skip
def test_systems_that_lead_nowhere_are_refused(systems, said):
    """Without an end of the chain, or without three points, there is no frame."""
    with pytest.raises(InputError, match=said):
        Places({1: at(2, 1.0, 0.0, 0.0)}, Grid(), systems).of(1)


def test_axes_of_a_cylinder_are_not_those_of_space():
    """Radial and tangential directions differ from place to place: supports along them are none."""
    places = Places({}, Grid(), {5: System(kind="C", points=Z_UP)})
    with pytest.raises(InputError, match="here: the axes of system 5 turn from place to place"):
        places.axes_of(5, "here")
    np.testing.assert_array_equal(places.axes_of(0, "here"), np.eye(3))
