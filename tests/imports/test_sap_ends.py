"""Ends of SAP2000's frames by hand: releases, rigid ends, insertion points in every corner."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.sap_ends import insertion_of, releases_of, rigid_ends_of
from trundle.imports.sap_makes import FrameMake
from trundle.imports.sap_tables import Row
from trundle.structure import CONCRETE, BeamSection

MAKE = FrameMake(
    section=BeamSection.rectangle(0.3, 0.8, CONCRETE), mass_per_length=0.0, weight_per_length=0.0,
    depth=0.8, width=0.3, symmetric=True,
)  # fmt: skip
# a frame along y: 2 points up, and 3 = 1 x 2 along x
ALONG_Y = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


def row(**cells):
    lower = {key.lower(): str(value) for key, value in cells.items()}
    return Row(place="m.s2k, line 9", cells=lower, used=set())


@pytest.mark.parametrize(
    ("point", "up", "right"),
    [
        (1, 0.4, -0.15), (2, 0.4, 0.0), (3, 0.4, 0.15), (4, 0.0, -0.15), (5, 0.0, 0.0),
        (6, 0.0, 0.15), (7, -0.4, -0.15), (8, -0.4, 0.0), (9, -0.4, 0.15), (10, 0.0, 0.0),
    ],
)  # fmt: skip
def test_the_axis_lies_across_from_its_cardinal_point(point, up, right):
    """Hand: the joint at the bottom (1 to 3) puts the axis half the depth above it.

    Points 1, 4 and 7 are on the left, where 3 points to as the section is drawn with 2 up: the
    axis lies half the width against 3 from them.
    """
    first, last = insertion_of(row(CardinalPt=point), MAKE, ALONG_Y)
    np.testing.assert_allclose(first, [right, 0.0, up], atol=1e-12)
    np.testing.assert_allclose(last, first)


def test_a_mirrored_section_has_its_points_on_the_other_side():
    """About 2 left and right change places, about 3 top and bottom."""
    about_2, _ = insertion_of(row(CardinalPt=1, Mirror2="Yes"), MAKE, ALONG_Y)
    about_3, _ = insertion_of(row(CardinalPt=1, Mirror3="Yes"), MAKE, ALONG_Y)
    np.testing.assert_allclose(about_2, [0.15, 0.0, 0.4], atol=1e-12)
    np.testing.assert_allclose(about_3, [-0.15, 0.0, -0.4], atol=1e-12)


def test_joint_offsets_in_local_and_global_axes():
    """0.1 along 2 is up; 0.1 along Y is along this frame; each end has its own."""
    local = {"JtOffset2I": 0.1, "JtOffset3J": 0.2}
    first, last = insertion_of(row(CardinalPt=10, CoordSys="Local", **local), MAKE, ALONG_Y)
    np.testing.assert_allclose([first, last], [[0, 0, 0.1], [0.2, 0, 0]], atol=1e-12)
    first, last = insertion_of(row(CardinalPt=10, CoordSys="GLOBAL", **local), MAKE, ALONG_Y)
    np.testing.assert_allclose([first, last], [[0, 0.1, 0], [0, 0, 0.2]], atol=1e-12)
    first, _ = insertion_of(row(CardinalPt=8, JtOffset2I=-0.1), MAKE, ALONG_Y)
    np.testing.assert_allclose(first, [0, 0, -0.5], atol=1e-12)  # both add up


def test_offsets_that_do_not_transform_the_stiffness_are_of_drawing_alone():
    """``Transform=No``: the frame bends between its joints, wherever it is drawn."""
    for key in ("Transform", "TransStiff"):
        first, last = insertion_of(row(CardinalPt=8, **{key: "No"}), MAKE, ALONG_Y)
        assert not first.any()
        assert not last.any()


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        ({"CardinalPt": 12}, "a cardinal point is 1 to 11; got '12'"),
        ({"CardinalPt": "top"}, "a cardinal point is 1 to 11; got 'top'"),
        ({"CardinalPt": 10, "CoordSys": "CSYS1"}, "offsets in 'CSYS1' are not read"),
    ],
)
def test_insertion_points_that_are_not_read_are_told(cells, said):
    """With the line of their row."""
    with pytest.raises(InputError, match=f"m.s2k, line 9: {said}"):
        insertion_of(row(**cells), MAKE, ALONG_Y)


def test_a_section_that_is_not_alike_on_both_sides_has_no_known_box():
    """A T's centroid is not in the middle of its box: only the centroid can be inserted at."""
    tee = FrameMake(
        section=MAKE.section, mass_per_length=0.0, weight_per_length=0.0, depth=0.8, width=0.3,
        symmetric=False,
    )  # fmt: skip
    with pytest.raises(InputError, match="where the box of this section lies"):
        insertion_of(row(CardinalPt=8), tee, ALONG_Y)
    assert not insertion_of(row(CardinalPt=10), tee, ALONG_Y)[0].any()


def test_releases_are_about_the_axes_that_they_name():
    """M3 bends in the plane of 1 and 2, whose axis is our y; M2 is about our z; T twists."""
    assert releases_of(row(M3I="Yes", TJ="Yes", M2J="Yes")) == (
        (False, True, False),
        (True, False, True),
    )
    assert releases_of(None) == ((False,) * 3,) * 2
    for cells, said in (
        ({"PI": "Yes"}, "releases of forces are not read"),
        ({"V2J": "Yes"}, "releases of forces are not read"),
        ({"M3I": "Yes", "PartialFix": "Yes"}, "partial fixity is not read"),
    ):
        with pytest.raises(InputError, match=said):
            releases_of(row(**cells))


def test_rigid_ends_are_their_lengths_times_the_factor():
    """0.5 m and 0.3 m, rigid by four tenths; a factor of 0 makes no end rigid."""
    cells = {"Type": "User", "LengthI": 0.5, "LengthJ": 0.3}
    assert rigid_ends_of(row(**cells, RigidFact=0.4), 6.0) == pytest.approx((0.2, 0.12))
    assert rigid_ends_of(row(**cells, RigidFactor=0.0), 6.0) == (0.0, 0.0)
    assert rigid_ends_of(None, 6.0) == (0.0, 0.0)
    for more, said in (
        ({"RigidFact": 1.5}, "a rigid zone factor is 0 to 1; got 1.5"),
        ({"RigidFact": 1.0, "LengthI": 5.8}, "end offsets leave nothing that bends"),
        ({"RigidFact": 1.0, "LengthI": -0.1}, "end offsets leave nothing that bends"),
    ):
        with pytest.raises(InputError, match=said):
            rigid_ends_of(row(**{**cells, **more}), 6.0)
    with pytest.raises(InputError, match="offsets without their lengths"):
        rigid_ends_of(row(Type="Auto", RigidFact=0.5), 6.0)
