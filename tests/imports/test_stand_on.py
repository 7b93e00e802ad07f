"""What is stood on in a mesh: levels with their areas, planes, and choices nothing answers to."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.stand_on import SurfaceChoice, levels_of, surfaces_of
from trundle.structure import CONCRETE, BeamGroup, BeamSection, ShellGroup, ShellSection

SLAB = ShellSection(thickness=0.2, material=CONCRETE)
BAR = BeamSection.rectangle(0.3, 0.5, CONCRETE)


def plates(*rectangles, name="slab"):
    """Return nodes and a group of a plate for each rectangle (x0, y0, x1, y1) and four heights."""
    nodes = [
        corner
        for (x0, y0, x1, y1), z in rectangles
        for corner in ((x0, y0, z[0]), (x1, y0, z[1]), (x1, y1, z[2]), (x0, y1, z[3]))
    ]
    elements = np.arange(len(nodes)).reshape(-1, 4)
    return np.array(nodes, dtype=float), ShellGroup(elements=elements, section=SLAB, name=name)


def level(z):
    return (z, z, z, z)


def test_levels_are_heights_with_their_areas_in_order():
    """Given from above to below: 2 x 3 m at 4 m, 5 x 1 m and 1 x 1 m at 0, a ramp that is none."""
    nodes, slab = plates(
        ((0, 0, 2, 3), level(4.0)),
        ((0, 0, 5, 1), level(0.0)),
        ((9, 9, 10, 10), level(0.0015)),  # within what programs round
        ((0, 0, 4, 4), (0.0, 1.0, 1.0, 0.0)),
    )
    found = levels_of(nodes, [slab])
    assert [round(z, 2) for z, _ in found] == [0.0, 4.0]
    assert [size for _, size in found] == pytest.approx([6.0, 6.0])


def test_a_landing_of_less_than_a_hundredth_is_no_storey():
    """A pad of 0.9 m2 at half height beside 100 m2 is left out, one of 1.1 m2 is a surface."""
    for size, names in ((0.9, ["floor"]), (1.1, ["z = 0 m", "z = 1.5 m"])):
        nodes, slab = plates(((0, 0, 10, 10), level(0.0)), ((0, 20, size, 21), level(1.5)))
        assert [one.name for one in surfaces_of(nodes, [slab])] == names


def test_beams_are_stood_on_where_there_are_no_plates_alone():
    """A beam above a slab is no surface; without the slab it is."""
    nodes, slab = plates(((0, 0, 4, 4), level(0.0)))
    nodes = np.vstack([nodes, [[0.0, 0.0, 3.0], [4.0, 0.0, 3.0]]])
    beam = BeamGroup(elements=np.array([[4, 5]]), section=BAR)
    (surface,) = surfaces_of(nodes, [slab, beam])
    assert surface.frame.origin[2] == 0.0
    (surface,) = surfaces_of(nodes, [beam])
    assert surface.frame.origin[2] == 3.0
    assert surface.holds(np.array([[2.0, 0.0], [2.0, 1.0]])).tolist() == [True, False]


def test_a_choice_by_group_keeps_the_others_out():
    """Two slabs at one height: a place over the other one is not on it."""
    nodes, slab = plates(((0, 0, 4, 4), level(3.0)), name="lab, <east>")
    more, other = plates(((4, 0, 8, 4), level(3.0)), name="Flur Süd")
    both = np.vstack([nodes, more])
    other = ShellGroup(elements=other.elements + 4, section=SLAB, name=other.name)
    (surface,) = surfaces_of(
        both, [slab, other], [SurfaceChoice(name="n", groups=("Flur Süd",), height=3.02)]
    )
    assert surface.holds(np.array([[2.0, 2.0], [6.0, 2.0]])).tolist() == [False, True]
    with pytest.raises(InputError, match=r"no group 'roof'; there are: lab, <east>, Flur Süd"):
        surfaces_of(both, [slab, other], [SurfaceChoice(name="n", groups=("roof",))])


def test_a_height_may_be_off_by_five_centimetres_and_no_more():
    """Asked for at 3.04 m the level of 3 m is meant; at 3.06 m none is."""
    nodes, slab = plates(((0, 0, 4, 4), level(3.0)), ((0, 0, 4, 4), level(3.3)))
    (surface,) = surfaces_of(nodes, [slab], [SurfaceChoice(name="lab", height=3.04)])
    assert surface.frame.origin[2] == 3.0
    with pytest.raises(InputError, match=r"'lab': no level element at 3\.06 m; .* 3 m, 3\.3 m"):
        surfaces_of(nodes, [slab], [SurfaceChoice(name="lab", height=3.06)])


def test_a_ramp_is_measured_along_its_slope():
    """z = 1 + 0.3 x - 0.4 y: x in the surface counts sqrt(1.09) of x in plan, by Pythagoras."""
    rectangle = (0.0, 0.0, 4.0, 2.0)
    z = [1 + 0.3 * x - 0.4 * y for x, y in ((0, 0), (4, 0), (4, 2), (0, 2))]
    nodes, slab = plates((rectangle, z))
    (ramp,) = surfaces_of(nodes, [slab], [SurfaceChoice(name="ramp", groups=("slab",))])
    normal = np.array([-0.3, 0.4, 1.0]) / np.sqrt(1.25)
    np.testing.assert_allclose(ramp.frame.normal, normal, atol=1e-12)
    flat = ramp.frame.coordinates(nodes)
    assert np.abs(flat[:, 2]).max() < 1e-12
    np.testing.assert_allclose(flat[1, 0] - flat[0, 0], 4.0 * np.sqrt(1.09), rtol=1e-12)


@pytest.mark.parametrize(
    ("z", "said"),
    [
        ((0.0, 0.0, 8.0, 8.0), "stand upright"),  # 4 m rise 8: 63 degrees
        ((0.0, 0.0, 0.0, 1.0), "lie in no plane"),
    ],
)
def test_what_nobody_stands_on_is_refused(z, said):
    """Steeper than 60 degrees is a wall, and a warped plate is no plane."""
    nodes, slab = plates(((0, 0, 4, 4), z))
    with pytest.raises(InputError, match=said):
        surfaces_of(nodes, [slab], [SurfaceChoice(name="n", groups=("slab",))])


def test_nothing_level_is_no_surface_and_is_said_when_asked_for():
    """A wall alone: no level is found, and a height that is asked for names what there is."""
    nodes = np.array([[0.0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]])
    wall = ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=SLAB)
    assert surfaces_of(nodes, [wall]) == ()
    with pytest.raises(InputError, match="there are levels at no height"):
        surfaces_of(nodes, [wall], [SurfaceChoice(name="n", height=0.0)])
