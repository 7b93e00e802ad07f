"""Cards of Nastran bulk data one by one, each against a closed form, and decks of other programs."""

from pathlib import Path

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from trundle.dynamics import natural_modes
from trundle.imports import read_model

E, A, I1, I2, L = 2.1e11, 0.01, 2e-5, 8e-6, 3.0
G = E / 2.6
BAR = """BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,3.,0.,0.
MAT1,1,2.1+11,,.3,7850.
PBAR,1,1,.01,2.-5,8.-6,1.-5
CBAR,1,1,1,2,0.,0.,1.
"""
MODELS = Path(__file__).parents[3] / "shared" / "data" / "models"


def model(tmp_path, text):
    path = tmp_path / "deck.bdf"
    path.write_text(text)
    found = read_model(path)
    assert found.structure is not None, [str(problem) for problem in found.problems]
    return found.structure


def moved(floor, node, dof, force=1e3):
    """Motion of a node, by its place in the deck, in the direction of a force on it."""
    load = np.zeros((len(floor.nodes), 6))
    load[node, dof] = force
    if floor.expansion is None:
        free = floor.dof_index >= 0
        by_free = np.zeros(floor.n_dofs)
        by_free[floor.dof_index[free]] = load[free]
        u = np.zeros(load.shape)
        u[free] = spsolve(floor.stiffness, by_free)[floor.dof_index[free]]
    else:
        u = floor.expansion @ spsolve(floor.stiffness, load.ravel() @ floor.expansion)
    return u.reshape(-1, 6)[node, dof] / force


def test_places_in_cylinders_spheres_and_systems_of_grids(tmp_path):
    """Radius 2 at 30 degrees; radius 2, 60 degrees from the axis; both under a turned system."""
    text = BAR + (
        "CORD2C,2,,1.,0.,0.,1.,0.,1.,+\n+,2.,0.,0.\n"
        "CORD2S,3,,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\n"
        "CORD1R,4,11,12,13\n"
        "GRID,3,2,2.,30.,.5\nGRID,4,3,2.,60.,90.\n"
        "GRID,11,,0.,0.,5.\nGRID,12,,1.,0.,5.\nGRID,13,,0.,1.,5.\nGRID,5,4,1.,2.,3.\n"
    )
    nodes = model(tmp_path, text).nodes
    np.testing.assert_allclose(nodes[2], [1 + 3**0.5, 1.0, 0.5], atol=1e-12)
    np.testing.assert_allclose(nodes[3], [0.0, 3**0.5, 1.0], atol=1e-12)
    # z of the system along x, its x along y, its y along z
    np.testing.assert_allclose(nodes[7], [3.0, 1.0, 7.0], atol=1e-12)


def test_what_grids_leave_open_grdset_says(tmp_path):
    """Grid 2 is held against everything but its sinking, and stands in system 9."""
    text = BAR.replace("GRID,2,,", "GRID,2,9,").replace("GRID,1,,", "GRID,1,0,") + (
        "CORD2R,9,,0.,0.,0.,0.,0.,1.,+\n+,0.,1.,0.\nGRDSET,,8,,,,,12456\n"
        "CORD2R,8,,0.,0.,7.,0.,0.,8.,+\n+,1.,0.,7.\nGRID,3,0,9.,0.,0.\nGRID,4,,1.,1.,1.\n"
    )
    floor = model(tmp_path, text)
    np.testing.assert_allclose(
        floor.nodes[[1, 2, 3]], [[0, 3, 0], [9, 0, 0], [1, 1, 8]], atol=1e-12
    )
    assert floor.fixed[1].tolist() == [True, True, False, True, True, True]
    assert moved(floor, 1, 2) == pytest.approx(L**3 / (12.0 * E * I1), rel=1e-9)


def test_a_grid_that_follows_by_rbe2(tmp_path):
    """Half a metre beyond the tip: P (L^3/3 + L^2 a + L a^2) / E I, through a chain of three."""
    text = BAR + (
        "GRID,3,,3.25,0.,0.\nGRID,4,,3.4,0.,0.\nGRID,5,,3.5,0.,0.\n"
        "RBE2,7,2,123456,3\nRBE2,8,3,123456,4\nRBE2,9,4,123456,5\n"
    )
    found = moved(model(tmp_path, text), 4, 2)
    a = 0.5
    assert found == pytest.approx((L**3 / 3 + L**2 * a + L * a**2) / (E * I1), rel=1e-9)


