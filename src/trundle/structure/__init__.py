"""Model floors with flat shells, eccentric beams, springs and supports."""

from trundle.structure.arches import arching
from trundle.structure.bridge import beam_bridge
from trundle.structure.edges import EDGES, Edge
from trundle.structure.elements import (
    BeamGroup,
    ContactShape,
    Elements,
    FaceGroup,
    Hat,
    Hermite,
    PointMasses,
    ShellGroup,
    SpringGroup,
    Standable,
    TriangleGroup,
)
from trundle.structure.floor import DOF_NAMES, Floor
from trundle.structure.links import RigidLinks
from trundle.structure.matrix_model import MatrixModel
from trundle.structure.modal_model import ModalModel
from trundle.structure.model import MirrorPlane, Structure, can_move, node_motion
from trundle.structure.places import Axis, Frame, Spot, Spots
from trundle.structure.plan import FloorPlan, Rectangle, build_floor, mesh_lines
from trundle.structure.plates import OrthotropicSection
from trundle.structure.profiles import (
    STEEL,
    box_section,
    i_section,
    rolled_section,
    rolled_sections,
    t_section,
    tube_section,
)
from trundle.structure.reference import reference_plan, reference_unit
from trundle.structure.resolution import (
    ELEMENTS_PER_WAVE,
    bending_wave,
    building_mesh_size,
    building_resolution,
    resolved_frequency,
    resolving_mesh_size,
)
from trundle.structure.sections import (
    CONCRETE,
    BeamSection,
    Material,
    PlateSection,
    ShellSection,
)
from trundle.structure.smeared import (
    composite_deck,
    hollow_core_slab,
    ribbed_slab,
    waffle_slab,
)
from trundle.structure.statics import self_weight_deflection
from trundle.structure.surface import Surface

__all__ = [
    "CONCRETE",
    "DOF_NAMES",
    "EDGES",
    "ELEMENTS_PER_WAVE",
    "STEEL",
    "Axis",
    "BeamGroup",
    "BeamSection",
    "ContactShape",
    "Edge",
    "Elements",
    "FaceGroup",
    "Floor",
    "FloorPlan",
    "Frame",
    "Hat",
    "Hermite",
    "Material",
    "MatrixModel",
    "MirrorPlane",
    "ModalModel",
    "OrthotropicSection",
    "PlateSection",
    "PointMasses",
    "Rectangle",
    "RigidLinks",
    "ShellGroup",
    "ShellSection",
    "Spot",
    "Spots",
    "SpringGroup",
    "Standable",
    "Structure",
    "Surface",
    "TriangleGroup",
    "arching",
    "beam_bridge",
    "bending_wave",
    "box_section",
    "build_floor",
    "building_mesh_size",
    "building_resolution",
    "can_move",
    "composite_deck",
    "hollow_core_slab",
    "i_section",
    "mesh_lines",
    "node_motion",
    "reference_plan",
    "reference_unit",
    "resolved_frequency",
    "resolving_mesh_size",
    "ribbed_slab",
    "rolled_section",
    "rolled_sections",
    "self_weight_deflection",
    "t_section",
    "tube_section",
    "waffle_slab",
]
