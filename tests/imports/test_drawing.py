"""Plans from DXF drawings: lines, outlines, blocks, units, and files that are no drawings."""

import ezdxf
import numpy as np
import pytest

import trundle as tr
from studies import BUILDING
from trundle.errors import InputError, StudyError
from trundle.imports.drawing import read_drawing
from trundle.structure.mesh.polygons import box_round


def drawing(path, *, units=4, draw=lambda m, doc: None, version="R2010"):
    doc = ezdxf.new(version)
    doc.header["$INSUNITS"] = units
    draw(doc.modelspace(), doc)
    doc.saveas(path)
    return path


def outline(m, points, layer, **more):
    m.add_lwpolyline(points, close=True, dxfattribs={"layer": layer}, **more)


def read(path, unit=None, origin=(0.0, 0.0)):
    return read_drawing(path, unit=unit, origin=origin)


@pytest.mark.parametrize(("units", "size"), [(4, 1e-3), (5, 1e-2), (6, 1.0), (1, 0.0254), (2, 0.3048)])  # fmt: skip
def test_a_drawing_says_its_unit(tmp_path, units, size):
    path = drawing(
        tmp_path / "a.dxf", units=units,
        draw=lambda m, _: outline(m, [(0, 0), (800, 0), (800, 600), (0, 600)], "S"),
    )  # fmt: skip
    (shape,) = read(path).layers["S"]
    assert shape.closed
    assert shape.points.max(axis=0) == pytest.approx([800 * size, 600 * size])


def test_a_drawing_without_a_unit_is_asked_for_one(tmp_path):
    path = drawing(
        tmp_path / "a.dxf", units=0, draw=lambda m, _: outline(m, [(0, 0), (8, 0), (8, 6)], "S")
    )
    with pytest.raises(InputError, match='state it, such as unit = "mm"'):
        read(path)
    assert read(path, unit=1.0, origin=(2.0, 1.0)).layers["S"][0].points[0].tolist() == [-2.0, -1.0]


def test_lines_and_arcs_enclose_an_outline_together(tmp_path):
    """A square of 4 m whose fourth side is half a circle: 16 + pi 2^2 / 2 m2, within 0.2 %."""

    def draw(m, _):
        for a, b in (((0, 4), (0, 0)), ((0, 0), (4, 0)), ((4, 0), (4, 4))):
            m.add_line(a, b, dxfattribs={"layer": "S"})
        m.add_arc((2, 4), 2, 0, 180, dxfattribs={"layer": "S"})

    (ring,) = read(drawing(tmp_path / "a.dxf", units=6, draw=draw)).outlines("S")
    x, y = ring.T
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert area == pytest.approx(16.0 + 2.0 * np.pi, rel=2e-3)


def test_a_bulge_is_an_arc(tmp_path):
    """A polyline of two points with bulges of 1 is a circle."""
    path = drawing(
        tmp_path / "a.dxf", units=6,
        draw=lambda m, _: outline(m, [(0, 0, 1), (2, 0, 1)], "C", format="xyb"),
    )  # fmt: skip
    (shape,) = read(path).layers["C"]
    assert shape.closed
    assert np.hypot(*(shape.points - (1.0, 0.0)).T) == pytest.approx(1.0, rel=1e-3)


def test_columns_in_blocks_are_found_where_they_are_inserted(tmp_path):
    """What a block has on layer 0 lies on the layer of its insertion, turned and scaled."""

    def draw(m, doc):
        block = doc.blocks.new("COL")
        block.add_lwpolyline([(-3, -2), (3, -2), (3, 2), (-3, 2)], close=True)
        for x, turn in ((10, 0), (20, 30)):
            m.add_blockref("COL", (x, 5), dxfattribs={"layer": "K", "rotation": turn})

    shapes = read(drawing(tmp_path / "a.dxf", units=5, draw=draw)).layers["K"]
    assert [s.centre.round(9).tolist() for s in shapes] == [[0.10, 0.05], [0.20, 0.05]]
    assert box_round(shapes[1].points) == pytest.approx((0.06, 0.04, 30.0))


def test_what_is_not_understood_is_counted(tmp_path):
    def draw(m, _):
        m.add_text("office", dxfattribs={"layer": "T"})
        m.add_text("store", dxfattribs={"layer": "T"})
        m.add_point((1, 2), dxfattribs={"layer": "P"})

    found = read(drawing(tmp_path / "a.dxf", units=6, draw=draw))
    assert found.left_out == {("T", "TEXT"): 2}
    assert found.layers["P"][0].centre.tolist() == [1.0, 2.0]


BROKEN = {
    "no such file": None,
    "binary": bytes(range(256)) * 20,
    "text": b"a study is no drawing\n" * 50,
    "empty": b"",
    "cut short": "cut",
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_drawing_is_refused_by_name(tmp_path, name):
    path, content = tmp_path / "plan.dxf", BROKEN[name]
    if content == "cut":
        whole = drawing(
            tmp_path / "b.dxf", draw=lambda m, _: outline(m, [(0, 0), (8, 0), (8, 6)], "S")
        )
        content = whole.read_bytes()[:900]
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=r"plan\.dxf"):
        found = read(path)
        assert not found.layers  # a header alone is a drawing of nothing
        raise InputError("plan.dxf shows nothing")


# --- in a study

