"""Units that would hang a parser, or mean several things, are refused at once."""

import subprocess
import sys

import pytest

from trundle.errors import InputError
from trundle.units import to_si

TOWERS = (
    "m**9**9**9",
    "m^9^9^9",
    "m**99999999",
    "m**(9**9**9)",
    "9**9**9",
    "s**-9**9**9",
    "m/9**9**9",
)


def test_powers_of_powers_are_not_worked_out():
    """In a process of its own, which has ten seconds: 9^(9^9) has 369 million digits."""
    code = (
        "from trundle.units import to_si, motion_scale\n"
        "from trundle.errors import InputError\n"
        f"for unit in {TOWERS}:\n"
        "    for read in (lambda: to_si('1 ' + unit, 'length'), lambda: motion_scale(unit),\n"
        "                 lambda: motion_scale('V', unit)):\n"
        "        try:\n            read()\n"
        "        except InputError:\n            continue\n"
        "        raise SystemExit(unit)\n"
    )  # fmt: skip
    subprocess.run([sys.executable, "-c", code], check=True, timeout=10)


@pytest.mark.parametrize("unit", ["ton", "tons"])
def test_a_ton_is_asked_back(unit):
    with pytest.raises(InputError, match="by country; write 't' for 1000 kg"):
        to_si(f"3 {unit}", "mass")
    assert to_si("3 t", "mass") == pytest.approx(3000.0)
