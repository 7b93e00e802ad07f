"""A building that another program has modelled, in a study: what it takes, and its mistakes."""

from dataclasses import replace

import numpy as np
import pytest

from meshes import as_msh_4, plate_mesh
from mode_tables import mode_tables
from studies import GOOD, MAP
from trundle import read_results, save
from trundle.errors import StudyError
from trundle.run.whole_study import run_study
from trundle.structure import ModalModel, build_floor
from trundle.study_file import load_study, study_from_text

START, END = GOOD.index("[floor]"), GOOD.index("[vehicle.truck]")

MESHED = """
[building]
kind = "gmsh"
file = "hall.msh"
units = "N, m"

[building.materials.concrete]
elastic_modulus = "30 GPa"
density = "2500 kg/m3"

[building.plates.floor]
thickness = "0.2 m"
material = "concrete"
superimposed_mass = "100 kg/m2"

[building.sections.girder]
shape = "rectangle"
width = "0.3 m"
depth = "0.5 m"
material = "concrete"

[[building.group]]
name = "slab"
plate = "floor"

[[building.group]]
name = "beam"
section = "girder"
offset = ["0 m", "0 m", "-0.35 m"]

[[building.group]]
name = "edge"
hold = "pinned"

[[building.group]]
name = "corner"
nothing = true

[[building.surface]]
name = "hall"
height = "0 m"

"""


def study(tmp_path, building, mesh=None):
    (tmp_path / "hall.msh").write_text(mesh or as_msh_4(*plate_mesh(12, 6, lx=12.0, ly=6.0)))
    path = tmp_path / "study.toml"
    path.write_text(GOOD[:START] + building + GOOD[END:])
    return path


def problems(tmp_path, *changes, mesh=None):
    text = MESHED
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    with pytest.raises(StudyError) as told:
        load_study(study(tmp_path, text, mesh))
    return [str(one) for one in told.value.problems]


def test_a_study_stands_on_a_mesh_of_gmsh(tmp_path):
    """Mass by hand: slab 600, girder 12 x 0.15 m3 at 2500 kg/m3; held edges carry theirs."""
    loaded = load_study(study(tmp_path, MESHED))
    assert list(loaded.floor.surfaces) == ["hall"]
    assert loaded.extent == ((0.0, 12.0), (0.0, 6.0))
    assert loaded.mesh_size == pytest.approx(1.0)
    whole = 12.0 * 6.0 * 600.0 + 12.0 * 0.15 * 2500.0
    assert 0.7 * whole < loaded.floor.moving_mass() < whole
    assert list(loaded.files) == ["hall.msh"]


def test_what_a_model_must_say_is_told_with_its_place(tmp_path):
    found = problems(tmp_path, ('units = "N, m"\n', ""))
    assert "building.units: got nothing" in found[0]
    assert "N moves 1000 kg" in problems(tmp_path, ('"N, m"', '"N, mm, kg"'))[0]
    found = problems(tmp_path, ('plate = "floor"', 'plate = "roof"'), ('hold = "pinned"', ""))
    assert "building.group[1].plate" in found[0]
    assert "there are: floor" in found[0]
    assert "building.group[3]" in found[1]
    assert "nothing = true alone" in found[1]
    found = problems(tmp_path, ('material = "concrete"\nsuper', 'material = "conc"\nsuper'))
    assert "building.plates.floor.material" in found[0]


def test_mistakes_of_the_mesh_stand_with_the_studys(tmp_path):
    found = problems(tmp_path, ('name = "corner"', 'name = "corners"'))
    assert "nothing says what 'corner' of the mesh is" in found[0]
    found = problems(tmp_path, ('height = "0 m"', 'height = "4 m"'))
    assert "there are levels at 0 m" in found[0]


def test_kinds_of_buildings_are_told(tmp_path):
    found = problems(tmp_path, ('kind = "gmsh"', 'kind = "gmesh"'))
    assert "building.kind" in found[0]
    assert "did you mean 'gmsh'?" in found[0]
    found = problems(tmp_path, ("height =", "hight ="))
    assert "building.surface[1].hight" in found[0]
    assert "did you mean 'height'?" in found[0]


def test_a_route_is_not_drawn_where_nothing_is(tmp_path):
    path = study(tmp_path, MESHED)
    text = path.read_text()
    start = text.index("path = [")
    end = text.index("\n", start)
    path.write_text(text[:start] + 'drawn = "route"' + text[end:])
    with pytest.raises(StudyError, match="this study has no building"):
        load_study(path)


MODES = """
[building]
kind = "modes"
frequencies = "f.csv"
shapes = "s.csv"
nodes = "n.csv"
elements = "e.csv"
complete_to = "40 Hz"

"""


def modes_study(tmp_path, building=MODES, change=("f_max", "f_max"), more=""):
    text = GOOD + more
    (tmp_path / "plan.toml").write_text(text)
    plan = load_study(tmp_path / "plan.toml")
    mode_tables(tmp_path, build_floor(plan.plan, mesh_size=1.5), 40.0)
    path = tmp_path / "study.toml"
    path.write_text((text[:START] + building + text[END:]).replace(*change))
    return plan, path


def bare(study):
    """Return the methods of a study without the static rest of the modes left out."""
    for method in study.methods:
        integration = replace(method.interaction.integration, residual=False)
        yield replace(method, interaction=replace(method.interaction, integration=integration))


DECOUPLED = GOOD[GOOD.index("[[method]]") : GOOD.index("[criteria]")].replace(
    "coupled", "decoupled"
)


