"""V9: plates whose elements are distorted, or triangles, against Leissa's and NAFEMS' frequencies.

Inner nodes are moved by up to a quarter of an element in any direction, as drawings make a mesher
do it.
"""

import numpy as np
import pytest
from shells import KINDS, shell

from trundle.dynamics import natural_modes

CASE = "V9"
SOURCE = "Leissa, NASA SP-160 (1969)"
N = 32


def scattered(side):
    """A square grid of N by N, its inner nodes moved by up to 0.25 of an element."""
    rng = np.random.default_rng(7)
    x, y = np.meshgrid(np.linspace(0.0, side, N + 1), np.linspace(0.0, side, N + 1), indexing="ij")
    places = np.stack([x, y, 0.0 * x], axis=2)
    places[1:-1, 1:-1, :2] += 0.25 * side / N * rng.uniform(-1.0, 1.0, (N - 1, N - 1, 2))
    return places


def edges(held):
    """Hold what is asked for on all edges, and motion in the plane everywhere."""
    fixed = np.zeros((N + 1, N + 1, 6), dtype=bool)
    fixed[..., [0, 1, 5]] = True
    for side in (0, -1):
        fixed[side][:, held] = True
        fixed[:, side][:, held] = True
    return fixed


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("edge", "held", "wanted"),
    [
        ("simple", [2], [19.7392, 49.3480, 49.3480, 78.9568]),
        ("clamped", [2, 3, 4], [35.992, 73.413, 73.413, 108.27]),
    ],
)
def test_square_plates(record, edge, held, wanted, kind):
    """``omega a^2 sqrt(rho t / D)``, t/a = 1/500: 32 x 32 scattered elements, 1 %."""
    t = 0.002
    scale = np.sqrt(200e9 * t**2 / 12.0 / 0.91 / 1.0) / (2.0 * np.pi)
    floor = shell(scattered(1.0), t, 200e9, 0.3, edges(held), kind)
    f = natural_modes(floor.mass, floor.stiffness, f_max=1.2 * wanted[-1] * scale).frequencies
    for i, value in enumerate(wanted):
        record.row(f"scattered plate, {edge}, {kind}, mode {i + 1}", value, f[i] / scale, rtol=0.01)


@pytest.mark.parametrize("kind", KINDS)
def test_free_thin_plate(record, kind):
    """NAFEMS FV12 (10 x 10 x 0.05 m, free) on scattered elements: 1 %.

    Three motions of the free plate are rigid; a shift makes the stiffness definite.
    """
    fixed = np.zeros((N + 1, N + 1, 6), dtype=bool)
    fixed[..., [0, 1, 5]] = True
    floor = shell(scattered(10.0), 0.05, 200e9, 0.3, fixed, kind, density=8000.0)
    shifted = floor.stiffness + (2 * np.pi * 0.1) ** 2 * floor.mass
    f2 = natural_modes(floor.mass, shifted, f_max=5.0).frequencies ** 2 - 0.1**2
    f = np.sqrt(np.abs(f2))
    record.row(f"scattered FV12, {kind}, rigid motions", 0.0, f[:3].max(), unit="Hz", atol=2e-3)
    for i, wanted in enumerate((1.622, 2.360, 2.922, 4.190, 4.190)):
        record.row(
            f"scattered FV12, {kind}, mode {7 + i}", wanted, f[3 + i], unit="Hz", rtol=0.01,
            source="NAFEMS FV12; series solution",
        )  # fmt: skip
