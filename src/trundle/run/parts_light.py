"""Look whether enough of each part is kept: the same few runs with less of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from trundle._progress import Tell
from trundle.dynamics import Modes
from trundle.errors import TrundleError
from trundle.results.cells import Cell, CellKey
from trundle.results.parts_change import PartsChange
from trundle.results.study_result import StudyResult
from trundle.run.settling import compared, few_runs
from trundle.structure import Structure
from trundle.structure.superelements import PartedStructure
from trundle.study.model import Study

__all__ = ["parts_change"]

_FACTOR = 2.0**0.5  # by which less is kept
_REACH = 1.2  # of what modes are asked for, that parts are kept to at least


def parts_change(
    study: Study,
    floor: Structure,
    cells: Mapping[CellKey, Cell],
    modes: Modes | None,
    *,
    run: Callable[[Study, Tell], StudyResult],
    tell: Tell,
) -> PartsChange | None:
    """Return what keeping less of each part changes.

    None for a structure that is not cut into parts, for studies that assess nothing, and where so
    little is kept already that less would not do, or nothing can be left out of some part.

    Parameters
    ----------
    study : Study
        A study, run.
    floor : Structure
        Its structure, with its parts reduced if it is cut.
    cells : mapping of CellKey to Cell
        Its results.
    modes : Modes or None
        Its modes, where methods use them.
    run : callable
        Runs a study.
    tell : callable
        Told what is being done, and the share done.
    """
    if study.parting is None or study.assessment is None or modes is None:
        return None
    if not isinstance(floor, PartedStructure):
        return None
    own = floor.parting.f_parts
    factor = min(_FACTOR, own / (_REACH * modes.f_max))
    if factor < 0.5 * (1.0 + _FACTOR):
        return None
    narrow = floor.narrower(factor, least=modes.f_max)
    if not narrow.less_than(floor):
        return None
    few = replace(few_runs(study, study.assessment.method), floor=narrow, parting=None)
    try:
        found = run(few, lambda what, done: tell(f"parts kept to less: {what}", done))
    except TrundleError:  # what is computed stands, with the doubt that nobody has looked
        return None
    change = compared(few, (found.cells, cells), (found.modes, modes))
    return PartsChange(kept=(narrow.parting.f_parts, own), change=change)
