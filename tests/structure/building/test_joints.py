"""What meets what: panels and openings, ramps beside each other, supports under heads, braces."""

import numpy as np
import pytest
from buildings import LEVELS, box, column, line, plate, slab, table

from trundle.structure import CONCRETE
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
)

SMALL = Profile.rectangle(0.3, 0.5, CONCRETE)


def built(building, size=1.0):
    return build_building(building, Meshing(mesh_size=size))


def area_of(floor, thickness):
    """Area of the elements of a thickness [m2]."""
    total = 0.0
    for group in (*floor.shells, *floor.others):
        section = getattr(group, "section", None)
        if getattr(section, "thickness", None) == thickness:
            xy = floor.nodes[group.connectivity][:, :, :2]
            x, y = np.moveaxis(xy, 2, 0)
            total += (
                0.5 * np.abs(np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1), axis=1)).sum()
            )
    return total


@pytest.mark.parametrize(
    ("of_slab", "of_panel", "thin", "thick"),
    [
        ((), (), 48 - 9, 9),
        ((box(3, 2, 4, 3),), (), 48 - 9, 9 - 1),
        ((), (box(3, 2, 4, 3),), 48 - 9, 9 - 1),
        ((box(4, 3, 6, 4),), (), 48 - 9 - 1, 9 - 1),
    ],
)
def test_panels_fill_no_opening_and_theirs_go_through(of_slab, of_panel, thin, thick):
    """A panel of 3 x 3 m over a slab of 48 m2 with an opening in either, or across its edge."""
    house = table(
        slabs=(
            slab(openings=of_slab),
            slab(corners=box(2, 1, 5, 4), section=plate(0.4), panel=True, openings=of_panel),
        )
    )
    floor = built(house)
    assert area_of(floor, 0.25) == pytest.approx(thin, rel=1e-9)
    assert area_of(floor, 0.4) == pytest.approx(thick, rel=1e-9)


def test_a_panel_reaches_no_further_than_its_slab():
    house = table(slabs=(slab(), slab(corners=box(6, 2, 10, 4), section=plate(0.4), panel=True)))
    floor = built(house)
    assert area_of(floor, 0.4) == pytest.approx(4.0, rel=1e-9)
    assert area_of(floor, 0.25) == pytest.approx(44.0, rel=1e-9)


def ramps(*strips, masses=()):
    """Ramps beside each other between two floors, each from y to y."""
    return Building(
        storeys=(Storey(name="low", level=0.0), Storey(name="high", level=1.5)),
        slabs=(slab(on="high", corners=box(10, 0, 14, 6)),),
        ramps=tuple(
            Ramp(
                name=f"ramp {i}",
                section=plate(),
                outline=line((0, a), (0, b), (10, b), (10, a)),
                bottom="low",
                top="high",
            )
            for i, (a, b) in enumerate(strips)
        ),
        supports=(
            Support(on="low", along=line((0, 1), (0, 5)), held=(True,) * 6),
            Support(on="high", along=line((14, 0), (14, 6)), held=(True,) * 6),
        ),
        masses=masses,
    )


def test_ramps_beside_each_other_are_joined_along_their_whole_edge():
    """Two of 2 m are one of 4 m, also where a mass divides the edge of one of them anew."""
    light = (Mass(on="ramp 0", along=line((4.4, 3.0)), mass=1.0),)
    one = built(ramps((1, 5), masses=light), 0.7)
    two = built(ramps((1, 3), (3, 5), masses=light), 0.7)
    assert two.moving_mass() == pytest.approx(one.moving_mass(), rel=0.01)
    f_one, f_two = (floor.modes(40.0).frequencies[:4] for floor in (one, two))
    np.testing.assert_allclose(f_two, f_one, rtol=0.01)


