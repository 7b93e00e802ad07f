"""Structures known by their matrices or modes: the same motion as of the model they came from."""

import numpy as np
import pytest
from scipy.io import mmwrite

from mode_tables import SI, files, mode_tables, of_units, write_elements, write_nodes
from models import small_floor
from trundle.errors import InputError
from trundle.imports import SurfaceChoice, units_of
from trundle.imports.matrices import read_matrices
from trundle.imports.modes import ModeFiles, read_modes
from trundle.imports.number_tables import read_table

KN_MM = units_of("kN, mm")  # mass in 1e6 kg


@pytest.mark.parametrize("units", [SI, KN_MM], ids=["N, m", "kN, mm"])
def test_matrices_give_the_model_back(tmp_path, units):
    """Matrices, frequencies and a place's motion are those of the floor that wrote them."""
    from scipy import sparse

    floor = small_floor(mesh_size=2.0)
    mass, stiffness = of_units(floor, units)
    mmwrite(tmp_path / "k.mtx", sparse.coo_array(stiffness), symmetry="symmetric", precision=17)
    mmwrite(tmp_path / "m.mtx", sparse.coo_array(mass), symmetry="general", precision=17)
    write_nodes(tmp_path / "nodes.csv", floor, rows=True, length=units.length)
    write_elements(tmp_path / "elements.csv", floor)
    read = read_matrices(
        stiffness=tmp_path / "k.mtx",
        mass=tmp_path / "m.mtx",
        nodes=tmp_path / "nodes.csv",
        elements=tmp_path / "elements.csv",
        units=units,
    )
    assert read.problems == ()
    model = read.structure
    assert model.moving_mass() == pytest.approx(floor.moving_mass(), rel=1e-9)
    for ours, theirs in zip(model.matrices(), floor.matrices(), strict=True):
        assert abs(ours - theirs).max() < 1e-9 * abs(theirs).max()
    assert model.modes(60.0).frequencies == pytest.approx(floor.modes(60.0).frequencies, rel=1e-9)
    assert model.surface().extent[1] == pytest.approx(floor.surface().extent[1])


@pytest.mark.parametrize("units", [SI, KN_MM], ids=["N, m", "kN, mm"])
def test_modes_give_the_motion_of_their_model(tmp_path, units):
    """Frequencies and what the wheels see of every shape, whatever the shapes' scale."""
    from trundle.structure import Hermite

    floor = small_floor(mesh_size=1.5)
    modes = mode_tables(tmp_path, floor, 60.0, scale=7.0, units=units)
    read = read_modes(files(tmp_path), units=units, reach=60.0)
    assert read.problems == ()
    model = read.structure
    given = model.modes(60.0)
    assert given.frequencies == pytest.approx(modes.frequencies, rel=1e-12)
    place = np.array([[3.4, 2.1], [5.0, 4.9]])
    seen = []
    for one, found in ((floor, modes), (model, given)):
        part, _, numbers, local = next(one.surface().find(place))
        weights = part.group.weights(local, part.corners[numbers], Hermite()).value
        motion = one.surface().frame.motion
        for_nodes = np.einsum("nkd,de->nke", weights.reshape(len(place), 4, 3), motion)
        nodes = part.elements[numbers]
        rows = one.dof_index[nodes]
        shapes = np.where(rows[..., None] >= 0, found.shapes[rows], 0.0)
        seen.append(np.einsum("nke,nkem->nm", for_nodes, shapes))
    np.testing.assert_allclose(seen[1], seen[0], atol=1e-9 * np.abs(seen[0]).max())


def test_modes_without_a_scale_are_refused(tmp_path):
    floor = small_floor(mesh_size=3.0)
    mode_tables(tmp_path, floor, 40.0, mass=False)
    read = read_modes(files(tmp_path), units=SI)
    assert "nothing tells the scale of the shapes" in str(read.problems[0])
    read = read_modes(files(tmp_path), units=SI, unit_mass=True)
    last = floor.modes(40.0).frequencies[-1]
    assert read.structure.reach == pytest.approx(last, rel=1e-6)
    assert read.structure.modes(read.structure.reach).frequencies[-1] == pytest.approx(last)


def test_a_test_of_a_few_points_is_enough_for_them(tmp_path):
    """Vertical shapes at points of a line, without elements: lines between them, and no more."""
    (tmp_path / "n.csv").write_text("node;x;y;z\nA;0;0;1\nB;2,5;0;1\nC;5;0;1\n")
    (tmp_path / "s.csv").write_text("node\tmode 1\tmode 2\nA\t0.1\t0.2\nB\t1\t0.1\nC\t0.1\t-0.2\n")
    (tmp_path / "f.csv").write_text("mode f\n1 6.5\n2 11.2\n")
    read = read_modes(files(tmp_path, elements=False), units=SI, unit_mass=True)
    assert read.problems == ()
    surface = read.structure.surface()
    assert surface.holds(np.array([[1.0, 0.0], [2.5, 0.5]])).tolist() == [True, False]
    assert "lines with sides up to 2.5 m, straight from node to node" in " ".join(read.told)
    with pytest.raises(InputError, match=r"known to 11\.2 Hz; f_max may be no higher"):
        read.structure.modes(20.0)


