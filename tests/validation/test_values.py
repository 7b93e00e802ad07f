"""The verification list's values, recomputed without trundle, beside those the tests compare with.

The scripts in `scripts/verification` use numpy and scipy alone; each says its equations. A value
agrees where it rounds to the printed digits. Two kinds do not quite: the peak acceleration of the
truck on the undamped beam (modes to 1 kHz: its fourth digit is the solver's tolerance), and the
slow level of the burst (0.26145, printed 0.262).
"""

import sys
from pathlib import Path

import numpy as np
import pytest

SCRIPTS = Path(__file__).parents[2] / "scripts"
if not (SCRIPTS / "verification").is_dir():
    pytest.skip("the scripts are not here", allow_module_level=True)
sys.path.insert(0, str(SCRIPTS))

import test_v1_moving_force  # noqa: E402  (the scripts' folder is on the path first)
import test_v2_sprung_mass  # noqa: E402
import test_v3_moving_mass  # noqa: E402
import test_v4_plate  # noqa: E402
import test_v5_container_truck  # noqa: E402
import test_v6_road  # noqa: E402
import test_v7_one_axle  # noqa: E402
from verification import (  # noqa: E402
    v1_moving_force,
    v2_sprung_mass,
    v3_moving_mass,
    v4_plate,
    v5_container_truck,
    v6_road,
    v7_one_axle,
    v8_bands,
)

from trundle.simulate import Coupled  # noqa: E402

CASE = "values"
SOURCE = "scripts/verification, numpy and scipy alone"


def state(record, values):
    for value in values:
        record.row(
            f"{value.case}, {value.quantity}", value.expected, value.computed, unit=value.unit,
            atol=value.allowed,
        )  # fmt: skip


@pytest.mark.parametrize("case", [v1_moving_force, v4_plate, v6_road, v7_one_axle, v8_bands])
def test_quick_cases(record, case):
    state(record, case.values())


@pytest.mark.longest
@pytest.mark.parametrize("case", [v2_sprung_mass, v3_moving_mass])
def test_ode_cases(record, case):
    state(record, case.values())


@pytest.mark.longest
@pytest.mark.parametrize(("kmh", "coupled"), v5_container_truck.PRINTED)
def test_container_truck(record, kmh, coupled):
    state(record, v5_container_truck.crossing_values(kmh, coupled=coupled))


def test_the_scripts_import_nothing_of_trundle():
    for file in (SCRIPTS / "verification").glob("*.py"):
        imports = [s for s in file.read_text("utf-8").splitlines() if "import" in s.split()]
        assert not any("trundle" in s.split(".")[0] for s in imports), file


def numbers(printed):
    return np.array([float(text) for text in printed])


def test_the_tests_compare_with_the_same_constants():
    """What the scripts print beside is what the tests of V1 to V7 expect of trundle."""
    v1 = dict([*v1_moving_force.FACTORS.items(), v1_moving_force.LARGEST])
    assert {float(a): float(p) for a, p in v1.items()} == test_v1_moving_force.FACTORS
    after = {float(a): float(p) for a, p in v1_moving_force.AFTER_THE_EXIT.items()}
    assert after == test_v1_moving_force.AFTER_THE_EXIT
    for acceleration, printed in v2_sprung_mass.PRINTED.items():
        assert tuple(numbers(printed)) == test_v2_sprung_mass.LISTED[acceleration]
    for cell, printed in v3_moving_mass.FACTORS.items():
        assert tuple(numbers(printed)) == test_v3_moving_mass.FACTORS[cell]
    for name, plate in v4_plate.PLATES.items():
        tested = test_v4_plate.PLATES[name]
        assert list(numbers(f for *_, f in plate.frequencies)) == tested["f"]
        assert float(plate.static) == tested["static"]
        assert (float(plate.largest), float(plate.when)) == (tested["largest"], tested["time"])
    assert tuple(numbers(v5_container_truck.STATICS)) == test_v5_container_truck.STATICS
    for (kind, kmh), tested in test_v5_container_truck.LISTED.items():
        printed = v5_container_truck.PRINTED[kmh, kind is Coupled]
        assert tuple(numbers(printed)) == tested
    assert {c: float(p) for c, p in v6_road.PRINTED.items()} == test_v6_road.SIGMAS
    assert {c: float(p) for c, p in v7_one_axle.PRINTED.items()} == test_v7_one_axle.SIGMAS
    assert float(v7_one_axle.FORCE[2]) == test_v7_one_axle.FORCE
