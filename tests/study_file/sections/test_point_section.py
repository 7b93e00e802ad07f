"""[[point]]: where the response is read, along which axes, and what stands between."""

import numpy as np
import pytest

from studies import BUILDING, GOOD
from trundle.errors import StudyError
from trundle.structure import Spot
from trundle.study_file import study_from_text

AT = 'at = ["3 m", "3 m"]'
LAB = 'on = "lab"\nat = ["4 m", "3 m"]'


def changed(old, new, text=GOOD):
    assert text.count(old) == 1
    return text.replace(old, new)


def told(old, new, text=GOOD):
    with pytest.raises(StudyError) as caught:
        study_from_text(changed(old, new, text))
    return {p.place: p for p in caught.value.problems}


def test_a_place_in_other_units_is_x_first_and_y_second():
    """250 cm along x and 1500 mm along y."""
    (spot,) = study_from_text(changed(AT, 'at = ["250 cm", "1500 mm"]')).points.values()
    assert spot == Spot(2.5, 1.5)


@pytest.mark.parametrize("at", ['["0 m", "0 m"]', '["12 m", "6 m"]', '["12 m", "0 m"]'])
def test_the_edge_of_a_floor_is_on_it(at):
    """Corners of 12 m by 6 m belong to the floor."""
    assert study_from_text(changed(AT, f"at = {at}")).points


@pytest.mark.parametrize(
    "at", ['["12.001 m", "3 m"]', '["-1 mm", "3 m"]', '["3 m", "6.001 m"]', '["6 m", "12 m"]']
)
def test_a_millimetre_beyond_is_off_it(at):
    """Along each axis by itself, and with x and y confused."""
    problem = told(AT, f"at = {at}")["point[1].at"]
    assert "x 0 to 12 m and y 0 to 6 m" in problem.rule


def test_points_keep_their_names_and_their_order_whatever_the_names():
    """Results are columns in this order, found by these names."""
    names = ["Waage", "a,b;c", "<i>Ü", "point", "2"]
    more = "".join(f'[[point]]\nname = "{n}"\nat = ["{i} m", "1 m"]\n' for i, n in enumerate(names))
    points = study_from_text(changed("[[method]]", more + "[[method]]")).points
    assert list(points) == ["tool", *names]
    assert [spot.x for spot in points.values()] == [3.0, 0.0, 1.0, 2.0, 3.0, 4.0]


def test_a_point_of_a_building_is_read_along_each_axis_under_a_name_of_its_own():
    """The vertical has the point's name, level motion its axis behind it, in the order given."""
    points = study_from_text(changed(LAB, f'{LAB}\naxes = ["y", "z", "x"]', BUILDING)).points
    assert list(points) == ["tool y", "tool", "tool x"]
    assert [spot.axis for spot in points.values()] == ["y", "z", "x"]
    assert {(spot.x, spot.y, spot.on) for spot in points.values()} == {(4.0, 3.0, "lab")}


def test_a_name_that_an_axis_makes_is_taken():
    """'tool' along x is 'tool x'; a point of that name would be one column with it."""
    more = f'{LAB}\naxes = ["z", "x"]\n[[point]]\nname = "tool x"\non = "lab"\nat = ["5 m", "3 m"]'
    assert told(LAB, more, BUILDING)["point[2]"].value == "'tool x' 2 times"


def test_level_motion_of_a_storey_whose_columns_end_fixed_is_not_read():
    """It does not sway: a level of nearly nothing would pass."""
    problem = told(AT, f'{AT}\naxes = ["z", "x"]')["point[1].axes"]
    assert "does not sway" in problem.rule
    assert problem.value == "z, x"


def test_an_isolator_is_of_vertical_motion_alone():
    """Nobody says how it moves along x; the floor's own x would be too much or too little."""
    more = f'{LAB}\naxes = ["z", "x"]\nisolator = {{ frequency = "2 Hz", damping = "5 %" }}'
    assert "vertical motion alone" in told(LAB, more, BUILDING)["point[1].axes"].rule


@pytest.mark.parametrize("axes", ["[]", '["w"]', '"z"'])
def test_axes_are_a_list_of_x_y_and_z(axes):
    """No axis is no motion: a point that nothing is read at."""
    assert any(place.startswith("point[1].axes") for place in told(AT, f"{AT}\naxes = {axes}"))


def test_an_isolator_is_a_mass_on_a_spring_of_its_own_units():
    """120 turns a minute are 2 Hz; at sqrt(2) times it what comes through is what goes in."""
    isolator = '{ frequency = "120 rpm", damping = "10 %" }'
    study = study_from_text(changed(AT, f"{AT}\nisolator = {isolator}"))
    (isolation,) = study.isolations.values()
    assert np.abs(isolation.response(np.array([2.0 * np.sqrt(2.0)]))) == pytest.approx(1.0)
    # at resonance |T| = sqrt(1 + 4 z^2) / (2 z)
    peak = np.sqrt(1.0 + 0.04) / 0.2
    assert np.abs(isolation.response(np.array([2.0]))) == pytest.approx(peak)


def test_a_table_of_an_isolator_takes_ratios_and_per_cents():
    """Between two rows of one ratio it stays; 5 % is 0.05."""
    table = '{ table = [["1 Hz", 0.05], ["20 Hz", "5 %"]] }'
    study = study_from_text(changed(AT, f"{AT}\nisolator = {table}"))
    response = study.isolations["tool"].response(np.array([1.0, 7.0, 20.0]))
    np.testing.assert_allclose(np.abs(response), 0.05)


@pytest.mark.parametrize(
    ("isolator", "place"),
    [
        ('{ frequency = "2 Hz", damping = "5 %", table = [["1 Hz", 1], ["9 Hz", 1]] }', ""),
        ('{ damping = "5 %" }', ""),
        ('{ frequency = "2 Hz", damping = 5 }', ".damping"),
        ('{ frequency = "0 Hz", damping = "5 %" }', ".frequency"),
        ('{ table = [["1 Hz", 1]] }', ".table"),
        ('{ table = [["1 Hz", 0], ["9 Hz", 1]] }', ".table[1][2]"),
        ('{ table = [["1 Hz", 1], ["9 Hz"]] }', ".table[2][2]"),
    ],
)
def test_an_isolator_that_is_said_twice_or_by_half_is_refused(isolator, place):
    """A transmissibility of 0 would let nothing through: a slip, and everything would pass."""
    found = told(AT, f"{AT}\nisolator = {isolator}")
    assert list(found) == [f"point[1].isolator{place}"]


def test_a_point_is_somewhere_once():
    """Without a place it would stand at (0, 0) in silence; a drawing is of a building."""
    assert "a point has a place" in told(AT + "\n", "")["point[1]"].rule
    assert "a point has a place" in told(AT, f'{AT}\ndrawn = "tool"')["point[1]"].rule
    assert told(AT, 'drawn = "tool"')["point[1].drawn"].remedy == "give at"


def test_a_storey_is_none_of_a_floor():
    """A [floor] has one surface, without a name."""
    assert told(AT, f'{AT}\non = "lab"')["point[1].on"].remedy == "remove it"


def test_surfaces_that_there_are_are_listed():
    """Two of three levels have a slab; the ground has none to stand on."""
    problem = told(LAB, LAB.replace('"lab"', '"ground"'), BUILDING)["point[1].on"]
    assert problem.remedy == "there are: deck, lab"
