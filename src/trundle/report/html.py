"""Fill in pages: templates that escape what they are given, pictures inside the page."""

from __future__ import annotations

import base64
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from trundle.report.canvas import Picture

__all__ = ["embedded", "template"]


def template(name: str) -> Template:
    """Return a page's template; everything put into it is escaped."""
    environment = Environment(
        loader=PackageLoader("trundle.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["sig"] = lambda value, digits=3: f"{value:.{digits}g}"
    environment.filters["rank"] = _rank
    return environment.get_template(name)


def embedded(picture: Picture, figures: Path) -> dict[str, str]:
    """Return a finished picture as a page takes it, its data inside."""
    png = (figures / f"{picture.name}.png").read_bytes()
    return {
        "name": picture.name,
        "title": picture.title,
        "caption": picture.caption,
        "data": base64.b64encode(png).decode("ascii"),
    }


def _rank(value: float) -> str:
    """Name a percentile; below the lowest run it is 'below all', above the highest 'above all'."""
    if value <= 0.0:
        return "below all"
    if value >= 100.0:
        return "above all"
    return f"{value:.0f} %"
