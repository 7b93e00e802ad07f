"""ETABS text files: a storey frame and a slab, against the same in SAP2000's syntax and by hand."""

import numpy as np
import pytest

from trundle.imports import Asked, read_model
from trundle.imports.summary import summary_of

FRAME = """$ PROGRAM INFORMATION
  PROGRAM  "ETABS"  VERSION "9.7.4"

$ CONTROLS
  UNITS  "KN"  "M"
  TITLE1  "two storeys"

$ STORIES - IN SEQUENCE FROM TOP
  STORY "STORY2"  HEIGHT 3.5
  STORY "STORY1"  HEIGHT 4
  STORY "BASE"  ELEV 1

$ DIAPHRAGM NAMES
  DIAPHRAGM "D1"  TYPE RIGID

$ MATERIAL PROPERTIES
  MATERIAL  "CONC"  M 2.5  W 24.5  TYPE "ISOTROPIC"  E 30000000  U 0.2  A 9.9E-06

$ FRAME SECTIONS
  FRAMESECTION  "C40"  MATERIAL "CONC"  SHAPE "Rectangular"  D 0.4  B 0.4
  FRAMESECTION  "B30X50"  MATERIAL "CONC"  SHAPE "Rectangular"  D 0.5  B 0.3
  FRAMESECTION  "B30X50"  I3MOD 0.7

$ WALL/SLAB/DECK PROPERTIES
  SHELLPROP  "S20"  MATERIAL "CONC"  PROPTYPE "SLAB"  TYPE "SHELL-THICK"  TM 0.2  TB 0.2

$ POINT COORDINATES
  POINT "1"  0 0
  POINT "2"  6 0
  POINT "3"  6 5
  POINT "4"  0 5

$ LINE CONNECTIVITIES
  LINE  "C1"  COLUMN  "1"  "1"  1
  LINE  "C2"  COLUMN  "2"  "2"  1
  LINE  "C3"  COLUMN  "3"  "3"  1
  LINE  "C4"  COLUMN  "4"  "4"  1
  LINE  "B1"  BEAM  "1"  "2"  0
  LINE  "B2"  BEAM  "4"  "3"  0

$ AREA CONNECTIVITIES
  AREA "F1"  FLOOR  4  "1"  "2"  "3"  "4"  0 0 0 0

$ POINT ASSIGNS
  POINTASSIGN  "1"  "BASE"  RESTRAINT "UX UY UZ RX RY RZ"
  POINTASSIGN  "2"  "BASE"  RESTRAINT "UX UY UZ RX RY RZ"
  POINTASSIGN  "3"  "BASE"  RESTRAINT "UX UY UZ RX RY RZ"
  POINTASSIGN  "4"  "BASE"  RESTRAINT "UX UY UZ RX RY RZ"

$ LINE ASSIGNS
""" + "".join(
    f'  LINEASSIGN  "{name}"  "STORY{storey}"  SECTION "{section}"\n'
    for storey in (1, 2)
    for name, section in [(f"C{i}", "C40") for i in range(1, 5)] + [("B1", "B30X50"), ("B2", "B30X50")]
) + """
$ AREA ASSIGNS
  AREAASSIGN  "F1"  "STORY1"  SECTION "S20"  DIAPH "D1"
  AREAASSIGN  "F1"  "STORY2"  SECTION "S20"

$ LOAD PATTERNS
  LOADPATTERN "DEAD"  TYPE  "Dead"  SELFWEIGHT  1
"""  # fmt: skip


def read(tmp_path, text, **asked):
    path = tmp_path / "tower.e2k"
    path.write_text(text)
    return read_model(path, Asked(**asked))


def test_storeys_masses_and_surfaces_are_as_said(tmp_path):
    """By hand: columns 4 x 0.16 x 7.5, beams 4 x 0.15 x 6, slabs 2 x 30 x 0.2 m3 at 2.5 t/m3."""
    found = read(tmp_path, FRAME)
    assert found.problems == ()
    assert found.units.said == "KN, M"
    summary = summary_of(found.structure, found)
    volume = 4 * 0.16 * 7.5 + 4 * 0.15 * 6.0 + 2 * 30.0 * 0.2
    assert summary.mass[2] == pytest.approx(2500.0 * volume, rel=1e-9)
    assert [(s.name, s.area) for s in summary.surfaces] == [
        ("z = 5 m", pytest.approx(30.0)),
        ("z = 8.5 m", pytest.approx(30.0)),
    ]
    assert "passed over: LOADPATTERN (1)" in found.told
    assert "floors and walls are meshed to 1 m or less" in found.told


