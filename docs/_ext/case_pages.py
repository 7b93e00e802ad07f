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
    """Write a page for each source, and one that lists them."""
    rows = list(rows_of((DOCS / "validation.md").read_text("utf-8")))
    found = [
        (_slug(mark), title, some)
        for mark, title in _PUBLISHED
        if (some := [row for row in rows if row.source.startswith(mark)])
    ]
    for slug, title, some in found:
        write_page(GENERATED / "cases" / f"{slug}.md", "\n".join(_one(title, some)))
    listed = table(
        ("source", "values", "cases", "furthest"),
        (
            (f"[{title}](cases/{slug}.md)", str(len(some)), _cases(some), _furthest(some))
            for slug, title, some in found
        ),
    )
    words = _WORDS.format(n=sum(len(some) for _, _, some in found))
    places = "\n".join(f"cases/{slug}" for slug, _, _ in found)
    write_page(GENERATED / "cases.md", words + listed + _TREE.format(places=places))


_TREE = """
```{{toctree}}
:hidden:

{places}
```
"""

_WORDS = """\
# Published cases

What others have printed, what standards define, or what other programs give, beside ours: {n} of the comparisons of
[](../validation.md), from which these tables are taken as they stand, a page a source. The others hold trundle against closed forms, against invariants, and against integrations made for the purpose. A
difference is relative where it is in per cent, and in the unit of its row otherwise; *furthest* is the one that takes most of its tolerance.

The paper that the project began with, T.-C. Pan, A. Mita and J. Li (2001), has a page of its own with its Tables 2 and 3 beside ours: [](paper.md).
"""


def _slug(mark: str) -> str:
    """Return the name of a source's page."""
    return re.sub(r"[^a-z0-9]+", "_", mark.lower()).strip("_")


def _cases(rows: list[Row]) -> str:
    return ", ".join(dict.fromkeys(row.case for row in rows))


def _furthest(rows: list[Row]) -> str:
    """Return the difference that takes the largest share of its tolerance."""

    def share(row: Row) -> float:
        """Return it as a number."""
        error, tolerance = (
            float(text.split()[0].rstrip("%")) for text in (row.error, row.tolerance)
        )
        return abs(error) / tolerance if tolerance else 0.0

    row = max(rows, key=share)
    return f"{_barred(row.quantity)}: {row.error} of {row.tolerance}"


def _barred(text: str) -> str:
    """Return text whose bars stay in their cell."""
    return re.sub(r"(?<!\\)\|", r"\\|", text)


def rows_of(page: str) -> Iterator[Row]:
    """Give every comparison of the validation page."""
    for case, text in _SECTION.findall(page):
        for line in text.splitlines():
            cells = [cell.strip() for cell in line.strip().strip("|").split(" | ")]
            if len(cells) == 7 and line.startswith("|") and cells[0] != "quantity":
                names = ("quantity", "expected", "computed", "unit", "error", "tolerance", "source")
                yield Row(case=case, **dict(zip(names, cells, strict=True)))


def _one(title: str, rows: list[Row]) -> Iterator[str]:
    yield f"# {title}\n"
    cases = dict.fromkeys(row.case for row in rows)
    commands = ", ".join(code(f"make validate ONLY={_asked(case)}") for case in cases)
    again = f"{commands} computes {'it' if len(rows) == 1 else 'them'} again"
    yield f"{len(rows)} value{'' if len(rows) == 1 else 's'}, theirs beside ours; {again}. All cases: [](../cases.md).\n"
    yield table(
        ("quantity", "theirs", "ours", "unit", "difference", "tolerance"),
        ((_barred(r.quantity), r.expected, r.computed, r.unit, r.error, r.tolerance) for r in rows),
        kind="numbers",
    )


def _asked(case: str) -> str:
    """Return what ``make validate`` knows a case by."""
    return '"' + case.replace(" ", " and ") + '"' if " " in case else case
