"""Replace the floor's motion at points by that of what stands there on an isolator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeVar

import numpy as np

from trundle._typing import Array
from trundle.errors import InputError
from trundle.signals import Isolation, behind
from trundle.simulate import Harmonics, MeanResponse, Runs

__all__ = ["behind_isolators"]

Response = TypeVar("Response", Runs, MeanResponse, Harmonics)


def behind_isolators(response: Response, isolations: Mapping[str, Isolation]) -> Response:
    """Return the response with points behind isolators in place of the floor there.

    Parameters
    ----------
    response : Runs, MeanResponse or Harmonics
        Motion of the floor.
    isolations : mapping of str to Isolator or TransmissibilityTable
        What stands at some of the points, by their names.

    Raises
    ------
    InputError
        A name that is no point's.
    """
    names = (response.mean if isinstance(response, Harmonics) else response).point_names
    for name in isolations:
        if name not in names:
            raise InputError(f"no point {name!r} to isolate; the points are {', '.join(names)}")
    if not isolations:
        return response
    fs = 1.0 / float(response.time[1] - response.time[0])

    def moved(values: Array) -> Array:
        """Return values with the isolated points in place of the floor's."""
        out = values.copy()
        for name, isolation in isolations.items():
            at = names.index(name)
            out[..., at] = behind(isolation, np.ascontiguousarray(values[..., at]), fs)
        return out

    changed = {k: moved(getattr(response, k)) for k in ("displacement", "velocity", "acceleration")}
    if isinstance(response, Harmonics):
        return replace(response, mean=behind_isolators(response.mean, isolations), **changed)
    return replace(response, **changed)
