"""Damage of files: whatever it leads to is a refusal, and a model that cannot be is none."""

import warnings

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.imports.guard import check_sound, guarded
from trundle.structure import (
    CONCRETE,
    Floor,
    Material,
    PointMasses,
    ShellGroup,
    ShellSection,
    TriangleGroup,
)

NODES = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
SLAB = ShellSection(thickness=0.2, material=CONCRETE)


def floor(*, nodes=NODES, elements=((0, 1, 2, 3),), section=SLAB, **more):
    return Floor(
        nodes=nodes, fixed=np.zeros((4, 6), dtype=bool),
        shells=(ShellGroup(elements=np.array(elements), section=section),), **more,
    )  # fmt: skip


@pytest.mark.parametrize(
    "error", [ZeroDivisionError, OverflowError, KeyError, IndexError, ValueError, TypeError,
              RecursionError, MemoryError, OSError]
)  # fmt: skip
def test_damage_is_told_by_the_name_of_the_file(error):
    """What nobody thought of ends as a refusal that names the file and the kind of damage."""
    with (
        pytest.raises(InputError, match=rf"^m\.bdf: is damaged, .* \({error.__name__}\)$"),
        guarded("m.bdf"),
    ):
        raise error


def test_what_is_said_already_is_said_as_it_is():
    """A refusal with its line is not covered by one without."""
    with pytest.raises(InputError, match=r"^line 7: a number$"), guarded("m.bdf"):
        raise InputError("line 7: a number")


def test_a_mistake_of_the_program_is_none_of_the_file():
    """An assertion that fails is a defect here: it must not be blamed on whoever gave the file."""
    with pytest.raises(AssertionError), guarded("m.bdf"):
        raise AssertionError


def test_overflow_warns_nobody_within_and_everybody_behind():
    """Numbers beyond all bounds are silent while a file is read; afterwards they are told again."""
    with guarded("m.bdf"):
        assert np.float64(1e300) * np.float64(1e300) == np.inf
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(RuntimeWarning, match="overflow"):
            np.float64(1e300) * np.float64(1e300)


def test_models_that_cannot_be_are_refused():
    """Places beyond 100 km, plates there twice in any order of their corners."""
    check_sound(floor())
    far = NODES.copy()
    far[0, 2] = -1.0001e5
    with pytest.raises(InputError, match="a node lies further than 100 km away"):
        check_sound(floor(nodes=far))
    with pytest.raises(InputError, match="1 plates stand twice on the same nodes"):
        check_sound(floor(elements=((0, 1, 2, 3), (2, 3, 0, 1))))
    halves = TriangleGroup(connectivity=np.array([[0, 1, 2], [2, 1, 3], [1, 2, 0]]), section=SLAB)
    with pytest.raises(InputError, match="1 plates stand twice"):
        check_sound(floor(others=(halves,)))


def test_matrices_that_are_not_finite_are_refused():
    """A modulus of 1e308 Pa overflows in a product with a thickness of 1 km; a mass likewise."""
    stuff = Material(elastic_modulus=1e308, poisson_ratio=0.2, density=1.0)
    thick = ShellSection(thickness=1e3, material=stuff)
    with np.errstate(all="ignore"), pytest.raises(InputError, match="its stiffness is not finite"):
        check_sound(floor(section=thick))
    heavy = (PointMasses(nodes=np.array([0, 0]), mass=np.array([1.7e308, 1.7e308])),)
    with np.errstate(all="ignore"), pytest.raises(InputError, match="its mass is not finite"):
        check_sound(floor(masses=heavy))
