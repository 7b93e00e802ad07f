"""Hold a road profile with its exact slope, and read it anywhere."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, non_negative, one_of, set_frozen
from trundle._typing import Array, ArrayLike
from trundle.errors import InputError
from trundle.road._averaging import Points, moving_average
from trundle.road._slopes import check_order, limited_slopes, measured_points

__all__ = ["Beyond", "Profile", "ProfileReader"]

Beyond: TypeAlias = Literal["unknown", "level", "mirror"]
"""What is taken of the road beyond its stations."""

_ROUNDING = 1e-6  # m; a reading so little beyond the stations is at their end


@dataclass(frozen=True, kw_only=True, eq=False)
class Profile:
    """Hold elevation and slope along a wheel track.

    Between stations the elevation is the cubic that meets elevation and slope at both ends,
    and the slope is exactly that cubic's derivative; so the work that a road does on a
    vehicle is consistent.

    Attributes
    ----------
    station : ndarray of float, shape (n_points,)
        Distance along the track [m], not falling; a station given twice is a kink.
    elevation : ndarray of float, shape (n_points,)
        Height above the smooth surface, or above any datum [m], up positive.
    slope : ndarray of float, shape (n_points,)
        Derivative of the elevation along the track [m/m].
    beyond : {"unknown", "level", "mirror"}
        Road outside the stations: unknown, so that reading there is refused; level, at the
        height of the end; or the mirror image of the profile in its end point, which goes on
        there with the same slope, as often as it takes.
    """

    station: Float[Array, " points"]
    elevation: Float[Array, " points"]
    slope: Float[Array, " points"]
    beyond: Beyond = "unknown"

    def __post_init__(self) -> None:
        """Freeze arrays and check the order of stations."""
        one_of("beyond", self.beyond, get_args(Beyond))
        station = frozen_array("station", self.station, shape=(None,))
        if len(station) < 2:
            raise InputError(f"a profile needs at least 2 stations; got {len(station)}")
        elevation = frozen_array("elevation", self.elevation, shape=station.shape)
        check_order(station, elevation)
        if station[0] == station[-1]:
            raise InputError(f"a profile needs a length; all its stations are {station[0]:g} m")
        set_frozen(
            self,
            station=station,
            elevation=elevation,
            slope=frozen_array("slope", self.slope, shape=station.shape),
        )

    @classmethod
    def smooth(cls) -> Profile:
        """Return a road without roughness, level everywhere."""
        level = np.zeros(2)
        return cls(station=np.array([0.0, 1.0]), elevation=level, slope=level, beyond="level")

    @classmethod
    def piecewise_linear(
        cls, station: ArrayLike, elevation: ArrayLike, *, beyond: Beyond = "unknown"
    ) -> Profile:
        """Join points by straight lines; the slope jumps at each point.

        Parameters
        ----------
        station : array_like of float, shape (n_points,)
            Distance along the track [m], rising.
        elevation : array_like of float, shape (n_points,)
            Height [m].
        beyond : {"unknown", "level", "mirror"}
            Road outside the stations.
        """
        s, z = measured_points(station, elevation, at_least=2)
        return cls(
            station=np.repeat(s, 2)[1:-1],
            elevation=np.repeat(z, 2)[1:-1],
            slope=np.repeat(np.diff(z) / np.diff(s), 2),
            beyond=beyond,
        )

    @classmethod
    def from_samples(
        cls, station: ArrayLike, elevation: ArrayLike, *, beyond: Beyond = "unknown"
    ) -> Profile:
        """Fit a smooth curve through measured points.

        The curve is the cubic spline wherever the points show the waves they are taken from;
        beside steps and sharp corners its slopes are held, so that it does not swing about
        them and only its first derivative is continuous.

        Parameters
        ----------
        station : array_like of float, shape (n_points,)
            Distance along the track [m], rising; chainage as surveyed.
        elevation : array_like of float, shape (n_points,)
            Height above any datum [m].
        beyond : {"unknown", "level", "mirror"}
            Road outside the stations.
        """
        s, z = measured_points(station, elevation, at_least=4)
        return cls(station=s, elevation=z, slope=limited_slopes(s, z), beyond=beyond)

    @property
    def spectrum(self) -> None:
        """Spectrum of its random part: nothing of it is random."""
        return

    @property
    def is_given(self) -> bool:
        """Whether a part of it is the same in every run: all is."""
        return True

    @property
    def start(self) -> float:
        """Station that lies at a route's start: 0."""
        return 0.0

    def under(self, lateral: float, tread: object) -> Profile:
        """Return itself: the same under every track."""
        del lateral, tread
        return self

    def of(self, route: str) -> Profile:
        """Return itself: the same on every route."""
        del route
        return self

    @property
    def length(self) -> float:
        """Distance from first to last station [m]."""
        return float(self.station[-1] - self.station[0])

    def moved(self, distance: float) -> Profile:
        """Return the same road with a distance added to all stations [m].

        Examples
        --------
        >>> surveyed = Profile.from_samples([478.0, 478.5, 479.0, 479.5], [0.0, 0.01, 0.01, 0.0])
        >>> surveyed.moved(-478.0).station.tolist()
        [0.0, 0.5, 1.0, 1.5]
        """
        return replace(self, station=self.station + finite("distance", distance))

    def starting_at(self, station: float) -> Profile:
        """Return the same road with its first station at another [m]."""
        return self.moved(finite("station", station) - float(self.station[0]))

    def averaged(self, length: float) -> Profile:
        """Return the centred moving average over a length, as a tyre's contact patch takes it.

        A wave of spatial frequency n keeps ``sin(pi n a) / (pi n a)`` of its height. Where the
        road beyond the stations is unknown, the average ends half a length inside them.

        Parameters
        ----------
        length : float
            Length a averaged over [m]; 0 changes nothing.

        Raises
        ------
        InputError
            A profile no longer than the length.
        """
        length = non_negative("length averaged over", length)
        if length == 0.0:
            return self
        if self.length <= length:
            raise InputError(
                f"a profile of {self.length:g} m cannot be averaged over {length:g} m: "
                "give a longer profile or a shorter contact patch"
            )
        mean = moving_average(self._with_margin(length), length)
        return Profile(
            station=mean.station,
            elevation=mean.elevation,
            slope=mean.slope,
            beyond=self.beyond,
        )

    def at(self, station: ArrayLike) -> tuple[Float[Array, ...], Float[Array, ...]]:
        """Return elevation [m] and slope [m/m] at any stations [m].

        Raises
        ------
        InputError
            A station beyond the profile's own, where the road there is unknown.
        """
        s = np.asarray(station, float)
        first, last = self.station[0], self.station[-1]
        if self.beyond == "mirror":
            return self._mirrored(s)
        outside = (s < first - _ROUNDING) | (s > last + _ROUNDING)
        if self.beyond == "unknown":
            if np.any(outside):
                raise InputError(
                    f"the profile covers {first:g} to {last:g} m; the road at "
                    f"{np.atleast_1d(s)[np.atleast_1d(outside)][0]:g} m is unknown: read it "
                    'inside, or say beyond="level" or beyond="mirror" when making the profile'
                )
            s = np.clip(s, first, last)
        return ProfileReader(self.station, s).read(self.elevation, self.slope)

    def _mirrored(self, s: Array) -> tuple[Array, Array]:
        """Read the road that is turned about each of its ends in turn, for ever."""
        first, last = self.station[0], self.station[-1]
        fold = np.floor((s - first) / (last - first))
        fold -= (s == last) & (fold == 1.0)
        along = s - first - fold * (last - first)
        turned = fold % 2 == 1
        inside = np.clip(np.where(turned, last - along, first + along), first, last)
        z, slope = ProfileReader(self.station, inside).read(self.elevation, self.slope)
        z0, z1 = self.elevation[0], self.elevation[-1]
        return np.asarray(fold * (z1 - z0) + np.where(turned, z0 + z1 - z, z)), slope

    def _with_margin(self, length: float) -> Points:
        """Return the points with what lies a length beyond either end, if that is known."""
        s, z, g = self.station, self.elevation, self.slope
        if self.beyond == "level":
            more, level = np.array([-length, 0.0]), np.zeros(2)
            s = np.concatenate([s[0] + more, s, s[-1] - more[::-1]])
            z = np.concatenate([z[[0, 0]], z, z[[-1, -1]]])
            g = np.concatenate([level, g, level])
        elif self.beyond == "mirror":
            # half a length: the average then ends where the road does, and mirrors as it does
            low, high = s[0] + 0.5 * length, s[-1] - 0.5 * length
            (z_low, z_high), (g_low, g_high) = self.at([low, high])
            near, far = (s > s[0]) & (s < low), (s < s[-1]) & (s > high)
            before = np.concatenate([[low], s[near][::-1]])
            after = np.concatenate([s[far][::-1], [high]])
            s = np.concatenate([2 * s[0] - before, s, 2 * s[-1] - after])
            z = np.concatenate(
                [
                    2 * z[0] - np.concatenate([[z_low], z[near][::-1]]),
                    z,
                    2 * z[-1] - np.concatenate([z[far][::-1], [z_high]]),
                ]
            )
            g = np.concatenate([[g_low], g[near][::-1], g, g[far][::-1], [g_high]])
        return Points(station=s, elevation=z, slope=g)


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
