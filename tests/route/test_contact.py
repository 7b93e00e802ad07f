"""The contact operator: what it must reproduce, and where it must be smooth."""

import numpy as np
import pytest

from models import simple_beam, small_floor
from trundle.errors import InputError
from trundle.route import (
    Abrupt,
    ConstantSpeed,
    DriveIn,
    Ramp,
    Route,
    StaticStart,
    SteadyAcceleration,
    contact_rows,
)
from trundle.structure import CONCRETE, Floor, Hat, Hermite, ShellGroup, ShellSection

ALONG_X = np.array([[1.0, 0.0]])


def free_floor() -> Floor:
    return small_floor(column=None, beams_x=None, beams_y=None)


def skewed_floor() -> Floor:
    """Two by two quadrilaterals that are no rectangles."""
    x, y = np.meshgrid([0.0, 1.2, 2.0], [0.0, 0.9, 2.0])
    nodes = np.column_stack([(x + 0.2 * y).ravel(), (y + 0.1 * x).ravel(), np.zeros(9)])
    nodes[4, :2] += [0.1, -0.05]
    elements = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
    section = ShellSection(thickness=0.2, material=CONCRETE)
    return Floor(
        nodes=nodes,
        fixed=np.zeros((9, 6), dtype=bool),
        shells=(ShellGroup(elements=elements, section=section),),
    )


def field(floor: Floor, w, wx, wy) -> np.ndarray:
    """Set uz = w, ry = -dw/dx, rx = dw/dy at every node."""
    x, y, _ = floor.nodes.T
    u = np.zeros(floor.n_dofs)
    for dof, values in ((2, w(x, y)), (3, wy(x, y)), (4, -wx(x, y))):
        rows = floor.dof_index[:, dof]
        u[rows[rows >= 0]] = np.broadcast_to(values, x.shape)[rows >= 0]
    return u


@pytest.mark.parametrize("make", [free_floor, skewed_floor])
@pytest.mark.parametrize("shape", [Hermite(), Hat()])
def test_a_plane_is_reproduced_everywhere(make, shape):
    """Rigid-body motions are exact: a load keeps its size and both its moments."""
    floor = make()
    low, high = floor.surface().extent
    rng = np.random.default_rng(1)
    inside = low + (high - low) * rng.uniform(0.3, 0.7, (50, 2))
    u = field(floor, lambda x, y: 2 + 3 * x - 4 * y, lambda x, y: 3.0, lambda x, y: -4.0)
    rows = contact_rows(floor, inside, np.repeat(ALONG_X, 50, axis=0), shape=shape)
    np.testing.assert_allclose(rows.matrix(rows.value) @ u, 2 + inside @ [3.0, -4.0], rtol=1e-10)
    np.testing.assert_allclose(rows.matrix(rows.slope) @ u, 3.0, rtol=1e-9)


def test_cubics_along_the_mesh_are_reproduced():
    """Hermite's functions carry any cubic in x or in y from values and slopes at the nodes."""
    floor = free_floor()
    places = np.random.default_rng(2).uniform([0, 0], [12, 6], (60, 2))
    rows = contact_rows(floor, places, np.repeat(ALONG_X, 60, axis=0), shape=Hermite())
    x, y = places.T
    u = field(floor, lambda x, y: x**3 - y**3, lambda x, y: 3 * x**2, lambda x, y: -3 * y**2)
    np.testing.assert_allclose(rows.matrix(rows.value) @ u, x**3 - y**3, atol=1e-9)
    np.testing.assert_allclose(rows.matrix(rows.slope) @ u, 3 * x**2, atol=1e-9)


def profile_along(floor, shape, direction, u, s):
    start = np.array([1.1, 0.4])
    places = start + s[:, None] * direction
    rows = contact_rows(floor, places, np.repeat(direction[None], len(s), axis=0), shape=shape)
    return rows.matrix(rows.value) @ u, rows.matrix(rows.slope) @ u


