"""Whether enough of each part is kept: levels with less of it, and what is said of them."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from towers import halfway, tower
from trundle.dynamics import ModalRatio
from trundle.results.level_change import LevelChange
from trundle.results.parts_change import PartsChange, parts_warnings, parts_words
from trundle.road import RoadClass
from trundle.route import Route
from trundle.simulate import Crossing, Decoupled, Modal, ensemble
from trundle.structure import Spot
from trundle.structure.superelements import Cuts, Parting
from trundle.vehicle import library_vehicle

CRITERIA = '\n[criteria]\nmethod = "coupled"\ncurves = ["VC-A"]\n'
PARTS = "\n[parts]\nnodes = 100\n"


@pytest.fixture(scope="module")
def result():
    return tr.run_study(tr.study_from_text(BUILDING + CRITERIA + PARTS))


@pytest.mark.longest
def test_the_narrower_structure_is_that_of_a_study_that_keeps_so_much(result):
    """Levels with less are those of the study run anew with that band: nothing else differs."""
    change = result.parts
    (method,) = result.study.methods
    f_max = method.interaction.integration.f_max
    assert change.kept == pytest.approx((2.0 * f_max / 2**0.5, 2.0 * f_max))
    bands = f"band = {2 / 2**0.5!r}\nseam_band = {5 / 2**0.5!r}\n"
    study = tr.study_from_text(BUILDING + CRITERIA + PARTS + bands)
    again = tr.run_study(replace(study, building=None, parting=None))
    (cell,) = again.cells.values()
    runs = min(4, study.runs)
    own = np.sqrt(np.mean(cell.spectra.values[:runs, 0] ** 2, axis=0))
    there = np.isfinite(change.change.levels[0, 0, 0])
    assert there.any()
    np.testing.assert_allclose(change.change.levels[0, 0, 0, there], own[there], rtol=1e-6)


def test_what_less_of_parts_changes_stands_in_the_report_and_is_read_back(result, tmp_path):
    tr.save(result, tmp_path / "out")
    words = parts_words(result.parts)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert words in page.replace("&#39;", "'")
    again = tr.read_results(tmp_path / "out")
    assert parts_words(again.parts) == words


def change_of(coarse, own):
    """One case, one point; the second of two bands is a whisper."""
    levels = np.array([[[[coarse, 0.05 * coarse]]], [[[own, 0.01 * own]]]])
    change = LevelChange(
        frequencies=np.ones((2, 1)), cases=("aisle",), points=("tool",),
        bands=np.array([4.0, 8.0]), levels=levels,
    )  # fmt: skip
    return PartsChange(kept=(28.0, 40.0), change=change)


def test_settled_levels_raise_no_doubt_and_others_do():
    """Twice 2 % is settled and twice 3 % is not; nobody having looked, or nothing being known, is a doubt."""
    assert parts_warnings(change_of(1.02, 1.0)) == ()
    (doubt,) = parts_warnings(change_of(1.03, 1.0))
    assert "have not settled" in doubt.message
    assert "3 % (aisle, tool, 4 Hz)" in doubt.message
    (doubt,) = parts_warnings(None)
    assert "was not looked at" in doubt.message
    (doubt,) = parts_warnings(change_of(np.nan, np.nan))
    assert "is not known" in doubt.message


def levels_of(structure, crossing, points, f_max):
    """Return the RMS velocity of each point in octaves to f_max, over two roads."""
    method = Decoupled(
        integration=Modal(f_max=1.25 * f_max, dt=0.01), damping=ModalRatio(ratio=0.03)
    )
    runs = ensemble(
        structure, crossing, method=method, points=points, n_runs=2, seed=1, duration=5.0
    )
    velocity = np.asarray(runs.velocity)
    power = np.abs(np.fft.rfft(velocity, axis=1)) ** 2
    f = np.fft.rfftfreq(velocity.shape[1], 0.01)
    edges = f_max / 2.0 ** np.arange(4)[::-1]
    bands = [power[:, (f >= low) & (f < high)].sum(axis=(0, 1)) for low, high in pairwise(edges)]
    return np.sqrt(np.array(bands))


@pytest.mark.longest
def test_twice_what_less_changes_bounds_what_is_left_in_19_of_20_buildings():
    """Towers, cuts, bands, routes and points drawn at random, against the same in one piece."""
    rng = np.random.default_rng(19)
    bounded = []
    while len(bounded) < 20:
        storeys, bays = int(rng.integers(2, 4)), int(rng.integers(2, 4))
        whole = tower(storeys=storeys, bays_x=bays, bays_y=1, mesh_size=1.5)
        cuts = Cuts(
            x=np.array([6.0]) if rng.random() < 0.5 else np.zeros(0),
            z=halfway(storeys) if storeys > 1 else np.zeros(0),
        )
        band, f_max = float(rng.uniform(1.7, 2.5)), float(rng.uniform(12.0, 24.0))
        reach = 1.25 * f_max
        parted = Parting(cuts=cuts, f_parts=band * reach, f_seams=2.5 * band * reach).of(whole)
        on = f"level {int(rng.integers(1, storeys + 1))}"
        y = float(rng.uniform(2.0, 4.0))
        route = replace(Route.straight((0.0, y), (6.0 * bays, y), speed=4.0), on=on)
        crossing = Crossing(library_vehicle("forklift_fl3_laden"), route, RoadClass("B"))
        points = {
            str(i): Spot(
                x=float(rng.uniform(1.0, 6.0 * bays - 1.0)),
                y=float(rng.uniform(1.0, 5.0)),
                on=f"level {int(rng.integers(1, storeys + 1))}",
            )
            for i in range(2)
        }
        narrow = parted.narrower(2**0.5, least=reach)
        if not narrow.less_than(parted):
            continue  # nothing can be said, and nothing is
        less, own, true = (
            levels_of(one, crossing, points, f_max) for one in (narrow, parted, whole)
        )
        matters = true > 0.1 * true.max(axis=0)
        estimate = np.abs(less / own - 1.0)[matters].max()
        error = np.abs(own / true - 1.0)[matters].max()
        bounded.append(error <= 2.0 * estimate)
    assert sum(bounded) >= 19
