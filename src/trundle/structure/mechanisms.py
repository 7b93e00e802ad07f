"""Find parts of a structure that nothing holds, before a solver stumbles over them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float, Int

from trundle._typing import Array
from trundle.structure.elements import GROUND, SpringGroup
from trundle.structure.floor import Floor
from trundle.structure.links import own_motion
from trundle.structure.mesh.merging import linked

__all__ = ["loose_parts"]

_HELD = 1e-9  # of the largest, below which an eigenvalue of what is held is nought
_MOTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")


def loose_parts(floor: Floor) -> list[str]:
    """Name the parts that can move as rigid bodies, and say how.

    Parameters
    ----------
    floor : Floor
        A structure; its elements and links say what is joined.

    Returns
    -------
    list of str
        One sentence for each part that supports and springs do not hold in all six motions.
    """
    part = _parts(floor)
    held = _held(floor, part)
    return [
        f"{_named(floor, part == i)} {_motion(held[i])}"
        for i in range(len(held))
        if np.linalg.matrix_rank(held[i], tol=_HELD * max(held[i].max(), 1e-300), hermitian=True)
        < 6
    ]


def _parts(floor: Floor) -> Int[Array, " nodes"]:
    """Return the number of the part that each node belongs to; -1 where no element is."""
    n = len(floor.nodes)
    pairs = [np.stack([link.leads, link.follows], axis=1) for link in floor.links]
    used = np.zeros(n, dtype=bool)
    for group in floor.elements:
        ends = group.connectivity
        used[ends[ends != GROUND]] = True
        some = [ends[:, [0, i]] for i in range(1, ends.shape[1])]
        pairs += [pair[(pair != GROUND).all(axis=1)] for pair in some]
    both = np.concatenate([np.zeros((0, 2), dtype=np.intp), *pairs])
    _, number = np.unique(linked(both, n)[used], return_inverse=True)
    out = np.full(n, -1, dtype=np.intp)
    out[used] = number
    return out


def _held(floor: Floor, part: Array) -> Float[Array, "parts 6 6"]:
    """Return for each part which rigid motions work against supports, as a form of rank 6 or less.

    Distances are measured from the middle of everything, in its size, so that turning counts like
    moving.
    """
    middle = floor.nodes.mean(axis=0)
    size = max(float(np.ptp(floor.nodes, axis=0).max()), 1.0)
    r = (floor.nodes - middle) / size
    node, dof = np.nonzero(floor.fixed)
    own = own_motion(np.arange(floor.fixed.size).reshape(-1, 6), floor.fixed.size, floor.angles)
    along_own = own.T @ _rigid(r).reshape(-1, 6)
    nodes, motions = [node], [along_own[6 * node + dof]]
    for group in floor.springs:
        for row, stiff in _grounded(group):
            nodes.append(np.full(int(stiff.sum()), row))
            motions.append(_rigid(r[[row]])[0, stiff])
    node, rows = np.concatenate(nodes), np.concatenate(motions)
    node, rows = node[part[node] >= 0], rows[part[node] >= 0]
    out = np.zeros((int(part.max(initial=-1)) + 1, 6, 6))
    np.add.at(out, part[node], rows[:, :, None] * rows[:, None, :])
    return out


def _grounded(group: SpringGroup) -> Iterator[tuple[int, Array]]:
    """Give nodes that springs join to the ground, and the dofs in which they are stiff."""
    for a, b in group.elements.tolist():
        if GROUND in (a, b):
            yield max(a, b), group.stiffness > 0.0


def _rigid(r: Array) -> Float[Array, "nodes 6 6"]:
    """Return each dof of nodes under the six rigid motions."""
    out = np.zeros((len(r), 6, 6))
    out[:, range(6), range(6)] = 1.0
    x, y, z = r.T
    out[:, 0, 4], out[:, 0, 5] = z, -y
    out[:, 1, 3], out[:, 1, 5] = -z, x
    out[:, 2, 3], out[:, 2, 4] = y, -x
    return out


def _motion(held: Array) -> str:
    """Say how a part can move."""
    values, vectors = np.linalg.eigh(held)
    free = vectors[:, values <= _HELD * max(values[-1], 1e-300)]
    if free.shape[1] == 6:
        return "is held by nothing"
    names = [name for i, name in enumerate(_MOTIONS) if np.linalg.norm(free[i]) > 0.3]
    moves = ["moves " + name for name in names if name.startswith("along")]
    turns = ["turns " + name for name in names if name.startswith("about")]
    return f"is not held: it {' and '.join([*moves, *turns])}"


def _named(floor: Floor, mine: Array) -> str:
    names = {
        group.name
        for group in floor.elements
        if mine[group.connectivity[group.connectivity != GROUND]].any()
    }
    low, high = floor.nodes[mine].min(axis=0), floor.nodes[mine].max(axis=0)
    where = ", ".join(
        f"{axis} {a:g}" if b - a < 1e-6 else f"{axis} {a:g} to {b:g}"
        for axis, a, b in zip("xyz", low, high, strict=True)
    )
    return f"the part of {', '.join(sorted(names))} at {where} m"
