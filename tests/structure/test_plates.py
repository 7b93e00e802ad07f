"""Plates that are not alike in all directions: closed forms, isotropic limits, what is smeared."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from trundle.dynamics import natural_modes
from trundle.errors import InputError
from trundle.structure import CONCRETE, BeamSection, Floor, ShellGroup, ShellSection, TriangleGroup
from trundle.structure.elements.quad_shell import shell_stiffness
from trundle.structure.elements.triangle_shell import triangle_stiffness
from trundle.structure.plates import OrthotropicSection
from trundle.structure.smeared import (
    composite_deck,
    hollow_core_slab,
    ribbed_slab,
    waffle_slab,
)

STIFF = 1e13  # N/m: shear that does not count
PLATE = OrthotropicSection(
    bending=(40e6, 10e6, 2e6, 5e6), membrane=(6e9, 5e9, 1e9, 2e9), shear=(STIFF, STIFF),
    mass_per_area=500.0,
)  # fmt: skip


def floor_of(section, *, triangles, n=(16, 12), size=(8.0, 6.0), held="all"):
    """A plate of quadrilaterals or triangles on simple edges, that only bends."""
    x, y = np.meshgrid(*(np.linspace(0.0, s, k + 1) for s, k in zip(size, n, strict=True)))
    flat = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    at = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (g.ravel() for g in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    edge = flat[:, 0] % size[0] == 0.0
    if held == "all":
        edge |= flat[:, 1] % size[1] == 0.0
    fixed = np.zeros((len(flat), 6), dtype=bool)
    fixed[edge, 2] = True
    fixed[:, [0, 1, 5]] = True
    if not triangles:
        quads = ShellGroup(elements=np.column_stack([a, b, c, d]), section=section)
        return Floor(nodes=flat, fixed=fixed, shells=(quads,))
    both = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return Floor(
        nodes=flat, fixed=fixed, others=(TriangleGroup(connectivity=both, section=section),)
    )


@pytest.mark.parametrize("triangles", [False, True])
def test_frequencies_of_an_orthotropic_plate(triangles):
    """Simply supported: ``w^2 = (pi^4 / m) (Dx a^4 + 2 (Dxy + 2 Dt) a^2 b^2 + Dy b^4)``.

    Leissa, Vibration of Plates (NASA SP-160, 1969), equation 9.15.
    """
    floor = floor_of(PLATE, triangles=triangles, n=(32, 24))
    d_x, d_y, d_xy, d_t = PLATE.bending
    waves = np.array([(m / 8.0, n / 6.0) for m in range(1, 4) for n in range(1, 4)]) * np.pi
    a, b = waves.T**2
    square = (d_x * a**2 + 2.0 * (d_xy + 2.0 * d_t) * a * b + d_y * b**2) / 500.0
    expected = np.sort(np.sqrt(square)) / (2.0 * np.pi)
    found = natural_modes(floor.mass, floor.stiffness, f_max=60.0).frequencies
    np.testing.assert_allclose(found[:4], expected[:4], rtol=0.01)


@pytest.mark.parametrize("degrees", [0.0, 25.0, 90.0])
def test_an_isotropic_plate_has_no_direction(degrees):
    """The same matrices as a solid slab, whatever the axis is, on any shape of element."""
    solid = ShellSection(thickness=0.2, material=CONCRETE)
    laws = solid.laws(np.eye(3)[None])
    as_plate = OrthotropicSection(
        bending=(*(laws.bending[i, i] for i in (0, 1)), laws.bending[0, 1], laws.bending[2, 2]),
        membrane=(*(laws.membrane[i, i] for i in (0, 1)), laws.membrane[0, 1], laws.membrane[2, 2]),
        shear=(laws.shear[0, 0], laws.shear[1, 1]), mass_per_area=solid.mass_per_area,
    ).turned(degrees)  # fmt: skip
    quad = np.array([[[0.0, 0.0, 0.0], [1.3, 0.1, 0.0], [1.1, 0.9, 0.0], [-0.1, 1.2, 0.0]]])
    for form, corners in ((shell_stiffness, quad), (triangle_stiffness, quad[:, :3])):
        expected = form(corners, solid)
        np.testing.assert_allclose(
            form(corners, as_plate), expected, atol=1e-10 * np.abs(expected).max()
        )


def test_a_turned_plate_on_a_turned_element_is_the_same():
    """Axis and element turned together by 37 degrees: energies do not change."""
    corners = np.array([[[0.0, 0.0, 0.0], [1.3, 0.1, 0.0], [1.1, 0.9, 0.0], [-0.1, 1.2, 0.0]]])
    c, s = np.cos(np.deg2rad(37.0)), np.sin(np.deg2rad(37.0))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    for form, part in ((shell_stiffness, corners), (triangle_stiffness, corners[:, :3])):
        values = np.linalg.eigvalsh(form(part, PLATE)[0])
        turned = np.linalg.eigvalsh(form(part @ turn.T, PLATE.turned(37.0))[0])
        np.testing.assert_allclose(turned, values, atol=1e-9 * values.max())


def mid_deflection(section, **settings):
    """Deflection of the middle under a uniform load of 1 kN/m2 [m]."""
    floor = floor_of(section, **settings)
    load = -1e3 / section.mass_per_area * (floor.mass @ floor.rigid_vector(2))
    u = spsolve(floor.stiffness, load)
    return -u[floor.dof_index[floor.nearest_node(4.0, 3.0), 2]]


def test_a_ribbed_strip_bends_as_its_t_beams():
    """Spanning 8 m along the ribs, sides free, no Poisson's ratio: ``5 q L^4 / (384 E I / s)``."""
    concrete = replace(CONCRETE, poisson_ratio=0.0)
    section = ribbed_slab(plate=0.08, rib_width=0.12, rib_depth=0.3, spacing=0.7, material=concrete)
    areas = np.array([0.7 * 0.08, 0.12 * 0.3])
    middles = np.array([-0.04, -0.23])
    centre = areas @ middles / areas.sum()
    inertia = 0.7 * 0.08**3 / 12 + 0.12 * 0.3**3 / 12 + areas @ (middles - centre) ** 2
    assert section.bending[0] == pytest.approx(concrete.elastic_modulus * inertia / 0.7, rel=1e-12)
    expected = 5.0 * 1e3 * 8.0**4 / (384.0 * concrete.elastic_modulus * inertia / 0.7)
    stiff = replace(section, shear=(STIFF, STIFF))
    for triangles in (False, True):
        found = mid_deflection(stiff, triangles=triangles, held="ends", n=(32, 24))
        assert found == pytest.approx(expected, rel=0.005)
    assert section.mass_per_area == pytest.approx(2450.0 * areas.sum() / 0.7, rel=1e-12)


