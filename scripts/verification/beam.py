"""Solve vehicles on a simply supported Bernoulli-Euler beam by its sine modes.

With ``phi_n = sin(n pi x / L)``, modal mass ``m L / 2``, ``omega_n = (n pi / L)^2 sqrt(EI / m)``
and w up positive::

    q_n'' + omega_n^2 q_n = -(2 / m L) sum_j f_j phi_n(x_j)
    f_j = s_j - k_j (d_j - w_j - r_j) - c_j (d_j' - w_j' - v r_j')
    w_j' = sum_n phi_n q_n' + v phi_n' q_n

for wheels j at x_j on the beam, with static force s_j, vehicle motion d_j over it, road r. The
system of first order goes to DOP853, from one arrival, exit or kink to the next. L. Fryba,
Vibration of Solids and Structures under Moving Loads (1972), chapters 1, 6 and 8.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81


@dataclass(frozen=True, kw_only=True)
class Beam:
    """Length [m], bending stiffness [N m2], mass of a metre [kg/m], number of modes."""

    length: float
    rigidity: float
    line_mass: float
    n_modes: int

    @property
    def wave(self) -> np.ndarray:
        """Wave number of each mode [rad/m]."""
        return np.arange(1, self.n_modes + 1) * np.pi / self.length

    @property
    def omega(self) -> np.ndarray:
        """Angular frequency of each mode [rad/s]."""
        return self.wave**2 * np.sqrt(self.rigidity / self.line_mass)


@dataclass(frozen=True, kw_only=True)
class Car:
    """Bodies on wheels: ``mass z'' = rows^T (f - static)``, ``d = rows z``; setbacks [m]."""

    mass: np.ndarray
    rows: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    static: np.ndarray
    setback: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Histories:
    """Midspan motion, up positive, and contact forces, at the times asked for."""

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    forces: np.ndarray


def cross(
    beam: Beam,
    car: Car,
    *,
    time: np.ndarray,
    place: Callable[[float], tuple[float, float]],
    breaks: np.ndarray,
    road: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None,
    coupled: bool = True,
) -> Histories:
    """Integrate from rest; `place` gives the front wheel's x and speed, `road` height and slope."""
    n, b = beam.n_modes, len(car.mass)
    inverse = np.linalg.inv(car.mass)

    wave, square, per_mass = beam.wave, beam.omega**2, 2 / (beam.line_mass * beam.length)
    push = inverse @ car.rows.T

    def forces_of(t: float, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        front, speed = place(t)
        x = front - car.setback
        angle = x[:, None] * wave
        on = ((x >= 0.0) & (x <= beam.length))[:, None]
        shape = np.sin(angle) * on
        if not coupled:
            return car.static, shape
        slope = np.cos(angle) * (wave * on)
        gap = car.rows @ y[2 * n : 2 * n + b] - shape @ y[:n]
        rate = car.rows @ y[2 * n + b :] - shape @ y[n : 2 * n] - speed * (slope @ y[:n])
        if road:
            height, steep = road(x)
            gap, rate = gap - height, rate - speed * steep
        return car.static - car.stiffness * gap - car.damping * rate, shape

    def right(t: float, y: np.ndarray) -> np.ndarray:
        forces, shape = forces_of(t, y)
        out = np.empty_like(y)
        out[:n] = y[n : 2 * n]
        out[n : 2 * n] = -square * y[:n] - per_mass * (forces @ shape)
        out[2 * n : 2 * n + b] = y[2 * n + b :]
        out[2 * n + b :] = push @ (forces - car.static)
        return out

    states = _solve(right, np.zeros(2 * (n + b)), time, breaks)
    middle = np.sin(beam.wave * beam.length / 2)
    rates = np.array([right(t, y) for t, y in zip(time, states, strict=True)])
    return Histories(
        time=time, displacement=states[:, :n] @ middle, velocity=rates[:, :n] @ middle,
        acceleration=rates[:, n : 2 * n] @ middle,
        forces=np.array([forces_of(t, y)[0] for t, y in zip(time, states, strict=True)]),
    )  # fmt: skip


def _solve(
    right: Callable[[float, np.ndarray], np.ndarray],
    y: np.ndarray,
    time: np.ndarray,
    breaks: np.ndarray,
) -> np.ndarray:
    """Integrate piece by piece; a sample on a break takes the state, which does not jump."""
    inner = breaks[(breaks > time[0]) & (breaks < time[-1])]
    states = np.empty((len(time), len(y)))
    for start, end in pairwise(np.unique([time[0], *inner, time[-1]])):
        here = (time >= start) & (time <= end)
        wanted = np.unique(np.append(time[here], end))
        solved = solve_ivp(
            right, (start, end), y, method="DOP853", rtol=1e-8, atol=1e-14, t_eval=wanted
        )
        states[here] = solved.y.T[: np.count_nonzero(here)]
        y = solved.y[:, -1]
    return states


def largest(values: np.ndarray) -> float:
    """Return the largest value of even samples, by the parabola through it and its neighbours."""
    i = int(values.argmax())
    if i in {0, len(values) - 1}:
        return float(values[i])
    left, middle, right = values[i - 1 : i + 2]
    curvature = left - 2 * middle + right
    return float(middle - (left - right) ** 2 / (8 * curvature) if curvature else middle)
