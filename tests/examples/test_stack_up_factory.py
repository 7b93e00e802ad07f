"""The factory of four units on each of six storeys, and the unit by itself, at small size."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

import trundle as tr
from trundle.run.estimate import estimate_of
from trundle.structure import reference_unit

FOLDER = Path(__file__).parents[2] / "examples" / "stack_up_factory"


def small(name, *, size="3 m", **changes):
    text = (FOLDER / name).read_text(encoding="utf-8")
    for old, new in (('mesh_size = "1.5 m"', f'mesh_size = "{size}"'), *changes.items()):
        assert old in text
        text = text.replace(old, new)
    return tr.study_from_text(text, folder=FOLDER)


def test_the_single_unit_is_the_reference_unit():
    """By the tables of a building and by a plan of bays: two builders, one mesh, equal modes."""
    unit, other = small("single_unit.toml").floor, reference_unit(mesh_size=3.0)
    assert unit.n_dofs == other.n_dofs
    assert unit.moving_mass() == pytest.approx(other.moving_mass(), rel=1e-9)
    np.testing.assert_allclose(unit.modes(5.0).frequencies, other.modes(5.0).frequencies, rtol=1e-6)


@pytest.mark.slow
def test_storeys_of_the_unit_bounce_on_their_columns():
    """A chain of six equal springs and masses: ``2 sqrt(k/m) sin(pi / 26)``, 2.9 Hz.

    k is EA/L of a column; m what one carries in the widest bays, 13 m x 21 m of slab, beams and the
    column itself. The floor's own spring lies in series with it: 10 % are left to that.
    """
    k = 30e9 * 0.8**2 / 8.5
    slab = 13.0 * 21.0 * (0.2 * 2450.0 + 500.0)
    beams = 13.0 * 1.0 * 1.8 + 21.0 * 0.6 * 1.5 + 21.0 * 0.3 * 0.7
    m = slab + 2450.0 * (beams + 8.5 * 0.8**2)
    chain = 2.0 * np.sqrt(k / m) * np.sin(np.pi / 26.0) / (2.0 * np.pi)
    first = small("six_storeys.toml").floor.modes(4.0).frequencies[0]
    assert first == pytest.approx(chain, rel=0.1)
    assert small("single_unit.toml").floor.modes(5.0).frequencies[0] > 1.2 * chain


@pytest.mark.parametrize("name", ["single_unit.toml", "six_storeys.toml"])
def test_all_studies_drive_the_same_truck_by_the_same_method(name):
    building, unit = (
        tomllib.loads((FOLDER / one).read_text("utf-8")) for one in ("study.toml", name)
    )
    for key in ("seed", "runs", "vehicle", "road", "roughness", "method", "criteria"):
        assert building[key] == unit[key]
    assert building["building"]["mesh_size"] == unit["building"]["mesh_size"]
    both = [{p["name"]: p["at"] for p in one["point"]} for one in (building, unit)]
    assert both[1].items() <= both[0].items()


def test_the_factory_is_four_units_on_six_storeys_with_ramps():
    """It weighs 24 units, and what lies beside them: lanes, landings, ramps, their beams.

    Of units beside each other, members in planes of symmetry count by half from both sides; at the
    outside of the building the other half of 0.6 x 1.5 m beams is added. Columns are left to the
    tolerance: those of a unit are held at their far ends, and there are none above the top.
    """
    study = small("study.toml", size="4 m")
    floor, concrete = study.floor, 2450.0
    storeys = {f"storey {i}" for i in range(1, 7)}
    ramps = {f"ramp {i}" for i in range(1, 7)}
    assert set(floor.surfaces) == storeys | ramps
    beside = 0.5 * 2 * 167.0 * 0.6 * 1.5 * concrete
    beside += (12.0 * 107.0 + 2 * 9.0 * 12.0) * (0.2 * concrete + 500.0)
    beside += ((132.0 + 131.0) * 0.6 * 1.5 + 107.0 * 0.3 * 0.7) * concrete
    beside += 8.0 * 83.0 * (0.25 * concrete + 100.0) + (166.0 + 48.0) * 0.5 * 1.2 * concrete
    units = 24 * reference_unit(mesh_size=4.0).moving_mass()
    assert floor.moving_mass() == pytest.approx(units + 6 * beside, rel=0.02)


@pytest.mark.longest
def test_equal_units_are_reduced_once():
    """Both units of one side are mirrored on the other, and repeat on five storeys: ten are one.

    Seven levels by three by two pieces; those of the ground floor and of the top are others.
    """
    pieces = small("study.toml", size="4 m").floor.pieces
    assert len(pieces.placed) == 7 * 3 * 2
    assert np.bincount([own.kind for own in pieces.placed]).max() == 2 * 5
    assert len(pieces.distinct) == 14


@pytest.mark.longest
def test_the_time_and_memory_of_the_factory_are_known_beforehand(monkeypatch):
    """Within a factor of two of what was measured (docs/stack_up_factory.md)."""
    monkeypatch.setenv("TRUNDLE_CACHE", "")
    page = (FOLDER.parents[1] / "docs" / "stack_up_factory.md").read_text("utf-8")
    assert "| 4.3 GB |" in page
    assert "| 932 s: " in page
    estimate = estimate_of(tr.load_study(FOLDER / "study.toml"))
    assert 0.5 < estimate.memory / 4.3e9 < 2.0
    assert 0.5 < estimate.seconds / 932.0 < 2.0


@pytest.mark.longest
def test_the_storey_that_is_driven_on_moves_most():
    """Coarsely and to 8 Hz: the tools above and below are shaken through columns alone."""
    study = small(
        "study.toml",
        size="4 m",
        **{'f_max = "11.2 Hz"': 'f_max = "8 Hz"', "runs = 100": "runs = 3"},
    )
    result = tr.run_study(study)
    rms = result.to_xarray()["exact_rms_velocity"].sel(case="rear").squeeze()
    here = float(rms.sel(point="tool, storey 3"))
    for other in ("tool, storey 4", "tool, storey 2", "tool, next unit"):
        assert 0.0 < float(rms.sel(point=other)) < here
