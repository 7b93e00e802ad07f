"""[[route]] and [[traffic]]: where, how fast and when; names, and what no vehicle can do."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

SPEED = 'speed = "15 km/h"'
PATH = 'path = [["0 m", "3 m"], ["12 m", "3 m"]]'
CAR = ('"container_truck_40ft"', '"car_bmw_320i"')
SECOND = """
[[route]]
name = "side"
vehicle = "truck"
path = [["0 m", "2 m"], ["12 m", "2 m"]]
speed = "15 km/h"
"""


def loaded(*changes, more="", text=GOOD):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return study_from_text(text + more)


def told(*changes, more="", text=GOOD):
    with pytest.raises(StudyError) as caught:
        loaded(*changes, more=more, text=text)
    return {p.place: p for p in caught.value.problems}


def traffic(keys, name="t"):
    return f'\n[[traffic]]\nname = "{name}"\n{keys}\n'


def test_a_path_in_other_units_runs_from_its_first_place_to_its_last():
    """1200 cm along x at y = 3000 mm; turned round it begins at the other end."""
    path = 'path = [["1200 cm", "3000 mm"], ["0 m", "3 m"]]'
    route = loaded((PATH, path)).drives["main"].route
    np.testing.assert_allclose(route.points, [[12.0, 3.0], [0.0, 3.0]])
    np.testing.assert_allclose(route.locate([2.0])[0], [[10.0, 3.0]])


@pytest.mark.parametrize("speed", ["15 km/h", "4.1666666667 m/s", "250 m/min", "9.32056788 mph"])
def test_a_speed_in_other_units_is_the_same_speed(speed):
    """15 / 3.6 m/s; 250 / 60 m/s; a mile of 1609.344 m in 3600 s."""
    law = loaded((SPEED, f'speed = "{speed}"')).drives["main"].route.law
    assert law.fastest == pytest.approx(15.0 / 3.6, rel=1e-8)


def test_speeds_over_stations_are_pairs_of_length_and_speed():
    """From 18 km/h to 9 km/h over 12 m, evenly slowed: 12 m at a mean of 3.75 m/s."""
    speeds = 'speeds = [["0 m", "18 km/h"], ["1200 cm", "2.5 m/s"]]'
    law = loaded((SPEED, speeds)).drives["main"].route.law
    assert law.time_to(12.0) == pytest.approx(12.0 / 3.75)
    assert law.fastest == pytest.approx(5.0)


def test_a_run_in_lane_and_radius_are_taken_where_they_are_given():
    """Nothing of the three unless asked for: a run-in of the program's own is None."""
    plain = loaded().drives["main"]
    assert (plain.run_in, plain.route.lane, plain.route.radius) == (None, 0.0, 0.0)
    assert plain.route.steering == "path"
    drive = loaded((SPEED, f'{SPEED}\nrun_in = "300 cm"\nlane = "-25 cm"'), CAR).drives["main"]
    assert (drive.run_in, drive.route.lane) == (3.0, -0.25)


def test_who_rounds_corners_is_pulled_and_who_backs_up_is_not():
    """What is behind the front axle cuts corners; pushed backwards nothing follows."""
    bent = (PATH, 'path = [["0 m", "3 m"], ["6 m", "3 m"], ["6 m", "6 m"]]')
    for more, steering in (("", "tractrix"), ("\nreverse = true", "path")):
        route = loaded(bent, (SPEED, f'{SPEED}\nradius = "2 m"{more}'), CAR).drives["main"].route
        assert route.steering == steering
    said = loaded(bent, (SPEED, f'{SPEED}\nradius = "2 m"\nsteering = "path"'), CAR)
    assert said.drives["main"].route.steering == "path"


@pytest.mark.parametrize(
    ("path", "place"),
    [
        ('[["-1 mm", "3 m"], ["12 m", "3 m"]]', "route[1].path[1]"),
        ('[["0 m", "3 m"], ["12 m", "7 m"]]', "route[1].path[2]"),
        ('[["0 m", "3 m"], ["6 m", "-1 m"], ["12 m", "3 m"]]', "route[1].path[2]"),
    ],
)
def test_the_corner_that_leaves_the_floor_is_named(path, place):
    """The floor is 12 m by 6 m; corners are counted from 1."""
    found = told((PATH, f"path = {path}"))
    assert found[place].rule.endswith("the floor covers x 0 to 12 m and y 0 to 6 m")


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ((SPEED, f'{SPEED}\nspeeds = [["0 m", "1 m/s"], ["1 m", "1 m/s"]]'), "speed and speeds"),
        ((SPEED, f'{SPEED}\nwaits = ["1 s"]'), "waits are of stops"),
        ((PATH, ""), "a route has a path"),
        ((PATH, f'{PATH}\ndrawn = "route"'), "a route has a path"),
        ((SPEED, f'{SPEED}\non = ["a", "b"]'), "has 1 legs"),
    ],
)
def test_what_a_route_says_twice_or_not_at_all_is_told_of_the_route(change, rule):
    """Of two speeds neither is taken."""
    assert rule in told(change)["route[1]"].rule


