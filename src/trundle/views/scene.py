"""Arrange a model, its modes and a crossing as the scene of a page: plain values and packed arrays.

Arrays are little-endian, in base 64: places in single precision, motions in 16 bits of a scale.
"""

from __future__ import annotations

import base64
from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import Modes
from trundle.results.modes import FirstModes
from trundle.run.playback import Playback
from trundle.structure import Floor, Structure, node_motion
from trundle.study.model import Study
from trundle.views.solids import Solid, solids_of

__all__ = ["scene_of"]

_WHOLE = 32767  # of 16 bits
_ABOVE = 0.05  # m by which what stands on a storey may reach above it
_MODES = 24  # that are shown


def scene_of(
    structure: Structure,
    *,
    title: str,
    modes: Modes | FirstModes | None = None,
    study: Study | None = None,
    playback: Playback | None = None,
) -> dict[str, Any]:
    """Return all that a page needs to draw a model and move it.

    Parameters
    ----------
    structure : Structure
        The model.
    title : str
        Above the page.
    modes : Modes or FirstModes, optional
        To be animated; the first 24 are, or those that results kept.
    study : Study, optional
        Whose routes and points are shown.
    playback : Playback, optional
        A crossing.
    """
    nodes = structure.nodes
    levels = _levels(structure)
    return {
        "title": title,
        "low": nodes.min(axis=0).tolist(),
        "high": nodes.max(axis=0).tolist(),
        "nodes": _floats(nodes),
        "storeys": [name for name, _ in levels],
        "heights": [height for _, height in levels],
        "solids": [part for solid in solids_of(structure) for part in _parts(solid, nodes, levels)],
        "supports": _supports(structure),
        "modes": [] if modes is None else _modes(modes.frequencies, _motion(structure, modes)),
        "routes": [] if study is None else list(_routes(study)),
        "points": [] if study is None else list(_points(study)),
        "crossing": None if playback is None else _crossing(playback),
    }


def _levels(structure: Structure) -> list[tuple[str, float]]:
    """Return storeys by height: the surfaces of a model, those at one height together."""
    found: dict[float, list[str]] = {}
    for name, surface in structure.surfaces.items():
        heights = [surface.nodes[elements][..., 2] for _, elements in surface.parts]
        top = max(float(z.max()) for z in heights if z.size)
        found.setdefault(round(top, 2), []).append(name)
    return [(", ".join(names), height) for height, names in sorted(found.items())]


def _parts(solid: Solid, nodes: Array, levels: list[tuple[str, float]]) -> Iterator[dict[str, Any]]:
    """Give a body storey by storey: what lies at or below a level and above the one below it."""
    at = nodes[solid.node]
    middle = at[solid.triangles][..., 2].mean(axis=1)
    heights = np.array([height for _, height in levels])
    storey = np.minimum(np.searchsorted(heights + _ABOVE, middle), max(len(heights) - 1, 0))
    for number in np.unique(storey).tolist():
        some = solid.triangles[storey == number]
        used, corners = np.unique(some, return_inverse=True)
        yield {
            "name": solid.name,
            "kind": solid.kind,
            "storey": int(number),
            "node": _ints(solid.node[used]),
            "arm": _floats(solid.arm[used]),
            "triangles": _ints(corners.ravel()),
        }


def _supports(structure: Structure) -> dict[str, Any]:
    """Return the nodes that are held, wholly or in part."""
    if not isinstance(structure, Floor):
        return {"node": _ints(np.zeros(0)), "fixed": []}
    used = np.unique(np.concatenate([g.connectivity.ravel() for g in structure.elements]))
    used = used[used >= 0]
    held = structure.fixed[used, :3]
    some = used[held[:, 2]]
    return {"node": _ints(some), "fixed": structure.fixed[some].all(axis=1).tolist()}


def _motion(structure: Structure, modes: Modes | FirstModes) -> Float[Array, "nodes 6 shown"]:
    """Return how all nodes move in the first modes; in none where results kept no such motion."""
    if isinstance(modes, FirstModes):
        return np.zeros((len(structure.nodes), 6, 0)) if modes.motion is None else modes.motion
    few = modes.first(_MODES)
    return np.stack([few.seen(node_motion(structure, dof)) for dof in range(6)], axis=1)


def _modes(frequencies: Array, motions: Float[Array, "nodes 6 shown"]) -> list[dict[str, Any]]:
    found = []
    for i, f in enumerate(frequencies[: motions.shape[2]].tolist()):
        motion = motions[:, :, i]
        largest = float(np.abs(motion[:, :3]).max()) or 1.0
        scale = max(float(np.abs(motion).max()) / largest, 1.0)
        found.append({"frequency": f, "scale": scale, **_packed(motion / largest / scale)})
    return found


def _routes(study: Study) -> Iterator[dict[str, Any]]:
    for name, drive in study.drives.items():
        yield {"name": name, "places": study.way_in_space(drive.route).tolist()}


def _points(study: Study) -> Iterator[dict[str, Any]]:
    for name, spot in study.points.items():
        frame = study.floor.surface(spot.on).frame
        yield {"name": name, "place": frame.in_space(np.array([[spot.x, spot.y]]))[0].tolist()}


def _crossing(play: Playback) -> dict[str, Any]:
    largest = float(np.abs(play.motion).max()) or 1.0
    return {
        "title": f"{play.case}, class {play.road}, {play.method}",
        "time": np.round(play.time, 4).tolist(),
        "nodes": _ints(play.nodes),
        "normals": _floats(play.normals),
        "largest": largest,
        "motion": _packed(play.motion / largest)["motion"],
        "wheels": [
            {
                "name": one.name,
                "contacts": list(one.contact_names),
                "places": np.round(one.places, 3).tolist(),
                "on": one.on.tolist(),
                "forces": np.round(one.forces, 0).tolist(),
            }
            for one in play.wheels
        ],
    }


def _packed(values: Array) -> dict[str, str]:
    """Return numbers from -1 to 1 in 16 bits."""
    whole = np.round(np.clip(values, -1.0, 1.0) * _WHOLE).astype("<i2")
    return {"motion": base64.b64encode(whole.tobytes()).decode()}


def _floats(values: Array) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode()


def _ints(values: Array) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype="<u4").tobytes()).decode()
