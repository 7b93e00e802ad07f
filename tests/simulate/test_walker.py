"""Walkers: a moving harmonic force in closed form, guides' harmonics, what is random of people."""

import numpy as np
import pytest

from models import simple_beam, small_floor
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.footfall import FootfallLoad, Harmonic, footfall_load
from trundle.route import Route
from trundle.simulate import Coupled, Decoupled, Modal, coverage_of, ensemble
from trundle.simulate.sources.walker import Gait, StandsAt, Walker

LENGTH, LINE_MASS, NATURAL, ZETA = 30.0, 500.0, 5.0, 0.05
STEADY = Gait(pace=2.0, weight=750.0, random_phase=False)
ONE = FootfallLoad(
    name="one", title="one harmonic", source="made up", confidence="none", weight=750.0,
    paces=(1.0, 3.0), harmonics=(Harmonic(number=1, f_from=1.0, f_to=9.0, constant=0.4),),
)  # fmt: skip
DECOUPLED = Decoupled(
    integration=Modal(f_max=15.0, dt=0.004, residual=False), damping=ModalRatio(ratio=ZETA)
)


@pytest.fixture(scope="module")
def beam():
    rigidity = LINE_MASS * (2.0 * np.pi * NATURAL) ** 2 * (LENGTH / np.pi) ** 4
    return simple_beam(length=LENGTH, rigidity=rigidity, line_mass=LINE_MASS, n_elements=60)


def along(length=LENGTH, speed=1.5):
    return Route.straight((0.0, 0.0), (length, 0.0), speed=speed)


@pytest.mark.parametrize("pace", [1.6, 4.9])
def test_a_moving_harmonic_force_is_the_closed_form(beam, pace):
    """``A cos(W t) sin(pi v t / L)`` is two tones ``W +- pi v / L``; each is answered steadily.

    Times are far from where the force comes on, so that what that set off has died away
    (exp(-0.05 x 31 x 5) = 4e-4); the pace of 4.9 Hz puts a tone on the mode of 5 Hz.
    """
    gait = Gait(pace=pace, weight=750.0, random_phase=False)
    walker = Walker(name="guard", load=ONE, gait=gait, where=along())
    method = Decoupled(
        integration=Modal(f_max=10.0, dt=0.004, residual=False), damping=ModalRatio(ratio=ZETA)
    )
    runs = ensemble(
        beam, walker, method=method, points={"mid": (15.0, 0.0)}, n_runs=1, seed=0, duration=20.0
    )
    some = (runs.time > 6.0) & (runs.time < 18.5)
    t = runs.time[some]
    natural, wave = 2 * np.pi * NATURAL, np.pi * 1.5 / LENGTH
    velocity = np.zeros(len(t))
    # cos a sin b = (sin(a + b) - sin(a - b)) / 2, of a mode of mass m L / 2
    for sign in (1.0, -1.0):
        w = 2 * np.pi * pace + sign * wave
        gain = 1.0 / (natural**2 - w**2 + 2j * ZETA * natural * w) / (0.5 * LINE_MASS * LENGTH)
        tone = -0.5 * sign * 0.4 * 750.0 * gain * 1j * w * np.exp(1j * w * t)
        velocity += np.imag(tone)
    # a mesh of 0.5 m carries the first mode; the second, at 20 Hz, is left out
    error = np.abs(runs.velocity[0, some, 0] - velocity).max()
    assert error < 0.01 * np.abs(velocity).max()


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
def test_on_the_spot_every_harmonic_has_its_guides_amplitude(kind):
    """The lines of the contact force over whole periods are alpha_h W, to the top band."""
    method = kind(integration=Modal(f_max=30.0, dt=0.004), damping=ModalRatio(ratio=0.05))
    load = footfall_load("p354")
    walker = Walker(name="w", load=load, gait=STEADY, where=StandsAt(x=6.0, y=3.0, lasts=12.0))
    runs = ensemble(
        small_floor(), walker, method=method, points={"tool": (8.0, 4.0)}, n_runs=1, seed=0,
        duration=12.0,
    )  # fmt: skip
    some = slice(500, 2500)  # eight seconds of sixteen steps
    lines = 2.0 * np.abs(np.fft.rfft(runs.contact_forces[0, some, 0])) / 2000
    harmonics = lines[16 * np.arange(1, 45)]
    np.testing.assert_allclose(harmonics, load.amplitudes(2.0, 44, weight=750.0), rtol=1e-6)


