"""Read a measured record of any format into SI units."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.records.channels import choose
from trundle.records.foreign import foreign
from trundle.records.headings import usual_unit
from trundle.records.raw import RawRecord
from trundle.records.record_format import all_formats, format_of
from trundle.records.stamps import clock_begin
from trundle.records.table import read_table
from trundle.signals import Axis, Record, RecordQuantity, axis_of, channel_fault
from trundle.units import motion_scale, to_si

__all__ = ["RecordOptions", "read_record"]

_LARGEST = 2_000_000_000  # bytes
_LARGEST_TEXT = 300_000_000  # bytes: lines, cells and levels take up to twelve times as much
_MISMATCH = 0.005  # relative, between a stated rate and that of the time stamps


@dataclass(frozen=True, kw_only=True)
class RecordOptions:
    """Hold what a file cannot say of itself.

    Attributes
    ----------
    unit : str
        Unit of the samples, as ``mm/s2``, or ``V`` with a sensitivity.
    rate : str
        Sampling rate, as ``500 Hz``.
    sensitivity : str
        Of the sensor, as ``10 V/(m/s2)`` or ``1000 mV/g``.
    full_scale : str
        What the largest number of a WAV file stands for, as ``20 m/s2`` or ``10 V``.
    channel : str
        Which channels: names, numbers from 1, units or ``vertical``, between commas; all if empty.
    start : str
        Local time of the first sample, as ``22:30`` or ``2024-05-03 22:30:00``.
    """

    unit: str = ""
    rate: str = ""
    sensitivity: str = ""
    full_scale: str = ""
    channel: str = ""
    start: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Motion:
    """The channels that can be used, in SI, and what is said of the others."""

    samples: Float[Array, "channels steps"]
    quantity: RecordQuantity
    names: tuple[str, ...]
    axes: tuple[Axis, ...]
    notes: tuple[FitnessWarning, ...]


@dataclass(frozen=True, kw_only=True)
class _Channel:
    """One channel in SI, or why it is passed over."""

    scale: float = 1.0
    quantity: RecordQuantity = "acceleration"
    problem: str = ""


def read_record(path: Path, options: RecordOptions) -> Record:
    """Read a record into SI units.

    The format is told by what is in the file. Channels that are no motion, or that cannot be used,
    are passed over by name as long as others can.

    Parameters
    ----------
    path : Path
        A text, WAV, UFF 58 or miniSEED file.
    options : RecordOptions
        Units, rate and sensitivity, where the file does not say them.

    Raises
    ------
    InputError
        A file that cannot be read, has gaps or uneven time stamps, or whose unit is not known.

    Notes
    -----
    Long records are large: the file's bytes and the samples in its units are let go as soon as
    nothing asks for them, so that two copies of the samples are held at most.
    """
    data = _bytes_of(path)
    kind = format_of(data)
    if options.full_scale and not (kind and kind.full_scale):
        raise InputError(f"{path}: --full-scale is for WAV files; say --unit")
    if options.full_scale and options.unit:
        raise InputError(f"{path}: --full-scale says the unit too; leave --unit out")
    stated, begin = _stated_rate(options.rate), _stated_start(options.start)
    raw = choose(_raw(data, path, options, stated), options.channel, str(path))
    del data
    if raw.whole and not options.full_scale:
        raise InputError(
            f"{path}: its numbers are shares of a full scale; say what that is: "
            "--full-scale '20 m/s2', or in volts with a --sensitivity"
        )
    rate = _rate(raw, stated, path)
    motion, begin = _motion(raw, rate, options, path), begin or raw.begin
    del raw
    return Record(
        samples=motion.samples,
        sampling_frequency=rate,
        quantity=motion.quantity,
        channel_names=motion.names,
        source="".join(c if c.isprintable() else "?" for c in path.name),
        axes=motion.axes,
        notes=motion.notes,
        begin=begin,
    )


def _stated_start(text: str) -> datetime | None:
    """Return the local time that the user says; None if he does not."""
    if not text:
        return None
    found = clock_begin([[text.strip()]])
    if found is None:
        raise InputError(
            f"--start {text!r}: must be a local time, as in '22:30' or '2024-05-03 22:30:00'"
        )
    return found


def _stated_rate(text: str) -> float | None:
    """Return the rate that the user says [Hz]; None if he does not."""
    if not text:
        return None
    try:
        rate = to_si(text, "frequency")
    except InputError as error:
        raise InputError(f"--rate {text!r}: {error}") from None
    if rate <= 0.0:
        raise InputError(f"--rate {text!r}: must be greater than 0")
    return rate


def _bytes_of(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder; name the record in it")
        if not path.exists():
            raise InputError(f"{path}: no such file")
        if not path.is_file():
            raise InputError(f"{path}: is no file but a device or a pipe")
        size = path.stat().st_size
        if size > _LARGEST:
            raise InputError(f"{path}: a record is at most 2 GB; cut it into events")
        with path.open("rb") as file:
            if size > _LARGEST_TEXT and format_of(file.read(512)) is None:
                raise InputError(f"{path}: a text is at most 300 MB; cut it into events")
            file.seek(0)
            return file.read(size + 1)  # as much as is asked for is set aside, read or not
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from None


def _raw(data: bytes, path: Path, options: RecordOptions, rate: float | None) -> RawRecord:
    if told := foreign(data):
        raise InputError(f"{path}: is {told}")
    if (kind := format_of(data)) is not None:
        return kind.read(data, path, options.channel)
    suffix = path.suffix.lower()
    if named := [one.name for one in all_formats() if suffix in one.suffixes]:
        raise InputError(f"{path}: is no {named[0]} file, whatever its name says")
    return read_table(data, path, rate=rate)


def _rate(raw: RawRecord, stated: float | None, path: Path) -> float:
    if raw.rate is None and stated is None:
        raise InputError(f"{path}: has no time column; say its rate: --rate '500 Hz'")
    if raw.rate is None or stated is None:
        return float(raw.rate or stated or 0.0)
    if abs(stated / raw.rate - 1.0) > _MISMATCH:
        raise InputError(
            f"{path}: its own time says {raw.rate:.5g} Hz, and --rate {stated:.5g} Hz; one is wrong"
        )
    return float(raw.rate)


def _motion(raw: RawRecord, rate: float, options: RecordOptions, path: Path) -> _Motion:
    """Return the channels in SI that can be used; refuse a file of which none can."""
    channels = [_channel(raw, i, options, rate) for i in range(len(raw.names))]
    sound = [i for i, one in enumerate(channels) if not one.problem]
    if not sound:
        raise InputError(f"{path}: channel {raw.names[0]!r} {channels[0].problem}")
    quantities: set[RecordQuantity] = {channels[i].quantity for i in sound}
    if len(quantities) > 1:
        raise InputError(
            f"{path}: channels of acceleration and of velocity; assess them apart, by --channel"
        )
    axes = raw.axes or ("",) * len(raw.names)
    notes = [FitnessWarning(subject="record", message=note) for note in raw.notes]
    notes += [
        FitnessWarning(subject=f"passed over, {raw.names[i]}", message=one.problem)
        for i, one in enumerate(channels)
        if one.problem
    ]
    samples = np.empty((len(sound), np.shape(raw.samples)[1]))
    for row, i in zip(samples, sound, strict=True):
        np.multiply(channels[i].scale, raw.samples[i], out=row)
    return _Motion(
        samples=samples,
        quantity=quantities.pop(),
        names=tuple(raw.names[i] for i in sound),
        axes=tuple(_axis(axes[i], raw.names[i]) for i in sound),
        notes=tuple(notes),
    )


def _axis(stated: str, name: str) -> Axis:
    if stated in {"vertical", "horizontal"}:
        return "vertical" if stated == "vertical" else "horizontal"
    return axis_of(name)


def _channel(raw: RawRecord, i: int, options: RecordOptions, rate: float) -> _Channel:
    """Return how a channel becomes SI, or why it cannot."""
    unit = _unit(raw, i, options)
    if not unit:
        return _Channel(problem=_unknown_unit(raw.ranges[i] if raw.ranges else ""))
    try:
        scale, quantity = motion_scale(usual_unit(unit), options.sensitivity)
    except InputError as error:
        said = (
            "" if unit == raw.units[i] else "--full-scale: " if options.full_scale else "--unit: "
        )
        return _Channel(problem=f"cannot be used: {said}{error}")
    fault = channel_fault(scale * raw.samples[i], rate)
    return _Channel(scale=scale, quantity=quantity, problem=fault)


def _unknown_unit(looks_like: str) -> str:
    """Say that the unit of a channel is not known, and how to say it."""
    if looks_like:
        return (
            f"has {looks_like!r} in its heading, which looks like the sensor's range and not like "
            "the unit of its samples; say that by --unit, as in --unit g"
        )
    return (
        "has no unit; write it in the heading as 'name [mm/s2]', or say --unit (a WAV file: "
        "--full-scale '20 m/s2')"
    )


def _is_usable(unit: str, options: RecordOptions) -> bool:
    try:
        motion_scale(usual_unit(unit), options.sensitivity)
    except InputError:
        return False
    return True


def _unit(raw: RawRecord, i: int, options: RecordOptions) -> str:
    """Return the unit of a channel; what file and command line say must not differ."""
    own = raw.units[i]
    if own and not _is_usable(own, options):
        return own  # of a temperature, say: it contradicts nothing, and is passed over
    if own and options.unit and usual_unit(own) != usual_unit(options.unit):
        raise InputError(
            f"{raw.names[i]!r} is in {own!r} by its heading, and --unit says {options.unit!r}; "
            "leave one out"
        )
    return options.full_scale or own or options.unit