@pytest.mark.parametrize(
    ("speeds", "place"),
    [
        ('speeds = [["0 m", "1 m/s"]]', "route[1].speeds"),
        ('speeds = [["0 m", "1 m/s"], ["-1 m", "1 m/s"]]', "route[1].speeds[2][1]"),
        ('speeds = [["5 m", "1 m/s"], ["0 m", "1 m/s"]]', "route[1].speeds"),
        ('speeds = [["0 m", "1 m/s"], ["5 m", "-1 m/s"]]', "route[1].speeds[2][2]"),
        (
            'speeds_over_time = [["0 s", "1 m/s"], ["1 m", "1 m/s"]]',
            "route[1].speeds_over_time[2][1]",
        ),
        ('speed = "600 km/h"', "route[1].speed"),
    ],
)
def test_a_wrong_number_among_speeds_is_found_by_its_row_and_column(speeds, place):
    """A speed below 0 would drive backwards; stations rise."""
    assert place in told((SPEED, speeds))


def test_all_vehicles_that_are_not_there_are_told_with_those_that_are():
    """By name, in the order of the alphabet; the route is told once."""
    more = '[vehicle."Bus 7"]\nkind = "city_bus_2_axle"\n'
    found = told(('vehicle = "truck"', 'vehicle = "Truck"'), more=more)
    assert list(found) == ["route[1].vehicle"]
    assert found["route[1].vehicle"].remedy == "there are: Bus 7, truck"


def test_every_route_is_a_case_and_then_all_traffic():
    """In the order of the file; each alone departs at 0."""
    cases = loaded(more=SECOND + traffic('routes = ["side", "main"]')).cases
    assert [(c.name, c.routes, c.departs) for c in cases] == [
        ("main", ("main",), (0.0,)),
        ("side", ("side",), (0.0,)),
        ("t", ("side", "main"), (0.0, 0.0)),
    ]


def test_departures_and_headways_are_seconds_in_the_order_of_the_routes():
    """0.1 min are 6 s; every 2500 ms the next one."""
    three, no_end = 'routes = ["main", "side", "main"]\n', ('duration = "4 s"\n', "")
    by_time, by_headway = (
        loaded(no_end, more=SECOND + traffic(three + keys)).cases[-1].departs
        for keys in ('departures = ["0.1 min", "0 s", "0 s"]', 'headway = "2500 ms"')
    )
    assert by_time == pytest.approx((6.0, 0.0, 0.0))
    assert by_headway == pytest.approx((0.0, 2.5, 5.0))


@pytest.mark.parametrize(
    ("keys", "place", "words"),
    [
        ('routes = ["main"]', "traffic[1].routes", "must hold at least 2"),
        ('routes = ["main", "Main"]', "traffic[1].routes[2]", "name of a route"),
        ('routes = ["main", "main"]', "traffic[1].routes", "one vehicle at a time"),
        ('routes = ["main", "side"]\nheadway = "0 s"', "traffic[1].headway", "greater than 0"),
        ('routes = ["main", "side"]\ndepartures = ["0 s"]', "traffic[1]", "as many departures; got 1"),
        ('routes = ["main", "side"]\ndepartures = ["0 s", "-1 s"]', "traffic[1].departures[2]", "0 or more"),
        ('routes = ["main", "side"]\ndepartures = ["0 s", "1 s"]\nheadway = "1 s"', "traffic[1]", "or a headway"),
    ],
)  # fmt: skip
def test_traffic_that_cannot_be_is_told(keys, place, words):
    """Who is left out, comes at no time, or is in one place twice."""
    assert words in told(more=SECOND + traffic(keys))[place].rule


