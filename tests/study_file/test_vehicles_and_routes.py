"""Vehicles by data sheet, payload and what shakes them; routes with arcs, lanes and stops."""

import re

import numpy as np
import pytest

from trundle import run_study, study_from_text
from trundle.errors import StudyError
from trundle.vehicle import GRAVITY, library_vehicle

HEAD = """title = "Vehicles and routes"
seed = 1
runs = 2
[floor]
kind = "plan"
mesh_size = "2 m"
x_lines = ["0 m", "12 m", "24 m"]
y_lines = ["0 m", "12 m", "24 m"]
slab_thickness = "0.20 m"
material = { elastic_modulus = "33 GPa", poisson_ratio = 0.2, density = "2450 kg/m3" }
beams_x = { width = "0.5 m", depth = "1.2 m" }
beams_y = { width = "0.4 m", depth = "1.0 m" }
column = { width = "0.7 m", depth = "0.7 m" }
storey_below = "6 m"
storey_above = "6 m"
[[road]]
class = "A"
[roughness]
n_min = "0.05 1/m"
n_max = "5 1/m"
[[point]]
name = "tool"
at = ["6 m", "5 m"]
"""
METHOD = """[[method]]
name = "m"
interaction = "decoupled"
dt = "5 ms"
f_max = "40 Hz"
damping = { ratio = "3 %" }
"""
ROUTE = """[[route]]
name = "way"
vehicle = "v"
path = [["0 m", "6 m"], ["24 m", "6 m"]]
speed = "10 km/h"
"""
VAN = '[vehicle.v]\nkind = "van_vw_vanagon"\n'


def study(vehicle=VAN, route=ROUTE, method=METHOD):
    return study_from_text(HEAD + vehicle + route + method)


def vehicle_of(text):
    return study(f"[vehicle.v]\n{text}\n").drives["way"].vehicle


def mistakes(**parts):
    with pytest.raises(StudyError) as told:
        study(**parts)
    return str(told.value)


def test_a_data_sheet_is_a_vehicle():
    """Loads in tonnes or kN, a wheelbase, a frequency: what it stands and bounces with."""
    vehicle = vehicle_of(
        'kind = "data_sheet"\naxle_loads = ["26 kN", "1.2 t"]\nwheelbase = "1.6 m"\n'
        'bounce = "4 Hz"\ndamping = "8 %"\ncontact_patch = "0.1 m"'
    )
    np.testing.assert_allclose(vehicle.static_forces, [26e3, 1200 * GRAVITY], rtol=1e-9)
    np.testing.assert_allclose(vehicle.natural_frequencies(), 4.0, rtol=1e-9)
    np.testing.assert_allclose(-vehicle.poles().real / np.abs(vehicle.poles()), 0.08, rtol=1e-6)
    assert vehicle.contact_patch == 0.1


def test_a_sheet_with_springs_and_a_load_in_two_states():
    """Laden it presses with its laden loads, on the springs of its larger ones."""
    text = (
        'kind = "data_sheet"\naxle_loads = ["3 t", "2.5 t"]\nladen_axle_loads = ["3.6 t", "7 t"]\n'
        'wheelbase = "4 m"\nbounce = "1.8 Hz"\nhop = "11 Hz"\nunsprung = ["400 kg", "800 kg"]\n'
    )
    empty, laden = vehicle_of(text), vehicle_of(text + "laden = true")
    np.testing.assert_allclose(laden.static_forces / GRAVITY, [3600, 7000], rtol=1e-9)
    np.testing.assert_allclose(empty.static_forces / GRAVITY, [3000, 2500], rtol=1e-9)
    f = laden.natural_frequencies()
    np.testing.assert_allclose(np.sort(f), [1.8, 1.8, 11.0, 11.0], rtol=1e-6)


def test_a_library_vehicle_is_changed():
    """A payload, two sides, tyres of the user's own."""
    plain = library_vehicle("forklift_fl3_laden")
    vehicle = vehicle_of(
        'kind = "forklift_fl3_laden"\ntrack_width = "1 m"\nbounce = "5 Hz"\nwheel_radius = "0.3 m"\n'
        'payload = { mass = "200 kg", setback = "0.2 m", aside = "0.1 m" }'
    )
    assert vehicle.n_contacts == 4
    assert vehicle.total_mass == pytest.approx(plain.total_mass + 200.0)
    assert vehicle.static_forces @ vehicle.lateral == pytest.approx(200.0 * GRAVITY * 0.1)
    ratio = vehicle.contact_stiffness[:2].sum() / plain.contact_stiffness[0]
    assert ratio == pytest.approx((5.0 / 6.0) ** 2)
    assert vehicle.wheel_radius == 0.3


