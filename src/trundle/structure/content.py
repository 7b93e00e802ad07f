"""Name a structure by its content: by what decides how it moves, and where it stands.

A worker keeps what it has prepared of a structure by this name: two that share it must answer
every question alike, those too that ask where a surface is.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from typing import Protocol, runtime_checkable

import numpy as np

from trundle._typing import Array, SparseMatrix
from trundle.structure.elements.faces import FaceGroup
from trundle.structure.elements.protocol import Damped, Elements
from trundle.structure.model import MirrorPlane
from trundle.structure.surface import Surface

__all__ = ["hash_of", "parts_of"]


@runtime_checkable
class _Placed(Protocol):
    """What any structure knows of places."""

    @property
    def nodes(self) -> Array:
        """Place of every node [m]."""
        ...

    @property
    def elements(self) -> tuple[Elements, ...]:
        """All groups of elements."""
        ...

    @property
    def decks(self) -> tuple[Surface, ...]:
        """Surfaces that were given."""
        ...

    @property
    def mirrors(self) -> tuple[MirrorPlane, ...]:
        """Planes of symmetry."""
        ...


def parts_of(matrix: SparseMatrix) -> list[Array]:
    """Return the arrays that a sparse matrix is made of."""
    return [matrix.indptr, matrix.indices, matrix.data]


def hash_of(structure: _Placed, motion: Sequence[Array]) -> str:
    """Return a hash of what decides the motion of a structure, and of all its places.

    Parameters
    ----------
    structure : Floor, MatrixModel or ModalModel
        Its nodes, elements, surfaces and planes of symmetry count; names of all but surfaces,
        by which routes and points call them, do not.
    motion : sequence of ndarray
        Matrices or modes, and whose motion they are.
    """
    digest = hashlib.sha256()
    for part in _parts(structure, motion):
        digest.update(part)
        digest.update(b"|")
    return digest.hexdigest()[:16]


def _parts(structure: _Placed, motion: Sequence[Array]) -> Iterator[bytes]:
    yield from _arrays([*motion, structure.nodes])
    yield from _groups(structure.elements)
    for deck in structure.decks:
        frame = deck.frame
        yield repr((deck.name, deck.flat)).encode()
        yield from _arrays([deck.nodes, frame.origin, frame.x_axis, frame.y_axis])
        yield from _groups(deck.groups)
    for mirror in structure.mirrors:
        yield from _arrays([mirror.normal, np.array(mirror.position)])


def _arrays(arrays: Iterable[Array]) -> Iterator[bytes]:
    for array in arrays:
        yield f"{array.dtype.str} {array.shape}".encode()
        yield np.ascontiguousarray(array).tobytes()


def _groups(groups: Iterable[Elements]) -> Iterator[bytes]:
    """Give which elements there are, how they are stood on and damped."""
    for group in groups:
        damped = group.damping_ratio if isinstance(group, Damped) else None
        smooth = group.smooth if isinstance(group, FaceGroup) else None
        yield repr((type(group).__name__, damped, smooth)).encode()
        yield from _arrays([np.asarray(group.connectivity)])