@pytest.mark.parametrize(
    "cards",
    [
        "CELAS2,5,2.+6,2,3\n",
        "CELAS1,5,3,2,3\nPELAS,3,2.+6\n",
        "CELAS1,5,3,2,3\nPELAS,9,1.,,,3,2.+6\n",
        "CBUSH,5,3,2,,,,,0\nPBUSH,3,K,,,2.+6\n",
        "CBUSH,5,3,2,3,,,,0\nGRID,3,,3.,0.,0.,,123456\nPBUSH,3,K,1.,,2.+6,,,,+\n+,,B,7.\n",
    ],
)
def test_a_spring_under_a_tip(tmp_path, cards):
    """``1 / (3 E I / L^3 + k)``, however the spring is written."""
    found = moved(model(tmp_path, BAR + cards), 1, 2)
    assert found == pytest.approx(1.0 / (3.0 * E * I1 / L**3 + 2e6), rel=1e-9)


def refused(tmp_path, text):
    (tmp_path / "deck.bdf").write_text(text)
    found = read_model(tmp_path / "deck.bdf")
    assert found.structure is None
    return "\n".join(map(str, found.problems))


# x of system 7 runs along y; that of system 8 lies 30 degrees beside x; 9 is a cylinder's
SYSTEMS = (
    "CORD2R,7,,0.,0.,0.,0.,0.,1.,+\n+,0.,1.,0.\nCORD2R,8,,0.,0.,0.,0.,0.,1.,+\n+,.8660254,.5,0.\n"
    "CORD2C,9,,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\n"
)


def post(system, *, vector="1.,0.,0.", more=""):
    """A bar that stands, whose foot moves in a system, and its head in system 7."""
    return BAR.replace("GRID,1,,0.,0.,0.,,", f"GRID,1,,0.,0.,0.,{system},").replace(
        "GRID,2,,3.,0.,0.", "GRID,2,,0.,0.,3.,7"
    ).replace("0.,0.,1.\n", f"{vector}{more}\n") + SYSTEMS  # fmt: skip


@pytest.mark.parametrize(
    ("system", "vector", "more", "way"),
    [
        (0, "1.,0.,0.", "", (1.0, 0.0)),
        (7, "1.,0.,0.", "", (0.0, 1.0)),
        (7, "0.,1.,0.", "", (-1.0, 0.0)),
        (8, "1.,0.,0.", "", (0.75**0.5, 0.5)),
        (8, "1.,0.,0.", ",BGG", (1.0, 0.0)),
    ],
)
def test_the_vector_of_a_bar_is_along_the_axes_of_its_first_grid(
    tmp_path, system, vector, more, way
):
    """Plane 1 holds it: P L^3 / 3 E I1 that way, I2 across; BGG says that it is in the basic one.

    By the manual (CBAR, remark 2) X1 to X3 are components in the displacement system of GA.
    """
    floor = model(tmp_path, post(system, vector=vector, more=more))
    u = np.zeros((2, 2))
    for dof in (0, 1):
        load = np.zeros(floor.n_dofs)
        load[floor.dof_index[1, dof]] = 1.0
        u[:, dof] = spsolve(floor.stiffness, load)[floor.dof_index[1, :2]]
    along = np.array(way)
    across = np.array([-along[1], along[0]])
    assert along @ u @ along == pytest.approx(L**3 / (3.0 * E * I1), rel=1e-6)
    assert across @ u @ across == pytest.approx(L**3 / (3.0 * E * I2), rel=1e-6)


def test_offsets_of_a_bar_are_along_the_axes_of_its_grids(tmp_path):
    """A fifth of a metre along basic y: x of system 7 at the head, y of the basic one at the foot."""
    text = post(0, more=",,+\n+,,,0.,.2,0.,.2,0.,0.")
    (bar,) = model(tmp_path, text).beams
    np.testing.assert_allclose(bar.offset, [0.0, 0.2, 0.0], atol=1e-12)
    apart = post(0, more=",,+\n+,,,0.,.2,0.,0.,.2,0.")
    assert "offsets that differ at both ends" in refused(tmp_path, apart)
    assert "system 9 turn from place to place" in refused(tmp_path, post(9))


