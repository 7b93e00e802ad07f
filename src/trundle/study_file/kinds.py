"""Say what kinds of sections a study file has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

__all__ = ["SectionKind"]


@dataclass(frozen=True, kw_only=True)
class SectionKind:
    """Hold how a section stands in the file.

    Attributes
    ----------
    name : str
        Its name.
    schema : pydantic model, or a union of them with a discriminator
        Its fields, checked by themselves.
    form : {"table", "named", "list"}
        ``[name]``, ``[name.ANY]``, or ``[[name]]``.
    required : bool
        Whether a study needs at least one.
    usual : str
        Kind of a table that names none, where there are several.
    shakes : bool
        Whether it is a source of vibration that needs no vehicle, route and road beside it.
    """

    name: str
    schema: Any
    form: Literal["table", "named", "list"]
    required: bool = False
    usual: str = ""
    shakes: bool = False

    @property
    def header(self) -> str:
        """How it is written."""
        return {"table": "[{}]", "named": "[{}.NAME]", "list": "[[{}]]"}[self.form].format(
            self.name
        )
