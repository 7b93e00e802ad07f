"""Exact steps and modal damping against dense algebra, other integrators and closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from scipy import integrate, linalg, sparse

from trundle.dynamics import (
    ByMaterial,
    ExactRecursion,
    LinearSystem,
    ModalRatio,
    ModalRecursion,
    NewmarkPropagator,
    Rayleigh,
    block_diagonal,
    modes_as_arrays,
    modes_from_arrays,
    natural_modes,
    repeatable,
)
from trundle.errors import InputError
from trundle.simulate import Newmark


def chain(n=4, *, seed=1):
    """Return masses on springs and dampers between neighbours and to the ground, dense."""
    rng = np.random.default_rng(seed)
    m, k, c = (rng.uniform(*span, n) for span in ((50.0, 90.0), (2e5, 6e5), (100.0, 900.0)))

    def laid(values):
        out = np.diag(values + np.append(values[1:], 0.0))
        return out - np.diag(values[1:], 1) - np.diag(values[1:], -1)

    return LinearSystem(mass=np.diag(m), damping=laid(c), stiffness=laid(k))


def test_exact_steps_follow_any_force_that_is_straight_between_steps():
    """Four coupled masses, forces of random corners: an adaptive Runge-Kutta method agrees.

    To 1e-7 of the largest motion, at steps a hundred times longer than it takes.
    """
    system, dt = chain(), 0.02
    rng = np.random.default_rng(2)
    corners = 100.0 * rng.standard_normal((12, 4))
    steps = ExactRecursion(system, dt)
    state, found = np.zeros(8), [np.zeros(8)]
    for before, after in pairwise(corners):
        state = steps.phi @ state + steps.from_start @ before + steps.from_end @ after
        found.append(state)
    clock = dt * np.arange(12)

    def rate(t, x):
        force = np.array([np.interp(t, clock, corners[:, i]) for i in range(4)])
        pull = force - system.damping @ x[4:] - system.stiffness @ x[:4]
        return np.concatenate([x[4:], np.linalg.solve(system.mass, pull)])

    other = integrate.solve_ivp(
        rate, (0.0, clock[-1]), np.zeros(8), t_eval=clock, rtol=1e-9, atol=1e-13, max_step=2e-3
    )
    scale = np.abs(other.y).max(axis=1)
    assert (np.abs(np.array(found).T - other.y).max(axis=1) < 1e-6 * scale).all()


def test_two_half_steps_are_one_step():
    """Free motion over dt is that over dt / 2 twice, and a straight force may be cut in the middle."""
    system = chain(3, seed=4)
    whole, half = ExactRecursion(system, 0.03), ExactRecursion(system, 0.015)
    np.testing.assert_allclose(half.phi @ half.phi, whole.phi, atol=1e-12)
    start = half.phi @ half.from_start + 0.5 * (half.phi @ half.from_end + half.from_start)
    end = half.from_end + 0.5 * (half.phi @ half.from_end + half.from_start)
    np.testing.assert_allclose(start, whole.from_start, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(end, whole.from_end, rtol=1e-9, atol=1e-15)


def test_modal_steps_are_the_closed_form_of_each_mode():
    """Free motion: exp(-z w t) (cos wd t, ...), light and beyond critical; a constant force ends
    at p / w^2.
    """
    omega, zeta, dt = np.array([3.0, 40.0, 25.0]), np.array([0.0, 0.05, 2.0]), 0.02
    steps = ModalRecursion(omega, zeta, dt)
    for i, (w, z) in enumerate(zip(omega, zeta, strict=True)):
        companion = np.array([[0.0, 1.0], [-(w**2), -2.0 * z * w]])
        values, vectors = np.linalg.eig(companion.astype(complex))
        free = (vectors * np.exp(values * dt)) @ np.linalg.inv(vectors)
        np.testing.assert_allclose(steps.phi[i], free.real, atol=1e-10)
        rest = np.array([1.0 / w**2, 0.0])
        held = steps.phi[i] @ rest + steps.from_start[i] + steps.from_end[i]
        np.testing.assert_allclose(held, rest, atol=1e-12)
    part = steps.part(slice(1, 3))
    np.testing.assert_array_equal(part.phi, steps.phi[1:])
    np.testing.assert_array_equal(part.square, omega[1:] ** 2)
    assert len(steps.square) == 3  # the whole stays as it was


def test_stepping_in_modes_is_stepping_the_matrices():
    """Stepping in its modes with Rayleigh's ratios is stepping the assembled matrices."""
    dense = chain(5, seed=6)
    damping = Rayleigh(alpha=0.7, beta=4e-4)
    system = LinearSystem(
        mass=dense.mass, damping=damping.matrix(dense.mass, dense.stiffness),
        stiffness=dense.stiffness,
    )  # fmt: skip
    squares, shapes = linalg.eigh(dense.stiffness, dense.mass)
    omega = np.sqrt(squares)
    direct, modal = ExactRecursion(system, 0.01), ModalRecursion(omega, damping.ratios(omega), 0.01)
    rng = np.random.default_rng(3)
    forces = rng.standard_normal((40, 5))
    x, q = np.zeros(10), np.zeros((5, 2))
    for before, after in pairwise(forces):
        x = direct.phi @ x + direct.from_start @ before + direct.from_end @ after
        p0, p1 = shapes.T @ before, shapes.T @ after
        q = np.einsum("mij,mj->mi", modal.phi, q)
        q += modal.from_start * p0[:, None] + modal.from_end * p1[:, None]
    np.testing.assert_allclose(x[:5], shapes @ q[:, 0], atol=1e-10 * np.abs(x[:5]).max())
    np.testing.assert_allclose(x[5:], shapes @ q[:, 1], atol=1e-10 * np.abs(x[5:]).max())


