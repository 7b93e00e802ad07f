"""[[printed]], [[printed_bound]], [publication] and [[note]]: what a publication says."""

import pytest

from studies import GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

PRINTED = """
[[printed]]
case = "main"
road = "B"
method = "coupled"
peak_acceleration = "1.5 gal"
rms_velocity = "30 um/s"
"""
BOUND = """
[[printed_bound]]
bound = "absolute maximum"
road = "B"
method = "coupled"
peak_acceleration = "20 mm/s2"
rms_velocity = "0.36 m/h"
"""
TRAFFIC = '[[traffic]]\nname = "both"\nroutes = ["main", "main"]\nheadway = "3 s"\n'
WALKER = '[[walker]]\nname = "guard"\nguide = "p354"\npace = "2 Hz"\nat = ["3 m", "1 m"]\n'


def told(more):
    with pytest.raises(StudyError) as caught:
        study_from_text(GOOD + more)
    return {p.place: p for p in caught.value.problems}


def test_printed_values_are_held_in_si():
    """1.5 gal are 0.015 m/s2; 0.36 m/h are 1e-4 m/s."""
    study = study_from_text(GOOD + PRINTED + BOUND)
    (value,), (bound,) = study.printed, study.printed_bounds
    assert (value.case, value.road, value.method) == ("main", "B", "coupled")
    assert value.peak_acceleration == pytest.approx(0.015)
    assert value.rms_velocity == pytest.approx(30e-6)
    assert bound.bound == "absolute maximum"
    assert bound.peak_acceleration == pytest.approx(0.02)
    assert bound.rms_velocity == pytest.approx(1e-4)


def test_values_of_traffic_are_values_of_a_case():
    """Several vehicles at once are a case like a route."""
    study = study_from_text(GOOD + TRAFFIC + PRINTED.replace('"main"', '"both"'))
    assert study.printed[0].case == "both"
    assert study.cases[-1].name == "both"


def test_values_of_a_walker_are_values_of_a_case():
    """People and machines are cases like a route; where nobody drives the road is 'no road'."""
    guard = PRINTED.replace('"main"', '"guard"')
    study = study_from_text(GOOD + WALKER + guard)
    assert study.printed[0].case in {case.name for case in study.cases}
    alone = GOOD.partition("[vehicle.truck]")[0] + GOOD[GOOD.index("[[point]]") :] + WALKER
    study = study_from_text(alone + guard.replace('"B"', '"no road"'))
    assert study.printed[0].road in study.roads
    with pytest.raises(StudyError) as caught:
        study_from_text(alone + guard)
    assert [p.remedy for p in caught.value.problems] == ["there are: no road"]


@pytest.mark.parametrize(
    ("more", "place", "known"),
    [
        (PRINTED.replace('"B"', '"C"'), "printed[1].road", "B"),
        (PRINTED.replace('"coupled"', '"other"'), "printed[1].method", "coupled"),
        (BOUND.replace('"B"', '"b"'), "printed_bound[1].road", "B"),
        (BOUND.replace('"coupled"', '"other"'), "printed_bound[1].method", "coupled"),
    ],
)
def test_a_value_of_nothing_that_is_computed_is_refused_with_what_there_is(more, place, known):
    """It would stand beside nothing, and nobody would see that."""
    assert told(more)[place].remedy == f"there are: {known}"


def test_a_bound_is_one_of_three():
    """A word that is near is offered."""
    problem = told(BOUND.replace("absolute maximum", "absolut maximum"))["printed_bound[1].bound"]
    assert problem.remedy == "did you mean 'absolute maximum'?"


def test_printed_values_of_a_road_with_a_mistake_are_no_second_mistake():
    """The road's label is not known until it is mended."""
    found = told('[[road]]\nclass = "Z"\n' + PRINTED.replace('"B"', '"Z"'))
    assert list(found) == ["road[2].class"]


def test_printed_values_of_a_road_whose_file_is_missing_are_no_second_mistake():
    """What the file is called is the road's label, be it there or not."""
    found = told('[[road]]\nfile = "gone.csv"\n' + PRINTED.replace('"B"', '"gone"'))
    assert list(found) == ["road[2].file"]


def test_a_road_is_meant_by_its_label_with_level_and_waviness():
    """As the report heads its columns."""
    road = '[[road]]\nclass = "C"\nlevel = "upper"\nwaviness = 2.5\n'
    study = study_from_text(GOOD + road + PRINTED.replace('"B"', '"C upper w=2.5"'))
    assert study.printed[0].road in study.roads


def test_a_publication_gives_numbers_sources_and_speeds():
    """36 km/h are 10 m/s; texts stay as they are, umlauts and commas too."""
    study = study_from_text(
        GOOD + '[publication]\nforce_speeds = ["36 km/h", "1 m/s"]\n'
        'sources = ["Müller, A. (2001), <Structures>"]\nnumbers = { floor = "Fig. 3, left" }\n'
    )
    assert study.force_speeds == (10.0, 1.0)
    assert study.publications == ("Müller, A. (2001), <Structures>",)
    assert study.numbering == {"floor": "Fig. 3, left"}


def test_without_a_publication_there_is_nothing_of_it():
    """No number is made up for a figure."""
    study = study_from_text(GOOD)
    assert (study.numbering, study.force_speeds, study.publications) == ({}, (), ())
    assert (study.printed, study.printed_bounds, study.notes) == ((), (), ())


def test_notes_keep_their_lines_and_their_order():
    """A text of several lines is one note; the title is one line."""
    text = '[[note]]\ntitle = "b"\ntext = """one\ntwo <x> & \'y\'"""\n[[note]]\ntitle = "a"\ntext = "z"\n'
    first, second = study_from_text(GOOD + text).notes
    assert (first.title, first.text, second.title) == ("b", "one\ntwo <x> & 'y'", "a")
    assert list(told('[[note]]\ntitle = "a\\nb"\ntext = ""\n')) == ["note[1].title", "note[1].text"]
