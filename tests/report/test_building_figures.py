"""Pictures of buildings: what stands where, storey by storey."""

import numpy as np
import pytest
from matplotlib.patches import PathPatch, Polygon

import trundle as tr
from studies import BUILDING
from trundle.report.figures import building as figures
from trundle.report.figures import floor as floor_figures
from trundle.results.modes import first_modes
from trundle.structure import CONCRETE, ShellSection
from trundle.structure.building import Brace, Building, Profile, Ramp, Storey
from trundle.study.map_plan import MapGrid

MAP = """
[criteria]
method = "coupled"
curves = ["VC-A", "VC-B"]

[map]
spacing = "2 m"
on = ["lab", "deck"]
"""


@pytest.fixture(scope="module")
def study():
    return tr.study_from_text(BUILDING + MAP)


def texts(axes):
    return {text.get_text() for text in axes.texts}


def patches(axes, kind):
    return [patch for patch in axes.patches if type(patch) is kind]


def test_a_plan_has_its_slab_with_the_opening_cut_out(study):
    (axes,) = figures.storey_figure(study, study.building, "deck").axes
    (slab,) = patches(axes, PathPatch)
    inside, opening = [(2.0, 3.0)], [(11.0, 3.0)]
    assert slab.get_path().contains_points(inside).all()
    corners = slab.get_path().to_polygons()
    assert sorted(abs(_area(c)) for c in corners) == pytest.approx([4.0, 96.0])
    assert _area(corners[0]) * _area(corners[1]) < 0.0  # in other senses, so that it is cut out
    assert opening


def _area(ring):
    x, y = np.asarray(ring)[:-1].T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def test_a_post_that_stands_on_a_ramp_ends_at_its_slope():
    """Of a ramp from 0 to 4 m over 8 m, 2 m up halfway and 3 m three quarters up."""
    plate = ShellSection(thickness=0.2, material=CONCRETE)
    ramp = Ramp(
        name="ramp",
        section=plate,
        outline=np.array([[0.0, 0.0], [0.0, 3.0], [8.0, 3.0], [8.0, 0.0]]),
        bottom="ground",
        top="deck",
    )
    post = Profile.rectangle(0.3, 0.3, CONCRETE)
    ends = np.array([[4.0, 1.0], [6.0, 1.0]])
    building = Building(
        storeys=(Storey(name="ground", level=0.0), Storey(name="deck", level=4.0)),
        ramps=(ramp,),
        braces=(Brace(profile=post, ends=ends, on=("ramp", "ramp")),),
    )
    along_y, _ = figures.elevation_figure(building).axes
    lines = [line.get_ydata() for line in along_y.lines if len(line.get_xdata()) == 2]
    assert any(np.allclose(z, [2.0, 3.0]) for z in lines)


def test_columns_walls_and_beams_are_drawn_to_scale(study):
    (axes,) = figures.storey_figure(study, study.building, "deck").axes
    areas = sorted(round(abs(_area(np.vstack([p.get_xy()]))), 4) for p in patches(axes, Polygon))
    assert areas.count(0.24) == 6  # columns of 0.4 by 0.6 m
    assert 1.2 in areas  # the wall, 6 by 0.2 m
    assert 1.08 in areas  # the beam, 6 m of an IPE 400, 180 mm wide


def test_routes_and_points_stand_on_their_own_storey(study):
    (deck,) = figures.storey_figure(study, study.building, "deck").axes
    (lab,) = figures.storey_figure(study, study.building, "lab").axes
    assert any("aisle" in t for t in texts(deck))
    assert "tool" not in texts(deck)
    assert "tool" in texts(lab)
    assert not any("aisle" in t for t in texts(lab))
    assert {"A", "B", "C", "1", "2", "8", "6"} <= texts(lab)
    assert lab.get_title() == "lab, level +6.5 m"


def test_an_elevation_names_every_level(study):
    panels = figures.elevation_figure(study.building).axes
    for panel in panels:
        assert {t.strip() for t in texts(panel)} == {"ground +0 m", "deck +3 m", "lab +6.5 m"}


def test_modes_are_shown_storey_by_storey(study):
    modes = first_modes(study.floor.modes(20.0), study.floor)
    panels = figures.storey_modes_figure(study, modes).axes
    assert len(panels) == 2 * 4
    assert panels[0].get_title().startswith("1: ")
    assert [panels[i].get_ylabel() for i in (0, 4)] == ["deck", "lab"]


def test_the_mesh_says_how_well_it_is_shaped(study):
    words = floor_figures._quality_words(study)
    assert "quadrilaterals and" in words
    assert "degrees" in words


def test_a_map_has_places_where_there_is_a_slab_alone(study):
    """16 by 6 m at 2 m: 24 places on the lab; the opening takes 1 of the deck's."""
    lab, deck = study.map.grids
    assert (lab.on, deck.on) == ("lab", "deck")
    assert len(lab.spots) == 24
    assert len(deck.spots) == 24 - 1
    assert not deck.there[1, 5]
    assert study.map.n_places == 47
    assert study.map.where(24 + 16) == (deck.xy[16, 0], deck.xy[16, 1], "deck")


def test_values_of_a_map_are_laid_on_its_grid(study):
    deck = study.map.grids[1]
    filled = deck.filled(np.arange(23.0))
    assert np.isnan(filled[1, 5])
    assert filled[0, 0] == 0.0
    assert filled[2, 7] == 22.0


def test_a_grid_over_no_surface_is_whole():
    grid = MapGrid.over(np.arange(3.0), np.arange(2.0), None, None)
    assert grid.there.all()
    assert grid.xy[1].tolist() == [1.0, 0.0]


@pytest.mark.longest
def test_maps_of_two_storeys_are_those_of_each(study, tmp_path):
    """Levels at a map's place are those of a point there; off the slab there is none."""
    result = tr.run_study(study)
    tree = result.to_xarray()
    deck = tree["/maps/aisle/deck"]
    assert np.isnan(deck["rms_velocity"].values[0, 1, 5])
    assert np.isfinite(deck["rms_velocity"].values[0, 0]).all()
    at = 'name = "tool"\non = "lab"\nat = ["4 m", "3 m"]'
    there = at.replace('"lab"', '"deck"').replace('["4 m", "3 m"]', '["5 m", "3 m"]')
    point = tr.run_study(tr.study_from_text((BUILDING + MAP).replace(at, there)))
    levels = point.to_xarray()["rms_velocity"].values.squeeze()
    expected = np.percentile(levels, 95.0)
    place = deck["rms_velocity"].sel(x=5.0, y=3.0).values.item()
    assert place == pytest.approx(expected, rel=0.01)
    tr.save(result, tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "aisle, class B, deck" in page
    assert "47 places" in page
