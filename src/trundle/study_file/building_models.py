"""Buildings that another program has modelled: their tables, and the model that they name."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from trundle.errors import FitnessWarning, InputError, Problem
from trundle.imports import (
    Asked,
    GroupMake,
    ModeFiles,
    ReadModel,
    SurfaceChoice,
    agreed_units,
    read_matrices,
    read_model,
    read_modes,
    read_universal_modes,
    units_of,
)
from trundle.structure import Floor, Structure
from trundle.study_file.attempt import attempted
from trundle.study_file.draft import Draft
from trundle.study_file.fields import Frequency, Length, Line, Name, Section
from trundle.study_file.mesh_makes import GroupSection, MeshMakes, makes_of

__all__ = [
    "AnyModel",
    "GmshSection",
    "MatricesSection",
    "ModelSection",
    "ModesSection",
    "model_taken",
    "with_model",
]

_LIKELY = {"elastic_modulus": (1e6, 2e12), "density": (1.0, 3e4)}  # Pa, kg/m3
_WIDEST = 1e4  # m
_FILES = ("file", "stiffness", "mass", "frequencies", "shapes", "nodes", "elements")


def _units(text: str) -> str:
    try:
        units_of(text)
    except InputError as error:
        raise PydanticCustomError("rule", "{rule}", {"rule": str(error)}) from None
    return text


UnitsText = Annotated[Line, AfterValidator(_units)]


class SurfaceSection(Section):
    """What is stood on, by height, by groups of elements, or both."""

    name: Name
    """How routes, points and maps call it."""
    height: Length | None = None
    """Of the level."""
    groups: tuple[Line, ...] = ()
    """Names of properties and groups of its elements."""


class _FromFile(Section):
    """What all models of other programs have."""

    surface: tuple[SurfaceSection, ...] = ()
    """What wheels and points stand on; every level unless given."""

    @property
    def choices(self) -> tuple[SurfaceChoice, ...]:
        """What is stood on."""
        return tuple(SurfaceChoice(**dict(one)) for one in self.surface)


class ModelSection(_FromFile):
    """A model that another program wrote, in one file."""

    kind: Literal["nastran", "sap2000", "etabs", "model"]
    """Whose format it is; model is told by the file."""
    file: Line
    """The model, beside the study."""
    units: UnitsText | None = None
    """Of the file, where it does not state them: "kN, m"."""
    ignore: tuple[Line, ...] = ()
    """Cards, tables and statements that are nothing of the structure."""


class GmshSection(_FromFile, MeshMakes):
    """A mesh, and what each of its groups is."""

    kind: Literal["gmsh"]
    """A mesh of gmsh."""
    file: Line
    """The mesh, beside the study."""
    units: UnitsText
    """Of the file; lengths of the mesh are in them."""
    group: tuple[GroupSection, ...]
    """What each physical group is."""


class MatricesSection(_FromFile):
    """Matrices of another program, and the nodes of their rows."""

    kind: Literal["matrices"]
    """Matrices of another program."""
    units: UnitsText
    """Of the files."""
    stiffness: Line
    """File of the stiffness matrix."""
    mass: Line
    """File of the mass matrix."""
    nodes: Line
    """File of the nodes of its rows."""
    elements: Line | None = None
    """File of the elements, for surfaces and pictures."""


class ModesSection(_FromFile):
    """Modes alone, of another program or of a test."""

    kind: Literal["modes"]
    """Modes alone."""
    units: UnitsText | None = None
    """Of the files, where they do not state them."""
    file: Line | None = None
    """One file with all, in a universal file, say."""
    frequencies: Line | None = None
    """File of the frequencies."""
    shapes: Line | None = None
    """File of the shapes."""
    nodes: Line | None = None
    """File of the nodes."""
    elements: Line | None = None
    """File of the elements."""
    scaled_to: Literal["unit mass", "modal mass"] = "modal mass"
    """Whether shapes are scaled to unit mass, or come with modal masses."""
    complete_to: Frequency | None = None
    """Frequency below which no mode is missing."""


AnyModel: TypeAlias = ModelSection | GmshSection | MatricesSection | ModesSection


def with_model(draft: Draft, section: AnyModel) -> tuple[Draft, list[Problem]]:
    """Return the draft with a model that is read from its files.

    Parameters
    ----------
    draft : Draft
        Knows where files are.
    section : ModelSection, GmshSection, MatricesSection or ModesSection
        What the study says of the model.
    """
    if isinstance(section, MatricesSection):
        return _read_with(draft, section, lambda files: _matrices(section, files))
    if isinstance(section, ModesSection):
        tables = (section.frequencies is not None, section.shapes is not None)
        if any(tables) if section.file is not None else not all(tables):
            return draft, [_one_way(section)]
        return _read_with(draft, section, lambda files: _modes(section, files))
    return _with_one_file(draft, section)


def model_taken(draft: Draft, name: str, path: Path, read: ReadModel) -> Draft:
    """Return the draft with a model that was read, and with the files that it was read from.

    Parameters
    ----------
    draft : Draft
        Without it.
    name : str
        How the study calls its file.
    path : Path
        Where that is.
    read : ReadModel
        A sound one.
    """
    kept = {name: path.read_bytes()}
    for other in read.files[1:]:  # those that it includes, by where they are beside it
        beside = other.resolve().relative_to(path.parent.resolve())
        kept[str(Path(name).parent / beside)] = other.read_bytes()
    assert read.structure is not None
    return _taken(draft, read, read.structure, kept)


def _one_way(section: ModesSection) -> Problem:
    given = [k for k in ("file", "frequencies", "shapes") if getattr(section, k) is not None]
    return Problem(
        place="building",
        value=", ".join(given) or "nothing",
        rule="modes stand in one universal file, or in tables of frequencies and of shapes",
        remedy="give file alone, or frequencies and shapes",
    )


def _read_with(
    draft: Draft,
    section: MatricesSection | ModesSection,
    read: Callable[[Mapping[str, Path]], ReadModel],
) -> tuple[Draft, list[Problem]]:
    """Return the draft with a model of several files, all of which are kept."""
    names = {k: name for k in _FILES if (name := getattr(section, k, None)) is not None}
    paths = {k: draft.files.get(name, draft.folder / name) for k, name in names.items()}
    found, mistakes = attempted("building", lambda: read(paths), "docs/models.md")
    if found is None or found.structure is None:
        return draft, mistakes + ([] if found is None else list(found.problems))
    kept = {names[k]: path.read_bytes() for k, path in paths.items()}
    return _taken(draft, found, found.structure, kept), mistakes


def _matrices(section: MatricesSection, files: Mapping[str, Path]) -> ReadModel:
    return read_matrices(**files, units=units_of(section.units), surfaces=section.choices)


def _modes(section: ModesSection, files: Mapping[str, Path]) -> ReadModel:
    units = None if section.units is None else units_of(section.units)
    unit_mass = section.scaled_to == "unit mass"
    surfaces, reach = section.choices, section.complete_to
    if "file" in files:
        return read_universal_modes(
            files["file"], units=units, unit_mass=unit_mass, reach=reach, surfaces=surfaces,
            nodes=files.get("nodes"), elements=files.get("elements"),
        )  # fmt: skip
    taken, said = agreed_units(None, units)
    read = read_modes(
        ModeFiles(**files), units=taken, unit_mass=unit_mass, reach=reach, surfaces=surfaces
    )
    return replace(read, told=(*said, *read.told))


def _with_one_file(
    draft: Draft, section: ModelSection | GmshSection
) -> tuple[Draft, list[Problem]]:
    """Return the draft with a model that one file holds, and those that it includes."""
    groups, found = dict[str, GroupMake](), list[Problem]()
    if isinstance(section, GmshSection):
        groups, found = makes_of(section, section.group)
    if found:
        return draft, found
    asked = Asked(
        kind=None if section.kind == "model" else section.kind,
        units=None if section.units is None else units_of(section.units),
        surfaces=section.choices,
        ignore=frozenset() if isinstance(section, GmshSection) else frozenset(section.ignore),
        groups=groups,
    )
    with _beside_each_other(draft, section.file) as path:
        read, found = attempted(
            "building.file", lambda: read_model(path, asked), "docs/models.md says what is read"
        )
        if read is None or read.structure is None:
            return draft, found + ([] if read is None else list(read.problems))
        if section.units is None and isinstance(read.structure, Floor):
            found += _unlikely(read, read.structure)
        return model_taken(draft, section.file, path, read), found


@contextmanager
def _beside_each_other(draft: Draft, name: str) -> Generator[Path]:
    """Give where a model's file is, with those that it includes where it looks for them.

    Results keep files under names of their own: such ones are laid out as they were.
    """
    if name not in draft.files:
        yield draft.folder / name
        return
    with tempfile.TemporaryDirectory(prefix="trundle-") as folder:
        home = Path(folder).resolve()
        for other, kept in draft.files.items():
            place = (home / other).resolve()
            if place.is_relative_to(home):
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(kept, place)
        yield home / name


def _taken(draft: Draft, read: ReadModel, structure: Structure, kept: Mapping[str, bytes]) -> Draft:
    told = tuple(FitnessWarning(subject="model", message=one) for one in read.told)
    sizes = [surface.element_size for surface in structure.surfaces.values()]
    return replace(
        draft,
        model=structure,
        mesh_size=float(np.median(sizes)) if sizes else 1.0,
        read={**draft.read, **kept},
        told=(*draft.told, *told),
    )


def _unlikely(read: ReadModel, floor: Floor) -> list[Problem]:
    """Return why numbers of a file that states no units can hardly be in N and m."""
    if read.units is None or read.units.said != "N, m":
        return []
    wide = float(np.ptp(floor.nodes, axis=0).max())
    found = [f"it would be {wide:.4g} m wide"] if wide > _WIDEST else []
    for group in floor.elements:
        material = getattr(getattr(group, "section", None), "material", None)
        for name, (low, high) in () if material is None else _LIKELY.items():
            value = getattr(material, name)
            if value > 0.0 and not low <= value <= high:
                unit = "Pa" if name == "elastic_modulus" else "kg/m3"
                found.append(f"{name.replace('_', ' ')} would be {value:.4g} {unit}")
    if not found:
        return []
    return [
        Problem(
            place="building.units",
            value="nothing",
            rule="the file states no units, and N and m are not likely: " + found[0],
            remedy='add units = "N, mm", say, or units = "N, m" if it is so',
        )
    ]