def test_a_wall_beside_a_ramp_touches_it_nowhere():
    """Nodes of the wall that happen to lie on the ramp's edge are others than the ramp's."""
    house = ramps((1, 5))
    wall = Wall(
        section=plate(0.2), along=line((2, 1), (10, 1)), bottom="low", top="high", base="fixed"
    )
    with_wall = Building(**{**vars(house), "walls": (wall,)})
    floor = built(with_wall, 1.0)
    (shells,) = (g for g in floor.shells if g.name == "wall")
    on_ramp = {int(n) for g in floor.shells if g.name == "ramp 0" for n in g.elements.ravel()}
    assert on_ramp
    between = {int(n) for n in shells.elements.ravel() if 0.01 < floor.nodes[n, 2] < 1.49}
    assert between
    assert not between & on_ramp


def test_a_roller_under_columns_of_an_edge_is_held_where_it_lies():
    """The edge does not sink; what it holds does not follow the columns' heads."""
    roller = Support(
        on="slab", along=line((1, 0), (1, 6)), held=(False, False, True, False, False, False)
    )
    floor = built(table(supports=(roller,)), 0.5)
    (links,) = floor.links
    held = np.flatnonzero(floor.fixed[:, 2] & (floor.nodes[:, 2] == 0.0))
    assert len(held) >= 13
    assert not set(held) & set(links.follows.tolist())
    assert floor.modes(40.0).n_modes > 0


def test_a_brace_ends_on_a_ramp():
    house = ramps((1, 5))
    brace = Brace(profile=SMALL, ends=line((12, 3), (5, 3)), on=("high", "ramp 0"))
    floor = built(Building(**{**vars(house), "braces": (brace,)}))
    (bar,) = (g for g in floor.others if g.name == "brace")
    np.testing.assert_allclose(
        floor.nodes[bar.connectivity[0]], [[12, 3, 1.5], [5, 3, 0.75]], atol=1e-9
    )


def test_columns_of_a_storey_without_a_slab_meet_beams_at_a_point():
    """Whatever lies in a column's outline there: the frame is the same on any mesh."""
    house = Building(
        storeys=LEVELS,
        beams=(Beam(on="slab", profile=SMALL, along=line((1, 1), (7, 1))),),
        columns=tuple(
            column(x, 1.0, profile=Profile.rectangle(0.6, 0.6, CONCRETE)) for x in (1.0, 7.0)
        ),
    )
    floors = [built(house, size) for size in (1.0, 0.1)]
    assert floors[0].links == floors[1].links == ()
    f = [floor.modes(60.0).frequencies[:3] for floor in floors]
    np.testing.assert_allclose(f[0], f[1], rtol=5e-3)


@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_a_hinged_beam_on_brackets_alone_stands(angle):
    """Nothing turns with its ends: ``pi / 2 / L^2 sqrt(E I / m)``, less what shear takes, 2 %."""
    span, turn = 8.0, np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    along = line((0, 0), (span, 0)) @ turn
    brackets = [
        Support(on="slab", along=end[None], held=(True, True, True, False, False, False))
        for end in along
    ]
    about_itself = Support(
        on="slab",
        along=along[:1],
        held=(False,) * 3 + (True, False, False),
        angle=np.degrees(angle),
    )
    house = Building(
        storeys=LEVELS[1:],
        beams=(Beam(on="slab", profile=SMALL, along=along, hinged=(True, True)),),
        supports=(*brackets, about_itself),
    )
    section = SMALL.section
    e, rho = CONCRETE.elastic_modulus, CONCRETE.density
    found = built(house, 0.5).modes(200.0).frequencies
    for inertia in (section.inertia_y, section.inertia_z):
        exact = np.pi / 2 / span**2 * np.sqrt(e * inertia / (rho * section.area))
        assert np.abs(found / exact - 1.0).min() < 0.02


def test_a_hinge_at_a_free_end_is_none():
    """A cantilever whose free end is hinged has the frequencies of one whose is not."""

    def cantilever(hinged):
        held = Support(on="slab", along=line((0, 0)), held=(True,) * 6)
        beam = Beam(on="slab", profile=SMALL, along=line((0, 0), (6, 0)), hinged=(False, hinged))
        return built(Building(storeys=LEVELS[1:], beams=(beam,), supports=(held,)), 0.5)

    f = [cantilever(hinged).modes(60.0).frequencies[:3] for hinged in (False, True)]
    np.testing.assert_allclose(f[1], f[0], rtol=1e-3)
