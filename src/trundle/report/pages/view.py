"""Write the page on which a model is looked at: turned, taken apart by storeys, and moved.

The page holds all that it needs, three.js too, and opens without any network.
"""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Any

from markupsafe import Markup

from trundle.report.html import template

__all__ = ["view_page", "write_view"]

_SCRIPTS = {
    "core": "three.core.min.js",
    "three": "three.module.min.js",
    "controls": "OrbitControls.js",
}


def write_view(scene: dict[str, Any], path: Path) -> Path:
    """Write the page of a scene, whole or not at all.

    Parameters
    ----------
    scene : dict
        What `trundle.views.scene.scene_of` returns.
    path : Path
        The file.
    """
    aside = path.with_name(f".{path.name}.part")
    try:
        aside.write_text(view_page(scene), encoding="utf-8")
        aside.replace(path)
    finally:
        aside.unlink(missing_ok=True)
    return path


def view_page(scene: dict[str, Any]) -> str:
    """Return the page of a scene."""
    home = resources.files("trundle.report")
    vendor = home.joinpath("vendor", "three")
    scripts = {key: vendor.joinpath(name).read_text("utf-8") for key, name in _SCRIPTS.items()}
    return template("view.html.j2").render(
        title=scene["title"],
        scene=_data(scene),
        scripts={key: _code(text) for key, text in scripts.items()},
        view=_code(home.joinpath("templates", "view.js").read_text("utf-8")),
        licence=vendor.joinpath("LICENSE").read_text("utf-8"),
    )


def _data(scene: dict[str, Any]) -> Markup:
    """Return a scene as JSON that may stand in a script element: no ``<`` is left in it."""
    text = json.dumps(scene, allow_nan=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))  # noqa: S704 - made safe here


def _code(text: str) -> Markup:
    """Return a script of this package or of three.js, so that nothing in it ends its element."""
    return Markup(text.replace("</", "<\\/"))  # noqa: S704 - nothing that came from outside
