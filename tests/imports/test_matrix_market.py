"""Matrices of text by hand: halves, rows of dofs, units of rotations, what is taken for granted."""

import numpy as np
import pytest

from trundle.imports import units_of
from trundle.imports.matrices import read_matrices

SI = units_of("N, m")
HEAD = "%%MatrixMarket matrix coordinate real {} \n% by hand\n\n2 2 {}\n"
NODES = "node,x,y,z,uz\n1,0,0,0,1\n2,4,0,0,2\n"
MASS = HEAD.format("symmetric", 2) + "1 1 50\n2 2 200\n"


def read(tmp_path, stiffness, mass=MASS, nodes=NODES, units=SI):
    for name, text in (("k.mtx", stiffness), ("m.mtx", mass), ("n.csv", nodes)):
        (tmp_path / name).write_text(text)
    return read_matrices(
        stiffness=tmp_path / "k.mtx", mass=tmp_path / "m.mtx", nodes=tmp_path / "n.csv",
        units=units,
    )  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        HEAD.format("symmetric", 3) + "1 1 5e3\n2 1 -2e3\n2 2 3e3\n",
        HEAD.format("symmetric", 3) + "1 2 -2000\n2 2 3000\n1 1 5000\n",  # the upper half
        HEAD.format("general", 4) + "1 1 5e3\n2 1 -2e3\n1 2 -2e3\n2 2 3e3\n",
        HEAD.format("general", 5) + "1 1 2e3\n1 1 3e3\n2 1 -2e3\n1 2 -2e3\n2 2 3e3\n",
        HEAD.format("SYMMETRIC", 3).replace("real", "Integer") + "1 1 5000\n2 1 -2000\n2 2 3000\n",
    ],
)
def test_one_half_or_both_are_the_same_matrix(tmp_path, text):
    """(5, -2; -2, 3) kN/m in five ways; entries that stand twice add up, as the format says."""
    found = read(tmp_path, text)
    assert found.problems == ()
    assert found.structure.stiffness.toarray().tolist() == [[5e3, -2e3], [-2e3, 3e3]]
    assert found.structure.mass.toarray().tolist() == [[50.0, 0.0], [0.0, 200.0]]


def test_two_masses_vibrate_by_hand(tmp_path):
    """Roots of (5e3 - 50 w2)(3e3 - 200 w2) = 4e6: by the quadratic formula."""
    text = HEAD.format("symmetric", 3) + "1 1 5e3\n2 1 -2e3\n2 2 3e3\n"
    omega = read(tmp_path, text).structure.modes(10.0).omega
    a, b, c = 50.0 * 200.0, -(5e3 * 200.0 + 3e3 * 50.0), 5e3 * 3e3 - 4e6
    roots = (-b + np.array([-1.0, 1.0]) * np.sqrt(b * b - 4 * a * c)) / (2 * a)
    np.testing.assert_allclose(omega**2, roots, rtol=1e-9)


def test_rotations_carry_a_length_each(tmp_path):
    """kN and mm: 2 kN/mm is 2e6 N/m, 3 kN between them 3e3 N, 5 kN mm is 5 N m; mass likewise.

    A unit of mass is 1 kN s2/mm, which is 1e6 kg; of its moment of inertia 1e6 kg mm2, 1 kg m2.
    """
    nodes = "node,x,y,z,uz,ry\n1,0,0,0,1,2\n2,4000,0,0,3,\n"
    head = "%%MatrixMarket matrix coordinate real symmetric\n3 3 {}\n"
    stiffness = head.format(4) + "1 1 2\n2 1 3\n2 2 5\n3 3 1\n"
    mass = head.format(3) + "1 1 4\n2 2 7\n3 3 1\n"
    found = read(tmp_path, stiffness, mass, nodes, units_of("kN, mm"))
    k, m = (one.toarray()[:2, :2] for one in (found.structure.stiffness, found.structure.mass))
    np.testing.assert_allclose(k, [[2e6, 3e3], [3e3, 5.0]], rtol=1e-12)
    np.testing.assert_allclose(m, [[4e6, 0.0], [0.0, 7.0]], rtol=1e-12)
    assert found.structure.nodes[1].tolist() == [4.0, 0.0, 0.0]


def test_rows_without_columns_are_those_of_the_nodes_in_their_order(tmp_path):
    """Two nodes and six rows: three translations each, so node 2 sinks by row 6."""
    diagonal = "%%MatrixMarket matrix coordinate real symmetric\n6 6 6\n" + "".join(
        f"{i} {i} {i}\n" for i in range(1, 7)
    )
    found = read(tmp_path, diagonal, diagonal, "node,x,y,z\nb,0,0,0\na,4,0,0\n")
    index = found.structure.dof_index
    assert index[:, :3].tolist() == [[0, 1, 2], [3, 4, 5]]
    assert (index[:, 3:] == -1).all()
    assert found.structure.moving_mass() == pytest.approx(3.0 + 6.0)


def test_a_file_that_is_not_there_is_told_as_a_problem(tmp_path):
    """Its name is in the problem, and nothing is made."""
    for name, text in (("m.mtx", MASS), ("n.csv", NODES)):
        (tmp_path / name).write_text(text)
    found = read_matrices(
        stiffness=tmp_path / "k.mtx", mass=tmp_path / "m.mtx", nodes=tmp_path / "n.csv", units=SI
    )
    assert found.structure is None
    assert "k.mtx: no such file" in str(found.problems[0])
    assert [path.name for path in found.files] == ["n.csv", "k.mtx", "m.mtx"]


def test_a_matrix_that_is_not_positive_is_refused(tmp_path):
    """Off its diagonal 5 between 2 and 3: 25 is more than 6, so some motion would give energy."""
    text = HEAD.format("symmetric", 3) + "1 1 2\n2 1 5\n2 2 3\n"
    assert "entry (2, 1) is larger than its diagonals allow" in str(
        read(tmp_path, text).problems[0]
    )
    just = HEAD.format("symmetric", 3) + "1 1 2\n2 1 -2.4494897\n2 2 3\n"  # the root of 6
    assert read(tmp_path, just).problems == ()
