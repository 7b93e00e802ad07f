"""Floors by flatness class: a drawn floor has the differences of height that its class allows."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.road import RoadClass, RoughnessBand, flat_floor, synthesise

INCH, FOOT = 0.0254, 0.3048


def heights(floor, step, *, length=15_000.0):
    """Heights of a long drawn floor at even distances; with waves far beyond both ends."""
    band = RoughnessBand(n_min=2e-4, n_max=40.0)
    road = synthesise(floor, length=length, rng=np.random.default_rng(1), band=band, spacing=0.0125)
    return road.at(np.arange(0.0, length - 1.0, step))[0]


@pytest.mark.parametrize("number", [25.0, 50.0, 100.0])
def test_ff_is_measured_back_as_astm_e1155_does(number):
    """4.57 in / (3 s_q) of the curvatures over 12 in; 1e5 of them scatter by half a percent."""
    q = np.diff(heights(flat_floor(f"FF {number:g}"), FOOT), 2)
    assert 4.57 * INCH / (3.0 * q.std()) == pytest.approx(number, rel=0.02)


def test_ff_and_fl_are_both_met():
    """And 12.5 in / (3 s_z) of the rises over 10 ft; long waves are few: 3 %."""
    z = heights(flat_floor("FF 50/FL 30"), FOOT)
    assert 4.57 * INCH / (3.0 * np.diff(z, 2).std()) == pytest.approx(50.0, rel=0.02)
    rises = z[10:] - z[:-10]
    assert 12.5 * INCH / (3.0 * rises.std()) == pytest.approx(30.0, rel=0.03)


@pytest.mark.parametrize(("number", "limit"), [("1", 1.8e-3), ("2", 2.0e-3), ("4", 2.4e-3)])
def test_95_percent_of_property_f_is_kept(number, limit):
    """Change between rises over 300 mm; 5 % of 1e5 readings are beyond, to a tenth of that."""
    f = np.diff(heights(flat_floor(f"FM {number}"), 0.3), 2)
    assert np.mean(np.abs(f) <= limit) == pytest.approx(0.95, abs=0.005)


@pytest.mark.parametrize(
    ("line", "limits"),
    [("3", {0.1: 2e-3, 1.0: 4e-3, 4.0: 10e-3}), ("4", {0.1: 1e-3, 1.0: 3e-3, 4.0: 9e-3})],
)
def test_gaps_under_a_straightedge_keep_din_18202(line, limits):
    """95 % of gaps under its middle keep every limit, and one limit exactly."""
    floor = flat_floor(f"DIN 18202 line {line}")
    shares = []
    for length, limit in limits.items():
        z = heights(floor, length / 2)
        gap = np.abs(z[1:-1] - 0.5 * (z[2:] + z[:-2]))
        shares.append(np.mean(gap <= limit))
    assert min(shares) == pytest.approx(0.95, abs=0.01)
    assert max(shares) > 0.97


def test_usual_floors_lie_where_roads_of_class_a_begin():
    """FF 25 is near the mean of class A, and FF 50 a quarter of it: s_q goes with 1 / FF."""
    coarse, fine = flat_floor("FF 25").roughness, flat_floor("FF 50").roughness
    assert coarse == pytest.approx(4.0 * fine, rel=1e-12)
    assert 0.5 * RoadClass("A").roughness < coarse < 2.0 * RoadClass("A").roughness


@pytest.mark.parametrize(
    "text", ["FF", "FF 2", "FL 30", "FM 5", "DIN 18202", "flat", "FF 20/FL 100", "FF 100/FL 8"]
)
def test_what_is_no_class_is_refused(text):
    with pytest.raises(InputError, match=r"FF|FL|known are"):
        flat_floor(text)
