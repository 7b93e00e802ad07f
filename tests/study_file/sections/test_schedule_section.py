"""[[schedule]]: streams of a day, in the units and words of the file; times of the day."""

import numpy as np
import pytest

from studies import GOOD
from trundle.errors import InputError, StudyError
from trundle.study_file import study_from_text
from trundle.study_file.timetables import read_timetable, seconds_of
from trundle.traffic import Poisson, Times

DAY = '[[schedule]]\nname = "day"\n'
SIDE = """
[[route]]
name = "side"
vehicle = "truck"
path = [["0 m", "2 m"], ["12 m", "2 m"]]
speed = "15 km/h"
"""


def schedules(*tables, folder="."):
    return study_from_text(GOOD + SIDE + "".join(tables), folder=folder).schedules


def streams(keys, folder="."):
    return schedules(f"{DAY}{keys}\n", folder=folder)["day"].streams


def told(*tables, folder="."):
    with pytest.raises(StudyError) as caught:
        schedules(*tables, folder=folder)
    return {p.place: p for p in caught.value.problems}


def test_times_of_a_day_are_seconds_since_midnight_in_their_order():
    """7:30 is 27000 s, half past noon 45000 s, 0.5 h 1800 s; sorted as a day goes."""
    (stream,) = streams('route = "main"\ntimes = ["12:30", "7:30", "0.5 h", "0:00"]')
    np.testing.assert_allclose(stream.times, [0.0, 1800.0, 27000.0, 45000.0])
    assert stream.route == "main"


@pytest.mark.parametrize(
    ("keys", "first", "last", "n"),
    [
        ('headway = "1 h"', 0.0, 23 * 3600.0, 24),
        ('headway = "15 min"\nfrom = "6:00"\nto = "7:00"', 21600.0, 24300.0, 4),
        ('headway = "15 min"\nfrom = "6:00"\nto = "7:01"', 21600.0, 25200.0, 5),
        ('headway = "6 h"\nfrom = "12:00"', 43200.0, 64800.0, 2),
        ('headway = "7 h"\nto = "12:00"', 0.0, 25200.0, 2),
    ],
)
def test_a_headway_departs_at_its_start_and_not_at_its_end(keys, first, last, n):
    """Counted by hand: from the first departure on, until none departs any more."""
    (stream,) = streams(f'route = "main"\n{keys}')
    assert isinstance(stream, Times)
    assert (stream.times[0], stream.times[-1], len(stream.times)) == (first, last, n)


def test_vehicles_an_hour_are_as_many_as_their_hours():
    """6 an hour from 8:00 to 9:30 are 9: six in the first hour, three in the second."""
    (stream,) = streams('route = "main"\nper_hour = 6\nfrom = "8:00"\nto = "9:30"')
    assert isinstance(stream, Poisson)
    hours = stream.expected()["main"]
    assert hours[8:10] == pytest.approx([6.0, 3.0])
    assert hours.sum() == pytest.approx(9.0)


def test_counts_by_hour_begin_at_midnight_and_a_mix_shares_them():
    """The k-th number is the hour from k: 4 at 6 h, shared 3 to 1."""
    counts = [0.0] * 24
    counts[6] = 4.0
    (stream,) = streams(f"mix = {{ main = 3.0, side = 1.0 }}\nby_hour = {counts}")
    main, side = stream.expected()["main"], stream.expected()["side"]
    assert (main[6], side[6]) == (pytest.approx(3.0), pytest.approx(1.0))
    assert main.sum() + side.sum() == pytest.approx(4.0)


def test_sections_of_one_name_are_one_day_and_of_two_names_two():
    """Morning and evening of one day; another day beside it."""
    found = schedules(
        f'{DAY}route = "main"\ntimes = ["7:00"]\n',
        '[[schedule]]\nname = "Sonntag, <ruhig>"\nroute = "main"\ntimes = ["10:00"]\n',
        f'{DAY}route = "side"\nheadway = "1 h"\nfrom = "18:00"\nto = "20:00"\n',
    )
    assert list(found) == ["day", "Sonntag, <ruhig>"]
    assert [s.route for s in found["day"].streams] == ["main", "side"]
    assert found["day"].per_day == 3.0


