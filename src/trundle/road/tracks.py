"""Draw parallel wheel tracks of one isotropic road."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from jaxtyping import Float
from scipy import special

from trundle._checks import frozen_array
from trundle._typing import Array, ArrayLike
from trundle.road.iso8608 import Spectrum
from trundle.road.profile import Profile
from trundle.road.synthesis import RoughnessBand, draw_spectrum, layout, profile_of

__all__ = ["synthesise_tracks", "track_coherence"]


def track_coherence(n: ArrayLike, distance: ArrayLike) -> Float[Array, ...]:
    """Return the coherence of two parallel tracks of an isotropic road.

    Parameters
    ----------
    n : array_like of float
        Spatial frequency along the tracks [cycle/m].
    distance : array_like of float
        Distance between the tracks [m].

    Returns
    -------
    ndarray of float
        ``g^2`` with ``g = 2 pi n b K1(2 pi n b)``, for w = 2: 1 for long waves, 0 for short.

    References
    ----------
    J. D. Robson, C. J. Dodds, The description of road surface roughness, J. Sound Vib. 31
    (1973) 175-183; K. M. A. Kamash, J. D. Robson, J. Sound Vib. 57 (1978) 89-100.
    """
    return _amplitude_ratio(np.asarray(n, float), np.asarray(distance, float)) ** 2


def synthesise_tracks(
    road: Spectrum,
    lateral: ArrayLike,
    *,
    length: float,
    rng: np.random.Generator,
    band: RoughnessBand | None = None,
    spacing: float | None = None,
    start: float = 0.0,
) -> tuple[Profile, ...]:
    """Draw the profiles of parallel tracks of one road.

    Parameters
    ----------
    road : Spectrum
        Spectrum of every track.
    lateral : array_like of float, shape (n_tracks,)
        Lateral places of the tracks [m]; two at one place get the same profile.
    length : float
        Distance to cover [m].
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
    tuple of Profile
        One for each place; the first is what `synthesise` draws with the same generator.

    Notes
    -----
    At each spatial frequency the tracks' spectra form a matrix ``Gd g(n, |y_i - y_j|)``;
    independent draws are mixed by its Cholesky factor. Tracks after the first are sums of
    waves, so their amplitudes scatter even where the first one's do not.
    """
    band = band or RoughnessBand()
    places = frozen_array("lateral", lateral, shape=(None,))
    unique, which = np.unique(places, return_inverse=True)
    # the first track asked for is drawn first, whatever its place
    order = np.concatenate([[which[0]], np.delete(np.arange(len(unique)), which[0])])
    n_samples, step, keep = layout(length, band, spacing)
    spectra, waves = [], np.zeros(0)
    for _ in order:
        spectrum, waves = draw_spectrum(road, band, n_samples, step, rng)
        spectra.append(spectrum)
    if len(order) > 1:
        spectra = _mix(spectra, waves, unique[order])
    profiles = [profile_of(row, waves, n_samples, step, keep=keep, start=start) for row in spectra]
    return tuple(profiles[int(np.flatnonzero(order == i)[0])] for i in which)


def _mix(spectra: list[Array], waves: Array, lateral: Array) -> list[Array]:
    factor = _mixing(tuple(lateral.tolist()), len(waves), float(waves[1]))
    mixed = np.einsum("wij,jw->iw", factor, np.array(spectra))
    return [spectra[0], *mixed[1:]]


@lru_cache(maxsize=4)  # an ensemble mixes its roads alike
def _mixing(
    lateral: tuple[float, ...], n_waves: int, resolution: float
) -> Float[Array, "waves tracks tracks"]:
    """Return what independent draws are mixed by at every wave."""
    waves, places = resolution * np.arange(n_waves), np.array(lateral)
    ratio = _amplitude_ratio(waves[:, None, None], np.abs(places[:, None] - places))
    factor = np.linalg.cholesky(ratio + _JITTER * np.eye(len(places)))
    factor.flags.writeable = False
    return factor


_JITTER = 1e-10  # long waves are the same in every track: the matrix is then singular


def _amplitude_ratio(n: Array, distance: Array) -> Array:
    x = 2.0 * np.pi * n * distance
    return np.where(x > 0.0, x * special.k1(np.where(x > 0.0, x, 1.0)), 1.0)
