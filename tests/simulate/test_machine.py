"""Machines on a beam whose first mode alone is kept: closed forms, and an integrator of its own."""

import numpy as np
import pytest
from scipy import integrate

from models import simple_beam, small_floor
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.machine import Harmonics, RunUp, Strokes, Unbalance
from trundle.signals import Isolator, mid_band_frequencies
from trundle.simulate import Coupled, Decoupled, Modal, coverage_of, ensemble
from trundle.simulate.sources.machine import Machine

LENGTH, LINE_MASS, NATURAL, ZETA = 10.0, 500.0, 5.0, 0.05
MODAL_MASS = 0.5 * LINE_MASS * LENGTH  # of a mode sin(pi x / L), which is 1 at midspan


@pytest.fixture(scope="module")
def beam():
    rigidity = LINE_MASS * (2.0 * np.pi * NATURAL) ** 2 * (LENGTH / np.pi) ** 4
    return simple_beam(length=LENGTH, rigidity=rigidity, line_mass=LINE_MASS, n_elements=20)


def at_midspan(beam, machine, *, kind=Decoupled, dt=0.004, duration=20.0, runs=1):
    """Run the first mode alone, read where the machine stands."""
    method = kind(
        integration=Modal(f_max=15.0, dt=dt, residual=False), damping=ModalRatio(ratio=ZETA)
    )
    return ensemble(
        beam, machine, method=method, points={"mid": (5.0, 0.0)}, n_runs=runs, seed=4,
        duration=duration,
    )  # fmt: skip


def standing(force, **more):
    return Machine(name="fan", feet=np.array([[5.0, 0.0]]), force=force, **more)


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
@pytest.mark.parametrize("ratio", [0.5, 0.9, 1.0, 1.1, 2.0])
def test_a_rotor_at_and_beside_resonance_is_the_closed_form(beam, kind, ratio):
    """``x = (m e / M) r^2 / |1 - r^2 + 2 i zeta r|`` (the unbalance curve), so ``a = w^2 x``."""
    rotor = Unbalance(mass_radius=0.2, frequency=ratio * NATURAL)
    runs = at_midspan(beam, standing(rotor), kind=kind)
    late = runs.acceleration[0, runs.time > 12.0, 0]
    curve = ratio**2 / abs(1.0 - ratio**2 + 2j * ZETA * ratio)
    expected = 0.2 / MODAL_MASS * curve * (2.0 * np.pi * rotor.frequency) ** 2
    assert np.abs(late).max() == pytest.approx(expected, rel=0.01)


def test_a_balance_grade_is_a_speed_of_the_centre_of_mass():
    """G 6.3: e omega = 6.3 mm/s; 100 kg at 25 turns a second press with m omega (e omega)."""
    rotor = Unbalance.of_grade(grade=6.3e-3, rotor_mass=100.0, frequency=25.0)
    assert rotor.amplitude == pytest.approx(100.0 * 2 * np.pi * 25.0 * 6.3e-3, rel=1e-12)


def test_a_run_up_through_resonance_is_the_mode_integrated_by_another_method(beam):
    """Runge-Kutta on ``M x'' + c x' + k x = -F``; the largest motion comes after the resonance."""
    force = RunUp(f_from=1.0, f_to=9.0, takes=8.0, mass_radius=0.2)
    machine = standing(force, random_phase=False)
    runs = at_midspan(beam, machine, duration=14.0)
    omega = 2.0 * np.pi * NATURAL

    def rate(t, state):
        on = 0.5 - 0.5 * np.cos(np.pi * min(t, 1.0))
        angle = 2 * np.pi * (t + 0.5 * t * t if t < 8.0 else 40.0 + 9.0 * (t - 8.0))
        speed = 2 * np.pi * min(1.0 + t, 9.0)
        pushed = -0.2 * speed**2 * np.cos(angle) * on / MODAL_MASS
        return [state[1], pushed - 2 * ZETA * omega * state[1] - omega**2 * state[0]]

    solved = integrate.solve_ivp(
        rate, (0.0, 14.0), [0.0, 0.0], t_eval=runs.time, rtol=1e-9, atol=1e-14
    )
    expected = solved.y[1]
    assert np.abs(runs.velocity[0, :, 0] - expected).max() < 0.01 * np.abs(expected).max()
    assert runs.time[np.abs(expected).argmax()] > 4.0  # it passes 5 Hz at 4 s


