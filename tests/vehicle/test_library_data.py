"""Vehicles that ship as data: against an independent solver, and each number with a source.

Frequencies on rigid ground [Hz] and static axle loads [kN] were found by another program from
the same parameters (its own assembly and eigensolver), rounded as they stand here.
"""

import re
import tomllib
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.vehicle import GRAVITY, RETIRED, VEHICLES, library_vehicle, read_vehicle

FOLDER = Path(str(resources.files("trundle.vehicle").joinpath("data")))
FILES = sorted(FOLDER.glob("*.toml"))
COLLECTION = Path(__file__).parents[3] / "shared" / "data" / "vehicles.toml"

# name: (frequencies, loads)
FOUND_INDEPENDENTLY = {
    "tractor_3axle_semitrailer_6_axle": (
        [1.81, 1.947, 2.722, 8.228, 9.915, 10.199, 11.606, 11.61, 11.708],
        [65.38, 64.07, 45.54, 55.57, 58.19, 60.82],
    ),
    "city_bus_2_axle": ([1.78, 2.151, 8.91, 11.112], [65.83, 81.05]),
    "light_truck_4x4_mowag_duro": ([1.288, 1.92, 9.845, 9.939], [23.56, 31.02]),
    "car_ford_escort": ([1.217, 1.611, 12.786, 12.791], [7.41, 4.61]),
    "car_bmw_320i": ([1.42, 1.436, 11.898, 12.06], [5.85, 4.87]),
    "van_vw_vanagon": ([1.405, 1.615, 12.412, 12.557], [7.7, 6.81]),
    "offroad_truck_2_axle_man_5t": ([1.461, 1.985, 6.829, 6.982], [53.74, 38.26]),
    "offroad_truck_3_axle_man_7t": ([1.467, 2.403, 6.806, 6.855, 6.948], [56.03, 33.68, 25.33]),
    "offroad_truck_4_axle_man_10t": (
        [1.513, 2.871, 6.762, 6.765, 6.813, 6.97],
        [54.69, 45.63, 28.54, 21.93],
    ),
    "truck_2_axle_lmtv": ([2.014, 2.564, 7.804, 7.921], [45.41, 32.55]),
    "van_vw_t2": ([1.061, 1.44, 7.754, 12.653], [12.93, 12.11]),
    "utility_vehicle_gator": ([2.624, 3.719, 15.789], [3.71, 5.13]),
    "b_double_9_axle": (
        [
            1.699,
            1.822,
            2.714,
            6.413,
            8.874,
            10.186,
            10.738,
            12.328,
            12.328,
            12.328,
            12.332,
            12.375,
            12.776,
        ],
        [43.68, 64.52, 49.5, 72.82, 76.57, 80.31, 67.78, 66.16, 64.54],
    ),
    "vbi2d_e01_truck_2_axle": ([2.432, 2.744, 15.529, 15.767], [60.33, 60.33]),
    "vbi2d_e01_truck_5_axle": (
        [2.594, 3.743, 4.785, 16.974, 17.632, 17.698, 18.069, 20.031],
        [39.09, 78.75, 65.11, 51.95, 38.79],
    ),
    "vbi2d_a01_truck_2_axle": ([1.551, 2.136, 7.302, 7.499], [58.86, 58.86]),
    "suv_e_class": ([1.851, 2.328, 9.331, 11.007], [10.96, 7.84]),
    "car_7dof_jian2022": ([1.006, 1.269, 8.431, 10.021], [6.14, 6.59]),
}

# those of which every number is assumed, or built from a data sheet: see test_parts.py
BY_THEIR_SOURCES = {"golden_car", "hs20_44", "tow_train"}

TOY = """
title = "Toy"
source = "made up"
confidence = "low"

[[body]]
mass = 1000.0
pitch_inertia = 900.0
centre = 1.0
source = "made up"

[[axle]]
body = 0
setback = 0.0
stiffness = 4e4
damping = 3e3
axle_mass = 60.0
tyre_stiffness = 4e5
source = "made up"

[[axle]]
body = 0
setback = 3.0
stiffness = 4e4
damping = 3e3
axle_mass = 60.0
tyre_stiffness = 4e5
source = "made up"

[worn]
damping = [500.0, 700.0]
source = "made up"

[payload]
mass = 300.0
body = 0
setback = 2.0
source = "made up"
"""


