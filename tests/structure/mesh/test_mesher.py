"""Meshes of sheets: they cover what is asked, meet node to node, and follow lines and points."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist

from trundle.errors import InputError
from trundle.structure.mesh import Area, Refinement, Sheet, Tie, mesh_sheets
from trundle.structure.mesh.free import FreeFace, triangles_of
from trundle.structure.mesh.merging import first_there
from trundle.structure.mesh.quality import squareness
from trundle.structure.mesh.smoothing import smoothed


def box(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def closed(ring):
    return np.vstack([ring, ring[:1]])


def area_of(mesh, elements):
    x, y = np.moveaxis(mesh.nodes[elements][:, :, :2], 2, 0)
    return 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1)


def sides_of(mesh):
    both = [
        np.stack([e, np.roll(e, -1, axis=1)], axis=2).reshape(-1, 2)
        for e in (mesh.quads, mesh.triangles)
    ]
    return np.unique(np.sort(np.concatenate(both), axis=1), axis=0, return_counts=True)


def check(mesh, area, boundary):
    """No element is folded, all areas add up, and what one element alone has is the boundary."""
    areas = np.concatenate([area_of(mesh, mesh.quads), area_of(mesh, mesh.triangles)])
    assert areas.min() > 0.0
    assert areas.sum() == pytest.approx(area, rel=1e-9)
    sides, times = sides_of(mesh)
    assert times.max() == 2
    lengths = np.linalg.norm(np.diff(mesh.nodes[sides[times == 1]], axis=1)[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(boundary, rel=1e-9)
    quality = mesh.quality
    assert quality.largest_angle < 178.0
    assert quality.least_angle > 1.0


L_SHAPE = np.array([[0, 0], [20, 0], [20, 8], [10, 8], [10, 18], [0, 18]], dtype=float)


def test_a_rectangle_is_a_grid_of_its_own_size():
    """10 by 4 m at 1 m: 40 squares, and no more nodes than their corners."""
    mesh = mesh_sheets([Sheet(name="s", areas=(Area(outline=box(0, 0, 10, 4)),))], size=1.0)
    assert (len(mesh.quads), len(mesh.triangles), len(mesh.nodes)) == (40, 0, 55)
    assert area_of(mesh, mesh.quads) == pytest.approx(np.ones(40))
    assert mesh.quality.share_of_rectangles == 1.0


def test_the_share_of_rectangles_is_of_the_area():
    """A grid of 5 x 4 m beside a parallelogram of as much: a half."""
    areas = (
        Area(outline=box(0, 0, 5, 4)),
        Area(outline=np.array([[5.0, 0], [10, 2], [10, 6], [5, 4]]), tag=1),
    )
    mesh = mesh_sheets([Sheet(name="s", areas=areas)], size=1.0)
    assert mesh.quality.share_of_rectangles == pytest.approx(0.5, rel=1e-9)


def test_columns_and_openings_in_an_l_are_met_by_good_elements():
    heads = [closed(box(x - 0.2, 3.8, x + 0.2, 4.2)) for x in (5.0, 10.0, 15.0)]
    hole = box(3, 10, 6, 13)
    sheet = Sheet(
        name="s",
        areas=(Area(outline=L_SHAPE, openings=(hole,)),),
        lines=(*heads, np.array([[12.0, 2.0], [17.0, 6.5]])),
        points=np.array([[5.0, 4.0], [1.3, 3.3]]),
    )
    mesh = mesh_sheets([sheet], size=0.75)
    check(mesh, area=260.0 - 9.0, boundary=76.0 + 12.0)
    assert mesh.quality.share_of_quads > 0.9
    assert mesh.quality.least_angle > 20.0
    assert mesh.quality.largest_angle < 150.0
    assert mesh.at(0, np.array([1.3, 3.3])) is not None
    assert mesh.at(0, np.array([1.5, 3.3])) is None


def test_elements_have_edges_along_every_line():
    """Nodes along a line follow each other by the sides of elements."""
    line = np.array([[2.0, 1.0], [17.0, 6.5]])
    sheet = Sheet(name="s", areas=(Area(outline=L_SHAPE),), lines=(line,))
    mesh = mesh_sheets([sheet], size=0.9)
    nodes = mesh.along(0, line)
    assert mesh.nodes[nodes[[0, -1]], :2] == pytest.approx(line, abs=1e-6)
    sides = {tuple(side) for side in sides_of(mesh)[0].tolist()}
    assert all(tuple(sorted(pair)) in sides for pair in pairwise(nodes.tolist()))
    steps = np.linalg.norm(np.diff(mesh.nodes[nodes], axis=0), axis=1)
    assert steps.max() < 0.9 + 1e-9


def test_lines_that_end_within_a_millimetre_meet():
    """A drawn beam that misses another by 0.5 mm ends on it."""
    sheet = Sheet(
        name="s",
        areas=(Area(outline=box(0, 0, 8, 6)),),
        lines=(np.array([[4.0, 0.0], [4.0, 6.0]]), np.array([[0.0, 3.0], [3.9995, 3.0]])),
    )
    mesh = mesh_sheets([sheet], size=1.0)
    check(mesh, area=48.0, boundary=28.0)
    assert mesh.quality.largest_aspect < 1.5


def test_areas_of_several_makes_keep_their_elements_apart():
    """A thick strip in a slab: its elements cover it, and nothing beside it."""
    thick = box(3, 0, 5, 6)
    sheet = Sheet(name="s", areas=(Area(outline=box(0, 0, 8, 6)), Area(outline=thick, tag=7)))
    mesh = mesh_sheets([sheet], size=1.0)
    mine = mesh.quad_owner[:, 1] == 7
    assert area_of(mesh, mesh.quads[mine]).sum() == pytest.approx(12.0)
    x = mesh.nodes[mesh.quads[mine]][:, :, 0]
    assert (x.min(), x.max()) == (3.0, 5.0)
    check(mesh, area=48.0, boundary=28.0)


def test_elements_are_small_near_a_line_and_grow_beyond():
    fine = Refinement(line=np.array([[0.0, 6.0], [20.0, 6.0]]), size=0.25, reach=0.5)
    sheet = Sheet(name="s", areas=(Area(outline=L_SHAPE),))
    mesh = mesh_sheets([sheet], size=1.5, refinements=[fine])
    check(mesh, area=260.0, boundary=76.0)
    sides = sides_of(mesh)[0]
    ends = mesh.nodes[sides]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    away = np.abs(ends[:, :, 1] - 6.0).max(axis=1)
    assert length[away < 0.5].max() < 0.25 * 1.7
    assert length[away > 6.0].max() > 1.0
    middle = np.abs(ends[:, :, 1].mean(axis=1) - 6.0)
    allowed = np.minimum(0.25 + 0.5 * np.maximum(middle - 0.5, 0.0), 1.5)
    assert (length < 2.0 * allowed).all()


def test_two_sheets_that_are_tied_have_the_same_nodes_along_the_tie():
    """A wall's line, cut by a beam above and by an edge below, is divided alike on both."""
    wall = np.array([[1.0, 3.0], [7.0, 3.0]])
    upper = Sheet(
        name="up",
        areas=(Area(outline=box(0, 0, 8, 6)),),
        lines=(wall, np.array([[2.3, 0.0], [2.3, 6.0]])),
        plane=np.array([3.0, 0.0, 0.0]),
    )
    lower = Sheet(name="low", areas=(Area(outline=box(0, 0, 4.1, 6)),), lines=(wall,))
    mesh = mesh_sheets([upper, lower], size=1.0, ties=[Tie(sheets=(0, 1), line=wall)])
    above, below = (mesh.nodes[mesh.along(i, wall)] for i in (0, 1))
    assert above[:, :2] == pytest.approx(below[:, :2], abs=1e-9)
    assert {2.3, 4.1} <= set(above[:, 0].round(9).tolist())


