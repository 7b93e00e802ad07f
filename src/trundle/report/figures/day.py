"""Draw days of traffic: events hour by hour, and over the floor."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch

from trundle.report.canvas import Drawing, legend_below, line_look, new_figure
from trundle.report.figures.map import draw_image, draw_panels
from trundle.results.cells import DayKey
from trundle.results.expected_days import DayRow, day_rows
from trundle.results.study_result import StudyResult
from trundle.views.day_map import DayMap, day_maps

__all__ = ["drawings"]

_HOURS = np.arange(24)
_MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give each day hour by hour, and where its events are on the floor.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    rows = list(day_rows(result))
    for i, key in enumerate(dict.fromkeys(row.key for row in rows)):
        number = f"_{i + 1}" if i else ""
        mine = [row for row in rows if row.key == key]
        yield Drawing(
            name=f"day_hours{number}",
            title=f"Events by hour: {key.schedule}, road {key.road}",
            caption="Passages that exceed each criterion in each hour: expected (lines), and times "
            "above it on the day that was run (marks).",
            draw=lambda mine=mine: hours_figure(mine),
        )
        maps = day_maps(result, key)
        if maps:
            yield _mapped(result, key, maps, number)


def _mapped(result: StudyResult, key: DayKey, maps: list[DayMap], number: str) -> Drawing:
    criterion = maps[0].criterion
    return Drawing(
        name=f"day_map{number}",
        title=f"Over the floor: {key.schedule}, road {key.road}",
        caption=f"Passages a day that exceed {criterion}, and minutes a day that the running level "
        "of 1 s lies above it, expected from the runs of the maps.",
        draw=lambda: day_map_figure(result, maps),
    )


def hours_figure(rows: list[DayRow]) -> Figure:
    """Draw events by hour, a panel for each point, a look for each criterion in all of them."""
    points = list(dict.fromkeys(row.point for row in rows))
    criteria = list(dict.fromkeys(row.criterion.name for row in rows))
    drawn: dict[str, StepPatch] = {}  # by name: titles may be alike
    figure, panels = new_figure(7.2, 1.0 + 2.3 * len(points), rows=len(points), share="x")
    for panel, point in zip(panels, points, strict=True):
        for row in (row for row in rows if row.point == point):
            k = criteria.index(row.criterion.name)
            colour, dashes = line_look(k)
            drawn[row.criterion.name] = panel.stairs(
                row.expected.by_hour, np.arange(25), color=colour, linestyle=dashes, linewidth=1.6
            )
            if row.day is not None and not np.isnan(row.minutes_run):
                criterion, place = row.place
                run = row.day.events[:, criterion, place]
                some = run > 0
                panel.plot(
                    _HOURS[some] + 0.5, run[some], _MARKS[k % len(_MARKS)], color=colour,
                    markersize=3.5, markeredgecolor="white", markeredgewidth=0.4,
                )  # fmt: skip
        panel.set(ylabel="events an hour", xlim=(0, 24), title=point)
        panel.set_ylim(bottom=0.0)
        panel.set_xticks(range(0, 25, 2))
    panels[-1].set_xlabel("hour of the day")
    titles = {row.criterion.name: row.criterion.title for row in rows}
    legend_below(figure, list(drawn.values()), [titles[name] for name in drawn], columns=4)
    return figure


def day_map_figure(result: StudyResult, maps: list[DayMap]) -> Figure:
    """Draw events and minutes a day over every surface that is mapped."""
    study = result.study
    shown = [(one, kind) for kind in ("events", "minutes") for one in maps]
    titles = [
        ("events a day" if kind == "events" else "minutes a day")
        + (f", {one.grid.label}" if one.grid.label else "")
        for one, kind in shown
    ]
    figure, panels = draw_panels(study, titles, columns=len(maps) if len(maps) > 1 else 2)
    for kind in ("events", "minutes"):
        mine = [(p, one) for p, (one, k) in zip(panels, shown, strict=True) if k == kind]
        values = [getattr(one, kind) for _, one in mine]
        largest = max((float(np.nanmax(v)) for v in values if np.isfinite(v).any()), default=0.0)
        norm, image = Normalize(0.0, largest or 1.0), None
        for (panel, one), value in zip(mine, values, strict=True):
            image = draw_image(
                panel, study, (one.grid, one.routes), value, cmap="cividis_r", norm=norm
            )
        if image is not None:
            bar = figure.colorbar(
                image, ax=[p for p, _ in mine], location="bottom", shrink=0.7, aspect=30
            )
            word = "passages" if kind == "events" else "minutes"
            bar.set_label(f"{word} a day above {maps[0].criterion}")
    return figure
