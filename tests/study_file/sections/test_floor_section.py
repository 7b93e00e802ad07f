"""[floor]: a storey of bays in SI, its mesh, and what holds it."""

import numpy as np
import pytest

from models import small_floor
from studies import GOOD
from trundle.errors import StudyError
from trundle.study_file import study_from_text

COLUMN = 'column = { width = "0.4 m", depth = "0.4 m" }\nstorey_below = "4 m"'
MASS = 'superimposed_mass = "300 kg/m2"'


def loaded(*changes, text=GOOD):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return study_from_text(text)


def told(*changes, text=GOOD):
    with pytest.raises(StudyError) as caught:
        loaded(*changes, text=text)
    return {p.place: p for p in caught.value.problems}


def test_a_storey_in_other_units_is_the_same_storey():
    """Every number of the section once more, in mm, cm, dm, km, t, N/mm2 or g/cm3."""
    other = [
        ('mesh_size = "1.5 m"', 'mesh_size = "1500 mm"'),
        ('x_lines = ["0 m", "6 m", "12 m"]', 'x_lines = ["0 mm", "600 cm", "0.012 km"]'),
        ('y_lines = ["0 m", "6 m"]', 'y_lines = ["0 cm", "6000 mm"]'),
        ('slab_thickness = "0.2 m"', 'slab_thickness = "2 dm"'),
        (MASS, 'superimposed_mass = "0.3 t/m2"'),
        ('elastic_modulus = "30 GPa"', 'elastic_modulus = "30000 N/mm2"'),
        ('density = "2450 kg/m3"', 'density = "2.45 g/cm3"'),
        ('beams_x = { width = "0.3 m"', 'beams_x = { width = "300 mm"'),
        ('storey_below = "4 m"', 'storey_below = "400 cm"'),
    ]
    plain, changed = loaded().plan, loaded(*other).plan
    np.testing.assert_allclose(changed.x_lines, [0.0, 6.0, 12.0])
    assert changed.slab.thickness == pytest.approx(0.2, rel=1e-14)
    assert changed.slab.superimposed_mass == pytest.approx(300.0)
    assert changed.material.elastic_modulus == pytest.approx(30e9)
    assert changed.material.density == pytest.approx(2450.0)
    assert changed.beams_x.width == pytest.approx(plain.beams_x.width)
    assert changed.storey_below == pytest.approx(4.0)


def test_the_floor_of_a_file_is_the_floor_of_the_same_plan_built_directly():
    """Frequencies of the modes of two ways to one floor; concrete of 30 GPa, 2450 kg/m3 and 0.2."""
    from trundle.structure import Material, Rectangle, ShellSection

    concrete = Material(elastic_modulus=30e9, poisson_ratio=0.2, density=2450.0)
    direct = small_floor(
        material=concrete,
        slab=ShellSection(thickness=0.2, material=concrete, superimposed_mass=300.0),
        beams_x=Rectangle(width=0.3, depth=0.6),
        beams_y=None,
        storey_above=0.0,
    )
    ours, theirs = (f.modes(40.0).frequencies for f in (loaded().floor, direct))
    np.testing.assert_allclose(ours, theirs, rtol=1e-9)


def test_width_and_depth_of_a_beam_are_not_taken_for_one_another():
    """A beam laid flat bends (0.3/0.6)^2 of one on edge about its own middle."""
    plan = loaded().plan
    assert (plan.beams_x.width, plan.beams_x.depth) == (0.3, 0.6)
    flat = loaded(('beams_x = { width = "0.3 m", depth = "0.6 m" }',
                   'beams_x = { width = "0.6 m", depth = "0.3 m" }')).floor  # fmt: skip
    assert flat.modes(40.0).frequencies[0] < loaded().floor.modes(40.0).frequencies[0]


def test_what_is_not_given_is_not_there():
    """No other beams, no mass laid on, no storey above, free edges: as the section leaves them."""
    plan = loaded((MASS, "")).plan
    assert plan.slab.superimposed_mass == 0.0
    assert (plan.beams_y, plan.secondary_y, plan.storey_above) == (None, None, 0.0)
    assert set(plan.edges.values()) == {"free"}
    assert plan.material.poisson_ratio == 0.2
    assert plan.eccentric_beams
    assert plan.column_heads == "point"


