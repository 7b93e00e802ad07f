"""Read study files: TOML to a study, or to every mistake in it."""

from trundle.study_file.build import load_study, study_from_text
from trundle.study_file.user_criteria import read_criteria

__all__ = ["load_study", "read_criteria", "study_from_text"]
