"""See a floor in its modes as walkers press on it, and as others feel it.

A walker stands at a place as a point load; what he gives another place is a sum over modes, and the
static flexibility of those left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from trundle._checks import frozen_array, set_frozen
from trundle._progress import Progress
from trundle._typing import Array, SparseMatrix
from trundle.errors import InputError
from trundle.route import contact_rows
from trundle.simulate.ground import PreparedFloor
from trundle.simulate.modal.method import FloorInModes
from trundle.structure import Hermite, Spots, Structure

__all__ = ["FootfallFloor", "footfall_floor"]

_PAIRS = 2_000_000  # of walkers and places answered for at once
_COLUMNS = 64  # static loads solved at once


@dataclass(frozen=True, kw_only=True, eq=False)
class FootfallFloor:
    """Hold modes at the places that are walked on, and at those where it is felt.

    Attributes
    ----------
    omega : ndarray of float, shape (n_modes,)
        Natural circular frequencies [rad/s].
    ratios : ndarray of float, shape (n_modes,)
        Ratios of critical damping.
    felt : ndarray of float, shape (n_places, n_modes)
        Mode shapes where it is felt, modes of unit modal mass [1/sqrt(kg)].
    walked : ndarray of float, shape (n_walkers, n_modes)
        Mode shapes under walkers.
    residual : ndarray of float or None, shape (n_places, n_walkers), or (n_places, 1) if alone
        Static flexibility of the modes left out [m/N].
    alone : bool
        Whether each walker is felt at his own place only; there are as many as places then.
    """

    omega: Float[Array, " modes"]
    ratios: Float[Array, " modes"]
    felt: Float[Array, "places modes"]
    walked: Float[Array, "walkers modes"]
    residual: Float[Array, "places _"] | None = None
    alone: bool = False

    def __post_init__(self) -> None:
        """Check that shapes fit, and that every mode is damped."""
        n = len(self.omega)
        for name, shape in (("omega", (n,)), ("ratios", (n,)), ("felt", (None, n))):
            set_frozen(self, **{name: frozen_array(name, getattr(self, name), shape=shape)})
        rows = len(self.felt) if self.alone else None
        set_frozen(self, walked=frozen_array("walked", self.walked, shape=(rows, n)))
        if n == 0 or not len(self.felt) or not len(self.walked):
            raise InputError("footfall needs a mode, a place that is walked on and one to feel it")
        wrong = np.flatnonzero((self.ratios <= 0.0) | (self.ratios >= 1.0))
        if wrong.size:
            raise InputError(
                f"damping ratio of mode {wrong[0] + 1} is {self.ratios[wrong[0]]:g}: a steady "
                "state needs one above 0 and below 1; give the floor its damping, such as 0.03"
            )

    @property
    def frequencies(self) -> Float[Array, " modes"]:
        """Natural frequencies [Hz]."""
        return self.omega / (2.0 * np.pi)

    def blocks(self) -> Iterator[slice]:
        """Give walkers some at a time, all of them if each is alone."""
        if self.alone:
            yield slice(0, 1)
            return
        step = max(1, _PAIRS // len(self.felt))
        for start in range(0, len(self.walked), step):
            yield slice(start, min(start + step, len(self.walked)))

    def carried(self, scale: Float[Array, " modes"], block: slice) -> Float[Array, "places some"]:
        """Return the sum over modes of ``felt scale walked`` for some walkers."""
        if self.alone:
            return ((self.felt * self.walked) @ scale)[:, None]
        return (self.felt * scale) @ self.walked[block].T

    def walkers(self, block: slice, column: Int[Array, " places"]) -> Int[Array, " places"]:
        """Return which walkers stand in the columns of a block, one for each place."""
        return np.arange(len(self.felt)) if self.alone else block.start + column

    def static(
        self, places: Int[Array, " some"], walkers: Int[Array, " some"]
    ) -> Float[Array, " some"]:
        """Return the residual flexibility between places and walkers [m/N]."""
        if self.residual is None:
            return np.zeros(len(places))
        return self.residual[places, np.zeros_like(walkers) if self.alone else walkers]


def footfall_floor(
    prepared: PreparedFloor,
    felt: Spots | Sequence[Spots],
    walked: Spots | Sequence[Spots] | None = None,
    *,
    progress: Progress | None = None,
) -> FootfallFloor:
    """See a prepared floor at places.

    Parameters
    ----------
    prepared : PreparedFloor
        The floor in its modes, from `prepare` with `Modal`.
    felt : Spots, or a sequence of them
        Where it is felt, vertically.
    walked : Spots, or a sequence of them, optional
        Where it is walked on. Unless given, walker and receiver are at the same place, each alone.
    progress : callable, optional
        Told the share of static deflections that are solved for.

    Raises
    ------
    InputError
        A floor that is not in its modes, level motion, a place off the floor, no damping.
    """
    if not isinstance(prepared, FloorInModes):
        raise InputError("footfall is answered in modes: prepare the floor with Modal")
    floor, modes = prepared.floor, prepared.modes
    reader, _ = _rows(floor, felt)
    presser = sparse.csr_array(reader if walked is None else _rows(floor, walked)[0])
    share = _rows(floor, felt if walked is None else walked)[1]
    presser = sparse.csr_array(presser.multiply(share[:, None]))
    alone = walked is None
    residual = None
    if prepared.residual:
        residual = _residual(prepared, reader, presser, alone=alone, progress=progress)
    square = prepared.propagator.square
    return FootfallFloor(
        omega=modes.omega,
        ratios=prepared.propagator.double / (2.0 * np.sqrt(square)),
        felt=modes.seen(reader),
        walked=modes.seen(presser),
        residual=residual,
        alone=alone,
    )


def _rows(floor: Structure, places: Spots | Sequence[Spots]) -> tuple[SparseMatrix, Array]:
    """Return rows that read deflections, and the share of a load that the model carries."""
    rows, shares = [], []
    for spots in [places] if isinstance(places, Spots) else places:
        if spots.axis != "z":
            raise InputError("footfall is vertical: places along x or y are not answered for")
        share = np.ones(len(spots))
        for direction in ([0.0, 1.0], [1.0, 0.0]):  # half of who stands in a plane of symmetry
            along = np.broadcast_to(direction, spots.xy.shape)
            found = contact_rows(floor, spots.xy, along, shape=Hermite(), on=spots.on)
            share = share * found.load_share
        rows.append(found.matrix(found.value))
        shares.append(share)
    return sparse.vstack(rows, format="csr"), np.concatenate(shares)


def _residual(
    prepared: FloorInModes,
    reader: SparseMatrix,
    presser: SparseMatrix,
    *,
    alone: bool,
    progress: Progress | None,
) -> Float[Array, "places _"]:
    """Return the flexibility of the modes left out, at places by walkers."""
    modes, n = prepared.modes, presser.shape[0]
    felt, walked = modes.seen(reader) / modes.omega**2, modes.seen(presser)
    out = np.empty((reader.shape[0], 1 if alone else n))
    for start in range(0, n, _COLUMNS):
        part = slice(start, start + _COLUMNS)
        sunk = prepared.flexibility.solve(np.ascontiguousarray(presser[part].T.toarray()))
        if alone:
            out[part, 0] = np.diag(reader[part] @ sunk) - np.sum(felt[part] * walked[part], axis=1)
        else:
            out[:, part] = reader @ sunk - felt @ walked[part].T
        if progress is not None:
            progress(min(1.0, (start + _COLUMNS) / n))
    return out
