"""Hold natural modes: frequencies, and shapes by dofs or by other coordinates of a structure."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._typing import Array, SparseMatrix

__all__ = ["Basis", "Modes", "unit_rows"]

_AT_ONCE = 64  # modes whose energies are formed together


def unit_rows(dofs: Int[Array, " some"], n_dofs: int) -> SparseMatrix:
    """Return rows of weights (n, n_dofs) that each see one dof."""
    entries = (np.ones(len(dofs)), (np.arange(len(dofs)), dofs))
    return sparse.csr_array(entries, shape=(len(dofs), n_dofs))


@runtime_checkable
class Basis(Protocol):
    """Coordinates by which the motion of a structure is written: ``u = T q``."""

    @property
    def n_dofs(self) -> int:
        """Number of dofs of the structure."""
        ...

    @property
    def told(self) -> str:
        """What a result must say of modes that are written so."""
        ...

    def seen(
        self, reader: SparseMatrix, q: Float[Array, "coordinates columns"]
    ) -> Float[Array, "rows columns"]:
        """Return ``reader T q`` for rows of weights (n_rows, n_dofs)."""
        ...

    def expanded(self, q: Float[Array, "coordinates columns"]) -> Float[Array, "dofs columns"]:
        """Return ``T q``."""
        ...

    def forces(self, load: Float[Array, " dofs"]) -> Float[Array, " coordinates"]:
        """Return ``T^T load``."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes:
    """Hold the natural modes of an undamped system, scaled to unit modal mass.

    Attributes
    ----------
    omega : ndarray of float, shape (n_modes,)
        Natural circular frequencies, rising [rad/s].
    shapes : ndarray of float, shape (n_dofs, n_modes)
        Mode shapes with ``shapes.T @ M @ shapes = I`` [1/sqrt(kg)]; by the coordinates of `basis`
        where there is one.
    residuals : ndarray of float, shape (n_modes,)
        ``|K phi - lambda M phi| / |K phi|`` of each mode.
    f_max : float
        Every mode below this frequency is here [Hz].
    basis : Basis, optional
        What the shapes are written by, where they are not by the dofs themselves.
    answering : str
        Where these are combinations that answer in place of all modes below `f_max`
        (`dynamics.answering`): what a result must say of them. None may be left out then.
    """

    omega: Float[Array, " modes"]
    shapes: Float[Array, "dofs modes"]
    residuals: Float[Array, " modes"]
    f_max: float
    basis: Basis | None = None
    answering: str = ""

    @property
    def frequencies(self) -> Float[Array, " modes"]:
        """Natural frequencies [Hz]."""
        return self.omega / (2.0 * np.pi)

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return len(self.omega)

    def seen(self, reader: SparseMatrix) -> Float[Array, "rows modes"]:
        """Return the shapes as rows of weights (n_rows, n_dofs) see them."""
        if self.basis is not None:
            return self.basis.seen(reader, self.shapes)
        return np.asarray(reader @ self.shapes)

    def at(self, dofs: Int[Array, " some"]) -> Float[Array, "some modes"]:
        """Return the shapes at some dofs."""
        if self.basis is None:
            return self.shapes[dofs]
        return self.basis.seen(unit_rows(dofs, self.basis.n_dofs), self.shapes)

    def energies(self, matrix: SparseMatrix) -> Float[Array, " modes"]:
        """Return ``phi.T @ K @ phi`` of each mode: twice its energy in a stiffness [1/s2]."""
        out = np.empty(self.n_modes)
        for start in range(0, self.n_modes, _AT_ONCE):
            some = self.shapes[:, start : start + _AT_ONCE]
            some = some if self.basis is None else self.basis.expanded(some)
            out[start : start + _AT_ONCE] = np.einsum("ij,ij->j", some, matrix @ some)
        return out

    def forces(self, load: Float[Array, " dofs"]) -> Float[Array, " modes"]:
        """Return the modal forces of a load."""
        return self.shapes.T @ (load if self.basis is None else self.basis.forces(load))

    def below(self, f: float) -> Modes:
        """Return the modes below a frequency [Hz], at most `f_max`.

        Combinations that answer are all given back: they answer below it too.
        """
        if self.answering:
            return replace(self, f_max=min(f, self.f_max))
        fewer = self.first(int(np.searchsorted(self.frequencies, f)))
        return replace(fewer, f_max=min(f, self.f_max))

    def first(self, n_modes: int) -> Modes:
        """Return the first modes, with the same `f_max`."""
        return self.part(slice(n_modes))

    def combined(
        self, columns: Float[Array, "modes basis"], omega: Float[Array, " basis"]
    ) -> Modes:
        """Return combinations of the modes in their place (`dynamics.combined_modes`).

        `columns` says how much of each mode, `omega` at which circular frequency [rad/s].
        """
        return replace(
            self,
            omega=omega,
            shapes=self.shapes @ columns,
            residuals=np.full(len(omega), self.residuals.max(initial=0.0)),
        )

    def part(self, which: slice) -> Modes:
        """Return some of the modes, with the same `f_max`."""
        return replace(
            self,
            omega=self.omega[which],
            shapes=self.shapes[:, which],
            residuals=self.residuals[which],
        )
