"""Combinations of modes answer between a route and points as all modes do, within what is told."""

import numpy as np
import pytest

from trundle.dynamics import response_basis

F_MAX = 10.0


def crowd(seed, *, n=400, dofs=16, points=2, ratio=0.03):
    """Return modes as a row of many equal bays has them: crowded, and felt far away by few."""
    rng = np.random.default_rng(seed)
    omega = 2 * np.pi * np.sort(rng.uniform(1.0, 1.25 * F_MAX, n))
    along = np.linspace(0.0, 1.0, dofs)
    waves = omega / omega[-1] * 6.0
    phase = rng.uniform(0.0, 2 * np.pi, n)
    route = rng.normal(size=n) * np.cos(np.pi * waves * along[:, None] + phase)
    return omega, np.full(n, ratio), route, rng.normal(size=(points, n))


def response(omega, ratios, read, route, f):
    """Return the receptance between readings and route, by its definition, mode by mode."""
    w = 2 * np.pi * f
    h = 1.0 / (omega**2 - w**2 + 2j * ratios * omega * w)
    return (read * h) @ route.T


@pytest.mark.parametrize(
    "seed", [*range(3), *(pytest.param(i, marks=pytest.mark.longest) for i in range(3, 20))]
)
def test_the_error_that_is_told_bounds_that_at_frequencies_not_looked_at(seed):
    """In third-octave bands, on 300 lines placed anew: at most the error told, half as much again."""
    omega, ratios, route, points = crowd(seed)
    basis = response_basis(omega, ratios, route, points, f_max=F_MAX, tolerance=0.01)
    assert basis is not None
    assert basis.error <= 0.01
    assert len(basis.omega) < 0.6 * len(omega)
    lines = np.geomspace(1.0, F_MAX, 300)
    both = [points @ basis.combined, route @ basis.combined]
    full = np.array([response(omega, ratios, points, route, f) for f in lines])
    fewer = np.array([response(basis.omega, basis.ratios, *both, f) for f in lines])
    for low in np.geomspace(1.0, F_MAX / 2 ** (1 / 3), 9):
        here = (lines >= low) & (lines < low * 2 ** (1 / 3))
        off = np.abs(fewer[here] - full[here]) ** 2
        size = np.abs(full[here]) ** 2
        worst = np.sqrt(off.sum(axis=(0, 2)) / size.sum(axis=(0, 2))).max()
        assert worst <= 1.5 * basis.error


def test_a_finer_tolerance_takes_more_of_them_and_is_met():
    """Errors fall with the size of a basis that holds the motions that matter most."""
    omega, ratios, route, points = crowd(1)
    found = [
        response_basis(omega, ratios, route, points, f_max=F_MAX, tolerance=t)
        for t in (0.05, 0.02, 0.005)
    ]
    assert all(
        one is not None and one.error <= t
        for one, t in zip(found, (0.05, 0.02, 0.005), strict=True)
    )
    sizes = [len(one.omega) for one in found]
    assert sizes == sorted(sizes)
    assert sizes[0] < sizes[2]


def test_combinations_are_modes_of_a_smaller_system():
    """Orthonormal, with frequencies between the lowest and the highest (Rayleigh), damped alike."""
    omega, ratios, route, points = crowd(2)
    basis = response_basis(omega, ratios, route, points, f_max=F_MAX, tolerance=0.01)
    n = len(basis.omega)
    np.testing.assert_allclose(basis.combined.T @ basis.combined, np.eye(n), atol=1e-10)
    assert basis.omega.min() >= omega.min() * (1 - 1e-12)
    assert basis.omega.max() <= omega.max() * (1 + 1e-12)
    square = basis.combined.T @ (omega[:, None] ** 2 * basis.combined)
    np.testing.assert_allclose(square, np.diag(basis.omega**2), atol=1e-9 * square.max())
    # the mean of frequencies is at most the root of their mean square: never more damped
    assert np.all(basis.ratios <= 0.03 + 1e-12)
    assert np.all(basis.ratios > 0.02)


def test_equal_modes_become_one():
    """Forty modes of one frequency, felt along one line by one number each: one oscillator."""
    rng = np.random.default_rng(0)
    omega = 2 * np.pi * np.repeat([2.0, 5.0, 9.0], 40)
    strength = rng.normal(size=120)
    route = strength * np.ones((6, 1))
    points = strength * np.full((1, 1), 2.0)
    basis = response_basis(omega, np.full(120, 0.03), route, points, f_max=F_MAX, tolerance=1e-6)
    assert basis is not None
    assert len(basis.omega) <= 12
    expected = response(omega, 0.03, points, route, 5.0)
    found = response(
        basis.omega, basis.ratios, points @ basis.combined, route @ basis.combined, 5.0
    )
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_where_few_modes_lie_all_are_kept():
    """Ten modes a decade apart from each other cannot be told by fewer."""
    rng = np.random.default_rng(3)
    omega = 2 * np.pi * np.linspace(1.0, 9.0, 10)
    route, points = rng.normal(size=(12, 10)), rng.normal(size=(1, 10))
    assert (
        response_basis(omega, np.full(10, 0.03), route, points, f_max=F_MAX, tolerance=0.005)
        is None
    )
