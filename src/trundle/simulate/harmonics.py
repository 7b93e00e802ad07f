"""Answer for every wave of a random road at once: pseudo-excitation.

A Gaussian road is a sum of waves of independent random amplitudes. The system is linear; so the
variance of any response at any time is the sum of squares of its answers to the waves, each taken
as a cosine and a sine of the amplitude that the spectrum gives it. No sampling is involved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from trundle._checks import count
from trundle._typing import Array
from trundle.dynamics import Modal
from trundle.errors import InputError
from trundle.road import Profile, RoadClass, RoughnessBand, track_coherence, wave_power
from trundle.simulate._drive import Drive, lay_out_drive
from trundle.simulate._schedule import RoadUnderWheels
from trundle.simulate.crossing import Crossing, Interaction
from trundle.simulate.ensemble import as_tuple, batch_size
from trundle.simulate.prepared import PreparedFloor, prepare
from trundle.simulate.runs import MeanResponse
from trundle.structure import Floor

__all__ = ["Harmonics", "Waves", "harmonics", "mean_response", "place_waves"]

Progress = Callable[[float], None]


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
    """

    time: Float[Array, " steps"]
    phase: Float[Array, "waves steps"]
    power: Float[Array, " waves"]
    coarse_power: Float[Array, " waves"]
    displacement: Complex[Array, "waves steps points"]
    velocity: Complex[Array, "waves steps points"]
    acceleration: Complex[Array, "waves steps points"]
    contact_forces: Complex[Array, "waves steps contacts"]


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


def mean_response(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    duration: float | None = None,
) -> MeanResponse:
    """Return the response to the static loads alone, with given profiles but no random road."""
    many, drive = _laid_out(floor, crossings, method, points, duration)
    shape = (*drive.timeline.station.shape, 1)
    road = RoadUnderWheels(elevation=np.zeros(shape), rate=np.zeros(shape))
    for crossing, columns in _columns(many):
        if isinstance(crossing.road, Profile):
            z, slope = crossing.road.at(drive.timeline.station[:, columns])
            road.elevation[:, columns, 0] = z
            road.rate[:, columns, 0] = drive.timeline.speed[:, columns] * slope
    record = drive.over(road)
    return MeanResponse(
        time=drive.time,
        displacement=record.displacement[:, :, 0],
        velocity=record.velocity[:, :, 0],
        acceleration=record.acceleration[:, :, 0],
        contact_forces=record.forces[:, :, 0],
        point_names=tuple(points),
    )


