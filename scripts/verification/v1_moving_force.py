"""V1: a constant force moving over a simply supported beam.

L. Fryba, Vibration of Solids and Structures under Moving Loads (1972), 1.3, undamped. For a unit
beam (L = EI = m = P = 1), ``alpha = v / v_cr`` with ``v_cr = pi``, ``omega_n = (n pi)^2`` and
``Omega_n = n pi v``::

    q_n = 2 / (omega_n^2 - Omega_n^2) (sin Omega_n t - (Omega_n / omega_n) sin omega_n t)
    q_n = (sin omega_n t - omega_n t cos omega_n t) / omega_n^2      where they are equal

``u(L/2) = sum over n = 1, 3 ... 41 of sin(n pi / 2) q_n``, over the static 1/48. After the exit
each mode goes on freely; frequencies are whole multiples of the first, so one of its periods is
all.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from verification.beam import largest
from verification.value import Value

FACTORS = {
    "0.05": "1.04825", "0.20": "1.06527", "0.25": "1.25761", "0.40": "1.61289", "0.50": "1.70545",
    "0.70": "1.72040", "0.80": "1.67617", "1.00": "1.54807", "1.50": "1.02383", "2.00": "0.67097",
}  # fmt: skip
LARGEST = ("0.61704", "1.73167")
AFTER_THE_EXIT = {"0.2": "0", "0.5": "1.31015", "1.0": "1.54807", "2.0": "0.94890"}
ORDERS = np.arange(1, 42, 2)
SIGNS = np.sin(ORDERS * np.pi / 2)
NATURAL = (ORDERS * np.pi) ** 2


def modes(alpha: float, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return each mode's displacement and velocity while the force is on."""
    passing = ORDERS * np.pi**2 * alpha
    w, p, t = NATURAL[:, None], passing[:, None], np.asarray(t)[None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        q = 2 / (w**2 - p**2) * (np.sin(p * t) - p / w * np.sin(w * t))
        qd = 2 * p / (w**2 - p**2) * (np.cos(p * t) - np.cos(w * t))
    equal = np.isclose(w, p)
    q = np.where(equal, (np.sin(w * t) - w * t * np.cos(w * t)) / w**2, q)
    return q, np.where(equal, t * np.sin(w * t), qd)


def factor(alpha: float, *, n_samples: int = 20001) -> float:
    """Return the largest midspan deflection over the static one while the force is on."""
    t = np.linspace(0.0, 1.0 / (np.pi * alpha), n_samples)
    return 48 * largest(SIGNS @ modes(alpha, t)[0])


def factor_after(alpha: float) -> float:
    """Return the peak of the free vibration over the static deflection."""
    q, qd = modes(alpha, np.array([1.0 / (np.pi * alpha)]))
    s = np.linspace(0.0, 2 / np.pi, 40001)[None, :]
    w = NATURAL[:, None]
    free = SIGNS @ (q * np.cos(w * s) + qd / w * np.sin(w * s))
    return 48 * largest(np.abs(free))


def values() -> list[Value]:
    """Return the case's values."""
    found = [
        Value(case="V1", quantity=f"DAF at alpha = {a}", printed=p, computed=factor(float(a)))
        for a, p in FACTORS.items()
    ]
    best = minimize_scalar(
        lambda a: -factor(a), bounds=(0.55, 0.68), method="bounded", options={"xatol": 1e-7}
    )
    found += [
        Value(case="V1", quantity="alpha of the largest DAF", printed=LARGEST[0], computed=best.x,
              tolerance=2e-5, note="the top is flat"),
        Value(case="V1", quantity="largest DAF", printed=LARGEST[1], computed=-best.fun),
    ]  # fmt: skip
    return found + [
        Value(case="V1", quantity=f"peak after the exit, alpha = {a}", printed=p,
              computed=factor_after(float(a)), tolerance=None if float(p) else 1e-9)
        for a, p in AFTER_THE_EXIT.items()
    ]  # fmt: skip
