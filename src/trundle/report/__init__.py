"""Draw figures and write the report of a study."""

from trundle.report.figures_mitigation import UNKNOWN
from trundle.report.mitigation_page import PARTLY, mitigation_rows, write_mitigation_report
from trundle.report.page import write_report
from trundle.report.record_page import record_rows, write_record_report
from trundle.report.tables import (
    bound_rows,
    comparison_rows,
    exact_rows,
    road_words,
    summary_rows,
    verdict_matrix,
    written,
)

__all__ = [
    "PARTLY",
    "UNKNOWN",
    "bound_rows",
    "comparison_rows",
    "exact_rows",
    "mitigation_rows",
    "record_rows",
    "road_words",
    "summary_rows",
    "verdict_matrix",
    "write_mitigation_report",
    "write_record_report",
    "write_report",
    "written",
]
