"""Measured records: files of loggers and programs, read into SI and held against criteria."""

from trundle.records.assess import RecordResult, assess_record
from trundle.records.read import RecordOptions, read_record

__all__ = ["RecordOptions", "RecordResult", "assess_record", "read_record"]
