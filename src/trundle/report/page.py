"""Write the report: figures, and one self-contained HTML page that opens offline."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from trundle.criteria import Verdict
from trundle.report import (
    figures_floor,
    figures_map,
    figures_response,
    figures_road,
    figures_vehicle,
)
from trundle.report.canvas import STYLE, Picture, save
from trundle.report.html import embedded, template
from trundle.report.interactive import plotly_script
from trundle.report.map_data import map_payload, map_views
from trundle.report.tables import (
    bound_rows,
    comparison_rows,
    exact_rows,
    road_words,
    roughest_words,
    summary_rows,
    truncation_rows,
    verdict_matrix,
)
from trundle.results.cells import CellKey
from trundle.results.maps import MapKey
from trundle.results.store import provenance
from trundle.results.study_result import StudyResult, positions_at, wheels_at
from trundle.road import CLASS_NAMES, class_limits
from trundle.structure import self_weight_deflection
from trundle.units import GAL, KMH, MICROMETRE_PER_SECOND

__all__ = ["write_report"]

Tell = Callable[[str, float], None]
Drawing = tuple[Picture, Callable[[], Figure]]

_FORCE_SPEEDS = (15.0 * KMH, 30.0 * KMH, 40.0 * KMH)


def write_report(result: StudyResult, folder: Path, *, tell: Tell | None = None) -> Path:
    """Write ``figures/*.png``, ``figures/*.svg`` and ``report.html``; return its path.

    Parameters
    ----------
    result : StudyResult
        A finished study.
    folder : Path
        Results folder, which must exist.
    tell : callable, optional
        Told which figure is drawn, and the share drawn.
    """
    figures = folder / "figures"
    figures.mkdir()
    planned = list(_figures(result))
    pictures: list[dict[str, str]] = []
    for number, (picture, draw) in enumerate(planned):
        if tell is not None:
            tell(f"figure: {picture.title}", number / len(planned))
        with rc_context(STYLE):
            save(draw(), figures, picture.name)
        pictures.append(embedded(picture, figures))
    page = folder / "report.html"
    page.write_text(_render(result, pictures), encoding="utf-8")
    return page


def _figures(result: StudyResult) -> Iterator[Drawing]:
    yield from _floor_figures(result)
    yield from _road_figures(result)
    yield from _vehicle_figures(result)
    yield from _response_figures(result)
    yield from _map_figures(result)


def _floor_figures(result: StudyResult) -> Iterator[Drawing]:
    study = result.study
    yield (
        Picture(
            name="plan",
            title="Plan with routes and points",
            caption="Beams (grey), secondary beams (dashed), columns (squares), routes with their "
            "direction and speed, and the points where the response is read. (Figure 8)",
        ),
        lambda: figures_floor.plan_figure(
            study.plan, {n: d.route for n, d in study.drives.items()}, study.points
        ),
    )
    yield (
        Picture(
            name="section",
            title="Section",
            caption="Section along y: slab, beams, columns above and below. (Figure 9)",
        ),
        lambda: figures_floor.section_figure(study.plan),
    )
    yield (
        Picture(
            name="mesh",
            title="Finite-element model",
            caption="Shells (blue), beams at their centroids (dark), columns (orange). (Figure 10)",
        ),
        lambda: figures_floor.mesh_figure(study.floor),
    )
    modes = result.modes
    if modes is not None:
        yield (
            Picture(
                name="modes",
                title="First modes of the floor",
                caption="Vertical motion of the slab, red up and blue down.",
            ),
            lambda: figures_floor.modes_figure(study.floor, modes),
        )


def _road_figures(result: StudyResult) -> Iterator[Drawing]:
    study = result.study
    yield (
        Picture(
            name="roughness",
            title="Road roughness of ISO 8608",
            caption="Displacement PSD of classes A to H: geometric mean (line) and limits (band). "
            "(Figure 2)",
        ),
        figures_road.roughness_figure,
    )
    yield (
        Picture(
            name="profiles",
            title="Profiles of classes A to D",
            caption=f"One realisation at the classes' upper limits, {study.band}. (Figure 3)",
        ),
        lambda: figures_road.profiles_figure(study.band, study.seed),
    )


def _vehicle_figures(result: StudyResult) -> Iterator[Drawing]:
    study = result.study
    drive = next(iter(study.drives.values()))
    vehicle, road = drive.vehicle, next(iter(study.roads.values()))
    yield (
        Picture(
            name="vehicle",
            title=f"Vehicle: {vehicle.name}",
            caption=f"Contacts with static loads, springs and dampers. Source: {vehicle.source}. "
            "(Figures 4 and 5)",
        ),
        lambda: figures_vehicle.vehicle_figure(vehicle),
    )
    yield (
        Picture(
            name="vehicle_modes",
            title="Natural frequencies of the vehicle",
            caption="Motion over each axle on rigid ground, largest set to 1. (Figure 6)",
        ),
        lambda: figures_vehicle.vehicle_modes_figure(vehicle),
    )
    yield (
        Picture(
            name="axle_forces",
            title="Dynamic axle forces",
            caption="Contact forces on rigid ground without the static load, one realisation. "
            "(Figure 7)",
        ),
        lambda: figures_vehicle.axle_forces_figure(
            vehicle, road, study.band, _FORCE_SPEEDS, seed=study.seed
        ),
    )


def _response_figures(result: StudyResult) -> Iterator[Drawing]:
    study = result.study
    methods = [method.name for method in study.methods]
    point, road = next(iter(study.points)), list(study.roads)[-1]
    for number, case in enumerate(study.cases):
        together = len(case.routes) > 1
        what = "several vehicles at once" if together else f"route {case.name}"
        yield (
            Picture(
                name=f"history_{number + 1}",
                title=f"Acceleration at {point}: {what}, class {road}",
                caption="First realisation by each method, on the same road. "
                f"(Figure {11 + min(number, 4)})",
            ),
            lambda case=case: figures_response.history_figure(
                result, case.name, road, methods, point
            ),
        )
    if study.assessment is not None:
        assessed = study.assessment.method
        yield (
            Picture(
                name="criteria_acceleration",
                title="Peak acceleration against equipment limits",
                caption="Zero-to-peak limits of precision equipment. (Figure 16)",
            ),
            lambda: figures_response.acceleration_criteria_figure(result, assessed, point),
        )
        for name in study.roads:
            yield (
                Picture(
                    name=f"criteria_velocity_{name.replace(' ', '_')}",
                    title=f"Velocity spectra against criteria, class {name}",
                    caption="One-third-octave RMS velocity on the generic criteria. (Figure 17)",
                ),
                lambda name=name: figures_response.velocity_criteria_figure(
                    result, name, assessed, point
                ),
            )
    rows = comparison_rows(result)
    if rows:
        yield (
            Picture(
                name="comparison",
                title="Printed values on our ranges",
                caption="Median (dot) and 5-95 % (bar) of our runs; crosses are printed values.",
            ),
            lambda: figures_response.comparison_figure(rows),
        )


def _map_figures(result: StudyResult) -> Iterator[Drawing]:
    plan = result.study.map
    if plan is None or not result.maps:
        return
    views = [view for view in map_views(result) if view.printed]
    about = (
        f"{len(plan.places)} places, level that {plan.percentile:g} % of {plan.runs} runs stay "
        f"below, averaging {plan.averaging}; a cell shows the place at its middle. "
        "Routes dashed, points crossed, columns grey."
    )
    yield (
        Picture(name="map_classes", title="Class map", caption=f"Strictest criterion met. {about}"),
        lambda: figures_map.class_map_figure(result.study, views),
    )
    yield (
        Picture(name="map_margin", title=f"Margin to {plan.criterion}", caption=about),
        lambda: figures_map.criterion_map_figure(result.study, views),
    )
    yield (
        Picture(name="map_share", title=f"Share of runs above {plan.criterion}", caption=about),
        lambda: figures_map.share_map_figure(result.study, views),
    )
    yield (
        Picture(name="map_rms", title="RMS velocity over the floor", caption=about),
        lambda: figures_map.rms_map_figure(result.study, views),
    )
    if plan.peaks:
        yield (
            Picture(name="map_peak", title="Peak acceleration over the floor", caption=about),
            lambda: figures_map.peak_map_figure(result.study, views),
        )


def _render(result: StudyResult, pictures: list[dict[str, str]]) -> str:
    study = result.study
    columns, matrix = verdict_matrix(result)
    modes = result.modes
    return template("report.html.j2").render(
        study=study,
        pictures=pictures,
        comparison=comparison_rows(result),
        bounds=bound_rows(result),
        summary=summary_rows(result),
        exact=exact_rows(result),
        truncation=truncation_rows(result),
        map=map_payload(result),
        plotly=plotly_script() if result.maps else "",
        columns=columns,
        roads=road_words(study),
        matrix=matrix,
        verdict=_headline(result),
        warnings=result.warnings(),
        provenance=provenance(result),
        frequencies=[] if modes is None else [f"{f:.2f}" for f in modes.frequencies[:24]],
        n_modes=0 if modes is None else modes.n_modes,
        moving_mass=study.floor.moving_mass() / 1e3,
        sag=-1e3 * float(self_weight_deflection(study.floor).min()),
        class_limits=_class_table(),
        gal=GAL,
        micrometre=MICROMETRE_PER_SECOND,
    )


def _class_table() -> list[tuple[str, list[str]]]:
    return [(name, [f"{1e6 * v:.0f}" for v in class_limits(name)]) for name in CLASS_NAMES]


def _headline(result: StudyResult) -> list[dict[str, Any]]:
    """State for each case and road the strictest velocity criterion that is met."""
    lines: list[dict[str, Any]] = []
    for key, verdicts in result.verdicts.items():
        for point in result.study.points:
            bands = [
                v
                for v in verdicts
                if v.point == point and v.criterion.quantity == "band_rms_velocity"
            ]
            passed = [v for v in bands if v.status == "pass"]
            best = min(passed, key=lambda v: float(v.criterion.limits.min()), default=None)
            failed = [v for v in bands if v.status == "fail"]
            first = max(failed, key=lambda v: float(v.criterion.limits.min()), default=None)
            lines.append(
                {
                    "case": key.case,
                    "road": key.road,
                    "point": point,
                    "best": best,
                    "first": first,
                    "where": _where(result, key, first or best),
                    "worst": _worst_place(result, key, first or best),
                    "road_passed": roughest_words(result.study, key.road, best) if best else "",
                    "reasons": _reasons(verdicts, point),
                }
            )
    return lines


def _reasons(verdicts: tuple[Verdict, ...], point: str) -> str:
    """Say why velocity criteria at a point are not assessed, if some are not."""
    found = (
        reason
        for v in verdicts
        if v.point == point
        and v.status == "not assessed"
        and v.criterion.quantity == "band_rms_velocity"
        for reason in v.reasons
    )
    return "; ".join(dict.fromkeys(found))


def _worst_place(result: StudyResult, key: CellKey, verdict: Verdict | None) -> str:
    """Say where on the map the margin to a criterion is smallest."""
    mapped = result.maps.get(MapKey(key.case, key.road))
    if mapped is None or verdict is None:
        return ""
    names = [c.name for c in mapped.classes.criteria]
    if verdict.criterion.name not in names:
        return ""
    margin = mapped.classes.margin[names.index(verdict.criterion.name)]
    if np.isnan(margin).all():
        return ""
    worst = int(np.nanargmin(margin))
    x, y = mapped.classes.places[worst]
    return f"{margin[worst]:.3g} at ({x:.1f}, {y:.1f}) m"


def _where(result: StudyResult, key: CellKey, verdict: Verdict | None) -> str:
    """Say when the governing level occurred, and where the vehicles were."""
    if verdict is None or not np.isfinite(verdict.time):
        return ""
    places = positions_at(result, key, verdict.time)
    on_floor = wheels_at(result, key, verdict.time)
    there = [
        f"{name} at ({place[0]:.1f}, {place[1]:.1f}) m"
        if place is not None
        else f"{name} is off the floor"
        if not on_floor[name]
        else f"{name}'s front axle is off, {on_floor[name]} wheels are on the floor"
        for name, place in places.items()
    ]
    return f"{verdict.time:.1f} s, {', '.join(there)}"
