"""[building] in a study file: what it makes, and what is said of mistakes in it."""

import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.errors import StudyError


def loaded(*changes):
    text = BUILDING
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return tr.study_from_text(text)


def refused(*changes):
    with pytest.raises(StudyError) as caught:
        loaded(*changes)
    return caught.value.problems


def test_a_building_has_storeys_to_drive_and_stand_on():
    study = loaded()
    assert set(study.floor.surfaces) == {"deck", "lab"}
    assert study.drives["aisle"].route.on == "deck"
    assert study.points["tool"].on == "lab"
    assert study.extent == ((0.0, 16.0), (0.0, 6.0))
    assert len(study.building.columns) == 6


def test_a_share_of_the_imposed_load_moves_with_the_slab():
    """100 kg/m2 and 0.3 of 5 kN/m2 over g."""
    (deck, _) = loaded().building.slabs
    assert deck.section.superimposed_mass == pytest.approx(100.0 + 0.3 * 5000.0 / 9.80665)


def test_a_stiffness_factor_takes_stiffness_and_leaves_mass():
    change = ('thickness = "0.25 m"', 'thickness = "0.25 m"\nstiffness_factor = 0.5')
    whole, cracked = loaded().building.slabs[0], loaded(change).building.slabs[0]
    frame = np.eye(3)[None]
    half, full = (one.section.laws(frame).bending for one in (cracked, whole))
    np.testing.assert_allclose(half, 0.5 * full, rtol=1e-12)
    assert cracked.section.mass_per_area == whole.section.mass_per_area


@pytest.mark.parametrize(
    ("kind", "sizes", "mass"),
    [
        ("ribbed", 'plate = "0.1 m"\nrib_width = "0.15 m"\nrib_depth = "0.3 m"\nspacing = "0.75 m"',
         2500.0 * (0.1 + 0.15 * 0.3 / 0.75)),
        ("waffle", 'plate = "0.1 m"\nrib_width = "0.15 m"\nrib_depth = "0.3 m"\nspacing = "0.9 m"',
         2500.0 * (0.1 + 0.3 * (2 * 0.15 / 0.9 - (0.15 / 0.9) ** 2))),
        ("hollow_core", 'thickness = "0.265 m"\nvoid = "0.17 m"\nspacing = "0.2 m"',
         2500.0 * (0.265 - np.pi * 0.17**2 / 4 / 0.2)),
        ("composite_deck", 'depth = "0.14 m"\ndeck_height = "0.06 m"\nrib_width = "0.15 m"\n'
         'spacing = "0.3 m"', 2500.0 * (0.08 + 0.06 * 0.5) + 12.0),
    ],
)  # fmt: skip
def test_plates_that_are_not_solid_have_their_own_mass(kind, sizes, mass):
    change = ('thickness = "0.25 m"\nmaterial', f'kind = "{kind}"\n{sizes}\nmaterial')
    slab = loaded(change, ('imposed_load = "5 kN/m2"\n', "")).building.slabs[0]
    assert slab.section.mass_per_area == pytest.approx(mass + 100.0, rel=1e-9)


