"""Transfer functions: closed forms, reciprocity, all dofs at once, and histories that reach them."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu
from test_sources import Shaker

from models import simple_beam, small_floor
from trundle.dynamics import ModalRatio, Rayleigh
from trundle.errors import InputError
from trundle.simulate import (
    Coupled,
    Decoupled,
    Modal,
    Newmark,
    TransferFunctions,
    ensemble,
    prepare,
    transfer,
)
from trundle.simulate.laying_out import point_rows
from trundle.simulate.spectral import transfer as transfers
from trundle.structure import (
    FaceGroup,
    FloorPlan,
    Frame,
    Material,
    MatrixModel,
    ShellSection,
    Spot,
    Surface,
    build_floor,
)

MACHINE, TOOL = {"machine": (3.0, 2.0)}, {"tool": (8.0, 4.0)}
PLACES = {**MACHINE, **TOOL, "off nodes": (10.3, 1.1)}
PAPER = Rayleigh(alpha=0.8587, beta=0.001)


def in_all_dofs(floor, damping, loads, points, frequencies):
    """The other way: ``(K + i w C - w^2 M) u = p`` solved whole at every line, without any mode."""
    mass, stiffness = (sparse.csc_array(part) for part in floor.matrices())
    c = damping.alpha * mass + damping.beta * stiffness
    pressed, read = point_rows(floor, loads), point_rows(floor, points)
    out = np.empty((len(loads), len(points), len(frequencies)), dtype=complex)
    for k, w in enumerate(2.0 * np.pi * np.asarray(frequencies)):
        whole = sparse.csc_array(stiffness + 1j * w * c - w**2 * mass)
        out[:, :, k] = (read @ splu(whole).solve(pressed.T.toarray().astype(complex))).T
    return out


def one_mass(*, mass, stiffness):
    """A slab that is a mass on a spring: all four corners are the same dof."""
    nodes = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 0.0]])
    rows = np.full((4, 6), -1)
    rows[:, 2] = 0
    faces = (FaceGroup(connectivity=np.array([[0, 1, 2, 3]])),)
    return MatrixModel(
        nodes=nodes, dof_index=rows, mass=sparse.csc_array([[mass]]), faces=faces,
        stiffness=sparse.csc_array([[stiffness]]),
        decks=(Surface(name="floor", nodes=nodes, groups=faces, frame=Frame.level(0.0)),),
    )  # fmt: skip


def test_a_mass_on_a_spring_is_its_formula_in_all_three_quantities():
    """``1 / (k - m w^2 + i w c)``, ``i w`` and ``-w^2`` times it: no mode is left out, so exactly."""
    mass, stiffness, zeta = 2000.0, 2000.0 * (2.0 * np.pi * 5.0) ** 2, 0.04
    lines = np.array([0.0, 1.0, 4.9, 5.0, 5.1, 20.0])
    found = transfer(
        one_mass(mass=mass, stiffness=stiffness), {"machine": (1.0, 1.0)}, {"tool": (3.5, 2.0)},
        lines, damping=ModalRatio(ratio=zeta),
    )  # fmt: skip
    w = 2.0 * np.pi * lines
    formula = 1.0 / (stiffness - mass * w**2 + 2j * zeta * np.sqrt(stiffness * mass) * w)
    np.testing.assert_allclose(found.receptance[0, 0], formula, rtol=1e-9)
    np.testing.assert_allclose(found.mobility[0, 0], 1j * w * formula, rtol=1e-9)
    np.testing.assert_allclose(found.accelerance[0, 0], -(w**2) * formula, rtol=1e-9)
    # a real and positive answer to a force that does not change, 1 / c of a dashpot at resonance
    assert found.receptance[0, 0, 0] == pytest.approx(1.0 / stiffness, rel=1e-9)
    dashpot = 2.0 * zeta * np.sqrt(stiffness * mass)
    assert found.mobility[0, 0, 3] == pytest.approx(1.0 / dashpot, rel=1e-9)
    assert repr(found) == "<TransferFunctions from machine to tool: 6 lines, 0 to 20 Hz>"


def beam_by_series(x, y, lines, *, length, rigidity, line_mass, zeta, n=4000):
    """All modes of a simple beam: ``2 / (m L) sum sin sin / (wn^2 - w^2 + 2 i zeta wn w)``."""
    k = np.arange(1, n + 1) * np.pi / length
    wn, w = k**2 * np.sqrt(rigidity / line_mass), 2.0 * np.pi * lines[:, None]
    both = np.sin(k * x) * np.sin(k * y) * 2.0 / (line_mass * length)
    return (both / (wn**2 - w**2 + 2j * zeta * wn * w)).sum(axis=1)


@pytest.mark.parametrize(("x", "y"), [(5.0, 5.0), (2.5, 6.0), (3.3, 8.1)])
def test_a_beam_is_the_sum_of_its_sine_modes(x, y):
    """Thin beam, 40 elements: the mesh is right to 1e-4 in frequency, 3 % damping bounds its effect."""
    beam = {"length": 10.0, "rigidity": 2e8, "line_mass": 500.0}
    lines = np.array([0.0, 3.0, 9.0, 9.9, 12.0, 25.0, 39.7, 60.0])
    found = transfer(
        simple_beam(**beam, n_elements=40), {"a": (x, 0.0)}, {"b": (y, 0.0)}, lines,
        integration=Modal(f_max=500.0, dt=1e-3), damping=ModalRatio(ratio=0.03),
    )  # fmt: skip
    series = beam_by_series(x, y, lines, **beam, zeta=0.03)
    np.testing.assert_allclose(
        found.receptance[0, 0], series, rtol=1e-3, atol=1e-3 * np.abs(series).min()
    )


def thin_plate(length, width, thickness, mesh):
    """A plate on four bearings, twenty times thinner than its stiffness and mass: Kirchhoff's."""
    material = Material(elastic_modulus=30e9 * 20.0**3, poisson_ratio=0.2, density=2500.0 * 20.0)
    plan = FloorPlan(
        x_lines=np.array([0.0, length]), y_lines=np.array([0.0, width]), x_extent=(0.0, length),
        y_extent=(0.0, width), material=material,
        slab=ShellSection(thickness=thickness / 20.0, material=material),
        edges=dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "pinned"),
    )  # fmt: skip
    return build_floor(plan, mesh_size=mesh)


