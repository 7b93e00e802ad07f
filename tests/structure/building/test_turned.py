"""Buildings whose planes of symmetry and supports lie at any angle move as those along x and y."""

import numpy as np
import pytest
from buildings import LEVELS, box, column, line, reference, slab, strip, table, turned

from trundle.dynamics import factorise
from trundle.errors import InputError
from trundle.road import RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.simulate import Coupled, Crossing, Modal, ModalRatio, ensemble
from trundle.structure import MirrorPlane, reference_unit
from trundle.structure.building import Building, Meshing, Support, build_building
from trundle.vehicle import container_truck_40ft

ANGLE = np.deg2rad(30.0)
TURN = np.array([[np.cos(ANGLE), np.sin(ANGLE)], [-np.sin(ANGLE), np.cos(ANGLE)]])


def built(building, size=1.0):
    return build_building(building, Meshing(mesh_size=size))


def velocities(floor, turn, ends):
    """Velocities at two places under the container truck on a route."""
    crossing = Crossing(
        vehicle=container_truck_40ft(),
        route=Route.straight(*(tuple(end) for end in np.array(ends) @ turn), speed=5.0),
        road=RoadClass("B", level="geometric_mean"),
        band=RoughnessBand(n_min=0.05, n_max=2.0),
        entry=DriveIn(length=2.0),
    )
    method = Coupled(integration=Modal(f_max=20.0, dt=0.005), damping=ModalRatio(ratio=0.03))
    points = {
        name: tuple(np.array(place) @ turn)
        for name, place in {"tool": (21.3, 30.7), "far": (44.0, 60.0)}.items()
    }
    return ensemble(floor, crossing, method=method, points=points, n_runs=2, seed=1).velocity


@pytest.mark.longest
@pytest.mark.parametrize("ends", [((3.0, 10.0), (30.0, 10.0)), ((0.0, 5.0), (0.0, 40.0))])
def test_the_reference_unit_turned_by_30_degrees_answers_the_same_truck_the_same(ends):
    """Its three planes of symmetry are oblique then; a route in one of them is shared by half.

    The plan's builder and the building's give one crossing; the turned one differs by what modes
    found to 1e-6 leave.
    """
    plan = velocities(reference_unit(mesh_size=2.0), np.eye(2), ends)
    unit = built(reference(), 2.0)
    np.testing.assert_allclose(velocities(unit, np.eye(2), ends), plan, atol=1e-6 * plan.max())
    oblique = built(turned(reference(), ANGLE), 2.0)
    assert oblique.n_dofs == unit.n_dofs
    assert oblique.moving_mass() == pytest.approx(unit.moving_mass(), rel=1e-8)
    found = velocities(oblique, TURN, ends)
    np.testing.assert_allclose(found, plan, atol=1e-4 * np.abs(plan).max())


def test_a_turned_roller_holds_across_its_edge_alone():
    """A strip that slides along turned rails: modes of the strip along x, to round-off."""
    rails = [line((0.0, 0.0), (0.0, 2.0)), line((20.0, 0.0), (20.0, 2.0))]

    def house(angle):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, s], [-s, c]])
        across = (False, True, True, False, False, False)
        supports = [
            Support(on="slab", along=rail @ turn, held=across, angle=np.degrees(angle))
            for rail in rails
        ]
        middle = Support(
            on="slab",
            along=line((10.0, 1.0)) @ turn,
            held=(True,) + (False,) * 5,
            angle=np.degrees(angle),
        )
        outline = box(0, 0, 20, 2) @ turn
        return strip(slabs=(slab(corners=outline),), supports=(*supports, middle))

    straight, oblique = (built(house(a)).modes(60.0).frequencies for a in (0.0, ANGLE))
    np.testing.assert_allclose(oblique, straight, rtol=1e-7)


def test_two_planes_at_45_degrees_leave_an_eighth_of_a_square_plate():
    """A square table on its middle column and four corners: an eighth has its symmetric modes."""
    columns = tuple(column(x, y) for x in (-4.0, 0.0, 4.0) for y in (-4.0, 0.0, 4.0))
    whole = built(table(slabs=(slab(corners=box(-4, -4, 4, 4)),), columns=columns), 0.5)
    eighth = built(
        table(
            slabs=(slab(corners=line((0, 0), (4, 0), (4, 4))),),
            columns=tuple(column(*at) for at in ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0))),
            symmetry=(
                MirrorPlane.across(1, 0.0),
                MirrorPlane.through(line((0.0, 0.0), (4.0, 4.0))),
            ),
        ),
        0.5,
    )
    f_whole, f_eighth = (floor.modes(80.0).frequencies for floor in (whole, eighth))
    nearest = np.abs(f_eighth[:3, None] - f_whole).min(axis=1)
    assert (nearest < 0.02 * f_eighth[:3]).all()


def test_what_is_held_in_two_directions_is_held_in_all():
    """A node on rails at 0 and 30 degrees moves up alone; one on two alike slides along them."""
    held = (True,) + (False,) * 5
    place = line((2.0, 3.0))
    for other, moves in ((30.0, False), (180.0, True)):
        supports = (
            Support(on="slab", along=place, held=held),
            Support(on="slab", along=place, held=held, angle=other),
        )
        floor = built(table(supports=supports))
        node = int(np.hypot(*(floor.nodes[:, :2] - place[0]).T).argmin())
        load = np.zeros(floor.fixed.size)
        load[6 * node + 1] = 1e6
        by_free = load if floor.expansion is None else load @ floor.expansion
        if floor.expansion is None:
            by_free = np.zeros(floor.n_dofs)
            by_free[floor.dof_index[node, 1]] = 1e6
        moved = np.abs(factorise(floor.stiffness).solve(by_free)).max()
        assert bool(moved > 1e-9) is moves


def test_a_floor_on_turned_rollers_that_all_run_one_way_slides_that_way():
    rollers = tuple(
        Support(
            on="slab",
            along=line((x, 0), (x, 6)),
            held=(True, False, True) + (False,) * 3,
            angle=30.0,
        )
        for x in (0.0, 8.0)
    )
    house = Building(storeys=LEVELS[1:], slabs=(slab(),), supports=rollers)
    with pytest.raises(InputError, match="is not held: it moves along x and moves along y"):
        built(house)


def test_springs_do_not_turn():
    with pytest.raises(InputError, match="springs act along x, y and z"):
        Support(on="slab", along=line((0, 0)), springs=(1e6, 0, 0, 0, 0, 0), angle=30.0)
