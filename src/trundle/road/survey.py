"""Read roughness off a profile: its spectrum, the line through it, its class, its IRI."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import linalg, signal

from trundle._checks import positive
from trundle._typing import Array
from trundle.errors import FitnessWarning, InputError
from trundle.road.iso8608 import (
    CLASS_NAMES,
    FITTED_RANGE,
    REFERENCE_FREQUENCY,
    RoadClass,
    class_limits,
)
from trundle.road.plausibility import (
    check_index,
    check_roughness,
    profile_doubts,
    roughness_doubts,
)
from trundle.road.profile import Profile
from trundle.signals import welch_psd

__all__ = ["RoughnessFit", "classify", "fit_roughness", "roughness_index"]

_SEGMENTS = 8  # per road: enough to average, long enough for a long wave
_LINES = 6  # below the lowest octave used, so that no longer wave leaks into it

_IRI_SPEED = 80.0 / 3.6  # m/s
_IRI_PATCH = 0.25  # m, moving average of the tyre
_IRI_LEAD = 11.0  # m over which the first slope is taken: half a second
# Golden car, by sprung mass: tyre, suspension [1/s2], damper [1/s], axle mass [-]
_K1, _K2, _C, _MU = 653.0, 63.3, 6.0, 0.15


@dataclass(frozen=True, kw_only=True)
class RoughnessFit:
    """Hold the straight line through a profile's spectrum.

    Attributes
    ----------
    roughness : float
        Gd(n0) of the line with its own slope [m3].
    waviness : float
        Exponent w of ``Gd(n) = Gd(n0) (n / n0)^-w``.
    roughness_at_two : float
        Gd(n0) of the line with w = 2, by which ISO 8608 classifies [m3].
    n_min, n_max : float
        Spatial frequencies that the line was fitted over [cycle/m].
    doubts : tuple of FitnessWarning
        Doubts about the profile's units.
    """

    roughness: float
    waviness: float
    roughness_at_two: float
    n_min: float
    n_max: float
    doubts: tuple[FitnessWarning, ...] = ()


def fit_roughness(
    profile: Profile, *, n_min: float = FITTED_RANGE[0], n_max: float = FITTED_RANGE[1]
) -> RoughnessFit:
    """Fit ISO 8608's straight line to the spectrum of a profile.

    Parameters
    ----------
    profile : Profile
        The road; read at even spacing, two samples and more to the shortest wave.
    n_min, n_max : float
        Spatial frequencies wanted [cycle/m]; what the profile's length and spacing cannot
        show is left out, and the fit says what it used.

    Raises
    ------
    InputError
        A profile that holds fewer than two octaves of the band.

    Notes
    -----
    Welch's PSD is averaged over octaves, as ISO 8608:2016 smooths its spectra, so that each
    octave has one vote in the line.
    """
    n, psd = _spectrum(profile, n_max)
    resolution = n[1] - n[0]
    low, high = max(n_min, _LINES * resolution), min(n_max, 0.8 * n[-1])
    n_octaves = int(np.log2(high / low)) if high > low else 0
    if n_octaves < 2:
        raise InputError(
            f"a profile of {profile.length:g} m with {len(profile.station)} points holds less "
            f"than two octaves between {n_min:g} and {n_max:g} cycle/m: give a longer one"
            f"{_said(profile)}"
        )
    edges = np.geomspace(low, high, n_octaves + 1)
    which = np.digitize(n, edges) - 1
    # The PSD times n^2 is even over an octave, so averaging it does not favour long waves.
    flat = psd * (n / REFERENCE_FREQUENCY) ** 2
    level = np.log([flat[which == i].mean() for i in range(n_octaves)])
    centre = np.log(np.sqrt(edges[:-1] * edges[1:]) / REFERENCE_FREQUENCY)
    slope, height = np.polyfit(centre, level, 1)
    at_two = float(np.exp(level.mean()))
    return RoughnessFit(
        roughness=float(np.exp(height)),
        waviness=float(2.0 - slope),
        roughness_at_two=at_two,
        n_min=float(low),
        n_max=float(high),
        doubts=(*profile_doubts(profile), *roughness_doubts(at_two)),
    )


def classify(profile: Profile) -> RoadClass:
    """Return the class of ISO 8608 whose limits hold a profile's Gd(n0) at w = 2.

    Raises
    ------
    InputError
        A profile too short, or with a Gd(n0) that no road has: most often its elevations are
        not in metres.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> from trundle.road import synthesise
    >>> str(classify(synthesise(RoadClass("C"), length=500.0, rng=rng)))
    'class C (geometric mean)'
    """
    roughness = fit_roughness(profile).roughness_at_two
    check_roughness(roughness)
    upper = [class_limits(name)[2] for name in CLASS_NAMES]
    return RoadClass(CLASS_NAMES[min(int(np.searchsorted(upper, roughness)), len(upper) - 1)])


def roughness_index(
    profile: Profile, *, segment: float = 100.0, spacing: float = 0.25
) -> Float[Array, " segments"]:
    """Return the International Roughness Index of each segment of a profile.

    Parameters
    ----------
    profile : Profile
        The road; elevations of a kilometre above the sea do no harm.
    segment : float
        Length of a segment [m]; a shorter rest at the end is left out.
    spacing : float
        Distance of the samples that the quarter car is driven over, 0.25 m at most [m].

    Returns
    -------
    ndarray of float, shape (n_segments,)
        Mean rectified slope of the suspension [m/m]; times 1000 it is in mm/m.

    Raises
    ------
    InputError
        A profile shorter than a segment, or with an index that no road has: most often its
        elevations are not in metres.

    Notes
    -----
    Golden car at 80 km/h in one continuous run, started with the mean slope of the first
    11 m. The tyre's 250 mm moving average and straight lines between samples make the slope
    a step function, over which the car is integrated exactly.

    References
    ----------
    M. W. Sayers, On the calculation of IRI from longitudinal road profile, Transportation
    Research Record 1501 (1995) 1-12. ASTM E1926.
    """
    spacing = positive("spacing", spacing)
    if spacing > _IRI_PATCH:
        raise InputError(f"spacing must be at most {_IRI_PATCH:g} m; got {spacing:g} m")
    per_segment = round(positive("segment", segment) / spacing)
    n_segments = int((profile.length / spacing + 1e-6) // per_segment)
    if n_segments < 1:
        raise InputError(
            f"a profile of {profile.length:g} m is shorter than a segment of {segment:g} m"
            f"{_said(profile)}"
        )
    station = profile.station[0] + spacing * np.arange(n_segments * per_segment + 1)
    ahead = np.minimum(station + _IRI_PATCH, profile.station[-1])
    rise = profile.at(ahead)[0] - profile.at(station)[0]
    slope = (rise / np.maximum(ahead - station, 1e-9))[:-1]
    if ahead[-2] - station[-2] < _IRI_PATCH * 0.5:
        slope[-1] = slope[-2]
    first = float(np.mean(slope[: max(1, round(_IRI_LEAD / spacing))]))
    rectified = np.abs(_suspension_slope(slope, spacing / _IRI_SPEED, first))
    index = rectified.reshape(n_segments, per_segment).mean(axis=1)
    check_index(float(index.mean()))
    return index


def _said(profile: Profile) -> str:
    """Return the doubts about a profile's units as the end of a message."""
    return "".join(f"; {doubt.message}" for doubt in profile_doubts(profile))


