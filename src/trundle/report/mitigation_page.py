"""Write what would help: a page with matrices and curves, and every margin as CSV."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib import rc_context

from trundle import __version__
from trundle._csv import write_csv
from trundle.mitigate.sweep import Sweep
from trundle.report.canvas import STYLE, Picture, save
from trundle.report.figures_mitigation import class_matrix_figure, speed_figure, strictest
from trundle.report.html import embedded, template
from trundle.units import KMH

__all__ = ["PARTLY", "mitigation_rows", "write_mitigation_report"]

PARTLY = (
    "not assessed: the road's waves end below the criterion's bands at this speed (raise n_max), "
    "or step and modes do not reach them; margins are those of the bands computed and excited"
)
"""What is not assessed, and why."""


def mitigation_rows(sweep: Sweep) -> list[dict[str, Any]]:
    """Return one row a combination and point: the strictest criterion met."""
    return [
        {
            "change": one.change,
            "case": one.case,
            "speed_kmh": one.speed / KMH,
            "road": one.road,
            "point": point,
            "strictest": strictest(one, point),
        }
        for one in sweep.outcomes
        for point in sweep.study.points
    ]


def write_mitigation_report(sweep: Sweep, folder: Path) -> Path:
    """Write ``report.html``, ``summary.csv`` and figures; return the page."""
    figures = folder / "figures"
    figures.mkdir()
    pictures = []
    curve = _middle_curve(sweep)
    for i, point in enumerate(sweep.study.points):
        drawings = [
            (
                Picture(
                    name=f"matrix_{i + 1}",
                    title=f"Strictest criterion met, {point}",
                    caption=f"By speed and road class, for every change and case. {PARTLY}.",
                ),
                lambda point=point: class_matrix_figure(sweep, point),
            )
        ]
        if curve:
            drawings.append(
                (
                    Picture(
                        name=f"speed_{i + 1}",
                        title=f"Level against speed, {point}",
                        caption=f"Level over the limit of {curve}, where it is nearest; above 1 it "
                        "fails. Dotted: speeds at which axles pass at the floor's first frequency, "
                        "a half or a third of it.",
                    ),
                    lambda point=point: speed_figure(sweep, point, curve),
                )
            )
        for picture, draw in drawings:
            with rc_context(STYLE):
                save(draw(), figures, picture.name)
            pictures.append(embedded(picture, figures))
    _write_summary(sweep, folder / "summary.csv")
    page = folder / "report.html"
    page.write_text(
        template("mitigation.html.j2").render(
            sweep=sweep,
            rows=mitigation_rows(sweep),
            partly=PARTLY,
            pictures=pictures,
            version=__version__,
        ),
        encoding="utf-8",
    )
    return page


def _middle_curve(sweep: Sweep) -> str:
    """Return the velocity criterion whose margins lie nearest to 1, to draw curves for."""
    by_curve: dict[str, list[float]] = {}
    for one in sweep.outcomes:
        for v in one.verdicts:
            if v.criterion.quantity == "band_rms_velocity" and v.margin == v.margin:
                by_curve.setdefault(v.criterion.name, []).append(v.margin)
    if not by_curve:
        return ""
    shares = {name: sum(m >= 1.0 for m in ms) / len(ms) for name, ms in by_curve.items()}
    return min(shares, key=lambda name: abs(shares[name] - 0.5))


def _write_summary(sweep: Sweep, file: Path) -> None:
    heads = ("change", "case", "speed_kmh", "road", "point", "criterion", "verdict", "margin")
    rows = []
    for one in sweep.outcomes:
        for v in one.verdicts:
            key = [one.change, one.case, f"{one.speed / KMH:g}", one.road, v.point]
            known = (v.margin, v.governing_band, v.share_exceeding, one.excited_to)
            rows.append([*key, v.criterion.name, v.status, *(f"{x:.6g}" for x in known)])
    write_csv(file, [*heads, "governing_band_hz", "share_exceeding", "excited_to_hz"], rows)