def test_bogies_and_what_shakes_a_vehicle_stand_in_a_study():
    """Every part is where it was put; the run goes to its end."""
    text = """[vehicle.v]
kind = "planar"
bodies = [{ mass = "10 t", pitch_inertia = "20000 kg m2", centre = "2.5 m", height = "1.2 m" }]
axles = [{ setback = "0 m", stiffness = "1 MN/m", damping = "20 kN s/m", axle_mass = "700 kg", tyre_stiffness = "2 MN/m" }]
bogies = [{ setback = "4 m", stiffness = "2 MN/m", damping = "40 kN s/m", mass = "1500 kg", pitch_inertia = "200 kg m2", wheels = ["-0.7 m", "0.7 m"], tyre_stiffness = "3 MN/m" }]
contact_patch = "0.2 m"
out_of_round = [{ amplitude = "0.5 mm", radius = "0.5 m", axle = 1 }]
force = [{ name = "compressor", amplitude = "400 N", frequency = "24 Hz", setback = "3 m", from = "1 s", to = "4 s" }]
"""
    made = study(text, ROUTE.replace('speed = "10 km/h"', 'speeds = [["0 m", "12 km/h"], ["30 m", "8 km/h"]]'))  # fmt: skip
    vehicle = made.drives["way"].vehicle
    np.testing.assert_allclose(vehicle.setback, [0.0, 3.3, 4.7])
    assert vehicle.rounds[0].axle == 0
    assert vehicle.forces[0].during == (1.0, 4.0)
    (cell,) = run_study(made).cells.values()
    assert cell.contact_names == (
        "axle 1",
        "axle 2",
        "axle 3",
        "compressor, inside",
        "braking, inside",
    )
    assert np.isfinite(cell.rms_velocity).all()


def test_a_vehicle_that_lifts_off_is_run_by_newmark_and_says_so():
    """Each road by itself, without exact statistics; modal steps are refused before work."""
    lifting = VAN + "lifts_off = true\n"
    assert "is not linear" in mistakes(vehicle=lifting)
    newmark = METHOD.replace('f_max = "40 Hz"\n', 'integration = "newmark"\n').replace(
        'ratio = "3 %"', 'rayleigh_alpha = "0.5 1/s", rayleigh_beta = "0.0005 s"'
    )
    text = HEAD.replace('class = "A"', 'class = "A"\n[[road]]\nclass = "B"')
    result = run_study(study_from_text(text + lifting + ROUTE + newmark))
    assert len(result.cells) == 2
    for cell in result.cells.values():
        assert cell.exact is None
        assert any("not linear" in one.message for one in cell.warnings)
    # B is what it is by itself, and no multiple of A
    alone = run_study(
        study_from_text(text.replace('class = "A"\n[[road]]\n', "") + lifting + ROUTE + newmark)
    )
    ours, theirs = (
        next(cell for key, cell in one.cells.items() if key.road == "B").rms_velocity
        for one in (result, alone)
    )
    np.testing.assert_array_equal(ours, theirs)


def test_routes_have_arcs_lanes_and_stops():
    """The way is rounded, driven 1 m to the right of it, slower in the curve; wheels are pulled."""
    route = """[[route]]
name = "way"
vehicle = "v"
path = [["0 m", "18 m"], ["18 m", "18 m"], ["18 m", "0 m"]]
radius = "6 m"
lane = "-1 m"
speeds = [["0 m", "15 km/h"], ["10 m", "0 km/h"], ["30 m", "15 km/h"]]
waits = ["3 s"]
"""
    made = study(route=route).drives["way"].route
    assert made.length == pytest.approx(12 + 12 + 3 * np.pi)
    assert made.steering == "tractrix"
    np.testing.assert_allclose(made.locate([0.0])[0], [[0.0, 17.0]])
    law, v = made.law, 15 / 3.6
    assert law.time_to(10.0) == pytest.approx(20.0 / v)
    assert law.time_to(30.0) == pytest.approx(20.0 / v + 3.0 + 40.0 / v)


