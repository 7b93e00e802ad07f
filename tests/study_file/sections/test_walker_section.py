"""[[walker]]: paces, weights, ways and places of people, in SI; and what no one can do."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

PATH = 'path = [["0 m", "1 m"], ["12 m", "1 m"]]'
WALKER = f'\n[[walker]]\nname = "guard"\nguide = "p354"\npace = "2 Hz"\n{PATH}\n'
NO_END = GOOD.replace('duration = "4 s"\n', "")
STAYS = WALKER.replace(PATH, 'at = ["3 m", "3 m"]')


def walker(more="", base=WALKER, *changes, study=GOOD):
    for old, new in changes:
        assert base.count(old) == 1
        base = base.replace(old, new)
    return study_from_text(study + base + more).sources["guard"]


def told(text, study=GOOD):
    with pytest.raises(StudyError) as caught:
        study_from_text(study + text)
    return {p.place: p for p in caught.value.problems}


def test_a_pace_is_steps_a_second_in_any_unit():
    """120 steps a minute are two a second."""
    assert walker("", WALKER, ('"2 Hz"', '"120 1/min"')).gait.pace == pytest.approx(2.0)


def test_one_person_walks_from_time_nought_unless_told_otherwise():
    """Nobody's pace or weight scatters by itself; the phase of the first step is drawn."""
    made = walker()
    assert (made.people, made.depart, made.gait.random_phase) == (1, 0.0, True)
    assert (made.gait.pace_spread, made.gait.weight_spread, made.gait.step_scatter) == (0, 0, 0)


def test_a_group_is_so_many_people_so_far_apart_in_time():
    """Three people 1500 ms apart, from 0.1 min on; spreads in per cent."""
    made = walker(
        'people = 3\nheadway = "1500 ms"\ndepart = "0.1 min"\npace_spread = "5 %"\n'
        'mass_spread = 0.2\nstep_scatter = "1 %"\nrandom_phase = false\n',
        study=NO_END,
    )
    assert (made.people, made.headway, made.depart) == (3, 1.5, pytest.approx(6.0))
    gait = made.gait
    assert (gait.pace_spread, gait.weight_spread, gait.step_scatter) == (0.05, 0.2, 0.01)
    assert gait.random_phase is False
    # the last leaves two headways after the first
    assert made.leaves == pytest.approx(walker().leaves + 6.0 + 2 * 1.5)


@pytest.mark.parametrize(("mass", "weight"), [("80 kg", 784.8), ("0.08 t", 784.8), ("10 kg", 98.1)])
def test_a_mass_presses_with_its_weight(mass, weight):
    """Times 9.81 m/s2."""
    assert walker(f'mass = "{mass}"\n').gait.weight == pytest.approx(weight)


def test_a_speed_of_ones_own_comes_before_the_guides():
    """12 m at 3.6 km/h take 12 s."""
    assert walker('speed = "3.6 km/h"\n').lasts == pytest.approx(12.0)


def test_a_rounded_way_is_shorter_than_its_corners():
    """6 m and 4 m with a corner of radius 2 m: 2 x 2 m less, and a quarter of a circle more."""
    bent = (PATH, 'path = [["0 m", "1 m"], ["6 m", "1 m"], ["6 m", "5 m"]]')
    made = walker('radius = "200 cm"\nspeed = "1 m/s"\n', WALKER, bent)
    assert made.lasts == pytest.approx(10.0 - 4.0 + np.pi)


