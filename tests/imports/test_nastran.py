"""Nastran bulk data: the same model in every form, closed forms, and cards that are told."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from models import small_floor
from studies import GOOD
from trundle import save
from trundle.dynamics import natural_modes
from trundle.errors import InputError, StudyError
from trundle.imports import Asked, read_model
from trundle.imports.nastran_cards import cards_of, real
from trundle.run.whole_study import run_study
from trundle.study_file import load_study


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2.9+7", 2.9e7), ("1.D-3", 1e-3), ("-.5", -0.5), ("7", 7.0), ("3.E10", 3e10),
        ("1.25E+2", 125.0), ("6.-4", 6e-4),
    ],
)  # fmt: skip
def test_reals_as_nastran_writes_them(text, value):
    assert real(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("text", ["", "1.2.3", "E7", "1.E", "nan", "0x1"])
def test_what_is_no_real_is_refused(text):
    with pytest.raises(InputError):
        real(text)


def written(floor, form):
    """Write a floor of shells and beams as bulk data: our own test of reading, not an export."""

    def card(name, *fields):
        values = ["" if f is None else f for f in fields]
        if form == "free":
            texts = [repr(v) if isinstance(v, float) else str(v) for v in values]
            lines = [texts[i : i + 8] for i in range(0, len(texts), 8)]
            for line in lines[:-1]:
                line.extend([""] * (8 - len(line)) + ["+"])
            return "\n".join(
                ",".join([name if i == 0 else "+", *line]) for i, line in enumerate(lines)
            )
        size = 16 if form == "large" else 8

        def cell(value):
            text = f"{value:.9E}" if isinstance(value, float) else str(value)
            if isinstance(value, float) and size == 8:
                many = (f"{value:.{k}e}".partition("e")[::2] for k in (4, 3, 2))
                text = next(t for d, p in many if len(t := f"{d}{int(p):+d}") <= 8)
            return text.ljust(size)

        step = 4 if form == "large" else 8
        rows = [values[i : i + step] for i in range(0, len(values), step)]
        mark = "*" if form == "large" else ""
        return "\n".join(
            (f"{name}{mark}" if i == 0 else (mark or "+")).ljust(8) + "".join(map(cell, row))
            for i, row in enumerate(rows)
        )

    lines = [
        "SOL 103",
        "CEND",
        "SPC = 1",
        "BEGIN BULK",
        "$ a comment",
        card("PARAM", "COUPMASS", 1),
    ]
    for i, (place, held) in enumerate(zip(floor.nodes, floor.fixed, strict=True)):
        lines.append(card("GRID", i + 1, None, *(float(v) for v in place)))
        if held.any():
            dofs = "".join(str(k + 1) for k in np.flatnonzero(held))
            lines.append(card("SPC1", 1, dofs, i + 1))
    (slab,) = floor.shells
    number, section = 1, slab.section
    m = section.material
    lines.append(card("MAT1", 1, m.elastic_modulus, None, m.poisson_ratio, m.density))
    lines.append(
        card("PSHELL", 1, 1, section.thickness, 1, None, 1, None, section.superimposed_mass)
    )
    for e in slab.elements:
        lines.append(card("CQUAD4", number, 1, *(int(n) + 1 for n in e)))
        number += 1
    for k, group in enumerate(floor.beams):
        s = group.section
        shear = (s.shear_area_z / s.area, s.shear_area_y / s.area)
        lines.append(
            card("PBAR", 10 + k, 1, s.area, s.inertia_y, s.inertia_z, s.torsion_constant,
                 0.0, None, *[None] * 8, *shear)
        )  # fmt: skip
        for a, b in group.elements:
            along = floor.nodes[b] - floor.nodes[a]
            up = (1.0, 0.0, 0.0) if abs(along[2]) > 0.5 * np.linalg.norm(along) else (0.0, 0.0, 1.0)
            w = [float(v) for v in group.offset] if group.offset.any() else [None] * 3
            lines.append(
                card("CBAR", number, 10 + k, int(a) + 1, int(b) + 1, *up, None, None, None, *w, *w)
            )
            number += 1
    return "\n".join([*lines, "ENDDATA", "and nothing behind it"])


@pytest.mark.parametrize(("form", "digits"), [("free", 1e-9), ("large", 1e-8), ("small", 1e-3)])
def test_a_floor_in_every_form_of_fields_is_the_floor(tmp_path, form, digits):
    """Its mass and its first frequencies, to the digits that the fields hold."""
    floor = small_floor(mesh_size=1.5)
    path = tmp_path / f"{form}.bdf"
    path.write_text(written(floor, form))
    found = read_model(path)
    assert found.problems == ()
    model = found.structure
    assert model.n_dofs == floor.n_dofs
    assert model.moving_mass() == pytest.approx(floor.moving_mass(), rel=digits)
    ours, theirs = (
        natural_modes(one.mass, one.stiffness, f_max=40.0).frequencies for one in (floor, model)
    )
    np.testing.assert_allclose(theirs, ours, rtol=digits)


CANTILEVER = """
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,7,3.,0.,0.
CORD2R,7,0,0.,0.,0.,0.,0.,1.,+
+,1.,0.,0.
MAT1,1,2.1+11,,.3,7850.
PBAR,1,1,.01,2.-5,8.-6,1.-5,10.
CBAR,1,1,1,2,UP
CONM2,9,2,,50.
"""


@pytest.mark.parametrize(
    ("up", "direction", "inertia"),
    [("0.,0.,1.", 2, 2e-5), ("0.,0.,1.", 1, 8e-6), ("0.,1.,0.", 1, 2e-5), ("0.,1.,0.", 2, 8e-6)],
)
def test_i1_bends_in_the_plane_of_the_orientation(tmp_path, up, direction, inertia):
    """``P L^3 / (3 E I)``: plane 1 holds the bar and its vector, as the guide draws it."""
    path = tmp_path / "bar.bdf"
    path.write_text(CANTILEVER.replace("UP", up))
    bar = read_model(path).structure
    load = np.zeros(bar.n_dofs)
    load[bar.dof_index[1, direction]] = 1e3
    sinking = spsolve(bar.stiffness, load)[bar.dof_index[1, direction]]
    assert sinking == pytest.approx(1e3 * 27.0 / (3.0 * 2.1e11 * inertia), rel=1e-9, abs=0.0)


@pytest.mark.parametrize(
    ("coupmass", "share"), [("", 2.0), ("PARAM,COUPMASS,1\n", 3.0), ("PARAM,COUPMASS,-1\n", 2.0)]
)
def test_masses_with_wtmass(tmp_path, coupmass, share):
    """The bar's own and what a metre has besides, and the point mass, by WTMASS.

    Half of a bar is lumped at its end; of a consistent one a third moves with a linear motion.
    """
    path = tmp_path / "bar.bdf"
    path.write_text(CANTILEVER.replace("UP", "0.,0.,1.") + coupmass + "PARAM,WTMASS,2.\n")
    bar = read_model(path).structure
    rigid = bar.rigid_vector(0)
    assert float(rigid @ (bar.mass @ rigid)) == pytest.approx(
        2.0 * ((7850.0 * 0.01 + 10.0) * 3.0 / share + 50.0), rel=1e-9
    )
    assert bool(bar.mass[bar.dof_index[1, 4], bar.dof_index[1, 4]]) is (share == 3.0)


def test_a_grid_in_a_turned_system(tmp_path):
    """x of the system points along y: three metres along it are y = 3 m, from its origin."""
    text = CANTILEVER.replace("UP", "0.,0.,1.").replace(
        "CORD2R,7,0,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.",
        "CORD2R,7,0,1.,0.,0.,1.,0.,1.,+\n+,1.,5.,0.",
    )
    path = tmp_path / "bar.bdf"
    path.write_text(text)
    np.testing.assert_allclose(read_model(path).structure.nodes[1], [1.0, 3.0, 0.0], atol=1e-12)


@pytest.mark.parametrize(
    ("card", "said"),
    [
        ("RBE3,5,,1,123456,1.,123,2", "bar.bdf, line 11: got RBE3"),
        ("RBE2,5,1,1237,2", "grids follow in dofs 1 to 6"),
        ("CELAS2,5,1.+6,1,3,2,2", "to the same of another"),
        ("CELAS2,5,1.+6", "a spring needs a grid"),
        ("CBUSH,5,1,1", "a bush without CID"),
        ("CBUSH,5,1,1,2,0.,1.,0.", "lies along the basic axes"),
        ("PBUSH,5,K,RIGID", "RIGID is not read"),
        ("PBEAM,5,1,.01,2.-5,8.-6,0.,1.-5,,+\n+,NO,1.,.02", "a beam that tapers"),
        ("PBEAM,5,1,.01,2.-5,8.-6,1.-6,1.-5", "I12 is not 0"),
        ("PBEAM,5,1,.01,2.-5,8.-6,,1.-5,,+\n+\n+,,,.1", "shear relief"),
        ("PBARL,5,1,,HAT,,,,,+\n+,.1,.1,.1,.1", "shapes read are BAR"),
        ("PBARL,5,1,,I,,,,,+\n+,.3,.1,.2,.01,.01,.01", "an I whose flanges differ"),
        ("CBAR,3,1,1,2,0.,0.,1.,GOO,+\n+,,,.1,,,.1", "offsets along the bar itself are not"),
        ("PCOMP,5,,,,,,,MEM,+\n+,1,.1,0.,YES", "a laminate of MEM"),
        ("PARAM,MAGIC,1", "PARAM MAGIC is not known"),
        ("CONM2,8,2,,5.,1.", "masses beside their grid"),
        ("PSHELL,4,1,.2", "only stretches, or only bends"),
        ("MAT1,2,2.1+11,1.+10,.3", "contradict each other"),
        ("GRID,3,,1.,X,0.", "must be a number"),
        ("SPC,1,1,1,.5", "enforced"),
        ("GRID,2,,5.,0.,0.", "grid 2 is there twice"),
        ("CBAR,1,1,2,1,0.,0.,1.", "element 1 is there twice"),
        ("CORD2R,8,0,0.,0.,0.,0.,0.,1.,+\n+,0.,0.,2.", "three points lie on one line"),
        ("PBAR,2,1,0.,1.,1.,1.", "field 4"),
        ("GRID,3,,1.+400,0.,0.", "too large a number"),
        ("GRID,3,,1.,2.,0.\n,50,2,,5.", "field 10 is not read"),
        ("PSHELL,4,1,.2,1,,1,,,+\n+,,,7", "field 12 is not read"),
        ("RBE2,5,1,123456", "names no grid that follows"),
        ("SPC1,1,3", "names no grid that is held"),
    ],
)
def test_what_is_not_understood_is_told_with_its_line(tmp_path, card, said):
    path = tmp_path / "bar.bdf"
    path.write_text(CANTILEVER.replace("UP", "0.,0.,1.").rstrip("\n") + f"\n{card}\n")
    found = read_model(path)
    assert found.structure is None
    text = "\n".join(map(str, found.problems))
    assert "line 12" in text or "line 11" in text
    import re

    assert re.search(said, text), text


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("CBAR,1,1,1,2,UP", "CBAR,1,1,1,9,0.,0.,1.", "names grid 9"),
        ("CBAR,1,1,1,2,UP", "CBAR,1,2,1,2,0.,0.,1.", "property 2, which is not there"),
        ("CBAR,1,1,1,2,UP", "CBAR,1,1,1,2,0.,0.,1.,,+\n+,2", "pins in 2 are not read"),
        ("CONM2,9", "CELAS1,8,4,2,3\nCONM2,9", "property 4, which is no spring's"),
        ("CONM2,9", "RBE2,8,2,123456,1\nRBE2,7,1,123456,2\nCONM2,9", "in a ring"),
        ("CBAR,1,1,1,2,UP", "CBAR,1,1,2,2,0.,0.,1.", "both ends are at one place"),
        ("CBAR,1,1,1,2,UP", "CBAR,1,1,1,2,1.,0.,0.", "orientation lies along the bar"),
        ("MAT1,1,", "MAT1,3,", "material 1, which is not there"),
        ("GRID,2,7,", "GRID,2,8,", "coordinate system 8"),
        (",,123456", ",,789", "dofs are numbered 1 to 6"),
    ],
)
def test_models_that_do_not_hold_together_are_told(tmp_path, old, new, said):
    path = tmp_path / "bar.bdf"
    path.write_text(CANTILEVER.replace(old, new).replace("UP", "0.,0.,1."))
    found = read_model(path)
    assert found.structure is None
    assert said in str(found.problems[0])


def test_includes_are_read_beside_the_model_alone(tmp_path):
    main, _, rest = CANTILEVER.replace("UP", "0.,0.,1.").partition("MAT1")
    (tmp_path / "inner.bdf").write_text("MAT1" + rest)
    (tmp_path / "outer.bdf").write_text(main + "INCLUDE 'inner.bdf'\n")
    assert read_model(tmp_path / "outer.bdf").structure.n_dofs == 6
    (tmp_path / "away.bdf").write_text(main + "INCLUDE '/etc/passwd'\n")
    assert "is not beside the model" in str(read_model(tmp_path / "away.bdf").problems[0])
    (tmp_path / "round.bdf").write_text(main + "INCLUDE 'round.bdf'\n")
    assert "include each other" in str(read_model(tmp_path / "round.bdf").problems[0])
    for i in range(1, 8):  # thirty files of thirty files of thirty files ...
        (tmp_path / f"i{i}.bdf").write_text(f"INCLUDE 'i{i + 1}.bdf'\n" * 30)
    (tmp_path / "i8.bdf").write_text("$\n")
    assert "more than 1000 files" in str(
        read_model(tmp_path / "i1.bdf", Asked(kind="nastran")).problems[0]
    )
    (tmp_path / "long.bdf").write_text(main + f"INCLUDE '{'a' * 5000}'\n")
    assert read_model(tmp_path / "long.bdf").structure is None


def test_supports_that_case_control_asks_for(tmp_path):
    """Of two sets the one that SPC names, or their sum; without a choice it is asked back."""
    text = CANTILEVER.replace("UP", "0.,0.,1.").replace(",,123456", "")
    sets = "SPC1,3,123,1\nSPC1,4,456,1\nSPCADD,5,3,4\n"
    path = tmp_path / "bar.bdf"
    for asked, free in (("SPC = 5\n", 6), ("SPC = 3\n", 9)):
        path.write_text(asked + text.lstrip() + sets)
        assert read_model(path).structure.n_dofs == free
    path.write_text(text + sets)
    assert "case control asks for none" in str(read_model(path).problems[0])


def test_a_range_holds_the_grids_that_are_there(tmp_path):
    """THRU to a billion: grids 1 and 2 are held, and nothing is listed."""
    text = CANTILEVER.replace("UP", "0.,0.,1.").replace(",,123456", "")
    path = tmp_path / "bar.bdf"
    path.write_text(text + "SPC1,1,123,1,THRU,999999999\n")
    assert read_model(path).structure.n_dofs == 6
    path.write_text(text + "SPC1,1,123,5\n")
    assert "names grid 5, which is not there" in str(read_model(path).problems[0])


def test_files_of_no_known_format_are_refused(tmp_path):
    path = tmp_path / "plan.txt"
    path.write_text("a list of things\n")
    with pytest.raises(InputError, match=r"no format that is known: .*Nastran bulk data"):
        read_model(path)
    with pytest.raises(InputError, match="no such file"):
        read_model(tmp_path / "none.bdf")


def test_continuations_are_joined(tmp_path):
    path = tmp_path / "cards.bdf"
    path.write_text("BEGIN BULK\nPBAR    1       1       .01     2.-5    8.-6    1.-5\n"
                    "+\n+       .5      .6\nSPC1,2,3,4,THRU,9\n")  # fmt: skip
    bar, held = cards_of(path)
    assert (bar.get(18), bar.get(19), bar.place) == (".5", ".6", "cards.bdf, line 2")
    assert held.fields[:5] == ("2", "3", "4", "THRU", "9")


def study_on(tmp_path, floor, **changes):
    """The small study, with its floor from a file."""
    (tmp_path / "floor.bdf").write_text(written(floor, "large"))
    start, end = GOOD.index("[floor]"), GOOD.index("[vehicle.truck]")
    text = GOOD[:start] + '[floor]\nkind = "model"\nfile = "floor.bdf"\n\n' + GOOD[end:]
    for old, new in changes.items():
        text = text.replace(old, new)
    path = tmp_path / "study.toml"
    path.write_text(text)
    return path


@pytest.mark.longest
def test_a_study_on_a_model_is_the_study_on_the_plan(tmp_path):
    """The same floor by both ways: levels to the digits of the file, and a report of each."""
    (tmp_path / "plan.toml").write_text(GOOD)
    plan = load_study(tmp_path / "plan.toml")
    model = load_study(study_on(tmp_path, plan.floor))
    assert model.plan is None
    assert model.extent == ((0.0, 12.0), (0.0, 6.0))
    both = [run_study(study) for study in (plan, model)]
    levels = [next(iter(result.cells.values())).rms_velocity for result in both]
    np.testing.assert_allclose(levels[1], levels[0], rtol=1e-4)
    save(both[1], tmp_path / "out")
    assert (tmp_path / "out" / "figures" / "plan.png").stat().st_size > 5000
    assert (tmp_path / "out" / "figures" / "modes.png").exists()
    assert not (tmp_path / "out" / "figures" / "section.png").exists()
    assert not (tmp_path / "out" / "figures" / "plan_1.png").exists()  # one surface


def test_mistakes_of_a_model_stand_with_those_of_the_study(tmp_path):
    path = study_on(tmp_path, small_floor(mesh_size=3.0))
    text = (tmp_path / "floor.bdf").read_text().replace("BEGIN BULK", "BEGIN BULK\nRBE3,1,2")
    (tmp_path / "floor.bdf").write_text(text)
    path.write_text(path.read_text().replace('speed = "15 km/h"', 'speed = "15 km"'))
    with pytest.raises(StudyError) as told:
        load_study(path)
    said = str(told.value)
    assert "RBE3" in said
    assert "route[1].speed" in said


def test_what_a_plan_alone_can_do_is_refused(tmp_path):
    """Half the mesh size, another slab, and a map of nodes need a plan."""
    from trundle.mitigate.changes import Change, changed_study
    from trundle.run.meshes import on_two_meshes

    path = study_on(tmp_path, small_floor(mesh_size=1.5))
    study = load_study(path)
    with pytest.raises(InputError, match="came as a mesh"):
        on_two_meshes(study)
    with pytest.raises(InputError, match="came as a mesh"):
        changed_study(study, Change(slab_thickness=0.3))
    path.write_text(path.read_text() + '\n[map]\nplaces = "nodes"\n')
    with pytest.raises(StudyError, match="stand in no grid"):
        load_study(path)


def test_a_deck_of_mistakes_ends_early(tmp_path):
    """A hundred are told; the rest, however many, is not even read."""
    path = tmp_path / "bad.bdf"
    path.write_text("BEGIN BULK\nGRID,1,,0.,0.,0.\n" + "CHEXA,1,1,1\n" * 5000)
    assert len(read_model(path).problems) == 100


def test_an_included_file_that_is_missing_is_told_with_the_rest(tmp_path):
    path = tmp_path / "deck.bdf"
    path.write_text("BEGIN BULK\nINCLUDE 'geom.inc'\nGRID,1,,0.,0.,0.\nCHEXA,1,1,1\n")
    told = [str(one) for one in read_model(path).problems]
    assert "deck.bdf, line 2: got geom.inc" in told[0]
    assert "CHEXA" in told[1]


@pytest.mark.parametrize(
    ("control", "said"),
    [
        ("SPC = 2 $ the other\n", "asks for SPC 2, which is not there"),
        ("SPC = 1\nSPC = 2\n", "subcases ask for SPC 1 and 2"),
        ("MPC = 3\n", "asks for MPC 3"),
        ("SPC = x\n", "asks for SPC = 'x'"),
    ],
)
def test_case_control_is_heard(tmp_path, control, said):
    path = tmp_path / "bar.bdf"
    bulk = CANTILEVER.replace("UP", "0.,0.,1.")
    path.write_text(control + bulk[bulk.index("BEGIN BULK") :] + "SPC1,1,3,2\n")
    assert said in " ".join(map(str, read_model(path).problems))


def test_ranges_of_followers_are_not_listed(tmp_path):
    """RBE2 to a billion: grid 2 follows, and nothing is listed."""
    path = tmp_path / "bar.bdf"
    path.write_text(CANTILEVER.replace("UP", "0.,0.,1.") + "RBE2,99,1,123456,2,THRU,999999999\n")
    read = read_model(path)
    assert "nothing of it can move" in str(read.problems[0])
