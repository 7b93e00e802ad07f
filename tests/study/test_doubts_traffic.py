"""Two vehicles at one place are doubted, in traffic and in schedules; followers at a distance not."""

from dataclasses import replace

import pytest

from studies import GOOD
from trundle.study.doubts_traffic import traffic_doubts
from trundle.study_file import study_from_text

OTHER = """
[[route]]
name = "back"
vehicle = "truck"
path = [["12 m", "4 m"], ["0 m", "4 m"]]
speed = "30 km/h"
"""


def doubts(more):
    text = GOOD.replace('duration = "4 s"\n', "").replace("[[road]]", OTHER + "\n[[road]]", 1)
    return study_from_text(text + more), list(traffic_doubts(study_from_text(text + more)))


def traffic(routes, departures):
    times = ", ".join(f'"{t:.6f} s"' for t in departures)
    names = ", ".join(f'"{name}"' for name in routes)
    return f'\n[[traffic]]\nname = "<meeting>"\nroutes = [{names}]\ndepartures = [{times}]\n'


def own_length(route):
    """Seconds that the truck needs for its own length, at 15 or 30 km/h."""
    vehicle = study_from_text(GOOD).drives["main"].vehicle
    return vehicle.length / ({"main": 15.0, "back": 30.0}[route] / 3.6)


@pytest.mark.parametrize("route", ["main", "back"])
@pytest.mark.parametrize(("share", "told"), [(0.01, True), (0.9, True), (1.01, False)])
def test_a_follower_needs_the_time_of_one_length(route, share, told):
    """Closed form: length over speed, for each route by its own speed."""
    needed = own_length(route)
    _, found = doubts(traffic([route, route], [0.0, share * needed]))
    assert bool(found) == told
    if told:
        (doubt,) = found
        assert doubt.subject == "traffic <meeting>"
        assert f"on {route!r} one vehicle departs {share * needed:.3g} s after" in doubt.message
        assert f"needs {needed:.3g} s to drive its own length" in doubt.message


def test_routes_of_their_own_do_not_get_into_each_others_way():
    """One truck a route at the same instant; whether the routes cross is another question."""
    assert doubts(traffic(["main", "back"], [0.0, 0.0]))[1] == []


def test_the_order_in_which_departures_are_written_does_not_matter():
    """20 s, 0 s, 20.1 s: the first and the third are too close, on main alone."""
    (doubt,) = doubts(traffic(["main", "main", "back", "main"], [20.0, 0.0, 0.0, 20.1]))[1]
    assert "on 'main' one vehicle departs 0.1 s after another" in doubt.message


def test_times_of_a_day_are_looked_through_by_route():
    """8:00:00 and 8:00:01 on one route, 8:00:00 on the other: one doubt, of the day."""
    day = (
        '\n[[schedule]]\nname = "day"\nroute = "main"\ntimes = ["8:00:01", "8:00:00", "9:00"]\n'
        '\n[[schedule]]\nname = "day"\nroute = "back"\ntimes = ["8:00:00"]\n'
    )
    study, found = doubts(day)
    assert list(study.schedules) == ["day"]
    (doubt,) = found
    assert doubt.subject == "schedule day"
    assert "on 'main' one vehicle departs 1 s after another" in doubt.message


def test_parts_of_one_day_come_together():
    """Half past eight twice, once in each of two sections of the day: they meet all the same."""
    part = '\n[[schedule]]\nname = "day"\nroute = "main"\ntimes = ["{}"]\n'
    _, found = doubts(part.format("8:30") + part.format("8:30:00"))
    assert len(found) == 1
    assert "departs 0 s after another" in found[0].message
    _, apart = doubts(part.format("8:30") + part.format("8:31"))
    assert apart == []


def test_a_case_of_one_vehicle_is_never_doubted():
    """Nobody follows; nor does a study without anyone who drives."""
    study, found = doubts("")
    assert found == []
    assert list(traffic_doubts(replace(study, cases=()))) == []
