"""Vehicles from parts: bogies, left and right wheels, payloads, data sheets."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.road import RoadClass
from trundle.route import Route
from trundle.simulate import Crossing, Modal, contact_forces
from trundle.vehicle import (
    GRAVITY,
    Axle,
    Body,
    Bogie,
    DataSheet,
    Hinge,
    Unit,
    build_vehicle,
    describe,
    library_vehicle,
    quarter_car_springs,
)

# Eight axles on three bodies: natural frequencies by Abaqus [Hz] and loads [kN], as published with
# VEqMon2D (D. Cantero, NTNU); numbers only
ORACLE = [1.4010, 1.5923, 1.9731, 4.8321, 7.3248, 8.8112, 12.351, 12.367, 12.661, 13.422, 29.174,
          29.775]  # fmt: skip
LOADS = [62.539, 41.079, 41.079, 80.933, 80.933, 80.933, 105.458, 105.458]


def oracle():
    """Its bodies' centres are at 0, 8 and 17 m; here behind the first axle, which is at -1 m."""
    suspension = ([0, 0, 1, 2, 2], [-1.0, 3.0, 2.0, -2.5, 2.5], [0.5e6, 2e6, 3e6, 1e6, 1e6],
                  [1e3, 2e3, 3e3, 1e3, 1e3], [750.0, 1500.0, 2250.0, 750.0, 750.0],
                  [0.0, 200.0, 300.0, 0.0, 0.0])  # fmt: skip
    wheels = ((0.0,), (-1.0, 1.0), (-1.2, 0.0, 1.2), (0.0,), (0.0,))
    centres = np.array([0.0, 8.0, 17.0]) + 1.0
    tyres = [1.75e6, 3.5e6, 3.5e6, 3.5e6, 3.5e6]
    return build_vehicle(
        name="oracle",
        bodies=tuple(
            Body(mass=m, pitch_inertia=i, centre=x)
            for m, i, x in zip((5e3, 30e3, 20e3), (4e3, 20e3, 10e3), centres, strict=True)
        ),
        axles=(),
        bogies=tuple(
            Bogie(body=b, setback=centres[b] + x, stiffness=k, damping=c, mass=m, pitch_inertia=i,
                  wheels=w, tyre_stiffness=kt, tyre_damping=1e4)
            for b, x, k, c, m, i, w, kt in zip(*suspension, wheels, tyres, strict=True)
        ),
        hinges=(Hinge(bodies=(0, 1), setback=2.0 + 1.0),),
    )  # fmt: skip


def test_bogies_have_the_frequencies_that_abaqus_finds():
    """Twelve of them, to the five digits that are published; and the axle loads to a newton."""
    vehicle = oracle()
    np.testing.assert_allclose(vehicle.natural_frequencies(), ORACLE, rtol=5e-5)
    np.testing.assert_allclose(vehicle.static_forces / 1e3, LOADS, atol=1e-3)


def car(**axle):
    return build_vehicle(
        name="car",
        bodies=(Body(mass=1200.0, pitch_inertia=1500.0, centre=1.2, roll_inertia=400.0),),
        axles=tuple(
            Axle(body=0, setback=x, stiffness=4e4, damping=3e3, track_width=1.5, **axle)
            for x in (0.0, 2.6)
        ),
    )


def test_a_body_rolls_on_its_springs_as_a_closed_form_says():
    """Omega^2 = sum k t^2 / 4 / I: each side carries half of every axle's stiffness at t / 2."""
    f = car().natural_frequencies()
    roll = np.sqrt(2 * 4e4 * 1.5**2 / 4 / 400.0) / (2 * np.pi)
    assert np.abs(f - roll).min() < 1e-9


def test_a_rigid_axle_rolls_between_springs_and_tyres():
    """Roll of a body on one stiff axle with a bar: two dofs, their determinant by hand."""
    t, ts, k, kt, bar, m = 1.8, 1.0, 6e5, 2e6, 5e4, 700.0
    vehicle = build_vehicle(
        name="axle",
        bodies=(Body(mass=5000.0, roll_inertia=3000.0),),
        axles=(
            Axle(body=0, setback=0.0, stiffness=k, axle_mass=m, tyre_stiffness=kt, track_width=t,
                 spring_track=ts, roll_stiffness=bar),
        ),
    )  # fmt: skip
    spring, tyre, inertia = k * ts**2 / 4 + bar, kt * t**2 / 4, m * t**2 / 4
    a, b = 3000.0 * inertia, 3000.0 * (spring + tyre) + inertia * spring
    squares = np.roots([a, -b, spring * tyre])
    expected = np.sort(np.sqrt(squares)) / (2 * np.pi)
    found = vehicle.natural_frequencies()
    for f in expected:
        assert np.abs(found - f).min() < 1e-9 * f
    # and in bounce it is the quarter car of the same springs
    a, b = 5000.0 * m, 5000.0 * (k + kt) + m * k
    for f in np.sqrt(np.roots([a, -b, k * kt])) / (2 * np.pi):
        assert np.abs(found - f).min() < 1e-9 * f