def test_a_wall_is_divided_alike_where_only_one_of_its_storeys_is_refined():
    wall = np.array([[1.0, 3.0], [7.0, 3.0]])
    sheets = [
        Sheet(name=name, areas=(Area(outline=box(0, 0, 8, 6)),), lines=(wall,), plane=plane)
        for name, plane in (("up", np.array([3.0, 0.0, 0.0])), ("low", np.zeros(3)))
    ]
    fine = Refinement(line=np.array([[2.0, 3.0]]), size=0.2, reach=0.5, sheet="up")
    mesh = mesh_sheets(sheets, size=1.0, refinements=[fine], ties=[Tie(sheets=(0, 1), line=wall)])
    above, below = (mesh.nodes[mesh.along(i, wall), :2] for i in (0, 1))
    assert above == pytest.approx(below, abs=1e-9)
    steps = np.diff(above[:, 0])
    assert steps.min() < 0.25
    assert steps.max() > 0.6


def test_a_ramp_shares_its_edge_with_the_floor_that_it_begins_on():
    edge = np.array([[4.0, 1.0], [4.0, 4.0]])
    floor = Sheet(name="f", areas=(Area(outline=box(0, 0, 4, 6)),), lines=(edge,))
    ramp = Sheet(
        name="r", areas=(Area(outline=box(4, 1, 14, 4)),), plane=np.array([-0.4, 0.1, 0.0])
    )
    mesh = mesh_sheets([floor, ramp], size=1.0, ties=[Tie(sheets=(0, 1), line=edge)])
    assert set(mesh.along(0, edge)) == set(mesh.along(1, edge))
    assert mesh.nodes[:, 2].max() == pytest.approx(1.0)