def test_a_plate_is_naviers_double_series():
    """``4 / (mu a b) sum sin sin sin sin / (wmn^2 - w^2 + 2 i zeta wmn w)``, 200 x 200 terms.

    The mesh of 24 elements a side has its first frequencies 0.2 to 0.8 % off (error of order h^2);
    at 5 % damping a shift of 0.8 % changes an answer near resonance by at most 0.008 / 0.05 / 2.
    """
    a, b, h, zeta = 8.0, 6.0, 0.2, 0.05
    machine, tool = (2.0, 1.5), (5.0, 4.0)
    lines = np.array([0.0, 5.0, 10.0, 17.0, 30.0, 45.0])
    found = transfer(
        thin_plate(a, b, h, 0.25), {"machine": machine}, {"tool": tool}, lines,
        integration=Modal(f_max=160.0, dt=1e-3), damping=ModalRatio(ratio=zeta),
    )  # fmt: skip
    rigidity, area_mass = 30e9 * h**3 / 12.0 / (1.0 - 0.2**2), 2500.0 * h
    m, n = (np.pi * np.arange(1, 201) / side for side in (a, b))
    (x, y), (u, v) = machine, tool
    wmn = np.add.outer(m**2, n**2) * np.sqrt(rigidity / area_mass)
    both = np.outer(np.sin(m * x) * np.sin(m * u), np.sin(n * y) * np.sin(n * v))
    w = 2.0 * np.pi * lines[:, None, None]
    series = (
        (both / (wmn**2 - w**2 + 2j * zeta * wmn * w)).sum(axis=(1, 2)) * 4.0 / (area_mass * a * b)
    )
    np.testing.assert_allclose(found.receptance[0, 0], series, rtol=0.08)
    np.testing.assert_allclose(found.receptance[0, 0, 0], series[0], rtol=5e-3)


