"""[[feature]]: what lies on which road, where along and across a route, and in which sizes."""

import numpy as np
import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.road import (
    Bump,
    CableProtector,
    CosineHump,
    ExpansionJoint,
    Patch,
    Pothole,
    RailCrossing,
    RampKink,
)
from trundle.study_file import study_from_text

BASE = GOOD.replace('"container_truck_40ft"', '"van_vw_t2"') + (
    '[roughness]\nn_max = "5 1/m"\ncontact_patch = "0.2 m"\n'
)
HUMP = 'kind = "cosine_hump"\nlength = "2 m"\nheight = "2 cm"\n'
SIDE = """
[[route]]
name = "side"
vehicle = "truck"
path = [["6 m", "0 m"], ["6 m", "6 m"]]
speed = "5 km/h"
"""


def study(*features, more=""):
    return study_from_text(BASE + more + "".join(f"[[feature]]\n{one}\n" for one in features))


def features(*tables, road="B", more=""):
    return study(*tables, more=more).roads[road].features


def told(*tables, more=""):
    with pytest.raises(StudyError) as caught:
        study(*tables, more=more)
    return {p.place: p for p in caught.value.problems}


@pytest.mark.parametrize(
    ("keys", "shape"),
    [
        ('kind = "joint"\ngap = "20 mm"\nstep = "-3 mm"\ndepth = "5 cm"\nrunout = "150 cm"',
         ExpansionJoint(gap=0.02, step=-0.003, depth=0.05, runout=1.5)),
        ('kind = "pothole"\nlength = "60 cm"\ndepth = "40 mm"\nedge = "10 cm"',
         Pothole(length=0.6, depth=0.04, edge=0.1)),
        ('kind = "patch"\nlength = "1.2 m"\nheight = "-8 mm"\nramp = "20 mm"',
         Patch(length=1.2, height=-0.008, ramp=0.02)),
        ('kind = "bump"\nlength = "50 cm"\nheight = "3 cm"', Bump(length=0.5, height=0.03)),
        ('kind = "cosine_hump"\nlength = "3.7 m"\nheight = "100 mm"', CosineHump(length=3.7, height=0.1)),
        ('kind = "ramp_kink"\ngrade = "-4 %"\nlength = "2 m"\nrounding = "50 cm"',
         RampKink(grade=-0.04, length=2.0, rounding=0.5)),
        ('kind = "rail_crossing"\nflangeway = "70 mm"\ndepth = "35 mm"\nhead = "67 mm"\n'
         'proud = "4 mm"\ngauge = "1 m"',
         RailCrossing(flangeway=0.07, depth=0.035, head=0.067, proud=0.004, gauge=1.0)),
        ('kind = "cable_protector"\nlength = "30 cm"\nheight = "45 mm"\ntop = "10 cm"',
         CableProtector(length=0.3, height=0.045, top=0.1)),
    ],
)  # fmt: skip
def test_every_kind_takes_its_sizes_in_si(keys, shape):
    """Each size a number of its own, so that no two can be confused: the shape made directly."""
    (feature,) = features(f'{keys}\nat = "5 m"')
    assert type(feature.shape) is type(shape)
    for name, value in vars(shape).items():
        assert getattr(feature.shape, name) == pytest.approx(value), name


@pytest.mark.parametrize(
    "keys",
    [
        'kind = "joint"\ngap = "20 mm"',
        'kind = "pothole"\nlength = "60 cm"\ndepth = "40 mm"',
        'kind = "patch"\nlength = "1 m"\nheight = "8 mm"',
        'kind = "rail_crossing"',
    ],
)
def test_sizes_that_are_left_out_are_those_of_the_shape_itself(keys):
    """The file has no defaults of its own beside the shapes'."""
    (feature,) = features(f'{keys}\nat = "5 m"')
    kinds = {"joint": ExpansionJoint, "pothole": Pothole, "patch": Patch}
    sizes = {"joint": {"gap": 0.02}, "pothole": {"length": 0.6, "depth": 0.04},
             "patch": {"length": 1.0, "height": 0.008}}  # fmt: skip
    kind = keys.split('"')[1]
    assert feature.shape == kinds.get(kind, RailCrossing)(**sizes.get(kind, {}))


def test_stations_are_lengths_one_or_several():
    """A number by itself is a list of one."""
    assert [f.station for f in features(f'{HUMP}at = "450 cm"')] == [4.5]
    assert [f.station for f in features(f'{HUMP}at = ["0 m", "9 m", "4500 mm"]')] == [0.0, 9.0, 4.5]


def test_what_comes_every_so_often_begins_at_its_station():
    """Four from 1 m on, every 250 cm: at 1, 3.5, 6 and 8.5 m."""
    found = features(f'{HUMP}at = "1 m"\nevery = "250 cm"\ncount = 4')
    assert [f.station for f in found] == [1.0, 3.5, 6.0, 8.5]


def test_a_side_is_left_or_right_of_the_way():
    """Left of the middle is positive."""
    across = {
        side: features(f'{HUMP}at = "5 m"\nside = "{side}"')[0].across
        for side in ("left", "right", "both")
    }
    assert across == {"left": (0.0, np.inf), "right": (-np.inf, 0.0), "both": (-np.inf, np.inf)}


def test_a_skew_is_in_radians_and_a_route_a_name():
    """30 deg are pi / 6; without a route it is for all of them."""
    one, all_ = features(
        f'{HUMP}at = "5 m"\nskew = "30 deg"\nroute = "side"', f'{HUMP}at = "3 m"', more=SIDE
    )
    assert one.skew == pytest.approx(np.pi / 6)
    assert (one.route, all_.route) == ("side", None)
    assert all_.skew == 0.0