def test_a_steady_amplitude_does_not_grow_with_speed():
    """A sweep of a shaker keeps its amplitude; a rotor's force grows with the speed squared."""
    time = np.arange(0.0, 10.0, 1e-3)
    shaker = RunUp(f_from=2.0, f_to=20.0, takes=10.0, amplitude=50.0).at(time, 0.0)
    assert np.abs(shaker[:2000]).max() == pytest.approx(50.0, rel=1e-3)
    assert np.abs(shaker[-2000:]).max() == pytest.approx(50.0, rel=1e-3)


def test_a_run_down_turns_backwards_through_the_same_speeds():
    """The angle gained is the integral of the speed: 2 to 20 Hz over 10 s is 110 turns both ways."""
    up = RunUp(f_from=2.0, f_to=20.0, takes=10.0, amplitude=1.0)
    down = RunUp(f_from=20.0, f_to=2.0, takes=10.0, amplitude=1.0)
    at = np.array([10.0, 10.25])
    assert up.at(at, 0.0) == pytest.approx([1.0, np.cos(2 * np.pi * 5.0)])
    assert down.at(at, 0.0) == pytest.approx([1.0, np.cos(2 * np.pi * 0.5)])


@pytest.mark.parametrize("contact_time", [0.001, 0.01, 0.03])
def test_a_blow_gives_the_mode_its_impulse(beam, contact_time):
    """Short beside the period, a blow J leaves ``v = J / M``, ringing down with the damping.

    A half sine of duration T is a blow of ``cos(w T / 2) / (1 - (w T / pi)^2)`` at frequency w:
    1.2 % less at the longest. The step of 4 ms is longer than the shortest blow.
    """
    blow = Strokes(impulse=100.0, contact_time=contact_time, first=1.0)
    runs = at_midspan(beam, standing(blow, random_phase=False), duration=6.0)
    omega = 2.0 * np.pi * NATURAL
    x = omega * contact_time / np.pi
    less = np.cos(0.5 * omega * contact_time) / (1.0 - x**2)
    since = runs.time - 1.0 - 0.5 * contact_time
    damped = omega * np.sqrt(1.0 - ZETA**2)
    free = np.exp(-ZETA * omega * since) * (
        np.cos(damped * since) - ZETA * omega / damped * np.sin(damped * since)
    )
    after = since > 0.1
    np.testing.assert_allclose(
        runs.velocity[0, after, 0], -100.0 / MODAL_MASS * less * free[after],
        atol=0.01 * 100.0 / MODAL_MASS,
    )  # fmt: skip


@pytest.mark.parametrize("dt", [0.001, 0.005, 0.02])
def test_blows_keep_impulse_and_time_whatever_the_step(dt):
    """Two blows, a step longer than a blow among the steps: their sum, and where they are."""
    time = np.arange(-3.0, 14.0, dt)
    blows = Strokes(impulse=30.0, contact_time=0.008, every=10.0, first=0.1)
    force = blows.at(time, 0.0)
    assert force.sum() * dt == pytest.approx(2 * 30.0, rel=1e-4)
    assert (force * time).sum() * dt == pytest.approx(30.0 * (0.104 + 10.104), rel=1e-3)


@pytest.mark.parametrize("contact_time", [0.0005, 0.006, 0.02])
def test_samples_hold_the_spectrum_of_a_blow(contact_time):
    """``J cos(pi f T) / (1 - (2 f T)^2)`` at 10, 40 and 80 Hz, by steps of 5 ms: 0.2 % of J."""
    blow = Strokes(impulse=2.0, contact_time=contact_time, first=2.0013)
    time = 0.005 * np.arange(1000.0)
    force = blow.at(time, 0.0)
    for f in (10.0, 40.0, 80.0):
        there = abs(np.sum(force * np.exp(-2j * np.pi * f * time)) * 0.005)
        x = f * contact_time
        assert there == pytest.approx(abs(2.0 * np.cos(np.pi * x) / (1.0 - 4.0 * x**2)), abs=0.004)


