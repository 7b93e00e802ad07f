"""Read a user's own criteria, from TOML or CSV, with their units."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from trundle.criteria import BY_FREQUENCY, Criterion
from trundle.errors import InputError, StudyError
from trundle.study_file.lines import parse, rows_of
from trundle.units import to_si

__all__ = ["read_criteria"]

_LARGEST = 1_000_000  # bytes
_DIMENSION = {
    "band_rms_velocity": "speed",
    "band_rms_acceleration": "acceleration",
    "band_rms_displacement": "length",
    "band_peak_acceleration": "acceleration",
    "narrow_band_acceleration": "acceleration",
    "peak_acceleration": "acceleration",
    "response_factor": "ratio",
    "vdv": "ratio",
}
_KEYS = ("name", "title", "quantity", "axis", "averaging", "source", "confidence", "aliases")
_EXAMPLE = 'points = [["1 Hz", "0.1 gal"], ["100 Hz", "0.1 gal"]]'


def read_criteria(path: Path) -> tuple[Criterion, ...]:
    """Read the criteria of a file.

    Parameters
    ----------
    path : Path
        A TOML file with a ``[[curve]]`` for each criterion (name, quantity, points with units), or
        a CSV file of one curve: lines ``# quantity = band_rms_velocity`` first, then a heading such
        as ``frequency [Hz], limit [um/s]``, then numbers. Its name is that of the file.

    Raises
    ------
    InputError
        A file that cannot be read; a curve that is none, with its place and a remedy.
    """
    try:
        if path.exists() and not path.is_file():
            raise InputError(f"{path}: is a folder, a device or a pipe, and no criteria file")
        with path.open("rb") as opened:
            raw = opened.read(_LARGEST + 1)
        if len(raw) > _LARGEST:
            raise InputError(f"{path}: a criteria file is at most 1 MB")
        text = raw.decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise InputError(f"{path}: cannot be read ({reason})") from None
    if path.suffix.lower() == ".csv":
        try:
            return (_from_csv(text, path),)
        except csv.Error as error:  # a field of 100 kB, say
            raise InputError(f"{path}: is no table of a criterion ({error})") from None
    return _from_toml(text, path)


def _from_toml(text: str, path: Path) -> tuple[Criterion, ...]:
    try:
        data = parse(text, str(path))
    except StudyError as error:
        (problem,) = error.problems
        at = "" if problem.line is None else f"line {problem.line}: "
        raise InputError(f"{path}: {at}{problem.rule}; got {problem.value}") from None
    curves = data.get("curve")
    if not isinstance(curves, list) or not curves:
        raise InputError(f"{path}: holds no criterion; write [[curve]] for each")
    found = []
    for i, entry in enumerate(curves):
        place = f"{path}: curve[{i + 1}]"
        if not isinstance(entry, Mapping):
            raise InputError(f"{place}: must be a table; write [[curve]]")
        points = entry.get("points")
        if not isinstance(points, list) or not all(
            isinstance(p, list) and len(p) == 2 for p in points
        ):
            raise InputError(
                f"{place}.points: pairs of frequency and limit are required: {_EXAMPLE}"
            )
        found.append(_criterion(entry, points, place))
    return tuple(found)


def _from_csv(text: str, path: Path) -> Criterion:
    lines = rows_of(text)
    notes = [line.lstrip("# ") for line in lines if line.startswith("#")]
    entry: dict[str, Any] = {"name": path.stem}
    entry |= {k.strip(): v.strip() for k, _, v in (note.partition("=") for note in notes) if v}
    rows = list(csv.reader(line for line in lines if line.strip() and not line.startswith("#")))
    if len(rows) < 3 or any(len(row) != 2 for row in rows):
        raise InputError(
            f"{path}: a curve is a heading and two or more rows of two columns, such as "
            "'frequency [Hz], limit [um/s]' and '1, 50'"
        )
    units = [_unit(heading, path) for heading in rows[0]]
    if entry.get("quantity") == "vdv" and units[1].replace("^", "").replace("**", "") == "m/s1.75":
        units[1] = "1"  # a dose's unit is no power of whole numbers, and has one spelling
    if units[1] == "1":
        units[1] = ""
    points = [
        [f"{v.strip()} {u}".strip() for v, u in zip(row, units, strict=True)] for row in rows[1:]
    ]
    return _criterion(entry, points, str(path))


def _unit(heading: str, path: Path) -> str:
    before, bracket, rest = heading.partition("[")
    if not bracket or not rest.strip().endswith("]"):
        raise InputError(
            f"{path}: heading {before.strip()!r} needs its unit in brackets, as 'limit [um/s]'"
        )
    return rest.strip()[:-1].strip()


def _criterion(entry: Mapping[str, Any], points: list[list[Any]], place: str) -> Criterion:
    unknown = sorted(set(entry) - {*_KEYS, "points"})
    if unknown:
        raise InputError(f"{place}: unknown key {unknown[0]!r}; known keys: {', '.join(_KEYS)}")
    quantity, name = str(entry.get("quantity", "")), str(entry.get("name", "")).strip()
    if quantity not in _DIMENSION:
        raise InputError(
            f"{place}.quantity: got {quantity!r}; it must be one of {', '.join(_DIMENSION)}"
        )
    if not name:
        raise InputError(f"{place}.name: a criterion needs a name")
    values = np.array(
        [
            [
                _value(f, "frequency", f"{place}.points[{i + 1}]"),
                _value(limit, _DIMENSION[quantity], f"{place}.points[{i + 1}]"),
            ]
            for i, (f, limit) in enumerate(points)
        ]
    )
    if quantity not in BY_FREQUENCY and np.ptp(values[:, 1]) > 0.0:
        raise InputError(f"{place}: {quantity} is a single number; all limits must be the same")
    try:
        return Criterion(
            name=name,
            title=str(entry.get("title", name)),
            quantity=quantity,  # pyright: ignore[reportArgumentType] - checked above
            frequencies=values[:, 0],
            limits=values[:, 1],
            axis=str(entry.get("axis", "vertical")).strip().lower(),
            averaging=str(entry.get("averaging", "as the study says")),
            source=str(
                entry.get("source", f"the user's file {Path(place.partition(':')[0]).name}")
            ),
            confidence=str(entry.get("confidence", "the user's own")),
            aliases=_aliases(entry.get("aliases", []), place),
        )
    except InputError as error:
        raise InputError(f"{place}: {error}") from None


def _aliases(given: object, place: str) -> tuple[str, ...]:
    if not isinstance(given, list):
        raise InputError(f"{place}.aliases: must be a list of names, such as ['maker A']")
    return tuple(map(str, given))


def _value(text: object, dimension: str, place: str) -> float:
    try:
        return to_si(text, dimension)
    except InputError as error:
        raise InputError(f"{place}: got {text!r}; {error}") from None
