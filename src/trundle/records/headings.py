"""Read what stands above a table: names, units, ranges, the rate, the number of samples."""

from __future__ import annotations

import re
from dataclasses import dataclass

from trundle.errors import InputError
from trundle.records.raw import Facts
from trundle.units import motion_scale, to_si

__all__ = ["Heading", "facts_of", "is_fact", "is_unit", "read_heading", "tells_unit", "usual_unit"]

_BRACKETS = re.compile(
    r"^\s*(?P<name>.*?)\s*(\[(?P<square>[^\[\]]+)\]|\((?P<round>(?:[^()]|\([^()]*\))+)\))\s*$"
)
_BEHIND = re.compile(r"^\s*(?P<name>.*?)(?:\s+in\s+|\s*/\s+|\s+/\s*|,\s+)(?P<unit>\S.*?)\s*$")
_TAIL = re.compile(r"^\s*(?P<name>.*)[\s_](?P<unit>\S+)\s*$")
_OF_MOTION = re.compile(
    r"(?:^|[\s_.])(?:acc|accel|acceleration|beschl\w*|a|(?:acc)?[xyz]|a[xyz])(?:$|[\s_.\d])",
    re.IGNORECASE,
)
_RANGE = re.compile(r"^\s*(?:\+-|\+/-|±)?\s*\d[\d.,]*\s*\S.*$")
_SPELLINGS: tuple[tuple[str, str], ...] = (
    (r"^g['’]?s$|^G['’]?[sS]?$|^g_?n$", "g"),
    (r"^m[gG]['’]?[sS]?$|^milli-?g['’]?s?$", "mg"),
    (r"^[uµμ][gG]['’]?s?$|^micro-?g['’]?s?$", "ug"),
    (r"^ips$|^IPS$|^in/sec$", "inch/s"),
    (r"^ips2$|^in/s/s$|^in/sec\^?2$", "inch/s2"),
    (r"^m?kine$", "cm/s"),
    (r"^(?P<p>[munµμ]|k|c)?m[ .·*/]?s(?:ec)?\^?-2$", r"\g<p>m/s2"),
    (r"^(?P<p>[munµμ]|k|c)?m[ .·*/]?s(?:ec)?\^?-1$", r"\g<p>m/s"),
    (r"^(?P<p>[munµμ]|k|c)?m/s(?:ec)?/s(?:ec)?$", r"\g<p>m/s2"),
    (r"^(?P<p>[munµμ]|k|c)?m/\(?s(?:ec)?(?:\^|\*\*)?2\)?$", r"\g<p>m/s2"),
    (r"^(?P<p>[munµμ]|k|c)?m/s(?:ec)?$", r"\g<p>m/s"),
    (r"^mGal$|^mgal$", "milligal"),
    (r"^Gal$|^GAL$", "gal"),
)
_RATE = re.compile(
    r"^(?:sampl\w*[ _-]*(?:rate|freq\w*)|sampling|fs|f_s|abtast(?:rate|frequenz)|"
    r"messrate|rate|frequence d.echantillonnage)$",
    re.IGNORECASE,
)
_STEP = re.compile(
    r"^(?:delta[_ ]?[xt]|dt|sampl\w*[ _-]*(?:interval|period|time|step)|interval|"
    r"abtastintervall|time[ _-]*step)$",
    re.IGNORECASE,
)
_UNIT = re.compile(
    r"^(?:y[_ -]?)?units?(?:[_ -]?label)?$|^einheit(?:en)?$|^unité$|^unites?$", re.IGNORECASE
)
_COUNT = re.compile(
    r"^(?:n[_ ]?samples|samples|npts|(?:number|no\.?|total) (?:of )?samples|anzahl(?: \w+)?)$",
    re.IGNORECASE,
)
_PAIR = re.compile(r"^[\s#%;!/'\"]*(?P<key>[^:=,;\t]+?)\s*(?:[:=,;\t]\s*|\s{2,})(?P<value>.+)$")
_GROUPS = re.compile(r"\s*[1-9]\d{0,2}(?:[.,'’ \u00a0\u202f]\d{3})+(?![.,]?\d)")
"""Digits in threes, as those of thousands stand, with a mark or a blank between them."""

_SLOWEST, _FASTEST = 2.5, 1e5  # Hz: rates that show a band, and that sensors of floors have
_NUMBER = re.compile(r"^\s*(?P<number>[\d.,eE+-]+)\s*[,;]?\s*(?P<unit>[^\d\s,;]\S*)?")


@dataclass(frozen=True, kw_only=True)
class Heading:
    """Hold what a column's heading says.

    Attributes
    ----------
    name, unit : str
        Empty where it does not say.
    range : str
        What looks like the range of a sensor instead of a unit.
    """

    name: str
    unit: str = ""
    range: str = ""


def usual_unit(text: str) -> str:
    """Return a unit of motion as it is spelled in SI texts: ``ms-2``, ``g's``, ``ips``, ``kine``.

    Examples
    --------
    >>> usual_unit("m.s-2"), usual_unit("mG"), usual_unit("mm/s2")
    ('m/s2', 'mg', 'mm/s2')
    """
    unit = text.strip()
    for pattern, spelled in _SPELLINGS:
        match = re.match(pattern, unit)
        if match:
            prefix = (match.groupdict().get("p") or "") if "<p>" in spelled else ""
            found = spelled.replace(r"\g<p>", prefix)
            return f"0.001 {found}" if unit == "mkine" else found
    return unit


