"""Forces of machines against time itself: turns counted, impulses kept, phases that are turns."""

import numpy as np
import pytest
from scipy import integrate

from trundle.errors import InputError
from trundle.machine import Harmonics, MachineForce, RunUp, Strokes, Unbalance

DT = 0.002
TIME = DT * np.arange(3000)


def test_a_turn_of_the_slowest_is_its_phase():
    """Invariant: a phase of p turns is the same force p periods of the lowest frequency later."""
    fan = Harmonics(
        frequencies=np.array([25.0, 10.0, 31.0]), amplitudes=np.array([3.0, 8.0, 1.5]),
        phases=np.array([0.4, -1.0, 2.0]),
    )  # fmt: skip
    for phase in (0.25, 0.9, 1.0):
        np.testing.assert_allclose(fan.at(TIME, phase), fan.at(TIME + phase / 10.0, 0.0), atol=1e-9)
    assert np.abs(fan.at(TIME, 0.0)).max() <= 12.5
    first = 3.0 * np.cos(0.4) + 8.0 * np.cos(-1.0) + 1.5 * np.cos(2.0)
    assert fan.at(TIME, 0.0)[0] == pytest.approx(first, rel=1e-12)
    assert (fan.reaches, fan.shows) == (31.0, 31.0)


def test_harmonics_have_the_power_of_their_cosines():
    """Over whole periods: the mean square is half the sum of squares of the amplitudes."""
    fan = Harmonics(
        frequencies=np.array([10.0, 25.0]), amplitudes=np.array([3.0, -4.0]), phases=np.zeros(2)
    )
    time = np.arange(2000) * 1e-4  # two periods of 10 Hz, five of 25 Hz
    assert np.mean(fan.at(time, 0.3) ** 2) == pytest.approx(0.5 * 25.0, rel=1e-9)


def test_a_rotor_presses_with_its_unbalance_times_omega_squared():
    """0.02 kg m at 50 turns a second: 0.02 (100 pi)^2 N; a quarter turn later it is nought."""
    rotor = Unbalance(mass_radius=0.02, frequency=50.0)
    assert rotor.amplitude == pytest.approx(0.02 * (100.0 * np.pi) ** 2, rel=1e-12)
    assert rotor.at(np.zeros(1), 0.0)[0] == pytest.approx(rotor.amplitude)
    assert abs(rotor.at(np.zeros(1), 0.25)[0]) < 1e-9 * rotor.amplitude
    assert rotor.at(np.array([0.01]), 0.0)[0] == pytest.approx(-rotor.amplitude)  # half a turn
    assert rotor.at(np.array([0.01]), 0.5)[0] == pytest.approx(rotor.amplitude)  # and half more


@pytest.mark.parametrize(("f_from", "f_to"), [(0.0, 20.0), (24.0, 3.0)])
def test_a_run_up_turns_as_often_as_its_speed_adds_up_to(f_from, f_to):
    """The angle is the integral of the speed, by quadrature; behind it the speed stays."""
    run = RunUp(f_from=f_from, f_to=f_to, takes=2.5, amplitude=70.0)
    for t in (0.3, 1.7, 2.5, 4.0):
        turns, _ = integrate.quad(lambda s: float(run.speed(np.array([s]))[0]), 0.0, t,
                                  points=[2.5])  # fmt: skip
        expected = 70.0 * np.cos(2.0 * np.pi * (turns + 0.15))
        assert run.at(np.array([t]), 0.15)[0] == pytest.approx(expected, abs=1e-6)
    assert run.speed(np.array([0.0, 1.25, 9.0])).tolist() == [f_from, (f_from + f_to) / 2, f_to]
    assert run.reaches == max(f_from, f_to)


def test_the_force_of_a_run_up_grows_with_its_speed_squared():
    """At a quarter, a half and the whole of 16 turns a second: a 16th, a quarter, all of it."""
    run = RunUp(f_from=0.0, f_to=16.0, takes=4.0, mass_radius=0.5)
    full = 0.5 * (2.0 * np.pi * 16.0) ** 2
    for t, share in ((1.0, 1 / 16), (2.0, 1 / 4), (6.0, 1.0)):
        near = t + np.arange(0.0, 0.25, 1e-4) - 0.125
        about = np.abs(run.at(near, 0.0)).max()
        # within an eighth of a second the speed grows by a half at most: the top lies between
        slower, faster = np.clip((t + np.array([-0.125, 0.125])) / 4.0, 0.0, 1.0) ** 2
        assert slower * full <= about <= faster * full * (1.0 + 1e-9)
        assert slower <= share <= faster


