"""SAP2000's text files: frames with published periods, closed forms, and tables that are told."""

import numpy as np
import pytest

from trundle.dynamics import natural_modes
from trundle.imports import Asked, read_model, units_of
from trundle.structure.elements import NodeInertia

HEAD = 'File C:\\model.s2k was saved on 1/1/24 at 10:00:00\n \nTABLE:  "PROGRAM CONTROL"\n'


def table(title, *rows):
    lines = [f'TABLE:  "{title}"']
    for row in rows:
        cells = (f'{k}="{v}"' if " " in str(v) else f"{k}={v}" for k, v in row.items())
        lines.append("   " + "   ".join(cells))
    return "\n".join(lines) + "\n \n"


def written(units, *tables):
    text = HEAD + f'   ProgramName=SAP2000   Version=24.0.0   CurrUnits="{units}"\n \n'
    return text + "".join(tables) + "END TABLE DATA\n"


def joints(places, extra=()):
    """Write joints, some of them with a line that goes on below."""
    rows = [
        dict(Joint=i, CoordSys="GLOBAL", CoordType="Cartesian", XorR=x, Y=y, Z=z, SpecialJt="No",
             GlobalX=x, GlobalY=y, GlobalZ=z)
        for i, (x, y, z) in places.items()
    ]  # fmt: skip
    text = table("JOINT COORDINATES", *rows, *extra)
    return text.replace("   SpecialJt=No   GlobalX", " _\n        SpecialJt=No   GlobalX", 1)


def held(nodes, dofs="111111"):
    keys = ("U1", "U2", "U3", "R1", "R2", "R3")
    return table(
        "JOINT RESTRAINT ASSIGNMENTS",
        *(
            {
                "Joint": n,
                **{k: "Yes" if d == "1" else "No" for k, d in zip(keys, dofs, strict=True)},
            }
            for n in nodes
        ),
    )


def material(e, mass=0.0, weight=0.0, nu=0.2, name="MAT"):
    return table(
        "MATERIAL PROPERTIES 01 - GENERAL",
        dict(Material=name, Type="Concrete", SymType="Isotropic", TempDepend="No"),
    ) + table(
        "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES",
        dict(Material=name, UnitWeight=weight, UnitMass=mass, E1=e, G12=e / 2 / (1 + nu), U12=nu),
    )


def section(name, area, i33, i22, j=1.0, as2=0.0, as3=0.0, **more):
    return dict(SectionName=name, Material="MAT", Shape="Rectangular", Area=area, TorsConst=j,
                I33=i33, I22=i22, AS2=as2, AS3=as3, **more)  # fmt: skip


def frames(ends):
    return table(
        "CONNECTIVITY - FRAME",
        *(dict(Frame=n, JointI=i, JointJ=j, IsCurved="No") for n, (i, j) in ends.items()),
    )


def sections_of(which):
    return table(
        "FRAME SECTION ASSIGNMENTS",
        *(dict(Frame=n, AnalSect=s, MatProp="Default") for n, s in which.items()),
    )


def read(tmp_path, text, **asked):
    path = tmp_path / "model.s2k"
    path.write_text(text)
    return read_model(path, Asked(**asked))


PLANAR = table(
    "ACTIVE DEGREES OF FREEDOM", dict(UX="Yes", UY="No", UZ="Yes", RX="No", RY="Yes", RZ="No")
)


def test_bathe_and_wilsons_frame(tmp_path):
    """10 bays, 9 storeys, no shear, lumped masses: omega2 as published, to its six digits."""
    places = {1 + i + 11 * s: (20.0 * i, 0.0, 10.0 * s) for s in range(10) for i in range(11)}
    ends, n = {}, 0
    for s in range(10):
        for i in range(11):
            here = 1 + i + 11 * s
            if s < 9:
                ends[n := n + 1] = (here, here + 11)
            if s > 0 and i < 10:
                ends[n := n + 1] = (here, here + 1)
    text = written(
        "Kip, ft, F", PLANAR, joints(places), held(range(1, 12)), material(432000.0, 1.0, 0.0),
        table("FRAME SECTION PROPERTIES 01 - GENERAL", section("S", 3.0, 1.0, 1.0)),
        frames(ends), sections_of(dict.fromkeys(ends, "S")),
    )  # fmt: skip
    found = read(tmp_path, text)
    assert found.problems == ()
    assert found.units.said == "Kip, ft"
    squares = found.structure.modes(3.0).omega[:3] ** 2
    np.testing.assert_allclose(squares, [0.589541, 5.52695, 16.5878], rtol=5e-6)


