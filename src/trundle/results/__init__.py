"""Hold what a study gave, and keep it in a folder."""

from trundle.results.cells import Cell, CellKey, History
from trundle.results.maps import MapKey, StudyMap
from trundle.results.study_result import StudyResult

__all__ = ["Cell", "CellKey", "History", "MapKey", "StudyMap", "StudyResult"]
