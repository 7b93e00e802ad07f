"""[map]: where, how often and against what a floor is mapped; and what cannot be mapped."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

CURVES = 'curves = ["VC-A"]'
HOUSE = BUILDING + '\n[criteria]\nmethod = "coupled"\ncurves = ["VC-A"]\n'


def mapped(more="", *changes, text=GOOD):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return study_from_text(f"{text}\n[map]\n{more}").map


def told(more="", *changes, text=GOOD):
    with pytest.raises(StudyError) as caught:
        mapped(more, *changes, text=text)
    return {p.place: p for p in caught.value.problems}


def curves(*names):
    return CURVES, "curves = [" + ", ".join(f'"{n}"' for n in names) + "]"


def test_places_lie_half_a_step_inside_and_no_further_apart_than_asked():
    """12 m in steps of at most 2.5 m are five of 2.4 m; 6 m are three of 2 m."""
    (grid,) = mapped('spacing = "250 cm"').grids
    np.testing.assert_allclose(grid.x, [1.2, 3.6, 6.0, 8.4, 10.8])
    np.testing.assert_allclose(grid.y, [1.0, 3.0, 5.0])
    assert (grid.on, grid.axis) == (None, "z")
    # x runs fastest: the second place is one step along x
    np.testing.assert_allclose(grid.spots.xy[:2], [[1.2, 1.0], [3.6, 1.0]])


def test_a_map_of_no_spacing_has_at_least_300_places():
    """The floor's area over 300 is that of a place, rounded to whole steps of both sides."""
    plan = mapped()
    assert 300 <= plan.n_places <= 300 * (1 + 1 / 24) * (1 + 1 / 12)


def test_nodes_of_the_mesh_are_where_the_mesh_has_them():
    """Bays of 6 m in elements of 1.5 m."""
    (grid,) = mapped('places = "nodes"').grids
    np.testing.assert_allclose(grid.x, np.arange(9) * 1.5)
    np.testing.assert_allclose(grid.y, np.arange(5) * 1.5)


@pytest.mark.parametrize(
    ("runs", "asked", "made"),
    [(2, "", 2), (2, "runs = 50", 2), (300, "", 200), (300, "runs = 7", 7)],
)
def test_runs_of_a_map_are_the_first_of_the_studys(runs, asked, made):
    """200 unless given, and never more than there are."""
    assert mapped(asked, ("runs = 2", f"runs = {runs}")).runs == made


def test_what_a_map_does_more_is_asked_for():
    """Traffic, peaks, people and every step take longer: none of them by itself."""
    plain = mapped()
    names = ("traffic", "every_step", "peaks", "people")
    assert [getattr(plain, n) for n in names] == [False] * 4
    for name in names:
        assert getattr(mapped(f"{name} = true"), name) is True
        assert list(told(f'{name} = "yes"')) == [f"map.{name}"]
    assert (plain.percentile, plain.averaging) == (95.0, "max_1s")


def test_a_map_that_is_held_against_peaks_or_people_maps_them():
    """A curve of peak acceleration cannot be held against levels of velocity."""
    assert mapped("", curves("stepper-B")).peaks
    assert not mapped("", curves("stepper-B")).people
    assert mapped("", curves("R-office")).people
    assert not mapped("", curves("R-office")).peaks


def test_speeds_are_si_each_once_from_slow_to_fast():
    """36 km/h are 10 m/s, 18 km/h 5 m/s."""
    assert mapped('speeds = ["36 km/h", "5 m/s", "18 km/h", "10 m/s"]').speeds == (5.0, 10.0)


def test_the_curve_that_is_drawn_is_vc_b_where_there_is_one_and_else_the_last():
    """As docs say; one that is asked for comes before."""
    assert mapped("", curves("VC-B", "VC-C")).criterion == "VC-B"
    assert mapped("", curves("VC-A", "VC-C")).criterion == "VC-C"
    assert mapped('criterion = "VC-A"', curves("VC-A", "VC-B")).criterion == "VC-A"


