"""Choose what wheels and points stand on in a model that came as a mesh.

A surface is chosen by its height, by the names of its groups, or both; without any choice every
height at which there are level plates is one (level beams, where there are no plates).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure import Elements, Frame, Standable, Surface

__all__ = ["SurfaceChoice", "levels_of", "surfaces_of"]

_FLAT = 2e-3  # m, within which other programs round the heights of a level
_NEAR = 0.05  # m, by which a height that is asked for may be off
_UPRIGHT = 0.5  # of a normal: steeper than 60 degrees nothing is stood on
_SHARE = 0.01  # of the largest: level plates of less area are no storey


@dataclass(frozen=True, kw_only=True)
class SurfaceChoice:
    """Hold how a surface is chosen.

    Attributes
    ----------
    name : str
        How routes and points call it.
    height : float or None
        Of its level elements [m]; None for whatever its groups are.
    groups : tuple of str
        Names of groups of elements, such as ``PSHELL 3``; none for all.
    """

    name: str
    height: float | None = None
    groups: tuple[str, ...] = ()


def surfaces_of(
    nodes: Float[Array, "nodes 3"],
    elements: Sequence[Elements],
    choices: Sequence[SurfaceChoice] = (),
) -> tuple[Surface, ...]:
    """Return the surfaces of a model that are chosen, or all of its levels.

    Parameters
    ----------
    nodes : ndarray of float, shape (n_nodes, 3)
        Its nodes [m].
    elements : sequence of Elements
        Its groups; those are stood on that can be.
    choices : sequence of SurfaceChoice
        What is asked for.

    Raises
    ------
    InputError
        A choice that nothing answers to.
    """
    groups = [group for group in elements if isinstance(group, Standable)]
    if choices:
        return tuple(_chosen(nodes, groups, one) for one in choices)
    return tuple(_found(nodes, _plates_of(groups)))


def levels_of(
    nodes: Float[Array, "nodes 3"], groups: Sequence[Standable]
) -> list[tuple[float, float]]:
    """Return heights at which level elements lie, and how much of them [m], [m2] (or [m])."""
    z, size = np.zeros(0), np.zeros(0)
    for group in groups:
        corners = nodes[group.connectivity]
        level = np.ptp(corners[..., 2], axis=1) < _FLAT
        z = np.append(z, corners[level][..., 2].mean(axis=1))
        size = np.append(size, _sizes(corners[level]))
    order = np.argsort(z, kind="stable")
    z, size = z[order], size[order]
    starts = np.flatnonzero(np.diff(z, prepend=-np.inf) > _FLAT)
    return [
        (float(np.median(part)), float(some.sum()))
        for part, some in zip(np.split(z, starts[1:]), np.split(size, starts[1:]), strict=True)
        if len(part)
    ]


def _plates_of(groups: Sequence[Standable]) -> list[Standable]:
    """Return the groups that are stood on: plates, or beams where there are none."""
    return [g for g in groups if g.connectivity.shape[1] > 2] or list(groups)


def _sizes(corners: Array) -> Array:
    """Return areas of plates in plan, lengths of beams."""
    if corners.shape[1] == 2:
        return np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    x, y = corners[..., 0], corners[..., 1]
    return 0.5 * np.abs(np.sum(x * np.roll(y, -1, 1) - np.roll(x, -1, 1) * y, axis=1))


def _found(nodes: Array, groups: Sequence[Standable]) -> Iterator[Surface]:
    levels = levels_of(nodes, groups)
    largest = max((size for _, size in levels), default=0.0)
    kept = [height for height, size in levels if size >= _SHARE * largest]
    for height in kept:
        name = "floor" if len(kept) == 1 else f"z = {height:.4g} m"
        yield _level(name, nodes, height, groups)


def _level(name: str, nodes: Array, height: float, groups: Sequence[Standable]) -> Surface:
    frame = Frame.level(height)
    return Surface(name=name, nodes=nodes, groups=tuple(groups), frame=frame, flat=_FLAT)


def _chosen(nodes: Array, groups: Sequence[Standable], choice: SurfaceChoice) -> Surface:
    some = _named(groups, choice) if choice.groups else _plates_of(groups)
    if choice.height is None:
        frame = _plane(nodes, choice, some)
        return Surface(name=choice.name, nodes=nodes, groups=tuple(some), frame=frame, flat=_FLAT)
    heights = [height for height, _ in levels_of(nodes, some)]
    off = np.abs(np.array(heights) - choice.height)
    if not len(off) or off.min() > _NEAR:
        raise InputError(
            f"surface {choice.name!r}: no level element at {choice.height:g} m; there are levels "
            f"at {_listed(heights)}"
        )
    return _level(choice.name, nodes, heights[int(off.argmin())], some)


def _listed(heights: Sequence[float]) -> str:
    return ", ".join(f"{z:g} m" for z in heights[:8]) or "no height"


def _named(groups: Sequence[Standable], choice: SurfaceChoice) -> list[Standable]:
    there = dict.fromkeys(group.name for group in groups)
    if missing := [name for name in choice.groups if name not in there]:
        raise InputError(
            f"surface {choice.name!r}: there is no group {missing[0]!r}; there are: "
            + ", ".join(there)
        )
    return [group for group in groups if group.name in choice.groups]


def _plane(nodes: Array, choice: SurfaceChoice, groups: Sequence[Standable]) -> Frame:
    """Return the plane that groups lie in.

    Raises
    ------
    InputError
        They lie in none, or in one that stands.
    """
    used = np.unique(np.concatenate([group.connectivity.ravel() for group in groups]))
    at = nodes[used]
    middle = at.mean(axis=0)
    normal = np.linalg.svd(at - middle, full_matrices=False)[2][2]
    off = float(np.abs((at - middle) @ normal).max())
    if np.ptp(at[:, 2]) < _FLAT:
        return Frame.level(float(np.median(at[:, 2])))
    if off >= _FLAT:
        heights = [height for height, _ in levels_of(nodes, groups)]
        raise InputError(
            f"surface {choice.name!r}: its groups lie in no plane (off by {off:.3g} m); add the "
            f"height of one of its levels: {_listed(heights)}"
        )
    if abs(normal[2]) < _UPRIGHT:
        raise InputError(f"surface {choice.name!r}: its groups stand upright")
    slope = -normal[:2] / normal[2]
    return Frame.through(np.array([middle[2] - slope @ middle[:2], *slope]))
