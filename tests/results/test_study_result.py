"""What a whole result says of itself: doubts by method, who stood where, and nothing unescaped."""

from dataclasses import replace

import numpy as np
import pytest

from made_results import (
    POINTS,
    SECOND,
    cell,
    curve,
    levels,
    made_result,
    made_study,
    spectra,
    verdict,
)
from trundle.errors import FitnessWarning
from trundle.results.cells import CellKey
from trundle.results.provenance import provenance_of
from trundle.results.study_result import positions_at, wheels_at
from trundle.study.plans import Case

SOUTH = "=Zufahrt, Süd"
CAGE = list(POINTS)[1]
MORE = """
[[method]]
name = "zweite"
interaction = "decoupled"
f_max = "30 Hz"
dt = "5 ms"
damping = { ratio = "3 %" }
"""


@pytest.fixture(scope="module")
def study():
    return made_study(SECOND + MORE)


@pytest.fixture(scope="module")
def result(study):
    return made_result(study)


def test_doubts_are_of_their_method_each_once(result):
    """One doubt of three cells by one method, another of the other's: neither twice, nor beside it."""
    one, other = (FitnessWarning(subject=s, message="m") for s in ("eins", "zwei"))
    cells = {
        key: replace(c, warnings=(one,) if key.method == "coupled" else (other, one))
        for key, c in result.cells.items()
    }
    found = replace(result, cells=cells).warnings()
    assert list(found) == ["coupled", "zweite"]
    assert found["coupled"].count(one) == 1
    assert found["zweite"][:2] == (other, one)
    assert other not in found["coupled"]


def test_motion_of_an_impossible_size_is_a_doubt_with_case_and_road(study, result):
    """2 m/s and 200 m/s2 at the second point on road C: named; the other cells are not."""
    key = CellKey(SOUTH, "C", "zweite")
    huge = levels(
        peak_acceleration=np.array([[1.0, 200.0]] * 3), rms_velocity=np.array([[1e-5, 2.0]] * 3)
    )
    quiet = {k: replace(c, reduced=levels(base=100.0)) for k, c in result.cells.items()}
    found = replace(result, cells={**quiet, key: cell(key, reduced=huge)}).warnings()
    sizes = [w for w in found["zweite"] if w.subject.startswith("size of the motion")]
    (one,) = sizes
    assert one.subject == f"size of the motion, {SOUTH}, class C"
    assert one.message.startswith(f"{CAGE}: a peak of 200 m/s2 and 2 m/s")
    assert not [w for w in found["coupled"] if w.subject.startswith("size of the motion")]


def test_few_runs_are_a_doubt_of_the_assessed_method_alone(result):
    """Three runs bound no 95 % level: said where verdicts stand, and not of the other method."""
    found = result.warnings()
    assert any("runs" in w.subject for w in found["coupled"])
    assert not any("runs" in w.subject for w in found["zweite"])


def test_a_map_of_fewer_runs_is_a_doubt_of_its_own(study):
    """A map of two of the study's runs is less sure than its points: it says so itself."""
    text = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\nruns = {}\n'
    fewer, all_of_them = (made_result(made_study(text.format(n), runs=300)) for n in (2, 300))
    subjects = [{w.subject for w in r.warnings()["coupled"]} for r in (fewer, all_of_them)]
    assert ["runs of the map" in some for some in subjects] == [True, False]


def test_a_record_that_ends_too_early_is_a_doubt_of_each_case_that_has_not_left(result):
    """4 s of record: 12.5 m of truck over 12 m at 15 km/h take 5.9 s, at 36 km/h 2.45 s."""
    found = {w.subject: w.message for w in result.warnings()["coupled"]}
    assert {s for s in found if s.startswith("duration")} == {"duration, main", "duration, both"}
    assert "it leaves at 5.9 s" in found["duration, main"]


