"""What the report shows of surveys, joints and wheels that cut corners."""

import functools
from pathlib import Path

import numpy as np

import trundle as tr
from trundle.report.figures.building import storey_figure
from trundle.report.figures.given_road import given_road_figure
from trundle.vehicle import GRAVITY

EXAMPLES = Path(__file__).parents[2] / "examples"


@functools.cache
def study(name):
    text = (EXAMPLES / name / "study.toml").read_text("utf-8")
    for size in ("0.75 m", "1 m", "1.2 m"):
        text = text.replace(f'mesh_size = "{size}"', 'mesh_size = "2 m"')
    return tr.study_from_text(text, folder=EXAMPLES / name)


def test_joints_are_drawn_as_given_and_as_the_tyre_meets_them():
    """A panel a track; the gap as deep as the tyre sinks, and a hundredth of the patch's mean."""
    made = study("forklift_joints")
    figure = given_road_figure(made, made.roads["dowelled"], made.drives["aisle"])
    assert len(figure.axes) == 2
    given, felt = (line.get_ydata() for line in figure.axes[0].lines)
    vehicle = made.drives["aisle"].vehicle
    sinking = 1e3 * vehicle.static_forces[0] / vehicle.contact_stiffness[0]
    np.testing.assert_allclose(sinking, 1e3 * GRAVITY / (2 * np.pi * 6.0) ** 2, rtol=1e-4)
    np.testing.assert_allclose(given.min(), -sinking, rtol=1e-6)
    np.testing.assert_allclose(felt.min(), -sinking * 0.010 / 0.1, rtol=1e-6)


def test_a_survey_is_drawn_in_its_own_chainage():
    """From 530 m, where the route begins, for the route's 24 m."""
    made = study("measured_profile")
    figure = given_road_figure(made, made.roads["surveyed"], made.drives["drive"])
    assert figure.axes[0].get_xlim() == (530.0, 554.0)


def test_a_plan_shows_where_wheels_go():
    """Twelve wheels of a semitrailer beside the route; the last axle's cut the corner."""
    made = study("curve_into_dock")
    figure = storey_figure(made, made.building, "deck")
    thin = [line for line in figure.axes[0].lines if line.get_linewidth() == 0.5]
    assert len(thin) == 12
    route = made.drives["into the dock"].route
    corner = np.array([21.0, 21.0])  # the centre of its arc
    nearest = [
        np.linalg.norm(np.column_stack(line.get_data()) - corner, axis=1).min() for line in thin
    ]
    assert min(nearest) < route.radius - 2.0
    assert max(nearest) > route.radius - 0.1
