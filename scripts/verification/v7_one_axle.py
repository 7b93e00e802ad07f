"""V7: one axle on a random road.

Under a wheel at V the road's velocity is white with the one-sided density ``(2 pi n0)^2 Gd(n0) V``;
the spring's deflection d of ``d'' + 2 zeta omega0 d' + omega0^2 d = -y''`` then has the variance
``pi^2 Gd(n0) n0^2 V / (2 zeta omega0)`` (S. H. Crandall, W. D. Mark, Random Vibration in Mechanical
Systems, 1963, 2.2). The integral over frequency of the density times
``|omega / (omega0^2 - omega^2 + 2 i zeta omega0 omega)|^2`` is taken numerically beside it.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad

from verification.v6_road import ROUGHNESS
from verification.value import Value

MASS, STIFFNESS, RATIO = 5390.0, 1.306667e6, 0.1
PRINTED = {("A", 15): "1.4536", ("A", 30): "2.0557", ("B", 15): "2.9072"}
FORCE = ("B", 15, "3.799")


def closed_form(name: str, kmh: float) -> float:
    """Return the standard deviation of the deflection by the formula [m]."""
    omega0 = np.sqrt(STIFFNESS / MASS)
    variance = np.pi**2 * ROUGHNESS[name] * 0.1**2 * kmh / 3.6 / (2 * RATIO * omega0)
    return float(np.sqrt(variance))


def integral(name: str, kmh: float) -> float:
    """Return the same by integration over frequency [m]."""
    omega0 = np.sqrt(STIFFNESS / MASS)
    white = (2 * np.pi * 0.1) ** 2 * ROUGHNESS[name] * kmh / 3.6

    def density(r: float) -> float:
        return white * r**2 / ((1 - r * r) ** 2 + (2 * RATIO * r) ** 2)

    # r from 1 to infinity goes over to 1 / r, where the integrand has the same form
    total = quad(density, 0, 1, epsrel=1e-11)[0]
    total += quad(lambda s: density(1 / s) / s**2, 0, 1, epsrel=1e-11)[0]
    return float(np.sqrt(total / (2 * np.pi * omega0)))


def values() -> list[Value]:
    """Return the case's values."""
    found = []
    for (name, kmh), printed in PRINTED.items():
        for way, compute in (("formula", closed_form), ("integral", integral)):
            quantity = f"sigma of the spring, class {name}, {kmh} km/h, {way}"
            found.append(
                Value(case="V7", quantity=quantity, printed=printed, unit="mm",
                      computed=1e3 * compute(name, kmh))
            )  # fmt: skip
    name, kmh, printed = FORCE
    found.append(
        Value(case="V7", quantity=f"RMS spring force, class {name}, {kmh} km/h", printed=printed,
              computed=STIFFNESS * integral(name, kmh) / 1e3, unit="kN")
    )  # fmt: skip
    return found
