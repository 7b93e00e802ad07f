"""Answer for many places of a floor at once, from contact forces that are known.

Given the contact forces, a floor in its modes is linear and does not change in time; only the place
where they act does. So the forces are laid out on the dofs of the route, transformed, and
multiplied by the floor's frequency response between these dofs and the places. Steps are those of
the exact recursion (`dynamics.exact`), whose response is taken at ``z = exp(i omega dt)``: nothing
is lost against stepping, and nothing is stored for a place but what is made of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float
from scipy import fft, sparse
from threadpoolctl import ThreadpoolController

from trundle._threads import n_threads
from trundle._typing import Array
from trundle.dynamics import ModalRecursion
from trundle.errors import InputError
from trundle.route import ContactRows, Hermite, StaticStart, contact_rows
from trundle.simulate._modal_floor import ModalFloor
from trundle.simulate._residual import unit_loads
from trundle.simulate.layout import Layout
from trundle.simulate.prepared import PreparedFloor

__all__ = ["PlaceResponses", "lay_out_places"]

_NOUGHT = 1e-12  # of the largest weight: of a wheel on a mesh line, half the nodes are round-off
_RINGING = 8.0  # s behind the record, for the floor and for low bands to come to rest
_PLACES = 128  # answered for at once
_LINES = 12  # whose responses are formed at once: they stay in cache
_LOAD_BYTES = 150e6  # loads on the route's dofs held in time at once
_SPECTRUM_BYTES = 1.2e9  # their spectra held at once
_ANSWER_BYTES = 250e6  # spectra at places held at once

Answer = tuple[slice, slice, Array, Array | None]


@dataclass(frozen=True, kw_only=True, eq=False)
class PlaceResponses:
    """Hold what leads from contact forces to the velocity at many places.

    Attributes
    ----------
    dt : float
        Time step [s].
    n_steps : int
        Steps of the record.
    n_padded : int
        Steps of record and ringing together, which is the period of the transforms.
    places : ndarray of float, shape (n_places, 2)
        Where the response is asked for [m].
    loads : sparse array, shape (n_steps * n_dofs, n_steps * n_contacts)
        Loads on the route's dofs by contact forces, upwards positive.
    route_shapes, place_shapes : ndarray of float, shape (n_modes, n_dofs) and (n_places, n_modes)
        Modes at the route's dofs and at the places.
    residual : ndarray of float or None, shape (n_places, n_dofs)
        Static flexibility of the modes left out [m/N].
    propagator : ModalRecursion
        Steps of the modes.
    single : bool
        Whether single precision is enough.
    """

    dt: float
    n_steps: int
    n_padded: int
    places: Float[Array, "places 2"]
    loads: sparse.csr_array
    route_shapes: Float[Array, "modes dofs"]
    place_shapes: Float[Array, "places modes"]
    residual: Float[Array, "places dofs"] | None
    propagator: ModalRecursion
    single: bool

    @property
    def frequencies(self) -> Float[Array, " lines"]:
        """Return the frequencies of the spectral lines [Hz]."""
        return np.fft.rfftfreq(self.n_padded, self.dt)

    def spectra(
        self,
        forces: Float[Array, "steps contacts runs"],
        *,
        acceleration: bool,
        progress: Callable[[float], None] | None = None,
    ) -> Iterator[Answer]:
        """Give spectra of velocity, and of acceleration, some places and runs at a time.

        Parameters
        ----------
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
        velocity, acceleration : ndarray of complex, shape (n_lines, n_places, n_runs)
            Discrete Fourier transforms over `n_padded` steps [m/s], [m/s2]; the second None if it
            is not wanted.
        """
        n_runs, n_dofs = forces.shape[2], self.route_shapes.shape[1]
        size = 8 if self.single else 16
        n_lines = len(self.frequencies)
        most = max(1, int(_SPECTRUM_BYTES / (size * n_lines * n_dofs)))
        at_once = max(1, int(_ANSWER_BYTES / (size * n_lines * _PLACES)))
        blocks = [
            (start, slice(place, place + _PLACES))
            for start in range(0, n_runs, most)
            for place in range(0, len(self.places), _PLACES)
        ]
        spectra, held = np.zeros((0, 0, 0)), -1
        for done, (start, places) in enumerate(blocks):
            if held != start:
                spectra, held = self._load_spectra(forces[:, :, start : start + most]), start
            response = self._response(places, rate=False)
            second = self._response(places, rate=True) if acceleration else None
            for first in range(0, spectra.shape[2], at_once):
                some = slice(first, min(first + at_once, spectra.shape[2]))
                runs = slice(start + some.start, start + some.stop)
                part = spectra[:, :, some]
                velocity = _multiplied(response, part)
                yield places, runs, velocity, None if second is None else _multiplied(second, part)
            if progress is not None:
                progress((done + 1) / len(blocks))

    def _load_spectra(self, forces: Array) -> Array:
        """Return spectra of the loads on the route's dofs, (lines, dofs, runs)."""
        n_steps, _, n_runs = forces.shape
        n_dofs = self.route_shapes.shape[1]
        kind = np.complex64 if self.single else np.complex128
        out = np.empty((len(self.frequencies), n_dofs, n_runs), dtype=kind)
        step = max(1, int(_LOAD_BYTES / (8 * n_steps * n_dofs)))
        flat = forces.reshape(-1, n_runs)
        for first in range(0, n_runs, step):
            some = slice(first, first + step)
            load = (self.loads @ flat[:, some]).reshape(n_steps, n_dofs, -1)
            if self.single:
                load = load.astype(np.float32)
            out[:, :, some] = fft.rfft(load, self.n_padded, axis=0, workers=n_threads())
        return out

    def _response(self, places: slice, *, rate: bool) -> Complex[Array, "lines places dofs"]:
        """Return velocity, or its rate, at places for unit loads on the route's dofs."""
        kind = np.float32 if self.single else np.float64
        read = self.place_shapes[places].astype(kind, copy=False)
        shapes = self.route_shapes.astype(kind, copy=False)
        n_dofs = shapes.shape[1]
        out = np.empty((len(self.frequencies), len(read), n_dofs), dtype=np.result_type(kind, 1j))

        def form(first: int) -> None:
            part = slice(first, first + _LINES)
            z = np.exp(2j * np.pi * self.frequencies[part] * self.dt)[:, None]
            modal = (_modal_acceleration if rate else _modal_velocity)(self.propagator, z)
            # what follows at once, by the differences that stepping takes of it
            rest = (z - 2.0 + 1.0 / z) / self.dt**2 if rate else (z - 1.0 / z) / (2.0 * self.dt)
            for take in (np.real, np.imag):
                driven = take(modal).astype(kind)[:, :, None] * shapes
                take(out)[part] = read @ driven  # both are views
            if self.residual is not None:
                out[part] += (rest[:, :, None] * self.residual[places]).astype(out.dtype)

        with _one_thread_a_product(), ThreadPoolExecutor(n_threads()) as pool:
            for _ in pool.map(form, range(0, len(out), _LINES)):
                pass
        return out