def test_masses_of_one_dof_are_along_the_axes_of_their_grid(tmp_path):
    """50 and 20 kg along x and y of system 7 move along basic y and x; 30 degrees leave products."""
    bare = model(tmp_path, post(0))
    cards = "CMASS2,5,50.,2,1\nCMASS2,6,20.,2,2\nCMASS2,7,3.,2,4\n"
    floor = model(tmp_path, post(0) + cards)
    rows = floor.dof_index[1]
    added = (floor.mass - bare.mass).diagonal()[rows]
    np.testing.assert_allclose(added, [20.0, 50.0, 0.0, 0.0, 3.0, 0.0], atol=1e-9)
    aslant = post(0).replace("0.,0.,3.,7", "0.,0.,3.,8")
    assert "(CD), which lie aslant" in refused(tmp_path, aslant + cards)
    alike = "CMASS2,5,50.,2,1\nCMASS2,6,50.,2,2\nCMASS2,7,50.,2,3\n"  # the same along any axes
    floor = model(tmp_path, aslant + alike)
    np.testing.assert_allclose((floor.mass - bare.mass).diagonal()[rows][:3], 50.0, rtol=1e-9)


@pytest.mark.parametrize(
    ("system", "dofs", "tied"),
    [(7, "2", "100000"), (7, "156", "010101"), (8, "126", "110001"), (8, "3", "001000")],
)
def test_dofs_that_follow_are_along_the_axes_of_their_grid(tmp_path, system, dofs, tied):
    """y of system 7 is -x; both level ones are level whatever the angle, and so is z."""
    text = post(0) + f"GRID,3,,1.,0.,3.,{system}\nCBAR,2,1,2,3,0.,0.,1.\nRBE2,9,2,{dofs},3\n"
    (link,) = model(tmp_path, text).links
    assert "".join(str(int(one)) for one in link.dofs) == tied
    if system == 8:
        aslant = refused(tmp_path, text.replace(f"RBE2,9,2,{dofs}", "RBE2,9,2,1"))
        assert "dofs 1 of grid 3, whose displacements have a system (CD 8), lie aslant" in aslant


def test_springs_are_along_the_axes_of_their_grid(tmp_path):
    """x of system 7 is basic y, z is z; aslant they are refused, and a bush lies along the basic."""
    bare = model(tmp_path, post(0)).stiffness
    cards = "CELAS2,5,2.+6,2,1\nCELAS2,6,3.+6,2,3\nCBUSH,7,3,2,,,,,0\nPBUSH,3,K,4.+6\n"
    floor = model(tmp_path, post(0) + cards)
    added = (floor.stiffness - bare).diagonal()[floor.dof_index[1]]
    np.testing.assert_allclose(added, [4e6, 2e6, 3e6, 0, 0, 0], atol=1e-3)
    aslant = post(0).replace("0.,0.,3.,7", "0.,0.,3.,8") + cards
    assert "dofs 1 of grid 2, whose displacements" in refused(tmp_path, aslant)
    two = post(0) + "GRID,3,,1.,0.,3.\nCBAR,2,1,2,3,0.,0.,1.\nCELAS2,5,2.+6,2,1,3,1\n"
    assert "whose displacements have two systems (CD)" in refused(tmp_path, two)


@pytest.mark.parametrize(
    ("pins", "plane_1", "plane_2"),
    [("", 192, 192), ("6", 48, 192), ("5", 192, 48), ("56", 48, 48)],
)
def test_pins_let_go_of_the_plane_that_they_name(tmp_path, pins, plane_1, plane_2):
    """Two bars between walls, pinned at both: P L^3 / 48 E I in that plane, 192 in the other."""
    text = BAR.replace("CBAR,1,1,1,2,0.,0.,1.", f"CBAR,1,1,1,2,0.,0.,1.,,+\n+,{pins}") + (
        f"GRID,3,,6.,0.,0.,,123456\nCBAR,2,1,2,3,0.,0.,1.,,+\n+,,{pins}\n"
    )
    floor = model(tmp_path, text)
    span = 2.0 * L
    assert moved(floor, 1, 2) == pytest.approx(span**3 / (plane_1 * E * I1), rel=1e-9)
    assert moved(floor, 1, 1) == pytest.approx(span**3 / (plane_2 * E * I2), rel=1e-9)


