"""Buildings whose modes are found by their parts, against the same ones in one piece."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from scipy import linalg, sparse

from models import small_floor
from towers import HEIGHT, halfway, tower
from trundle.dynamics import ModalRatio, modes_by_shifts
from trundle.errors import InputError
from trundle.road import RoadClass
from trundle.route import Route
from trundle.simulate import Coupled, Crossing, Modal, ensemble
from trundle.structure import CONCRETE, ShellSection, Spot
from trundle.structure.building import (
    Beam,
    Building,
    Column,
    Meshing,
    Profile,
    Ramp,
    Slab,
    Storey,
    build_building,
)
from trundle.structure.superelements import Cuts, Parting
from trundle.structure.superelements.cuts import shares_of
from trundle.structure.superelements.pieces import like
from trundle.vehicle import library_vehicle

F_MAX = 20.0


@functools.cache
def building():
    return tower(storeys=3, bays_x=4, bays_y=2, mesh_size=1.0)


@functools.cache
def whole_modes():
    return building().modes(F_MAX)


PARTINGS = {
    "storeys": Parting(cuts=Cuts(z=halfway(3)), f_parts=40.0, f_seams=100.0),
    "storeys and units": Parting(
        cuts=Cuts(x=np.array([12.0]), z=halfway(3)), f_parts=60.0, f_seams=100.0
    ),
    "bays": Parting(
        cuts=Cuts(x=np.array([6.0, 12.0, 18.0]), y=np.array([6.0])), f_parts=60.0, f_seams=200.0
    ),
    "halves": Parting(largest=300, f_parts=60.0, f_seams=200.0),
}


@pytest.mark.parametrize("name", PARTINGS)
def test_frequencies_are_those_of_the_whole(name):
    """At two to three times the band within 0.5 %, none too low (Rayleigh and Ritz), sway included."""
    modes = PARTINGS[name].of(building()).modes(F_MAX)
    expected = whole_modes().omega
    n = modes.n_modes
    sure = np.count_nonzero(expected < 2 * np.pi * F_MAX / 1.005)
    assert sure <= n <= len(expected)  # those at 20 Hz itself may be too high
    assert np.all(modes.omega >= expected[:n] * (1.0 - 1e-9))
    np.testing.assert_allclose(modes.omega, expected[:n], rtol=5e-3)
    assert np.median(modes.omega / expected[:n] - 1.0) < 2e-3


def test_pieces_add_up_to_the_whole():
    """Elements in a plane of the cut are shared by halves: nothing is lost, nothing twice."""
    floor = building()
    for parting in PARTINGS.values():
        pieces = parting.of(floor).pieces
        for name in ("stiffness", "mass"):
            total = sparse.csc_array((floor.n_dofs, floor.n_dofs))
            for own in pieces.placed:
                k = getattr(pieces.distinct[own.kind], name).tocoo()
                values = k.data * own.sign[k.row] * own.sign[k.col]
                total = total + sparse.coo_array(
                    (values, (own.dofs[k.row], own.dofs[k.col])), shape=total.shape
                )
            expected = getattr(floor, name)
            assert abs(total - expected).max() < 1e-9 * abs(expected).max()


def test_equal_parts_are_reduced_once():
    """Of two by four bays the corner and the inner ones differ; all others are their mirror images."""
    pieces = PARTINGS["bays"].of(building()).pieces
    assert len(pieces.placed) == 8
    assert len(pieces.distinct) == 2
    kinds = [own.kind for own in pieces.placed]
    assert kinds == [0, 0, 1, 1, 1, 1, 0, 0]


def test_a_mirrored_copy_moves_as_the_mirrored_model():
    """The modes of the left half, seen at mirrored places of the right one, up to their signs."""
    floor = tower(storeys=1, bays_x=2, bays_y=1, mesh_size=1.0)
    parted = Parting(cuts=Cuts(x=np.array([6.0])), f_parts=60.0, f_seams=300.0).of(floor)
    assert len(parted.pieces.distinct) == 1
    modes = parted.modes(30.0)
    uz = floor.dof_index[:, 2]
    where = {tuple(np.round(xyz, 6)): dof for xyz, dof in zip(floor.nodes, uz, strict=True)}
    pairs = [
        (dof, where[(round(12.0 - x, 6), y, z)])
        for (x, y, z), dof in where.items()
        if dof >= 0 and x < 6.0 and (round(12.0 - x, 6), y, z) in where
    ]
    here, there = (modes.at(np.array(some)) for some in zip(*pairs, strict=True))
    size = np.abs(here).max(axis=0)
    even, odd = np.abs(here - there).max(axis=0), np.abs(here + there).max(axis=0)
    assert len(pairs) > 20
    assert np.all(np.minimum(even, odd) < 1e-4 * size)


def test_parts_that_differ_are_told_apart():
    """A slab 1 % thicker, or a hinge, makes another part; the same one moved does not."""
    section = small_floor(mesh_size=2.0)
    thicker = replace(
        section,
        shells=tuple(
            replace(g, section=replace(g.section, thickness=0.202)) for g in section.shells
        ),
    )
    moved = replace(section, nodes=section.nodes + np.array([3.3, -7.1, 2.0]))
    one, other, same = (
        Parting(largest=10**6, f_parts=9.0, f_seams=9.0).of(floor).pieces.distinct[0]
        for floor in (section, thicker, moved)
    )
    assert like(one, other) is None
    assert like(one, same) is not None


def test_shapes_are_orthonormal_and_seen_as_they_are_expanded():
    """Phi^T M Phi is 1 with the whole's mass; rows see what the expanded motion shows."""
    floor = building()
    modes = PARTINGS["bays"].of(floor).modes(F_MAX)
    assert modes.basis is not None
    shapes = modes.basis.expanded(modes.shapes)
    n = modes.n_modes
    np.testing.assert_allclose(shapes.T @ (floor.mass @ shapes), np.eye(n), atol=1e-9)
    rng = np.random.default_rng(3)
    reader = sparse.random_array((7, floor.n_dofs), density=0.05, rng=rng, format="csr")
    np.testing.assert_allclose(modes.seen(reader), reader @ shapes, atol=1e-12)
    dofs = rng.choice(floor.n_dofs, 60, replace=False)
    np.testing.assert_allclose(modes.at(dofs), shapes[dofs], atol=1e-12)
    load = rng.normal(size=floor.n_dofs)
    np.testing.assert_allclose(modes.forces(load), shapes.T @ load, rtol=1e-9, atol=1e-9)
    energies = modes.energies(floor.stiffness)
    np.testing.assert_allclose(energies, modes.omega**2, rtol=1e-6)


