"""Places of a map that cannot move: neither passed nor failed, and no hindrance to a picture."""

import warnings

import numpy as np
from matplotlib import rc_context

from studies import GOOD
from trundle.report import write_report
from trundle.results.store import write_results
from trundle.run.whole_study import run_study
from trundle.study_file.build import load_study

MAP = """
[map]
runs = 2
places = "nodes"
peaks = true
"""


def test_nodes_on_a_held_edge_are_not_assessed(tmp_path, monkeypatch):
    """A level of 0 is below every limit; logarithmic scales have no place for it."""
    monkeypatch.setenv("TRUNDLE_CACHE", "")
    text = GOOD.replace('duration = "4 s"\n', "")
    text += MAP
    text = text.replace(
        'storey_below = "4 m"', 'storey_below = "4 m"\nedges = { x_min = "simple" }'
    )
    path = tmp_path / "study.toml"
    path.write_text(text)
    study = load_study(path)
    result = run_study(study)
    (mapped,) = result.maps.values()
    held = study.map.grids[0].xy[:, 0] < 1e-9
    assert 0 < held.sum() < len(held)
    np.testing.assert_array_equal(np.isnan(mapped.classes.margin), held[None])
    np.testing.assert_array_equal(np.isnan(mapped.classes.share_exceeding), held[None])
    assert (mapped.classes.classes()[held] == -2).all()
    assert (mapped.numbers["rms_velocity"][held] < 1e-12).all()
    assert (mapped.numbers["rms_velocity"][~held] > 1e-9).all()
    with warnings.catch_warnings(), rc_context():
        warnings.simplefilter("error")
        write_results(result, tmp_path)
        write_report(result, tmp_path)
    assert (tmp_path / "figures" / "map_rms.png").exists()
