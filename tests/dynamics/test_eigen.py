"""Modes and sparse factors against dense linear algebra."""

import subprocess
import sys

import numpy as np
import pytest
from scipy import linalg, sparse

from models import small_floor
from trundle.dynamics import (
    available_backends,
    count_modes_below,
    factorise,
    lanczos,
    natural_modes,
)
from trundle.errors import InputError, UnrestrainedModeError
from trundle.structure import reference_unit


@pytest.fixture(scope="module")
def floor():
    return small_floor(mesh_size=0.75)


@pytest.fixture(scope="module")
def dense(floor):
    squares, shapes = linalg.eigh(floor.stiffness.toarray(), floor.mass.toarray())
    return np.sqrt(squares) / (2 * np.pi), shapes


@pytest.mark.parametrize("backend", available_backends())
def test_block_lanczos_finds_what_dense_algebra_finds(floor, dense, backend):
    """Same frequencies as LAPACK, none missing, shapes M-orthonormal, residuals small."""
    assert floor.n_dofs > 600  # the sparse path
    f_max = 120.0
    modes = natural_modes(floor.mass, floor.stiffness, f_max=f_max, backend=backend)
    wanted = dense[0][dense[0] < f_max]
    assert modes.n_modes == len(wanted) > 40
    np.testing.assert_allclose(modes.frequencies, wanted, rtol=1e-8)
    gram = modes.shapes.T @ (floor.mass @ modes.shapes)
    np.testing.assert_allclose(gram, np.eye(modes.n_modes), atol=1e-9)
    assert modes.residuals.max() < 1e-8


@pytest.mark.parametrize("backend", available_backends())
@pytest.mark.parametrize("modes_a_shift", [24, 60])
def test_slices_of_a_spectrum_fit_together(floor, dense, backend, modes_a_shift, monkeypatch):
    """Many shifts, from both ends at once: still LAPACK's modes, orthonormal across the cuts."""
    monkeypatch.setattr(lanczos, "_SLICE", modes_a_shift)
    f_max = 250.0
    modes = natural_modes(floor.mass, floor.stiffness, f_max=f_max, backend=backend)
    wanted = dense[0][dense[0] < f_max]
    assert modes.n_modes == len(wanted) > 2 * modes_a_shift
    np.testing.assert_allclose(modes.frequencies, wanted, rtol=1e-8)
    gram = modes.shapes.T @ (floor.mass @ modes.shapes)
    np.testing.assert_allclose(gram, np.eye(modes.n_modes), atol=1e-9)
    assert modes.residuals.max() < 1e-8


def test_few_masses_on_a_large_structure():
    """A rank-4 mass: four modes, the same as of the static flexibility between the masses."""
    n = 900
    stiffness = sparse.diags_array(
        [np.full(n - 1, -1.0), np.full(n, 2.0), np.full(n - 1, -1.0)], offsets=[-1, 0, 1]
    ).tocsc()
    places = np.array([100, 350, 351, 700])
    mass = sparse.csc_array((np.full(4, 2.0), (places, places)), shape=(n, n))
    flexibility = np.linalg.inv(stiffness.toarray())[np.ix_(places, places)]
    expected = np.sort(1.0 / np.sqrt(2.0 * np.linalg.eigvalsh(flexibility))) / (2 * np.pi)
    modes = natural_modes(mass, stiffness, f_max=10.0)
    np.testing.assert_allclose(modes.frequencies, expected, rtol=1e-8)


@pytest.mark.parametrize("backend", available_backends())
def test_inertia_counts_modes(floor, dense, backend):
    for f in (5.0, 33.0, 77.7):
        count = count_modes_below(floor.mass, floor.stiffness, f, backend=backend)
        assert count == np.count_nonzero(dense[0] < f)


@pytest.mark.parametrize("backend", available_backends())
@pytest.mark.parametrize("columns", [None, 1, 5])
def test_factor_solves(floor, backend, columns):
    rng = np.random.default_rng(3)
    shape = (floor.n_dofs,) if columns is None else (floor.n_dofs, columns)
    x = rng.standard_normal(shape)
    solved = factorise(floor.stiffness, backend=backend).solve(floor.stiffness @ x)
    assert solved.shape == shape
    np.testing.assert_allclose(solved, x, rtol=1e-6, atol=1e-7)


def test_repeated_modes_are_all_found():
    """A square plate has pairs of equal modes; a single-vector iteration could miss one."""
    from trundle.structure import CONCRETE, FloorPlan, ShellSection, build_floor

    plan = FloorPlan(
        x_lines=np.array([0.0, 4.0]),
        y_lines=np.array([0.0, 4.0]),
        x_extent=(0.0, 4.0),
        y_extent=(0.0, 4.0),
        slab=ShellSection(thickness=0.1, material=CONCRETE),
        material=CONCRETE,
        edges=dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "pinned"),
    )
    plate = build_floor(plan, mesh_size=0.25)
    f = natural_modes(plate.mass, plate.stiffness, f_max=150.0).frequencies
    assert f[1] == pytest.approx(f[2], rel=1e-9)


def test_a_free_body_has_six_rigid_modes():
    floor = small_floor(mesh_size=3.0, column=None)
    with pytest.raises(UnrestrainedModeError, match="6 motions without strain"):
        natural_modes(floor.mass, floor.stiffness, f_max=50.0)
    free = natural_modes(floor.mass, floor.stiffness, f_max=50.0, allow_rigid=True)
    assert np.count_nonzero(free.frequencies < 0.01) == 6
    assert free.frequencies[6] > 1.0


