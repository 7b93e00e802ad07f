"""Say which single numbers are kept of every run: one row of a table each.

What is kept of runs, the labelled arrays, ``summary.csv``, the tables of screen and report, maps
and their pictures loop over `QUANTITIES`; a further quantity is a further row here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from trundle._typing import Array
from trundle.signals import BASE_ACCELERATION, mtvv, vibration_dose_value

__all__ = ["QUANTITIES", "Histories", "Mapped", "Quantity", "mapped", "tabled"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Histories:
    """Hold what quantities are measured on: the steps of some runs that are looked at.

    Attributes
    ----------
    time : ndarray of float, shape (n_steps,)
        Time [s].
    sampling_frequency : float
        Steps a second [Hz].
    acceleration, velocity : ndarray of float, shape (n_runs, n_steps, n_points)
        Motion, up positive [m/s2], [m/s].
    felt : ndarray of float, shape (n_runs, n_points, n_steps)
        Acceleration weighted as people feel it: Wb upright, Wd sideways [m/s2].
    base : ndarray of float, shape (n_points,)
        Weighted acceleration whose response factor is 1 [m/s2].
    contact_forces : ndarray of float, shape (n_runs, n_steps, n_contacts)
        Forces on the floor, positive when pressing [N].
    lifts : ndarray of bool, shape (n_contacts,)
        Which contacts would leave the floor rather than pull: wheels; not what forces given about
        a weight act at.
    """

    time: Float[Array, " steps"]
    sampling_frequency: float
    acceleration: Float[Array, "runs steps points"]
    velocity: Float[Array, "runs steps points"]
    felt: Float[Array, "runs points felt"]
    base: Float[Array, " points"]
    contact_forces: Float[Array, "runs all contacts"]
    lifts: Bool[Array, " contacts"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Mapped:
    """Hold how a number is mapped over a floor.

    Attributes
    ----------
    of : {"velocity", "acceleration", "felt"}
        Motion that it is measured on; acceleration, and what is felt of it (weighted by Wb), are
        mapped where they are asked for.
    measure : callable
        Takes the motion of some places over the record, shape (n_places, n_steps), and the steps a
        second; returns an array of shape (n_places,).
    figure : str
        What its picture is called.
    title : str
        What stands above it.
    word : str
        What it is called beside the pointer.
    """

    of: Literal["velocity", "acceleration", "felt"]
    measure: Callable[[Float[Array, "places steps"], float], Float[Array, " places"]]
    figure: str
    title: str
    word: str


@dataclass(frozen=True, kw_only=True, eq=False)
class Quantity:
    """Hold one number that is kept of every run.

    Attributes
    ----------
    name : str
        Its name in arrays and tables.
    units : str
        Unit in SI; units for people follow from it.
    long_name : str
        What it is, for the arrays.
    heading : str
        What it is called above a column of a table; nothing if it stands in none.
    per : {"point", "contact"}
        What there is one of.
    stored : bool
        Whether it is among the labelled arrays.
    mapped : Mapped or None
        How it is mapped over a floor; None if it is not.
    joined : {"largest", "at largest", "rms", "dose"}
        How values of a record's sections make that of the whole: the largest; that of the section
        whose acceleration is largest; as mean squares; as sums of fourth powers.
    measure : callable
        Takes `Histories`; returns an array of shape (n_runs, n_points or n_contacts).
    """

    name: str
    units: str
    long_name: str
    heading: str = ""
    per: Literal["point", "contact"] = "point"
    stored: bool = True
    mapped: Mapped | None = None
    joined: Literal["largest", "at largest", "rms", "dose"] = "largest"
    measure: Callable[[Histories], Array]


QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        name="peak_acceleration",
        units="m/s2",
        long_name="largest absolute acceleration",
        heading="peak acceleration",
        mapped=Mapped(
            of="acceleration",
            measure=lambda a, _: np.maximum(a.max(axis=-1), -a.min(axis=-1)),
            figure="map_peak",
            title="Peak acceleration over the floor",
            word="peak",
        ),
        measure=lambda h: np.abs(h.acceleration).max(axis=1),
    ),
    Quantity(
        name="peak_time",
        units="s",
        long_name="time of the largest absolute acceleration",
        stored=False,
        joined="at largest",
        measure=lambda h: h.time[np.abs(h.acceleration).argmax(axis=1)],
    ),
    Quantity(
        name="rms_velocity",
        units="m/s",
        long_name="RMS velocity over the record",
        heading="record RMS velocity",
        mapped=Mapped(
            of="velocity",
            measure=lambda v, _: np.sqrt(np.mean(v**2, axis=-1)),
            figure="map_rms",
            title="RMS velocity over the floor",
            word="record RMS",
        ),
        joined="rms",
        measure=lambda h: np.sqrt(np.mean(h.velocity**2, axis=1)),
    ),
    Quantity(
        name="response_factor",
        units="1",
        long_name="largest 1 s RMS of weighted acceleration over the base curve",
        stored=False,
        mapped=Mapped(
            of="felt",
            measure=lambda a, fs: mtvv(a, fs) / BASE_ACCELERATION,
            figure="map_response_factor",
            title="Response factor R over the floor",
            word="R",
        ),
        measure=lambda h: mtvv(h.felt, h.sampling_frequency) / h.base,
    ),
    Quantity(
        name="vdv",
        units="m/s1.75",
        long_name="vibration dose value of one event",
        stored=False,
        mapped=Mapped(
            of="felt",
            measure=vibration_dose_value,
            figure="map_vdv",
            title="Vibration dose value of one event over the floor",
            word="VDV",
        ),
        joined="dose",
        measure=lambda h: vibration_dose_value(h.felt, h.sampling_frequency),
    ),
    Quantity(
        name="weighted_rms",
        units="m/s2",
        long_name="RMS of weighted acceleration over the record",
        stored=False,
        joined="rms",
        measure=lambda h: np.sqrt(np.mean(h.felt**2, axis=-1)),
    ),
    Quantity(
        name="peak_contact_force",
        units="N",
        long_name="largest contact force, static load included",
        per="contact",
        measure=lambda h: h.contact_forces.max(axis=1),
    ),
    Quantity(
        name="tension",
        units="1",
        long_name="whether a contact would have had to pull: it would have left the floor",
        per="contact",
        stored=False,
        measure=lambda h: np.any(h.contact_forces < 0.0, axis=1) & h.lifts,
    ),
)
"""All of them, in the order of tables."""


def tabled() -> tuple[Quantity, ...]:
    """Return the quantities that have columns in tables."""
    return tuple(quantity for quantity in QUANTITIES if quantity.heading)


def mapped() -> tuple[tuple[Quantity, Mapped], ...]:
    """Return the quantities that are mapped, those of velocity first, of what is felt last."""
    found = [(quantity, quantity.mapped) for quantity in QUANTITIES if quantity.mapped is not None]
    order = ("velocity", "acceleration", "felt")
    return tuple(sorted(found, key=lambda pair: order.index(pair[1].of)))
