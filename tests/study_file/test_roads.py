"""Roads of a study: classes, flatness, surveys in their own chainage, and what lies on them."""

import re
from pathlib import Path

import numpy as np
import pytest

from trundle import run_study, study_from_text
from trundle.errors import StudyError
from trundle.road import FeaturedRoad, Profile, RoadClass, RoughnessBand, Tread, synthesise

STUDY = """title = "Roads"
seed = 1
runs = 2
[floor]
kind = "plan"
mesh_size = "2 m"
x_lines = ["0 m", "12 m", "24 m"]
y_lines = ["0 m", "10 m"]
slab_thickness = "0.20 m"
material = { elastic_modulus = "33 GPa", poisson_ratio = 0.2, density = "2450 kg/m3" }
beams_x = { width = "0.5 m", depth = "1.2 m" }
beams_y = { width = "0.4 m", depth = "1.0 m" }
column = { width = "0.7 m", depth = "0.7 m" }
storey_below = "6 m"
storey_above = "6 m"
[vehicle.van]
kind = "van_vw_vanagon"
[[route]]
name = "aisle"
vehicle = "van"
path = [["0 m", "5 m"], ["24 m", "5 m"]]
speed = "10 km/h"
run_in = "5 m"
[[point]]
name = "tool"
at = ["6 m", "3 m"]
[roughness]
n_min = "0.05 1/m"
n_max = "5 1/m"
contact_patch = "0.15 m"
[[method]]
name = "decoupled"
interaction = "decoupled"
dt = "5 ms"
f_max = "40 Hz"
damping = { ratio = "3 %" }
"""


def study(more, folder=".", **changes):
    text = STUDY + more
    for old, new in changes.values():
        text = text.replace(old, new)
    return study_from_text(text, folder=folder)


def mistakes(more, folder="."):
    with pytest.raises(StudyError) as caught:
        study(more, folder)
    return str(caught.value)


def survey(tmp_path, profile):
    rows = (f"{s:.9f},{z:.12f}" for s, z in zip(profile.station, profile.elevation, strict=True))
    (tmp_path / "road.csv").write_text("station [m],height [m]\n" + "\n".join(rows) + "\n")


def test_every_way_to_say_what_a_road_is():
    """A class, a roughness, a flatness, nothing at all; each under its own label."""
    roads = study("""
[[road]]
class = "B"
[[road]]
roughness = "5e-6 m3"
waviness = 2.5
name = "hall"
[[road]]
flatness = "FF 50"
[[road]]
smooth = true
""").roads
    assert list(roads) == ["B", "hall", "FF 50", "smooth"]
    assert roads["hall"].spectrum.roughness == 5e-6
    assert roads["hall"].spectrum.waviness == 2.5
    assert roads["smooth"].spectrum is None


def test_a_profile_of_class_b_given_as_data_is_the_run_that_drew_it(tmp_path):
    """Read back from a file, at the run's own stations: what is felt at the tool is the same.

    The file holds the heights that the first run was drawn with; the spline between its points is
    within 3e-5 of the waves (20 samples to the shortest), and the run drawn by class reads its
    slope from the Fourier series.
    """
    from trundle.simulate import Crossing
    from trundle.simulate.sources.random_road import run_generator

    drawn = study('[[road]]\nclass = "B"\n')
    case, method = drawn.cases[0], drawn.methods[0]
    (passage,) = drawn.acting(case, "B", method)
    crossing = passage.crossing
    assert isinstance(crossing, Crossing)
    ends = drawn.record_length([passage])
    reach = crossing.vehicle.length + 10.0
    low = -float(np.ceil(5.0 - min(0.0, crossing.lead + 10.0) + reach))
    way = float(crossing.route.law.distance(ends))
    high = float(np.ceil(max(crossing.route.length, way) + reach))
    # the band holds the contact patch; the file must not, for it is averaged when it is driven on
    bare = RoughnessBand(n_min=0.05, n_max=5.0)
    road = synthesise(
        RoadClass("B"), length=high - low, rng=run_generator(1, "aisle", 0), band=bare, start=low
    )
    survey(tmp_path, road)
    given = study(
        '[[road]]\nfile = "road.csv"\nfrom = "0 m"\nbeyond = "mirror"\ndetrend = false\n', tmp_path
    )
    ours, theirs = (
        next(iter(run_study(one).cells.values())).history.acceleration[:, 0]
        for one in (given, drawn)
    )
    assert np.abs(ours - theirs).max() < 1e-2 * np.abs(theirs).max()


