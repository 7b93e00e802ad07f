"""Integrate directly in time with Newmark's method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float
from scipy import linalg, sparse

from trundle._typing import Array, Matrix
from trundle.dynamics.damping import Rayleigh
from trundle.dynamics.sparse_solver import Factor, HalfSolve, factorise
from trundle.dynamics.stepping import Motion, State
from trundle.dynamics.system import LinearSystem

__all__ = ["HalfStep", "NewmarkParameters", "NewmarkPropagator"]


@runtime_checkable
class NewmarkParameters(Protocol):
    """A time step [s] and Newmark's two parameters."""

    @property
    def dt(self) -> float:
        """Time step [s]."""
        ...

    @property
    def gamma(self) -> float:
        """Share of the step's last acceleration in its velocity."""
        ...

    @property
    def beta(self) -> float:
        """Share of it in its displacement."""
        ...


class _DenseSolver:
    def __init__(self, matrix: Array) -> None:
        self._factor = linalg.lu_factor(matrix)

    def solve(self, right_hand_side: Array) -> Array:
        return linalg.lu_solve(self._factor, right_hand_side)


@dataclass(frozen=True, kw_only=True, eq=False)
class HalfStep:
    """Hold a step whose solution is half done: forces may still be added to it.

    Attributes
    ----------
    forward : ndarray of float, shape (n_dofs, n_runs)
        ``L^-1`` times the load without forces at the step's end, in the solver's order.
    displacement, velocity : ndarray of float, shape (n_dofs, n_runs)
        Newmark's predictors.
    past : ndarray of float, shape (n_dofs, n_runs)
        What the displacement gains without a solution.
    """

    forward: Float[Array, "dofs runs"]
    displacement: Float[Array, "dofs runs"]
    velocity: Float[Array, "dofs runs"]
    past: Float[Array, "dofs runs"]


class NewmarkPropagator:
    """Step ``M u'' + C u' + K u = p`` with one factorisation of the effective stiffness.

    Notes
    -----
    With predictors ``u^ = u + dt u' + dt^2 (1/2 - beta) u''`` and
    ``v^ = u' + dt (1 - gamma) u''`` the end of the step follows from
    ``(K + a1 C + a0 M) u = p + M a0 u^ + C (a1 u^ - v^)``, with ``a0 = 1 / (beta dt^2)`` and
    ``a1 = gamma / (beta dt)``; then ``u' = v^ + a1 (u - u^)`` and ``u'' = a0 (u - u^)``.

    Where ``C = alpha M + b K``, K is what the effective matrix A leaves after its mass part, so
    ``C w = alpha M w + b' (A w - (a0 + a1 alpha) M w)`` with ``b' = b / (1 + a1 b)``; the part
    ``b' A w`` needs no solution, and a step no product with K: one with M is left.

    References
    ----------
    N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94.
    """

    def __init__(
        self,
        system: LinearSystem,
        method: NewmarkParameters,
        *,
        rayleigh: Rayleigh | None = None,
        backend: str | None = None,
    ) -> None:
        self.dt = method.dt
        self.method = method
        self.system = system
        self.a0 = 1.0 / (method.beta * method.dt**2)
        self.a1 = method.gamma / (method.beta * method.dt)
        effective = system.stiffness + self.a1 * system.damping + self.a0 * system.mass
        self.solver = _factor(effective, backend)
        self._rayleigh = rayleigh
        alpha, b = (0.0, 0.0) if rayleigh is None else (rayleigh.alpha, rayleigh.beta)
        self._past_solution = b / (1.0 + self.a1 * b)
        self._on_mass = alpha - self._past_solution * (self.a0 + self.a1 * alpha)

    def start(self, displacement: Float[Array, "dofs runs"]) -> State:
        """Return a state at rest, in equilibrium at the given displacement."""
        zero = np.zeros_like(displacement)
        return State(displacement=displacement, velocity=zero, acceleration=zero)

    def predict(self, state: State, force: Float[Array, "dofs runs"] | None = None) -> Motion:
        """Return the motion at the step's end under a known force there (none: zero)."""
        u_hat, v_hat = self._predictors(state)
        w = self.a1 * u_hat - v_hat
        load = self._load(u_hat, w)
        if force is not None:
            load = load + force
        u = self.solver.solve(load)
        if self._rayleigh is not None:
            u = u + self._past_solution * w
        return Motion(displacement=u, velocity=v_hat + self.a1 * (u - u_hat))

    @property
    def halves(self) -> tuple[HalfSolve, HalfSolve] | None:
        """Both halves of a solution, where the solver offers them."""
        return None if isinstance(self.solver, _DenseSolver) else self.solver.halves()

    def begin(self, state: State, forward: HalfSolve) -> HalfStep:
        """Do the first half of a step without forces at its end."""
        u_hat, v_hat = self._predictors(state)
        w = self.a1 * u_hat - v_hat
        load = self._load(u_hat, w)
        return HalfStep(
            forward=forward(load), displacement=u_hat, velocity=v_hat, past=self._past_solution * w
        )

    def complete(self, half: HalfStep, back: HalfSolve) -> State:
        """Do the second half, whatever was added to the first half's solution."""
        change = back(half.forward)
        change += half.past
        u = change.copy()
        change -= half.displacement
        return State(
            displacement=u,
            velocity=half.velocity + self.a1 * change,
            acceleration=self.a0 * change,
        )

    def _load(self, u_hat: Array, w: Array) -> Array:
        if self._rayleigh is None:
            return self.system.mass @ (self.a0 * u_hat) + self.system.damping @ w
        return self.system.mass @ (self.a0 * u_hat + self._on_mass * w)

    def respond(self, force: Float[Array, "dofs columns"]) -> Motion:
        """Return the change of that motion by forces at the step's end."""
        u = self.solver.solve(force)
        return Motion(displacement=u, velocity=self.a1 * u)

    def finish(
        self, state: State, motion: Motion, force: Float[Array, "dofs runs"] | None = None
    ) -> State:
        """Return the state at the step's end; the force is already in the motion."""
        del force
        u_hat, _ = self._predictors(state)
        return State(
            displacement=motion.displacement,
            velocity=motion.velocity,
            acceleration=self.a0 * (motion.displacement - u_hat),
        )

    def _predictors(self, state: State) -> tuple[Array, Array]:
        dt, method = self.dt, self.method
        u_hat = (
            state.displacement
            + dt * state.velocity
            + (dt**2 * (0.5 - method.beta)) * state.acceleration
        )
        return u_hat, state.velocity + (dt * (1.0 - method.gamma)) * state.acceleration


def _factor(effective: Matrix, backend: str | None) -> Factor | _DenseSolver:
    if sparse.issparse(effective):
        return factorise(sparse.csc_array(effective), backend=backend)
    return _DenseSolver(np.asarray(effective))