def harmonics(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    *,
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    n_waves: int = 400,
    duration: float | None = None,
    progress: Progress | None = None,
) -> Iterator[Harmonics]:
    """Answer for the waves of every random road, some at a time.

    Parameters
    ----------
    floor : Floor or PreparedFloor
        The floor.
    crossings : Crossing or sequence of Crossing
        One vehicle, or several at once, whose roads are independent.
    method : Decoupled or Coupled
        Method; its integration must be `Modal`.
    points : mapping of str to (x, y)
        Where the response is read [m].
    n_waves : int
        Waves to each road; each costs two runs (times the wheel tracks of the vehicle).
    duration : float, optional
        Length of the record [s], as in `ensemble`.
    progress : callable, optional
        Told the share done.

    Yields
    ------
    Harmonics
        Answers to the next waves. Sums of squares over all of them are variances.
    """
    n_waves = count("n_waves", n_waves)
    if not isinstance(method.integration, Modal):
        raise InputError("exact statistics step the floor in its modes: choose Modal")
    many, drive = _laid_out(floor, crossings, method, points, duration)
    jobs = [(crossing, columns) for crossing, columns in _columns(many) if _is_random(crossing)]
    if not jobs:
        raise InputError("no crossing drives on a random road: its response has no variance")
    size = max(1, batch_size(drive, len(points)) // 2)
    for place, (crossing, columns) in enumerate(jobs):
        for answer, done in _of_one_road(drive, crossing, columns, n_waves, size):
            if progress is not None:
                progress((place + done) / len(jobs))
            yield answer


def _of_one_road(
    drive: Drive, crossing: Crossing, columns: slice, n_waves: int, size: int
) -> Iterator[tuple[Harmonics, float]]:
    assert isinstance(crossing.road, RoadClass)  # the caller has looked
    speed = float(drive.timeline.speed[:, columns].max())
    waves = place_waves(
        crossing.road, crossing.band, n_waves, resonances=_resonances(crossing, speed)
    )
    shortest = 2.0 * waves.n[-1] * speed * drive.integration.dt
    if shortest > 1.0 + 1e-9:
        raise InputError(
            f"route {crossing.route.name!r}: waves of {waves.n[-1]:g} cycle/m at {speed:.3g} m/s "
            f"need a time step of at most {drive.integration.dt / shortest:.3g} s"
        )
    tracks, which = np.unique(crossing.vehicle.lateral, return_inverse=True)
    distance = np.abs(tracks[:, None] - tracks)
    for source in range(len(tracks)):
        for start in range(0, len(waves.n), size):
            part = slice(start, start + size)
            share = _mixing(waves.n[part], distance)[:, which, source]
            road = _wave_road(drive, columns, waves.n[part], share)
            yield (
                _answers(drive, road, waves, part, columns.start),
                (source + min(1.0, part.stop / len(waves.n))) / len(tracks),
            )


def _mixing(n: Array, distance: Array) -> Array:
    """Return each track's part of independent waves, (n_waves, tracks, sources)."""
    ratio = np.sqrt(track_coherence(n[:, None, None], distance))
    return np.linalg.cholesky(ratio + 1e-10 * np.eye(len(distance)))


def _wave_road(drive: Drive, columns: slice, n: Array, share: Array) -> RoadUnderWheels:
    """Return unit waves under the wheels: cosines first, then sines."""
    timeline = drive.timeline
    shape = (*timeline.station.shape, 2 * len(n))
    road = RoadUnderWheels(elevation=np.zeros(shape), rate=np.zeros(shape))
    angle = 2.0 * np.pi * timeline.station[:, columns, None] * n
    turning = 2.0 * np.pi * timeline.speed[:, columns, None] * n
    amplitude = share.T
    wave = amplitude * np.cos(angle), amplitude * np.sin(angle)
    road.elevation[:, columns] = np.concatenate(wave, axis=2)
    road.rate[:, columns] = np.concatenate([-turning * wave[1], turning * wave[0]], axis=2)
    return road


def _answers(
    drive: Drive, road: RoadUnderWheels, waves: Waves, part: slice, front: int
) -> Harmonics:
    record = drive.over(road, weight=np.zeros(road.elevation.shape[2]))
    n = waves.n[part]
    station = drive.timeline.station[drive.timeline.n_run_in :, front]
    return Harmonics(
        time=drive.time,
        phase=2.0 * np.pi * n[:, None] * station,
        power=waves.power[part],
        coarse_power=waves.coarse_power[part],
        displacement=_complex(record.displacement),
        velocity=_complex(record.velocity),
        acceleration=_complex(record.acceleration),
        contact_forces=_complex(record.forces),
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


def _laid_out(
    floor: Floor | PreparedFloor,
    crossings: Crossing | Sequence[Crossing],
    method: Interaction,
    points: Mapping[str, tuple[float, float]],
    duration: float | None,
) -> tuple[tuple[Crossing, ...], Drive]:
    many = as_tuple(crossings)
    if isinstance(floor, Floor):
        floor = prepare(floor, method.integration, method.damping)
    return many, lay_out_drive(floor, many, method=method, points=points, duration=duration)


def _columns(crossings: tuple[Crossing, ...]) -> Iterator[tuple[Crossing, slice]]:
    at = 0
    for crossing in crossings:
        yield crossing, slice(at, at + crossing.vehicle.n_contacts)
        at += crossing.vehicle.n_contacts


def _is_random(crossing: Crossing) -> bool:
    return isinstance(crossing.road, RoadClass)
