"""Binary glTF 2.0: bodies by group, and the first modes as animations.

Reference: Khronos Group, glTF 2.0 specification (ISO/IEC 12113:2022).
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.exports.cells import shapes_at_nodes
from trundle.exports.export_format import ExportFormat, Subject
from trundle.views.solids import Solid, moved, solids_of

__all__ = ["EXPORT"]

_FLOAT, _UINT = 5126, 5125
_VERTICES, _INDICES = 34962, 34963
_MOST = 12  # modes: each is another set of places
_SHOWN = 0.05  # of the model's size, of the largest motion
_KEYS = 24  # of a period
_COLOURS = {
    "plate": (0.62, 0.66, 0.70), "member": (0.36, 0.45, 0.58), "spring": (0.80, 0.45, 0.10),
    "mass": (0.55, 0.20, 0.20),
}  # fmt: skip
_UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # z up becomes y up


@dataclass(kw_only=True)
class _Buffer:
    """The binary part, and what describes it."""

    data: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    accessors: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])

    def add(self, values: Array, *, target: int | None, bounds: bool = False) -> int:
        """Return the number of a new accessor."""
        kind = {1: "SCALAR", 3: "VEC3"}[1 if values.ndim == 1 else values.shape[1]]
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes}
        self.views.append(view if target is None else {**view, "target": target})
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": _UINT if values.dtype == np.uint32 else _FLOAT,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            ends = (np.atleast_1d(values.min(axis=0)), np.atleast_1d(values.max(axis=0)))
            accessor |= dict(zip(("min", "max"), (end.tolist() for end in ends), strict=True))
        self.accessors.append(accessor)
        self.data += values.tobytes() + b"\0" * (-values.nbytes % 4)
        return len(self.accessors) - 1


def write(subject: Subject, stem: str) -> Mapping[str, bytes]:
    """Return the bodies of a structure, with the first modes as animations of a second each.

    Parameters
    ----------
    subject : Subject
        With modes or without.
    stem : str
        Name of the scene.
    """
    structure, buffer = subject.structure, _Buffer()
    shapes = np.zeros((0, len(structure.nodes), 6))
    names: list[str] = []
    if subject.modes is not None and subject.modes.n_modes:
        modes = subject.modes.first(_MOST)
        shapes = shapes_at_nodes(structure, modes)
        names = [f"mode {i}, {f:.2f} Hz" for i, f in enumerate(modes.frequencies, start=1)]
    size = float(np.ptp(structure.nodes, axis=0).max())
    largest = np.abs(shapes[:, :, :3]).max(axis=(1, 2), keepdims=True, initial=1e-300)
    shapes = shapes * (_SHOWN * size / largest)
    shown = dict(zip(names, shapes, strict=True))
    solids = solids_of(structure)
    kinds = sorted({solid.kind for solid in solids})
    document = {
        "asset": {"version": "2.0", "generator": "trundle"},
        "scene": 0,
        "scenes": [{"name": stem, "nodes": [0]}],
        "nodes": [
            {"name": stem, "rotation": _UPRIGHT, "children": list(range(1, len(solids) + 1))},
            *({"name": solid.name, "mesh": i} for i, solid in enumerate(solids)),
        ],
        "materials": [_material(kind) for kind in kinds],
        "meshes": [
            _mesh(buffer, structure.nodes, solid, kinds.index(solid.kind), shown)
            for solid in solids
        ],
    }
    if names:
        document["animations"] = _animations(buffer, names, len(solids))
    document |= {
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    return {".glb": _binary(document, bytes(buffer.data))}


def _material(kind: str) -> dict[str, Any]:
    colour = [*_COLOURS[kind], 1.0]
    surface = {"baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.9}
    return {"name": kind, "pbrMetallicRoughness": surface, "doubleSided": True}


def _mesh(
    buffer: _Buffer,
    nodes: Float[Array, "nodes 3"],
    solid: Solid,
    material: int,
    shown: Mapping[str, Float[Array, "nodes 6"]],
) -> dict[str, Any]:
    places = (nodes[solid.node] + solid.arm).astype("<f4")
    primitive: dict[str, Any] = {
        "attributes": {"POSITION": buffer.add(places, target=_VERTICES, bounds=True)},
        "indices": buffer.add(solid.triangles.ravel().astype(np.uint32), target=_INDICES),
        "material": material,
        "mode": 4,
    }
    if shown:
        primitive["targets"] = [
            {
                "POSITION": buffer.add(
                    moved(solid, shape).astype("<f4"), target=_VERTICES, bounds=True
                )
            }
            for shape in shown.values()
        ]
    mesh: dict[str, Any] = {"name": solid.name, "primitives": [primitive]}
    if shown:
        mesh |= {"weights": [0.0] * len(shown), "extras": {"targetNames": list(shown)}}
    return mesh


def _animations(buffer: _Buffer, names: list[str], n_meshes: int) -> list[dict[str, Any]]:
    """Return an animation a mode: its weight swings through a period of a second."""
    time = np.linspace(0.0, 1.0, _KEYS + 1).astype("<f4")
    keys = buffer.add(time, target=None, bounds=True)
    found = []
    for i, name in enumerate(names):
        weights = np.zeros((len(time), len(names)), dtype="<f4")
        weights[:, i] = np.sin(2.0 * np.pi * time)
        sampler = {"input": keys, "output": buffer.add(weights.ravel(), target=None)}
        found.append(
            {
                "name": name,
                "samplers": [{**sampler, "interpolation": "LINEAR"}],
                "channels": [
                    {"sampler": 0, "target": {"node": node, "path": "weights"}}
                    for node in range(1, n_meshes + 1)
                ],
            }
        )
    return found


def _binary(document: dict[str, Any], data: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    whole = 12 + 8 + len(text) + 8 + len(data)
    parts = (
        b"glTF", (2).to_bytes(4, "little"), whole.to_bytes(4, "little"),
        len(text).to_bytes(4, "little"), b"JSON", text,
        len(data).to_bytes(4, "little"), b"BIN\0", data,
    )  # fmt: skip
    return b"".join(parts)


EXPORT = ExportFormat(kind="gltf", name="glTF scene", suffix=".glb", uses=("modes",), write=write)
