"""Step systems exactly under forces that vary linearly over each step.

There is no period error and no numerical damping: the only error left is that of the force
between the steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._checks import positive, set_frozen
from trundle._typing import Array
from trundle.dynamics.stepping import Motion, State
from trundle.dynamics.system import LinearSystem

__all__ = ["ExactPropagator", "Modal", "ModalPropagator"]


@dataclass(frozen=True, kw_only=True)
class Modal:
    """Choose modal superposition with all modes below a frequency, stepped exactly.

    Attributes
    ----------
    f_max : float
        All modes below this frequency are kept [Hz].
    dt : float
        Time step [s].
    residual : bool
        Add the static flexibility of the modes left out (True), or leave them out altogether.
    """

    f_max: float
    dt: float
    residual: bool = True

    def __post_init__(self) -> None:
        """Check both numbers."""
        set_frozen(self, f_max=positive("f_max", self.f_max), dt=positive("dt", self.dt))

    def __str__(self) -> str:
        """Describe the method for a report."""
        rest = "" if self.residual else "nothing for the modes above, "
        return (
            f"modal superposition, modes below {self.f_max:g} Hz, {rest}exact recursion, "
            f"dt = {1e3 * self.dt:g} ms"
        )


def first_order_hold(state_matrix: Array, input_matrix: Array, dt: float) -> tuple[Array, ...]:
    """Return Phi, Gamma0, Gamma1 of ``x1 = Phi x0 + Gamma0 f0 + Gamma1 f1`` for linear f.

    Works on stacks: shapes (..., n, n) and (..., n, k).

    References
    ----------
    C. F. Van Loan, IEEE Trans. Autom. Control 23 (1978) 395-404.
    """
    n, k = input_matrix.shape[-2:]
    size = n + 2 * k
    block = np.zeros((*state_matrix.shape[:-2], size, size))
    block[..., :n, :n] = state_matrix * dt
    block[..., :n, n : n + k] = input_matrix * dt
    block[..., n : n + k, n + k :] = np.eye(k)
    power = linalg.expm(block)
    phi, hold, ramp = power[..., :n, :n], power[..., :n, n : n + k], power[..., :n, n + k :]
    return phi, hold - ramp, ramp


class ExactPropagator:
    """Step a small dense ``M u'' + C u' + K u = p`` exactly for linear p.

    Any damping and any rigid-body motion are allowed.
    """

    def __init__(self, system: LinearSystem, dt: float) -> None:
        self.dt = positive("dt", dt)
        self.system = system
        n = system.n_dofs
        inverse = np.linalg.inv(np.asarray(system.mass))
        self._inverse = inverse
        state_matrix = np.block(
            [
                [np.zeros((n, n)), np.eye(n)],
                [-inverse @ system.stiffness, -inverse @ system.damping],
            ]
        )
        self._phi, self._start, self._end = first_order_hold(
            state_matrix, np.vstack([np.zeros((n, n)), inverse]), dt
        )

    def start(self, displacement: Float[Array, "dofs runs"]) -> State:
        """Return a state at rest, in equilibrium at the given displacement."""
        zero = np.zeros_like(displacement)
        return State(
            displacement=displacement,
            velocity=zero,
            acceleration=zero,
            force=self.system.stiffness @ displacement,
        )

    def predict(self, state: State, force: Float[Array, "dofs runs"] | None = None) -> Motion:
        """Return the motion at the step's end under a known force there (none: zero)."""
        x = self._phi @ np.vstack([state.displacement, state.velocity]) + self._start @ state.force
        if force is not None:
            x = x + self._end @ force
        n = self.system.n_dofs
        return Motion(displacement=x[:n], velocity=x[n:])

    def respond(self, force: Float[Array, "dofs columns"]) -> Motion:
        """Return the change of that motion by forces at the step's end."""
        x = self._end @ force
        n = self.system.n_dofs
        return Motion(displacement=x[:n], velocity=x[n:])

    def finish(self, state: State, motion: Motion, force: Float[Array, "dofs runs"]) -> State:
        """Return the state at the step's end, given its motion and the force there."""
        del state
        s = self.system
        acceleration = self._inverse @ (
            force - s.damping @ motion.velocity - s.stiffness @ motion.displacement
        )
        return State(
            displacement=motion.displacement,
            velocity=motion.velocity,
            acceleration=acceleration,
            force=force,
        )


class ModalPropagator:
    """Step uncoupled modes ``q'' + 2 zeta omega q' + omega^2 q = p`` exactly for linear p."""

    def __init__(
        self, omega: Float[Array, " modes"], ratios: Float[Array, " modes"], dt: float
    ) -> None:
        self.dt = positive("dt", dt)
        self._square = omega**2
        self._double = 2.0 * ratios * omega
        state_matrix = np.zeros((len(omega), 2, 2))
        state_matrix[:, 0, 1] = 1.0
        state_matrix[:, 1, 0] = -(omega**2)
        state_matrix[:, 1, 1] = -2.0 * ratios * omega
        unit = np.broadcast_to(np.array([[0.0], [1.0]]), (len(omega), 2, 1))
        phi, start, end = first_order_hold(state_matrix, unit, dt)
        self.phi, self.from_start, self.from_end = phi, start[:, :, 0], end[:, :, 0]

    def start(self, displacement: Float[Array, "modes runs"]) -> State:
        """Return a state at rest, in equilibrium at the given displacement."""
        zero = np.zeros_like(displacement)
        return State(
            displacement=displacement,
            velocity=zero,
            acceleration=zero[:0],
            force=self._square[:, None] * displacement,
        )

    def predict(self, state: State, force: Float[Array, "modes runs"] | None = None) -> Motion:
        """Return the motion at the step's end under a known force there (none: zero)."""
        terms = ((self.phi[:, :, 0], state.displacement), (self.phi[:, :, 1], state.velocity))
        terms += ((self.from_start, state.force),)
        if force is not None:
            terms += ((self.from_end, force),)
        out = (np.empty_like(state.displacement), np.empty_like(state.displacement))
        scratch = np.empty_like(state.displacement)
        for row, motion in enumerate(out):
            for i, (factor, values) in enumerate(terms):
                np.multiply(factor[:, row, None], values, out=scratch if i else motion)
                if i:
                    np.add(motion, scratch, out=motion)
        return Motion(displacement=out[0], velocity=out[1])

    def respond(self, force: Float[Array, "modes columns"]) -> Motion:
        """Return the change of that motion by forces at the step's end."""
        return Motion(
            displacement=self.from_end[:, 0, None] * force,
            velocity=self.from_end[:, 1, None] * force,
        )

    def finish(self, state: State, motion: Motion, force: Float[Array, "modes runs"]) -> State:
        """Return the state at the step's end; its acceleration is left to `acceleration`."""
        return State(
            displacement=motion.displacement,
            velocity=motion.velocity,
            acceleration=state.acceleration,
            force=force,
        )

    def acceleration(
        self, rows: Float[Array, "points modes"], state: State
    ) -> Float[Array, "points runs"]:
        """Return ``rows @ q''`` from the equation of motion, without forming q'' of every mode."""
        return (
            rows @ state.force
            - (rows * self._double) @ state.velocity
            - (rows * self._square) @ state.displacement
        )
