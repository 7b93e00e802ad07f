"""Say what files of other programs are, and what to do with them."""

from __future__ import annotations

__all__ = ["foreign"]

_FOREIGN: tuple[tuple[bytes, str], ...] = (
    (b"PK\x03\x04", "a spreadsheet or an archive: save the sheet as CSV, or unpack it"),
    (b"\x1f\x8b", "compressed by gzip: unpack it"),
    (b"BZh", "compressed by bzip2: unpack it"),
    (b"\xfd7zXZ", "compressed by xz: unpack it"),
    (b"\x89HDF", "an HDF5 or MATLAB 7.3 file: export it as CSV or UFF 58"),
    (b"MATLAB 5.0", "a MATLAB file: export it as CSV or UFF 58"),
    (b"TDSm", "a LabVIEW TDMS file: export it as CSV"),
    (b"\x1aE\xdf\xa3", "an IDE recording: export it as CSV with the program of its maker"),
    (b"\xd0\xcf\x11\xe0", "an old spreadsheet: save the sheet as CSV"),
    (b"\x80\x02", "a Python pickle, which is never opened"),
    (b"\x80\x03", "a Python pickle, which is never opened"),
    (b"\x80\x04", "a Python pickle, which is never opened"),
    (b"\x80\x05", "a Python pickle, which is never opened"),
    (b"\x93NUMPY", "a NumPy array: save it as CSV with a heading"),
    (b"fLaC", "a FLAC recording: save it as WAV"),
    (b"ID3", "an MP3 recording, which has lost what no one hears: record WAV"),
    (b"%PDF", "a PDF: ask for the numbers"),
)


def foreign(data: bytes) -> str:
    """Return what a file of no readable format is, and what to do; nothing if it is not known."""
    return next((told for start, told in _FOREIGN if data.startswith(start)), "")