@pytest.mark.parametrize("kind", ["modal", "newmark", "structure"])
def test_it_is_the_solution_in_all_dofs(kind):
    """Every line solved whole, each answer against the largest at its line.

    Modes to 400 Hz leave those above to their static rest, wrong by ``(30 / 400)^2`` of what they do,
    which is a tenth of the whole: below 1e-3. A floor without modes of its own takes those to three
    times the highest line: ``1 / 3^2`` of that tenth, 1.2 %.
    """
    floor = small_floor(mesh_size=1.5)
    lines = np.array([0.0, 2.0, 6.0, 9.3, 14.0, 21.0, 30.0])
    modal, direct = Modal(f_max=400.0, dt=1e-3), Newmark(dt=1e-3)
    settings = {
        "modal": {"floor": prepare(floor, modal, PAPER)},
        "newmark": {"floor": prepare(floor, direct, PAPER)},
        "structure": {"floor": floor, "integration": modal, "damping": PAPER},
    }[kind]  # fmt: skip
    found = transfer(settings.pop("floor"), PLACES, PLACES, lines, **settings)
    whole = in_all_dofs(floor, PAPER, PLACES, PLACES, lines)
    tolerance = 1e-3 if kind != "newmark" else 0.012
    scale = np.abs(whole).max(axis=(0, 1))
    assert (np.abs(found.receptance - whole).max(axis=(0, 1)) < tolerance * scale).all()
    static = np.abs(found.receptance[:, :, 0] - whole[:, :, 0])
    assert (static < 1e-9 * np.abs(whole[:, :, 0]).max()).all()


def test_the_static_rest_is_what_makes_it_so():
    """The same modes without it: under the machine much of the sinking is missing, statically too."""
    floor = small_floor(mesh_size=1.5)
    whole = in_all_dofs(floor, PAPER, MACHINE, MACHINE, [0.0, 8.0])
    errors = {
        rest: np.abs(
            transfer(
                floor, MACHINE, MACHINE, [0.0, 8.0], damping=PAPER,
                integration=Modal(f_max=30.0, dt=1e-3, residual=rest),
            ).receptance - whole
        ).max() / np.abs(whole).max()
        for rest in (True, False)
    }  # fmt: skip
    assert errors[True] < 0.01
    assert errors[False] > 5.0 * errors[True]


@pytest.mark.parametrize("f_max", [20.0, 100.0])
def test_there_and_back_are_the_same(f_max):
    """Betti and Maxwell: mass, damping and stiffness are symmetric; to round-off."""
    found = transfer(
        small_floor(mesh_size=1.5), PLACES, PLACES, np.linspace(0.0, 0.8 * f_max, 50),
        integration=Modal(f_max=f_max, dt=1e-3), damping=ModalRatio(ratio=0.02),
    ).receptance  # fmt: skip
    back = found.transpose(1, 0, 2)
    np.testing.assert_allclose(found, back, atol=1e-10 * np.abs(found).max())
    # a force does work on what it drives: at the load itself the mobility has a positive real part
    for i in range(len(PLACES)):
        assert (found[i, i, 1:].imag < 0.0).all()
        assert found[i, i, 0].real > 0.0


def test_chunks_of_lines_leave_the_same(monkeypatch):
    """However little room there is: two lines at a time."""
    settings = {"integration": Modal(f_max=60.0, dt=1e-3), "damping": ModalRatio(ratio=0.02)}
    floor, lines = small_floor(mesh_size=2.0), np.linspace(1.0, 40.0, 23)
    whole = transfer(floor, PLACES, TOOL, lines, **settings).receptance
    modes = floor.modes(60.0).n_modes
    monkeypatch.setattr(transfers, "_BYTES", 2 * 16 * 3 * modes)
    np.testing.assert_allclose(
        transfer(floor, PLACES, TOOL, lines, **settings).receptance, whole, rtol=1e-12,
        atol=1e-14 * np.abs(whole).max(),
    )  # fmt: skip


METHODS = [
    Decoupled(integration=Modal(f_max=100.0, dt=0.002), damping=ModalRatio(ratio=0.05)),
    Coupled(integration=Modal(f_max=100.0, dt=0.002), damping=PAPER),
    Decoupled(integration=Newmark(dt=0.002), damping=PAPER),
]


