"""The paper's tables, and what the notes beside them say of the printed numbers."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from trundle.route import Abrupt, Ramp
from trundle.simulate import ensemble, prepare
from trundle.study_file.build import load_study

FOLDER = Path(__file__).parents[2] / "examples" / "paper"


def printed(file):
    """RMS velocity [um/s] and peak [gal] of Table 2 by (road, class, method)."""
    data = tomllib.loads((FOLDER / file).read_text("utf-8"))
    return {
        (p["case"], p["road"], p["method"]): tuple(
            float(p[key].split()[0]) for key in ("rms_velocity", "peak_acceleration")
        )
        for p in data["printed"]
    }


def test_what_the_printed_velocities_hold_that_does_not_grow_with_the_road():
    """v^2 = s^2 + (g r)^2, g = 1 and 2 for classes B and C: r = sqrt((v_C^2 - v_B^2) / 3)."""
    table = printed("study.toml")

    def part(case):
        b, c = (table[case, road, "decoupled"][0] for road in "BC")
        return np.sqrt((c**2 - b**2) / 3.0)

    # the rear and aerial road agree with the coupled column, front and side do not
    assert part("rear") == pytest.approx(table["rear", "B", "coupled"][0], rel=0.003)
    assert part("aerial") == pytest.approx(table["aerial", "B", "coupled"][0], rel=0.02)
    assert part("front") == pytest.approx(1.51 * table["front", "B", "coupled"][0], rel=0.01)
    assert part("side") == pytest.approx(0.164 * table["side", "B", "coupled"][0], rel=0.01)
    notes = " ".join(n["text"] for n in tomllib.loads((FOLDER / "study.toml").read_text())["note"])
    for case, digits in (("rear", 1), ("aerial", 2), ("front", 1), ("side", 1)):
        assert f"{part(case):.{digits}f}" in notes


def test_the_notes_claim_no_scatter_of_single_roads():
    notes = tomllib.loads((FOLDER / "study.toml").read_text("utf-8"))["note"]
    text = " ".join(note["title"] + note["text"] for note in notes)
    assert "this is the scatter" not in text
    assert "cannot be met" not in text
    for word in ("consistent with", "remains open", "side road does not fit", "25 ms", "5 ms"):
        assert word in text


def test_the_reading_differs_by_entry_alone():
    study = load_study(FOLDER / "reading.toml")
    decoupled, coupled = study.methods
    assert isinstance(decoupled.entry, Abrupt)
    assert isinstance(coupled.entry, Ramp)
    for part in ("integration", "damping", "contact"):
        ours, theirs = (getattr(m.interaction, part) for m in (decoupled, coupled))
        assert ours == theirs
    # half the height is a quarter of the spectrum: A stands beside printed B, B beside C
    gd = {name: road.displacement_psd(np.array([0.1]))[0] for name, road in study.roads.items()}
    assert gd == {"A": pytest.approx(64e-6 / 4), "B": pytest.approx(256e-6 / 4)}
    moved = {"B": "A", "C": "B"}
    assert printed("reading.toml") == {
        (case, moved[road], method): values
        for (case, road, method), values in printed("study.toml").items()
    }


@pytest.mark.longest
def test_the_reading_gives_decoupled_far_above_coupled_on_three_roads():
    """Published: peaks 4.6, 8.2 and 3.6 times as high for class B; rear 108.8 and 49.4 um/s."""
    study = load_study(FOLDER / "reading.toml")
    method = study.methods[0].interaction
    floor = prepare(study.floor, method.integration, method.damping)
    cases = {case.name: case for case in study.cases}

    def medians(name, plan):
        runs = ensemble(
            floor,
            study.acting(cases[name], "A", plan),
            method=plan.interaction,
            points=study.points,
            n_runs=40,
            seed=study.seed,
            duration=study.duration,
        )
        speed = np.sqrt((runs.velocity[:, :, 0] ** 2).mean(axis=1))
        return np.median(np.abs(runs.acceleration[:, :, 0]).max(axis=1)), np.median(speed)

    found = {
        name: [medians(name, plan) for plan in study.methods]
        for name in ("aerial", "front", "rear")
    }
    for decoupled, coupled in found.values():
        assert decoupled[0] > 3.0 * coupled[0]
    # the floor is a stand-in: levels within a quarter, their proportion closer
    decoupled, coupled = 1e6 * np.array(found["rear"])[:, 1]
    np.testing.assert_allclose([decoupled, coupled], [108.8, 49.4], rtol=0.25)
    assert decoupled / coupled == pytest.approx(108.8 / 49.4, rel=0.15)
