"""The reduced matrices of a building by their pieces: products, damped solutions, and what is seen."""

import functools

import numpy as np
import pytest
from scipy import sparse

from towers import halfway, tower
from trundle.structure.superelements import Cuts, Parting

CUT = Parting(cuts=Cuts(x=np.array([6.0]), z=halfway(2)), f_parts=40.0, f_seams=80.0)


@functools.cache
def parted():
    return CUT.of(tower(storeys=2, bays_x=2, bays_y=1, mesh_size=1.5))


@pytest.mark.parametrize("f", [3.0, 11.0, 40.0])
def test_a_damped_solution_satisfies_the_reduced_matrices(f):
    """``(K - z M) x = b`` by products with K and M, which know nothing of the elimination."""
    pencil = parted().joined.pencil
    shift = (2 * np.pi * f) ** 2 / (1 + 0.06j)
    rng = np.random.default_rng(0)
    for load in (
        rng.standard_normal(pencil.n_coordinates),
        rng.standard_normal((pencil.n_coordinates, 3)),
    ):
        x = pencil.factorise_damped(shift).solve(load)
        assert x.shape == load.shape
        left = sum(
            unit * (pencil.stiffness @ part - shift * (pencil.mass @ part))
            for unit, part in ((1.0, x.real), (1j, x.imag))
        )
        assert np.linalg.norm(left - load) <= 1e-10 * np.linalg.norm(load)


def test_a_real_shift_gives_the_same_on_either_way():
    """Just off the real axis the damped solution is the real one."""
    pencil = parted().joined.pencil
    shift = (2 * np.pi * 7.0) ** 2
    load = np.random.default_rng(1).standard_normal(pencil.n_coordinates)
    real = pencil.factorise(shift).solve(load)
    damped = pencil.factorise_damped(complex(shift, 1e-9 * shift)).solve(load)
    assert np.linalg.norm(damped - real) <= 1e-5 * np.linalg.norm(real)


def test_rows_by_coordinates_see_what_the_whole_motion_shows():
    """Motion of all dofs by random coordinates, read row by row, dofs on cuts among them."""
    joined = parted().joined
    q = np.random.default_rng(2).standard_normal((joined.pencil.n_coordinates, 4))
    reader = sparse.random_array(
        (30, joined.n_dofs), density=0.01, rng=np.random.default_rng(3), format="csr"
    )
    rows = joined.by_coordinates(reader)
    assert rows.shape == (30, joined.pencil.n_coordinates)
    np.testing.assert_allclose(rows @ q, reader @ joined.expanded(q), atol=1e-12)
    np.testing.assert_allclose(rows @ q, joined.seen(reader, q), atol=1e-12)


def test_no_rows_see_nothing():
    joined = parted().joined
    rows = joined.by_coordinates(sparse.csr_array((0, joined.n_dofs)))
    assert rows.shape == (0, joined.pencil.n_coordinates)
