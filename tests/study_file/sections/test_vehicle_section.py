"""[vehicle.NAME]: of the library, of bodies and axles, of a data sheet; and what each may change."""

import numpy as np
import pytest

from studies import GOOD, LIBRARY
from trundle.errors import StudyError
from trundle.study_file import study_from_text
from trundle.vehicle import GRAVITY, Friction, Stop, library_vehicle

PLANAR = """kind = "planar"
bodies = [{ mass = "4 t", pitch_inertia = "9 t m2", centre = "200 cm" }]
axles = [
  { setback = "0 m", stiffness = "0.4 MN/m", damping = "8 kN s/m" },
  { setback = "500 cm", stiffness = "6000 N/cm", damping = "9 N s/mm" },
]"""
WHEELS = PLANAR.replace('"8 kN s/m"', '"8 kN s/m", axle_mass = "0.3 t", tyre_stiffness = "2 MN/m"')
SHEET = 'kind = "data_sheet"\naxle_loads = ["2 t", "3 t"]\nwheelbase = "3 m"\nbounce = "2 Hz"'
VAN = 'kind = "van_vw_t2"'


def vehicle(text, more=""):
    """Return what drives the good study's route, with a patch that meets joints."""
    return study_from_text(GOOD.replace(LIBRARY, text) + more).drives["main"].vehicle


def told(text):
    with pytest.raises(StudyError) as caught:
        vehicle(text)
    return {p.place.removeprefix("vehicle.truck"): p for p in caught.value.problems}


def test_a_vehicle_of_the_library_is_the_librarys():
    """Nothing said of it, nothing changed."""
    made, direct = vehicle(VAN), library_vehicle("van_vw_t2")
    np.testing.assert_array_equal(made.static_forces, direct.static_forces)
    np.testing.assert_array_equal(made.natural_frequencies(), direct.natural_frequencies())


def test_bodies_and_axles_in_any_unit_stand_as_statics_says():
    """4 t at 2 m of 5 m: 3/5 of the weight in front, 2/5 behind; its springs 400 and 600 kN/m."""
    made = vehicle(PLANAR)
    weight = 4000 * GRAVITY
    np.testing.assert_allclose(made.static_forces, [0.6 * weight, 0.4 * weight])
    np.testing.assert_allclose(made.setback, [0.0, 5.0])
    np.testing.assert_allclose(made.contact_stiffness, [4e5, 6e5])
    np.testing.assert_allclose(made.contact_damping, [8e3, 9e3])
    # two masses of its modes by hand: bounce and pitch about the centre at 2 m
    K = np.array([[1e6, 4e5 * -2 + 6e5 * 3], [4e5 * -2 + 6e5 * 3, 4e5 * 4 + 6e5 * 9]])
    square = np.linalg.eigvals(np.diag([1 / 4000, 1 / 9000]) @ K)
    np.testing.assert_allclose(
        np.sort(made.natural_frequencies()), np.sort(np.sqrt(square)) / (2 * np.pi)
    )


def test_the_front_axle_is_the_foremost_and_stands_at_nought():
    """Axles at 1 m and 6 m are axles at 0 and 5 m; the mass moves with them."""
    text = (
        PLANAR.replace('"0 m"', '"1 m"').replace('"500 cm"', '"6 m"').replace('"200 cm"', '"3 m"')
    )
    moved, plain = vehicle(text), vehicle(PLANAR)
    np.testing.assert_allclose(moved.setback, plain.setback)
    np.testing.assert_allclose(moved.static_forces, plain.static_forces)


def test_a_hinge_carries_a_trailer_on_its_tractor():
    """4 t on 0 and 4 m, hinged there to 4 t on 4 and 8 m: a quarter, a half, a quarter."""
    made = vehicle("""kind = "planar"
bodies = [{ mass = "4 t", pitch_inertia = "9 t m2", centre = "2 m" },
          { mass = "4 t", pitch_inertia = "9 t m2", centre = "6 m" }]
axles = [{ setback = "0 m", stiffness = "1 MN/m" }, { setback = "4 m", stiffness = "1 MN/m" },
         { body = 1, setback = "8 m", stiffness = "1 MN/m" }]
hinges = [{ bodies = [0, 1], setback = "4 m" }]""")
    np.testing.assert_allclose(made.static_forces / (8000 * GRAVITY), [0.25, 0.5, 0.25])


