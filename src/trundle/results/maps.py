"""Hold the maps of a study's cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from jaxtyping import Float

from trundle._typing import Array
from trundle.criteria import ClassMap

__all__ = ["MapKey", "StudyMap"]


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
    numbers : mapping of str to ndarray, shape (n_places,)
        What the share of runs stays below, by the names of quantities; NaN where no criterion
        asks for one.
    band_levels : ndarray of float, shape (n_places, n_bands)
        The same of band levels [m/s].
    seconds_above : mapping of str to ndarray, shape (n_places,)
        For how long the running level lies above each curve in one passage, the mean of the runs
        [s], by the names of criteria; empty unless a day asks for it.
    """

    classes: ClassMap
    numbers: Mapping[str, Array]
    band_levels: Float[Array, "places bands"]
    seconds_above: Mapping[str, Array] = field(default_factory=dict[str, Array])

    def part(self, places: slice) -> StudyMap:
        """Return some of the places."""
        return StudyMap(
            classes=self.classes.part(places),
            numbers={name: values[places] for name, values in self.numbers.items()},
            band_levels=self.band_levels[places],
            seconds_above={name: values[places] for name, values in self.seconds_above.items()},
        )
