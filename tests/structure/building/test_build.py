"""Models of buildings against closed forms, against the plan's builder, and against each other."""

from dataclasses import replace

import numpy as np
import pytest
from buildings import LEVELS, box, column, line, plate, reference, slab, strip, table, turned

from trundle.dynamics import factorise
from trundle.errors import InputError
from trundle.route import contact_rows
from trundle.structure import CONCRETE, BeamSection, Hermite, MirrorPlane, reference_unit
from trundle.structure.building import (
    Beam,
    Brace,
    Building,
    Mass,
    Meshing,
    Profile,
    Ramp,
    Storey,
    Support,
    Wall,
    build_building,
    mesh_building,
)
from trundle.structure.mesh import Refinement

E, G, RHO = CONCRETE.elastic_modulus, CONCRETE.shear_modulus, CONCRETE.density


def built(building, size=1.0, **changes):
    return build_building(building, Meshing(mesh_size=size, **changes))


def first(building, size=1.0, n=1, f_max=60.0, **changes):
    return built(building, size, **changes).modes(f_max).frequencies[:n]


def pushed(floor, places, force, at, dof=2):
    """Displacements of nodes at places under a force at the node of another [m]."""
    load = np.zeros(floor.n_dofs)
    load[floor.dof_index[node_at(floor, at), dof]] = force
    u = factorise(floor.stiffness).solve(load)
    return [u[floor.dof_index[node_at(floor, place), dof]] for place in places]


def node_at(floor, place):
    away = np.linalg.norm(floor.nodes - np.asarray(place, dtype=float), axis=1)
    assert away.min() < 1e-6
    return int(away.argmin())


# --- the same floor, built in two ways


def test_the_reference_unit_part_by_part_is_the_reference_unit():
    """Same mass, same modes as the plan's builder gives: the two share nothing but elements."""
    unit, plan = built(reference(), 2.0), reference_unit(mesh_size=2.0)
    assert unit.n_dofs == plan.n_dofs
    assert unit.moving_mass() == pytest.approx(plan.moving_mass(), rel=1e-12)
    f_unit, f_plan = (floor.modes(12.0).frequencies for floor in (unit, plan))
    np.testing.assert_allclose(f_unit, f_plan, rtol=1e-9)


@pytest.mark.longest
def test_triangles_carry_the_reference_unit_as_quadrilaterals_do():
    """At 1 m, within 1 % of where quadrilaterals of 1 m and 0.6 m lead (their error goes with h^2).

    Quadrilaterals of 1 m themselves lie up to 0.9 % above it, triangles up to 0.5 % below.
    """
    coarse, fine = (reference_unit(mesh_size=h).modes(6.0).frequencies[:12] for h in (1.0, 0.6))
    settled = fine - (coarse - fine) * 0.6**2 / (1.0 - 0.6**2)
    triangles = first(reference(), 1.0, n=12, f_max=6.0, only_triangles=True)
    np.testing.assert_allclose(triangles, settled, rtol=0.01)


def test_a_building_turned_in_plan_has_the_same_modes():
    """Whatever is not square to the axes is meshed and joined as what is."""
    profile = Profile.rectangle(0.3, 0.6, CONCRETE)
    wall = Wall(
        section=plate(0.2), along=line((0, 0), (0, 4)), bottom="base", top="slab", base="fixed"
    )
    house = table(
        columns=tuple(
            column(x, y, profile=Profile.rectangle(0.3, 0.5, CONCRETE))
            for x in (3.0, 7.0)
            for y in (1.0, 5.0)
        ),
        beams=(Beam(on="slab", profile=profile, along=line((3, 1), (3, 5))),),
        walls=(wall,),
    )
    straight = first(house, 0.5, n=6, f_max=80.0)
    skewed = first(turned(house, np.deg2rad(30.0)), 0.5, n=6, f_max=80.0)
    np.testing.assert_allclose(skewed, straight, rtol=2e-3)


# --- beams under slabs


