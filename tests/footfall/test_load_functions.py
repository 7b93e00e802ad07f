"""Load functions built by hand: ranges, caps, series that go on, weights, speeds, refusals."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.footfall import FOOTFALLS, FootfallLoad, Harmonic, Impulse, footfall_load

FIRST = Harmonic(number=1, f_from=1.5, f_to=2.5, constant=-0.6, slope=0.5, most=0.6, phase=0.3)
SECOND = Harmonic(number=2, f_from=3.0, f_to=5.0, constant=0.1, phase=-0.7)


def load(**changes):
    values = {
        "name": "a <guide>", "title": "t", "source": "s", "confidence": "c", "weight": 800.0,
        "paces": (1.5, 2.5), "harmonics": (FIRST, SECOND),
        "impulse": Impulse(factor=50.0, pace_power=1.5, power=1.0), "speed": (0.5, 0.0, 0.25),
    }  # fmt: skip
    return FootfallLoad(**{**values, **changes})


def test_a_factor_is_a_line_between_its_ends_below_its_most_and_never_below_nought():
    """-0.6 + 0.5 f: 0.15 at 1.5 Hz and before, 0.4 at 2 Hz, 0.6 from 2.4 Hz on."""
    np.testing.assert_allclose(
        FIRST.factor([0.5, 1.5, 2.0, 2.4, 2.5, 9.0]), [0.15, 0.15, 0.4, 0.6, 0.6, 0.6]
    )
    below = replace(FIRST, constant=-2.0)
    np.testing.assert_allclose(below.factor([1.5, 2.5]), [0.0, 0.0])


def test_a_guide_covers_its_ends_and_nothing_beyond():
    """Its own ends count, whatever round-off made of them."""
    for f, known in (
        (1.5, True),
        (3 * 0.5, True),
        (2.5 + 1e-10, True),
        (1.499, False),
        (2.501, False),
    ):
        assert FIRST.covers(f) is known


def test_a_series_goes_on_by_impulses_where_the_guides_harmonics_end():
    """By hand at 2 steps a second: 800 N times 0.4 and 0.1, then 2 f_p I(h f_p) with I 50 2^1.5 / f.

    The third lies at 6 Hz: 2 x 2 x 50 x 2.828 / 6 N.
    """
    found = load().amplitudes(2.0, 4)
    shape = 4.0 * 50.0 * 2.0**1.5
    np.testing.assert_allclose(found, [320.0, 80.0, shape / 6.0, shape / 8.0], rtol=1e-12)
    np.testing.assert_allclose(load().amplitudes(2.0), found[:2])
    np.testing.assert_allclose(load().amplitudes(2.0, 1), found[:1])
    assert load().amplitudes(2.0, 0).tolist() == []


def test_a_heavier_walker_presses_harder_in_every_harmonic():
    """Invariant: amplitudes of harmonics and of impulses alike are in proportion to the weight."""
    for name in FOOTFALLS:
        guide = footfall_load(name)
        n = len(guide.harmonics) + (3 if guide.impulse else 0)
        once, twice = (
            guide.amplitudes(1.9, n, weight=w) for w in (guide.weight, 2.0 * guide.weight)
        )
        np.testing.assert_allclose(twice, 2.0 * once, rtol=1e-12)
        np.testing.assert_allclose(guide.amplitudes(1.9, n), once, rtol=1e-12)
    assert not load().amplitudes(2.0, 4, weight=0.0).any()


@pytest.mark.parametrize(
    ("pace", "f_max", "n"), [(2.0, 20.0, 10), (2.0, 19.99, 9), (1.6, 22.4, 14), (1.7, 34.0, 20),
                             (2.2, 1.0, 2)]
)  # fmt: skip
def test_a_series_reaches_the_frequency_that_is_asked_for(pace, f_max, n):
    """22.4 Hz is 14 times 1.6 Hz, though a division says less; never fewer than the guide's."""
    assert load().n_harmonics(pace, f_max) == n
    assert load(impulse=None).n_harmonics(pace, f_max) == 2
    assert load().highest(pace) == pytest.approx(2.0 * pace)


def test_phases_beyond_the_guides_fall_on_the_step():
    """Its own in their order, then nought; fewer where fewer are asked for."""
    assert load().phases(4).tolist() == [0.3, -0.7, 0.0, 0.0]
    assert load().phases(1).tolist() == [0.3]
    assert load().phases().tolist() == [0.3, -0.7]


def test_speed_is_a_polynomial_of_the_pace_or_three_quarters_of_a_metre_a_step():
    """0.5 + 0.25 f^2 at 2 steps a second is 1.5 m/s; without one, 0.75 f."""
    assert load().walking_speed(2.0) == pytest.approx(1.5)
    assert load(speed=()).walking_speed(1.6) == pytest.approx(1.2)


def test_people_walk_as_fast_as_people_do_by_every_guide():
    """At every pace a guide is for: between 0.8 and 2.5 m/s, and never slower at a higher pace."""
    for name in FOOTFALLS:
        guide = footfall_load(name)
        paces = np.linspace(*guide.paces, 20)
        speeds = [guide.walking_speed(float(p)) for p in paces]
        assert np.all(np.diff(speeds) > 0.0), name
        assert 0.7 < min(speeds) < max(speeds) < 2.5, name


def test_guides_press_less_than_their_walkers_weigh():
    """A foot that is on the ground does not pull: harmonics together stay below the weight."""
    for name in FOOTFALLS:
        guide = footfall_load(name)
        for pace in np.linspace(*guide.paces, 7):
            assert 0.0 < guide.amplitudes(float(pace)).sum() < guide.weight, name


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"paces": (2.5, 1.5)}, "'a <guide>': paces must rise; got 2.5 and 1.5"),
        ({"paces": (0.0, 1.5)}, "paces must rise"),
        ({"harmonics": (SECOND, FIRST)}, "harmonics must be 1, 2, 3 and so on"),
        ({"harmonics": (FIRST, replace(SECOND, number=3))}, "harmonics must be 1, 2, 3 and so on"),
        ({"weight": -1.0}, "weight must be greater than 0"),
    ],
)
def test_guides_that_cannot_be_are_refused(changes, said):
    """A gap among harmonics would press with the next one's force at its frequency."""
    with pytest.raises(InputError, match=said):
        load(**changes)


def test_walks_that_cannot_be_are_refused():
    """No walker of less than nothing, nobody at nought steps a second, no impulse of nought."""
    with pytest.raises(InputError, match="weight must be 0 or more; got -5"):
        load().amplitudes(2.0, weight=-5.0)
    for pace in (0.0, np.nan, 11.0):
        with pytest.raises(InputError, match="pace must be"):
            load().amplitudes(pace)
    with pytest.raises(InputError, match="impulse factor must be greater than 0"):
        Impulse(factor=0.0, pace_power=1.0, power=1.0)
    with pytest.raises(InputError, match="'a <guide>' gives 2 harmonics and no impulse; got 3"):
        load(impulse=None).amplitudes(2.0, 3)
