"""Write models, modes, crossings and maps for other programs, a file a format."""

from trundle.exports.export_format import ExportFormat, Subject, all_exports, export, format_of

__all__ = ["ExportFormat", "Subject", "all_exports", "export", "format_of"]