@pytest.mark.parametrize("independent", [False, True])
def test_in_space_a_vehicle_on_one_track_is_the_planar_one(independent):
    """Both wheels of an axle on the same road: nothing rolls, and sides sum to the axle."""
    flat = describe("tractor_3axle_semitrailer_6_axle")
    flat = replace(flat, units=())
    wide = flat.widened(2.0)
    wide = replace(wide, axles=tuple(replace(a, independent=independent) for a in wide.axles))
    route = Route.straight((0, 0), (40, 0), speed=4.0)
    one = Modal(f_max=90.0, dt=0.005)
    found = []
    for parts in (flat, wide):
        vehicle = parts.build()
        # the track that every wheel rolls on is then the same
        vehicle = replace(vehicle, lateral=np.zeros(vehicle.n_contacts))
        _, forces = contact_forces(
            Crossing(vehicle, route, RoadClass("C")), integration=one, n_runs=1, seed=3,
            duration=6.0,
        )  # fmt: skip
        found.append(forces[0])
    planar, spatial = found
    np.testing.assert_allclose(
        spatial[:, 0::2] + spatial[:, 1::2], planar, rtol=1e-7, atol=1e-6 * planar.max()
    )
    np.testing.assert_allclose(spatial[:, 0::2], spatial[:, 1::2], rtol=1e-6)
    for f in flat.build().natural_frequencies():
        assert np.abs(wide.build().natural_frequencies() - f).min() < 1e-6 * f


def test_two_tracks_press_less_than_one_by_their_coherence():
    """At low coherence the sum of two sides varies with half the power of two sides as one.

    A vehicle that does not roll: its bounce feels the mean of both tracks. Far apart (50 m) waves
    of a metre have no coherence, so the force's variance is half; side by side it is the whole.
    """
    body = Body(mass=1000.0)
    route = Route.straight((0, 0), (40, 0), speed=4.0)

    def variance(width):
        axle = Axle(body=0, setback=0.0, stiffness=1e6, damping=2e4, track_width=width)
        vehicle = build_vehicle(name="v", bodies=(body,), axles=(axle,))
        _, forces = contact_forces(
            Crossing(vehicle, route, RoadClass("B")), integration=Modal(f_max=90.0, dt=0.005),
            n_runs=200, seed=5, duration=8.0,
        )  # fmt: skip
        return (forces.sum(axis=2) - vehicle.static_forces.sum())[:, 200:].var()

    near, far = variance(1e-3), variance(50.0)
    # 200 runs of 7 s at some 5 Hz of bandwidth: each variance is within 2 %
    assert far / near == pytest.approx(0.5, rel=0.05)


def test_a_payload_off_the_middle_presses_as_moments_say():
    """Two wheels, a load aside: each side's share by moments about the other."""
    vehicle = (
        replace(describe("forklift_efg_320"), lumped=())
        .widened(0.9, roll_inertia=[900.0])
        .loaded(500.0, body=0, setback=0.3, aside=0.1)
        .build()
    )
    forces, at = vehicle.static_forces, vehicle.lateral
    empty = 3306.0 * GRAVITY
    assert forces.sum() == pytest.approx(empty + 500.0 * GRAVITY)
    assert forces @ at == pytest.approx(500.0 * GRAVITY * 0.1)
    assert forces @ vehicle.setback == pytest.approx(
        GRAVITY * (1817.0 * 1.508 + 500.0 * 0.3), rel=1e-9
    )


def test_a_quarter_car_has_the_frequencies_that_are_asked_for():
    """Springs found for 1.3 and 11 Hz, and built: its own eigenvalues are those."""
    k, kt = quarter_car_springs(4000.0, 500.0, 1.3, 11.0)
    vehicle = build_vehicle(
        name="q",
        bodies=(Body(mass=4000.0),),
        axles=(Axle(body=0, setback=0.0, stiffness=k, axle_mass=500.0, tyre_stiffness=kt),),
    )
    np.testing.assert_allclose(vehicle.natural_frequencies(), [1.3, 11.0], rtol=1e-12)
    assert k < kt


@pytest.mark.parametrize("loads", [(3000.0, 5000.0), (2500.0, 4000.0, 4200.0)])
def test_a_data_sheet_gives_its_loads_and_frequencies(loads):
    """Masses over the axles: each is a quarter car, and loads are those of the sheet."""
    setbacks = (0.0, 3.5, 4.8)[: len(loads)]
    unsprung = (400.0, 600.0, 600.0)[: len(loads)]
    sheet = DataSheet(
        name="truck", setbacks=setbacks, loads=loads, unsprung=unsprung, bounce=1.6, hop=11.0,
        damping=0.1,
    )  # fmt: skip
    vehicle = sheet.description().build()
    np.testing.assert_allclose(vehicle.static_forces / GRAVITY, loads, rtol=1e-9)
    found = vehicle.natural_frequencies()
    assert np.sum(np.abs(found - 1.6) < 1e-6) == 2  # bounce and pitch of one body
    assert np.sum(np.abs(found - 11.0) < 1e-6) >= 2


