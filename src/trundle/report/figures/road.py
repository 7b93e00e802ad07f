"""Draw road roughness: spectra of the classes, and one profile of some of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from trundle.report.canvas import COLOURS, Drawing, make_logarithmic, new_figure
from trundle.results.study_result import StudyResult
from trundle.road import CLASS_NAMES, FITTED_RANGE, RoadClass, RoughnessBand, synthesise

__all__ = ["drawings"]


def drawings(result: StudyResult) -> Iterator[Drawing]:
    """Give the spectra of all classes, and a profile of some.

    Yields
    ------
    Drawing
        One after the other, as they stand on the page.
    """
    study = result.study
    yield Drawing(
        name="roughness",
        title="Road roughness of ISO 8608",
        caption="Displacement PSD of classes A to H: geometric mean (line) and limits (band).",
        draw=roughness_figure,
    )
    yield Drawing(
        name="profiles",
        title="Profiles of classes A to D",
        caption=f"One realisation at the classes' upper limits, {study.band}.",
        draw=lambda: profiles_figure(study.band, study.seed),
    )


def roughness_figure() -> Figure:
    """Draw Gd(n) of the eight classes with their limits."""
    figure, (axes,) = new_figure(7.2, 4.2)
    n = np.array([0.01, 10.0])
    for i, name in enumerate(CLASS_NAMES):
        mean = RoadClass(name).displacement_psd(n)
        lower, upper = (RoadClass(name, level=x).displacement_psd(n) for x in ("lower", "upper"))
        axes.fill_between(n, lower, upper, color=COLOURS[i % 2], alpha=0.16, linewidth=0)
        axes.plot(n, mean, color=COLOURS[i % 2])
        axes.annotate(name, (n[1], mean[1]), xytext=(5, 0), textcoords="offset points", va="center")
    axes.axvspan(*FITTED_RANGE, ymax=0.02, color="#000000", alpha=0.6)
    axes.annotate(
        "fitted range of ISO 8608",
        (0.18, 0.0),
        xycoords=("data", "axes fraction"),
        xytext=(0, 8),
        textcoords="offset points",
        ha="center",
    )
    make_logarithmic(axes, "xy")
    axes.set(
        xlim=(0.01, 10.0),
        xlabel="spatial frequency n [cycle/m]",
        ylabel="displacement PSD Gd(n) [m³]",
    )
    return figure


def profiles_figure(band: RoughnessBand, seed: int, *, length: float = 100.0) -> Figure:
    """Draw one profile of classes A to D, upper limits, one phase set."""
    figure, (axes,) = new_figure(7.2, 3.2)
    for i, name in enumerate("DCBA"):
        profile = synthesise(
            RoadClass(name, level="upper"),
            length=length,
            rng=np.random.default_rng(seed),
            band=band,
        )
        s = np.linspace(0.0, length, 2001)
        axes.plot(s, 100.0 * profile.at(s)[0], color=COLOURS[3 - i], label=f"class {name}")
    axes.set(xlabel="distance [m]", ylabel="elevation [cm]", xlim=(0.0, length))
    axes.legend(ncols=4, loc="upper center", bbox_to_anchor=(0.5, 1.14))
    return figure