@pytest.mark.parametrize(
    ("keys", "place"),
    [
        ('departures = ["0 s", "4 s"]', "traffic[1].departures[2]"),
        ('headway = "4 s"', "traffic[1].headway"),
    ],
)
def test_traffic_that_departs_when_the_record_has_ended_is_told(keys, place):
    """Of 4 s of record the second would be in none; at 3.9 s it is."""
    keys = 'routes = ["main", "side"]\n' + keys
    assert list(told(more=SECOND + traffic(keys))) == [place]
    assert loaded(more=SECOND + traffic(keys.replace('"4 s"', '"3.9 s"')))


def test_a_vehicle_that_waits_before_the_floor_until_the_record_has_ended_is_told():
    """Four seconds of record, and it drives off after 4 s or 3.9 s: then its front axle is there.

    One that stands on the floor at first loads it all the time.
    """
    waits = 'speeds_over_time = [["0 s", "0 km/h"], ["{} s", "0 km/h"], ["9 s", "15 km/h"]]'
    speed, car = 'speed = "15 km/h"', ('"container_truck_40ft"', '"car_bmw_320i"')
    found = told((speed, waits.format(4.0)), car)
    assert list(found) == ["route[1].speeds_over_time"]
    assert loaded((speed, waits.format(3.9)), car)
    standing = ('dt = "5 ms"', 'dt = "5 ms"\nentry = "static"')
    assert loaded((speed, waits.format(4.0)), car, standing)


def test_who_begins_late_by_himself_departs_later_still():
    """2.5 s of his own and 2 s of the traffic's are 4.5 s, of a record of 4 s."""
    walker = '[[walker]]\nname = "guard"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'
    walker += 'depart = "2.5 s"\n'
    keys = 'routes = ["main", "guard"]\ndepartures = ["0 s", "{} s"]'
    found = told(more=walker + traffic(keys.format(2)))
    assert list(found) == ["traffic[1].departures[2]"]
    assert found["traffic[1].departures[2]"].value == "a beginning at 4.5 s"
    assert loaded(more=walker + traffic(keys.format(1)))


def test_traffic_of_who_has_a_mistake_is_no_second_mistake():
    """The pace is wrong; the walker's name is in the file."""
    walker = '[[walker]]\nname = "guard"\nguide = "p354"\npace = "2 m"\nat = ["3 m", "1 m"]\n'
    assert list(told(more=walker + traffic('routes = ["main", "guard"]'))) == ["walker[1].pace"]


def test_names_of_routes_and_traffic_differ():
    """Results of both are cases, found by their names."""
    both = told(more=traffic('routes = ["main", "side"]', name="side") + SECOND)
    assert both["traffic[1].name"].value == "'side' 2 times"
    assert "route[3].name" in told(more=SECOND + SECOND)


@pytest.mark.parametrize("name", ["Süd, 1. OG", "<a> & b", "main (2) x"])
def test_odd_names_of_routes_name_cases_as_they_are(name):
    """Commas, umlauts and signs of HTML."""
    study = loaded(('name = "main"', f'name = "{name}"'))
    assert [case.name for case in study.cases] == [name]
    assert list(study.drives) == [name]


def test_a_route_along_a_plane_of_symmetry_loads_the_floor_and_one_along_a_held_edge_does_not():
    """At a plane of symmetry the floor moves; on a clamped edge it does not, and all would pass."""
    storey = 'storey_below = "4 m"'
    along = (PATH, 'path = [["0 m", "0 m"], ["12 m", "0 m"]]')
    assert loaded(along, (storey, f'{storey}\nedges = {{ y_min = "symmetry" }}'))
    found = told(along, (storey, f'{storey}\nedges = {{ y_min = "clamped" }}'))
    assert found["route[1].path"].value == "a way along y_min, which is clamped"


def test_a_way_may_lead_over_two_surfaces_and_names_one_for_each_leg():
    """Three places are two legs; a storey that is not there is told."""
    path = 'path = [["0 m", "5 m"], ["16 m", "5 m"]]'
    bent = 'path = [["0 m", "5 m"], ["8 m", "5 m"], ["16 m", "5 m"]]'
    same = BUILDING.replace('on = "deck"\npath', 'on = ["deck", "deck"]\npath').replace(path, bent)
    assert study_from_text(same).drives["aisle"].route.on == "deck"
    wrong = same.replace('["deck", "deck"]', '["deck", "dock"]')
    with pytest.raises(StudyError) as caught:
        study_from_text(wrong)
    assert "route[1].on" in [p.place for p in caught.value.problems]
