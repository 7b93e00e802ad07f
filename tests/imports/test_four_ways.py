"""One building four ways: built here, meshed by gmsh's format, as a Nastran deck, by its modes.

The builder's own mesh is written as a mesh of gmsh (geometry by groups, what they are in the
study), as bulk data by our export, and as a universal file of modes; each is a study of its own
with the same truck.
"""

import re

import numpy as np
import pytest

from meshes import as_msh_4
from studies import BUILDING
from trundle import study_from_text
from trundle.exports import Subject, export
from trundle.run.whole_study import run_study
from trundle.structure import BeamGroup, Floor

TEXT = (
    BUILDING.replace('f_max = "60 Hz"', 'f_max = "112 Hz"')
    # no walls and hinges: a mesh of gmsh knows of neither
    .replace(BUILDING[BUILDING.index("[[building.wall]]") : BUILDING.index("[vehicle.car]")], "")
    .replace('hinged = "both"\n', "")
    .replace('base = "fixed"', 'base = "fixed"\nhead = "point"')
)
POINTS = """
[[point]]
name = "aside"
on = "deck"
at = ["5 m", "2 m"]
"""
CRITERIA = """
[criteria]
method = "coupled"
curves = ["VC-A"]
"""


def on(model):
    """Return the study on another building."""
    start, end = TEXT.index("[building]"), TEXT.index("[vehicle.car]")
    return TEXT[:start] + model + TEXT[end:] + POINTS + CRITERIA


@pytest.fixture(scope="module")
def built():
    return study_from_text(TEXT + POINTS + CRITERIA)


def gmsh_of(floor: Floor):
    """Return the mesh by groups, and the study's tables that say what they are."""
    groups, tables, number = {}, [], 0
    deck = 'plate = "deck"'
    for shell in [*floor.shells, *floor.others]:
        number += 1
        groups[2, number, f"plates {number}"] = np.asarray(shell.connectivity)
        tables.append(f'[[building.group]]\nname = "plates {number}"\n{deck}\n')
    for beam in floor.beams:
        assert isinstance(beam, BeamGroup)
        number += 1
        groups[1, number, f"members {number}"] = np.asarray(beam.elements)
        section = "post" if "column" in beam.name else "steel"
        offset = ", ".join(f'"{value!r} m"' for value in beam.offset.tolist())
        up = ", ".join(f"{value!r}" for value in beam.up.tolist())
        tables.append(
            f'[[building.group]]\nname = "members {number}"\nsection = "{section}"\n'
            f"offset = [{offset}]\nup = [{up}]\n"
        )
    held = np.flatnonzero(floor.fixed.all(axis=1))
    groups[0, number + 1, "bases"] = held[:, None]
    tables.append('[[building.group]]\nname = "bases"\nhold = "fixed"\n')
    return as_msh_4(floor.nodes, groups), "\n".join(tables)


SURFACES = """
[[building.surface]]
name = "deck"
height = "3 m"

[[building.surface]]
name = "lab"
height = "6.5 m"

"""


@pytest.fixture(scope="module")
def ways(built, tmp_path_factory):
    folder = tmp_path_factory.mktemp("ways")
    floor = built.floor
    mesh, tables = gmsh_of(floor)
    (folder / "b.msh").write_text(mesh)
    kept = TEXT[TEXT.index("[building.materials.concrete]") : TEXT.index("[building.grid.x]")]
    kept = re.sub(r"\[building\.plates\.wall\].*?\n\n", "", kept, flags=re.DOTALL)
    gmsh = f'[building]\nkind = "gmsh"\nfile = "b.msh"\nunits = "N, m"\n\n{kept}{tables}{SURFACES}'
    export(Subject(structure=floor), folder / "b.bdf")
    deck = f'[building]\nkind = "nastran"\nfile = "b.bdf"\nunits = "N, m"\n{SURFACES}'
    export(Subject(structure=floor, modes=floor.modes(112.0)), folder / "b.uff")
    modes = f'[building]\nkind = "modes"\nfile = "b.uff"\ncomplete_to = "112 Hz"\n{SURFACES}'
    return {
        name: study_from_text(on(text), folder=folder)
        for name, text in {"gmsh": gmsh, "deck": deck, "modes": modes}.items()
    }


def test_frequencies_are_those_of_the_building(built, ways):
    """Thirty of them within 0.5 %, as asked; the same model, so to the digits of the files."""
    ours = built.floor.modes(112.0).frequencies[:30]
    assert len(ours) == 30
    for name, allowed in {"gmsh": 1e-6, "deck": 1e-6, "modes": 1e-5}.items():
        theirs = ways[name].floor.modes(112.0).frequencies[:30]
        np.testing.assert_allclose(theirs, ours, rtol=allowed, err_msg=name)


def levels(study):
    """Return RMS velocity and band levels of every run at every point."""
    cell = next(iter(run_study(study).cells.values()))
    return cell.rms_velocity, cell.spectra.values


@pytest.mark.longest
def test_the_same_truck_does_the_same_to_all(built, ways):
    """RMS within 2 %, as asked: of models by 1e-5; of modes alone on the storey above by 2 %."""
    ours, ours_bands = levels(built)
    for name, allowed in {"gmsh": 1e-4, "deck": 1e-4}.items():
        theirs, theirs_bands = levels(ways[name])
        np.testing.assert_allclose(theirs, ours, rtol=allowed, err_msg=name)
        np.testing.assert_allclose(theirs_bands, ours_bands, rtol=1e-3, err_msg=name)
    theirs, theirs_bands = levels(ways["modes"])
    names = list(built.points)
    tool = names.index("tool")
    # where the static share of the modes left out is small: a storey away
    np.testing.assert_allclose(theirs[:, tool], ours[:, tool], rtol=0.02)
    excited = ours_bands[:, tool] > 0.05 * ours_bands[:, tool].max()
    np.testing.assert_allclose(
        theirs_bands[:, tool][excited], ours_bands[:, tool][excited], rtol=0.02
    )
