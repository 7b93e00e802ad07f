"""Hold criterion curves as data, with source and range."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, one_of, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.response import SpectrumQuantity
from trundle.signals import mid_band_frequencies

__all__ = [
    "BY_FREQUENCY",
    "VC",
    "Criterion",
    "Quantity",
    "Shape",
    "all_criteria",
    "find_criterion",
    "shaped",
    "told_apart",
]

Quantity: TypeAlias = SpectrumQuantity | Literal["peak_acceleration", "response_factor", "vdv"]
"""What a curve limits: RMS velocity, acceleration or displacement in one-third-octave bands;
0-peak acceleration in such a band, on lines of 1 Hz, or of the whole signal; the response factor
of a person; the vibration dose value."""

BY_FREQUENCY: tuple[str, ...] = get_args(SpectrumQuantity)
"""Quantities that have a value at each frequency; the others are single numbers."""

_SINGLE = ("peak_acceleration", "response_factor", "vdv")
_FILES = ("vc.toml", "acceleration.toml", "equipment.toml", "people.toml")


Shape: TypeAlias = Literal["rising", "flat"]
"""What generic curves do below 8 Hz: rise towards 4 Hz, or stay as they are down to 1 Hz."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Criterion:
    """Hold one limit curve.

    Attributes
    ----------
    name, title : str
        Short name for study files, and title for reports.
    quantity : Quantity
        What it limits.
    frequencies : ndarray of float, shape (n_points,)
        Corner frequencies, rising [Hz].
    limits : ndarray of float, shape (n_points,)
        Limits there in SI units; straight between corners on log-log axes.
    axis : str
        Direction that it is meant for.
    averaging : str
        Averaging rule of its values.
    source, confidence : str
        Where the numbers come from, and how sure they are.
    aliases : tuple of str
        Other names.
    """

    name: str
    title: str
    quantity: Quantity
    frequencies: Float[Array, " points"]
    limits: Float[Array, " points"]
    axis: str
    averaging: str
    source: str
    confidence: str
    aliases: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Freeze the corners; the last of a level end may be at infinity."""
        one_of("axis", self.axis, ("vertical", "horizontal", "each axis"))
        one_of("quantity", self.quantity, (*BY_FREQUENCY, *_SINGLE))
        frequencies = np.array(self.frequencies, dtype=float)
        if len(frequencies) < 2 or not np.all(frequencies[1:] > frequencies[:-1]):
            raise InputError(f"criterion {self.name!r}: frequencies must rise, and be numbers")
        frequencies.setflags(write=False)
        limits = frozen_array("limits", self.limits, shape=frequencies.shape)
        if np.any(limits <= 0.0):
            raise InputError(f"criterion {self.name!r}: limits must be greater than 0")
        set_frozen(self, frequencies=frequencies, limits=limits)
        self._check_shape()

    def _check_shape(self) -> None:
        """Refuse limits that no straight line on logarithmic axes joins, or nothing compares."""
        frequencies, differ = self.frequencies, bool(np.ptp(self.limits) > 0.0)
        if frequencies[0] < 0.0 or (frequencies[0] == 0.0 and differ):
            raise InputError(
                f"criterion {self.name!r}: frequencies must be above 0, for limits are straight on "
                "logarithmic axes"
            )
        if np.isinf(frequencies[-1]) and self.limits[-1] != self.limits[-2]:
            raise InputError(
                f"criterion {self.name!r}: no line goes from {self.limits[-2]:g} to "
                f"{self.limits[-1]:g} at infinity; give the frequency where it ends"
            )
        if self.quantity in _SINGLE and differ:
            raise InputError(
                f"criterion {self.name!r}: a {self.quantity} is one number and has one limit; got "
                f"{self.limits.min():g} and {self.limits.max():g}: give a criterion for each"
            )

    def limit(self, f: Float[Array, " lines"]) -> Float[Array, " lines"]:
        """Return the limit at frequencies [Hz]; NaN outside the curve's range."""
        f = np.asarray(f, float)
        # A band belongs to the curve when its nominal frequency does: 79.4 Hz is "80 Hz".
        inside = (f >= self.frequencies[0] * 0.98) & (f <= self.frequencies[-1] * 1.02)
        if np.ptp(self.limits) == 0.0:
            return np.where(inside, self.limits[0], np.nan)
        value = np.exp(np.interp(np.log(f), np.log(self.frequencies), np.log(self.limits)))
        return np.where(inside, value, np.nan)

    def bands_beyond(self) -> Float[Array, " bands"]:
        """Return mid-bands of its range that are never computed: below 1 Hz, above 80 Hz."""
        outside = np.concatenate([mid_band_frequencies(-10, -1), mid_band_frequencies(20, 23)])
        return outside[np.isfinite(self.limit(outside))]

    @property
    def rises(self) -> bool:
        """Whether it is a generic curve whose limit of 8 Hz is doubled towards 4 Hz."""
        ends = self.limit(np.array([4.0, 8.0]))
        return bool(
            self.quantity == "band_rms_velocity"
            and np.isclose(self.frequencies[0], 4.0)
            and np.isclose(ends[0], 2.0 * ends[1])
        )

    def flattened(self) -> Criterion:
        """Return the curve with its value at 8 Hz held constant down to 1 Hz.

        This is the paper's second branch, for equipment with pneumatic isolation.
        """
        level = float(self.limit(np.array([8.0]))[0])
        return replace(
            self,
            title=f"{self.title} (flat to 1 Hz)",
            frequencies=np.array([1.0, self.frequencies[-1]]),
            limits=np.array([level, level]),
        )


