"""Cells that share an ensemble are what each would be alone."""

import numpy as np
from test_bad_input import GOOD

from trundle.simulate import ensemble
from trundle.study import load_study
from trundle.study.cells import CellKey
from trundle.study.run import run_study


def test_every_class_has_the_response_to_its_own_road(tmp_path):
    """Class C shares its runs with class B in a study; alone, it drives over class C."""
    path = tmp_path / "study.toml"
    path.write_text(GOOD + '\n[[road]]\nclass = "C"\n')
    study = load_study(path)
    result = run_study(study)
    case, method = study.cases[0], study.methods[0]
    for road in study.roads:
        cell = result.cells[CellKey(case.name, road, method.name)]
        alone = ensemble(
            study.floor, study.crossings(case, road, method), method=method.interaction,
            points=study.points, n_runs=study.runs, seed=study.seed, duration=study.duration,
        )  # fmt: skip
        np.testing.assert_allclose(cell.peak_acceleration, alone.peak_acceleration(), rtol=1e-7)
        np.testing.assert_allclose(
            cell.peak_contact_force, alone.contact_forces.max(axis=1), rtol=1e-9
        )
        np.testing.assert_allclose(cell.history.velocity, alone.velocity[0], rtol=1e-6, atol=1e-12)
