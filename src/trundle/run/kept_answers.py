"""Keep by what a building answers on disk: a study that asks the same finds it there."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics import (
    AnsweringModes,
    Questions,
    answers_as_arrays,
    answers_from_arrays,
    are_answers_of,
    available_backends,
)
from trundle.results.kept import read_kept, write_kept
from trundle.run.cache import cache_folder, make_room
from trundle.structure.superelements import PartedStructure

__all__ = ["Asked", "keep_answers", "kept_answers"]

_KEPT = 20  # sets of answers; those unused for longest go first
_ROOM = 4e9  # bytes of them
_LINES = 200  # frequencies by which damping is known


@dataclass(frozen=True, kw_only=True, eq=False)
class Asked:
    """Hold all that decides the answers of a building.

    Attributes
    ----------
    structure : PartedStructure
        The building.
    questions : Questions
        Where it is pushed and looked at.
    ratios : callable
        Gives the least damping ratio at circular frequencies [rad/s].
    f_max : float
        Highest frequency [Hz].
    """

    structure: PartedStructure
    questions: Questions
    ratios: Callable[[Float[Array, " lines"]], Float[Array, " lines"]]
    f_max: float

    @cached_property
    def content_hash(self) -> str:
        """Hash of all of it; what is asked alike shares it."""
        tolerance = self.structure.parting.response_tolerance
        said = (self.structure.content_hash, self.f_max, tolerance, available_backends()[0])
        digest = hashlib.sha256(repr(said).encode())
        omega = 2.0 * np.pi * np.geomspace(0.01, 1.0, _LINES) * self.f_max
        digest.update(np.asarray(self.ratios(omega)).tobytes())
        for rows in (self.questions.pushed, self.questions.read, self.questions.mapped):
            ordered = rows.tocsr(copy=True)
            ordered.sort_indices()
            digest.update(repr(ordered.shape).encode())
            for values in (ordered.indptr, ordered.indices):
                digest.update(values.astype(np.int64).tobytes())
            digest.update(ordered.data.tobytes())
        return digest.hexdigest()[:24]

    def is_met_by(self, found: AnsweringModes) -> bool:
        """Return whether what was kept answers it, tried at one frequency."""
        return found.modes.f_max == self.f_max and are_answers_of(
            found,
            self.structure.joined.pencil,
            self.questions,
            ratios=self.ratios,
            tolerance=self.structure.parting.response_tolerance,
        )


def kept_answers(asked: Asked) -> AnsweringModes | None:
    """Return what answers, if it is kept and can be believed."""
    file = _file(asked)
    kept = None if file is None or not file.is_file() else read_kept(file, file.stem)
    if file is None or kept is None:
        return None
    try:
        found = answers_from_arrays(kept[0])
        met = asked.is_met_by(found)
    except Exception:  # a stranger's arrays may be anything
        return None
    if not met:
        return None
    with suppress(OSError):
        os.utime(file)
    return found


def keep_answers(asked: Asked, found: AnsweringModes) -> None:
    """Keep what answers; a cache that cannot be written is no reason to stop."""
    file = _file(asked)
    if file is None:
        return
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        write_kept(file, answers_as_arrays(found), file.stem)
        make_room(file, _KEPT, _ROOM)


def _file(asked: Asked) -> Path | None:
    """Return where it is kept, None where keeping is switched off."""
    folder = cache_folder()
    return None if folder is None else folder / "answers" / f"answers-{asked.content_hash}.npz"
