"""Outlines of crossings, joints, kinks and plates at stations by hand."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.road import ExpansionJoint, Patch, Pothole, RailCrossing, RampKink


def test_rails_stand_and_grooves_lie_where_their_measures_say():
    """Head 70 mm, groove 65 mm, gauge 1435 mm between the heads: both rails are mirror images.

    The whole is 2 x 0.07 + 1.435 m long; a tyre that sinks 30 mm finds no 40 mm groove's bottom.
    """
    outline = RailCrossing(proud=0.005).outline(0.03)
    z = {s: float(outline.at(s)[0]) for s in (0.03, 0.10, 0.8, 1.47, 1.54)}
    assert z[0.03] == pytest.approx(0.005)
    assert z[0.10] == pytest.approx(-0.03)
    assert z[0.8] == pytest.approx(0.0, abs=1e-12)
    assert z[1.47] == pytest.approx(-0.03)
    assert z[1.54] == pytest.approx(0.005)
    assert outline.length == pytest.approx(1.575)
    s = np.linspace(0.0, 1.575, 300)
    np.testing.assert_allclose(outline.at(s)[0], outline.at(1.575 - s)[0], atol=1e-12)
    assert RailCrossing().outline(0.5).at(0.10)[0] == pytest.approx(-0.04)


def test_a_step_runs_out_or_stays():
    """20 mm up over a gap of 30 mm: behind it level, or back to 0 over 2 m; a drop alike."""
    for step in (0.02, -0.02):
        stays = ExpansionJoint(gap=0.03, step=step).outline(0.01)
        assert stays.at([0.015, 0.03, 5.0])[0] == pytest.approx([-0.01, step, step])
        back = ExpansionJoint(gap=0.03, step=step, runout=2.0).outline(0.01)
        assert back.at([0.03, 1.03, 2.03, 9.0])[0] == pytest.approx(
            [step, 0.5 * step, 0.0, 0.0], abs=1e-12
        )
    assert ExpansionJoint(gap=0.03, depth=0.004).outline(0.01).at(0.015)[0] == -0.004


def test_a_kink_is_rounded_by_parabolas_of_the_same_grade():
    """5 % over 4 m rounded over 1 m: a parabola has grade/2 at its middle and grade/8 of its length
    above the tangent there; without rounding the straight ramp.
    """
    rounded = RampKink(grade=0.05, length=4.0, rounding=1.0).outline(0.0)
    z, slope = rounded.at(np.array([-0.5, 0.0, 0.5, 2.0, 4.0, 4.5, 9.0]))
    np.testing.assert_allclose(z[[0, 1, 2, 3]], [0.0, 0.05 / 8.0, 0.025, 0.1], atol=1e-12)
    np.testing.assert_allclose(z[[4, 5, 6]], [0.2 - 0.05 / 8.0, 0.2, 0.2], atol=1e-12)
    np.testing.assert_allclose(slope, [0.0, 0.025, 0.05, 0.05, 0.025, 0.0, 0.0], atol=1e-12)
    straight = RampKink(grade=0.05, length=4.0).outline(0.0)
    np.testing.assert_allclose(straight.at([1.0, 4.0, 5.0])[0], [0.05, 0.2, 0.2])


@pytest.mark.parametrize("make", [Patch, Pothole])
def test_sides_that_meet_are_refused(make):
    """Two sides of 0.3 m do not fit into 0.6 m: nothing would be level between."""
    names = {Patch: ("height", "ramp"), Pothole: ("depth", "edge")}[make]
    with pytest.raises(InputError, match="do not fit"):
        make(length=0.6, **dict(zip(names, (0.02, 0.3), strict=True)))
    fits = make(length=0.6, **dict(zip(names, (0.02, 0.29), strict=True)))
    assert abs(fits.outline(0.0).at(0.3)[0]) == pytest.approx(0.02)


def test_the_walls_of_the_narrowest_gap_meet():
    """4 mm of two chamfers of 2 mm: a notch as deep as the tyre sinks, and no bottom."""
    notch = ExpansionJoint(gap=0.004).outline(0.02)
    np.testing.assert_allclose(notch.at([0.0, 0.001, 0.002, 0.003, 0.004])[0],
                               [0.0, -0.01, -0.02, -0.01, 0.0], atol=1e-12)  # fmt: skip
    with pytest.raises(InputError, match="gap must be 4 mm"):
        ExpansionJoint(gap=0.0039)
