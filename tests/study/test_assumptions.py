"""What a study takes for granted is said: axes, tracks, symmetry, beams under points, early ends."""

import re
from dataclasses import replace

import numpy as np
import pytest

from models import small_plan
from studies import BUILDING, GOOD
from trundle.structure import Spot, build_floor
from trundle.study.assumptions import assumption_warnings, early_end_warnings
from trundle.study_file import study_from_text


@pytest.fixture(scope="module")
def study():
    return study_from_text(GOOD)


def said(study):
    return {warning.subject: warning.message for warning in assumption_warnings(study)}


def test_vertical_motion_alone_is_said_to_be_so(study):
    """Curves for each axis hold for the vertical alone, unless a point or a map is level."""
    assert said(study)["axis"].startswith("only vertical motion is computed")
    level = replace(study, points={"tool x": replace(study.points["tool"], axis="x")})
    assert said(level)["axis"].startswith("level motion is that of vertical wheel loads alone")
    mapped = study_from_text(
        BUILDING + '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\naxes = ["z", "x"]\n'
        '[criteria]\nmethod = "coupled"\ncurves = ["VC-A"]\n'
    )
    assert mapped.point_ways is None
    assert said(mapped)["axis"].startswith("level motion")


def test_one_track_under_both_wheels_is_said_where_a_vehicle_is_flat():
    """The library's truck has its wheels in its middle; 2 m apart they have tracks of their own."""
    flat = study_from_text(GOOD)
    assert "wheel tracks" in said(flat)
    wide = study_from_text(
        GOOD.replace('kind = "container_truck_40ft"',
                     'kind = "container_truck_40ft"\ntrack_width = "2 m"')
    )  # fmt: skip
    assert np.ptp(wide.drives["main"].vehicle.lateral) == pytest.approx(2.0)
    assert "wheel tracks" not in said(wide)


@pytest.mark.parametrize(
    ("at", "on_beam"),
    [
        ((3.0, 3.0), False),  # middle of a bay, 3 m from any line
        ((3.0, 0.4), True),  # 0.4 m from the beam along y = 0
        ((3.0, 0.6), False),
        ((6.3, 3.0), True),  # 0.3 m from the beam along x = 6
        ((6.0, 6.0), True),
    ],
)
def test_a_point_within_half_a_metre_of_a_main_beam_is_told(study, at, on_beam):
    """Beams along both axes on lines x = 0, 6, 12 and y = 0, 6 of the small plan."""
    plan = small_plan()
    there = replace(
        study, plan=plan, floor=build_floor(plan, mesh_size=1.5), points={"<p>": Spot(*at)}
    )
    found = said(there)
    assert ("point <p>" in found) == on_beam
    if on_beam:
        assert f"({at[0]:g}, {at[1]:g}) m stands on a main beam" in found["point <p>"]


def test_only_beams_that_are_there_hold_a_point_still(study):
    """The small study has beams along x alone: x = 6 m is no beam, y = 0.2 m is one."""
    assert study.plan.beams_y is None
    for at, told in (((6.0, 3.0), False), ((3.0, 0.2), True)):
        assert any(
            subject.startswith("point")
            for subject in said(replace(study, points={"p": Spot(*at)}))
        ) == told  # fmt: skip


def test_a_record_that_ends_too_early_is_told_with_its_case_and_times(study):
    """The truck leaves at 5.9 s: 4 s are too short, exactly that long is enough."""
    (case,) = study.cases
    leaves = study.acting(case, "B", study.methods[0])[0].leaves
    driven = study.drives["main"].route.length + study.drives["main"].vehicle.length
    assert leaves >= driven / (15.0 / 3.6)  # not before its last axle is over the edge
    (told,) = early_end_warnings(study, case)
    assert told.subject == "duration, main"
    times = re.search(
        r"record at (\S+) s; it leaves at (\S+) s, and nothing is assessed", told.message
    )
    assert float(times[1]) == 4.0
    assert float(times[2]) == pytest.approx(leaves, abs=0.05)
    assert early_end_warnings(replace(study, duration=leaves), case) == ()
    assert early_end_warnings(replace(study, duration=leaves - 1e-6), case) != ()
    assert early_end_warnings(replace(study, duration=None), case) == ()
