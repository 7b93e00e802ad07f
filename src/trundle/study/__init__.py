"""Hold whole studies: what is run, on what, and what it is held against."""

from trundle.study.map_plan import MapPlan
from trundle.study.model import Study
from trundle.study.plans import Assessment, Case, Drive, MethodPlan
from trundle.study.report_plan import ReportPlan

__all__ = ["Assessment", "Case", "Drive", "MapPlan", "MethodPlan", "ReportPlan", "Study"]
