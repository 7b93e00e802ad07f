"""Write what is said of a measured record: a page, figures, levels and verdicts."""

from __future__ import annotations

import json
from pathlib import Path

from trundle import __version__
from trundle._csv import write_csv
from trundle._json import plain
from trundle.records.assess import RecordResult
from trundle.report.figures import record
from trundle.report.html import embedded, template
from trundle.views.record import level_rows, record_rows, record_summary

__all__ = ["write_record_report"]


def write_record_report(result: RecordResult, folder: Path) -> Path:
    """Write ``report.html``, ``levels.csv``, ``summary.json`` and figures; return the page."""
    pictures = embedded(list(record.drawings(result)), folder / "figures")
    write_csv(folder / "levels.csv", *level_rows(result))
    text = json.dumps(plain(record_summary(result)), indent=1, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    page = folder / "report.html"
    page.write_text(
        template("record.html.j2").render(
            result=result,
            record=result.record,
            rows=record_rows(result),
            pictures=pictures,
            version=__version__,
        ),
        encoding="utf-8",
    )
    return page
