"""Walkers, machines, schedules and departures of a study file: what they become, and mistakes."""

import numpy as np
import pytest

from studies import GOOD
from trundle.errors import InputError, StudyError
from trundle.machine import Harmonics, RunUp, Strokes, Unbalance
from trundle.simulate.sources.walker import StandsAt
from trundle.study.doubts import study_doubts
from trundle.study_file.build import study_from_text
from trundle.study_file.timetables import read_timetable, seconds_of
from trundle.traffic import Poisson, Times

WALKER = """
[[walker]]
name = "guard"
guide = "p354"
pace = "2 Hz"
path = [["0 m", "1 m"], ["12 m", "1 m"]]
"""
MACHINE = """
[[machine]]
name = "pump"
at = ["9 m", "4 m"]
rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }
"""
SCHEDULE = """
[[schedule]]
name = "day"
route = "main"
headway = "10 min"
from = "8:00"
to = "17:30"
"""
ALONE = GOOD.partition("[vehicle.truck]")[0] + GOOD[GOOD.index("[[point]]") :]


def told(text):
    with pytest.raises(StudyError) as error:
        study_from_text(text)
    return [str(problem) for problem in error.value.problems]


def test_a_walker_takes_speed_weight_and_harmonics_from_the_guide():
    """P354: 1.52 m/s at 2 steps a second, 746 N; a mass of one's own is a weight."""
    walker = study_from_text(GOOD + WALKER).sources["guard"]
    assert walker.lasts == pytest.approx(12.0 / 1.52)
    assert walker.gait.weight == 746.0
    heavy = study_from_text(GOOD + WALKER + 'mass = "100 kg"\nspeed = "1 m/s"\n').sources["guard"]
    assert (heavy.gait.weight, heavy.lasts) == (pytest.approx(981.0), pytest.approx(12.0))
    at = WALKER.replace('path = [["0 m", "1 m"], ["12 m", "1 m"]]', 'at = ["3 m", "3 m"]')
    stays = study_from_text(GOOD + at + 'lasts = "20 s"\npeople = 2\n').sources["guard"]
    assert stays.where == StandsAt(x=3.0, y=3.0, lasts=20.0)
    assert stays.leaves == pytest.approx(22.0)


def test_people_and_machines_need_no_vehicle_no_route_and_no_road():
    """A study of them alone has one road, that nobody drives on, and each is a case."""
    study = study_from_text(ALONE + WALKER + MACHINE)
    assert {case.name for case in study.cases} == {"guard", "pump"}
    assert list(study.roads) == ["no road"]
    assert not study.drives
    with_route = ALONE + WALKER + GOOD[GOOD.index("[[route]]") : GOOD.index("[[road]]")]
    assert {"vehicle", "road"} <= {one.partition(":")[0].split()[-1] for one in told(with_route)}
    assert len(told(ALONE)) == 3  # nothing shakes it at all


@pytest.mark.parametrize(
    ("how", "kind"),
    [
        ('rotor = { speed = "25 Hz", unbalance = "500 g mm" }', Unbalance),
        ('harmonics = [["25 Hz", "100 N"], ["50 Hz", "20 N"]]', Harmonics),
        ('run_up = { from = "2 Hz", to = "20 Hz", takes = "8 s", amplitude = "50 N" }', RunUp),
        ('blows = { impulse = "30 N s", contact_time = "10 ms", every = "2 s" }', Strokes),
    ],
)
def test_every_kind_of_machine(how, kind):
    """Each way to write a force gives its kind; feet and mounts too."""
    rotor = 'rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }'
    text = MACHINE.replace(rotor, how).replace(
        'at = ["9 m", "4 m"]', 'feet = [["9 m", "4 m"], ["10 m", "4 m"]]'
    )
    machine = study_from_text(
        GOOD + text + 'mounts = { frequency = "5 Hz", damping = "5 %" }\n'
    ).sources["pump"]
    assert isinstance(machine.force, kind)
    assert machine.feet.shape == (2, 2)
    assert machine.mounts.frequency == 5.0


