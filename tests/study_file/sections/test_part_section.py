"""Parts of a building that a study gives by their outlines."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.structure.superelements import PartedStructure
from trundle.study_file.build import study_from_text

HALF = 'name = "half"\noutline = ["A/1", "B/1", "B/2", "A/2"]\n'


def made(*parts, more="", text=BUILDING):
    return study_from_text(text + more + "".join(f"\n[[part]]\n{part}" for part in parts))


def told(*parts, more="", text=BUILDING):
    with pytest.raises(StudyError) as found:
        made(*parts, more=more, text=text)
    return [(p.place, p.rule, p.line) for p in found.value.problems]


def test_a_part_is_given_by_crossings_of_grid_lines():
    """8 m of 16 m: the part, and what is left of the building, without any [parts]."""
    study = made(HALF)
    assert isinstance(study.floor, PartedStructure)
    (region,) = study.floor.parting.cuts.regions
    np.testing.assert_allclose(region.outline, [[0, 0], [8, 0], [8, 6], [0, 6]])
    assert (region.low, region.high) == (-np.inf, np.inf)
    assert len(study.floor.pieces.placed) == 2
    reach = study.methods[0].interaction.integration.f_max
    assert study.floor.parting.f_parts == pytest.approx(2 * reach)


def test_a_part_is_placed_several_times():
    """The same outline moved by 8 m; with planes beside it, which cut it not."""
    study = made(HALF + 'at = [["0 m", "0 m"], ["8 m", "0 mm"]]\n', more="\n[parts]\nband = 3\n")
    one, other = study.floor.parting.cuts.regions
    np.testing.assert_allclose(other.outline, one.outline + np.array([8.0, 0.0]))
    assert one.name == other.name == "half"
    reach = study.methods[0].interaction.integration.f_max
    assert study.floor.parting.f_parts == pytest.approx(3 * reach)


def test_storeys_of_a_part_end_halfway_to_others():
    """Levels at 0, 3 and 6.5 m: the lab from 4.75 m up, ground and deck below."""
    lab, both = made(
        HALF + 'storeys = ["lab"]\n',
        HALF.replace("half", "lower") + 'storeys = ["ground", "deck"]\n',
    ).floor.parting.cuts.regions
    assert (lab.low, lab.high) == (pytest.approx(4.75), np.inf)
    assert (both.low, both.high) == (-np.inf, pytest.approx(4.75))


@pytest.mark.parametrize(
    ("parts", "place", "words"),
    [
        ([HALF, HALF.replace("half", "other")], "part[2].outline", "overlaps part 'half'"),
        ([HALF + 'at = [["0 m", "0 m"], ["7 m", "0 m"]]\n'], "part[1].at[2]", "overlaps"),
        ([HALF.replace("B/2", "Z/2")], "part[1].outline[3]", "no grid line 'Z'"),
        ([HALF.replace(', "B/2", "A/2"', "")], "part[1].outline", ""),
        ([HALF + 'storeys = ["roof"]\n'], "part[1].storeys", "no storey"),
        ([HALF + 'storeys = ["ground", "lab"]\n'], "part[1].storeys", "'deck' lies between"),
        ([HALF + 'storeys = ["lab"]\nlow = "2 m"\n'], "part[1]", "or holds storeys"),
        ([HALF + 'low = "3 m"\nhigh = "3 m"\n'], "part[1].outline", "end above where it begins"),
        ([HALF + 'at = [["90 m", "0 m"]]\n'], "part[1].outline", "nothing of the structure"),
        ([HALF + "size = 3\n"], "part[1].size", ""),
        (
            [HALF, HALF + 'low = "1 m"\n'.replace("1 m", "-9 m") + 'high = "-8 m"\n'],
            "part[2].name",
            "names must differ",
        ),
    ],
)
def test_mistakes_are_told_where_they_stand(parts, place, words):
    found = told(*parts)
    assert any(at == place and words in rule for at, rule, _ in found), found
    assert all(line is not None for _, _, line in found)


def test_parts_and_halves_are_not_both():
    ((place, rule, _),) = told(HALF, more="\n[parts]\nnodes = 500\n")
    assert place == "parts"
    assert "not by both" in rule


def test_a_storey_of_bays_has_no_grid_lines():
    ((place, rule, _),) = told(HALF, text=GOOD)
    assert place == "part[1].outline"
    assert "[building]" in rule


def test_a_storey_of_bays_has_parts_too():
    """[floor] of the plan's kind: a quarter of it by places."""
    study = made(
        'name = "left"\noutline = [["-9 m", "-9 m"], ["6 m", "-9 m"], ["6 m", "99 m"], '
        '["-9 m", "99 m"]]\n',
        text=GOOD,
    )
    assert len(study.floor.pieces.placed) == 2
