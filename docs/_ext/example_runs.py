"""Run examples for the gallery, once for what they are: a picture and a sentence of each.

The quick ones always; all that are studies where ``GALLERY=all`` stands in the environment, which
takes most of an hour of processor time.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from matplotlib import rc_context
from pages import ROOT

import trundle
from trundle.report.canvas import STYLE, Drawing
from trundle.report.figures import class_plan, response
from trundle.results.study_result import StudyResult
from trundle.views.conclusions import concluded, conclusion_of_all

__all__ = ["NOT_HERE", "QUICK", "Outcome", "outcome_of", "runs_here"]

_KEPT = ROOT / "build" / "docs-runs"

QUICK = ("from_drawing", "from_python", "measured_profile", "steel_floor")
"""Examples that a build runs whole: less than a minute of processor time together."""

_SMALL = "`{}` runs it at small size (`make validate`)"
NOT_HERE = {
    "paper": "`make demo` runs it; [](paper.md) has its tables",
    "stack_up_factory": "`tests/examples/test_stack_up_factory.py` meshes it and runs parts of it; [](../stack_up_factory.md) tells what it gives",
    **dict.fromkeys(
        ("car_park", "flat_slab", "hospital"),
        _SMALL.format("tests/examples/test_buildings.py"),
    ),
    **dict.fromkeys(
        ("laboratory_corridor", "two_lanes"),
        _SMALL.format("tests/examples/test_days_and_sources.py"),
    ),
    **dict.fromkeys(
        ("curve_into_dock", "forklift_joints"),
        _SMALL.format("tests/examples/test_roads_and_routes.py"),
    ),
    "quick_start": "`tests/examples/test_quick_start.py` runs it, and holds its numbers to those of the README",
}
"""What runs the others, which take minutes."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Hold what an example gave.

    Attributes
    ----------
    picture : Path
        Its first class plan, or the levels of its first point on the criteria.
    title : str
        What is seen there.
    sentence : str
        What is concluded of all its points.
    runs : int
        Runs of every cell.
    """

    picture: Path
    title: str
    sentence: str
    runs: int


def runs_here(folder: Path) -> bool:
    """Return whether a build runs an example."""
    asked = os.environ.get("GALLERY") == "all"
    return folder.name in QUICK or (asked and (folder / "study.toml").exists())


def outcome_of(folder: Path, kept: Path = _KEPT) -> Outcome:
    """Return what an example gives; run it only if it, or trundle's version, is another than before.

    Parameters
    ----------
    folder : Path
        The example.
    kept : Path
        Where pictures and sentences are kept.
    """
    name = f"{folder.name}-{content_of(folder)}"
    told, picture = kept / f"{name}.json", kept / f"{name}.svg"
    if not (told.exists() and picture.exists()):
        kept.mkdir(parents=True, exist_ok=True)
        result = trundle.run_study(trundle.load_study(folder / "study.toml"))
        drawing = _result_drawing(result)
        with rc_context(STYLE):
            drawing.draw().savefig(picture, metadata={"Date": None}, bbox_inches="tight")
        said = {
            "title": drawing.title,
            "sentence": conclusion_of_all(concluded(result)),
            "runs": result.study.runs,
        }
        told.write_text(json.dumps(said), encoding="utf-8")
    return Outcome(picture=picture, **json.loads(told.read_text("utf-8")))


def content_of(folder: Path) -> str:
    """Return a hash of an example's files, of trundle's version, and of this way to show it."""
    found = hashlib.sha256(trundle.__version__.encode())
    for path in (Path(__file__), *sorted(one for one in folder.iterdir() if one.is_file())):
        found.update(path.read_bytes())
    return found.hexdigest()[:12]


def _result_drawing(result: StudyResult) -> Drawing:
    """Return the class plan where there is a map, or else levels on the criteria."""
    return next(chain(class_plan.drawings(result), _levels(result)))


def _levels(result: StudyResult) -> Iterator[Drawing]:
    return (one for one in response.drawings(result) if one.name.startswith("criteria_velocity"))