@pytest.mark.longest
def test_a_study_on_modes_alone_runs_and_says_what_is_missing(tmp_path):
    """The levels of the plan's own modes without their static rest; and that is what is told."""
    plan, path = modes_study(tmp_path, more="\n" + DECOUPLED + MAP)
    found = load_study(path)
    assert isinstance(found.floor, ModalModel)
    assert found.floor.moving_mass() is None
    both = [run_study(study) for study in (replace(plan, methods=tuple(bare(plan))), found)]
    for key, cell in both[0].cells.items():
        theirs = both[1].cells[key]
        np.testing.assert_allclose(theirs.rms_velocity, cell.rms_velocity, rtol=1e-7)
        assert (cell.exact is None) == (theirs.exact is None)
        if cell.exact is not None:
            for name, variance in cell.exact.variance.items():
                np.testing.assert_allclose(theirs.exact.variance[name], variance, rtol=1e-7)
    for key, one in both[0].maps.items():
        np.testing.assert_allclose(both[1].maps[key].band_levels, one.band_levels, rtol=1e-7)
    assert both[0].maps
    assert len(both[0].cells) == 2
    told = " ".join(str(one) for some in both[1].warnings().values() for one in some)
    assert "not even statically" in told
    assert "follow the wheels" not in told
    save(both[1], tmp_path / "out")
    again = read_results(tmp_path / "out")
    assert again.study.floor.content_hash == found.floor.content_hash
    page = (tmp_path / "out" / "report.html").read_text()
    assert "not known: modes alone were given" in page


def test_what_modes_cannot_say_is_refused(tmp_path):
    _, path = modes_study(tmp_path, change=('f_max = "30 Hz"', 'f_max = "60 Hz"'))
    with pytest.raises(StudyError, match="the modes that are given reach 40 Hz"):
        load_study(path)
    text = path.read_text()
    path.write_text(text.replace('f_max = "60 Hz"', 'integration = "newmark"'))
    with pytest.raises(StudyError, match="has no matrices to integrate"):
        load_study(path)
    path.write_text(text.replace('f_max = "60 Hz"\n', ""))
    assert load_study(path).methods[0].interaction.integration.f_max == pytest.approx(40.0)
    path.write_text(text.replace('shapes = "s.csv"\n', ""))
    with pytest.raises(StudyError, match="give file alone, or frequencies and shapes"):
        load_study(path)


@pytest.mark.parametrize(
    "given",
    [
        ("file", "frequencies"), ("file", "shapes"), ("file", "frequencies", "shapes"),
        ("frequencies",), ("shapes",), (),
    ],
)  # fmt: skip
def test_modes_stand_in_a_file_or_in_two_tables_and_not_in_both(tmp_path, given):
    """Of both nobody knows which are meant; that there is none of the files is not looked at."""
    names = "".join(f'{key} = "gone.{key}"\n' for key in given)
    text = GOOD[:START] + f'[building]\nkind = "modes"\n{names}\n' + GOOD[END:]
    with pytest.raises(StudyError) as caught:
        study_from_text(text, folder=tmp_path)
    (problem,) = (p for p in caught.value.problems if p.place == "building")
    assert problem.value == (", ".join(given) or "nothing")
    assert problem.remedy == "give file alone, or frequencies and shapes"


def test_motion_that_nobody_measured_is_no_motion(tmp_path):
    """A point read along x of shapes without ux would be still, and pass."""
    _, path = modes_study(tmp_path, change=('f_max = "30 Hz"\n', ""))
    shapes = (tmp_path / "s.csv").read_text()
    point = 'at = ["3 m", "3 m"]'
    path.write_text(path.read_text().replace(point, f'{point}\naxes = ["z", "x"]'))
    assert load_study(path).points.keys() == {"tool", "tool x"}
    (tmp_path / "s.csv").write_text(shapes.replace("U1,", "V1,"))
    with pytest.raises(StudyError, match="nobody says how"):
        load_study(path)


def test_a_deck_in_several_files_is_kept_whole(tmp_path):
    """Read where the deck no longer is, from files of other names: as results are read back."""
    from trundle.exports import Subject, export

    (tmp_path / "plan.toml").write_text(GOOD)
    export(Subject(structure=load_study(tmp_path / "plan.toml").floor), tmp_path / "all.bdf")
    head, mark, rest = (tmp_path / "all.bdf").read_text().partition("$ slab")
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "rest.inc").write_text(mark + rest.replace("ENDDATA\n", ""))
    (tmp_path / "deck.bdf").write_text(head + "INCLUDE 'parts/rest.inc'\nENDDATA\n")
    model = '[building]\nkind = "nastran"\nfile = "deck.bdf"\nunits = "N, m"\n\n'
    (tmp_path / "study.toml").write_text(GOOD[:START] + model + GOOD[END:])
    study = load_study(tmp_path / "study.toml")
    assert list(study.files) == ["deck.bdf", "parts/rest.inc"]
    kept = {}
    for i, (name, content) in enumerate(study.files.items()):
        kept[name] = tmp_path / f"file{i:02d}.bdf"  # as a results folder has them
        kept[name].write_bytes(content)
    (tmp_path / "deck.bdf").unlink()
    (tmp_path / "parts" / "rest.inc").unlink()
    again = load_study(tmp_path / "study.toml", files=kept)
    assert again.floor.content_hash == study.floor.content_hash
    assert list(again.files) == list(study.files)
