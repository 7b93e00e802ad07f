"""Mistakes of keys that take values of several kinds: told once, of the kind that was meant."""

import pytest

from studies import BUILDING
from trundle.errors import StudyError
from trundle.study_file import study_from_text
from trundle.study_file.alternatives import by_likeness

WAY = 'on = "deck"\npath'


def told(old, new):
    assert BUILDING.count(old) == 1
    with pytest.raises(StudyError) as caught:
        study_from_text(BUILDING.replace(old, new))
    return [(p.place, p.rule) for p in caught.value.problems]


def error(*loc):
    return {"type": "rule", "loc": loc, "msg": "no"}


def kept(errors, data):
    return [(e["loc"], tuple(e.get("others", ()))) for e in by_likeness(errors, data)]


BASE = [
    error("column", 0, "base", "literal['fixed','pinned']"),
    error("column", 0, "base", "SpringsSection", "uz"),
]


def test_of_a_word_or_a_table_the_kind_of_the_value_is_kept():
    """For a table what is wrong within it; for a word, or what is neither, what the words are."""
    table, word = ("column", 0, "base", "uz"), ("column", 0, "base")
    for value, expected in (
        ({"uz": "50 MN"}, [(table, ("a word",))]),
        ("pined", [(word, ("a table",))]),
        (3, [(word, ("a table",))]),
    ):
        assert kept(BASE, {"column": [{"base": value}]}) == expected


def test_a_list_is_told_by_its_entries_and_a_word_by_the_words():
    """Places, or the word grid."""
    errors = [error("at", "tuple[any, ...]", 1), error("at", "literal['grid']")]
    assert kept(errors, {"at": [["1 m", "2 m"], ["3 m"]]}) == [(("at", 1), ("a word",))]
    assert kept(errors, {"at": "Grid"}) == [(("at",), ("a list",))]


def test_every_entry_of_a_list_is_looked_at_by_itself():
    """The first column's base is a word, the second's a table, the third is not there."""
    errors = [{**e, "loc": ("column", i, *e["loc"][2:])} for i in range(3) for e in BASE]
    data = {"column": [{"base": "x"}, {"base": {"uz": 1}}]}
    assert [loc for loc, _ in kept(errors, data)] == [
        ("column", 0, "base"), ("column", 1, "base", "uz"), ("column", 2, "base"),
    ]  # fmt: skip


def test_mistakes_of_keys_of_one_kind_are_kept_as_they_are():
    """And a key of a table is told by its name, not as a key."""
    errors = [error("speed"), error("materials", "a/b", "[key]")]
    assert kept(errors, {}) == [(("speed",), ()), (("materials", "a/b"), ())]


@pytest.mark.parametrize(
    ("new", "place", "words"),
    [
        ('on = ["deck", 3]\npath', "route[1].on[2]", "must be text, in quotes"),
        ('on = ["a/b"]\npath', "route[1].on[1]", "without '/'"),
        ("on = 3\npath", "route[1].on", "must be text, in quotes; or a list"),
        ("on = {}\npath", "route[1].on", "must be text, in quotes; or a list"),
    ],
)
def test_a_storey_or_a_list_of_them_is_told_as_what_was_given(new, place, words):
    """One mistake for one slip: by its number in a list, or with both kinds for neither."""
    ((where, rule),) = told(WAY, new)
    assert where == place
    assert words in rule


def test_a_word_that_is_none_is_told_with_the_words_and_that_a_table_would_do_too():
    """One letter off."""
    ((place, rule),) = told('base = "fixed"', 'base = "fixd"')
    assert place == "building.column[1].base"
    assert rule == "must be one of 'fixed' or 'pinned'; or a table"


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ('base = "fixed"', 'base = { uz = "50 MN" }', "building.column[1].base.uz"),
        ('base = "pinned"', 'base = { rx = "50 MN m/rad" }', "building.wall[1].base.rx"),
        ('at = "grid"', 'at = ["A/1", ["3 m"], "B/1"]', "building.column[1].at[2]"),
    ],
)
def test_a_table_or_list_of_a_building_is_told_of_its_own_key(old, new, place):
    """The kind of the building, which its section does not name, is no part of where it stands."""
    assert [where for where, _ in told(old, new)] == [place]