@pytest.mark.parametrize(
    ("n", "period"), [(1, 0.054547), (2, 0.042333), (4, 0.039090), (6, 0.038485)]
)
@pytest.mark.parametrize("divided", ["frames", "segments", "largest"])
def test_a_cantilever_of_lumped_masses(tmp_path, n, period, divided):
    """96 in, 12 x 18 in, by frames of their own, by segments, by a largest length."""
    units = n if divided == "frames" else 1
    places = {i + 1: (0.0, 0.0, 96.0 * i / units) for i in range(units + 1)}
    ends = {i + 1: (i + 1, i + 2) for i in range(units)}
    mesh = dict(Frame=1, AutoMesh="Yes", AtJoints="Yes", AtFrames="No", NumSegments=0, MaxLength=0)
    mesh |= {"segments": {"NumSegments": n}, "largest": {"MaxLength": 96.0 / n}}.get(divided, {})
    text = written(
        "Kip, in, F", PLANAR, joints(places), held([1]), material(3600.0, 2.3e-7),
        table("FRAME SECTION PROPERTIES 01 - GENERAL",
              section("S", 216.0, 18.0 * 12.0**3 / 12.0, 12.0 * 18.0**3 / 12.0)),
        frames(ends), sections_of(dict.fromkeys(ends, "S")),
        table("FRAME AUTO MESH ASSIGNMENTS", mesh),
    )  # fmt: skip
    found = read(tmp_path, text)
    assert found.problems == ()
    first = found.structure.modes(200.0).frequencies[0]
    assert 1.0 / first == pytest.approx(period, rel=2e-5)


def diaphragm_frame(z=(0.0, 4.0, 8.0)):
    """Two storeys with rigid floors; masses at two nodes of their own, in the plane of each."""
    corners = [(0.0, 0.0), (6.0, 0.0), (6.0, 5.0), (0.0, 5.0)]
    places = {1 + c + 10 * s: (*corners[c], z[s]) for s in range(3) for c in range(4)}
    places |= {19: (3.0, 2.5, z[1]), 29: (3.0, 2.5, z[2])}
    ends, n = {}, 0
    for s in range(2):
        for c in range(4):
            ends[n := n + 1] = (1 + c + 10 * s, 11 + c + 10 * s)
    columns = list(ends)
    for s in (1, 2):
        for c in range(4):
            ends[n := n + 1] = (1 + c + 10 * s, 1 + (c + 1) % 4 + 10 * s)
    which = {k: "COL" if k in columns else "BEAM" for k in ends}
    constraints = table(
        "CONSTRAINT DEFINITIONS - DIAPHRAGM",
        *(dict(Name=f"D{s}", CoordSys="GLOBAL", Axis="Z", MultiLevel="No") for s in (1, 2)),
    ) + table(
        "JOINT CONSTRAINT ASSIGNMENTS",
        *(
            dict(Joint=j, Constraint=f"D{s}", Type="Diaphragm")
            for s in (1, 2)
            for j in [*(1 + c + 10 * s for c in range(4)), 9 + 10 * s]
        ),
    )
    return places, ends, which, constraints


