"""Estimate what the modes left out would change, by leaving out some more."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._checks import within
from trundle._typing import Array
from trundle.errors import InputError
from trundle.simulate.layout import Layout
from trundle.simulate.runs import Runs
from trundle.simulate.wheels.roads import roads_under_wheels

__all__ = ["TruncationChange", "truncation_change"]

_RUNS = 8  # enough for a relative change, which hardly varies from road to road


@dataclass(frozen=True, kw_only=True, eq=False)
class TruncationChange:
    """Hold by how much the response changes when the highest modes are left out too.

    Attributes
    ----------
    f_max : float
        Modes below this frequency were kept in the comparison [Hz].
    velocity, acceleration : ndarray of float, shape (n_points,)
        RMS of the difference over that of the response, 0 for no change.
    """

    f_max: float
    velocity: Float[Array, " points"]
    acceleration: Float[Array, " points"]


def truncation_change(
    layout: Layout, runs: Runs, numbers: range, *, share: float = 0.5
) -> TruncationChange:
    """Drive some runs again with fewer modes, and compare.

    What the modes of the highest octave change is taken for what all modes above ``f_max`` would
    still change: contributions fall with frequency, for a rough road excites less and less and
    what lies above answers statically already. Small floors of some ten modes an octave came out
    at 0.1 to 1.6 times it against a basis that reached far beyond.

    Parameters
    ----------
    layout : Layout
        What the runs share; its integration must be `Modal`.
    runs : Runs
        Runs with histories.
    numbers : range
        Their numbers.
    share : float
        Part of the highest frequency to which modes are kept, 0 to 1.
    """
    top = layout.integration.f_max
    if top is None:
        raise InputError("direct integration leaves no modes out")
    top *= within("share", share, 0.0, 1.0)
    fewer = layout.with_modes_below(top)
    some = numbers[:_RUNS]
    road = roads_under_wheels(layout.sources, layout.timeline, some, runs.seed)
    record = fewer.over(road)
    n = len(some)
    return TruncationChange(
        f_max=top,
        velocity=_change(record.velocity, runs.velocity[:n]),
        acceleration=_change(record.acceleration, runs.acceleration[:n]),
    )


def _change(other: Array, reference: Array) -> Array:
    """Return the relative RMS difference at each point; `other` has its runs last."""
    difference = np.transpose(other, (2, 0, 1)) - reference
    whole = np.sqrt(np.mean(reference**2, axis=(0, 1)))
    return np.sqrt(np.mean(difference**2, axis=(0, 1))) / np.maximum(whole, np.finfo(float).tiny)