def test_who_stays_is_there_for_ten_seconds_unless_told_otherwise():
    """At the place that was given, x before y."""
    where = walker("", STAYS, ('["3 m", "3 m"]', '["350 cm", "2 m"]')).where
    assert (where.x, where.y, where.lasts) == (3.5, 2.0, 10.0)
    assert walker('lasts = "0.5 min"\n', STAYS).where.lasts == 30.0


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        (WALKER.replace(PATH, ""), "walker[1]", "give path or at"),
        (STAYS + 'radius = "1 m"\n', "walker[1]", "are of a path"),
        (STAYS + 'speed = "1 m/s"\n', "walker[1]", "are of a path"),
        (WALKER + 'mass = "9.9 kg"\n', "walker[1]", "people weigh 10 to 400 kg"),
        (WALKER + 'mass = "401 kg"\n', "walker[1]", "got 401 kg"),
        (WALKER + 'mass = "800 N"\n', "walker[1].mass", "not one of mass"),
        (WALKER + 'speed = "0.3 km/h"\n', "walker[1]", "got 0.0833 m/s"),
        (WALKER + 'speed = "22 km/h"\n', "walker[1]", "people walk at 0.1 to 6 m/s"),
        (WALKER + "people = 201\n", "walker[1].people", "200 or less"),
        (WALKER + 'pace_spread = "100 %"\n', "walker[1].pace_spread", "below 1"),
        (WALKER + 'depart = "-1 s"\n', "walker[1].depart", "0 or more"),
        (WALKER.replace(PATH, 'path = [["0 m", "1 m"]]'), "walker[1].path", "at least 2"),
        (WALKER.replace('["12 m"', '["12.1 m"'), "walker[1].path[2]", "must stand on the floor"),
        (STAYS.replace('"3 m"]', '"6.1 m"]'), "walker[1].at", "must stand on the floor"),
        (WALKER.replace('"guard"', '"road"'), "walker[1].name", "results have for themselves"),
    ],
)  # fmt: skip
def test_what_nobody_does_is_told_where_it_stands(text, place, words):
    """A mass in the place of a weight, a speed in km/h for m/s: each is a slip of a factor."""
    assert words in told(text)[place].rule


def test_people_of_a_building_walk_on_a_storey_and_round_its_openings():
    """The hole of the deck is 10 to 12 m by 2 to 4 m; on the lab above there is none."""
    across = 'path = [["9 m", "3 m"], ["13 m", "3 m"]]'
    at = WALKER.replace(PATH, across)
    assert told(at, BUILDING)["walker[1].on"].value == "nothing"
    found = told(at + 'on = "deck"\n', BUILDING)["walker[1].path[1]"]
    assert "over no slab from (10." in found.value
    made = study_from_text(BUILDING + at + 'on = "lab"\n').sources["guard"]
    assert made.where.on == "lab"
    stands = STAYS.replace('["3 m", "3 m"]', '["11 m", "3 m"]') + 'on = "deck"\n'
    assert told(stands, BUILDING)["walker[1].at"].rule == "must stand on a slab of 'deck'"


def test_who_stands_on_a_plane_of_symmetry_is_half_beyond_it():
    """One who walks along it is not refused, one who stays there is."""
    half = GOOD.replace("column = {", 'edges = { x_max = "symmetry" }\ncolumn = {')
    assert (
        "plane of symmetry"
        in told(STAYS.replace('["3 m", ', '["12 m", '), half)["walker[1].at"].rule
    )
    assert study_from_text(half + STAYS.replace('["3 m", ', '["11.9 m", ')).sources


def test_cases_of_people_come_behind_those_of_vehicles():
    """Vehicles, then people and machines by the order of their kinds, then traffic."""
    more = '[[traffic]]\nname = "all"\nroutes = ["guard", "main"]\nheadway = "3 s"\n'
    cases = study_from_text(GOOD + more + WALKER).cases
    assert [case.name for case in cases] == ["main", "guard", "all"]
    assert cases[-1].departs == (0.0, 3.0)


@pytest.mark.parametrize("base", [WALKER, STAYS], ids=["path", "at"])
def test_who_departs_when_the_record_has_ended_is_told(base):
    """Nothing would load the floor in 4 s of record; with no end it lasts until he has left."""
    late = base + 'depart = "4 s"\n'
    assert list(told(late)) == ["walker[1].depart"]
    assert walker('depart = "3.9 s"\n', base)
    made = study_from_text(NO_END + late)
    assert made.longest_record > made.sources["guard"].leaves
