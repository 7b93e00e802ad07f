"""Show what a model comes to, as tables of text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from trundle.imports.summary import ModelSummary

__all__ = ["TextTable", "summary_data", "summary_tables"]

_WAYS = ("along x", "along y", "along z", "about x", "about y", "about z")
_SOUND = 1e-9  # of the largest stiffness: what rigid motions raise by round-off alone


@dataclass(frozen=True, kw_only=True)
class TextTable:
    """Hold a table of text.

    Attributes
    ----------
    title : str
        Above it.
    headings : tuple of str
        Of its columns.
    rows : tuple of tuple of str
        Its cells.
    text_columns : int
        How many of the columns are words.
    """

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    text_columns: int = 1


def summary_tables(found: ModelSummary) -> Iterator[TextTable]:
    """Give the tables of a summary.

    Parameters
    ----------
    found : ModelSummary
        What a model comes to.

    Yields
    ------
    TextTable
        Whole, groups, surfaces, rigid motions, first frequencies.
    """
    yield TextTable(
        title=found.name, headings=("what", "value"), rows=tuple(_whole(found)), text_columns=2
    )
    yield TextTable(
        title="Groups of elements",
        headings=("group", "elements", "how many", "m2 or m", "mass [t]"),
        rows=tuple(
            (one.name, one.kind, str(one.count), f"{one.size:.4g}", f"{one.mass / 1e3:.4g}")
            for one in found.groups
        ),
        text_columns=2,
    )
    yield TextTable(
        title="What wheels and points can stand on",
        headings=("surface", "height [m]", "m2 or m", "x [m]", "y [m]"),
        rows=tuple(
            (
                one.name,
                f"{one.lowest:.4g}"
                + ("" if one.highest - one.lowest < 0.01 else f" to {one.highest:.4g}"),
                f"{one.area:.4g}",
                f"{one.low[0]:.4g} to {one.high[0]:.4g}",
                f"{one.low[1]:.4g} to {one.high[1]:.4g}",
            )
            for one in found.surfaces
        ),
    )
    if found.mass is not None and found.rigid is not None:
        yield TextTable(
            title="Moved as a rigid body, without supports",
            headings=("motion", "mass [t], [t m2]", "force over largest stiffness"),
            rows=tuple(
                (way, f"{mass / 1e3:.5g}", f"{raised:.1e}")
                for way, mass, raised in zip(_WAYS, found.mass, found.rigid, strict=True)
            ),
        )
    if len(found.frequencies):
        yield TextTable(
            title="First natural frequencies, as it is held",
            headings=("mode", "f [Hz]"),
            rows=tuple((str(i), f"{f:.4f}") for i, f in enumerate(found.frequencies, start=1)),
        )


def _whole(found: ModelSummary) -> Iterator[tuple[str, str]]:
    yield "units of the file", found.units or "-"
    yield "nodes", str(found.n_nodes)
    yield "degrees of freedom", str(found.n_dofs)
    for axis, low, high in zip("xyz", found.low, found.high, strict=True):
        yield f"{axis} [m]", f"{low:.4g} to {high:.4g}"
    if found.mass is None:
        yield "mass", "not known" if found.centre is None else "-"
    else:
        yield "mass along z [t]", f"{found.mass[2] / 1e3:.5g}"
    if found.centre is not None:
        yield "centre of mass [m]", ", ".join(f"{value:.4g}" for value in found.centre)
    if found.rigid is not None and found.rigid.max() > _SOUND:
        yield "grounded", "rigid motions raise forces: springs hold it, or elements are not sound"
    if found.unmoved:
        yield "no modes", found.unmoved
    for one in found.told:
        yield "told", one


def summary_data(found: ModelSummary) -> dict[str, object]:
    """Return a summary as plain values, for programs."""
    return {
        "name": found.name,
        "units": found.units,
        "nodes": found.n_nodes,
        "degrees_of_freedom": found.n_dofs,
        "low_m": found.low.tolist(),
        "high_m": found.high.tolist(),
        "groups": [
            {"name": g.name, "elements": g.kind, "count": g.count, "size": g.size,
             "mass_kg": g.mass}
            for g in found.groups
        ],
        "surfaces": [
            {"name": s.name, "heights_m": [s.lowest, s.highest], "area": s.area,
             "low_m": list(s.low), "high_m": list(s.high)}
            for s in found.surfaces
        ],
        "mass_kg_and_kg_m2": None if found.mass is None else found.mass.tolist(),
        "centre_of_mass_m": None if found.centre is None else found.centre.tolist(),
        "rigid_motions": None if found.rigid is None else found.rigid.tolist(),
        "frequencies_hz": found.frequencies.tolist(),
        "no_modes": found.unmoved,
        "told": list(found.told),
    }  # fmt: skip
