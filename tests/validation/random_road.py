"""A road of many cosines, flat before the floor, and band levels by Fourier's transform."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle.road import Profile

CLASS_B = 64e-6  # m3: geometric mean of class B at 0.1 cycle/m, ISO 8608
BANDS = 10.0 ** (np.arange(20) / 10)  # Hz: 1 to 80 Hz, exact mid-band frequencies


@dataclass(frozen=True, kw_only=True)
class Waves:
    """Cosines along the track, of class B's power, faded in over some metres."""

    n: np.ndarray  # cycle/m
    amplitude: np.ndarray
    phase: np.ndarray
    fade: float = 0.0  # m: the road is level before station 0 and whole after so many metres

    def at(self, s):
        """Return elevation and slope at stations of any shape."""
        s = np.asarray(s, dtype=float)
        angle = 2 * np.pi * self.n * s[..., None] + self.phase
        height = np.cos(angle) @ self.amplitude
        slope = -np.sin(angle) @ (2 * np.pi * self.n * self.amplitude)
        if self.fade == 0.0:
            return height, slope
        t = np.clip(s / self.fade, 0.0, 1.0)
        rise, steep = t * t * t * (10 - 15 * t + 6 * t * t), 30 * (t * (1 - t)) ** 2 / self.fade
        return rise * height, rise * slope + steep * height

    def profile(self, first, last, *, spacing=0.002):
        """Sample it so finely that the cubic between samples is the cosine to 1e-7 of it."""
        s = np.linspace(first, last, round((last - first) / spacing) + 1)
        height, slope = self.at(s)
        return Profile(station=s, elevation=height, slope=slope)


def class_b(n_min, n_max, *, n_waves, seed, fade=0.0):
    """Draw waves of even share of a third octave, each with the power of its strip."""
    rng = np.random.default_rng(seed)
    edges = np.geomspace(n_min, n_max, n_waves + 1)
    n = edges[:-1] + rng.random(n_waves) * np.diff(edges)
    power = CLASS_B * (n / 0.1) ** -2.0 * np.diff(edges)
    return Waves(
        n=n, amplitude=np.sqrt(2 * power), phase=rng.uniform(0, 2 * np.pi, n_waves), fade=fade
    )


def band_rms(values, dt, bands=BANDS):
    """Return the RMS of a record within straight-sided one-third-octave bands (Parseval).

    The record is faded over its first and last 2 %, so that its two ends meet. Its last sample
    is left out: what lasts as long has the same lines then, whatever the step.
    """
    n = len(values) - 1
    values = values[:n]
    edge = round(0.02 * n)
    window = np.ones(n)
    window[:edge] = np.sin(0.5 * np.pi * np.arange(edge) / edge) ** 2
    window[n - edge :] = window[:edge][::-1]
    lines = np.fft.rfft(window * values)
    f = np.fft.rfftfreq(n, dt)
    power = 2 * np.abs(lines / n) ** 2
    return np.array(
        [np.sqrt(power[(f >= b * 10**-0.05) & (f < b * 10**0.05)].sum()) for b in bands]
    )