def test_curves_that_no_map_shows_are_left_to_the_points():
    """A dose is of a day at one place; bands of acceleration are read at points."""
    plan = mapped("", curves("VC-A", "VDV-office-low"))
    assert [c.name for c in plan.criteria] == ["VC-A"]
    problem = told('criterion = "VDV-office-low"', curves("VC-A", "VDV-office-low"))[
        "map.criterion"
    ]
    assert problem.remedy == "there are: VC-A"
    assert told("", curves("VDV-office-low"))["map"].value == "no curve that can be mapped"


def test_level_motion_is_drawn_by_a_curve_of_level_motion():
    """Along x a vertical curve says nothing: it is not offered, and a horizontal one is."""
    house = HOUSE.replace(*curves("electron-microscope-vertical", "electron-microscope-horizontal"))
    grids = 'on = "lab"\nspacing = "4 m"\n'
    assert mapped(grids + 'axes = ["x"]', text=house).criterion == "electron-microscope-horizontal"
    assert mapped(grids, text=house).criterion == "electron-microscope-vertical"
    problem = told(grids + 'axes = ["y"]\ncriterion = "electron-microscope-vertical"', text=house)[
        "map.criterion"
    ]
    assert problem.remedy == "there are: electron-microscope-horizontal"


def test_every_storey_is_mapped_along_every_axis_unless_some_are_named():
    """Two decks and two axes are four grids; an axis that is named twice is mapped once."""
    plan = mapped('spacing = "4 m"\naxes = ["z", "x", "z"]', text=HOUSE)
    assert [(g.on, g.axis) for g in plan.grids] == [
        ("deck", "z"), ("deck", "x"), ("lab", "z"), ("lab", "x"),
    ]  # fmt: skip
    assert [g.on for g in mapped('spacing = "4 m"\non = "lab"', text=HOUSE).grids] == ["lab"]
    # 16 m by 6 m in steps of 4 m: 4 x 2 places of 4 m by 3 m, at y = 1.5 m and 4.5 m
    (grid,) = mapped('spacing = "4 m"\non = ["lab"]', text=HOUSE).grids
    np.testing.assert_allclose(grid.y, [1.5, 4.5])
    assert grid.spots.xy.shape == (8, 2)


def test_places_over_an_opening_are_left_out():
    """In steps of 1 m four places, 10.5 and 11.5 by 2.5 and 3.5 m, lie over the hole."""
    plan = mapped('spacing = "1 m"\non = "deck"', text=HOUSE)
    (grid,) = plan.grids
    assert plan.n_places == 16 * 6 - 4
    over = [list(grid.x).index(10.5), list(grid.y).index(2.5)]
    assert not grid.there[over[1], over[0]]


@pytest.mark.parametrize(
    ("more", "change", "place", "value"),
    [
        ("", (CURVES, CURVES + '\naveraging = "slow"'), "map", "averaging 'slow'"),
        ('spacing = "5 cm"', None, "map.spacing", "0.05 m"),
        ('places = "nodes"\nspacing = "1 m"', None, "map.spacing", "1 m"),
        ('axes = ["x"]', None, "map.axes", "x"),
        ('on = "deck"', None, "map.on", "'deck'"),
        ('criterion = "VC-B"', None, "map.criterion", "'VC-B'"),
        ("", ('f_max = "30 Hz"', 'f_max = "30 Hz"\nentry = "static"'), "map", "method 'coupled'"),
    ],
)
def test_what_cannot_be_mapped_is_told_before_work(more, change, place, value):
    """Each with what stands there; nothing of it is mapped otherwise in silence."""
    vehicle = ('"container_truck_40ft"', '"car_bmw_320i"')  # that fits on the floor
    found = told(more, *([change] if change else []), vehicle)
    assert list(found) == [place]
    assert found[place].value == value


def test_a_surface_that_is_named_twice_is_mapped_once():
    """Two grids of one name would be one picture; as axes, which are taken once too."""
    plan = mapped('spacing = "4 m"\non = ["deck", "lab", "deck"]', text=HOUSE)
    assert [grid.on for grid in plan.grids] == ["deck", "lab"]


def test_a_list_of_no_surface_is_refused():
    """One grid over all storeys, on none of them, cannot be computed."""
    assert list(told('spacing = "4 m"\non = []', text=HOUSE)) == ["map.on"]