@pytest.mark.parametrize(
    ("keys", "place", "words"),
    [
        ('route = "main"', "schedule[1]", "got none"),
        ('route = "main"\nheadway = "1 h"\nper_hour = 2', "schedule[1]", "got headway and per_hour"),
        ('headway = "1 h"', "schedule[1]", "name the route, or a mix"),
        ('route = "main"\nmix = { main = 1 }\nper_hour = 2', "schedule[1]", "name the route, or a mix"),
        ('mix = { main = 1 }\nheadway = "1 h"', "schedule[1]", "a mix is drawn at random"),
        ('mix = { main = 1 }\ntimes = ["8:00"]', "schedule[1]", "a mix is drawn at random"),
        ('route = "main"\ntimes = ["8:00"]\nfrom = "7:00"', "schedule[1]", "times needs none"),
        ('route = "main"\nper_hour = 1\nfrom = "22:00"\nto = "6:00"', "schedule[1]", "two parts"),
        ('route = "main"\nper_hour = 1\nfrom = "8:00"\nto = "8:00"', "schedule[1]", "to must come after"),
        ('route = "main"\ntimes = []', "schedule[1].times", "at least 1"),
        ('route = "main"\ntimes = ["8:00", "25:00"]', "schedule[1].times[2]", "between 0:00 and 24:00"),
        ('route = "main"\nper_hour = 0', "schedule[1].per_hour", "greater than 0"),
        ('route = "main"\nper_hour = "6 1/h"', "schedule[1].per_hour", "must be a number"),
        ('mix = { main = 0 }\nper_hour = 2', "schedule[1].mix.main", "greater than 0"),
        ('mix = { man = 1 }\nper_hour = 2', "schedule[1].mix.man", "name of a route"),
        ('mix = {}\nper_hour = 2', "schedule[1].mix", "at least 1"),
        ('route = "main"\nheadway = "0 s"', "schedule[1].headway", "greater than 0"),
        ('route = "main"\nheadway = "0.1 s"', "schedule[1]", "lengthen the headway"),
        ('route = "main"\ntimes = ["24:00"]', "schedule[1]", "within a day"),
    ],
)  # fmt: skip
def test_a_day_that_cannot_be_is_told(keys, place, words):
    """Each rule at its key; a stream that is dropped would be a quieter day."""
    found = told(f"{DAY}{keys}\n")
    assert words in found[place].rule


def test_hours_are_24():
    """23 would shift nothing and miss the last; which number is missing nobody knows."""
    for n, words in ((23, "at least 24"), (25, "at most 24")):
        problem = told(f'{DAY}route = "main"\nby_hour = {[1.0] * n}\n')["schedule[1].by_hour"]
        assert words in problem.rule


@pytest.mark.parametrize("value", ["nan", "inf", "-1.0", "10001.0", '"2"', "true"])
def test_a_count_is_a_number_of_vehicles(value):
    """At most 10 000 an hour; the place is that of the hour."""
    counts = ", ".join(["1.0"] * 7 + [value] + ["1.0"] * 16)
    assert list(told(f'{DAY}route = "main"\nby_hour = [{counts}]\n')) == ["schedule[1].by_hour[8]"]


def test_streams_of_a_timetable_are_those_of_its_rows(tmp_path):
    """Written as a table with other headings, a mark of its encoding, odd names and empty lines."""
    rows = '\ufeff#\r\nVehicle;Departure\r\nmain;6:00\r\n\r\n"side";5:59:30.5\r\nmain;0:00\r\n'
    (tmp_path / "Fahrplan März.csv").write_bytes(rows.encode())
    found = streams('timetable = "Fahrplan März.csv"', tmp_path)
    times = {s.route: s.times.tolist() for s in found}
    assert times == {"main": [0.0, 21600.0], "side": [21570.5]}


