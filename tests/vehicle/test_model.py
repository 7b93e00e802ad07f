"""Vehicles turned round, widened, loaded; what shakes them; files and sheets that cannot be."""

from dataclasses import replace

import numpy as np
import pytest

from trundle._checks import set_frozen
from trundle.errors import InputError, UnrestrainedModeError
from trundle.vehicle import (
    Axle,
    Body,
    BodyForce,
    DataSheet,
    Description,
    Friction,
    Hinge,
    LumpedMass,
    OutOfRound,
    Stop,
    Unit,
    build_vehicle,
    damping_coefficient,
    quarter_car,
    sprung_mass,
)

AXLE = Axle(
    body=0, setback=0.0, stiffness=2e5, damping=8e3, axle_mass=300.0, tyre_stiffness=9e5,
    tyre_damping=700.0,
)  # fmt: skip


def van(**changes):
    """Return a van of two axles, its body 1.1 m behind the front of 3 m, 0.7 m high."""
    body = Body(mass=2400.0, pitch_inertia=3500.0, centre=1.1, height=0.7)
    values = {
        "name": "Lieferwagen <1>", "bodies": (body,), "axles": (AXLE, replace(AXLE, setback=3.0))
    }  # fmt: skip
    return Description(**{**values, **changes})


def test_static_forces_are_those_of_moments():
    """Body 2400 kg: 1.9 / 3 in front and 1.1 / 3 behind, and 300 kg of each axle."""
    expected = 9.81 * (2400.0 * np.array([1.9, 1.1]) / 3.0 + 300.0)
    np.testing.assert_allclose(van().build().static_forces, expected, rtol=1e-9)


def test_two_turns_give_the_vehicle_back():
    """Backwards: last axle first, left on the other side, pitching turned; the springs stay."""
    wide = van().widened(1.6).build()
    back = wide.backwards()
    np.testing.assert_allclose(back.setback, 3.0 - wide.setback)
    np.testing.assert_allclose(back.lateral, -wide.lateral)
    np.testing.assert_array_equal(back.pitching, -wide.pitching)
    np.testing.assert_array_equal(back.static_forces, wide.static_forces)
    again = back.backwards()
    for name in ("setback", "lateral", "pitching", "contact_map"):
        np.testing.assert_allclose(getattr(again, name), getattr(wide, name), atol=1e-12)
    np.testing.assert_allclose(back.natural_frequencies(), wide.natural_frequencies(), rtol=1e-12)


def test_backwards_over_a_sine_is_forwards_of_the_vehicle_built_that_way():
    """Contact forces by the transfer function: the van built from its other end, contact by contact."""
    one = van().build().backwards()
    other = van(
        bodies=(replace(van().bodies[0], centre=1.9),),
    ).build()
    f = np.array([1.0, 3.7, 11.0, 25.0])
    turned = one.contact_force_transfer(f, speed=7.0)[:, ::-1]
    built = other.contact_force_transfer(f, speed=7.0)
    np.testing.assert_allclose(turned, built, rtol=1e-9)


def test_a_quarter_car_answers_a_sine_as_its_two_equations():
    """Force on the road by a 2 x 2 system written out; no damping in the tyre, and with some."""
    ms, mu, k, c, kt = 400.0, 50.0, 2e4, 1500.0, 2e5
    for ct in (0.0, 900.0):
        car = quarter_car(
            body_mass=ms, axle_mass=mu, stiffness=k, damping=c, tyre_stiffness=kt, tyre_damping=ct
        )
        for f in (0.5, 1.3, 6.0, 11.0, 40.0):
            w = 2 * np.pi * f
            link, tyre = k + 1j * w * c, kt + 1j * w * ct
            matrix = np.array([[link - ms * w**2, -link], [-link, link + tyre - mu * w**2]])
            z = np.linalg.solve(matrix, np.array([0.0, tyre]))
            force = tyre * (1.0 - z[1])
            found = car.contact_force_transfer(np.array([f]), speed=3.0)[0, 0]
            assert found == pytest.approx(force, rel=1e-9)


def test_the_rear_axle_meets_the_road_later_by_its_setback():
    """Two masses that know nothing of each other: the second force lags by 2 pi f L / V."""
    mass = Body(mass=500.0)
    pair = build_vehicle(
        name="pair", bodies=(mass, mass),
        axles=(Axle(body=0, setback=0.0, stiffness=1e5), Axle(body=1, setback=4.0, stiffness=1e5)),
    )  # fmt: skip
    f = np.array([0.7, 2.0, 9.0])
    front, rear = pair.contact_force_transfer(f, speed=6.0).T
    np.testing.assert_allclose(rear, front * np.exp(-2j * np.pi * f * 4.0 / 6.0), rtol=1e-9)