def test_a_beam_under_a_strip_is_a_composite_section():
    """First frequency of a T on bearings, pi/2/L^2 sqrt(EI/m); shear takes 2 % off."""
    w, d, b, t, span = 0.6, 1.5, 2.0, 0.2, 20.0
    beam = Beam(
        on="slab", profile=Profile.rectangle(w, d, CONCRETE), along=line((0, b / 2), (span, b / 2))
    )
    areas, lever = (b * t, w * d), (t + d) / 2.0
    centre = areas[1] * lever / sum(areas)
    inertia = b * t**3 / 12 + areas[0] * centre**2
    inertia += w * d**3 / 12 + areas[1] * (lever - centre) ** 2
    exact = np.pi / 2 / span**2 * np.sqrt(E * inertia / (RHO * sum(areas)))
    for triangles in (False, True):
        found = first(strip((beam,)), 1.0, n=2, only_triangles=triangles)
        assert found[1] == pytest.approx(exact, rel=0.025)
        assert found[1] < exact


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize(("w", "d"), [(0.3, 1.2), (0.6, 1.5)])
def test_a_beam_under_a_strip_twists_as_an_open_section(w, d, triangles):
    """Saint-Venant: the torsion constant of a T is the sum of its parts'.

    A web whose sections turn in plan with the slab's nodes would be sheared sideways, and the T
    several times too stiff with elements that turn in their plane.
    """
    span, b, t = 20.0, 2.0, 0.2
    beam = Beam(
        on="slab", profile=Profile.rectangle(w, d, CONCRETE), along=line((0, b / 2), (span, b / 2))
    )
    clamped = Support(on="slab", along=line((0, 0), (0, b)), held=(True,) * 6)
    floor = built(strip((beam,), supports=(clamped,)), 0.5, only_triangles=triangles)
    angles = pushed(floor, [(15.0, 1.0, 0.0), (5.0, 1.0, 0.0)], 1e6, (span, b / 2, 0.0), dof=3)
    parts = [BeamSection.rectangle(*size, CONCRETE).torsion_constant for size in ((b, t), (w, d))]
    found = 1e6 / G / ((angles[0] - angles[1]) / 10.0)
    assert found == pytest.approx(sum(parts), rel=0.03)


def test_a_hinged_beam_carries_no_moment_into_its_ends():
    """Midspan deflection of a lone beam: P L^3 / 48 EI hinged, P L^3 / 192 EI built in."""
    span, force = 10.0, 1e5
    profile = Profile.rectangle(0.3, 0.5, CONCRETE)
    section = profile.section
    bending = force * span**3 / (E * section.inertia_y)
    shear = force * span / (4.0 * G * section.shear_area_z)
    ends = [Support(on="slab", along=line((x, 0)), held=(True,) * 6) for x in (0.0, span)]
    for hinged, share in ((False, 192.0), (True, 48.0)):
        beam = Beam(
            on="slab", profile=profile, along=line((0, 0), (span, 0)), hinged=(hinged, hinged)
        )
        middle = Mass(on="slab", along=line((span / 2, 0)), mass=1.0)
        house = Building(storeys=LEVELS[1:], beams=(beam,), supports=tuple(ends), masses=(middle,))
        (sag,) = pushed(built(house), [(span / 2, 0, 0)], force, (span / 2, 0, 0))
        assert sag == pytest.approx(bending / share + shear, rel=1e-9)


def test_a_propped_beam_is_hinged_at_one_end_alone():
    """Hinge at the start: deflection at midspan 7 P L^3 / 768 EI (slender: no shear)."""
    span, force = 10.0, 1e5
    section = replace(
        BeamSection.rectangle(0.3, 0.5, CONCRETE), shear_area_y=np.inf, shear_area_z=np.inf
    )
    profile = Profile(section=section, depth=0.5, width=0.3, above=0.25)
    beam = Beam(on="slab", profile=profile, along=line((0, 0), (span, 0)), hinged=(True, False))
    house = Building(
        storeys=LEVELS[1:],
        beams=(beam,),
        supports=tuple(
            Support(on="slab", along=line((x, 0)), held=(True,) * 6) for x in (0.0, span)
        ),
        masses=(Mass(on="slab", along=line((span / 2, 0)), mass=1.0),),
    )
    (sag,) = pushed(built(house), [(span / 2, 0, 0)], force, (span / 2, 0, 0))
    assert sag == pytest.approx(7.0 * force * span**3 / (768.0 * E * section.inertia_y), rel=1e-9)


