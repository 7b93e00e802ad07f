"""Write what people who walk give a floor: a table, what it was computed from, and maps."""

from __future__ import annotations

import json
from pathlib import Path

from trundle._csv import write_csv
from trundle._json import plain
from trundle.report.figures.footfall import drawings
from trundle.run.footfall import StudyFootfall
from trundle.views.footfall import FootfallDose, footfall_rows, worst_places

__all__ = ["footfall_summary", "write_footfall"]


def footfall_summary(found: StudyFootfall) -> dict[str, object]:
    """Return what was asked, the worst places and the doubts, for programs."""
    response = found.response
    headings, rows = footfall_rows(found, None)
    return {
        "guide": response.load.title,
        "source": response.load.source,
        "confidence": response.load.confidence,
        "assumption": response.load.assumption,
        "quantity": response.quantity,
        "method": str(found.method.interaction),
        "excitation": "full" if found.asked.everywhere else "self",
        "walked_length_m": found.asked.length,
        "paces_hz": [float(response.paces[0]), float(response.paces[-1])],
        "worst": [dict(zip(headings, rows[i], strict=True)) for i in worst_places(found)],
        "warnings": [str(doubt) for doubt in response.doubts],
    }


def write_footfall(found: StudyFootfall, folder: Path, dose: FootfallDose | None = None) -> None:
    """Write ``footfall.csv``, ``footfall.json`` and a map of every storey into a folder."""
    write_csv(folder / "footfall.csv", *footfall_rows(found, dose))
    text = json.dumps(plain(footfall_summary(found)), indent=1, allow_nan=False)
    (folder / "footfall.json").write_text(f"{text}\n", encoding="utf-8")
    for drawing in drawings(found):
        drawing.save(folder)