def test_mounts_pass_on_what_the_transmissibility_says(beam):
    """On mounts of 10 Hz with 5 %, a rotor of 20 Hz passes on ``|1 + 2 i z r| / |1 - r^2 + ..|``."""
    force = Harmonics(frequencies=[20.0], amplitudes=[100.0], phases=[0.0])
    machine = standing(force, mounts=Isolator(frequency=10.0, damping_ratio=0.05))
    runs = at_midspan(beam, machine, dt=0.002, duration=12.0)
    passed = np.abs(runs.contact_forces[0, runs.time > 8.0, 0]).max()
    r = 2.0
    assert passed == pytest.approx(
        100.0 * abs((1 + 2j * 0.05 * r) / (1 - r**2 + 2j * 0.05 * r)), rel=0.01
    )


@pytest.mark.parametrize("frequency", [40.0, 63.0, 80.0])
def test_at_the_default_step_the_top_bands_are_right(beam, frequency):
    """Beside a mode of 80 Hz (the fourth: 16 times 5 Hz), steps of 5 ms: within 1.5 %.

    The force stands at an eighth of the span, where that mode is 1; modes 1 to 5 answer, each by
    its closed form.
    """
    rotor = Harmonics(frequencies=[frequency], amplitudes=[100.0], phases=[0.0])
    machine = Machine(name="m", feet=np.array([[1.25, 0.0]]), force=rotor, random_phase=False)
    method = Decoupled(
        integration=Modal(f_max=150.0, dt=0.005, residual=False), damping=ModalRatio(ratio=ZETA)
    )
    runs = ensemble(
        beam, machine, method=method, points={"p": (1.25, 0.0)}, n_runs=1, seed=0, duration=12.0
    )
    late = runs.velocity[0, runs.time >= 8.0, 0][:800]  # 4 s: whole periods of each
    i = np.arange(1, 6)
    w, wi = 2 * np.pi * frequency, 2 * np.pi * NATURAL * i**2
    shape = np.sin(np.pi * i * 1.25 / LENGTH)
    gain = np.sum(shape**2 / MODAL_MASS / (wi**2 - w**2 + 2j * ZETA * wi * w))
    assert np.sqrt(2.0 * np.mean(late**2)) == pytest.approx(100.0 * w * abs(gain), rel=0.015)


def test_feet_share_the_force_and_the_phase_is_the_runs_own(beam):
    """Two feet press half each; other runs have other phases, the same seed the same bits."""
    rotor = Unbalance(mass_radius=0.1, frequency=4.0)
    machine = Machine(name="fan", feet=np.array([[4.0, 0.0], [6.0, 0.0]]), force=rotor)
    first, again = (at_midspan(beam, machine, duration=4.0, runs=2) for _ in range(2))
    np.testing.assert_array_equal(first.contact_forces, again.contact_forces)
    np.testing.assert_allclose(first.contact_forces[..., 0], first.contact_forces[..., 1])
    assert np.abs(first.contact_forces[0, :, 0]).max() == pytest.approx(
        0.5 * rotor.amplitude, rel=0.01
    )
    assert not np.allclose(first.contact_forces[0], first.contact_forces[1])


def test_what_a_machine_excites_bounds_nobody_elses_reach():
    """Its force is known in every band; alone it excites none above its own."""
    fan = standing(Unbalance(mass_radius=0.1, frequency=25.0))
    pump = standing(Unbalance(mass_radius=0.1, frequency=40.0))
    assert coverage_of([fan, pump], 20.0).excited_to == 40.0
    reach = coverage_of([fan], 20.0)
    assert (reach.excited_to, reach.by) == (25.0, "forces")
    assert "forces that are given end at 25 Hz" in reach.reasons(waves=True)[0]
    # the band that holds its line is excited, those wholly above are not
    bands = mid_band_frequencies()
    assert bands[reach.excites(bands)].max() == pytest.approx(10**1.4)


def test_what_cannot_be_is_refused():
    """Aliases, blows that overlap, two forces in one, no feet."""
    with pytest.raises(InputError, match="shorten dt to 4"):
        at_midspan(
            small_floor(mesh_size=3.0), standing(Unbalance(mass_radius=1.0, frequency=90.0)),
            dt=0.01,
        )  # fmt: skip
    with pytest.raises(InputError, match="cannot follow each other"):
        Strokes(impulse=1.0, contact_time=0.1, every=0.05)
    with pytest.raises(InputError, match="one of them"):
        RunUp(f_from=1.0, f_to=2.0, takes=1.0, amplitude=1.0, mass_radius=1.0)
    with pytest.raises(InputError, match="at least one foot"):
        Machine(name="m", feet=np.zeros((0, 2)), force=Unbalance(mass_radius=1.0, frequency=1.0))
