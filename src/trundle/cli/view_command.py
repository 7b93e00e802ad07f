"""Write the page on which a study, a model or results are looked at."""

from __future__ import annotations

from pathlib import Path

from trundle.cli.aside import check_file
from trundle.cli.export_command import Wanted, modes_to, played
from trundle.cli.opened import open_path
from trundle.cli.saying import say
from trundle.cli.screen import progress_bar
from trundle.errors import ComputationError, InputError
from trundle.report.pages.view import write_view
from trundle.views.scene import scene_of

__all__ = ["view"]


def view(path: Path, out: Path | None, *, wanted: Wanted, crossing: bool, quiet: bool) -> None:
    """Write the page, and say where it is."""
    place = out or Path(f"{path.resolve().stem}-view.html")
    check_file("--out", place, [".html", ".htm"])
    opened = open_path(path, units=wanted.units)
    structure, study = opened.structure, opened.study
    told = ""
    with progress_bar(quiet=quiet) as tell:
        playback = played(study, wanted, tell) if study is not None and crossing else None
        try:
            modes = modes_to(structure, wanted.f_max, tell, study)
        except ComputationError as error:  # a model that nothing holds is looked at all the same
            modes, told = None, f"no modes: {error}"
        title = structure.name if study is None else study.title
        scene = scene_of(structure, title=title, modes=modes, study=study, playback=playback)
        tell("writing", 1.0)
        try:
            write_view(scene, place)
        except OSError as error:
            raise InputError(f"{place}: cannot be written ({error.strerror})") from None
    if not quiet:
        if told:
            say(f"warning: {told}")
        say(f"{place}: open it in a browser ({place.stat().st_size / 1e6:.1f} MB)")
