"""A study as a value: who acts when, how long records last, which waves, and on which mesh."""

from dataclasses import replace

import numpy as np
import pytest

from models import small_floor
from studies import BUILDING, GOOD
from trundle.errors import InputError
from trundle.simulate.sources.passage import Passage
from trundle.structure import Spot
from trundle.study.model import directions, extent_of
from trundle.study.plans import Case
from trundle.study_file import study_from_text

V = 15.0 / 3.6  # m/s
LONG = 12.0  # m, of the route

SOURCES = """
[[walker]]
name = "corridor"
guide = "p354"
pace = "2 Hz"
path = [["1 m", "1 m"], ["11 m", "1 m"]]

[[traffic]]
name = "convoy"
routes = ["main", "corridor", "main"]
departures = ["0 s", "2 s", "7.5 s"]
"""


@pytest.fixture(scope="module")
def study():
    return study_from_text(GOOD)


@pytest.fixture(scope="module")
def convoy():
    return study_from_text(GOOD.replace('duration = "4 s"\n', "") + SOURCES)


def acting(study, case, road="B"):
    (found,) = (one for one in study.cases if one.name == case)
    return study.acting(found, road, study.methods[0])


def test_all_of_a_case_depart_at_once_unless_told(study):
    """A case without times has a nought for each of its routes, repeated ones included."""
    assert Case(name="a", routes=("x", "y", "x")).departs == (0.0, 0.0, 0.0)
    assert Case(name="a", routes=("x", "y"), departs=(1.0, 2.0)).departs == (1.0, 2.0)
    assert [one.name for one in study.cases] == ["main"]


def test_passages_of_one_route_are_numbered_and_depart_as_told(convoy):
    """Two trucks and a walker between them: numbers 1 and 2, the second leaves 7.5 s later."""
    first, walker, second = acting(convoy, "convoy")
    assert isinstance(first, Passage)
    assert (first.number, second.number) == (1, 2)
    assert not isinstance(walker, Passage)
    assert second.leaves - first.leaves == pytest.approx(7.5)
    (alone,) = acting(convoy, "corridor")
    assert walker.leaves - alone.leaves == pytest.approx(2.0)


def test_a_record_lasts_until_the_last_has_left_and_the_floor_is_at_rest(convoy, study):
    """Five seconds behind the last that leaves, up to a whole second; or what was asked for."""
    for case in ("main", "corridor", "convoy"):
        sources = acting(convoy, case)
        ends = max(source.leaves for source in sources)
        assert convoy.record_length(sources) == np.ceil(ends + 5.0)
    truck = convoy.drives["main"].vehicle.length
    assert acting(convoy, "main")[0].leaves == pytest.approx((LONG + truck) / V, abs=1.5)
    assert convoy.longest_record == max(
        convoy.record_length(acting(convoy, one.name)) for one in convoy.cases
    )
    assert study.record_length(acting(study, "main")) == 4.0
    # what is asked for is kept where it is longer, and never taken where it is too short
    assert study.long_enough(acting(study, "main")) > 10.0
    patient = replace(study, duration=60.0)
    assert patient.long_enough(acting(study, "main")) == 60.0


def test_other_speeds_change_the_speed_and_nothing_else(study):
    """At 3 m/s the truck needs (12 m + its length) / 3 m/s; vehicle, way and run-in stay."""
    slow = study.at_speed(3.0)
    before, after = study.drives["main"], slow.drives["main"]
    assert after.route.law.fastest == 3.0
    assert after.vehicle is before.vehicle
    assert after.run_in == before.run_in
    np.testing.assert_array_equal(after.route.line, before.route.line)
    assert study.drives["main"].route.law.fastest == pytest.approx(V)
    longer = acting(slow, "main")[0].leaves - acting(study, "main")[0].leaves
    driven = before.route.length + before.vehicle.length
    assert longer == pytest.approx(driven * (1.0 / 3.0 - 1.0 / V), rel=0.2)


