"""What a mesh carries, against the closed form of waves on it and against finer meshes."""

import numpy as np
import pytest

from trundle.dynamics import natural_modes
from trundle.structure import (
    CONCRETE,
    ELEMENTS_PER_WAVE,
    FloorPlan,
    Rectangle,
    ShellSection,
    build_floor,
    reference_plan,
    resolved_frequency,
    resolving_mesh_size,
)

LENGTH, THIN = 6.0, 0.02


def strip(n, thickness=THIN):
    """Return a slab that bends in one direction, one half wave of n elements long."""
    width = 2 * LENGTH / n
    sides = {"x_min": "simple", "x_max": "simple", "y_min": "symmetry", "y_max": "symmetry"}
    return FloorPlan(
        x_lines=np.array([0.0, LENGTH]),
        y_lines=np.array([0.0, width]),
        x_extent=(0.0, LENGTH),
        y_extent=(0.0, width),
        slab=ShellSection(thickness=thickness, material=CONCRETE, superimposed_mass=30.0),
        material=CONCRETE,
        edges=sides,
    )


def error(k_h):
    """Return how many times too high the frequency of a wave along the mesh is (closed form)."""
    square = 48 * (np.sin(k_h / 2) * np.tan(k_h / 2)) ** 2 / ((2 + np.cos(k_h)) * k_h**4)
    return np.sqrt(square)


@pytest.mark.parametrize("n", [3, 4, 6])
def test_waves_on_the_mesh_are_as_fast_as_the_closed_form_says(n):
    """Bending along x of a thin plate, D = E t^3 / 12 (1 - nu^2): pi / 2 / L^2 sqrt(D / m).

    The slab is L / 300 thick, so that shear takes 1e-4 or less.
    """
    plan = strip(n)
    floor = build_floor(plan, mesh_size=LENGTH / n)
    rigidity = 30e9 * THIN**3 / 12 / (1 - 0.2**2)
    exact = np.pi / 2 / LENGTH**2 * np.sqrt(rigidity / (2450 * THIN + 30.0))
    found = natural_modes(floor.mass, floor.stiffness, f_max=2 * exact).frequencies[0]
    assert found / exact == pytest.approx(error(np.pi / n), rel=3e-4)


def test_the_number_of_elements_keeps_a_wave_inside_its_band():
    """Half of a one-third-octave band is 10^(1/20), 12.2 %; one element fewer is too few."""
    assert (
        error(2 * np.pi / ELEMENTS_PER_WAVE) < 10**0.05 < error(2 * np.pi / (ELEMENTS_PER_WAVE - 1))
    )


def test_the_frequency_of_a_wave_of_so_many_elements():
    """The strip's half wave is 3.5 elements long where a mesh of L / 3.5 just carries it."""
    plan = strip(4)
    rigidity = 30e9 * THIN**3 / 12 / (1 - 0.2**2)
    exact = np.pi / 2 / LENGTH**2 * np.sqrt(rigidity / (2450 * THIN + 30.0))
    assert resolving_mesh_size(plan, exact) == pytest.approx(LENGTH / 3.5)
    # four elements are what the lines leave of a mesh size of L / 3.5
    assert resolved_frequency(plan, LENGTH / 3.5) == pytest.approx(exact * (4 / 3.5) ** 2)


def test_a_mesh_of_two_metres_does_not_carry_the_reference_unit_beyond_six_hertz():
    """By hand: 2 pi sqrt(D / m) = 911 m2/s for 0.2 m of concrete under 500 kg/m2."""
    speed = 2 * np.pi * np.sqrt(30e9 * 0.2**3 / 12 / 0.96 / 990.0)
    reach = resolved_frequency(reference_plan(), 2.0)
    assert speed / (7 * 2.0) ** 2 <= reach < 6.3
    assert resolved_frequency(reference_plan(), 0.5) > 63.0


@pytest.mark.longest
def test_modes_below_what_a_mesh_carries_agree_with_half_the_mesh_and_those_above_do_not():
    """Mesh 2 m against 1 m on four bays: within 11 % below the frequency, beyond it above."""
    plan = FloorPlan(
        x_lines=np.array([0.0, 8.0, 16.0]),
        y_lines=np.array([0.0, 8.0, 16.0]),
        x_extent=(0.0, 16.0),
        y_extent=(0.0, 16.0),
        slab=ShellSection(thickness=0.3, material=CONCRETE),
        material=CONCRETE,
        beams_x=Rectangle(width=0.4, depth=0.9),
        beams_y=Rectangle(width=0.4, depth=0.9),
        column=Rectangle(width=0.5, depth=0.5),
        storey_below=4.0,
        storey_above=4.0,
    )
    coarse, fine = (
        natural_modes(floor.mass, floor.stiffness, f_max=60.0).frequencies
        for floor in (build_floor(plan, mesh_size=size) for size in (2.0, 1.0))
    )
    reach = resolved_frequency(plan, 2.0)
    n = min(len(coarse), len(fine))
    off = np.abs(coarse[:n] / fine[:n] - 1.0)
    below = fine[:n] < reach
    assert off[below].max(initial=0.0) < error(2 * np.pi / ELEMENTS_PER_WAVE) - 1.0
    assert off[~below].max() > 0.12
