"""Properties that hold for any input of a kind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from models import small_floor
from trundle.errors import InputError
from trundle.response import percentile_rank, upper_bounds
from trundle.road import Profile, RoadClass
from trundle.route import contact_rows
from trundle.signals import averaged_rms
from trundle.structure import Hat, Hermite
from trundle.units import to_si

FLOOR = small_floor(column=None, beams_x=None, beams_y=None)
FINITE = st.floats(-1e3, 1e3, allow_nan=False)


@given(x=st.floats(0, 12), y=st.floats(0, 6), smooth=st.booleans())
@settings(max_examples=100, deadline=None)
def test_a_wheel_anywhere_presses_with_its_whole_force_and_moment(x, y, smooth):
    shape = Hermite() if smooth else Hat()
    rows = contact_rows(FLOOR, np.array([[x, y]]), np.array([[1.0, 0.0]]), shape=shape)
    load = rows.matrix(rows.value).toarray()[0]
    u = np.zeros((3, FLOOR.n_dofs))
    u[0, FLOOR.dof_index[:, 2]] = 1.0
    u[1, FLOOR.dof_index[:, 2]], u[1, FLOOR.dof_index[:, 4]] = FLOOR.nodes[:, 0], -1.0
    u[2, FLOOR.dof_index[:, 2]], u[2, FLOOR.dof_index[:, 3]] = FLOOR.nodes[:, 1], 1.0
    assert u @ load == pytest.approx([1.0, x, y], abs=1e-9)


@given(heights=st.lists(FINITE, min_size=4, max_size=20), at=st.floats(0, 1))
@settings(max_examples=60, deadline=None)
def test_the_slope_of_a_profile_is_its_derivative(heights, at):
    s = np.arange(len(heights), dtype=float)
    profile = Profile.from_samples(s, heights)
    x, h = 0.01 + at * (s[-1] - 0.02), 1e-5
    difference = (profile.at(x + h)[0] - profile.at(x - h)[0]) / (2 * h)
    assert profile.at(x)[1] == pytest.approx(difference, abs=1e-3 * (1 + np.ptp(heights)))


@given(n=st.floats(0.001, 50), name=st.sampled_from("ABCDEFGH"))
def test_each_class_is_four_times_rougher_than_the_last(n, name):
    road = RoadClass(name)
    assert road.displacement_psd(n) == pytest.approx(
        16e-6 * 4 ** "ABCDEFGH".index(name) * (n / 0.1) ** -2
    )


@given(values=st.lists(st.floats(1e-6, 1e3), min_size=1, max_size=20))
def test_bounds_are_ordered(values):
    bound = upper_bounds(values)
    slack = 1 + 1e-12
    assert bound.largest <= bound.root_sum_square * slack <= bound.absolute_sum * slack**2


@given(samples=st.lists(FINITE, min_size=1, max_size=50), value=FINITE)
def test_a_percentile_rank_is_a_share(samples, value):
    assert 0.0 <= percentile_rank(value, samples) <= 100.0


@given(scale=st.floats(1e-6, 1e6))
def test_rms_scales_with_the_signal(scale):
    x = np.random.default_rng(1).standard_normal(500)
    for rule in ("max_1s", "slow", "event"):
        assert averaged_rms(scale * x, 100.0, rule) == pytest.approx(
            scale * averaged_rms(x, 100.0, rule), rel=1e-9
        )


@given(text=st.text(max_size=40))
@settings(max_examples=300, deadline=None)
def test_any_text_is_a_speed_or_an_input_error(text):
    try:
        speed = to_si(text, "speed")
    except InputError as error:
        if "15 km/h" not in str(error):
            raise AssertionError(f"{error} does not show how to write it") from None
    else:
        assert np.isfinite(speed)
