"""Read WAV files."""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from trundle.errors import InputError
from trundle.records.raw import RawRecord
from trundle.records.record_format import RecordFormat

__all__ = ["FORMAT", "read_wav"]


def read_wav(data: bytes, path: Path) -> RawRecord:
    """Read a WAV file: whole numbers are shares of a full scale.

    Parameters
    ----------
    data : bytes
        The file.
    path : Path
        Its name, for messages.

    Raises
    ------
    InputError
        A damaged file, or one that is cut short.
    """
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            rate, samples = wavfile.read(io.BytesIO(data))
    except Exception as error:  # its parser raises whatever it meets
        raise InputError(
            f"{path}: is a damaged WAV file ({error or type(error).__name__})"
        ) from None
    if any("EOF" in str(one.message) for one in told):
        raise InputError(f"{path}: is cut short: it holds less than its head says; copy it again")
    samples = np.atleast_2d(np.asarray(samples).T)
    if samples.dtype.kind not in "iuf" or not rate > 0:
        raise InputError(f"{path}: is a damaged WAV file (no samples, or no rate)")
    whole = samples.dtype.kind in "iu"
    if whole:
        offset = 128.0 if samples.dtype == np.uint8 else 0.0
        full = 128.0 if samples.dtype == np.uint8 else -float(np.iinfo(samples.dtype).min)
        samples = samples - offset
        samples /= full  # in place: of a long record a copy is large
    with np.errstate(invalid="ignore"):  # of damaged floats, which are found to be no numbers
        samples = samples.astype(float, copy=False)
    return RawRecord(
        samples=samples,
        rate=float(rate),
        names=tuple(f"channel {i + 1}" for i in range(len(samples))),
        units=("",) * len(samples),
        whole=whole,
    )


FORMAT = RecordFormat(
    name="WAV",
    suffixes=(".wav",),
    claims=lambda data: data[:4] in {b"RIFF", b"RIFX", b"RF64"} and data[8:12] == b"WAVE",
    read=lambda data, path, _wanted: read_wav(data, path),
    full_scale=True,
)
