"""Write what is said of a measured record: a page, figures, levels and verdicts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context

from trundle import __version__
from trundle._csv import write_csv
from trundle._json import plain
from trundle.records.assess import RecordResult
from trundle.report import figures_record
from trundle.report.canvas import STYLE, Picture, save
from trundle.report.html import embedded, template
from trundle.signals import crest_factor, nominal_frequency
from trundle.units import GAL, MICROMETRE_PER_SECOND

__all__ = ["record_rows", "write_record_report"]


def record_rows(result: RecordResult) -> list[dict[str, Any]]:
    """Return single numbers of every channel, in engineers' units."""
    runs, reduced = result.runs, result.reduced
    return [
        {
            "channel": name,
            "peak_gal": float(reduced.peak_acceleration[0, i]) / GAL,
            "peak_time_s": float(reduced.peak_time[0, i]),
            "rms_um_s": float(reduced.rms_velocity[0, i]) / MICROMETRE_PER_SECOND,
            "crest_factor": float(crest_factor(runs.acceleration[0, :, i])),
            "response_factor": float(reduced.response_factor[0, i]),
            "vdv": float(reduced.vdv[0, i]),
        }
        for i, name in enumerate(runs.point_names)
    ]


def write_record_report(result: RecordResult, folder: Path) -> Path:
    """Write ``report.html``, ``levels.csv``, ``summary.json`` and figures; return the page."""
    pictures = _pictures(result, folder / "figures")
    _write_levels(result, folder / "levels.csv")
    text = json.dumps(plain(_summary(result)), indent=1, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    page = folder / "report.html"
    page.write_text(
        template("record.html.j2").render(
            result=result,
            record=result.record,
            rows=record_rows(result),
            pictures=pictures,
            version=__version__,
        ),
        encoding="utf-8",
    )
    return page


def _pictures(result: RecordResult, figures: Path) -> list[dict[str, str]]:
    figures.mkdir()
    found: list[dict[str, str]] = []
    for picture, draw in (
        (
            Picture(
                name="spectra",
                title="Velocity spectra on criteria",
                caption="RMS velocity in one-third octaves of every channel.",
            ),
            figures_record.record_spectra_figure,
        ),
        (
            Picture(
                name="history",
                title="Motion in time",
                caption=f"Velocity and acceleration above {result.high_pass:g} Hz.",
            ),
            figures_record.record_history_figure,
        ),
    ):
        with rc_context(STYLE):
            save(draw(result), figures, picture.name)
        found.append(embedded(picture, figures))
    return found


def _summary(result: RecordResult) -> dict[str, Any]:
    return {
        "program": "trundle",
        "version": __version__,
        "source": result.record.source,
        "averaging": result.averaging,
        "high_pass_hz": result.high_pass,
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
        "warnings": [str(warning) for warning in result.warnings],
    }


def _write_levels(result: RecordResult, file: Path) -> None:
    spectra = result.reduced.spectra
    rows = []
    for i, f in enumerate(spectra.mid_band):
        levels = spectra.values[0, :, i] / MICROMETRE_PER_SECOND
        row = ["" if np.isnan(v) else f"{v:.6g}" for v in levels]
        rows.append([f"{nominal_frequency(float(f)):g}", *row])
    write_csv(file, ["band_hz", *(f"{name} [um/s]" for name in spectra.point_names)], rows)
