"""Hold the one value to which every vibrating thing reduces: mass, damping, stiffness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from trundle._checks import set_frozen
from trundle._typing import Array, Matrix
from trundle.errors import InputError


@dataclass(frozen=True, kw_only=True, eq=False)
class LinearSystem:
    """Hold the matrices of ``M u'' + C u' + K u = p``.

    Attributes
    ----------
    mass : ndarray or sparse array, shape (n_dofs, n_dofs)
        Mass matrix M, symmetric [kg, kg m2].
    damping : ndarray or sparse array, shape (n_dofs, n_dofs)
        Viscous damping matrix C [N s/m].
    stiffness : ndarray or sparse array, shape (n_dofs, n_dofs)
        Stiffness matrix K [N/m].

    Raises
    ------
    InputError
        Matrices that are not square, not of one size, or hold a number that is not finite.
    """

    mass: Matrix
    damping: Matrix
    stiffness: Matrix

    def __post_init__(self) -> None:
        """Convert to float64 and check shapes and numbers once."""
        converted = {
            name: _as_matrix(name, getattr(self, name)) for name in ("mass", "damping", "stiffness")
        }
        if len({matrix.shape for matrix in converted.values()}) != 1:
            shapes = ", ".join(f"{name} {matrix.shape}" for name, matrix in converted.items())
            raise InputError(f"mass, damping and stiffness must have one shape; got {shapes}")
        set_frozen(self, **converted)

    @property
    def n_dofs(self) -> int:
        """Number of degrees of freedom."""
        return int(self.mass.shape[0])

    @property
    def is_sparse(self) -> bool:
        """True when the matrices are sparse arrays."""
        return sparse.issparse(self.stiffness)


def block_diagonal(systems: tuple[LinearSystem, ...]) -> LinearSystem:
    """Join systems that do not touch each other into one, in the order given."""
    joined = {
        name: _dense_blocks([np.asarray(getattr(system, name)) for system in systems])
        for name in ("mass", "damping", "stiffness")
    }
    return LinearSystem(**joined)


def _dense_blocks(blocks: list[Array]) -> Array:
    size = sum(len(block) for block in blocks)
    out = np.zeros((size, size))
    at = 0
    for block in blocks:
        out[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return out


def _as_matrix(name: str, matrix: Matrix) -> Matrix:
    converted: Matrix
    if sparse.issparse(matrix):
        converted = sparse.csc_array(matrix, dtype=np.float64)
        numbers = converted.data
    else:
        converted = np.array(matrix, dtype=np.float64)
        converted.setflags(write=False)
        numbers = converted
    if converted.ndim != 2 or converted.shape[0] != converted.shape[1]:
        raise InputError(f"{name} must be a square matrix; got shape {converted.shape}")
    if not np.all(np.isfinite(numbers)):
        raise InputError(f"{name} must be finite; it holds NaN or infinity")
    return converted