def test_levels_that_are_doubted_are_those_of_the_smallest_margin(study, result):
    """Of two assessed cells that with a margin of 0.5; none that is not a number decides."""
    first, second = CellKey("main", "B", "coupled"), CellKey(SOUTH, "C", "coupled")
    loud = cell(second, reduced=levels(spectra=spectra(np.ones((3, 2, 20)))))
    some = replace(
        result,
        cells={**result.cells, second: loud},
        verdicts={
            first: (verdict(margin=0.7), verdict(margin=np.nan, status="not assessed")),
            second: (verdict(margin=3.0), verdict(margin=0.5)),
        },
    )
    assert some._governing_levels() is loud.reduced.spectra
    assert replace(some, verdicts={})._governing_levels() is None


def test_a_line_counts_verdicts_by_what_they_are(result):
    """Two passes, one fail and one that is not assessed, in two cells."""
    some = {
        CellKey("main", "B", "coupled"): (verdict(), verdict(status="fail")),
        CellKey("main", "C", "coupled"): (verdict(), verdict(status="not assessed")),
    }
    assert repr(replace(result, verdicts=some)).endswith(
        "verdicts: 2 pass, 1 fail, 1 not assessed>"
    )
    assert repr(result).endswith("12 cells, 0 maps; verdicts: none>")


def test_the_page_of_a_notebook_escapes_every_name(study, result):
    """Names and titles with markup are text in it, and each verdict stands with its own point."""
    wild = curve(title='<script>alert("1")</script>')
    some = {
        CellKey(SOUTH, "B", "coupled"): (verdict(wild, point=CAGE, margin=0.123456, status="fail"),)
    }
    page = replace(result, verdicts=some)._repr_html_()
    assert "<script>" not in page
    assert (
        f"<tr><td>{SOUTH}</td><td>B</td><td>Käfig, &quot;&lt;b&gt;&amp;</td>"
        "<td>&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;</td><td>fail</td><td>0.123</td></tr>"
    ) in page


def test_front_axles_are_where_speed_and_departure_have_brought_them(study):
    """15 km/h from x = 0 and 36 km/h from x = 12 m, the second 0.5 s later, and the first again 2 s later.

    After 2.4 s: 10 m; before 0.5 s the second is not there; at 1 s it stands at 12 - 5 m.
    """
    both = Case(name="both", routes=("main", SOUTH, "main"), departs=(0.0, 0.5, 2.0))
    result = made_result(replace(study, cases=(*study.cases[:2], both)))
    key = CellKey("both", "B", "coupled")
    found = positions_at(result, key, 1.0)
    assert list(found) == ["main", SOUTH, "main (2)"]
    assert found["main"] == pytest.approx([15 / 3.6, 3.0])
    assert found[SOUTH] == pytest.approx([7.0, 2.0])
    assert found["main (2)"] is None
    assert positions_at(result, key, 0.4)[SOUTH] is None
    later = positions_at(result, key, 2.4)
    assert (later["main"], later["main (2)"]) == (
        pytest.approx([10.0, 3.0]),
        pytest.approx([5 / 3, 3.0]),
    )
    assert positions_at(result, key, 50.0) == dict.fromkeys(found)
    assert positions_at(result, key, np.nan) == {}
    wheels = wheels_at(result, key, 0.4)
    assert (wheels[SOUTH], wheels["main (2)"]) == (0, 0)
    assert wheels["main"] >= 1
    assert set(wheels_at(result, key, 50.0).values()) == {0}


def test_where_results_come_from_is_the_studys_own(study):
    """Seed, runs, hashes and methods of this study; another seed has another hash, on the same floor."""
    one, other = provenance_of(study), provenance_of(made_study(SECOND + MORE, runs=4))
    assert (one["seed"], one["runs"], one["study"]) == (1, 3, "Small")
    assert one["study_hash"] == study.content_hash != other["study_hash"]
    assert one["floor_hash"] == other["floor_hash"]
    assert list(one["methods"]) == ["coupled", "zweite"]