def test_the_count_below_any_frequency_is_that_of_the_reduced_matrices():
    """Sylvester and Haynsworth: pieces' own modes and the seams' negative pivots, by dense algebra."""
    joined = PARTINGS["bays"].of(building()).joined
    pencil = joined.pencil
    whole = np.eye(pencil.n_coordinates)
    omega2 = linalg.eigh(pencil.stiffness @ whole, pencil.mass @ whole, eigvals_only=True)
    for f in (3.0, 11.0, 19.0, 45.0):
        shift = (2 * np.pi * f) ** 2
        factor = pencil.factorise(shift)
        assert factor.n_negative == np.count_nonzero(omega2 < shift)
        b = np.random.default_rng(1).normal(size=(pencil.n_coordinates, 2))
        x = factor.solve(b)
        np.testing.assert_allclose(
            pencil.stiffness @ x - shift * (pencil.mass @ x), b, atol=1e-7 * np.abs(b).max()
        )
    found = modes_by_shifts(pencil, f_max=F_MAX)
    np.testing.assert_allclose(found.omega**2, omega2[: found.n_modes], rtol=1e-8)


def test_a_crossing_of_a_parted_building_is_that_of_the_whole():
    """Coupled, storey by storey: RMS and peaks on the deck and below it within 1 %."""
    floor = tower(storeys=2, bays_x=2, bays_y=1, mesh_size=1.0)
    parted = Parting(cuts=Cuts(z=np.array([1.5 * HEIGHT])), f_parts=80.0, f_seams=80.0).of(floor)
    route = Route.straight((0.0, 3.0), (12.0, 3.0), speed=4.0)
    route = replace(route, on="level 2")
    crossing = Crossing(library_vehicle("forklift_fl3_laden"), route, RoadClass("B"))
    method = Coupled(integration=Modal(f_max=40.0, dt=0.01), damping=ModalRatio(ratio=0.03))
    points = {
        "near": Spot(x=4.0, y=2.0, on="level 2"),
        "below": Spot(x=8.0, y=4.0, on="level 1"),
    }
    runs = [
        ensemble(one, crossing, method=method, points=points, n_runs=3, seed=1, duration=6.0)
        for one in (floor, parted)
    ]
    for name in ("velocity", "acceleration"):
        expected, found = (np.asarray(getattr(run, name)) for run in runs)
        rms = np.sqrt((expected**2).mean(axis=1))
        np.testing.assert_allclose(np.sqrt((found**2).mean(axis=1)), rms, rtol=0.01)
        peak = np.abs(expected).max(axis=1)
        np.testing.assert_allclose(np.abs(found).max(axis=1), peak, rtol=0.02)


