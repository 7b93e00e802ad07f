"""Combinations found at a few frequencies answer as the whole does, within what is told of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu

from trundle.dynamics import (
    Questions,
    SparsePencil,
    answering_modes,
    available_backends,
    factorise_damped,
    natural_modes,
)
from trundle.errors import ConvergenceError, UnrestrainedModeError

F_MAX = 10.0
RATIO = 0.06
N = 30


def grid(n=N, *, f_first=0.6, seed=0):
    """Return a membrane of masses on springs, each a little different, held all round.

    Some 500 of its 900 modes lie below F_MAX.
    """
    rng = np.random.default_rng(seed)
    line = sparse.diags_array(
        [-np.ones(n - 1), 2 * np.ones(n), -np.ones(n - 1)], offsets=[-1, 0, 1]
    )
    one = sparse.eye_array(n)
    stiffness = sparse.kron(line, one) + sparse.kron(one, line)
    mass = sparse.diags_array(rng.uniform(0.8, 1.2, n * n))
    first = 2 * (2 - 2 * np.cos(np.pi / (n + 1)))
    return SparsePencil(
        mass=sparse.csc_array(mass),
        stiffness=sparse.csc_array(stiffness * (2 * np.pi * f_first) ** 2 / first),
    )


def rows(places, n=N):
    """Return rows that each see one mass, numbered along and across."""
    at = [i * n + j for i, j in places]
    return sparse.csr_array((np.ones(len(at)), (np.arange(len(at)), at)), shape=(len(at), n * n))


def asked(*, mapped=False):
    """Drive along a short way near one corner, read in the middle and near the other corner."""
    return Questions(
        pushed=rows([(3, j) for j in range(4, 10)]),
        read=rows([(15, 14), (25, 26)]),
        mapped=rows([(20, j) for j in range(0, N, 3)] if mapped else []),
    )


def solved(pencil, omega, loads):
    """Return the motion under loads, by a sparse solution of the full damped matrix."""
    shift = omega**2 / (1 + 2j * RATIO)
    return splu(sparse.csc_matrix(pencil.stiffness - shift * pencil.mass)).solve(loads + 0j)


def told_by(pencil, modes, omega, read, loads):
    """Return what rows read under loads by combinations, statics of what they leave out added."""
    shift = omega**2 / (1 + 2j * RATIO)
    still = splu(sparse.csc_matrix(pencil.stiffness)).solve(loads)
    more = 1.0 / (modes.omega**2 - shift) - 1.0 / modes.omega**2
    return read @ still + (read @ modes.shapes * more) @ (modes.shapes.T @ loads)


def constant(omega):
    return np.full_like(omega, RATIO)


@pytest.mark.parametrize("seed", range(4))
def test_the_error_told_bounds_that_at_frequencies_nobody_looked_at(seed):
    """Against dense solutions on 150 lines placed anew, point by point over the route."""
    pencil, questions = grid(seed=seed), asked()
    found = answering_modes(pencil, questions, constant, f_max=F_MAX, tolerance=0.02)
    assert found.error <= 0.02
    assert found.modes.n_modes < 0.7 * found.n_below
    read = sparse.vstack([questions.read, questions.pushed])
    loads, off, size = questions.pushed.T.toarray(), [], []
    for f in np.geomspace(0.4, F_MAX, 120):
        omega = 2 * np.pi * f
        true = read @ solved(pencil, omega, loads)
        ours = told_by(pencil, found.modes, omega, read, loads)
        off.append(omega * norms(ours - true))
        size.append(omega * norms(true))
    loudest = np.max(size, axis=0)  # what is 40 dB below it is held against that
    worst = np.max(off / np.maximum(size, 0.01 * loudest))
    assert worst <= 1.5 * max(found.error, 0.005)


def norms(block):
    """Return how large each reading is over the route."""
    return np.linalg.norm(block, axis=1)


@pytest.mark.parametrize("link", [0.1, 0.001])
def test_a_reading_that_little_comes_to_is_answered_too(link):
    """In a second membrane on two weak springs, as a storey below: what moves it is a small part of
    how it answers, and must not be left out as small. Against sparse solutions, within what is
    told."""
    n = 20
    one, other = grid(n), grid(n, seed=5)
    stiffness = sparse.block_diag([one.stiffness, other.stiffness]).tolil()
    spring = link * abs(one.stiffness).max()
    for p in (3 * n + 15, 12 * n + 4):
        for i, j, sign in (
            (p, p, 1),
            (p, p + n * n, -1),
            (p + n * n, p, -1),
            (p + n * n, p + n * n, 1),
        ):
            stiffness[i, j] += sign * spring
    mass = sparse.csc_array(sparse.block_diag([one.mass, other.mass]))
    pencil = SparsePencil(mass=mass, stiffness=sparse.csc_array(stiffness))
    none = sparse.csr_array((0, n * n))
    questions = Questions(
        pushed=sparse.csr_array(
            sparse.hstack([rows([(3, j) for j in range(4, 10)], n), 0 * one.mass[:6]])
        ),
        read=sparse.csr_array(sparse.hstack([0 * one.mass[:1], rows([(16, 16)], n)])),
        mapped=sparse.csr_array(sparse.hstack([none, none])),
    )
    found = answering_modes(pencil, questions, constant, f_max=F_MAX, tolerance=0.1)
    assert found.error <= 0.1
    loads, off, size = questions.read.T.toarray(), [], []
    for f in np.geomspace(0.4, F_MAX, 60):
        omega = 2 * np.pi * f
        true = questions.pushed @ solved(pencil, omega, loads)
        ours = told_by(pencil, found.modes, omega, questions.pushed, loads)
        off.append(omega * np.linalg.norm(ours - true))
        size.append(omega * np.linalg.norm(true))
    worst = np.max(off / np.maximum(size, 0.01 * max(size)))
    assert worst <= 1.5 * found.error


def test_a_finer_tolerance_looks_at_more_frequencies_and_is_met():
    """Errors fall as the answers at more frequencies are taken in."""
    pencil, questions = grid(), asked()
    found = [
        answering_modes(pencil, questions, constant, f_max=F_MAX, tolerance=t)
        for t in (0.1, 0.02, 0.005)
    ]
    assert [one.error <= t for one, t in zip(found, (0.1, 0.02, 0.005), strict=True)] == [True] * 3
    sizes = [one.modes.n_modes for one in found]
    assert sizes == sorted(sizes)
    assert sizes[0] < sizes[2]
    assert found[0].n_frequencies < found[2].n_frequencies


def test_combinations_are_modes_of_a_smaller_system():
    """M-orthonormal, K-orthogonal, none below the first mode (Rayleigh), which they find."""
    pencil, questions = grid(), asked()
    found = answering_modes(pencil, questions, constant, f_max=F_MAX, tolerance=0.02)
    shapes, omega = found.modes.shapes, found.modes.omega
    np.testing.assert_allclose(shapes.T @ (pencil.mass @ shapes), np.eye(len(omega)), atol=1e-9)
    square = shapes.T @ (pencil.stiffness @ shapes)
    np.testing.assert_allclose(square, np.diag(omega**2), atol=1e-9 * square.max())
    whole = natural_modes(pencil.mass, pencil.stiffness, f_max=F_MAX)
    assert found.n_below == whole.n_modes
    assert omega[0] >= whole.omega[0] * (1 - 1e-10)
    assert omega[0] == pytest.approx(whole.omega[0], rel=1e-6)
    # each is an upper bound of the mode of its number (Courant, Fischer)
    assert np.all(omega[: whole.n_modes] >= whole.omega[: len(omega)] * (1 - 1e-10))


def test_places_of_a_map_are_looked_at_too():
    """A map that the route hardly reaches asks for more than the route itself."""
    pencil = grid()
    alone, both = (
        answering_modes(pencil, asked(mapped=m), constant, f_max=F_MAX, tolerance=0.01)
        for m in (False, True)
    )
    assert both.error <= 0.01
    assert both.modes.n_modes >= alone.modes.n_modes
    questions = asked(mapped=True)
    push = questions.pushed.T.toarray() @ np.ones((6, 1))
    for f in (0.7, 3.7, 8.9):
        omega = 2 * np.pi * f
        true = questions.mapped @ solved(pencil, omega, push)
        ours = told_by(pencil, both.modes, omega, questions.mapped, push)
        assert np.linalg.norm(ours - true) <= 0.02 * np.linalg.norm(true)


def test_answers_need_no_further_modes_when_cut_at_a_lower_frequency():
    """None of them is left out: they answer below a lower limit as well."""
    found = answering_modes(grid(), asked(), constant, f_max=F_MAX, tolerance=0.05)
    assert not found.modes.answering  # said by whoever knows of what
    told = replace(found.modes, answering="in place of all modes")
    lower = told.below(0.5 * F_MAX)
    assert lower.n_modes == told.n_modes
    assert lower.f_max == 0.5 * F_MAX
    assert found.modes.below(0.5 * F_MAX).n_modes < told.n_modes


def test_what_cannot_be_met_is_said():
    """Answers with an error that no frequency mends are given up, and not without end."""
    rng = np.random.default_rng(1)

    def spoiled(enquiry, shifts):
        for shift in shifts:
            found = enquiry.at(shift)
            yield found * (1.0 + 0.2 * rng.standard_normal(found.shape[1]))

    with pytest.raises(ConvergenceError, match="do not come within the tolerance"):
        answering_modes(grid(), asked(), constant, f_max=F_MAX, tolerance=0.01, answer_all=spoiled)


@pytest.mark.parametrize("backend", available_backends())
def test_damped_matrices_are_solved_by_every_backend(backend):
    """Residuals at round-off, of real and complex right-hand sides, one and several."""
    pencil = grid()
    matrix = sparse.csc_array(pencil.stiffness - (500.0 - 30.0j) * pencil.mass)
    solver = factorise_damped(matrix, backend=backend)
    rng = np.random.default_rng(0)
    for b in (rng.standard_normal(N * N), rng.standard_normal((N * N, 3)) * (1 + 2j)):
        x = solver.solve(b)
        assert x.shape == b.shape
        assert np.linalg.norm(matrix @ x - b) <= 1e-12 * np.linalg.norm(b)


def test_a_singular_damped_matrix_is_refused():
    nothing = sparse.csc_array(np.zeros((3, 3), dtype=complex))
    with pytest.raises(UnrestrainedModeError):
        factorise_damped(nothing, backend="superlu")
