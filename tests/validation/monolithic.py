"""Integrate modes and vehicle as one system, and find the modes, without the project's solvers.

From the project come the floor's mass and stiffness, where its nodes and dofs stand, and the
vehicle's numbers. The modes are found by shift and invert, slice by slice, each slice counted by
inertia; the deck under a wheel is interpolated by Hermite's cubics on a grid of rectangles;
everything that moves stands in one state, which Runge and Kutta's method of order four steps
without splitting it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh, splu

UZ, RX, RY = 2, 3, 4


@dataclass(frozen=True, kw_only=True)
class Basis:
    """Natural modes of unit modal mass, as columns."""

    omega: np.ndarray
    shapes: np.ndarray


def modes_below(mass, stiffness, f_max, *, slice_size=120):
    """Return all modes below a frequency, by slices that Sylvester's count closes."""
    M, K = sparse.csc_matrix(mass), sparse.csc_matrix(stiffness)
    squares, shapes = [], []
    for (low, n_low), (high, n_high) in pairwise(_slices(M, K, f_max, slice_size)):
        n_wanted = n_high - n_low
        # the shift is not in the middle of its slice's values, so some more are asked for
        for asked in (n_wanted + n_wanted // 8 + 8, 2 * n_wanted + 8):
            found, vectors = eigsh(K, k=asked, M=M, sigma=0.5 * (low + high))
            inside = (found > low) & (found <= high)
            if np.count_nonzero(inside) == n_wanted:
                break
        else:
            raise AssertionError(f"{np.count_nonzero(inside)} of {n_wanted} modes of a slice")
        squares.append(found[inside])
        shapes.append(vectors[:, inside])
    square, shape = np.concatenate(squares), np.hstack(shapes)
    rising = np.argsort(square)
    return Basis(omega=np.sqrt(square[rising]), shapes=shape[:, rising])


def _slices(M, K, f_max, size):
    """Halve the range until no slice holds more than so many modes: [(omega^2, modes below)]."""
    top = (2 * np.pi * f_max) ** 2

    def split(low, n_low, high, n_high):
        if n_high - n_low <= size:
            return [(high, n_high)] if n_high > n_low else []
        # in omega the modes of a floor are about even
        middle = (0.5 * (np.sqrt(low) + np.sqrt(high))) ** 2
        n_middle = _modes_below(M, K, middle)
        return [*split(low, n_low, middle, n_middle), *split(middle, n_middle, high, n_high)]

    return [(0.0, 0), *split(0.0, 0, top, _modes_below(M, K, top))]


def _modes_below(M, K, square):
    factor = splu(
        sparse.csc_matrix(K - square * M), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )  # fmt: skip
    return int(np.count_nonzero(factor.U.diagonal() < 0.0))


def _hermite(t):
    """Return value functions and slope functions of both ends, t from 0 to 1; and their slopes."""
    value = np.stack([1 - 3 * t**2 + 2 * t**3, 3 * t**2 - 2 * t**3], axis=-1)
    slope = np.stack([t - 2 * t**2 + t**3, t**3 - t**2], axis=-1)
    d_value = np.stack([6 * t**2 - 6 * t, 6 * t - 6 * t**2], axis=-1)
    d_slope = np.stack([1 - 4 * t + 3 * t**2, 3 * t**2 - 2 * t], axis=-1)
    return value, slope, d_value, d_slope


class Deck:
    """The deck's grid lines and, at each crossing, the dofs of its node."""

    def __init__(self, floor, *, z=0.0):
        on = np.flatnonzero(np.abs(floor.nodes[:, 2] - z) < 1e-9)
        self.x = np.unique(floor.nodes[on, 0].round(9))
        self.y = np.unique(floor.nodes[on, 1].round(9))
        if len(on) != len(self.x) * len(self.y):
            raise AssertionError("the deck is no full grid")
        i = np.searchsorted(self.x, floor.nodes[on, 0].round(9))
        j = np.searchsorted(self.y, floor.nodes[on, 1].round(9))
        self.dofs = np.empty((len(self.x), len(self.y), 3), dtype=int)
        self.dofs[i, j] = floor.dof_index[on][:, [UZ, RX, RY]]

    def line(self, shapes, y):
        """Return deflection and slope dw/dx on every grid line in x, along a line of equal y.

        Between two nodes along y deflection is the Hermite cubic of w and dw/dy = rx, and
        dw/dx = -ry goes over with the same value functions. Shapes (n_lines, n_modes) each.
        """
        cell = int(np.clip(np.searchsorted(self.y, y, "right") - 1, 0, len(self.y) - 2))
        size = self.y[cell + 1] - self.y[cell]
        value, slope, _, _ = _hermite(np.float64((y - self.y[cell]) / size))
        deflection = np.zeros((len(self.x), shapes.shape[1]))
        gradient = np.zeros_like(deflection)
        for end in range(2):
            w, rx, ry = (self._of(shapes, cell + end, k) for k in range(3))
            deflection += value[end] * w + slope[end] * size * rx
            gradient -= value[end] * ry
        return deflection, gradient

    def _of(self, shapes, j, k):
        dofs = self.dofs[:, j, k]
        return np.where((dofs >= 0)[:, None], shapes[np.maximum(dofs, 0)], 0.0)

    def along(self, x):
        """Return matrices that take `line`'s two arrays, stacked, to w and dw/dx at places x."""
        cell = np.clip(np.searchsorted(self.x, x, "right") - 1, 0, len(self.x) - 2)
        size = self.x[cell + 1] - self.x[cell]
        value, slope, d_value, d_slope = _hermite(np.clip((x - self.x[cell]) / size, 0.0, 1.0))
        size = size[:, None]
        n = len(self.x)
        columns = np.column_stack([cell, cell + 1, n + cell, n + cell + 1])
        rows = np.repeat(np.arange(len(x)), 4)
        return tuple(
            sparse.csr_array((w.ravel(), (rows, columns.ravel())), shape=(len(x), 2 * n))
            for w in (np.hstack([value, slope * size]), np.hstack([d_value / size, d_slope]))
        )

    def at(self, shapes, x, y):
        """Return the modes' deflection at one place, shape (n_modes,)."""
        to_value, _ = self.along(np.array([x]))
        return (to_value @ np.vstack(self.line(shapes, y)))[0]


@dataclass(frozen=True, kw_only=True)
class Drive:
    """A vehicle along x at constant speed, on a road, onto a floor that takes its share.

    `road(s)` gives elevation and slope, `share(s)` the floor's share of the force and its slope;
    s is the distance from the floor's edge, where the front axle stands at time 0, at rest.
    """

    vehicle: object
    speed: float
    y: float
    road: Callable
    share: Callable
    coupled: bool = True


@dataclass(frozen=True, kw_only=True)
class Motion:
    time: np.ndarray
    displacement: np.ndarray  # (n_steps, n_points)
    velocity: np.ndarray
    acceleration: np.ndarray
    forces: np.ndarray  # (n_steps, n_contacts)


class OneSystem:
    """``x' = A(t) x + b(t)`` with x = (q, q', z, z')."""

    def __init__(self, deck, basis, drive, *, damping_ratio):
        self.deck, self.drive, self.omega = deck, drive, basis.omega
        self.lines = np.vstack(deck.line(basis.shapes, drive.y))
        self.double = 2.0 * damping_ratio * basis.omega
        vehicle = drive.vehicle
        self.k, self.c = vehicle.contact_stiffness, vehicle.contact_damping
        self.map, self.static = vehicle.contact_map, vehicle.static_forces
        mass = np.asarray(vehicle.system.mass)
        # the body's own springs and dampers: those to the ground are in the contact forces
        own_k = vehicle.system.stiffness - self.map.T @ np.diag(self.k) @ self.map
        own_c = vehicle.system.damping - self.map.T @ np.diag(self.c) @ self.map
        inverse = np.linalg.inv(mass)
        self.inner = -inverse @ np.hstack([own_k, own_c])
        self.push = inverse @ self.map.T
        self.n, self.nv = len(self.omega), len(mass)

    def ground(self, time):
        """Return rows and their rates under the wheels, road and its rate, at several times."""
        s = self.drive.speed * time[:, None] - self.drive.vehicle.setback
        share, share_slope = self.drive.share(s)
        height, slope = self.drive.road(s)
        to_value, to_slope = self.deck.along(s.ravel())
        shape = (*s.shape, self.n)
        value = (to_value @ self.lines).reshape(shape)
        along = (to_slope @ self.lines).reshape(shape)
        rate = share_slope[:, :, None] * value + share[:, :, None] * along
        return share[:, :, None] * value, self.drive.speed * rate, height, self.drive.speed * slope

    def right(self, x, rows, row_rates, height, height_rate):
        """Return x' and the contact forces."""
        n, nv = self.n, self.nv
        q, qd, z, zd = x[:n], x[n : 2 * n], x[2 * n : 2 * n + nv], x[2 * n + nv :]
        y, yd = height, height_rate
        if self.drive.coupled:
            y = y + rows @ q
            yd = yd + row_rates @ q + rows @ qd
        dynamic = self.k * (y - self.map @ z) + self.c * (yd - self.map @ zd)
        out = np.empty_like(x)
        out[:n] = qd
        out[n : 2 * n] = -(self.omega**2) * q - self.double * qd - (self.static + dynamic) @ rows
        out[2 * n : 2 * n + nv] = zd
        out[2 * n + nv :] = self.inner @ x[2 * n :] + self.push @ dynamic
        return out, self.static + dynamic


def integrate(deck, basis, drive, *, points, duration, dt, damping_ratio, chunk=200):
    """Step the whole by Runge-Kutta of order four; return what the points do at every step."""
    system = OneSystem(deck, basis, drive, damping_ratio=damping_ratio)
    n, n_steps = system.n, round(duration / dt)
    reader = np.array([deck.at(basis.shapes, *place) for place in points])
    x = np.zeros(2 * (n + system.nv))
    kept = np.empty((n_steps + 1, 3, len(points)))
    forces = np.empty((n_steps + 1, len(system.k)))
    for start in range(0, n_steps + 1, chunk):
        here = range(start, min(start + chunk, n_steps + 1))
        ground = system.ground(0.5 * dt * np.arange(2 * here.start, 2 * here.stop + 1))
        for i, step in enumerate(here):
            at = [tuple(part[2 * i + half] for part in ground) for half in range(3)]
            k1, forces[step] = system.right(x, *at[0])
            kept[step] = reader @ x[:n], reader @ x[n : 2 * n], reader @ k1[n : 2 * n]
            k2, _ = system.right(x + 0.5 * dt * k1, *at[1])
            k3, _ = system.right(x + 0.5 * dt * k2, *at[1])
            k4, _ = system.right(x + dt * k3, *at[2])
            x = x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return Motion(
        time=dt * np.arange(n_steps + 1), displacement=kept[:, 0], velocity=kept[:, 1],
        acceleration=kept[:, 2], forces=forces,
    )  # fmt: skip


def with_static_rest(motion, deck, basis, drive, *, stiffness, points):
    """Add what the modes left out do, without inertia, to the motion of the points.

    ``H_p (K^-1 - Phi Phi^T / omega^2) H^T f``; what it does to the contact forces is the spring's
    stiffness times this flexibility, some 1e-3 of them, and is left out.
    """
    rows = deck.at(np.eye(stiffness.shape[0]), *points[0])[:, None]
    for place in points[1:]:
        rows = np.column_stack([rows, deck.at(np.eye(stiffness.shape[0]), *place)])
    fields = np.linalg.solve(stiffness.toarray(), rows)
    fields -= basis.shapes @ ((basis.shapes.T @ rows) / basis.omega[:, None] ** 2)
    s = drive.speed * motion.time[:, None] - drive.vehicle.setback
    to_value, _ = deck.along(s.ravel())
    seen = (to_value @ np.vstack(deck.line(fields, drive.y))).reshape(*s.shape, len(points))
    rest = -np.einsum("tj,tjp->tp", motion.forces * drive.share(s)[0], seen)
    rate = np.gradient(rest, motion.time, axis=0)
    return Motion(
        time=motion.time, displacement=motion.displacement + rest,
        velocity=motion.velocity + rate,
        acceleration=motion.acceleration + np.gradient(rate, motion.time, axis=0),
        forces=motion.forces,
    )  # fmt: skip