def lay_out_places(
    prepared: PreparedFloor,
    layout: Layout,
    places: Float[Array, "places 2"],
    *,
    single: bool = True,
) -> PlaceResponses:
    """Lay out the way from the contact forces of a crossing to many places.

    Parameters
    ----------
    prepared : PreparedFloor
        The floor in its modes, as the layout uses it.
    layout : Layout
        Who drives where.
    places : ndarray of float, shape (n_places, 2)
        Where the response is asked for [m].
    single : bool
        Compute in single precision: twice as fast, and within 1e-5.

    Raises
    ------
    InputError
        A floor that is not stepped in its modes, or a crossing that starts on it.
    """
    floor = layout.floor
    if not isinstance(floor, ModalFloor) or prepared.modes is None:
        raise InputError("a map needs a floor in its modes: choose Modal")
    if any(isinstance(crossing.entry, StaticStart) for crossing in layout.crossings):
        raise InputError("a map needs a floor at rest at time 0: let the vehicle drive in or ramp")
    rows, modes = floor.rows, prepared.modes
    kept = np.abs(rows.value) > _NOUGHT * np.abs(rows.value).max(initial=0.0)
    used = np.unique(rows.dofs[kept])
    along_x = np.broadcast_to([1.0, 0.0], places.shape)
    reading = contact_rows(prepared.floor, places, along_x, shape=Hermite())
    reader = reading.matrix(reading.value)
    residual = None
    place_shapes = np.ascontiguousarray(reader @ modes.shapes[:, : floor.n_modes])
    if prepared.residual:
        residual = np.empty((len(places), len(used)))
        for part, unit in unit_loads(used, prepared.floor.n_dofs):
            residual[:, part] = reader @ prepared.flexibility.solve(unit)
        residual -= (place_shapes / modes.omega**2) @ modes.shapes[used].T
    n_steps = len(layout.time)
    dt = layout.integration.dt
    return PlaceResponses(
        dt=dt,
        n_steps=n_steps,
        n_padded=_padded(n_steps, dt),
        places=places,
        loads=_loads(rows, kept, used, n_steps),
        route_shapes=np.ascontiguousarray(modes.shapes[used].T),
        place_shapes=place_shapes,
        residual=residual,
        propagator=floor.propagator,
        single=single,
    )


