"""What sections say to each other: names that there are, places on a floor, kinds of mistakes."""

import pytest

from trundle.errors import InputError, Problem
from trundle.study_file.attempt import attempt, attempted
from trundle.study_file.draft import covered, is_off, refer, unique
from trundle.study_file.rules import rule_of

EXTENT = ((-1.0, 11.0), (2.0, 8.0))


@pytest.mark.parametrize(
    ("place", "off"),
    [
        ((-1.0, 2.0), False),
        ((11.0, 8.0), False),
        ((11.0 + 9e-7, 5.0), False),
        ((11.0 + 2e-6, 5.0), True),
        ((5.0, 2.0 - 2e-6), True),
        ((5.0, 9.0), True),
        ((9.0, -0.5), True),
    ],
)
def test_a_floor_ends_a_micrometre_beyond_its_edge(place, off):
    """What a conversion rounds is forgiven, a millimetre is not; x and y are not confused."""
    assert is_off(EXTENT, place) is off


def test_where_a_floor_is_is_said_x_first():
    """Both ranges in metres."""
    assert covered(EXTENT) == "the floor covers x -1 to 11 m and y 2 to 8 m"


def test_names_that_stand_more_than_once_are_counted_each_once():
    """a three times and c twice are two mistakes, told where each stands for the second time."""
    found = list(unique((f"point[{i}]", name) for i, name in enumerate("abacac", start=1)))
    assert [p.value for p in found] == ["'a' 3 times", "'c' 2 times"]
    assert [p.place for p in found] == ["point[3]", "point[6]"]
    assert [p.remedy.rpartition(" ")[2] for p in found] == ["point[1]", "point[4]"]
    assert not list(unique([("p", "a"), ("p", "A"), ("p", "a ")]))


def test_a_reference_lists_names_in_the_order_of_the_alphabet():
    """To be found by eye; nothing is 'none'."""
    (problem,) = refer("route[1].vehicle", "x", {"van", "bus", "Müll"}, "vehicle")
    assert problem.remedy == "there are: Müll, bus, van"
    (problem,) = refer("p", "x", set(), "route")
    assert problem.remedy == "there are: none"
    assert not list(refer("p", "x", {"x"}, "route"))


def refuse(message):
    raise InputError(message)


@pytest.mark.parametrize(
    ("message", "rule", "value"),
    [
        ("speed must be positive; got -3", "speed must be positive", "-3"),
        ("speed must be positive", "speed must be positive", "this section"),
        ("a; b; got c; got d", "a; b", "c; got d"),
    ],
)
def test_a_message_is_parted_into_rule_and_value(message, rule, value):
    """Messages end in what was got; where they do not the section is meant."""
    problem = attempt("here", lambda: refuse(message))
    assert (problem.place, problem.rule, problem.value) == ("here", rule, value)
    assert problem.remedy == "correct the value"


def test_what_can_be_made_is_made_and_other_errors_are_not_hidden():
    """Only a mistake of the input becomes a message; a fault of the program must show."""
    assert attempted("here", lambda: 0) == (0, [])
    made, (problem,) = attempted("here", lambda: refuse("no"), "do this")
    assert made is None
    assert problem.remedy == "do this"
    with pytest.raises(ZeroDivisionError):
        attempted("here", lambda: 1 // 0)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        ({"type": "greater_than", "ctx": {"gt": 1_000_000}}, "must be greater than 1000000"),
        ({"type": "less_than_equal", "ctx": {"le": 1_000_000}}, "must be 1000000 or less"),
        ({"type": "less_than", "ctx": {"lt": 0.5}}, "must be less than 0.5"),
        ({"type": "too_long", "ctx": {"max_length": 20}}, "must hold at most 20"),
        ({"type": "int_from_float"}, "must be a whole number"),
        ({"type": "finite_number"}, "must be a finite number"),
        ({"type": "literal_error", "ctx": {"expected": "'a' or 'b'"}}, "must be one of 'a' or 'b'"),
        ({"type": "rule", "msg": "must be nice"}, "must be nice"),
        ({"type": "value_error", "ctx": {"error": ValueError("is odd")}}, "is odd"),
        (
            {"type": "a kind that nobody knows", "msg": "Input should be"},
            "is not what belongs here",
        ),
    ],
)
def test_rules_are_in_the_words_of_this_program(error, words):
    """What the validating library says of its own never shows; numbers are not 1e+06."""
    assert rule_of(error) == words


def test_a_problem_reads_place_value_rule_and_remedy():
    """With its line before all of it, where that is known."""
    problem = Problem(place="a.b", value="3", rule="must be 4", remedy="write 4", line=7)
    assert str(problem) == "line 7, a.b: got 3\n    rule:   must be 4\n    remedy: write 4"
