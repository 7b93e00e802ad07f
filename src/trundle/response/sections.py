"""Reduce a record of any length section by section, to the levels of the whole.

Filters are filled by what lies before a section, and running averages begin before it, so that
nothing is lost at a seam; sums over time are taken over a section alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.response.measured import runs_of, without_short_bands
from trundle.response.quantities import QUANTITIES
from trundle.response.reduction import RunLevels, felt_of, histories_of
from trundle.response.spectra import BandSpectra, SpectrumQuantity, spectra_of
from trundle.signals import Averaging, Record, Section
from trundle.simulate import Runs

__all__ = ["SectionLevels", "join_sections", "reduce_section"]

_LEAD = 12.0  # s before a section: a running average of 1 s, or of 12 time constants


@dataclass(frozen=True, kw_only=True, eq=False)
class SectionLevels:
    """Hold what is kept of a section.

    Attributes
    ----------
    n_steps : int
        How many samples it is of.
    levels : RunLevels
        Its levels; times are those of the record.
    felt : ndarray of float, shape (n_channels, n_wide)
        Weighted acceleration, beside the section too [m/s2].
    """

    n_steps: int
    levels: RunLevels
    felt: Float[Array, "channels wide"]


def reduce_section(
    record: Record,
    section: Section,
    *,
    high_pass: float,
    averaging: Averaging,
    quantities: Iterable[SpectrumQuantity] = (),
) -> SectionLevels:
    """Reduce the motion of a section as `reduce_record` does that of a record.

    Parameters
    ----------
    record : Record
        The record.
    section : Section
        One of its sections.
    high_pass : float
        Frequency below which motion was taken for drift [Hz].
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the band levels.
    quantities : iterable of SpectrumQuantity
        Spectra wanted beside that of velocity.
    """
    fs, seen = record.sampling_frequency, section.seen
    runs = runs_of(record, section.motion, seen.start - section.first, high_pass=high_pass)
    lead = 0 if section.begins else 4 * round(_LEAD * fs / 4.0)
    longer = slice(seen.start - lead, seen.stop)
    felt, base = felt_of(runs)
    alone, led = (histories_of(runs, felt, base, part) for part in (seen, longer))
    numbers = {q.name: q.measure(led if q.name == "response_factor" else alone) for q in QUANTITIES}
    wanted = dict.fromkeys(quantities)
    wanted.pop("band_rms_velocity", None)

    def spectrum(name: SpectrumQuantity) -> BandSpectra:
        """Return levels in the section."""
        sums = averaging == "event" and "_rms_" in name
        goes_on = (not section.begins, not section.ends)
        return _spectrum(runs, name, averaging, seen if sums else longer, goes_on)

    return SectionLevels(
        n_steps=section.n_seen,
        levels=RunLevels(
            numbers=numbers,
            spectra=spectrum("band_rms_velocity"),
            more={name: spectrum(name) for name in wanted},
        ),
        felt=felt[0],
    )


def _spectrum(
    runs: Runs,
    name: SpectrumQuantity,
    averaging: Averaging,
    part: slice,
    goes_on: tuple[bool, bool],
) -> BandSpectra:
    """Return levels of a part, at the times of the record."""
    found = spectra_of(runs, name, averaging=averaging, record=part, goes_on=goes_on)
    return replace(found, times=found.times + max(float(runs.time[part.start]), 0.0))


def join_sections(record: Record, parts: Sequence[SectionLevels]) -> RunLevels:
    """Return the levels of a record from those of all its sections.

    Parameters
    ----------
    record : Record
        The record.
    parts : sequence of SectionLevels
        In their order.
    """
    levels = [part.levels for part in parts]
    n = np.array([part.n_steps for part in parts], float)
    more: dict[SpectrumQuantity, BandSpectra] = {
        name: _joined([one.more[name] for one in levels], n) for name in levels[0].more
    }
    whole = RunLevels(
        numbers=_numbers([one.numbers for one in levels], n),
        spectra=_joined([one.spectra for one in levels], n),
        more=more,
    )
    return without_short_bands(whole, record)


def _numbers(parts: Sequence[Mapping[str, Array]], n: Float[Array, " parts"]) -> dict[str, Array]:
    """Join single numbers, each by its own rule."""
    weight = (n / n.sum())[:, None, None]
    rules: dict[str, Callable[[Array], Array]] = {
        "largest": lambda x: x.max(axis=0),
        "rms": lambda x: np.sqrt(np.sum(weight * x**2, axis=0)),
        "dose": lambda x: np.sum(x**4, axis=0) ** 0.25,
    }
    at = np.stack([part["peak_acceleration"] for part in parts]).argmax(axis=0)[None]
    found = {}
    for q in QUANTITIES:
        values = np.stack([part[q.name] for part in parts])
        if q.joined == "at largest":
            found[q.name] = np.take_along_axis(values, at, axis=0)[0]
        else:
            found[q.name] = rules[q.joined](values)
    return found


def _joined(parts: Sequence[BandSpectra], n: Float[Array, " parts"]) -> BandSpectra:
    """Join levels: the largest and when it was, or over the whole time where that is the rule."""
    values, times = np.stack([p.values for p in parts]), np.stack([p.times for p in parts])
    first = parts[0]
    if first.averaging == "event" and "_rms_" in first.quantity:
        weight = (n / n.sum())[:, None, None, None]
        return replace(first, values=np.sqrt(np.sum(weight * values**2, axis=0)))
    at = np.where(np.isnan(values), -np.inf, values).argmax(axis=0)[None]
    return replace(
        first,
        values=np.take_along_axis(values, at, axis=0)[0],
        times=np.take_along_axis(times, at, axis=0)[0],
    )