@pytest.mark.parametrize("direction", [[1.0, 0.0], [0.0, 1.0], [0.8, 0.6]])
def test_the_path_of_a_wheel_is_smooth_across_mesh_lines(direction):
    """C1 for any nodal values; the hat function has kinks at mesh lines (control)."""
    floor = free_floor()
    u = np.random.default_rng(3).standard_normal(floor.n_dofs)
    s = np.linspace(0.0, 5.0, 40001)
    step = s[1]
    jumps = {}
    for shape in (Hermite(), Hat()):
        w, slope = profile_along(floor, shape, np.array(direction), u, s)
        assert np.abs(np.diff(w)).max() < 100 * step  # continuous
        middle = 0.5 * (slope[1:] + slope[:-1])
        if isinstance(shape, Hermite):
            np.testing.assert_allclose(np.diff(w) / step, middle, atol=5e-3)
        jumps[type(shape)] = np.abs(np.diff(slope)).max()
    assert jumps[Hermite] < 5e-3
    assert jumps[Hat] > 0.1


def test_a_beam_carries_wheels_where_there_are_no_shells():
    beam = simple_beam(length=10.0, rigidity=1e8, line_mass=1000.0, n_elements=5)
    x = np.array([0.3, 2.0, 4.9, 9.99])
    u = field(beam, lambda x, y: x * (10 - x), lambda x, y: 10 - 2 * x, lambda x, y: 0 * x)
    rows = contact_rows(
        beam, np.column_stack([x, 0 * x]), np.repeat(ALONG_X, 4, axis=0), shape=Hermite()
    )
    np.testing.assert_allclose(rows.matrix(rows.value) @ u, x * (10 - x), rtol=1e-9)
    np.testing.assert_allclose(rows.matrix(rows.slope) @ u, 10 - 2 * x, rtol=1e-9)


def test_places_in_a_large_element_beside_small_ones_are_found():
    """A graded mesh: the nearest element centres are those of the small neighbours."""
    x = np.concatenate([[0.0, 3.0], 3.0 + 0.2 * np.arange(1, 16)])
    y = np.concatenate([[0.0, 3.0], 3.0 + 0.2 * np.arange(1, 16)])
    grid = np.arange(len(x) * len(y)).reshape(len(y), len(x))
    corners = [grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]]
    nodes = np.column_stack([np.tile(x, len(y)), np.repeat(y, len(x)), np.zeros(grid.size)])
    floor = Floor(
        nodes=nodes,
        fixed=np.zeros((grid.size, 6), dtype=bool),
        shells=(
            ShellGroup(
                elements=np.stack([c.ravel() for c in corners], axis=1),
                section=ShellSection(thickness=0.2, material=CONCRETE),
            ),
        ),
    )
    u = field(floor, lambda x, y: x + 2 * y, lambda x, y: 1.0, lambda x, y: 2.0)
    rows = contact_rows(floor, np.array([[2.9, 2.9]]), ALONG_X, shape=Hermite())
    assert rows.matrix(rows.value) @ u == pytest.approx([2.9 + 5.8])


@pytest.mark.parametrize("place", [[-0.1, 1.0], [12.2, 3.0], [6.0, 6.5], [np.inf, 0.0]])
def test_places_off_the_floor_are_refused(place):
    with pytest.raises((InputError, ValueError), match=r"not on the floor|finite"):
        contact_rows(free_floor(), np.array([place]), ALONG_X, shape=Hermite())


def test_wheels_along_a_mirror_plane_load_the_model_by_half():
    floor = small_floor(edges={"y_min": "symmetry"})
    places = np.array([[3.0, 0.0], [3.0, 0.0], [3.0, 2.0]])
    directions = np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
    rows = contact_rows(floor, places, directions, shape=Hermite())
    assert rows.load_share.tolist() == [0.5, 1.0, 1.0]


