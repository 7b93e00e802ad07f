"""Lines and arcs, one behind the other: where a station of a way lies, and how it bends there.

A way is given by corners and a radius. Each corner of angle a is cut off by an arc that touches
both lines, ``R tan(a/2)`` before it and behind; so direction and place are continuous, and a wheel
beside the line runs on a parallel curve without a jump.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Legs", "legs_of"]

_STRAIGHT = 1e-9  # rad: a corner so flat is none
_FITS = 1e-9  # m


@dataclass(frozen=True, kw_only=True, eq=False)
class Legs:
    """Hold legs of constant curvature, one behind the other.

    Attributes
    ----------
    station : ndarray of float, shape (n_legs + 1,)
        Distance from the start at which each leg begins [m], and at which the last ends.
    place : ndarray of float, shape (n_legs, 2)
        Where each begins [m].
    direction : ndarray of float, shape (n_legs, 2)
        Unit vector along it there.
    curvature : ndarray of float, shape (n_legs,)
        1 over its radius [1/m], positive to the left; 0 of a line.
    """

    station: Float[Array, " ends"]
    place: Float[Array, "legs 2"]
    direction: Float[Array, "legs 2"]
    curvature: Float[Array, " legs"]

    @property
    def length(self) -> float:
        """Length of all [m]."""
        return float(self.station[-1])

    def at(
        self, station: Float[Array, " n"]
    ) -> tuple[Float[Array, "n 2"], Float[Array, "n 2"], Float[Array, " n"]]:
        """Return places [m], unit directions and curvatures [1/m] at stations.

        Before the start and behind the end the way goes straight on.
        """
        s = np.asarray(station, float)
        leg = np.clip(np.searchsorted(self.station, s, "right") - 1, 0, len(self.curvature) - 1)
        bend = np.where((s < 0.0) | (s > self.length), 0.0, self.curvature[leg])
        inside = np.clip(s, 0.0, self.length)
        along = inside - self.station[leg]
        turned = self.curvature[leg] * along
        here = _rotated(self.direction[leg], turned)
        # over an arc the chord is 2 sin(t/2) / curvature, at half its angle; a line has t = 0
        chord = along * np.sinc(0.5 * turned / np.pi)
        place = self.place[leg] + chord[:, None] * _rotated(self.direction[leg], 0.5 * turned)
        return place + (s - inside)[:, None] * here, here, bend


def legs_of(points: Float[Array, "points 2"], radius: float, name: str) -> Legs:
    """Return the legs of a way by its corners.

    Parameters
    ----------
    points : ndarray of float, shape (n_points, 2)
        Start, corners and end [m].
    radius : float
        By which every corner is rounded [m]; 0 leaves it sharp.
    name : str
        Of the route, for messages.

    Raises
    ------
    InputError
        A radius that does not fit between two corners, or a way that turns back on itself.
    """
    step = np.diff(points, axis=0)
    length = np.linalg.norm(step, axis=1)
    direction = step / length[:, None]
    if radius == 0.0:
        ends = np.concatenate([[0.0], np.cumsum(length)])
        return Legs(
            station=ends, place=points[:-1], direction=direction, curvature=np.zeros(len(length))
        )
    one, other = direction[:-1], direction[1:]
    turn = np.arctan2(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0], (one * other).sum(axis=1))
    back = np.abs(np.abs(turn) - np.pi) < 1e-6
    if back.any():
        x, y = points[1 + int(np.argmax(back))]
        raise InputError(
            f"route {name!r} turns back on itself at ({x:g}, {y:g}) m: no radius rounds that; end "
            "it there, and let another route drive back with reverse = true"
        )
    cut = np.where(np.abs(turn) > _STRAIGHT, radius * np.tan(0.5 * np.abs(turn)), 0.0)
    free = length - np.concatenate([[0.0], cut]) - np.concatenate([cut, [0.0]])
    if free.min() < -_FITS:
        i = int(np.argmin(free))
        (a, b), (c, d) = points[i], points[i + 1]
        raise InputError(
            f"route {name!r}: a radius of {radius:g} m does not fit between ({a:g}, {b:g}) and "
            f"({c:g}, {d:g}) m, {length[i]:.4g} m apart: it needs {length[i] - free[i]:.4g} m; use "
            f"a radius of {radius * length[i] / (length[i] - free[i]):.3g} m or less"
        )
    return _rounded(points, direction, _Corners(turn, cut, np.maximum(free, 0.0), radius))


class _Corners(NamedTuple):
    """Corners by their angles [rad], what each takes off its lines, what lines are left [m]."""

    turn: Array
    cut: Array
    free: Array
    radius: float


def _rounded(points: Array, direction: Array, corners: _Corners) -> Legs:
    places, ways, bends, lengths = [], [], [], []
    turn, cut, free, radius = corners
    for i, way in enumerate(direction):
        if free[i] > _FITS:
            places.append(points[i] + (cut[i - 1] if i else 0.0) * way)
            ways.append(way)
            bends.append(0.0)
            lengths.append(free[i])
        if i < len(turn) and cut[i] > 0.0:
            places.append(points[i + 1] - cut[i] * way)
            ways.append(way)
            bends.append(np.sign(turn[i]) / radius)
            lengths.append(radius * abs(turn[i]))
    return Legs(
        station=np.concatenate([[0.0], np.cumsum(lengths)]),
        place=np.array(places),
        direction=np.array(ways),
        curvature=np.array(bends),
    )


def _rotated(vector: Array, angle: Array) -> Array:
    """Turn vectors to the left by angles."""
    left = np.stack([-vector[:, 1], vector[:, 0]], axis=1)
    return np.cos(angle)[:, None] * vector + np.sin(angle)[:, None] * left
