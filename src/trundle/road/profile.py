"""Hold a road profile with its exact slope, and read it anywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError

__all__ = ["Profile", "ProfileReader"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Profile:
    """Hold elevation and slope along a wheel track.

    Between stations the elevation is the cubic that meets elevation and slope at both ends,
    and the slope is exactly that cubic's derivative; so the work that a road does on a
    vehicle is consistent. Outside the stations the road goes on level.

    Attributes
    ----------
    station : ndarray of float, shape (n_points,)
        Distance along the track [m], not falling; a station given twice is a kink.
    elevation : ndarray of float, shape (n_points,)
        Height above the smooth surface [m], up positive.
    slope : ndarray of float, shape (n_points,)
        Derivative of the elevation along the track [m/m].
    """

    station: Float[Array, " points"]
    elevation: Float[Array, " points"]
    slope: Float[Array, " points"]

    def __post_init__(self) -> None:
        """Freeze arrays and check the order of stations."""
        station = frozen_array("station", self.station, shape=(None,))
        if len(station) < 2:
            raise InputError(f"a profile needs at least 2 stations; got {len(station)}")
        if np.any(np.diff(station) < 0.0):
            bad = int(np.argmin(np.diff(station)))
            raise InputError(
                f"station must not fall; it goes from {station[bad]:g} to {station[bad + 1]:g} m "
                f"at point {bad + 1}: sort the file by station"
            )
        set_frozen(
            self,
            station=station,
            elevation=frozen_array("elevation", self.elevation, shape=station.shape),
            slope=frozen_array("slope", self.slope, shape=station.shape),
        )

    @classmethod
    def smooth(cls) -> Profile:
        """Return a road without roughness."""
        return cls(station=np.array([0.0, 1.0]), elevation=np.zeros(2), slope=np.zeros(2))

    @classmethod
    def piecewise_linear(cls, station: ArrayLike, elevation: ArrayLike) -> Profile:
        """Join points by straight lines; the slope jumps at each point."""
        s, z = (np.asarray(values, float) for values in (station, elevation))
        slopes = np.diff(z) / np.diff(s)
        return cls(
            station=np.repeat(s, 2)[1:-1],
            elevation=np.repeat(z, 2)[1:-1],
            slope=np.repeat(slopes, 2),
        )

    @classmethod
    def from_samples(cls, station: ArrayLike, elevation: ArrayLike) -> Profile:
        """Fit a twice continuously differentiable curve through measured points.

        Parameters
        ----------
        station : array_like of float, shape (n_points,)
            Distance along the track [m], rising.
        elevation : array_like of float, shape (n_points,)
            Height [m].
        """
        s, z = (np.asarray(values, float) for values in (station, elevation))
        if s.ndim != 1 or s.shape != z.shape or len(s) < 4:
            raise InputError(
                "a measured profile needs at least 4 points with one elevation each; "
                f"got {s.shape} stations and {z.shape} elevations"
            )
        if np.any(np.diff(s) <= 0.0):
            raise InputError("station must rise from point to point: sort it and drop repeats")
        return cls(station=s, elevation=z, slope=CubicSpline(s, z)(s, 1))

    @property
    def length(self) -> float:
        """Distance from first to last station [m]."""
        return float(self.station[-1] - self.station[0])

    def at(self, station: ArrayLike) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return elevation [m] and slope [m/m] at any stations [m]."""
        return ProfileReader(self.station, station).read(self.elevation, self.slope)


class ProfileReader:
    """Find once where stations lie between samples, and read many profiles there.

    Parameters
    ----------
    samples : ndarray of float, shape (n_points,)
        Stations of the profiles' samples [m].
    station : array_like of float
        Where they are to be read [m].
    """

    def __init__(self, samples: Float[Array, " points"], station: ArrayLike) -> None:
        s = np.asarray(station, float)
        inside = np.clip(s, samples[0], samples[-1])
        right = np.clip(np.searchsorted(samples, inside, "right"), 1, len(samples) - 1)
        # At the far end of a kinked profile the last interval may have no length.
        while np.any(flat := samples[right] == samples[right - 1]):
            right = right - flat
        self._right, self._left = right, right - 1
        self._width = samples[right] - samples[self._left]
        self._x = (inside - samples[self._left]) / self._width
        self._level = s != inside

    def read(
        self, elevation: Float[Array, " points"], slope: Float[Array, " points"]
    ) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return elevation [m] and slope [m/m] of one profile at the stations."""
        x, width = self._x, self._width
        z0 = elevation[self._left]
        g0, g1 = slope[self._left] * width, slope[self._right] * width
        rise = elevation[self._right] - z0
        second, third = 3 * rise - 2 * g0 - g1, g0 + g1 - 2 * rise
        height = z0 + x * (g0 + x * (second + x * third))
        steepness = (g0 + x * (2 * second + 3 * x * third)) / width
        return height, np.where(self._level, 0.0, steepness)
