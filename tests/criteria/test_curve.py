"""Limit curves: straight on logarithmic axes, where they begin and end, their names."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.criteria import VC, Criterion, all_criteria, find_criterion, shaped
from trundle.criteria.curve import told_apart
from trundle.errors import InputError
from trundle.signals import mid_band_frequencies, nominal_frequency


def curve(points, **changes):
    """Return a curve through points of frequency and limit."""
    values = {
        "name": "own", "title": "Own", "quantity": "band_rms_velocity", "axis": "vertical",
        "averaging": "max_1s", "source": "a data sheet", "confidence": "printed",
    }  # fmt: skip
    corners = np.array(points, dtype=float).reshape(-1, 2)
    return Criterion(frequencies=corners[:, 0], limits=corners[:, 1], **{**values, **changes})


def test_a_limit_is_a_power_of_frequency_between_two_corners():
    """Through (2, 9) and (32, 144) runs 4.5 f; through (32, 144) and (72, 64) runs 4608 / f."""
    three = curve([(2.0, 9.0), (32.0, 144.0), (72.0, 64.0)])
    f = np.array([2.0, 3.0, 8.0, 32.0, 48.0, 72.0])
    expected = np.where(f <= 32.0, 4.5 * f, 4608.0 / f)
    np.testing.assert_allclose(three.limit(f), expected, rtol=1e-12)


def test_a_band_belongs_to_a_curve_by_its_nominal_frequency():
    """79.43 Hz is "80 Hz" and 3.98 Hz is "4 Hz"; their neighbours 100 and 3.15 Hz are outside.

    Exact mid-bands differ from their names by up to 1.3 %: each curve between two nominal
    frequencies has a limit in those bands, and in none beside them.
    """
    bands = mid_band_frequencies(-10, 23)
    names = np.array([nominal_frequency(f) for f in bands])
    for low in (1.0, 3.15, 4.0, 12.5, 31.5):
        for high in (40.0, 63.0, 80.0, 100.0):
            one = curve([(low, 1.0), (high, 2.0)])
            inside = np.isfinite(one.limit(bands))
            np.testing.assert_array_equal(inside, (names >= low) & (names <= high))


def test_a_constant_curve_without_end_has_its_limit_everywhere():
    """From 0 Hz to infinity: logarithms of neither exist, and neither is needed."""
    every = curve([(0.0, 3e-3), (np.inf, 3e-3)], quantity="peak_acceleration")
    np.testing.assert_array_equal(every.limit(np.array([0.0, 1e-3, 1.0, 1e9])), 3e-3)


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (1.0, 80.0, []),
        (0.8, 80.0, [0.8]),
        (0.1, 20.0, [0.1, 0.125, 0.16, 0.2, 0.25, 0.315, 0.4, 0.5, 0.63, 0.8]),
        (10.0, 200.0, [100.0, 125.0, 160.0, 200.0]),
        (0.5, 100.0, [0.5, 0.63, 0.8, 100.0]),
    ],
)
def test_bands_that_are_never_computed_are_named(low, high, expected):
    """Levels are formed from 1 to 80 Hz; the series of preferred frequencies names the others."""
    beyond = curve([(low, 1.0), (high, 1.0)]).bands_beyond()
    assert [nominal_frequency(f) for f in beyond] == pytest.approx(expected)


def test_only_curves_that_double_towards_4_hz_are_flattened():
    """Those of Gordon's curves that rise: workshop to VC-B; all others are as they are.

    Flat means their value at 8 Hz from 1 to 80 Hz.
    """
    every = all_criteria()
    rising = [c.name for c in every if c.rises]
    assert rising == [c.name for c in VC[:6]]
    flat = shaped(every, "flat")
    for before, after in zip(every, flat, strict=True):
        if not before.rises:
            assert after is before
            continue
        at_8 = before.limit(np.array([8.0]))[0]
        np.testing.assert_allclose(after.limit(mid_band_frequencies()), at_8, rtol=1e-12)
        assert after.name == before.name
        assert after.title == f"{before.title} (flat to 1 Hz)"
    assert shaped(every, "rising") == tuple(every)


def test_criteria_are_found_by_any_of_their_names_in_any_case():
    """Every name and alias that ships leads to its own curve: none hides another."""
    for one in all_criteria():
        for name in (one.name, *one.aliases):
            assert find_criterion(f"  {name.upper()} ") is one


def test_an_own_criterion_comes_before_one_that_ships():
    """The user's VC-A is meant where a study names VC-A, by its aliases as well."""
    mine = curve([(1.0, 1e-6), (80.0, 1e-6)], name="vc-a", aliases=("Bühler <3>",))
    assert find_criterion("VC-A", [mine]) is mine
    assert find_criterion("bühler <3>", [mine]) is mine
    assert find_criterion("VC-B", [mine]) is find_criterion("VC-B")
    with pytest.raises(InputError, match="there are vc-a, workshop"):
        find_criterion("VC-Z", [mine])


