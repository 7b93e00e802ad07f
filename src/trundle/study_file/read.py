"""Read a study file and report every mistake in it at once."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any, cast

from pydantic import TypeAdapter, ValidationError

from trundle.errors import Problem, StudyError
from trundle.study_file.alternatives import by_likeness
from trundle.study_file.document import StudyFile
from trundle.study_file.fields import Section
from trundle.study_file.kinds import SectionKind
from trundle.study_file.lines import parse, shown_key
from trundle.study_file.rules import rule_of
from trundle.study_file.sections import KINDS
from trundle.study_file.sections.general import GeneralSection
from trundle.vehicle import RETIRED, VEHICLES

__all__ = ["read_study", "read_text"]

_LARGEST = 1_000_000  # bytes; a study is a page or two of text
_TABLES = {kind.name: kind for kind in KINDS if kind.form == "table"}
_NAMED_TABLES = {kind.name: kind.schema for kind in KINDS if kind.form == "named"}
_LISTS = {kind.name: kind.schema for kind in KINDS if kind.form == "list"}
_HEADERS = {kind.name: kind.header for kind in KINDS}
_REQUIRED = tuple(kind.name for kind in KINDS if kind.required)
_DRIVING = ("vehicle", "route", "road")
_SHAKING = tuple(kind.name for kind in KINDS if kind.shakes)
_GENERAL = tuple(GeneralSection.model_fields)


def read_study(path: Path) -> tuple[StudyFile, list[Problem]]:
    """Read a study file; return its sound sections, and a problem for each mistake.

    Raises
    ------
    StudyError
        A file that cannot be read as TOML text at all.
    """
    return read_text(_text_of(path), str(path).encode("utf-8", "replace").decode())


def read_text(text: str, source: str) -> tuple[StudyFile, list[Problem]]:
    """Check the text of a study file section by section."""
    data = parse(text, source)
    problems: list[Problem] = []
    known = (*_GENERAL, *_TABLES, *_NAMED_TABLES, *_LISTS)
    problems += [_unknown_key(key, data[key], known, "") for key in data if key not in known]
    problems += [_missing(name) for name in _needed(data) if name not in data]
    general = _section(GeneralSection, {k: data[k] for k in _GENERAL if k in data}, "", problems)
    tables = {
        name: section
        for name, kind in _TABLES.items()
        if name in data and (section := _table(kind, data[name], problems)) is not None
    }
    vehicles = _named(data, "vehicle", problems)
    lists = {name: _list(data, name, kind, problems) for name, kind in _LISTS.items()}
    study = StudyFile(
        source=source,
        text=text,
        general=general,
        tables=tables,
        vehicles=vehicles,
        lists=lists,
        declared=_declared(data),
        counts={k: len(data[k]) for k in _LISTS if isinstance(data.get(k), list)},
        given=frozenset(data),
        shaking=_SHAKING,
    )
    return study, problems


def _needed(data: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the sections that there must be: people and machines shake a floor by themselves."""
    alone = any(name in data for name in _SHAKING) and not any(k in data for k in _DRIVING)
    return tuple(name for name in _REQUIRED if not (alone and name in _DRIVING))


def _declared(data: Mapping[str, Any]) -> dict[str, set[str]]:
    declared: dict[str, set[str]] = {}
    for kind in _LISTS:
        entries = data.get(kind, [])
        tables = [e for e in entries if isinstance(e, dict)] if isinstance(entries, list) else []
        declared[kind] = {_printable(e["name"]) for e in tables if "name" in e}
    vehicles = data.get("vehicle", {})
    declared["vehicle"] = set(vehicles) if isinstance(vehicles, dict) else set()
    return declared


