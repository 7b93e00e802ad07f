"""Say where results come from: all that is needed to run the study again and get the same bits."""

from __future__ import annotations

import platform
from typing import Any

import numpy as np

from trundle import __version__
from trundle.study.model import Study

__all__ = ["provenance_of"]


def provenance_of(study: Study) -> dict[str, Any]:
    """Return the versions, hashes, seed and methods of a study that is run here and now."""
    return {
        "program": "trundle",
        "version": __version__,
        "study": study.title,
        "study_hash": study.content_hash,
        "floor_hash": study.floor.content_hash,
        "seed": study.seed,
        "runs": study.runs,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "methods": {method.name: str(method.interaction) for method in study.methods},
    }
