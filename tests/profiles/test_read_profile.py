"""Measured profiles as programs write them, and damaged ones."""

from pathlib import Path

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.profiles import ProfileOptions, read_profile
from trundle.road import classify

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
SI = ProfileOptions(station_unit="m", unit="m", detrend=False)

ERD = """ERDFILEV2.00
      2,      6,     -1,      1,      5,       0.25,     -1,
TITLE   Section 1, Run 1
SHORTNAMLElev.  RElev.
UNITSNAMmm      mm
XLABEL  Distance
XUNITS  m
DATE    11/Apr/1997

END
 0.0 1.0
 1.5 1.0
 2.0 0.5
 2.5 0.5
 1.0 0.0
 0.0 0.0
"""
CRG_HEAD = """$CT
A straight road of five cuts
$
$ROAD_CRG
reference_line_start_u   = 0.0
reference_line_end_u     = 1.9
reference_line_increment = 0.1
long_section_v_right     = -1.0
long_section_v_left      = 1.0
long_section_v_increment = 0.5
$
$KD_DEFINITION
#:LRFI
U:reference line u,m,0,0.1
D:long section 1,m
D:long section 2,m
D:long section 3,m
D:long section 4,m
D:long section 5,m
$
"""
V, U = np.linspace(-1.0, 1.0, 5), 0.1 * np.arange(20)
HEIGHTS = 0.01 * np.sin(2 * np.pi * U)[:, None] + 0.002 * V


def crg(rows=HEIGHTS):
    lines = ["".join(f"{z:10.6f}" for z in row) for row in rows]
    return CRG_HEAD + "$" * 72 + "\n" + "\n".join(lines) + "\n"


def table(heading, rows):
    return heading + "\n" + "\n".join(rows) + "\n"


def kept(tmp_path, text, name="road.csv"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


RISING = [f"{0.1 * i:.1f}" for i in range(30)]
SAW = [f"{(7 * i) % 5}" for i in range(30)]


@pytest.mark.parametrize(
    "text",
    [
        table("station [m],height [mm]", map(",".join, zip(RISING, SAW, strict=True))),
        table("Distance (m)\tCenter Elevation (mm)", map("\t".join, zip(RISING, SAW, strict=True))),
        table("s_m elevation_mm", map(" ".join, zip(RISING, SAW, strict=True))),
        table("station;height\nm;mm", map(";".join, zip(RISING, SAW, strict=True))),
        table(
            "station [m];height [mm]",
            (";".join(p).replace(".", ",") for p in zip(RISING, SAW, strict=True)),
        ),
        table("Headers:\n\nDistance [m], Laser 1 [mm]", map(", ".join, zip(RISING, SAW, strict=True))),
        table("height [mm],chainage [m]", map(",".join, zip(SAW, RISING, strict=True))),
        table("station [m],height [mm]", map(",".join, zip(RISING, SAW, strict=True)))
        .replace("\n", "\r\n").encode("utf-16"),
    ],
)  # fmt: skip
def test_tables_are_read_however_they_are_written(tmp_path, text):
    """Delimiters, decimal commas, units in headings or below them, any order, any encoding."""
    road = read_profile(kept(tmp_path, text), ProfileOptions(detrend=False)).road
    (track,) = road.tracks
    np.testing.assert_allclose(track.station, np.array(RISING, float), atol=1e-12)
    np.testing.assert_allclose(track.elevation, 1e-3 * np.array(SAW, float), atol=1e-12)


def test_units_that_are_stated_win_and_feet_are_feet(tmp_path):
    """A heading says mm; the user says in over ft."""
    text = table("station [m],height [mm]", map(",".join, zip(RISING, SAW, strict=True)))
    options = ProfileOptions(station_unit="ft", unit="in", detrend=False)
    (track,) = read_profile(kept(tmp_path, text), options).road.tracks
    assert track.station[-1] == pytest.approx(2.9 * 0.3048)
    assert track.elevation[1] == pytest.approx(2 * 0.0254)


def test_a_trend_is_taken_off_each_track(tmp_path):
    """A grade of 5 % and a datum of 583 m are no roughness; what is left has no line in it."""
    s = np.arange(0.0, 40.0, 0.25)
    bump = 1e-3 * np.sin(2 * np.pi * s / 3.0)
    text = table("station [m],height [m]", (f"{a:.2f},{583 + 0.05 * a + b:.6f}" for a, b in zip(s, bump, strict=True)))  # fmt: skip
    (track,) = read_profile(kept(tmp_path, text)).road.tracks
    assert np.polyfit(track.station, track.elevation, 1) == pytest.approx([0.0, 0.0], abs=1e-9)
    slope, level = np.polyfit(s, bump, 1)
    np.testing.assert_allclose(track.elevation, bump - slope * s - level, atol=2e-6)


def test_erd_files_are_read(tmp_path):
    """Names, units, step and both channels of a header as profilers write it."""
    options = ProfileOptions(lateral=(0.9, -0.9), detrend=False)
    road = read_profile(kept(tmp_path, ERD, "run.erd"), options).road
    right, left = road.tracks
    np.testing.assert_allclose(left.station, 0.25 * np.arange(6))
    np.testing.assert_allclose(left.elevation, 1e-3 * np.array([0.0, 1.5, 2.0, 2.5, 1.0, 0.0]))
    np.testing.assert_allclose(right.elevation[:3], 1e-3 * np.array([1.0, 1.0, 0.5]))
    only = ProfileOptions(tracks=("RElev.",), detrend=False)
    (track,) = read_profile(kept(tmp_path, ERD, "run.erd"), only).road.tracks
    np.testing.assert_allclose(track.elevation, right.elevation)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("      6,", "      7,", "says 7 samples of 2 channels on line 2 and holds 6"),
        (" 0.0 0.0\n", " 0.0\n", "line 16 holds 1 numbers, and line 2 says 2 channels"),
        ("  5,  ", "  1,  ", "are binary .kind 1 on line 2"),
        ("END\n", "", "no line END"),
        (" 2.0 0.5", " 2.0 x.5", "line 13 must be a number; got 'x.5'"),
        ("UNITSNAMmm      mm\n", "", 'unit of its heights .* unit = "m" or "mm"'),
        ("UNITSNAMmm      mm", "UNITSNAMcounts  cts", "'cts', is no length"),
        ("0.25,", "0,", "step on line 2 must be above 0"),
        ("      2,      6", "     x2,      6", "line 2 must hold the numbers"),
        ("      2,      6", "      1,      6", "line 11 holds 2 numbers, and line 2 says 1"),
        ("      6,", "      4,", "says 4 samples of 2 channels on line 2 and holds 6"),
        (" 1.5 1.0", " 1,5 1,0", "decimal commas"),
        ("0.25,", "1e308,", "step on line 2 must be above 0"),
        ("XUNITS  m", "XSTART  inf\nXUNITS  m", "XSTART must be a number"),
        (" 2.0 0.5", " nan 0.5", "line 13 must be a number"),
    ],
)
def test_damaged_erd_files_are_refused_with_their_line(tmp_path, old, new, words):
    text = ERD.replace(old, new, 1) if old != " 0.0 0.0\n" else ERD[: -len(old)] + new
    options = ProfileOptions(lateral=(0.9, -0.9))
    with pytest.raises(InputError, match=words):
        read_profile(kept(tmp_path, text, "run.erd"), options)


