"""What a feature of a road says of itself, kind by kind: where it lies and what it is."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self, TypeAlias

import numpy as np
from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from trundle.road import (
    Bump,
    CableProtector,
    CosineHump,
    ExpansionJoint,
    Patch,
    Pothole,
    RailCrossing,
    RampKink,
    Shape,
)
from trundle.study_file.fields import (
    Angle,
    Grade,
    Length,
    Name,
    NonNegativeLength,
    Place,
    PositiveLength,
    Section,
)

__all__ = ["FeatureSection", "PlacedSection"]

_MOST = 10_000  # repetitions, and stations of one feature


def _as_list(value: object) -> object:
    return value if isinstance(value, list | tuple) else [value]


class PlacedSection(Section):
    """Where a feature lies."""

    at: Annotated[tuple[Length, ...], BeforeValidator(_as_list), Field(max_length=_MOST)] = ()
    """Where it begins, along every route: from its start, or in a survey's chainage."""
    every: PositiveLength | None = None
    """Distance to the next one of its kind."""
    count: Annotated[int, Field(strict=True, ge=2, le=_MOST)] | None = None
    """How many there are in all."""
    line: tuple[Place, Place] | None = None
    """Two places in plan that it lies between, in place of at."""
    skew: Angle = 0.0
    """Angle by which it lies aslant: the left wheel meets it later."""
    side: Literal["both", "left", "right"] = "both"
    """Under which wheels it lies."""
    route: Name | None = None
    """The route on which it lies; every one unless given."""
    roads: tuple[Name, ...] = ()
    """The roads on which it lies; every one unless given."""

    @model_validator(mode="after")
    def _check_place(self) -> Self:
        rule = ""
        if bool(self.at) == (self.line is not None):
            rule = (
                "a feature lies at stations along routes (at), or on a line across the plan (line)"
            )
        elif (self.every is None) != (self.count is None):
            rule = "every and count go together: every 6 m, 8 times"
        elif self.every is not None and len(self.at) != 1:
            rule = "repeated features begin at one station: at"
        elif self.line is not None and {"skew", "every"} & self.model_fields_set:
            rule = "a line in plan says its own angle, and is there once: leave skew and every out"
        if rule:
            raise PydanticCustomError("rule", "{rule}", {"rule": rule})
        return self

    @property
    def stations(self) -> tuple[float, ...]:
        """Where it begins along a route [m]."""
        if self.every is None or self.count is None:
            return self.at
        return tuple(self.at[0] + self.every * i for i in range(self.count))

    @property
    def across(self) -> tuple[float, float]:
        """Where it lies across a road [m]."""
        low = 0.0 if self.side == "left" else -np.inf
        return low, 0.0 if self.side == "right" else np.inf

    def shape(self) -> Shape:
        """Return what it looks like."""
        where = set(PlacedSection.model_fields) | {"kind"}
        values = {k: v for k, v in self if k not in where and v is not None}
        return _SHAPES[getattr(self, "kind")](**values)  # noqa: B009 - of its kinds alone


class JointSection(PlacedSection):
    """A joint between slabs."""

    kind: Literal["joint"]
    """A joint between slabs."""
    gap: NonNegativeLength = 0.0
    """Width of the gap."""
    depth: PositiveLength | None = None
    """Depth of the gap; as deep as the tyre sinks unless given."""
    step: Length = 0.0
    """Height of the far edge above the near one; negative drops."""
    runout: PositiveLength | None = None
    """Length over which the far slab returns to the level before; it stays unless given."""


class PotholeSection(PlacedSection):
    """A hole."""

    kind: Literal["pothole"]
    """A hole with a level bottom."""
    length: PositiveLength
    """From rim to rim."""
    depth: PositiveLength
    """Depth of its bottom."""
    edge: PositiveLength | None = None
    """Length of each side; upright unless given."""


class PatchSection(PlacedSection):
    """A patch or a plate."""

    kind: Literal["patch"]
    """A patch or a plate."""
    length: PositiveLength
    """From foot to foot."""
    height: Length
    """Of its top; negative lies lower."""
    ramp: PositiveLength | None = None
    """Length of the ramp at either end; upright unless given."""


class HumpSection(PlacedSection):
    """A bump of half a sine, or a hump of a cosine."""

    kind: Literal["bump", "cosine_hump"]
    """A bump of half a sine, or a hump of h (1 - cos) / 2."""
    length: PositiveLength
    """From foot to foot."""
    height: Length
    """Of its crest; negative lies lower."""


class KinkSection(PlacedSection):
    """A change of grade."""

    kind: Literal["ramp_kink"]
    """A change of grade."""
    grade: Grade
    """Rise by length."""
    length: PositiveLength
    """Until the road turns back into its former grade."""
    rounding: NonNegativeLength = 0.0
    """Length over which each turn is rounded."""


class RailSection(PlacedSection):
    """A level crossing of two rails."""

    kind: Literal["rail_crossing"]
    """A level crossing of two rails."""
    flangeway: PositiveLength | None = None
    """Width of the groove beside each rail; 65 mm unless given."""
    depth: PositiveLength | None = None
    """Depth of the groove; 40 mm unless given."""
    head: PositiveLength | None = None
    """Width of a rail's head; 70 mm unless given."""
    proud: Length = 0.0
    """How far heads stand above the road; negative lies lower."""
    gauge: PositiveLength | None = None
    """Between the inner sides of the heads; 1.435 m unless given."""


class ProtectorSection(PlacedSection):
    """A cable protector, a threshold, a hose bridge."""

    kind: Literal["cable_protector"]
    """A cable protector, a threshold, a hose bridge: a trapezoid."""
    length: PositiveLength
    """From foot to foot."""
    height: PositiveLength
    """Of its top."""
    top: PositiveLength
    """Length of its top."""


FeatureSection: TypeAlias = Annotated[
    JointSection
    | PotholeSection
    | PatchSection
    | HumpSection
    | KinkSection
    | RailSection
    | ProtectorSection,
    Field(discriminator="kind"),
]

_SHAPES: dict[str, Any] = {
    "joint": ExpansionJoint,
    "pothole": Pothole,
    "patch": Patch,
    "bump": Bump,
    "cosine_hump": CosineHump,
    "ramp_kink": RampKink,
    "rail_crossing": RailCrossing,
    "cable_protector": CableProtector,
}
