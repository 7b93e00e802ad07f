"""Damping of modes by the energy in each material, against sums by hand."""

from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.dynamics import ByMaterial, ModalRatio
from trundle.errors import InputError, StudyError
from trundle.simulate import Modal
from trundle.structure import (
    CONCRETE,
    STEEL,
    BeamGroup,
    BeamSection,
    Floor,
    PointMasses,
    SpringGroup,
)

E, SIZE = CONCRETE.elastic_modulus, (0.3, 0.5)


def beams(material, z=0.0):
    section = BeamSection.rectangle(*SIZE, material)
    return BeamGroup(
        elements=np.array([[0, 1], [1, 2]]), section=section, offset=np.zeros(3),
        up=np.array([0.0, 0.0, 1.0]),
    )  # fmt: skip


def cantilever(*groups, springs=()):
    nodes = np.array([[0.0, 0, 0], [2.0, 0, 0], [4.0, 0, 0]])
    fixed = np.zeros((3, 6), dtype=bool)
    fixed[0] = True
    return Floor(nodes=nodes, fixed=fixed, beams=groups, springs=springs)


def ratios(floor, damping, f_max=400.0):
    prepared = Modal(f_max=f_max, dt=1e-4).prepare(floor, damping)
    omega = np.sqrt(prepared.propagator.square)
    return prepared.propagator.double / (2.0 * omega), prepared


def test_beams_side_by_side_damp_by_their_stiffness():
    """Same shape, moduli E and 3 E, 1 % and 5 %: every mode has (1 + 3 x 5) / 4 = 4 %."""
    soft = replace(CONCRETE, damping_ratio=0.01)
    stiff = replace(CONCRETE, elastic_modulus=3.0 * E, damping_ratio=0.05)
    found, prepared = ratios(cantilever(beams(soft), beams(stiff)), ByMaterial(other=0.5))
    assert len(found) >= 4
    assert found == pytest.approx(np.full(len(found), 0.04), rel=1e-9)
    (said,) = (d for d in prepared.doubts() if d.subject == "damping")
    assert "4 to 4 % of critical" in said.message


def test_what_has_no_ratio_of_its_own_takes_the_other():
    """A spring k beside a beam of 3 EI / L^3 carries k / (k + 3 EI / L^3) of a slow tip mass."""
    k = 5e6
    section = replace(
        BeamSection.rectangle(*SIZE, replace(CONCRETE, damping_ratio=0.02, density=1e-6)),
        shear_area_y=np.inf, shear_area_z=np.inf,
    )  # fmt: skip
    beam = replace(beams(CONCRETE), section=section)
    spring = SpringGroup(elements=np.array([[2, -1]]), stiffness=np.array([0, 0, k, 0, 0, 0.0]))
    floor = replace(
        cantilever(beam, springs=(spring,)),
        masses=(PointMasses(nodes=np.array([2]), mass=1e5),),
    )
    of_beam = 3.0 * E * section.inertia_y / 4.0**3
    found, prepared = ratios(floor, ByMaterial(other=0.10), f_max=20.0)
    upright = np.argmax(np.abs(prepared.modes.shapes[floor.dof_index[2, 2]]))
    expected = (0.10 * k + 0.02 * of_beam) / (k + of_beam)
    assert found[upright] == pytest.approx(expected, rel=1e-6)


def test_one_ratio_of_all_materials_is_that_ratio():
    floor = cantilever(beams(replace(CONCRETE, damping_ratio=0.03)))
    by_material, _ = ratios(floor, ByMaterial(other=0.9))
    assert by_material == pytest.approx(ratios(floor, ModalRatio(ratio=0.03))[0], rel=1e-9)


def test_a_study_damps_by_material():
    """Steel and concrete of 3 % alike: levels of the study with 3 % in every mode."""
    materials = BUILDING.replace(
        'density = "2500 kg/m3"', 'density = "2500 kg/m3"\ndamping_ratio = "3 %"'
    )
    by_material = materials.replace('{ ratio = "3 %" }', '{ by_material = true, ratio = "3 %" }')
    one, other = (tr.run_study(tr.study_from_text(text)) for text in (BUILDING, by_material))
    (a,), (b,) = one.cells.values(), other.cells.values()
    np.testing.assert_allclose(b.rms_velocity, a.rms_velocity, rtol=1e-9)
    told = [
        w.message for found in other.warnings().values() for w in found if w.subject == "damping"
    ]
    assert told == [
        "by the energy that modes store in each material they have 3 to 3 % of critical, the first 3 %"
    ]


def test_damping_by_material_needs_a_material_that_has_some():
    text = BUILDING.replace('{ ratio = "3 %" }', '{ by_material = true, ratio = "3 %" }')
    with pytest.raises(StudyError, match="no material has a damping_ratio"):
        tr.study_from_text(text)
    with pytest.raises(StudyError, match="a ratio, also of what has none by its material"):
        tr.study_from_text(text.replace('by_material = true, ratio = "3 %"', "by_material = true"))


def test_ratios_beyond_critical_are_refused():
    with pytest.raises(InputError, match="damping"):
        replace(STEEL, damping_ratio=1.5)
