"""Say to which spatial frequency a road excites whoever crosses it: as a whole, and at all.

What a road does not hold is missing from every level, and a level from which something is missing
passes nothing. So the waves of a survey end where its points lie too far apart for them, however
close a few of them are; and what somebody draws on a road adds no roughness to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.road import Feature, FeaturedRoad, Profile, Road
from trundle.simulate.sources.crossing import Crossing

__all__ = ["RoadReach", "road_reach"]

_USUAL = 0.9  # of the way, on which points lie no further apart than is usual of a survey


@dataclass(frozen=True, kw_only=True)
class RoadReach:
    """Hold where the waves of a road end under one vehicle.

    Attributes
    ----------
    whole : float
        Spatial frequency to which all of its waves are there, under every wheel [cycle/m].
    partly : float
        To which any are, `whole` or more [cycle/m]: what they give above that is a lower bound.
    """

    whole: float
    partly: float


def road_reach(crossing: Crossing) -> RoadReach:
    """Return where the waves of a crossing's road end.

    Notes
    -----
    Points a distance d apart hold no wave shorter than 2 d. Of a survey d is what is usual of the
    coarsest track that a wheel rolls on, between the route's ends, and the least of any track for
    what is there in part. Joints, humps and the like have corners, which excite all bands, each in
    part.
    """
    road = crossing.road
    touching = range(crossing.driven.n_contacts - crossing.driven.inner)
    asides = [float(crossing.driven.lateral[i]) for i in touching]
    if road.spectrum is not None:
        whole = partly = crossing.band.n_max
    else:
        base = _base(road)
        tracks = (base.under(y, crossing.tread(i)) for i, y in enumerate(asides))
        apart = [_spacings(crossing, track) for track in tracks if track is not None]
        whole = min((0.5 / usual for usual, _ in apart), default=0.0)
        partly = max((0.5 / least for _, least in apart), default=0.0)
    if any(one.reaches(y) for one in _features(road) for y in asides):
        partly = np.inf
    return RoadReach(whole=whole, partly=max(whole, partly))


def _base(road: Road) -> Road:
    """Return what features lie on."""
    return _base(road.base) if isinstance(road, FeaturedRoad) else road


def _features(road: Road) -> tuple[Feature, ...]:
    """Return all that lies on a road."""
    return (*_features(road.base), *road.features) if isinstance(road, FeaturedRoad) else ()


def _spacings(crossing: Crossing, track: Profile) -> tuple[float, float]:
    """Return the usual and the least distance of points that a wheel rolls over [m]."""
    start = crossing.chainage
    apart, driven = _between(track, start + min(0.0, crossing.lead), start + crossing.route.length)
    order = np.argsort(apart)
    covered = np.cumsum(driven[order])
    at = int(np.searchsorted(covered, _USUAL * covered[-1]))
    return float(apart[order][min(at, len(order) - 1)]), float(apart.min())


def _between(
    track: Profile, low: float, high: float
) -> tuple[Float[Array, " gaps"], Float[Array, " gaps"]]:
    """Return distances of points, and how much of each lies on a stretch [m].

    Of a track that has no point there, all distances, for it is a mirror image or level.
    """
    near, far = track.station[:-1], track.station[1:]
    driven = np.minimum(far, high) - np.maximum(near, low)
    if not np.any(driven > 0.0):
        driven = far - near
    some = (driven > 0.0) & (far > near)
    return (far - near)[some], driven[some]
