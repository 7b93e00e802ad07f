"""V6: standard deviation of an ISO 8608 road between two spatial frequencies.

``Gd(n) = Gd(n0) (n / n0)^-2`` with ``n0 = 0.1`` cycle/m and, for class A, B, C, the geometric means
``Gd(n0) = 16, 64, 256e-6 m3`` (ISO 8608:2016, table C.1); its integral from n1 to n2 is
``n0^2 Gd(n0) (1/n1 - 1/n2)``. The integral is taken numerically here, in log n.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad

from verification.value import Value

ROUGHNESS = {"A": 16e-6, "B": 64e-6, "C": 256e-6}
PRINTED = {
    ("A", 0.01, 10.0): "3.998", ("B", 0.01, 10.0): "7.996", ("C", 0.01, 10.0): "15.992",
    ("A", 0.011, 2.83): "3.806", ("B", 0.011, 2.83): "7.613",
}  # fmt: skip


def sigma(name: str, n_min: float, n_max: float) -> float:
    """Return the standard deviation of the elevation [m]."""
    power, _ = quad(
        lambda x: ROUGHNESS[name] * (np.exp(x) / 0.1) ** -2 * np.exp(x), np.log(n_min),
        np.log(n_max), epsrel=1e-10,
    )  # fmt: skip
    return float(np.sqrt(power))


def values() -> list[Value]:
    """Return the case's values."""
    return [
        Value(case="V6", quantity=f"sigma, class {name}, {low:g} to {high:g} cycle/m",
              printed=printed, computed=1e3 * sigma(name, low, high), unit="mm")
        for (name, low, high), printed in PRINTED.items()
    ]  # fmt: skip