def test_a_beam_hangs_below_the_thickest_slab_beside_it():
    """Centroids: half a slab and the part above the centroid below the nodes, panel by panel."""
    profile = Profile.t(0.6, 0.4, 0.2, 0.15, CONCRETE)
    house = table(
        slabs=(slab(), slab(corners=box(0, 0, 4, 6), section=plate(0.4), panel=True)),
        beams=(
            Beam(on="slab", profile=profile, along=line((0, 3), (8, 3)), name="under"),
            Beam(on="slab", profile=profile, along=line((0, 1), (8, 1)), below=False, name="in"),
        ),
    )
    drops = {
        (group.name, round(float(group.offset[2]), 6))
        for group in built(house).beams
        if group.name != "column"
    }
    above = (0.06 * 0.075 + 0.09 * 0.375) / 0.15
    under = [("under", round(-t / 2 - above, 6)) for t in (0.25, 0.4)]
    assert drops == {*under, ("in", 0.0)}


# --- columns, walls, braces


@pytest.mark.parametrize(("base", "share"), [("fixed", 12.0), ("pinned", 3.0)])
def test_columns_sway_as_their_feet_are_held(base, share):
    """A rigid slab on slender columns: 4 x 12 EI / L^3, or 4 x 3 EI / L^3 on hinges."""
    stiff = replace(CONCRETE, elastic_modulus=E * 1e5)
    section = replace(
        BeamSection.rectangle(0.2, 0.2, CONCRETE), shear_area_y=np.inf, shear_area_z=np.inf
    )
    profile = Profile(section=section, depth=0.2, width=0.2, above=0.1)
    house = table(
        slabs=(slab(section=replace(plate(0.5), material=stiff)),),
        columns=tuple(
            column(x, y, profile=profile, base=base, head="point")
            for x in (1.0, 7.0)
            for y in (1.0, 5.0)
        ),
    )
    floor = built(house, 1.0)
    force = floor.inertia_of(0)
    u = factorise(floor.stiffness).solve(force)
    moved = u[floor.dof_index[node_at(floor, (1.0, 1.0, 0.0)), 0]]
    slab_mass = 48.0 * (0.5 * RHO)
    columns = 4.0 * 0.04 * RHO * 4.0  # the share of their own inertia that reaches the heads
    stiffness = 4.0 * share * E * section.inertia_y / 4.0**3
    assert moved * stiffness == pytest.approx(slab_mass + 0.5 * columns, rel=0.02)


def test_springs_under_columns_are_those_that_are_given():
    """A rigid table on four springs of k: it sinks by its weight over 4 k."""
    k = 2e7
    springs = (1e9, 1e9, k, 1e9, 1e9, 1e9)
    house = table(columns=tuple(column(x, y, base=springs) for x in (1.0, 7.0) for y in (1.0, 5.0)))
    floor = built(house)
    u = factorise(floor.stiffness).solve(floor.inertia_of(2))
    feet = [u[floor.dof_index[node_at(floor, (x, y, -4.0)), 2]] for x in (1, 7) for y in (1, 5)]
    assert sum(feet) * k == pytest.approx(floor.moving_mass(), rel=1e-9)