def test_floors_move_as_one_in_their_planes(tmp_path):
    """Shear frame by hand: beams stiff without end, E I of columns clamped at both ends.

    Each storey has the stiffness 4 x 12 E I / h3; two equal masses on two equal storeys have
    omega2 = (3 -+ sqrt 5) / 2 k / m along x and y; about z, k by the columns' distances.
    """
    places, ends, which, constraints = diaphragm_frame()
    mass, about = 90.0, 90.0 * (6.0**2 + 5.0**2) / 12.0
    text = written(
        "KN, m, C", joints(places), held([1, 2, 3, 4]), held([19, 29], "001110"),
        material(2e7),
        table("FRAME SECTION PROPERTIES 01 - GENERAL",
              section("COL", 10.0, 0.003, 0.002, j=1e-9), section("BEAM", 10.0, 1e4, 1e4, j=1e4)),
        frames(ends), sections_of(which), constraints,
        table("JOINT ADDED MASS ASSIGNMENTS",
              *(dict(Joint=j, CoordSys="Local", Mass1=mass, Mass2=mass, Mass3=0, MMI1=0, MMI2=0,
                     MMI3=about) for j in (19, 29))),
    )  # fmt: skip
    found = read(tmp_path, text)
    assert found.problems == ()
    # local 2 of a column points along x: I33 bends along x
    along = [4.0 * 12.0 * 2e7 * i / 4.0**3 for i in (0.003, 0.002)]
    turning = along[0] * 2.5**2 + along[1] * 3.0**2
    roots = np.array([(3.0 - np.sqrt(5.0)) / 2.0, (3.0 + np.sqrt(5.0)) / 2.0])
    squares = np.concatenate(
        [roots * along[0] / mass, roots * along[1] / mass, roots * turning / about]
    )
    mass_matrix, stiffness = found.structure.matrices()
    omega = natural_modes(mass_matrix, stiffness, f_max=60.0).omega
    # axial give of columns and beams, 1 : 1e3 and more of it, leaves 0.2 %
    np.testing.assert_allclose(omega, np.sqrt(np.sort(squares)), rtol=2e-3)


def slab(*more):
    """Return a simply supported slab of 6 x 4 m in 16 x 12 intervals, in kN and mm."""
    a, b, t, e, rho = 6000.0, 4000.0, 150.0, 30.0, 2.5e-12  # kN, mm: mass in kN s2/mm
    places = {1: (0.0, 0.0, 0.0), 2: (a, 0.0, 0.0), 3: (a, b, 0.0), 4: (0.0, b, 0.0)}
    places |= {5 + i: (a * (i + 1) / 16, 0.0, 0.0) for i in range(15)}
    places |= {20 + i: (a * (i + 1) / 16, b, 0.0) for i in range(15)}
    places |= {35 + i: (0.0, b * (i + 1) / 12, 0.0) for i in range(11)}
    places |= {46 + i: (a, b * (i + 1) / 12, 0.0) for i in range(11)}
    return written(
        "KN, mm, C", joints(places), held(places, "111000"), material(e, rho, 2.45e-8),
        table("AREA SECTION PROPERTIES",
              dict(Section="SLAB", Material="MAT", MatAngle=0, AreaType="Shell", Type="Shell-Thin",
                   DrillDOF="Yes", Thickness=t, BendThick=t, M11Mod=1, MMod=1)),
        table("CONNECTIVITY - AREA", dict(Area=1, NumJoints=4, Joint1=1, Joint2=2, Joint3=3,
                                          Joint4=4)),
        table("AREA SECTION ASSIGNMENTS", dict(Area=1, Section="SLAB", MatProp="Default")),
        table("AREA AUTO MESH ASSIGNMENTS",
              dict(Area=1, MeshType="Num Intervals", Number1=16, Number2=12)),
        *more,
    )  # fmt: skip


def test_a_slab_is_meshed_as_it_says(tmp_path):
    """Simply supported, 16 x 12 intervals, thin: Navier's frequency; units of kN and mm."""
    text = slab()
    found = read(tmp_path, text)
    assert found.problems == ()
    floor = found.structure
    assert len(floor.nodes) == 17 * 13
    rigidity = 30e9 * 0.15**3 / 12 / (1 - 0.2**2)
    navier = 0.5 * np.pi * (1 / 36 + 1 / 16) * np.sqrt(rigidity / (2500.0 * 0.15))
    assert floor.modes(30.0).frequencies[0] == pytest.approx(navier, rel=0.006)
    assert list(floor.surfaces) == ["floor"]
    largest = text.replace("Num Intervals", "Max Size").replace(
        "Number1=16   Number2=12", "MaxSize1=375   MaxSize2=334"
    )
    again = read(tmp_path, largest).structure
    assert again.modes(30.0).frequencies == pytest.approx(floor.modes(30.0).frequencies)
    # a quarter of the stiffness along x, all along y and in twist, coupled by the root of both
    other = read(tmp_path, text.replace("M11Mod=1", "M11Mod=0.25")).structure
    coupling = 0.5 * 0.2 + 2.0 * 0.5 * (1.0 - 0.2)
    factor = 0.25 / 6.0**4 + 2.0 * coupling / (6.0 * 4.0) ** 2 + 1.0 / 4.0**4
    expected = 0.5 * np.pi * np.sqrt(factor * rigidity / (2500.0 * 0.15))
    assert other.modes(30.0).frequencies[0] == pytest.approx(expected, rel=0.006)


