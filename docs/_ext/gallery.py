"""Make the gallery: what each example is, its plan, and what the quick ones give."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator
from pathlib import Path

from example_runs import NOT_HERE, outcome_of, runs_here
from matplotlib import rc_context
from matplotlib.figure import Figure
from pages import DOCS, GENERATED, ROOT, code, write_page

import trundle
from trundle.report.canvas import STYLE
from trundle.report.figures import building, floor
from trundle.study.model import Study
from trundle.study_file.build import load_study
from trundle.study_file.read import read_study
from trundle.study_file.sections import KINDS

__all__ = ["examples", "write_gallery"]

_KEPT = ROOT / "build" / "docs-pictures"
_GIVEN = {"stack_up_factory": DOCS / "images" / "stack_up_plan.png"}  # ten seconds to mesh
_WITHOUT_STUDY = {
    "quick_start": (
        "A truck on the reference unit, from Python",
        "Floor, vehicle, route and road as values, 20 runs at one point, held against the VC curves. Half a minute.",
        "python examples/quick_start/quick_start.py",
    ),
    "clusters": (
        "A study on many machines",
        "Files that run a study by ssh, on Slurm and on Kubernetes; [](../scale-out.md) explains them.",
        "",
    ),
}


def write_gallery() -> None:
    """Write the page and its pictures."""
    parts = ["# Gallery\n", _WORDS]
    for folder in examples():
        parts += _without_study(folder) if folder.name in _WITHOUT_STUDY else _entry(folder)
    write_page(GENERATED / "gallery.md", "\n".join(parts))


_WORDS = """\
Every folder of `examples`, with the plan of its floor: slabs, columns and beams, where vehicles drive or people walk, and where the response is
read. This build ran the quick ones: a picture of their results and their conclusion stand below their plans, as in the report that `trundle run` writes. Of the
others it is said what runs them.
"""


def examples() -> list[Path]:
    """Return the folders of examples."""
    return sorted(path for path in (ROOT / "examples").iterdir() if path.is_dir())


def _without_study(folder: Path) -> Iterator[str]:
    title, words, command = _WITHOUT_STUDY[folder.name]
    yield f"\n## {title}\n\n{words}\n"
    if command:
        yield _shown(command)
    yield from _not_here(folder)
    yield f"In `examples/{folder.name}`.\n"


def _entry(folder: Path) -> Iterator[str]:
    path = folder / "study.toml"
    text = path.read_text("utf-8")
    file, _ = read_study(path)
    yield f"\n## {file.general.title}\n\n{_said_above(text)}\n"
    yield f"![Plan: {file.general.title}](gallery/{_picture(folder)}){{.plan}}\n"
    yield _shown(f"trundle run {path.relative_to(ROOT).as_posix()}")
    yield from _outcome(folder)
    used = [kind for kind in KINDS if kind.name in file.given]
    linked = ", ".join(f"[{code(one.header)}](keys/{one.name}.md)" for one in used)
    yield f"In it: {linked}.\n"
    others = [one.name for one in sorted(folder.iterdir()) if one.is_file() and one != path]
    if others:
        yield f"Beside it in `examples/{folder.name}`: {', '.join(map(code, others))}.\n"


def _outcome(folder: Path) -> Iterator[str]:
    """Give picture and conclusion of an example that is run here; of another, what runs it."""
    if not runs_here(folder):
        yield from _not_here(folder)
        return
    found = outcome_of(folder)
    there = _copied(found.picture, f"{folder.name}-result.svg")
    yield f"![{found.title}](gallery/{there.name}){{.plan}}\n"
    yield f"**Run by this build**, {found.runs} runs a case: {found.sentence}\n"


def _not_here(folder: Path) -> Iterator[str]:
    if folder.name in NOT_HERE:
        yield f"Not run by this build: {NOT_HERE[folder.name]}.\n"


def _said_above(text: str) -> str:
    """Return what the comment above the first key says, without commands."""
    above: list[str] = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        above.append(line.lstrip("# ").strip())
    said = [line for line in above if line and not line.startswith(("trundle ", "Run it with"))]
    return " ".join(said)


def _shown(command: str) -> str:
    return f"```sh\n{command}\n```\n"


def _picture(folder: Path) -> str:
    """Return the name of an example's picture, drawn once for what it is drawn from."""
    given = _GIVEN.get(folder.name)
    source = given or _KEPT / f"{folder.name}-{_content(folder)}.svg"
    if not source.exists():
        _KEPT.mkdir(parents=True, exist_ok=True)
        _draw(load_study(folder / "study.toml"), source)
    return _copied(source, f"{folder.name}{source.suffix}").name


def _copied(source: Path, name: str) -> Path:
    """Return a picture among those of the page; one that has not changed keeps its time."""
    there = GENERATED / "gallery" / name
    there.parent.mkdir(parents=True, exist_ok=True)
    if not there.exists() or there.read_bytes() != source.read_bytes():
        shutil.copyfile(source, there)
    return there


def _content(folder: Path) -> str:
    """Return a hash of an example and of what draws it."""
    drawn_by = [Path(module.__file__ or "") for module in (building, floor)]
    found = hashlib.sha256(trundle.__version__.encode())
    for path in (*drawn_by, *sorted(one for one in folder.iterdir() if one.is_file())):
        found.update(path.read_bytes())
    return found.hexdigest()[:12]


def _draw(study: Study, path: Path) -> None:
    with rc_context(STYLE):
        _plan(study).savefig(path, metadata={"Date": None})


def _plan(study: Study) -> Figure:
    """Draw the plan of the storey that most of a study's points are on."""
    if study.plan is not None:
        return floor.plan_figure(study, study.plan)
    if study.building is None:
        return floor.mesh_figure(study.floor)
    surfaces = list(study.floor.surfaces)
    on = [spot.on or surfaces[0] for spot in study.points.values()]
    return building.storey_figure(study, study.building, max(surfaces, key=on.count))
