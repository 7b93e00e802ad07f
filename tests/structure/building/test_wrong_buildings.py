"""Wrong buildings end in messages that say where, what is asked, and what to do."""

from dataclasses import replace

import numpy as np
import pytest
from buildings import LEVELS, box, column, line, plate, slab, table

from trundle.errors import InputError
from trundle.structure import CONCRETE, MirrorPlane, OrthotropicSection
from trundle.structure.building import (
    Beam,
    Brace,
    Building,
    Mass,
    Meshing,
    Profile,
    Ramp,
    Storey,
    Support,
    Wall,
    build_building,
    building_problems,
)

SMALL = Profile.rectangle(0.3, 0.5, CONCRETE)
RIBBED = OrthotropicSection(
    bending=(2e7, 1e7, 2e6, 4e6), membrane=(1e9, 5e8, 1e8, 2e8), shear=(1e8, 1e8),
    mass_per_area=300.0,
)  # fmt: skip
BOW_TIE = line((0, 0), (8, 6), (8, 0), (0, 6))


def beam(*places, **changes):
    return Beam(**({"on": "slab", "profile": SMALL, "along": line(*places)} | changes))


def wall(*places, **changes):
    given = {"section": plate(0.2), "along": line(*places), "bottom": "base", "top": "slab"}
    return Wall(**(given | {"base": "fixed"} | changes))


def ramp(*corners, **changes):
    given = {
        "name": "ramp", "section": plate(), "outline": line(*corners), "bottom": "base",
        "top": "slab",
    }  # fmt: skip
    return Ramp(**(given | changes))


RAMP = ((8, 0), (8, 3), (20, 3), (20, 0))

