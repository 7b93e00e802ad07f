"""Write what would help: a page with matrices and curves, and every margin as CSV."""

from __future__ import annotations

from pathlib import Path

from trundle import __version__
from trundle._csv import write_csv
from trundle.mitigate.outcome import Sweep
from trundle.report.figures import mitigation
from trundle.report.html import embedded, template
from trundle.views.mitigation import MARGIN_HEADINGS, PARTLY, margin_rows, mitigation_rows

__all__ = ["write_mitigation_report"]


def write_mitigation_report(sweep: Sweep, folder: Path) -> Path:
    """Write ``report.html``, ``summary.csv`` and figures; return the page."""
    pictures = embedded(list(mitigation.drawings(sweep)), folder / "figures")
    write_csv(folder / "summary.csv", MARGIN_HEADINGS, margin_rows(sweep))
    page = folder / "report.html"
    page.write_text(
        template("mitigation.html.j2").render(
            sweep=sweep,
            rows=mitigation_rows(sweep),
            partly=PARTLY,
            pictures=pictures,
            version=__version__,
        ),
        encoding="utf-8",
    )
    return page