def test_a_turned_column_bends_about_its_own_axes():
    """A cantilever column of 0.2 x 0.6 m turned by 90 degrees is stiff along y, not along x."""
    profile = Profile.rectangle(0.2, 0.6, CONCRETE)
    sway = {}
    for angle in (0.0, 90.0):
        post = column(4.0, 3.0, profile=profile, angle=angle)
        floor = built(table(columns=(post,)), 1.0)
        at = (4.0, 3.0, 0.0)
        sway[angle] = [pushed(floor, [at], 1.0, at, dof=dof)[0] for dof in (0, 1)]
    assert sway[0.0][0] == pytest.approx(sway[90.0][1], rel=1e-6)
    assert sway[0.0][1] == pytest.approx(sway[90.0][0], rel=1e-6)
    assert sway[0.0][1] > 5.0 * sway[0.0][0]


def test_a_wall_is_a_deep_cantilever_in_its_plane():
    """Bending and shear of a wall of 4 x 12 m: F h^3 / 3 EI + F h / (5/6 G A)."""
    height, width, t, force = 12.0, 4.0, 0.25, 1e6
    house = Building(
        storeys=(Storey(name="base", level=0.0), Storey(name="top", level=height)),
        slabs=(slab(on="top", corners=box(0, -0.5, width, 0.5), section=plate(0.05)),),
        walls=(
            Wall(
                section=plate(t),
                along=line((0, 0), (width, 0)),
                bottom="base",
                top="top",
                base="fixed",
            ),
        ),
    )
    floor = built(house, 0.5)
    head = np.flatnonzero((np.abs(floor.nodes[:, 2] - height) < 1e-9) & (floor.nodes[:, 1] == 0.0))
    load = np.zeros(floor.n_dofs)
    load[floor.dof_index[head, 0]] = force / len(head)
    u = factorise(floor.stiffness).solve(load)[floor.dof_index[head, 0]].mean()
    inertia, area = t * width**3 / 12.0, t * width
    exact = force * height**3 / (3.0 * E * inertia) + force * height / (5.0 / 6.0 * G * area)
    assert u == pytest.approx(exact, rel=0.02)


def test_walls_and_slabs_of_three_storeys_share_their_nodes():
    """A wall through three storeys is joined to every slab: no part of the building is loose."""
    storeys = tuple(Storey(name=f"level {i}", level=3.0 * i) for i in range(3))
    wall = Wall(
        section=plate(0.2),
        along=line((0, 1), (0, 5)),
        bottom="level 0",
        top="level 2",
        base="fixed",
    )
    house = Building(
        storeys=storeys,
        slabs=tuple(slab(on=s.name) for s in storeys[1:]),
        walls=(wall,),
        columns=(
            column(7, 1, bottom="level 0", top="level 2"),
            column(7, 5, bottom="level 0", top="level 2"),
        ),
    )
    floor = built(house)
    assert set(floor.surfaces) == {"level 1", "level 2"}
    assert len(np.unique(floor.nodes.round(6), axis=0)) == len(floor.nodes)
    assert floor.modes(12.0).frequencies[0] > 1.0


def test_a_hinged_brace_is_a_bar():
    """A table on hinged feet and no moment in its heads sways on its braces: 2 E A cos^2 / L."""
    steel = Profile.tube(0.1, 0.005, CONCRETE)
    stiff = replace(CONCRETE, elastic_modulus=E * 1e5)
    thin = replace(BeamSection.rectangle(0.05, 0.05, CONCRETE), area=10.0)  # bends, never shortens
    posts = Profile(section=thin, depth=0.05, width=0.05, above=0.025)
    corners = [(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)]
    braces = tuple(
        Brace(profile=steel, ends=line(corners[i], corners[(i + 1) % 4]), on=("base", "slab"))
        for i in range(4)
    )
    house = Building(
        storeys=LEVELS,
        slabs=(slab(corners=box(0, 0, 6, 6), section=replace(plate(0.5), material=stiff)),),
        columns=tuple(column(x, y, profile=posts, base="pinned", head="point") for x, y in corners),
        braces=braces,
    )
    floor = built(house)
    moved = pushed(floor, [(3.0, 0.0, 0.0)], 1e5, (3.0, 0.0, 0.0), dof=0)[0]
    length = np.hypot(6.0, 4.0)
    one = E * steel.section.area / length * (6.0 / length) ** 2
    sway = 4.0 * 3.0 * E * posts.section.inertia_y / 4.0**3
    # the force acts at an edge 3 m off the middle: two braces along each edge share the turning
    turning = 3.0**2 / (4.0 * one * 3.0**2)
    assert moved == pytest.approx(1e5 * (1.0 / (2.0 * one + sway) + turning), rel=0.02)