@pytest.mark.parametrize("rayleigh", [None, Rayleigh(alpha=0.8, beta=1e-3)])
def test_sparse_and_dense_newmark_steps_are_the_same(rayleigh):
    """The same steps by LU of a dense matrix, by a sparse factor, and by the short form of Rayleigh's."""
    dense = chain(6, seed=7)
    if rayleigh is not None:
        dense = LinearSystem(
            mass=dense.mass, damping=rayleigh.matrix(dense.mass, dense.stiffness),
            stiffness=dense.stiffness,
        )  # fmt: skip
    thin = LinearSystem(
        **{n: sparse.csc_array(getattr(dense, n)) for n in ("mass", "damping", "stiffness")}
    )
    assert thin.is_sparse
    assert not dense.is_sparse
    force = np.random.default_rng(1).standard_normal((6, 2))
    ends = []
    for system, given in ((dense, None), (thin, None), (thin, rayleigh)):
        steps = NewmarkPropagator(system, Newmark(dt=0.004), rayleigh=given)
        state = steps.start(1e-3 * force)
        for k in range(25):
            now = np.sin(0.3 * k) * force
            state = steps.finish(state, steps.predict(state, now), now)
        ends.append(state)
    for other in ends[1:]:
        np.testing.assert_allclose(other.displacement, ends[0].displacement, atol=1e-12)
        np.testing.assert_allclose(other.velocity, ends[0].velocity, atol=1e-10)


def test_newmark_keeps_the_equation_of_motion_at_every_step():
    """M u'' + C u' + K u = p at the step's end, whatever the step and the parameters."""
    system = chain(3, seed=8)
    steps = NewmarkPropagator(system, Newmark(dt=0.05))
    state = steps.start(np.zeros((3, 1)))
    for k in range(10):
        force = np.array([[100.0 * k], [-50.0], [10.0 * k**2]])
        state = steps.finish(state, steps.predict(state, force), force)
        inner = (
            system.mass @ state.acceleration + system.damping @ state.velocity
            + system.stiffness @ state.displacement
        )  # fmt: skip
        np.testing.assert_allclose(inner, force, atol=1e-8 * max(1.0, np.abs(force).max()))


def test_systems_beside_each_other_do_not_touch():
    """Blocks in their order: each steps as it does alone."""
    one, other = chain(2, seed=1), chain(3, seed=2)
    both = block_diagonal((one, other))
    assert both.n_dofs == 5
    np.testing.assert_array_equal(both.stiffness[:2, :2], one.stiffness)
    np.testing.assert_array_equal(both.mass[2:, 2:], other.mass)
    assert np.abs(both.damping[:2, 2:]).max() == 0.0
    phi = ExactRecursion(both, 0.01).phi
    alone = ExactRecursion(other, 0.01).phi
    np.testing.assert_allclose(phi[np.ix_([2, 3, 4], [2, 3, 4])], alone[:3, :3], atol=1e-12)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mass": np.ones((2, 3))}, r"mass must be a square matrix; got shape \(2, 3\)"),
        ({"stiffness": np.eye(3)}, "must have one shape"),
        ({"damping": np.array([[0.0, np.nan], [0.0, 0.0]])}, "damping must be finite"),
        ({"stiffness": sparse.csc_array([[np.inf, 0.0], [0.0, 1.0]])}, "stiffness must be finite"),
    ],
)
def test_matrices_that_are_no_system_are_refused(changes, words):
    """Shapes that differ and numbers that are none would come back as motion."""
    values = {"mass": np.eye(2), "damping": np.zeros((2, 2)), "stiffness": np.eye(2), **changes}
    with pytest.raises(InputError, match=words):
        LinearSystem(**values)


