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
    partly_to : float or None
        Frequency to which any source excites in part, the largest of all [Hz]; None where that is
        `excited_to`. Between the two a level is a lower bound: it can fail, and not pass.
    partly_by : {"road", "forces"}
        What ends there.
    """

    excited_to: float = np.inf
    leaves: float = -np.inf
    ends: float = np.inf
    by: str = "road"
    partly_to: float | None = None
    partly_by: str = "road"

    @property
    def left(self) -> bool:
        """Whether every wheel is off the floor at the record's end."""
        return self.ends >= self.leaves * (1.0 - 1e-9)

    def excites(self, mid_band: Float[Array, " bands"]) -> Bool[Array, " bands"]:
        """Return which bands the roads excite as a whole, or which hold a line of given forces."""
        return _reached(mid_band, self.excited_to, self.by)

    def excites_partly(self, mid_band: Float[Array, " bands"]) -> Bool[Array, " bands"]:
        """Return which bands any of several sources excites: a level above a limit fails there."""
        if self.partly_to is None:
            return self.excites(mid_band)
        return _reached(mid_band, self.partly_to, self.partly_by)

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
            above = "nothing excites" if self.partly_to is None else "not all of it excites"
            tiny = float(np.finfo(float).tiny)
            times = 10.0**0.05 * TOP_FREQUENCY / max(self.excited_to, tiny)
            found.append(
                f"the road's waves end at {self.excited_to:.3g} Hz at this speed, and {above} "
                f"the bands above: raise n_max {times:.2g} times for {TOP_FREQUENCY:g} Hz, with a "
                "contact patch; the points of a survey would have to lie so much closer"
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
    bounding = [i for i, source in enumerate(many) if not source.complete]
    reach = [source.excited_to(ends) for source in many]
    partly = [source.partly_excited_to(ends) for source in many]
    most = int(np.argmax(partly))
    least = min(bounding, key=lambda i: reach[i]) if bounding else most
    further = most != least or _WHOLE * partly[most] > reach[least]
    return Coverage(
        excited_to=reach[least],
        leaves=max(source.leaves for source in many),
        ends=ends,
        by=_what(many[least]),
        partly_to=partly[most] if further else None,
        partly_by=_what(many[most]),
    )


def _what(source: Source) -> str:
    return "forces" if source.oscillator is None else "road"


def _reached(mid_band: Float[Array, " bands"], top: float, by: str) -> Bool[Array, " bands"]:
    """Return which bands a road's waves fill, or which hold a line of given forces."""
    edges = band_edges(np.asarray(mid_band, float))
    return edges[:, 0] <= top if by == "forces" else edges[:, 1] * _WHOLE <= top
