"""What would help: every combination is what a study of it would say."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from studies import BUILDING, GOOD, LIBRARY
from trundle.errors import FitnessWarning, InputError
from trundle.mitigate import mitigation
from trundle.mitigate.changes import Change, each_change, every_combination
from trundle.mitigate.mitigation import resonance_speeds, try_changes
from trundle.results.parts import ChangesPart
from trundle.road import ExpansionJoint, Feature, FeaturedRoad, RoadClass
from trundle.run.checkpoint import InMemory, unfinished_of
from trundle.run.dask_cluster import local_cluster
from trundle.run.threads import Threads
from trundle.run.whole_study import run_study
from trundle.signals import Isolator
from trundle.simulate.fitness import LOST_CONTACT
from trundle.study_file.build import load_study
from trundle.units import KMH
from trundle.vehicle import container_truck_40ft
from trundle.views.mitigation import NONE, UNKNOWN, strictest

TEXT = GOOD.replace('duration = "4 s"', 'duration = "14 s"')


def study_of(folder, text=TEXT):
    path = folder / "study.toml"
    path.write_text(text)
    return load_study(path)


def verdict_of(study):
    ((verdict,),) = run_study(study).verdicts.values()
    return verdict


def outcome(sweep, change, speed, road):
    (found,) = (
        o for o in sweep.outcomes if (o.change, o.road) == (change, road) and o.speed == speed
    )
    (verdict,) = found.verdicts
    return verdict


@pytest.mark.longest
def test_a_combination_is_what_its_own_study_says(tmp_path):
    """Class C at 12 km/h, a thicker slab, more damping, an isolator: against four studies."""
    changes = [
        Change(),
        Change(label="slab", slab_thickness=0.3),
        Change(label="damping", damping_ratio=0.06),
        Change(label="isolator", isolation=Isolator(frequency=2.0, damping_ratio=0.1)),
    ]
    speeds = (12 * KMH, 15 * KMH)
    study = study_of(tmp_path)
    sweep = try_changes(study, changes=changes, speeds=speeds, roads=("B", "C"), runs=study.runs)
    assert len(sweep.outcomes) == 4 * 2 * 2
    slow = TEXT.replace('"15 km/h"', '"12 km/h"').replace('class = "B"', 'class = "C"')
    for text, found in (
        (slow, outcome(sweep, "as in the study", speeds[0], "C")),
        (TEXT, outcome(sweep, "as in the study", speeds[1], "B")),
        (TEXT.replace('slab_thickness = "0.2 m"', 'slab_thickness = "0.3 m"'), outcome(sweep, "slab", speeds[1], "B")),
        (TEXT.replace('"3 %"', '"6 %"'), outcome(sweep, "damping", speeds[1], "B")),
        (
            TEXT.replace("[[point]]", '[[point]]\nisolator = { frequency = "2 Hz", damping = "10 %" }'),
            outcome(sweep, "isolator", speeds[1], "B"),
        ),
    ):  # fmt: skip
        own = verdict_of(study_of(tmp_path, text))
        assert found.margin == pytest.approx(own.margin, rel=1e-5)
        assert found.status == own.status
    margins = sweep.margin("as in the study", "main", "C", "tool", "VC-A")
    assert margins[0] == pytest.approx(outcome(sweep, "as in the study", speeds[0], "C").margin)


def test_a_building_of_which_answers_are_asked_is_changed_by_its_answers(tmp_path, monkeypatch):
    """What is changed in nothing is what its own study says, to the last bit, near and far alike;
    nobody finds all modes, and no speed is told to be one of resonance."""
    parts = '\n[parts]\nnodes = 100\nband = 3\nresponse_tolerance = 0.05\nnear = "8 m"\n'
    text = BUILDING + parts + '\n[criteria]\nmethod = "coupled"\ncurves = ["VC-A"]\n'
    monkeypatch.setattr(mitigation, "modes_of", None)
    study = study_of(tmp_path, text)
    sweep = try_changes(study, changes=[Change()], speeds=[20 * KMH], roads=["B"], runs=study.runs)
    (found,) = sweep.outcomes
    ((_, own),) = run_study(study).verdicts.items()
    assert [v.margin for v in found.verdicts] == [v.margin for v in own]
    assert not any(sweep.resonances.values())


@pytest.mark.longest
def test_changes_together_are_what_their_own_study_says(tmp_path):
    """Slab, damping and isolator in all 8 combinations; the last against a study of all three."""
    levers = [
        [Change(label="slab", slab_thickness=0.3)],
        [Change(label="damping", damping_ratio=0.06)],
        [Change(label="isolator", isolation=Isolator(frequency=2.0, damping_ratio=0.1))],
    ]
    changes = every_combination(levers)
    assert [change.label for change in changes] == [
        "as in the study", "isolator", "damping", "damping, isolator",
        "slab", "slab, isolator", "slab, damping", "slab, damping, isolator",
    ]  # fmt: skip
    assert [change.label for change in each_change(levers)] == [
        "as in the study", "slab", "damping", "isolator",
    ]  # fmt: skip
    study = study_of(tmp_path)
    speeds = (15 * KMH,)
    sweep = try_changes(study, changes=changes, speeds=speeds, roads=("B",), runs=study.runs)
    assert [o.change for o in sweep.outcomes] == [change.label for change in changes]
    text = TEXT.replace('slab_thickness = "0.2 m"', 'slab_thickness = "0.3 m"').replace(
        '"3 %"', '"6 %"'
    )
    for label, own in (
        ("as in the study", TEXT),
        ("slab, damping", text),
        (
            "slab, damping, isolator",
            text.replace(
                "[[point]]", '[[point]]\nisolator = { frequency = "2 Hz", damping = "10 %" }'
            ),
        ),
    ):
        found = outcome(sweep, label, speeds[0], "B")
        expected = verdict_of(study_of(tmp_path, own))
        assert found.margin == pytest.approx(expected.margin, rel=1e-5)
    margins = [one.verdicts[0].margin for one in sweep.outcomes]
    assert len(set(np.round(margins, 6))) == len(changes)


def test_a_warning_of_every_speed_stands_once(tmp_path):
    """Modes left out are a doubt at both speeds, a road's end another one at each."""
    speeds = (12 * KMH, 15 * KMH)
    sweep = try_changes(
        study_of(tmp_path), changes=[Change()], speeds=speeds, roads=("A", "B"), runs=2
    )
    told = sweep.warnings()
    assert sum("modal truncation" in text for text in told) == 1
    assert not any(text.startswith("12") and "modal truncation" in text for text in told)
    (slow,) = (text for text in told if text.startswith("12 km/h"))
    assert "at 12 km/h; the road excites nothing" in slow
    pulling = FitnessWarning(subject=LOST_CONTACT, message="a wheel would pull")
    lost = [replace(o, warnings=(pulling,)) if o.road == "B" else o for o in sweep.outcomes]
    told = replace(sweep, outcomes=tuple(lost)).warnings()
    assert any(text.startswith("class B: loss of contact") for text in told)


