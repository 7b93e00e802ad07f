"""Measured records: files as loggers and programs write them, read into SI units."""

from trundle.records.read import RecordOptions, read_record

__all__ = ["RecordOptions", "read_record"]
