"""Elements: a file each, which knows its nodes, the dofs it carries, and its matrices.

A floor asks a group of elements for no more than `Elements` says; a new kind is a new file here and
goes to a floor by ``Floor(others=(group, ...))``. One that wheels can stand on is `Standable` too.
"""

from trundle.structure.elements.beam import BeamGroup
from trundle.structure.elements.faces import FaceGroup
from trundle.structure.elements.joint_spring import JointSprings
from trundle.structure.elements.node_inertia import NodeInertia
from trundle.structure.elements.point_mass import PointMasses
from trundle.structure.elements.protocol import GROUND, Damped, Elements, Standable
from trundle.structure.elements.quad_shell import ShellGroup
from trundle.structure.elements.released_beam import ReleasedBeams
from trundle.structure.elements.spring import SpringGroup
from trundle.structure.elements.standing import ContactShape, Hat, Hermite, Located, Weights
from trundle.structure.elements.triangle_shell import TriangleGroup

__all__ = [
    "GROUND",
    "BeamGroup",
    "ContactShape",
    "Damped",
    "Elements",
    "FaceGroup",
    "Hat",
    "Hermite",
    "JointSprings",
    "Located",
    "NodeInertia",
    "PointMasses",
    "ReleasedBeams",
    "ShellGroup",
    "SpringGroup",
    "Standable",
    "TriangleGroup",
    "Weights",
]
