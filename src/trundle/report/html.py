"""Fill in pages: templates that escape what they are given, pictures inside the page."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from pathlib import Path
from typing import TypeAlias

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from trundle._progress import Tell, silent
from trundle.report.canvas import Drawing
from trundle.views.words import between, hertz, limit_words, margin_words, rank, written

__all__ = ["Picture", "embedded", "template"]

Picture: TypeAlias = dict[str, str]
"""Name, title, caption and data of a picture."""


def template(name: str) -> Template:
    """Return a page's template; everything put into it is escaped."""
    environment = Environment(
        loader=PackageLoader("trundle.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["sig"] = written
    environment.filters["rank"] = rank
    environment.filters["margin"] = margin_words
    environment.filters["between"] = between
    environment.filters["hertz"] = hertz
    environment.filters["limit"] = limit_words
    return environment.get_template(name)


def embedded(drawings: Sequence[Drawing], figures: Path, *, tell: Tell = silent) -> list[Picture]:
    """Draw into a new folder, and return the pictures as a page takes them, their data inside.

    Parameters
    ----------
    drawings : sequence of Drawing
        What is drawn.
    figures : Path
        The folder.
    tell : callable, optional
        Told which figure is drawn, and the share drawn.
    """
    figures.mkdir()
    pictures: list[Picture] = []
    for number, drawing in enumerate(drawings):
        tell(f"figure: {drawing.title}", number / len(drawings))
        png = drawing.save(figures)
        pictures.append(
            {
                "name": drawing.name,
                "title": drawing.title,
                "caption": drawing.caption,
                "data": base64.b64encode(png).decode("ascii"),
            }
        )
    return pictures
