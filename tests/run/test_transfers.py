"""Transfer functions of a building by parts whose answers stand in place of its modes."""

import numpy as np

import trundle as tr
from studies import BUILDING
from trundle.run.transfers import method_of, transfer_of
from trundle.structure import Spot

PARTS = "\n[parts]\nnodes = 100\nband = 4\n"
ANSWERING = PARTS + "response_tolerance = 0.02\n"


def test_answers_give_what_modes_to_three_times_the_highest_line_give():
    """Velocity over force at every line and point, to 1.5 % of the largest (what modes left out
    cost at the highest line) and the tolerance together; the uppermost lines are not in doubt."""
    study = tr.study_from_text(BUILDING + ANSWERING)
    method = method_of(study, "coupled")
    lines = np.geomspace(1.0, method.interaction.integration.f_resolved, 150)
    points = {**study.points, "beside": Spot(2.0, 2.5, next(iter(study.points.values())).on)}
    loads = dict([next(iter(points.items()))])
    found = transfer_of(study, loads, points, lines, method=method)
    by_modes = tr.simulate.transfer(
        tr.study_from_text(BUILDING + PARTS).floor,
        loads,
        points,
        lines,
        damping=method.interaction.damping,
    )
    largest = np.abs(by_modes.mobility).max(axis=-1, keepdims=True)
    assert np.all(np.abs(found.mobility - by_modes.mobility) <= 0.035 * largest)
    subjects = [doubt.subject for doubt in found.doubts]
    assert "answers" in subjects
    assert "modal truncation" not in subjects


def test_answers_between_places_are_kept(monkeypatch, tmp_path):
    """The second time nothing is solved."""
    monkeypatch.setenv("TRUNDLE_CACHE", str(tmp_path))
    study = tr.study_from_text(BUILDING + ANSWERING)
    method, points, lines = method_of(study, "coupled"), dict(study.points), np.array([5.0, 9.0])
    first = transfer_of(study, points, points, lines, method=method)
    monkeypatch.setattr("trundle.run.answering.answering_modes", None)
    again = transfer_of(study, points, points, lines, method=method)
    np.testing.assert_array_equal(again.receptance, first.receptance)
