"""Draw figures and write reports."""

from trundle.report.pages.mitigation import write_mitigation_report
from trundle.report.pages.record import write_record_report
from trundle.report.pages.study import unused_numbers, write_report
from trundle.report.pdf import find_browser, print_pdf
from trundle.report.workbook import check_workbooks, write_workbook

__all__ = [
    "check_workbooks",
    "find_browser",
    "print_pdf",
    "unused_numbers",
    "write_mitigation_report",
    "write_record_report",
    "write_report",
    "write_workbook",
]