def test_a_map_without_criteria_is_refused():
    """Held against nothing a floor is all of the best class."""
    bare = GOOD[: GOOD.index("[criteria]")]
    assert list(told(text=bare)) == ["map"]


def test_nodes_of_a_model_stand_in_no_grid():
    """A building is meshed freely."""
    assert "map.places" in told('places = "nodes"', text=HOUSE)


def test_runs_that_fit_are_offered_and_do_fit():
    """20 000 places at most; levels of many runs and roads are held at once."""
    roads = "".join(f'[[road]]\nclass = "{c}"\n' for c in "ACDEFGH")
    changes = [("runs = 2", "runs = 1000000"), ("[[point]]", roads + "[[point]]")]
    spacing = 'spacing = "12 cm"\n'
    problem = told(spacing + "runs = 900000", *changes)["map.runs"]
    most = int(problem.remedy.removeprefix("use at most ").partition(" ")[0])
    fewer = [("runs = 2", f"runs = {most}"), changes[1]]
    assert mapped(spacing + f"runs = {most}", *fewer).runs == most
    again = [("runs = 2", f"runs = {2 * most}"), changes[1]]
    assert list(told(spacing + f"runs = {2 * most}", *again)) == ["map.runs"]


def test_a_speed_at_which_steps_cannot_follow_the_road_is_refused():
    """Steps of 5 ms follow 0.5 / (10 x 0.005) = 10 cycles a metre at 36 km/h, 5 at 72 km/h."""
    rough = '[roughness]\nn_max = "9 1/m"\nn_max_follows_dt = {}\n[[method]]'
    fixed, free = (("[[method]]", rough.format(word)) for word in ("false", "true"))
    speeds = 'speeds = ["36 km/h", "72 km/h"]'
    found = told(speeds, fixed)
    assert list(found) == ["map.speeds[2]"]
    assert "waves to 5 1/m" in found["map.speeds[2]"].rule
    assert found["map.speeds[2]"].value == "72 km/h"
    assert mapped(speeds, free).speeds == (10.0, 20.0)


@pytest.mark.parametrize(
    ("of_method", "of_study", "fine"), [("20", "2.83", False), ("2.83", "20", True)]
)
def test_the_road_of_a_map_ends_where_its_methods_own_ends(of_method, of_study, fine):
    """Steps of 5 ms follow 6 cycles a metre at 60 km/h: 2.83 they follow, 20 they do not."""
    changes = (
        ('dt = "5 ms"', f'dt = "5 ms"\nn_max = "{of_method} 1/m"'),
        ("[[method]]", f'[roughness]\nn_max = "{of_study} 1/m"\nn_max_follows_dt = false\n[[method]]'),
    )  # fmt: skip
    speeds = 'speeds = ["60 km/h"]'
    if fine:
        assert mapped(speeds, *changes).speeds == pytest.approx((60 / 3.6,))
    else:
        found = told(speeds, *changes)
        assert list(found) == ["map.speeds[1]"]
        assert "the road's end at 20 1/m" in found["map.speeds[1]"].rule


def test_a_speed_at_which_steps_follow_no_wave_of_the_road_is_refused():
    """At 72 km/h waves to 5 cycles a metre are followed, and the road's shortest begin at 6."""
    rough = ("[[method]]", '[roughness]\nn_min = "6 1/m"\nn_max = "9 1/m"\n[[method]]')
    found = told('speeds = ["36 km/h", "72 km/h"]', rough)
    assert list(found) == ["map.speeds[2]"]
    assert "begin at 6 1/m" in found["map.speeds[2]"].rule


def test_a_speed_at_which_a_crossing_takes_more_than_a_million_steps_is_refused():
    """12 m and a car of 2.6 m or so at 5 m/h: three hours, two million steps of 5 ms."""
    car = ('"container_truck_40ft"', '"car_bmw_320i"')
    found = told('speeds = ["0.005 km/h"]', car)
    assert list(found) == ["map.speeds[1]"]
    assert "the limit is 1000000" in found["map.speeds[1]"].rule
