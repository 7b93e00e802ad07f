"""Make the reference of study files from the fields that the reader checks them by."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from key_words import default_of, taken_by
from pages import DOCS, GENERATED, ROOT, code, table, write_page

from trundle.study_file.fields import Section
from trundle.study_file.kinds import SectionKind
from trundle.study_file.sections import KINDS
from trundle.study_file.sections.general import GeneralSection

__all__ = ["example_of", "members_of", "shared_by", "tables_of", "write_keys"]

GENERAL = "general"
"""Name of the page of the keys above the first table."""

_UNTIL_DRAWN = {("RouteSection", "path"), ("PointSection", "at")}
"""Fields whose value stands for nothing until a drawing has been read."""

_HEADER = re.compile(r"^\[\[?([A-Za-z_]+)[\].]")


def write_keys() -> None:
    """Write a page for each section of a study file."""
    folder = GENERATED / "keys"
    write_page(folder / f"{GENERAL}.md", _general_page())
    for kind in KINDS:
        write_page(folder / f"{kind.name}.md", _page(kind))


def members_of(kind: SectionKind) -> list[type[Section]]:
    """Return the tables that a section may be: one, or one for each of its kinds."""
    inner = getattr(kind.schema, "__origin__", kind.schema)
    return list(getattr(inner, "__args__", (inner,)))


def tables_of(kind: SectionKind) -> Iterator[tuple[str, type[Section]]]:
    """Give all tables inside a section, with how each is written, each schema once."""
    seen = set(members_of(kind))
    waiting = [pair for one in members_of(kind) for pair in _inside(kind.header, one)]
    while waiting:
        where, one = waiting.pop(0)
        if one not in seen:
            seen.add(one)
            yield where, one
            waiting += _inside(where, one)


def _inside(header: str, section: type[Section]) -> list[tuple[str, type[Section]]]:
    return [
        (_within(header, info.alias or name, how), inner)
        for name, info in section.model_fields.items()
        for how, inner in taken_by(info).inner
    ]


def shared_by(kind: SectionKind) -> list[str]:
    """Return the fields that all kinds of a section inherit."""
    members = members_of(kind)
    bases = [set(one.__mro__) for one in members]
    common = set.intersection(*bases) - {Section, *members}
    shared = [one for one in common if issubclass(one, Section)]
    return [name for one in shared for name in one.model_fields]


def _within(header: str, key: str, how: str) -> str:
    """Return how a table inside another is written."""
    path = f"{header.strip('[]')}.{key}"
    return {"": f"[{path}]", ".NAME": f"[{path}.NAME]", "[]": f"[[{path}]]"}[how]


def _general_page() -> str:
    words = "The keys above the first table."
    example = _source_texts()[0].split("\n[", 1)[0].split("\n\n")[1].split("\n# duration")[0]
    parts = ["# Above the first table\n", words, _fields(GeneralSection), _shown(example)]
    return "\n".join(parts)


def _page(kind: SectionKind) -> str:
    parts = [f"# `{kind.header}`\n", _first_words(kind)]
    if kind.required:
        parts.append("\nA study needs at least one" + _unless(kind) + ".\n")
    members, shared = members_of(kind), shared_by(kind)
    for member in members:
        if len(members) > 1:
            parts.append(f"\n## {_kinds(member)}\n\n{_words(member)}")
        parts.append(_shown(example_of(kind.name, *_kinds_of(member))))
        parts.append(_fields(member, [name for name in member.model_fields if name not in shared]))
    if shared:
        parts += ["\n## All of them take\n", _fields(members[0], shared)]
    for where, section in tables_of(kind):
        parts.append(f"\n## {code(where)}\n\n{_words(section)}{_fields(section)}")
    return "\n".join(parts)


def _first_words(kind: SectionKind) -> str:
    members = members_of(kind)
    if len(members) == 1:
        return _words(members[0])
    usual = f', `"{kind.usual}"` unless given' if kind.usual else ""
    return f"`kind` says which of these it is{usual}; each has keys of its own."


def _unless(kind: SectionKind) -> str:
    driving = {"vehicle", "route", "road"}
    shaking = " or ".join(f"`{one.header}`" for one in KINDS if one.shakes)
    return f", unless {shaking} shake the floor alone" if kind.name in driving else ""


def _kinds_of(member: type[Section]) -> tuple[str, ...]:
    """Return the values of ``kind`` that a table goes by; none where it has no such key."""
    named = member.model_fields.get("kind")
    return () if named is None else named.annotation.__args__  # type: ignore[union-attr]


def _kinds(member: type[Section]) -> str:
    names = _kinds_of(member)
    if len(names) > 12:
        return "A vehicle of the library"
    return ", ".join([f'`kind = "{names[0]}"`', *(f'`"{name}"`' for name in names[1:])])


def _words(section: type[Section]) -> str:
    return " ".join((section.__doc__ or "").split())


def _fields(section: type[Section], names: Iterable[str] | None = None) -> str:
    rows = []
    for name in section.model_fields if names is None else names:
        info = section.model_fields[name]
        taken = taken_by(info)
        allowed = taken.rules if taken.kind == "word" else (taken.kind, *taken.rules)
        default = "" if (section.__name__, name) in _UNTIL_DRAWN else default_of(info)
        key = code(info.alias or name)
        rows.append((key, "; ".join(allowed), default, info.description or ""))
    return table(("key", "takes", "default", "meaning"), rows, kind="keys")


def _shown(example: str) -> str:
    return f"\n```toml\n{example}\n```\n" if example else ""


@cache
def example_of(name: str, *kinds: str) -> str:
    """Return the shortest example of a section that has more than two lines; "" if none has.

    Parameters
    ----------
    name : str
        The section.
    *kinds : str
        What its ``kind`` may be; whatever it is unless given.
    """
    found = [block for text in _source_texts() for block in _blocks(text, name)]
    ofit = [block for block in found if not kinds or _kind_in(block, name) in kinds]
    whole = [block for block in ofit if _begins(block, name)] or ofit
    long_enough = [block for block in whole if block.count("\n") >= 2] or whole
    return min(long_enough, key=lambda one: (one.count("\n"), len(one)), default="")


def _kind_in(block: str, name: str) -> str:
    """Return the ``kind`` that an example has."""
    told = re.search(r'^kind = "(.*?)"', block, re.MULTILINE)
    usual = next(kind.usual for kind in KINDS if kind.name == name)
    return usual if told is None else told[1]


@cache
def _source_texts() -> list[str]:
    """Return studies and parts of them: the template, the examples, blocks of pages."""
    paths: list[Path] = [ROOT / "src/trundle/study_file/template.toml"]
    paths += sorted((ROOT / "examples").glob("*/*.toml"))
    pages = [page.read_text("utf-8") for page in sorted(DOCS.glob("*.md"))]
    blocks = [
        block for page in pages for block in re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    ]
    return [*(path.read_text("utf-8") for path in paths), *blocks]


def _blocks(text: str, name: str) -> Iterator[str]:
    """Give every stretch of a text that is a section of a name, with the tables inside it."""
    kept: list[str] = []
    for line in [*text.splitlines(), "[end.of]"]:
        header = _HEADER.match(line)
        if kept and header is not None and (header[1] != name or _begins(line, name)):
            yield _trimmed(kept)
            kept = []
        if kept or (header is not None and header[1] == name):
            kept.append(line)


def _begins(line: str, name: str) -> bool:
    """Return whether a header begins a section, and no table inside one."""
    once_more = name == "vehicle" and line.partition("]")[0].count(".") == 1
    return line.startswith((f"[[{name}]]", f"[{name}]")) or once_more


def _trimmed(lines: list[str]) -> str:
    """Return lines without the comments that belong to what comes next."""
    while lines and (not lines[-1].strip() or lines[-1].startswith("#")):
        lines = lines[:-1]
    return "\n".join(lines)
