"""Make all that the manual has of the code itself, before a build reads its pages."""

from __future__ import annotations

import re

from api_pages import write_api
from case_pages import write_cases
from command_pages import write_commands
from diagrams import write_diagrams
from gallery import write_gallery
from library_pages import write_library
from pages import DOCS
from sphinx.application import Sphinx
from study_keys import write_keys

__all__ = ["setup"]


def setup(app: Sphinx) -> dict[str, bool]:
    """Have the pages written once the build begins."""
    app.connect("builder-inited", _write)
    app.connect("source-read", _without_empty_lists)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _write(app: Sphinx) -> None:
    del app
    for write in (
        write_api, write_cases, write_commands, write_diagrams, write_gallery, write_keys,
        write_library,
    ):  # fmt: skip
        write()


_LIST = re.compile(r"```\{toctree\}\n(?:.*\n)*?```\n")


def _without_empty_lists(app: Sphinx, name: str, source: list[str]) -> None:
    """Take lists of pages out of the front page whose folder has none yet."""
    del app
    if name == "index":
        source[0] = _LIST.sub(
            lambda found: found[0] if _leads_somewhere(found[0]) else "", source[0]
        )


def _leads_somewhere(listed: str) -> bool:
    names = [line for line in listed.splitlines() if line and not line.startswith((":", "```"))]
    return any(any(DOCS.glob(f"{name}.md")) for name in names)