def test_a_payload_presses_where_it_lies():
    """1 t at 1 m of 5 m: 4/5 of it in front."""
    before = vehicle(PLANAR).static_forces
    made = vehicle(f'{PLANAR}\npayload = {{ mass = "1000 kg", setback = "1000 mm" }}')
    np.testing.assert_allclose(
        made.static_forces - before, [0.8 * 1000 * GRAVITY, 0.2 * 1000 * GRAVITY]
    )


def test_what_is_not_round_turns_once_a_circumference():
    """0.5 mm round wheels of 0.5 m, three waves a turn; axle 2 of the file is number 1."""
    keys = 'amplitude = "500 um", radius = "50 cm", order = 3, axle = 2, phase = "90 deg"'
    (wave,) = vehicle(f"{PLANAR}\nout_of_round = [{{ {keys} }}]").rounds
    lift, _ = wave.lift(np.array([0.0, 0.5 * 2 * np.pi / 3 / 4]))
    np.testing.assert_allclose(lift, [0.0, -5e-4], atol=1e-12)
    assert wave.axle == 1
    keys = 'amplitude = "1 mm", radius = "0.5 m"'
    (wave,) = vehicle(f"{PLANAR}\nout_of_round = [{{ {keys} }}]").rounds
    assert (wave.axle, wave.order, wave.phase) == (None, 1, 0.0)


def test_an_engine_shakes_between_its_times_at_its_frequency():
    """1440 turns a minute are 24 Hz; with the wheels it turns n s / R."""
    by_itself, with_wheels = vehicle(
        f'{PLANAR}\nforce = [{{ amplitude = "0.4 kN", frequency = "1440 rpm", from = "1 s", to = "4000 ms" }},'
        ' { name = "axle", amplitude = "1 N", order = 4.0, radius = "50 cm", phase = "180 deg" }]'
    ).forces
    time = np.array([0.99, 1.0, 1.0 + 1 / 48, 4.0, 4.01])
    np.testing.assert_allclose(
        by_itself.force(time, 0 * time), [0.0, 400.0, -400.0, 400.0, 0.0], atol=1e-9
    )
    station = np.array([0.0, np.pi / 8])
    np.testing.assert_allclose(with_wheels.force(station, station), [-1.0, 1.0])
    assert (by_itself.name, with_wheels.name) == ("engine", "axle")


def test_friction_and_stops_are_of_axles_counted_from_one():
    """The second axle of the file is number 1 of the program."""
    text = WHEELS.replace(
        '"9 N s/mm"', '"9 N s/mm", axle_mass = "300 kg", tyre_stiffness = "2 MN/m"'
    )
    newmark = GOOD.replace('f_max = "30 Hz"', 'integration = "newmark"').replace(
        'ratio = "3 %"', 'rayleigh_alpha = "1 1/s", rayleigh_beta = "1 ms"'
    )
    text += '\nfriction = [{ axle = 2, force = "3 kN", stiffness = "20 kN/mm" }]'
    text += '\nstop = [{ axle = 1, gap = "60 mm", stiffness = "1 kN/mm" }]'
    made = study_from_text(newmark.replace(LIBRARY, text)).drives["main"].vehicle
    friction, stop = made.laws
    assert isinstance(friction, Friction)
    assert (friction.axle, friction.force, friction.stiffness) == (1, 3000.0, 2e7)
    assert isinstance(stop, Stop)
    assert (stop.axle, stop.gap, stop.stiffness) == (0, 0.06, 1e6)
    assert not made.is_linear


def test_a_vehicle_in_space_has_wheels_on_both_sides():
    """Half of each axle's load a side, 75 cm from the middle; it rolls by its inertia."""
    plain = vehicle(PLANAR)
    made = vehicle(f'{PLANAR}\ntrack_width = "1.5 m"\nroll_inertia = ["2 t m2"]')
    assert made.n_contacts == 4
    np.testing.assert_allclose(np.sort(made.lateral), [-0.75, -0.75, 0.75, 0.75])
    left = made.lateral > 0
    np.testing.assert_allclose(made.static_forces[left], plain.static_forces / 2)
    # roll by hand: springs of 500 kN/m a side at 0.75 m on 2000 kg m2
    roll = np.sqrt(1e6 * 0.75**2 / 2000) / (2 * np.pi)
    assert np.abs(made.natural_frequencies() - roll).min() < 1e-6


