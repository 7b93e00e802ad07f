"""Intervals that few runs leave open are said in words, never as infinite numbers."""

import numpy as np
import pytest

from trundle.response import percentile_interval
from trundle.views.tables import ExactRow


@pytest.mark.parametrize(
    ("n", "words"), [(1, "too few runs for limits"), (10, "above"), (200, "-")]
)
def test_open_intervals_are_words(n, words):
    """The 95 % level has an upper limit from 72 runs on: 0.95^72 is below 2.5 %."""
    interval = percentile_interval(np.linspace(1.0, 2.0, n), 95.0)
    assert np.isfinite(interval[1]) == (n >= 72)
    row = ExactRow(
        case="c", road="B", method="m", point="p", rms=1.0, sampled_rms=1.0, peak=(1.0, 1.0),
        sampled_peak=(1.0, 1.0), interval=interval, quadrature_error=0.0,
    )  # fmt: skip
    assert words in row.between
    assert "inf" not in row.between