@pytest.mark.parametrize("f", [7.0, 12.0])
@pytest.mark.parametrize("method", METHODS, ids=str)
def test_a_history_under_a_shaker_comes_to_its_amplitude_and_phase(method, f):
    """Steady state: fitted sines of the last second are ``-H F`` for a force that presses.

    Newmark's period is ``(w dt)^2 / 12`` too long, below 2e-3 here; the modal recursion has no
    such error. Of the start 3 % at 6 Hz leave exp(-4.5) after 4 s, and the fit a tenth of that.
    """
    floor, force = small_floor(mesh_size=3.0), 400.0
    runs = ensemble(
        floor, Shaker(MACHINE["machine"], force, f), method=method, points=TOOL, n_runs=1, seed=0,
        duration=5.0,
    )  # fmt: skip
    late = runs.time > 4.0
    basis = np.exp(2j * np.pi * f * runs.time[late])
    both = np.column_stack([basis.imag, basis.real])
    (sine, cosine), *_ = np.linalg.lstsq(both, runs.velocity[0, late, 0], rcond=None)
    found = transfer(
        floor, MACHINE, TOOL, [f], integration=method.integration, damping=method.damping
    )
    assert abs(sine + 1j * cosine) == pytest.approx(force * abs(found.mobility[0, 0, 0]), rel=0.01)
    assert sine + 1j * cosine == pytest.approx(-force * found.mobility[0, 0, 0], rel=0.03)


def test_level_motion_by_a_level_force_and_through_the_slab():
    """A frame pushed along x moves along x; crosswise answers are there and back the same."""
    floor = small_floor(mesh_size=1.5)
    places = {"push": Spot(6.0, 3.0, axis="x"), "press": Spot(3.0, 3.0)}
    lines = np.array([0.0, 2.0, 10.0])
    found = transfer(floor, places, places, lines, integration=Modal(f_max=300.0, dt=1e-3),
                     damping=PAPER).receptance  # fmt: skip
    whole = in_all_dofs(floor, PAPER, places, places, lines)
    scale = np.abs(whole).max(axis=(0, 1))
    assert (np.abs(found - whole).max(axis=(0, 1)) < 1e-3 * scale).all()
    assert found[0, 0, 0].real > 0.0


def test_half_a_floor_stands_for_both_halves():
    """A force in the mirror plane is that on the whole floor; off it, it acts with its image."""
    half = small_floor(mesh_size=1.5, x_extent=(0.0, 6.0), x_lines=np.array([0.0, 6.0]),
                       edges={"x_max": "symmetry"})  # fmt: skip
    settings = {"integration": Modal(f_max=200.0, dt=1e-3), "damping": PAPER}
    lines, read = np.array([0.0, 7.0, 13.0]), {"tool": (3.0, 4.0)}
    loads = {"in plane": (6.0, 3.0), "off": (3.0, 2.0), "image": (9.0, 2.0)}
    whole = transfer(small_floor(mesh_size=1.5), loads, read, lines, **settings)
    there = {name: loads[name] for name in ("in plane", "off")}
    found = transfer(half, there, read, lines, **settings)
    expected = np.array([whole.receptance[0], whole.receptance[1] + whole.receptance[2]])
    # higher modes that only the whole has are left out at other frequencies: statics tell them apart
    np.testing.assert_allclose(found.receptance, expected, rtol=1e-3)
    assert any(doubt.subject == "mirror planes" for doubt in found.doubts)
    assert not any(doubt.subject == "mirror planes" for doubt in whole.doubts)


