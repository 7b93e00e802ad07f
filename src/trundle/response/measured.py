"""Look at a measured record as at a run: the same levels, held against the same criteria."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from trundle._typing import Array
from trundle.response.reduction import RunLevels, reduce_runs
from trundle.response.spectra import BandSpectra, SpectrumQuantity
from trundle.signals import Averaging, Record, record_warnings, wide_motion_of
from trundle.simulate import Runs

__all__ = ["reduce_record", "runs_of", "without_short_bands"]


def reduce_record(
    record: Record,
    *,
    high_pass: float = 0.5,
    averaging: Averaging = "max_1s",
    quantities: Iterable[SpectrumQuantity] = (),
) -> tuple[Runs, RunLevels]:
    """Return a record as one run, its channels as points, and its levels.

    Bands of which the record holds fewer than 8 periods are not resolved.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the band levels.
    quantities : iterable of SpectrumQuantity
        Spectra wanted beside that of velocity.
    """
    motion, seen = wide_motion_of(record, high_pass=high_pass)
    wide = runs_of(record, motion, seen.start, high_pass=high_pass)
    wide = replace(wide, warnings=record_warnings(record))
    reduced = reduce_runs(wide, averaging=averaging, quantities=quantities, record=seen)
    return _seen(wide, seen), without_short_bands(reduced, record)


def runs_of(
    record: Record, motion: tuple[Array, Array, Array], before: int, *, high_pass: float
) -> Runs:
    """Return the motion of a record's channels as that of points in one run, without doubts.

    Parameters
    ----------
    record : Record
        The record.
    motion : tuple of three ndarray of float, shape (n_channels, n_steps)
        Displacement, velocity and acceleration [m], [m/s], [m/s2].
    before : int
        Steps before time 0.
    high_pass : float
        Frequency below which motion was taken for drift [Hz].
    """
    horizontal = tuple(i for i, axis in enumerate(record.axes) if axis == "horizontal")
    displacement, velocity, acceleration = (np.ascontiguousarray(x.T)[None] for x in motion)
    n_steps, fs = velocity.shape[1], record.sampling_frequency
    return Runs(
        time=(np.arange(n_steps) - before) / fs,
        displacement=displacement,
        velocity=velocity,
        acceleration=acceleration,
        contact_forces=np.zeros((1, n_steps, 0)),
        point_names=record.channel_names,
        contact_names=(),
        seed=0,
        method=f"measured {record.quantity}, high-pass {high_pass:g} Hz",
        f_max=0.5 * fs,
        horizontal=horizontal,
    )


def _seen(wide: Runs, seen: slice) -> Runs:
    return replace(
        wide,
        time=wide.time[seen],
        displacement=wide.displacement[:, seen],
        velocity=wide.velocity[:, seen],
        acceleration=wide.acceleration[:, seen],
        contact_forces=wide.contact_forces[:, seen],
    )


def without_short_bands(reduced: RunLevels, record: Record) -> RunLevels:
    """Return levels without those of bands of which the record holds fewer than 8 periods."""

    def held(spectra: BandSpectra) -> BandSpectra:
        """Return a spectrum whose low bands are not resolved."""
        short = spectra.mid_band < record.lowest_frequency * (1.0 - 1e-9)
        values = np.where(short, np.nan, spectra.values)
        return replace(spectra, values=values, resolved=spectra.resolved & ~short)

    more = {name: held(spectra) for name, spectra in reduced.more.items()}
    return replace(reduced, spectra=held(reduced.spectra), more=more)
