"""What is run to try changes: each combination once, shared where isolators alone differ."""

from dataclasses import replace

import pytest

from studies import GOOD, MAP
from trundle.errors import InputError
from trundle.mitigate.changes import Change
from trundle.mitigate.estimate import estimate_of_changes
from trundle.mitigate.mitigation import check_changes, check_speeds
from trundle.mitigate.plan import assessed, plan_changes, sharing_runs
from trundle.signals import Isolator
from trundle.study_file import study_from_text
from trundle.units import KMH
from trundle.vehicle import library_vehicle

TWO_METHODS = GOOD.replace(
    "[criteria]",
    '[[method]]\nname = "other"\ninteraction = "decoupled"\nf_max = "20 Hz"\ndt = "4 ms"\n'
    'damping = { ratio = "8 %" }\n\n[criteria]',
)
ISOLATORS = [
    Change(label=f"isolator {f:g}", isolation=Isolator(frequency=f, damping_ratio=0.1))
    for f in (1.0, 2.0)
]
SLAB = Change(label="slab", slab_thickness=0.3)
AS_IT_IS = (Change(),)
DAMPED = Change(label="damped", damping_ratio=0.06)


@pytest.fixture(scope="module")
def study():
    return study_from_text(GOOD)


def planned(study, changes=AS_IT_IS, speeds=(3.0,), roads=("A", "C"), runs=4):
    return plan_changes(study, changes=changes, speeds=speeds, roads=roads, runs=runs)


def test_changes_that_differ_by_isolators_alone_share_their_runs(study):
    """As it is and two isolators are one combination of three variants; slab and damping are not."""
    changes = [SLAB, Change(), DAMPED, *ISOLATORS, SLAB.but(ISOLATORS[0])]
    groups = [[c.label for c in group] for group in sharing_runs(changes)]
    assert groups == [
        ["as in the study", "isolator 1", "isolator 2"],
        ["damped"],
        ["slab", "slab, isolator 1"],
    ]
    found = planned(study, changes)
    assert [one.slab_thickness for one in found] == [None, None, 0.3]
    (tasks, *_) = (one.tasks(study) for one in found)
    assert [dict(v) for v in tasks[0].variants] == [
        {}, {"tool": ISOLATORS[0].isolation}, {"tool": ISOLATORS[1].isolation},
    ]  # fmt: skip


def test_two_vehicles_of_one_kind_are_two_changes():
    """A vehicle built twice is not known to be the same: it is run twice rather than mistaken."""
    one, other = (Change(label=n, vehicle=library_vehicle("car_bmw_320i")) for n in "ab")
    assert len(sharing_runs([Change(), one, other])) == 3


def test_every_speed_has_a_job_of_its_own_that_the_assessed_method_runs():
    """Two speeds, one case: two jobs by 'coupled', on both classes, with the runs asked for."""
    study = study_from_text(TWO_METHODS + MAP)
    found = planned(study, speeds=(2.0, 4.0), roads=("A", "C"), runs=7)
    assert [one.speed for one in found] == [2.0, 4.0]
    assert len({one.job.name for one in found}) == 2
    for one in found:
        assert one.job.method.name == "coupled"
        assert list(one.job.factors) == ["A", "C"]
        assert sum(len(part) for part in one.job.parts) == 7
        assert one.job.seed == found[0].job.seed
    assert found[0].label == "as in the study: main at 7.2 km/h"
    assert assessed(study)[1].interaction.integration.dt == 0.005


def test_class_c_is_four_times_as_rough_as_class_b_and_sixteen_as_a(study):
    """ISO 8608: power goes by 4 from class to class, amplitude by 2, counted from the first asked."""
    (one,) = planned(study, roads=("B", "A", "C", "D"))
    factors = one.job.factors
    assert {name: factors[name] / factors["B"] for name in factors} == pytest.approx(
        {"B": 1.0, "A": 0.5, "C": 2.0, "D": 4.0}
    )


def test_records_are_long_enough_for_the_slowest(study):
    """At 1 m/s the truck is on the floor for more than 12 s: the study's own 4 s are not kept."""
    slow, fast = planned(study, speeds=(1.0, 8.0))
    driven = study.drives["main"].route.length + study.drives["main"].vehicle.length
    lengths = [one.job.duration for one in (slow, fast)]
    assert lengths[0] >= driven / 1.0 + 5.0
    assert lengths[1] < lengths[0]
    assert lengths[1] >= driven / 8.0 + 5.0


def test_speeds_are_checked_by_their_steps(study):
    """Route and truck in steps of 5 ms: 20 to 100000 of them, both ends outside."""
    driven = study.drives["main"].route.length + study.drives["main"].vehicle.length
    check_speeds(study, [driven / (21 * 0.005), driven / (99_000 * 0.005)])
    for steps in (19, 101_000):
        with pytest.raises(InputError, match=r"20 to 100000 are computed") as told:
            check_speeds(study, [3.0, driven / (steps * 0.005)])
        assert f"in {float(f'{steps:.3g}'):.3g} steps of 5 ms" in str(told.value)
    for speed in (0.0, -3.0, float("nan")):
        with pytest.raises(InputError):
            check_speeds(study, [speed])
    with pytest.raises(InputError, match="give at least one speed"):
        check_speeds(study, [])
    with pytest.raises(InputError, match="nobody drives in this study"):
        check_speeds(replace(study, drives={}), [3.0])


def test_a_study_without_criteria_is_not_swept(study):
    """There is nothing that a change could meet; the file is named with the remedy."""
    with pytest.raises(InputError, match=r"has no \[criteria\] to hold changes against; add them"):
        check_changes(replace(study, assessment=None), [Change()])
    with pytest.raises(InputError, match="2 changes are called 'slab'"):
        check_changes(study, [SLAB, Change(), SLAB])


def test_more_work_is_estimated_as_longer(study):
    """Twice the speeds, runs, or slabs take longer; an isolator beside others next to nothing."""

    def seconds(changes=AS_IT_IS, speeds=(3.0,), runs=60):
        return estimate_of_changes(study, changes, speeds, runs).seconds

    once = seconds()
    assert once > 0.0
    assert seconds(speeds=(3.0, 3.5)) > once
    assert seconds(runs=600) > once
    assert seconds(changes=(Change(), SLAB)) > once
    assert seconds(changes=(Change(), *ISOLATORS)) == pytest.approx(once, rel=0.01)


def test_joints_on_every_road_are_laid_on_every_class():
    """A joint of 4 mm at 3 m lies on class D as it lies on the study's own road."""
    joint = '\n[[feature]]\nkind = "joint"\nat = "3 m"\nstep = "4 mm"\n'
    patch = 'kind = "container_truck_40ft"\ncontact_patch = "0.2 m"'
    text = GOOD.replace('kind = "container_truck_40ft"', patch) + joint
    (one,) = planned(study_from_text(text), roads=("D",), speeds=(15 * KMH,))
    (plain,) = planned(study_from_text(GOOD), roads=("D",), speeds=(15 * KMH,))
    (passage,), (smooth,) = one.job.sources, plain.job.sources
    (feature,) = passage.crossing.road.features
    assert feature.station == 3.0
    assert not hasattr(smooth.crossing.road, "features")
