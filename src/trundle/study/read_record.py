"""Read measured records from CSV, WAV, UFF 58 and miniSEED files, with their units."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from trundle._typing import Array
from trundle.errors import InputError
from trundle.signals import Record, RecordQuantity
from trundle.study.read_csv import RawRecord, even_rate, read_csv
from trundle.units import motion_scale, to_si

__all__ = ["RecordOptions", "read_record"]

_LARGEST = 2_000_000_000  # bytes
_MISMATCH = 0.005  # relative, between a stated rate and that of the time stamps
_UFF_ORDINATE = {11: "m/s", 12: "m/s2"}  # codes of what the samples are, of dataset 58


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
    """

    unit: str = ""
    rate: str = ""
    sensitivity: str = ""
    full_scale: str = ""


def read_record(path: Path, options: RecordOptions) -> Record:
    """Read a record into SI units.

    Parameters
    ----------
    path : Path
        A CSV, TXT, WAV, UFF, UNV or miniSEED file.
    options : RecordOptions
        Units, rate and sensitivity, where the file does not say them.

    Raises
    ------
    InputError
        A file that cannot be read, has gaps or uneven time stamps, or whose unit is not known.
    """
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder; name the record in it")
        if not path.is_file():
            raise InputError(f"{path}: no such file")
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path}: a record is at most 2 GB; cut it into events")
        raw = _READERS.get(path.suffix.lower(), read_csv)(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from None
    samples, quantity = _in_si(raw, options, path)
    return Record(
        samples=samples,
        sampling_frequency=_rate(raw, options, path),
        quantity=quantity,
        channel_names=raw.names,
        source=path.name,
    )


def _rate(raw: RawRecord, options: RecordOptions, path: Path) -> float:
    stated = to_si(options.rate, "frequency") if options.rate else None
    if raw.rate is None and stated is None:
        raise InputError(f"{path}: has no time column; say its rate: --rate '500 Hz'")
    if raw.rate is None or stated is None:
        return float(raw.rate or stated or 0.0)
    if abs(stated / raw.rate - 1.0) > _MISMATCH:
        raise InputError(
            f"{path}: its own time says {raw.rate:.5g} Hz, and --rate {stated:.5g} Hz; one is wrong"
        )
    return float(raw.rate)


def _unit(own: str, options: RecordOptions, path: Path, name: str) -> str:
    """Return the unit of a channel; what file and command line say must not differ."""
    wav = path.suffix.lower() == ".wav"
    if options.full_scale and not wav:
        raise InputError(f"{path}: --full-scale is for WAV files; say --unit")
    if options.full_scale and options.unit:
        raise InputError(f"{path}: --full-scale says the unit too; leave --unit out")
    if own and options.unit and own != options.unit:
        raise InputError(
            f"{path}: channel {name!r} is in {own!r} by its heading, and --unit says "
            f"{options.unit!r}; leave one out"
        )
    return options.full_scale or own or options.unit


def _in_si(raw: RawRecord, options: RecordOptions, path: Path) -> tuple[Array, RecordQuantity]:
    if raw.whole and not options.full_scale:
        raise InputError(
            f"{path}: its numbers are shares of a full scale; say what that is: "
            "--full-scale '20 m/s2', or in volts with a --sensitivity"
        )
    scales, quantities = [], set[RecordQuantity]()
    for name, own in zip(raw.names, raw.units, strict=True):
        unit = _unit(own, options, path, name)
        if not unit:
            raise InputError(
                f"{path}: the unit of channel {name!r} is not known; write it in the heading as "
                "'name [mm/s2]', or say --unit (a WAV file: --full-scale '20 m/s2')"
            )
        try:
            scale, quantity = motion_scale(unit, options.sensitivity)
        except InputError as error:
            raise InputError(f"{path}: channel {name!r}: {error}") from None
        scales.append(scale)
        quantities.add(quantity)
    if len(quantities) > 1:
        raise InputError(f"{path}: channels of acceleration and of velocity; assess them apart")
    return raw.samples * np.array(scales)[:, None], quantities.pop()


def _read_wav(path: Path) -> RawRecord:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # chunks of other programs
            rate, data = wavfile.read(path)
    except ValueError as error:
        raise InputError(f"{path}: is no WAV file ({error})") from None
    data = np.atleast_2d(np.asarray(data).T)
    whole = np.issubdtype(data.dtype, np.integer)
    if whole:
        offset = 128.0 if data.dtype == np.uint8 else 0.0
        data = (data - offset) / (
            128.0 if data.dtype == np.uint8 else -float(np.iinfo(data.dtype).min)
        )
    names = tuple(f"channel {i + 1}" for i in range(len(data)))
    return RawRecord(
        samples=data.astype(float),
        rate=float(rate),
        names=names,
        units=("",) * len(data),
        whole=whole,
    )


def _read_uff(path: Path) -> RawRecord:
    try:
        import pyuff  # noqa: PLC0415 - an extra
    except ImportError:
        raise InputError(f"{path}: UFF files need pyuff: pip install 'trundle[records]'") from None
    try:
        sets = pyuff.UFF(str(path)).read_sets()
    except Exception as error:  # its reader raises whatever its parsing meets
        raise InputError(f"{path}: is no UFF file ({error})") from None
    found = [one for one in (sets if isinstance(sets, list) else [sets]) if one.get("type") == 58]
    found = [one for one in found if one.get("func_type") == 1 and not np.iscomplexobj(one["data"])]
    if not found:
        raise InputError(f"{path}: holds no time record (dataset 58, function type 1)")
    for one in found:
        if int(one.get("num_pts") or 0) != len(one["data"]):
            raise InputError(
                f"{path}: {_uff_name(one, 0)!r} says {one.get('num_pts')} samples and holds "
                f"{len(one['data'])}; export it again"
            )
    times = [_uff_time_scale(one, path) * np.asarray(one["x"], float) for one in found]
    rates = {round(even_rate(time, path), 6) for time in times}
    if len(rates) > 1 or len({len(time) for time in times}) > 1:
        raise InputError(f"{path}: its channels differ in rate or length; assess them apart")
    return RawRecord(
        samples=np.array([one["data"] for one in found], dtype=float),
        rate=rates.pop(),
        names=tuple(_uff_name(one, i) for i, one in enumerate(found)),
        units=tuple(_uff_unit(one) for one in found),
    )


def _uff_time_scale(one: dict[str, object], path: Path) -> float:
    label = str(one.get("abscissa_axis_units_lab") or "").strip()
    if not label or label.upper() == "NONE":
        return 1.0
    try:
        return to_si(f"1 {label}", "time")
    except InputError as error:
        raise InputError(f"{path}: its abscissa is no time: {error}") from None


def _uff_name(one: dict[str, object], number: int) -> str:
    return str(one.get("id1") or "").strip() or f"channel {number + 1}"


def _uff_unit(one: dict[str, object]) -> str:
    label = str(one.get("ordinate_axis_units_lab") or "").strip()
    if label and label.upper() != "NONE":
        return label
    code = one.get("ordinate_spec_data_type")
    return _UFF_ORDINATE.get(code, "") if isinstance(code, int) else ""


def _read_miniseed(path: Path) -> RawRecord:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its imports use what Python is about to drop
            import obspy  # noqa: PLC0415 - an extra
    except ImportError:
        raise InputError(f"{path}: miniSEED needs obspy: pip install 'trundle[seismic]'") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stream = obspy.read(str(path))
            stream.merge()
    except Exception as error:  # its readers raise whatever their parsing meets
        raise InputError(f"{path}: is no miniSEED file ({error})") from None
    gaps = [trace.id for trace in stream if np.ma.isMaskedArray(trace.data)]
    if gaps:
        raise InputError(f"{path}: gaps in {', '.join(gaps)}; cut the record there")
    if len({(trace.stats.sampling_rate, len(trace.data)) for trace in stream}) > 1:
        raise InputError(f"{path}: its channels differ in rate or length; assess them apart")
    starts = [float(trace.stats.starttime) for trace in stream]
    if max(starts) - min(starts) > 0.5 / float(stream[0].stats.sampling_rate):
        raise InputError(f"{path}: its channels do not start together; assess them apart")
    return RawRecord(
        samples=np.array([trace.data for trace in stream], dtype=float),
        rate=float(stream[0].stats.sampling_rate),
        names=tuple(trace.id for trace in stream),
        units=("",) * len(stream),
    )


_READERS = {
    ".wav": _read_wav,
    ".uff": _read_uff,
    ".unv": _read_uff,
    ".mseed": _read_miniseed,
    ".miniseed": _read_miniseed,
    ".msd": _read_miniseed,
}
