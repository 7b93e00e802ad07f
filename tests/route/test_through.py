"""Ways through several surfaces: halves of one plate, and a ramp behind a level one."""

from dataclasses import replace

import numpy as np
import pytest

from trundle import study_from_text
from trundle.dynamics import ModalRatio
from trundle.errors import InputError, StudyError
from trundle.road import RoadClass
from trundle.route import ConstantSpeed, Route
from trundle.simulate import Coupled, Crossing, Decoupled, Modal, ensemble, lay_out, prepare
from trundle.simulate.sources.passage import Passage
from trundle.simulate.wheels.surfaces import tracks_on
from trundle.structure import CONCRETE, Floor, Frame, ShellGroup, ShellSection, Spot, Surface
from trundle.vehicle import describe

SECTION = ShellSection(thickness=0.2, material=CONCRETE)
SLOPE = 0.15
VAN = describe("van_vw_vanagon").widened(1.5).build()


def plates(slope=0.0):
    """12 m by 6 m, its edges held; behind x = 6 m it climbs. Surfaces: both halves."""
    x, y = np.meshgrid(np.linspace(0.0, 12.0, 9), np.linspace(0.0, 6.0, 5))
    z = slope * np.maximum(x - 6.0, 0.0)
    nodes = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    at = np.arange(x.size).reshape(x.shape)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1)
    groups = [
        ShellGroup(elements=part.reshape(-1, 4), section=SECTION)
        for part in (quads[:, :4], quads[:, 4:])
    ]
    edge = (x % 12.0 == 0.0) | (y % 6.0 == 0.0)
    up = np.array([1.0, 0.0, slope]) / np.hypot(1.0, slope)
    frames = (
        Frame(origin=np.zeros(3), x_axis=np.array([1.0, 0.0, 0.0]), y_axis=np.array([0.0, 1.0, 0.0])),
        Frame(origin=np.array([6.0, 0.0, 0.0]), x_axis=up, y_axis=np.array([0.0, 1.0, 0.0])),
    )  # fmt: skip
    decks = [
        Surface(name=name, nodes=nodes, groups=(group,), frame=frame)
        for name, group, frame in zip(("near", "far"), groups, frames, strict=True)
    ]
    if slope == 0.0:
        decks.append(Surface(name="whole", nodes=nodes, groups=tuple(groups), frame=frames[0]))
    return Floor(
        nodes=nodes, fixed=np.repeat(edge.ravel()[:, None], 6, axis=1), shells=tuple(groups),
        decks=tuple(decks),
    )  # fmt: skip


def way(**more):
    points = np.array([[0.0, 3.0], [6.0, 3.0], [12.0, 3.0]])
    return Route(points=points, law=ConstantSpeed(3.0), **more)


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
def test_through_two_halves_is_over_the_whole(kind):
    """The same plate, once as one surface and once as two: the same motion, to rounding."""
    floor = plates()
    method = kind(integration=Modal(f_max=90.0, dt=0.005), damping=ModalRatio(ratio=0.03))
    both = [
        ensemble(
            floor, Crossing(VAN, route, RoadClass("B")), method=method,
            points={"a": Spot(4.0, 2.0, "near"), "b": Spot(2.0, 2.0, "far")}, n_runs=2, seed=1,
        )
        for route in (way(on="whole"), way(surfaces=("near", "far")))
    ]  # fmt: skip
    scale = np.abs(both[0].velocity).max()
    np.testing.assert_allclose(both[1].velocity, both[0].velocity, atol=1e-9 * scale)


def test_on_a_ramp_wheels_move_along_the_slope():
    """In plan at 3 m/s they climb at 3 sqrt(1 + 0.15^2), in the ramp's own axis."""
    floor = plates(SLOPE)
    passage = Passage(crossing=Crossing(VAN, way(surfaces=("near", "far")), RoadClass("B")))
    track = passage.track(np.linspace(0.0, 5.0, 101), -3.0)
    near, far = tracks_on(floor, track)
    assert (near.there ^ far.there).all()
    np.testing.assert_allclose(near.stretch, 1.0)
    np.testing.assert_allclose(far.stretch, np.hypot(1.0, SLOPE), rtol=1e-12)
    np.testing.assert_allclose(far.direction, np.tile([1.0, 0.0], (far.direction.shape[0], 1)))
    plan = track.place.reshape(-1, 2)[far.there]
    climbed = far.place[far.there]
    np.testing.assert_allclose(climbed[:, 0], (plan[:, 0] - 6.0) * np.hypot(1.0, SLOPE), atol=1e-9)
    method = Coupled(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=0.03))
    prepared = prepare(floor, method.integration, method.damping)
    layout = lay_out(
        prepared, passage.crossing, method=method, points={"a": Spot(4.0, 2.0, "near")}
    )
    _, speed = layout.rows.window(0, layout.rows.n_steps)
    front = passage.crossing.along(layout.time, -3.0).station[:, 0]
    level, up = (front > 1.0) & (front < 5.9), (front > 6.1) & (front < 11.0)
    np.testing.assert_allclose(speed[level, 0], 3.0)
    np.testing.assert_allclose(speed[up, 0], 3.0 * np.hypot(1.0, SLOPE), rtol=1e-12)
    runs = ensemble(
        floor, passage.crossing, method=method, n_runs=1, seed=1,
        points={"a": Spot(4.0, 2.0, "near"), "b": Spot(2.0, 2.0, "far")},
    )  # fmt: skip
    assert np.isfinite(runs.velocity).all()
    assert runs.velocity.std(axis=1).min() > 0.0


