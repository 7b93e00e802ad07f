"""Make the list of published cases from the tables of the validation page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from pages import DOCS, GENERATED, code, table, write_page

__all__ = ["Row", "rows_of", "write_cases"]

# how the rows of publications, standards and other programs name their source
_PUBLISHED = (
    ("Fryba (1972)", "L. Fryba, *Vibration of Solids and Structures under Moving Loads*, 1972"),
    ("Leissa", "A. W. Leissa, *Vibration of Plates*, NASA SP-160, 1969"),
    (
        "Timoshenko and Woinowsky",
        "S. Timoshenko, S. Woinowsky-Krieger, *Theory of Plates and Shells*, 1959",
    ),
    ("Mindlin (1951)", "R. D. Mindlin, plates with shear deformation, 1951"),
    ("NAFEMS FV12", "NAFEMS benchmark FV12: a free thin square plate"),
    ("NAFEMS FV32", "NAFEMS benchmark FV32: a tapered membrane"),
    ("ISO 8608", "ISO 8608:2016, road surface profiles"),
    ("IEC 61260-1", "IEC 61260-1:2014, octave-band filters"),
    (
        "M. Sorel",
        "M. Sorel, F. Sroubek, *iri*, 2023: the IRI of a measured profile by their program",
    ),
    (
        "MacNeal and Harder",
        "R. H. MacNeal, R. L. Harder, *A proposed standard set of problems*, 1985",
    ),
    ("AISC Design Guide 11", "AISC Design Guide 11, 2nd edition, 2016"),
    ("ISO 8041-1", "ISO 8041-1:2017, weightings"),
    ("OpenSeesPy", "OpenSeesPy: the same floor in another program"),
)
_SECTION = re.compile(r"^## (.+?)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True, kw_only=True)
class Row:
    """Hold one comparison of the validation page."""

    case: str
    quantity: str
    expected: str
    computed: str
    unit: str
    error: str
    tolerance: str
    source: str


def write_cases() -> None:
    """Write the page."""
    rows = list(rows_of((DOCS / "validation.md").read_text("utf-8")))
    parts = ["# Published cases\n", _WORDS.format(n=sum(map(_is_published, rows)))]
    for mark, title in _PUBLISHED:
        some = [row for row in rows if row.source.startswith(mark)]
        parts += _one(title, some) if some else []
    write_page(GENERATED / "cases.md", "\n".join(parts))


_WORDS = """\
What others have printed, what standards define, or what other programs give, beside ours: {n} of the comparisons of
[](../validation.md), from which these tables are taken as they stand. The others hold trundle against closed forms, against invariants, and against integrations made for the purpose. A
difference is relative where it is in per cent, and in the unit of its row otherwise.

The paper that the project began with, T.-C. Pan, A. Mita and J. Li (2001), has a page of its own with its Tables 2 and 3 beside ours: [](paper.md).
"""


def rows_of(page: str) -> Iterator[Row]:
    """Give every comparison of the validation page."""
    for case, text in _SECTION.findall(page):
        for line in text.splitlines():
            cells = [cell.strip() for cell in line.strip().strip("|").split(" | ")]
            if len(cells) == 7 and line.startswith("|") and cells[0] != "quantity":
                names = ("quantity", "expected", "computed", "unit", "error", "tolerance", "source")
                yield Row(case=case, **dict(zip(names, cells, strict=True)))


def _is_published(row: Row) -> bool:
    return any(row.source.startswith(mark) for mark, _ in _PUBLISHED)


def _one(title: str, rows: list[Row]) -> Iterator[str]:
    yield f"\n## {title}\n"
    cases = dict.fromkeys(row.case for row in rows)
    commands = ", ".join(code(f"make validate ONLY={_asked(case)}") for case in cases)
    yield f"{len(rows)} values; {commands} computes them again."
    yield table(
        ("quantity", "theirs", "ours", "unit", "difference", "tolerance"),
        ((r.quantity, r.expected, r.computed, r.unit, r.error, r.tolerance) for r in rows),
        kind="numbers",
    )


def _asked(case: str) -> str:
    """Return what ``make validate`` knows a case by."""
    return '"' + case.replace(" ", " and ") + '"' if " " in case else case