# --- columns under flat slabs


@pytest.mark.longest
def test_a_flat_slab_settles_as_its_mesh_is_refined():
    """Frequencies and the static answer at a tool: below 5 % to half the size, 2 % to a quarter."""
    house = Building(
        storeys=LEVELS,
        slabs=(slab(corners=box(-1, -1, 17, 17), section=plate(0.3)),),
        columns=tuple(
            column(x, y, profile=Profile.rectangle(0.5, 0.5, CONCRETE))
            for x in (0.0, 8.0, 16.0)
            for y in (0.0, 8.0, 16.0)
        ),
    )
    tool, wheel = np.array([[4.1, 4.2]]), np.array([[5.7, 4.4]])
    f, answer = [], []
    for size in (0.75, 0.375, 0.1875):
        floor = built(house, size)
        f.append(floor.modes(25.0).frequencies[:8])
        rows = contact_rows(
            floor, np.concatenate([tool, wheel]), np.array([[1.0, 0.0]] * 2), shape=Hermite()
        )
        both = rows.matrix(rows.value).toarray()
        answer.append(float(both[0] @ factorise(floor.stiffness).solve(both[1])))
    for values in (f, answer):
        assert values[1] == pytest.approx(values[0], rel=0.05)
        assert values[2] == pytest.approx(values[1], rel=0.02)


def test_a_column_takes_the_slab_over_its_cross_section_along():
    """Nodes within a column's cross-section move as its axis does, and lie where it is drawn."""
    post = column(4.0, 3.0, profile=Profile.rectangle(0.4, 0.8, CONCRETE), angle=30.0)
    floor = built(table(columns=(post,)), 0.8)
    (links,) = floor.links
    behind = floor.nodes[links.follows, :2]
    assert len(behind) >= 4
    for corner in post.footprint:
        assert np.hypot(*(behind - corner).T).min() < 1e-5
    assert set(links.leads.tolist()) == {node_at(floor, (4.0, 3.0, 0.0))}


def test_columns_above_and_below_a_slab_hold_it_as_one_block():
    """A thick column below, a thinner one above, and one that touches it: nobody follows two."""
    storeys = (*LEVELS, Storey(name="up", level=4.0))
    wide = Profile.rectangle(0.8, 0.8, CONCRETE)
    house = table(
        storeys=storeys,
        slabs=(slab(), slab(on="up")),
        columns=(
            *(column(x, y, profile=wide) for x in (1.0, 7.0) for y in (1.0, 5.0)),
            *(column(x, y, bottom="slab", top="up", base=None) for x in (1.0, 7.0) for y in (1.0, 5.0)),
            column(1.6, 1.0),
        ),
    )  # fmt: skip
    floor = built(house)
    (links,) = floor.links
    assert len(np.unique(links.follows)) == len(links.follows)
    assert not set(links.leads.tolist()) & set(links.follows.tolist())
    # nodes of the block at (1, 1) move together: 0.8 m square below, and what touches it
    block = links.leads == node_leading(floor, (1.0, 1.0, 0.0), links)
    x = floor.nodes[links.follows[block], 0]
    assert (x.min(), x.max()) == pytest.approx((0.6, 1.8))


def node_leading(floor, place, links):
    """Whom the node at a place follows; itself, if it leads."""
    node = node_at(floor, place)
    behind = np.flatnonzero(links.follows == node)
    return int(links.leads[behind[0]]) if len(behind) else node


# --- ramps and storeys


