"""Take a floor's flatness class for a road: the spectrum that just keeps its limits.

A class of flatness limits differences of height over some feet or metres; a random road needs a
spectrum. Assumed is a Gaussian floor with a straight spectrum ``Gd(n) = Gd(n0) (n / n0)^-w``,
normal as written in each function, that just meets the limit all over. A floor that is flatter than
asked for is smoother; one with joints has them besides (`trundle.road.Feature`).
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
from scipy import optimize, special

from trundle._checks import positive
from trundle.errors import InputError
from trundle.road.iso8608 import REFERENCE_FREQUENCY, RoadSpectrum

__all__ = ["flat_floor"]

_INCH, _FOOT = 0.0254, 0.3048
# FF = 4.57 / (3 s_q + |mean q|), q the curvature over 12 in, in inches;
# FL = 12.5 / (3 s_z + |mean z|), z the rise over 10 ft, in inches (ASTM E1155)
_FF, _FL = 4.57 * _INCH / 3.0, 12.5 * _INCH / 3.0
_USUAL = (5.0, 200.0)  # F-numbers: a slab that is not levelled at all, and the best of superflats
# Property F [m]: change between rises over 300 mm behind each other, kept by 95 % of readings
# (Concrete Society TR34, 4th edition, Table 3.1)
_TR34 = {"1": 1.8e-3, "2": 2.0e-3, "3": 2.2e-3, "4": 2.4e-3}
_TR34_STEP = 0.3  # m
# Gap under a straightedge between supports 0.1, 1 and 4 m apart [m] (DIN 18202, Table 3)
_DIN_SPANS = np.array([0.1, 1.0, 4.0])
_DIN = {
    "2": np.array([5e-3, 8e-3, 12e-3]),
    "3": np.array([2e-3, 4e-3, 10e-3]),
    "4": np.array([1e-3, 3e-3, 9e-3]),
}
_WITHIN = 1.96  # standard deviations that 95 % of normal readings lie within

_NUMBER = r"(\d+(?:\.\d+)?)"
_KNOWN = (
    "known are 'FF 50', 'FF 50/FL 30' (ASTM E1155), 'FM 1' to 'FM 4' (TR34, 4th edition) and "
    "'DIN 18202 line 2' to '4'"
)


def flat_floor(text: str) -> RoadSpectrum:
    """Return the roughness of a floor of a class of flatness.

    Parameters
    ----------
    text : str
        ``"FF 50"``, ``"FF 50/FL 30"``, ``"FM 2"`` or ``"DIN 18202 line 3"``.

    Raises
    ------
    InputError
        Another text, or numbers that no floor has.

    Notes
    -----
    For w = 2 the curvature ``q = z(s + d) - 2 z(s) + z(s - d)`` has the variance
    ``4 pi^2 d n0^2 Gd(n0)``, and the rise over a length L has ``2 pi^2 L n0^2 Gd(n0)``; both follow
    from ``int Gd(n) |H(n)|^2 dn`` with ``|H| = 4 sin^2(pi n d)`` and ``2 sin(pi n L)``.

    Examples
    --------
    >>> f"{flat_floor('FF 50').roughness:.2e}"
    '4.98e-06'
    """
    for pattern, make in _KINDS:
        if found := re.fullmatch(pattern, text.strip(), re.IGNORECASE):
            return make(*found.groups())
    raise InputError(f"flatness {text!r} is not known; {_KNOWN}")


def _by_f_numbers(flatness: str, levelness: str | None) -> RoadSpectrum:
    """Return a floor of F-numbers: w = 2 of FF alone; with FL, the w at which both are met."""
    curvature = _FF / _f_number("FF", flatness)
    if levelness is None:
        return _of_curvature(f"FF {flatness}", curvature, _FOOT)
    rise = _FL / _f_number("FL", levelness)
    ratio = (curvature / rise) ** 2

    def left(w: float) -> float:
        # the variances' ratio is (d / L)^(w-1) (4 - 2^(w-1)), for 1 < w < 3
        return 0.1 ** (w - 1.0) * (4.0 - 2.0 ** (w - 1.0)) - ratio

    low, high = 1.05, 2.95
    name = f"FF {flatness}/FL {levelness}"
    if left(low) * left(high) > 0.0:
        raise InputError(
            f"flatness {name!r} fits no floor: its long waves would be "
            f"{'lower' if left(low) < 0.0 else 'higher'} than any straight spectrum gives; give FF "
            "alone"
        )
    return _of_curvature(name, curvature, _FOOT, float(optimize.brentq(left, low, high)))


def _by_tr34(number: str) -> RoadSpectrum:
    """Return a floor of which 95 % of readings keep Property F."""
    return _of_curvature(f"FM {number} (TR34)", _TR34[number] / _WITHIN, _TR34_STEP)


def _by_din(line: str) -> RoadSpectrum:
    """Return the roughest floor of which 95 % of places keep all gaps."""
    spans = _DIN_SPANS
    # under the middle of a straightedge the gap is half the curvature over half its length
    curvature = 2.0 * _DIN[line] / _WITHIN
    all_of_them = [
        _of_curvature("", float(q), float(0.5 * span)).roughness
        for q, span in zip(curvature, spans, strict=True)
    ]
    return RoadSpectrum(roughness=min(all_of_them), name=f"floor of DIN 18202 line {line}")


_KINDS: tuple[tuple[str, Callable[..., RoadSpectrum]], ...] = (
    (rf"FF\s*{_NUMBER}(?:\s*[/,]?\s*FL\s*{_NUMBER})?", _by_f_numbers),
    (r"(?:TR\s*34\s*)?FM\s*([1-4])", _by_tr34),
    (r"DIN\s*18202,?\s*(?:line|row|zeile)\s*([2-4])", _by_din),
)


def _of_curvature(name: str, deviation: float, step: float, w: float = 2.0) -> RoadSpectrum:
    """Return the roughness whose curvature over a step has a standard deviation [m]."""
    # int_0^inf x^-w (1 - cos x) dx = -Gamma(1 - w) sin(pi w / 2), pi / 2 at w = 2
    whole = 0.5 * np.pi if w == 2.0 else -special.gamma(1.0 - w) * np.sin(0.5 * np.pi * w)
    fourth = (4.0 * 2.0 ** (w - 1.0) - 4.0 ** (w - 1.0)) / 8.0 * whole
    unit = REFERENCE_FREQUENCY**w * (np.pi * step) ** (w - 1.0) * 16.0 * fourth
    return RoadSpectrum(roughness=float(deviation**2 / unit), waviness=w, name=f"floor of {name}")


def _f_number(name: str, text: str) -> float:
    number = positive(name, float(text))
    low, high = _USUAL
    if not low <= number <= high:
        raise InputError(f"{name} must be {low:g} to {high:g}; got {number:g}")
    return number