def test_features_lie_on_the_roads_they_name_in_the_order_of_the_file():
    """Roads without one stay as they are; those with the same ones share them."""
    more = '[[road]]\nclass = "C"\n[[road]]\nsmooth = true\n'
    roads = study(
        f'{HUMP}at = "9 m"\nroads = ["C", "B"]', f'{HUMP}at = "2 m"\nroads = ["B", "C"]', more=more
    ).roads
    assert list(roads) == ["B", "C", "smooth"]
    assert [f.station for f in roads["B"].features] == [9.0, 2.0]
    assert roads["B"].features is roads["C"].features
    assert not hasattr(roads["smooth"], "features")


@pytest.mark.parametrize(
    ("line", "station", "skew", "across"),
    [
        ('[["4 m", "0 m"], ["4 m", "6 m"]]', 4.0, 0.0, (-3.0, 3.0)),
        ('[["4 m", "6 m"], ["4 m", "0 m"]]', 4.0, 0.0, (-3.0, 3.0)),
        ('[["4 m", "2 m"], ["4 m", "5 m"]]', 4.0, 0.0, (-1.0, 2.0)),
        ('[["3 m", "2 m"], ["5 m", "4 m"]]', 4.0, np.pi / 4, (-1.0, 1.0)),
        ('[["5 m", "2 m"], ["3 m", "4 m"]]', 4.0, -np.pi / 4, (-1.0, 1.0)),
    ],
)
def test_a_line_in_plan_is_where_the_route_meets_it(line, station, skew, across):
    """A way along x at y = 3 m: by hand, station is x, and across is y - 3 m of the line's ends.

    A line that runs ahead on the left meets left wheels later.
    """
    (feature,) = features(f'kind = "joint"\ngap = "2 cm"\nline = {line}')
    assert feature.station == pytest.approx(station, abs=1e-6)
    assert feature.skew == pytest.approx(skew, abs=1e-9)
    assert feature.across == pytest.approx(across)
    assert feature.route == "main"


def test_a_line_that_two_routes_cross_is_there_for_each():
    """x + y = 9 m meets y = 3 m at x = 6 m, and x = 6 m at y = 3 m."""
    line = 'kind = "joint"\ngap = "2 cm"\nline = [["4 m", "5 m"], ["8 m", "1 m"]]'
    found = features(line, more=SIDE)
    assert {f.route: pytest.approx(f.station) for f in found} == {"main": 6.0, "side": 3.0}
    (only,) = features(f'{line}\nroute = "side"', more=SIDE)
    assert only.route == "side"


def test_a_line_that_ends_before_the_way_is_met_by_nobody():
    """y = 3 m is not reached from y = 4 m; the line is told with its ends."""
    problem = told('kind = "joint"\ngap = "2 cm"\nline = [["4 m", "4 m"], ["5 m", "6 m"]]')[
        "feature[1].line"
    ]
    assert problem.value == "from (4, 4) to (5, 6) m"


@pytest.mark.parametrize(
    ("keys", "place", "words"),
    [
        ("every = '2 m'\ncount = 3\nat = ['1 m', '2 m']", "feature[1]", "begin at one station"),
        ("count = 3\nat = '1 m'", "feature[1]", "every and count go together"),
        ("every = '2 m'\ncount = 1\nat = '1 m'", "feature[1].count", "2 or more"),
        ("every = '2 m'\ncount = 2.5\nat = '1 m'", "feature[1].count", "whole number"),
        ("skew = '3 deg'\nline = [['4 m', '0 m'], ['4 m', '6 m']]", "feature[1]", "its own angle"),
        ("at = '1 m'\nside = 'lef'", "feature[1].side", "must be one of"),
        ("at = '1 m'\nwidth = '1 m'", "feature[1].width", "unknown key"),
        ("at = '1 kg'", "feature[1].at[1]", "not one of length"),
        ("at = '13 m'", "feature[1].at", "no route meets it: the longest ends after 12 m"),
        ("at = '1 m'\nroute = 'other'", "feature[1].route", "name of a route"),
        ("at = '1 m'\nroads = ['B', 'X']", "feature[1].roads[2]", "name of a road"),
    ],
)
def test_a_feature_that_would_lie_nowhere_is_told(keys, place, words):
    """Left out in silence a hump that nobody meets would make the floor pass."""
    found = told(HUMP + keys)
    assert words in found[place].rule


@pytest.mark.parametrize("height", ["0 m", "0 mm"])
def test_a_hump_of_no_height_is_refused(height):
    """There would be nothing where the file says that there is something."""
    assert (
        "must not be 0"
        in told(f'kind = "bump"\nlength = "1 m"\nheight = "{height}"\nat = "1 m"')[
            "feature[1]"
        ].rule
    )


def test_a_feature_of_a_route_with_a_mistake_is_no_second_mistake():
    """The route's speed is wrong; its name is known."""
    text = BASE.replace('speed = "15 km/h"', 'speed = "15"')
    with pytest.raises(StudyError) as caught:
        study_from_text(f'{text}[[feature]]\n{HUMP}at = "1 m"\nroute = "main"\n')
    assert [p.place for p in caught.value.problems] == ["route[1].speed"]


def test_a_feature_of_a_road_that_cannot_be_read_is_no_second_mistake():
    """The survey is missing; its label is known. That of a road of no class is not."""
    gone = told(f'{HUMP}at = "4 m"\nroads = ["survey"]',
                more='[[road]]\nfile = "gone.csv"\nname = "survey"\n')  # fmt: skip
    assert list(gone) == ["road[2].file"]
    unsound = told(f'{HUMP}at = "4 m"\nroads = ["Z"]', more='[[road]]\nclass = "Z"\n')
    assert list(unsound) == ["road[2].class"]