def test_poles_of_a_mass_on_a_spring_are_those_of_the_textbook():
    """-z w +- i w sqrt(1 - z^2) below critical; two real ones above, the slow one decaying less."""
    m, w = 800.0, 12.0
    for zeta in (0.02, 0.4, 1.5):
        one = sprung_mass(mass=m, stiffness=m * w**2, damping=2 * zeta * m * w)
        expected = np.sort_complex(w * np.roots([1.0, 2.0 * zeta, 1.0]))
        np.testing.assert_allclose(np.sort_complex(one.poles()), expected, rtol=1e-9)
        assert one.decay_rates()[0] == pytest.approx(-expected.real.max(), rel=1e-9)
        assert one.decay_rates().shape == (2,)
    assert damping_coefficient(0.4, m * w**2, m) == pytest.approx(2 * 0.4 * m * w)


def test_shapes_are_shown_over_contacts_with_a_peak_of_one():
    """A symmetric van bounces with both ends alike and pitches with them against each other."""
    even = van(bodies=(Body(mass=2400.0, pitch_inertia=3500.0, centre=1.5),)).build()
    f, shapes = even.mode_shapes()
    np.testing.assert_allclose(f, even.natural_frequencies(), rtol=1e-12)
    np.testing.assert_allclose(np.abs(shapes).max(axis=0), 1.0, rtol=1e-9)
    signs = np.prod(np.sign(shapes.round(9)), axis=0)
    assert sorted(signs.tolist()) == [-1.0, -1.0, 1.0, 1.0]


def test_a_vehicle_that_does_not_stand_has_no_frequencies():
    """A system without springs under it: a mechanism, and named."""
    one = van().build()
    floating = replace(
        one, contact_stiffness=0.0 * one.contact_stiffness, system=one.free_system, name="Schweber"
    )
    with pytest.raises(UnrestrainedModeError, match="'Schweber' does not stand"):
        floating.natural_frequencies()


def test_a_widened_vehicle_on_level_ground_presses_as_before():
    """Each side carries half; bounce and pitch keep their frequencies, rolling comes beside them."""
    flat, wide = van().build(), van().widened(1.8, roll_inertia=[900.0]).build()
    assert wide.contact_names == ("axle 1 left", "axle 1 right", "axle 2 left", "axle 2 right")
    np.testing.assert_allclose(wide.lateral, [0.9, -0.9, 0.9, -0.9])
    np.testing.assert_allclose(
        wide.static_forces.reshape(2, 2), np.tile(0.5 * flat.static_forces[:, None], 2), rtol=1e-9
    )
    every = wide.natural_frequencies()
    for f in flat.natural_frequencies():
        assert np.abs(every / f - 1.0).min() < 1e-9
    assert len(every) == 7  # body: bounce, pitch, roll; two axles: bounce and roll
    assert wide.contacts_of(1) == [2, 3]
    assert wide.contacts_of(None) == [0, 1, 2, 3]
    assert flat.contacts_of(1) == [1]
    assert flat.contacts_of(2) == []


def test_units_of_a_widened_vehicle_hold_both_wheels():
    """Contact c becomes 2c and 2c + 1: who is pulled in a curve stays who it was."""
    units = (Unit(lead=0.0, pivot=3.0, contacts=(0, 1)),)
    assert van(units=units).widened(1.5).units[0].contacts == (0, 1, 2, 3)
    assert "radius of roll 0.42 track widths" in van().widened(1.5).assumption
    assert van().widened(1.5, roll_inertia=[800.0]).assumption == ""


def test_inner_contacts_are_forces_on_the_vehicle_and_none_on_the_ground():
    """An engine, a stop and the pitching of braking: named, without stiffness, behind the wheels."""
    force = BodyForce(amplitude=50.0, frequency=30.0, setback=0.2, name="Motor")
    made = van(forces=(force,), laws=(Stop(axle=1, gap=0.05, stiffness=1e6),)).build()
    inner = made.with_inner_contacts(braked=True)
    assert inner.contact_names[2:] == ("stop axle 2, inside", "Motor, inside", "braking, inside")
    assert inner.inner == 3
    assert inner.length == made.length
    assert inner.total_mass == pytest.approx(3000.0)
    assert (inner.contact_stiffness[2:] == 0.0).all()
    assert inner.contacts_of(None) == [0, 1]
    assert made.with_inner_contacts(braked=False).inner == 2
    plain = van(bodies=(replace(van().bodies[0], height=0.0),)).build()
    assert plain.with_inner_contacts(braked=True) is plain
    # bounce and pitch of the body where the engine stands, 0.9 m before its centre
    motion = inner.contact_map[3]
    assert motion[0] == 1.0
    assert motion[1] == pytest.approx(0.2 - 1.1)
    # an acceleration of 1 m/s2 turns it by m h, rear down
    assert inner.contact_map[4][1] == pytest.approx(-2400.0 * 0.7)
    assert not made.is_linear
    assert van().build().is_linear
    assert not replace(van().build(), lifts_off=True).is_linear


