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
from trundle.road import RoadClass, RoughnessBand, track_coherence, wave_power
from trundle.simulate.crossing import Crossing
from trundle.simulate.ensembles import batch_size, mean_of, part_of
from trundle.simulate.layout import Layout
from trundle.simulate.runs import MeanResponse
from trundle.simulate.wheels.roads import RoadUnderWheels, roads_under_wheels
from trundle.simulate.wheels.timeline import columns_of, contact_springs

__all__ = ["Harmonics", "Waves", "harmonics", "mean_response", "place_waves"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Waves:
    """Hold the waves that stand for a random road.

    Attributes
    ----------
    n : ndarray of float, shape (n_waves,)
        Spatial frequencies, rising [cycle/m].
    power : ndarray of float, shape (n_waves,)
        Variance of the elevation that each stands for [m2].
    coarse_power : ndarray of float, shape (n_waves,)
        The same if only every other wave stood for the road, 0 for the rest [m2].
    """

    n: Float[Array, " waves"]
    power: Float[Array, " waves"]
    coarse_power: Float[Array, " waves"]


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


def place_waves(
    road: RoadClass,
    band: RoughnessBand,
    n_waves: int,
    *,
    resonances: Float[Array, "modes 2"],
) -> Waves:
    """Place waves over a band, dense where what they excite is narrow.

    Parameters
    ----------
    road : RoadClass
        Spectrum.
    band : RoughnessBand
        Spatial frequencies.
    n_waves : int
        How many, odd numbers being made even.
    resonances : ndarray of float, shape (n_modes, 2)
        Resonances of the vehicle: spatial frequency at its speed [cycle/m], damping ratio.

    Notes
    -----
    Waves lie evenly in the integral of the density ``1 / n + sum 1 / |n - n_i + i zeta_i n_i|``:
    a floor's bandwidth grows with its frequency, a vehicle's few resonances are sharp. Each wave
    stands for the whole power between the middles of its neighbours, so none is lost.
    """
    fine = np.geomspace(band.n_min, band.n_max, 20001)
    density = 2.0 / fine
    for n_i, zeta in resonances:
        density += 0.5 / np.hypot(fine - n_i, max(zeta, 0.01) * n_i)
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(fine)
    inside = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = (np.arange(n_waves + n_waves % 2) + 0.5) / (n_waves + n_waves % 2) * inside[-1]
    n = np.interp(wanted, inside, fine)
    coarse = np.zeros_like(n)
    coarse[::2] = wave_power(road, band, n[::2])
    return Waves(n=n, power=wave_power(road, band, n), coarse_power=coarse)


def mean_response(layout: Layout) -> MeanResponse:
    """Return the response to the static loads alone, with given profiles but no random road."""
    road = roads_under_wheels(layout.crossings, layout.timeline, range(0), 0, smooth=1)
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
    sets = [
        part
        for crossing, columns in columns_of(layout.crossings)
        if isinstance(crossing.road, RoadClass)
        for part in _wave_sets(layout, crossing, columns, n_waves)
    ]
    if not sets:
        raise InputError("no crossing drives on a random road: its response has no variance")
    size = max(1, batch_size(layout) // 2)
    total, done = sum(len(part.n) for part in sets), 0
    for together in _filled(sets, size):
        count_here = sum(len(part.n) for part in together)
        share = (done / total, count_here / total)
        yield _answers(layout, together, progress=part_of(progress, *share))
        done += count_here


@dataclass(frozen=True, kw_only=True, eq=False)
class _WaveSet:
    """Waves of one road, as one independent source sends them to the wheels of one crossing."""

    columns: slice  # contacts
    n: Array
    power: Array
    coarse_power: Array
    share: Array  # (n_waves, n_contacts): of the unit amplitude, at each wheel's track

    def part(self, which: slice) -> _WaveSet:
        return _WaveSet(
            columns=self.columns,
            n=self.n[which],
            power=self.power[which],
            coarse_power=self.coarse_power[which],
            share=self.share[which],
        )


def _wave_sets(
    layout: Layout, crossing: Crossing, columns: slice, n_waves: int
) -> Iterator[_WaveSet]:
    assert isinstance(crossing.road, RoadClass)  # the caller has looked
    speed = float(layout.timeline.speed[:, columns].max())
    waves = place_waves(
        crossing.road, crossing.band, n_waves, resonances=_resonances(crossing, speed)
    )
    shortest = 2.0 * waves.n[-1] * speed * layout.integration.dt
    if shortest > 1.0 + 1e-9:
        raise InputError(
            f"route {crossing.route.name!r}: waves of {waves.n[-1]:g} cycle/m at {speed:.3g} m/s "
            f"need a time step of at most {layout.integration.dt / shortest:.3g} s"
        )
    tracks, which = np.unique(crossing.vehicle.lateral, return_inverse=True)
    mixing = _mixing(waves.n, np.abs(tracks[:, None] - tracks))
    for source in range(len(tracks)):
        yield _WaveSet(
            columns=columns,
            n=waves.n,
            power=waves.power,
            coarse_power=waves.coarse_power,
            share=mixing[:, which, source],
        )


def _filled(sets: list[_WaveSet], size: int) -> Iterator[list[_WaveSet]]:
    """Fill batches of so many waves, roads beside each other."""
    together: list[_WaveSet] = []
    room = size
    for one in sets:
        at = 0
        while at < len(one.n):
            part = one.part(slice(at, at + room))
            together.append(part)
            at, room = at + len(part.n), room - len(part.n)
            if room == 0:
                yield together
                together, room = [], size
    if together:
        yield together


def _mixing(n: Array, distance: Array) -> Array:
    """Return each track's part of independent waves, (n_waves, tracks, sources)."""
    ratio = np.sqrt(track_coherence(n[:, None, None], distance))
    return np.linalg.cholesky(ratio + 1e-10 * np.eye(len(distance)))


def _wave_road(layout: Layout, sets: list[_WaveSet]) -> RoadUnderWheels:
    """Return unit waves under the wheels: all cosines, then all sines, then no random road."""
    timeline = layout.timeline
    total = sum(len(part.n) for part in sets)
    smooth = roads_under_wheels(layout.crossings, timeline, range(0), 0, smooth=1)
    shape = (*timeline.station.shape, 2 * total + 1)
    road = RoadUnderWheels(push=np.zeros(shape), start=np.zeros(shape[1:]))
    road.push[..., -1], road.start[..., -1] = smooth.push[..., 0], smooth.start[..., 0]
    stiffness, damping = contact_springs(layout.crossings)
    at = 0
    for part in sets:
        cosine = slice(at, at + len(part.n))
        sine = slice(total + cosine.start, total + cosine.stop)
        wavenumber = 2.0 * np.pi * part.n
        front = timeline.station[:, part.columns.start]
        rolling = np.exp(1j * front[:, None] * wavenumber)
        for i in range(part.columns.start, part.columns.stop):
            # every wheel of a vehicle follows its first at a fixed distance
            behind = np.exp(1j * (timeline.station[0, i] - front[0]) * wavenumber)
            unit = rolling * (part.share[:, i - part.columns.start] * behind)
            turning = timeline.speed[:, i, None] * wavenumber
            felt = (stiffness[i] + 1j * damping[i] * turning) * unit
            for place, take in ((cosine, np.real), (sine, np.imag)):
                road.push[:, i, place] = take(felt)
                road.start[i, place] = take(unit[0])
        at = cosine.stop
    for crossing, columns in columns_of(layout.crossings):
        if crossing.start == "level":
            road.start[columns] = 0.0
    return road


def _answers(layout: Layout, sets: list[_WaveSet], *, progress: Progress | None) -> Harmonics:
    road = _wave_road(layout, sets)
    weight = np.zeros(road.n_runs)
    weight[-1] = 1.0
    everything = layout.over(road, weight=weight, progress=progress)
    record = everything.columns(slice(0, -1))
    station = layout.timeline.station[layout.timeline.n_run_in :]
    phases = [2.0 * np.pi * part.n[:, None] * station[:, part.columns.start] for part in sets]
    return Harmonics(
        time=layout.time,
        phase=np.concatenate(phases),
        power=np.concatenate([part.power for part in sets]),
        coarse_power=np.concatenate([part.coarse_power for part in sets]),
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


def _resonances(crossing: Crossing, speed: float) -> Array:
    poles = crossing.vehicle.poles()
    frequency = np.abs(poles)
    keep = (np.imag(poles) > 0.0) & (frequency > 0.0)
    return np.column_stack(
        [frequency[keep] / (2.0 * np.pi * speed), -np.real(poles)[keep] / frequency[keep]]
    )
