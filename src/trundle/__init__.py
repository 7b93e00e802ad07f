"""Carry vehicle-induced floor vibration from a rough road to a vibration class.

Sub-packages are imported on first use, so ``import trundle`` stays quick.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trundle import (
        criteria,
        dynamics,
        errors,
        report,
        response,
        road,
        route,
        signals,
        simulate,
        structure,
        study,
        units,
        vehicle,
    )

__version__ = "0.1.0"

__all__ = [
    "__version__",
    "criteria",
    "dynamics",
    "errors",
    "report",
    "response",
    "road",
    "route",
    "signals",
    "simulate",
    "structure",
    "study",
    "units",
    "vehicle",
]


def __getattr__(name: str) -> ModuleType:
    """Import a sub-package when it is first asked for."""
    if name in __all__ and not name.startswith("_"):
        return importlib.import_module(f"trundle.{name}")
    raise AttributeError(f"module 'trundle' has no attribute {name!r}")


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