def test_levels_between_nodes_are_joined_and_openings_left(tmp_path):
    """A grid of 1 m with an opening of 3 m: what is joined is the slab without it."""
    x, y = (g.ravel() for g in np.meshgrid(np.arange(9.0), np.arange(7.0)))
    inside = (x > 2) & (x < 6) & (y > 2) & (y < 5)
    x, y = x[~inside], y[~inside]
    rows = [f"{i},{a},{b},3.2,{a}" for i, (a, b) in enumerate(zip(x, y, strict=True))]
    (tmp_path / "s.csv").write_text("\n".join(["node,x,y,z,mode 1", *rows]) + "\n")
    (tmp_path / "f.csv").write_text("mode,frequency\n1,5\n")
    named = ModeFiles(frequencies=tmp_path / "f.csv", shapes=tmp_path / "s.csv")
    choice = (SurfaceChoice(name="lab", height=3.2),)
    read = read_modes(named, units=SI, unit_mass=True, surfaces=choice)
    surface = read.structure.surface("lab")
    held = surface.holds(np.array([[1.5, 3.5], [7.5, 6.0], [4.0, 3.5], [4.0, 4.2]]))
    assert held.tolist() == [True, True, False, False]


GOOD = {
    "n.csv": "node,x,y,z\n1,0,0,0\n2,4,0,0\n3,0,4,0\n4,4,4,0\n",
    "s.csv": "node,mode,uz\n1,1,0.1\n2,1,0.2\n3,1,0.3\n4,1,0.4\n",
    "f.csv": "mode,frequency,modal_mass\n1,5.5,1200\n",
}


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("n.csv", "2,4,0,0", "2,4,0", "n.csv, line 3: z is empty"),
        ("n.csv", "2,4,0,0", "2,4,0,0,7", "n.csv, line 3: has 5 columns, and the heading 4"),
        ("n.csv", "2,4,0,0", "2,four,0,0", "line 3: x must be a number; got 'four'"),
        ("n.csv", "2,4,0,0", "2,inf,0,0", "line 3: x must be a number; got 'inf'"),
        ("n.csv", "2,4,0,0", "1,4,0,0", "line 3: node 1 is at another place before"),
        ("n.csv", "node,x,y,z", "node,x,y,y", "two columns have one heading"),
        ("n.csv", "node,", "corner,", "no column 'node'; there are: corner, x, y, z"),
        ("s.csv", "2,1,0.2", "7,1,0.2", "names node 7, which is not in n.csv"),
        ("s.csv", "2,1,0.2", "2,2,0.2", "line 3: mode 2 has no frequency"),
        ("s.csv", "2,1,0.2", "1,1,0.2", "a node stands twice in one mode"),
        ("s.csv", "uz", "ux", "no column uz: nothing says how nodes move vertically"),
        ("s.csv", "mode,uz", "more,uz", "no column 'mode_1'"),
        ("f.csv", "5.5", "0", "line 2: a frequency must be above 0"),
        ("f.csv", "1200", "-3", "line 2: a modal mass must be above 0"),
        ("f.csv", "1,5.5,1200", "1,5.5,1200\n2,7.5,900", "has no shape of mode 2"),
        ("f.csv", "1,5.5,1200", "1.5,5.5,1200", "mode must be a whole number; got 1.5"),
        ("f.csv", GOOD["f.csv"], "mode,frequency\n", "has a heading, and no rows"),
        ("f.csv", GOOD["f.csv"], "", "holds no table"),
        ("f.csv", "frequency,", "frequency [rad/s],", "read in Hz; these are in 'rad/s'"),
        ("n.csv", "node,x,", "node,x [mm],", "x is in 'mm', and the model's units are others"),
        ("n.csv", "1,0,0,0", "1,0,0,0,5,6", "has more columns than the heading"),
    ],
)
def test_damaged_tables_are_refused_with_their_line(tmp_path, name, old, new, words):
    for file, text in GOOD.items():
        changed = text.replace(old, new) if file == name else text
        assert file != name or changed != text
        (tmp_path / file).write_text(changed)
    read = read_modes(files(tmp_path, elements=False), units=SI)
    assert read.structure is None
    assert words in str(read.problems[0])


