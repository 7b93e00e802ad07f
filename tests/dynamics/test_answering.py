"""Combinations found at a few frequencies answer as the whole does, within what is told of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu

from trundle.dynamics import (
    Enquiry,
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


def plate(n=N, *, f_first=0.6, seed=0):
    """Return a grid whose frequencies rise with the square of the waves across it, as a slab's."""
    one = grid(n, f_first=f_first, seed=seed)
    square = one.stiffness @ one.stiffness
    first = 2 * (2 - 2 * np.cos(np.pi / (n + 1)))
    unit = (2 * np.pi * f_first) ** 2 / first  # of what the grid is a multiple
    return SparsePencil(mass=one.mass, stiffness=sparse.csc_array(square / (first * unit)))


def side_by_side(pencils, link):
    """Join equal masses of neighbours by springs, as joints between slabs do."""
    stiffness = sparse.block_diag([one.stiffness for one in pencils]).tolil()
    n = pencils[0].mass.shape[0]
    spring = link * abs(pencils[0].stiffness).max()
    for k in range(1, len(pencils)):
        for p in range(0, n, 100):
            a, b = (k - 1) * n + p, k * n + p
            stiffness[a, a] += spring
            stiffness[b, b] += spring
            stiffness[a, b] -= spring
            stiffness[b, a] -= spring
    mass = sparse.csc_array(sparse.block_diag([one.mass for one in pencils]))
    return SparsePencil(mass=mass, stiffness=sparse.csc_array(stiffness))


def slabs():
    """Return three slabs in a row whose first modes are at 0.6 Hz, and two lanes and three points.

    All but a few of their 1200 modes lie below 100 Hz.
    """
    n, count = 20, 3
    pencil = side_by_side([plate(n, seed=seed) for seed in range(count)], 0.02)
    lanes = [(k * n + i, j) for k in range(count) for i in (3, 9) for j in range(1, n - 1)]
    wide = (len(lanes) + 3, count * n * n)
    at = [i * n + j for i, j in [*lanes, (15, 14), (n + 19, 17), (2 * n + 9, 9)]]
    every = sparse.csr_array((np.ones(len(at)), (np.arange(len(at)), at)), shape=wide)
    return pencil, Questions(pushed=every[:-3], read=every[-3:], mapped=every[:0])


def test_a_hundred_times_the_first_mode_is_answered_as_well_as_twice():
    """The static answer of the first modes is thousands of times what moves at 100 Hz, and nothing
    there may be left out as small beside it. Against sparse solutions on lines placed anew, from
    points to both lanes."""
    pencil, questions = slabs()
    found = answering_modes(pencil, questions, constant, f_max=100.0, tolerance=0.1)
    assert found.error <= 0.1
    pushed, loads, off, size = questions.pushed, questions.read.T.toarray(), [], []
    for f in np.geomspace(0.4, 100.0, 40):
        omega = 2 * np.pi * f
        true = pushed @ solved(pencil, omega, loads)
        ours = told_by(pencil, found.modes, omega, pushed, loads)
        off.append(omega * np.linalg.norm(ours - true, axis=0))
        size.append(omega * np.linalg.norm(true, axis=0))
    worst = np.max(off / np.maximum(size, 0.01 * np.max(size, axis=0)))
    assert worst <= found.error


@pytest.mark.parametrize("f", [2.0, 6.0, 11.0])
def test_forces_that_no_combination_holds_move_little_at_any_frequency(f):
    """What random forces on both lanes have beside the combinations, as it moves the lanes beyond
    its static answer, against all that these forces do there; sparse solutions."""
    pencil, questions = slabs()
    shifts = [(2 * np.pi * line) ** 2 / (1 + 2j * RATIO) for line in (12.0, 3.0, 0.75)]
    rest = pencil.factorise(0.0)
    enquiry = Enquiry.of(pencil, questions, rest, shifts=shifts, tolerance=0.1)
    pushed = questions.pushed
    patterns = pushed @ enquiry.forces[:, : enquiry.n_combined]  # each row sees one mass
    assert patterns.shape[1] < pushed.shape[0]
    drawn = np.random.default_rng(1).standard_normal((pushed.shape[0], 8))
    left = drawn - patterns @ (patterns.T @ drawn)
    omega = 2 * np.pi * f
    moved = pushed @ (solved(pencil, omega, pushed.T @ left) - rest.solve(pushed.T @ left))
    whole = pushed @ solved(pencil, omega, pushed.T @ drawn)
    assert np.linalg.norm(moved) <= 0.1 * np.linalg.norm(whole)


def norms(block):
    """Return how large each reading is over the route."""
    return np.linalg.norm(block, axis=1)


def storeys(link, n=20):
    """Return two membranes on two springs, as storeys, and places (i, j) of each as rows."""
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

    def seen(first, second):
        """Return rows of places of the first, then of the second."""
        return sparse.csr_array(sparse.block_diag([rows(first, n), rows(second, n)]))

    return SparsePencil(mass=mass, stiffness=sparse.csc_array(stiffness)), seen


LANE = [(3, j) for j in range(4, 10)]


@pytest.mark.parametrize("link", [0.1, 0.001])
def test_a_reading_that_little_comes_to_is_answered_too(link):
    """In a second membrane on two weak springs, as a storey below: what moves it is a small part of
    how it answers, and must not be left out as small. Against sparse solutions, within what is
    told."""
    pencil, seen = storeys(link)
    questions = Questions(pushed=seen(LANE, []), read=seen([], [(16, 16)]), mapped=seen([], []))
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


@pytest.mark.parametrize("link", [0.1, 0.01])
def test_a_map_that_little_comes_to_is_answered_too(link):
    """The same of places that are looked at only, and not pushed to find what moves them."""
    pencil, seen = storeys(link)
    places = [(i, j) for i in range(2, 18, 5) for j in range(3, 18, 4)]
    questions = Questions(pushed=seen(LANE, []), read=seen([(10, 10)], []), mapped=seen([], places))
    found = answering_modes(pencil, questions, constant, f_max=F_MAX, tolerance=0.1)
    assert found.error <= 0.1
    push = questions.pushed.T @ np.random.default_rng(3).standard_normal((len(LANE), 4))
    off, size = [], []
    for f in np.geomspace(0.4, F_MAX, 60):
        omega = 2 * np.pi * f
        true = questions.mapped @ solved(pencil, omega, push)
        ours = told_by(pencil, found.modes, omega, questions.mapped, push)
        off.append(omega * np.linalg.norm(ours - true, axis=0))
        size.append(omega * np.linalg.norm(true, axis=0))
    worst = np.max(off / np.maximum(size, 0.01 * np.max(size, axis=0)))
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
