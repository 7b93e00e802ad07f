"""Meshes of gmsh: geometry by physical groups, of which the study says what they are."""

from __future__ import annotations

from pathlib import Path

from trundle.errors import InputError, Problem
from trundle.imports.gmsh_mesh import grouped_mesh
from trundle.imports.mesh_groups import floor_of_mesh
from trundle.imports.model_format import Asked, ModelFormat, ReadModel
from trundle.imports.unit_system import agreed_units

__all__ = ["FORMAT"]


def read(path: Path, asked: Asked) -> ReadModel:
    """Read a mesh; what its groups are is in SI, and `asked.units` are those of its places."""
    try:
        mesh, told = grouped_mesh(path, {name for name, one in asked.groups.items() if one.nothing})
        units, said = agreed_units(None, asked.units)
        floor = floor_of_mesh(mesh, asked.groups, path.stem, length=units.length)
    except InputError as error:
        problem = Problem(
            place=path.name, value="the mesh", rule=str(error), remedy="docs/models.md"
        )
        return ReadModel(structure=None, problems=(problem,), files=(path,))
    return ReadModel(structure=floor, told=(*said, *told), files=(path,), units=units)


FORMAT = ModelFormat(
    kind="gmsh",
    name="gmsh mesh",
    suffixes=(".msh",),
    claims=lambda data: data.lstrip().startswith((b"$MeshFormat", b"$Comments")),
    read=read,
)
