"""Small buildings that tests share."""

from dataclasses import replace

import numpy as np

from trundle.structure import CONCRETE, MirrorPlane, ShellSection, reference_plan
from trundle.structure.building import (
    Beam,
    Building,
    Column,
    Profile,
    Slab,
    Storey,
    Support,
)


def box(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def line(*places):
    return np.array(places, dtype=float)


def plate(thickness=0.25, **changes):
    return ShellSection(thickness=thickness, material=CONCRETE, **changes)


def slab(on="slab", corners=None, **changes):
    outline = box(0, 0, 8, 6) if corners is None else corners
    return Slab(**({"on": on, "section": plate(), "outline": outline} | changes))


def column(x, y, **changes):
    given = {
        "profile": Profile.rectangle(0.4, 0.4, CONCRETE),
        "at": np.array([x, y], dtype=float),
        "bottom": "base",
        "top": "slab",
        "base": "fixed",
    }
    return Column(**(given | changes))


LEVELS = (Storey(name="base", level=-4.0), Storey(name="slab", level=0.0))


def table(**changes):
    """A slab of 8 by 6 m on four columns."""
    given = {
        "storeys": LEVELS,
        "slabs": (slab(),),
        "columns": tuple(column(x, y) for x in (1.0, 7.0) for y in (1.0, 5.0)),
        "name": "table",
    }
    return Building(**(given | changes))


def strip(beams=(), length=20.0, width=2.0, thickness=0.2, ends=("uy", "uz"), **changes):
    """A strip of slab that spans along x between two bearings."""
    held = tuple(dof in ends for dof in ("ux", "uy", "uz", "rx", "ry", "rz"))
    edges = [line((x, 0.0), (x, width)) for x in (0.0, length)]
    middle = Support(on="slab", along=line((length / 2, width / 2)), held=(True,) + (False,) * 5)
    given = {
        "storeys": LEVELS[1:],
        "slabs": (slab(corners=box(0, 0, length, width), section=plate(thickness)),),
        "beams": beams,
        "supports": (*(Support(on="slab", along=edge, held=held) for edge in edges), middle),
        "name": "strip",
    }
    return Building(**(given | changes))


def reference():
    """The reference unit, part by part."""
    plan = reference_plan()
    (x0, x1), (y0, y1) = plan.x_extent, plan.y_extent

    def beam(size, name, *places):
        return Beam(
            on="unit",
            profile=Profile.rectangle(size.width, size.depth, plan.material),
            along=line(*places),
            name=name,
        )

    beams = [beam(plan.beams_x, "beam x", (x0, y), (x1, y)) for y in plan.y_lines]
    beams += [beam(plan.beams_y, "beam y", (x, y0), (x, y1)) for x in plan.x_lines]
    beams += [beam(plan.secondary_y, "secondary y", (x, y0), (x, y1)) for x in plan.secondary_lines]
    size = Profile.rectangle(plan.column.width, plan.column.depth, plan.material)
    columns = [
        column(x, y, profile=size, bottom="below", top="above", cap="fixed", head="point")
        for x in plan.x_lines
        for y in plan.y_lines
    ]
    return Building(
        name="reference unit",
        storeys=(
            Storey(name="below", level=-plan.storey_below),
            Storey(name="unit", level=0.0),
            Storey(name="above", level=plan.storey_above),
        ),
        slabs=(slab(on="unit", corners=box(x0, y0, x1, y1), section=plan.slab),),
        beams=tuple(beams),
        columns=tuple(columns),
        symmetry=(
            MirrorPlane.across(0, x0),
            MirrorPlane.across(0, x1),
            MirrorPlane.across(1, y0),
        ),
    )


def turned(building, angle):
    """A building turned in plan about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    keys = ("outline", "along", "at")

    def one(part):
        changes = {k: getattr(part, k) @ turn for k in keys if hasattr(part, k)}
        if hasattr(part, "openings"):
            changes["openings"] = tuple(o @ turn for o in part.openings)
        if hasattr(part, "angle"):
            changes["angle"] = part.angle + np.degrees(angle)
        return replace(part, **changes)

    mirrors = tuple(
        MirrorPlane(normal=p.normal @ turn, position=p.position) for p in building.symmetry
    )
    kinds = ("slabs", "beams", "columns", "walls", "supports")
    changes = {k: tuple(map(one, getattr(building, k))) for k in kinds}
    return replace(building, symmetry=mirrors, **changes)