@pytest.mark.parametrize("backend", available_backends())
def test_a_singular_matrix_is_refused(backend):
    loose = sparse.csc_array(
        (np.array([1.0, -1.0, -1.0, 1.0]), ([0, 0, 1, 1], [0, 1, 0, 1])), shape=(2, 2)
    )
    with pytest.raises(UnrestrainedModeError, match="move without strain"):
        factorise(loose, backend=backend)


def test_an_unknown_backend_is_refused():
    with pytest.raises(InputError, match="sparse backend must be one of"):
        factorise(sparse.csc_array(np.eye(2)), backend="magic")


@pytest.mark.longest
def test_a_missing_mode_is_noticed(monkeypatch):
    """If inertia counts one mode more than are found, nothing is returned."""
    from trundle.dynamics import eigen
    from trundle.errors import ConvergenceError

    floor = small_floor(mesh_size=0.75)
    counted = eigen.count_modes_below
    monkeypatch.setattr(
        eigen, "count_modes_below", lambda *args, **kwargs: counted(*args, **kwargs) + 1
    )
    with pytest.raises(ConvergenceError):
        natural_modes(floor.mass, floor.stiffness, f_max=20.0)


@pytest.mark.longest
def test_what_a_slice_has_missed_is_hunted_down(monkeypatch):
    """A chain of 6500 masses, ``omega_j = 2 sqrt(k / m) sin(j pi / 2 / 6501)``, whose first slice
    loses one of its modes: inertia tells, and the march goes back and finds it."""
    from trundle.dynamics import lanczos

    n, k, m = 6500, 1e6, 10.0
    chain = sparse.diags_array(
        [2 * k * np.ones(n), -k * np.ones(n - 1), -k * np.ones(n - 1)], offsets=[0, 1, -1]
    )
    near, lost = lanczos.near, []

    def one_less(*args, **kwargs):
        part = near(*args, **kwargs)
        if lost:
            return part
        lost.append(part.eigenvalues[7])
        stays = np.arange(len(part.eigenvalues)) != 7
        return lanczos.EigenSlice(eigenvalues=part.eigenvalues[stays], shapes=part.shapes[:, stays])

    monkeypatch.setattr(lanczos, "near", one_less)
    exact = 2 * np.sqrt(k / m) * np.sin(np.arange(1, n + 1) * np.pi / 2 / (n + 1))
    f_max = 0.5 * (exact[599] + exact[600]) / (2 * np.pi)
    found = natural_modes(
        sparse.csc_array(m * sparse.eye_array(n)), sparse.csc_array(chain), f_max=f_max
    )
    assert len(lost) == 1
    np.testing.assert_allclose(found.omega, exact[:600], rtol=1e-8)


@pytest.mark.parametrize("backend", available_backends())
@pytest.mark.parametrize(
    ("copies", "f_max"),
    [(45, 6.0), (100, 2.0), pytest.param(100, 9.0, marks=pytest.mark.longest)],
)
def test_many_equal_modes_are_all_found(backend, copies, f_max):
    """Copies of a chain of 90 masses, ``omega_j = 2 sqrt(k / m) sin(j pi / 2 / 91)`` as often as
    there are copies, more than a block of the iteration shows, at the limit and between slices."""
    n, k, m = 90, 1e6, 10.0
    chain = sparse.diags_array(
        [2 * k * np.ones(n), -k * np.ones(n - 1), -k * np.ones(n - 1)], offsets=[0, 1, -1]
    )
    each = sparse.eye_array(copies)
    stiffness = sparse.csc_array(sparse.kron(each, chain))
    mass = sparse.csc_array(sparse.kron(each, m * sparse.eye_array(n)))
    exact = np.sqrt(k / m) / np.pi * np.sin(np.arange(1, n + 1) * np.pi / 2 / (n + 1))
    found = natural_modes(mass, stiffness, f_max=f_max, backend=backend)
    np.testing.assert_allclose(
        found.frequencies, np.repeat(exact[exact < f_max], copies), rtol=1e-9
    )
    gram = found.shapes.T @ (mass @ found.shapes)
    assert np.abs(gram - np.eye(found.n_modes)).max() < 1e-9
    assert found.residuals.max() < 1e-7


@pytest.mark.longest
@pytest.mark.parametrize("backend", available_backends())
@pytest.mark.parametrize(("mesh_size", "f_max"), [(2.0, 39.2), (2.0, 124.0), (3.0, 44.0)])
def test_a_floor_of_equal_columns_keeps_all_its_modes(backend, mesh_size, f_max):
    """The reference unit, whose equal columns have some 45 modes near 39 Hz: by inertia's count."""
    floor = reference_unit(mesh_size=mesh_size)
    found = natural_modes(floor.mass, floor.stiffness, f_max=f_max, backend=backend)
    assert found.n_modes == count_modes_below(floor.mass, floor.stiffness, f_max)
    assert found.residuals.max() < 1e-8


@pytest.mark.skipif("pardiso" not in available_backends(), reason="needs pypardiso")
def test_a_factor_gives_its_memory_back():
    """30 factors of 30,000 dofs, each of some 20 MB that used to stay: less than one stays."""
    script = """
import resource
import subprocess
import sys

import numpy as np
from scipy import sparse
from trundle.dynamics import factorise
n = 173
line = sparse.diags_array([2.1 * np.ones(n), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1])
eye = sparse.eye_array(n)
matrix = sparse.csc_array(sparse.kron(line, eye) + sparse.kron(eye, line))
def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 1e6
for i in range(35):
    factorise(matrix, backend="pardiso").solve(np.ones(n * n))
    if i == 4:
        first = resident()
print(resident() - first)
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert float(done.stdout) < 20.0
