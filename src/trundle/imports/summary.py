"""Sum up a model: what an engineer looks at before believing that it came over whole."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._typing import Array, SparseMatrix
from trundle.errors import ComputationError, InputError
from trundle.imports.model_format import ReadModel
from trundle.structure import Floor, MatrixModel, ModalModel, Structure, Surface
from trundle.structure.elements import GROUND, Elements
from trundle.structure.frames import plate_areas
from trundle.structure.links import own_motion

__all__ = ["GroupSummary", "ModelSummary", "SurfaceSummary", "summary_of"]

_FIRST_MODES = 10
_HIGHEST = 2000.0  # Hz, to which first modes are looked for
_KINDS = {1: "points", 2: "lines", 3: "triangles", 4: "quadrilaterals"}


@dataclass(frozen=True, kw_only=True)
class GroupSummary:
    """Hold what a group of elements comes to.

    Attributes
    ----------
    name, kind : str
        What it is called, and what its elements are.
    count : int
        How many there are.
    size : float
        Area of plates [m2], length of lines [m].
    mass : float
        That moves vertically [kg].
    """

    name: str
    kind: str
    count: int
    size: float
    mass: float


@dataclass(frozen=True, kw_only=True)
class SurfaceSummary:
    """Hold what can be stood on.

    Attributes
    ----------
    name : str
        How routes and points call it.
    lowest, highest : float
        Heights between which it lies [m].
    area : float
        [m2]; length of beams [m].
    low, high : tuple of float
        Least and largest x, y in its frame [m].
    """

    name: str
    lowest: float
    highest: float
    area: float
    low: tuple[float, float]
    high: tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class ModelSummary:
    """Hold what a model comes to.

    Attributes
    ----------
    name, units : str
        What it is called; units of its file.
    n_nodes, n_dofs : int
        How many there are.
    low, high : ndarray of float, shape (3,)
        Corners of the box round all nodes [m].
    groups : tuple of GroupSummary
        Its elements.
    surfaces : tuple of SurfaceSummary
        What can be stood on.
    mass : ndarray of float, shape (6,), or None
        Mass along x, y, z [kg], and moments of inertia about the centre of mass [kg m2], without
        supports; None where nothing says it.
    centre : ndarray of float, shape (3,), or None
        Centre of mass [m].
    rigid : ndarray of float, shape (6,), or None
        Largest force that a rigid motion raises without supports, against the largest stiffness:
        nought but for springs to the ground, and for elements that are not sound.
    frequencies : ndarray of float, shape (n,)
        First natural frequencies, as it is held [Hz].
    unmoved : str
        Why there are none.
    told : tuple of str
        What was passed over, and what was assumed.
    """

    name: str
    units: str
    n_nodes: int
    n_dofs: int
    low: Float[Array, " 3"]
    high: Float[Array, " 3"]
    groups: tuple[GroupSummary, ...]
    surfaces: tuple[SurfaceSummary, ...]
    mass: Float[Array, " 6"] | None
    centre: Float[Array, " 3"] | None
    rigid: Float[Array, " 6"] | None
    frequencies: Float[Array, " modes"]
    unmoved: str
    told: tuple[str, ...]


def summary_of(structure: Structure, read: ReadModel | None = None) -> ModelSummary:
    """Sum up a structure.

    Parameters
    ----------
    structure : Structure
        Any.
    read : ReadModel, optional
        What its file gave.
    """
    nodes = structure.nodes
    mass = centre = rigid = None
    bare = _without_supports(structure)
    if bare is not None:
        mass, centre, rigid = _moved(nodes, *bare)
    frequencies, why = _first_modes(structure)
    units = "" if read is None or read.units is None else read.units.said
    return ModelSummary(
        name=structure.name,
        units=units,
        n_nodes=len(nodes),
        n_dofs=structure.n_dofs,
        low=nodes.min(axis=0),
        high=nodes.max(axis=0),
        groups=tuple(_group(nodes, group) for group in _by_name(structure)),
        surfaces=tuple(_surface(one) for one in structure.surfaces.values()),
        mass=mass,
        centre=centre,
        rigid=rigid,
        frequencies=frequencies,
        unmoved=why,
        told=() if read is None else read.told,
    )


def _by_name(structure: Structure) -> Iterator[list[Elements]]:
    """Give elements of one name and kind together."""
    found: dict[tuple[str, int], list[Elements]] = {}
    for group in structure.elements:
        found.setdefault((group.name, group.connectivity.shape[1]), []).append(group)
    yield from found.values()


def _group(nodes: Array, groups: list[Elements]) -> GroupSummary:
    corners = groups[0].connectivity.shape[1]
    size = mass = 0.0
    for group in groups:
        xyz = nodes[group.connectivity]
        size += 0.0 if GROUND in group.connectivity else _size(xyz)
        blocks = group.mass_blocks(xyz)
        mass += 0.0 if blocks is None else float(blocks[:, 2::6, 2::6].sum())
    return GroupSummary(
        name=groups[0].name,
        kind=_KINDS.get(corners, f"of {corners} nodes"),
        count=sum(len(group.connectivity) for group in groups),
        size=size,
        mass=mass,
    )


def _size(xyz: Array) -> float:
    """Return the area of plates, or the length of lines."""
    if xyz.shape[1] == 1:
        return 0.0
    if xyz.shape[1] == 2:
        return float(np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1).sum())
    return float(plate_areas(xyz).sum())


def _surface(one: Surface) -> SurfaceSummary:
    corners = [one.nodes[elements] for _, elements in one.parts if len(elements)]
    heights = np.concatenate([xyz[..., 2].ravel() for xyz in corners])
    low, high = one.extent
    return SurfaceSummary(
        name=one.name,
        lowest=float(heights.min()),
        highest=float(heights.max()),
        area=sum(_size(xyz) for xyz in corners),
        low=(float(low[0]), float(low[1])),
        high=(float(high[0]), float(high[1])),
    )


def _without_supports(
    structure: Structure,
) -> tuple[SparseMatrix, SparseMatrix, Float[Array, "dofs 6"]] | None:
    """Return mass, stiffness and rigid motions of a structure that nothing holds."""
    if isinstance(structure, Floor):
        free = replace(structure, fixed=np.zeros_like(structure.fixed), angles=None)
        mass, stiffness = free.matrices()
        own = own_motion(free.dof_index, free.n_dofs, None)
        return mass, stiffness, own.T @ _rigid_motions(structure.nodes)
    if isinstance(structure, MatrixModel):
        own = own_motion(structure.dof_index, structure.n_dofs, None)
        return *structure.matrices(), own.T @ _rigid_motions(structure.nodes)
    return None


def _rigid_motions(nodes: Float[Array, "nodes 3"]) -> Float[Array, "all 6"]:
    """Return the motion of all dofs of all nodes in six rigid motions about the origin."""
    motions = np.zeros((len(nodes), 6, 6))
    motions[:, range(6), range(6)] = 1.0
    x, y, z = nodes.T
    motions[:, 1, 3], motions[:, 2, 3] = -z, y
    motions[:, 0, 4], motions[:, 2, 4] = z, -x
    motions[:, 0, 5], motions[:, 1, 5] = -y, x
    return motions.reshape(-1, 6)


def _moved(
    nodes: Array, mass: SparseMatrix, stiffness: SparseMatrix, rigid: Array
) -> tuple[Array | None, Array | None, Array]:
    """Return mass in six directions, its centre, and what rigid motions raise."""
    size = float(np.abs(stiffness.diagonal()).max())
    wide = max(float(np.ptp(nodes, axis=0).max()), 1.0)
    raised = np.abs(stiffness @ rigid).max(axis=0) / size
    raised[3:] /= wide
    whole = rigid.T @ (mass @ rigid)
    if not np.all(whole.diagonal()[:3] > 0.0):
        return None, None, raised
    centre = np.array(
        [whole[1, 5] / whole[1, 1], whole[2, 3] / whole[2, 2], whole[0, 4] / whole[0, 0]]
    )
    about = rigid.copy()
    x, y, z = centre
    # turned about the centre instead of the origin
    about[:, 3] += z * rigid[:, 1] - y * rigid[:, 2]
    about[:, 4] += x * rigid[:, 2] - z * rigid[:, 0]
    about[:, 5] += y * rigid[:, 0] - x * rigid[:, 1]
    return np.einsum("ij,ij->j", about, mass @ about), centre, raised


def _first_modes(structure: Structure) -> tuple[Array, str]:
    """Return the first natural frequencies, or why there are none."""
    none = np.zeros(0)
    if isinstance(structure, ModalModel):
        return structure.omega[:_FIRST_MODES] / (2.0 * np.pi), ""
    limit = 10.0
    while limit <= _HIGHEST:
        try:
            found = structure.modes(limit).frequencies
        except (ComputationError, InputError) as error:
            return none, str(error)
        if len(found) >= _FIRST_MODES or limit * 2.0 > _HIGHEST:
            return found[:_FIRST_MODES], "" if len(found) else f"no mode below {limit:g} Hz"
        limit *= 2.0
    return none, ""
