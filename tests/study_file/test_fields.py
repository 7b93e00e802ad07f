"""Fields of a study file: the SI number of a text, its limits, names, and places on a grid."""

import math

import pytest
from pydantic import TypeAdapter, ValidationError

from trundle.study_file import fields
from trundle.units import DIMENSIONS

POUND, INCH = 0.45359237, 0.0254  # kg and m, by international agreement of 1959


def read(kind, value):
    return TypeAdapter(getattr(fields, kind)).validate_python(value)


def refusal(kind, value):
    with pytest.raises(ValidationError) as told:
        read(kind, value)
    (error,) = told.value.errors()
    return error["msg"]


@pytest.mark.parametrize(
    ("kind", "text", "si"),
    [
        ("Length", "-350 mm", -0.35),
        ("Length", "12 in", 12 * INCH),
        ("PositiveLength", "1e3 um", 1e-3),
        ("Time", "1.5 min", 90.0),
        ("AnyTime", "0.5 h", 1800.0),
        ("Speed", "54 km/h", 15.0),
        ("Speed", "10 mph", 10 * 63360 * INCH / 3600),
        ("Frequency", "3000 rpm", 50.0),
        ("Frequency", "0.2 kHz", 200.0),
        ("Rate", "30 1/min", 0.5),
        ("Wavenumber", "3 1/km", 3e-3),
        ("Mass", "2000 lb", 2000 * POUND),
        ("Mass", "0.75 t", 750.0),
        ("AreaDensity", "0.03 g/mm2", 30.0),
        ("Density", "2.4 g/cm3", 2400.0),
        ("Density", "2.4 t/m³", 2400.0),
        ("Pressure", "33000 N/mm2", 33e9),
        ("Pressure", "210 kN/mm^2", 210e9),
        ("Load", "5 kPa", 5e3),
        ("Load", "50 N/dm2", 5e3),
        ("Force", "0.4 MN", 4e5),
        ("Impulse", "3 kN ms", 3.0),
        ("Impulse", "7 kg m/s", 7.0),
        ("Unbalance", "2 kg mm", 2e-3),
        ("Stiffness", "160 N/mm", 160e3),
        ("Stiffness", "1.2 MN/m", 1.2e6),
        ("StiffnessPerMetre", "50 N/mm2", 50e6),
        ("RotationalStiffness", "20 kN m/rad", 20e3),
        ("RotationalStiffness", "360 N m/deg", 360 * 180 / math.pi),
        ("DampingCoefficient", "12 N s/mm", 12e3),
        ("DampingCoefficient", "8 kNs/m", 8e3),
        ("RotaryInertia", "4.6 t m2", 4600.0),
        ("Angle", "90 deg", math.pi / 2),
        ("Angle", "-0.5 rad", -0.5),
        ("CrossArea", "84.5 cm2", 84.5e-4),
        ("SecondMoment", "23130 cm4", 23130e-8),
        ("SecondMoment", "2e8 mm4", 2e-4),
        ("LineDensity", "66.3 kg/m", 66.3),
        ("LineDensity", "0.1 t/m", 100.0),
        ("Acceleration", "0.3 gal", 3e-3),
        ("Acceleration", "2 mg", 2 * 9.80665e-3),
        ("Roughness", "16 cm3", 16e-6),
        ("Ratio", "3 %", 0.03),
        ("Ratio", "30 permille", 0.03),
        ("Ratio", 0.03, 0.03),
        ("Ratio", "0.03", 0.03),
        ("Grade", "-6 %", -0.06),
        ("Factor", "150 %", 1.5),
    ],
)
def test_a_quantity_is_the_si_number_worked_out_by_hand(kind, text, si):
    """Powers of ten of the prefixes; 60 s a minute, 180 deg in pi, 0.0254 m an inch."""
    assert read(kind, text) == pytest.approx(si, rel=1e-12)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_an_example_of_a_message_is_itself_accepted(dimension):
    """Who copies the example that a message shows must not be refused for it: within all limits."""
    example = DIMENSIONS[dimension][1]
    validator = fields._quantity(dimension)
    assert validator.func(example) > 0.0


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("Length", "1 s"),
        ("Mass", "1 kN"),
        ("Force", "1 kg"),
        ("Force", "1 t"),
        ("Stiffness", "1 kN m"),
        ("Pressure", "30 kN/m"),
        ("Load", "500 kg/m2"),
        ("AreaDensity", "5 kN/m2"),
        ("LineDensity", "1 kN/m"),
        ("StiffnessPerMetre", "5 MN/m"),
        ("Stiffness", "5 MN/m/m"),
        ("RotationalStiffness", "5 MN/m"),
        ("RotaryInertia", "5 kg m"),
        ("Unbalance", "5 kg m2"),
        ("CrossArea", "5 cm4"),
        ("SecondMoment", "5 cm2"),
        ("Acceleration", "5 mm/s"),
        ("Speed", "5 mm/s2"),
        ("Roughness", "16e-6 m2"),
        ("Ratio", "3 deg"),
        ("Grade", "5 deg"),
        ("Angle", "5 %"),
        ("Rate", "1 m"),
        ("Wavenumber", "1 m"),
    ],
)
def test_a_unit_of_another_kind_is_refused_by_name(kind, text):
    """A mass is no force, a load no mass: each differs in a power of kg, m or s."""
    said = refusal(kind, text)
    assert repr(text.partition(" ")[2]) in said
    assert "is not one of" in said


