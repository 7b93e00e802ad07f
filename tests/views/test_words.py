"""Numbers, ranges, roads and rules as people read them."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import SECOND, curve, made_study, verdict
from trundle.criteria import find_criterion
from trundle.road import RoadClass
from trundle.study import ReportPlan
from trundle.views.words import (
    between,
    hertz,
    limit_words,
    rank,
    road_words,
    roughest_words,
    roughness_words,
    rule_name,
    shown,
    spread,
    written,
)


@pytest.fixture(scope="module")
def study():
    return made_study(SECOND)


@pytest.mark.parametrize(
    ("name", "usual", "asked"),
    [
        ("VC-A", "100 um/s at 4 Hz, 50 um/s at 8 Hz, 50 um/s at 80 Hz",
         "0.003937 in/s at 4 Hz, 0.001969 in/s at 8 Hz, 0.001969 in/s at 80 Hz"),
        ("precision-isolated", "0.3 gal", "0.3059 mg"),
        ("R-office", "4", "4"),
    ],
)  # fmt: skip
def test_a_limit_is_told_in_the_units_of_a_report(name, usual, asked):
    """An inch has 25400 um; 3 mm/s2 are 3 / 9.80665 thousandths of gravity; a factor has no unit."""
    criterion = find_criterion(name)
    assert limit_words(criterion) == usual
    assert limit_words(criterion, ReportPlan(velocity="in/s", acceleration="mg")) == asked


def test_a_range_is_of_the_runs_in_the_unit():
    """Of 0 to 100 gal in steps of 1: 5, 50 and 95 gal, whatever their order."""
    values = 0.01 * np.random.default_rng(3).permutation(np.arange(101.0))
    assert spread(values, 0.01) == pytest.approx((5.0, 50.0, 95.0))


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (0.0, "0"), (1.0, "1"), (12.345, "12.3"), (999.4, "999"), (999.6, "1000"), (1324.0, "1320"),
        (-1324.0, "-1320"), (123456.0, "123000"), (999499.0, "999000"), (0.0123456, "0.0123"),
        (1.5e6, "1.5e+06"), (np.inf, "inf"),
    ],
)  # fmt: skip
def test_numbers_of_three_digits_have_no_powers_of_ten_below_a_million(value, said):
    """Rounded to three digits by hand; a thousand is a thousand and no 1e+03."""
    assert written(value) == said


def test_units_of_people_are_so_large_in_si():
    """1 gal is 0.01 m/s2, 1 um/s 1e-6 m/s; a unit that nobody turns stays, times one."""
    assert shown("m/s2") == ("gal", 0.01)
    assert shown("m/s") == ("um/s", 1e-6)
    assert shown("m/s1.75") == ("m/s^1.75", 1.0)
    assert shown("1") == ("1", 1.0)


@pytest.mark.parametrize(
    ("interval", "said"),
    [
        ((0.8, 1.25), "1.23 (0.8-1.25)"), ((0.0, 1.25), "1.23 (at most 1.25)"),
        ((0.0, np.inf), "1.23"), ((np.nan, np.nan), "1.23"),
    ],
)  # fmt: skip
def test_a_margin_stands_with_what_bounds_it(interval, said):
    """Few runs leave the lower end open: then 0 is no bound, and is not written as one."""
    assert between(verdict(margin=1.2345, interval=interval)) == said


def test_bands_are_called_by_their_names():
    """3.162 Hz is 3.15, 31.62 is 31.5, 79.43 is 80; a single number has no band."""
    assert [hertz(10 ** (k / 10)) for k in (0, 5, 15, 19)] == ["1", "3.15", "31.5", "80"]
    assert hertz(np.nan) == ""


@pytest.mark.parametrize(
    ("value", "said"), [(0.0, "below all"), (50.0, "50 %"), (100.0, "above all")]
)
def test_a_rank_below_the_lowest_run_is_no_percentile(value, said):
    """Printed values that no run reaches are not the 0th percentile of the class."""
    assert rank(value) == said


def test_rules_of_averaging_are_four_different_words():
    """A level by one rule may be several times that by another: none is called as another."""
    names = [rule_name(rule) for rule in ("max_1s", "slow", "fast", "event")]
    assert names == ["largest 1 s average", "slow", "fast", "whole event"]


def test_roads_are_said_with_their_roughness(study):
    """ISO 8608: class B has 64e-6 m3 in the mean, C four times that, its upper limit twice as much."""
    assert road_words(study) == [
        "B: geometric mean of class B, Gd(n0) = 64e-6 m3",
        "C: geometric mean of class C, Gd(n0) = 256e-6 m3",
    ]
    upper = replace(study, roads={"C, rauh": RoadClass("C", level="upper")})
    assert road_words(upper) == ["C, rauh: upper of class C, Gd(n0) = 512e-6 m3"]
    assert road_words(replace(study, drives={})) == ["none: nobody drives"]


@pytest.mark.parametrize(
    ("margin", "said"),
    [
        (1.0, "at least 64e-6 m3 (all of class A)"),  # class B ends at 128e-6
        (1.5, "at least 144e-6 m3 (all of class B)"),
        (3.0, "at least 576e-6 m3 (all of class C)"),
        (0.8, "at most 41e-6 m3 (all of class A)"),
        (0.5, "at most 16e-6 m3 (less than class A)"),  # class A ends at 32e-6
        (1000.0, "at least 64 m3 (all of class H)"),
    ],
)
def test_the_roughest_road_that_is_passed_goes_with_the_square_of_the_margin(study, margin, said):
    """64e-6 m3 times margin squared, beside the upper limits of ISO 8608: 32, 128, 512e-6 m3 ..."""
    assert roughest_words(study, "B", verdict(margin=margin)) == said


def test_no_road_is_named_where_nothing_is_known_of_it(study):
    """No margin, a limit on another quantity: nothing, and no class that passes."""
    assert roughest_words(study, "B", verdict(margin=np.nan)) == ""
    peak = curve(quantity="peak_acceleration")
    assert roughest_words(study, "B", verdict(peak, margin=2.0)) == ""


@pytest.mark.parametrize(
    ("value", "said"),
    [(64e-6, "64e-6 m3"), (1.174e-3, "1170e-6 m3"), (4.0e-7, "0.4e-6 m3"), (64.0, "64 m3")],
)
def test_a_roughness_has_one_power_of_ten(value, said):
    """Three digits in 1e-6 m3, as ISO 8608 prints it; above 1 m3 in whole ones."""
    assert roughness_words(value) == said


@pytest.mark.parametrize(
    ("f", "said"), [(10**0.8, "6.3"), (7.0, "7"), (10**1.5, "31.5"), (31.0, "31"), (np.nan, "")]
)
def test_bands_have_names_and_lines_have_not(f, said):
    """31.62 Hz is called 31.5 Hz; a line at 31 Hz is itself."""
    assert hertz(f) == said