def test_several_people_are_single_ones_later(beam):
    """Superposition: three with 1.25 s between them equal one, put off and added up."""
    points, settings = {"mid": (15.0, 0.0)}, {"n_runs": 1, "seed": 0, "duration": 26.0}
    one = Walker(name="w", load=ONE, gait=STEADY, where=along())
    many = Walker(name="w", load=ONE, gait=STEADY, where=along(), people=3, headway=1.25)
    assert many.leaves == pytest.approx(20.0 + 2.5)
    alone, together = (
        ensemble(beam, w, method=DECOUPLED, points=points, **settings).velocity[0, :, 0]
        for w in (one, many)
    )
    late = round(1.25 / 0.004)
    summed = sum(np.concatenate([np.zeros(k), alone[: len(alone) - k]]) for k in (0, 312, 625))
    assert late == 312  # 1.25 s are 312.5 steps: the second is half a step off
    assert np.abs(together - summed).max() < 0.05 * np.abs(together).max()
    exact = Walker(name="w", load=ONE, gait=STEADY, where=along(), people=3, headway=1.2)
    together = ensemble(beam, exact, method=DECOUPLED, points=points, **settings).velocity[0, :, 0]
    summed = sum(np.concatenate([np.zeros(k), alone[: len(alone) - k]]) for k in (0, 300, 600))
    np.testing.assert_allclose(together, summed, atol=1e-6 * np.abs(together).max())


def forces_of(walker, runs=40, dt=0.01):
    time = dt * np.arange(0.0, 3000.0)
    inputs = walker.inputs(time, 0.0, 7)
    return np.stack([inputs.draw(run)[0] for run in range(runs)])


def test_people_differ_as_they_are_told_to():
    """Paces by the line of the first harmonic, weights by its height: spreads of 5 and 15 %.

    With 400 people a standard deviation scatters by 3.5 %, a mean by a twentieth of it.
    """
    gait = Gait(pace=2.0, weight=750.0, pace_spread=0.05, weight_spread=0.15)
    walker = Walker(name="w", load=ONE, gait=gait, where=StandsAt(x=0.0, y=0.0, lasts=30.0))
    forces = forces_of(walker, runs=400)[:, :, 0] * np.hanning(3000)
    lines = np.abs(np.fft.rfft(forces, 16 * 3000, axis=1))
    paces = lines.argmax(axis=1) / (16 * 30.0)
    heights = lines.max(axis=1)
    assert paces.mean() == pytest.approx(2.0, rel=0.01)
    assert paces.std() == pytest.approx(0.1, rel=0.15)
    assert heights.std() / heights.mean() == pytest.approx(0.15, rel=0.15)


def test_uneven_steps_spread_the_lines_of_high_harmonics():
    """With 3 % from step to step the tenth harmonic is no line: its height falls, its power stays."""
    load = footfall_load("ccip-016")
    even, uneven = (
        Walker(
            name="w", load=load, where=StandsAt(x=0.0, y=0.0, lasts=30.0),
            gait=Gait(pace=2.0, weight=746.0, step_scatter=s, random_phase=False),
        )
        for s in (0.0, 0.03)
    )  # fmt: skip
    a, b = (np.abs(np.fft.rfft(forces_of(w, runs=20)[:, :, 0], axis=1)) for w in (even, uneven))
    band = slice(round(30 * 15.0), round(30 * 25.0))
    assert (b[:, band].max(axis=1) < 0.7 * a[0, band].max()).all()
    assert np.mean(b[:, band] ** 2) == pytest.approx(np.mean(a[0, band] ** 2), rel=0.25)


def test_phases_are_random_unless_they_are_not():
    """Same seed, same bits; another run, another phase; the mean of a random one is nothing."""
    free = Walker(name="w", load=ONE, gait=Gait(pace=2.0, weight=750.0), where=along())
    first, second = forces_of(free, runs=2), forces_of(free, runs=2)
    np.testing.assert_array_equal(first, second)
    assert not np.allclose(first[0], first[1])
    time = 0.01 * np.arange(0.0, 3000.0)
    assert not free.inputs(time, 0.0, 7).still()[0].any()
    held = Walker(name="w", load=ONE, gait=STEADY, where=along())
    np.testing.assert_array_equal(*forces_of(held, runs=2))
    assert held.inputs(time, 0.0, 7).still()[0].any()


def test_a_guide_without_impulses_excites_no_more_than_its_harmonics():
    """ISO 10137 ends at the fifth; P354 goes on to the top band by its effective impulse."""
    iso, p354 = (
        Walker(name="w", load=footfall_load(name), gait=STEADY, where=along())
        for name in ("iso-10137", "p354")
    )
    assert coverage_of([iso], 30.0).excited_to == pytest.approx(10.0)
    assert coverage_of([p354], 30.0).excites(np.array([79.4])).all()
    # what a walker puts in is not all that there is of him: he bounds a truck's reach
    assert coverage_of([iso, p354], 30.0).excited_to == pytest.approx(10.0)


def test_what_nobody_walks_is_refused():
    """Paces, people, steps that are too long for the guide's harmonics."""
    with pytest.raises(InputError, match="pace must be in"):
        Gait(pace=12.0, weight=750.0)
    with pytest.raises(InputError, match="people"):
        Walker(name="w", load=ONE, gait=STEADY, where=along(), people=0)
    slow = Decoupled(integration=Modal(f_max=15.0, dt=0.08), damping=ModalRatio(ratio=0.05))
    walker = Walker(name="w", load=footfall_load("p354"), gait=STEADY, where=along(10.0))
    with pytest.raises(InputError, match="shorten dt"):
        ensemble(small_floor(), walker, method=slow, points={"p": (8.0, 4.0)}, n_runs=1, seed=0)
