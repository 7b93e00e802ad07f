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

    Vectors are stored as rows: products of few rows with many take half the time of products of
    many columns with few.
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
        self._beside = np.zeros((0, n_dofs)) if beside is None else np.ascontiguousarray(beside.T)
        self._basis = np.zeros((capacity + BLOCK, n_dofs))
        dear = not sparse.issparse(mass)
        self._loaded_basis = np.zeros((capacity + BLOCK, n_dofs)) if dear else None
        self._projected = np.zeros((capacity + BLOCK, capacity + BLOCK))
        drawn = np.random.default_rng(start).standard_normal((n_dofs, BLOCK))
        first = self._apart(_solved(factor, _times(mass, np.ascontiguousarray(drawn.T))))
        self._block, self._loaded, self._triangle = _orthonormal(mass, first)
        self.size = 0

    def extend(self) -> bool:
        """Take the last block into the basis and form the next.

        False if there is no room, or nothing further to be found from where it began.
        """
        if self.size + 2 * BLOCK > self._capacity:
            return False
        before, here = self.size, slice(self.size, self.size + BLOCK)
        self._basis[here] = self._block
        if self._loaded_basis is not None:
            self._loaded_basis[here] = self._loaded
        self.size += BLOCK
        basis = self._basis[: self.size]
        new = self._apart(_solved(self._factor, self._loaded))
        # Large parts lie along the last two blocks; the rest is what round-off brings back.
        overlap = np.zeros((BLOCK, self.size))
        overlap[:, here] = new @ self._loaded.T
        if before:
            overlap[:, before - BLOCK : before] = self._triangle
        near = slice(max(0, before - BLOCK), self.size)
        new -= overlap[:, near] @ basis[near]
        if self._loaded_basis is not None:
            correction = new @ self._loaded_basis[: self.size].T
        else:
            correction = _times(self._mass, new) @ basis.T
        new -= correction @ basis
        overlap += correction
        self._projected[here, : self.size] = overlap
        self._projected[: self.size, here] = overlap.T
        try:
            self._block, self._loaded, self._triangle = self._next_block(new, basis)
        except linalg.LinAlgError:  # round-off alone is left: the space is whole
            self._triangle = np.zeros((BLOCK, BLOCK))
            self._capacity = self.size
            return False
        return True

    def _next_block(self, new: Array, basis: Array) -> tuple[Array, Array, Array]:
        """Return what `_orthonormal` does, of a block that stays apart from the basis."""
        block, loaded, triangle = _orthonormal(self._mass, new)
        sizes = np.abs(np.diag(triangle))
        if sizes.min() >= _DEPENDENT * sizes.max():
            return block, loaded, triangle
        again = block - (loaded @ basis.T) @ basis  # scaling up brings the basis back in
        block, loaded, scale = _orthonormal(self._mass, again)
        return block, loaded, scale @ triangle

    def _apart(self, block: Array) -> Array:
        """Take off what lies along the vectors beside the space."""
        if not len(self._beside):
            return block
        return block - (_times(self._mass, block) @ self._beside.T) @ self._beside

    def ritz_pairs(self) -> tuple[Array, Array, Array]:
        """Return inverse eigenvalues, rising, their vectors in the basis, and error bounds."""
        projected = self._projected[: self.size, : self.size]
        nu, ritz = linalg.eigh(projected)
        return nu, ritz, np.linalg.norm(self._triangle @ ritz[-BLOCK:], axis=0)

    def vectors(self, ritz: Array) -> Array:
        """Return vectors in full coordinates, (n_dofs, n_vectors)."""
        return (ritz.T @ self._basis[: self.size]).T


def _times(mass: Product, rows: Array) -> Array:
    """Return ``M x`` of vectors that are rows, as rows."""
    return np.ascontiguousarray((mass @ rows.T).T)


def _solved(factor: Factor, rows: Array) -> Array:
    """Return ``A^-1 x`` of vectors that are rows, as rows."""
    return np.ascontiguousarray(factor.solve(rows.T).T)


def _orthonormal(mass: Product, rows: Array) -> tuple[Array, Array, Array]:
    """Return M-orthonormal rows, M times them, and R of ``rows = R^T @ orthonormal``."""
    loaded, triangle = _times(mass, rows), np.eye(len(rows))
    for _ in range(2):  # the second time on a block that is orthonormal but for round-off
        lower = linalg.cholesky(rows @ loaded.T, lower=True)
        back = linalg.solve_triangular(lower, np.eye(len(lower)), lower=True)
        rows, loaded = back @ rows, back @ loaded
        triangle = lower.T @ triangle
    return rows, loaded, triangle
