"""Title, seed, runs and duration, and studies that would not fit in memory or in a lifetime."""

import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

NO_END = GOOD.replace('duration = "4 s"\n', "")


def changed(*changes, text=GOOD):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def told(*changes, text=GOOD):
    with pytest.raises(StudyError) as caught:
        study_from_text(changed(*changes, text=text))
    return {p.place: p for p in caught.value.problems}


@pytest.mark.parametrize("title", ['Gebäude 7, Halle <3> & \\"Süd\\"', "x" * 200])
def test_a_title_is_any_one_line(title):
    """It is printed, never a path: signs that HTML and CSV mind are kept as they are."""
    study = study_from_text(changed(('"Small"', f'"{title}"')))
    assert study.title == title.replace("\\", "")


@pytest.mark.parametrize("title", ["x" * 201, "a\\nb", " a", "\\u0000", "\\u202e"])
def test_titles_that_are_no_line_are_refused(title):
    """Longer than 200, of two lines, with a space before it, or with signs that turn text round."""
    assert list(told(('"Small"', f'"{title}"'))) == ["title"]


@pytest.mark.parametrize(
    ("seed", "fine"), [(0, True), (2**63 - 1, True), (2**63, False), (-1, False)]
)
def test_a_seed_is_a_whole_number_that_every_file_format_holds(seed, fine):
    """Signed 64 bits of NetCDF end at 2^63 - 1."""
    change = ("seed = 1", f"seed = {seed}")
    if fine:
        assert study_from_text(changed(change)).seed == seed
    else:
        assert list(told(change)) == ["seed"]


@pytest.mark.parametrize(
    ("text", "seconds"), [("0.1 min", 6.0), ("6000 ms", 6.0), ("1e-1 h", 360.0)]
)
def test_a_duration_in_another_unit_is_in_seconds(text, seconds):
    """60 s a minute, 3600 s an hour."""
    assert study_from_text(changed(('"4 s"', f'"{text}"'))).duration == pytest.approx(seconds)


def test_without_a_duration_each_record_lasts_until_its_vehicle_has_left():
    """12 m of floor and the truck's own length at 15 km/h take 5.9 s; nothing cuts that off."""
    study = study_from_text(NO_END)
    assert study.duration is None
    vehicle = study.drives["main"].vehicle
    leaves = (12.0 + vehicle.length) / (15.0 / 3.6)
    assert study.longest_record > leaves


@pytest.mark.parametrize(("seconds", "fine"), [("4700 s", True), ("5002 s", False)])
def test_a_record_of_more_than_a_million_steps_is_refused(seconds, fine):
    """At 5 ms a million steps are 5000 s, the run-in before included: 0 m of it here."""
    changes = (
        ('"4 s"', f'"{seconds}"'),
        ('speed = "15 km/h"', 'speed = "15 km/h"\nrun_in = "0 m"'),
    )
    # a point and few contacts: what is held at once fits
    text = changed(*changes, ('kind = "container_truck_40ft"', 'kind = "van_vw_t2"'))
    if fine:
        assert study_from_text(text).duration == 4700.0
    else:
        with pytest.raises(StudyError) as caught:
            study_from_text(text)
        (problem,) = caught.value.problems
        assert "the limit is 1000000" in problem.rule


def test_steps_of_a_run_in_count():
    """4900 s of record and 500 m at 1 km/h before it, 1800 s: more than a million steps of 5 ms."""
    changes = (('"4 s"', '"4900 s"'), ('speed = "15 km/h"', 'speed = "1 km/h"\nrun_in = "500 m"'))
    rule = told(*changes)["duration"].rule
    assert "run-in included" in rule
    steps = float(rule.partition("would take ")[2].partition(" steps")[0])
    assert steps == pytest.approx((4900.0 + 1800.0) / 0.005, rel=0.01)


def test_a_vehicle_that_takes_too_long_is_told_without_a_duration_too():
    """12 m and two lengths of a truck at 1 m/h: 12 hours and more, some 7 million steps."""
    problem = told(('"15 km/h"', '"0.001 km/h"'), text=NO_END)["route[1]"]
    length = study_from_text(GOOD).drives["main"].vehicle.length
    time = (12.0 + 2.0 * length) / (0.001 / 3.6) + 5.0
    assert float(problem.value.removesuffix(" s")) == pytest.approx(time, rel=1e-5)


@pytest.mark.parametrize(
    ("more", "place", "seconds"),
    [
        ('[[walker]]\nname = "w"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'
         'lasts = "9 d"\n', "walker[1]", 9 * 86400.0),
        ('[[walker]]\nname = "w"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'
         'people = 3\nheadway = "3600 s"\nlasts = "10 s"\n', "walker[1]", 7210.0),
        ('[[machine]]\nname = "m"\nat = ["9 m", "4 m"]\nstarts = "900000 s"\n'
         'rotor = { speed = "25 Hz", unbalance = "5 g mm" }\n', "machine[1]", 900010.0),
        ('[[traffic]]\nname = "t"\nroutes = ["main", "main"]\n'
         'departures = ["0 s", "900000 s"]\n', "traffic[1]", None),
    ],
)  # fmt: skip
def test_whoever_makes_a_record_too_long_is_told(more, place, seconds):
    """5 ms and a million steps are 5000 s; 5 s of rest come behind the last who leaves."""
    problem = told(text=f"{NO_END}\n{more}")[place]
    if seconds is None:  # as long as the passage itself, which stands behind the departure
        truck = study_from_text(GOOD).drives["main"].vehicle.length
        seconds = 900000.0 + (12.0 + 2.0 * truck) / (15.0 / 3.6)
    assert float(problem.value.removesuffix(" s")) == pytest.approx(seconds + 5.0, rel=1e-5)
    assert "the limit is 1000000" in problem.rule


def test_a_duration_ends_records_however_long_somebody_stays():
    """Nine days of pacing, of which 4 s are computed."""
    stays = '\n[[walker]]\nname = "w"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'
    assert study_from_text(GOOD + stays + 'lasts = "9 d"\n').longest_record == 4.0


def test_a_vehicle_that_comes_to_rest_takes_no_longer_than_that():
    """It stands after 9 m for ever: the record is not endless."""
    speeds = 'speeds = [["0 m", "9 km/h"], ["15 m", "0 km/h"]]'
    text = changed(('speed = "15 km/h"', speeds), text=NO_END)
    text = text.replace('"container_truck_40ft"', '"car_bmw_320i"')
    study = study_from_text(text.replace('["15 m", ', '["10 m", '))
    assert study.longest_record < 60.0


def test_the_runs_that_the_remedy_allows_fit():
    """A thousand points: the largest number of runs that the message names is accepted."""
    points = "".join(
        f'[[point]]\nname = "p{i}"\nat = ["{0.1 + i % 100 / 10} m", "{1 + i // 100 / 5} m"]\n'
        for i in range(500)
    )
    more = [("runs = 2", "runs = 1000000"), ("[[method]]", points + "[[method]]")]
    problem = told(*more)["runs"]
    most = int(problem.remedy.removeprefix("use at most ").partition(" ")[0])
    assert 0 < most < 1_000_000
    assert study_from_text(changed(("runs = 2", f"runs = {most}"), more[1])).runs == most
    assert list(told(("runs = 2", f"runs = {most + most // 100 + 1}"), more[1])) == ["runs"]
