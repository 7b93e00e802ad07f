"""Look at a measured record as at a run: the same levels, held against the same criteria."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trundle.response.reduction import Reduced
from trundle.response.spectra import BandSpectra
from trundle.signals import Averaging, Record, lost_by_fading, motion_of, record_warnings
from trundle.simulate import Runs

__all__ = ["as_if_not_faded", "runs_of_record", "without_short_bands"]


def runs_of_record(record: Record, *, high_pass: float = 0.5) -> Runs:
    """Return a record as one run, its channels as points.

    Parameters
    ----------
    record : Record
        The record.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].
    """
    displacement, velocity, acceleration = (
        np.ascontiguousarray(part.T)[None] for part in motion_of(record, high_pass=high_pass)
    )
    n_steps, fs = velocity.shape[1], record.sampling_frequency
    return Runs(
        time=np.arange(n_steps) / fs,
        displacement=displacement,
        velocity=velocity,
        acceleration=acceleration,
        contact_forces=np.zeros((1, n_steps, 0)),
        point_names=record.channel_names,
        contact_names=(),
        seed=0,
        method=f"measured {record.quantity}, high-pass {high_pass:g} Hz",
        f_max=0.5 * fs,
        warnings=record_warnings(record),
    )


def without_short_bands(reduced: Reduced, record: Record) -> Reduced:
    """Return levels without those of bands of which the record holds fewer than 8 periods."""

    def held(spectra: BandSpectra) -> BandSpectra:
        """Return a spectrum whose low bands are not resolved."""
        short = spectra.mid_band < record.lowest_frequency * (1.0 - 1e-9)
        values = np.where(short, np.nan, spectra.values)
        return replace(spectra, values=values, resolved=spectra.resolved & ~short)

    more = {name: held(spectra) for name, spectra in reduced.more.items()}
    return replace(reduced, spectra=held(reduced.spectra), more=more)


def as_if_not_faded(
    reduced: Reduced, record: Record, averaging: Averaging, *, high_pass: float = 0.5
) -> Reduced:
    """Return averages over the record as they would be had it not been faded in and out.

    Parameters
    ----------
    reduced : Reduced
        Levels of the faded record.
    record : Record
        The record.
    averaging : {"max_1s", "slow", "fast", "event"}
        Averaging rule of the levels.
    high_pass : float
        Frequency below which motion is taken for drift [Hz].
    """
    rms, dose = lost_by_fading(record, high_pass=high_pass)
    found = replace(reduced, rms_velocity=reduced.rms_velocity * rms, vdv=reduced.vdv * dose)
    if averaging != "event":
        return found

    def louder(spectra: BandSpectra) -> BandSpectra:
        """Return levels averaged over what was not faded."""
        return replace(spectra, values=spectra.values * rms[:, None])

    more = {name: louder(spectra) for name, spectra in found.more.items()}
    return replace(found, spectra=louder(found.spectra), more=more)