def rough(first, length):
    road = synthesise(
        RoadClass("A"), length=length, rng=np.random.default_rng(3),
        band=RoughnessBand(n_min=0.05, n_max=5.0),
    )  # fmt: skip
    return Profile.from_samples(road.station + first, road.elevation)


def test_chainage_is_respected(tmp_path):
    """A survey from 478 m laid with its 500 m at the route's start is read there."""
    survey(tmp_path, rough(478.0, 80.0))
    made = study('[[road]]\nfile = "road.csv"\nfrom = "500 m"\n', tmp_path)
    (passage,) = made.acting(made.cases[0], "road", made.methods[0])
    assert passage.crossing.chainage == 500.0
    assert made.files["road.csv"].startswith(b"station [m]")


def test_a_survey_that_does_not_reach_is_refused_with_the_missing_stretch(tmp_path):
    """Named are the road's line, what is missing, and where the route may start."""
    survey(tmp_path, rough(478.0, 80.0))
    told = mistakes('[[road]]\nfile = "road.csv"\nfrom = "478 m"\n', tmp_path)
    assert re.search(r"line \d+, road\[1\]: got 478.07 to 557.9", told)
    found = re.search(r"needs (\S+) to (\S+) m of it", told)
    low, high = float(found[1]), float(found[2])
    # run-in 5 m (rounded up to steps) and 2.47 m of van before the start; the van's length behind
    assert 478.0 - 5.0 - 2.48 - 0.02 < low < 478.0 - 5.0 - 2.46
    assert high == pytest.approx(478.0 + 24.0 + 2.47, abs=0.02)
    assert f"{low:.2f} to 478.07 m missing" in told
    least = float(re.search(r'start at from = "(\S+) m"', told)[1])
    study(
        f'[[road]]\nfile = "road.csv"\nfrom = "{least} m"\n', tmp_path
    )  # what it offers is enough
    short = mistakes('[[road]]\nfile = "road.csv"\nfrom = "545 m"\n', tmp_path)
    assert "557.93 to 571.47 m missing" in short or "to 571.47 m missing" in short


def test_belgian_blocks_are_driven_over_on_five_cuts(tmp_path):
    """Ten measured metres, mirrored: left and right wheels on cuts of their own, and they roll."""
    blocks = Path(__file__).resolve().parents[3] / "shared" / "data" / "belgian_block.csv"
    if not blocks.exists():
        pytest.skip("no measured road at hand")
    (tmp_path / "blocks.csv").write_bytes(blocks.read_bytes())
    made = study(
        '[[road]]\nfile = "blocks.csv"\nbeyond = "mirror"\n', tmp_path,
        kind=('kind = "van_vw_vanagon"', 'kind = "van_vw_vanagon"\ntrack_width = "1.5 m"'),
        slow=('"10 km/h"', '"5 km/h"'),
    )  # fmt: skip
    left, right = (made.roads["blocks"].under(y, Tread()) for y in (0.75, -0.75))
    assert left is made.roads["blocks"].tracks[3]  # at v = 0.94 m
    assert right is made.roads["blocks"].tracks[1]  # at v = -0.60 m
    (cell,) = run_study(made).cells.values()
    forces = cell.history.contact_forces[:600]
    # blocks of 2 cm in height press hard at a walking pace, and not alike on both sides
    assert forces.std(axis=0).min() > 0.02 * forces.mean()
    sides = np.corrcoef(forces[:, 0] - forces[:, 0].mean(), forces[:, 1] - forces[:, 1].mean())
    assert abs(sides[0, 1]) < 0.9


FEATURES = """
[[road]]
class = "A"
[[road]]
class = "C"
[[road]]
smooth = true
[[feature]]
kind = "joint"
at = "6 m"
every = "6 m"
count = 3
gap = "20 mm"
step = "3 mm"
runout = "2 m"
[[feature]]
kind = "cosine_hump"
at = ["4 m", "15 m"]
length = "3 m"
height = "40 mm"
roads = ["smooth"]
side = "left"
"""


def test_features_lie_on_the_roads_that_they_are_for():
    """Three joints on all; humps on one, under left wheels alone."""
    roads = study(FEATURES).roads
    assert [len(road.features) for road in roads.values()] == [3, 3, 5]
    tread = Tread(sinking=0.02)
    left, right = (roads["smooth"].under(y, tread).at(5.5)[0] for y in (0.8, -0.8))
    assert (left, right) == (pytest.approx(0.04), pytest.approx(0.0))
    joint = roads["A"].under(0.0, tread)
    assert [joint.at(x)[0] for x in (6.01, 12.01, 18.01)] == [pytest.approx(-0.02)] * 3


