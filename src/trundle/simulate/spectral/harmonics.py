"""Answer for every wave of a random road at once: pseudo-excitation.

A Gaussian road is a sum of waves of independent random amplitudes. The system is linear; so the
variance of any response at any time is the sum of squares of its answers to the waves, each taken
as a cosine and a sine of the amplitude that the spectrum gives it. No sampling is involved.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from trundle._checks import count
from trundle._progress import Progress
from trundle._typing import Array
from trundle.errors import InputError
from trundle.simulate.ensembles import batch_size, mean_of, part_of
from trundle.simulate.layout import Layout
from trundle.simulate.runs import MeanResponse
from trundle.simulate.sources.source import WaveSet
from trundle.simulate.wheels.roads import RoadUnderWheels, roads_under_wheels
from trundle.simulate.wheels.timeline import columns_of

__all__ = ["Harmonics", "harmonics", "mean_response"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Harmonics:
    """Hold answers to some waves of unit amplitude: real part to the cosine, imaginary to the sine.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time of the record [s].
    phase : ndarray of float, shape (n_waves, n_steps)
        Phase of each wave under the front axle [rad]; answers turn about as fast as it.
    power, coarse_power : ndarray of float, shape (n_waves,)
        As in `Waves` [m2].
    displacement, velocity, acceleration : ndarray of complex, shape (n_waves, n_steps, n_points)
        Response at the points for each metre of amplitude.
    contact_forces : ndarray of complex, shape (n_waves, n_steps, n_contacts)
        Dynamic forces under the wheels [N/m].
    mean : MeanResponse
        Response to the static loads alone, computed beside them.
    f_max : float
        Highest frequency that modes and step show as it is [Hz].
    """

    time: Float[Array, " steps"]
    phase: Float[Array, "waves steps"]
    power: Float[Array, " waves"]
    coarse_power: Float[Array, " waves"]
    displacement: Complex[Array, "waves steps points"]
    velocity: Complex[Array, "waves steps points"]
    acceleration: Complex[Array, "waves steps points"]
    contact_forces: Complex[Array, "waves steps contacts"]
    mean: MeanResponse
    f_max: float = np.inf


def mean_response(layout: Layout) -> MeanResponse:
    """Return the response to the static loads alone, with given profiles but no random road."""
    road = roads_under_wheels(layout.sources, layout.timeline, range(0), 0, smooth=1)
    return mean_of(layout, layout.over(road))


def harmonics(
    layout: Layout, *, n_waves: int = 400, progress: Progress | None = None
) -> Iterator[Harmonics]:
    """Answer for the waves of every random road, some at a time.

    Parameters
    ----------
    layout : Layout
        What drives where, from `lay_out`; its integration must be `Modal`.
    n_waves : int
        Waves to each road; each costs two runs (times the wheel tracks of the vehicle).
    progress : callable, optional
        Told the share done.

    Yields
    ------
    Harmonics
        Answers to the next waves. Sums of squares over all of them are variances.
    """
    n_waves = count("n_waves", n_waves)
    if layout.integration.f_max is None:
        raise InputError("exact statistics step the floor in its modes: choose Modal")
    timeline = layout.timeline
    sets = [
        _Sent(columns=columns, waves=waves)
        for source, begins, columns in columns_of(layout.sources, timeline)
        for waves in source.waves(timeline.time, begins, n_waves)
    ]
    if not sets:
        raise InputError("no crossing drives on a random road: its response has no variance")
    size = max(1, batch_size(layout) // 2)
    total, done = sum(len(sent.waves.n) for sent in sets), 0
    for together in _filled(sets, size):
        count_here = sum(len(sent.waves.n) for sent in together)
        share = (done / total, count_here / total)
        yield _answers(layout, together, progress=part_of(progress, *share))
        done += count_here


@dataclass(frozen=True, kw_only=True, eq=False)
class _Sent:
    """Waves, with the contacts among all that they are sent to."""

    columns: slice
    waves: WaveSet


def _filled(sets: list[_Sent], size: int) -> Iterator[list[_Sent]]:
    """Fill batches of so many waves, roads beside each other."""
    together: list[_Sent] = []
    room = size
    for one in sets:
        at = 0
        while at < len(one.waves.n):
            part = one.waves.part(slice(at, at + room))
            together.append(_Sent(columns=one.columns, waves=part))
            at, room = at + len(part.n), room - len(part.n)
            if room == 0:
                yield together
                together, room = [], size
    if together:
        yield together


def _wave_road(layout: Layout, sets: list[_Sent]) -> RoadUnderWheels:
    """Return unit waves under the wheels: all cosines, then all sines, then no random road."""
    timeline = layout.timeline
    total = sum(len(sent.waves.n) for sent in sets)
    smooth = roads_under_wheels(layout.sources, timeline, range(0), 0, smooth=1)
    shape = (*smooth.push.shape[:2], 2 * total + 1)
    road = RoadUnderWheels(push=np.zeros(shape), start=np.zeros(shape[1:]))
    road.push[..., -1], road.start[..., -1] = smooth.push[..., 0], smooth.start[..., 0]
    at = 0
    for sent in sets:
        cosine = slice(at, at + len(sent.waves.n))
        sine = slice(total + cosine.start, total + cosine.stop)
        for i, (felt, first) in enumerate(sent.waves.pushes(), start=sent.columns.start):
            for place, take in ((cosine, np.real), (sine, np.imag)):
                road.push[:, i, place] = take(felt)
                road.start[i, place] = take(first)
        at = cosine.stop
    return road


def _answers(layout: Layout, sets: list[_Sent], *, progress: Progress | None) -> Harmonics:
    road = _wave_road(layout, sets)
    weight = np.zeros(road.n_runs)
    weight[-1] = 1.0
    everything = layout.over(road, weight=weight, progress=progress)
    record = everything.columns(slice(0, -1))
    phases = [sent.waves.phase()[:, layout.timeline.n_run_in :] for sent in sets]
    return Harmonics(
        time=layout.time,
        phase=np.concatenate(phases),
        power=np.concatenate([sent.waves.power for sent in sets]),
        coarse_power=np.concatenate([sent.waves.coarse_power for sent in sets]),
        displacement=_complex(record.displacement),
        velocity=_complex(record.velocity),
        acceleration=_complex(record.acceleration),
        contact_forces=_complex(record.forces),
        mean=mean_of(layout, everything),
        f_max=layout.f_max,
    )


def _complex(values: Array) -> Array:
    cosine, sine = np.split(np.transpose(values, (2, 0, 1)), 2)
    return cosine + 1j * sine