def portal(*tables, releases=None):
    """Return a beam between two stiff clamped columns, loaded by nothing but itself."""
    places = {1: (0, 0, 0), 2: (0, 0, 3), 3: (8, 0, 3), 4: (8, 0, 0)}
    ends = {1: (1, 2), 2: (2, 3), 3: (4, 3)}
    more = [] if releases is None else [table("FRAME RELEASE ASSIGNMENTS 1 - GENERAL", releases)]
    return written(
        "N, m, C", PLANAR, joints(places), held([1, 4]), material(2e11, 7850.0, 7850.0 * 9.80665),
        table("FRAME SECTION PROPERTIES 01 - GENERAL",
              section("COL", 1.0, 1.0, 1.0, t3=0.4, t2=0.4),
              section("BEAM", 0.01, 2e-4, 1e-4, t3=0.4, t2=0.2)),
        frames(ends), sections_of({1: "COL", 2: "BEAM", 3: "COL"}),
        table("FRAME AUTO MESH ASSIGNMENTS",
              dict(Frame=2, AutoMesh="Yes", AtJoints="Yes", AtFrames="No", NumSegments=16,
                   MaxLength=0)),
        *more, *tables,
    )  # fmt: skip


def bending(length, root):
    return root**2 / length**2 * np.sqrt(2e11 * 2e-4 / (7850.0 * 0.01)) / (2.0 * np.pi)


def first_of(tmp_path, text):
    found = read(tmp_path, text)
    assert found.problems == ()
    return found.structure.modes(60.0).frequencies[0]


@pytest.mark.parametrize(
    ("releases", "root"),
    [
        (None, 4.730041),
        (dict(Frame=2, M3I="Yes", M3J="Yes", PartialFix="No"), np.pi),
        (dict(Frame=2, M3I="Yes", M3J="No", PartialFix="No"), 3.926602),
        (dict(Frame=2, M2I="Yes", M2J="Yes", TI="Yes", PartialFix="No"), 4.730041),
    ],
)
def test_moments_are_released_about_their_axes(tmp_path, releases, root):
    """Clamped, hinged, both: Euler's beams of 8 m; columns a thousand times as stiff."""
    assert first_of(tmp_path, portal(releases=releases)) == pytest.approx(
        bending(8.0, root), rel=4e-3
    )


def test_end_offsets_shorten_what_bends(tmp_path):
    """0.8 m at both ends, rigid by half: a clamped beam of 7.2 m with the mass of its length."""
    offsets = table(
        "FRAME OFFSET (LENGTH) ASSIGNMENTS",
        dict(Frame=2, Type="User", LengthI=0.8, LengthJ=0.8, RigidFact=0.5),
    )
    assert first_of(tmp_path, portal(offsets)) == pytest.approx(bending(7.2, 4.730041), rel=8e-3)


