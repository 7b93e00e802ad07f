"""Hold what a drive leaves: motion at the points and forces under the wheels."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float

from trundle._typing import Array

__all__ = ["Driven"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Driven:
    """Hold what was seen at every step, shapes (n_steps, n_points or n_contacts, n_runs).

    The motion may go on behind the last force, see `drive_in_blocks`.
    """

    displacement: Float[Array, "seen points runs"]
    velocity: Float[Array, "seen points runs"]
    acceleration: Float[Array, "seen points runs"]
    forces: Float[Array, "steps contacts runs"]

    def columns(self, runs: slice) -> Driven:
        """Return some of the runs."""
        return Driven(
            displacement=self.displacement[..., runs],
            velocity=self.velocity[..., runs],
            acceleration=self.acceleration[..., runs],
            forces=self.forces[..., runs],
        )
