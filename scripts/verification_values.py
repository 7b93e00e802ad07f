"""Recompute the verification list's values without trundle, and print them beside the list's.

Usage: python scripts/verification_values.py [CASE ...]

Exit code 1 where a value differs by more than the rounding of its last digit.
"""

from __future__ import annotations

import sys
from collections.abc import Callable

from verification import (
    v1_moving_force,
    v2_sprung_mass,
    v3_moving_mass,
    v4_plate,
    v5_container_truck,
    v6_road,
    v7_one_axle,
    v8_bands,
)
from verification.value import Value

CASES: dict[str, Callable[[], list[Value]]] = {
    "V1": v1_moving_force.values,
    "V2": v2_sprung_mass.values,
    "V3": v3_moving_mass.values,
    "V4": v4_plate.values,
    "V5": v5_container_truck.values,
    "V6": v6_road.values,
    "V7": v7_one_axle.values,
    "V8": v8_bands.values,
}


def main(names: list[str]) -> int:
    """Print the cases named, or all."""
    unknown = sorted(set(names) - set(CASES))
    if unknown:
        print(f"no case {', '.join(unknown)}; the cases are {', '.join(CASES)}")
        return 2
    all_agree = True
    for name in names or CASES:
        for value in CASES[name]():
            print(line(value))
            all_agree &= value.agrees
    return 0 if all_agree else 1


def line(value: Value) -> str:
    """Return one line of the table."""
    mark = "" if value.agrees else "  DIFFERS"
    note = f"  ({value.note})" if value.note else ""
    return (
        f"{value.case:3} {value.quantity:52} {value.printed:>10} {value.computed:13.6f} "
        f"{value.unit:5} {value.difference:+.2e} of {value.allowed:.0e}{mark}{note}"
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
