"""Find the line of a study file on which a key or table stands, and read its text as TOML.

The TOML reader gives values without their lines. A study is written line by line, so its headings
and keys are found again by looking; texts and lists over several lines are passed over.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from typing import Any

from trundle.errors import Problem, StudyError

__all__ = ["line_of", "lines_of", "parse", "rows_of", "shown_key"]

_ENDS = re.compile(r"\r\n|\r|\n")
_WORD = r"""(?:[\w-]+|"(?:\\.|[^"\\])*"|'[^']*')"""
_DOTTED = rf"{_WORD}(?:\s*\.\s*{_WORD})*"
_HEADING = re.compile(rf"^\s*(\[\[?)\s*({_DOTTED})\s*\]")
_KEY = re.compile(rf"^\s*({_DOTTED})\s*=")
_PART = re.compile(_WORD)
_TRIPLE = re.compile(r'"{3}|\'{3}')
# the rest of a text of several lines: quotes behind a backslash end none, and up to two may stand
# before those that do
_END = {'"' * 3: r'(?:\\.|[^\\])*?"{3,5}', "'" * 3: r".*?'{3,5}"}
_TEXTS = re.compile(
    "|".join(f"{quotes}{rest}" for quotes, rest in _END.items())
    + r"""|("{3}|'{3})|"(?:\\.|[^"\\])*"|'[^']*'|\#.*"""
)  # texts, the quotes that open one of several lines, and comments

_WORDS = {
    "Invalid statement": "a line is a [table], a [[list]], or key = value",
    "Expected '=' after": "a key is followed by = and its value",
    "Expected newline or end": "a line ends behind its value; one key a line",
    "Invalid value": "a value is a number, true, false, a list, or text in quotes",
    "Unclosed array": "a list ends with ]",
    "Unclosed inline table": "a table in a line ends with }",
    "Unterminated string": "a text ends with the quote that it begins with",
    "Unescaped": "in quotes a backslash is written twice",
    "Illegal character": "a text ends on its line, with the quote that it begins with",
    "Cannot overwrite a value": "a key stands once in a table",
    "Duplicate inline table key": "a key stands once in a table",
    "Cannot declare": "a table [name] stands once; of several write [[name]]",
    "Invalid initial character": "a key begins with a letter or digit, or stands in quotes",
    "Expected ']": "a table's name stands between brackets: [name] or [[name]]",
    "Invalid date": "dates are not asked for here: is the value a text without quotes?",
}


def parse(text: str, source: str) -> dict[str, Any]:
    """Read TOML text.

    Raises
    ------
    StudyError
        The line that is no TOML, and what stands there.
    """
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # bad TOML, numbers of thousands of digits
        raise StudyError(source, [_no_toml(text, str(error))]) from None


def _no_toml(text: str, said: str) -> Problem:
    """Return what is wrong with a text, in this program's words."""
    at = re.search(r"\(at line (\d+)", said)
    line = int(at.group(1)) if at else _last_opened(text) if "end of document" in said else None
    rule = next((words for begin, words in _WORDS.items() if said.startswith(begin)), "")
    rows = text.split("\n")  # as the TOML reader counts them
    shown = rows[line - 1].strip() if line is not None and line <= len(rows) else ""
    shown = shown if len(shown) <= 60 else shown[:57] + "..."
    return Problem(
        place="file",
        value=repr(shown) if shown else "text that is no TOML",
        rule=rule or "the file must be TOML 1.0, with numbers and levels of a readable length",
        remedy="mend this line; a study is TOML 1.0: text in quotes, tables in [brackets]",
        line=line,
    )


def _last_opened(text: str) -> int:
    """Return the last line that begins a heading or a key: what is open at the end began there."""
    return max(lines_of(text).values(), default=1)


def lines_of(text: str) -> dict[str, int]:
    """Return the line of each heading and key, by its place as messages write it.

    Parameters
    ----------
    text : str
        A study file, sound or not.

    Returns
    -------
    dict of str to int
        ``route[2].speed`` and the like, lines counted from 1.
    """
    found: dict[str, int] = {}
    counts: Counter[str] = Counter()
    prefix, depth, closing = "", 0, ""
    for number, row in enumerate(rows_of(text), start=1):
        rest = row
        if closing:  # within a text of several lines
            ended = re.match(_END[closing], row)
            if ended is None:
                continue
            rest = row[ended.end() :]
        elif depth <= 0:
            if heading := _HEADING.match(row):
                prefix = _place(heading.group(2), counts, listed=heading.group(1) == "[[")
                found.setdefault(prefix, number)
                continue
            if key := _KEY.match(row):
                name = ".".join(_parts(key.group(1)))
                found.setdefault(f"{prefix}.{name}" if prefix else name, number)
        bare, closing = _without_texts(rest)
        depth = max(0, depth) + sum(bare.count(c) for c in "[{") - sum(bare.count(c) for c in "]}")
    return found


def rows_of(text: str) -> list[str]:
    """Return the lines of a text as editors count them: signs such as U+2028 end none."""
    return _ENDS.split(text)


def _without_texts(row: str) -> tuple[str, str]:
    """Return a row without texts and comments, and the quotes of a text that goes on behind it."""
    bare = _TEXTS.sub(r"\1", row)
    opened = _TRIPLE.search(bare)
    return (bare, "") if opened is None else (bare[: opened.start()], opened.group())


def line_of(place: str, lines: dict[str, int]) -> int | None:
    """Return the line of a place, or of the nearest key around it that has one."""
    while place:
        if place in lines:
            return lines[place]
        place = place[: max(place.rfind("."), place.rfind("["), 0)]
    return None


def _place(name: str, counts: Counter[str], *, listed: bool) -> str:
    """Return a heading as messages write it, tables of a list counted."""
    parts, place = _parts(name), ""
    for i, part in enumerate(parts):
        place += f".{part}" if place else part
        if listed and i == len(parts) - 1:
            counts[place] += 1
        if counts[place]:
            place += f"[{counts[place]}]"
    return place


def _parts(name: str) -> list[str]:
    return [shown_key(_unquoted(part)) for part in _PART.findall(name)]


def _unquoted(word: str) -> str:
    """Return the key that a word of TOML writes, its escapes read."""
    try:
        return next(iter(tomllib.loads(f"{word} = 0")))
    except ValueError:  # of a file that is no TOML
        return word.strip("\"'")


def shown_key(key: str) -> str:
    """Return a key as places write it: signs that do not show are escaped."""
    return key if key.isprintable() else repr(key)