def test_opencrg_files_are_read(tmp_path):
    """Five cuts where the header says they lie, heights to the six digits of the text."""
    pytest.importorskip("pyopencrg")
    road = read_profile(kept(tmp_path, crg(), "road.crg"), ProfileOptions(detrend=False)).road
    np.testing.assert_allclose(road.lateral, V)
    for track, heights in zip(road.tracks, HEIGHTS.T, strict=True):
        np.testing.assert_allclose(track.station, U, atol=1e-12)
        np.testing.assert_allclose(track.elevation, heights, atol=6e-7)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (crg(HEIGHTS[:10]), "cut short"),
        (crg()[:-5] + "\n", "its last line has 46 columns"),
        (crg().replace("reference_line_end_u     = 1.9\n", ""), "does not say where"),
        (crg().replace("$ROAD_CRG\n", "$ROAD_CRG_FILE\n/etc/hostname\n$\n$ROAD_CRG\n"), "not opened"),
        (crg(HEIGHTS[:1]), "cut short|cannot be read"),
        (crg().replace("  0.004878", "      ****", 1), "heights are missing"),
        (crg().replace("long section 1,m", "long section 1,mm"), "cannot be read"),
        (CRG_HEAD, "cut short|cannot be read"),
        (crg().replace("v_increment = 0.5", "v_increment = 0.25"), "its 5 cuts lie from -1 to 0 m"),
        (crg().replace("v_right     = -1.0", "v_right     = 1.0"), "which is wrong"),
        (crg().replace("v_right     = -1.0", "v_right     = abc"), "must be a number; got 'abc'"),
        (crg().replace("end_u     = 1.9", "end_u     = nan"), "must be a number; got 'nan'"),
    ],
)  # fmt: skip
def test_damaged_opencrg_files_are_refused(tmp_path, text, words):
    pytest.importorskip("pyopencrg")
    with pytest.raises(InputError, match=words):
        read_profile(kept(tmp_path, text, "road.crg"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("station [m],h [mm]\n0,1\n1,x2\n1.5,3\n2,2\n3,4\n", "line 3 must hold numbers; got '1,x2'"),
        ("station [m],h [mm]\n0,1\n1,nan\n1.5,3\n2,2\n", "line 3 holds 'nan'"),
        ("station [m],h [mm]\n0,1\n1,2\n0.5,3\n2,2\n3,3\n", "line 4: the station falls: 1, then 0.5"),
        ("station [m],h [mm]\n0,1\n1,2\n1,3\n2,2\n3,3\n", "line 4: the station is given twice"),
        ("station [m],h [mm]\n0,1\n", "no samples|1 point"),
        ("station [m],h [mm]\n0,1\n1,2\n2,3\n", "3 point"),
        ("station [m],h\n0,1\n1,2\n2,3\n3,1\n", "does not say the unit of its heights"),
        ("station,h [mm]\n0,1\n1,2\n2,3\n3,1\n", "unit of its stations"),
        ("h [mm]\n1\n2\n3\n4\n5\n", "one column"),
        ("station [m],h [kg]\n0,1\n1,2\n2,3\n3,1\n", "'kg', is no length"),
        ("station [m],a [mm],b [mm]\n0,1,1\n1,2,1\n2,3,2\n3,1,3\n", "2 tracks .a, b. and does not say"),
        (table("s [m],h [m]", map(",".join, zip(RISING, SAW, strict=True))), "in mm"),
        ("station [m],h [mm]\n0,\n1,2\n2,3\n3,1\n4,1\n5,1\n", "line 2 must|one column"),
        ("station [m],h [mm]\n0,abc\n1,2\n2,3\n3,1\n4,1\n5,1\n", "line 2 must hold numbers"),
        ("station [m];h [mm]\n0;1\n1;2\n;3\n3;1\n4;1\n5;1\n", "line 4 must hold numbers"),
        ("station [m],h [mm]\n0,1\n1,2\n# 2,3\n3,1\n4,1\n5,1\n", "line 4 must hold numbers"),
        ("station [m],h [mm]\n0,1\n1,2\n2,3\n3,1\n" + "n/a,n/a\n" * 9, "line 9 must hold numbers"),
        ("station [m],h [mm]\n0,1\n1,2\n2,3\n3,1\n30,1\n31,1\n", "line 6: nothing from station 3"),
        ("station [m],left v = 0.6 m\n0,1\n1,2\n2,3\n3,1\n", "unit of its heights"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0", "is not text"),
        ("", "no samples"),
    ],
)  # fmt: skip
def test_wrong_files_are_refused_with_line_and_remedy(tmp_path, text, words):
    with pytest.raises(InputError, match=words):
        read_profile(kept(tmp_path, text))


def test_what_a_user_states_is_doubted_and_not_refused(tmp_path):
    """A block pavement laid by hand may be as steep as this; who says so is believed."""
    text = table("s [m],h [m]", map(",".join, zip(RISING, SAW, strict=True)))
    assert read_profile(kept(tmp_path, text), SI).road.tracks[0].elevation.max() == 4.0


def test_the_measured_roads_at_hand():
    """544 m at 0.25 m by its source; ten metres of Belgian blocks on five cuts by theirs."""
    if not DATA.exists():
        pytest.skip("no measured roads at hand")
    options = ProfileOptions(station_unit="m", unit="m")
    road = read_profile(DATA / "sorel_profile_1.txt", options).road
    (track,) = road.tracks
    assert (track.station[0], track.length, len(track.station)) == (478.0, 544.0, 2177)
    assert classify(track).name in "AB"
    blocks = read_profile(DATA / "belgian_block.csv").road
    np.testing.assert_allclose(blocks.lateral, [-1.37, -0.60, 0.17, 0.94, 1.70])
    assert all(len(one.station) == 1001 and one.length == 10.0 for one in blocks.tracks)
    with pytest.raises(InputError, match="unit of its stations"):
        read_profile(DATA / "sorel_profile_1.txt")


def test_the_place_of_a_track_is_no_unit_of_its_heights(tmp_path):
    """Places in m, cm or mm, before or behind the unit of the heights, which is mm."""
    rows = map(",".join, zip(RISING, SAW, SAW, strict=True))
    heading = "station [m],left height mm v = 600 mm,right height [mm] V = -6e-1 m"
    road = read_profile(kept(tmp_path, table(heading, rows)), ProfileOptions(detrend=False)).road
    np.testing.assert_allclose(road.lateral, [-0.6, 0.6])
    assert road.tracks[0].elevation.max() == pytest.approx(4e-3)


def test_modifiers_of_a_grid_are_told(tmp_path):
    """They are not applied: who reads it must know."""
    pytest.importorskip("pyopencrg")
    text = crg().replace("$KD_DEFINITION", "$ROAD_CRG_MODS\nscale_z_grid = 1000\n$\n$KD_DEFINITION")
    read = read_profile(kept(tmp_path, text, "road.crg"), ProfileOptions(detrend=False))
    assert "modifiers" in read.told[0]
