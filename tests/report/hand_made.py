"""Results that are made by hand, so that every number is known, and pages as readers read them."""

from __future__ import annotations

from html.parser import HTMLParser

import numpy as np

import trundle as tr
from studies import GOOD
from trundle.criteria import ClassMap, assess_reduced, find_criterion
from trundle.response import RunLevels
from trundle.response.spectra import BandSpectra
from trundle.results.cells import Cell, CellKey, History
from trundle.results.provenance import provenance_of
from trundle.results.study_result import StudyResult
from trundle.signals import mid_band_frequencies
from trundle.simulate import Coverage

BANDS = mid_band_frequencies(0, 19)
"""From 1 to 80 Hz."""

FACTORS = np.array([0.5, 1.0, 4.0])
"""Of three runs: their median is 1, and 95 % of them stay below 3.7."""


def study_of(text="", *changes):
    """Return the small study with some texts replaced, and others added."""
    given = GOOD
    for old, new in changes:
        assert given.count(old) == 1
        given = given.replace(old, new)
    return tr.study_from_text(given + text)


def levels_of(names, level, *, shown_to=np.inf):
    """Return spectra of three runs, as loud at each point and band as is said [m/s]."""
    level = np.asarray(level, float)
    level = level if level.ndim == 2 else np.broadcast_to(level, (len(names),))[:, None]
    level = np.broadcast_to(level, (len(names), len(BANDS)))
    resolved = shown_to >= BANDS
    values = FACTORS[:, None, None] * level
    values[:, :, ~resolved] = np.nan
    spectra = BandSpectra(
        mid_band=BANDS, values=values, times=np.full(values.shape, np.nan), resolved=resolved,
        averaging="max_1s", point_names=tuple(names),
    )  # fmt: skip
    one = FACTORS[:, None] * level.max(axis=1)
    numbers = {
        "peak_acceleration": 100.0 * one,
        "peak_time": 2.0 + 0.0 * one,
        "rms_velocity": one / 3.0,
        "response_factor": 1e4 * one,
        "vdv": 10.0 * one,
        "weighted_rms": 5.0 * one,
        "peak_contact_force": np.full((3, 2), 6e4),
        "tension": np.zeros((3, 2), bool),
    }
    return RunLevels(numbers=numbers, spectra=spectra, more={})


def cell_of(study, key, level, *, coverage=None, shown_to=np.inf):
    """Return a cell of such levels; its first run swings at 1 Hz, each point ten times the last."""
    names = tuple(study.points)
    time = np.linspace(0.0, 4.0, 401)
    wave = np.sin(2.0 * np.pi * time)[:, None] * 10.0 ** np.arange(len(names)) * 0.01
    return Cell(
        key=key,
        reduced=levels_of(names, level, shown_to=shown_to),
        contact_names=("front", "rear"),
        exact=None,
        exact_peaks=None,
        truncation=None,
        history=History(
            time=time, displacement=wave, velocity=wave, acceleration=wave,
            contact_forces=np.zeros((len(time), 2)),
        ),
        f_resolved=min(shown_to, 100.0),
        coverage=coverage or Coverage(),
        warnings=(),
    )  # fmt: skip


def result_of(study, level=1e-5, **more):
    """Return a result whose levels are a number, or what a function says of each cell [m/s].

    A function takes the cell's key, and returns one level, one for each point, or for each point
    and band.
    """
    keys = [
        CellKey(case.name, road, method.name)
        for case in study.cases
        for road in study.roads
        for method in study.methods
    ]
    cells = {
        key: cell_of(study, key, level(key) if callable(level) else level, **more) for key in keys
    }
    assessment = study.assessment
    verdicts = {
        key: assess_reduced(
            cell.reduced, assessment.criteria, percentile=assessment.percentile,
            f_resolved=cell.f_resolved, coverage=cell.coverage, axes=study.point_ways,
        )
        for key, cell in cells.items()
        if assessment is not None and key.method == assessment.method
    }  # fmt: skip
    return StudyResult(
        study=study, cells=cells, verdicts=verdicts, maps={}, days={}, modes=None, mesh=None,
        provenance=provenance_of(study),
    )  # fmt: skip


def class_map_of(grids, margins, *, complete=True, share=0.25):
    """Return a map of vertical motion with margins to criteria by name, each at every place."""
    places = np.concatenate([grid.xy for grid in grids])
    margin = np.array([np.broadcast_to(m, len(places)) for m in margins.values()], float)
    return ClassMap(
        places=places,
        criteria=tuple(find_criterion(name) for name in margins),
        margin=margin,
        governing_band=np.where(np.isnan(margin), np.nan, 10.0),
        share_exceeding=np.where(np.isnan(margin), np.nan, share),
        applies=np.ones(margin.shape, bool),
        complete=(complete,) * len(margins),
        percentile=95.0,
    )


class Page(HTMLParser):
    """A page as it is read: sections by id, their tables row by row, and every tag that is there."""

    VOID = frozenset({"meta", "img", "br", "input", "link"})

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.tags, self.ids, self.headings, self.words = [], [], [], {}
        self.tables, self.classes, self.links, self.images = {}, {}, [], []
        self._open, self._section, self._cell = [], "", None
        self.feed(text)
        self.close()
        assert not self._open, f"never closed: {self._open}"

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.tags.append(tag)
        if tag not in self.VOID:
            self._open.append(tag)
        if "id" in given:
            self.ids.append(given["id"])
        if tag == "a":
            self.links.append(given["href"])
        if tag == "img":
            self.images.append(given)
        if tag in {"section", "header"}:
            self._section = given.get("id", tag)
        elif tag == "table":
            self.tables.setdefault(self._section, []).append([])
            self.classes.setdefault(self._section, []).append([])
        elif tag == "tr":
            self.tables[self._section][-1].append([])
            self.classes[self._section][-1].append([])
        elif tag in {"td", "th"}:
            self._cell = []
            self.classes[self._section][-1][-1].append(given.get("class", ""))
        elif tag in {"h1", "h2", "h3"}:
            self.headings.append("")

    def handle_endtag(self, tag):
        assert self._open, f"{tag} was never opened"
        assert self._open.pop() == tag
        if tag in {"td", "th"}:
            self.tables[self._section][-1][-1].append(" ".join("".join(self._cell).split()))
            self._cell = None

    def handle_data(self, data):
        inside = set(self._open)
        if inside & {"script", "style"}:
            return
        if self._cell is not None:
            self._cell.append(data)
        if inside & {"h1", "h2", "h3"}:
            self.headings[-1] += data
        self.words[self._section] = self.words.get(self._section, "") + data

    def said(self, section):
        """Return what stands in a section, in one line."""
        return " ".join(self.words[section].split())

    def rows(self, section, number=0):
        """Return the rows of one of its tables as dictionaries by heading, first names first."""
        head, *rest = self.tables[section][number]
        return [dict(reversed(list(zip(head, row, strict=False)))) for row in rest]