def shaped(criteria: Iterable[Criterion], shape: Shape) -> tuple[Criterion, ...]:
    """Return criteria with the generic curves that rise below 8 Hz as they are, or flat.

    Parameters
    ----------
    criteria : iterable of Criterion
        The curves.
    shape : {"rising", "flat"}
        ``flat`` for equipment on pneumatic isolation.
    """
    one_of("shape", shape, get_args(Shape))
    return tuple(c.flattened() if shape == "flat" and c.rises else c for c in criteria)


def told_apart(criteria: Iterable[Criterion]) -> tuple[Criterion, ...]:
    """Return criteria whose titles differ: to a title that several have each adds its name.

    A user's curve may be titled as one that ships with trundle, and readers go by titles.
    """
    every = tuple(criteria)
    titles = Counter(c.title for c in every)
    return tuple(
        replace(c, title=f"{c.title} ({c.name})") if titles[c.title] > 1 else c for c in every
    )


@cache
def all_criteria() -> tuple[Criterion, ...]:
    """Return every criterion that ships with trundle, in the order of its files."""
    return tuple(curve for name in _FILES for curve in _read(name))


def find_criterion(name: str, own: Iterable[Criterion] = ()) -> Criterion:
    """Return a criterion by name or alias, in any case.

    Parameters
    ----------
    name : str
        Name or alias.
    own : iterable of Criterion
        The user's own criteria; they come before those that ship with trundle.

    Raises
    ------
    InputError
        No such criterion; the message lists what there is.
    """
    wanted = name.strip().lower()
    every = (*own, *all_criteria())
    for criterion in every:
        if wanted in {known.lower() for known in (criterion.name, *criterion.aliases)}:
            return criterion
    known = ", ".join(criterion.name for criterion in every)
    raise InputError(f"no criterion {name!r}; there are {known}")


def _read(file: str) -> Iterable[Criterion]:
    text = resources.files("trundle.criteria").joinpath("data", file).read_text("utf-8")
    data = tomllib.loads(text)
    for entry in data["curve"]:
        values = {**data["common"], **entry}
        points = np.array(values.pop("points"), dtype=float)
        values["aliases"] = tuple(values["aliases"])
        yield Criterion(frequencies=points[:, 0], limits=points[:, 1], **values)


VC_NAMES = (
    "workshop",
    "office",
    "residential-day",
    "operating-theatre",
    "VC-A",
    "VC-B",
    "VC-C",
    "VC-D",
    "VC-E",
)

VC: tuple[Criterion, ...] = tuple(find_criterion(name) for name in VC_NAMES)
"""The nine generic curves, widest first."""
