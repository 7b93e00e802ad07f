"""A structure of which only modes are known: another program's, or measured ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from trundle._checks import frozen_array, positive, set_frozen
from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Modes
from trundle.errors import InputError
from trundle.structure.content import hash_of
from trundle.structure.elements import Elements
from trundle.structure.elements.faces import FaceGroup
from trundle.structure.model import MirrorPlane
from trundle.structure.surface import Surface, check_names, named_surface

__all__ = ["ModalModel"]

_SAME = 1e-9  # relative, within which two frequencies are one


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalModel:
    """Hold nodes, and modes at them: nothing says how it sinks, or what it weighs.

    Attributes
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Coordinates [m], z up.
    dof_index : ndarray of int, shape (n_nodes, 6)
        Row in `shapes` of each dof of each node, -1 where its motion is not known.
    omega : ndarray of float, shape (n_modes,)
        Natural circular frequencies, rising [rad/s].
    shapes : ndarray of float, shape (n_rows, n_modes)
        Mode shapes, scaled to unit modal mass [1/sqrt(kg)].
    reach : float
        Frequency below which the modes are all that there are, by whoever gave them [Hz].
    faces : tuple of FaceGroup
        Between which nodes wheels can stand.
    decks : tuple of Surface
        Surfaces of them.
    name : str
        Name for reports.
    """

    nodes: Float[Array, "nodes 3"]
    dof_index: Int[Array, "nodes 6"]
    omega: Float[Array, " modes"]
    shapes: Float[Array, "rows modes"]
    reach: float
    faces: tuple[FaceGroup, ...]
    decks: tuple[Surface, ...]
    name: str = "modes"

    def __post_init__(self) -> None:
        """Freeze arrays, and check that they belong together."""
        nodes = frozen_array("nodes", self.nodes, shape=(None, 3))
        rows = frozen_array("dof_index", self.dof_index, shape=(len(nodes), 6), dtype=np.intp)
        omega = frozen_array("omega", self.omega, shape=(None,))
        shapes = frozen_array("shapes", self.shapes, shape=(None, len(omega)))
        set_frozen(
            self,
            nodes=nodes,
            dof_index=rows,
            omega=omega,
            shapes=shapes,
            reach=positive("reach", self.reach),
        )
        if not len(omega) or omega[0] <= 0.0 or np.any(np.diff(omega) < 0.0):
            raise InputError("frequencies of modes must be above 0, and rise")
        if rows.max() >= len(shapes):
            raise InputError(f"row {rows.max()} of a node, and the shapes have {len(shapes)}")
        check_names(self.decks)

    @property
    def n_dofs(self) -> int:
        """Number of dofs at which shapes are known."""
        return len(self.shapes)

    @property
    def elements(self) -> tuple[Elements, ...]:
        """The faces."""
        return self.faces

    @property
    def expansion(self) -> SparseMatrix | None:
        """Nothing: `dof_index` says it all."""
        return None

    @property
    def surfaces(self) -> Mapping[str, Surface]:
        """What is driven and stood on, by name."""
        return {deck.name: deck for deck in self.decks}

    @property
    def mirrors(self) -> tuple[MirrorPlane, ...]:
        """None: what the modes end at, they do not say."""
        return ()

    @property
    def has_matrices(self) -> bool:
        """Whether its modes are computed, not given: no."""
        return False

    def surface(self, name: str | None = None) -> Surface:
        """Return a surface by its name; None for the only one."""
        return named_surface(self.surfaces, name)

    @property
    def content_hash(self) -> str:
        """Hash of all that decides its motion and places."""
        return self._content_hash

    @cached_property
    def _content_hash(self) -> str:
        return hash_of(self, [np.array(self.reach), self.omega, self.shapes, self.dof_index])

    def modes(self, f_max: float, *, progress: Progress | None = None) -> Modes:
        """Return the modes below a frequency [Hz]; those at the end of what is known are too.

        A study that asks for all that there are names the last frequency, and means its mode.

        Raises
        ------
        InputError
            They are not known as far.
        """
        del progress
        end = self.reach * (1.0 + _SAME)
        if f_max > end:
            raise InputError(
                f"{self.name}: modes are known to {self.reach:g} Hz; f_max may be no higher"
            )
        at_the_end = f_max > self.reach * (1.0 - 2.0 * _SAME)
        some = self.omega < 2.0 * np.pi * (end if at_the_end else f_max)
        return Modes(
            omega=self.omega[some],
            shapes=np.ascontiguousarray(self.shapes[:, some]),
            residuals=np.full(int(some.sum()), np.nan),
            f_max=f_max,
        )

    def flexibility(self) -> None:
        """Return nothing: modes do not say how a structure sinks."""

    def matrices(self) -> tuple[SparseMatrix, SparseMatrix]:
        """Refuse: there are none.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(f"{self.name} is known by its modes: it has no matrices")

    def damped_stiffness(self, other: float) -> SparseMatrix:
        """Refuse: nothing says what is of which material.

        Raises
        ------
        InputError
            Always.
        """
        del other
        raise InputError(f"{self.name} is known by its modes: give damping as a ratio")

    def inertia_of(self, dof: int) -> None:
        """Return nothing: modes at some nodes do not say what a structure weighs."""
        del dof

    def moving_mass(self, dof: int = 2) -> None:
        """Return nothing, as `inertia_of`."""
        del dof
