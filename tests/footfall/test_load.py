"""Load factors against the guides' tables, and impulses against their formulas."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.footfall import FOOTFALLS, footfall_load

# pace, then alpha_h as the tables' formulas give them by hand
TABLES = {
    "p354": [
        (1.8, [0.436 * 0.85, 0.006 * 15.9, 0.007 * 10.6, 0.007 * 9.2]),
        (2.2, [0.436 * 1.25, 0.006 * 16.7, 0.007 * 11.8, 0.007 * 10.8]),
    ],
    "ccip-016": [
        (1.5, [0.41 * 0.55, 0.069 + 0.0168, 0.033 + 0.0288, 0.013 + 0.039]),
        (2.8, [0.56, 0.069 + 0.03136, 0.033 + 0.05376, 0.013 + 0.0728]),
    ],
    "dg11": [(1.6, [0.5, 0.2, 0.1, 0.05]), (2.2, [0.5, 0.2, 0.1, 0.05])],
    "iso-10137": [(1.2, [0.074, 0.1, 0.06, 0.06, 0.06]), (2.4, [0.518, 0.1, 0.06, 0.06, 0.06])],
}


def test_every_load_function_has_a_table_here():
    """A further file needs its values checked."""
    assert set(TABLES) == set(FOOTFALLS)


@pytest.mark.parametrize(
    ("name", "pace", "factors"),
    [(name, *row) for name, rows in TABLES.items() for row in rows],
)
def test_factors_are_those_of_the_table(name, pace, factors):
    """Amplitude over weight is the printed factor."""
    load = footfall_load(name)
    np.testing.assert_allclose(load.amplitudes(pace) / load.weight, factors, rtol=1e-9)


def test_the_phases_of_p354_are_those_of_a_sine():
    """The guide prints ``sin(2 pi h f t + phi)`` with 0, -pi/2, pi, pi/2."""
    cosine, sine = footfall_load("p354").phases(), np.array([0.0, -0.5, 1.0, 0.5]) * np.pi
    t = np.linspace(0.0, 1.0, 7)[:, None]
    np.testing.assert_allclose(np.cos(t + cosine), np.sin(t + sine), atol=1e-12)


def test_beyond_its_range_a_harmonic_is_held():
    """A pace that a guide does not know takes the factor at the nearest end."""
    load = footfall_load("p354")
    np.testing.assert_allclose(load.amplitudes(1.2), load.amplitudes(1.8), rtol=1e-12)


def test_a_series_of_steps_gives_a_mode_the_effective_impulse():
    """One step of the continued series has the impulse of the guide at every frequency.

    The Fourier integral over one period of the series at one of its harmonics is the transform of
    the step there: 54 f_p^1.43 / f^1.3 at 20 Hz and 2 steps a second.
    """
    load, pace = footfall_load("ccip-016"), 2.0
    n = 44
    t = np.arange(0.0, 1.0 / pace, 1e-4)
    h = np.arange(1, n + 1)
    force = np.cos(2 * np.pi * pace * t[:, None] * h) @ load.amplitudes(pace, n)
    transform = abs(np.sum(force * np.exp(-2j * np.pi * 20.0 * t)) * 1e-4)
    assert transform == pytest.approx(54.0 * 2.0**1.43 / 20.0**1.3, rel=1e-9)


def test_impulses_are_those_of_the_guides():
    """P354 prints 60 N s for 700 N; DG11 ``f^1.43 / f_n^1.3 Q / 17.8`` in pounds."""
    at = (2.0, 16.0)
    shape = 2.0**1.43 / 16.0**1.3
    p354, dg11 = footfall_load("p354").impulse, footfall_load("dg11").impulse
    assert p354.size(*at) == pytest.approx(60.0 * shape * 746.0 / 700.0, rel=1e-9)
    assert dg11.size(*at) == pytest.approx(shape * 168.0 / 17.8 * 4.4482216, rel=1e-5)


def test_walking_speed_follows_the_guide():
    """P354: 1.67 f^2 - 4.83 f + 4.5; elsewhere three quarters of a metre a step."""
    assert footfall_load("p354").walking_speed(2.0) == pytest.approx(1.52)
    assert footfall_load("dg11").walking_speed(2.0) == pytest.approx(1.5)


def test_what_no_guide_gives_is_refused():
    """ISO 10137 has five harmonics and no impulse; nobody walks at 20 Hz."""
    with pytest.raises(InputError, match="gives 5 harmonics"):
        footfall_load("iso-10137").amplitudes(2.0, 9)
    with pytest.raises(InputError, match="pace"):
        footfall_load("p354").amplitudes(20.0)
    with pytest.raises(InputError, match="did you mean 'p354'"):
        footfall_load("p345")