def ramp_house(slope=0.15):
    length = 10.0
    rise = slope * length
    return Building(
        storeys=(Storey(name="low", level=0.0), Storey(name="high", level=rise)),
        slabs=(slab(on="high", corners=box(length, 0, length + 4, 4)),),
        ramps=(
            Ramp(
                name="ramp",
                section=plate(),
                outline=line((0, 0), (0, 4), (length, 4), (length, 0)),
                bottom="low",
                top="high",
            ),
        ),
        supports=(
            Support(on="low", along=line((0, 0), (0, 4)), held=(True,) * 6),
            Support(on="high", along=line((14, 0), (14, 4)), held=(True,) * 6),
            Support(
                on="high", along=line((10, 0), (10, 4)), held=(False, False, True) + (False,) * 3
            ),
        ),
    )


def test_a_wheel_presses_at_right_angles_on_a_ramp():
    """A unit load on a ramp: components of its normal, moments none (sums over the dofs)."""
    floor = built(ramp_house(), 1.0)
    surface = floor.surface("ramp")
    at = surface.frame.from_plan(np.array([[4.3, 1.7]]))
    rows = contact_rows(floor, at, np.array([[1.0, 0.0]]), shape=Hermite(), on="ramp")
    weights = rows.matrix(rows.value)
    force = [float((weights @ floor.rigid_vector(dof))[0]) for dof in range(3)]
    slope = 0.15
    assert force == pytest.approx(np.array([-slope, 0.0, 1.0]) / np.hypot(1.0, slope), abs=1e-12)
    assert surface.frame.to_plan(at)[0] == pytest.approx([4.3, 1.7])


def test_a_gentle_ramp_is_nearly_the_level_slab():
    """Slopes go to 0: the first frequency of one of 3 % is that of one of 6 %, to 1 - cos."""
    flat, gentle = (first(ramp_house(slope), 1.0)[0] for slope in (3e-2, 6e-2))
    assert flat == pytest.approx(gentle, rel=5e-3)


def test_a_force_on_one_storey_moves_another():
    """Reciprocity between storeys: what the lower does to the upper, the upper does to it."""
    storeys = tuple(
        Storey(name=n, level=z) for n, z in (("base", -4.0), ("slab", 0.0), ("up", 4.0))
    )
    house = Building(
        storeys=storeys,
        slabs=(slab(), slab(on="up")),
        columns=tuple(column(x, y, top="up") for x in (1.0, 7.0) for y in (1.0, 5.0)),
    )
    floor = built(house)
    places, along = np.array([[4.1, 2.2], [2.7, 3.3]]), np.array([[1.0, 0.0]])
    rows = [
        contact_rows(floor, place[None], along, shape=Hermite(), on=on)
        for place, on in zip(places, ("slab", "up"), strict=True)
    ]
    one, other = (row.matrix(row.value).toarray()[0] for row in rows)
    factor = factorise(floor.stiffness)
    there, back = other @ factor.solve(one), one @ factor.solve(other)
    assert there == pytest.approx(back, rel=1e-9)
    assert abs(there) > 1e-3 * (one @ factor.solve(one))


# --- masses, supports, refinement


def test_masses_at_points_and_along_lines_are_all_there():
    light, loaded = (
        built(table(masses=masses), 1.0).moving_mass()
        for masses in (
            (),
            (
                Mass(on="slab", along=line((3, 2)), mass=800.0),
                Mass(on="slab", along=line((0, 0), (8, 0), (8, 6)), mass=120.0),
            ),
        )
    )
    assert loaded - light == pytest.approx(800.0 + 120.0 * 14.0, rel=1e-9)


def test_springs_along_a_line_count_by_the_metre():
    """A strip on a line of springs under each edge sinks by its weight over 2 b k."""
    k, edges = 5e6, (0.0, 6.0)
    house = Building(
        storeys=LEVELS[1:],
        slabs=(slab(corners=box(0, 0, 6, 3)),),
        supports=tuple(
            Support(on="slab", along=line((x, 0), (x, 3)), springs=(1e9, 1e9, k, 0, 0, 0))
            for x in edges
        ),
    )
    floor = built(house)
    u = factorise(floor.stiffness).solve(floor.inertia_of(2))
    total = 0.0
    for group in floor.springs:
        nodes = group.elements[:, 0]
        total += group.stiffness[2] * u[floor.dof_index[nodes, 2]].sum()
    assert total == pytest.approx(floor.moving_mass(), rel=1e-9)
    assert sum(g.stiffness[2] * len(g.elements) for g in floor.springs) == pytest.approx(6.0 * k)


