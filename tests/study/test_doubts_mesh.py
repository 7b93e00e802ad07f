"""Slivers of a mesh are told with their place, and sound meshes are not doubted."""

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.study.doubts import study_doubts
from trundle.study.doubts_mesh import quality_of_mesh

BEAM = """
[[building.beam]]
on = "deck"
section = "steel"
along = [["3 m", "1 m"], ["7 m", "{y} m"]]

[[building.beam]]
on = "deck"
section = "steel"
along = [["3 m", "1.02 m"], ["7 m", "1.5 m"]]
"""


def mesh_doubts(text):
    study = tr.study_from_text(text)
    return study, [d.message for d in study_doubts(study) if "hardly any room" in d.message]


def test_a_sound_mesh_is_not_doubted():
    study, doubts = mesh_doubts(BUILDING)
    assert doubts == []
    assert quality_of_mesh(study).least_angle > 5.0


@pytest.mark.parametrize(("y", "told"), [("1", 1), ("1.48", 1)])
def test_beams_that_begin_2_cm_apart_leave_slivers_which_are_told(y, told):
    """An edge of 20 mm beside elements of a metre: a corner of atan(0.02) = 1.1 degrees, or 50 : 1."""
    study, doubts = mesh_doubts(
        BUILDING.replace("[[building.column]]", BEAM.format(y=y) + "\n[[building.column]]", 1)
    )
    assert len(doubts) == told
    assert "of 'deck'" in doubts[0]
    x, at = (float(part) for part in doubts[0].split("(")[1].split(")")[0].split(","))
    assert 2.0 < x < 8.0
    assert 0.9 < at < 1.6
    found = quality_of_mesh(study)
    assert found.least_angle < 5.0 or found.largest_aspect > 20.0
    assert np.isfinite(found.largest_angle)


def test_ends_that_miss_a_part_by_millimetres_are_told():
    """A beam of a storey without a slab that ends 5 mm short of another; 0.5 mm would be joined."""
    storey = '[[building.storey]]\nname = "roof"\nlevel = "10 m"\n\n'
    roof = "".join(
        f'[[building.beam]]\non = "roof"\nsection = "steel"\nalong = {along}\n\n'
        for along in ('[["0 m", "0 m"], ["0 m", "6 m"]]', '[["{x} m", "3 m"], ["8 m", "3 m"]]')
    )
    columns = (
        '[[building.column]]\nsection = "post"\nat = [["0 m", "0 m"], ["0 m", "6 m"], ["8 m", "3 m"]]\n'
        'from = "lab"\nto = "roof"\n\n'
    )
    text = BUILDING.replace("[[building.slab]]", storey + roof + columns + "[[building.slab]]", 1)
    told = {}
    for x in ("0.005", "0.0005", "0.2"):
        doubts = study_doubts(tr.study_from_text(text.replace("{x}", x)))
        told[x] = [d.message for d in doubts if d.subject == "gap"]
    assert told["0.0005"] == told["0.2"] == []
    assert len(told["0.005"]) == 1
    assert "ends at (0.005, 3) m on 'roof', 5 mm from beam" in told["0.005"][0]


def test_a_route_through_a_wall_or_a_column_is_told():
    """The aisle runs along y = 5 m on the deck; a wall across it, and a post that rises from it."""
    wall = '[[building.wall]]\nplate = "wall"\nalong = [["6 m", "4 m"], ["6 m", "6 m"]]\nfrom = "{}"\nto = "{}"\n{}\n\n'
    post = '[[building.column]]\nsection = "post"\nat = [["9 m", "5.1 m"]]\nfrom = "deck"\nto = "lab"\n\n'
    rising = wall.format("deck", "lab", "") + post
    under = wall.format("ground", "deck", 'base = "fixed"')
    told = {}
    for name, more in (("rising", rising), ("under", under), ("none", "")):
        study = tr.study_from_text(
            BUILDING.replace("[[building.column]]", more + "[[building.column]]", 1)
        )
        told[name] = [d.message for d in study_doubts(study) if d.subject == "route"]
    assert told["under"] == told["none"] == []
    assert len(told["rising"]) == 2
    assert "runs through wall" in told["rising"][0]
    assert "(6, 5) m" in told["rising"][0]
    assert "runs through column" in told["rising"][1]
