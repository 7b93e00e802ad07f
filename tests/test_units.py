"""Units of measured motion, by the definitions of the units."""

import pytest

from trundle.errors import InputError
from trundle.units import motion_scale


@pytest.mark.parametrize(
    ("unit", "sensitivity", "expected"),
    [
        ("mm/s2", "", (1e-3, "acceleration")),
        ("um/s", "", (1e-6, "velocity")),
        ("gal", "", (1e-2, "acceleration")),
        ("g", "", (9.80665, "acceleration")),
        ("20 m/s2", "", (20.0, "acceleration")),
        ("mV", "1000 mV/g", (9.80665e-3, "acceleration")),
        ("V", "10 V/(m/s2)", (0.1, "acceleration")),
        ("V", "28.8 V s/m", (1 / 28.8, "velocity")),
    ],
)
def test_samples_become_motion(unit, sensitivity, expected):
    """g = 9.80665 m/s2 and 1 gal = 0.01 m/s2 by definition; volts over volts a unit of motion."""
    scale, quantity = motion_scale(unit, sensitivity)
    assert scale == pytest.approx(expected[0], rel=1e-9)
    assert quantity == expected[1]


@pytest.mark.parametrize(
    ("unit", "sensitivity"), [("V", ""), ("kg", ""), ("mm/s2; rm", ""), ("V", "mV/K"), ("__", "")]
)
def test_what_is_no_motion_is_refused(unit, sensitivity):
    with pytest.raises(InputError):
        motion_scale(unit, sensitivity)
