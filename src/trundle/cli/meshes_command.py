"""Show what half the mesh size changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from trundle.cli.afford import check_affordable
from trundle.cli.saying import say
from trundle.cli.screen import print_table, progress_bar
from trundle.run.estimate import estimate_of
from trundle.run.meshes import compare_meshes, on_two_meshes
from trundle.signals import nominal_frequency
from trundle.structure import building_resolution, resolved_frequency
from trundle.study.model import Study
from trundle.study_file.build import load_study
from trundle.views.words import shown

__all__ = ["compare"]


def _reach(study: Study, size: float) -> float:
    """Return up to what frequency a mesh carries bending waves [Hz]."""
    if study.plan is not None:
        return resolved_frequency(study.plan, size)
    if study.building is None:
        return np.inf
    parts = (*study.building.slabs, *study.building.ramps)
    return building_resolution([part.section for part in parts], size)


def compare(path: Path, *, yes: bool = False) -> None:
    """Compute a study's first case on two meshes, and print the levels band by band."""
    study = load_study(path)
    check_affordable(f"{path} on half its mesh size", estimate_of(on_two_meshes(study)[1]), yes=yes)
    with progress_bar() as tell:
        found = compare_meshes(study, tell=tell)
    coarse, fine = found.sizes
    reach = _reach(study, coarse)
    unit, size = shown("m/s", study.report)
    for p, point in enumerate(found.points):
        print_table(
            f"{point}: {found.case}, road {found.road}, {found.method}; rms velocity [{unit}]",
            ("band [Hz]", f"{coarse:g} m", f"{fine:g} m", "change", "carried by the mesh"),
            (
                (
                    f"{nominal_frequency(float(f)):g}",
                    f"{found.levels[0, p, b] / size:.4g}",
                    f"{found.levels[1, p, b] / size:.4g}",
                    f"{100.0 * (found.ratios[p, b] - 1.0):+.0f} %",
                    "yes" if f <= reach else "no",
                )
                for b, f in enumerate(found.bands)
            ),
        )
    say(
        f"change: {coarse:g} m against {fine:g} m on the same roads; where it is large, set "
        f"mesh_size to {fine:g} m and look again"
    )
