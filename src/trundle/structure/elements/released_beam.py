"""Form straight members whose ends are hinged: rotations there are their own, not the nodes'."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from trundle._checks import frozen_array, set_frozen
from trundle._typing import Array
from trundle.structure.elements.beam import BeamGroup, beam_mass, beam_stiffness, with_offset
from trundle.structure.elements.standing import (
    ContactShape,
    Located,
    Weights,
    line_locate,
    line_weights,
)
from trundle.structure.frames import beam_frames

__all__ = ["ReleasedBeams"]

_NO_OFFSET = np.zeros(3)


@dataclass(frozen=True, kw_only=True, eq=False)
class ReleasedBeams:
    """Hold members like those of a group, of which some rotations at the ends are released.

    Attributes
    ----------
    beams : BeamGroup
        The members.
    released : ndarray of bool, shape (2, 3)
        For start and end: rotations about the member's own x, y and z that transmit no moment.

    Notes
    -----
    What a hinge lets go is taken out of the member's own equations: with R the released rotations,
    ``T = 1 - R (R' K R)^-1 R' K`` follows the rest without a moment, and the member has the
    stiffness ``K T`` and, by Guyan's reduction, the mass ``T' M T``. The stiffness is exact; the
    mass is that of a member which bends as it does without inertia.
    """

    beams: BeamGroup
    released: Bool[Array, "2 3"]

    def __post_init__(self) -> None:
        """Freeze what is released."""
        released = frozen_array("released", self.released, shape=(2, 3), dtype=np.bool_)
        set_frozen(self, released=released)

    @property
    def name(self) -> str:
        """What the group is."""
        return self.beams.name

    @property
    def offset(self) -> Float[Array, " 3"]:
        """From node to centroid in global axes [m]."""
        return self.beams.offset

    @property
    def connectivity(self) -> Int[Array, "elements 2"]:
        """Node numbers of each element."""
        return self.beams.elements

    @property
    def of_one_section(self) -> bool:
        """True: elements of one shape have the same matrices."""
        return True

    @property
    def stands_on_ground(self) -> bool:
        """Whether an end may be rigid ground."""
        return False

    @property
    def damping_ratio(self) -> float | None:
        """Ratio of critical damping of what they are made of, if known."""
        return self.beams.damping_ratio

    @property
    def carried(self) -> Bool[Array, " 6"]:
        """The translations, and the rotations that one end at least transmits."""
        kept = ~self.released.all(axis=0)
        # which axes of the member those of the building are is not known here
        return np.concatenate([np.ones(3, dtype=bool), np.full(3, kept.any())])

    def stiffness_blocks(
        self, xyz: Float[Array, "elements 2 3"]
    ) -> Float[Array, "elements dofs dofs"]:
        """Return the stiffness of each member at its nodes."""
        stiffness, follow = self._follow(xyz)
        return self._at_nodes(stiffness @ follow, xyz)

    def mass_blocks(self, xyz: Float[Array, "elements 2 3"]) -> Float[Array, "elements dofs dofs"]:
        """Return the mass of each member at its nodes."""
        _, follow = self._follow(xyz)
        mass = beam_mass(xyz, self.beams.section, offset=_NO_OFFSET, up=self.beams.up)
        return self._at_nodes(np.swapaxes(follow, 1, 2) @ mass @ follow, xyz)

    def _at_nodes(self, matrices: Array, xyz: Array) -> Array:
        lengths, frames = beam_frames(xyz, self.beams.up)
        return with_offset(matrices, self.beams.offset, lengths, frames[:, 0])

    def _follow(self, xyz: Array) -> tuple[Array, Array]:
        """Return the stiffness without hinges, and how a member follows its nodes with them."""
        stiffness = beam_stiffness(xyz, self.beams.section, offset=_NO_OFFSET, up=self.beams.up)
        _, frames = beam_frames(xyz, self.beams.up)
        ends, axes = np.nonzero(self.released)
        hinges = np.zeros((len(xyz), 12, len(ends)))
        for i, (end, axis) in enumerate(zip(ends, axes, strict=True)):
            hinges[:, 6 * end + 3 : 6 * end + 6, i] = frames[:, axis]
        moments = np.swapaxes(hinges, 1, 2) @ stiffness
        # torsion that both ends let go has no stiffness to be solved for
        own = hinges @ np.linalg.pinv(moments @ hinges, rcond=1e-12, hermitian=True) @ moments
        return stiffness, np.eye(12) - own

    def locate(self, corners: Float[Array, "n 2 2"], places: Float[Array, "n 2"]) -> Located:
        """Return where along members places lie, see `line_locate`."""
        return line_locate(corners, places)

    def weights(
        self, local: Float[Array, "n 2"], corners: Float[Array, "n 2 2"], shape: ContactShape
    ) -> Weights:
        """Return what the nodes' motion gives at places, see `line_weights`."""
        return line_weights(local, corners, shape)
