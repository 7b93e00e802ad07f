"""Make all that the manual has of the code itself, before a build reads its pages."""

from __future__ import annotations

import re
from pathlib import Path

from api_pages import write_api
from case_pages import write_cases
from command_pages import write_commands
from diagrams import write_diagrams
from docutils import nodes
from gallery import write_gallery
from library_pages import write_library
from pages import DOCS
from paper_page import write_paper
from sphinx.application import Sphinx
from study_keys import write_keys

__all__ = ["fitted", "setup"]


def setup(app: Sphinx) -> dict[str, bool]:
    """Have the pages written once the build begins."""
    app.connect("builder-inited", _write)
    app.connect("env-get-outdated", _read_front_again)
    app.connect("source-read", _list_front)
    app.connect("doctree-read", _wrap_words)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _write(app: Sphinx) -> None:
    del app
    for write in (
        write_api, write_cases, write_commands, write_diagrams, write_gallery, write_keys,
        write_library, write_paper,
    ):  # fmt: skip
        write()


_DRAWN = frozenset("┃│┏┗")


def _wrap_words(app: Sphinx, tree: nodes.document) -> None:
    """Have long lines of what a command says go on below, unless they are a table's."""
    del app
    for block in tree.findall(nodes.literal_block):
        if block.get("language") == "text" and not _DRAWN.intersection(block.astext()):
            block["classes"].append("words")


_LIST = re.compile(r"```\{toctree\}\n(?:.*\n)*?```\n")
_FRONT = "index"


def _list_front(app: Sphinx, name: str, source: list[str]) -> None:
    """Fit the front page's lists of pages to the pages that there are."""
    del app
    if name == _FRONT:
        source[0] = _LIST.sub(lambda found: fitted(found[0]), source[0])


def fitted(listed: str, folder: Path = DOCS) -> str:
    """Return a list of pages; "" if there are none, and a folder by its own list if it has one.

    Parameters
    ----------
    listed : str
        A list of pages, as it stands on one.
    folder : Path
        Where the pages are.
    """
    names = [line for line in listed.splitlines() if line and not line.startswith((":", "```"))]
    if not any(any(folder.glob(f"{name}.md")) for name in names):
        return ""
    for name in names:
        own = folder / name.replace("*", "index.md")
        if name.endswith("/*") and own.exists() and "{toctree}" in own.read_text("utf-8"):
            listed = listed.replace(name, name.replace("*", "index"))
    return listed


def _read_front_again(
    app: Sphinx, env: object, added: set[str], changed: set[str], removed: set[str]
) -> list[str]:
    """Have the front page read again when pages come or go."""
    del app, env, changed
    return [_FRONT] if added or removed else []
