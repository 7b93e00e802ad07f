"""Integrators against closed forms and their theoretical orders."""

import numpy as np
import pytest

from trundle.dynamics import (
    ExactRecursion,
    LinearSystem,
    ModalRatio,
    ModalRecursion,
    NewmarkPropagator,
    Rayleigh,
)
from trundle.errors import InputError
from trundle.simulate import Newmark


def oscillator(omega: float, ratio: float = 0.0) -> LinearSystem:
    return LinearSystem(
        mass=np.eye(1), damping=2 * ratio * omega * np.eye(1), stiffness=omega**2 * np.eye(1)
    )


def march(propagator, forces, displacement=0.0):
    state = propagator.start(np.full((1, 1), displacement))
    out = [state]
    for force in forces:
        load = np.full((1, 1), force)
        motion = propagator.predict(state, load)
        state = propagator.finish(state, motion, load)
        out.append(state)
    return np.array([float(s.displacement[0, 0]) for s in out]), out


def recur(recursion, forces, state):
    """March a single degree of freedom by its exact recursion from a state without force."""
    phi, start, end = (
        np.reshape(a, shape)
        for a, shape in (
            (recursion.phi, (2, 2)), (recursion.from_start, 2), (recursion.from_end, 2)
        )
    )  # fmt: skip
    states, before = [np.asarray(state, float)], 0.0
    for force in forces:
        states.append(phi @ states[-1] + start * before + end * force)
        before = force
    return np.array(states)


@pytest.mark.parametrize("f", [3.75, 10.0])
def test_newmark_stretches_the_period_as_theory_says(f):
    """Average acceleration keeps energy and has omega_num = (2/dt) atan(omega dt / 2)."""
    dt, omega = 0.025, 2 * np.pi * f
    system = oscillator(omega)
    propagator = NewmarkPropagator(system, Newmark(dt=dt))
    u, _ = march(propagator, np.zeros(4000), displacement=1.0)
    omega_numerical = 2.0 / dt * np.arctan(0.5 * omega * dt)
    # a free vibration satisfies u[n+1] - 2 cos(omega_num dt) u[n] + u[n-1] = 0 exactly
    residual = u[4:] - 2 * np.cos(omega_numerical * dt) * u[3:-1] + u[2:-2]
    assert np.abs(residual).max() < 1e-10 * np.abs(u).max()


def test_newmark_is_second_order():
    """Halving the step quarters the error against the damped closed form under a ramp."""
    omega, ratio = 10.0, 0.05
    system = oscillator(omega, ratio)
    exact = ramp_response(omega, ratio, 1.0)
    errors = []
    for dt in (0.02, 0.01, 0.005):
        times = dt * np.arange(1, round(1.0 / dt) + 1)
        u, _ = march(NewmarkPropagator(system, Newmark(dt=dt)), times)
        errors.append(abs(u[-1] - exact))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.1)


def ramp_response(omega: float, ratio: float, time: float) -> float:
    """Return u(t) of u'' + 2 zeta w u' + w^2 u = t from rest, in closed form."""
    wd = omega * np.sqrt(1 - ratio**2)
    a = -2 * ratio / omega**3
    decay = np.exp(-ratio * omega * time)
    b = -(1 / omega**2 + ratio * omega * a) / wd
    return time / omega**2 + a + decay * (-a * np.cos(wd * time) + b * np.sin(wd * time))


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.9])
@pytest.mark.parametrize("dt", [0.01, 0.1, 0.5])
def test_exact_steps_have_no_error_under_a_ramp(ratio, dt):
    """A linear force is what the recursion is exact for, at any step."""
    omega = 10.0
    n = round(1.0 / dt)
    for recursion in (
        ExactRecursion(oscillator(omega, ratio), dt),
        ModalRecursion(np.array([omega]), np.array([ratio]), dt),
    ):
        states = recur(recursion, dt * np.arange(1, n + 1), [0.0, 0.0])
        assert states[-1, 0] == pytest.approx(ramp_response(omega, ratio, n * dt), rel=1e-10)


def test_exact_steps_carry_a_free_mass():
    """A mass without a spring under a ramp of force moves as t^3 / 6."""
    system = LinearSystem(mass=np.eye(1), damping=np.zeros((1, 1)), stiffness=np.zeros((1, 1)))
    states = recur(ExactRecursion(system, 0.1), 0.1 * np.arange(1, 11), [0.0, 0.0])
    assert states[-1, 0] == pytest.approx(1.0 / 6.0, rel=1e-12)


