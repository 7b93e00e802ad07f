"""Compute transfer functions of a study's floor, with modes that are kept from earlier work."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from trundle._checks import one_of
from trundle._progress import Progress
from trundle._typing import Array
from trundle.run.answering import answers_to_places, asks_for_answers
from trundle.run.mode_cache import modes_of
from trundle.run.parts import with_kept_parts
from trundle.simulate import TransferFunctions, transfer
from trundle.simulate.spectral.transfer import (
    check_lines,
    load_rows,
    modes_needed,
    place_rows,
)
from trundle.structure import Spot
from trundle.study.model import Study
from trundle.study.plans import MethodPlan

__all__ = ["method_of", "transfer_of"]


def method_of(study: Study, name: str | None = None) -> MethodPlan:
    """Return a method of a study by its name; the one that is assessed, or the first, without one.

    Raises
    ------
    InputError
        No such method.
    """
    methods = {one.name: one for one in study.methods}
    usual = study.assessment.method if study.assessment is not None else next(iter(methods))
    return methods[one_of("method", name or usual, methods)]


def transfer_of(
    study: Study,
    loads: Mapping[str, Spot],
    points: Mapping[str, Spot],
    frequencies: Float[Array, " lines"],
    *,
    method: MethodPlan,
    progress: Progress | None = None,
) -> TransferFunctions:
    """Return the transfer functions of a study's floor, as a method keeps modes and damps them.

    Parameters
    ----------
    study : Study
        The study.
    loads, points : mapping of str to Spot
        Where unit forces act, and where motion is read.
    frequencies : ndarray of float, shape (n_lines,)
        Rising [Hz].
    method : MethodPlan
        One of its methods.
    progress : callable, optional
        Told the share of modes found, where they must be found.

    Raises
    ------
    InputError
        Frequencies that the method does not show, or a place off the floor.
    """
    floor = with_kept_parts(study.floor)
    integration = method.interaction.integration
    check_lines(np.asarray(frequencies), integration)
    f_max = modes_needed(float(frequencies[-1]), integration)
    damping = method.interaction.damping
    if asks_for_answers(floor):
        pushed, read = load_rows(floor, loads), place_rows(floor, "point", points)
        modes = answers_to_places(floor, pushed, read, damping, f_max=f_max, progress=progress)
    else:
        modes = modes_of(floor, f_max=f_max, progress=progress)
    return transfer(
        floor,
        loads,
        points,
        frequencies,
        integration=integration,
        damping=damping,
        modes=modes,
    )
