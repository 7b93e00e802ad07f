"""Studies of trucks and people on several roads: what a road makes larger, and what it does not."""

import numpy as np
import pytest

from studies import GOOD
from trundle.results.cells import CellKey
from trundle.run.jobs import plan_jobs
from trundle.run.whole_study import run_study
from trundle.study_file.build import study_from_text

ROADS = GOOD.replace('[[road]]\nclass = "B"', '[[road]]\nclass = "A"\n\n[[road]]\nclass = "C"')
PEOPLE = """
[[walker]]
name = "guard"
guide = "p354"
pace = "2 Hz"
path = [["0 m", "1 m"], ["12 m", "1 m"]]

[[machine]]
name = "pump"
at = ["9 m", "4 m"]
rotor = { speed = "600 rpm", unbalance = "2000 g mm" }
random_phase = false

[[traffic]]
name = "with people"
routes = ["main", "guard"]

[[traffic]]
name = "with a pump"
routes = ["main", "pump"]
"""


@pytest.fixture(scope="module")
def decoupled():
    text = ROADS.replace('interaction = "coupled"', 'interaction = "decoupled"')
    study = study_from_text(text + PEOPLE)
    return run_study(study)


def history(result, case, road):
    return result.cells[CellKey(case, road, "coupled")].history.velocity[:, 0]


@pytest.mark.parametrize(("case", "other"), [("with people", "guard"), ("with a pump", "pump")])
@pytest.mark.parametrize("road", ["A", "C"])
def test_on_every_road_others_are_what_they_are_alone(decoupled, case, other, road):
    """Decoupled, the first run of all together is the sum of those alone, on A and on C.

    A road of class C has four times the elevations of A: what another source does is not scaled
    with them, be it random from run to run or not.
    """
    summed = history(decoupled, "main", road) + history(decoupled, other, road)
    together = history(decoupled, case, road)
    assert np.abs(together - summed).max() < 1e-6 * np.abs(together).max()


def test_roads_share_their_runs_where_nothing_else_is_random():
    """A pump of known phase leaves them together; people who differ take each road by itself."""
    jobs = plan_jobs(study_from_text(ROADS + PEOPLE))
    roads = {}
    for job in jobs:
        roads.setdefault(job.case.name, []).append(tuple(job.factors))
    assert roads["main"] == roads["with a pump"] == [("A", "C")]
    assert roads["with people"] == [("A",), ("C",)]
    assert roads["guard"] == [("A", "C")]  # nobody drives: no road counts, and all are alike
    alone = next(job for job in jobs if job.case.name == "guard")
    assert set(alone.factors.values()) == {1.0}
    assert alone.n_waves == 0


def test_people_are_not_in_statistics_of_roads(decoupled):
    """Exact statistics sum answers to waves: a case with people in it has none, and says none."""
    assert decoupled.cells[CellKey("main", "A", "coupled")].exact is not None
    assert decoupled.cells[CellKey("with people", "A", "coupled")].exact is None
    assert decoupled.cells[CellKey("with a pump", "A", "coupled")].exact is not None


def test_no_walker_pulls(decoupled):
    """Forces about a weight are below 0 half of the time, and nobody lifts off."""
    cell = decoupled.cells[CellKey("guard", "A", "coupled")]
    assert not cell.reduced.tension.any()
    assert not any(w.subject == "loss of contact" for w in cell.warnings)
