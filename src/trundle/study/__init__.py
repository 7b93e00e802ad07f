"""Read studies, plan and run them, and store what they give."""

from trundle.study.build import load_study
from trundle.study.model import Case, MethodPlan, Study

__all__ = ["Case", "MethodPlan", "Study", "load_study"]