def test_lines_too_far_apart_for_its_peaks_are_a_doubt():
    """Between lines d apart a peak of half width zeta f is shown at ``1 / sqrt(1 + (d / 2 zeta f)^2)``."""
    floor, damping = one_mass(mass=1.0, stiffness=(2.0 * np.pi * 10.0) ** 2), ModalRatio(ratio=0.01)
    place = {"slab": (1.0, 1.0)}
    coarse = transfer(floor, place, place, [9.9, 10.1], damping=damping)
    (doubt,) = (d for d in coarse.doubts if d.subject == "frequency lines")
    assert "71 %" in doubt.message
    peak = np.abs(transfer(floor, place, place, [10.0], damping=damping).receptance).max()
    assert np.abs(coarse.receptance).max() / peak == pytest.approx(np.sqrt(0.5), rel=0.02)
    fine = transfer(floor, place, place, np.linspace(9.0, 11.0, 201), damping=damping)
    assert "frequency lines" not in {d.subject for d in fine.doubts}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frequencies": [1.0, 60.0]}, "at most 48 Hz.*got 60 Hz.*raise f_max to 75 Hz"),
        ({"frequencies": [1.0, 40.0], "integration": Modal(f_max=60.0, dt=0.02)}, "shorten dt to 11 ms"),
        ({"frequencies": [9.0], "integration": Newmark(dt=0.01), "damping": PAPER}, "at most 7.5 Hz.*dt"),
        ({"frequencies": [2.0, 1.0]}, "each above the last"),
        ({"frequencies": []}, "frequencies must be some numbers"),
        ({"frequencies": [-1.0, 1.0]}, "0 or more"),
        ({"frequencies": [1.0, np.nan]}, "must be finite"),
        ({"loads": {}}, "at least one load"),
        ({"points": {}}, "at least one point"),
        ({"loads": {"press": (13.0, 2.0)}}, "load 'press': point .13, 2. m is not on the floor"),
        ({"points": {"tool": Spot(1.0, 1.0, on="attic")}}, "point 'tool': there is no surface 'attic'"),
        ({"damping": None}, "damping must be given"),
        ({"integration": Newmark(dt=1e-3)}, "needs Rayleigh damping"),
        ({"loads": [(1.0, 1.0)]}, "loads must be a mapping of names to places"),
    ],
)  # fmt: skip
def test_mistakes_are_told_with_their_remedy(changes, words):
    settings = {
        "loads": MACHINE, "points": TOOL, "frequencies": [1.0],
        "integration": Modal(f_max=60.0, dt=1e-3), "damping": ModalRatio(ratio=0.02),
    } | changes  # fmt: skip
    with pytest.raises(InputError, match=words):
        transfer(small_floor(mesh_size=3.0), **settings)


def test_a_prepared_floor_brings_its_own_and_bears_no_other():
    prepared = prepare(small_floor(mesh_size=3.0), Modal(f_max=60.0, dt=1e-3), PAPER)
    assert isinstance(transfer(prepared, MACHINE, TOOL, [1.0]), TransferFunctions)
    assert transfer(prepared, MACHINE, TOOL, [1.0], damping=PAPER).doubts
    with pytest.raises(InputError, match="prepared for"):
        transfer(prepared, MACHINE, TOOL, [1.0], damping=ModalRatio(ratio=0.02))
    with pytest.raises(InputError, match="at most 48 Hz"):
        transfer(prepared, MACHINE, TOOL, [50.0])


def test_a_force_on_a_support_and_a_mode_without_damping_are_refused():
    """Nothing moves under the one, and nothing bounds the other."""
    beam = simple_beam(length=10.0, rigidity=2e8, line_mass=500.0, n_elements=20)
    middle, undamped = {"middle": (5.0, 0.0)}, ModalRatio(ratio=0.0)
    with pytest.raises(InputError, match="load 'end': the floor is held there"):
        transfer(beam, {"end": Spot(0.0, 0.0, axis="x")}, middle, [1.0], damping=undamped)
    slab = one_mass(mass=1.0, stiffness=(2.0 * np.pi * 10.0) ** 2)
    first = float(slab.modes(25.0).frequencies[0])
    place, whole = {"slab": (1.0, 1.0)}, 2.0 * np.pi * first
    assert whole**2 == pytest.approx((2.0 * np.pi * 10.0) ** 2)
    with pytest.raises(InputError, match="undamped mode lies at 10 Hz"):
        transfer(slab, place, place, [first], damping=undamped)


def test_modes_that_reach_hardly_further_are_a_doubt_that_is_no_less_than_the_error():
    """What is said at half of f_max and at 0.8 of it, against all dofs on a floor of 13 modes."""
    floor = small_floor(mesh_size=1.5)
    for share, bound in ((1.0 / 3.0, 0.015), (0.5, 0.05), (0.8, 0.4)):
        lines = np.linspace(1.0, share * 60.0, 24)
        found = transfer(floor, PLACES, PLACES, lines, integration=Modal(f_max=60.0, dt=1e-3),
                         damping=PAPER)  # fmt: skip
        whole = in_all_dofs(floor, PAPER, PLACES, PLACES, lines)
        off = np.abs(found.receptance - whole).max(axis=(0, 1)) / np.abs(whole).max(axis=(0, 1))
        assert off[-1] < bound
        said = [d.message for d in found.doubts if "lie close to modes left out" in d.message]
        assert bool(said) == (share > 0.5)
