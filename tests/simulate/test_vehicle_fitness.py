"""Doubts about vehicles: who can hop, and who cannot."""

import pytest

from trundle.road import RoadClass
from trundle.route import Route
from trundle.simulate import Crossing
from trundle.simulate.sources.axle_hop import axle_hop_warnings
from trundle.vehicle import VEHICLES, library_vehicle, quarter_car, sprung_mass


def crossing(vehicle):
    return Crossing(vehicle, Route.straight((0, 0), (10, 0), speed=4.0), RoadClass("B"))


def test_the_papers_truck_cannot_hop_and_says_what_to_do():
    """Its highest natural frequency is 2.48 Hz (Pan, Mita and Li, Figure 6)."""
    (warning,) = axle_hop_warnings((crossing(VEHICLES["container_truck_40ft"]()),) * 2)
    text = str(warning)
    for word in ("axle hop", "40-ft container truck", "2.48 Hz", "8 to 15 Hz", "axle_mass",
                 "trundle vehicles"):  # fmt: skip
        assert word in text


# on tyres alone, and slower than wheels hop
SLOW = {"container_truck_40ft", "reach_stacker_45t", "reach_stacker_45t_laden"}


@pytest.mark.parametrize("name", sorted(set(VEHICLES) - SLOW))
def test_vehicles_with_unsprung_masses_are_not_doubted(name):
    assert axle_hop_warnings((crossing(library_vehicle(name)),)) == ()


def test_a_stiff_cart_without_suspension_is_not_doubted_and_a_soft_one_is():
    """By hand: sqrt(k / m) / 2 pi = 10 and 4 Hz; a quarter car with a slow wheel has a wheel."""
    stiff = sprung_mass(mass=1000.0, stiffness=1000.0 * (2 * 3.141592653589793 * 10.0) ** 2)
    soft = sprung_mass(mass=1000.0, stiffness=1000.0 * (2 * 3.141592653589793 * 4.0) ** 2)
    slow = quarter_car(
        body_mass=400.0, axle_mass=300.0, stiffness=2e4, damping=1e3, tyre_stiffness=2e5
    )
    assert slow.natural_frequencies()[-1] < 8.0
    found = axle_hop_warnings((crossing(stiff), crossing(slow), crossing(soft)))
    assert ["4 Hz at most" in str(warning) for warning in found] == [True]


def test_a_run_carries_the_doubt():
    from models import small_floor
    from trundle.simulate import Decoupled, Modal, ensemble

    runs = ensemble(
        small_floor(),
        Crossing(
            VEHICLES["container_truck_40ft"](),
            Route.straight((0.0, 3.0), (12.0, 3.0), speed=4.0),
            RoadClass("B"),
            run_in=0.0,
        ),
        method=Decoupled(integration=Modal(f_max=30.0, dt=0.01)),
        points={"p": (6.0, 3.0)},
        n_runs=1,
        seed=1,
        duration=1.0,
    )
    assert any(warning.subject.startswith("axle hop") for warning in runs.warnings)
