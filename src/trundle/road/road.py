"""Say what is asked of a road, and put roads together from parts.

A road has a random part, a given part, or both: roughness of a class is random alone, a survey is
given alone, and an expansion joint on a road of class B is both. Whoever drives draws the random
part anew for each run and reads the given part under each wheel's own track.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from trundle._checks import finite, frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.road._sums import added
from trundle.road.features import Feature, Tread, laid
from trundle.road.iso8608 import Spectrum
from trundle.road.profile import Profile

__all__ = ["FeaturedRoad", "MeasuredRoad", "Road"]


@runtime_checkable
class Road(Protocol):
    """What wheels roll on."""

    @property
    def spectrum(self) -> Spectrum | None:
        """Spectrum of its random part; None where nothing of it is random."""
        ...

    @property
    def is_given(self) -> bool:
        """Whether it has a part that is the same in every run."""
        ...

    def under(self, lateral: float, tread: Tread) -> Profile | None:
        """Return the given part under a track, as a tyre's tread meets it; None without one.

        Parameters
        ----------
        lateral : float
            Distance of the track to the left of the centre line [m].
        tread : Tread
            What meets it.
        """
        ...

    def of(self, route: str) -> Road:
        """Return the road as a route of a name meets it."""
        ...

    @property
    def start(self) -> float:
        """Station that lies at a route's start [m]."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class MeasuredRoad:
    """Hold the surveyed tracks of one road.

    Attributes
    ----------
    tracks : tuple of Profile
        One for each track, right to left or left to right.
    lateral : ndarray of float, shape (n_tracks,)
        Distance of each to the left of the centre line [m], rising.
    name : str
        Name for tables.
    start : float
        Station that lies at a route's start [m].
    """

    tracks: tuple[Profile, ...]
    lateral: Float[Array, " tracks"]
    name: str = "measured road"
    start: float = 0.0

    def __post_init__(self) -> None:
        """Check that every track has a place of its own."""
        lateral = frozen_array("lateral", self.lateral, shape=(len(self.tracks),))
        if not self.tracks:
            raise InputError("a measured road needs a track")
        if np.any(np.diff(lateral) <= 0.0):
            raise InputError(f"places of tracks must rise; got {lateral.tolist()} m")
        set_frozen(self, lateral=lateral, start=finite("start", self.start))

    @property
    def spectrum(self) -> None:
        """Nothing of it is random."""
        return

    @property
    def is_given(self) -> bool:
        """All of it is given."""
        return True

    def under(self, lateral: float, tread: Tread) -> Profile:
        """Return the track nearest to a place; a tread is averaged over by who drives."""
        del tread
        return self.tracks[int(np.abs(self.lateral - lateral).argmin())]

    def of(self, route: str) -> MeasuredRoad:
        """Return itself, the same on every route."""
        del route
        return self

    def __str__(self) -> str:
        """Describe the road for a report."""
        one = self.tracks[0]
        tracks = f"{len(self.tracks)} tracks" if len(self.tracks) > 1 else "one track"
        return f"{self.name}, {tracks} of {one.length:.4g} m from {one.station[0]:g} m"


@dataclass(frozen=True, kw_only=True, eq=False)
class FeaturedRoad:
    """Hold a road with joints, potholes, humps and the like on it.

    Attributes
    ----------
    base : Road
        What they lie on.
    features : tuple of Feature
        What lies on it; where two overlap their heights add.
    """

    base: Road
    features: tuple[Feature, ...]

    @property
    def spectrum(self) -> Spectrum | None:
        """That of what they lie on."""
        return self.base.spectrum

    @property
    def start(self) -> float:
        """That of what they lie on."""
        return self.base.start

    @property
    def is_given(self) -> bool:
        """Whether it has features, or what they lie on is given."""
        return bool(self.features) or self.base.is_given

    def under(self, lateral: float, tread: Tread) -> Profile | None:
        """Return base and features under a track."""
        below = self.base.under(lateral, tread)
        lying = [one for one in self.features if one.reaches(lateral)]
        if not lying:
            return below
        on_top = laid(lying, lateral, tread)
        if below is None:
            return on_top
        self._check_cover(below, lateral)
        return added(below, on_top)

    def _check_cover(self, below: Profile, lateral: float) -> None:
        """Refuse features off a survey, which nobody would meet."""
        first, last = float(below.station[0]), float(below.station[-1])
        for one in self.features:
            at = one.begins(lateral)
            if below.beyond != "level" and not first <= at <= last:
                raise InputError(
                    f"a feature at {at:.4g} m lies off the measured road, which covers {first:g} "
                    f"to {last:g} m: give its station in the road's own chainage"
                )

    def of(self, route: str) -> FeaturedRoad:
        """Return the road with the features of a route alone."""
        some = tuple(one for one in self.features if one.route in (None, route))
        return replace(self, base=self.base.of(route), features=some)

    def __str__(self) -> str:
        """Describe the road for a report."""
        kinds = [_words(type(one.shape).__name__) for one in self.features]
        counts = ", ".join(f"{kinds.count(k)} x {k}" for k in dict.fromkeys(kinds))
        return f"{self.base} with {counts}" if counts else str(self.base)


def _words(name: str) -> str:
    """Return a class's name as words: ExpansionJoint, expansion joint."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()