def test_insertion_points_lower_the_axis(tmp_path):
    """Cantilever below its joints by half its depth: the same in bending, I + A e2 at the joints.

    Held at both ends in rotation and translation the beam is as stiff; at a joint, mass apart,
    the rotation that a moment gives is that of the centroid. What is checked is the offset.
    """
    points = table(
        "FRAME INSERTION POINT ASSIGNMENTS",
        dict(Frame=2, CardinalPt="8 (top center)", MirrorAbt2="No", TransStiff="Yes",
             CoordSys="Local", JtOffset1I=0, JtOffset2I=0, JtOffset3I=0),
    )  # fmt: skip
    beam = next(b for b in read(tmp_path, portal(points)).structure.beams if b.name == "BEAM")
    np.testing.assert_allclose(beam.offset, [0.0, 0.0, -0.2], atol=1e-12)
    still = points.replace("TransStiff=Yes", "TransStiff=No")
    beam = next(b for b in read(tmp_path, portal(still)).structure.beams if b.name == "BEAM")
    np.testing.assert_array_equal(beam.offset, 0.0)
    shifted = points.replace("JtOffset2I=0", "JtOffset2I=-0.1").replace("8 (top center)", "10")
    floor = read(tmp_path, portal(shifted)).structure
    starts = floor.nodes[
        next(b.elements for b in floor.beams if b.name == "BEAM")[[0, -1]][:, [0, 1]]
    ]
    np.testing.assert_allclose(starts[0, 0], [0.0, 0.0, 2.9], atol=1e-12)
    np.testing.assert_allclose(starts[1, 1], [8.0, 0.0, 3.0], atol=1e-12)


def masses(tmp_path, text):
    floor = read(tmp_path, text).structure
    joints = [g.inertia[:, 2].sum() for g in floor.others if isinstance(g, NodeInertia)]
    return sum(group.mass.sum() for group in floor.masses) + sum(joints)


def test_mass_comes_from_where_the_model_says(tmp_path):
    """Elements 7850 (0.01 x 8 + 1 x 6) kg; loads by their shares over g; weight by its pattern."""
    own = 7850.0 * (0.01 * 8.0 + 6.0)
    assert masses(tmp_path, portal()) == pytest.approx(own)
    patterns = table(
        "LOAD PATTERN DEFINITIONS",
        dict(LoadPat="DEAD", DesignType="Dead", SelfWtMult=1),
        dict(LoadPat="LIVE", DesignType="Live", SelfWtMult=0),
    )
    loads = table(
        "FRAME LOADS - DISTRIBUTED",
        dict(Frame=2, LoadPat="LIVE", CoordSys="GLOBAL", Type="Force", Dir="Gravity",
             DistType="RelDist", RelDistA=0, RelDistB=1, FOverLA=1000.0, FOverLB=1000.0),
    ) + table(
        "JOINT LOADS - FORCE", dict(Joint=2, LoadPat="LIVE", CoordSys="GLOBAL", F1=0, F2=0, F3=-500)
    )  # fmt: skip
    source = table(
        "MASS SOURCE",
        dict(MassSource="M", Elements="No", Masses="No", Loads="Yes", IsDefault="Yes",
             LoadPat="DEAD", Multiplier=1),
        dict(MassSource="M", LoadPat="LIVE", Multiplier=0.3),
    )  # fmt: skip
    expected = own + 0.3 * (8.0 * 1000.0 + 500.0) / 9.80665
    assert masses(tmp_path, portal(patterns, loads, source)) == pytest.approx(expected)
    assert masses(tmp_path, portal(patterns, loads)) == pytest.approx(own)  # loads are no mass


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t.replace("END TABLE DATA\n", ""), "does not end with END TABLE DATA"),
        (lambda t: t.replace("Frame=2   AnalSect=BEAM", "Frame=2   AnalSect=BIM"), "names section 'BIM'"),
        (lambda t: t.replace("JointI=2   JointJ=3", "JointI=2   JointJ=33"), "names joint '33'"),
        (lambda t: t.replace("E1=200000000000.0", "E1=abc"), "E1 must be a number; got 'abc'"),
        (lambda t: t.replace("Area=0.01", "Area=-0.01"), "area"),
        (lambda t: t.replace("IsCurved=No", "IsCurved=Yes"), "a curved frame is not read"),
        (lambda t: t.replace("AtFrames=No", "AtFrames=Yes"), "divide each other without a joint"),
        (lambda t: t.replace("N, m, C", "N, parsec, C"), "are not understood"),
        (lambda t: t.replace("Joint=2   CoordSys", "Joint=1   CoordSys", 1), "is there twice"),
        (lambda t: t.replace("   Frame=1", "   Frame"), "must be Key=Value pairs"),
        (lambda t: t.replace('TABLE:  "JOINT COORDINATES"', 'TABLE:  "CABLES"'), "CABLES"),
        (lambda t: t.replace("JointJ=3", "JointJ=2", 1), "has no length"),
        (lambda t: t.replace("U1=Yes", "U1=Ja"), "U1 must be Yes or No; got 'Ja'"),
        (lambda t: t.replace("Shape=Rectangular", "Shape=Nonprismatic"), "changes along its frame"),
        (lambda t: t.replace("SymType=Isotropic", "SymType=Orthotropic"), "isotropic ones are read"),
    ],
)  # fmt: skip
def test_what_is_wrong_or_not_read_is_told(tmp_path, change, words):
    good = portal()
    assert change(good) != good
    found = read(tmp_path, change(good))
    assert found.structure is None
    assert words in str(found.problems[0])


