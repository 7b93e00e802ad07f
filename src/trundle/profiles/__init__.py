"""Read measured road profiles: tables, ERD files, OpenCRG files."""

from trundle.profiles.read import ProfileOptions, ReadProfile, read_profile
from trundle.profiles.survey import Survey

__all__ = ["ProfileOptions", "ReadProfile", "Survey", "read_profile"]
