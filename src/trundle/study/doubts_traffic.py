"""Doubt traffic in which two vehicles would be at one place."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trundle.errors import FitnessWarning
from trundle.study.model import Study
from trundle.traffic import Times

__all__ = ["traffic_doubts"]


def traffic_doubts(study: Study) -> Iterator[FitnessWarning]:
    """Give routes on which one vehicle departs before the one ahead has driven its own length.

    Parameters
    ----------
    study : Study
        A checked study.

    Yields
    ------
    FitnessWarning
        One for each route of a schedule or traffic; random streams keep their distance themselves.
    """
    for case in study.cases:
        for name in dict.fromkeys(case.routes):
            pairs = zip(case.routes, case.departs, strict=True)
            times = np.array([t for n, t in pairs if n == name])
            yield from _too_close(study, f"traffic {case.name}", name, times)
    for schedule in study.schedules.values():
        for name in schedule.routes:
            known = [s.times for s in schedule.streams if isinstance(s, Times) and s.route == name]
            times = np.concatenate([np.zeros(0), *known])
            yield from _too_close(study, f"schedule {schedule.name}", name, times)


def _too_close(study: Study, what: str, name: str, times: np.ndarray) -> Iterator[FitnessWarning]:
    if name not in study.drives or len(times) < 2:
        return
    drive = study.drives[name]
    needed = float(drive.route.law.time_to(drive.vehicle.length))
    gaps = np.diff(np.sort(times))
    if gaps.min() < needed:
        yield FitnessWarning(
            subject=what,
            message=f"on {name!r} one vehicle departs {gaps.min():.3g} s after another, which "
            f"needs {needed:.3g} s to drive its own length: they would be at one place; give them "
            "a longer headway",
        )
