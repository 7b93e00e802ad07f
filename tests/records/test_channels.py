"""Channels of a record are chosen by what the file calls them first, and never by chance."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.records.channels import choose
from trundle.records.raw import RawRecord


def raw(*names, units=(), axes=()):
    """A record whose channel i holds the number i throughout."""
    n = len(names)
    return RawRecord(
        samples=np.repeat(np.arange(float(n))[:, None], 4, axis=1), rate=100.0, names=names,
        units=units or ("mm/s",) * n, axes=axes, ranges=tuple(f"{i} g" for i in range(n)),
    )  # fmt: skip


def chosen(record, wanted):
    """Which channels, by the numbers that they hold."""
    found = choose(record, wanted, "r.csv")
    numbers = [int(row[0]) for row in found.samples]
    # names, units and ranges go with their samples
    assert found.names == tuple(record.names[i] for i in numbers)
    assert found.units == tuple(record.units[i] for i in numbers)
    assert found.ranges == tuple(record.ranges[i] for i in numbers)
    return numbers


@pytest.mark.parametrize(
    ("wanted", "numbers"),
    [
        ("", [0, 1, 2]), (" , ,", [0, 1, 2]), ("2", [0]), ("3", [2]), ("3, 2 ,3", [2, 0]),
        ("1", [1]), ("HALL", [2]),
    ],
)  # fmt: skip
def test_a_name_wins_over_a_number(wanted, numbers):
    """Channels are called 2, 1 and hall: ``2`` is the one of that name, ``3`` the third."""
    assert chosen(raw("2", "1", "hall"), wanted) == numbers


@pytest.mark.parametrize(
    ("wanted", "numbers"),
    [
        ("vertical", [2]), ("Horizontal", [0, 1]), ("mm/s2", [0, 1]), ("mm/s^2", [0, 1]),
        ("mg", [2]), ("horizontal, vertical", [0, 1, 2]), ("mg,mm.s-2", [2, 0, 1]),
    ],
)  # fmt: skip
def test_units_in_any_spelling_and_axes_choose_all_that_have_them(wanted, numbers):
    """Two level channels in mm/s2 and an upright one in mg, in the order that is asked for."""
    record = raw("slab x", "slab y", "slab z", units=("mm/s2", "mms-2", "mG"))
    assert chosen(record, wanted) == numbers


def test_directions_that_the_format_states_win_over_names():
    """A universal file says which way is up; a channel called x there may be upright."""
    record = raw("x", "z", axes=("vertical", "horizontal"))
    assert chosen(record, "vertical") == [0]
    assert choose(record, "vertical", "r.uff").axes == ("vertical",)


def test_ends_of_names_are_found_by_words():
    """``z`` is a last word and not a last letter; longer ends may be letters of a code."""
    record = raw("slab z", "buzz", "XX.FLOOR..HHZ", "HHZ 2")
    assert chosen(record, "z") == [0]
    assert chosen(record, "hhz") == [2]
    assert chosen(record, "zz") == [1]


@pytest.mark.parametrize("wanted", ["0", "4", "-1", "1.0", "up", "2 ", "m"])
def test_what_no_channel_is_is_refused_with_all_that_there_are(wanted):
    """Numbers count from 1 to 3; a list with one slip is refused as a whole."""
    record = raw("<b>", "größe", "c", units=("mm/s", "", "g"))
    if wanted == "2 ":
        assert chosen(record, wanted) == [1]
        return
    with pytest.raises(InputError) as told:
        choose(record, f"c, {wanted}", "r.csv")
    assert str(told.value) == (
        f"r.csv: no channel is {wanted!r}; there are 1 '<b>' [mm/s], 2 'größe', 3 'c' [g]"
    )