def test_a_floor_ends_at_its_column_lines_unless_it_goes_on():
    """Half a metre beyond along x alone; a point out there is on it."""
    assert loaded().extent == ((0.0, 12.0), (0.0, 6.0))
    wider = loaded(
        ("y_lines", 'x_extent = ["-50 cm", "12.5 m"]\ny_lines'),
        ('at = ["3 m", "3 m"]', 'at = ["-0.5 m", "3 m"]'),
    )
    assert wider.extent == ((-0.5, 12.5), (0.0, 6.0))


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        (("y_lines", 'x_extent = ["12 m", "0 m"]\ny_lines'), "x_extent must rise"),
        (('["0 m", "6 m", "12 m"]', '["0 m", "6 m", "6 m"]'), "rise without repeats"),
    ],
)
def test_lines_and_extents_rise(change, rule):
    """Turned round or repeated, bays would have no or a negative width."""
    assert rule in told(change)["floor"].rule


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ('["0 m", "6 m", "12 m"]', '["0 m"]', "floor.x_lines"),
        ('density = "2450', 'poisson_ratio = 0.5, density = "2450', "floor.material.poisson_ratio"),
        ('density = "2450', 'poisson_ratio = nan, density = "2450', "floor.material.poisson_ratio"),
        ('"30 GPa"', '"30 kPa"', "floor.material.elastic_modulus"),
        ('"0.2 m"', '"0 m"', "floor.slab_thickness"),
        (', depth = "0.6 m"', "", "floor.beams_x.depth"),
        ("[floor]", "[floor]\nsecondary_per_bay = 0", "floor.secondary_per_bay"),
        ("[floor]", "[floor]\nsecondary_per_bay = 1.0", "floor.secondary_per_bay"),
        ("[floor]", '[floor]\nedges = { x_min = "fixed" }', "floor.edges.x_min"),
        ("[floor]", '[floor]\nedges = { x = "free" }', "floor.edges.x"),
        ("[floor]", '[floor]\ncolumn_heads = "stiff"', "floor.column_heads"),
        ("[floor]", '[floor]\ncolour = "red"', "floor.colour"),
        ('kind = "plan"', "", "floor.kind"),
    ],
)
def test_a_mistake_of_a_storey_has_its_place_and_line(old, new, place):
    """A line of [floor] or of a table within it."""
    found = told((old, new))
    assert list(found) == [place]
    rows = GOOD.replace(old, new).splitlines()
    assert rows.index("[floor]") < found[place].line <= rows.index("[vehicle.truck]")


@pytest.mark.parametrize(
    ("size", "fine"), [("1.5 m", True), ("1.51 m", False), ("3.3 cm", True), ("2 cm", False)]
)
def test_elements_are_at_most_a_quarter_of_the_shorter_side_and_not_too_many(size, fine):
    """A quarter of 6 m is 1.5 m; 100 000 nodes of 72 m2 are 2.7 cm apart."""
    change = ('"1.5 m"', f'"{size}"')
    section = GOOD.replace(*change)
    if fine:  # without meshing it
        from trundle.study_file.draft import Draft
        from trundle.study_file.read import read_text
        from trundle.study_file.sections import floor

        file, _ = read_text(section, "s")
        draft, found = floor.build(Draft(file=file, folder=".", files={}))
        assert not found
        assert draft.mesh_size == pytest.approx(
            float(size.split()[0]) / (100 if "c" in size else 1)
        )
    else:
        assert list(told(change)) == ["floor.mesh_size"]


def test_the_size_that_a_refusal_offers_is_accepted():
    """1 mm is too fine; the number of metres in the remedy is not."""
    remedy = told(('"1.5 m"', '"1 mm"'))["floor.mesh_size"].remedy
    size = float(remedy.removeprefix("use ").partition(" ")[0])
    assert (12.0 / size + 1.0) * (6.0 / size + 1.0) <= 1.02 * 100_000
    assert (12.0 / size) * (6.0 / size) > 0.4 * 100_000


