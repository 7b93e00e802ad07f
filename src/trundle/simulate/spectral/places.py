"""Answer for many places of a floor at once, from contact forces that are known.

Given the contact forces, a floor in its modes is linear and does not change in time; only the place
where they act does. So the forces are laid out on the dofs of the route, transformed, and
multiplied by the floor's frequency response between these dofs and the places. Steps are those of
the exact recursion (`dynamics.exact`), whose response is taken at ``z = exp(i omega dt)``: nothing
is lost against stepping, and nothing is stored for a place but what is made of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import fft, sparse

from trundle._typing import Array
from trundle.dynamics import ModalRecursion
from trundle.errors import InputError
from trundle.route import ContactRows
from trundle.simulate.ground import ModalReach, PreparedFloor
from trundle.simulate.laying_out import spot_rows
from trundle.simulate.layout import Layout
from trundle.simulate.wheels.standing import StandingWheels
from trundle.structure import Spots

__all__ = ["PlaceResponses", "lay_out_places"]

_NOUGHT = 1e-12  # of the largest weight: of a wheel on a mesh line, half the nodes are round-off
_RINGING = 8.0  # s behind the record, for low bands to come to rest
_AT_REST = 1e-3  # of its motion, that a mode is left with before the period begins again
_LONGEST = 300.0  # s of ringing at most: of a floor with next to no damping more is left


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
    n_stepped : int
        How many of them are stepped; the others follow the forces (`following_filters`).
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
    n_stepped: int
    single: bool

    @property
    def frequencies(self) -> Float[Array, " lines"]:
        """Return the frequencies of the spectral lines [Hz]."""
        return np.fft.rfftfreq(self.n_padded, self.dt)


def lay_out_places(
    prepared: PreparedFloor,
    layout: Layout,
    places: Spots | Sequence[Spots],
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
    places : Spots, or a sequence of them
        Where the response is asked for, on one surface or on several.
    single : bool
        Compute in single precision: twice as fast, and within 1e-5.

    Raises
    ------
    InputError
        A floor that is not stepped in its modes, or a crossing that starts on it.
    """
    standing = layout.rows
    if standing is None:
        raise InputError("a map needs a floor: rigid ground does not vibrate")
    if layout.wheels.static:
        raise InputError("a map needs a floor at rest at time 0: let the vehicle drive in or ramp")
    used = np.unique(np.concatenate([rows.dofs[kept] for rows, kept, _ in _pressing(standing)]))
    spots = [places] if isinstance(places, Spots) else list(places)
    rows = sparse.vstack([spot_rows(prepared.floor, some) for some in spots], format="csr")
    reach = prepared.reach(used, rows)
    n_steps, dt = len(layout.time), layout.integration.dt
    return PlaceResponses(
        dt=dt,
        n_steps=n_steps,
        n_padded=_padded(n_steps, dt, _ringing(reach)),
        places=np.concatenate([some.xy for some in spots]),
        loads=_loads(standing, used),
        route_shapes=reach.dof_shapes,
        place_shapes=reach.read_shapes,
        residual=reach.residual,
        propagator=reach.propagator,
        n_stepped=reach.n_stepped,
        single=single,
    )


def _ringing(reach: ModalReach) -> float:
    """Return how long the slowest mode takes to come to rest [s]."""
    slowest = 0.5 * float(reach.propagator.double[: reach.n_stepped].min())  # zeta omega
    return max(_RINGING, min(-np.log(_AT_REST) / max(slowest, 1e-9), _LONGEST))


def _padded(n_steps: int, dt: float, ringing: float) -> int:
    """Return an even number of steps, quick to transform: whole seconds where steps divide them."""
    fs = 1.0 / dt
    if abs(fs - round(fs)) < 1e-9 * fs:
        seconds = fft.next_fast_len(int(np.ceil(n_steps * dt + ringing)))
        return seconds * round(fs) * (2 if seconds * round(fs) % 2 else 1)
    return 2 * fft.next_fast_len(int(np.ceil((n_steps + ringing * fs) / 2)), real=True)


def _pressing(standing: StandingWheels) -> Iterator[tuple[ContactRows, Array, int]]:
    """Give rows window by window, which of their weights count, and their first row among all."""
    for start, stop in standing.windows():
        rows, _ = standing.window(start, stop)
        yield rows, np.abs(rows.value) > _NOUGHT * standing.largest, start * standing.n_contacts


def _loads(standing: StandingWheels, used: Array) -> sparse.csr_array:
    """Return loads on used dofs at every step by the contact forces at every step."""
    weights, at, columns = [], [], []
    for rows, kept, first in _pressing(standing):
        row = first + np.arange(len(rows.dofs))[:, None]
        step = row // standing.n_contacts
        weights.append((-rows.load_share[:, None] * rows.value)[kept])
        at.append((step * len(used) + np.searchsorted(used, rows.dofs))[kept])
        columns.append(np.broadcast_to(row, rows.dofs.shape)[kept])
    entries = (np.concatenate(weights), (np.concatenate(at), np.concatenate(columns)))
    shape = (standing.n_steps * len(used), standing.n_steps * standing.n_contacts)
    return sparse.csr_array(entries, shape=shape)
