"""Read structural models that other programs wrote, a file a format."""

from trundle.imports.model_format import ModelFormat, all_formats
from trundle.imports.read import read_model

__all__ = ["ModelFormat", "all_formats", "read_model"]
