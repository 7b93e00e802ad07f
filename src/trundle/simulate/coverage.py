"""Say how far a result reaches: what the road excites, and whether the vehicles have left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.signals import TOP_FREQUENCY, band_edges
from trundle.simulate.sources.crossing import Crossing
from trundle.simulate.sources.passage import as_sources
from trundle.simulate.sources.source import Source

__all__ = ["Coverage", "coverage_of"]

_WHOLE = 0.99  # of a band's upper edge, that the road's waves must reach


@dataclass(frozen=True, kw_only=True)
class Coverage:
    """Hold how far a result reaches; by default as far as anybody asks.

    Attributes
    ----------
    excited_to : float
        Frequency at which the waves of the first road end, the least of all vehicles [Hz]; of
        sources whose forces are known, where those end.
    leaves : float
        Time at which the last wheel leaves the floor [s].
    ends : float
        Time at which the record ends [s].
    by : {"road", "forces"}
        What ends there: a road's waves, or forces that are known.
    """

    excited_to: float = np.inf
    leaves: float = -np.inf
    ends: float = np.inf
    by: str = "road"

    @property
    def left(self) -> bool:
        """Whether every wheel is off the floor at the record's end."""
        return self.ends >= self.leaves * (1.0 - 1e-9)

    def excites(self, mid_band: Float[Array, " bands"]) -> Bool[Array, " bands"]:
        """Return which bands the roads excite as a whole, or which hold a line of given forces."""
        edges = band_edges(np.asarray(mid_band, float))
        if self.by == "forces":
            return edges[:, 0] <= self.excited_to
        return edges[:, 1] * _WHOLE <= self.excited_to

    def reasons(self, *, waves: bool) -> tuple[str, ...]:
        """Say what is missing and what would help.

        Parameters
        ----------
        waves : bool
            Whether bands are asked for that the road does not excite.
        """
        found: list[str] = []
        if not self.left:
            last = "last wheel leaves the floor" if self.by == "road" else "last source ends"
            found.append(
                f"the record ends at {self.ends:.3g} s and the {last} at "
                f"{self.leaves:.3g} s: lengthen or remove duration"
            )
        if waves and self.by == "forces":
            found.append(
                f"the forces that are given end at {self.excited_to:.3g} Hz, and nothing excites "
                "the bands above: give harmonics or impulses that reach further, if there are any"
            )
        elif waves:
            times = 10.0**0.05 * TOP_FREQUENCY / self.excited_to
            found.append(
                f"the road's waves end at {self.excited_to:.3g} Hz at this speed, and nothing "
                "excites the bands above: raise n_max "
                f"{times:.2g} times for {TOP_FREQUENCY:g} Hz, with a contact patch"
            )
        return tuple(found)


def coverage_of(sources: Sequence[Crossing | Source], ends: float) -> Coverage:
    """Return how far a record of some sources reaches.

    Parameters
    ----------
    sources : sequence of Crossing or Source
        What drives where.
    ends : float
        Length of the record [s].
    """
    many = as_sources(sources)
    # a force that is known altogether bounds nobody else's reach
    bounding = [source for source in many if not source.complete]
    reach = [source.excited_to(ends) for source in bounding or many]
    chosen = int(np.argmin(reach) if bounding else np.argmax(reach))
    return Coverage(
        excited_to=reach[chosen],
        leaves=max(source.leaves for source in many),
        ends=ends,
        by="forces" if (bounding or many)[chosen].oscillator is None else "road",
    )