def test_a_ribbed_slab_without_ribs_is_a_slab():
    """Ribs of next to no width leave the plate's own stiffnesses."""
    section = ribbed_slab(plate=0.2, rib_width=1e-9, rib_depth=0.1, spacing=1.0, material=CONCRETE)
    laws = ShellSection(thickness=0.2, material=CONCRETE).laws(np.eye(3)[None])
    np.testing.assert_allclose(
        section.bending,
        [laws.bending[0, 0], laws.bending[1, 1], laws.bending[0, 1], laws.bending[2, 2]],
        rtol=1e-6,
    )
    np.testing.assert_allclose(
        section.membrane,
        [laws.membrane[0, 0], laws.membrane[1, 1], laws.membrane[0, 1], laws.membrane[2, 2]],
        rtol=1e-6,
    )


@pytest.mark.parametrize(("build", "directions"), [(ribbed_slab, 1), (waffle_slab, 2)])
def test_a_strip_of_ribs_twists_as_its_rectangles(build, directions):
    """w = c x y on a strip of one rib: ``4 Dt s = G (s t^3 / 3 + J)``, Saint-Venant's of both."""
    section = build(plate=0.08, rib_width=0.12, rib_depth=0.3, spacing=0.7, material=CONCRETE)
    rib = BeamSection.rectangle(0.12, 0.3, CONCRETE).torsion_constant
    whole = 0.7 * 0.08**3 / 3.0 + directions * rib
    assert 4.0 * section.bending[3] * 0.7 == pytest.approx(CONCRETE.shear_modulus * whole, rel=1e-9)


