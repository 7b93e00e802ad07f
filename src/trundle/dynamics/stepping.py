"""State what every time-stepping scheme offers, so that systems can be coupled step by step.

A step is split in two: `predict` carries a state to the end of the step as if no force acted
there, and `finish` adds the effect of the force at the step's end. Both are linear in the
force, and `respond` gives that effect for unit forces; so two systems that touch can solve
for their contact force alone, and neither is ever factorised again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from jaxtyping import Float

from trundle._typing import Array

__all__ = ["Motion", "Propagator", "State"]


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Hold the motion of every run at one time.

    Attributes
    ----------
    displacement, velocity : ndarray of float, shape (n_dofs, n_runs)
        Motion [m], [m/s] (or the same in generalised coordinates).
    acceleration : ndarray of float, shape (n_dofs, n_runs)
        Acceleration [m/s2].
    """

    displacement: Float[Array, "dofs runs"]
    velocity: Float[Array, "dofs runs"]
    acceleration: Float[Array, "dofs runs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """Hold displacement and velocity at the end of a step, of shape (n_dofs, n_runs)."""

    displacement: Float[Array, "dofs runs"]
    velocity: Float[Array, "dofs runs"]


@runtime_checkable
class Propagator(Protocol):
    """One scheme, prepared for one system and one time step."""

    dt: float

    def start(self, displacement: Float[Array, "dofs runs"]) -> State:
        """Return a state at rest, in equilibrium at the given displacement."""
        ...

    def predict(self, state: State, force: Float[Array, "dofs runs"] | None = None) -> Motion:
        """Return the motion at the step's end under a known force there (none: zero)."""
        ...

    def respond(self, force: Float[Array, "dofs columns"]) -> Motion:
        """Return the change of that motion by forces at the step's end."""
        ...

    def finish(self, state: State, motion: Motion, force: Float[Array, "dofs runs"]) -> State:
        """Return the state at the step's end, given its motion and the force there."""
        ...
