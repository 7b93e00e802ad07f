"""Step systems exactly under forces that vary linearly over each step.

There is no period error and no numerical damping: the only error left is that of the force
between the steps.
"""

from __future__ import annotations

from copy import copy

import numpy as np
from jaxtyping import Float
from scipy import linalg

from trundle._checks import positive
from trundle._typing import Array
from trundle.dynamics.system import LinearSystem

__all__ = ["ExactRecursion", "ModalRecursion"]


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


class ExactRecursion:
    """Hold exact steps of a small dense ``M u'' + C u' + K u = p`` for linear p.

    Any damping and any rigid-body motion are allowed. With x the displacements over the
    velocities, ``x1 = phi x0 + from_start p0 + from_end p1``.

    Parameters
    ----------
    system : LinearSystem
        Dense matrices.
    dt : float
        Time step [s].

    Attributes
    ----------
    phi : ndarray of float, shape (2 n_dofs, 2 n_dofs)
        Free motion over a step.
    from_start, from_end : ndarray of float, shape (2 n_dofs, n_dofs)
        What forces at the two ends of the step add.
    """

    def __init__(self, system: LinearSystem, dt: float) -> None:
        self.dt = positive("dt", dt)
        n = system.n_dofs
        inverse = np.linalg.inv(np.asarray(system.mass))
        state_matrix = np.block(
            [
                [np.zeros((n, n)), np.eye(n)],
                [-inverse @ system.stiffness, -inverse @ system.damping],
            ]
        )
        self.phi, self.from_start, self.from_end = first_order_hold(
            state_matrix, np.vstack([np.zeros((n, n)), inverse]), dt
        )


class ModalRecursion:
    """Hold exact steps of modes ``q'' + 2 zeta omega q' + omega^2 q = p`` for linear p.

    Parameters
    ----------
    omega : ndarray of float, shape (n_modes,)
        Angular frequencies [rad/s].
    ratios : ndarray of float, shape (n_modes,)
        Damping ratios.
    dt : float
        Time step [s].

    Attributes
    ----------
    phi : ndarray of float, shape (n_modes, 2, 2)
        Free motion of displacement and velocity over a step.
    from_start, from_end : ndarray of float, shape (n_modes, 2)
        What modal forces at the two ends of the step add.
    square, double : ndarray of float, shape (n_modes,)
        ``omega^2`` and ``2 zeta omega``.
    """

    def __init__(
        self, omega: Float[Array, " modes"], ratios: Float[Array, " modes"], dt: float
    ) -> None:
        self.dt = positive("dt", dt)
        self.square = omega**2
        self.double = 2.0 * ratios * omega
        state_matrix = np.zeros((len(omega), 2, 2))
        state_matrix[:, 0, 1] = 1.0
        state_matrix[:, 1, 0] = -self.square
        state_matrix[:, 1, 1] = -self.double
        unit = np.broadcast_to(np.array([[0.0], [1.0]]), (len(omega), 2, 1))
        phi, start, end = first_order_hold(state_matrix, unit, dt)
        self.phi, self.from_start, self.from_end = phi, start[:, :, 0], end[:, :, 0]

    def part(self, modes: slice) -> ModalRecursion:
        """Return the steps of some modes alone."""
        fewer = copy(self)
        for name in ("square", "double", "phi", "from_start", "from_end"):
            setattr(fewer, name, getattr(self, name)[modes])
        return fewer