def test_patch_radius_and_heights_are_taken_where_they_are_given():
    """20 cm, 0.45 m; braking pitches a body whose centre is 1.2 m high."""
    made = vehicle(f'{PLANAR}\ncontact_patch = "20 cm"\nwheel_radius = "450 mm"')
    assert (made.contact_patch, made.wheel_radius) == (0.2, 0.45)
    high = vehicle(f'{PLANAR}\nheights = ["120 cm"]')
    low = vehicle(PLANAR)
    # a mass m at height h that is slowed by a pitches with m h a
    assert np.abs(high.pitching).max() == pytest.approx(4000 * 1.2)
    assert np.abs(low.pitching).max() == 0.0


def test_a_data_sheet_of_one_axle_or_of_many_stands_on_its_loads():
    """Loads as masses and as weights; axles where they are said to be."""
    one = vehicle('kind = "data_sheet"\naxle_loads = ["9.81 kN"]\nbounce = "2 Hz"')
    assert one.static_forces == pytest.approx([9810.0])
    assert one.natural_frequencies() == pytest.approx([2.0])
    many = vehicle(
        'kind = "data_sheet"\naxle_loads = ["6 t", "9 t", "9 t"]\nbounce = "1.5 Hz"\n'
        'setbacks = ["0 m", "400 cm", "5.3 m"]'
    )
    np.testing.assert_allclose(many.setback, [0.0, 4.0, 5.3])
    np.testing.assert_allclose(many.static_forces.sum(), 24000 * GRAVITY)


def test_tyres_of_a_data_sheet_are_taken_as_they_are():
    """Stiffness of each axle in place of a frequency: sqrt(k / m) by hand."""
    text = SHEET.replace('bounce = "2 Hz"', 'tyre_stiffness = ["0.8 MN/m", "1200 N/mm"]')
    made = vehicle(text)
    np.testing.assert_allclose(made.contact_stiffness, [8e5, 1.2e6])
    hand = np.sqrt(np.array([8e5 / 2000, 1.2e6 / 3000])) / (2 * np.pi)
    np.testing.assert_allclose(np.sort(made.natural_frequencies()), np.sort(hand))


def test_a_vehicle_is_laden_when_it_is_said_to_be():
    """2.5 t and 4.5 t in place of 2 t and 3 t, and only with laden = true."""
    text = f'{SHEET}\nladen_axle_loads = ["2.5 t", "4.5 t"]\n'
    np.testing.assert_allclose(vehicle(text).static_forces / GRAVITY, [2000, 3000])
    laden = vehicle(text + "laden = true").static_forces
    np.testing.assert_allclose(laden / GRAVITY, [2500, 4500])
    assert "no laden axle loads" in told(f"{SHEET}\nladen = true")[""].rule


def test_bounce_and_damping_of_a_library_vehicle_are_replaced():
    """The axle that is heaviest empty bounces with the 5 Hz and 12 % asked for.

    Both springs change by one factor, so the two frequencies keep their ratio.
    """
    made = vehicle('kind = "forklift_fl3"\nbounce = "300 rpm"\ndamping = "12 %"')
    plain = library_vehicle("forklift_fl3").natural_frequencies()
    found = made.natural_frequencies()
    assert found.min() == pytest.approx(5.0)
    np.testing.assert_allclose(found / found.min(), plain / plain.min(), rtol=1e-9)
    pole = min(made.poles(), key=abs)
    assert -pole.real / abs(pole) == pytest.approx(0.12)