WRONG = {
    "no storeys": (Building(storeys=()), "storey", "has a storey at least"),
    "storeys out of order": (
        table(storeys=LEVELS[::-1]), "storey[2].level", "from below to above",
    ),
    "storeys at one level": (
        table(storeys=(*LEVELS, Storey(name="top", level=0.1))), "storey[3].level", "0.2 m or more",
    ),
    "two storeys of a name": (
        table(storeys=(*LEVELS, Storey(name="slab", level=4.0))), "storey", "must differ",
    ),
    "a slab on no storey": (
        table(slabs=(slab(on="roof"),)), "slab[1].on", "must be the name of a storey",
    ),
    "a column to no storey": (
        table(columns=(column(1, 1, top="roof"),)), "column[1].to", "must be the name of a storey",
    ),
    "a self-crossing outline": (
        table(slabs=(slab(corners=BOW_TIE),)), "slab[1].outline", "at (4, 3) m",
    ),
    "an outline of two corners": (
        table(slabs=(slab(corners=line((0, 0), (8, 6))),)), "slab[1].outline", "3 corners or more",
    ),
    "a corner twice in a row": (
        table(slabs=(slab(corners=line((0, 0), (8, 0), (8, 0), (0, 6))),)),
        "slab[1].outline", "are the same, (8, 0) m",
    ),
    "an outline without area": (
        table(slabs=(slab(corners=line((0, 0), (4, 0), (8, 0))),)), "slab[1].outline", "outline",
    ),
    "an opening outside": (
        table(slabs=(slab(openings=(box(7, 5, 9, 7),)),)),
        "slab[1].openings[1]", "within the outline",
    ),
    "a self-crossing opening": (
        table(slabs=(slab(openings=(line((2, 2), (4, 4), (4, 2), (2, 4)),)),)),
        "slab[1].openings[1]", "must not cross",
    ),
    "openings in each other": (
        table(slabs=(slab(openings=(box(2, 2, 4, 4), box(3, 3, 5, 5))),)),
        "slab[1].openings[2]", "must not overlap",
    ),
    "overlapping slabs": (
        table(slabs=(slab(), slab(corners=box(7, 0, 12, 6)))),
        "slab[2].outline", "6 m2 shared" ,
    ),
    "a panel on no slab": (
        table(slabs=(slab(), slab(corners=box(20, 0, 22, 2), panel=True))),
        "slab[2].panel", "none lies there",
    ),
    "a beam without length": (
        table(beams=(beam((1, 1), (1.005, 1)),)), "beam[1].along", "20 mm or more apart",
    ),
    "a beam of one place": (table(beams=(beam((1, 1)),)), "beam[1].along", "two places or more"),
    "a beam twice": (
        table(beams=(beam((0, 3), (8, 3)), beam((2, 3), (6, 3)))),
        "beam[2].along", "it lies on beam 1",
    ),
    "a wall twice": (
        table(walls=(wall((0, 0), (0, 6)), wall((0, 2), (0, 4)))), "wall[2].along", "on wall 1",
    ),
    "a column upside down": (
        table(columns=(column(1, 1, bottom="slab", top="base"),)),
        "column[1].to", "not above 'slab'",
    ),
    "a column in the air": (
        table(columns=(column(1, 1, base=None),)), "column[1].base", "nothing under it on 'base'",
    ),
    "a column that misses its slab": (
        table(columns=(column(30, 1),)), "column[1].at", "nothing over it on 'slab'",
    ),
    "a column in an opening": (
        table(slabs=(slab(openings=(box(2, 2, 4, 4),)),), columns=(column(3, 3),)),
        "column[1].at", "nothing over it",
    ),
    "a column twice": (
        table(columns=(column(1, 1), column(1.1, 1.0))), "column[2].at", "within column 1",
    ),
    "a wall in the air": (
        table(walls=(wall((0, 0), (0, 6), base=None),)), "wall[1].base", "nothing under an end",
    ),
    "a ribbed wall": (
        table(walls=(wall((0, 0), (0, 6), section=RIBBED),)), "wall[1].plate", "solid plate",
    ),
    "a wall in a plane of symmetry": (
        table(walls=(wall((0, 0), (0, 6)),), symmetry=(MirrorPlane.across(0, 0.0),)),
        "wall[1].along", "by half",
    ),
    "a brace to nowhere": (
        table(braces=(Brace(profile=SMALL, ends=line((1, 1), (30, 1)), on=("base", "slab")),)),
        "brace[1]", "nothing on 'slab' at (30, 1) m",
    ),
    "a brace without length": (
        table(braces=(Brace(profile=SMALL, ends=line((1, 1), (1, 1)), on=("slab", "slab")),)),
        "brace[1]", "joins two places",
    ),
    "a warped ramp": (
        table(ramps=(ramp((8, 0), (8, 3), (20, 4), (19, 0)),)), "ramp[1].outline", "parallel",
    ),
    "a steep ramp": (
        table(ramps=(ramp((8, 0), (8, 3), (12, 3), (12, 0)),)), "ramp[1].outline", "a slope of 100 %",
    ),
    "a ramp downwards": (
        table(ramps=(ramp(*RAMP, bottom="slab", top="base"),)), "ramp[1].to", "not above 'slab'",
    ),
    "a support of nothing": (
        table(supports=(Support(on="slab", along=line((0, 0), (0, 6))),)),
        "support[1]", "nothing held, and no spring",
    ),
    "a support in the air": (
        table(supports=(Support(on="slab", along=line((0, 0), (0, 9)), held=(True,) * 6),)),
        "support[1].along", "nothing on 'slab' at (0, 9) m",
    ),
    "a mass in the air": (
        table(masses=(Mass(on="slab", along=line((30, 2)), mass=1.0),)),
        "mass[1].at", "nothing on 'slab' at (30, 2) m",
    ),
    "a plane of symmetry that nothing reaches": (
        table(symmetry=(MirrorPlane.across(0, 15.0),)), "symmetry[1].at", "a part reaches it",
    ),
    "a beam that runs back over itself": (
        table(beams=(beam((2, 2), (4, 2), (3, 2)),)), "beam[1].along", "count twice",
    ),
    "a beam to the moon": (
        table(beams=(beam((2, 2), (9e9, 2)),)), "beam[1].along", "within 10000 m",
    ),
    "planes of symmetry at an odd angle": (
        table(
            slabs=(slab(corners=line((0, 0), (8, 0), (8, 5.6))),), columns=(column(4, 2),),
            symmetry=(MirrorPlane.across(1, 0.0), MirrorPlane.through(line((0, 0), (8, 5.6)))),
        ),
        "symmetry[2].along", "90, 60, 45",
    ),
    "a plane of symmetry through a slab": (
        table(symmetry=(MirrorPlane.across(0, 4.0),)), "symmetry[1].at", "on one side",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_building_is_told_with_place_and_remedy(name):
    building, place, words = WRONG[name]
    found = [p for p in building_problems(building) if p.place == place]
    assert found, [str(p) for p in building_problems(building)]
    assert any(words in f"{p.value} {p.rule}" for p in found)
    assert all(p.remedy for p in found)
    with pytest.raises(InputError, match="remedy"):
        build_building(building, Meshing(mesh_size=1.0))


@pytest.mark.parametrize(
    "building",
    [
        table(),
        table(ramps=(ramp(*RAMP),)),
        table(slabs=(slab(), slab(corners=box(8, 0, 12, 6)))),
        table(slabs=(slab(), slab(corners=box(3, 3, 5, 5), section=plate(0.5), panel=True))),
        table(beams=(beam((0, 3), (4, 3)), beam((4, 3), (8, 3)), beam((4, 0), (4, 6)))),
        table(beams=(beam((0, 3), (8, 3)), beam((0, 2.9), (8, 3.2)))),
        table(columns=(column(1, 1), column(1.41, 1.0))),
    ],
    ids=["table", "ramp", "side by side", "panel", "crossing beams", "small angle", "twins"],
)
def test_sound_buildings_have_no_problems(building):
    assert building_problems(building) == []


def test_all_mistakes_are_told_at_once():
    building = table(
        slabs=(slab(corners=BOW_TIE), slab(openings=(box(7, 5, 9, 7),))),
        beams=(beam((1, 1), (1, 1)),),
    )
    assert {p.place for p in building_problems(building)} == {
        "slab[1].outline", "slab[2].openings[1]", "beam[1].along",
    }  # fmt: skip


def test_columns_above_each_other_do_not_stand_in_each_other():
    storeys = (*LEVELS, Storey(name="up", level=4.0))
    above = column(1, 1, bottom="slab", top="up", base=None)
    building = table(storeys=storeys, slabs=(slab(), slab(on="up")), columns=(column(1, 1), above))
    assert building_problems(building) == []


def test_a_support_says_that_springs_cannot_pull_back():
    with pytest.raises(InputError, match="0 or more"):
        Support(on="slab", along=np.zeros((1, 2)), springs=(0, 0, -1.0, 0, 0, 0))
    assert replace(table(), name="x").name == "x"
