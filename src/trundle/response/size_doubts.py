"""Doubt motion of a size that no floor under a vehicle has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from trundle.errors import FitnessWarning
from trundle.response.reduction import RunLevels

__all__ = ["size_warnings"]

_MOST, _LEAST = 100.0, 1e-7  # m/s2: ten times gravity, a hundredth of what sensors see
_FASTEST = 1.0  # m/s


def size_warnings(reduced: Mapping[str, RunLevels]) -> tuple[FitnessWarning, ...]:
    """Return the doubts about motion that is too large or too small to be meant.

    Parameters
    ----------
    reduced : mapping of str to RunLevels
        What is kept of every run, by what drove.
    """
    return tuple(doubt for name, one in reduced.items() for doubt in _doubts(name, one))


def _doubts(name: str, reduced: RunLevels) -> Iterator[FitnessWarning]:
    remedy = "see whether a mass, a stiffness, a thickness or a speed has the wrong unit"
    for i, point in enumerate(reduced.spectra.point_names):
        peak = float(reduced.peak_acceleration[:, i].max())
        rms = float(reduced.rms_velocity[:, i].max())
        if peak > _MOST or rms > _FASTEST:
            size = f"a peak of {peak:.3g} m/s2 and {rms:.3g} m/s are more than a floor bears"
        elif peak < _LEAST:
            size = f"a peak of {peak:.3g} m/s2 is less than any floor moves under a vehicle"
        else:
            continue
        yield FitnessWarning(
            subject=f"size of the motion, {name}", message=f"{point}: {size}; {remedy}"
        )
