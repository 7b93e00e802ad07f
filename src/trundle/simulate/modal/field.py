"""Give the motion of many places at some steps, once the forces under the wheels are known.

The kernels of ensembles read few places of many runs; here it is the other way round. Modes are
stepped by themselves through the record of one run, and read where they are wanted; the static rest
of the modes left out is solved for at the steps that are shown.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.simulate.modal.method import FloorInModes
from trundle.simulate.wheels.standing import StandingWheels

__all__ = ["field_motion"]

_AT_ONCE = 32  # static solutions


def field_motion(
    prepared: FloorInModes,
    standing: StandingWheels,
    forces: Float[Array, "steps contacts"],
    reader: SparseMatrix,
    steps: Int[Array, " frames"],
    *,
    at_rest: bool = False,
    progress: Progress | None = None,
) -> Float[Array, "frames places"]:
    """Return the displacement of places at some steps [m].

    Parameters
    ----------
    prepared : FloorInModes
        The structure in its modes.
    standing : StandingWheels
        How wheels stand on it at every step.
    forces : ndarray of float, shape (n_steps, n_contacts)
        Contact forces of one run, positive when pressing [N].
    reader : sparse matrix, shape (n_places, n_dofs)
        Weights that give the displacement of each place.
    steps : ndarray of int, shape (n_frames,)
        At which steps, rising.
    at_rest : bool
        Whether the structure has settled under the first forces; it is unloaded unless so.
    progress : callable, optional
        Told the share of the steps done.
    """
    pressed = np.zeros((len(steps), prepared.modes.n_modes))
    moved = np.empty_like(pressed)
    square = prepared.modes.omega**2
    state, before, at = np.zeros((len(square), 2)), np.zeros(len(square)), 0
    turn = prepared.propagator
    for start, stop in standing.windows():
        loads = prepared.modes.seen(_loads(standing, forces, start, stop))
        for step, load in enumerate(loads, start=start):
            if step == 0:
                state[:, 0] = load / square if at_rest else 0.0
            else:
                state = np.einsum("mij,mj->mi", turn.phi, state)
                state += turn.from_start * before[:, None] + turn.from_end * load[:, None]
            before = load
            if at < len(steps) and steps[at] == step:
                pressed[at], moved[at] = load, state[:, 0]
                at += 1
        if progress is not None:
            progress(stop / standing.n_steps)
    seen = prepared.modes.seen(reader)
    out = moved @ seen.T
    if prepared.residual:
        out += _rest(prepared, standing, forces, reader, steps) - (pressed / square) @ seen.T
    return out


def _loads(standing: StandingWheels, forces: Array, start: int, stop: int) -> SparseMatrix:
    """Return the load of each step on all dofs, (n_steps, n_dofs)."""
    rows, _ = standing.window(start, stop)
    n = stop - start
    pressing = -forces[start:stop].reshape(-1, 1) * rows.load_share[:, None]
    matrix = rows.matrix(rows.value * pressing)
    step, one = np.repeat(np.arange(n), forces.shape[1]), np.ones(n * forces.shape[1])
    of_step = sparse.csr_array((one, (step, np.arange(len(step)))), shape=(n, len(step)))
    return (of_step @ matrix).tocsr()


def _rest(
    prepared: FloorInModes,
    standing: StandingWheels,
    forces: Array,
    reader: SparseMatrix,
    steps: Array,
) -> Array:
    """Return the static deflection of places under the forces of some steps."""
    out = np.empty((len(steps), reader.shape[0]))
    for start in range(0, len(steps), _AT_ONCE):
        some = steps[start : start + _AT_ONCE]
        loads = [_loads(standing, forces, int(k), int(k) + 1).toarray()[0] for k in some]
        u = prepared.flexibility.solve(np.ascontiguousarray(np.array(loads).T))
        out[start : start + len(some)] = (reader @ u).T
    return out