@pytest.mark.parametrize(
    "rods",
    [
        "PROD,2,1,.002\nCROD,2,2,3,5\nCROD,3,2,4,5\n",
        "CONROD,2,3,5,1,.002\nCONROD,3,4,5,1,.002\n",
    ],
)
def test_two_rods_carry_along_themselves_alone(tmp_path, rods):
    """Under 45 degrees, 2^0.5 m long: P L / (2 E A sin^2), and half of each lumped on the tip."""
    text = BAR + (
        "GRID,3,,-1.,9.,1.,,123456\nGRID,4,,1.,9.,1.,,123456\nGRID,5,,0.,9.,0.,,2456\n" + rods
    )
    floor = model(tmp_path, text)
    length = 2.0**0.5
    assert moved(floor, 4, 2) == pytest.approx(length / (2.0 * E * 0.002 * 0.5), rel=1e-9)
    tip = floor.dof_index[4, 2]
    assert floor.mass[tip, tip] == pytest.approx(7850.0 * 0.002 * length, rel=1e-9)


@pytest.mark.parametrize(
    ("more", "k"),
    [
        ("", 1.0),
        (",,+\n+\n+,.8,.5", 0.8),
        (",,+\n+,.1,.2,.3,.4,.5,.6,.7,.8,+\n+,YES,1.,.01,2.-5,8.-6,,1.-5,,+\n+\n+,.8,.5", 0.8),
        (",,+\n+,NO,1.,,,,,,,+\n+,0.,0.", 0.0),
    ],
)
def test_a_beam_shears(tmp_path, more, k):
    """P L^3 / 3 E I + P L / K1 G A in plane 1; none where K is 0 (PBEAM: 1 unless given)."""
    text = BAR.replace("PBAR,1,1,.01,2.-5,8.-6,1.-5", f"PBEAM,1,1,.01,2.-5,8.-6,,1.-5{more}")
    floor = model(tmp_path, text.replace("CBAR", "CBEAM"))
    shear = L / (k * G * A) if k else 0.0
    assert moved(floor, 1, 2) == pytest.approx(L**3 / (3.0 * E * I1) + shear, rel=1e-9)


@pytest.mark.parametrize(
    ("shape", "area", "inertia"),
    [
        ("BAR,,,,,+\n+,.2,.4", 0.08, 0.2 * 0.4**3 / 12),
        ("ROD,,,,,+\n+,.1", np.pi * 0.01, np.pi * 1e-4 / 4),
        ("TUBE,,,,,+\n+,.1,.08", np.pi * 0.0036, np.pi * (1e-4 - 0.08**4) / 4),
        ("BOX,,,,,+\n+,.2,.4,.02,.01", 0.08 - 0.18 * 0.36, (0.2 * 0.4**3 - 0.18 * 0.36**3) / 12),
        ("I,,,,,+\n+,.4,.2,.2,.01,.02,.02", 0.0116, (0.2 * 0.4**3 - 0.19 * 0.36**3) / 12),
    ],
)
@pytest.mark.parametrize("card", ["PBARL", "PBEAML"])
def test_shapes_by_their_dimensions(tmp_path, card, shape, area, inertia):
    """Area by stretching; bending in plane 1, whose axis is the orientation, less what shear adds."""
    text = BAR.replace("PBAR,1,1,.01,2.-5,8.-6,1.-5", f"{card},1,1,,{shape}")
    floor = model(tmp_path, text)
    section = floor.beams[0].section
    assert moved(floor, 1, 0) == pytest.approx(L / (E * area), rel=1e-9)
    sinks = moved(floor, 1, 2) - L / (G * section.shear_area_z)
    assert sinks == pytest.approx(L**3 / (3.0 * E * inertia), rel=1e-9)


# --- decks of other programs, with the answers that were published beside them


def frequencies(name, f_max, shift=0.0):
    """Natural frequencies; of a free model the shifted ones, less the shift."""
    if not (MODELS / name).exists():
        pytest.skip("the collection of models is not beside this repository")
    floor = read_model(MODELS / name).structure
    stiffness = floor.stiffness + (2.0 * np.pi * shift) ** 2 * floor.mass
    found = natural_modes(floor.mass, stiffness, f_max=f_max).frequencies
    return np.sqrt(np.maximum(found**2 - shift**2, 0.0))