def toy(tmp_path, *changes):
    text = TOY
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "toy.toml"
    file.write_text(text, encoding="utf-8")
    return read_vehicle(file)


def test_each_file_has_an_independent_answer():
    sheets = {file.stem for file in FILES if "\n[sheet]" in file.read_text("utf-8")}
    assert {file.stem for file in FILES} == {*FOUND_INDEPENDENTLY, *sheets, *BY_THEIR_SOURCES}


SHEETS = {  # front and rear axle [kg], empty and laden: of the table or data sheet named in the file
    "forklift_fl1": (0.47 * 21, 0.53 * 21, 26, 5), "forklift_fl2": (0.47 * 31, 0.53 * 31, 40, 6),
    "forklift_fl3": (0.47 * 44, 0.53 * 44, 63, 6), "forklift_fl4": (0.47 * 60, 0.53 * 60, 90, 10),
    "forklift_fl5": (0.47 * 90, 0.53 * 90, 140, 10),
    "forklift_fl6": (0.47 * 110, 0.53 * 110, 170, 20),
}  # fmt: skip


@pytest.mark.parametrize("name", SHEETS)
def test_forklifts_press_as_en_1991_says(name):
    """Table 6.6 for the front axle laden; net weight and lift of Table 6.5 for the sums [kN]."""
    front, rear, laden_front, laden_rear = SHEETS[name]
    empty, laden = (VEHICLES[f"{name}{end}"]().static_forces / 1e3 for end in ("", "_laden"))
    np.testing.assert_allclose(empty, [front, rear], rtol=1e-4)
    np.testing.assert_allclose(laden, [laden_front, laden_rear], rtol=1e-4)


def test_more_than_25_vehicles_each_with_source_and_confidence():
    """States of one vehicle (worn, laden) counted once."""
    assert len(FILES) + 1 >= 25
    for build in VEHICLES.values():
        vehicle = build()
        assert vehicle.source
        assert vehicle.confidence in {"high", "medium", "low"}
        assert vehicle.assumption or vehicle.confidence != "low"


@pytest.mark.parametrize("name", sorted(FOUND_INDEPENDENTLY))
def test_frequencies_and_loads_of_an_independent_solver(name):
    """Half a digit of what it printed: 0.0005 Hz, 0.005 kN."""
    frequencies, loads = FOUND_INDEPENDENTLY[name]
    for state in (name, f"{name}_worn"):
        if state in VEHICLES:  # dampers change neither
            vehicle = VEHICLES[state]()
            found = vehicle.natural_frequencies()
            np.testing.assert_allclose(found, frequencies, rtol=0, atol=5.1e-4)
            np.testing.assert_allclose(vehicle.static_forces / 1e3, loads, rtol=0, atol=5.1e-3)


@pytest.mark.parametrize("name", sorted(FOUND_INDEPENDENTLY))
def test_files_hold_the_numbers_of_the_collection_they_were_taken_from(name):
    """Masses, places, springs and dampers beside the collection, where it is at hand (six decimals)."""
    if not COLLECTION.is_file():
        pytest.skip("the collection of vehicles is not beside this repository")
    theirs = tomllib.loads(COLLECTION.read_text("utf-8"))[name]
    ours = tomllib.loads((FOLDER / f"{name}.toml").read_text("utf-8"))
    bodies = [[b["mass"], b["pitch_inertia"], b["centre"]] for b in ours["body"]]
    keys = ("setback", "stiffness", "damping", "axle_mass", "tyre_stiffness", "tyre_damping")
    axles = [[a["body"], *(a.get(key, 0.0) for key in keys)] for a in ours["axle"]]
    np.testing.assert_allclose(bodies, theirs["bodies"], rtol=1e-6)
    np.testing.assert_allclose(axles, theirs["axles"], rtol=1e-6, atol=1e-9)
    hinges = [[*h["bodies"], h["setback"]] for h in ours.get("hinge", ())]
    assert hinges == theirs["hinges"]
    assert (theirs["f"], theirs["loads"]) == FOUND_INDEPENDENTLY[name]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_number_has_a_source(file):
    data = tomllib.loads(file.read_text("utf-8"))
    tables = [data, *(t for key in ("body", "axle", "hinge", "unit") for t in data.get(key, ()))]
    tables += [data[key] for key in ("worn", "payload", "sheet") if key in data]
    assert all(len(table["source"]) >= 10 for table in tables)
    assert "memory" not in file.read_text("utf-8")
    if "src/chrono" in data["source"] or "CommonRoad" in data["source"]:
        assert re.search(r"BSD-3-Clause", data["source"])


