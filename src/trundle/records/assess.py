"""Hold a measured record against criteria, beside a simulation if there is one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr
from jaxtyping import Float

from trundle._html import html_table
from trundle._kinds import kinds_checked
from trundle._progress import Tell, silent
from trundle._typing import Array
from trundle.criteria import (
    BY_FREQUENCY,
    Criterion,
    Verdict,
    assess_reduced,
    spectra_asked_for,
)
from trundle.errors import FitnessWarning, InputError
from trundle.records.doses import PeriodDose, doses
from trundle.records.events import ChannelEvents, find_events
from trundle.records.survey import Survey
from trundle.records.surveying import Surveyor
from trundle.response import (
    RunLevels,
    SectionLevels,
    SpectrumQuantity,
    join_sections,
    level_warnings,
    reduce_section,
)
from trundle.results.owned import check_unchanged
from trundle.results.zarr_check import check_whole, check_zarr
from trundle.signals import (
    Averaging,
    Record,
    band_limit,
    doubtful_channels,
    record_sections,
    record_warnings,
)

__all__ = ["RecordResult", "Simulated", "assess_record", "read_simulated"]

_STORED = (
    "band_velocity",
    "case",
    "road",
    "method_name",
    "point",
    "band",
)  # arrays of a results store


@dataclass(frozen=True, kw_only=True, eq=False)
class Simulated:
    """Hold simulated band levels to lay a record over.

    Attributes
    ----------
    title : str
        Case, road and point.
    mid_band : ndarray of float, shape (n_bands,)
        Mid-band frequencies [Hz].
    levels : ndarray of float, shape (3, n_bands)
        5, 50 and 95 % of the runs [m/s].
    """

    title: str
    mid_band: Float[Array, " bands"]
    levels: Float[Array, "3 bands"]


@dataclass(frozen=True, kw_only=True, eq=False)
class RecordResult:
    """Hold what is said of a record.

    Attributes
    ----------
    record : Record
        The record in SI.
    doubts : tuple of FitnessWarning
        What is doubtful about it.
    reduced : RunLevels
        Levels and peaks of every channel.
    criteria : tuple of Criterion
        What it is held against.
    verdicts : tuple of Verdict
        By channel, then by criterion.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of band levels.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].
    survey : Survey
        How it runs: levels over time, spectra, doses.
    events : tuple of ChannelEvents
        What stands out of it, one for each channel.
    doses : tuple of PeriodDose
        Vibration dose values of days and nights, or of the record.
    simulated : tuple of Simulated
        Simulations laid beside it.
    """

    record: Record
    doubts: tuple[FitnessWarning, ...]
    reduced: RunLevels
    criteria: tuple[Criterion, ...]
    verdicts: tuple[Verdict, ...]
    averaging: Averaging
    high_pass: float
    survey: Survey
    events: tuple[ChannelEvents, ...]
    doses: tuple[PeriodDose, ...]
    simulated: tuple[Simulated, ...] = ()

    def __repr__(self) -> str:
        """Say in a line what is said of the record."""
        names = ", ".join(self.record.channel_names)
        said = "; ".join(map(str, self.verdicts)) or "held against nothing"
        return f"<RecordResult of {self.record.source!r}, {names}: {said}>"

    def _repr_html_(self) -> str:
        """Show the verdicts as a table."""
        return html_table(
            self.record.source,
            ("channel", "axis", "criterion", "verdict", "margin"),
            (
                (v.point, v.axis, v.criterion.title, v.status, f"{v.margin:.3g}")
                for v in self.verdicts
            ),
        )

    @property
    def warnings(self) -> tuple[FitnessWarning, ...]:
        """Return the doubts about the record, and about levels of one passage."""
        length = self.record.samples.shape[1] / self.record.sampling_frequency
        return (*self.doubts, *level_warnings(self.averaging, length))


@kinds_checked
def assess_record(
    record: Record,
    criteria: Sequence[Criterion],
    *,
    averaging: Averaging = "max_1s",
    high_pass: float = 0.5,
    events: float = 1.0,
    simulated: Sequence[Simulated] = (),
    tell: Tell = silent,
) -> RecordResult:
    """Hold a record against criteria, as a run of a simulation is.

    Parameters
    ----------
    record : Record
        The record.
    criteria : sequence of Criterion
        The curves.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of band levels.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].
    events : float
        How many such events a vibration dose is for.
    simulated : sequence of Simulated
        Simulations to lay beside it.
    tell : callable, optional
        Told which part of the record is read, and the share done.

    Notes
    -----
    A long record is read section by section: beside its samples no more is held than a section,
    some copies of one channel while it is looked at for faults, and running levels.

    A channel that is clipped or hides a gap passes nothing, for its true levels may be higher; nor
    does a record too short for the 1 Hz band pass a single number that weighs it.
    """
    if not 0.05 <= high_pass <= 0.5:
        raise InputError(
            f"the high-pass frequency must take drift off and leave the 1 Hz band whole: 0.05 Hz "
            f"to 0.5 Hz at most; got {high_pass:g} Hz"
        )
    many = tuple(criteria)
    reduced, survey = _read(record, spectra_asked_for(many), averaging, high_pass, tell)
    f_resolved = band_limit(record.sampling_frequency)
    found = assess_reduced(
        reduced, many, percentile=100.0, f_resolved=f_resolved, events=events, axes=record.axes
    )
    doubtful = doubtful_channels(record)
    verdicts = tuple(_unless_in_doubt(verdict, record, doubtful) for verdict in found)
    names = record.channel_names
    return RecordResult(
        record=record,
        doubts=record_warnings(record),
        reduced=reduced,
        criteria=many,
        verdicts=verdicts,
        averaging=averaging,
        high_pass=high_pass,
        survey=survey,
        events=tuple(
            find_events(i, survey.running, [v for v in verdicts if v.point == name], name)
            for i, name in enumerate(names)
        ),
        doses=doses(survey.dose, record.duration, record.begin),
        simulated=tuple(simulated),
    )


def _read(
    record: Record,
    quantities: Sequence[SpectrumQuantity],
    averaging: Averaging,
    high_pass: float,
    tell: Tell,
) -> tuple[RunLevels, Survey]:
    """Read a record section by section; return its levels and how it runs."""
    parts: list[SectionLevels] = []
    surveyor = Surveyor(record, averaging)
    n = record.samples.shape[1]
    for section in record_sections(record, high_pass=high_pass):
        tell(f"levels of {record.source}", section.first / n)
        part = reduce_section(
            record, section, high_pass=high_pass, averaging=averaging, quantities=quantities
        )
        surveyor.take(section, part.felt)
        parts.append(replace(part, felt=part.felt[:, :0]))
    return join_sections(record, parts), surveyor.survey()


def _unless_in_doubt(verdict: Verdict, record: Record, doubtful: Sequence[str]) -> Verdict:
    """Return a verdict that passes nothing whose true level may be higher."""
    if verdict.status != "pass":
        return verdict
    reasons = list(verdict.reasons)
    if verdict.point in doubtful:
        reasons.append("the channel is clipped or hides a gap: its true levels may be higher")
    if record.lowest_frequency > 1.0 and verdict.criterion.quantity not in BY_FREQUENCY:
        reasons.append(f"{record.duration:.3g} s are too short for the lowest motion it weighs")
    return replace(verdict, status="not assessed", reasons=tuple(reasons)) if reasons else verdict


def read_simulated(
    folder: Path, *, point: str | None = None, averaging: Averaging = "max_1s"
) -> tuple[Simulated, ...]:
    """Read the band levels of a results folder, one for each case and road, by its last method.

    Parameters
    ----------
    folder : Path
        A results folder that trundle wrote.
    point : str, optional
        Name of the point; the first unless given.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule that its levels must have.

    Raises
    ------
    InputError
        No such folder, no such point, or levels by another rule.
    """
    store = folder / "results.zarr"
    if not store.is_dir():
        raise InputError(f"{folder}: is no results folder of trundle (no results.zarr in it)")
    check_zarr(store)
    for name in _STORED:
        check_whole(store, name)
    check_unchanged(folder, store.name)
    try:
        return _laid_beside(store, point, averaging)
    except InputError:
        raise
    except Exception as error:  # readers raise whatever damage leads them to
        raise InputError(
            f"{folder}: its band levels are damaged ({type(error).__name__}); run the study again"
        ) from None


def _laid_beside(store: Path, point: str | None, averaging: Averaging) -> tuple[Simulated, ...]:
    """Return the levels of a store at a point, one for each case and road."""
    folder = store.parent
    # Attributes of a stranger are not obeyed: none is a scale, a mask or a calendar.
    with xr.open_zarr(store, zarr_format=2, consolidated=False, decode_cf=False) as data:
        points = [str(name) for name in data["point"].values]
        names = (*points, *map(str, data["case"].values), *map(str, data["road"].values))
        if not all(name.isprintable() for name in names):
            raise InputError(f"{folder}: has names with control characters, which trundle refuses")
        if point is not None and point not in points:
            raise InputError(f"{folder}: no point {point!r}; there are {', '.join(points)}")
        rule = str(data["band_velocity"].attrs["long_name"]).rpartition(", ")[2]
        if rule != averaging:
            raise InputError(
                f"{folder}: its levels are averaged by {rule}, and the record's by {averaging}, "
                f"which may be several times apart; say --averaging {rule}"
            )
        name = point or points[0]
        levels = data["band_velocity"].isel(method_name=-1).sel(point=name).load()
    levels = levels.transpose("case", "road", "run", "band")
    mid_band = np.asarray(levels["band"].values, float)
    found = []
    for case in levels["case"].values:
        for road in levels["road"].values:
            values = levels.sel(case=case, road=road).values
            found.append(
                Simulated(
                    title=f"{case}, class {road}, {name}",
                    mid_band=mid_band,
                    levels=np.percentile(values, [5.0, 50.0, 95.0], axis=0),
                )
            )
    return tuple(found)