def test_exact_steps_of_an_overdamped_mode_decay():
    """Rayleigh damping overdamps high modes: the slow root is the smaller of the quadratic's."""
    omega, ratio, dt = 100.0, 2.0, 0.01
    recursion = ModalRecursion(np.array([omega]), np.array([ratio]), dt)
    states = recur(recursion, np.zeros(50), [1.0, 0.0])
    slow = omega * (ratio - np.sqrt(ratio**2 - 1))
    assert states[-1, 0] / states[-2, 0] == pytest.approx(np.exp(-slow * dt), rel=1e-9)


def test_respond_is_the_difference_that_a_force_makes():
    """predict with a force = predict without it + respond: what the contact solver relies on."""
    rng = np.random.default_rng(1)
    root = rng.standard_normal((3, 3))
    system = LinearSystem(
        mass=np.eye(3) + 0.1 * root @ root.T, damping=0.3 * np.eye(3), stiffness=root @ root.T * 40
    )
    force = rng.standard_normal((3, 2))
    propagator = NewmarkPropagator(system, Newmark(dt=0.05))
    state = propagator.start(rng.standard_normal((3, 2)))
    with_force, without = propagator.predict(state, force), propagator.predict(state)
    change = propagator.respond(force)
    np.testing.assert_allclose(
        with_force.displacement, without.displacement + change.displacement, rtol=1e-10
    )
    np.testing.assert_allclose(
        with_force.velocity, without.velocity + change.velocity, rtol=1e-9, atol=1e-12
    )


def test_newmark_conserves_energy_without_damping():
    """Average acceleration conserves the discrete energy of a free linear system exactly."""
    rng = np.random.default_rng(2)
    root = rng.standard_normal((4, 4))
    stiffness = root @ root.T * 100 + np.eye(4)
    system = LinearSystem(mass=np.eye(4), damping=np.zeros((4, 4)), stiffness=stiffness)
    propagator = NewmarkPropagator(system, Newmark(dt=0.1))
    state = propagator.start(rng.standard_normal((4, 1)))
    state = propagator.finish(state, propagator.predict(state))
    energies = []
    for _ in range(200):
        state = propagator.finish(state, propagator.predict(state))
        u, v = state.displacement, state.velocity
        energies.append(float((v.T @ v + u.T @ stiffness @ u)[0, 0]))
    # from the second step on the motion is free and satisfies the equation of motion
    assert np.ptp(energies) < 1e-9 * energies[0]


def test_rayleigh_through_two_frequencies():
    """The fitted coefficients give the asked ratio at both frequencies."""
    model = Rayleigh.through(0.03, 3.75, 5.80)
    assert model.alpha == pytest.approx(0.8587, rel=1e-3)  # the paper's coefficients
    assert model.beta == pytest.approx(0.001, rel=1e-3)
    assert model.ratios(2 * np.pi * np.array([3.75, 5.8])) == pytest.approx(0.03)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Newmark(dt=0.0),
        lambda: Newmark(dt=0.01, beta=0.1),
        lambda: Newmark(dt=0.01, gamma=0.4),
        lambda: ModalRatio(ratio=3.0),
        lambda: ModalRatio(ratio=-0.1),
        lambda: Rayleigh(alpha=-1.0, beta=0.0),
        lambda: Rayleigh.through(0.03, 5.8, 3.75),
        lambda: LinearSystem(mass=np.eye(2), damping=np.eye(2), stiffness=np.eye(3)),
        lambda: LinearSystem(mass=np.eye(2), damping=np.eye(2), stiffness=np.eye(2) * np.nan),
    ],
)
def test_bad_numbers_are_refused(make):
    with pytest.raises(InputError, match=r"must|shape"):
        make()


def test_rayleigh_steps_need_no_product_with_the_stiffness():
    """The short form of a step is the long one: equal to round-off over 50 steps under a force."""
    rng = np.random.default_rng(6)
    root = rng.standard_normal((5, 5))
    mass, stiffness = np.eye(5) + 0.1 * root @ root.T, 300 * root @ root.T + 50 * np.eye(5)
    damping = Rayleigh(alpha=0.7, beta=0.004)
    system = LinearSystem(mass=mass, damping=damping.matrix(mass, stiffness), stiffness=stiffness)
    long = NewmarkPropagator(system, Newmark(dt=0.03))
    short = NewmarkPropagator(system, Newmark(dt=0.03), rayleigh=damping)
    states = [propagator.start(np.zeros((5, 2))) for propagator in (long, short)]
    for _ in range(50):
        force = rng.standard_normal((5, 2))
        states = [
            propagator.finish(state, propagator.predict(state, force))
            for propagator, state in zip((long, short), states, strict=True)
        ]
    for name in ("displacement", "velocity", "acceleration"):
        a, b = (getattr(state, name) for state in states)
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-12 * np.abs(a).max())
