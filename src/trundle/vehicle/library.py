"""Offer ready vehicles, each with the source of its numbers."""

from __future__ import annotations

from collections.abc import Callable

from trundle.vehicle.model import Vehicle
from trundle.vehicle.planar import (
    Axle,
    Body,
    Hinge,
    LumpedMass,
    build_vehicle,
    damping_coefficient,
)

__all__ = [
    "VEHICLES",
    "articulated_truck_5_axle",
    "container_truck_40ft",
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
    wheelbase, tractor_wheelbase, box = 9.2, 3.3, 12.192
    trailer, tandem_load, drive_load, steer_load = 34_730.0, 22_910.0, 12_390.0, 5_390.0
    share = tandem_load / trailer
    single, twin = _axle_spring(2, 2), _axle_spring(2, 4)
    springs = (single, twin, 2.0 * twin)
    loads, ratios = (steer_load, drive_load, tandem_load), (0.10, 0.02, 0.02)
    setbacks = (0.0, tractor_wheelbase, tractor_wheelbase + wheelbase)
    return build_vehicle(
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
        source="Pan, Mita and Li (2001), spring units corrected from kN/cm to N/cm",
    )


def articulated_truck_5_axle() -> Vehicle:
    """Build a five-axle articulated truck with separate wheel masses and tyres.

    Returns
    -------
    Vehicle
        Tractor with two axles, semitrailer with three.

    References
    ----------
    Parameters of example A01 of D. Cantero, VBI-2D (NTNU): body masses 4500 and 31450 kg,
    pitch inertias 4604 and 16302 kg m2, five suspensions and tyres; axle places follow from
    its spacings: -0.5 m and 2.5 m from the tractor's centre, hinge at 2.15 m; trailer axles
    at 1.8, 2.9 and 4.0 m behind the trailer's centre, hinge 6.15 m ahead of it.
    """
    tractor_centre = 0.5
    hinge = tractor_centre + 2.15
    trailer_centre = hinge + 6.15
    places = (0.0, tractor_centre + 2.5, *(trailer_centre + d for d in (1.8, 2.9, 4.0)))
    suspension = (400e3, 1000e3, 750e3, 750e3, 750e3)
    wheel_mass = (700.0, 1100.0, 750.0, 750.0, 750.0)
    tyre = (1750e3, 3500e3, 3500e3, 3500e3, 3500e3)
    return build_vehicle(
        name="5-axle articulated truck",
        bodies=(
            Body(mass=4500.0, pitch_inertia=4604.0, centre=tractor_centre),
            Body(mass=31450.0, pitch_inertia=16302.0, centre=trailer_centre),
        ),
        hinges=(Hinge(bodies=(0, 1), setback=hinge),),
        axles=tuple(
            Axle(
                body=0 if i < 2 else 1,
                setback=places[i],
                stiffness=suspension[i],
                damping=1e3,
                axle_mass=wheel_mass[i],
                tyre_stiffness=tyre[i],
                tyre_damping=10e3,
            )
            for i in range(5)
        ),
        source="VBI-2D example A01 (D. Cantero, NTNU), parameters only",
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


VEHICLES: dict[str, Callable[[], Vehicle]] = {
    "container_truck_40ft": container_truck_40ft,
    "articulated_truck_5_axle": articulated_truck_5_axle,
}
"""Ready vehicles by the name that a study file uses."""
