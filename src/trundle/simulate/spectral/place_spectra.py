"""Carry contact forces to the spectra of the motion at many places, in bounded memory.

The loads on the route's dofs are transformed, and multiplied line by line by the floor's frequency
response. A response takes as many operations as hundreds of runs of its place; so it is formed
once, for as many places as there is room, and all runs pass by it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager

import numpy as np
from jaxtyping import Complex, Float
from scipy import fft
from threadpoolctl import ThreadpoolController

from trundle._progress import Progress
from trundle._threads import n_threads
from trundle._typing import Array
from trundle.dynamics import (
    ModalRecursion,
    differentiator,
    few_lines,
    following_filters,
    image_filters,
    responses_of,
    restoring_filter,
)
from trundle.simulate.spectral.places import PlaceResponses

__all__ = ["place_spectra"]

_PLACES = 100  # answered for at once, at most: what is made of them stays in memory used before
_LINES = 128  # whose responses are formed at once, by those few of them that tell of all
_TURNED = 32  # multiplied at once, and turned in cache
_LOAD_BYTES = 25e6  # loads on the route's dofs in time, for a thread: memory that is used again
_SPECTRUM_BYTES = 8e8  # their spectra held at once
_RESPONSE_BYTES = 1.8e9  # frequency responses held at once
_ANSWER_BYTES = 250e6  # spectra at places held at once

Answer = tuple[slice, slice, Array, Array | None]


def place_spectra(
    places: PlaceResponses,
    forces: Float[Array, "steps contacts runs"],
    *,
    acceleration: bool,
    progress: Progress | None = None,
) -> Iterator[Answer]:
    """Give spectra of velocity, and of acceleration, some places and runs at a time.

    Parameters
    ----------
    places : PlaceResponses
        What leads from the forces to the places.
    forces : ndarray of float, shape (n_steps, n_contacts, n_runs)
        Contact forces [N], positive when they press on the floor.
    acceleration : bool
        Whether spectra of acceleration are wanted too; they cost as much again.
    progress : callable, optional
        Told the share done.

    Yields
    ------
    places, runs : slice
        Whose spectra these are.
    velocity, acceleration : ndarray of complex, shape (n_runs, n_places, n_lines)
        Discrete Fourier transforms over `n_padded` steps [m/s], [m/s2], until the next are asked
        for; the second None if it is not wanted.
    """
    n_places, n_runs = len(places.places), forces.shape[2]
    kind = np.complex64 if places.single else np.complex128
    n_lines, n_dofs = len(places.frequencies), places.route_shapes.shape[1]
    line_bytes, quantities = np.dtype(kind).itemsize * n_lines, 1 + acceleration
    groups = _parts(slice(0, n_places), _RESPONSE_BYTES / (line_bytes * n_dofs * quantities))
    held = _parts(slice(0, n_runs), _SPECTRUM_BYTES / (line_bytes * n_dofs))
    beside = _ANSWER_BYTES / (line_bytes * min(n_places, _PLACES))
    loads = np.empty((n_lines, n_dofs, max(part.stop - part.start for part in held)), dtype=kind)
    room = np.empty((1 + acceleration, 0, 0, 0), dtype=kind)
    done = 0
    responses: tuple[Array, ...] = ()
    for group, some_runs in itertools.product(groups, held):
        if some_runs.start == 0:
            responses = ()  # there is room for one group's alone
            responses = _responses(places, group, acceleration=acceleration)
        spectra = loads[:, :, : some_runs.stop - some_runs.start]
        _load_spectra(places, forces[:, :, some_runs], out=spectra)
        for some, runs in itertools.product(_parts(group, _PLACES), _parts(some_runs, beside)):
            at = slice(some.start - group.start, some.stop - group.start)
            part = spectra[:, :, runs.start - some_runs.start : runs.stop - some_runs.start]
            n_some, n_beside = at.stop - at.start, part.shape[2]
            if not room.size or room.shape[1] < n_beside or room.shape[2] < n_some:
                room = np.empty((len(responses), n_beside + 1, n_some + 1, n_lines), dtype=kind)
            answers = room[:, :n_beside, :n_some]
            for response, out in zip(responses, answers, strict=True):
                _multiply(response[:, at], part, out=out)
            yield some, runs, answers[0], answers[1] if acceleration else None
            done += n_beside * n_some
            if progress is not None:
                progress(done / (n_places * n_runs))


def _parts(whole: slice, most: float) -> list[slice]:
    """Cut a range into the fewest parts no larger than wanted, all nearly alike."""
    n = whole.stop - whole.start
    edges = np.linspace(whole.start, whole.stop, -(-n // max(1, int(most))) + 1).astype(int)
    return [slice(int(a), int(b)) for a, b in itertools.pairwise(edges)]


def _load_spectra(places: PlaceResponses, forces: Array, *, out: Array) -> None:
    """Put spectra of the loads on the route's dofs in place, (lines, dofs, runs)."""
    n_steps, _, n_runs = forces.shape
    n_dofs = out.shape[1]
    step = max(1, int(_LOAD_BYTES / (8 * n_steps * n_dofs)))
    kind = np.float32 if places.single else np.float64
    flat, loads = forces.reshape(-1, n_runs), places.loads.astype(kind)

    def transform(first: int) -> None:
        """Transform the loads of some runs."""
        some = slice(first, first + step)
        load = np.asarray(loads @ flat[:, some].astype(kind)).reshape(n_steps, n_dofs, -1)
        out[:, :, some] = fft.rfft(load, places.n_padded, axis=0)

    _in_threads(transform, range(0, n_runs, step))