def test_published_curves_do_not_change_with_use():
    """A limit that somebody scales in place would hold for every later verdict."""
    one = find_criterion("VC-A")
    for values in (one.limits, one.frequencies):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0
    given = np.array([1.0, 2.0])
    own = replace(one, frequencies=np.array([1.0, 80.0]), limits=given)
    given[0] = 9.0
    assert own.limits[0] == 1.0


@pytest.mark.parametrize(
    ("points", "changes", "told"),
    [
        ([(0.0, 1.0), (80.0, 2.0)], {}, "must be above 0"),
        ([(-1.0, 1.0), (80.0, 1.0)], {}, "must be above 0"),
        ([(1.0, 1.0), (1.0, 2.0)], {}, "must rise"),
        ([], {}, "must rise"),
        ([(1.0, 1.0), (np.nan, 1.0)], {}, "must rise"),
        ([(np.nan, 1.0), (80.0, 1.0)], {}, "must rise"),
        ([(1.0, 1.0), (np.inf, 1.0), (np.inf, 1.0)], {}, "must rise"),
        ([(1.0, 1e-6), (np.inf, 1e-3)], {}, "no line goes from 1e-06 to 0.001 at infinity"),
        ([(1.0, 1e-3), (80.0, 1e-5)], {"quantity": "vdv"}, "one number and has one limit"),
        ([(1.0, 1e-3), (80.0, 1e-5)], {"quantity": "peak_acceleration"}, "one limit"),
        ([(1.0, 1.0), (80.0, np.nan)], {}, "must be finite"),
        ([(1.0, 1.0), (80.0, np.inf)], {}, "must be finite"),
        ([(1.0, 1.0), (80.0, -1.0)], {}, "greater than 0"),
        ([(1.0, 1.0), (80.0, 1.0)], {"axis": "upright"}, "axis must be one of"),
    ],
)
def test_what_is_no_limit_curve_is_refused(points, changes, told):
    """A zero, an order that falls or a limit that is no number would compare as met.

    So would a slope that never ends, which stays at its first limit, and of two limits of one
    number the wider.
    """
    with pytest.raises(InputError, match=told):
        curve(points, **changes)


def test_a_curve_may_go_on_level_for_ever():
    """Halved from 4 to 8 Hz, and from there on as it is."""
    one = curve([(4.0, 2e-6), (8.0, 1e-6), (np.inf, 1e-6)])
    np.testing.assert_allclose(one.limit(np.array([4.0, 8.0, 80.0, 1e4])), [2e-6, 1e-6, 1e-6, 1e-6])


def test_generic_classes_go_from_wide_to_strict_and_halve():
    """Gordon's classes: each allows half of what the one before allows (12.5, 6.25 and 3.12)."""
    limits = np.array([c.limit(np.array([20.0]))[0] for c in VC])
    np.testing.assert_allclose(limits[:-1] / limits[1:], 2.0, rtol=0.003)


def test_people_are_not_held_against_bands():
    """Doses and response factors are single numbers, of one limit at all frequencies."""
    single = [c for c in all_criteria() if c.quantity in {"vdv", "response_factor"}]
    assert len(single) > 10
    for one in single:
        assert np.ptp(one.limits) == 0.0
        assert one.frequencies[0] == 0.0
        assert np.isinf(one.frequencies[-1])


def test_titles_that_several_have_are_told_apart_by_names():
    """Readers go by titles: a user's curve may be called as one that ships with trundle."""
    one, other, alone = (
        curve([(4, 1e-4), (80, 1e-4)], name=name, title=title)
        for name, title in (("VC-A", "VC-A"), ("mine", "VC-A"), ("b", "B"))
    )
    found = told_apart([one, other, alone])
    assert [c.title for c in found] == ["VC-A (VC-A)", "VC-A (mine)", "B"]
    assert [c.name for c in found] == ["VC-A", "mine", "b"]
