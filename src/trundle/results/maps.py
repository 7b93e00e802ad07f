"""Hold the maps of a study's cases, and read them from what their parts leave."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import ClassMap
from trundle.results.pieces import Piece
from trundle.study.map_plan import MapPlan

__all__ = ["BY_CRITERION", "LEVELS", "MapKey", "StudyMap", "map_of"]

BY_CRITERION = ("margin", "governing_band", "share_exceeding")
"""Arrays of a map that have a row for each criterion."""

LEVELS = ("rms_velocity", "peak_acceleration", "band_levels")
"""Levels of a map that a share of runs stays below."""


@dataclass(frozen=True)
class MapKey:
    """Name a map: what drove, on what road, at what speed if not the study's own [m/s]."""

    case: str
    road: str
    speed: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyMap:
    """Hold the map of one cell.

    Attributes
    ----------
    classes : ClassMap
        Margins, exceedance and classes.
    rms_velocity : ndarray of float, shape (n_places,)
        RMS velocity over the record that the share of runs stays below [m/s].
    peak_acceleration : ndarray of float, shape (n_places,)
        The same of the peak [m/s2]; NaN where no criterion asks for it.
    band_levels : ndarray of float, shape (n_places, n_bands)
        The same of band levels [m/s].
    """

    classes: ClassMap
    rms_velocity: Float[Array, " places"]
    peak_acceleration: Float[Array, " places"]
    band_levels: Float[Array, "places bands"]


def map_of(plan: MapPlan, piece: Piece, road: int) -> StudyMap:
    """Return the map of one of the roads of a piece."""
    arrays = piece.arrays
    some = tuple(c for c in plan.criteria if c.axis != "horizontal")
    return StudyMap(
        classes=ClassMap(
            places=plan.places,
            criteria=some,
            complete=tuple(bool(flag) for flag in arrays[f"{road}.complete"]),
            percentile=plan.percentile,
            **{name: arrays[f"{road}.{name}"] for name in BY_CRITERION},
        ),
        **{name: arrays[f"{road}.{name}"] for name in LEVELS},
    )