def test_two_changes_of_one_name_are_refused(tmp_path):
    changes = [Change(label="slab", slab_thickness=t) for t in (0.2, 0.3)]
    with pytest.raises(InputError, match="2 changes are called 'slab'"):
        try_changes(study_of(tmp_path), changes=changes, speeds=(4.0,), roads=("B",), runs=2)


def test_a_criterion_is_not_met_for_want_of_excitation(tmp_path):
    """Waves to 2.83 cycle/m end at 11.8 Hz at 15 km/h, below the bands to 25 Hz computed."""
    study = study_of(tmp_path)
    sweep = try_changes(study, changes=[Change()], speeds=(15 * KMH,), roads=("A",), runs=2)
    (one,) = sweep.outcomes
    (passage,) = study.acting(study.cases[0], "B", study.methods[0])
    assert one.excited_to == pytest.approx(15 * KMH * passage.crossing.band.n_max)
    assert all(v.status != "pass" for v in one.verdicts)
    assert all(min(v.unexcited) == 12.5 for v in one.verdicts if v.unexcited)
    assert any(v.unexcited for v in one.verdicts)
    unknown = tuple(replace(v, status="not assessed") for v in one.verdicts)
    assert strictest(replace(one, verdicts=unknown), "tool") == UNKNOWN
    failed = tuple(replace(v, status="fail") for v in one.verdicts)
    assert strictest(replace(one, verdicts=failed), "tool") == NONE