def test_runout_and_drivelines_turn_with_the_way():
    """Order n on a radius R: n waves in 2 pi R; the slope is the derivative of the height."""
    wave = OutOfRound(amplitude=2e-3, radius=0.5, order=3, phase=0.4)
    s = np.linspace(0.0, 2 * np.pi * 0.5, 1201)
    height, slope = wave.lift(s)
    assert height[0] == pytest.approx(2e-3 * np.cos(0.4))
    assert height[-1] == pytest.approx(height[0])
    assert np.count_nonzero(np.diff(np.sign(height)) != 0) == 6
    np.testing.assert_allclose(np.gradient(height, s, edge_order=2), slope, atol=2e-6)
    shaft = BodyForce(amplitude=10.0, order=2.0, radius=0.5, during=(1.0, 3.0), phase=0.1)
    time, station = np.array([0.9, 1.0, 2.0, 3.0, 3.1]), np.array([0.0, 0.5, 1.0, 1.5, 2.0])
    expected = 10.0 * np.cos(2.0 * station / 0.5 + 0.1) * [0, 1, 1, 1, 0]
    np.testing.assert_allclose(shaft.force(time, station), expected, atol=1e-12)


def test_leaves_stick_to_their_force_and_slip_at_it():
    """Jenkins's element by hand: from 0 N, stretched by 1 mm at 2e5 N/m it pulls 200 N; at 5 mm it
    slips at 600 N; going back it sticks again at once.
    """
    leaf = Friction(axle=0, force=600.0, stiffness=2e5)
    start = np.zeros((2, 3))
    pressed, rate = leaf.on_body(np.array([1e-3, 5e-3, -5e-3]), start)
    np.testing.assert_allclose(pressed, [-200.0, -600.0, 600.0])
    np.testing.assert_allclose(rate, [-2e5, 0.0, 0.0])
    back, rate = leaf.on_body(np.array([4e-3]), np.array([[5e-3], [-600.0]]))
    assert back[0] == pytest.approx(-400.0)
    assert rate[0] == -2e5


def test_a_stop_presses_behind_its_gap_alone():
    """Compressed by 3 cm over a gap of 2: 1 cm of 1e5 N/m presses up; stretched, or less, nothing."""
    stop = Stop(axle=0, gap=0.02, stiffness=1e5)
    pressed, rate = stop.on_body(np.array([-0.03, -0.019, 0.05]), np.zeros((2, 3)))
    np.testing.assert_allclose(pressed, [1000.0, 0.0, 0.0])
    np.testing.assert_allclose(rate, [-1e5, 0.0, 0.0])


def sheet(**changes):
    values = {
        "name": "Stapler", "setbacks": (0.0, 2.0), "loads": (1500.0, 1100.0), "bounce": 4.0,
        "damping": 0.05,
    }  # fmt: skip
    return DataSheet(**{**values, **changes})


