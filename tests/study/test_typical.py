"""Doubts about single values: ranges, units they are written in, and what was meant instead."""

import numpy as np
import pytest

from trundle.study.typical import TYPICAL, Typical, doubt_of

KM_H = 1.0 / 3.6


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.001, "1 mm"), (0.9994, "999.4 mm"), (1.0, "1 m"), (1.0 - 1e-12, "1 m"), (12.5, "12.5 m"),
        (0.0002, "0.2 mm"), (1234567.0, "1235000 m"), (0.0, "0 mm"), (-2.0, "-2 m"),
    ],
)  # fmt: skip
def test_a_length_is_written_in_the_largest_unit_that_fits(value, text):
    """By hand, with four digits; less than a millimetre stays in millimetres."""
    assert TYPICAL["slab"].write(value) == text


def test_bounds_belong_to_the_range_in_spite_of_round_off():
    """50 km/h typed as 50/3.6 m/s is usual; a thousandth more is not."""
    speed = TYPICAL["speed"]
    assert speed.holds(50.0 * KM_H)
    assert speed.holds(50.0 / 3.6 * (1.0 + 1e-12))
    assert not speed.holds(50.05 * KM_H)
    assert speed.holds(1.5 * KM_H)
    assert not speed.holds(1.498 * KM_H)


@pytest.mark.parametrize(
    ("key", "value", "guess"),
    [
        ("modulus", 33e6, "33 GPa"),  # MPa for GPa
        ("density", 2.5, "2500 kg/m3"),  # t/m3 typed as kg/m3
        ("slab", 200.0, "200 mm"),  # mm typed as m
        ("damping", 3.0, "3 %"),  # 3 for 3 %
        ("speed", 15.0, "15 km/h"),  # m/s for km/h
        ("storey", 0.04, "4 m"),  # cm for m
        ("superimposed mass", 3.0, "306 kg/m2"),  # kN/m2 typed as kg/m2
        ("vehicle mass", 40e6, "masses 1000 times smaller"),  # kg typed as t
    ],
)
def test_the_first_guess_is_the_value_without_the_slip(key, value, guess):
    """Each slip by hand: a prefix, a point, km/h for m/s, 1 kN/m2 for 102 kg/m2."""
    assert TYPICAL[key].guesses(value)[0] == guess


def test_guesses_are_usual_values_and_few():
    """For every quantity and a slip of any size, what is guessed lies in the range itself."""
    for key, typical in TYPICAL.items():
        middle = float(np.sqrt(typical.low * typical.high))
        for factor in (1e-6, 1e-3, 0.01, 100.0, 1e3, 1e6):
            value = middle * factor**typical.power
            if typical.holds(value):
                continue
            guesses = typical.guesses(value)
            assert len(guesses) <= 3, key
            assert len(set(guesses)) == len(guesses), key
            # the slip's own inverse leads back to the middle of the range
            assert guesses, (key, factor)


def test_a_stiffness_is_mistaken_by_the_square_of_its_frequency():
    """0.05 Hz instead of 1.6 Hz is a stiffness 1000 times too small: f goes with its root."""
    bounce = TYPICAL["bounce of a truck"]
    assert bounce.guesses(1.6 / np.sqrt(1e3))[0] == "a stiffness 1000 times as large"
    assert bounce.guesses(1.6 * np.sqrt(1e3))[0] == "a stiffness 1000 times smaller"


def test_a_doubt_says_place_value_range_and_guess():
    """One sentence, from which the slip is seen; a usual value has none."""
    doubt = doubt_of("floor.slab_thickness", "slab", 2.0)
    assert doubt.subject == "floor.slab_thickness"
    assert doubt.message == (
        "2 m is unusual: the thickness of a slab is mostly 60 mm to 1.2 m; did you mean 200 mm?"
    )
    assert doubt_of("floor.slab_thickness", "slab", 0.2) is None


@pytest.mark.parametrize("value", [0.0, 1e12])
def test_a_value_that_nothing_explains_is_asked_back(value):
    """No power of ten leads from nothing, nor from a million kilometres, to a slab."""
    assert doubt_of("x", "slab", value).message.endswith("; is it meant?")


def test_every_range_is_one_and_can_be_written():
    """Low is below high, units rise, and each end is written as a number that reads back."""
    for key, typical in TYPICAL.items():
        assert 0.0 < typical.low < typical.high, key
        sizes = [size for _, size in typical.units]
        assert sizes == sorted(sizes), key
        for end in (typical.low, typical.high):
            number, _, unit = typical.write(end).partition(" ")
            assert float(number) * dict(typical.units)[unit] == pytest.approx(end, rel=1e-3), key
        # a slip by a thousand is never usual, where the value itself was in the middle
        middle = np.sqrt(typical.low * typical.high)
        if typical.power == 1.0 and typical.high / typical.low < 1e6:
            assert not typical.holds(middle * 1e3), key


def test_not_a_number_is_not_usual():
    """A comparison with NaN is false either way: it must not be taken for a usual value."""
    plain = Typical(what="a number", low=1.0, high=2.0)
    assert not plain.holds(float("nan"))
    assert not plain.holds(float("inf"))