def test_roads_with_the_same_features_are_scaled_and_not_run_again():
    """C is A with 16 times the power: its random part is 4 times A's, and the joints' stays.

    Run alone it draws the same roads; what it gives must be the same.
    """
    result = run_study(study(FEATURES))
    alone = run_study(study(FEATURES.replace('[[road]]\nclass = "A"\n', "")))
    ours, theirs = (
        next(cell for key, cell in one.cells.items() if key.road == "C").history.acceleration
        for one in (result, alone)
    )
    np.testing.assert_allclose(ours, theirs, atol=1e-9 * np.abs(theirs).max())


@pytest.mark.parametrize("turned", [False, True])
def test_a_joint_line_on_the_plan_meets_each_route_where_they_cross(turned):
    """A line from (10, 2) to (12, 8) meets y = 5 at x = 11, at an angle of atan(2 / 6)."""
    path = ('["0 m", "5 m"], ["24 m", "5 m"]', '["24 m", "5 m"], ["0 m", "5 m"]')
    more = """
[[road]]
smooth = true
[[feature]]
kind = "joint"
line = [["10 m", "2 m"], ["12 m", "8 m"]]
step = "5 mm"
"""
    made = study(more, way=(path[0], path[1] if turned else path[0]))
    (feature,) = made.roads["smooth"].features
    assert feature.station == pytest.approx(13.0 if turned else 11.0)
    assert feature.route == "aisle"
    # to the left of the first way the line runs on ahead; the other way the same, seen from behind
    assert feature.skew == pytest.approx(np.arctan(1.0 / 3.0))
    # the line's ends are 3 m to either side
    assert feature.across == (pytest.approx(-3.0), pytest.approx(3.0))
    # from the right of the line to its left it rises
    assert feature.shape.step == pytest.approx(0.005 if turned else -0.005)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ('[[road]]\nclass = "B"\nsmooth = true\n', "one of: class, roughness, flatness, file"),
        ("[[road]]\nwaviness = 2.0\n", "got none of them"),
        ('[[road]]\nflatness = "FF 50"\nlevel = "upper"\n', "a road of flatness has no level"),
        ('[[road]]\nflatness = "FF"\n', "flatness 'FF' is not known"),
        ('[[road]]\nfile = "nothing.csv"\n', "no such file"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "joint"\nat = "4 m"\n', "a gap or a step"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "bump"\nlength = "1 m"\nheight = "1 cm"\n',
         "at stations along routes .at., or on a line"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "bump"\nat = "4 m"\nevery = "2 m"\n'
         'length = "1 m"\nheight = "1 cm"\n', "every and count go together"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "hole"\nat = "4 m"\n', "joint.*pothole"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "bump"\nat = "40 m"\nlength = "1 m"\n'
         'height = "1 cm"\n', "no route meets it: the longest ends after 24 m"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "bump"\nat = "4 m"\nlength = "1 m"\n'
         'height = "1 cm"\nroute = "other"\n', "must be the name of a route"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "bump"\nat = "4 m"\nlength = "1 m"\n'
         'height = "1 cm"\nroads = ["B"]\n', "must be the name of a road"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "joint"\ngap = "2 mm"\n'
         'line = [["6 m", "0 m"], ["8 m", "10 m"]]\n', "4 mm to 0.5 m"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "joint"\ngap = "20 mm"\n'
         'line = [["0 m", "4.99 m"], ["24 m", "5.01 m"]]\n', "within 80 degrees"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "ramp_kink"\nat = "4 m"\n'
         'grade = "5 deg"\nlength = "2 m"\n', r"feature\[1\].grade"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "bump"\nat = "-600 m"\nlength = "1 m"\n'
         'height = "1 cm"\n', "more than 200 m before"),
        ('[[road]]\nsmooth = true\n[[feature]]\nkind = "joint"\nstep = "5 mm"\n'
         'line = [["1 m", "7 m"], ["3 m", "9 m"]]\n', "no route crosses this line"),
    ],
)  # fmt: skip
def test_mistakes_are_named(more, words):
    assert re.search(words, mistakes(more), re.DOTALL)


def test_a_point_contact_on_a_joint_is_refused_before_work():
    """By name, with usual lengths of contact patches."""
    with pytest.raises(StudyError, match=r"some 0.2 m of a truck's tyre"):
        study(FEATURES, patch=('contact_patch = "0.15 m"\n', ""))


def test_features_are_kept_as_values():
    """The road says what it is, for the report."""
    road = study(FEATURES).roads["A"]
    assert isinstance(road, FeaturedRoad)
    assert str(road) == "class A (geometric mean) with 3 x expansion joint"