def test_tables_that_are_not_read_are_told_and_may_be_ignored(tmp_path):
    link = table("CONNECTIVITY - LINK", dict(Link=1, JointI=2, JointJ=3))
    drawn = table("GRID LINES", dict(CoordSys="GLOBAL", AxisDir="X", GridID="A", XRYZCoord=0))
    found = read(tmp_path, portal(link, drawn))
    assert "CONNECTIVITY - LINK" in str(found.problems[0])
    assert "line " in str(found.problems[0])
    found = read(tmp_path, portal(link, drawn), ignore=frozenset({"Connectivity - Link"}))
    assert found.problems == ()
    assert "passed over: CONNECTIVITY - LINK (1)" in found.told
    assert "passed over: GRID LINES (1)" in found.told
    asked = read(tmp_path, portal(), units=units_of("kN, m"))
    assert "states N, m, and kN, m are asked for" in str(asked.problems[0])


def test_a_frame_of_two_storeys_with_rigid_floors(tmp_path):
    """Two bays of 35 ft and of 25 ft, storeys of 13 ft, mass off the middle: published periods.

    0.2271, 0.2156, 0.0733 and 0.0720 s (Peterson 1981, EASE2 example manual), to their digits.
    """
    foot, n = 0.3048, 0
    x, y, z = (0.0, 35.0, 70.0), (0.0, 25.0, 50.0), (0.0, 13.0, 26.0)
    grid = [(i, j) for j in range(3) for i in range(3)]
    places = {
        1 + i + 3 * j + 9 * s: (x[i] * foot, y[j] * foot, z[s] * foot)
        for s in range(3)
        for i, j in grid
    }
    places |= {100 + s: (38.0 * foot, 27.0 * foot, z[s] * foot) for s in (1, 2)}
    ends, which = {}, {}

    def frame(start, end, name):
        nonlocal n
        n += 1
        ends[n], which[n] = (start, end), name

    for s in (1, 2):
        for i, j in grid:
            here = 1 + i + 3 * j + 9 * s
            frame(here - 9, here, "COL")
            for beyond, step in ((i, 1), (j, 3)):
                if beyond < 2:
                    frame(here, here + step, "BEAM")
    constraints = table(
        "CONSTRAINT DEFINITIONS - DIAPHRAGM",
        *(dict(Name=f"D{s}", CoordSys="GLOBAL", Axis="Z", MultiLevel="No") for s in (1, 2)),
    ) + table(
        "JOINT CONSTRAINT ASSIGNMENTS",
        *(
            dict(Joint=joint, Constraint=f"D{s}", Type="Diaphragm")
            for s in (1, 2)
            for joint in [*range(1 + 9 * s, 10 + 9 * s), 100 + s]
        ),
    )
    text = written(
        "KN, m, C", joints(places), held(range(1, 10)), held([101, 102], "001110"),
        material(16.757256e6, name="C"),
        material(23.938937e6, name="B"),
        table("FRAME SECTION PROPERTIES 01 - GENERAL",
              {**section("COL", 0.3716, 0.010789, 0.010789, j=1e-9), "Material": "C"},
              {**section("BEAM", 0.4645, 0.02253, 0.01381, j=1e-9), "Material": "B"}),
        frames(ends), sections_of(which), constraints,
        table("JOINT ADDED MASS ASSIGNMENTS",
              *(dict(Joint=j, CoordSys="Local", Mass1=90.64111, Mass2=90.64111) for j in (101, 102))),
    )  # fmt: skip
    found = read(tmp_path, text)
    assert found.problems == ()
    mass, stiffness = (matrix.toarray() for matrix in found.structure.matrices())
    squares = np.linalg.eigvals(np.linalg.solve(stiffness, mass)).real
    periods = 2.0 * np.pi * np.sqrt(np.sort(squares)[::-1][:4])
    np.testing.assert_allclose(periods, [0.2271, 0.2156, 0.0733, 0.0720], atol=5.1e-5)


