"""Solve vehicles on simply supported beams and plates by their sine modes and a general ODE solver.

Nothing of the project is used here: it is the other method, against which the project's elements,
contact solver and integrators are compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

G = 9.81


@dataclass(frozen=True, kw_only=True)
class Track:
    """The modes of a beam or plate as a vehicle along x sees them."""

    wave: np.ndarray  # m pi / L of each mode
    omega: np.ndarray
    modal_mass: float
    weight: np.ndarray  # the mode across the track, at the vehicle's line
    length: float

    def under(self, x):
        inside = ((x >= 0.0) & (x <= self.length))[:, None]
        angle = np.outer(x, self.wave)
        return (
            np.sin(angle) * self.weight * inside,
            np.cos(angle) * self.wave * self.weight * inside,
        )


def beam(*, length, rigidity, line_mass, n_modes):
    n = np.arange(1, n_modes + 1)
    wave = n * np.pi / length
    return Track(
        wave=wave, omega=wave**2 * np.sqrt(rigidity / line_mass),
        modal_mass=line_mass * length / 2, weight=np.ones(n_modes), length=length,
    )  # fmt: skip


def plate(*, length, width, rigidity, area_mass, n_x, n_y):
    """A plate whose vehicle drives along its centre line."""
    m, n = (a.ravel() for a in np.meshgrid(np.arange(1, n_x + 1), np.arange(1, n_y + 1, 2)))
    wave = m * np.pi / length
    omega = (wave**2 + (n * np.pi / width) ** 2) * np.sqrt(rigidity / area_mass)
    return Track(
        wave=wave, omega=omega, modal_mass=area_mass * length * width / 4,
        weight=np.sin(n * np.pi / 2), length=length,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Car:
    """Mass matrix, contact rows, springs, dampers, static forces and setbacks of a vehicle."""

    mass: np.ndarray
    rows: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    static: np.ndarray
    setback: np.ndarray


def one_mass(*, mass, stiffness, damping=0.0):
    return Car(
        mass=np.array([[mass]]), rows=np.ones((1, 1)), stiffness=np.array([stiffness]),
        damping=np.array([damping]), static=np.array([mass * G]), setback=np.zeros(1),
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Answer:
    time: np.ndarray
    displacement: np.ndarray  # at midspan, up positive
    velocity: np.ndarray
    acceleration: np.ndarray
    forces: np.ndarray


def solve(track, car, *, time, place, kinks=(), coupled=True, rtol=1e-8):
    """Integrate between kinks; `place(t)` gives the front wheel's x and its speed."""
    n, nv = len(track.omega), len(car.mass)
    inverse = np.linalg.inv(car.mass)

    def parts(t, y):
        q, qd = y[:n], y[n : 2 * n]
        z, zd = y[2 * n : 2 * n + nv], y[2 * n + nv :]
        x, speed = place(t)
        shape, slope = track.under(x - car.setback)
        on = (x - car.setback >= 0) & (x - car.setback <= track.length)
        if not coupled:
            return car.static * on, shape
        gap = car.rows @ z - shape @ q
        rate = car.rows @ zd - shape @ qd - speed * slope @ q
        return car.static - car.stiffness * gap - car.damping * rate, shape

    def right(t, y):
        forces, shape = parts(t, y)
        qdd = -(track.omega**2) * y[:n] - shape.T @ forces / track.modal_mass
        zdd = inverse @ car.rows.T @ (forces - car.static) if coupled else np.zeros(nv)
        return np.concatenate([y[n : 2 * n], qdd, y[2 * n + nv :], zdd])

    marks = np.unique(np.clip([time[0], *kinks, time[-1]], time[0], time[-1]))
    y = np.zeros(2 * (n + nv))
    states = np.zeros((len(time), len(y)))
    for start, end in pairwise(marks):
        inside = (time >= start) & (time <= end)
        wanted = np.unique(np.append(time[inside], end))
        solution = solve_ivp(
            right, (start, end), y, method="DOP853", rtol=rtol, atol=1e-14, t_eval=wanted
        )
        states[inside] = solution.y.T[: np.count_nonzero(inside)]
        y = solution.y[:, -1]
    middle = track.under(np.array([track.length / 2]))[0][0]
    acceleration = np.array([right(t, s)[n : 2 * n] for t, s in zip(time, states, strict=True)])
    return Answer(
        time=time, displacement=states[:, :n] @ middle, velocity=states[:, n : 2 * n] @ middle,
        acceleration=acceleration @ middle,
        forces=np.array([parts(t, s)[0] for t, s in zip(time, states, strict=True)]),
    )  # fmt: skip


def rigid_mass(track, *, mass, speed, n_samples=2001, convective=True):
    """A mass that never leaves the track: midspan displacement while it is on.

    Its acceleration is ``H q'' + 2 V H' q' + V^2 H'' q``; without the last two terms where
    `convective` is false.
    """
    n = len(track.omega)

    def right(t, y):
        q, qd = y[:n], y[n:]
        angle = track.wave * speed * t
        shape = np.sin(angle) * track.weight
        slope = np.cos(angle) * track.wave * track.weight
        carried = 0.0
        if convective:
            carried = 2 * speed * slope @ qd - speed**2 * (shape * track.wave**2) @ q
        matrix = np.eye(n) * track.modal_mass + mass * np.outer(shape, shape)
        load = -shape * mass * (G + carried) - track.modal_mass * track.omega**2 * q
        return np.concatenate([qd, np.linalg.solve(matrix, load)])

    end = track.length / speed
    time = np.linspace(0.0, end, n_samples)
    solution = solve_ivp(
        right, (0, end), np.zeros(2 * n), method="DOP853", rtol=1e-8, atol=1e-14, t_eval=time
    )
    middle = track.under(np.array([track.length / 2]))[0][0]
    return time, middle @ solution.y[:n]