def test_a_sheet_of_tyres_alone_bounces_as_it_says_at_each_axle():
    """m a b of inertia uncouples both axles: each is its load on its tyres at 4 Hz, 5 % damped."""
    made = sheet().description().build()
    np.testing.assert_allclose(made.static_forces / 9.81, [1500.0, 1100.0], rtol=1e-9)
    np.testing.assert_allclose(made.natural_frequencies(), [4.0, 4.0], rtol=1e-6)
    np.testing.assert_allclose(made.decay_rates(), 0.05 * 2 * np.pi * 4.0, rtol=1e-6)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"loads": (1500.0,)}, "loads gives 1 numbers for 2 axles"),
        ({"setbacks": (1.0, 2.0)}, "setbacks must begin at 0 and rise"),
        ({"setbacks": (0.0, 0.0)}, "setbacks must begin at 0 and rise"),
        ({"bounce": 0.0}, "give its bounce frequency, or the tyre_stiffness"),
        ({"tyre_stiffness": (1e6, 1e6)}, "says how stiff a vehicle is once"),
        ({"unsprung": (100.0, 100.0)}, "give hop, the frequency of it"),
        ({"unsprung": (1500.0, 100.0), "hop": 10.0}, "must be below its load"),
        ({"hop": 10.0}, "give unsprung too, or leave them out"),
        ({"laden": (1000.0, 900.0)}, "a laden vehicle is heavier"),
        ({"damping": 1.0}, "damping must be in"),
        ({"loads": (-1.0, 5.0)}, "loads must be greater than 0"),
    ],
)
def test_sheets_that_contradict_themselves_are_refused(changes, words):
    """Each with what is missing or too much."""
    with pytest.raises(InputError, match=words):
        sheet(**changes)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: van().loaded(-5.0, body=0, setback=1.0), "payload must be greater than 0"),
        (lambda: van().loaded(900.0, body=1, setback=1.0).build(), "body numbers must be 0 to 0"),
        (lambda: van().loaded(9e4, body=0, setback=9.0).build(), "axle 1 would lift off at rest"),
        (lambda: van().widened(1.5, roll_inertia=[1.0, 2.0]), "gives 2 numbers for 1 bodies"),
        (lambda: van(axles=()).build(), "needs at least one body and one axle"),
        (lambda: van(hinges=(Hinge(bodies=(0, 0), setback=1.0),)).build(), "two different bodies"),
        (
            lambda: van(laws=(Stop(axle=2, gap=0.0, stiffness=1.0),)).build(),
            "must be 1 to 2; got 3",
        ),
        (
            lambda: van(rounds=(OutOfRound(amplitude=1e-3, radius=0.4, axle=4),)).build(),
            "no axle 5 to be out of round; there are: axle 1, axle 2",
        ),
        (lambda: Stop(axle=-1, gap=0.0, stiffness=1.0), "axle must be 0 or more"),
        (lambda: OutOfRound(amplitude=1e-3, radius=0.4, order=0), "order must be a whole number"),
        (lambda: BodyForce(amplitude=1.0, frequency=3.0, phase=np.nan), "phase must be finite"),
        (lambda: BodyForce(amplitude=1.0, frequency=3.0, setback=np.inf), "setback must be finite"),
        (lambda: BodyForce(amplitude=1.0, frequency=3.0, aside=np.nan), "aside must be finite"),
        (lambda: LumpedMass(mass=-300.0, body=0, setback=1.0), "lumped mass must be greater"),
        (lambda: LumpedMass(mass=300.0, body=0, setback=np.nan), "setback must be finite"),
        (lambda: Hinge(bodies=(0, 1), setback=np.nan), "setback must be finite"),
        (lambda: Unit(lead=0.0, pivot=np.nan, contacts=(0,)), "pivot must be finite"),
        (lambda: BodyForce(amplitude=1.0), "a frequency of its own, or an order"),
        (
            lambda: BodyForce(amplitude=1.0, frequency=3.0, order=1.0, radius=0.3),
            "a frequency of its own, or an order",
        ),
        (lambda: BodyForce(amplitude=1.0, order=2.0), "a frequency of its own, or an order"),
        (
            lambda: BodyForce(amplitude=1.0, frequency=3.0, during=(2.0, 2.0)),
            "from one time to a later one",
        ),
        (lambda: Unit(lead=2.0, pivot=2.0, contacts=(0,)), "pivots behind it"),
    ],
)
def test_vehicles_that_cannot_be_are_refused(make, words):
    """With the part that is wrong, before anything drives."""
    with pytest.raises(InputError, match=words):
        make()


@pytest.mark.parametrize("order", [1.5, np.nan])
def test_no_part_of_a_wave_goes_round_a_wheel(order):
    """A wheel that has turned once is as high as it was; types are checked in tests alone."""
    wave = OutOfRound(amplitude=1e-3, radius=0.4)
    set_frozen(wave, order=order)
    with pytest.raises(InputError, match="order must be"):
        wave.__post_init__()


def test_a_lumped_mass_adds_its_own_inertia():
    """Kinetic energy of a van that turns about its centre: + m x^2 of a mass x behind it.

    200 kg at 2.6 m, 1.5 m behind the centre: mass matrix [[2600, 300], [300, 3500 + 450]].
    """
    loaded = van(lumped=(LumpedMass(mass=200.0, body=0, setback=2.6),)).build()
    mass = np.asarray(loaded.system.mass)[:2, :2]
    np.testing.assert_allclose(mass, [[2600.0, 300.0], [300.0, 3950.0]], rtol=1e-12)
