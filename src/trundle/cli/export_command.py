"""Write a model, its modes, a crossing or maps for other programs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from trundle._progress import Tell
from trundle.cli.opened import open_path
from trundle.cli.quantities import quantity_of
from trundle.cli.saying import say
from trundle.cli.screen import progress_bar
from trundle.dynamics import Modes
from trundle.errors import InputError
from trundle.exports import Subject, export, format_of
from trundle.exports.export_format import ExportFormat
from trundle.run.mode_cache import modes_of
from trundle.run.playback import Playback, playback_of
from trundle.structure import ModalModel, Structure
from trundle.study.model import Study

__all__ = ["Wanted", "export_of", "modes_to", "played"]


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """Hold what the options of a command ask for; empty texts for nothing."""

    f_max: str = ""
    case: str = ""
    road: str = ""
    method: str = ""
    units: str = ""
    origin: str = ""
    frames: int = 120


def export_of(path: Path, out: Path, *, kind: str, wanted: Wanted, quiet: bool) -> None:
    """Write what is asked for, and say where it is."""
    chosen = format_of(out, kind or None)
    with progress_bar(quiet=quiet) as tell:
        subject = _subject(path, wanted, tell, chosen)
        tell("writing", 1.0)
    main, *others = export(subject, out, chosen.kind)
    if not quiet:
        more = f", with {len(others)} files beside it" if others else ""
        say(f"{main}: {chosen.name}{more}")


def _subject(path: Path, wanted: Wanted, tell: Tell, chosen: ExportFormat) -> Subject:
    """Return what stands at a path: results, a study or a model, with what a format needs."""
    opened = open_path(path, units=wanted.units)
    study = opened.study
    subject = Subject(
        structure=opened.structure, result=opened.result, origin=_origin(wanted.origin)
    )
    if study is not None and study.building is not None and study.building.north is not None:
        subject = replace(subject, north=float(np.radians(study.building.north)))
    if "modes" in (*chosen.needs, *chosen.uses):
        subject = replace(subject, modes=modes_to(opened.structure, wanted.f_max, tell, study))
    if "playback" in chosen.needs:
        if study is None:
            raise InputError(f"{path}: a model alone has no crossing; name a study or its results")
        subject = replace(subject, playback=played(study, wanted, tell))
    return subject


def modes_to(structure: Structure, f_max: str, tell: Tell, study: Study | None) -> Modes:
    """Return the modes of a structure to a frequency."""
    if f_max:
        limit = quantity_of("--f-max", f_max, "frequency")
    elif isinstance(structure, ModalModel):
        limit = structure.reach
    else:
        given = [m.interaction.integration.f_max for m in study.methods] if study else []
        limit = next((f for f in given if f is not None), 30.0)
    return modes_of(structure, f_max=limit, progress=lambda share: tell("modes", share))


def played(study: Study, wanted: Wanted, tell: Tell) -> Playback:
    """Return the crossing that is asked for."""
    return playback_of(
        study,
        case=wanted.case or None,
        road=wanted.road or None,
        method=wanted.method or None,
        n_frames=wanted.frames,
        tell=tell,
    )


def _origin(text: str) -> tuple[float, float] | None:
    if not text:
        return None
    try:
        longitude, latitude = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"--origin {text!r}: must be longitude, latitude: '8.54, 47.38'") from None
    if not (-180.0 <= longitude <= 180.0 and -90.0 < latitude < 90.0):
        raise InputError(f"--origin {text!r}: longitude is -180 to 180, latitude -90 to 90")
    return longitude, latitude