@pytest.mark.parametrize(
    ("kind", "good", "bad", "rule"),
    [
        ("Length", "-10 km", "-10.1 km", "up to 10000 m; this one is -10100 m"),
        ("Time", "1e6 s", "300 h", "up to 1e+06 s; this one is 1.08e+06 s"),
        ("Speed", "540 km/h", "541 km/h", "1e-10 to 150 m/s"),
        ("Frequency", "2 kHz", "2.01 kHz", "up to 2000 1/s"),
        ("Mass", "10000 t", "10001 t", "up to 1e+07 kg"),
        ("Pressure", "1e5 Pa", "33 kPa", "100000 to 1e+13 kg/m/s2"),
        ("Wavenumber", "0.1 1/km", "0.09 1/km", "0.0001 to 100 1/m"),
        ("Density", "30 t/m3", "30.1 t/m3", "up to 30000 kg/m3"),
        ("Angle", "570 deg", "580 deg", "up to 10 rad"),
    ],
)
def test_beyond_what_exists_is_a_slip_and_at_the_limit_is_not(kind, good, bad, rule):
    """The limit itself is allowed; a step beyond is told in SI, with what was understood."""
    read(kind, good)
    assert rule in refusal(kind, bad)


@pytest.mark.parametrize(
    ("kind", "zero", "rule"),
    [
        ("PositiveLength", "0 m", "must be greater than 0"),
        ("Time", "0 s", "must be greater than 0"),
        ("Speed", "0 km/h", "must be greater than 0"),
        ("Density", "0 kg/m3", "must be greater than 0"),
        ("Impulse", "0 N s", "must be greater than 0"),
        ("Unbalance", "0 g mm", "must be greater than 0"),
        ("Factor", "0 %", "must be greater than 0"),
        ("Acceleration", "0 gal", "must be greater than 0"),
    ],
)
def test_nothing_at_all_is_no_size(kind, zero, rule):
    """A thickness, a speed, a limit of 0 divides by 0 somewhere: told where it stands."""
    assert refusal(kind, zero) == rule


@pytest.mark.parametrize(
    ("kind", "negative"),
    [
        ("NonNegativeLength", "-1 mm"),
        ("AnyTime", "-1 s"),
        ("AnySpeed", "-1 km/h"),
        ("Mass", "-1 kg"),
        ("AreaDensity", "-1 kg/m2"),
        ("Force", "-1 N"),
        ("Load", "-1 kN/m2"),
        ("Stiffness", "-1 N/m"),
        ("DampingCoefficient", "-1 N s/m"),
        ("RotaryInertia", "-1 kg m2"),
    ],
)
def test_less_than_nothing_is_refused_and_nothing_is_not(kind, negative):
    """A negative mass or damper feeds energy in; 0 leaves it out."""
    assert refusal(kind, negative) == "must be 0 or more"
    assert read(kind, negative.replace("-1", "0")) == 0.0