def test_a_waffle_slab_is_alike_in_both_directions_and_weighs_what_it_holds():
    """Volume of plate and crossing ribs, each crossing counted once."""
    section = waffle_slab(
        plate=0.1, rib_width=0.15, rib_depth=0.3, spacing=0.9, material=CONCRETE,
        superimposed_mass=100.0,
    )  # fmt: skip
    assert section.bending[0] == section.bending[1]
    cell = 0.9**2 * 0.1 + (2 * 0.9 * 0.15 - 0.15**2) * 0.3
    assert section.mass_per_area == pytest.approx(2450.0 * cell / 0.9**2 + 100.0, rel=1e-12)
    one_way = ribbed_slab(plate=0.1, rib_width=0.15, rib_depth=0.3, spacing=0.9, material=CONCRETE)
    assert one_way.bending[0] == pytest.approx(section.bending[0], rel=1e-12)
    assert one_way.bending[1] < 0.1 * section.bending[1]


def test_hollow_cores_take_weight_and_leave_stiffness():
    """Circles of 150 mm every 190 mm in 200 mm: area and inertia less the circles' own."""
    section = hollow_core_slab(thickness=0.2, void=0.15, spacing=0.19, material=CONCRETE)
    hole = np.pi * 0.15**2 / 4.0
    assert section.mass_per_area == pytest.approx(2450.0 * (0.2 - hole / 0.19), rel=1e-12)
    inertia = 0.2**3 / 12.0 - np.pi * 0.15**4 / 64.0 / 0.19
    wide = CONCRETE.elastic_modulus / (1.0 - CONCRETE.poisson_ratio**2)
    assert section.bending[0] == pytest.approx(wide * inertia, rel=1e-9)
    assert 0.7 * section.bending[0] < section.bending[1] < section.bending[0] * 1.05
    topped = hollow_core_slab(
        thickness=0.2, void=0.15, spacing=0.19, material=CONCRETE, topping=0.05
    )
    assert topped.bending[0] > 1.7 * section.bending[0]


def test_a_composite_deck_weighs_concrete_and_sheet():
    """130 mm on a 51 mm deck whose ribs are half as wide as they are apart."""
    section = composite_deck(
        depth=0.13, deck_height=0.051, rib_width=0.075, spacing=0.15, material=CONCRETE
    )
    volume = 0.079 + 0.5 * 0.051
    assert section.mass_per_area == pytest.approx(2450.0 * volume + 12.0, rel=1e-12)
    assert section.bending[0] > 2.0 * section.bending[1]


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: replace(PLATE, bending=(1.0, 1.0, 2.0, 1.0)), "bending stiffnesses must be above"),
        (lambda: ribbed_slab(plate=0.1, rib_width=0.8, rib_depth=0.2, spacing=0.7,
                             material=CONCRETE), "ribs of 0.8 m cannot stand every 0.7 m"),
        (lambda: hollow_core_slab(thickness=0.2, void=0.2, spacing=0.3, material=CONCRETE),
         "do not fit into"),
        (lambda: composite_deck(depth=0.1, deck_height=0.1, rib_width=0.1, spacing=0.3,
                                material=CONCRETE), "leaves nothing"),
    ],
)  # fmt: skip
def test_plates_that_cannot_be_are_refused(build, said):
    with pytest.raises(InputError, match=said):
        build()


def test_a_plate_whose_axis_stands_on_it_is_refused():
    upright = replace(PLATE, axis=np.array([0.0, 0.0, 1.0]))
    with pytest.raises(InputError, match="stands upright"):
        shell_stiffness(np.array([[[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]]), upright)