@pytest.mark.parametrize(("mark", "name"), [(",", "a;b"), (";", "a, b"), ("\t", "a, b; c")])
def test_columns_are_parted_by_one_mark_and_names_may_hold_the_others(tmp_path, mark, name):
    """Quotes hold a name together that has the mark itself."""
    path = tmp_path / "t.csv"
    path.write_text(f'time{mark}route\n8:00{mark}{name}\n8:01{mark}"x{mark}y"\n')
    assert read_timetable(path) == {name: [28800.0], f"x{mark}y": [28860.0]}


def test_a_timetable_is_a_file_of_a_few_megabytes(tmp_path):
    """A folder, one beyond 5 MB, one in Latin-1: each is told by its name."""
    (tmp_path / "folder.csv").mkdir()
    with (tmp_path / "long.csv").open("wb") as file:
        file.truncate(5_000_001)
    (tmp_path / "latin.csv").write_bytes("time,route\n8:00,Süd\n".encode("latin-1"))
    for name, words in (
        ("folder", "is a folder"), ("long", "at most 5 MB"), ("latin", "not UTF-8"), ("gone", "no such"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=f"{name}.csv: .*{words}"):
            read_timetable(tmp_path / f"{name}.csv")


def test_a_timetable_leaves_route_mix_and_hours_out(tmp_path):
    """It says all three itself."""
    (tmp_path / "t.csv").write_text("time,route\n8:00,main\n")
    for more in ('route = "main"', "mix = { main = 1 }", 'from = "7:00"', 'to = "9:00"'):
        assert "schedule[1]" in told(f'{DAY}timetable = "t.csv"\n{more}\n', folder=tmp_path)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("0:00:00.000001", 1e-6),
        ("23:59:59.999999", 86399.999999),
        (" 7:05 ", 25500.0),
        ("90 min", 5400.0),
    ],
)
def test_a_time_is_read_to_the_microsecond(text, seconds):
    """Sixty minutes of sixty seconds."""
    assert seconds_of(text) == pytest.approx(seconds, abs=1e-9)


@pytest.mark.parametrize(
    "text", ["7.30", "7:5", "007:00", "7:00:5", "7:00 Uhr", "24:00:01", "", "7:00:00,5"]
)
def test_a_time_that_reads_two_ways_is_refused(text):
    """7.30 is half past seven or a number without a unit; 7:5 is five past or fifty past."""
    with pytest.raises(InputError, match="time of the day"):
        seconds_of(text)


def test_a_day_of_who_has_a_mistake_is_no_second_mistake():
    """The pace is wrong; the walker's name is in the file."""
    walker = '[[walker]]\nname = "guard"\nguide = "p354"\npace = "2 m"\nat = ["3 m", "1 m"]\n'
    assert list(told(walker, f'{DAY}route = "guard"\nper_hour = 2.0\n')) == ["walker[1].pace"]


@pytest.mark.parametrize(
    ("name", "words"), [("nobody", "name of a route"), ("fan", "never stops is no event")]
)
def test_who_stands_in_a_timetable_alone_is_told_where_it_is_named(tmp_path, name, words):
    """A slip in a name, and a fan that runs for ever: in the file as in the study."""
    fan = '[[machine]]\nname = "fan"\nat = ["9 m", "4 m"]\n'
    fan += 'rotor = { speed = "25 Hz", unbalance = "5 g mm" }\n'
    (tmp_path / "t.csv").write_text(f"time,route\n8:00,main\n8:10,{name}\n")
    day = f'{DAY}route = "main"\nper_hour = 2.0\n{DAY}timetable = "t.csv"\n'
    found = told(fan, day, folder=tmp_path)
    assert list(found) == ["schedule[2].timetable"]
    assert words in found["schedule[2].timetable"].rule


def test_lines_of_a_timetable_are_those_of_editors(tmp_path):
    """U+2028 within a name ends no line; LF, CR LF and CR do."""
    path = tmp_path / "t.csv"
    path.write_bytes("time,route\r\n8:00,a\u2028b\r8:05,c\nnoon,d\n".encode())
    with pytest.raises(InputError, match=r"t\.csv, line 4: 'noon'"):
        read_timetable(path)
    path.write_bytes(path.read_bytes().replace(b"noon,d\n", b""))
    assert read_timetable(path) == {"a\u2028b": [28800.0], "c": [29100.0]}