def test_a_little_slope_changes_little():
    """At 1 % the ramp answers as the level plate: to a percent of the largest motion."""
    method = Decoupled(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=0.05))
    found = [
        ensemble(
            floor, Crossing(VAN, way(surfaces=("near", "far")), RoadClass("B")), method=method,
            points={"b": Spot(2.0, 2.0, "far")}, n_runs=1, seed=1,
        ).velocity
        for floor in (plates(1e-12), plates(0.001))
    ]  # fmt: skip
    assert np.abs(found[1] - found[0]).max() < 0.02 * np.abs(found[0]).max()


def test_surfaces_that_do_not_fit_a_way_are_refused():
    """One a leg; and none begins in a rounded corner."""
    with pytest.raises(InputError, match="has 2 legs"):
        way(surfaces=("near",))
    with pytest.raises(InputError, match="in a corner that is rounded"):
        replace(
            way(surfaces=("near", "far")),
            points=np.array([[0.0, 3.0], [6.0, 3.0], [6.0, 6.0]]),
            radius=1.0,
        )


CAR_PARK = """title = "Up a ramp"
seed = 1
runs = 2
[building]
mesh_size = "2 m"
[building.materials.concrete]
elastic_modulus = "33 GPa"
density = "2500 kg/m3"
[building.sections.column]
shape = "rectangle"
width = "0.5 m"
depth = "0.5 m"
material = "concrete"
[building.plates.deck]
thickness = "0.3 m"
material = "concrete"
[[building.storey]]
name = "base"
level = "-3 m"
[[building.storey]]
name = "yard"
level = "0 m"
[[building.storey]]
name = "upper"
level = "1.5 m"
[[building.slab]]
on = "yard"
plate = "deck"
outline = [["0 m", "0 m"], ["12 m", "0 m"], ["12 m", "6 m"], ["0 m", "6 m"]]
[[building.slab]]
on = "upper"
plate = "deck"
outline = [["24 m", "0 m"], ["36 m", "0 m"], ["36 m", "6 m"], ["24 m", "6 m"]]
[[building.ramp]]
name = "ramp"
plate = "deck"
from = "yard"
to = "upper"
outline = [["12 m", "0 m"], ["12 m", "6 m"], ["24 m", "6 m"], ["24 m", "0 m"]]
[[building.column]]
section = "column"
at = [["1 m", "1 m"], ["1 m", "5 m"], ["11 m", "1 m"], ["11 m", "5 m"]]
from = "base"
to = "yard"
base = "fixed"
[[building.column]]
section = "column"
at = [["25 m", "1 m"], ["25 m", "5 m"], ["35 m", "1 m"], ["35 m", "5 m"]]
from = "base"
to = "upper"
base = "fixed"
[vehicle.van]
kind = "van_vw_vanagon"
track_width = "1.5 m"
[[route]]
name = "up"
vehicle = "van"
path = [["0 m", "3 m"], ["12 m", "3 m"], ["24 m", "3 m"], ["36 m", "3 m"]]
on = ["yard", "ramp", "upper"]
speed = "12 km/h"
[[road]]
class = "A"
[roughness]
n_max = "3 1/m"
contact_patch = "0.2 m"
[[point]]
name = "below"
at = ["6 m", "2 m"]
on = "yard"
[[point]]
name = "above"
at = ["30 m", "2 m"]
on = "upper"
[[method]]
name = "coupled"
interaction = "coupled"
dt = "5 ms"
f_max = "30 Hz"
damping = { ratio = "3 %" }
[criteria]
curves = ["VC-A"]
method = "coupled"
"""


@pytest.mark.longest
def test_a_study_drives_up_a_ramp_to_its_report(tmp_path):
    """First the yard is shaken, then the upper deck; the report shows the way on all three."""
    import trundle as tr

    result = tr.run_study(study_from_text(CAR_PARK))
    (cell,) = result.cells.values()
    time, v = cell.history.time, cell.history.velocity
    loudest = time[np.abs(v).argmax(axis=0)]
    assert loudest[0] < 12.0 / (12 / 3.6) + 2.0 < 24.0 / (12 / 3.6) < loudest[1]
    tr.save(result, tmp_path / "out")
    assert (tmp_path / "out" / "report.html").stat().st_size > 1e5
    kept = tr.read_results(tmp_path / "out").study.drives["up"].route
    assert kept.visited == ("yard", "ramp", "upper")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('on = ["yard", "ramp", "upper"]', 'on = ["yard", "ramp"]', "3 legs: name the surface"),
        ('on = ["yard", "ramp", "upper"]', 'on = ["yard", "ramp", "roof"]', "must name a storey"),
        ('["12 m", "3 m"], ["24 m", "3 m"]', '["9 m", "3 m"], ["24 m", "3 m"]',
         "stay on the slabs of 'ramp'"),
('track_width = "1.5 m"', 'track_width = "6.2 m"', "every wheel must stay"),
    ],
)  # fmt: skip
def test_mistakes_of_a_way_through_are_named(old, new, words):
    assert CAR_PARK.count(old) == 1
    with pytest.raises(StudyError, match=words):
        study_from_text(CAR_PARK.replace(old, new))
