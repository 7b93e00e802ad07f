"""Cells that share an ensemble are what each would be alone."""

import numpy as np

from studies import GOOD
from trundle.results.cells import CellKey
from trundle.run.whole_study import run_study
from trundle.simulate import Coupled, Decoupled, ensemble
from trundle.study_file.build import load_study
from trundle.units import GAL
from trundle.views.tables import summary_rows


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
            study.floor, study.acting(case, road, method), method=method.interaction,
            points=study.points, n_runs=study.runs, seed=study.seed, duration=study.duration,
        )  # fmt: skip
        np.testing.assert_allclose(cell.peak_acceleration, alone.peak_acceleration(), rtol=1e-7)
        np.testing.assert_allclose(
            cell.peak_contact_force, alone.contact_forces.max(axis=1), rtol=1e-9
        )
        np.testing.assert_allclose(cell.history.velocity, alone.velocity[0], rtol=1e-6, atol=1e-12)


def test_a_study_asks_for_what_it_says(tmp_path):
    """Method, level and percentile of the file are those of the study and of its verdicts."""
    path = tmp_path / "study.toml"
    text = GOOD.replace('class = "B"', 'class = "B"\nlevel = "upper"', 1)
    path.write_text(text.replace('["VC-A"]', '["VC-A"]\npercentile = 80'))
    study = load_study(path)
    assert isinstance(study.methods[0].interaction, Coupled)
    assert study.roads["B upper"].level == "upper"
    other = tmp_path / "other.toml"
    other.write_text(text.replace('interaction = "coupled"', 'interaction = "decoupled"'))
    assert isinstance(load_study(other).methods[0].interaction, Decoupled)
    result = run_study(study)
    for key, verdicts in result.verdicts.items():
        for verdict in verdicts:
            assert verdict.percentile == 80.0
        for row in summary_rows(result):
            peaks = result.cells[key].peak_acceleration[:, 0] / GAL
            np.testing.assert_allclose(row.ranges[0], np.percentile(peaks, [5, 50, 95]), rtol=1e-12)
