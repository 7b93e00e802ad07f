"""[[machine]]: forces in SI by each way to say them, where they act, and what steps do not show."""

import numpy as np
import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

ROTOR = 'rotor = { speed = "25 Hz", unbalance = "500 g mm" }'
MACHINE = f'\n[[machine]]\nname = "pump"\nat = ["9 m", "4 m"]\n{ROTOR}\n'


def machine(force=ROTOR, more=""):
    return study_from_text(GOOD + MACHINE.replace(ROTOR, force) + more).sources["pump"]


def told(force=ROTOR, more="", study=GOOD):
    with pytest.raises(StudyError) as caught:
        study_from_text(study + MACHINE.replace(ROTOR, force) + more)
    return {p.place: p for p in caught.value.problems}


def test_an_unbalance_presses_with_its_mass_radius_and_its_turns():
    """500 g mm are 5e-4 kg m; at 1500 turns a minute m e omega^2 = 5e-4 (2 pi 25)^2 = 12.337 N."""
    for speed in ("25 Hz", "1500 rpm", "1500 r/min", "1.5e3 1/min"):
        force = machine(f'rotor = {{ speed = "{speed}", unbalance = "0.5 kg mm" }}').force
        assert force.at(np.zeros(1), 0.0)[0] == pytest.approx(5e-4 * (2 * np.pi * 25) ** 2)
        assert force.frequency == pytest.approx(25.0)


def test_a_grade_is_a_speed_of_the_centre_of_mass():
    """ISO 21940-11: G 6.3 of 200 kg at 25 Hz has e = 6.3e-3 / (2 pi 25) m, a force of 198 N."""
    rotor = 'rotor = { speed = "25 Hz", grade = "6.3 mm/s", mass = "0.2 t" }'
    assert machine(rotor).force.amplitude == pytest.approx(200 * 6.3e-3 * 2 * np.pi * 25)


def test_harmonics_are_pairs_of_frequency_and_amplitude():
    """At time 0 and phase 0 all cosines add: 100 N and 20 N."""
    force = machine('harmonics = [["25 Hz", "0.1 kN"], ["3000 rpm", "20 N"]]').force
    np.testing.assert_allclose(force.frequencies, [25.0, 50.0])
    np.testing.assert_allclose(force.amplitudes, [100.0, 20.0])
    assert force.at(np.zeros(1), 0.0)[0] == pytest.approx(120.0)


def test_a_run_up_goes_from_the_one_speed_to_the_other():
    """Half-way from 2 to 20 Hz it turns 11 times a second; a shaker's force stays what it is."""
    force = machine(
        'run_up = { from = "120 rpm", to = "20 Hz", takes = "0.1 min", amplitude = "0.05 kN" }'
    ).force
    assert force.speed(np.array([0.0, 3.0, 6.0, 9.0])) == pytest.approx([2.0, 11.0, 20.0, 20.0])
    assert force.at(np.zeros(1), 0.0)[0] == pytest.approx(50.0)


def test_blows_have_an_impulse_a_time_and_a_first_one():
    """Once a second from 1 s on unless said; a single one comes never again."""
    blows = machine(
        'blows = { impulse = "30 kN ms", contact_time = "20 ms", every = "0.05 min" }'
    ).force
    assert (blows.impulse, blows.contact_time) == (30.0, 0.02)
    assert (blows.every, blows.first) == (pytest.approx(3.0), 1.0)
    single = machine('blows = { impulse = "3 N s", contact_time = "20 ms", first = "0 s" }').force
    assert single.every == np.inf
    # the force over time is the impulse of one blow, whatever steps show of it
    time = 0.005 * np.arange(-100, 400)
    assert single.at(time, 0.0).sum() * 0.005 == pytest.approx(3.0, rel=1e-3)


def test_a_machine_runs_from_the_beginning_for_ever_unless_told_otherwise():
    """And nobody knows where its rotor stands."""
    made = machine()
    assert (made.starts, made.lasts, made.random_phase, made.mounts) == (0.0, np.inf, True, None)
    said = machine(more='starts = "1500 ms"\nlasts = "0.5 min"\nrandom_phase = false\n')
    assert (said.starts, said.lasts, said.random_phase) == (1.5, 30.0, False)
    assert said.leaves == pytest.approx(31.5)


def test_feet_stand_where_they_are_given_in_their_order():
    """x before y, in cm and m; one place is one foot."""
    np.testing.assert_allclose(machine().feet, [[9.0, 4.0]])
    text = GOOD + MACHINE.replace(
        'at = ["9 m", "4 m"]', 'feet = [["900 cm", "4 m"], ["8 m", "3.5 m"]]'
    )
    np.testing.assert_allclose(study_from_text(text).sources["pump"].feet, [[9.0, 4.0], [8.0, 3.5]])
    off = MACHINE.replace('at = ["9 m", "4 m"]', 'feet = [["9 m", "4 m"], ["8 m", "7 m"]]')
    with pytest.raises(StudyError) as caught:
        study_from_text(GOOD + off)
    assert [p.place for p in caught.value.problems] == ["machine[1].feet[2]"]


