"""Raise the doubts that a result must carry with it."""

from __future__ import annotations

from trundle.errors import FitnessWarning
from trundle.simulate.ground import PreparedFloor
from trundle.simulate.sources.source import Source
from trundle.structure import ContactShape

__all__ = ["LOST_CONTACT", "contact_warnings", "fitness_warnings"]

LOST_CONTACT = "loss of contact"
"""Subject of the warning about wheels that would have to pull."""


def fitness_warnings(
    sources: tuple[Source, ...], prepared: PreparedFloor, contact: ContactShape
) -> tuple[FitnessWarning, ...]:
    """Return the doubts about a method on a floor, whatever the road.

    Parameters
    ----------
    sources : tuple of Source
        What drove.
    prepared : PreparedFloor
        The floor, as the method needs it.
    contact : ContactShape
        Interpolation of loads between nodes.
    """
    of_sources = [
        doubt
        for source in sources
        for doubt in source.doubts(prepared.floor, prepared.modes, contact)
    ]
    kinds = list(dict.fromkeys(_kind(doubt) for doubt in of_sources))
    of_sources.sort(key=lambda doubt: kinds.index(_kind(doubt)))
    return tuple(dict.fromkeys([*prepared.doubts(), *prepared.damping.doubts(), *of_sources]))


def _kind(doubt: FitnessWarning) -> str:
    """Return what a doubt is about, without whom."""
    return doubt.subject.partition(",")[0]


def contact_warnings(share: float) -> tuple[FitnessWarning, ...]:
    """Return the doubt about runs in which a wheel would pull on the floor.

    Parameters
    ----------
    share : float
        Share of such runs, 0 to 1.
    """
    if share == 0.0:
        return ()
    return (
        FitnessWarning(
            subject=LOST_CONTACT,
            message=f"a wheel would pull on the floor in {_percent(share)} % of the runs; "
            "the linear vehicle cannot lift off, so those runs are not what would happen",
        ),
    )


def _percent(share: float) -> str:
    """Write a share as people do: 0.4, 12, 100."""
    return f"{100.0 * share:.1f}" if share < 0.01 else f"{100.0 * share:.0f}"
