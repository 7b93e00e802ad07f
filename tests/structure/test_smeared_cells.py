"""Smeared slabs against their cells: volumes and moments by quadrature, limits, refusals."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.structure import CONCRETE, composite_deck, hollow_core_slab, ribbed_slab, waffle_slab

E, RHO = 30e9, 2450.0
WIDE = E / (1.0 - 0.2**2)


def moments(width, low, high, n=20_001):
    """Return area, centroid and second moment of a section by its width over its height."""
    edges = np.linspace(low, high, n)
    z = 0.5 * (edges[1:] + edges[:-1])
    w, dz = width(z), edges[1] - edges[0]
    area = np.sum(w) * dz
    centre = np.sum(w * z) * dz / area
    return area, centre, np.sum(w * (z - centre) ** 2) * dz


def test_a_waffle_weighs_what_a_cell_of_it_weighs():
    """Plate and ribs of 0.2 m every 1 m and every 0.8 m, 0.3 m deep: the cell counted in voxels.

    Where ribs cross, concrete is there once.
    """
    slab = waffle_slab(
        plate=0.1, rib_width=0.2, rib_depth=0.3, spacing=1.0, spacing_y=0.8, material=CONCRETE,
        superimposed_mass=120.0,
    )  # fmt: skip
    x, y = np.meshgrid((np.arange(80) + 0.5) * 0.01, (np.arange(100) + 0.5) * 0.01)
    rib = (y < 0.2) | (x < 0.2)  # along x every metre of y, along y every 0.8 m of x
    assert slab.mass_per_area == pytest.approx(RHO * (0.1 + 0.3 * rib.mean()) + 120.0, rel=1e-12)


@pytest.mark.parametrize("spacing", [0.6, 1.0])
def test_ribs_bend_as_their_t_with_a_plate_that_cannot_narrow(spacing):
    """E I of the T a metre wide by quadrature, and what the plate alone gains by 1 / (1 - nu^2)."""
    t, w, d = 0.12, 0.2, 0.4
    slab = ribbed_slab(plate=t, rib_width=w, rib_depth=d, spacing=spacing, material=CONCRETE)
    area, _, inertia = moments(lambda z: np.where(z > d, 1.0, w / spacing), 0.0, d + t)
    gain = (WIDE - E) * t**3 / 12.0
    assert slab.bending[0] == pytest.approx(E * inertia + gain, rel=1e-5)
    assert slab.bending[1] == pytest.approx(WIDE * t**3 / 12.0, rel=1e-12)
    assert slab.membrane[0] == pytest.approx(E * area + (WIDE - E) * t, rel=1e-4)
    assert slab.membrane[3] == pytest.approx(E / 2.4 * t, rel=1e-12)
    assert slab.thickness == pytest.approx(t + d)


def test_round_voids_leave_what_is_round_them():
    """Along the planks by quadrature over circles, with a topping that shifts the centroid."""
    h, d, s, top = 0.265, 0.18, 0.22, 0.05
    slab = hollow_core_slab(thickness=h, void=d, spacing=s, material=CONCRETE, topping=top,
                            superimposed_mass=80.0)  # fmt: skip

    def width(z):
        inside = np.maximum(0.25 * d**2 - (z - 0.5 * h) ** 2, 0.0)
        return 1.0 - 2.0 * np.sqrt(inside) / s

    area, _, inertia = moments(width, 0.0, h + top)
    assert slab.bending[0] == pytest.approx(WIDE * inertia, rel=1e-5)
    assert slab.mass_per_area == pytest.approx(RHO * area + 80.0, rel=1e-5)
    wall = 0.5 * (h - d)
    solid = lambda z: np.where((z < wall) | (z > h - wall), 1.0, 0.0)  # noqa: E731
    _, _, across = moments(solid, 0.0, h + top)
    assert slab.bending[1] == pytest.approx(WIDE * across, rel=1e-3)


def test_a_deck_is_a_ribbed_slab_of_its_depth_and_the_sheet_is_weight():
    """150 mm over ribs of 60 mm: a plate of 90 mm; 10 kg/m2 of steel weigh and do not bend."""
    sizes = {"rib_width": 0.15, "spacing": 0.3, "material": CONCRETE}
    deck = composite_deck(depth=0.15, deck_height=0.06, deck_mass=10.0, **sizes)
    plain = ribbed_slab(plate=0.09, rib_depth=0.06, **sizes)
    assert deck.bending == pytest.approx(plain.bending, rel=1e-12)
    assert deck.mass_per_area == pytest.approx(RHO * (0.09 + 0.5 * 0.06) + 10.0, rel=1e-12)


def test_ribs_in_both_directions_turn_into_each_other():
    """Invariant: spacings exchanged exchange x and y, and leave coupling and twist."""
    one, other = (
        waffle_slab(plate=0.1, rib_width=0.15, rib_depth=0.3, spacing=a, spacing_y=b,
                    material=CONCRETE)
        for a, b in ((0.7, 1.1), (1.1, 0.7))
    )  # fmt: skip
    for name in ("bending", "membrane"):
        x, y, both, twist = getattr(one, name)
        assert getattr(other, name) == pytest.approx((y, x, both, twist), rel=1e-12)
        assert x > y  # nearer ribs are stiffer
    assert one.shear == pytest.approx(other.shear[::-1])
    assert one.mass_per_area == pytest.approx(other.mass_per_area)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: ribbed_slab(plate=0.1, rib_width=0.6, rib_depth=0.3, spacing=0.6,
                             material=CONCRETE), "ribs of 0.6 m cannot stand every 0.6 m"),
        (lambda: hollow_core_slab(thickness=0.2, void=0.2, spacing=0.3, material=CONCRETE),
         "voids of 0.2 m do not fit into 0.2 m, every 0.3 m"),
        (lambda: hollow_core_slab(thickness=0.3, void=0.2, spacing=0.2, material=CONCRETE),
         "do not fit into 0.3 m, every 0.2 m"),
        (lambda: waffle_slab(plate=0.1, rib_width=0.1, rib_depth=0.3, spacing=0.5,
                             material=CONCRETE, superimposed_mass=-1.0), "superimposed_mass"),
    ],
)  # fmt: skip
def test_slabs_that_cannot_be_are_refused_with_their_sizes(make, said):
    """Ribs that touch, voids that do or that are as deep as their plank, a weight below nought."""
    with pytest.raises(InputError, match=said):
        make()
