"""Surveys and features in pictures: heights in mm from where the route begins, and what they are."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made import result_of, study_of
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba

import trundle as tr
from studies import BUILDING
from trundle.report.figures import given_road as figures
from trundle.report.figures import model
from trundle.road import MeasuredRoad, Profile, RoadClass, synthesise

PATCH = ("[[method]]", '[roughness]\ncontact_patch = "0.5 m"\n\n[[method]]')
HUMP = """
[[feature]]
kind = "cosine_hump"
at = "6 m"
length = "2 m"
height = "30 mm"
{more}
"""


def road_of(station, height, *, start=0.0, beyond="level"):
    one = Profile.piecewise_linear(
        np.asarray(station, float), np.asarray(height, float), beyond=beyond
    )
    return MeasuredRoad(tracks=(one,), lateral=np.zeros(1), name="the <yard>", start=start)


def drawn(study):
    return {one.name: one for one in figures.drawings(result_of(study))}


def test_a_survey_is_drawn_from_its_own_datum_in_millimetres():
    """A plane of 1 in 100 at 250 m above the sea: from nought at the route's start to 120 mm."""
    study = study_of()
    road = road_of([500.0, 600.0], [250.0, 251.0], start=520.0)
    figure = figures.given_road_figure(study, road, study.drives["main"])
    (panel,) = figure.axes
    given = panel.lines[0]
    s, z = given.get_data()
    np.testing.assert_allclose(z, 10.0 * (s - 520.0), atol=1e-9)
    assert panel.get_xlim() == (520.0, 532.0)
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("station [m]", "height [mm]")
    assert given.get_label() == "as given"


def test_what_the_tyre_feels_is_the_mean_over_its_patch():
    """A step of 20 mm under a patch of 0.5 m: half of it over the step itself, a ramp of 0.5 m."""
    study = study_of("", PATCH)
    road = road_of([-50.0, 5.999, 6.001, 50.0], [0.0, 0.0, 0.02, 0.02])
    (panel,) = figures.given_road_figure(study, road, study.drives["main"]).axes
    given, felt = panel.lines
    s, z = felt.get_data()
    np.testing.assert_allclose(z, 20.0 * np.clip((s - 5.75) / 0.5, 0.0, 1.0), atol=0.05)
    assert felt.get_label() == "averaged over the tyre's 0.5 m"
    assert given.get_ydata().max() == pytest.approx(20.0)
    assert set(np.round(given.get_xdata(), 6)) >= {5.999, 6.001}  # its own points are drawn


def test_where_nobody_has_surveyed_no_line_is_drawn():
    """Known to station 8 m of the route's 12: heights end there, they are not made up."""
    road = road_of([0.0, 8.0], [0.0, 0.008], beyond="unknown")
    places = np.linspace(0.0, 12.0, 13)
    heights = figures._read(road.tracks[0], places)
    np.testing.assert_array_equal(np.isnan(heights), places > 8.0)
    np.testing.assert_allclose(heights[:9], 0.001 * places[:9])
    level = road_of([0.0, 8.0], [0.0, 0.008]).tracks[0]
    np.testing.assert_allclose(figures._read(level, places)[9:], 0.008)


def test_only_roads_that_are_given_have_a_picture_and_on_their_own_routes():
    """A hump on one of two routes and on one of two roads: one picture of four."""
    text = (
        '\n[[route]]\nname = "back"\nvehicle = "truck"\npath = [["12 m", "5 m"], ["0 m", "5 m"]]\n'
    )
    text += 'speed = "8 km/h"\n\n[[road]]\nclass = "C"\n'
    study = study_of(text + HUMP.format(more='route = "back"\nroads = ["C"]'), PATCH)
    found = drawn(study)
    assert [one.title for one in found.values()] == ["Road C along back"]
    (one,) = found.values()
    assert "1 x " in one.caption
    assert "hump" in one.caption
    assert one.caption.endswith("Its random waves are not drawn: they differ from run to run.")
    panel = one.draw().axes[0]
    s, z = panel.lines[0].get_data()
    hump = 15.0 * (1.0 - np.cos(np.pi * np.clip(s - 6.0, 0.0, 2.0)))  # begins at 6 m, 2 m long
    np.testing.assert_allclose(z, hump, atol=0.05)