def test_resonance_speeds_are_those_of_axles_in_step():
    """f1 = 4 Hz: axles d apart pass every 1/4 s at V = 4 d, every second beat at half of it."""
    truck = container_truck_40ft()
    distances = np.diff(truck.setback)
    expected = sorted({4.0 * d / k for d in distances for k in (1, 2, 3)})
    found = resonance_speeds(truck, 4.0, (0.1, 100.0))
    np.testing.assert_allclose(found, expected)
    assert all(3.0 <= v <= 7.0 for v in resonance_speeds(truck, 4.0, (3.0, 7.0)))


def test_the_command_writes_matrix_and_margins(tmp_path, monkeypatch, capsys, trundle):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(TEXT)
    options = ("--speeds", "10 km/h, 15 km/h", "--roads", "A,B", "--runs", "2", "--damping", "5 %")
    assert trundle("mitigate", "study.toml", *options) == 0
    assert "Strictest criterion met at tool: damping 5 %" in capsys.readouterr().out
    folder = tmp_path / "study-mitigation-results"
    with (folder / "summary.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 2 * 2
    assert {row["speed_kmh"] for row in rows} == {"10", "15"}
    assert all(float(row["margin"]) > 0 for row in rows)
    assert "data:image/png" in (folder / "report.html").read_text()


@pytest.mark.parametrize(
    ("option", "value", "told"),
    [
        ("--speeds", "15 kg", "--speeds '15 kg'"),
        ("--speeds", "0.001 km/h", "100000 are computed"),
        ("--speeds", "1e9 km/h", "100000 are computed"),
        ("--roads", "Z", "must be one of A, B"),
        ("--slab", "2 mm", "20 mm to 3 m"),
        ("--damping", "0 %", "above 0"),
        ("--isolator", "2 Hz", "2 Hz / 10 %"),
        ("--vehicle", "bicycle", "must be one of"),
        ("--slab", "0.3 m, 300 mm", "slab 300 mm stands there 2 times"),
    ],
)
def test_changes_that_cannot_be_are_refused(
    tmp_path, monkeypatch, capsys, trundle, option, value, told
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(TEXT)
    assert trundle("mitigate", "study.toml", option, value) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "study-mitigation-results").exists()


class Counting(Threads):
    """Counts the tasks that are computed."""

    def __init__(self):
        super().__init__()
        self.names = []

    def submit(self, task, shared, progress):
        self.names.append(task.name)
        super().submit(task, shared, progress)


def test_a_sweep_that_is_stopped_goes_on_with_what_it_finished(tmp_path):
    """Stopped after the first slab: the second run computes the rest alone, and says the same."""
    changes = [Change(), Change(label="slab", slab_thickness=0.3)]
    asked = {"changes": changes, "speeds": (12 * KMH, 15 * KMH), "roads": ("B",), "runs": 2}
    study, store = study_of(tmp_path), InMemory()

    def stop(what, share):
        if what.startswith("slab"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        try_changes(study, **asked, tell=stop, store=store)
    with Counting() as rest:
        resumed = try_changes(study, **asked, store=store, executor=rest)
    with Counting() as every:
        whole = try_changes(study, **asked, executor=every)
    assert 0 < len(rest.names) < len(every.names)
    for one, other in zip(resumed.outcomes, whole.outcomes, strict=True):
        assert [v.margin for v in one.verdicts] == [v.margin for v in other.verdicts]
    assert resumed.resonances == whole.resonances


def test_a_sweep_of_other_changes_takes_nothing_over(tmp_path):
    """What decides the runs beside the study decides whether its pieces are taken up again."""
    study, out = study_of(tmp_path), tmp_path / "out"
    for also, found in ((("slab", 0.3), 0), (("slab", 0.3), 1), (("slab", 0.31), 0)):
        with pytest.raises(KeyboardInterrupt), unfinished_of(study, out, also=also) as disk:
            assert disk.n_found == found
            disk.save("a", ChangesPart(variants=()))
            raise KeyboardInterrupt


@pytest.mark.longest
@pytest.mark.filterwarnings("ignore")
def test_workers_try_changes_to_the_same_bits(tmp_path):
    pytest.importorskip("distributed")
    changes = [Change(), Change(label="slab", slab_thickness=0.3)]
    asked = {"changes": changes, "speeds": (15 * KMH,), "roads": ("B", "C"), "runs": 4}
    study = study_of(tmp_path)
    here = try_changes(study, **asked)
    with local_cluster(2) as cluster:
        there = try_changes(study, **asked, executor=cluster)
    for one, other in zip(here.outcomes, there.outcomes, strict=True):
        assert [v.margin for v in one.verdicts] == [v.margin for v in other.verdicts]


@pytest.mark.parametrize("nothing", [{"changes": []}, {"speeds": []}, {"roads": []}, {"runs": 0}])
def test_nothing_to_try_is_refused(tmp_path, nothing):
    asked = {"changes": [Change()], "speeds": (15 * KMH,), "roads": ("B",), "runs": 2} | nothing
    with pytest.raises(InputError, match="at least one"):
        try_changes(study_of(tmp_path), **asked)


JOINT = """
[[feature]]
kind = "joint"
at = "3 m"
step = "4 mm"
"""


@pytest.mark.longest
def test_joints_stay_when_road_classes_are_compared(tmp_path):
    """On the study's own class and speed a joint is felt as in the study itself: the same level."""
    text = TEXT.replace(LIBRARY, LIBRARY + '\ncontact_patch = "0.2 m"') + JOINT
    study = study_of(tmp_path, text)
    speed = study.drives["main"].route.law.fastest
    sweep = try_changes(study, changes=[Change()], speeds=[speed], roads=["B"], runs=study.runs)
    assert outcome(sweep, sweep.outcomes[0].change, speed, "B").margin == pytest.approx(
        verdict_of(study).margin, rel=1e-9
    )
    plain = study_of(tmp_path, TEXT.replace(LIBRARY, LIBRARY + '\ncontact_patch = "0.2 m"'))
    change = verdict_of(plain).margin / verdict_of(study).margin
    assert abs(change - 1.0) > 0.02  # without it, it is another level


def test_joints_on_some_roads_and_vehicles_that_lift_off_are_refused(tmp_path):
    """Nothing is compared without a word on what was left out."""
    study = study_of(tmp_path)
    feature = Feature(shape=ExpansionJoint(step=0.004), station=3.0)
    first = next(iter(study.roads))
    roads = {**study.roads, first: FeaturedRoad(base=study.roads[first], features=(feature,))}
    roads["plain"] = RoadClass("A")
    with pytest.raises(InputError, match="on some of its roads alone"):
        try_changes(
            replace(study, roads=roads), changes=[Change()], speeds=[3.0], roads=["A"], runs=2
        )
    drives = {
        name: replace(drive, vehicle=replace(drive.vehicle, lifts_off=True))
        for name, drive in study.drives.items()
    }
    with pytest.raises(InputError, match="run on each road by itself"):
        try_changes(
            replace(study, drives=drives), changes=[Change()], speeds=[3.0], roads=["A"], runs=2
        )