def test_ribs_run_where_they_are_turned_to():
    change = (
        'thickness = "0.25 m"\nmaterial',
        'kind = "ribbed"\nplate = "0.1 m"\nrib_width = "0.15 m"\nrib_depth = "0.3 m"\n'
        'spacing = "0.75 m"\ndirection = "90 deg"\nmaterial',
    )
    assert loaded(change).building.slabs[0].section.axis == pytest.approx([0.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("sizes", "area"),
    [
        ('shape = "circle"\ndiameter = "0.5 m"', np.pi / 16.0),
        ('shape = "tube"\ndiameter = "0.5 m"\nwall = "20 mm"', np.pi / 4 * (0.5**2 - 0.46**2)),
        ('shape = "box"\ndepth = "0.4 m"\nwidth = "0.3 m"\nweb = "10 mm"\nflange = "12 mm"',
         0.4 * 0.3 - 0.376 * 0.28),
        ('shape = "t"\ndepth = "0.6 m"\nwidth = "0.4 m"\nweb = "0.2 m"\nflange = "0.1 m"', 0.14),
        ('shape = "i"\ndepth = "0.6 m"\nwidth = "0.4 m"\nweb = "0.2 m"\nflange = "0.1 m"', 0.16),
        ('shape = "own"\ndepth = "0.4 m"\nwidth = "0.2 m"\narea = "84.5 cm2"\n'
         'inertia_y = "23130 cm4"\ninertia_z = "1318 cm4"\ntorsion_constant = "51 cm4"', 84.5e-4),
    ],
)  # fmt: skip
def test_sections_are_computed_from_their_sizes(sizes, area):
    change = ('shape = "rectangle"\nwidth = "0.4 m"\ndepth = "0.6 m"', sizes)
    assert loaded(change).building.columns[0].profile.section.area == pytest.approx(area, rel=1e-9)


def test_triangles_and_finer_elements_can_be_asked_for():
    size = 'mesh_size = "1.5 m"'
    coarse, triangles, fine = (
        loaded((size, f"{size}\n{more}")).floor
        for more in ("", 'elements = "triangles"', 'size_at_routes = "0.5 m"')
    )
    assert not [g for g in triangles.shells if g.name.startswith("slab")]
    assert fine.n_dofs > 1.5 * coarse.n_dofs


def test_a_point_can_be_a_node_and_a_route_a_row_of_edges():
    size = 'mesh_size = "1.5 m"'
    more = "nodes_at_points = true\nedges_along_routes = true"
    nodes = loaded((size, f"{size}\n{more}")).floor.nodes
    tool = np.linalg.norm(nodes - (4.0, 3.0, 6.5), axis=1).min()
    assert tool < 1e-9
    on_route = (np.abs(nodes[:, 1] - 5.0) < 1e-9) & (np.abs(nodes[:, 2] - 3.0) < 1e-9)
    assert np.count_nonzero(on_route) >= 12


def test_supports_masses_braces_and_refinement_are_read():
    more = """
[[building.support]]
on = "deck"
at = ["C/1", "C/2"]
hold = ["ux", "uy"]

[[building.support]]
on = "lab"
along = ["C/1", "C/2"]
springs = { uz = "5 MN/m/m" }

[[building.mass]]
on = "lab"
at = [["3 m", "3 m"], ["5 m", "3 m"]]
mass = "1.2 t"

[[building.mass]]
on = "lab"
along = ["A/1", "C/1"]
mass_per_metre = "250 kg/m"

[[building.brace]]
section = "steel"
start = "B/1"
end = "C/1"
on = ["ground", "deck"]

[[building.refine]]
on = "lab"
at = [["4 m", "3 m"]]
size = "0.4 m"

[vehicle.car]"""
    plain, study = loaded(), loaded(("\n[vehicle.car]", more))
    added = study.floor.moving_mass() - plain.floor.moving_mass()
    assert len(study.building.supports) == 3
    assert added == pytest.approx(2.0 * 1200.0 + 16.0 * 250.0, rel=0.05)
    brace = [g for g in study.floor.others if g.name.startswith("brace")]
    assert len(brace) == 1
    assert study.floor.n_dofs > plain.floor.n_dofs


def test_a_study_runs_from_one_storey_to_another(tmp_path):
    result = tr.run_study(loaded())
    assert result.to_xarray()["rms_velocity"].min() > 0.0


MISTAKES = {
    "an unknown storey": (
        ('on = "deck"\nplate', 'on = "dock"\nplate'), "building.slab[1].on", "name of a storey",
    ),
    "an unknown plate": (
        ('on = "lab"\nplate = "deck"', 'on = "lab"\nplate = "dek"'),
        "building.slab[2].plate", "one of the building's plates",
    ),
    "an unknown section": (
        ('section = "post"', 'section = "posts"'), "building.column[1].section", "sections",
    ),
    "an unknown material": (
        ('depth = "0.6 m"\nmaterial = "concrete"', 'depth = "0.6 m"\nmaterial = "conc"'),
        "building.sections.post.material", "must be a material",
    ),
    "an unknown rolled section": (
        ("IPE 400", "IPE 405"), "building.sections.steel", "no rolled section",
    ),
    "a size that a shape lacks": (
        ('width = "0.4 m"\n', ""), "building.sections.post.width", "needs width, depth",
    ),
    "a size of another shape": (
        ('width = "0.4 m"\n', 'width = "0.4 m"\nweb = "10 mm"\n'),
        "building.sections.post.web", "has no web",
    ),
    "an unknown key": (
        ('on = "lab"\nplate = "deck"', 'on = "lab"\nplate = "deck"\nthick = "1 m"'),
        "building.slab[2].thick", "unknown key",
    ),
    "an unknown key in a section": (
        ('rolled = "IPE 400"', 'rolled = "IPE 400"\nwdth = "1 m"'),
        "building.sections.steel.wdth", "unknown key",
    ),
    "no unit": (('level = "3 m"', 'level = "3"'), "building.storey[2].level", "unit is missing"),
    "a grid line that is not there": (
        ('along = ["B/1", "B/2"]', 'along = ["X/1", "B/2"]'),
        "building.beam[1].along[1]", "no grid line 'X'",
    ),
    "grid lines that do not cross": (
        ('along = ["B/1", "B/2"]', 'along = ["A/B", "B/2"]'),
        "building.beam[1].along[1]", "do not cross",
    ),
    "a place of one number": (
        ('["10 m", "2 m"], ["12 m"', '["10 m"], ["12 m"'),
        "building.slab[1].openings[1][1]", "two lengths",
    ),
    "a column in the air": (('base = "fixed"\n', ""), "building.column[1].base", "nothing under it"),
    "a point on no slab": (
        ('on = "lab"\nat = ["4 m", "3 m"]', 'on = "deck"\nat = ["11 m", "3 m"]'),
        "point[1].at", "has none there",
    ),
    "a point on no storey": (('on = "lab"\nat', "at"), "point[1].on", "name a storey"),
    "a route over an opening": (
        ('["0 m", "5 m"], ["16 m", "5 m"]', '["0 m", "3 m"], ["16 m", "3 m"]'),
        "route[1].path[1]", "over no slab from (10.1, 3) to (11.9, 3) m",
    ),
    "a route on the ground": (('on = "deck"\npath', 'on = "ground"\npath'), "route[1].on", "storey"),
    "a plane of symmetry of no kind": (
        ("[[building.column]]", '[[building.symmetry]]\naxis = "x"\n\n[[building.column]]'),
        "building.symmetry[1]", "across an axis at a place",
    ),
    "springs that are turned": (
        (
            "[[building.column]]",
            '[[building.support]]\non = "deck"\nat = [["1 m", "1 m"]]\nangle = "30 deg"\n'
            'springs = { ux = "1 MN/m" }\n\n[[building.column]]',
        ),
        "building.support[1].angle", "springs act along x, y and z",
    ),
    "grid lines of one name": (
        ('C = "16 m"', 'C = "16 m"\n1 = "3 m"'), "building.grid", "names of grid lines must differ",
    ),
    "springs along a line by the place": (
        (
            "[[building.column]]",
            '[[building.support]]\non = "deck"\nalong = ["A/1", "C/1"]\n'
            'springs = { uz = "1 MN/m" }\n\n[[building.column]]',
        ),
        "building.support[1].springs", "are by the metre",
    ),
    "a refinement of a storey that is not there": (
        (
            "[[building.column]]",
            '[[building.refine]]\non = "dekc"\nat = ["A/1"]\nsize = "0.2 m"\n\n[[building.column]]',
        ),
        "building.refine[1].on", "name of a storey",
    ),
    "a refinement of nothing": (
        ("[[building.column]]", '[[building.refine]]\nsize = "0.2 m"\n\n[[building.column]]'),
        "building.refine[1]", "along a line, or at places",
    ),
    "a refinement that is coarser": (
        (
            "[[building.column]]",
            '[[building.refine]]\nat = ["A/1"]\nsize = "2 m"\n\n[[building.column]]',
        ),
        "building.refine[1].size", "smaller than mesh_size",
    ),
    "a plane of symmetry of one place": (
        (
            "[[building.column]]",
            '[[building.symmetry]]\nalong = ["A/1", "A/1"]\n\n[[building.column]]',
        ),
        "building.symmetry[1].along", "two places",
    ),
    "columns at a word": (('at = "grid"', 'at = "Grid"'), "building.column[1].at", "'grid'; or a list"),
    "a base that is no kind": (('base = "fixed"', 'base = "fixd"'), "building.column[1].base", "or a table"),
    "too fine along routes": (
        ('mesh_size = "1.5 m"', 'mesh_size = "1.5 m"\nsize_at_routes = "1 cm"'),
        "building.mesh_size", "nodes where it is refined",
    ),
    "a mesh too fine": (('"1.5 m"', '"0.02 m"'), "building.mesh_size", "may have 100000 nodes"),
    "both a floor and a building": (
        ("[building]\n", '[floor]\nkind = "reference_unit"\n\n[building]\n'),
        "floor", "only one of them",
    ),
    "two walls of which one hangs": (
        ('base = "pinned"\n', ""), "building.wall[1].base", "nothing under an end",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_line(name):
    change, place, words = MISTAKES[name]
    problems = refused(change)
    found = [p for p in problems if p.place == place]
    assert found, [str(p) for p in problems]
    assert any(words in f"{p.value} {p.rule}" for p in found)
    assert all(p.line for p in found)
    assert all(p.remedy for p in found)


def test_a_plane_of_symmetry_runs_along_two_places():
    """Along the edge at y = 0 it holds what the plane across y at 0 holds."""
    table = "[[building.symmetry]]\n{}\n\n[[building.column]]"
    by_axis, by_places = (
        loaded(("[[building.column]]", table.format(text))).floor
        for text in ('axis = "y"\nat = "0 m"', 'along = ["A/1", "C/1"]')
    )
    assert np.array_equal(by_axis.fixed, by_places.fixed)
    assert by_places.angles is None
    assert by_axis.fixed.sum() > loaded().floor.fixed.sum()


def test_a_mistake_of_one_column_among_many_names_it():
    problems = refused(('at = "grid"', 'at = [["1 m", "1 m"], ["30 m", "1 m"]]'))
    assert [p.place for p in problems] == ["building.column[1].at[2]"]


def test_what_nothing_holds_is_named():
    problems = refused(('base = "fixed"', "base = { uz = \"50 MN/m\" }"), ('base = "pinned"', "base = { uz = \"50 MN/m/m\" }"))  # fmt: skip
    assert [p.place for p in problems] == ["building"]
    assert "moves along x and moves along y and turns about z" in problems[0].rule


def test_a_study_needs_a_floor_or_a_building():
    text = BUILDING[BUILDING.index("[vehicle.car]") :].replace('on = "deck"\n', "").replace('on = "lab"\n', "")  # fmt: skip
    with pytest.raises(StudyError, match=r"\[floor\] or a \[building\]"):
        tr.study_from_text('title = "t"\nseed = 1\nruns = 2\n' + text)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('at = "grid"', 'at = "A/1"'),
        ('at = "grid"', 'at = ["0 m", "0 m"]'),
        ('base = "fixed"', 'base = { uz = "-1 MN/m" }'),
        ('base = "fixed"', "base = 3"),
        ('C = "16 m"', 'C = "16 m"\n"A/B" = "3 m"'),
    ],
)
def test_alternatives_of_a_key_are_told_once_in_our_words(old, new):
    """No names of the validating library, and one mistake for one slip."""
    problems = refused((old, new))
    for problem in problems:
        assert not any(c in problem.place.split(".")[-1] for c in "(<"), str(problem)
        for word in ("literal", "tuple", "function", "Section", "[key]"):
            assert word not in str(problem)
    places = [problem.place for problem in problems]
    assert len(places) == len(set(places))


def test_elements_are_small_at_supports_columns_and_walls():
    """Within 0.5 m of a column's axis elements are as small as asked for, on each of its storeys."""
    size = 'mesh_size = "1.5 m"'
    plain, fine = (
        loaded((size, f"{size}\n{more}")).floor for more in ("", 'size_at_supports = "0.3 m"')
    )
    for level in (3.0, 6.5):
        near = [
            np.count_nonzero(
                (np.hypot(*(f.nodes[:, :2] - (8.0, 6.0)).T) < 0.8) & (f.nodes[:, 2] == level)
            )
            for f in (plain, fine)
        ]
        assert near[1] > 1.5 * near[0]


def test_elements_are_small_where_grid_lines_cross():
    fine = loaded(("[[building.column]]", '[[building.refine]]\non = "deck"\nat = ["A/1"]\nsize = "0.2 m"\n\n[[building.column]]')).floor  # fmt: skip
    near = np.hypot(*(fine.nodes[:, :2]).T) < 0.6
    assert np.count_nonzero(near & (fine.nodes[:, 2] == 3.0)) >= 6
