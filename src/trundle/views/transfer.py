"""Arrange transfer functions for tables, files and figures, in engineers' units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from jaxtyping import Complex, Float

from trundle._typing import Array
from trundle.simulate import TransferFunctions
from trundle.study.report_plan import ReportPlan
from trundle.units import PRINTED
from trundle.views.words import USUAL

__all__ = ["HEADING", "Curve", "Peak", "Quantity", "curves", "heading", "largest_peaks", "rows"]

Quantity: TypeAlias = Literal["receptance", "mobility", "accelerance"]
"""Displacement, velocity or acceleration over force."""

_UNITS: dict[Quantity, tuple[str, float]] = {
    "receptance": ("nm/N", 1e-9),
    "mobility": ("(um/s)/N", 1e-6),
    "accelerance": ("(mm/s2)/N", 1e-3),
}
"""Units of files, and of people whose study asks for none."""
_MOTION: dict[Quantity, str] = {
    "receptance": "displacement",
    "mobility": "velocity",
    "accelerance": "acceleration",
}
"""Of what a study's report chooses the unit."""
HEADING = ("from", "to", "frequency [Hz]", "real", "imaginary", "magnitude", "phase [deg]")
"""Columns of the table of a file; three of them have the quantity's unit."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """Hold the transfer function from one place to another.

    Attributes
    ----------
    load, point : str
        Where the force acts, and where motion is read.
    frequencies : ndarray of float, shape (n_lines,)
        [Hz].
    values : ndarray of complex, shape (n_lines,)
        In `unit`.
    unit : str
        Such as ``(um/s)/N``.
    """

    load: str
    point: str
    frequencies: Float[Array, " lines"]
    values: Complex[Array, " lines"]
    unit: str

    @property
    def magnitude(self) -> Float[Array, " lines"]:
        """Amplitude over amplitude."""
        return np.abs(self.values)

    @property
    def phase(self) -> Float[Array, " lines"]:
        """How far motion is ahead of the force, -180 to 180 [degrees]."""
        return np.degrees(np.angle(self.values))


@dataclass(frozen=True, kw_only=True)
class Peak:
    """Hold a peak of a curve.

    Attributes
    ----------
    load, point : str
        Of which curve.
    frequency : float
        [Hz].
    value : float
        Magnitude, in the curve's unit.
    at_end : bool
        Whether it is no peak but the range's end, beyond which the curve may rise further.
    """

    load: str
    point: str
    frequency: float
    value: float
    at_end: bool


def curves(
    functions: TransferFunctions, quantity: Quantity, report: ReportPlan = USUAL
) -> list[Curve]:
    """Return every transfer function, load by load.

    Parameters
    ----------
    functions : TransferFunctions
        What was found.
    quantity : Quantity
        Displacement, velocity or acceleration over force.
    report : ReportPlan
        Units that are asked for by name; where the motion's is not, that of `heading`.
    """
    unit, scale = _unit(quantity, report)
    values = getattr(functions, quantity) / scale
    return [
        Curve(
            load=load,
            point=point,
            frequencies=functions.frequencies,
            values=values[i, j],
            unit=unit,
        )
        for i, load in enumerate(functions.load_names)
        for j, point in enumerate(functions.point_names)
    ]


def _unit(quantity: Quantity, report: ReportPlan) -> tuple[str, float]:
    """Return the unit that people read a quantity in, and its size in SI."""
    motion = _MOTION[quantity]
    if motion not in report.chosen:
        return _UNITS[quantity]
    unit = getattr(report, motion)
    return (f"({unit})/N" if "/" in unit else f"{unit}/N"), PRINTED[unit]


def largest_peaks(curve: Curve, n: int = 3) -> list[Peak]:
    """Return the largest peaks of a curve, the largest first.

    Equal samples beside each other are one place, by the first of them. An end of the range is
    among them where it is the largest of all.
    """
    size = curve.magnitude
    first = np.flatnonzero(np.diff(size, prepend=np.nan) != 0.0)
    level = size[first]
    inside = first[1:-1][(level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])]
    ends = np.array([0, len(size) - 1])
    places = first[[0, -1]]
    found = np.union1d(inside, ends[(places == size.argmax()) & (size[ends] > 0.0)])
    found = found[np.argsort(-size[found], kind="stable")][:n]
    return [
        Peak(
            load=curve.load,
            point=curve.point,
            frequency=float(curve.frequencies[i]),
            value=float(size[i]),
            at_end=bool(i in ends),
        )
        for i in found
    ]


def heading(quantity: Quantity) -> tuple[str, ...]:
    """Return the columns of a file's `rows`, with units that are the same whatever people read."""
    unit = _UNITS[quantity][0]
    with_unit = {"real", "imaginary", "magnitude"}
    return tuple(f"{name} [{unit}]" if name in with_unit else name for name in HEADING)


def rows(some: list[Curve]) -> Iterator[tuple[str, str, float, float, float, float, float]]:
    """Give every line of every curve as a row of a table."""
    for curve in some:
        parts = (np.real(curve.values), np.imag(curve.values), curve.magnitude, curve.phase)
        table = np.column_stack([curve.frequencies, *parts])
        for f, real, imaginary, magnitude, phase in table.tolist():
            yield curve.load, curve.point, f, real, imaginary, magnitude, phase