def test_a_laden_forklift_bounces_as_stated_and_a_user_may_state_it():
    """The front axle of FL3 carries 63 kN: at 6 Hz unless said; at 4 Hz or by a stiffness if so."""
    (front,) = (a for a in describe("forklift_fl3_laden").axles if a.setback == 0.0)
    load = 63e3 / 9.81
    assert front.stiffness == pytest.approx(load * (2 * np.pi * 6.0) ** 2, rel=1e-4)
    soft = describe("forklift_fl3_laden", {"bounce": 4.0}).axles[0]
    assert soft.stiffness == pytest.approx(load * (2 * np.pi * 4.0) ** 2, rel=1e-4)
    stated = describe("forklift_fl3_laden", {"tyre_stiffness": (7e6, 5e6)}).axles
    assert [a.stiffness for a in stated] == [7e6, 5e6]
    empty, laden = library_vehicle("forklift_fl3"), library_vehicle("forklift_fl3_laden")
    np.testing.assert_allclose(empty.contact_stiffness, laden.contact_stiffness)
    assert laden.static_forces[0] == pytest.approx(63e3, rel=1e-4)


def test_design_trucks_and_the_golden_car_are_what_their_sources_say():
    """AASHTO: 8, 32 and 32 kip (35.6, 142.3, 142.3 kN), 14 ft apart. IRI: 1.236 and 10.76 Hz damped.

    The golden car's eigenvalues are hard-coded in a public program as -2.590 +- 7.323i and
    -20.41 +- 64.42i; its masses and springs over the sprung mass give them.
    """
    truck = library_vehicle("hs20_44")
    np.testing.assert_allclose(truck.static_forces / 1e3, [35.6, 142.3, 142.3], rtol=3e-3)
    np.testing.assert_allclose(truck.setback, [0.0, 4.267, 8.534])
    poles = library_vehicle("golden_car").poles()
    poles = np.sort_complex(poles[poles.imag > 0.0])
    np.testing.assert_allclose(poles, [-20.41 + 64.42j, -2.590 + 7.323j], rtol=1e-3)


def test_units_are_found_from_hinges():
    """A tractor led at its front axle and pivoting amid its rear ones; a trailer at the hinge."""
    tractor, trailer = library_vehicle("tractor_3axle_semitrailer_6_axle").units
    assert (tractor.lead, tractor.pivot, tractor.contacts) == (0.0, 4.78, (0, 1, 2))
    assert (trailer.lead, trailer.pivot) == (4.64, pytest.approx(12.23))
    wide = describe("container_truck_40ft").widened(2.0).build()
    assert wide.units[1].contacts == (4, 5)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Bogie(body=0, setback=0, stiffness=1e6, mass=9, wheels=(-1, 1), tyre_stiffness=1e6),
         "pitch_inertia"),
        (lambda: Bogie(body=0, setback=0, stiffness=1e6, mass=9, wheels=(), tyre_stiffness=1e6),
         "has axles"),
        (lambda: Axle(body=0, setback=0, stiffness=1e6, spring_track=1.0), "track_width"),
        (lambda: Axle(body=0, setback=0, stiffness=1e6, track_width=2, roll_stiffness=1e4),
         "axle_mass"),
        (lambda: Unit(lead=2.0, pivot=1.0, contacts=(0,)), "pivots behind"),
        (lambda: quarter_car_springs(1000.0, 500.0, 5.0, 6.0), "no springs give"),
        (lambda: DataSheet(name="x", setbacks=(0, 2), loads=(1e3,), bounce=2.0), "one each"),
        (lambda: DataSheet(name="x", setbacks=(0, 2), loads=(1e3, 1e3)), "says how stiff"),
        (lambda: DataSheet(name="x", setbacks=(0, 2), loads=(1e3, 1e3), bounce=2.0, hop=9.0),
         "unsprung"),
        (lambda: DataSheet(name="x", setbacks=(1, 2), loads=(1e3, 1e3), bounce=2.0), "begin at 0"),
        (lambda: describe("container_truck_40ft", {"bounce": 2.0}), "known by its parts"),
        (lambda: describe("golden_car").widened(1.5, roll_inertia=[1.0, 2.0]), "2 numbers for 1"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_axles_of_bogies_are_counted_on_from_the_axles():
    """An axle of two wheels is one axle: behind it come axles 2 and 3 of a bogie, 4 of another.

    By that number a wheel out of round is found.
    """
    beam = {"body": 0, "stiffness": 1e6, "mass": 500.0, "tyre_stiffness": 2e6}
    made = build_vehicle(
        name="m", bodies=(Body(mass=5e3, pitch_inertia=2e4, centre=3.0, roll_inertia=1e3),),
        axles=(Axle(body=0, setback=0.0, stiffness=4e5, track_width=2.0),),
        bogies=(
            Bogie(setback=4.0, pitch_inertia=200.0, wheels=(-0.6, 0.6), **beam),
            Bogie(setback=7.0, wheels=(0.0,), **beam),
        ),
    )  # fmt: skip
    assert made.contact_names == ("axle 1 left", "axle 1 right", "axle 2", "axle 3", "axle 4")
    assert [made.contacts_of(i) for i in range(4)] == [[0, 1], [2], [3], [4]]