def _responses(
    places: PlaceResponses, group: slice, *, acceleration: bool
) -> tuple[Complex[Array, "lines places dofs"], ...]:
    """Return velocity, and acceleration if wanted, for unit loads on the route's dofs."""
    kind = np.float32 if places.single else np.float64
    read = places.place_shapes[group].astype(kind, copy=False)
    shapes = places.route_shapes.astype(kind, copy=False)
    dt, lines = places.dt, places.frequencies
    shape = (len(lines), len(read), shapes.shape[1])
    n_stepped = places.n_stepped
    steps, followers = (
        places.propagator.part(part) for part in (slice(n_stepped), slice(n_stepped, None))
    )
    images, followed = image_filters(steps)[1:], following_filters(followers)[1:]
    kept = restoring_filter()[:, None]
    rates = [differentiator(order)[:, None] / dt**order for order in (1, 2)]
    found = tuple(np.empty(shape, np.result_type(kind, 1j)) for _ in range(1 + acceleration))

    def form(first: int) -> None:
        """Form the responses at some lines."""
        part = slice(first, first + _LINES)
        turn = 2.0 * np.pi * lines[part] * dt
        stepped = _modal_motion(steps, np.exp(1j * turn)[:, None])
        restored = responses_of(kept, turn)
        wanted = zip(stepped, images, followed, strict=True)
        motion = np.array(
            [
                np.hstack(
                    [restored * modal + responses_of(image, turn), responses_of(follow, turn)]
                )
                for modal, image, follow in itertools.islice(wanted, len(found))
            ]
        )
        sinking = np.array([responses_of(rate, turn) for rate in rates[: len(found)]])
        few = few_lines(np.concatenate([motion, sinking], axis=2))
        at = np.arange(len(turn)) if few is None else few[0]
        for out, whole, sinks in zip(found, motion[:, at], sinking[:, at], strict=True):
            told = out[part] if few is None else np.empty((len(at), *shape[1:]), dtype=out.dtype)
            for take in (np.real, np.imag):
                _read(read, take(whole).astype(kind), shapes, out=take(told))  # views both
            if places.residual is not None:
                told += sinks[:, :, None].astype(told.dtype) * places.residual[group].astype(kind)
            if few is not None:
                _combine(few[1].astype(kind), told, out=out[part])

    _in_threads(form, range(0, len(lines), _LINES))
    return found


def _combine(weights: Array, told: Array, *, out: Array) -> None:
    """Put answers at all lines in place, by those at few of them."""
    flat = told.view(weights.dtype).reshape(len(told), -1)
    np.matmul(weights, flat, out=out.view(weights.dtype).reshape(len(out), -1))


def _read(read: Array, motion: Array, shapes: Array, *, out: Array) -> None:
    """Put ``read @ (motion * shapes)`` in place, line by line: what is in between stays in cache.

    `motion` is that of every mode by its force, (n_lines, n_modes).
    """
    driven = np.empty_like(shapes)
    for seen, line in zip(out, motion, strict=True):
        np.multiply(line[:, None], shapes, out=driven)
        seen[:] = read @ driven


def _modal_motion(
    propagator: ModalRecursion, z: Complex[Array, "lines 1"]
) -> tuple[Complex[Array, "lines modes"], Complex[Array, "lines modes"]]:
    """Return modal velocity and acceleration by modal force.

    Displacement and velocity are ``(z I - phi)^-1 (g0 + z g1)``; acceleration is what the equation
    of motion leaves, ``p - 2 zeta omega v - omega^2 u``.
    """
    (p00, p01), (p10, p11) = propagator.phi.transpose(1, 2, 0)
    force_u, force_v = (propagator.from_start[:, i] + z * propagator.from_end[:, i] for i in (0, 1))
    determinant = (z - p00) * (z - p11) - p01 * p10
    u = ((z - p11) * force_u + p01 * force_v) / determinant
    v = (p10 * force_u + (z - p00) * force_v) / determinant
    return v, 1.0 - propagator.double * v - propagator.square * u


def _multiply(response: Array, spectra: Array, *, out: Array) -> None:
    """Put response @ spectra, line by line, in place with lines running fastest."""
    n_runs, n_places, n_lines = out.shape

    def multiply(first: int) -> None:
        """Multiply some lines, and turn them while they are in cache."""
        part = slice(first, first + _TURNED)
        product = np.matmul(response[part], spectra[part]).reshape(-1, n_places * n_runs)
        turned = np.ascontiguousarray(product.T).reshape(n_places, n_runs, -1)
        out[:, :, part] = turned.transpose(1, 0, 2)

    _in_threads(multiply, range(0, n_lines, _TURNED))


def _in_threads(work: Callable[[int], None], firsts: range) -> None:
    """Work in as many threads as there are cores, none of which splits a product again."""
    with _one_thread_a_product(), ThreadPoolExecutor(n_threads()) as pool:
        for _ in pool.map(work, firsts):
            pass


def _one_thread_a_product() -> AbstractContextManager[object]:
    return ThreadpoolController().select(internal_api="openblas").limit(limits=1)
