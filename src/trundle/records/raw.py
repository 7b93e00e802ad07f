"""Samples as a file has them, before units and channels are chosen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np
from jaxtyping import Float

from trundle._typing import Array

__all__ = ["Facts", "RawRecord"]


@dataclass(frozen=True, kw_only=True)
class Facts:
    """Hold what a file says beside its table.

    Attributes
    ----------
    rate : float or None
        Samples per second [Hz].
    units : tuple of str
        Unit of all channels, or of each in their order.
    n_samples : int or None
        How many samples it should hold.
    unclear : str
        A rate or step that can be read in two ways, as it is written; it is neither.
    """

    rate: float | None = None
    units: tuple[str, ...] = ()
    n_samples: int | None = None
    unclear: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class RawRecord:
    """Hold samples as a file has them.

    Attributes
    ----------
    samples : ndarray of float, shape (n_channels, n_steps)
        In the units of the channels.
    rate : float or None
        Samples per second, where the file says it [Hz].
    names, units : tuple of str
        Of the channels; a unit that the file does not say is empty.
    axes : tuple of str
        Directions that the format states; empty where the names must say.
    ranges : tuple of str
        What stands behind a name and looks like the range of a sensor, as ``40g``.
    whole : bool
        Whether they are shares of a full scale, as the whole numbers of a WAV file are.
    notes : tuple of str
        What was passed over or made good.
    begin : datetime or None
        Local time of the first sample; of year 1 where only the time of day is known.
    """

    samples: Float[Array, "channels steps"]
    rate: float | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    axes: tuple[str, ...] = ()
    ranges: tuple[str, ...] = ()
    whole: bool = False
    notes: tuple[str, ...] = ()
    begin: datetime | None = None

    def chosen(self, which: list[int]) -> RawRecord:
        """Return some of the channels, in that order."""

        def pick(values: tuple[str, ...]) -> tuple[str, ...]:
            """Return the chosen ones of some values, or none if there are none."""
            return tuple(values[i] for i in which) if values else ()

        return replace(
            self,
            samples=np.asarray(self.samples)[which],
            names=pick(self.names),
            units=pick(self.units),
            axes=pick(self.axes),
            ranges=pick(self.ranges),
        )