@pytest.mark.parametrize("value", [1.0, "100 %", -0.01, "-1 %", 3, "300 %"])
def test_a_damping_ratio_is_at_least_0_and_below_1(value):
    """From 1 on nothing vibrates, and 3 is 3 % without its sign."""
    assert "write 3 % or 0.03" in refusal("Ratio", value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_that_toml_has_and_nature_has_not_are_no_ratio(value):
    """TOML writes nan and inf without quotes; neither may reach a computation."""
    assert "finite" in refusal("Ratio", value)


@pytest.mark.parametrize("value", [True, False, None, [], {}, 3, 0.5])
def test_a_length_without_a_unit_is_no_length(value):
    """A bare number says nothing of its unit, not even 0."""
    assert refusal("Length", value) == "a length is written as text with its unit, such as '1 m'"


def test_an_axle_carries_a_mass_or_its_weight():
    """26 kN over 9.81 m/s2 are 2650.4 kg; below a kilogram or beyond 10 000 t it is a slip."""
    assert read("AxleLoad", "26 kN") == pytest.approx(26000 / 9.81)
    assert read("AxleLoad", "2.65 t") == pytest.approx(2650.0)
    assert read("AxleLoad", "1 kg") == 1.0
    assert "this one 0.9 kg" in refusal("AxleLoad", "900 g")
    assert "this one 2e+07 kg" in refusal("AxleLoad", "20000 t")
    assert "'m' is not one of mass" in refusal("AxleLoad", "3 m")


def test_a_place_on_a_grid_is_a_crossing_or_two_lengths():
    """Lengths in units of their own; a crossing keeps its text until the grid is known."""
    assert read("GridPlace", ["600 cm", "-2 m"]) == (6.0, -2.0)
    assert read("GridPlace", "A/1") == "A/1"
    for wrong in ("A", "A/1/2", "", ["1 m"], ["1 m", "2 m", "3 m"], 7, {"x": "1 m"}):
        assert "where two grid lines cross" in refusal("GridPlace", wrong)
    assert "unit is missing" in refusal("GridPlace", ["1", "2 m"])


@pytest.mark.parametrize(
    "name", ["Trüb & Söhne", "a, b; c", "<b>tool & co", "5 % \"x\" 'y'", "東京", "x" * 60]
)
def test_names_of_people_are_names(name):
    """Umlauts, commas, quotes and angle brackets stand in drawings; none breaks a path."""
    assert read("Name", name) == name


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("", "must not be blank"),
        ("   ", "must not be blank"),
        (" tool", "begin or end with a space"),
        ("tool\u00a0", "begin or end with a space"),
        ("to\tol", "without control characters"),
        ("to\nol", "without control characters"),
        ("to\u202eol", "without control characters"),
        ("x" * 61, "at most 60 characters"),
        (".tool", "not beginning with '.'"),
        ("a/b", "without '/'"),
        ("a\\b", "without '/' and"),
    ],
)
def test_names_that_a_path_or_a_line_cannot_hold_are_refused(name, rule):
    """Results are kept in folders by name, and tables are one line a row."""
    assert rule in refusal("Name", name)


@pytest.mark.parametrize("name", ["band", "case", "contact", "method_name", "point", "road", "run"])
def test_a_group_is_not_named_as_a_coordinate_and_a_point_may_be(name):
    """A group and a coordinate of one name overwrite each other in a file; points do not."""
    assert "results have for themselves" in refusal("GroupName", name)
    assert read("Name", name) == name
    assert read("GroupName", f"{name} 2") == f"{name} 2"