def test_mounts_pass_on_what_an_isolator_passes():
    """300 turns a minute are 5 Hz; at sqrt(2) times it as much comes out as goes in."""
    made = machine(more='mounts = { frequency = "300 rpm", damping = "4 %" }\n')
    assert np.abs(made.mounts.response(np.array([5.0 * np.sqrt(2.0)]))) == pytest.approx(1.0)
    assert made.mounts.damping_ratio == 0.04


@pytest.mark.parametrize(
    ("force", "place", "words"),
    [
        ("", "machine[1]", "got none"),
        (f'{ROTOR}\nblows = {{ impulse = "1 N s", contact_time = "9 ms" }}', "machine[1]", "got rotor and blows"),
        (f'{ROTOR}\nfeet = [["1 m", "1 m"]]', "machine[1]", "give at or feet"),
        ('rotor = { speed = "25 Hz" }', "machine[1].rotor", "an unbalance, or a grade"),
        ('rotor = { speed = "25 Hz", mass = "9 kg" }', "machine[1].rotor", "an unbalance, or a grade"),
        ('rotor = { speed = "25 Hz", grade = "6.3 mm/s" }', "machine[1].rotor", "an unbalance, or a grade"),
        ('rotor = { speed = "25 Hz", unbalance = "1 g mm", grade = "6.3 mm/s", mass = "9 kg" }', "machine[1].rotor", "an unbalance, or a grade"),
        ('rotor = { speed = "25 Hz", grade = "6.3", mass = "9 kg" }', "machine[1].rotor.grade", "unit is missing"),
        ('rotor = { speed = "157 rad/s", unbalance = "1 g mm" }', "machine[1].rotor.speed", "cycles, not radians"),
        ('rotor = { speed = "25 Hz", unbalance = "0 g mm" }', "machine[1].rotor.unbalance", "greater than 0"),
        ('rotor = { speed = "25 Hz", unbalance = "1 g mm", mass = "9 kg" }', "machine[1].rotor", "an unbalance, or a grade"),
        ("harmonics = []", "machine[1].harmonics", "at least 1"),
        ('harmonics = [["25 Hz", "9 N"], ["50 Hz"]]', "machine[1].harmonics[2][2]", "required"),
        ('harmonics = [["9 N", "25 Hz"]]', "machine[1].harmonics[1][1]", "not one of frequency"),
        ('run_up = { from = "2 Hz", to = "9 Hz", takes = "9 s" }', "machine[1]", "an unbalance or an amplitude"),
        ('run_up = { from = "2 Hz", to = "2 Hz", takes = "9 s", amplitude = "1 N" }', "machine[1]", "from one speed to another"),
        ('run_up = { to = "2 Hz", takes = "9 s", amplitude = "1 N" }', "machine[1].run_up.from", "required"),
        ('blows = { impulse = "1 N s", contact_time = "9 ms", every = "9 ms" }', "machine[1]", "cannot follow each other"),
        ('blows = { impulse = "0 N s", contact_time = "9 ms" }', "machine[1].blows.impulse", "greater than 0"),
        (f'{ROTOR}\nlasts = "0 s"', "machine[1].lasts", "greater than 0"),
        (f'{ROTOR}\nmounts = {{ frequency = "5 Hz" }}', "machine[1].mounts.damping", "required"),
        (f'{ROTOR}\non = "roof"', "machine[1].on", "no other surface"),
    ],
)  # fmt: skip
def test_a_machine_that_would_press_with_nothing_or_twice_is_told(force, place, words):
    """No force is no vibration, and passes; of two nobody knows which is meant."""
    assert words in told(force)[place].rule


@pytest.mark.parametrize(("speed", "fine"), [("79 Hz", True), ("81 Hz", False)])
def test_a_rotor_faster_than_the_step_shows_is_refused(speed, fine):
    """Steps of 5 ms show 0.4 of 200 Hz; a faster one would look slower than it is."""
    force = f'rotor = {{ speed = "{speed}", unbalance = "500 g mm" }}'
    if fine:
        assert machine(force)
    else:
        assert list(told(force)) == ["machine[1]"]
        assert "shorten dt" in told(force)["machine[1]"].rule


def test_machines_and_walkers_are_of_one_list_of_names():
    """Their results are cases found by name."""
    walker = '[[walker]]\nname = "pump"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "3 m"]\n'
    assert told(more=walker)["walker[1].name"].value == "'pump' 2 times"


@pytest.mark.parametrize(
    ("force", "place"),
    [
        (f'{ROTOR}\nstarts = "4 s"', "machine[1].starts"),
        ('blows = { impulse = "9 N s", contact_time = "0.1 s", first = "4 s" }',
         "machine[1].blows.first"),
    ],
)  # fmt: skip
def test_a_machine_that_starts_when_the_record_has_ended_is_told(force, place):
    """The record is 4 s long: a floor that nothing shakes would pass. At 3.9 s it starts in it."""
    assert list(told(force)) == [place]
    assert machine(force.replace('"4 s"', '"3.9 s"'))