def test_reversing_and_tables_over_time():
    """Backwards along the path, faster with time."""
    route = ROUTE.replace(
        'speed = "10 km/h"', 'reverse = true\nspeeds_over_time = [["0 s", "0 km/h"], ["4 s", "9 km/h"]]'
    )  # fmt: skip
    made = study(route=route).drives["way"].route
    assert made.reverse
    assert made.law.speed(2.0) == pytest.approx(1.25)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"route": ROUTE.replace('speed = "10 km/h"\n', "")}, "one of speed, speeds .* got none"),
        ({"route": ROUTE + 'waits = ["1 s"]\n'}, "waits are of stops"),
        ({"route": ROUTE + 'reverse = true\nsteering = "tractrix"\n'}, "not pulled"),
        ({"route": ROUTE.replace('speed = "10 km/h"', 'speeds = [["0 m", "0 km/h"], ["9 m", "0 km/h"]]')},
         r"route\[1\].speeds.*speed between two stops"),
        ({"route": ROUTE.replace('["24 m", "6 m"]]', '["12 m", "6 m"], ["12 m", "0 m"]]') + 'radius = "20 m"\n'},
         "does not fit between"),
        ({"vehicle": VAN + 'track_width = "1.5 m"\n',
          "route": ROUTE.replace('["24 m", "6 m"]]', '["12 m", "6 m"], ["12 m", "0 m"]]')},
         "would jump"),
        ({"vehicle": VAN + 'track_width = "1.5 m"\n', "route": ROUTE.replace('"6 m"', '"0.5 m"')},
         r"axle 1 right at .*every wheel must stay on the slabs"),
        ({"route": ROUTE.replace('speed = "10 km/h"', 'speeds = [["0 m", "9 km/h"], ["25 m", "0 km/h"]]')},
         "comes to rest with its front axle 1 m behind"),
        ({"vehicle": VAN + 'bounce = "2 Hz"\n'}, "known by its parts"),
        ({"vehicle": VAN + 'roll_inertia = ["600 kg m2"]\n'}, "give its track_width too"),
        ({"vehicle": VAN + 'payload = { mass = "100 kg", setback = "1 m", aside = "0.2 m" }\n'},
         "rolls its vehicle"),
        ({"vehicle": '[vehicle.v]\nkind = "data_sheet"\naxle_loads = ["2 t", "1 t"]\nwheelbase = "2 m"\n'},
         "how stiff a vehicle is once"),
        ({"vehicle": '[vehicle.v]\nkind = "data_sheet"\naxle_loads = ["2 t", "1 t"]\nbounce = "2 Hz"\n'},
         "say where axles are once"),
        ({"vehicle": '[vehicle.v]\nkind = "data_sheet"\naxle_loads = ["3.5 ton", "1 t"]\nwheelbase = "2 m"\nbounce = "2 Hz"\n'},
         "a 'ton' is 1000 kg, 907 kg or 1016 kg"),
        ({"vehicle": VAN + 'force = [{ amplitude = "9 N" }]\n'}, "a frequency of its own"),
        ({"vehicle": VAN + 'force = [{ amplitude = "9 N", frequency = "9 Hz", from_ = "1 s" }]\n'},
         "did you mean 'from'"),
        ({"vehicle": VAN + 'force = [{ amplitude = "9 N", frequency = "9 Hz", from = "5 s", to = "1 s" }]\n'},
         "to a later one"),
        ({"vehicle": VAN + 'force = [{ amplitude = "9 N", frequency = "900 Hz" }]\n'},
         r"method\[1\]|80 Hz at most"),
        ({"vehicle": VAN + 'out_of_round = [{ amplitude = "1 mm", radius = "0.3 m", axle = 3 }]\n'},
         "no axle 3"),
        ({"vehicle": '[vehicle.v]\nkind = "data_sheet"\naxle_loads = ["1e12 t", "1 t"]\nwheelbase = "2 m"\nbounce = "2 Hz"\n'},
         "an axle carries 1 kg to"),
        ({"route": ROUTE.replace('speed = "10 km/h"', 'speeds = [["0 m", "9 km/h"], ["1 mm", "90 km/h"]]')},
         "no wheel holds more"),
        ({"vehicle": VAN + 'stop = [{ axle = 3, gap = "9 mm", stiffness = "1 MN/m" }]\n'},
         "axle numbers must be 1 to 2"),
    ],
)  # fmt: skip
def test_mistakes_are_named(parts, words):
    assert re.search(words, mistakes(**parts), re.DOTALL)