def _padded(n_steps: int, dt: float) -> int:
    """Return an even number of steps, quick to transform: whole seconds where steps divide them."""
    fs = 1.0 / dt
    if abs(fs - round(fs)) < 1e-9 * fs:
        seconds = fft.next_fast_len(int(np.ceil(n_steps * dt + _RINGING)))
        return seconds * round(fs) * (2 if seconds * round(fs) % 2 else 1)
    return 2 * fft.next_fast_len(int(np.ceil((n_steps + _RINGING * fs) / 2)), real=True)


def _loads(rows: ContactRows, kept: Array, used: Array, n_steps: int) -> sparse.csr_array:
    """Return loads on used dofs at every step by the contact forces at every step."""
    n_rows, width = rows.dofs.shape
    weights = -rows.load_share[:, None] * rows.value
    step = np.arange(n_rows) // (n_rows // n_steps)
    at = step[:, None] * len(used) + np.searchsorted(used, rows.dofs)
    column = np.broadcast_to(np.arange(n_rows)[:, None], (n_rows, width))
    shape = (n_steps * len(used), n_rows)
    return sparse.csr_array((weights[kept], (at[kept], column[kept])), shape=shape)


def _modal_motion(
    propagator: ModalRecursion, z: Complex[Array, "lines 1"]
) -> tuple[Complex[Array, "lines modes"], Complex[Array, "lines modes"]]:
    """Return modal displacement and velocity by modal force: ``(z I - phi)^-1 (g0 + z g1)``."""
    (p00, p01), (p10, p11) = propagator.phi.transpose(1, 2, 0)
    force_u, force_v = (propagator.from_start[:, i] + z * propagator.from_end[:, i] for i in (0, 1))
    determinant = (z - p00) * (z - p11) - p01 * p10
    u = ((z - p11) * force_u + p01 * force_v) / determinant
    return u, (p10 * force_u + (z - p00) * force_v) / determinant


def _modal_velocity(propagator: ModalRecursion, z: Complex[Array, "lines 1"]) -> Array:
    return _modal_motion(propagator, z)[1]


def _modal_acceleration(propagator: ModalRecursion, z: Complex[Array, "lines 1"]) -> Array:
    """Return ``p - 2 zeta omega v - omega^2 u`` by modal force."""
    u, v = _modal_motion(propagator, z)
    return 1.0 - propagator.double * v - propagator.square * u


def _one_thread_a_product() -> AbstractContextManager[object]:
    """Keep threads of single products from taking the cores of those that run beside them."""
    return ThreadpoolController().select(internal_api="openblas").limit(limits=1)


def _multiplied(response: Array, spectra: Array) -> Array:
    """Return response @ spectra, line by line, in threads."""
    out = np.empty((len(response), response.shape[1], spectra.shape[2]), dtype=response.dtype)

    def multiply(first: int) -> None:
        part = slice(first, first + _LINES)
        np.matmul(response[part], spectra[part], out=out[part])

    with _one_thread_a_product(), ThreadPoolExecutor(n_threads()) as pool:
        for _ in pool.map(multiply, range(0, len(response), _LINES)):
            pass
    return out
