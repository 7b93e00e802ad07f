"""Arrange what is said of a measured record: single numbers, levels, verdicts."""

from __future__ import annotations

from typing import Any

import numpy as np

from trundle import __version__
from trundle.records.assess import RecordResult
from trundle.signals import nominal_frequency
from trundle.study.report_plan import ReportPlan
from trundle.units import GAL, MICROMETRE_PER_SECOND
from trundle.views.record_answer import answers
from trundle.views.record_survey import dose_rows, event_rows
from trundle.views.words import USUAL, shown

__all__ = ["level_rows", "record_rows", "record_summary", "shown_rows"]


def record_rows(result: RecordResult) -> list[dict[str, Any]]:
    """Return single numbers of every channel, for programs: in units that never change."""
    reduced = result.reduced
    return [
        {
            "channel": name,
            "peak_gal": float(reduced.peak_acceleration[0, i]) / GAL,
            "peak_time_s": float(reduced.peak_time[0, i]),
            "rms_um_s": float(reduced.rms_velocity[0, i]) / MICROMETRE_PER_SECOND,
            "crest_factor": float(result.survey.crest_factor[i]),
            "response_factor": float(reduced.response_factor[0, i]),
            "vdv": float(reduced.vdv[0, i]),
        }
        for i, name in enumerate(result.record.channel_names)
    ]


def shown_rows(result: RecordResult, report: ReportPlan = USUAL) -> list[dict[str, Any]]:
    """Return the same for people: peak and RMS in the units of a report."""
    reduced = result.reduced
    peak, rms = shown("m/s2", report)[1], shown("m/s", report)[1]
    return [
        {
            **row,
            "peak": float(reduced.peak_acceleration[0, i]) / peak,
            "rms": float(reduced.rms_velocity[0, i]) / rms,
        }
        for i, row in enumerate(record_rows(result))
    ]


def record_summary(result: RecordResult) -> dict[str, Any]:
    """Return all that is said of a record, as JSON takes it."""
    return {
        "program": "trundle",
        "version": __version__,
        "source": result.record.source,
        "averaging": result.averaging,
        "high_pass_hz": result.high_pass,
        "answers": [
            {
                "channel": one.channel,
                "sentence": one.words,
                "class": one.met or None,
                "verdict": one.status,
                "margin": one.margin,
                "governing_band_hz": one.governing_band,
                "not_assessed_below_hz": one.below,
                "not_assessed_above_hz": one.above,
            }
            for one in answers(result)
        ],
        "channels": record_rows(result),
        "verdicts": [
            {
                "channel": v.point,
                "axis": v.axis,
                "criterion": v.criterion.name,
                "verdict": v.status,
                "margin": v.margin,
                "governing_band_hz": v.governing_band,
                "value_si": v.value,
                "limit_si": v.limit,
                "time_s": v.time,
                "unresolved_bands_hz": list(v.unresolved),
                "reasons": list(v.reasons) if v.status == "not assessed" else [],
            }
            for v in result.verdicts
        ],
        "events": event_rows(result),
        "event_rules": {one.channel: one.rule for one in result.events},
        "vibration_doses": dose_rows(result),
        "warnings": [str(warning) for warning in result.warnings],
    }


def level_rows(result: RecordResult) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of band levels of every channel [um/s], a row a band."""
    spectra = result.reduced.spectra
    rows = []
    for i, f in enumerate(spectra.mid_band):
        levels = spectra.values[0, :, i] / MICROMETRE_PER_SECOND
        row = ["" if np.isnan(v) else f"{v:.6g}" for v in levels]
        rows.append([f"{nominal_frequency(float(f)):g}", *row])
    return ["band_hz", *(f"{name} [um/s]" for name in spectra.point_names)], rows