def _text_of(path: Path) -> str:
    def refuse(value: str, rule: str, remedy: str) -> StudyError:
        return StudyError(str(path), [Problem(place="file", value=value, rule=rule, remedy=remedy)])

    try:
        if path.is_dir():
            raise refuse("a folder", "a study is one TOML file", f"name the file in {path}")
        if path.exists() and not path.is_file():
            raise refuse("a device or pipe", "a study is a file", "name a TOML file")
        size = path.stat().st_size
        if size > _LARGEST:
            raise refuse(
                f"{size / 1e6:.1f} MB",
                "a study file is at most 1 MB",
                "name the study file, not a result or a record",
            )
        raw = path.read_bytes()
    except FileNotFoundError:
        raise refuse(
            "no such file", "the file must exist", "check the path, or make one with 'trundle new'"
        ) from None
    except OSError as error:
        raise refuse(
            error.strerror or str(error), "the file must be readable", "check its permissions"
        ) from None
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refuse(
            f"byte {error.start} is not UTF-8 text",
            "a study is a text file in UTF-8",
            "save it as UTF-8; is this a binary file?",
        ) from None
    if not text.strip():
        raise refuse(
            "an empty file",
            "a study needs at least a floor, a vehicle, a route, a road, a point and a method",
            "start from 'trundle new study.toml'",
        )
    return text


def _section(kind: Any, data: Any, place: str, problems: list[Problem]) -> Any:
    if not isinstance(data, Mapping):
        problems.append(
            Problem(
                place=place,
                value=_show(data),
                rule="must be a table",
                remedy=f"write its keys under [{place}]",
            )
        )
        return None
    try:
        return TypeAdapter(kind).validate_python(data)
    except ValidationError as error:
        given = [cast("dict[str, Any]", e) for e in error.errors()]
        errors = by_likeness(_without_tags(given, kind, data), data)
        inner = {e["loc"][:n] for e in errors for n in range(len(e["loc"]))}
        problems += [
            _problem(e, place, kind, data)
            for e in errors
            # a list is too short only because of the mistakes in it, which are told already
            if not (e["type"] == "too_short" and e["loc"] in inner)
        ]
        return None


def _table(kind: SectionKind, data: Any, problems: list[Problem]) -> Any:
    """Return a table's section; one that names no kind is of the usual one."""
    if kind.usual and isinstance(data, Mapping):
        data = {"kind": kind.usual, **data}
    return _section(kind.schema, data, kind.name, problems)


def _named(data: Mapping[str, Any], name: str, problems: list[Problem]) -> dict[str, Any]:
    tables = data.get(name, {})
    if not isinstance(tables, Mapping):
        problems.append(
            Problem(
                place=name,
                value=_show(tables),
                rule="must hold one table a name",
                remedy=f"write [{name}.truck] with its keys below",
            )
        )
        return {}
    if name in data and not tables:
        problems.append(_missing(name))
    sections = {}
    for key, table in tables.items():
        section = _section(_NAMED_TABLES[name], table, _path(name, [key]), problems)
        if section is not None:
            sections[key] = section
    return sections


def _list(
    data: Mapping[str, Any], name: str, kind: Any, problems: list[Problem]
) -> list[tuple[int, Any]]:
    entries = data.get(name, [])
    if not isinstance(entries, list):
        problems.append(
            Problem(
                place=name,
                value=_show(entries),
                rule="must be a list of tables",
                remedy=f"write [[{name}]] with double brackets",
            )
        )
        return []
    if name in data and not entries and name in _REQUIRED:
        problems.append(_missing(name))
    found = [
        (i, _section(kind, entry, f"{name}[{i + 1}]", problems)) for i, entry in enumerate(entries)
    ]
    return [(i, section) for i, section in found if section is not None]


def _problem(error: dict[str, Any], place: str, kind: Any, data: Mapping[str, Any]) -> Problem:
    location = list(error["loc"])
    path = _path(place, location)
    if error["type"] == "extra_forbidden":
        known = _fields_within(kind, data, location[:-1])
        return _unknown_key(str(location[-1]), error["input"], known, _path(place, location[:-1]))
    if error["type"] == "missing":
        remedy = "add one" if isinstance(location[-1], int) else f"add {location[-1]}"
        return Problem(place=path, value="nothing", rule="this is required", remedy=remedy)
    if error["type"] in {"union_tag_invalid", "union_tag_not_found"}:
        return Problem(
            place=_path(place, ["kind"]),
            value=_show(data["kind"]) if "kind" in data else "nothing",
            rule=f"must be one of {', '.join(_tag_names(kind))}",
            remedy=_kind_remedy(str(data.get("kind", "")), _tag_names(kind)),
        )
    return Problem(
        place=path,
        value=_show(error["input"]),
        rule="; or ".join([rule_of(error), *error.get("others", [])]),
        remedy=_remedy(error),
    )