def test_waves_end_where_the_step_can_follow(study):
    """Two samples a wave: n_max = 1 / (2 V dt). At 5 ms and 200 km/h it is 1.8 cycle/m."""
    method, drive = study.methods[0], study.drives["main"]
    assert study.band_for(drive, method).n_max == study.band.n_max
    fast = study.at_speed(200.0 / 3.6)
    limit = 0.5 / (200.0 / 3.6 * 0.005)
    assert limit < study.band.n_max
    assert fast.band_for(fast.drives["main"], method).n_max == pytest.approx(limit)
    assert fast.band_for(fast.drives["main"], method).n_min == study.band.n_min
    fixed = replace(fast, band_follows_dt=False)
    assert fixed.band_for(fixed.drives["main"], method).n_max == study.band.n_max
    own = replace(method, band=replace(study.band, n_max=1.0))
    assert study.band_for(drive, own).n_max == 1.0


def test_the_crossing_has_the_road_and_entry_of_its_cell(study):
    """Road by its label, entry and waves by the method, run-in by the route."""
    (passage,) = acting(study, "main")
    assert passage.crossing.road is study.roads["B"]
    assert passage.crossing.entry is study.methods[0].entry
    assert passage.crossing.vehicle is study.drives["main"].vehicle
    with pytest.raises(KeyError):
        acting(study, "main", road="C")


def test_half_the_mesh_size_has_four_times_the_elements(study):
    """A plate of 12 m by 6 m: 1.5 m edges give 8 by 4 elements, 0.75 m give 16 by 8."""
    fine = study.meshed(0.5)
    assert fine.mesh_size == 0.75
    assert study.mesh_size == 1.5
    counts = [
        sum(len(e) for s in one.floor.surfaces.values() for _, e in s.parts if e.shape[1] == 4)
        for one in (study, fine)
    ]
    assert counts == [32, 128]
    np.testing.assert_allclose(fine.floor.moving_mass(), study.floor.moving_mass(), rtol=1e-6)


def test_a_building_is_meshed_anew_on_all_its_storeys():
    """Half the size: about twice the elements along each edge of both storeys, the same mass.

    96 m2 and 92 m2 in squares of 0.75 m are 170 and 163 elements at least; lines that the mesh must
    follow add some.
    """
    building = study_from_text(BUILDING)
    fine = building.meshed(0.5)
    assert fine.mesh_size == building.mesh_size / 2 == 0.75
    for name, fewest in (("deck", 163), ("lab", 170)):
        n_fine, n_coarse = (
            sum(len(e) for _, e in one.floor.surfaces[name].parts if e.shape[1] > 2)
            for one in (fine, building)
        )
        assert n_fine >= fewest
        assert n_fine > 1.8 * n_coarse
    np.testing.assert_allclose(fine.floor.moving_mass(), building.floor.moving_mass(), rtol=1e-3)


def test_a_mesh_that_came_as_one_cannot_be_meshed_anew(study):
    """Without plan and building nobody knows what lies between its nodes."""
    with pytest.raises(InputError, match="came as a mesh: it cannot be meshed anew"):
        replace(study, plan=None).meshed(0.5)


def test_the_extent_is_that_of_all_surfaces():
    """The plan's 12 m by 6 m; storeys of 16 m by 6 m together, whatever one lacks."""
    assert extent_of(small_floor()) == ((0.0, 12.0), (0.0, 6.0))
    building = study_from_text(BUILDING)
    assert building.extent == ((0.0, 16.0), (0.0, 6.0))


def test_directions_are_said_only_where_one_is_level():
    """A vertical limit must not be taken for a level point: each has its word, in order."""
    up, along = Spot(1.0, 1.0), Spot(1.0, 1.0, None, "x")
    assert directions({"a": up}) is None
    assert directions({"b x": along, "a": up}) == ("horizontal", "vertical")
    assert directions({}) is None


def test_titles_and_names_are_no_html(study):
    """A title in angle brackets stands in a notebook as it was written."""
    odd = replace(study, title="<b>Größe</b> & co", points={"<i>tool</i>": study.points["tool"]})
    page = odd._repr_html_()
    assert "<b>" not in page
    assert "<i>" not in page
    assert "&lt;b&gt;Größe&lt;/b&gt; &amp; co" in page
    assert "1 cases on 1 roads by 1 methods, 2 runs each, 1 points" in repr(odd)


def test_without_an_assessment_there_are_no_criteria(study):
    """Nothing is asked for, and nothing is held against."""
    assert [one.name for one in study.criteria] == ["VC-A"]
    assert replace(study, assessment=None).criteria == ()
