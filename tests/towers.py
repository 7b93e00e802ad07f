"""Small buildings of several equal storeys and units that tests cut into parts."""

import numpy as np

from trundle.structure import CONCRETE, ShellSection
from trundle.structure.building import (
    Beam,
    Building,
    Column,
    Meshing,
    Profile,
    Slab,
    Storey,
    build_building,
)

HEIGHT = 3.6
SPAN = 6.0


def tower(*, storeys=2, bays_x=2, bays_y=1, mesh_size=1.0, beams=True, **more):
    """Build storeys of square bays on columns that stand on the ground."""
    x, y = SPAN * np.arange(bays_x + 1), SPAN * np.arange(bays_y + 1)
    levels = [Storey(name=f"level {i}", level=HEIGHT * i) for i in range(storeys + 1)]
    outline = np.array([[0, 0], [x[-1], 0], [x[-1], y[-1]], [0, y[-1]]], dtype=float)
    slab = ShellSection(thickness=0.2, material=CONCRETE, superimposed_mass=200.0)
    post = Profile.rectangle(0.4, 0.4, CONCRETE)
    rib = Profile.rectangle(0.3, 0.5, CONCRETE)
    lines = [np.array([[a, y[0]], [a, y[-1]]]) for a in x]
    building = Building(
        name="tower",
        storeys=tuple(levels),
        slabs=tuple(Slab(on=s.name, section=slab, outline=outline) for s in levels[1:]),
        columns=tuple(
            Column(
                profile=post,
                at=np.array([a, b]),
                bottom="level 0",
                top=levels[-1].name,
                base="fixed",
            )
            for a in x
            for b in y
        ),
        beams=tuple(
            Beam(profile=rib, along=line, on=s.name) for s in levels[1:] for line in lines if beams
        ),
        **more,
    )
    return build_building(building, Meshing(mesh_size=mesh_size))


def halfway(storeys):
    """Return the heights between storeys, halfway up the columns [m]."""
    return HEIGHT * (np.arange(1, storeys) + 0.5)