def test_matrices_are_kept_from_their_giver():
    """A stiffness that is scaled afterwards is not that of the system."""
    stiffness = np.eye(2)
    system = LinearSystem(mass=np.eye(2), damping=np.zeros((2, 2)), stiffness=stiffness)
    stiffness[0, 0] = 7.0
    assert system.stiffness[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        system.stiffness[0, 0] = 2.0


@pytest.mark.parametrize("f", [2.0, 8.0, 30.0])
def test_rayleigh_is_what_it_does_to_a_mode(f):
    """phi^T C phi / (2 omega) of unit modal mass: alpha / (2 omega) + beta omega / 2."""
    damping = Rayleigh.through(0.03, 3.0, 20.0)
    w = 2 * np.pi * f
    c = damping.matrix(np.array([[1.0]]), np.array([[w**2]]))[0, 0]
    assert damping.ratios(np.array([w]))[0] == pytest.approx(c / (2.0 * w), rel=1e-12)
    inside = 3.0 < f < 20.0
    assert (damping.ratios(np.array([w]))[0] < 0.03) == inside


def test_heavy_rayleigh_damping_is_doubted_with_its_numbers():
    """beta / 2 x 2 pi 80 = 0.25 of beta = 1 ms; 0.35 ms give 9 % there and are not doubted."""
    (doubt,) = Rayleigh(alpha=0.0, beta=1e-3).doubts()
    assert "3.1 % at 10 Hz" in doubt.message
    assert "25 % at 80 Hz" in doubt.message
    assert Rayleigh(alpha=0.0, beta=3.5e-4).doubts() == ()
    assert ModalRatio(ratio=0.5).doubts() == ByMaterial(other=0.5).doubts() == ()


def test_only_a_sum_of_mass_and_stiffness_is_stepped_directly():
    """One ratio for all modes is no such sum, but for none at all."""
    assert ModalRatio(ratio=0.03).rayleigh is None
    assert ByMaterial(other=0.03).rayleigh is None
    none = ModalRatio(ratio=0.0).rayleigh
    assert (none.alpha, none.beta) == (0.0, 0.0)
    own = Rayleigh(alpha=1.0, beta=0.0)
    assert own.rayleigh is own


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: ModalRatio(ratio=3.0), r"got 3 \(write 3 % as 0.03\)"),
        (lambda: ModalRatio(ratio=np.nan), "must be finite"),
        (lambda: ModalRatio(ratio=-0.01), "must be 0 or more"),
        (lambda: ByMaterial(other=1.0), "damping ratio must be in"),
        (lambda: Rayleigh(alpha=-1.0, beta=0.0), "rayleigh alpha must be 0 or more"),
        (lambda: Rayleigh.through(0.03, 20.0, 3.0), "f_high must be above f_low = 20 Hz"),
        (lambda: Rayleigh.through(3.0, 3.0, 20.0), r"damping ratio must be in \[0, 1\]"),
        (lambda: ExactRecursion(chain(), 0.0), "dt must be greater than 0"),
    ],
)
def test_damping_and_steps_that_cannot_be_are_refused(make, words):
    """A per cent for a ratio is the mistake most often made."""
    with pytest.raises(InputError, match=words):
        make()


def test_kept_modes_come_back_or_not_at_all():
    """Written and read they are the same bits; one changed number is damage."""
    system = chain(8, seed=3)
    mass, stiffness = (sparse.csc_array(m) for m in (system.mass, system.stiffness))
    top = np.sqrt(linalg.eigh(system.stiffness, system.mass, eigvals_only=True)[3])
    modes = natural_modes(mass, stiffness, f_max=float(top / (2 * np.pi)) * 1.01)
    kept = modes_as_arrays(modes)
    back = modes_from_arrays(kept)
    np.testing.assert_array_equal(back.shapes, modes.shapes)
    np.testing.assert_array_equal(back.frequencies, modes.frequencies)
    assert back.f_max == modes.f_max
    for name in ("omega", "shapes", "residuals", "f_max"):
        spoilt = {**kept, name: np.nextafter(kept[name], np.inf)}
        with pytest.raises(ValueError, match="damaged"):
            modes_from_arrays(spoilt)


def test_within_a_block_products_are_by_one_thread():
    """The limits are given back behind it, by an error too."""
    from threadpoolctl import threadpool_info, threadpool_limits

    with threadpool_limits(limits=2):
        before = [pool["num_threads"] for pool in threadpool_info()]
        with repeatable():
            assert {pool["num_threads"] for pool in threadpool_info()} == {1}
        with pytest.raises(RuntimeError), repeatable():
            raise RuntimeError
        assert [pool["num_threads"] for pool in threadpool_info()][: len(before)] == before
