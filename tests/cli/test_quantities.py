"""Quantities of options are in SI, and a mistake is told with its option."""

import pytest

from trundle.cli.quantities import quantity_of
from trundle.errors import InputError


def test_a_quantity_is_in_si():
    """By definition: 36 km/h are 10 m/s, 0.4 Hz are 0.4 Hz."""
    assert quantity_of("--speed", "36 km/h", "speed") == pytest.approx(10.0, rel=1e-12)
    assert quantity_of("--high-pass", "0.4 Hz", "frequency") == 0.4


@pytest.mark.parametrize("text", ["0.4", "0.4 kg", "fast", "", "nan Hz", "inf Hz"])
def test_a_mistake_is_told_with_option_and_text(text):
    """Several options of a command may lack a unit: which of them does is said."""
    with pytest.raises(InputError) as told:
        quantity_of("--high-pass", text, "frequency")
    assert str(told.value).startswith(f"--high-pass {text!r}: ")