def test_worn_dampers_of_the_bus_are_those_of_the_literature():
    """Body up, wheels still: the damping matrix holds the sum of the suspensions' dampers."""
    new, worn = (VEHICLES[f"city_bus_2_axle{end}"]() for end in ("", "_worn"))
    assert np.asarray(new.system.damping)[0, 0] == pytest.approx(121.1e3 + 152.1e3)
    assert np.asarray(worn.system.damping)[0, 0] == pytest.approx(10e3 + 20e3)
    np.testing.assert_array_equal(np.asarray(new.system.mass), np.asarray(worn.system.mass))


def test_wheels_with_worn_dampers_hop():
    """The long vehicle's six hop modes at 8 to 12 Hz ring: 2 to 20 % of critical, none overdamped.

    One wheel by itself: c / (2 sqrt(m (k + kt))), 6 to 14 %.
    """
    poles = VEHICLES["tractor_3axle_semitrailer_6_axle_worn"]().poles()
    hop = poles[(poles.imag > 2 * np.pi * 7.5)]
    assert len(hop) == 6
    ratios = -hop.real / np.abs(hop)
    k, kt = np.array([1184353, 2052878, 1421223.0]), np.array([1347800, 2695600, 2450000.0])
    m, c = np.array([996.4, 1226.4, 728.0]), np.array([10e3, 20e3, 10e3])
    alone = c / (2 * np.sqrt(m * (k + kt)))
    assert 0.8 * alone.min() < ratios.min() < ratios.max() < 1.25 * alone.max()


def test_a_payload_stands_where_it_is_put(tmp_path):
    """By hand: 300 kg at 2 m of a wheelbase of 3 m adds a third in front, two thirds behind."""
    file = toy(tmp_path)
    states = {name: file.build(**state) for name, state in file.states()}
    assert list(states) == ["toy", "toy_worn", "toy_laden", "toy_laden_worn"]
    added = states["toy_laden"].static_forces - states["toy"].static_forces
    np.testing.assert_allclose(added / GRAVITY, [100.0, 200.0], rtol=1e-9)
    assert np.asarray(states["toy_laden_worn"].system.damping)[0, 0] == pytest.approx(1200.0)
    assert states["toy_laden_worn"].name == "Toy, worn dampers, laden"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("mass = 1000.0", "mas = 1000.0", ["toy.toml, body 1", "mas"]),
        ("mass = 1000.0", "mass = -1.0", ["toy.toml, body 1", "greater than 0"]),
        ('title = "Toy"', "", ["toy.toml", "title"]),
        ('centre = 1.0\nsource = "made up"', "centre = 1.0", ["body 1", "source"]),
        ("[500.0, 700.0]", "[500.0]", ["worn", "2 numbers"]),
        ("[worn]", "[rusty]", ["toy.toml", "rusty", "worn"]),
        ("stiffness = 4e4", "stiffness = 'soft'", ["axle 1", "stiffness"]),
    ],
)
def test_a_bad_file_says_where(tmp_path, old, new, words):
    with pytest.raises(InputError) as caught:
        toy(tmp_path, (old, new))
    assert all(word in str(caught.value) for word in words)


def test_unknown_and_retired_vehicles_say_what_to_use():
    with pytest.raises(InputError, match="did you mean 'city_bus_2_axle'"):
        library_vehicle("city_bus")
    for name in RETIRED:
        with pytest.raises(InputError, match="use 'tractor_3axle_semitrailer_6_axle_worn'"):
            library_vehicle(name)
        assert name not in VEHICLES
    with pytest.raises(InputError, match="no payload"):
        read_vehicle(FOLDER / "golden_car.toml").build(laden=True)
