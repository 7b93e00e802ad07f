"""Draw figures and write reports."""

from trundle.report.pages.mitigation import write_mitigation_report
from trundle.report.pages.record import write_record_report
from trundle.report.pages.study import unused_numbers, write_report

__all__ = ["unused_numbers", "write_mitigation_report", "write_record_report", "write_report"]
