"""Meshes of plans: conforming to lines and points, mostly quadrilaterals."""

from trundle.structure.mesh.mesher import mesh_sheets
from trundle.structure.mesh.quality import MeshQuality, angles, aspects, quality_of
from trundle.structure.mesh.sheet import Area, Refinement, Sheet, Tie
from trundle.structure.mesh.sheet_mesh import SheetMesh

__all__ = [
    "Area",
    "MeshQuality",
    "Refinement",
    "Sheet",
    "SheetMesh",
    "Tie",
    "angles",
    "aspects",
    "mesh_sheets",
    "quality_of",
]
