"""Make the reference of the command line from what the commands themselves say."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import typer.main
from pages import DOCS, GENERATED, ROOT, code, table, write_page

from trundle.cli.app import BAD_INPUT, FAILED, INTERRUPTED, NOT_MET, app

__all__ = ["commands", "examples_of", "write_commands"]

_CODES = (
    (0, "done"),
    (FAILED, "the mathematics failed: an integration that does not converge, say"),
    (BAD_INPUT, "input that breaks a rule: a study, a record, an option"),
    (NOT_MET, "a criterion of `--fail-on` is failed, or not assessed"),
    (INTERRUPTED, "stopped by Ctrl-C"),
)
_BLOCK = re.compile(r"^```([^\n]*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_OPTION = re.compile(r"(?<![\w`-])--[a-z][a-z-]*")
_DEFAULT = re.compile(r"\s*\[default: (.*?)\]\s*$")


def write_commands() -> None:
    """Write a page for each command, and the tables of the page on all of them."""
    folder = GENERATED / "commands"
    for name, command in commands():
        write_page(folder / f"{name.replace(' ', '_')}.md", _page(name, command))
    write_page(folder / "all.inc", _all())
    write_page(folder / "exit_codes.inc", _exit_codes())


def commands() -> Iterator[tuple[str, Any]]:
    """Give every command and what it is, those of groups after their group."""
    root = typer.main.get_command(app)
    for name, command in root.commands.items():  # type: ignore[attr-defined]
        yield name, command
        for inner, one in getattr(command, "commands", {}).items():
            yield f"{name} {inner}", one


def _all() -> str:
    rows = [
        (
            f"[`trundle {name}`](generated/commands/{name.replace(' ', '_')}.md)",
            _first_line(command),
        )
        for name, command in commands()
    ]
    return table(("command", "what it does"), rows)


def _first_line(command: Any) -> str:
    return (command.help or "").split("\n\n")[0]


def _exit_codes() -> str:
    return table(("exit code", "when"), ((str(code_), when) for code_, when in _CODES))


def _page(name: str, command: Any) -> str:
    first, _, rest = (command.help or "").replace("\\[", "[").partition("\n\n")
    arguments = [one for one in command.params if not one.opts[0].startswith("-")]
    options = [one for one in command.params if one.opts[0].startswith("-")]
    parts = [
        f"# `trundle {name}`\n\n{first}\n",
        _usage(name, arguments),
        _OPTION.sub(r"`\g<0>`", rest),
    ]
    if arguments:
        rows = ((code(one.metavar or one.name), _said(one)[0]) for one in arguments)
        parts.append("\n## Arguments\n" + table(("argument", "what"), rows))
    rows = [*(_row(one) for one in options), ("`--help`, `-h`", "", "", "Show all this, and end.")]
    parts.append(
        "\n## Options\n" + table(("option", "takes", "default", "what"), rows, kind="keys")
    )
    parts.append(_examples(name))
    return "\n".join(parts)


def _usage(name: str, arguments: list[Any]) -> str:
    names = [one.metavar or one.name.upper() for one in arguments]
    return f"\n```text\n{' '.join(('trundle', name, *names, '[OPTIONS]'))}\n```\n"


def _row(option: Any) -> tuple[str, str, str, str]:
    words, told = _said(option)
    names = ", ".join(code(one) for one in (*option.opts, *option.secondary_opts))
    takes = "" if option.is_flag else code(option.metavar or _kind(option))
    if option.multiple:
        takes += ", several times"
    return names, takes, told or _default(option), words


def _said(parameter: Any) -> tuple[str, str]:
    """Return what a parameter says of itself, and the default that it names there."""
    words = (parameter.help or "").replace("\\[", "[")
    told = _DEFAULT.search(words)
    return _OPTION.sub(r"`\g<0>`", _DEFAULT.sub("", words)), "" if told is None else told[1]


def _kind(option: Any) -> str:
    kind = option.type_descriptor.annotation
    words = {int: "NUMBER", float: "NUMBER", str: "TEXT"}
    return words.get(kind, "PATH" if "Path" in str(kind) else "TEXT")


def _default(option: Any) -> str:
    value = getattr(option, "default", None)
    return (
        ""
        if value in {None, "", False}
        else code(f"{value:g}" if isinstance(value, float) else str(value))
    )


def _examples(name: str) -> str:
    shown = "\n".join(examples_of(name))
    return f"\n## Examples\n\n```sh\n{shown}\n```\n" if shown else ""


def examples_of(name: str) -> list[str]:
    """Return the lines of README and pages that call a command, each once."""
    inner = {other for other, _ in commands() if other.startswith(f"{name} ")}
    lines = [line for line in _lines() if re.match(rf"trundle {name}( |$)", line)]
    own = [line for line in lines if not any(line.startswith(f"trundle {one}") for one in inner)]
    return list(dict.fromkeys(own))


@cache
def _lines() -> tuple[str, ...]:
    """Return all lines of commands in README and pages that people have written."""
    pages = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
    texts = [page.read_text("utf-8") for page in pages]
    blocks = [block for text in texts for kind, block in _BLOCK.findall(text) if kind in {"", "sh"}]
    lines = [line.strip().removeprefix("$ ") for block in blocks for line in block.splitlines()]
    return tuple(line for line in lines if line.startswith("trundle "))
