"""Arguments of a wrong kind are named with the right one, from every public door."""

import pytest

import trundle as tr
from models import small_floor
from trundle.criteria import VC, assess, find_criterion
from trundle.errors import InputError
from trundle.route import Route
from trundle.run.whole_study import run_study
from trundle.simulate import Coupled, Crossing, Decoupled, ensemble, lay_out, prepare
from trundle.structure import build_floor
from trundle.vehicle import build_vehicle, library_vehicle

TRUCK = library_vehicle("car_bmw_320i")
ROUTE = Route.straight((0.0, 3.0), (12.0, 3.0), speed=5.0, name="main")
ROAD = tr.road.RoadClass("B")


def drive(**changes):
    floor, crossing = small_floor(mesh_size=3.0), Crossing(TRUCK, ROUTE, ROAD)
    values = {
        "floor": floor, "crossings": crossing, "method": Coupled(), "points": {"a": (3.0, 3.0)},
        "n_runs": 1, "seed": 1,
    }  # fmt: skip
    values |= changes
    return ensemble(values.pop("floor"), values.pop("crossings"), **values)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Crossing(TRUCK, ROUTE, "B"), 'road must be a Road, such as RoadClass."B"'),
        (lambda: Crossing("car", ROUTE, ROAD), "vehicle must be a Vehicle, such as library"),
        (lambda: Crossing(TRUCK, [(0, 3), (12, 3)], ROAD), "route must be a Route, such as"),
        (lambda: Crossing(TRUCK, ROUTE, ROAD, entry="abrupt"), 'such as entry_named."abrupt"'),
        (lambda: Crossing(TRUCK, ROUTE, ROAD, band=22.0), "band must be a RoughnessBand"),
        (lambda: Coupled(damping=0.03), "damping must be a Damping, such as Modal"),
        (lambda: Decoupled(integration="newmark"), "integration must be an Integration, such as"),
        (lambda: Coupled(contact="hat"), "contact must be a ContactShape, such as Hermite"),
        (lambda: Route(points=[(0, 0), (1, 0)], law=4.0, name="x"), "law must be a SpeedLaw"),
        (lambda: build_vehicle(name="x", bodies=[1], axles=()), r"bodies\[0\] must be a Body"),
        (lambda: build_floor("plan", mesh_size=1.0), "plan must be a FloorPlan"),
        (lambda: drive(points=[(3.0, 3.0)]), "points must be a mapping of names to places"),
        (lambda: drive(points={"a": 3.0}), r"points\['a'\] must be 2 numbers or a Spot; got 3.0"),
        (lambda: drive(points={"a": (3.0, 3.0, 0.0)}), r"points\['a'\] must be 2 numbers"),
        (lambda: drive(crossings=[TRUCK]), r"crossings\[0\] must be a Crossing"),
        (lambda: drive(method="coupled"), "method must be a Decoupled or a Coupled"),
        (lambda: drive(floor=None), "floor must be a Structure or a PreparedFloor, such as what build"),
        (lambda: lay_out(1, ROUTE, method=Coupled(), points={}), "floor must be"),
        (lambda: prepare(small_floor(), 90.0, 0.03), "integration must be"),
        (lambda: assess("runs", VC), "runs must be a Runs, such as what ensemble"),
        (lambda: run_study("study.toml"), 'study must be a Study, such as load_study."study'),
    ],
)  # fmt: skip
def test_a_wrong_kind_is_named_with_the_right_one(call, words):
    with pytest.raises(InputError, match=words):
        call()


def test_criteria_by_name_alone_are_refused_with_the_way_to_them():
    runs = drive()
    for wrong in ("VC-A", ["VC-A"]):
        with pytest.raises(InputError, match=r"find_criterion\(\"VC-A\"\)"):
            assess(runs, wrong)
    assert assess(runs, find_criterion("VC-A"))


def test_what_fits_passes():
    """A list of crossings; and Python's own words for what no signature has."""
    assert drive(crossings=[Crossing(TRUCK, ROUTE, ROAD)])
    with pytest.raises(TypeError, match="unexpected keyword"):
        Crossing(TRUCK, ROUTE, ROAD, colour="red")