def _suspension_slope(slope: Array, dt: float, first: float) -> Array:
    """Return the golden car's suspension velocity over its speed, after each sample."""
    system = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-_K2, -_C, _K2, _C],
            [0.0, 0.0, 0.0, 1.0],
            [_K2 / _MU, _C / _MU, -(_K1 + _K2) / _MU, -_C / _MU],
        ]
    )
    transition = linalg.expm(system * dt)
    push = np.array([0.0, 0.0, 0.0, _K1 / _MU])
    hold = np.linalg.solve(system, (transition - np.eye(4)) @ push)
    # Uncoupled by its eigenvectors, each of the four states is a first-order filter.
    values, vectors = np.linalg.eig(transition)
    inputs = np.linalg.solve(vectors, hold)
    starts = np.linalg.solve(vectors, np.array([first, 0.0, first, 0.0]))
    read = vectors[0] - vectors[2]
    out = np.zeros(len(slope))
    for value, entry, start, weight in zip(values, inputs, starts, read, strict=True):
        state, _ = signal.lfilter([entry], [1.0, -value], slope + 0j, zi=[value * start])
        out += np.real(weight * state)
    return out


def _spectrum(profile: Profile, n_max: float) -> tuple[Array, Array]:
    spacing = profile.length / (len(np.unique(profile.station)) - 1)
    spacing = min(spacing, 0.4 / n_max) if spacing < 0.5 / n_max else spacing
    station = np.arange(profile.station[0], profile.station[-1], spacing)
    elevation = signal.detrend(profile.at(station)[0])
    return welch_psd(elevation, 1.0 / spacing, resolution=_SEGMENTS / 2 / profile.length)