def test_turns_a_minute_are_turns():
    """1450 rpm are 24.17 Hz, not 151.8; and 500 g mm are 5e-4 kg m."""
    machine = study_from_text(GOOD + MACHINE).sources["pump"]
    assert machine.force.frequency == pytest.approx(1450.0 / 60.0)
    assert machine.force.amplitude == pytest.approx(200.0 * 2 * np.pi * 1450 / 60 * 6.3e-3)
    rotor = 'rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }'
    text = MACHINE.replace(rotor, 'rotor = { speed = "25 Hz", unbalance = "500 g mm" }')
    assert study_from_text(GOOD + text).sources["pump"].force.mass_radius == pytest.approx(5e-4)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (WALKER.replace('"p354"', '"p345"'), "did you mean 'p354'"),
        (WALKER + 'at = ["3 m", "3 m"]\n', "give path or at"),
        (WALKER + 'lasts = "3 s"\n', "lasts is of a place"),
        (WALKER.replace('["12 m", "1 m"]', '["13 m", "1 m"]'), "must stand on the floor"),
        (WALKER.replace('"2 Hz"', '"9 Hz"'), "pace must be in"),
        (WALKER.replace('"2 Hz"', '"2 m"'), "not one of frequency"),
        (WALKER + 'mass = "80 t"\n', "people weigh"),
        (WALKER + 'speed = "100 km/h"\n', "people walk at"),
        (
            MACHINE.replace(
                'rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }',
                'harmonics = [["10 Hz", "0 N"]]',
            ),
            "greater than 0",
        ),
        (WALKER + "people = 0\n", "must be 1 or more"),
        (WALKER + 'on = "attic"\n', "no other surface"),
        (WALKER + 'pase = "2 Hz"\n', "did you mean 'pace'"),
        (MACHINE.replace('"4 m"]', '"40 m"]'), "must stand on the floor"),
        (MACHINE + 'harmonics = [["25 Hz", "1 N"]]\n', "one of rotor, harmonics"),
        (MACHINE + 'feet = [["1 m", "1 m"]]\n', "at or feet"),
        (MACHINE.replace(', mass = "200 kg"', ""), "a grade"),
        (MACHINE.replace('"1450 rpm"', '"6000 rpm"'), "shorten dt"),
        (SCHEDULE.replace('route = "main"', 'route = "mein"'), "must be the name of a route"),
        (SCHEDULE.replace('route = "main"\n', ""), "name the route, or a mix"),
        (SCHEDULE + "per_hour = 4.0\n", "one of times, headway"),
        (SCHEDULE.replace('"8:00"', '"18:00"'), "to must come after from"),
        (SCHEDULE.replace('"8:00"', '"8:61"'), "a time of the day is written as"),
        (SCHEDULE.replace('headway = "10 min"', "by_hour = [1.0, 2.0]"), "24"),
        (SCHEDULE.replace('headway = "10 min"', 'timetable = "no.csv"'), "leave route and mix out"),
        (MACHINE + SCHEDULE.replace('"main"', '"pump"'), "never stops"),
        ('[[traffic]]\nname = "t"\nroutes = ["main", "main"]\n', "its own time in departures"),
        (
            '[[traffic]]\nname = "t"\nroutes = ["main", "main"]\ndepartures = ["0 s"]\n',
            "as many departures",
        ),
        (WALKER + '[[traffic]]\nname = "t"\nroutes = ["guard", "guard"]\nheadway = "3 s"\n', "there once"),
    ],
)  # fmt: skip
def test_mistakes_are_told_with_their_place(text, words):
    """Each names its rule; nothing is run."""
    found = told(GOOD + text)
    assert any(words in one for one in found), found


def test_a_day_is_held_against_something():
    """Without criteria nothing lies above anything."""
    bare = GOOD[: GOOD.index("[criteria]")]
    assert any("held against limits" in one for one in told(bare + SCHEDULE))


def test_parts_of_a_day_are_one_schedule(tmp_path):
    """Streams of one name go together: times, headways, counts by hour, a timetable beside it."""
    (tmp_path / "trucks.csv").write_text("# as of May\nTime;Route\n08:05;main\n8:00:30;main\n")
    by_hour = ", ".join(["2.0"] * 24)
    more = f"""
[[schedule]]
name = "day"
by_hour = [{by_hour}]
mix = {{ main = 1.0 }}

[[schedule]]
name = "day"
timetable = "trucks.csv"

[[schedule]]
name = "quiet day"
route = "main"
times = ["7:00", "25200.5 s", "23:59:59"]
"""
    study = study_from_text(GOOD + SCHEDULE + more, folder=tmp_path)
    even, random, known = study.schedules["day"].streams
    assert isinstance(random, Poisson)
    assert isinstance(even, Times)
    assert len(even.times) == 57
    np.testing.assert_allclose(known.times, [28830.0, 29100.0])
    np.testing.assert_allclose(
        study.schedules["quiet day"].streams[0].times, [25200, 25200.5, 86399]
    )
    assert study.files["trucks.csv"].startswith(b"# as of May")
    assert study.schedules["day"].per_day == pytest.approx(57 + 48 + 2)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("time,route\n", "no departure"),
        ("when,route\n8:00,main\n", "one column called 'time'"),
        ("time,route\n8:00\n", "line 2: 1 cells under 2 headings"),
        ("time,route\n8:00,main\n25:00,main\n", "line 3"),
        ("time,route\nsoon,main\n", "line 2: 'soon'"),
        ("time,time,route\n8:00,8:00,main\n", "one column called 'time'"),
    ],
)
def test_timetables_that_are_none_are_refused_with_their_line(tmp_path, text, words):
    """What cannot be read is told by file and line."""
    file = tmp_path / "t.csv"
    file.write_text(text)
    with pytest.raises(Exception, match=words):
        read_timetable(file)


