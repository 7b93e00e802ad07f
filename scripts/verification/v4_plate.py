"""V4: a constant force along the centre line of a simply supported Kirchhoff plate.

Navier's double series, S. Timoshenko and S. Woinowsky-Krieger, Theory of Plates and Shells (1959),
chapter 5. With ``D = E h^3 / 12 (1 - nu^2)`` and
``omega_mn^2 = (D / rho h) pi^4 (m^2/a^2 + n^2/b^2)^2``, undamped, modal
mass ``rho h a b / 4``, force P at x = v t, y = b/2::

    q_mn = (4 P sin(n pi / 2) / rho h a b) (sin Omega_m t - (Omega_m / omega) sin omega t)
           / (omega^2 - Omega_m^2),   Omega_m = m pi v / a

Only odd n count; the centre sees odd m. N_TERMS half waves each way;
the largest of 4001 even samples over the crossing, and its time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from verification.value import Value

FORCE, MODULUS, POISSON, DENSITY = 100e3, 30e9, 0.2, 2500.0
N_TERMS = 41


@dataclass(frozen=True, kw_only=True)
class Plate:
    """A plate of the list [m], the force's speed [km/h] and what the list prints."""

    length: float
    width: float
    thickness: float
    kmh: float
    frequencies: tuple[tuple[int, int, str], ...]
    static: str
    largest: str
    when: str

    def omega(self, m: np.ndarray | int, n: np.ndarray | int) -> np.ndarray:
        """Return angular frequencies of modes with m and n half waves [rad/s]."""
        rigidity = MODULUS * self.thickness**3 / 12 / (1 - POISSON**2)
        waves = (np.asarray(m) / self.length) ** 2 + (np.asarray(n) / self.width) ** 2
        return np.pi**2 * waves * np.sqrt(rigidity / (DENSITY * self.thickness))

    @property
    def modal_mass(self) -> float:
        """Modal mass of every mode [kg]."""
        return DENSITY * self.thickness * self.length * self.width / 4


PLATES = {
    "8.5 x 8.5 x 0.20 m": Plate(
        length=8.5, width=8.5, thickness=0.20, kmh=15.0,
        frequencies=((1, 1, "8.8758"), (1, 2, "22.189"), (2, 1, "22.189"), (2, 2, "35.503")),
        static="4.021875", largest="4.107391", when="0.99093",
    ),
    "20 x 10 x 0.30 m": Plate(
        length=20.0, width=10.0, thickness=0.30, kmh=40.0,
        frequencies=((1, 1, "6.0120"), (2, 1, "9.6191"), (3, 1, "15.6311")),
        static="2.348647", largest="2.378245", when="0.93735",
    ),
}  # fmt: skip


def centre(plate: Plate, n_terms: int) -> tuple[float, float, float]:
    """Return static deflection, largest deflection [mm] and its time [s] at the centre."""
    odd = np.arange(1, n_terms + 1, 2)
    m, n = (k.ravel() for k in np.meshgrid(odd, odd))
    w = plate.omega(m, n)
    weight = np.sin(m * np.pi / 2) * np.sin(n * np.pi / 2) ** 2 * FORCE / plate.modal_mass
    static = np.sum(np.sin(m * np.pi / 2) * weight / w**2)
    speed = plate.kmh / 3.6
    t = np.linspace(0.0, plate.length / speed, 4001)
    u = np.zeros_like(t)
    for mode_weight, natural, passing in zip(
        weight, w, m * np.pi * speed / plate.length, strict=True
    ):
        forced = np.sin(passing * t) - passing / natural * np.sin(natural * t)
        u += mode_weight / (natural**2 - passing**2) * forced
    return 1e3 * static, 1e3 * u.max(), t[u.argmax()]


def values() -> list[Value]:
    """Return the case's values."""
    found = []
    for name, plate in PLATES.items():
        found += [
            Value(case="V4", quantity=f"{name}, mode {m},{n}", printed=printed, unit="Hz",
                  computed=float(plate.omega(m, n)) / (2 * np.pi))
            for m, n, printed in plate.frequencies
        ]  # fmt: skip
        static, largest, when = centre(plate, N_TERMS)
        for quantity, printed, computed, unit in (
            ("static", plate.static, static, "mm"),
            ("largest", plate.largest, largest, "mm"),
            ("time of the largest", plate.when, when, "s"),
        ):
            found.append(
                Value(case="V4", quantity=f"{name}, {quantity}", printed=printed,
                      computed=computed, unit=unit)
            )  # fmt: skip
    return found
