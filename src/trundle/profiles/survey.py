"""A survey of a road as a file has it, before tracks are chosen."""

from __future__ import annotations

from dataclasses import dataclass

from jaxtyping import Float, Int

from trundle._typing import Array

__all__ = ["Survey"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Survey:
    """Hold the tracks of a road in the units of its file.

    Attributes
    ----------
    station : ndarray of float, shape (n_points,)
        Distance along the road.
    elevation : ndarray of float, shape (n_tracks, n_points)
        Height of every track.
    names : tuple of str
        What the tracks are called.
    station_unit : str
        Unit of the stations; empty where the file does not say it.
    units : tuple of str
        Units of the tracks, the same.
    lateral : tuple of float or None
        Place of every track, to the left of the centre line [m]; None where the file says none.
    where : str
        What the numbers of `lines` count: ``"line"`` of a text, ``"sample"``.
    lines : ndarray of int, shape (n_points,)
        Where in the file each point stands.
    notes : tuple of str
        What was passed over, or taken for granted.
    """

    station: Float[Array, " points"]
    elevation: Float[Array, "tracks points"]
    names: tuple[str, ...]
    station_unit: str
    units: tuple[str, ...]
    lateral: tuple[float, ...] | None = None
    where: str = "line"
    lines: Int[Array, " points"]
    notes: tuple[str, ...] = ()
