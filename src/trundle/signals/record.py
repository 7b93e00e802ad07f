"""Hold a measured record."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from datetime import datetime
from typing import Literal, TypeAlias, get_args

import numpy as np
from jaxtyping import Float

from trundle._checks import frozen_array, one_of, positive, set_frozen
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError

__all__ = ["Axis", "Record", "RecordQuantity", "axis_of", "channel_fault"]

RecordQuantity: TypeAlias = Literal["acceleration", "velocity"]
"""What a sensor measured."""

Axis: TypeAlias = Literal["vertical", "horizontal", ""]
"""Direction of a channel; empty where nobody says."""

_IMPLAUSIBLE = 1e4  # m/s2 or m/s
_PERIODS = 8.0  # of a band's mid-frequency, that a record must hold to show it
_LEAST = 32  # samples
_LONGEST = 60  # letters of a name
_SLOWEST = 2.5  # samples per second: 1 Hz is the lowest band

_OF = r"(?:^|[^a-z])(?:a|v|acc|accel|acceleration|vel|velocity)?[ _.-]*"
_VERTICAL = re.compile(
    _OF + r"(?:z|vert|vertical|vertikal|verticale|up|ud)(?:$|[^a-z])|(?:^|[ ._])[a-z][hnl]z$",
    re.IGNORECASE,
)
# N and E alone, or behind what they are of: "hall E" and "point N" are places, and a place that is
# weighted as if it moved sideways would pass what it must not
_SIDEWAYS = re.compile(
    _OF + r"(?:x|y|hor|horizontal|lateral|longitudinal|radial|transverse)(?:$|[^a-z])"
    r"|^(?:a|v|acc|vel)?[_.-]?(?:n|e|ns|ew|north|east)$|(?:^|[ ._])[a-z][hnl][ne12]$",
    re.IGNORECASE,
)


def axis_of(name: str) -> Axis:
    """Return the direction that a channel's name says: ``Z``, ``acc_z``, ``HHN``, ``vertical``.

    Examples
    --------
    >>> axis_of("acc_z [g]"), axis_of("IU.ANMO.00.BHN"), axis_of("hall 3")
    ('vertical', 'horizontal', '')
    """
    up, sideways = _VERTICAL.search(name), _SIDEWAYS.search(name)
    if bool(up) == bool(sideways):
        return ""
    return "vertical" if up else "horizontal"


@dataclass(frozen=True, kw_only=True, eq=False)
class Record:
    """Hold what some sensors measured together.

    Attributes
    ----------
    samples : ndarray of float, shape (n_channels, n_steps)
        Acceleration [m/s2] or velocity [m/s].
    sampling_frequency : float
        Samples per second [Hz].
    quantity : {"acceleration", "velocity"}
        What they are.
    channel_names : tuple of str
        Names of the channels; equal ones are numbered.
    source : str
        Where the record is from.
    axes : tuple of {"vertical", "horizontal", ""}
        Directions of the channels; as their names say unless given.
    notes : tuple of FitnessWarning
        What was passed over or made good when it was read.
    begin : datetime or None
        Local time of the first sample; of year 1 where only the time of day is known.
    """

    samples: Float[Array, "channels steps"]
    sampling_frequency: float
    quantity: RecordQuantity
    channel_names: tuple[str, ...]
    source: str = "record"
    axes: tuple[Axis, ...] = ()
    notes: tuple[FitnessWarning, ...] = ()
    begin: datetime | None = None

    def __post_init__(self) -> None:
        """Refuse samples that are no record: not finite, too few, a channel that never moves."""
        one_of("quantity", self.quantity, get_args(RecordQuantity))
        fs = positive("sampling_frequency", self.sampling_frequency)
        axes = self.axes or tuple(axis_of(name) for name in self.channel_names)
        for axis in axes:
            one_of("axes", axis, get_args(Axis))
        names = _told_apart(self.channel_names)
        samples = np.asarray(self.samples, dtype=float)
        for name, row in zip(names, samples, strict=True):
            if fault := channel_fault(row, fs):
                raise InputError(f"{self.source}: channel {name!r} {fault}")
        samples = frozen_array("samples", samples, shape=(len(names), None))
        if len(axes) != len(names):
            raise InputError(f"axes: {len(names)} are needed, one for each channel")
        _check_length(samples.shape[1], fs, self.source)
        set_frozen(self, samples=samples, sampling_frequency=fs, channel_names=names, axes=axes)

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return self.samples.shape[1] / self.sampling_frequency

    @property
    def lowest_frequency(self) -> float:
        """Lowest mid-band frequency of which the record holds 8 periods [Hz]."""
        return _PERIODS / self.duration


def channel_fault(row: Float[Array, " steps"], fs: float) -> str:
    """Say why a channel cannot be assessed; nothing where it can."""
    bad = np.flatnonzero(~np.isfinite(row))
    if len(bad):
        return (
            f"has {len(bad)} samples that are not numbers, the first at {bad[0] / fs:.4g} s; cut "
            "the gap out, or export the record again"
        )
    if len(row) and float(np.abs(row).max()) > _IMPLAUSIBLE:
        return (
            f"reaches {np.abs(row).max():.3g} in SI units, which no floor does; mind its unit, "
            "scale or sensitivity"
        )
    if len(row) and np.ptp(row) == 0.0:
        return "never moves; leave it out, or mend its cable"
    return ""


def _check_length(n: int, fs: float, source: str) -> None:
    if n < _LEAST:
        raise InputError(f"{source}: {n} samples are too few; give {_LEAST} samples or more")
    if fs < _SLOWEST:
        raise InputError(
            f"{source}: {fs:g} Hz shows no band from 1 Hz up; sample at {_SLOWEST:g} Hz at least, "
            "200 Hz or more shows all"
        )
    if n < 2.0 * fs:
        raise InputError(
            f"{source}: {n} samples at {fs:g} Hz are {n / fs:.3g} s, too short for a level over "
            f"1 s; give 2 s or more, {int(np.ceil(2.0 * fs))} samples"
        )


def _shown(name: str) -> str:
    """Return a name without what would steer a terminal, and not longer than a line."""
    plain = "".join(c if c.isprintable() else "?" for c in name)
    return plain if len(plain) <= _LONGEST else plain[: _LONGEST - 3] + "..."


def _told_apart(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names, equal ones numbered; of letters that a screen shows, and short."""
    names = tuple(_shown(name) for name in names)
    often, seen, found = Counter(names), Counter[str](), []
    for name in names:
        seen[name] += 1
        found.append(name if often[name] == 1 else f"{name} ({seen[name]})")
    return (
        tuple(found)
        if len(set(found)) == len(names)
        else tuple(f"{name} ({i + 1})" for i, name in enumerate(names))
    )
