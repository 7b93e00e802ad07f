"""Make good what steps that are straight between samples lose of a motion.

Exact steps for forces that are straight between samples (`dynamics.exact`) are exact for a force
that is not there: a straight line between samples holds ``sinc^2(f dt)`` of a wave of frequency f,
and images of it at ``f - n / dt``. At 5 ms that is 0.97 at 20 Hz, 0.88 at 40 Hz, 0.57 at 80 Hz.

For a force without waves above half the sampling frequency the loss is known, and linear in time:

- all that a system answers is multiplied by ``sinc^2``; so a short symmetric filter with the
  inverse of it, run over what was recorded, restores it (`restoring_filter`);
- the images move the system too. It follows them as a mass, far above its resonance, without
  delay; so what they add is a short filter of the force itself, mode by mode, and is taken off
  (`image_filters`).

Modes above half the sampling frequency are not stepped: their images would stand within the bands.
Below it they follow the force nearly without delay, so all that they add is a short filter of the
force (`following_filters`).

The filters are symmetric but for damping, as long as both sides of a sample are known; so they act
on what was recorded, never inside a coupled step. They are fitted up to 0.45 of the sampling
frequency, which is the upper edge of the highest band that is assessed at it.

References
----------
A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, 3rd ed. (2010), section 4.8
(reconstruction by a first-order hold and its compensation), chapter 7 (least-squares filters).
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Complex, Float

from trundle._typing import Array

if TYPE_CHECKING:
    from trundle.dynamics.exact import ModalRecursion

__all__ = [
    "REACH",
    "TOP",
    "differentiator",
    "following_filters",
    "image_filters",
    "responses_of",
    "restoring_filter",
]

REACH = 12
"""Steps that a filter reaches to either side."""

TOP = 0.45
"""Share of the sampling frequency up to which filters are fitted."""

_IMAGES = 12  # to either side; the n-th adds 1/n^4 of the first
_TAPS = np.arange(-REACH, REACH + 1)
_LINES = 200  # frequencies at which filters are fitted


def _angles() -> Array:
    """Return ``omega dt`` at which filters are fitted [rad]."""
    return 2.0 * np.pi * TOP * (np.arange(_LINES) + 0.5) / _LINES


def _both_sides(centre: Array, side: Array, sign: float) -> Array:
    return np.concatenate([sign * side[..., ::-1], centre[..., None], side], axis=-1)


@cache
def restoring_filter() -> Float[Array, " taps"]:
    """Return the symmetric filter that gives back what ``sinc^2(f dt)`` took.

    Returns
    -------
    ndarray of float, shape (2 REACH + 1,)
        Weights of the samples from REACH steps before to REACH after; their sum is 1, so that a
        constant stays. Times ``sinc^2`` it is 1 within 0.1 % up to `TOP`.
    """
    x, lags = _angles(), np.arange(1, REACH + 1)
    kept = np.sinc(x / (2.0 * np.pi)) ** 2
    columns = (2.0 * np.cos(np.outer(x, lags)) - 2.0) * kept[:, None]
    side = np.linalg.lstsq(columns, 1.0 - kept, rcond=None)[0]
    return _frozen(_both_sides(np.asarray(1.0 - 2.0 * side.sum()), side, 1.0))


@cache
def differentiator(order: int) -> Float[Array, " taps"]:
    """Return a filter that differentiates samples one step apart, once or twice.

    Returns
    -------
    ndarray of float, shape (2 REACH + 1,)
        Weights; divide by ``dt`` or ``dt^2``. The second derivative is within 0.2 % up to `TOP`,
        the first within 0.1 % up to 0.4 of the sampling frequency and 4 % at `TOP`, for no short
        filter is steep just below half the sampling frequency. A constant gives exactly 0.
    """
    x, lags = _angles(), np.arange(1, REACH + 1)
    if order == 1:
        columns = 2.0 * np.sin(np.outer(x, lags)) / x[:, None]
        side = np.linalg.lstsq(columns, np.ones_like(x), rcond=None)[0]
        return _frozen(_both_sides(np.asarray(0.0), side, -1.0))
    columns = (2.0 - 2.0 * np.cos(np.outer(x, lags))) / x[:, None] ** 2
    side = np.linalg.lstsq(columns, np.ones_like(x), rcond=None)[0]
    return _frozen(_both_sides(np.asarray(-2.0 * side.sum()), side, 1.0))


def image_filters(steps: ModalRecursion) -> Float[Array, "3 taps modes"]:
    """Return the filters of modal forces that complete restored modal motion.

    Restored displacement of a mode plus its modal force by the first filter is the displacement
    that a force without waves above half the sampling frequency gives; the second completes the
    velocity, the third the acceleration that is read from the equation of motion.

    Parameters
    ----------
    steps : ModalRecursion
        Steps of the modes.

    Notes
    -----
    With S = sinc^2, restored motion is ``H(f) + sum_n H(f - n fs) S(f - n fs) / S(f)``, n not 0,
    and ``S(f - n fs) / S(f) = f^2 / (f - n fs)^2``; the filters are that sum's negative, fitted on
    functions that are 0 for a constant force. Acceleration is what the equation of motion leaves,
    ``p - 2 zeta omega v - omega^2 u``: its force must not be restored.
    """
    x, lags = _angles(), np.arange(1, REACH + 1)
    shift = np.concatenate([np.arange(-_IMAGES, 0), np.arange(1, _IMAGES + 1)])
    image = (x[:, None] - 2.0 * np.pi * shift)[..., None] / steps.dt  # (lines, images, 1)
    rigid = steps.square - image**2 + 1j * steps.double * image
    weight = (x[:, None, None] / steps.dt / image) ** 2
    cosine, sine = 2.0 * np.cos(np.outer(x, lags)) - 2.0, 2.0 * np.sin(np.outer(x, lags))
    found = []
    for added in (weight / rigid, 1j * image * weight / rigid):
        target = -added.sum(axis=1) / x[:, None] ** 2
        even = np.linalg.lstsq(cosine / x[:, None] ** 2, target.real, rcond=None)[0]
        odd = np.linalg.lstsq(sine / x[:, None] ** 2, target.imag, rcond=None)[0]
        centre = -2.0 * even.sum(axis=0)
        found.append(np.concatenate([(even - odd)[::-1], centre[None], even + odd]))
    whole = np.zeros(2 * REACH + 1)
    whole[REACH] = 1.0
    rest = (whole - restoring_filter())[:, None]
    return np.array([*found, rest - steps.double * found[1] - steps.square * found[0]])


def following_filters(modes: ModalRecursion) -> Float[Array, "3 taps modes"]:
    """Return the filters of modal forces that give all the motion of modes that are not stepped.

    Parameters
    ----------
    modes : ModalRecursion
        Modes above half the sampling frequency, with the time step of the forces.

    Returns
    -------
    ndarray of float, shape (3, 2 REACH + 1, n_modes)
        Weights of the samples from REACH steps before to REACH after, for displacement, velocity
        and acceleration. A constant gives ``1 / omega^2``, and 0 for the two rates.

    Notes
    -----
    Fitted to ``(i omega)^k / (omega_n^2 - omega^2 + 2 i zeta omega_n omega)``, smooth up to `TOP`
    for such modes: within 3 % of it for a mode at half the sampling frequency, within 1 % from 0.75
    on.
    """
    x, lags = _angles()[:, None], np.arange(1, REACH + 1)
    omega = x / modes.dt
    motion = 1.0 / (modes.square - omega**2 + 1j * modes.double * omega)
    even, odd = (2.0 * np.cos(x * lags) - 2.0) / x**2, 2.0 * np.sin(x * lags) / x
    found = []
    for order, constant in enumerate((1.0 / modes.square, 0.0 * modes.square, 0.0 * modes.square)):
        target = (1j * omega) ** order * motion
        here = np.linalg.lstsq(even, (target.real - constant) / x**2, rcond=None)[0]
        turned = np.linalg.lstsq(odd, target.imag / x, rcond=None)[0]
        centre = constant - 2.0 * here.sum(axis=0)
        found.append(np.concatenate([(here - turned)[::-1], centre[None], here + turned]))
    return np.array(found)


def responses_of(
    filters: Float[Array, "... taps columns"], omega_dt: Float[Array, " lines"]
) -> Complex[Array, "... lines columns"]:
    """Return the frequency responses of filters whose taps run along the last axis but one.

    Parameters
    ----------
    filters : ndarray of float, shape (..., 2 REACH + 1, n_columns)
        Weights of the samples from REACH steps before to REACH after.
    omega_dt : ndarray of float, shape (n_lines,)
        Angular frequency times the time step [rad].
    """
    return np.exp(1j * np.outer(omega_dt, _TAPS)) @ filters


def _frozen(values: Array) -> Array:
    values.setflags(write=False)
    return values
