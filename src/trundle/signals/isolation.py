"""Pass a floor's motion on to what stands on an isolator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Complex, Float, Inexact
from scipy import fft, signal

from trundle._checks import frozen_array, positive, set_frozen, within
from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["Isolation", "Isolator", "TransmissibilityTable", "behind"]


@dataclass(frozen=True, kw_only=True)
class Isolator:
    """Hold a mass on a spring and a damper, moved by the floor.

    The mass is taken as light beside the floor: the floor's motion stays as it is.

    Attributes
    ----------
    frequency : float
        Natural frequency of mass on spring [Hz].
    damping_ratio : float
        Ratio of critical damping, 0 to 2.
    """

    frequency: float
    damping_ratio: float

    def __post_init__(self) -> None:
        """Check both numbers."""
        set_frozen(
            self,
            frequency=positive("isolator frequency", self.frequency),
            damping_ratio=within("isolator damping_ratio", self.damping_ratio, 0.0, 2.0),
        )

    def response(self, f: Float[Array, " lines"]) -> Complex[Array, " lines"]:
        """Return motion of the mass over motion of the floor.

        ``(1 + 2i zeta r) / (1 - r^2 + 2i zeta r)``, ``r = f / f0``.
        """
        r = np.asarray(f, float) / self.frequency
        passed = 1.0 + 2j * self.damping_ratio * r
        return passed / (passed - r**2)

    def __str__(self) -> str:
        """Describe the isolator for a report."""
        return f"isolator of {self.frequency:g} Hz, {100 * self.damping_ratio:g} % damping"


@dataclass(frozen=True, kw_only=True, eq=False)
class TransmissibilityTable:
    """Hold a measured transmissibility: its size alone, its phase taken as the least there can be.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_points,)
        Frequencies, rising [Hz].
    ratios : ndarray of float, shape (n_points,)
        Motion behind over motion before; straight in between on log-log axes, and held beyond
        both ends.
    """

    frequencies: Float[Array, " points"]
    ratios: Float[Array, " points"]

    def __post_init__(self) -> None:
        """Check and freeze both columns."""
        f = frozen_array("transmissibility frequencies", self.frequencies, shape=(None,))
        ratios = frozen_array("transmissibility ratios", self.ratios, shape=f.shape)
        if len(f) < 2 or f[0] <= 0.0 or np.any(np.diff(f) <= 0.0):
            raise InputError("transmissibility frequencies must be above 0 and rise; give two")
        if np.any(ratios <= 0.0):
            raise InputError("transmissibility ratios must be greater than 0")
        set_frozen(self, frequencies=f, ratios=ratios)

    def response(self, f: Float[Array, " lines"]) -> Complex[Array, " lines"]:
        """Return the ratio at frequencies [Hz]."""
        at = np.log(np.maximum(np.asarray(f, float), self.frequencies[0]))
        value = np.exp(np.interp(at, np.log(self.frequencies), np.log(self.ratios)))
        return value + 0j

    def __str__(self) -> str:
        """Describe the table for a report."""
        return f"transmissibility given from {self.frequencies[0]:g} to {self.frequencies[-1]:g} Hz"


Isolation: TypeAlias = Isolator | TransmissibilityTable
"""What stands between floor and tool."""


def behind(
    isolation: Isolation, samples: Inexact[Array, "... steps"], sampling_frequency: float
) -> Inexact[Array, "... steps"]:
    """Return the motion behind an isolator from that of the floor.

    Parameters
    ----------
    isolation : Isolator or TransmissibilityTable
        What stands between.
    samples : ndarray, shape (..., n_steps)
        Motion of the floor, at rest before the record; real, or complex answers to waves.
    sampling_frequency : float
        Samples per second [Hz].
    """
    if isinstance(isolation, Isolator):
        return _moved(isolation, samples, sampling_frequency)
    n = samples.shape[-1]
    size = 2 * fft.next_fast_len(n)
    size_of = np.abs(isolation.response(np.abs(fft.fftfreq(size, 1.0 / sampling_frequency))))
    spectrum = fft.fft(samples, size, axis=-1) * _least_phase(size_of)
    moved = np.asarray(fft.ifft(spectrum, axis=-1)[..., :n])
    return moved if np.iscomplexobj(samples) else moved.real.copy()


def _least_phase(size: Float[Array, " lines"]) -> Complex[Array, " lines"]:
    """Return a response of given size that follows its cause as closely as any can.

    With no phase at all it would come before its cause, and begin with a click where a record does
    (A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, 3rd ed. 2010, section 13.5).
    """
    cepstrum = fft.ifft(np.log(size)).real
    half = len(size) // 2
    folded = np.zeros_like(cepstrum)
    folded[0], folded[half] = cepstrum[0], cepstrum[half]
    folded[1:half] = 2.0 * cepstrum[1:half]
    return np.exp(fft.fft(folded))


def _moved(isolator: Isolator, samples: Array, sampling_frequency: float) -> Array:
    """Step mass, spring and damper, as exactly as their response is known.

    Steps that are exact for motion straight between samples answer too weakly near the sampling
    frequency; what they lack is smooth, and is multiplied to the spectrum beforehand. So the poles
    are stepped, and no ringing, however long, comes round the period of a transform.
    """
    omega, zeta = 2.0 * np.pi * isolator.frequency, isolator.damping_ratio
    passed = [2.0 * zeta * omega, omega**2] if zeta > 0.0 else [omega**2]
    system = (passed, [1.0, 2.0 * zeta * omega, omega**2])
    # scipy's annotations know the state-space form alone
    b, a, _ = signal.cont2discrete(system, 1.0 / sampling_frequency, method="foh")  # pyright: ignore
    n = samples.shape[-1]
    size = fft.next_fast_len(2 * n, real=True)
    turned = np.iscomplexobj(samples)  # an answer to waves: both halves of the spectrum
    transform, back = (fft.fft, fft.ifft) if turned else (fft.rfft, fft.irfft)
    f = np.asarray((fft.fftfreq if turned else fft.rfftfreq)(size, 1.0 / sampling_frequency))
    # off the pole of an undamped isolator
    f = np.where(np.isclose(np.abs(f), isolator.frequency, rtol=1e-9), f * (1 + 1e-6), f)
    _, stepped = signal.freqz(np.ravel(b), a, worN=f, fs=sampling_frequency)
    spectrum = transform(samples, size, axis=-1) * (isolator.response(f) / stepped)
    return np.asarray(
        signal.lfilter(np.ravel(b), a, back(spectrum, size, axis=-1)[..., :n], axis=-1)
    )