def test_elements_are_smaller_where_it_is_asked_for():
    near = Refinement(line=line((2, 3)), size=0.2, reach=0.4, sheet="slab")
    coarse, fine = (
        mesh_building(table(), Meshing(mesh_size=1.0, refinements=some)) for some in ((), (near,))
    )
    assert len(fine.nodes) > 1.4 * len(coarse.nodes)
    away = np.hypot(*(fine.nodes[:, :2] - (2.0, 3.0)).T)
    assert np.count_nonzero(away < 0.5) >= 12


def test_sizes_of_a_meshing_are_scaled_together():
    near = Refinement(line=line((2, 3)), size=0.2, reach=0.4)
    half = Meshing(mesh_size=1.0, refinements=(near,)).scaled(0.5)
    assert (half.mesh_size, half.refinements[0].size) == (0.5, 0.1)


# --- what nothing holds


def test_what_nothing_holds_is_named():
    """A second slab beside the first, joined to nothing."""
    house = table(slabs=(slab(), slab(corners=box(20, 0, 26, 5), name="annex")))
    with pytest.raises(
        InputError, match=r"annex at x 20 to 26, y 0 to 5, z 0 m is held by nothing"
    ):
        built(house)


def test_a_floor_on_rollers_moves_sideways_and_turns():
    rollers = tuple(
        Support(on="slab", along=line((x, 0), (x, 6)), held=(False, False, True) + (False,) * 3)
        for x in (0.0, 8.0)
    )
    house = Building(storeys=LEVELS[1:], slabs=(slab(),), supports=rollers)
    with pytest.raises(InputError, match="moves along x and moves along y and turns about z"):
        built(house)


def off_the_whole(half, whole):
    """Largest distance of the first five frequencies of a half from those of the whole."""
    f_half, f_whole = (floor.modes(60.0).frequencies for floor in (half, whole))
    nearest = np.abs(f_half[:5, None] - f_whole).min(axis=1)
    return (nearest / f_half[:5]).max()


def test_half_a_table_at_a_plane_of_symmetry_has_half_the_mass_and_its_symmetric_modes():
    whole = table(columns=tuple(column(x, y) for x in (1.0, 4.0, 7.0) for y in (1.0, 5.0)))
    half = table(
        slabs=(slab(corners=box(0, 0, 4, 6)),),
        columns=tuple(column(x, y) for x in (1.0, 4.0) for y in (1.0, 5.0)),
        symmetry=(MirrorPlane.across(0, 4.0),),
    )
    both = [built(house, 0.5) for house in (whole, half)]
    assert both[1].moving_mass() == pytest.approx(0.5 * both[0].moving_mass(), rel=2e-3)
    assert off_the_whole(both[1], both[0]) < 0.01