def test_the_frame_is_that_of_the_other_syntax(tmp_path):
    """The same bare frame in SAP2000's tables: the same frequencies, modifiers and releases too."""
    from test_sap2000 import frames, held, joints, material, section, sections_of, table, written

    bare = "\n".join(line for line in FRAME.splitlines() if not line.startswith("  AREAASSIGN"))
    bare = bare.replace(
        '"B1"  "STORY2"  SECTION "B30X50"', '"B1"  "STORY2"  SECTION "B30X50"  RELEASE "M3I M3J"'
    ).replace('"C1"  "STORY1"  SECTION "C40"', '"C1"  "STORY1"  SECTION "C40"  ANG 30')
    ours = read(tmp_path, bare)
    assert ours.problems == ()
    z = (1.0, 5.0, 8.5)
    at = [(0.0, 0.0), (6.0, 0.0), (6.0, 5.0), (0.0, 5.0)]
    places = {1 + i + 10 * s: (*at[i], z[s]) for s in range(3) for i in range(4)}
    ends = {f"C{i}{s}": (1 + i + 10 * (s - 1), 1 + i + 10 * s) for s in (1, 2) for i in range(4)}
    ends |= {
        f"B{k}{s}": (a + 10 * s, b + 10 * s)
        for s in (1, 2)
        for k, (a, b) in ((1, (1, 2)), (2, (4, 3)))
    }
    square = 0.4**4 / 12.0
    torsion = 0.4**4 * 0.1406  # of a square (Timoshenko)
    from trundle.structure import STEEL, BeamSection

    c, b = (
        BeamSection.rectangle(width=w, depth=d, material=STEEL) for w, d in ((0.4, 0.4), (0.3, 0.5))
    )
    assert c.torsion_constant == pytest.approx(torsion, rel=2e-3)
    text = written(
        "KN, m, C", joints(places), held(range(1, 5)), material(3e7, 2.5),
        table("FRAME SECTION PROPERTIES 01 - GENERAL",
              section("C40", 0.16, square, square, c.torsion_constant, c.shear_area_z, c.shear_area_y),
              section("B30X50", 0.15, 0.3 * 0.5**3 / 12, 0.5 * 0.3**3 / 12, b.torsion_constant,
                      b.shear_area_z, b.shear_area_y, I3Mod=0.7)),
        frames(ends), sections_of({n: "C40" if n[0] == "C" else "B30X50" for n in ends}),
        table("FRAME RELEASE ASSIGNMENTS 1 - GENERAL", {"Frame": "B12", "M3I": "Yes", "M3J": "Yes"}),
        table("FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL", {"Frame": "C01", "Angle": 30}),
    )  # fmt: skip
    path = tmp_path / "same.s2k"
    path.write_text(text)
    theirs = read_model(path)
    assert theirs.problems == ()
    both = [one.structure.modes(60.0).frequencies for one in (ours, theirs)]
    assert len(both[0]) > 6
    np.testing.assert_allclose(both[0], both[1], rtol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('SECTION "S20"  DIAPH', 'SECTION "S99"  DIAPH', "names section 'S99'"),
        ('"B1"  BEAM  "1"', '"B1"  BEAM  "9"', "names point '9'"),
        ('"C1"  "STORY1"', '"C1"  "STORY7"', "names storey 'STORY7'"),
        ("E 30000000", "E many", "E1 must be a number; got 'many'"),
        ("HEIGHT 4", "HEIGHT x", "line 10: must be a number"),
        ('UNITS  "KN"  "M"', "", "states no UNITS"),
        ('"Rectangular"  D 0.4', '"Tee"  D 0.4', "a section of shape 'Tee' is not read"),
        ('FLOOR  4  "1"', 'FLOOR  5  "1" "1"', "three or four corners"),
        ('PROPTYPE "SLAB"', 'PROPTYPE "DECK"', "is no slab or wall of one thickness"),
        ("$ LOAD PATTERNS", '$ LINKS\n  LINK "K1"\n$ LOAD PATTERNS', "LINK is not read"),
        ("$ LOAD PATTERNS", '  SPRING "1" "BASE" 3\n$ LOAD', "SPRING is not read"),
        ('RESTRAINT "UX UY', 'RESTRANT "UX UY', "RESTRANT of a POINTASSIGN is not read"),
        ('RESTRAINT "UX UY', 'RESTRAINT "UXX UY', "UXX is no dof"),
        ('SECTION "C40"\n', 'SECTION "C40"  RELEASE "PINNED"\n', "a release 'PINNED' is not read"),
        (
            'SECTION "C40"\n',
            'SECTION "C40"  MATERIALOVERWRITE "X"\n',
            "MATERIALOVERWRITE of a LINEASSIGN",
        ),
        ('SECTION "S20"  DIAPH "D1"', 'SECTION "S20"  OPENING "Yes"', "OPENING is not read"),
        ('DIAPH "D1"', 'DIAPH "D9"', "names diaphragm 'D9'"),
        ('AREAASSIGN  "F1"  "STORY2"', 'AREAASSIGN  "F9"  "STORY2"', "names area 'F9'"),
        ('AREAASSIGN  "F1"  "STORY2"', 'AREAASSIGN  "F1"  "STORY1"', "is assigned twice"),
        ("D 0.4  B 0.4", "D 0.4  B 0.4 0.9", "must be keys with values"),
        ("D 0.4  B 0.4", "D 0.4  B 0.4  FILLMATERIAL STEEL", "FILLMATERIAL of a FRAMESECTION"),
        ('"Rectangular"  D 0.4', '"Concrete Encasement Rectangle"  D 0.4', "is not read"),
        ("  U 0.2  A", "  A", "has no E and U"),
        ('POINT "3"  6 5', 'POINT "2"  6 5', "is there once"),
        ("HEIGHT 4", "HEIGHT -4", "height must be above 0"),
        (
            '  AREAASSIGN  "F1"  "STORY1"  SECTION "S20"  DIAPH "D1"',
            '  AREAASSIGN  "F1"',
            "ends too early",
        ),
        ('"1"  "2"  "3"  "4"  0 0 0 0', '"1"  "2"  "3"  "4"  0', "of 4 corners how deep"),
        ('"1"  "2"  "3"  "4"  0 0 0 0', '"1"', "ends too early"),
        (
            'POINT "1"  0 0',
            'POINT "1"  0 0\n  POINT "5"  2.5 2.5\n$ L\n  LINE  "C5"  COLUMN  "5"  "5"  1\n'
            '  LINEASSIGN  "C5"  "STORY1"  SECTION "C40"\n$ P',
            "without sharing nodes: (2.5, 2.5, 5)",
        ),
        ("$ LOAD PATTERNS", '  MASSSOURCE  INCLUDE "LOADS"\n$ LOAD', "mass by loads is not read"),
        ('SECTION "C40"\n', 'SECTION "C40"  PROPMODI2 0.5\n', "PROPMODI2 of a line or area"),
    ],
)
def test_what_is_wrong_or_not_read_is_told(tmp_path, old, new, words):
    assert old in FRAME
    found = read(tmp_path, FRAME.replace(old, new, 1))
    assert found.structure is None
    assert words in str(found.problems[0])


def test_catalogue_sections_are_known_by_their_names(tmp_path):
    """W18x35 in kips and inches: 10.3 in2 and 510 in4 (AISC manual)."""
    text = FRAME.replace('SHAPE "Rectangular"  D 0.4  B 0.4', 'SHAPE "W18X35"')
    text = text.replace('"KN"  "M"', '"KIP"  "IN"').replace("HEIGHT 3.5", "HEIGHT 140")
    text = text.replace("HEIGHT 4", "HEIGHT 160")
    for old, new in (("6 0", "240 0"), ("6 5", "240 200"), ("0 5", "0 200")):
        text = text.replace(f"  {old}\n", f"  {new}\n")
    found = read(tmp_path, text)
    assert found.problems == ()
    column = next(b for b in found.structure.beams if b.name == "C40").section
    assert column.area == pytest.approx(10.3 * 0.0254**2, rel=0.01)
    assert column.inertia_y == pytest.approx(510.0 * 0.0254**4, rel=0.01)
