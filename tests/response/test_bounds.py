"""Upper bounds and percentile ranks."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.response import percentile_rank, upper_bounds


def test_table_3_from_table_2():
    """The paper's absolute maxima: sums of accelerations; velocities near root sums of squares."""
    decoupled_b = upper_bounds([0.040, 0.32, 0.070, 1.93])
    assert decoupled_b.absolute_sum == pytest.approx(2.36, abs=0.005)
    velocity_b = upper_bounds([3.43, 20.3, 4.46, 108.79])
    assert velocity_b.root_sum_square == pytest.approx(111.0, rel=0.005)
    assert velocity_b.largest == 108.79
    velocity_c = upper_bounds([3.8, 22.2, 5.21, 138.33])
    assert velocity_c.root_sum_square == pytest.approx(140.0, rel=0.005)


def test_no_sum_of_signals_exceeds_the_absolute_sum():
    rng = np.random.default_rng(1)
    signals = rng.standard_normal((4, 1000))
    bound = upper_bounds(np.abs(signals).max(axis=1)).absolute_sum
    assert np.abs(signals.sum(axis=0)).max() <= bound


def test_percentile_rank():
    samples = np.arange(1.0, 11.0)
    assert percentile_rank(0.0, samples) == 0.0
    assert percentile_rank(99.0, samples) == 100.0
    assert percentile_rank(5.5, samples) == 50.0
    assert percentile_rank(5.0, samples) == 45.0


@pytest.mark.parametrize("of", [upper_bounds, lambda none: percentile_rank(1.0, none)])
def test_nothing_has_no_bound_and_no_rank(of):
    with pytest.raises(InputError, match="at least one"):
        of([])
