"""Make a vehicle of what a data sheet says: axle loads, wheelbase, frequencies, damping ratios.

The masses above the axles are put where they give each axle its load, with the pitch inertia of
masses over the axles (for two axles m a b: neither axle then moves with the other), and each axle
is a quarter car: its springs are those that give the frequencies asked for, exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trundle._checks import non_negative, positive, set_frozen, within
from trundle.errors import InputError
from trundle.vehicle.description import Description
from trundle.vehicle.parts import Axle, Body, damping_coefficient

__all__ = ["DataSheet", "quarter_car_springs"]


@dataclass(frozen=True, kw_only=True, eq=False)
class DataSheet:
    """Hold what a data sheet says of a vehicle on one frame.

    Attributes
    ----------
    name, source : str
        Name for tables, and where the numbers come from.
    setbacks : tuple of float
        Axles behind the front one [m], from 0.
    loads : tuple of float
        Mass on each axle, axle and wheels included [kg].
    laden : tuple of float
        The same with the payload; empty where it carries none.
    bounce : float
        Frequency of the mass over each axle on its springs [Hz], of the larger of its loads empty
        and laden; 0 where stiffnesses are given.
    damping : float
        Damping ratio of that motion.
    unsprung : tuple of float
        Mass of each axle with its wheels [kg]; empty of a vehicle on tyres alone.
    hop : float
        Frequency of an axle between its springs and tyres [Hz]; with `unsprung`.
    stiffness, tyre_stiffness : tuple of float
        Of the springs and of the tyres of each axle [N/m], in place of `bounce` and `hop`; without
        `unsprung` the tyres alone.
    track_width : float
        Between left and right wheels [m]; 0 takes both as one.
    contact_patch, wheel_radius : float
        How its tyres meet the road [m].
    assumption : str
        What of it is assumed.
    """

    name: str
    setbacks: tuple[float, ...]
    loads: tuple[float, ...]
    laden: tuple[float, ...] = ()
    bounce: float = 0.0
    damping: float = 0.05
    unsprung: tuple[float, ...] = ()
    hop: float = 0.0
    stiffness: tuple[float, ...] = ()
    tyre_stiffness: tuple[float, ...] = ()
    track_width: float = 0.0
    contact_patch: float = 0.0
    wheel_radius: float = 0.0
    source: str = ""
    assumption: str = ""

    def __post_init__(self) -> None:
        """Check that there is a number for each axle, and one way to say how stiff it is."""
        n = len(self.setbacks)
        for name in ("loads", "laden", "unsprung", "stiffness", "tyre_stiffness"):
            values = tuple(positive(name, float(v)) for v in getattr(self, name))
            if len(values) != n and (values or name == "loads"):
                raise InputError(f"{name} gives {len(values)} numbers for {n} axles: give one each")
            set_frozen(self, **{name: values})
        set_frozen(
            self,
            setbacks=tuple(float(s) for s in self.setbacks),
            bounce=non_negative("bounce", self.bounce),
            hop=non_negative("hop", self.hop),
            damping=within("damping", self.damping, 0.0, 0.999),
            track_width=non_negative("track_width", self.track_width),
        )
        if n < 1 or self.setbacks[0] != 0.0 or np.any(np.diff(self.setbacks) <= 0.0):
            raise InputError(f"setbacks must begin at 0 and rise; got {list(self.setbacks)} m")
        self._check_springs()
        least = np.minimum(self.loads, self.laden) if self.laden else np.array(self.loads)
        if self.unsprung and np.any(np.array(self.unsprung) >= least):
            raise InputError("an axle's unsprung mass must be below its load, empty and laden")
        if self.laden and sum(self.laden) <= sum(self.loads):
            raise InputError(
                f"a laden vehicle is heavier than an empty one; got {sum(self.laden):g} kg and "
                f"{sum(self.loads):g} kg"
            )

    def _check_springs(self) -> None:
        sprung, stated = bool(self.unsprung), bool(self.tyre_stiffness)
        if stated == (self.bounce > 0.0):
            raise InputError(
                "a data sheet says how stiff a vehicle is once: give its bounce frequency, or the "
                "tyre_stiffness of each axle"
            )
        if sprung and stated != bool(self.stiffness):
            raise InputError(
                "axles with unsprung masses have springs and tyres: give stiffness and "
                "tyre_stiffness, or bounce and hop"
            )
        if sprung and not stated and self.hop == 0.0:
            raise InputError("axles with unsprung masses hop: give hop, the frequency of it")
        if not sprung and (self.hop > 0.0 or self.stiffness):
            raise InputError(
                "hop and stiffness are of axles between springs and tyres: give unsprung too, or "
                "leave them out"
            )

    def description(self, *, laden: bool = False) -> Description:
        """Return the vehicle's parts, empty or laden.

        Raises
        ------
        InputError
            Laden without a payload, or a hop that no springs give.
        """
        if laden and not self.laden:
            raise InputError(f"vehicle {self.name!r} has no laden axle loads")
        carried = np.array(self.laden if laden else self.loads)
        unsprung = np.array(self.unsprung or np.zeros(len(carried)))
        sprung, at = carried - unsprung, np.array(self.setbacks)
        centre = float(sprung @ at / sprung.sum())
        inertia = float(sprung @ (at - centre) ** 2)
        body = Body(
            mass=float(sprung.sum()),
            pitch_inertia=inertia if len(at) > 1 else 0.0,
            centre=centre,
        )
        # of two axles tyres are as stiff as their larger load asks, empty or laden; of more axles
        # the springs tell the loads
        both = np.maximum(self.loads, self.laden) if self.laden else carried
        told = both if len(at) == 2 else carried
        axles = tuple(
            self._axle(i, float(told[i] - unsprung[i]), float(unsprung[i])) for i in range(len(at))
        )
        made = Description(
            name=self.name + ", laden" * laden,
            bodies=(body,),
            axles=axles,
            contact_patch=self.contact_patch,
            wheel_radius=self.wheel_radius,
            source=self.source,
            assumption=self.assumption,
        )
        return made if self.track_width == 0.0 else made.widened(self.track_width)

    def _axle(self, number: int, sprung: float, unsprung: float) -> Axle:
        setback = self.setbacks[number]
        if unsprung == 0.0:
            tyre = (
                self.tyre_stiffness[number]
                if self.tyre_stiffness
                else sprung * (2.0 * np.pi * self.bounce) ** 2
            )
            damping = damping_coefficient(self.damping, tyre, sprung)
            return Axle(body=0, setback=setback, stiffness=float(tyre), damping=damping)
        if self.tyre_stiffness:
            spring, tyre = self.stiffness[number], self.tyre_stiffness[number]
        else:
            spring, tyre = quarter_car_springs(sprung, unsprung, self.bounce, self.hop)
        return Axle(
            body=0,
            setback=setback,
            stiffness=spring,
            damping=damping_coefficient(self.damping, spring, sprung),
            axle_mass=unsprung,
            tyre_stiffness=tyre,
        )


def quarter_car_springs(
    sprung: float, unsprung: float, bounce: float, hop: float
) -> tuple[float, float]:
    """Return the spring and the tyre of a quarter car with two frequencies.

    Parameters
    ----------
    sprung, unsprung : float
        Masses above and below the spring [kg].
    bounce, hop : float
        Its natural frequencies [Hz], the spring being the softer of the two.

    Returns
    -------
    tuple of float
        Spring and tyre [N/m].

    Raises
    ------
    InputError
        Frequencies too near each other for any springs.

    Notes
    -----
    Of the characteristic equation, ``k kt = w1^2 w2^2 m mu`` and
    ``k / m + (k + kt) / mu = w1^2 + w2^2``: a quadratic equation for k, whose smaller root is the
    soft spring.

    Examples
    --------
    >>> k, kt = quarter_car_springs(1000.0, 100.0, 1.0, 10.0)
    >>> round(k * kt / (1000.0 * 100.0 * 10.0**2 * (2.0 * np.pi) ** 4), 9)
    1.0
    """
    one, two = (2.0 * np.pi * positive("bounce", bounce)) ** 2, (2.0 * np.pi * hop) ** 2
    a, b, c = 1.0 / sprung + 1.0 / unsprung, one + two, one * two * sprung
    root = b * b - 4.0 * a * c
    if hop <= bounce or root < 0.0:
        raise InputError(
            f"no springs give {sprung:g} kg over {unsprung:g} kg a bounce of {bounce:g} Hz and a "
            f"hop of {hop:g} Hz: raise hop, or lower bounce"
        )
    spring = 2.0 * c / (b + float(np.sqrt(root)))
    return spring, one * two * sprung * unsprung / spring
