"""Give combinations that answer as arrays to be kept, and see whether kept ones can be believed."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.dynamics.answering import AnsweringModes
from trundle.dynamics.enquiry import Enquiry, Questions
from trundle.dynamics.modes import Modes
from trundle.dynamics.pencil import DampedPencil, shift_near

__all__ = ["answers_as_arrays", "answers_from_arrays", "are_answers_of"]

_SUMS = 3  # random sums of all combinations by which kept ones are tried
_OFF = 1e-6  # relative, that such a sum may be off
_ROUND_OFF = 1e-12  # of the largest, that may be left of it where others cancel


def answers_as_arrays(found: AnsweringModes) -> dict[str, Array]:
    """Return all that combinations hold."""
    modes = found.modes
    return {
        "omega": modes.omega,
        "shapes": modes.shapes,
        "f_max": np.array(modes.f_max),
        "error": np.array(found.error),
        "n_frequencies": np.array(found.n_frequencies),
        "n_below": np.array(found.n_below),
    }


def answers_from_arrays(arrays: Mapping[str, Array]) -> AnsweringModes:
    """Return combinations that were kept.

    Raises
    ------
    KeyError
        Something is missing.
    """
    omega, error = arrays["omega"], float(arrays["error"])
    modes = Modes(
        omega=omega,
        shapes=arrays["shapes"],
        residuals=np.full(len(omega), error),
        f_max=float(arrays["f_max"]),
    )
    return AnsweringModes(
        modes=modes,
        error=error,
        n_frequencies=int(arrays["n_frequencies"]),
        n_below=int(arrays["n_below"]),
    )


def are_answers_of(
    found: AnsweringModes,
    pencil: DampedPencil,
    questions: Questions,
    *,
    ratios: Callable[[Float[Array, " lines"]], Float[Array, " lines"]],
    tolerance: float,
) -> bool:
    """Return whether combinations answer questions of a structure within a tolerance.

    Parameters
    ----------
    found : AnsweringModes
        What was kept.
    pencil : DampedPencil
        The structure.
    questions : Questions
        What is asked of it.
    ratios : callable
        Gives the damping ratio at circular frequencies [rad/s].
    tolerance : float
        Error that is allowed.

    Notes
    -----
    Random sums of the combinations must meet each of them, by mass and by stiffness, as those of
    unit mass and its frequency do; inertia counts the modes in whose place they stand; and at one
    frequency, drawn by their number, they are held against the structure solved there.
    """
    modes, n = found.modes, found.modes.n_modes
    fit = modes.shapes.shape == (pencil.mass.shape[0], n) and modes.omega.shape == (n,) and n > 0
    if not fit or not np.isfinite(modes.shapes).all() or not np.isfinite(modes.omega).all():
        return False
    if not (0.0 <= found.error <= tolerance and found.n_frequencies > 0):
        return False
    random = np.random.default_rng(n)
    if not _are_combinations(modes, pencil, random.choice([-1.0, 1.0], size=(n, _SUMS))):
        return False
    high = 2.0 * np.pi * modes.f_max
    if shift_near(pencil, high).below != found.n_below:
        return False
    omega = high * random.uniform(0.3, 1.0)
    shift = complex(omega**2 / (1.0 + 2j * ratios(np.array([omega]))[0]))
    enquiry = Enquiry.of_probes(pencil, questions, pencil.factorise(0.0))
    motions = enquiry.motions(modes.omega, modes.shapes)
    off, sizes = enquiry.difference(motions, shift, enquiry.at(shift))
    return bool(np.all(np.linalg.norm(off, axis=1) <= tolerance * np.linalg.norm(sizes, axis=1)))


def _are_combinations(modes: Modes, pencil: DampedPencil, signs: Array) -> bool:
    """Return whether combinations have unit mass, and their frequencies, by sums of them."""
    both, square = modes.shapes @ signs, modes.omega[:, None] ** 2
    heavy, stiff = (modes.shapes.T @ (by @ both) for by in (pencil.mass, pencil.stiffness))
    limit = _OFF * square + _ROUND_OFF * square.max()
    return bool(
        np.all(np.abs(heavy - signs) <= _OFF) and np.all(np.abs(stiff - square * signs) <= limit)
    )
