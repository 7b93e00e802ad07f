"""Draw random road profiles with a given spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float
from scipy import fft

from trundle._checks import non_negative, positive, set_frozen
from trundle._typing import Array
from trundle.errors import InputError
from trundle.road.iso8608 import FITTED_RANGE, Spectrum, band_power
from trundle.road.profile import Profile

__all__ = ["RoughnessBand", "synthesise", "wave_power"]

_SAMPLES_PER_WAVE = 20  # cubic interpolation is then within 3e-5 of the shortest wave


@dataclass(frozen=True, kw_only=True)
class RoughnessBand:
    """Hold the band of spatial frequencies that a synthetic road contains.

    Attributes
    ----------
    n_min, n_max : float
        Limits of the band [cycle/m]; ISO 8608's fitted range unless given. Beyond 2.83
        cycle/m the straight line of ISO 8608 is an extrapolation.
    contact_patch : float
        Length over which a tyre averages the road [m]; 0 is a point contact. Multiplies
        each wave by ``sin(pi n a) / (pi n a)``.
    gaussian_amplitudes : bool
        Draw amplitudes as well as phases at random (exactly Gaussian at any length), or
        keep each wave's power fixed and draw phases alone.
    """

    n_min: float = FITTED_RANGE[0]
    n_max: float = FITTED_RANGE[1]
    contact_patch: float = 0.0
    gaussian_amplitudes: bool = False

    def __post_init__(self) -> None:
        """Check that the band rises."""
        low, high = positive("n_min", self.n_min), positive("n_max", self.n_max)
        if high <= low:
            raise InputError(f"n_max must be above n_min = {low:g} cycle/m; got {high:g} cycle/m")
        patch = non_negative("contact_patch", self.contact_patch)
        set_frozen(self, n_min=low, n_max=high, contact_patch=patch)

    def __str__(self) -> str:
        """Describe the band for a report."""
        patch = f", tyre averaging over {self.contact_patch:g} m" if self.contact_patch else ""
        return f"{self.n_min:g} to {self.n_max:g} cycle/m{patch}"


def synthesise(
    road: Spectrum,
    *,
    length: float,
    rng: np.random.Generator,
    band: RoughnessBand | None = None,
    spacing: float | None = None,
    start: float = 0.0,
) -> Profile:
    """Draw one profile by inverse FFT with random phases.

    Parameters
    ----------
    road : Spectrum
        Spectrum.
    length : float
        Distance to cover [m]; the profile does not repeat within it.
    rng : numpy.random.Generator
        Source of randomness.
    band : RoughnessBand, optional
        Spatial frequencies contained; ISO 8608's fitted range unless given.
    spacing : float, optional
        Largest distance between samples [m]; a twentieth of the shortest wave unless given.
    start : float
        Station of the first sample [m].

    Returns
    -------
    Profile
        Elevation and slope from the same Fourier series: the slope is exact.

    Raises
    ------
    InputError
        A spacing that cannot hold the shortest wave, or a length without any wave.

    Notes
    -----
    Each line of the spectrum carries the integral of Gd over its own interval, so the
    variance of the profile is exactly the band's at every length.
    """
    band = band or RoughnessBand()
    n_samples, step, keep = layout(length, band, spacing)
    spectrum, waves = draw_spectrum(road, band, n_samples, step, rng)
    return profile_of(spectrum, waves, n_samples, step, keep=keep, start=start)


def layout(length: float, band: RoughnessBand, spacing: float | None) -> tuple[int, float, int]:
    """Return the samples in a period, their distance [m] and how many a road keeps."""
    length = positive("length", length)
    spacing = positive("spacing", spacing or 1.0 / (_SAMPLES_PER_WAVE * band.n_max))
    if spacing > 0.5 / band.n_max:
        raise InputError(
            f"spacing must be at most {0.5 / band.n_max:g} m to hold waves of n_max = "
            f"{band.n_max:g} cycle/m; got {spacing:g} m"
        )
    # The period covers the longest wave, so a short road still has its lowest frequency. It
    # does not depend on the spacing: a finer one adds short waves and keeps the long ones.
    period = 1.01 * max(length, 1.0 / band.n_min)
    n_samples = int(fft.next_fast_len(int(np.ceil(period / spacing)) + 1, real=True))
    step = period / n_samples
    return n_samples, step, min(n_samples, int(np.ceil(length / step)) + 1)


def profile_of(
    spectrum: Array, waves: Array, n_samples: int, step: float, *, keep: int, start: float
) -> Profile:
    """Return the profile of a Fourier series, with the slope of the same series."""
    elevation = fft.irfft(spectrum, n_samples)
    slope = fft.irfft(2j * np.pi * waves * spectrum, n_samples)
    return Profile(
        station=start + step * np.arange(keep), elevation=elevation[:keep], slope=slope[:keep]
    )


def draw_spectrum(
    road: Spectrum, band: RoughnessBand, n_samples: int, step: float, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Return the Fourier coefficients of one random road, and their waves [cycle/m]."""
    amplitude, waves = _amplitudes(road, band, n_samples, step)
    if band.gaussian_amplitudes:
        pair = rng.standard_normal((2, len(waves))) / np.sqrt(2.0)
        coefficient = amplitude * (pair[0] + 1j * pair[1])
    else:
        turns = rng.random(len(waves))
        coefficient = np.zeros(len(waves), dtype=complex)
        held = amplitude > 0.0  # a tenth of all lines: the spacing is far below the shortest wave
        coefficient[held] = amplitude[held] * np.exp(2j * np.pi * turns[held])
    coefficient[0] = 0.0
    if n_samples % 2 == 0:
        coefficient[-1] = 0.0  # a wave at the sampling limit has no defined phase
    return 0.5 * n_samples * coefficient, waves


@lru_cache(maxsize=16)  # an ensemble draws its roads from the same amplitudes
def _amplitudes(
    road: Spectrum, band: RoughnessBand, n_samples: int, step: float
) -> tuple[Array, Array]:
    resolution = 1.0 / (n_samples * step)
    waves = resolution * np.arange(n_samples // 2 + 1)
    low = np.clip(waves - 0.5 * resolution, band.n_min, band.n_max)
    high = np.clip(waves + 0.5 * resolution, band.n_min, band.n_max)
    power = band_power(road, low, high)
    if not np.any(power > 0.0):
        raise InputError(f"no wave between {band} fits on this road; make it longer")
    amplitude = np.sqrt(2.0 * power) * np.abs(np.sinc(waves * band.contact_patch))
    amplitude.flags.writeable = waves.flags.writeable = False
    return amplitude, waves


def wave_power(
    road: Spectrum, band: RoughnessBand, n: Float[Array, " waves"]
) -> Float[Array, " waves"]:
    """Share out the power of a band among waves, each to the middles of its neighbours.

    Parameters
    ----------
    road : Spectrum
        Spectrum.
    band : RoughnessBand
        Band and tyre averaging.
    n : ndarray of float, shape (n_waves,)
        Spatial frequencies inside the band, rising [cycle/m].

    Returns
    -------
    ndarray of float, shape (n_waves,)
        Variances; without tyre averaging their sum is the band's [m2].
    """
    edges = np.concatenate([[band.n_min], 0.5 * (n[1:] + n[:-1]), [band.n_max]])
    return band_power(road, edges[:-1], edges[1:]) * np.sinc(n * band.contact_patch) ** 2