def _remedy(error: dict[str, Any]) -> str:
    if error["type"] == "literal_error":
        options = str(error["ctx"]["expected"]).replace("'", "").replace(" or ", ", ").split(", ")
        return _did_you_mean(str(error["input"]), options)
    if error["type"] == "quantity":
        return "write a number and its unit in quotes"
    return "correct the value"


def _kind_remedy(value: str, kinds: list[str]) -> str:
    if value in RETIRED and set(VEHICLES) <= set(kinds):
        return f"no longer offered: {RETIRED[value]}"
    near = get_close_matches(value, kinds, n=1, cutoff=0.5)
    return f"did you mean {near[0]!r}?" if near else f'write kind = "{kinds[0]}", say'


def _did_you_mean(value: str, options: list[str]) -> str:
    near = get_close_matches(value, options, n=1, cutoff=0.5)
    return f"did you mean {near[0]!r}?" if near else f"choose one of {', '.join(options)}"


def _unknown_key(key: str, value: Any, known: tuple[str, ...], place: str) -> Problem:
    near = get_close_matches(key, known, n=1, cutoff=0.6)
    listed = f"known keys: {', '.join(known)}" if known else "remove it, or mend its spelling"
    remedy = f"did you mean {near[0]!r}?" if near else listed
    return Problem(place=_path(place, [key]), value=_show(value), rule="unknown key", remedy=remedy)


def _missing(name: str) -> Problem:
    rule, remedy = "a study needs at least one", f"add {_HEADERS[name]}"
    return Problem(place=name, value="nothing", rule=rule, remedy=remedy)


def _path(place: str, location: list[Any]) -> str:
    path = place
    for part in location:
        if isinstance(part, int):
            path += f"[{part + 1}]"
        else:
            shown = shown_key(str(part))
            path += f".{shown}" if path else shown
    return path


def _members(kind: Any) -> list[Any]:
    inner = getattr(kind, "__origin__", kind)
    return list(getattr(inner, "__args__", (inner,)))


def _tag_names(kind: Any) -> list[str]:
    return [
        name
        for member in _members(kind)
        for name in getattr(member.model_fields["kind"].annotation, "__args__", ())
    ]


def _without_tags(
    errors: list[dict[str, Any]], kind: Any, data: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Return errors without the tag that leads their locations; the file has no such key."""
    tag = (str(data.get("kind")),) if len(_members(kind)) > 1 else ()
    return [{**e, "loc": e["loc"][1:]} if e["loc"][:1] == tag else e for e in errors]


def _fields(kind: Any, data: Mapping[str, Any]) -> tuple[str, ...]:
    names: list[str] = []
    for member in _members(kind):
        tags = getattr(member.model_fields.get("kind"), "annotation", None)
        if len(_members(kind)) > 1 and data.get("kind") not in getattr(tags, "__args__", ()):
            continue
        names += [info.alias or name for name, info in member.model_fields.items()]
    return tuple(names)


def _fields_within(kind: Any, data: Mapping[str, Any], location: list[Any]) -> tuple[str, ...]:
    """Return the keys known to a table within a section, by the way that leads to it."""
    if not location:
        return _fields(kind, data)
    names = [str(part) for part in location if not isinstance(part, int)]
    sections = [m for m in _members(kind) if names[0] in m.model_fields]
    for name in names:
        if not any(name in m.model_fields for m in sections):
            continue  # the name that a table of tables has in this file
        inner = (m.model_fields[name].annotation for m in sections if name in m.model_fields)
        sections = [section for annotation in inner for section in _sections_in(annotation)]
    return tuple(
        dict.fromkeys(
            info.alias or key for section in sections for key, info in section.model_fields.items()
        )
    )


def _sections_in(annotation: Any) -> list[Any]:
    """Return the sections that a field may hold, itself or in a list."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return [annotation]
    return [s for inner in getattr(annotation, "__args__", ()) for s in _sections_in(inner)]


def _printable(value: Any) -> str:
    return value if isinstance(value, str) and value.isprintable() else repr(value)


def _show(value: Any) -> str:
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # thousands of digits, thousands of levels
        return f"a {type(value).__name__} too long to show"
    return text if len(text) <= 80 else text[:77] + "..."
