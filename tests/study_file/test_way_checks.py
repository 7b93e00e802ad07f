"""Ways, wheels and standing places on slabs: which leg, which wheel, which place leaves them."""

import re

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

HOUSE = BUILDING.replace('mesh_size = "1.5 m"', 'mesh_size = "3 m"')
WAY = 'path = [["0 m", "5 m"], ["16 m", "5 m"]]'
AT = 'on = "lab"\nat = ["4 m", "3 m"]'
CAR = 'kind = "car_bmw_320i"'


def told(*changes, text=HOUSE):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    with pytest.raises(StudyError) as caught:
        study_from_text(text)
    return {p.place: p for p in caught.value.problems}


def loaded(*changes, text=HOUSE):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return study_from_text(text)


def test_the_leg_over_the_opening_is_named_with_where_it_is_over_none():
    """The hole is 10 to 12 m by 2 to 4 m: the second of three legs crosses it at x = 11 m."""
    bent = 'path = [["0 m", "5 m"], ["11 m", "5 m"], ["11 m", "1 m"], ["16 m", "1 m"]]'
    problem = told((WAY, bent))["route[1].path[2]"]
    x0, y0, x1, y1 = map(float, re.findall(r"\d+\.?\d*", problem.value))
    assert (x0, x1) == (11.0, 11.0)
    # looked at every 0.1 m: within that of the edges at y = 4 m and y = 2 m
    assert 3.9 <= y0 <= 4.0
    assert 2.0 <= y1 <= 2.1


def test_a_way_along_the_edge_of_an_opening_is_on_the_slab():
    """y = 4 m bounds the hole; y = 3.95 m is over it."""
    assert loaded((WAY, WAY.replace('"5 m"', '"4 m"')))
    assert "route[1].path[1]" in told((WAY, WAY.replace('"5 m"', '"3.95 m"')))


def test_a_way_over_an_opening_is_told_whatever_the_mesh():
    """In elements of 6 m too, whose own coordinates lead far from them, the hole is a hole."""
    coarse = HOUSE.replace('mesh_size = "3 m"', 'mesh_size = "6 m"')
    surface = study_from_text(coarse).floor.surface("deck")
    x, y = np.meshgrid(np.linspace(0.05, 15.95, 60), np.linspace(0.05, 5.95, 60))
    hole = (x > 10.0) & (x < 12.0) & (y > 2.0) & (y < 4.0)
    there = surface.frame.from_plan(np.stack([x.ravel(), y.ravel()], axis=1))
    assert (surface.holds(there) != hole.ravel()).all()
    over = WAY.replace('"5 m"', '"3.9 m"')
    assert "route[1].path[1]" in told((WAY, over), text=coarse)


def test_wheels_beside_the_way_are_looked_at_too():
    """A car of 1.4 m track 0.5 m beside the hole has its left or right wheels over it."""
    wide = (CAR, f'{CAR}\ntrack_width = "1.4 m"')
    near = WAY.replace('"5 m"', '"4.5 m"')
    problem = told(wide, (WAY, near))["route[1].path"]
    assert problem.value.startswith("axle 1 right at (")  # along x the right is at lower y
    y = float(problem.value.rpartition(", ")[2].split(")")[0])
    assert y == pytest.approx(4.5 - 0.7)
    assert loaded(wide)  # at y = 5 m they roll at 4.3 m
    assert loaded((WAY, near))  # one that is a line needs no more than its line


def test_a_lane_moves_the_wheels_and_not_the_path():
    """The path keeps 1 m from the edge at y = 6 m; half a track and a lane of 0.5 m do not fit."""
    wide = (CAR, f'{CAR}\ntrack_width = "1.4 m"')
    fits, falls = (
        ('speed = "20 km/h"', f'speed = "20 km/h"\nlane = "{lane}"') for lane in ("20 cm", "50 cm")
    )
    assert loaded(wide, fits)
    assert "axle 1 left at (" in told(wide, falls)["route[1].path"].value


def test_places_are_looked_at_on_the_storey_that_they_name():
    """Over the deck's hole there is a slab of the lab."""
    over = 'on = "{}"\nat = ["11 m", "3 m"]'
    assert loaded((AT, over.format("lab")))
    assert "has none there" in told((AT, over.format("deck")))["point[1].at"].rule


def test_machines_over_a_hole_are_told_foot_by_foot():
    """The second of three feet."""
    machine = (
        '[[machine]]\nname = "m"\non = "deck"\nharmonics = [["9 Hz", "9 N"]]\n'
        'feet = [["9 m", "3 m"], ["11 m", "3 m"], ["13 m", "3 m"]]\n'
    )
    found = told(text=HOUSE + machine)
    assert list(found) == ["machine[1].feet[2]"]
    assert found["machine[1].feet[2]"].rule == "must stand on a slab of 'deck'"


def test_a_plane_of_symmetry_of_a_building_halves_what_stands_on_it():
    """At y = 0 on either storey; 10 cm off it is whole, and on a storey above it too."""
    plane = '[[building.symmetry]]\naxis = "y"\nat = "0 m"\n\n[[building.column]]'
    half = HOUSE.replace("[[building.column]]", plane)
    machine = (
        '[[machine]]\nname = "m"\non = "lab"\nharmonics = [["9 Hz", "9 N"]]\nat = ["9 m", "{}"]\n'
    )
    assert "half beyond it" in told(text=half + machine.format("0 m"))["machine[1].at"].rule
    assert study_from_text(half + machine.format("10 cm")).sources
    assert study_from_text(HOUSE + machine.format("0 m")).sources


def test_wheels_that_leave_a_plain_floor_are_named():
    """6 m of floor: a forklift with wheels 1.2 m apart drives 0.5 m from the edge."""
    text = GOOD.replace('"container_truck_40ft"', '"car_bmw_320i"\ntrack_width = "1.2 m"')
    near = text.replace('["0 m", "3 m"], ["12 m", "3 m"]', '["0 m", "5.5 m"], ["12 m", "5.5 m"]')
    value = told(text=near)["route[1].path"].value
    assert value.startswith("axle 1 left at (")
    assert float(value.rpartition(", ")[2].split(")")[0]) == pytest.approx(5.5 + 0.6)
    exact = near.replace("5.5 m", "5.4 m")
    assert np.isclose(study_from_text(exact).drives["main"].route.points[0, 1], 5.4)