def test_a_timetable_of_an_unknown_route_is_a_mistake(tmp_path):
    """Routes that a file names must be the study's."""
    (tmp_path / "t.csv").write_text("time\troute\n8:00\tmain\n9:00\tother\n")
    text = GOOD + '[[schedule]]\nname = "d"\ntimetable = "t.csv"\n'
    with pytest.raises(StudyError) as error:
        study_from_text(text, folder=tmp_path)
    assert "other" in str(error.value)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("0:00", 0.0),
        ("24:00", 86400.0),
        ("8:30", 30600.0),
        ("08:30:15.5", 30615.5),
        ("2 h", 7200.0),
    ],
)
def test_times_of_the_day(text, seconds):
    """As people write them."""
    assert seconds_of(text) == pytest.approx(seconds)


@pytest.mark.parametrize("text", ["8", "8:60", "24:01", "-1:00", "8:00:61", 8.0, "8 pm", "25 h"])
def test_what_is_no_time_of_the_day(text):
    """Each is refused with the rule."""
    with pytest.raises(Exception, match="time of the day"):
        seconds_of(text)


def test_departures_make_several_passages_of_one_route():
    """The second is put off, has its own name, and meets the same road."""
    text = (
        GOOD + '[[traffic]]\nname = "t"\nroutes = ["main", "main"]\ndepartures = ["0 s", "3 s"]\n'
    )
    study = study_from_text(text)
    case = study.cases[-1]
    first, second = study.acting(case, "B", study.methods[0])
    assert (first.name, second.name) == ("main", "main (2)")
    assert second.crossing.depart == 3.0
    apart = study_from_text(text.replace('departures = ["0 s", "3 s"]', 'headway = "3 s"'))
    assert apart.cases[-1].departs == (0.0, 3.0)


@pytest.mark.parametrize(
    ("text", "told_of"),
    [
        (SCHEDULE.replace('headway = "10 min"', 'headway = "1 s"'), "schedule day"),
        (
            '[[traffic]]\nname = "t"\nroutes = ["main", "main"]\ndepartures = ["0 s", "1 s"]\n',
            "traffic t",
        ),
    ],
)  # fmt: skip
def test_two_vehicles_at_one_place_are_doubted(text, told_of):
    """A truck of some 12.5 m at 15 km/h needs 3 s for its length; a second behind is inside it."""
    found = [w for w in study_doubts(study_from_text(GOOD + text)) if w.subject == told_of]
    assert len(found) == 1
    assert "at one place" in found[0].message
    calm = study_from_text((GOOD + text).replace('"1 s"', '"20 s"').replace('duration = "4 s"', ""))
    assert not [w for w in study_doubts(calm) if w.subject == told_of]


def test_what_stands_on_a_plane_of_symmetry_is_told():
    """Half of it is beyond: neither the floor's own force nor twice it would be right."""
    half = GOOD.replace("column = {", 'edges = { y_min = "symmetry" }\ncolumn = {')
    text = MACHINE.replace('["9 m", "4 m"]', '["9 m", "0 m"]')
    assert any("plane of symmetry" in one for one in told(half + text))
    assert study_from_text(half + MACHINE).sources
    assert study_from_text(half + WALKER.replace('"1 m"]', '"0 m"]')).sources  # ways are halved


def test_people_and_machines_of_traffic_depart_when_they_are_told():
    """Later than each begins by itself: 2 s more of a walker, 3 s more of a pump."""
    text = WALKER + 'depart = "1 s"\n' + MACHINE
    text += '[[traffic]]\nname = "t"\nroutes = ["main", "guard", "pump"]\n'
    study = study_from_text(GOOD + text + 'departures = ["0 s", "2 s", "3 s"]\n')
    _, guard, pump = study.acting(study.cases[-1], "B", study.methods[0])
    assert (guard.depart, pump.starts) == (3.0, 3.0)
    alone = study.acting(study.cases[1], "B", study.methods[0])[0]
    assert {getattr(alone, "depart", 0.0), getattr(alone, "starts", 0.0)} <= {0.0, 1.0}


@pytest.mark.parametrize(
    "text", [WALKER + WALKER, MACHINE + MACHINE, WALKER + MACHINE.replace("pump", "guard")]
)
def test_names_of_sources_must_differ(text):
    """None is dropped in silence."""
    assert any("names must differ" in one for one in told(GOOD + text))


def test_blows_that_no_step_tells_apart_are_refused():
    """Every microsecond, by steps of 5 ms: told before memory is asked for."""
    rotor = 'rotor = { speed = "1450 rpm", grade = "6.3 mm/s", mass = "200 kg" }'
    blows = 'blows = { impulse = "3 N s", contact_time = "0.5 us", every = "1 us" }'
    assert any("shorten dt" in one for one in told(GOOD + MACHINE.replace(rotor, blows)))


@pytest.mark.parametrize("row", ["8:00," + 200_000 * "x", '8:00,"main', '8:00,"ma"in'])
def test_rows_that_no_table_has_are_refused(tmp_path, row):
    """A field without end, a quote that is not closed: with the line, and no traceback."""
    (tmp_path / "t.csv").write_text(f"time,route\n{row}\n8:10,main\n")
    with pytest.raises(InputError, match="line 2"):
        read_timetable(tmp_path / "t.csv")