PLAN = """
[[building.drawing]]
file = "plan.dxf"
on = "lab"

[[building.drawing.slab]]
layer = "SLAB"
plate = "deck"

[[building.drawing.opening]]
layer = "HOLE"

[[building.drawing.column]]
layer = "COLUMN"
section = "post"
from = "ground"
to = "lab"
base = "fixed"

[[building.drawing.beam]]
layer = "BEAM"
section = "steel"

[[building.drawing.wall]]
layer = "WALL"
plate = "wall"
from = "deck"
to = "lab"

[vehicle.car]"""
LAB = """[[building.slab]]
on = "lab"
plate = "deck"
outline = ["A/1", "C/1", "C/2", "A/2"]

"""
POSTS = BUILDING[BUILDING.index("[[building.column]]") : BUILDING.index("[[building.wall]]")]


def plan(m, _):
    outline(m, [(0, 0), (16e3, 0), (16e3, 6e3), (0, 6e3)], "SLAB")
    outline(m, [(5e3, 2e3), (7e3, 2e3), (7e3, 4e3), (5e3, 4e3)], "HOLE")
    for x in (8e3, 15.5e3):
        for y in (500, 5500):
            outline(m, [(x - 200, y - 300), (x + 200, y - 300), (x + 200, y + 300), (x - 200, y + 300)], "COLUMN")  # fmt: skip
    m.add_line((8e3, 500), (8e3, 5500), dxfattribs={"layer": "BEAM"})
    m.add_line((0, 0), (0, 6e3), dxfattribs={"layer": "WALL"})
    m.add_lwpolyline([(0, 1e3), (16e3, 1e3)], dxfattribs={"layer": "WAY"})
    m.add_circle((12e3, 3e3), 200, dxfattribs={"layer": "TOOL"})
    m.add_line((0, 0), (1, 1), dxfattribs={"layer": "JUNK"})


def study(folder, *changes):
    drawing(folder / "plan.dxf", draw=plan)
    text = BUILDING.replace(LAB, "").replace(POSTS, POSTS.replace('to = "lab"', 'to = "deck"'))
    text = text.replace('from = "ground"\nto = "lab"\nbase = "pinned"', 'from = "ground"\nto = "deck"\nbase = "pinned"')  # fmt: skip
    text = text.replace("[vehicle.car]", PLAN.strip(), 1)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return tr.study_from_text(text, folder=folder)


DRAWN = ('path = [["0 m", "5 m"], ["16 m", "5 m"]]', 'drawn = "WAY"'), ('at = ["4 m", "3 m"]', 'drawn = "TOOL"')  # fmt: skip


def test_a_storey_is_taken_from_its_drawing(tmp_path):
    found = study(tmp_path, *DRAWN, ('on = "deck"\ndrawn', "drawn"), ('on = "lab"\ndrawn', "drawn"))
    lab = [slab for slab in found.building.slabs if slab.on == "lab"]
    assert [slab.area for slab in lab] == pytest.approx([96.0 - 4.0])
    columns = [c for c in found.building.columns if c.top == "lab"]
    assert sorted(c.at.tolist() for c in columns) == [
        [8.0, 0.5],
        [8.0, 5.5],
        [15.5, 0.5],
        [15.5, 5.5],
    ]
    assert {round(c.angle) for c in columns} == {90}  # the longer side runs along y
    assert found.drives["aisle"].route.points.tolist() == [[0.0, 1.0], [16.0, 1.0]]
    assert found.drives["aisle"].route.on == "lab"
    assert (found.points["tool"].x, found.points["tool"].y) == (12.0, 3.0)
    (told,) = found.told
    assert "layer 'JUNK' (1 shapes)" in told.message
    assert "WAY" not in told.message
    assert list(found.files) == ["plan.dxf"]


WRONG = {
    "no such file": (('file = "plan.dxf"', 'file = "plans.dxf"'), "building.drawing[1].file", "cannot be read"),
    "no such layer": (('layer = "SLAB"', 'layer = "SLABS"'), "building.drawing[1].slab[1].layer", "nothing of the kind"),
    "no such plate": (('layer = "SLAB"\nplate = "deck"', 'layer = "SLAB"\nplate = "dock"'), "building.drawing[1].slab[1].plate", "plates"),
    "columns in the air": (('to = "lab"\nbase = "fixed"\n\n[[building.drawing.beam]]', 'to = "lab"\n\n[[building.drawing.beam]]'), "building.drawing[1].column[1].base", "nothing under it"),
    "a route on no line": (('path = [["0 m", "5 m"], ["16 m", "5 m"]]', 'drawn = "SLABS"'), "route[1].drawn", "one line"),
    "a route drawn and given": (('path = [["0 m", "5 m"]', 'drawn = "WAY"\npath = [["0 m", "5 m"]'), "route[1]", "a route has a path, or is drawn"),
    "an unknown unit": (('file = "plan.dxf"', 'file = "plan.dxf"\nunit = "mil"'), "building.drawing[1].unit", "one of m, dm, cm"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_a_mistake_about_a_drawing_is_told_where_it_stands(tmp_path, name):
    change, place, words = WRONG[name]
    with pytest.raises(StudyError) as caught:
        study(tmp_path, change)
    found = [p for p in caught.value.problems if p.place == place]
    assert found, [str(p) for p in caught.value.problems]
    assert words in f"{found[0].value} {found[0].rule}"
    assert found[0].line


def test_a_layer_needs_a_building(tmp_path):
    from studies import GOOD

    text = GOOD.replace('at = ["3 m", "2 m"]', 'drawn = "TOOL"')
    if text == GOOD:
        import re

        text = re.sub(r"(?m)^at = \[.*\]$", 'drawn = "TOOL"', GOOD)
    with pytest.raises(StudyError, match="this study has no building"):
        tr.study_from_text(text)
