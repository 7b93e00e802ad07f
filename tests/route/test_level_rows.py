"""Reading level motion: rigid motions exactly, nodes as they are, symmetry, and verdicts by axis."""

import numpy as np
import pytest

import trundle as tr
from models import small_floor
from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.route import level_rows

PLACES = np.array([[1.3, 0.7], [3.9, 2.2], [11.2, 5.1]])
CRITERIA = '\n[criteria]\nmethod = "coupled"\ncurves = ["VC-A", "R-office"]\n'


def rigid(floor, centre=(0.0, 0.0)):
    """A unit rotation about an upright axis: u = -(y - y0), v = x - x0, and the turn itself."""
    u = np.zeros(floor.n_dofs)
    motion = {0: -(floor.nodes[:, 1] - centre[1]), 1: floor.nodes[:, 0] - centre[0]}
    motion[5] = np.ones(len(floor.nodes))
    for dof, values in motion.items():
        rows = floor.dof_index[:, dof]
        u[rows[rows >= 0]] = values[rows >= 0]
    return u


@pytest.mark.parametrize("heads", ["point", "rigid"])
def test_rigid_motions_are_read_exactly(heads):
    """Two translations and a turn in the plane, between nodes and over heads of columns."""
    floor = small_floor(column_heads=heads)
    x, y = (level_rows(floor, PLACES, axis) for axis in ("x", "y"))
    one, none = np.ones(len(PLACES)), np.zeros(len(PLACES))
    for dof, values in ((0, (one, none)), (1, (none, one)), (2, (none, none))):
        moved = floor.rigid_vector(dof)
        assert x @ moved == pytest.approx(values[0], abs=1e-12)
        assert y @ moved == pytest.approx(values[1], abs=1e-12)
    turned = rigid(floor)
    assert x @ turned == pytest.approx(-PLACES[:, 1], abs=1e-9)
    assert y @ turned == pytest.approx(PLACES[:, 0], abs=1e-9)


def test_a_place_on_a_node_reads_that_node():
    floor = small_floor()
    node = floor.nearest_node(3.0, 3.0)
    rows = level_rows(floor, floor.nodes[[node], :2], "y")
    assert rows.toarray()[0].nonzero()[0].tolist() == [floor.dof_index[node, 1]]
    assert rows.sum() == pytest.approx(1.0)


def study(*changes, axes='axes = ["z", "x", "y"]'):
    text = BUILDING.replace('at = ["4 m", "3 m"]', f'at = ["4 m", "3 m"]\n{axes}') + CRITERIA
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return tr.study_from_text(text)


def test_points_read_all_three_axes_and_limits_hold_for_their_own():
    """VC curves are for each axis; the response factor is of vertical motion alone."""
    result = tr.run_study(study())
    assert result.to_xarray()["point"].values.tolist() == ["tool", "tool x", "tool y"]
    (verdicts,) = result.verdicts.values()
    told = {(v.point, v.criterion.name): v for v in verdicts}
    assert told["tool", "VC-A"].axis == "vertical"
    assert told["tool x", "VC-A"].axis == "horizontal"
    assert np.isfinite(told["tool x", "VC-A"].margin)
    assert told["tool x", "R-office"].status == "not assessed"
    levels = result.to_xarray()["rms_velocity"].mean(dim="run").values.squeeze()
    assert (levels > 0.0).all()
    assert levels[0] > 2.0 * levels[1:].max()  # a slab between stiff columns shakes upright
    words = " ".join(w.message for found in result.warnings().values() for w in found)
    assert "vertical wheel loads alone" in words
    assert "only vertical motion" not in words


@pytest.mark.longest
def test_a_building_that_is_its_own_mirror_image_moves_along_its_plane_alone():
    """A route along the middle moves nothing across it; one beside it does.

    The mesh is its own mirror image but for the triangles round the opening: 2 % of what a route
    2 m beside the plane moves across.
    """
    wall = BUILDING[BUILDING.index("[[building.wall]]") : BUILDING.index("[vehicle.car]")]
    across = []
    for y in ("3 m", "5 m"):
        way = f'["0 m", "{y}"], ["9 m", "{y}"]'
        found = tr.run_study(study((wall, ""), ('["0 m", "5 m"], ["16 m", "5 m"]', way)))
        across.append(float(found.to_xarray()["rms_velocity"].sel(point="tool y").mean()))
    assert across[0] < 0.1 * across[1]


def test_a_storey_of_bays_is_vertical_only():
    text = GOOD.replace('name = "tool"', 'name = "tool"\naxes = ["x"]')
    with pytest.raises(StudyError, match="vertical only"):
        tr.study_from_text(text)


def test_an_isolator_is_vertical_only():
    change = 'axes = ["z", "x"]\nisolator = { frequency = "2 Hz", damping = "5 %" }'
    with pytest.raises(StudyError, match="vertical motion alone"):
        study(axes=change)


def test_an_unknown_axis_is_told():
    with pytest.raises(StudyError, match=r"point\[1\]\.axes"):
        study(axes='axes = ["w"]')
