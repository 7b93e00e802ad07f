"""Write the report of a study: figures, and one self-contained HTML page that opens offline."""

from __future__ import annotations

import base64
import gzip
import itertools
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from trundle._progress import Tell, silent
from trundle.errors import InputError
from trundle.report.canvas import Drawing, class_colours
from trundle.report.figures import (
    building,
    class_plan,
    day,
    floor,
    given_road,
    map,
    model,
    response,
    road,
    vehicle,
)
from trundle.report.html import Picture, embedded, template
from trundle.report.pages.view import view_page
from trundle.results.mesh_change import mesh_words
from trundle.results.parts_change import parts_words
from trundle.results.study_result import StudyResult
from trundle.road import CLASS_NAMES, class_limits
from trundle.structure import Structure, self_weight_deflection
from trundle.study.model import Study
from trundle.views.assumptions import assumption_lines, source_lines
from trundle.views.conclusions import concluded, conclusion_of_all, lights
from trundle.views.days import day_views, together_lines
from trundle.views.map import map_payload
from trundle.views.printed import bound_rows, comparison_rows
from trundle.views.scene import scene_of
from trundle.views.tables import exact_rows, summary_headings, summary_rows, truncation_rows
from trundle.views.verdicts import headline, verdict_matrix
from trundle.views.words import road_words

__all__ = ["unused_numbers", "write_report"]

_FILES = (
    building,
    model,
    floor,
    road,
    given_road,
    vehicle,
    response,
    day,
    class_plan,
    map,
)  # in the order of the page


def write_report(result: StudyResult, folder: Path, *, tell: Tell | None = None) -> Path:
    """Write ``figures/*.png``, ``figures/*.svg`` and ``report.html``; return its path.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    folder : Path
        Results folder, which must exist.
    tell : callable, optional
        Told which figure is drawn, and the share drawn.
    """
    numbered = [_numbered(drawing, result.study.numbering) for drawing in _drawings(result)]
    pictures = embedded(numbered, folder / "figures", tell=tell or silent)
    page = folder / "report.html"
    page.write_text(_render(result, pictures), encoding="utf-8")
    return page


def _drawings(result: StudyResult) -> Iterator[Drawing]:
    return itertools.chain.from_iterable(file.drawings(result) for file in _FILES)


def unused_numbers(result: StudyResult) -> list[str]:
    """Return the names that a study numbers and that no figure or table of its report has."""
    known = {drawing.name for drawing in _drawings(result)}.union(_tables(result))
    return [name for name in result.study.numbering if name not in known]


def _tables(result: StudyResult) -> Iterator[str]:
    """Give the names of the tables on the page that bear numbers."""
    yield "classes"
    if comparison_rows(result):
        yield "printed"
        if bound_rows(result):
            yield "printed_bound"


def _numbered(drawing: Drawing, numbering: Mapping[str, str]) -> Drawing:
    """Return a drawing whose caption ends with the number that the study gives it."""
    number = numbering.get(drawing.name)
    if number is None:
        return drawing
    return replace(drawing, caption=f"{drawing.caption} ({number})")


def _with_colours(payload: dict[str, Any]) -> dict[str, Any]:
    """Return what the interactive map shows, with a colour for each class."""
    return payload and payload | {"colours": class_colours(payload["limits"])}


def _render(result: StudyResult, pictures: list[Picture]) -> str:
    study = result.study
    columns, matrix = verdict_matrix(result)
    modes, conclusions, shown = result.modes, concluded(result), lights(result)
    return template("report.html.j2").render(
        study=study,
        numbering=study.numbering,
        pictures=pictures,
        comparison=comparison_rows(result),
        bounds=bound_rows(result),
        summary=summary_rows(result),
        summary_headings=summary_headings(study.report),
        exact=exact_rows(result),
        truncation=truncation_rows(result),
        map=_with_colours(map_payload(result)),
        columns=columns,
        roads=road_words(study),
        matrix=matrix,
        verdict=headline(result),
        conclusions=conclusions,
        conclusion=conclusion_of_all(conclusions),
        lights=shown,
        other_motion=any(not one.applies for row in shown.values() for one in row.values()),
        logo=_logo(study),
        space=_in_space(result),
        together=together_lines(result),
        days=day_views(result),
        mesh="" if result.mesh is None else mesh_words(result.mesh),
        parts="" if result.parts is None else parts_words(result.parts),
        assumptions=assumption_lines(study),
        sources=source_lines(study),
        warnings=result.warnings(),
        provenance=result.provenance,
        frequencies=[] if modes is None else [f"{f:.2f}" for f in modes.frequencies[:24]],
        n_modes=0 if modes is None else modes.n_modes,
        moving_mass=study.floor.moving_mass(),
        sag=_sag(study.floor),
        class_limits=_class_table(),
    )


def _sag(floor: Structure) -> float | None:
    """Return the largest deflection under its own weight [mm]; None if nothing says it."""
    try:
        return -1e3 * float(self_weight_deflection(floor).min())
    except InputError:  # it is known by its modes
        return None


def _in_space(result: StudyResult) -> str:
    """Return the packed page of the model in 3-D with its first modes; nothing if it is large."""
    if result.modes is None or result.modes.motion is None:
        return ""
    study = result.study
    page = view_page(scene_of(study.floor, title=study.title, modes=result.modes, study=study))
    return base64.b64encode(gzip.compress(page.encode(), 9, mtime=0)).decode("ascii")


def _logo(study: Study) -> str:
    """Return the study's logo as the address of a picture; nothing without one."""
    data = study.files.get(study.report.logo, b"") if study.report.logo else b""
    kind = "png" if data.startswith(b"\x89PNG") else "jpeg"
    return f"data:image/{kind};base64,{base64.b64encode(data).decode('ascii')}" if data else ""


def _class_table() -> list[tuple[str, list[str]]]:
    return [(name, [f"{1e6 * v:.0f}" for v in class_limits(name)]) for name in CLASS_NAMES]