def test_tables_as_programs_write_them(tmp_path):
    """A title, a line of units, decimal commas, quotes, comments: the same numbers."""
    path = tmp_path / "t.csv"
    path.write_text(
        'TABLE:  Modal Periods And Frequencies\n"StepNum","Period","Frequency"\n'
        '"Unitless","Sec","Cyc/sec"\n1,0.2,5.0\n2,0.1,10.0\n'
    )
    table = read_table(path)
    assert table.need(("f", "frequency")).tolist() == [5.0, 10.0]
    path.write_text("mode;f [Hz]\n# by hand\n1;5,5\n\n2;7,25\n")
    assert read_table(path).need(("f",)).tolist() == [5.5, 7.25]
    path.write_bytes("mode;f\n1;5\n".encode("utf-16"))
    with pytest.raises(InputError, match="is not UTF-8 text"):
        read_table(path)


MATRIX = "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 2.0\n2 2 2.0\n3 3 2.0\n"
NODES = "node,x,y,z,uz\n1,0,0,0,1\n2,4,0,0,2\n3,0,4,0,3\n"


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("k.mtx", "hello\n", "line 1: must begin with %%MatrixMarket"),
        ("k.mtx", MATRIX.replace("3 3 3", "3 3 4"), "is no matrix that can be read"),
        ("k.mtx", MATRIX.replace("3 3 3", "3 4 3").replace("symmetric", "general"), "must be square"),
        ("k.mtx", MATRIX.replace("real", "complex").replace("2.0", "2.0 1.0"), "must be a real"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "1 1 nan"), "is no matrix that can be read"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "1 1 2.0e"), "is no matrix that can be read"),
        ("k.mtx", MATRIX[:-2] + "e", "is no matrix that can be read"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "1 1 2.0 7"), "is no matrix that can be read"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "2 1 9.0"), "larger than its diagonals allow"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "1 9 2.0"), "lies outside its 3 rows"),
        ("k.mtx", MATRIX.replace("real", "pattern"), "must be a real matrix"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "1 1 -2.0"), "row 1 has a diagonal below 0"),
        ("k.mtx", MATRIX.replace("1 1 2.0", "2 1 2.0").replace("symmetric", "general"), "symmetric"),
        ("m.mtx", MATRIX.replace("3 3 3", "4 4 3"), "has 3 rows, and m.mtx 4"),
        ("nodes.csv", NODES.replace("4,0,0,2", "4,0,0,9"), "row 9 of uz is none of the 3"),
        ("nodes.csv", NODES.replace("4,0,0,2", "4,0,0,1"), "row 1 belongs to two dofs"),
        ("nodes.csv", NODES.replace("4,0,0,2", "4,0,0,"), "row 2 of the matrices belongs to no node"),
        ("nodes.csv", NODES.replace(",uz", ",w"), "are neither six nor three"),
    ],
)  # fmt: skip
def test_damaged_matrices_are_refused(tmp_path, name, text, words):
    for file, good in (("k.mtx", MATRIX), ("m.mtx", MATRIX), ("nodes.csv", NODES)):
        (tmp_path / file).write_text(text if file == name else good)
    read = read_matrices(
        stiffness=tmp_path / "k.mtx",
        mass=tmp_path / "m.mtx",
        nodes=tmp_path / "nodes.csv",
        units=SI,
    )
    assert read.structure is None
    assert words in str(read.problems[0])


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("node 1,node 2,node 3,node 4\n1,2,3,4\n", "line 2: a face is folded"),
        ("node 1,node 2,node 3,node 4\n1,2,4,4\n", "line 2: a face names a node twice"),
        ("node 1,node 2,node 3,corner 4\n1,2,4,3\n", "not used of e.csv: corner_4"),
        ("node 1,node 2,node 3\n1,2,4\n2,4,1\n", "a face stands in it twice"),
        ("node 1,node 2,node 3\n1,2,9\n", "names node 9, which is not in n.csv"),
    ],
)
def test_faces_that_cannot_be_are_refused(tmp_path, table, words):
    for file, text in {**GOOD, "e.csv": table}.items():
        (tmp_path / file).write_text(text)
    assert words in str(read_modes(files(tmp_path), units=SI).problems[0])


def test_columns_that_are_not_used_are_told(tmp_path):
    for file, text in GOOD.items():
        (tmp_path / file).write_text(
            text.replace("mode,uz", "mode,uz,v1").replace("0.1\n", "0.1,7\n")
        )
    (tmp_path / "s.csv").write_text("node,mode,uz,v1\n1,1,0.1,5\n2,1,0.2,5\n3,1,0.3,5\n4,1,0.4,5\n")
    read = read_modes(files(tmp_path, elements=False), units=SI)
    assert "not used of s.csv: v1" in read.told