def test_planes_outside_cut_nothing_and_ends_are_not_shared():
    """A plane along the edge leaves its beams whole; one piece is the structure itself."""
    floor = building()
    for at in (-0.2, 24.2, -3.0, 50.0):  # its edge lies along the columns' faces
        shares = shares_of(floor.elements, floor.nodes, Cuts(x=np.array([at])))
        assert all(np.all(share.weight == 1.0) and not share.piece.any() for share in shares)
    inner = shares_of(floor.elements, floor.nodes, Cuts(x=np.array([12.0])))
    for group, share in zip(floor.elements, inner, strict=True):
        total = np.bincount(share.element, weights=share.weight)
        np.testing.assert_allclose(total, np.ones(len(group.connectivity)))
    assert any(np.any(share.weight == 0.5) for share in inner)


def test_a_beam_where_planes_cross_hangs_on_the_pieces_that_carry_it():
    """A ramp rises through the crossing of two planes; the beam across it there has four neighbours.

    Two hold a half of the ramp each, and carry a half of the beam; in the two others it would
    float, and their stiffness have six motions without strain. Frequencies are the whole's.
    """
    slab = ShellSection(thickness=0.2, material=CONCRETE)
    corners = np.array([[12.0, 0.0], [12.0, 3.0], [24.0, 3.0], [24.0, 0.0]])
    ramp = Ramp(name="ramp", section=slab, outline=corners, bottom="level 1", top="level 2")
    rib = Profile.rectangle(0.3, 0.5, CONCRETE)
    across = Beam(profile=rib, along=np.array([[18.0, 0.0], [18.0, 3.0]]), on="ramp")
    floor = crossed(ramp, across)
    cuts = Cuts(x=np.array([18.0]), z=halfway(2))
    shares = shares_of(floor.elements, floor.nodes, cuts)
    for group, share in zip(floor.elements, shares, strict=True):
        total = np.bincount(share.element, weights=share.weight)
        np.testing.assert_allclose(total, np.ones(len(group.connectivity)))
        middle = floor.nodes[group.connectivity].mean(axis=1)
        on = (np.abs(middle[:, [0, 2]] - [18.0, 1.5 * HEIGHT]) < 1e-6).all(axis=1)
        counted = np.bincount(share.element, minlength=len(on))[on]
        assert (counted == 2).all()
    parted = Parting(cuts=cuts, f_parts=60.0, f_seams=200.0).of(floor).modes(15.0)
    whole = floor.modes(15.0)
    np.testing.assert_allclose(parted.omega, whole.omega[: parted.n_modes], rtol=5e-3)


