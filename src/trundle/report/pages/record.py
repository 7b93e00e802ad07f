"""Write what is said of a measured record: a page, figures, levels and verdicts."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from trundle import __version__
from trundle._csv import write_csv
from trundle._json import plain
from trundle._progress import Tell, silent
from trundle.records.assess import RecordResult
from trundle.report.figures import record
from trundle.report.html import Picture, embedded, template
from trundle.study.report_plan import ReportPlan
from trundle.views.record import level_rows, record_summary, shown_rows
from trundle.views.record_answer import answers, light, lights
from trundle.views.record_survey import (
    EVENT_HEADINGS,
    PERCENTILE_HEADINGS,
    csv_table,
    dose_rows,
    event_rows,
    percentile_rows,
    psd_table,
    running_table,
    shown_events,
)
from trundle.views.words import USUAL

__all__ = ["record_page", "write_record_report"]

_MOST_EVENTS = 200  # on the page; the file has all


def write_record_report(
    result: RecordResult, folder: Path, *, report: ReportPlan = USUAL, tell: Tell = silent
) -> Path:
    """Write the page, its figures, ``summary.json`` and tables (CSV); return the page.

    Parameters
    ----------
    result : RecordResult
        What is said of the record.
    folder : Path
        A folder without figures.
    report : ReportPlan, optional
        Has the units of page and figures; files for programs keep theirs, which they name.
    tell : callable, optional
        Told which figure is drawn, and the share drawn.
    """
    pictures = embedded(list(record.drawings(result, report)), folder / "figures", tell=tell)
    write_csv(folder / "levels.csv", *level_rows(result))
    write_csv(folder / "percentiles.csv", *csv_table(percentile_rows(result), PERCENTILE_HEADINGS))
    write_csv(folder / "events.csv", *csv_table(event_rows(result), EVENT_HEADINGS))
    write_csv(folder / "psd.csv", *psd_table(result))
    write_csv(folder / "running.csv", *running_table(result))
    text = json.dumps(plain(record_summary(result)), indent=1, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    page = folder / "report.html"
    page.write_text(record_page(result, pictures, report), encoding="utf-8")
    return page


def record_page(
    result: RecordResult, pictures: Sequence[Picture], report: ReportPlan = USUAL
) -> str:
    """Return the page of a record, with pictures as `embedded` gives them."""
    events = shown_events(result, report)
    return template("record.html.j2").render(
        result=result,
        record=result.record,
        answers=answers(result),
        lights=lights(result),
        light=light,
        rows=shown_rows(result, report),
        report=report,
        events=events[:_MOST_EVENTS],
        n_events=len(events),
        doses=dose_rows(result),
        pictures=pictures,
        version=__version__,
    )