@pytest.mark.parametrize(
    "entry", [Ramp(length=2.0), DriveIn(length=3.0), StaticStart(exit_length=1.0)]
)
def test_the_share_on_the_floor_is_whole_inside_and_its_slope_is_its_derivative(entry):
    s = np.linspace(-4.0, 24.0, 281)
    share, slope = entry.share(s, 20.0)
    assert share[(s > 3.1) & (s < 16.9)] == pytest.approx(1.0)
    assert share.min() >= 0.0
    assert share[-1] == 0.0
    h = 1e-6
    difference = (entry.share(s + h, 20.0)[0] - entry.share(s - h, 20.0)[0]) / (2 * h)
    corners = np.isclose(np.abs(np.diff(slope, prepend=slope[0])), 0.0, atol=0.2)
    np.testing.assert_allclose(
        slope[corners], difference[corners], atol=0.51 if not isinstance(entry, DriveIn) else 1e-5
    )


def test_an_abrupt_entry_is_all_or_nothing():
    """The front axle stands on the edge at time 0, with its whole load."""
    entry = Abrupt()
    share, slope = entry.share(np.array([-3.0, -1e-9, 0.0, 5.0, 20.0, 20.1]), 20.0)
    assert share.tolist() == [0.0, 0.0, 1.0, 1.0, 1.0, 0.0]
    assert not slope.any()
    assert entry.lead(12.5) == 0.0


def test_the_rate_that_a_wheel_feels_is_the_derivative_of_its_height():
    """With the floor's share g growing along the way, d(g H)/ds = g' H + g dH/ds."""
    floor = free_floor()
    u = np.random.default_rng(5).standard_normal(floor.n_dofs)
    entry, s, h = DriveIn(length=3.0), np.linspace(0.2, 11.8, 60), 1e-6

    def along(station):
        places = np.column_stack([station, np.full_like(station, 2.3)])
        rows = contact_rows(floor, places, np.repeat(ALONG_X, len(s), axis=0), shape=Hermite())
        return rows.scaled(*entry.share(station, 12.0))

    rows, before, after = along(s), along(s - h), along(s + h)
    height = [r.matrix(r.value) @ u for r in (before, after)]
    difference = (height[1] - height[0]) / (2 * h)
    np.testing.assert_allclose(rows.matrix(rows.slope) @ u, difference, atol=1e-6)


def test_routes_turn_corners():
    route = Route(points=np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]]), law=ConstantSpeed(2.0))
    assert route.length == 7.0
    place, direction = route.locate([1.0, 5.0, 99.0])
    np.testing.assert_allclose(place, [[1, 0], [3, 2], [3, 4]])
    np.testing.assert_allclose(direction, [[1, 0], [0, 1], [0, 1]])
    left, _ = route.locate([1.0], 0.5)
    np.testing.assert_allclose(left, [[1.0, 0.5]])
    back, _ = route.reversed().locate([1.0])
    np.testing.assert_allclose(back, [[3.0, 3.0]])


def test_speed_laws():
    """v0 t + a t^2 / 2, and braking ends at rest at v0^2 / 2a."""
    law = SteadyAcceleration(initial=25.0, acceleration=10.0)
    assert law.distance(0.4) == pytest.approx(25 * 0.4 + 5 * 0.16)
    assert law.speed(0.4) == pytest.approx(29.0)
    assert law.time_to(float(law.distance(0.4))) == pytest.approx(0.4)
    brake = SteadyAcceleration(initial=10.0, acceleration=-2.0)
    assert brake.distance(99.0) == pytest.approx(25.0)
    assert brake.speed(99.0) == pytest.approx(0.0)
    assert brake.time_to(30.0) == np.inf


@pytest.mark.parametrize(
    ("points", "match"),
    [([[0.0, 0.0]], "at least 2 points"), ([[0.0, 0.0], [0.0, 0.0]], "same point twice")],
)
def test_bad_routes_are_refused(points, match):
    with pytest.raises(InputError, match=match):
        Route(points=np.array(points), law=ConstantSpeed(1.0))