def test_areas_that_do_not_share_their_nodes_are_told(tmp_path):
    """A panel of 2 x 1 beside two of 1 x 1: the corner between these lies on its side."""
    places = {1: (0, 0, 0), 2: (2, 0, 0), 3: (2, 1, 0), 4: (0, 1, 0), 5: (1, 1, 0), 6: (0, 2, 0),
              7: (1, 2, 0), 8: (2, 2, 0)}  # fmt: skip
    corners = {1: (1, 2, 3, 4), 2: (4, 5, 7, 6), 3: (5, 3, 8, 7)}
    text = written(
        "N, m, C", joints(places), held([1, 2, 6, 8]), material(3e10, 2500.0),
        table("AREA SECTION PROPERTIES",
              dict(Section="S", Material="MAT", AreaType="Shell", Type="Shell-Thick", Thickness=0.2)),
        table("CONNECTIVITY - AREA",
              *(dict(Area=a, NumJoints=4, **{f"Joint{i}": j for i, j in enumerate(c, 1)})
                for a, c in corners.items())),
        table("AREA SECTION ASSIGNMENTS", *(dict(Area=a, Section="S") for a in corners)),
    )  # fmt: skip
    found = read(tmp_path, text)
    assert found.problems == ()
    assert any("meet at 1 places without sharing nodes: (1, 1, 0)" in t for t in found.told)
    whole = text.replace(
        "Joint=5   CoordSys=GLOBAL   CoordType=Cartesian   XorR=1   Y=1",
        "Joint=5   CoordSys=GLOBAL   CoordType=Cartesian   XorR=1   Y=1.2",
    ).replace("GlobalX=1   GlobalY=1 ", "GlobalX=1   GlobalY=1.2 ")
    assert not any("without sharing" in t for t in read(tmp_path, whole).told)


def test_modifiers_of_areas_and_frames_count(tmp_path):
    """A quarter of the stiffness in bending is half the frequency; of the mass, twice it."""
    quarter = dict(Area=1, f11=1, f22=1, f12=1, m11=0.25, m22=0.25, m12=0.25, v13=1, v23=1,
                   MassMod=1, WeightMod=1)  # fmt: skip
    first = read(tmp_path, slab()).structure.modes(30.0).frequencies[0]
    softer = read(tmp_path, slab(table("AREA STIFFNESS MODIFIERS", quarter))).structure
    assert softer.modes(30.0).frequencies[0] == pytest.approx(0.5 * first, rel=1e-3)
    whole = bending(8.0, 4.730041)
    by = dict(
        Frame=2, AMod=1, AS2Mod=1, AS3Mod=1, JMod=1, I22Mod=1, I33Mod=0.25, MassMod=1, WeightMod=1
    )
    text = portal(table("FRAME PROPERTY MODIFIERS", by))
    assert first_of(tmp_path, text) == pytest.approx(0.5 * whole, rel=4e-3)
    heavy = portal(table("FRAME PROPERTY MODIFIERS", {**by, "I33Mod": 1, "MassMod": 4}))
    assert first_of(tmp_path, heavy) == pytest.approx(0.5 * whole, rel=4e-3)


POINT = dict(Frame=2, CardinalPt="8 (top center)", Mirror2="No", Mirror3="No", CoordSys="Local")


