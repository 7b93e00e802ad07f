"""Offer ready vehicles, each with the source of its numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from trundle._checks import one_of
from trundle.errors import InputError
from trundle.vehicle.data_file import VehicleFile, shipped_files
from trundle.vehicle.description import Description, build_vehicle
from trundle.vehicle.model import Vehicle
from trundle.vehicle.parts import Axle, Body, LumpedMass, Unit, damping_coefficient

__all__ = [
    "RETIRED",
    "VEHICLES",
    "container_truck_40ft",
    "describe",
    "library_vehicle",
    "quarter_car",
    "sprung_mass",
]

# Pan, Mita and Li (2001) print 14,700 and 11,760 kN/cm; only N/cm gives the frequencies that
# they report (1.97, 2.40, 2.48 Hz), so these are N/cm in N/m.
_SUSPENSION = 14_700e2
_TYRE = 11_760e2


def _axle_spring(n_springs: int, n_tyres: int) -> float:
    """Return suspension springs in series with tyres [N/m]."""
    return 1.0 / (1.0 / (n_springs * _SUSPENSION) + 1.0 / (n_tyres * _TYRE))


def container_truck_40ft() -> Vehicle:
    """Build the paper's 40-ft container truck of 40.69 t.

    Axle 1 moves alone; axles 2 and 3 are the ends of the rigid trailer. The tandem counts as
    one axle with the stiffness of two.

    Returns
    -------
    Vehicle
        Three contacts, static loads 5.39, 12.39 and 22.91 t.

    Notes
    -----
    Printed: axle loads, kingpin load 11.82 t, container 30.48 t, chassis 4.25 t, damping
    ratios 0.10 and 0.02, spring constants (with the unit corrected, see above). Inferred:
    trailer wheelbase 9.2 m, which gives the printed 2.0 and 2.4 Hz; tractor wheelbase 3.3 m;
    pitch inertia of a uniform box of 12.192 m. The tractor's 0.57 t on the drive axle moves
    with it.

    References
    ----------
    Pan, Mita and Li (2001), Figures 4 to 6.

    Examples
    --------
    >>> container_truck_40ft().natural_frequencies().round(2).tolist()
    [1.97, 2.4, 2.48]
    """
    return _container_truck().build()


def _container_truck() -> Description:
    wheelbase, tractor_wheelbase, box = 9.2, 3.3, 12.192
    trailer, tandem_load, drive_load, steer_load = 34_730.0, 22_910.0, 12_390.0, 5_390.0
    share = tandem_load / trailer
    single, twin = _axle_spring(2, 2), _axle_spring(2, 4)
    springs = (single, twin, 2.0 * twin)
    loads, ratios = (steer_load, drive_load, tandem_load), (0.10, 0.02, 0.02)
    setbacks = (0.0, tractor_wheelbase, tractor_wheelbase + wheelbase)
    return Description(
        name="40-ft container truck",
        bodies=(
            Body(mass=steer_load),
            Body(
                mass=trailer,
                pitch_inertia=trailer * box**2 / 12.0,
                centre=tractor_wheelbase + share * wheelbase,
            ),
        ),
        lumped=(
            LumpedMass(mass=drive_load - (1 - share) * trailer, body=1, setback=tractor_wheelbase),
        ),
        axles=tuple(
            Axle(
                body=min(i, 1),
                setback=setbacks[i],
                stiffness=springs[i],
                damping=damping_coefficient(ratios[i], springs[i], loads[i]),
            )
            for i in range(3)
        ),
        # in a curve it is a tractor of two axles that pulls a semitrailer of one
        units=(
            Unit(lead=0.0, pivot=setbacks[1], contacts=(0, 1)),
            Unit(lead=setbacks[1], pivot=setbacks[2], contacts=(2,)),
        ),
        source="Pan, Mita and Li (2001), spring units corrected from kN/cm to N/cm",
        confidence="medium",
        assumption="wheelbases and pitch inertia are inferred from the printed frequencies",
    )


def sprung_mass(*, mass: float, stiffness: float, damping: float = 0.0) -> Vehicle:
    """Build one mass on one spring and damper [kg], [N/m], [N s/m]."""
    return build_vehicle(
        name="sprung mass",
        bodies=(Body(mass=mass),),
        axles=(Axle(body=0, setback=0.0, stiffness=stiffness, damping=damping),),
        source="given by the caller",
    )


def quarter_car(
    *,
    body_mass: float,
    axle_mass: float,
    stiffness: float,
    damping: float,
    tyre_stiffness: float,
    tyre_damping: float = 0.0,
) -> Vehicle:
    """Build a body over one suspension, one wheel mass and one tyre [kg], [N/m], [N s/m]."""
    return build_vehicle(
        name="quarter car",
        bodies=(Body(mass=body_mass),),
        axles=(
            Axle(
                body=0,
                setback=0.0,
                stiffness=stiffness,
                damping=damping,
                axle_mass=axle_mass,
                tyre_stiffness=tyre_stiffness,
                tyre_damping=tyre_damping,
            ),
        ),
        source="given by the caller",
    )


_PAPERS = "container_truck_40ft"
_FILES: dict[str, VehicleFile] = {file.name: file for file in shipped_files()}
_STATES: dict[str, tuple[VehicleFile, dict[str, bool]]] = {
    name: (file, state) for file in _FILES.values() for name, state in file.states()
}


def describe(name: str, changes: Mapping[str, Any] | None = None) -> Description:
    """Return the parts of a ready vehicle, to be changed before it is built.

    Parameters
    ----------
    name : str
        A name that ``trundle vehicles`` lists.
    changes : mapping, optional
        Of a vehicle that is known by a data sheet: fields of `DataSheet` in place of its own, as
        ``{"bounce": 5.0}``.

    Raises
    ------
    InputError
        No such vehicle, or one without a data sheet that is to be changed.
    """
    if name in RETIRED:
        raise InputError(f"vehicle {name!r} is no longer offered: {RETIRED[name]}")
    one_of("vehicle", name, VEHICLES)
    if name != _PAPERS:
        file, state = _STATES[name]
        return file.describe(**state, changes=changes or {})
    if changes:
        raise InputError(
            f"vehicle {name!r} is known by its parts: {', '.join(changes)} cannot be changed"
        )
    return _container_truck()


def _build(name: str) -> Vehicle:
    return describe(name).build()


VEHICLES: dict[str, Callable[[], Vehicle]] = {
    name: partial(_build, name) for name in (_PAPERS, *_STATES)
}
"""Ready vehicles by the name that a study file uses: the paper's, and one for each data file."""

RETIRED: dict[str, str] = {
    "articulated_truck_5_axle": "it had 1 % of damping and no source; use "
    "'tractor_3axle_semitrailer_6_axle_worn'",
}
"""Vehicles that are no longer offered, each with what to use instead."""


def library_vehicle(name: str) -> Vehicle:
    """Build a ready vehicle by name.

    Parameters
    ----------
    name : str
        A name that ``trundle vehicles`` lists.

    Raises
    ------
    InputError
        No such vehicle; the message lists what there is, or says what has replaced it.

    Examples
    --------
    >>> round(library_vehicle("tractor_3axle_semitrailer_6_axle").total_mass)
    35633
    """
    return describe(name).build()