def is_unit(text: str) -> bool:
    """Return whether a word is a unit of time, motion or volts, or stands in brackets."""
    word = text.strip()
    inner = word.strip("()[]").strip()
    if (word[:1], word[-1:]) in {("(", ")"), ("[", "]")} or inner in {
        "s",
        "sec",
        "ms",
        "us",
        "µs",
        "min",
        "V",
        "mV",
        "°C",
        "counts",
        "count",
    }:
        return True
    return _is_motion(inner)


def tells_unit(cell: str) -> bool:
    """Return whether a heading of a column says a unit of motion or of time."""
    unit = read_heading(cell, 0).unit
    if _is_motion(unit):
        return True
    try:
        return bool(unit) and to_si(f"1 {unit}", "time") > 0.0
    except InputError:
        return False


def _is_motion(unit: str) -> bool:
    if not unit or unit[0].isdigit():
        return False
    try:
        motion_scale(usual_unit(unit))
    except InputError:
        return False
    return True


def read_heading(text: str, column: int) -> Heading:
    """Read ``z [mm/s2]``, ``Acc (g)``, ``a / (m/s²)``, ``a in g``, ``acc_g`` or ``X (40g)``."""
    fallback = f"channel {column + 1}"
    text = text.strip().strip('"').strip()
    match = _BRACKETS.match(text)
    if match is not None:
        inner = (match["square"] or match["round"]).strip()
        name = match["name"].strip(" /") or fallback
        if _RANGE.match(inner):
            return Heading(name=name, range=inner)
        return Heading(name=name, unit=inner)
    for pattern in (_BEHIND, _TAIL):
        match = pattern.match(text)
        if match is None or not match["name"].strip():
            continue
        name, unit = match["name"].strip(), match["unit"].strip("()")
        if _is_motion(unit) and (pattern is _BEHIND or not _is_letter(name, unit)):
            return Heading(name=name, unit=unit)
    return Heading(name=text or fallback)


def _is_letter(name: str, unit: str) -> bool:
    """Return whether a single letter behind a name counts places, as in Point G, and is no unit."""
    return len(unit) == 1 and (unit != "g" or _OF_MOTION.search(name) is None)


def is_fact(line: str) -> bool:
    """Return whether a line states a rate, a step, a unit or a number of samples."""
    match = _PAIR.match(line.strip())
    key = match["key"].strip().strip('"') if match else ""
    return any(pattern.match(key) for pattern in (_RATE, _STEP, _COUNT, _UNIT))


def facts_of(lines: list[str]) -> Facts:
    """Read what lines above a table say: ``Sample rate: 500 Hz``, ``unit = mg``."""
    rate = step = n_samples = None
    units, unclear = tuple[str, ...](), ""
    for line in lines:
        match = _PAIR.match(line.strip())
        if match is None:
            continue
        key, value = match["key"].strip().strip('"'), match["value"].strip().strip('"')
        number = _number(value)
        if (_RATE.match(key) or _STEP.match(key)) and _is_unclear(key, value):
            unclear = unclear or line.strip()
        elif _RATE.match(key) and number is not None:
            rate = rate or _in_hertz(*number)
        elif _STEP.match(key) and number is not None:
            step = step or _in_seconds(*number)
        elif _COUNT.match(key):
            n_samples = _count(value) or n_samples
        elif _UNIT.match(key):
            units = tuple(w.strip() for w in re.split(r"[\t;,]", value) if w.strip())
    if rate is None and step is not None:
        rate = 1.0 / step
    return Facts(rate=rate, units=units, n_samples=n_samples, unclear=unclear)


def _is_unclear(key: str, value: str) -> bool:
    """Return whether a rate or a step has thousands, or decimals that may be such.

    12,800 Hz is 12.8 Hz or 12800 Hz; 200.000 Hz is 200 Hz, for no sensor of floors has 200 kHz.
    """
    match = _GROUPS.match(value)
    if match is None or not {*match[0].strip()} & {".", ","}:
        return match is not None
    unit = _NUMBER.match("1" + value[match.end() :])
    number, of = float(re.sub(r"\D", "", match[0])), (unit["unit"] or "") if unit else ""
    step = None if _RATE.match(key) else _in_seconds(number, of)
    rate = _in_hertz(number, of) if step is None else 1.0 / step
    return rate is not None and _SLOWEST <= rate < _FASTEST


def _count(value: str) -> int | None:
    """Return a whole number of samples, whatever stands between its thousands."""
    if match := _GROUPS.match(value):
        return int(re.sub(r"\D", "", match[0]))
    number = _number(value)
    return int(number[0]) if number is not None and number[0] == round(number[0]) else None


def _number(text: str) -> tuple[float, str] | None:
    match = _NUMBER.match(text)
    if match is None:
        return None
    try:
        number = float(match["number"].rstrip(",;").replace(",", "."))
    except ValueError:
        return None
    return (number, match["unit"] or "") if number > 0.0 else None


def _in_hertz(number: float, unit: str) -> float | None:
    unit = {"": "Hz", "sps": "Hz", "s/s": "Hz", "hz": "Hz", "khz": "kHz"}.get(unit.lower(), unit)
    try:
        return to_si(f"{number:.17g} {unit}", "frequency")
    except InputError:
        return None


def _in_seconds(number: float, unit: str) -> float | None:
    try:
        return to_si(f"{number:.17g} {unit or 's'}", "time")
    except InputError:
        return None
