"""Make a page for each package with all its public names."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
import sys
from functools import cache
from types import ModuleType
from typing import get_origin

from pages import GENERATED, code, table, write_page
from sphinx.pycode import ModuleAnalyzer

import trundle

__all__ = ["alias_words", "home_of", "packages", "public_names", "write_api"]

_INTERNAL = {
    "trundle.cli": "commands: they have a reference of their own",
    "trundle.study_file.sections": "keys of study files: they have a reference of their own",
}


def write_api() -> None:
    """Write the pages, and one of the single modules that anybody may need."""
    for module in packages():
        write_page(GENERATED / "api" / f"{module.__name__}.md", _page(module))


@cache
def packages() -> tuple[ModuleType, ...]:
    """Return every package and module that lists public names and is no part of another."""
    offering = [trundle]
    for found in pkgutil.walk_packages(trundle.__path__, "trundle."):
        hidden = any(part.startswith("_") for part in found.name.split("."))
        alone = found.ispkg or found.name.count(".") == 1
        if hidden or not alone or any(found.name.startswith(name) for name in _INTERNAL):
            continue
        module = importlib.import_module(found.name)
        if public_names(module):
            offering.append(module)
    return tuple(offering)


def public_names(module: ModuleType) -> list[str]:
    """Return the names that a package offers, without packages below it."""
    names = getattr(module, "__all__", ())
    return [name for name in names if not inspect.ismodule(getattr(module, name))]


def home_of(name: str, value: object) -> str:
    """Return the package under which a name is described: the one that it is made in, if it offers it.

    Parameters
    ----------
    name : str
        A public name.
    value : object
        What it is.
    """
    offering = [one.__name__ for one in packages() if getattr(one, name, None) is value]
    made_in = getattr(value, "__module__", None) or ""
    inside = [one for one in offering if f"{made_in}.".startswith(f"{one}.")]
    return max(inside, key=len, default=offering[0])


def _page(module: ModuleType) -> str:
    name = module.__name__
    names = [one for one in public_names(module) if not one.startswith("__")]
    homes = {one: home_of(one, getattr(module, one)) for one in names}
    parts = [f"# {name}\n", f"```{{eval-rst}}\n.. automodule:: {name}\n   :no-members:\n```\n"]
    parts.append(table(("name", "what"), (_row(module, one, home) for one, home in homes.items())))
    parts.append("\n```{eval-rst}")
    for one, home in homes.items():
        parts += _directive(f"{name}.{one}", getattr(module, one)) if home == name else []
    return "\n".join([*parts, "```", ""])


def _row(module: ModuleType, name: str, home: str) -> tuple[str, str]:
    """Return a name with a link to where it is described, and what it says first."""
    value = getattr(module, name)
    told = inspect.isroutine(value) or isinstance(value, type)
    said = (inspect.getdoc(value) if told else alias_words(name, value)) or ""
    elsewhere = "" if home == module.__name__ else f" (of {code(home)})"
    return f"{{py:obj}}`~{home}.{name}`{elsewhere}", _plain(said.split("\n\n")[0])


def _plain(text: str) -> str:
    """Return a docstring's words in Markdown."""
    parts = text.replace("``", "`").split("`")
    parts[::2] = [words.replace("*", "\\*") for words in parts[::2]]
    return "`".join(parts)


def _directive(name: str, value: object) -> list[str]:
    """Return what documents a name under the package that offers it."""
    if isinstance(value, type) and issubclass(value, BaseException):
        return [f".. autoexception:: {name}", "   :members:", ""]
    if isinstance(value, type):
        return [f".. autoclass:: {name}", "   :members:", ""]
    if inspect.isroutine(value):
        return [f".. autofunction:: {name}", ""]
    said = alias_words(name.rpartition(".")[2], value).replace("\n", "\n   ")
    if get_origin(value) is not None:
        return [f".. py:type:: {name}", f"   :canonical: {_shown(value)}", "", f"   {said}", ""]
    number = isinstance(value, int | float | str)
    shown = [f"   :value: {value!r}"] if number else []
    return [f".. py:data:: {name}", *shown, "", f"   {said}", ""]


def _shown(alias: object) -> str:
    """Return an alias of a type as it may be read."""
    return re.sub(r"\b(?:[a-z_]\w*\.)+(?=[A-Za-z])", "", str(alias))


def alias_words(name: str, value: object) -> str:
    """Return what stands below a constant or an alias where it is made."""
    for module in [one for key, one in sorted(sys.modules.items()) if key.startswith("trundle")]:
        if vars(module).get(name) is value and re.search(
            rf"^{name}\b.*=", _source(module), re.MULTILINE
        ):
            said = ModuleAnalyzer.for_module(module.__name__).find_attr_docs()
            if ("", name) in said:
                return "\n".join(said["", name]).strip()
    return ""


@cache
def _source(module: ModuleType) -> str:
    return inspect.getsource(module) if getattr(module, "__file__", None) else ""
