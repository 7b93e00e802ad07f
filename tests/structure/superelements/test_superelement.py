"""A part reduced to its boundary and its own modes."""

import numpy as np
import pytest
from scipy import linalg

from models import simple_beam, small_floor
from trundle.dynamics import RestingPart, natural_modes, reduce_part
from trundle.errors import UnrestrainedModeError


def dense(superelement):
    """Return the reduced mass and stiffness as dense matrices, own modes first."""
    n, b = len(superelement.omega), len(superelement.boundary)
    mass, stiffness = np.eye(n + b), np.zeros((n + b, n + b))
    mass[:n, n:], mass[n:, :n] = superelement.coupling, superelement.coupling.T
    mass[n:, n:] = superelement.mass
    stiffness[:n, :n] = np.diag(superelement.omega**2)
    stiffness[n:, n:] = superelement.stiffness
    return mass, stiffness


def test_at_rest_the_boundary_is_as_stiff_as_with_the_inside_solved_out():
    """K_b is the Schur complement, by dense algebra; static shapes are what it leaves inside."""
    floor = small_floor(mesh_size=2.0)
    boundary = np.unique(np.concatenate([floor.dof_index[:9].ravel(), floor.dof_index[-1]]))
    boundary = boundary[boundary >= 0]
    part = reduce_part(floor.mass, floor.stiffness, boundary, f_max=20.0)
    k = floor.stiffness.toarray()
    inside = part.interior
    solved = np.linalg.solve(k[np.ix_(inside, inside)], k[np.ix_(inside, boundary)])
    schur = k[np.ix_(boundary, boundary)] - k[np.ix_(boundary, inside)] @ solved
    np.testing.assert_allclose(part.stiffness, schur, atol=1e-8 * np.abs(schur).max())
    resting = RestingPart(reduced=part, stiffness=floor.stiffness)
    following = resting.following(np.eye(len(boundary)))
    np.testing.assert_allclose(following, -solved, atol=1e-9 * np.abs(solved).max())


def test_a_rigid_body_keeps_its_mass_and_costs_no_energy():
    """A beam without supports, moved as a whole by its two ends: u^T M u is its mass, u^T K u is 0."""
    beam = simple_beam(length=8.0, rigidity=2e7, line_mass=300.0, n_elements=16)
    ends = np.sort(np.concatenate([beam.dof_index[0], beam.dof_index[-1]]))
    ends = ends[ends >= 0]
    free = ~np.isin(np.arange(beam.n_dofs), ends)
    part = reduce_part(beam.mass, beam.stiffness, ends, f_max=1e4)
    assert part.n_dofs == beam.n_dofs
    assert free.sum() == len(part.interior)
    # the ends turn alone, for supports hold them: half a wave of rotation is the first own shape
    mass, stiffness = dense(part)
    omega2 = linalg.eigh(stiffness, mass, eigvals_only=True)
    expected = np.pi**2 * np.sqrt(2e7 / 300.0) / 8.0**2
    assert np.sqrt(omega2[0]) == pytest.approx(expected, rel=1e-5)


def test_frequencies_fall_to_those_of_the_whole_as_more_of_its_modes_are_kept():
    """Rayleigh and Ritz: each is an upper bound, and a wider band a larger space."""
    floor = small_floor(mesh_size=1.5)
    whole = natural_modes(floor.mass, floor.stiffness, f_max=25.0).omega
    middle = np.abs(floor.nodes[:, 0] - 6.0) < 1e-6
    boundary = np.sort(floor.dof_index[middle][floor.dof_index[middle] >= 0])
    errors = []
    for band in (30.0, 60.0, 120.0):
        part = reduce_part(floor.mass, floor.stiffness, boundary, f_max=band)
        mass, stiffness = dense(part)
        omega = np.sqrt(linalg.eigh(stiffness, mass, eigvals_only=True))[: len(whole)]
        errors.append(omega / whole - 1.0)
        assert errors[-1].min() > -1e-9
    assert np.all(errors[1] <= errors[0] + 1e-9)
    assert np.all(errors[2] <= errors[1] + 1e-9)
    # an own mode left out at f costs (f_mode / f)^4 of what it shares: a sixteenth an octave
    assert errors[2].max() < errors[0].max() / 16.0
    assert errors[2].max() < 1e-3


def test_what_rows_see_is_what_the_expanded_motion_shows():
    """Rows of weights on inside and boundary dofs alike, against the motion of all dofs."""
    floor = small_floor(mesh_size=2.0)
    boundary = np.arange(0, floor.n_dofs, 17)
    part = reduce_part(floor.mass, floor.stiffness, boundary, f_max=60.0)
    rng = np.random.default_rng(1)
    q, moved = rng.normal(size=(len(part.omega), 3)), rng.normal(size=(len(boundary), 3))
    from scipy import sparse

    reader = sparse.random_array((4, floor.n_dofs), density=0.1, rng=rng, format="csr")
    resting = RestingPart(reduced=part, stiffness=floor.stiffness)
    modes, static = resting.seen(reader)
    np.testing.assert_allclose(
        modes @ q + static @ moved, reader @ resting.expanded(q, moved), rtol=1e-9, atol=1e-12
    )


def test_a_part_that_its_boundary_does_not_hold_is_refused():
    """A free floor held at two dofs of one node can still turn."""
    beam = small_floor(mesh_size=3.0, column=None, storey_below=0.0, storey_above=0.0)
    with pytest.raises(UnrestrainedModeError):
        reduce_part(beam.mass, beam.stiffness, np.array([0, 1]), f_max=20.0)