@pytest.mark.parametrize(
    ("edges", "stands"),
    [
        ('{ x_min = "clamped" }', True),
        ('{ x_min = "simple", x_max = "simple" }', True),
        ('{ x_min = "simple", y_min = "pinned" }', True),
        ('{ x_min = "simple", x_max = "symmetry" }', True),
        ('{ y_max = "pinned", y_min = "symmetry" }', True),
        ('{ x_min = "simple" }', False),
        ('{ x_min = "simple", y_max = "symmetry" }', False),
        ('{ x_min = "symmetry", y_min = "symmetry" }', False),
        ("{}", False),
    ],
)
def test_edges_alone_hold_a_floor_up_or_do_not(edges, stands):
    """By statics: one hinge tips unless a plane of symmetry across from it holds the rotation.

    Where it stands its lowest mode has a frequency; where it does not it is refused.
    """
    change = (COLUMN, f"edges = {edges}")
    if stands:
        assert loaded(change).floor.modes(60.0).frequencies[0] > 0.1
    else:
        assert "nothing holds this floor" in told(change)["floor.edges"].rule


@pytest.mark.parametrize(
    ("new", "place", "value"),
    [
        ('storey_below = "4 m"', "floor.storey_below", "a storey without columns"),
        ('column = { width = "0.4 m", depth = "0.4 m" }', "floor.column", "columns without a storey"),
        ('column = { width = "0.4 m", depth = "0.4 m" }\nstorey_below = "0 m"', "floor.column", "columns without a storey"),
    ],
)  # fmt: skip
def test_columns_and_storeys_are_given_together(new, place, value):
    """A column of no height would be rigid, and a height without columns nothing."""
    assert told((COLUMN, new))[place].value == value


def test_columns_above_hold_as_well_as_those_below():
    """Beams in the slab's plane make a floor its own mirror image: the same modes either way."""
    level = ("storey_below", "eccentric_beams = false\nstorey_below")
    below = loaded(level).floor.modes(40.0)
    above = loaded(("storey_below", "eccentric_beams = false\nstorey_above")).floor.modes(40.0)
    np.testing.assert_allclose(above.frequencies, below.frequencies, rtol=1e-6)


def test_a_floor_and_a_building_are_one_too_many():
    """Neither is taken; nothing else is told of the floor."""
    found = told(("[vehicle.truck]", "[building]\nkind = 'model'\nfile = 'x.npz'\n[vehicle.truck]"))
    assert found["floor"].value == "[floor] and [building]"


def test_the_reference_unit_is_the_one_of_the_paper():
    """A stand-in with bays of its own; its mesh is 1 m unless given."""
    from trundle.structure import reference_plan

    start, end = GOOD.index("[floor]"), GOOD.index("[vehicle.truck]")
    head = GOOD[:start] + '[floor]\nkind = "reference_unit"\nmesh_size = "250 cm"\n' + GOOD[end:]
    (x0, x1), (y0, y1) = reference_plan().x_extent, reference_plan().y_extent
    middle = 0.5 * (y0 + y1)
    head = head.replace(
        '[["0 m", "3 m"], ["12 m", "3 m"]]', f'[["{x0} m", "{middle} m"], ["{x1} m", "{middle} m"]]'
    )
    study = study_from_text(head)
    assert study.extent == ((x0, x1), (y0, y1))
    assert study.mesh_size == 2.5


def test_a_model_that_is_not_there_is_told_by_its_file():
    """With its name and where the formats are described."""
    start, end = GOOD.index("[floor]"), GOOD.index("[vehicle.truck]")
    text = GOOD[:start] + '[floor]\nkind = "model"\nfile = "gone.npz"\n' + GOOD[end:]
    problem = told(text=text)["floor.file"]
    assert "gone.npz" in problem.rule
    assert problem.remedy == "docs/models.md says what is read"
