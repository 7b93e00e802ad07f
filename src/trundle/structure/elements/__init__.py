"""Elements: a file each, which knows its nodes, the dofs it carries, and its matrices.

A floor asks a group of elements for no more than `Elements` says; a new kind is a new file here and
goes to a floor by ``Floor(others=(group, ...))``.
"""

from trundle.structure.elements.beam import BeamGroup
from trundle.structure.elements.point_mass import PointMasses
from trundle.structure.elements.protocol import GROUND, Elements
from trundle.structure.elements.quad_shell import ETA, XI, ShellGroup
from trundle.structure.elements.spring import SpringGroup

__all__ = [
    "ETA",
    "GROUND",
    "XI",
    "BeamGroup",
    "Elements",
    "PointMasses",
    "ShellGroup",
    "SpringGroup",
]
