"""Transfer functions as rows: each pair under its own names, in the unit of its heading."""

import numpy as np
import pytest

from trundle.simulate import TransferFunctions
from trundle.views.transfer import Curve, curves, heading, largest_peaks, rows

F = np.array([1.0, 2.0, 4.0])


def functions():
    """Load i, point j and line k have ``(10 i + j + 1) (k + 1) 1e-9`` m/N times i^j, so ahead by j 90."""
    i, j, k = np.ogrid[:2, :3, :3]
    values = (10.0 * i + j + 1) * (k + 1) * 1e-9 * 1j**j
    return TransferFunctions(
        frequencies=F, receptance=values, load_names=("Pumpe, 1", "<b>"), point_names=("a", "b", "c")
    )  # fmt: skip


def test_pairs_stand_load_by_load_with_their_own_values():
    """By hand in nm/N: load 1 to point 2 has 13, 26 and 39, turned by 180 degrees."""
    some = curves(functions(), "receptance")
    assert [(c.load, c.point) for c in some] == [
        (load, point) for load in ("Pumpe, 1", "<b>") for point in "abc"
    ]
    last = some[-1]
    np.testing.assert_allclose(last.values, [-13.0, -26.0, -39.0])
    np.testing.assert_allclose(last.magnitude, [13.0, 26.0, 39.0])
    np.testing.assert_allclose(np.abs(last.phase), 180.0)
    np.testing.assert_allclose(some[1].phase, 90.0)  # motion ahead of the force


@pytest.mark.parametrize(
    ("quantity", "unit", "scale"),
    [("receptance", "nm/N", 1e9), ("mobility", "(um/s)/N", 1e6), ("accelerance", "(mm/s2)/N", 1e3)],
)
def test_units_of_headings_are_those_of_the_rows(quantity, unit, scale):
    """Velocity is 2 pi f times displacement and 90 degrees ahead, acceleration once more."""
    names = heading(quantity)
    assert names == (
        "from", "to", "frequency [Hz]", f"real [{unit}]", f"imaginary [{unit}]", f"magnitude [{unit}]", "phase [deg]",
    )  # fmt: skip
    order = ("receptance", "mobility", "accelerance").index(quantity)
    table = list(rows(curves(functions(), quantity)[:1]))
    assert [row[:3] for row in table] == [("Pumpe, 1", "a", f) for f in F]
    for k, (*_, real, imaginary, magnitude, phase) in enumerate(table):
        value = (2j * np.pi * F[k]) ** order * (k + 1) * 1e-9 * scale
        assert real + 1j * imaginary == pytest.approx(value, abs=1e-12 * abs(value))
        assert magnitude == pytest.approx(abs(value))
        assert abs(phase) == pytest.approx(90.0 * order)


def curve(*sizes):
    return Curve(
        load="l", point="p", frequencies=np.arange(1.0, len(sizes) + 1.0),
        values=np.array(sizes, dtype=complex), unit="nm/N",
    )  # fmt: skip


def test_a_lower_end_that_is_highest_is_told_to_be_an_end():
    """A static answer above all resonances: first, and no peak; the one inside is one."""
    found = largest_peaks(curve(9, 3, 5, 2, 1))
    assert [(p.frequency, p.value, p.at_end) for p in found] == [
        (1.0, 9.0, True),
        (3.0, 5.0, False),
    ]


def test_an_end_that_is_not_highest_is_no_peak():
    """It rises towards its end to 4, below the 5 inside: one peak."""
    assert [p.frequency for p in largest_peaks(curve(1, 5, 2, 3, 4))] == [2.0]


def test_peaks_of_one_height_keep_their_order_and_no_more_are_given_than_asked_for():
    """Four of them at 5, 5, 7 and 6: the three largest, of equal ones that of the lower frequency."""
    found = largest_peaks(curve(0, 5, 0, 7, 0, 5, 0, 6, 0))
    assert [p.frequency for p in found] == [4.0, 8.0, 2.0]


def test_a_single_line_is_an_end():
    """Of one line nobody knows whether it is a peak."""
    (only,) = largest_peaks(curve(3))
    assert only.at_end


@pytest.mark.parametrize(
    ("values", "peaks"),
    [
        ([1, 5, 5, 7, 1], [(4.0, False)]),  # a shoulder on the way up
        ([1, 7, 5, 5, 1], [(2.0, False)]),  # and on the way down
        ([1, 5, 5, 1, 1], [(2.0, False)]),  # a flat top is one peak
        ([1, 2, 5, 5], [(4.0, True)]),  # flat up to the end: it may rise beyond
        ([5, 5, 2, 1], [(1.0, True)]),
        ([0, 0, 0], []),
    ],
)
def test_equal_samples_beside_each_other_are_one_place(values, peaks):
    """Higher than what lies before and behind: a shoulder is not."""
    some = Curve(
        load="l", point="p", frequencies=np.arange(1.0, len(values) + 1.0),
        values=np.array(values, complex), unit="u",
    )  # fmt: skip
    assert [(p.frequency, p.at_end) for p in largest_peaks(some)] == peaks