@pytest.mark.parametrize("name", ["Stapler 3,5 t", "<b>", "Süd"])
def test_a_vehicle_is_called_as_the_file_calls_it(name):
    """Keys in quotes: commas, signs of HTML, umlauts."""
    text = GOOD.replace("[vehicle.truck]", f'[vehicle."{name}"]').replace(LIBRARY, PLANAR)
    text = text.replace('vehicle = "truck"', f'vehicle = "{name}"')
    assert study_from_text(text).drives["main"].vehicle.name == name


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        (PLANAR.replace('"4 t", ', '"4 kN", '), ".bodies[1].mass", "not one of mass"),
        (PLANAR.replace('"4 t", ', '"0 t", '), ".bodies[1].mass", "greater than 0"),
        (PLANAR.replace('"500 cm"', '"-500 cm"'), ".axles[2].setback", "0 or more"),
        (PLANAR.replace('"6000 N/cm"', '"0 N/cm"'), ".axles[2].stiffness", "greater than 0"),
        (PLANAR.replace('"6000 N/cm", damping', '"6000 N/cm", body = 1, damping'), "", "body numbers must be 0 to 0"),
        (PLANAR.replace('"6000 N/cm", damping', '"6000 N/cm", body = -1, damping'), ".axles[2].body", "0 or more"),
        (PLANAR.partition("axles")[0], "", "needs axles, or bogies"),
        ('kind = "planar"\naxles = [{ setback = "0 m", stiffness = "1 MN/m" }]', ".bodies", "required"),
        (PLANAR.replace('"200 cm"', '"6 m"'), "", "would lift off at rest"),
        (PLANAR + '\nhinges = [{ bodies = [0], setback = "1 m" }]', ".hinges[1].bodies[2]", "required"),
        (PLANAR + '\nhinges = [{ bodies = [0, -1], setback = "1 m" }]', "", "body numbers"),
        (PLANAR + '\npayload = { mass = "0 t", setback = "1 m" }', ".payload.mass", "greater than 0"),
        (PLANAR + '\npayload = { mass = "1 t" }', ".payload.setback", "required"),
        (PLANAR + '\npayload = { mass = "1 t", setback = "1 m", body = 1 }', "", "body numbers must be 0 to 0"),
        (PLANAR + '\nheights = ["1 m", "2 m"]', "", "2 numbers for 1 bodies"),
        (PLANAR + '\ntrack_width = "1.5 m"\nroll_inertia = ["1 t m2", "1 t m2"]', "", "2 numbers for 1 bodies"),
        (PLANAR + '\nout_of_round = [{ amplitude = "1 mm", radius = "1 m", axle = 0 }]', ".out_of_round[1].axle", "1 or more"),
        (PLANAR + '\nforce = [{ amplitude = "0 N", frequency = "9 Hz" }]', ".force[1].amplitude", "greater than 0"),
        (PLANAR + '\nforce = [{ amplitude = "9 N", order = 2 }]', "", "the radius of the wheels"),
        (PLANAR + '\nforce = [{ amplitude = "9 N", frequency = "9 Hz", order = 2, radius = "1 m" }]', "", "frequency of its own, or"),
        (PLANAR + '\nstop = [{ axle = 1, gap = "9 mm", stiffness = "1 MN/m" }]', "", "give that too"),
        (PLANAR + "\nlifts_off = 1", ".lifts_off", "true or false"),
        (PLANAR + '\nbounce = "2 Hz"', ".bounce", "unknown key"),
        (SHEET.replace("axle_loads", "axle_load"), ".axle_loads", "required"),
        (SHEET + '\nsetbacks = ["0 m", "3 m"]', "", "say where axles are once"),
        (SHEET.replace('"3 t"]', '"3 t", "3 t"]'), "", "with 3 give setbacks"),
        (SHEET.replace('"3 t"]', '"3 m"]'), ".axle_loads[2]", "not one of mass"),
        (SHEET + '\nunsprung = ["2 t", "100 kg"]\nhop = "11 Hz"', "", "below its load"),
        (SHEET + '\nhop = "11 Hz"', "", "give unsprung too"),
        (SHEET + '\nladen_axle_loads = ["1 t", "2 t"]', "", "heavier than an empty one"),
        (SHEET.replace('wheelbase = "3 m"', 'setbacks = ["0 m", "3 m", "4 m"]'), "", "2 numbers for 3 axles"),
        (SHEET.replace('wheelbase = "3 m"', 'setbacks = ["1 m", "3 m"]'), "", "must begin at 0 and rise"),
    ],
)  # fmt: skip
def test_a_vehicle_that_cannot_be_is_told_where_it_stands(text, place, words):
    """Bodies, axles and laws are counted as the file counts them."""
    assert words in told(text)[place].rule


def test_a_vehicle_that_nobody_drives_is_still_checked():
    """It may be driven tomorrow; its mistake is told today."""
    with pytest.raises(StudyError) as caught:
        study_from_text(GOOD + f"[vehicle.spare]\n{PLANAR.replace('200 cm', '6 m')}\n")
    assert [p.place for p in caught.value.problems] == ["vehicle.spare"]
