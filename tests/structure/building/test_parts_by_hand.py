"""Parts of a building by hand: areas, footprints, storeys between, profiles, what is refused."""

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.structure import CONCRETE, BeamSection, MirrorPlane, ShellSection
from trundle.structure.building import Building, Column, Ramp, Slab, Storey
from trundle.structure.building.held import Mass
from trundle.structure.building.profile import Profile
from trundle.structure.building.sheets import has_slab, meets, passes, plane_of

PLATE = ShellSection(thickness=0.2, material=CONCRETE)
POST = Profile.rectangle(0.4, 0.8, CONCRETE)


def box(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def storeys(*levels):
    return tuple(Storey(name=f"level {z:g}", level=z) for z in levels)


def test_a_slab_has_its_area_less_its_openings_either_way_round():
    """An L of 12 m2 with a hole of 1 m2, by hand; clockwise too."""
    corner = np.array([[0.0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]])
    for outline in (corner, corner[::-1]):
        slab = Slab(on="a", section=PLATE, outline=outline, openings=(box(0.5, 0.5, 1.5, 1.5),))
        assert slab.area == pytest.approx(11.0)


def test_a_column_turned_by_30_degrees_has_its_corners_there():
    """Depth 0.8 m along its own x, width 0.4 m across: the first corner by trigonometry."""
    column = Column(profile=POST, at=np.array([5.0, 1.0]), bottom="a", top="b", angle=30.0)
    c, s = np.sqrt(3.0) / 2.0, 0.5
    first = [5.0 - 0.4 * c + 0.2 * s, 1.0 - 0.4 * s - 0.2 * c]
    np.testing.assert_allclose(column.footprint[0], first, atol=1e-12)
    np.testing.assert_allclose(column.depth_axis, [c, s, 0.0], atol=1e-12)
    sides = np.linalg.norm(np.diff(column.footprint, axis=0), axis=1)
    np.testing.assert_allclose(sides, [0.8, 0.4, 0.8])


def test_storeys_between_two_are_in_the_order_of_their_heights():
    """Given in any order, both ends belong to them; exchanged, there is nothing between."""
    building = Building(storeys=storeys(3.0, 0.0, 9.0, 6.0))
    names = [s.name for s in building.between("level 0", "level 6")]
    assert names == ["level 0", "level 3", "level 6"]
    assert building.between("level 6", "level 0") == ()
    assert building.level("level 9") == 9.0


def test_planes_of_symmetry_face_the_building():
    """A building at x above 2 m looks away from a plane whose normal was given the other way."""
    slab = Slab(on="level 0", section=PLATE, outline=box(2, 0, 8, 4))
    plane = MirrorPlane(normal=np.array([-1.0, 0.0]), position=-2.0)
    building = Building(storeys=storeys(0.0), slabs=(slab,), symmetry=(plane,))
    (facing,) = building.mirrors
    np.testing.assert_array_equal(facing.normal, [1.0, 0.0])
    assert facing.position == 2.0


def ramp(outline):
    return Ramp(name="ramp", section=PLATE, outline=outline, bottom="level 0", top="level 3")


def test_a_ramp_lies_in_the_plane_of_both_its_edges():
    """From x = 2 at 0 to x = 12 at 3 m: z = -0.6 + 0.3 x, the same all along y."""
    outline = np.array([[2.0, 0], [2, 4], [12, 4], [12, 0]])
    building = Building(storeys=storeys(0.0, 3.0), ramps=(ramp(outline),))
    np.testing.assert_allclose(plane_of(building, building.ramps[0]), [-0.6, 0.3, 0.0], atol=1e-9)
    assert building.ramps[0].area == pytest.approx(40.0)
    skew = outline + np.array([[0, 0], [0, 0], [2, 0], [0, 0.0]])
    warped = Building(storeys=storeys(0.0, 3.0), ramps=(ramp(skew),))
    with pytest.raises(
        InputError, match="ramp 'ramp' is warped: its lower and its upper edge must"
    ):
        plane_of(warped, warped.ramps[0])


def test_columns_meet_what_is_there_and_pass_what_is_not():
    """A slab with an opening and a panel with one: where neither is open there is a slab."""
    slab = Slab(on="level 3", section=PLATE, outline=box(0, 0, 8, 4), openings=(box(1, 1, 2, 2),))
    panel = Slab(on="level 3", section=PLATE, outline=box(4, 0, 8, 4), panel=True,
                 openings=(box(5, 1, 6, 2),))  # fmt: skip
    building = Building(storeys=storeys(0.0, 3.0, 6.0), slabs=(slab, panel))
    at = {place: has_slab(building, "level 3", np.array(place)) for place in
          ((0.5, 0.5), (1.5, 1.5), (4.5, 0.5), (5.5, 1.5), (9.0, 1.0))}  # fmt: skip
    assert list(at.values()) == [True, False, True, False, False]
    assert meets(building, "level 3", np.array([8.0, 4.0]))
    through = Column(profile=POST, at=np.array([1.5, 1.5]), bottom="level 0", top="level 6")
    assert [passes(building, through, s.name) for s in building.storeys] == [True, False, True]


def test_a_t_hangs_by_its_centroid():
    """From its top to its centroid, by integration over the height from scratch."""
    h, b, tw, tf = 0.6, 1.2, 0.3, 0.15
    tee = Profile.t(h, b, tw, tf, CONCRETE)

    def width(z):
        return b if z < tf else tw

    area, first = (
        integrate.quad(lambda z, p=p: width(z) * z**p, 0.0, h, points=[tf])[0] for p in (0, 1)
    )
    assert tee.above == pytest.approx(first / area, rel=1e-9)
    assert (tee.depth, tee.width) == (h, b)


def test_a_cracked_section_is_softer_and_as_heavy():
    """Half the stiffness: E I and G J by half, the mass of a metre as it was."""
    soft = POST.softened(0.5)
    assert soft.section.material.elastic_modulus == 15e9
    assert soft.section.material.shear_modulus == pytest.approx(6.25e9)
    assert soft.section.material.density * soft.section.area == pytest.approx(2450.0 * 0.32)
    with pytest.raises(InputError, match="stiffness factor must be greater than 0"):
        POST.softened(0.0)


def test_half_a_section_on_a_plane_of_symmetry_has_half_of_everything():
    """Area, inertia, torsion and shear: two halves side by side are the whole."""
    whole = POST.section
    half = whole.scaled(0.5)
    for name in ("area", "inertia_y", "inertia_z", "torsion_constant", "shear_area_y",
                 "shear_area_z"):  # fmt: skip
        assert 2.0 * getattr(half, name) == pytest.approx(getattr(whole, name), rel=1e-15)
    thin = BeamSection(
        area=1.0, inertia_y=1.0, inertia_z=1.0, torsion_constant=1.0, shear_area_y=np.inf,
        shear_area_z=np.inf, material=CONCRETE,
    )  # fmt: skip
    assert thin.scaled(0.5).shear_area_y == np.inf


def test_rolled_profiles_keep_their_outer_sizes():
    """HE 300 A by its name: 290 mm deep and 300 mm wide (EN 10365), hung by half its depth."""
    profile = Profile.rolled("he 300 a")
    assert (profile.depth, profile.width, profile.above) == pytest.approx((0.290, 0.300, 0.145))


def test_masses_and_storeys_that_cannot_be_are_refused():
    """A mass of nothing and a level that is nowhere."""
    with pytest.raises(InputError, match="mass must be greater than 0; got 0"):
        Mass(on="a", along=np.zeros((1, 2)), mass=0.0)
    with pytest.raises(InputError, match="level must be finite"):
        Storey(name="a", level=np.inf)
