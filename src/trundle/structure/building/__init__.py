"""Buildings of storeys, slabs, beams, columns, walls and ramps, and the models built of them."""

from trundle.structure.building.build import Meshing, build_building, mesh_building
from trundle.structure.building.checks import building_problems
from trundle.structure.building.gaps import gaps_of
from trundle.structure.building.held import Base, Mass, Springs, Support
from trundle.structure.building.in_the_way import in_the_way
from trundle.structure.building.joint import Joint
from trundle.structure.building.parts import Beam, Brace, Building, Column, Ramp, Slab, Storey, Wall
from trundle.structure.building.profile import Profile

__all__ = [
    "Base",
    "Beam",
    "Brace",
    "Building",
    "Column",
    "Joint",
    "Mass",
    "Meshing",
    "Profile",
    "Ramp",
    "Slab",
    "Springs",
    "Storey",
    "Support",
    "Wall",
    "build_building",
    "building_problems",
    "gaps_of",
    "in_the_way",
    "mesh_building",
]