@pytest.mark.parametrize("contact_time", [0.0004, 0.01, 0.3])
def test_a_blow_keeps_its_impulse_and_its_middle_wherever_it_falls(contact_time):
    """Zeroth and first moment: the sum over steps is the impulse, its middle half a contact later.

    A blow far shorter than a step, of a few steps, and of many, between steps at that.
    """
    blow = Strokes(impulse=-12.0, contact_time=contact_time, first=2.00071)
    force = blow.at(TIME, 0.7)
    assert force.sum() * DT == pytest.approx(-12.0, rel=1e-4)
    middle = (force @ TIME) * DT / -12.0
    assert middle == pytest.approx(2.00071 + 0.5 * contact_time, abs=2e-5)
    np.testing.assert_array_equal(blow.at(TIME, 0.2), force)  # a single blow is when it is said


def test_a_long_blow_is_half_a_sine():
    """Contact of 150 steps: ``pi I / 2 T sin(pi (t - t0) / T)`` to half a percent of its top."""
    blow = Strokes(impulse=30.0, contact_time=0.3, first=1.0)
    top = np.pi * 30.0 / (2.0 * 0.3)
    since = TIME - 1.0
    expected = np.where((since >= 0) & (since <= 0.3), top * np.sin(np.pi * since / 0.3), 0.0)
    np.testing.assert_allclose(blow.at(TIME, 0.0), expected, atol=0.005 * top)


def test_blows_follow_each_other_and_are_put_off_by_their_phase():
    """Every 0.5 s from 0.2 s on, put off by 0.3 of a period: at 0.35, 0.85, 1.35 s ..., 12 in 6 s."""
    press = Strokes(impulse=5.0, contact_time=0.02, every=0.5, first=0.2)
    force = press.at(TIME, 0.3)
    assert force.sum() * DT == pytest.approx(12 * 5.0, rel=1e-3)
    tops = TIME[np.flatnonzero(force > 0.9 * force.max())]
    expected = 0.36 + 0.5 * np.arange(12)
    assert np.abs(tops[:, None] - expected).min(axis=1).max() < 0.01
    assert np.abs(expected[:, None] - tops).min(axis=1).max() < 0.01
    assert press.shows == pytest.approx(1.6)
    assert press.reaches == pytest.approx(75.0)


def test_steps_that_begin_later_hold_the_same_blows():
    """Invariant: the force at a time does not depend on when the steps begin."""
    press = Strokes(impulse=5.0, contact_time=0.003, every=0.31, first=0.2)
    whole = press.at(TIME, 0.4)
    np.testing.assert_allclose(press.at(TIME[700:2100], 0.4), whole[700:2100], atol=1e-9)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Strokes(impulse=1.0, contact_time=0.1, every=0.1), "cannot follow each other"),
        (lambda: Strokes(impulse=1.0, contact_time=0.1, every=np.nan), "cannot follow each other"),
        (lambda: Strokes(impulse=np.inf, contact_time=0.1), "impulse must be finite"),
        (lambda: Strokes(impulse=1.0, contact_time=0.1, first=-1.0), "first must be 0 or more"),
        (lambda: RunUp(f_from=1.0, f_to=9.0, takes=1.0), "an unbalance or an amplitude, one of"),
        (lambda: RunUp(f_from=9.0, f_to=9.0, takes=1.0, amplitude=1.0), "from one speed to another"),
        (lambda: RunUp(f_from=1.0, f_to=9.0, takes=0.0, amplitude=1.0), "takes must be greater"),
        (lambda: Unbalance(mass_radius=0.0, frequency=1.0), "mass_radius must be greater than 0"),
        (lambda: Unbalance.of_grade(grade=0.0063, rotor_mass=-1.0, frequency=25.0), "rotor_mass"),
        (lambda: Harmonics(frequencies=np.zeros(0), amplitudes=np.zeros(0), phases=np.zeros(0)),
         "must be greater than 0"),
        (lambda: Harmonics(frequencies=np.array([5.0, 0.0]), amplitudes=np.ones(2),
                           phases=np.ones(2)), "must be greater than 0"),
        (lambda: Harmonics(frequencies=np.array([5.0]), amplitudes=np.array([np.nan]),
                           phases=np.zeros(1)), r"amplitudes must be finite; element \(0,\)"),
    ],
)  # fmt: skip
def test_forces_that_cannot_be_are_refused(make, said):
    """Blows that overlap, rotors that do not turn, numbers that are none: by their names."""
    with pytest.raises(InputError, match=said):
        make()


def test_all_kinds_are_forces_of_machines():
    """A simulation asks how far they reach, what a step must show, and whether they are sudden."""
    kinds = [
        Harmonics(frequencies=np.ones(1), amplitudes=np.ones(1), phases=np.ones(1)),
        Unbalance(mass_radius=1.0, frequency=1.0),
        RunUp(f_from=0.0, f_to=1.0, takes=1.0, amplitude=1.0),
        Strokes(impulse=1.0, contact_time=0.5),
    ]
    assert all(isinstance(kind, MachineForce) for kind in kinds)
    assert [kind.sudden for kind in kinds] == [False, False, False, True]
    assert kinds[-1].shows == 0.0  # a single blow has no period