@pytest.mark.parametrize("head", ["point", "rigid"])
def test_a_beam_is_hinged_at_the_face_of_a_column_with_a_rigid_head(head):
    """A beam in a thin strip on two stiff posts: P L^3 / 48 EI between its hinges.

    Within a head nothing bends: a hinge at the column's axis would let go of nothing, and leave
    the beam built in, four times stiffer.
    """
    span, width, force = 8.0, 0.8, 1e5
    soft = replace(CONCRETE, elastic_modulus=E * 1e-4)
    profile = Profile.rectangle(0.3, 0.8, CONCRETE)
    section = profile.section
    stiff = Profile.rectangle(width, width, replace(CONCRETE, elastic_modulus=E * 1e4))
    house = Building(
        storeys=LEVELS,
        slabs=(
            slab(
                corners=box(-1, -1, span + 1, 1),
                section=replace(plate(0.05), material=soft),
            ),
        ),
        beams=(
            Beam(
                on="slab",
                profile=profile,
                along=line((0, 0), (span, 0)),
                hinged=(True, True),
                below=False,
            ),
        ),
        columns=tuple(column(x, 0.0, profile=stiff, head=head) for x in (0.0, span)),
        masses=(Mass(on="slab", along=line((span / 2, 0)), mass=1.0),),
    )
    clear = span - (width if head == "rigid" else 0.0)
    exact = force * clear**3 / (48.0 * E * section.inertia_y)
    exact += force * clear / (4.0 * G * section.shear_area_z)
    (sag,) = pushed(built(house, 0.5), [(span / 2, 0, 0)], force, (span / 2, 0, 0))
    assert sag == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize("rise", [1.0, 1.001, 1.003, 0.997])
def test_a_ramp_meets_its_floors_whatever_their_level(rise):
    """The same edge, seen from the ramp and from the floor, is one: nothing is loose above it."""
    low, high = (ramp_house(rise / 10.0 * factor) for factor in (1.0, 1.0 + 1e-6))
    nodes = [len(built(house, 0.7).nodes) for house in (low, high)]
    assert nodes[0] == nodes[1]
    assert first(low, 0.7, f_max=40.0)[0] == pytest.approx(
        first(high, 0.7, f_max=40.0)[0], rel=1e-3
    )


def test_what_stands_in_a_plane_of_symmetry_belongs_to_the_model_by_half():
    """Springs under columns and edges, and masses in the plane: half the whole, and its modes."""
    soft = (1e8, 1e8, 2e7, 1e6, 1e6, 1e6)
    by_metre = (0.0, 0.0, 3e6, 0.0, 0.0, 0.0)

    def house(to, xs, **changes):
        return table(
            slabs=(slab(corners=box(0, 0, to, 6)),),
            columns=tuple(column(x, y, base=soft) for x in xs for y in (1.0, 5.0)),
            supports=(
                Support(on="slab", along=line((4, 2), (4, 4)), springs=by_metre),
                Support(on="slab", along=line((4, 3)), springs=(0, 0, 4e6, 0, 0, 0)),
                Support(on="slab", along=line((0, 3), (to, 3)), springs=by_metre),
            ),
            masses=(
                Mass(on="slab", along=line((4, 0.5)), mass=900.0),
                Mass(on="slab", along=line((4, 3), (4, 6)), mass=400.0),
                Mass(on="slab", along=line((0, 3), (to, 3)), mass=200.0),
            ),
            **changes,
        )

    whole = house(8, (1.0, 4.0, 7.0))
    half = house(4, (1.0, 4.0), symmetry=(MirrorPlane.across(0, 4.0),))
    both = [built(one, 0.5) for one in (whole, half)]
    for read in (_spring_sum, _point_masses):
        assert read(both[1]) == pytest.approx(0.5 * read(both[0]), rel=1e-9)
    assert off_the_whole(both[1], both[0]) < 0.01


def _spring_sum(floor):
    return sum(float(g.stiffness[2]) * len(g.elements) for g in floor.springs)


def _point_masses(floor):
    return sum(g.mass.sum() for g in floor.masses)


def test_a_slab_moves_with_all_of_a_wide_column_s_head():
    """A pier of 2 m under elements of 0.5 m: nodes inside its outline follow it as its edges do."""
    pier = Profile.rectangle(2.0, 2.0, CONCRETE)
    floor = built(table(columns=(column(4.0, 3.0, profile=pier),)), 0.5)
    (links,) = floor.links
    level = floor.nodes[:, 2] == 0.0
    within = level & (np.abs(floor.nodes[:, :2] - (4.0, 3.0)).max(axis=1) < 1.0 + 1e-6)
    follow = set(np.flatnonzero(within)) - set(links.leads.tolist())
    assert set(links.follows.tolist()) == follow
    assert len(follow) >= 24
