"""Carry vehicle-induced floor vibration from a rough road to a vibration class.

Whole things by one call: `load_study`, `run_study`, `read_results`, `try_changes`, `assess_record`.
Their parts stand in rooms, imported on first use: ``import trundle`` stays quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trundle import (
        criteria,
        dynamics,
        errors,
        imports,
        mitigate,
        profiles,
        records,
        report,
        response,
        results,
        road,
        route,
        run,
        signals,
        simulate,
        structure,
        study,
        study_file,
        units,
        vehicle,
    )
    from trundle._face import (
        list_criteria,
        list_vehicles,
        read_results,
        run_study,
        save,
        try_changes,
    )
    from trundle.records import assess_record, read_record
    from trundle.report import write_record_report, write_report
    from trundle.study_file import load_study, study_from_text

__version__ = "0.2.0"

_WHERE = {
    "assess_record": "trundle.records",
    "list_criteria": "trundle._face",
    "list_vehicles": "trundle._face",
    "load_study": "trundle.study_file",
    "read_record": "trundle.records",
    "read_results": "trundle._face",
    "run_study": "trundle._face",
    "save": "trundle._face",
    "study_from_text": "trundle.study_file",
    "try_changes": "trundle._face",
    "write_record_report": "trundle.report",
    "write_report": "trundle.report",
}

__all__ = [
    "__version__",
    "assess_record",
    "criteria",
    "dynamics",
    "errors",
    "imports",
    "list_criteria",
    "list_vehicles",
    "load_study",
    "mitigate",
    "profiles",
    "read_record",
    "read_results",
    "records",
    "report",
    "response",
    "results",
    "road",
    "route",
    "run",
    "run_study",
    "save",
    "signals",
    "simulate",
    "structure",
    "study",
    "study_file",
    "study_from_text",
    "try_changes",
    "units",
    "vehicle",
    "write_record_report",
    "write_report",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - rooms and functions
    """Import a room, or the home of a function, when it is first asked for."""
    if name in _WHERE:
        return getattr(importlib.import_module(_WHERE[name]), name)
    if name in __all__ and not name.startswith("_"):
        return importlib.import_module(f"trundle.{name}")
    raise AttributeError(f"module 'trundle' has no attribute {name!r}")


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
