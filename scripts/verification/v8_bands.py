"""V8: bands, a burst and Newmark's period.

White noise of density 1 in a band with straight sides: ``sqrt(f (10^0.05 - 10^-0.05))``. A sine's
RMS is its amplitude over the root of 2. The burst ``exp(-t / 0.5 s) sin(2 pi 10 Hz t)`` passes a
causal Butterworth band-pass (four second-order sections, exact edges, sampled at 4 kHz); then the
largest RMS of any second, or the largest exponential average with 1 s (slow) or 0.125 s (fast).
Newmark's average acceleration turns by ``2 atan(omega dt / 2)`` in a step, found here as the angle
of the eigenvalues of the step's matrix.
"""

from __future__ import annotations

import numpy as np
from scipy import signal

from verification.value import Value

WHITE = {8.0: "1.35873", 10.0: "1.5191", 12.5: "1.69841"}
BURST = {"max_1s": "0.316", "slow": "0.262", "fast": "0.442"}
LONGER = {3.75: "2.83", 10.0: "18.0"}


def burst_levels() -> dict[str, float]:
    """Return the burst's levels by the three averages."""
    fs = 4000
    t = np.arange(4 * fs) / fs
    burst = np.exp(-t / 0.5) * np.sin(2 * np.pi * 10 * t)
    edges = 10.0 * 10 ** np.array([-0.05, 0.05])
    sections = signal.butter(4, edges, "bandpass", fs=fs, output="sos")
    square = signal.sosfilt(sections, burst) ** 2
    total = np.cumsum(np.concatenate([[0.0], square])) / fs
    levels = {"max_1s": np.max(total[fs:] - total[:-fs])}
    for name, tau in (("slow", 1.0), ("fast", 0.125)):
        decay = np.exp(-1.0 / (fs * tau))
        levels[name] = signal.lfilter([1 - decay], [1.0, -decay], square).max()
    return {name: float(np.sqrt(value)) for name, value in levels.items()}


def newmark_longer(f: float, dt: float) -> float:
    """Return by how much average acceleration stretches a period [%]."""
    w = 2 * np.pi * f
    # displacement and velocity at both ends: u1 - u0 = dt (v0 + v1) / 2, v1 - v0 = dt (a0 + a1) / 2
    left = np.array([[1.0, -dt / 2], [dt / 2 * w**2, 1.0]])
    right = np.array([[1.0, dt / 2], [-dt / 2 * w**2, 1.0]])
    turn = np.abs(np.angle(np.linalg.eigvals(np.linalg.solve(left, right)))).max()
    return 100 * (w * dt / turn - 1)


def values() -> list[Value]:
    """Return the case's values."""
    levels = burst_levels()
    found = [
        Value(case="V8", quantity=f"white noise in the {f:g} Hz band", printed=printed,
              computed=float(np.sqrt(f * (10**0.05 - 10**-0.05))), unit="um/s")
        for f, printed in WHITE.items()
    ]  # fmt: skip
    found.append(
        Value(case="V8", quantity="sine of 100 um/s in its band", printed="70.711",
              computed=100 / np.sqrt(2), unit="um/s")
    )  # fmt: skip
    found += [
        Value(case="V8", quantity=f"burst, {name}", printed=printed, computed=levels[name],
              tolerance=1e-3 if name == "slow" else None,
              note="0.26145 at any sampling frequency" if name == "slow" else "")
        for name, printed in BURST.items()
    ]  # fmt: skip
    return found + [
        Value(case="V8", quantity=f"longer period at {f:g} Hz, 25 ms", printed=printed,
              computed=newmark_longer(f, 0.025), unit="%", tolerance=0.05 if f > 5 else None)
        for f, printed in LONGER.items()
    ]  # fmt: skip
