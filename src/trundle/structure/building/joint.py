"""Hold joints between two edges of a building: bearings, dowels and fillers as springs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.errors import InputError, Problem

__all__ = ["WIDEST", "Joint", "line_problems"]

WIDEST = 1.0
"""Gap that a joint can have [m]."""

_UNLIKE = 0.05  # by which both edges may differ in length


@dataclass(frozen=True, kw_only=True, eq=False)
class Joint:
    """Hold what connects two edges that are not one: an expansion joint between two buildings.

    Attributes
    ----------
    on : str
        Storey or ramp of both.
    along, to : ndarray of float, shape (n, 2)
        Corners of the edge on one side, and of the one that faces it [m].
    springs : tuple of float
        Stiffness along x, y and z of every metre [N/m2].
    name : str
        Name for messages.
    """

    on: str
    along: Float[Array, "corners 2"]
    to: Float[Array, "others 2"]
    springs: tuple[float, float, float]
    name: str = "joint"

    def __post_init__(self) -> None:
        """Freeze both lines and check the springs."""
        for name in ("along", "to"):
            set_frozen(self, **{name: frozen_array(name, getattr(self, name), shape=(None, 2))})
        if min(self.springs) < 0.0:
            raise InputError(f"springs must be 0 or more; got {list(self.springs)}")

    def facing(self) -> Float[Array, "others 2"]:
        """Return the other edge in the direction of the first [m]."""
        ends = self.to[[0, -1]] - self.along[[0, -1]]
        crossed = self.to[[-1, 0]] - self.along[[0, -1]]
        return self.to if np.abs(ends).sum() <= np.abs(crossed).sum() else self.to[::-1]


def line_problems(joints: tuple[Joint, ...]) -> Iterator[Problem]:
    """Give joints whose two edges do not face each other, or that hold nothing."""
    for i, joint in enumerate(joints, start=1):
        if not any(joint.springs):
            yield Problem(
                place=f"joint[{i}].springs",
                value="nothing",
                rule="a joint has a spring at least",
                remedy='give springs = { uz = "50 MN/m/m" }, or leave the joint out',
            )
        gap = float(np.linalg.norm(joint.facing()[[0, -1]] - joint.along[[0, -1]], axis=1).max())
        lengths = [_length(joint.along), _length(joint.to)]
        if gap > WIDEST:
            yield Problem(
                place=f"joint[{i}].to",
                value=f"{gap:.3g} m away",
                rule=f"both edges of a joint face each other, {WIDEST:g} m apart at most",
                remedy="give the edge on the other side of the joint, as long as the first",
            )
        elif abs(lengths[0] - lengths[1]) > _UNLIKE * max(lengths):
            yield Problem(
                place=f"joint[{i}].to",
                value=f"{lengths[1]:.4g} m long, beside {lengths[0]:.4g} m",
                rule="both edges of a joint have one length",
                remedy="give of each edge the part that faces the other",
            )


def _length(line: Array) -> float:
    return sum(float(np.linalg.norm(b - a)) for a, b in pairwise(line))