def crossed(ramp, across):
    """Two decks on columns, the lower one to the left, and a ramp from it to the upper one."""
    slab = ShellSection(thickness=0.2, material=CONCRETE, superimposed_mass=200.0)
    post = Profile.rectangle(0.4, 0.4, CONCRETE)
    levels = ("level 0", "level 1", "level 2")
    sides = {"level 1": (6.0, 12.0), "level 2": (24.0, 30.0)}
    building = Building(
        name="ramp between two decks",
        storeys=tuple(Storey(name=name, level=HEIGHT * i) for i, name in enumerate(levels)),
        slabs=tuple(
            Slab(on=on, section=slab, outline=np.array([[a, 0], [b, 0], [b, 3], [a, 3]], float))
            for on, (a, b) in sides.items()
        ),
        columns=tuple(
            Column(profile=post, at=np.array([x, y]), bottom="level 0", top=on, base="fixed")
            for on, both in sides.items()
            for x in both
            for y in (0.0, 3.0)
        ),
        beams=(across,),
        ramps=(ramp,),
    )
    return build_building(building, Meshing(mesh_size=1.0))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "either by planes or"),
        ({"largest": 100, "cuts": Cuts(x=np.array([1.0]))}, "either by planes or"),
        ({"largest": 100, "f_parts": 0.0}, "f_parts must be"),
        ({"largest": 100, "f_parts": 50.0}, "at least as far as those of parts"),
    ],
)
def test_partings_that_cannot_be_are_refused(values, message):
    """Nothing is cut, everything twice, or seams are kept to less than parts."""
    with pytest.raises(InputError, match=message):
        Parting(**{"f_parts": 20.0, "f_seams": 40.0, **values})


def test_modes_beyond_what_parts_are_kept_to_are_refused():
    """A part without modes of its own at 50 Hz cannot show the building's there."""
    with pytest.raises(InputError, match="not enough for modes to 50 Hz: keep them to 100 Hz"):
        PARTINGS["storeys"].of(building()).modes(50.0)


def test_static_deflections_are_those_of_the_whole():
    """K^-1 by parts and seams, against the whole's factor: exact where seams keep all dofs."""
    floor = building()
    parted = PARTINGS["storeys"].of(floor)
    flexibility, exact = parted.flexibility(), floor.flexibility()
    rng = np.random.default_rng(5)
    load = rng.normal(size=(floor.n_dofs, 3))
    expected = exact.solve(load)
    np.testing.assert_allclose(
        flexibility.solve(load), expected, atol=1e-9 * np.abs(expected).max()
    )
    dofs = rng.choice(floor.n_dofs, 40, replace=False)
    unit = sparse.csr_array((np.ones(40), (np.arange(40), dofs)), shape=(40, floor.n_dofs))
    points = sparse.random_array((3, floor.n_dofs), density=0.01, rng=rng, format="csr")
    expected = points @ exact.solve(unit.toarray().T)
    found = flexibility.between(points, unit)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_deflections_across_long_seams_grow_to_those_of_the_whole():
    """On a seam written by shapes of its own a load sinks less, and less so with more of them (Ritz)."""
    floor = building()
    at = floor.nodes - np.array([6.0, 3.0, 2 * HEIGHT])
    node = int(np.argmin((at**2).sum(axis=1)))
    dof = np.array([floor.dof_index[node, 2]])
    unit = sparse.csr_array(([1.0], ([0], dof)), shape=(1, floor.n_dofs))
    exact = floor.flexibility().solve(unit.toarray().T)[dof]
    found = []
    for f_seams in (100.0, 200.0, 400.0, 2000.0):
        parting = Parting(cuts=PARTINGS["bays"].cuts, f_parts=20.0, f_seams=f_seams)
        found.append(float(parting.of(floor).flexibility().between(unit, unit)[0, 0] / exact[0, 0]))
    assert np.all(np.diff(found) > 0.0)
    assert found[-1] < 1.0 + 1e-9
    assert found[0] > 0.9
    assert found[-1] > 0.99


def test_planes_must_rise():
    """Two planes in one place part nothing."""
    with pytest.raises(InputError, match="must rise"):
        Cuts(y=np.array([2.0, 2.0]))
