"""Grow a block Krylov basis that stays orthonormal in the mass inner product."""

from __future__ import annotations

import numpy as np
from scipy import linalg, sparse

from trundle._typing import Array
from trundle.dynamics.pencil import Product
from trundle.dynamics.sparse_solver import Factor

__all__ = ["BLOCK", "Krylov"]

BLOCK = 12  # columns: smaller blocks converge in fewer columns, larger ones step faster
_DEPENDENT = 1e-3  # diagonal of R against its largest: columns that nearly depend


class Krylov:
    """A growing M-orthonormal basis V of a block Krylov space, and ``V^T M A^-1 M V``.

    Each step orthogonalises against the two blocks before it, as a Lanczos step does, and once
    against all, which keeps round-off from bringing found eigenvectors back. Where M is no sparse
    matrix a product with it costs more than reading M V again, and M V is kept.
    """

    def __init__(
        self,
        mass: Product,
        factor: Factor,
        capacity: int,
        *,
        beside: Array | None = None,
        start: int = 0,
    ) -> None:
        """`beside` (n_dofs, n_found) are vectors that the space stays M-orthogonal to.

        `start` chooses the vectors that the space grows from.
        """
        self._mass, self._factor, self._capacity = mass, factor, capacity
        n_dofs = mass.shape[0]
        self._beside = np.zeros((n_dofs, 0)) if beside is None else beside
        self._basis = np.zeros((n_dofs, capacity + BLOCK), order="F")
        dear = not sparse.issparse(mass)
        self._loaded_basis = np.zeros_like(self._basis) if dear else None
        self._projected = np.zeros((capacity + BLOCK, capacity + BLOCK))
        drawn = np.random.default_rng(start).standard_normal((n_dofs, BLOCK))
        first = self._apart(factor.solve(mass @ drawn))
        self._block, self._loaded, self._triangle = _orthonormal(mass, first)
        self.size = 0

    def extend(self) -> bool:
        """Take the last block into the basis and form the next; False if there is no room."""
        if self.size + 2 * BLOCK > self._capacity:
            return False
        before, here = self.size, slice(self.size, self.size + BLOCK)
        self._basis[:, here] = self._block
        if self._loaded_basis is not None:
            self._loaded_basis[:, here] = self._loaded
        self.size += BLOCK
        basis = self._basis[:, : self.size]
        new = self._apart(self._factor.solve(self._loaded))
        # Large parts lie along the last two blocks; the rest is what round-off brings back.
        overlap = np.zeros((self.size, BLOCK))
        overlap[here] = self._loaded.T @ new
        if before:
            overlap[before - BLOCK : before] = self._triangle.T
        near = slice(max(0, before - BLOCK), self.size)
        new -= basis[:, near] @ overlap[near]
        if self._loaded_basis is not None:
            correction = self._loaded_basis[:, : self.size].T @ new
        else:
            correction = basis.T @ (self._mass @ new)
        new -= basis @ correction
        self._block, self._loaded, self._triangle = _orthonormal(self._mass, new)
        sizes = np.abs(np.diag(self._triangle))
        if sizes.min() < _DEPENDENT * sizes.max():  # scaling up brings the basis back in
            again = self._block - basis @ (basis.T @ self._loaded)
            self._block, self._loaded, scale = _orthonormal(self._mass, again)
            self._triangle = scale @ self._triangle
        overlap += correction
        self._projected[: self.size, here] = overlap
        self._projected[here, : self.size] = overlap.T
        return True

    def _apart(self, block: Array) -> Array:
        """Take off what lies along the vectors beside the space."""
        if not self._beside.shape[1]:
            return block
        return block - self._beside @ (self._beside.T @ (self._mass @ block))

    def ritz_pairs(self) -> tuple[Array, Array, Array]:
        """Return inverse eigenvalues, rising, their vectors in the basis, and error bounds."""
        projected = self._projected[: self.size, : self.size]
        nu, ritz = linalg.eigh(projected)
        return nu, ritz, np.linalg.norm(self._triangle @ ritz[-BLOCK:], axis=0)

    def vectors(self, ritz: Array) -> Array:
        """Return vectors in full coordinates."""
        return self._basis[:, : self.size] @ ritz


def _orthonormal(mass: Product, block: Array) -> tuple[Array, Array, Array]:
    """Return an M-orthonormal block, M times it, and R of ``block = orthonormal @ R``."""
    loaded, triangle = mass @ block, np.eye(block.shape[1])
    for _ in range(2):  # the second time on a block that is orthonormal but for round-off
        lower = linalg.cholesky(block.T @ loaded, lower=True)
        back = linalg.solve_triangular(lower, np.eye(len(lower)), lower=True).T
        block, loaded = block @ back, loaded @ back
        triangle = lower.T @ triangle
    return block, loaded, triangle
