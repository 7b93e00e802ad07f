"""Sources other than crossings, surfaces other than one floor, records longer than memory."""

from dataclasses import dataclass

import numpy as np
import pytest

from models import simple_beam, small_floor
from trundle.dynamics import ModalRatio, Rayleigh
from trundle.errors import InputError
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import DriveIn, Route, Track
from trundle.simulate import (
    Coupled,
    Crossing,
    Decoupled,
    Modal,
    Newmark,
    ensemble,
    harmonics,
    lay_out,
    lay_out_places,
    prepare,
)
from trundle.simulate.sources.source import KnownForces
from trundle.simulate.wheels import standing
from trundle.structure import (
    CONCRETE,
    BeamGroup,
    BeamSection,
    Floor,
    Frame,
    Spot,
    Spots,
    Surface,
)
from trundle.vehicle import quarter_car

POINTS = {"tool": (8.0, 4.0)}


@dataclass(frozen=True)
class Shaker(KnownForces):
    """A force ``amplitude sin(2 pi f t)`` that presses at one place."""

    at: tuple[float, float]
    amplitude: float
    frequency: float
    name = "shaker"
    contact_names = ("foot",)
    leaves = 0.0
    on = None

    def track(self, time, begins):
        one = np.ones((len(time), 1))
        place = np.broadcast_to(self.at, (len(time), 1, 2))
        along_x = np.broadcast_to([1.0, 0.0], place.shape)
        return Track(
            on=self.on, place=place, direction=along_x, speed=0.0 * one, share=one,
            share_slope=0.0 * one,
        )  # fmt: skip

    def way(self):
        yield np.array([self.at]), np.array([[1.0, 0.0]])

    def inputs(self, time, begins, seed):
        force = self.amplitude * np.sin(2.0 * np.pi * self.frequency * time)
        return Known(np.where(time < 0.0, 0.0, force)[:, None])

    def excited_to(self, ends):
        return self.frequency


@dataclass(frozen=True)
class Known:
    """The same forces in every run."""

    forces: np.ndarray

    def draw(self, run):
        return self.forces, np.zeros(1)

    def still(self):
        return self.draw(0)


def truck(*, name="way", y=3.0, road=None, on=None):
    return Crossing(
        vehicle=quarter_car(
            body_mass=4500.0, axle_mass=500.0, stiffness=4e5, damping=2e4, tyre_stiffness=2e6,
            tyre_damping=500.0,
        ),
        route=Route(
            points=np.array([[0.0, y], [12.0, y]]),
            law=Route.straight((0.0, 0.0), (1.0, 0.0), speed=6.0).law, name=name, on=on,
        ),
        road=road or RoadClass("B"), band=RoughnessBand(n_max=8.0), entry=DriveIn(length=2.0),
        run_in=5.0,
    )  # fmt: skip


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 1.7])
def test_a_shaker_on_a_beam_is_the_closed_form(kind, ratio):
    """First mode of a simple beam under F sin wt at midspan, steady: ``2 F / (m L) H(w)``."""
    length, line_mass, force, zeta = 10.0, 500.0, 1e3, 0.05
    rigidity = line_mass * (2.0 * np.pi * 5.0) ** 2 * (length / np.pi) ** 4  # first mode 5 Hz
    beam = simple_beam(length=length, rigidity=rigidity, line_mass=line_mass, n_elements=20)
    method = kind(
        integration=Modal(f_max=15.0, dt=0.004, residual=False), damping=ModalRatio(ratio=zeta)
    )
    source = Shaker((5.0, 0.0), force, 5.0 * ratio)
    runs = ensemble(
        beam, source, method=method, points={"mid": (5.0, 0.0)}, n_runs=1, seed=0, duration=20.0
    )
    late = runs.acceleration[0, runs.time > 12.0, 0]
    w, w1 = 2.0 * np.pi * source.frequency, 2.0 * np.pi * 5.0
    gain = 2.0 * force / (line_mass * length) / abs(w1**2 - w**2 + 2j * zeta * w * w1)
    assert np.abs(late).max() == pytest.approx(w**2 * gain, rel=0.01)
    assert runs.contact_forces[0, :, 0] == pytest.approx(
        force * np.sin(w * runs.time), abs=1e-9 * force
    )


METHODS = [
    Decoupled(integration=Modal(f_max=60.0, dt=0.005)),
    Coupled(integration=Modal(f_max=60.0, dt=0.005)),
    Decoupled(integration=Newmark(dt=0.01), damping=Rayleigh(alpha=0.5, beta=1e-3)),
    Coupled(integration=Newmark(dt=0.01), damping=Rayleigh(alpha=0.5, beta=1e-3)),
]


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_truck_and_shaker_together_are_the_sum(method):
    """Everything is linear, and a known force is not changed by what the truck does: exactly."""
    floor, shaker = small_floor(mesh_size=2.0), Shaker((4.0, 2.0), 500.0, 7.0)
    settings = {"method": method, "points": POINTS, "n_runs": 2, "seed": 3, "duration": 4.0}
    prepared = prepare(floor, method.integration, method.damping)
    together = ensemble(prepared, [truck(), shaker], **settings)
    if isinstance(method, Coupled):
        # what the shaker moves under the truck is part of it: twice the shaker, twice its share
        twice = Shaker(shaker.at, 2.0 * shaker.amplitude, shaker.frequency)
        double = ensemble(prepared, [truck(), twice], **settings)
        alone = ensemble(prepared, truck(), **settings)
        expected = 0.5 * (double.acceleration + alone.acceleration)
    else:
        parts = [ensemble(prepared, one, **settings) for one in (truck(), shaker)]
        expected = sum(part.acceleration for part in parts)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(together.acceleration, expected, atol=1e-8 * scale)
    assert together.contact_names[1] == "shaker foot"


