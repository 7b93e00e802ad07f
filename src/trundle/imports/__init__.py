"""Read structural models that other programs wrote, a file a format."""

from trundle.imports.matrices import read_matrices
from trundle.imports.mesh_groups import GroupMake
from trundle.imports.model_format import Asked, ModelFormat, ReadModel, all_formats
from trundle.imports.modes import ModeFiles, read_modes
from trundle.imports.modes_uff import read_universal_modes
from trundle.imports.read import read_model
from trundle.imports.stand_on import SurfaceChoice
from trundle.imports.unit_system import Units, agreed_units, units_of

__all__ = [
    "Asked",
    "GroupMake",
    "ModeFiles",
    "ModelFormat",
    "ReadModel",
    "SurfaceChoice",
    "Units",
    "agreed_units",
    "all_formats",
    "read_matrices",
    "read_model",
    "read_modes",
    "read_universal_modes",
    "units_of",
]