def test_triangles_alone_halve_every_quadrilateral():
    sheet = Sheet(name="s", areas=(Area(outline=L_SHAPE),), points=np.array([[3.3, 3.4]]))
    both = mesh_sheets([sheet], size=1.0)
    alone = mesh_sheets([sheet], size=1.0, only_triangles=True)
    assert len(alone.quads) == 0
    assert len(alone.triangles) == 2 * len(both.quads) + len(both.triangles)
    check(alone, area=260.0, boundary=76.0)


def test_the_same_sheet_gives_the_same_mesh():
    sheet = Sheet(name="s", areas=(Area(outline=L_SHAPE),), points=np.array([[3.3, 3.4]]))
    one, other = (mesh_sheets([sheet], size=0.7) for _ in range(2))
    assert np.array_equal(one.nodes, other.nodes)
    assert np.array_equal(one.quads, other.quads)


def test_nothing_to_mesh_is_said():
    with pytest.raises(InputError, match="nothing to mesh in empty"):
        mesh_sheets([Sheet(name="empty")], size=1.0)


def one_whole(mesh, area, around, gap=1e-6):
    """Areas add up, and what has one neighbour alone is the boundary: there is no crack."""
    areas = np.concatenate([area_of(mesh, mesh.quads), area_of(mesh, mesh.triangles)])
    assert areas.min() > 0.0
    assert areas.sum() == pytest.approx(area, rel=gap)
    sides, times = sides_of(mesh)
    assert times.max() == 2
    lengths = np.linalg.norm(np.diff(mesh.nodes[sides[times == 1]], axis=1)[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(around, rel=gap)


@st.composite
def plans(draw):
    """A turned rectangle with a hole, columns and beams anywhere in it."""
    share = st.floats(0.05, 0.95)
    size = np.array([draw(st.floats(5.0, 30.0)), draw(st.floats(5.0, 30.0))])
    angle = draw(st.floats(0.0, 1.5))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    columns = draw(st.lists(st.tuples(share, share), max_size=6))
    beams = draw(st.lists(st.tuples(share, share, share, share), max_size=4))
    hole = draw(st.booleans())
    return size, turn, columns, beams, hole, draw(st.floats(0.4, 2.5))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(plan=plans())
def test_any_plan_is_covered_by_sound_elements(plan):
    """Areas add up and neighbours meet, whatever lines cross at whatever angles."""
    size, turn, columns, beams, hole, h = plan
    outline, opening = box(0, 0, 1, 1) * size, box(0.4, 0.4, 0.6, 0.55) * size
    heads = [closed(np.array(c) * size + box(-0.15, -0.15, 0.15, 0.15)) for c in columns]
    lines = [np.array(b).reshape(2, 2) * size for b in beams]
    lines = [line for line in lines if np.hypot(*(line[1] - line[0])) > 0.1]
    sheet = Sheet(
        name="s",
        areas=(Area(outline=outline @ turn, openings=(opening @ turn,) if hole else ()),),
        lines=tuple(line @ turn for line in (*heads, *lines)),
    )
    area, around = np.prod(size), 2.0 * size.sum()
    if hole:
        area, around = area * 0.97, around + 2.0 * (0.2 * size[0] + 0.15 * size[1])
    one_whole(mesh_sheets([sheet], size=h), area, around)


@st.composite
def nearly_touching(draw):
    """Lines that run beside each other, or end short of each other, by millimetres to decimetres."""
    w, d, h = draw(st.floats(5.0, 30.0)), draw(st.floats(5.0, 30.0)), draw(st.floats(0.4, 2.5))
    share, gap = st.floats(0.05, 0.95), st.sampled_from([0.0, 1e-3, 2e-3, 5e-3, 0.02, 0.1])
    lines = []
    for y in draw(st.lists(share, min_size=1, max_size=3)):
        off, short = draw(gap), draw(gap)
        lines.append(np.array([[0.0, y * d], [w, y * d + off]]))
        lines.append(
            np.array([[draw(share) * w, draw(share) * d], [draw(share) * w, y * d - short]])
        )
    heads = [(draw(share) * w, draw(share) * d) for _ in range(draw(st.integers(0, 4)))]
    lines += [closed(np.array(at) + box(-0.2, -0.2, 0.2, 0.2)) for at in heads]
    points = np.array(draw(st.lists(st.tuples(share, share), max_size=3))).reshape(-1, 2) * (w, d)
    inside = tuple(line for line in lines if np.hypot(*(line[1] - line[0])) > 0.05)
    return inside, points, (w, d), h


@settings(max_examples=80, deadline=None, derandomize=True)
@given(drawn=nearly_touching())
@pytest.mark.longest
def test_lines_that_nearly_touch_leave_no_crack(drawn):
    """A line may end 2 mm from another, or run 1 mm off the edge: up to 2 mm are taken in or out."""
    lines, points, (w, d), h = drawn
    sheet = Sheet(name="s", areas=(Area(outline=box(0, 0, w, d)),), lines=lines, points=points)
    mesh = mesh_sheets([sheet], size=h)
    one_whole(mesh, w * d, 2.0 * (w + d), gap=2e-3)
    for line in (pair for one in lines for pair in pairwise(one)):
        led_along(mesh, np.array(line))


def led_along(mesh, line):
    """Nodes along a line follow each other by sides of elements, from one end to the other."""
    row = mesh.along(0, line)
    sides = {tuple(side) for side in sides_of(mesh)[0].tolist()}
    assert all(tuple(sorted(pair)) in sides for pair in pairwise(row.tolist()))
    assert np.abs(mesh.nodes[row[[0, -1]], :2] - line).max() < 2.5e-3
    steps = np.linalg.norm(np.diff(mesh.nodes[row], axis=0), axis=1)
    assert steps.sum() == pytest.approx(np.hypot(*(line[1] - line[0])), abs=5e-3)


def test_lines_that_leave_each_other_at_a_tenth_of_a_milliradian_are_two():
    """1 mm in 10 m: within the distance at which ends meet, nodes of both lie on either's line."""
    lines = [np.array([[1.0, 1.0], [11.0, 1.0]]), np.array([[1.0, 1.0], [11.0, 1.003]])]
    sheet = Sheet(
        name="s", areas=(Area(outline=box(0, 0, 12, 4)),), lines=tuple(lines),
        points=np.array([[3.0, 0.5]]),
    )  # fmt: skip
    mesh = mesh_sheets([sheet], size=1.0)
    one_whole(mesh, 48.0, 32.0)
    for line in lines:
        led_along(mesh, line)
    assert not set(mesh.along(0, lines[0])[1:]) & set(mesh.along(0, lines[1])[1:])


@pytest.mark.parametrize("seed", range(12))
def test_lines_that_cross_within_a_millimetre_cross_at_one_place(seed):
    """Three lines through places up to 1 mm apart: a triangle too small for elements is a place."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0.0, np.pi, 3)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    middle = np.array([4.1, 3.2]) + rng.uniform(-5e-4, 5e-4, (3, 2))
    lines = np.stack([middle - 2.0 * along, middle + 2.0 * along], axis=1)
    sheet = Sheet(name="s", areas=(Area(outline=box(0, 0, 8, 6)),), lines=tuple(lines))
    mesh = mesh_sheets([sheet], size=1.0)
    one_whole(mesh, 48.0, 28.0)
    near = mesh.nodes[np.hypot(*(mesh.nodes[:, :2] - (4.1, 3.2)).T) < 0.05]
    assert len(near) == 1 or pdist(near).min() > 1e-3
    for line in lines:
        led_along(mesh, line)


@pytest.mark.parametrize(
    ("polygon", "sides"),
    [
        (box(0, 0, 2, 1), [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]]),  # two sides cross
        (box(0, 0, 2, 2), [[0, 1], [1, 2], [2, 3], [3, 0]]),  # half of it has no corner
    ],
)
def test_what_no_mesh_fits_is_refused_with_its_place(polygon, sides):
    face = FreeFace(polygon=shapely.Polygon(polygon), points=box(0, 0, 2, 1), sides=np.array(sides))
    with pytest.raises(InputError, match=r"no mesh fits the area of [24] m2 at \("):
        triangles_of(face, lambda xy: np.full(len(xy), 5.0))


def test_smoothing_leaves_no_element_worse_than_the_worst_beside_it():
    """Corners anywhere: after it, the worst element at each node is no worse than it was."""
    rng = np.random.default_rng(4)
    n = 9
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    at = np.arange(n * n).reshape(n, n)
    quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=2).reshape(-1, 4)
    free = ((x > 0) & (x < n - 1) & (y > 0) & (y < n - 1)).ravel()
    points = (
        np.stack([x.ravel(), y.ravel()], axis=1)
        + 0.8 * rng.uniform(-1, 1, (n * n, 2)) * free[:, None]
    )
    triangles = np.zeros((0, 3), dtype=int)
    moved = smoothed(points, quads, triangles, free)

    def worst(places):
        out = np.ones(n * n)
        np.minimum.at(out, quads.ravel(), np.repeat(squareness(places[quads]), 4))
        return out

    assert np.array_equal(moved[~free], points[~free])
    assert (worst(moved) >= worst(points) - 1e-6).all()
    assert worst(moved).mean() > worst(points).mean() + 0.1


def test_a_wall_through_four_storeys_is_divided_alike_where_one_alone_is_cut():
    """What the lowest storey is cut at reaches the highest, storey by storey."""
    wall = np.array([[0.0, 3.0], [8.0, 3.0]])
    beam = np.array([[2.3, 0.0], [2.3, 6.0]])
    sheets = [
        Sheet(
            name=f"level {i}",
            areas=(Area(outline=box(0, 0, 8, 6)),),
            lines=(wall, beam) if i == 0 else (wall,),
            plane=np.array([3.0 * i, 0.0, 0.0]),
        )
        for i in range(4)
    ]
    ties = [Tie(sheets=pair, line=wall) for pair in pairwise(range(4))]
    mesh = mesh_sheets(sheets, size=1.0, ties=ties)
    rows = [mesh.nodes[mesh.along(i, wall), :2] for i in range(4)]
    assert 2.3 in rows[3][:, 0].round(9)
    for row in rows[1:]:
        assert row == pytest.approx(rows[0], abs=1e-9)


@pytest.mark.parametrize("shift", [0.0, 0.2, 0.5, 0.999])
def test_places_within_a_distance_are_one_wherever_they_lie(shift):
    """0.9 mm apart is one and 1.1 mm is two, wherever a grid of whole millimetres has its lines."""
    places = np.array([[0.0, 0.0], [0.9e-3, 0.0], [2.0e-3, 0.0], [2.0e-3, 5.0]]) + shift * 1e-3
    assert first_there(places, 1e-3).tolist() == [0, 0, 2, 3]
