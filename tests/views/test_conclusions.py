"""Conclusions: a fail anywhere fails, what is unknown is never met, and one sentence says it."""

import os
import sys
from dataclasses import replace

import numpy as np
import pytest

from trundle.views.conclusions import concluded, conclusion_of_all, lights

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "report"))
from hand_made import result_of, study_of

TWO_ROADS = '\n[[road]]\nclass = "C"\n'
CURVES = ('curves = ["VC-A"]', 'curves = ["VC-A", "VC-B", "stepper-B"]')
NAME = 'name = "tool"'


def points(*names):
    """So many points beside the first, along the floor."""
    text = '\n[[point]]\nname = "{}"\nat = ["{:.1f} m", "4 m"]\n'
    return "".join(text.format(name, 1.0 + 0.5 * i) for i, name in enumerate(names))


def test_one_point_is_concluded_in_one_sentence_with_what_governs():
    """95 % of 0.5, 1, 4 is 3.7: flat 10 um/s are 37 against the 50 of VC-A; flat curves meet at 1 Hz on.

    VC-B's 25 fail. The band that governs a flat spectrum is the first of the flat part of the curve.
    """
    (one,) = concluded(result_of(study_of("", CURVES), 1e-5))
    assert one.status == "pass"
    assert one.met.verdict.criterion.name == "VC-A"
    assert one.words.startswith("VC-A is met with margin 1.35 (at most 5), though more runs")
    assert "governing: main, " in one.words
    assert conclusion_of_all([one]) == f"tool: {one.words}."


@pytest.mark.parametrize("loud", ["B", "C"])
def test_the_worst_road_is_what_counts(loud):
    """Quiet on one, 60 um/s x 3.7 on the other: nothing is met, and the road that governs is named."""
    result = result_of(study_of(TWO_ROADS, CURVES), lambda key: 60e-6 if key.road == loud else 1e-6)
    (one,) = concluded(result)
    light = lights(result)["tool"]["VC-A"]
    assert (one.status, one.met, light.status) == ("fail", None, "fail")
    np.testing.assert_allclose(light.verdict.margin, 50.0 / (3.7 * 60.0), rtol=1e-12)
    assert light.where == f"main, road {loud}"
    assert one.words.startswith("no velocity criterion is met: VC-A fails with margin 0.225")


def test_what_is_not_assessed_in_one_cell_is_not_met_by_the_others():
    """On B all bands are known and quiet; on C they end at 31.5 Hz: VC-A is not assessed."""
    study = study_of(TWO_ROADS, CURVES)
    whole, cut = result_of(study, 1e-8), result_of(study, 1e-8, shown_to=35.0)
    mixed = {k: (cut if k.road == "C" else whole).verdicts[k] for k in whole.verdicts}
    result = replace(whole, verdicts=mixed)
    assert lights(result)["tool"]["VC-A"].status == "not assessed"
    (one,) = concluded(result)
    assert (one.status, one.met) == ("not assessed", None)
    assert "is met" not in one.words
    assert "not assessed" in conclusion_of_all([one])


def test_bands_that_are_missing_above_are_named():
    """Loud enough to fail VC-B at 1 Hz in what is known, to 31.5 Hz; VC-A is kept below and unknown above."""
    (one,) = concluded(result_of(study_of("", CURVES), 1e-5, shown_to=35.0))
    assert one.status == "fail"
    assert "no velocity criterion is known to be met: VC-B fails" in one.words
    assert "not assessed" in one.words
    assert "VC-A" in one.words


@pytest.mark.parametrize("n", [3, 20])
def test_many_points_are_summed_up_by_the_weakest(n):
    """Each louder than the last: the last is the weakest, and meets VC-A alone."""
    names = [f"tool {i}" for i in range(2, n + 1)]
    study = study_of(points(*names), CURVES)
    level = np.linspace(1e-6, 1e-5, n)
    found = concluded(result_of(study, lambda key: level))
    assert [one.point for one in found] == ["tool", *names]
    told = conclusion_of_all(found)
    assert told.startswith(
        f"VC-A, or stricter, is met at all {n} points; the weakest is tool {n}: "
    )


def test_points_where_nothing_is_met_are_named():
    study = study_of(points("tool 2", "tool 3"), CURVES)
    found = concluded(result_of(study, lambda key: [1e-6, 1e-3, 1e-6]))
    assert conclusion_of_all(found) == (
        "A velocity criterion is met at 2 of 3 points; none at tool 2."
    )
    nothing = concluded(result_of(study, 1e-3))
    assert conclusion_of_all(nothing) == "No velocity criterion is met at any of 3 points."


def test_a_criterion_for_other_motion_does_not_count():
    """One for level motion at an upright point: neither met nor in the sentence."""
    curves = ('curves = ["VC-A"]', 'curves = ["VC-A", "electron-microscope-horizontal"]')
    result = result_of(study_of("", curves), 1e-8)
    light = lights(result)["tool"]["electron-microscope-horizontal"]
    assert not light.applies
    (one,) = concluded(result)
    assert one.status == "pass"
    assert "icroscope" not in one.words


def test_nothing_is_concluded_without_criteria():
    result = result_of(replace(study_of(), assessment=None))
    assert concluded(result) == []
    assert conclusion_of_all([]) == ""