def test_exact_statistics_count_a_known_force_in_the_mean_alone():
    """It has no variance: harmonics answer for the truck, and the mean holds the shaker."""
    floor, shaker = small_floor(mesh_size=2.0), Shaker((4.0, 2.0), 500.0, 7.0)
    method = METHODS[0]
    layouts = [
        lay_out(floor, some, method=method, points=POINTS, duration=4.0)
        for some in ([truck()], [truck(), shaker], [shaker])
    ]
    alone, both = (next(harmonics(layout, n_waves=8)) for layout in layouts[:2])
    np.testing.assert_allclose(both.acceleration, alone.acceleration, atol=1e-9)
    shaken = ensemble(floor, shaker, method=method, points=POINTS, n_runs=1, seed=0, duration=4.0)
    difference = both.mean.acceleration - alone.mean.acceleration
    scale = np.abs(shaken.acceleration).max()
    np.testing.assert_allclose(difference, shaken.acceleration[0], atol=1e-8 * scale)
    with pytest.raises(InputError, match="no variance"):
        next(harmonics(layouts[2]))


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_windows_of_a_long_record_leave_what_the_whole_leaves(method, monkeypatch):
    """Rows formed anew window by window are the same bits: histories, and loads of maps."""
    floor = small_floor(mesh_size=2.0)
    prepared = prepare(floor, method.integration, method.damping)
    settings = {"method": method, "points": POINTS, "duration": 4.0}
    crossings = [truck(), truck(name="back", y=4.5)]

    def both():
        layout = lay_out(prepared, crossings, **settings)
        runs = ensemble(prepared, crossings, n_runs=2, seed=3, **settings)
        if method.integration.f_max is None:
            return layout, runs, None
        return layout, runs, lay_out_places(prepared, layout, Spots(xy=np.array([[3.0, 2.0]])))

    held, runs, places = both()
    monkeypatch.setattr(standing, "_HELD", 0.0)
    monkeypatch.setattr(standing, "_WINDOW", 97)
    windows, again, same_places = both()
    assert windows.rows._rows is None
    assert held.rows._rows is not None
    np.testing.assert_array_equal(runs.acceleration, again.acceleration)
    np.testing.assert_array_equal(runs.contact_forces, again.contact_forces)
    if places is not None:
        assert (places.loads != same_places.loads).nnz == 0


def two_storeys():
    """Two slabs, one over the other, on four columns that go through both to fixed feet."""
    low = small_floor(mesh_size=2.0)
    n = len(low.nodes)
    corners = [low.nearest_node(x, y) for x in (0.0, 12.0) for y in (0.0, 6.0)]
    feet = low.nodes[corners] - np.array([0.0, 0.0, 4.0])
    nodes = np.vstack([low.nodes, low.nodes + np.array([0.0, 0.0, 4.0]), feet])
    section = BeamSection(
        area=0.16, inertia_y=2.1e-3, inertia_z=2.1e-3, torsion_constant=3.6e-3, shear_area_y=0.13,
        shear_area_z=0.13, material=CONCRETE,
    )  # fmt: skip
    members = [(2 * n + i, c) for i, c in enumerate(corners)] + [(c, c + n) for c in corners]
    posts = BeamGroup(
        elements=np.array(members), section=section, name="column", up=np.array([1.0, 0.0, 0.0])
    )
    (slab,) = low.shells
    slabs = tuple(type(slab)(elements=slab.elements + k * n, section=slab.section) for k in (0, 1))
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    fixed[2 * n :] = True
    return Floor(
        nodes=nodes, fixed=fixed, shells=slabs, beams=(posts,),
        decks=tuple(
            Surface(name=f"level {k + 1}", nodes=nodes, groups=slabs, frame=Frame.level(4.0 * k))
            for k in (0, 1)
        ),
    )  # fmt: skip


def test_a_truck_on_one_storey_is_felt_on_the_other():
    """Statics at a crawl: the deflection of either storey under the load of the wheel on one."""
    floor = two_storeys()
    points = {"up": Spot(6.0, 2.0, on="level 2"), "down": Spot(6.0, 2.0, on="level 1")}
    method = Decoupled(integration=Modal(f_max=40.0, dt=0.01), damping=ModalRatio(ratio=0.5))
    way = Crossing(
        vehicle=truck().vehicle,
        route=Route(
            points=np.array([[0.0, 2.0], [12.0, 2.0]]), on="level 2",
            law=Route.straight((0.0, 0.0), (1.0, 0.0), speed=0.25).law,
        ),
        road=Profile.smooth(), run_in=0.0, entry=DriveIn(length=2.0),
    )  # fmt: skip
    runs = ensemble(floor, way, method=method, points=points, n_runs=1, seed=0, duration=26.0)
    at_middle = runs.displacement[0, np.argmin(np.abs(runs.time - 24.0))]
    load = np.zeros(floor.n_dofs)
    node = int(np.argmin(np.abs(floor.nodes - [6.0, 2.0, 4.0]).sum(axis=1)))
    load[floor.dof_index[node, 2]] = -way.vehicle.static_forces[0]
    static = floor.flexibility().solve(load)
    below = int(np.argmin(np.abs(floor.nodes - [6.0, 2.0, 0.0]).sum(axis=1)))
    up, down = (static[floor.dof_index[k, 2]] for k in (node, below))
    np.testing.assert_allclose(at_middle, [up, down], rtol=0.005)
    assert up < -10.0 * abs(down) < 0.0
    with pytest.raises(InputError, match="say on which surface"):
        lay_out(floor, way, method=method, points={"a": (6.0, 2.0)})
