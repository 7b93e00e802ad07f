"""Units of models: what is understood, and every part of a floor in other units."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.unit_system import in_si, units_of
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    OrthotropicSection,
    PointMasses,
    ShellGroup,
    SpringGroup,
)
from trundle.structure.elements import GROUND, NodeInertia


@pytest.mark.parametrize(
    ("text", "force", "length"),
    [
        ("kip, in, F", 4448.2216152605, 0.0254),
        ("KN, m, C", 1e3, 1.0),
        ("N mm t", 1.0, 1e-3),
        ("lbf, ft, slug", 4.4482216152605, 0.3048),
        ("Tonf, cm", 9806.65, 0.01),
        ("N, m, kg", 1.0, 1.0),
        ("MN, m", 1e6, 1.0),
        ("mN, mm", 1e-3, 1e-3),
        ("mN, mm, kg", 1e-3, 1e-3),
    ],
)
def test_units_as_programs_write_them(text, force, length):
    units = units_of(text)
    assert (units.force, units.length) == pytest.approx((force, length))


@pytest.mark.parametrize(
    "text", ["m", "kN", "kN, parsec", "", "kN, m, stone", "N, mm, kg", "mn, m", "mN, mm, t"]
)
def test_what_is_no_system_is_refused(text):
    with pytest.raises(InputError, match=r"are not understood|do not go together"):
        units_of(text)


def floor(u):
    """A table on springs, its numbers in units u of SI."""
    f, length = 1.0 / u.force, 1.0 / u.length
    mass = f / length
    stuff = Material(
        elastic_modulus=3e10 * f / length**2, poisson_ratio=0.2, density=2500.0 * mass / length**3
    )
    ribs = OrthotropicSection(
        bending=(4e7 * f * length, 2e7 * f * length, 3e6 * f * length, 5e6 * f * length),
        membrane=(6e9 * f / length, 5e9 * f / length, 1e9 * f / length, 2e9 * f / length),
        shear=(2e9 * f / length, 1.5e9 * f / length),
        mass_per_area=400.0 * mass / length**2,
        rotary_inertia=3.0 * mass,
        thickness=0.3 * length,
    )
    return Floor(
        nodes=length * np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]]),
        fixed=np.zeros((4, 6), dtype=bool),
        shells=(ShellGroup(elements=np.array([[0, 1, 2, 3]]), section=ribs),),
        beams=(
            BeamGroup(
                elements=np.array([[0, 1]]),
                section=BeamSection.rectangle(
                    width=0.3 * length, depth=0.5 * length, material=stuff
                ),
                offset=length * np.array([0.0, 0.0, -0.4]),
            ),
        ),
        springs=(
            SpringGroup(
                elements=np.array([[i, GROUND] for i in range(4)]),
                stiffness=np.array([1e6 * f / length] * 3 + [2e5 * f * length] * 3),
            ),
        ),
        masses=(PointMasses(nodes=np.array([2]), mass=700.0 * mass),),
        others=(
            NodeInertia(
                nodes=np.array([1]),
                inertia=np.array([[5, 6, 7, 8 * length**2, 9 * length**2, length**2]]) * mass,
            ),
        ),
    )


@pytest.mark.parametrize("text", ["kip, in", "kN, mm"])
def test_a_model_of_other_units_is_the_same_in_si(text):
    """Every number that a part holds: both matrices, by entries."""
    units = units_of(text)
    ours = floor(units_of("N, m"))
    theirs = in_si(floor(units), units)
    for a, b in zip(ours.matrices(), theirs.matrices(), strict=True):
        assert abs(a - b).max() < 1e-9 * abs(a).max()
