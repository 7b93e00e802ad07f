"""ParaView's collections: a crossing as grids in time, with wheels and their forces.

Reference: Kitware, VTK file formats; ParaView's PVD collections.
"""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

import numpy as np

from trundle._typing import Array
from trundle.exports.cells import Cells, cells_of
from trundle.exports.export_format import ExportFormat, Subject
from trundle.exports.formats.vtu import grid_of

__all__ = ["EXPORT"]


def write(subject: Subject, stem: str) -> Mapping[str, bytes]:
    """Return the frames of a crossing: a grid of the floor and one of the wheels for each.

    Parameters
    ----------
    subject : Subject
        With a playback.
    stem : str
        How the names of files begin.
    """
    play = subject.playback
    assert play is not None  # the format needs it
    nodes, mesh = subject.structure.nodes, cells_of(subject.structure)
    files: dict[str, bytes] = {}
    listed = list[str]()
    for i, (time, motion) in enumerate(zip(play.time, play.motion, strict=True)):
        moved = np.zeros((len(nodes), 3), dtype="f4")
        moved[play.nodes] = motion[:, None] * play.normals
        files[f"-{i:04d}.vtu"] = grid_of(nodes, mesh, {"displacement [m]": moved})
        files[f"-{i:04d}-wheels.vtu"] = _wheels(subject, i)
        for part, end in enumerate((".vtu", "-wheels.vtu")):
            name = escape(f"{stem}-{i:04d}{end}", quote=True)
            listed.append(f'<DataSet timestep="{time:.6g}" part="{part}" file="{name}"/>\n')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n'
    whole = f"{head}{''.join(listed)}</Collection>\n</VTKFile>\n"
    return {".pvd": whole.encode(), **files}


def _wheels(subject: Subject, frame: int) -> bytes:
    """Return the wheels that stand on the floor, with their forces."""
    assert subject.playback is not None
    places, forces = list[Array](), list[Array]()
    for source in subject.playback.wheels:
        on = source.on[frame]
        places.append(source.places[frame][on])
        forces.append(source.forces[frame][on])
    at = np.concatenate(places) if places else np.zeros((0, 3))
    down = np.zeros((len(at), 3), dtype="f4")
    down[:, 2] = -np.concatenate(forces) if forces else 0.0
    points = Cells(blocks=(np.arange(len(at))[:, None],), groups=("wheels",))
    return grid_of(at, points, {"force on the floor [N]": down})


EXPORT = ExportFormat(
    kind="pvd", name="ParaView collection in time", suffix=".pvd", needs=("playback",), write=write
)
