"""How a study cuts its building into parts."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.structure.superelements import PartedStructure
from trundle.study_file.build import study_from_text


def made(section, text=BUILDING):
    return study_from_text(text + "\n[parts]\n" + section)


def told(section, text=BUILDING):
    with pytest.raises(StudyError) as found:
        made(section, text)
    return [(p.place, p.rule, p.line) for p in found.value.problems]


def test_storeys_are_cut_halfway_up_their_columns():
    """Levels at 0, 3 and 6.5 m: planes at 1.5 and 4.75 m; bands times the modes' 60 Hz."""
    study = made("storeys = true\nband = 3\nseam_band = 4")
    floor = study.floor
    assert isinstance(floor, PartedStructure)
    np.testing.assert_allclose(floor.parting.cuts.z, [1.5, 4.75])
    assert len(floor.pieces.placed) == 3
    reach = study.methods[0].interaction.integration.f_max
    assert floor.parting.f_parts == pytest.approx(3 * reach)
    assert floor.parting.f_seams == pytest.approx(4 * reach)


def test_planes_are_typed_in_any_unit_and_any_order():
    """12 m and 400 cm; the same plane twice is one."""
    cuts = made('cuts_x = ["12 m", "400 cm", "4 m"]\ncuts_y = ["3000 mm"]').floor.parting.cuts
    np.testing.assert_allclose(cuts.x, [4.0, 12.0])
    np.testing.assert_allclose(cuts.y, [3.0])


def test_a_storey_of_bays_may_be_cut_too():
    """[floor] of the plan's kind: the same floor, by halves of so many nodes."""
    study = made("nodes = 100", GOOD)
    assert isinstance(study.floor, PartedStructure)
    assert study.floor.parting.largest == 100
    assert study.floor.n_dofs == study_from_text(GOOD).floor.n_dofs


def test_a_finer_mesh_is_cut_as_well():
    """What a mesh check compares must be found in the same way."""
    study = made("storeys = true")
    finer = study.meshed(0.8)
    assert isinstance(finer.floor, PartedStructure)
    assert finer.floor.n_dofs > study.floor.n_dofs


@pytest.mark.parametrize(
    ("section", "place", "words"),
    [
        ("band = 2", "parts", "cut by planes"),
        ("storeys = true\nnodes = 500", "parts", "not by both"),
        ('cuts_x = ["90 m"]', "parts.cuts_x[1]", "lies between x = "),
        ('cuts_z = ["2 m", "-1 m"]', "parts.cuts_z[2]", "lies between z = "),
        ("nodes = 5", "parts.nodes", "100"),
        ("storeys = true\nband = 1", "parts.band", "1.2"),
        ('cut_x = ["2 m"]', "parts.cut_x", ""),
    ],
)
def test_what_cuts_nothing_is_refused_with_its_line(section, place, words):
    """Each mistake names its place, and stands where it was typed."""
    ((found, rule, line),) = told(section)
    assert found == place
    assert words in rule
    assert line is not None


def test_storeys_of_a_plan_are_not_known():
    """[floor] has no storeys: its heights must be given."""
    ((place, rule, _),) = told("storeys = true", GOOD)
    assert place == "parts.storeys"
    assert "[building]" in rule
