"""Outcomes of a sweep, made by hand: margins by speed, and each doubt once with what it is about."""

import numpy as np
import pytest

from studies import GOOD
from trundle.criteria import Verdict, find_criterion
from trundle.errors import FitnessWarning
from trundle.mitigate.outcome import Outcome, Sweep
from trundle.study_file import study_from_text
from trundle.units import KMH
from trundle.views.mitigation import NONE, UNKNOWN, mitigation_rows, strictest

SPEEDS = (10.0 * KMH, 20.0 * KMH)
ROADS = ("A", "B")


@pytest.fixture(scope="module")
def study():
    return study_from_text(GOOD)


def verdict(criterion="VC-A", status="pass", margin=2.0, point="tool"):
    return Verdict(
        criterion=find_criterion(criterion), point=point, status=status, percentile=95.0,
        unresolved=(), averaging="max_1s", margin=margin,
    )  # fmt: skip


def outcome(speed, road, *verdicts, change="as in the study", warnings=(), case="main"):
    return Outcome(
        change=change, case=case, speed=speed, road=road, verdicts=verdicts, excited_to=12.0,
        warnings=tuple(FitnessWarning(subject=s, message="x") for s in warnings),
    )  # fmt: skip


def sweep(study, *outcomes, changes=("as in the study",)):
    return Sweep(
        study=study, changes=changes, speeds=SPEEDS, roads=ROADS, runs=3, outcomes=outcomes,
        resonances={},
    )  # fmt: skip


def test_margins_stand_in_the_order_of_the_speeds(study):
    """Whatever the order of the outcomes, and beside other roads, changes, points and criteria."""
    slow, fast = SPEEDS
    made = sweep(
        study,
        outcome(fast, "A", verdict(margin=0.5), verdict(margin=9.0, point="other")),
        outcome(slow, "A", verdict(margin=3.0), verdict("VC-C", margin=8.0)),
        outcome(slow, "B", verdict(margin=7.0)),
        outcome(fast, "B", verdict(margin=6.0)),
        outcome(slow, "A", verdict(margin=5.0), change="slab"),
    )
    asked = ("as in the study", "main", "A", "tool", "VC-A")
    np.testing.assert_array_equal(made.margin(*asked), [3.0, 0.5])
    np.testing.assert_array_equal(made.margin(*asked[:2], "B", *asked[3:]), [7.0, 6.0])
    with pytest.raises(KeyError):
        made.margin("slab", *asked[1:])  # at one of the speeds alone


def test_a_margin_that_is_not_known_stays_unknown(study):
    """NaN is no margin and no nought: a curve has a hole there."""
    made = sweep(study, *(outcome(v, "A", verdict(margin=m)) for v, m in zip(SPEEDS, (2.0, np.nan), strict=True)))  # fmt: skip
    found = made.margin("as in the study", "main", "A", "tool", "VC-A")
    assert found[0] == 2.0
    assert np.isnan(found[1])


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ({(0, "A"), (0, "B"), (1, "A"), (1, "B")}, "d: x"),
        ({(0, "A"), (0, "B")}, "10 km/h: d: x"),
        ({(0, "B"), (1, "B")}, "class B: d: x"),
        ({(1, "A")}, "20 km/h, class A: d: x"),
    ],
)
def test_a_doubt_stands_once_with_the_speeds_and_roads_that_it_is_about(study, where, told):
    """Nothing stands before it where it is about all of them."""
    made = sweep(
        study,
        *(
            outcome(speed, road, verdict(), warnings=("d",) if (i, road) in where else ())
            for i, speed in enumerate(SPEEDS)
            for road in ROADS
        ),
    )
    assert made.warnings() == (told,)


def test_several_doubts_keep_their_order_and_none_is_lost(study):
    """Two at one place and one elsewhere; equal words are one doubt."""
    made = sweep(
        study,
        outcome(SPEEDS[0], "A", verdict(), warnings=("b", "a")),
        outcome(SPEEDS[1], "A", verdict(), warnings=("a",)),
    )
    assert made.warnings() == ("10 km/h, class A: b: x", "class A: a: x")
    assert sweep(study).warnings() == ()


@pytest.mark.parametrize(
    ("statuses", "best"),
    [
        (("pass", "pass", "fail"), "VC-C"),
        (("pass", "fail", "fail"), "VC-A"),
        (("fail", "fail", "fail"), NONE),
        (("fail", "not assessed", "fail"), UNKNOWN),
        (("pass", "not assessed", "not assessed"), "VC-A"),
        (("not assessed", "not assessed", "not assessed"), UNKNOWN),
    ],
)
def test_the_strictest_met_is_one_that_was_computed(study, statuses, best):
    """VC-A, VC-C and VC-E allow 50, 12.5 and 3.1 um/s; what is not assessed is never met."""
    one = outcome(
        SPEEDS[0], "A",
        *(verdict(c, s) for c, s in zip(("VC-A", "VC-C", "VC-E"), statuses, strict=True)),
        verdict("VC-E", "pass", point="other"),
    )  # fmt: skip
    titles = {find_criterion(name).title: name for name in ("VC-A", "VC-C", "VC-E")}
    found = strictest(one, "tool")
    assert titles.get(found, found) == best


def test_rows_are_in_km_h_and_for_each_point(study):
    """10 km/h are 2.78 m/s; a study of one point has a row a combination."""
    (row,) = mitigation_rows(sweep(study, outcome(SPEEDS[0], "B", verdict())))
    assert row["speed_kmh"] == pytest.approx(10.0)
    assert (row["change"], row["road"], row["point"]) == ("as in the study", "B", "tool")
    assert row["strictest"] == find_criterion("VC-A").title


def test_labels_are_no_html(study):
    """What people call a change or a point is shown as they wrote it."""
    odd = outcome(
        SPEEDS[0], "A", verdict(point="<i>p</i>"), change="<b>slab</b>", case="Größe & co"
    )
    made = sweep(study, odd, changes=("<b>slab</b>",))
    page = made._repr_html_()
    for text in ("<b>", "<i>"):
        assert text not in page
    assert "&lt;b&gt;slab&lt;/b&gt;" in page
    assert "Größe &amp; co" in page
    assert "1 changes at 2 speeds on 2 road classes, 3 runs each" in repr(made)