def test_bars_of_msc_nastran():
    """Lumped masses and no shear: the ten frequencies that MSC Nastran printed, to 1e-6."""
    wanted = [46.46440, 146.9333, 279.0229, 752.9903, 815.3514, 882.3479, 1405.450, 2059.242,
              2366.242, 2381.164]  # fmt: skip
    np.testing.assert_allclose(frequencies("nastran_cofe/bar.bdf", 2500.0), wanted, rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "wanted", "f_max", "shift"),
    [
        ("plate_py.dat", [6333.012, 7495.461, 16238.458, 17161.513], 18000.0, 100.0),
        # the values beside the deck are rad/s
        (
            "extse04c.bdf", np.array([1134.435, 1641.731, 2092.225, 2887.572]) / (2 * np.pi),
            464.5, 20.0,
        ),
    ],
)  # fmt: skip
def test_free_plates_of_nx_nastran(name, wanted, f_max, shift):
    """Six rigid motions, then the frequencies that NX Nastran printed, on its mesh: 1 %."""
    found = frequencies(f"nastran_pynastran/{name}", f_max, shift)
    assert (found[:6] < 1e-5 * found[6]).all()
    np.testing.assert_allclose(found[6 : 6 + len(wanted)], wanted, rtol=0.01)


@pytest.mark.parametrize(
    ("kind", "wanted"), [("8_clamped", 0.001505), ("8tri_clamped", 0.00126532)]
)
def test_clamped_plates_under_pressure(kind, wanted):
    """``w D / q a^4`` in the middle: 1 %.

    A tenth as thick as wide, and its PSHELL lets it shear: 0.001505 of Mindlin's plate (C. Lovadina,
    SIAM J. Numer. Anal. 33 (1996)). Our triangles do not: 0.00126532 of Kirchhoff's (Timoshenko and
    Woinowsky-Krieger, table 35).
    """
    path = MODELS / f"nastran_cofe/square_plate_{kind}-000.dat"
    if not path.exists():
        pytest.skip("the collection of models is not beside this repository")
    floor = read_model(path).structure
    group = (*floor.shells, *floor.others)[0]
    corners = floor.nodes[group.connectivity]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    if corners.shape[1] == 3:
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    load = np.zeros(floor.n_dofs)
    share = 0.5 * np.linalg.norm(across, axis=1) / corners.shape[1]
    rows = floor.dof_index[group.connectivity, 2]
    np.add.at(load, rows[rows >= 0], np.broadcast_to(share[:, None], rows.shape)[rows >= 0])
    sinks = spsolve(floor.stiffness, load)[rows[rows >= 0]].max()
    side, rigidity = float(np.ptp(floor.nodes[:, 0])), 1e7 * 0.2**3 / 12.0 / (1.0 - 0.3**2)
    assert sinks == pytest.approx(wanted * side**4 / rigidity, rel=0.01)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("nastran_cofe/bar_modes.dat", "svanberg.bdf"),
        ("nastran_pynastran/plate_mixed.bdf", "PCOMP 2 couples"),
        ("nastran_pynastran/mode_solid_shell_bar.bdf", "geom.inc"),
    ],
)
def test_what_is_missing_or_not_read_is_named(name, said):
    if not (MODELS / name).exists():
        pytest.skip("the collection of models is not beside this repository")
    try:
        text = " ".join(str(problem) for problem in read_model(MODELS / name).problems)
    except ValueError as error:
        text = str(error)
    assert said in text


def test_a_plate_without_mid3_does_not_shear(tmp_path):
    """A strip as thick as it is long to a fifth: P L^3 / 3 E I alone, and P L / (5/6 G A) with it."""
    nodes = "".join(
        f"GRID,{10 * i + j + 1},,{0.125 * i},{0.5 * j},0.,,{'123456' if i == 0 else ''}\n"
        for i in range(9) for j in range(2)
    )  # fmt: skip
    faces = "".join(
        f"CQUAD4,{i + 1},1,{10 * i + 1},{10 * i + 11},{10 * i + 12},{10 * i + 2}\n"
        for i in range(8)
    )
    found = []
    for shear in ("", "1"):
        text = f"BEGIN BULK\nMAT1,1,1.+9,,0.,0.\nPSHELL,1,1,.2,1,,{shear}\n" + nodes + faces
        floor = model(tmp_path, text)
        load = np.zeros(floor.n_dofs)
        load[floor.dof_index[-2:, 2]] = 0.5
        found.append(spsolve(floor.stiffness, load)[floor.dof_index[-1, 2]])
    bends, shears = 1.0 / (3.0 * 1e9 * 0.5 * 0.2**3 / 12.0), 1.0 / (5.0 / 6.0 * 0.5e9 * 0.1)
    assert found[0] == pytest.approx(bends, rel=5e-3)
    assert found[1] - found[0] == pytest.approx(shears, rel=1e-3)


