"""Compare the band levels of a study on its own mesh with those on half of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._progress import Tell, silent
from trundle._typing import Array
from trundle.response import BandSpectra
from trundle.run.whole_study import run_study
from trundle.signals import mid_band_frequencies
from trundle.study.model import Study

__all__ = ["MeshComparison", "compare_meshes", "on_two_meshes"]

_RUNS = 4  # roads are the same on both meshes: their ratio scatters far less than the levels


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshComparison:
    """Hold band levels on two meshes, on the same roads.

    Attributes
    ----------
    sizes : tuple of float
        Largest edge of an element of each mesh [m].
    case, road, method : str
        What was computed.
    points : tuple of str
        Where.
    bands : ndarray of float, shape (n_bands,)
        Mid-band frequencies that the road excites and both results resolve [Hz].
    levels : ndarray of float, shape (2, n_points, n_bands)
        Root mean square over the runs of the velocity levels on each mesh [m/s].
    """

    sizes: tuple[float, float]
    case: str
    road: str
    method: str
    points: tuple[str, ...]
    bands: Float[Array, " bands"]
    levels: Float[Array, "2 points bands"]

    @property
    def ratios(self) -> Float[Array, "points bands"]:
        """Return levels on the coarse mesh over those on the fine one; NaN where nothing moves."""
        coarse, fine = self.levels
        return np.divide(coarse, fine, out=np.full_like(coarse, np.nan), where=fine > 0.0)


def on_two_meshes(study: Study) -> tuple[Study, Study]:
    """Return a few runs of a study's first case, on its own mesh and on half of it.

    Parameters
    ----------
    study : Study
        A checked study.
    """
    name = study.methods[0].name if study.assessment is None else study.assessment.method
    label = next(iter(study.roads))
    small = replace(
        study,
        runs=_RUNS,
        cases=study.cases[:1],
        roads={label: study.roads[label]},
        methods=tuple(m for m in study.methods if m.name == name),
        map=None,
        schedules={},
        printed=(),
        printed_bounds=(),
    )
    return small, small.meshed(0.5)


def compare_meshes(study: Study, *, tell: Tell | None = None) -> MeshComparison:
    """Compute a study's first case on its mesh and on half of it.

    Parameters
    ----------
    study : Study
        A checked study.
    tell : callable, optional
        Told what is being done and the share done.

    Returns
    -------
    MeshComparison
        Of the first case on the first road, by the method that carries the verdict, or the first.
    """
    told = tell or silent
    both = on_two_meshes(study)
    spectra: list[BandSpectra] = []
    whole = np.ones(len(mid_band_frequencies()), dtype=bool)
    # the finer mesh has four times the dofs, and takes about five times as long
    for one, start, share in zip(both, (0.0, 0.17), (0.17, 0.83), strict=True):
        result = run_study(
            one,
            tell=lambda what, done, a=start, b=share, s=one.mesh_size: told(
                f"{s:g} m mesh: {what}", a + b * done
            ),
        )
        (cell,) = result.cells.values()
        spectra.append(cell.spectra)
        whole &= cell.spectra.resolved & cell.coverage.excites(cell.spectra.mid_band)
    return MeshComparison(
        sizes=(both[0].mesh_size, both[1].mesh_size),
        case=both[0].cases[0].name,
        road=next(iter(both[0].roads)),
        method=both[0].methods[0].name,
        points=spectra[0].point_names,
        bands=spectra[0].mid_band[whole],
        levels=np.sqrt([np.mean(s.values[:, :, whole] ** 2, axis=0) for s in spectra]),
    )
