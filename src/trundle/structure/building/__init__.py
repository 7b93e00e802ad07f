"""Buildings of storeys, slabs, beams, columns, walls and ramps, and the models built of them."""

from trundle.structure.building.build import Meshing, build_building, mesh_building
from trundle.structure.building.checks import building_problems
from trundle.structure.building.parts import (
    Base,
    Beam,
    Brace,
    Building,
    Column,
    Mass,
    Ramp,
    Slab,
    Springs,
    Storey,
    Support,
    SymmetryPlane,
    Wall,
)
from trundle.structure.building.profile import Profile

__all__ = [
    "Base",
    "Beam",
    "Brace",
    "Building",
    "Column",
    "Mass",
    "Meshing",
    "Profile",
    "Ramp",
    "Slab",
    "Springs",
    "Storey",
    "Support",
    "SymmetryPlane",
    "Wall",
    "build_building",
    "building_problems",
    "mesh_building",
]
