"""Give transfer functions of a structure: a force here, motion there, at some frequencies.

By modes, with the static share of those left out, and without a step in time: lines are computed
at the frequencies that are asked for.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float
from scipy import sparse

from trundle._checks import frozen_array, set_frozen
from trundle._kinds import kinds_checked
from trundle._typing import Array, ArrayLike, SparseMatrix
from trundle.dynamics import TOP, Damping, ModalRecursion, Modes
from trundle.errors import FitnessWarning, InputError
from trundle.simulate.ground import Integration, PreparedFloor
from trundle.simulate.laying_out import Place, spot_rows
from trundle.simulate.modal.method import MODES_BEYOND, Modal
from trundle.simulate.spectral.transfer_doubts import FAR_ENOUGH, transfer_doubts
from trundle.structure import Spot, Spots, Structure

__all__ = [
    "TransferFunctions",
    "check_lines",
    "load_rows",
    "modes_needed",
    "place_rows",
    "transfer",
]

_STEP = 1e-3  # s: nothing is stepped, but a floor is prepared for some step
_LEAST = 25.0  # Hz: modes to here at least, so that lines near 0 have some
_ON_PLANE = 1e-6  # m
_BYTES = 50e6  # of modal answers held at once


@dataclass(frozen=True, kw_only=True, eq=False)
class TransferFunctions:
    """Hold what unit forces at some places do at others.

    Force and motion are positive upwards, or along x or y where a place says so: a structure's
    static answer at the load itself is real and positive. A contact force is positive when it
    presses, so it moves a place by minus this.

    Attributes
    ----------
    frequencies : ndarray of float, shape (n_lines,)
        Rising [Hz].
    receptance : ndarray of complex, shape (n_loads, n_points, n_lines)
        Displacement over force, for ``exp(+i omega t)`` [m/N].
    load_names, point_names : tuple of str
        Where forces act, and where motion is read.
    doubts : tuple of FitnessWarning
        What a reader must know of modes, damping, mirror planes and lines.
    """

    frequencies: Float[Array, " lines"]
    receptance: Complex[Array, "loads points lines"]
    load_names: tuple[str, ...]
    point_names: tuple[str, ...]
    doubts: tuple[FitnessWarning, ...] = ()

    def __post_init__(self) -> None:
        """Freeze both arrays, and check that names and lines are as many as the answers."""
        lines = frozen_array("frequencies", self.frequencies, shape=(None,))
        shape = (len(self.load_names), len(self.point_names), len(lines))
        answers = frozen_array("receptance", self.receptance, shape=shape, dtype=np.complex128)
        set_frozen(self, frequencies=lines, receptance=answers)

    def __repr__(self) -> str:
        """Say in a line what is held."""
        low, high = self.frequencies[[0, -1]]
        return (
            f"<TransferFunctions from {', '.join(self.load_names)} to "
            f"{', '.join(self.point_names)}: {len(self.frequencies)} lines, "
            f"{low:g} to {high:g} Hz>"
        )

    @property
    def mobility(self) -> Complex[Array, "loads points lines"]:
        """Velocity over force, ``i omega`` times the receptance [m/(s N)]."""
        return 2j * np.pi * self.frequencies * self.receptance

    @property
    def accelerance(self) -> Complex[Array, "loads points lines"]:
        """Acceleration over force, ``-omega^2`` times the receptance [1/kg]."""
        return -((2.0 * np.pi * self.frequencies) ** 2) * self.receptance


@kinds_checked
def transfer(
    floor: Structure | PreparedFloor,
    loads: Mapping[str, Place],
    points: Mapping[str, Place],
    frequencies: ArrayLike,
    *,
    integration: Integration | None = None,
    damping: Damping | None = None,
    modes: Modes | None = None,
) -> TransferFunctions:
    """Return the transfer functions from forces at places to motion at places.

    Parameters
    ----------
    floor : Structure or PreparedFloor
        The structure; one that is prepared brings integration and damping.
    loads : mapping of str to (x, y) or Spot
        Where a unit force acts [m]: up along the surface's normal, or along the spot's axis.
    points : mapping of str to (x, y) or Spot
        Where motion is read [m], likewise.
    frequencies : array_like of float, shape (n_lines,)
        Rising, from 0 on: at 0 the answer is the static one [Hz].
    integration : Modal, Newmark or another Integration, optional
        Says which modes are kept and to which frequency it shows. Without one, or without modes of
        its own, those below three times the highest frequency are kept.
    damping : ModalRatio, Rayleigh or another Damping, optional
        Damping of the floor; needed unless it is prepared.
    modes : Modes, optional
        Modes found before, at least as far as `modes_needed` says.

    Returns
    -------
    TransferFunctions
        Displacement over force, from each load to each point.

    Raises
    ------
    InputError
        A place off the floor, or a load that moves nothing; frequencies that the modes or the step
        do not show; a floor prepared otherwise; an undamped mode at one of the lines.

    Notes
    -----
    With modes scaled to unit modal mass, the answer at p to a force at l is

        H(omega) = sum_m phi_m(p) phi_m(l) / (omega_m^2 - omega^2 + 2 i zeta_m omega_m omega) + R

    where R is the static flexibility of the modes left out (`StaticFlexibility`), over
    ``1 + i beta omega`` where damping is Rayleigh's: dashpots in parallel with all stiffness, which
    the modes left out strain too. It is the same from p to l, to round-off. Of a structure that
    ends at mirror planes, a load acts together with its images behind them, and one in a plane is
    carried by the modelled side to its half (or quarter); then the way back is the same only
    between places that both lie off the planes.

    References
    ----------
    D. J. Ewins, Modal Testing (2000), section 2.4 (receptance, mobility, accelerance) and 5.3
    (residual of the modes beyond the range).

    Examples
    --------
    A simple beam sinks at midspan by ``L^3 / (48 E I)`` for a unit force there:

    >>> from trundle.dynamics import ModalRatio
    >>> from trundle.structure import beam_bridge
    >>> beam = beam_bridge(length=10.0, bending_stiffness=2e8, line_mass=500.0, n_elements=10)
    >>> middle = {"middle": (5.0, 0.0)}
    >>> found = transfer(beam, middle, middle, [0.0, 20.0], damping=ModalRatio(ratio=0.02))
    >>> float(round(found.receptance[0, 0, 0].real * 48 * 2e8 / 10.0**3, 6))
    1.0
    """
    lines = _rising(frequencies)
    structure = floor.floor if isinstance(floor, PreparedFloor) else floor
    chosen = floor.integration if isinstance(floor, PreparedFloor) else integration
    if chosen is not None:
        check_lines(lines, chosen)
    pressed = load_rows(structure, loads)
    reader = place_rows(structure, "point", points)
    prepared = _in_modes(floor, lines, integration, damping, modes)
    used = np.unique(pressed.indices)
    reach, shares = prepared.reach(used, reader), pressed[:, used].toarray()
    receptance = _by_modes(lines, reach.propagator, shares @ reach.dof_shapes.T, reach.read_shapes)
    if reach.residual is not None:
        receptance += (shares @ reach.residual.T)[:, :, None] / _strained(lines, prepared.damping)
    return TransferFunctions(
        frequencies=lines,
        receptance=receptance,
        load_names=tuple(loads),
        point_names=tuple(points),
        doubts=transfer_doubts(lines, prepared, reach.propagator),
    )


def modes_needed(top: float, integration: Integration | None = None) -> float:
    """Return to which frequency modes are needed for lines up to one [Hz]."""
    if integration is not None and integration.f_max is not None:
        return integration.f_max
    return max(FAR_ENOUGH * top, _LEAST)


def check_lines(frequencies: Float[Array, " lines"], integration: Integration) -> None:
    """Refuse frequencies above those that an integration shows as they are.

    Raises
    ------
    InputError
        With what to change, modes or step.
    """
    top, shown = float(frequencies[-1]), integration.f_resolved
    if top <= shown * (1.0 + 1e-9):
        return
    remedies = [f"ask for {shown:.4g} Hz at most"]
    if integration.f_max is not None and integration.f_max < MODES_BEYOND * top:
        remedies.append(f"raise f_max to {MODES_BEYOND * top:.4g} Hz")
    else:
        remedies.append(f"shorten dt to {1e3 * integration.dt * shown / top:.2g} ms")
    raise InputError(
        f"frequencies must be at most {shown:.4g} Hz, as far as the method shows them "
        f"({integration}); got {top:.4g} Hz: {', or '.join(remedies)}"
    )


def _rising(frequencies: ArrayLike) -> Float[Array, " lines"]:
    lines = frozen_array("frequencies", frequencies, shape=(None,))
    if not len(lines) or lines[0] < 0.0 or not np.all(np.diff(lines) > 0.0):
        raise InputError("frequencies must be some numbers of 0 or more, each above the last one")
    return lines


def place_rows(floor: Structure, what: str, places: Mapping[str, Place]) -> sparse.csr_array:
    """Return a row of weights for each place.

    Raises
    ------
    InputError
        A place off the floor, or none.
    """
    if not places:
        raise InputError(f"name at least one {what}, such as {{'tool': (6.0, 5.0)}}")
    found = list[SparseMatrix]()
    for name, place in places.items():
        spot = _spot(place)
        spots = Spots(xy=np.array([(spot.x, spot.y)]), on=spot.on, axis=spot.axis)
        try:
            found.append(spot_rows(floor, spots))
        except InputError as error:
            raise InputError(f"{what} {name!r}: {error}") from None
    return sparse.csr_array(sparse.vstack(found, format="csr"))


def load_rows(floor: Structure, loads: Mapping[str, Place]) -> sparse.csr_array:
    """Return the share of a unit force at each place that the model carries on each dof.

    Raises
    ------
    InputError
        A place off the floor, or one that is held.
    """
    rows = place_rows(floor, "load", loads)
    rows.eliminate_zeros()
    still = [name for name, n in zip(loads, np.diff(rows.indptr), strict=True) if n == 0]
    if still:
        raise InputError(
            f"load {still[0]!r}: the floor is held there and nothing moves; move it off the support"
        )
    shares = [_carried(floor, _spot(place)) for place in loads.values()]
    return sparse.csr_array(sparse.diags_array(shares) @ rows)


def _carried(floor: Structure, spot: Spot) -> float:
    """Return what share of a force the model carries: half of one in a mirror plane."""
    place = floor.surface(spot.on).frame.in_space(np.array([(spot.x, spot.y)]))
    on = [abs(float(mirror.away(place)[0])) < _ON_PLANE for mirror in floor.mirrors]
    return 0.5 ** sum(on)


def _spot(place: Place) -> Spot:
    return place if isinstance(place, Spot) else Spot(*place)


def _in_modes(
    floor: Structure | PreparedFloor,
    lines: Array,
    integration: Integration | None,
    damping: Damping | None,
    modes: Modes | None,
) -> PreparedFloor:
    """Return the floor in modes that reach as far as the lines need."""
    if isinstance(floor, PreparedFloor):
        _check_same(floor, integration, damping)
        if floor.modes is not None:
            return floor
        structure, damping, flexibility = floor.floor, floor.damping, floor.flexibility
    else:
        structure, flexibility = floor, None
    if damping is None:
        raise InputError(
            "damping must be given unless the floor is prepared, such as ModalRatio(ratio=0.03)"
        )
    if integration is not None:
        integration.check_damping(damping)
    if integration is None or integration.f_max is None:
        f_max = modes_needed(float(lines[-1]))
        integration = Modal(f_max=f_max, dt=min(_STEP, TOP / f_max))
    return integration.prepare(structure, damping, modes=modes, flexibility=flexibility)


def _check_same(
    floor: PreparedFloor, integration: Integration | None, damping: Damping | None
) -> None:
    for asked, has in ((integration, floor.integration), (damping, floor.damping)):
        if asked is not None and asked != has:
            raise InputError(
                f"the floor is prepared for {has}, and {asked} is asked for: leave it out, or "
                "prepare the floor for it"
            )


def _by_modes(
    lines: Array, steps: ModalRecursion, loads: Array, points: Array
) -> Complex[Array, "loads points lines"]:
    """Return the sum over modes, given those at the loads and at the points (n, n_modes)."""
    out = np.empty((len(loads), len(points), len(lines)), dtype=np.complex128)
    n_at_once = max(1, int(_BYTES / (16 * loads.size)))
    for part in _parts(len(lines), n_at_once):
        omega = 2.0 * np.pi * lines[part, None]
        stiffness = steps.square - omega**2 + 1j * steps.double * omega
        if not stiffness.all():
            at = lines[part][~stiffness.all(axis=1)][0]
            raise InputError(
                f"an undamped mode lies at {at:.6g} Hz, where its answer has no bound: give some "
                "damping, or move that line"
            )
        answers = loads / stiffness[:, None, :]
        for take in (np.real, np.imag):
            take(out)[:, :, part] = (take(answers) @ points.T).transpose(1, 2, 0)  # both are views
    return out


def _strained(lines: Array, damping: Damping) -> Complex[Array, " lines"]:
    """Return by what damping stiffens the modes left out, which follow a force quasi-statically."""
    beta = 0.0 if damping.rayleigh is None else damping.rayleigh.beta
    return 1.0 + 2j * np.pi * beta * lines


def _parts(n: int, most: int) -> Iterator[slice]:
    for start in range(0, n, most):
        yield slice(start, min(start + most, n))
