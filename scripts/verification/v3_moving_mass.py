"""V3: a mass that never leaves a simply supported beam, L = EI = m = 1, 15 modes.

The mass at x = v t shares the beam's motion, ``d2w(vt, t)/dt2 = w_tt + 2 v w_xt + v^2 w_xx``; so, u
downwards, with mass ratio M, ``phi_n = sin(n pi v t)`` and modal mass 1/2::

    (q_n'' + omega_n^2 q_n) / 2
        = phi_n M (g - sum_k phi_k q_k'' + 2 v phi_k' q_k' + v^2 phi_k'' q_k)

The last two terms are Coriolis' and the centrifugal; the list prints in brackets what comes out
without them. L. Fryba (1972), chapter 8. DAF over the static ``M g / 48``.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from verification.beam import largest
from verification.value import Value

FACTORS = {
    (0.1, 0.1): ("1.0759", "1.0842"), (0.1, 0.25): ("1.2872", "1.3038"),
    (0.1, 0.5): ("1.7629", "1.7540"), (0.1, 0.75): ("1.8035", "1.7136"),
    (0.5, 0.1): ("1.0722", "1.0998"), (0.5, 0.25): ("1.4179", "1.4739"),
    (0.5, 0.5): ("2.0221", "1.8844"), (0.5, 0.75): ("2.2310", "1.7539"),
}  # fmt: skip
WAVE = np.pi * np.arange(1, 16)


def factor(ratio: float, alpha: float, *, convective: bool) -> float:
    """Return the largest midspan deflection over the static one, in units with g = 1."""
    v, n = np.pi * alpha, len(WAVE)

    def right(t: float, y: np.ndarray) -> np.ndarray:
        q, qd = y[:n], y[n:]
        phi, slope = np.sin(WAVE * v * t), WAVE * np.cos(WAVE * v * t)
        load = 1.0
        if convective:
            load += v**2 * (WAVE**2 * phi) @ q - 2 * v * slope @ qd
        matrix = 0.5 * np.eye(n) + ratio * np.outer(phi, phi)
        qdd = np.linalg.solve(matrix, ratio * load * phi - 0.5 * WAVE**4 * q)
        return np.concatenate([qd, qdd])

    time = np.linspace(0.0, 1.0 / v, 4001)
    solved = solve_ivp(
        right, (0.0, time[-1]), np.zeros(2 * n), method="DOP853", rtol=1e-8, atol=1e-12,
        t_eval=time,
    )  # fmt: skip
    return largest(np.sin(WAVE / 2) @ solved.y[:n]) * 48 / ratio


def values() -> list[Value]:
    """Return the case's values."""
    return [
        Value(
            case="V3", printed=printed, computed=factor(ratio, alpha, convective=convective),
            quantity=f"DAF, mass ratio {ratio:g}, alpha = {alpha:g}"
            + ("" if convective else ", without convective terms"),
        )
        for (ratio, alpha), pair in FACTORS.items()
        for printed, convective in zip(pair, (True, False), strict=True)
    ]  # fmt: skip
