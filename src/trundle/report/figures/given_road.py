"""Draw surveys and features: what lies under the wheels, and what a tyre makes of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from trundle.errors import InputError
from trundle.report.canvas import COLOURS, Drawing, new_figure
from trundle.results.study_result import StudyResult
from trundle.road import FeaturedRoad, MeasuredRoad, Profile, Road, classify
from trundle.simulate import Crossing
from trundle.study.model import Study
from trundle.study.plans import Drive

__all__ = ["drawings"]

_MOST_TRACKS = 3
_PLACES = 4001


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give the given part of every road that has one, along every route.

    Yields
    ------
    Drawing
        One for each road and route.
    """
    study, number = result.study, 0
    for label, road in study.roads.items():
        for name, drive in study.drives.items() if road.is_given else ():
            number += 1
            if not road.of(name).is_given:
                continue
            yield Drawing(
                name=f"given_road_{number}",
                title=f"Road {label} along {name}",
                caption=_caption(road.of(name)),
                draw=lambda r=road, d=drive: given_road_figure(study, r, d),
            )


def given_road_figure(study: Study, road: Road, drive: Drive) -> Figure:
    """Draw a road along a route: as given under each track, and averaged by the tyre."""
    method = study.methods[0]
    crossing = Crossing(
        drive.vehicle, drive.route, road,
        band=study.band_for(drive, method), entry=method.entry, run_in=drive.run_in,
    )  # fmt: skip
    start, patch = crossing.chainage, crossing.band.contact_patch
    s = start + np.linspace(0.0, drive.route.length, _PLACES)
    wheels = _wheels(crossing)
    figure, axes = new_figure(7.2, 0.5 + 1.7 * len(wheels), rows=len(wheels), share="xy")
    for panel, (contact, profile) in zip(axes, wheels.items(), strict=True):
        places = np.unique(np.concatenate([s, _points(profile, s[0], s[-1])]))
        bare = _read(profile, places)
        level = float(bare[np.isfinite(bare)][0]) if np.isfinite(bare).any() else 0.0
        panel.plot(places, 1e3 * (bare - level), color="#9A9A9A", linewidth=0.8, label="as given")
        if patch:
            felt = _read(profile.averaged(patch), s)
            panel.plot(
                s, 1e3 * (felt - level), color=COLOURS[0], linewidth=1.2,
                label=f"averaged over the tyre's {patch:g} m",
            )  # fmt: skip
        panel.set(ylabel="height [mm]", title=f"under {drive.vehicle.contact_names[contact]}")
    axes[0].legend(loc="lower right", ncols=2, bbox_to_anchor=(1.0, 0.98))
    axes[-1].set(xlabel="station [m]", xlim=(s[0], s[-1]))
    return figure


def _wheels(crossing: Crossing) -> dict[int, Profile]:
    """Return the first wheels of different tracks, each with what lies under it."""
    found: dict[float, int] = {}
    vehicle = crossing.driven
    for contact in range(vehicle.n_contacts - vehicle.inner):
        found.setdefault(float(vehicle.lateral[contact]), contact)
    under: dict[int, Profile] = {}
    for aside, contact in list(found.items())[:_MOST_TRACKS]:
        profile = crossing.road.under(aside, crossing.tread(contact))
        if profile is not None:
            under[contact] = profile
    return under


def _points(profile: Profile, low: float, high: float) -> np.ndarray:
    return profile.station[(profile.station >= low) & (profile.station <= high)]


def _read(profile: Profile, places: np.ndarray) -> np.ndarray:
    """Return heights [m]; not-a-number where nobody knows the road."""
    known = np.ones(len(places), dtype=bool)
    if profile.beyond == "unknown":
        known = (places >= profile.station[0]) & (places <= profile.station[-1])
    out = np.full(len(places), np.nan)
    out[known] = profile.at(places[known])[0]
    return out


def _caption(road: Road) -> str:
    """Say what it is, and of a survey that is long enough which class it has."""
    base = road.base if isinstance(road, FeaturedRoad) else road
    text = f"{road}."
    if isinstance(base, MeasuredRoad):
        try:
            text += f" Its spectrum is that of {classify(base.tracks[0])}."
        except InputError:
            text += " It is too short to have a class."
    elif base.spectrum is not None:
        text += " Its random waves are not drawn: they differ from run to run."
    return text
