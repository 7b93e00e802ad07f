"""Lines of a spectrum as combinations of few of them, against the answers themselves."""

import numpy as np
import pytest

from trundle.dynamics import few_lines


def _velocity(f, lines, ratio):
    """Velocity of oscillators of unit mass by a unit force, ``i w / (w_m^2 - w^2 + 2 i z w_m w)``:
    closed form; and acceleration, i w times as much."""
    own, w = 2 * np.pi * f, 2 * np.pi * lines[:, None]
    velocity = 1j * w / (own**2 - w**2 + 2j * ratio * own * w)
    return np.array([velocity, 1j * w * velocity])


@pytest.mark.parametrize("band", [(12.0, 16.0), (30.0, 34.0), (80.0, 84.0)])
def test_every_mode_follows_from_few_lines(band):
    """Round-off of each mode's largest answer in the band, also of modes far from it."""
    modes, lines = np.geomspace(2.0, 120.0, 300), np.linspace(*band, 128)
    answers = _velocity(modes, lines, 0.03)
    picked, weights = few_lines(answers)
    told = weights @ answers[:, picked]
    off = np.abs(told - answers).max(axis=1) / np.abs(answers).max(axis=1)
    assert off.max() < 2e-11
    assert np.abs(weights).max() < 100.0  # nothing is the small difference of large numbers


def test_smoother_answers_need_fewer_lines():
    """Modes as wide as 6 % of their frequency: at 80 Hz a line tells of ten times as far as at 8,
    and of about as many, whatever the number of modes."""
    lines = np.linspace(0.0, 4.0, 128)
    low, high = (
        len(few_lines(_velocity(np.geomspace(2.0, 120.0, 300), first + lines, 0.03))[0])
        for first in (8.0, 80.0)
    )
    more = len(few_lines(_velocity(np.geomspace(2.0, 120.0, 900), 80.0 + lines, 0.03))[0])
    assert high < 0.6 * low
    assert more < 1.3 * high  # of three times the modes


def test_where_every_line_tells_something_new_none_is_left_out():
    """Modes of 0.1 % between lines 1 Hz apart: no line tells of another."""
    assert few_lines(_velocity(np.arange(3.0, 90.0, 0.25), np.arange(4.0, 80.0), 0.001)) is None


def test_what_does_not_move_has_no_lines():
    """Nothing answers: nothing is picked."""
    assert few_lines(np.zeros((2, 128, 7), dtype=complex)) is None