def test_a_road_without_anything_given_has_no_picture():
    """Random roads differ from run to run: there is nothing to draw."""
    assert drawn(study_of()) == {}


def test_a_survey_says_its_class_or_that_it_is_too_short():
    """A made road of class C, 400 m long, is told as one; 8 m of it hold no two octaves."""
    rng = np.random.default_rng(3)
    waves = synthesise(RoadClass("C"), length=400.0, rng=rng)
    s = np.arange(0.0, 400.0, 0.1)
    road = road_of(s, waves.at(s)[0])
    told = figures._caption(road)
    assert told.startswith("the <yard>, one track of 399.9 m from 0 m.")
    assert "class C" in told
    short = figures._caption(road_of(s[:81], waves.at(s[:81])[0]))
    assert short.endswith("It is too short to have a class.")


def test_tracks_of_both_sides_have_panels_of_their_own():
    """A truck of two tracks on a road whose left one is 5 mm higher at its crest than the right."""
    study = study_of()
    drive = study.drives["main"]
    n = drive.vehicle.n_contacts
    lateral = np.where(np.arange(n) % 2 == 0, 0.9, -0.9)
    drive = replace(drive, vehicle=replace(drive.vehicle, lateral=lateral))
    sides = [
        Profile.piecewise_linear(
            np.array([0.0, 6.0, 12.0]), np.array([0.0, h, 0.0]), beyond="level"
        )
        for h in (0.010, 0.015)
    ]
    road = MeasuredRoad(tracks=tuple(sides), lateral=np.array([-0.9, 0.9]), name="two", start=0.0)
    figure = figures.given_road_figure(study, road, drive)
    left, right = figure.axes
    names = drive.vehicle.contact_names
    assert [left.get_title(), right.get_title()] == [f"under {names[0]}", f"under {names[1]}"]
    assert left.lines[0].get_ydata().max() == pytest.approx(15.0)
    assert right.lines[0].get_ydata().max() == pytest.approx(10.0)


def test_a_model_of_several_surfaces_has_a_plan_of_each():
    """A building taken as a mesh: 16 by 6 m, and an opening of 2 by 2 m in the deck alone."""
    study = replace(tr.study_from_text(BUILDING), building=None)
    found = {one.name: one for one in model.drawings(result_of(study))}
    assert [one.title for one in found.values()] == ["Plan of deck", "Plan of lab"]
    around = {}
    for one in found.values():
        (axes,) = one.draw().axes
        black = [
            c
            for c in axes.collections
            if isinstance(c, LineCollection) and np.allclose(c.get_color(), to_rgba("black"))
        ]
        ends = black[0].get_segments()
        around[axes.get_title()] = sum(
            float(np.linalg.norm(np.diff(side, axis=0))) for side in ends
        )
        inside = {text.get_text() for text in axes.texts}
        assert ("tool" in inside) == (axes.get_title() == "lab")
        assert ("aisle, 20 km/h" in inside) == (axes.get_title() == "deck")
        columns = [line for line in axes.lines if line.get_marker() == "s"]
        places = np.concatenate([np.column_stack(line.get_data()) for line in columns])
        there = {tuple(np.round(place, 6)) for place in places}
        assert there == {(x, y) for x in (0.0, 8.0, 16.0) for y in (0.0, 6.0)}
    assert around == {"deck": pytest.approx(44.0 + 8.0), "lab": pytest.approx(44.0)}


def test_a_plan_that_was_built_here_is_not_drawn_twice():
    """Floors and buildings have plans of their own; only models that came as a mesh are drawn so."""
    assert list(model.drawings(result_of(study_of()))) == []
    assert list(model.drawings(result_of(tr.study_from_text(BUILDING)))) == []