def strip(tmp_path, *cards, n=12):
    """Return the tip's deflection of a strip 6 x 1 m under 1 N, held at one end; its plate's cards."""
    nodes = "".join(
        f"GRID,{10 * i + j + 1},,{6.0 * i / n},{1.0 * j},0.,,{'123456' if i == 0 else ''}\n"
        for i in range(n + 1) for j in range(2)
    )  # fmt: skip
    way = next((c.partition(":")[2] for c in cards if c.startswith("WAY:")), "")
    faces = "".join(
        f"CQUAD4,{i + 1},1,{10 * i + 1},{10 * i + 11},{10 * i + 12},{10 * i + 2},{way}\n"
        for i in range(n)
    )
    text = "BEGIN BULK\n" + "\n".join(c for c in cards if not c.startswith("WAY:")) + "\n"
    floor = model(tmp_path, text + nodes + faces)
    load = np.zeros(floor.n_dofs)
    load[floor.dof_index[-2:, 2]] = 0.5
    return spsolve(floor.stiffness, load)[floor.dof_index[-1, 2]], floor


MAT8 = "MAT8,1,2.+10,5.+9,0.,3.+9,,,1600."


@pytest.mark.parametrize(("way", "e"), [("", 2e10), ("90.", 5e9), ("4", 5e9), ("0", 2e10)])
def test_an_orthotropic_plate_bends_along_its_axes(tmp_path, way, e):
    """P L3 / 3 E I with the modulus along the strip: by an angle, or by a system's x axis."""
    system = "CORD2R,4,0,0.,0.,0.,0.,0.,1.,+\n+,0.,1.,0."
    tip, floor = strip(tmp_path, MAT8, "PSHELL,1,1,.1,1,,", system, f"WAY:{way}")
    assert tip == pytest.approx(6.0**3 / (3.0 * e * 0.1**3 / 12.0), rel=5e-3)
    assert floor.moving_mass() == pytest.approx(1600.0 * 0.1 * 6.0 * (1.0 - 0.5 / 12.0))


def test_a_laminate_is_the_plate_that_is_as_stiff(tmp_path):
    """Plies 0/90/0 of a third each: E I by layers; equal isotropic plies are a solid plate."""
    third = 0.1 / 3.0
    plies = f"PCOMP,1,,,,,,,,+\n+,1,{third!r:.12},0.,YES,1,{third!r:.12},90.,YES,+\n+,1,{third!r:.12},0."
    tip, floor = strip(tmp_path, MAT8, plies)
    inner = third**3 / 12.0
    rigidity = 2e10 * (0.1**3 / 12.0 - inner) + 5e9 * inner
    assert tip == pytest.approx(6.0**3 / (3.0 * rigidity), rel=5e-3)
    assert floor.shells[0].section.thickness == pytest.approx(0.1)
    isotropic = "MAT1,1,2.+10,,.2,2000."
    both = [
        strip(tmp_path, isotropic, plate)[1].matrices()
        for plate in (plies, "PCOMP,1,,,,,,,SYM,+\n+,1,.05,0.,YES", "PSHELL,1,1,.1,1,,1")
    ]
    for laminate in both[:2]:
        for ours, theirs in zip(laminate, both[2], strict=True):
            assert abs(ours - theirs).max() < 1e-8 * abs(theirs).max()


@pytest.mark.parametrize(
    ("cards", "said"),
    [
        ((MAT8, "PCOMP,1,,,,,,,,+\n+,1,.05,0.,YES,1,.05,90.,YES"), "couples stretching, bending"),
        ((MAT8, "PCOMP,1,,,,,,,,+\n+,1,.1,30.,YES"), "couples stretching, bending"),
        ((MAT8, "PCOMP,1,-.05,,,,,,,+\n+,7,.1,0.,YES"), "names material 7"),
        (("MAT8,1,2.+10,5.+9,3.,3.+9", "PSHELL,1,1,.1,1"), "leave no energy"),
        (
            ("MAT2,1,2.+10,1.+9,1.+8,2.+10,0.,8.+9", "PSHELL,1,1,.1,1"),
            "couple stretching and shear",
        ),
    ],
)
def test_plates_without_an_equivalent_are_refused(tmp_path, cards, said):
    path = tmp_path / "plate.bdf"
    nodes = "".join(
        f"GRID,{i + 1},,{x}.,{y}.,0.\n" for i, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)])
    )
    path.write_text("BEGIN BULK\n" + "\n".join(cards) + "\n" + nodes + "CQUAD4,1,1,1,2,3,4\n")
    assert said in " ".join(str(one) for one in read_model(path).problems)