@pytest.mark.parametrize(
    ("row", "offset"),
    [
        ({**POINT, "Transform": "Yes"}, -0.2),
        ({**POINT, "Transform": "No"}, 0.0),
        ({**POINT, "Mirror3": "Yes", "Transform": "Yes"}, 0.2),
        ({**POINT, "JtOffsetYI": 0.05, "JtOffsetYJ": 0.05, "Transform": "Yes"}, -0.15),
    ],
)
def test_insertion_points_by_the_keys_of_later_versions(tmp_path, row, offset):
    text = portal(table("FRAME INSERTION POINT ASSIGNMENTS", row))
    beam = next(b for b in read(tmp_path, text).structure.beams if b.name == "BEAM")
    np.testing.assert_allclose(beam.offset, [0.0, 0.0, offset], atol=1e-12)


def test_what_holds_nothing_and_what_is_not_used_does_no_harm(tmp_path):
    """Load transfer, definitions alone, a section that nothing uses, edges that are not tied."""
    own = first_of(tmp_path, portal())
    more = (
        table("FRAME LOAD TRANSFER OPTIONS", dict(Frame=1, Transfer="Yes")),
        table("LINK PROPERTY DEFINITIONS 01 - GENERAL", dict(Link="LIN1", LinkType="Linear")),
        table("FRAME SECTION PROPERTIES 01 - GENERAL", section("TAPER", 1.0, 1.0, 1.0)).replace(
            "Rectangular", "Nonprismatic"
        ),
    )
    assert first_of(tmp_path, portal(*more)) == pytest.approx(own, rel=1e-12)
    untied = table("AREA EDGE CONSTRAINT ASSIGNMENTS", dict(Area=1, Constrained="No"))
    assert read(tmp_path, slab(untied)).problems == ()
    assert read(tmp_path, slab(untied.replace("=No", "=Yes"))).structure is None


LOADED = table(
    "MASS SOURCE",
    dict(
        MassSource="M",
        Elements="Yes",
        Masses="Yes",
        Loads="Yes",
        IsDefault="Yes",
        LoadPat="L",
        Multiplier=1,
    ),
)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (portal().replace("AnalSect=BEAM   MatProp=Default", "AnalSect=BEAM   MatProp=C60"), "MatProp"),
        (portal().replace("TorsConst=1.0", "TorsConst=1.0   I23=0.1", 1), "I23 is not 0"),
        (slab().replace("Number1=16", "SuppEdge=Yes   Number1=16"), "SuppEdge is not read"),
        (slab().replace("Number1=16   ", ""), "Number1 is missing"),
        (slab().replace("Type=Shell-Thin", "Type=Plate-Thin"), "Plate-Thin, is not read"),
        (slab(table("AREA OVERWRITES - JOINT OFFSETS", dict(Area=1, Offset1=5))), "OVERWRITES"),
        (portal(table("FRAME P-DELTA FORCE ASSIGNMENTS", dict(Frame=1, P=1))), "P-DELTA"),
        (portal(table("FRAME ADDED MASS ASSIGNMENTS", dict(Frame=99, MassPerLen=1))), "names frame '99'"),
        (portal(releases=dict(Frame=2, M9I="Yes")), "m9i is not known"),
        (portal().replace("R3=Yes", "RR3=Yes"), "rr3 is not known"),
        (portal(frames({2: (1, 4)})), "frame '2' is there twice"),
        (portal().replace("E1=2", "E1=3   E1=2"), "E1 is there twice"),
        (portal(table("FRAME OFFSET (LENGTH) ASSIGNMENTS",
                      dict(Frame=2, Type="Auto From Connectivity", RigidFactor=1))), "without their lengths"),
        (portal(table("FRAME OFFSET (LENGTH) ASSIGNMENTS",
                      dict(Frame=2, Type="User", LengthI=1, LengthJ=1))), "RigidFact is missing"),
        (portal(table("MASSES 1 - MASS SOURCE", dict(MassFrom="All"))), "'all' is not known"),
        (portal(LOADED, table("FRAME LOADS - DISTRIBUTED", dict(
            Frame=2, LoadPat="L", CoordSys="Local", Dir=2, FOverLA=-4, FOverLB=-4))), "not read as mass"),
        (portal().replace("I33=0.0002", "I33=1e300"), "out of all bounds"),
    ],
)  # fmt: skip
def test_what_would_change_the_structure_is_not_passed_over(tmp_path, text, words):
    found = read(tmp_path, text)
    assert found.structure is None
    assert words in str(found.problems[0])
