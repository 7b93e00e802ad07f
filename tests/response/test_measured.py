"""A measured record beside runs: what it is called, which bands it shows, which way it moves."""

import numpy as np
import pytest

from trundle.criteria import assess_reduced, find_criterion
from trundle.response import reduce_record
from trundle.signals import Record, mid_band_frequencies

BANDS = mid_band_frequencies()
FS = 200.0


def record(seconds=20.0, names=("z", "x", "hall 3"), quantity="velocity", amplitude=1e-4):
    """Return a steady 10 Hz tone on every channel, the second twice and the third three times."""
    t = np.arange(round(seconds * FS)) / FS
    tone = amplitude * np.sqrt(2.0) * np.sin(2 * np.pi * 10.0 * t)
    samples = np.arange(1.0, len(names) + 1.0)[:, None] * tone
    return Record(
        samples=samples, sampling_frequency=FS, quantity=quantity, channel_names=names, source="r"
    )


def test_channels_become_points_of_one_run_in_their_order():
    """RMS 100, 200, 300 um/s at 10 Hz, from the first second to the last of the record."""
    runs, reduced = reduce_record(record())
    assert (runs.n_runs, runs.point_names) == (1, ("z", "x", "hall 3"))
    assert runs.time[0] == pytest.approx(0.0, abs=1e-9)
    assert len(runs.time) == 4000
    np.testing.assert_allclose(reduced.spectra.values[0, :, 10], [1e-4, 2e-4, 3e-4], rtol=0.01)
    np.testing.assert_allclose(reduced.rms_velocity[0], [1e-4, 2e-4, 3e-4], rtol=0.01)
    peak = 2 * np.pi * 10.0 * np.sqrt(2.0) * 1e-4
    np.testing.assert_allclose(reduced.peak_acceleration[0], peak * np.arange(1, 4), rtol=0.02)
    assert reduced.peak_contact_force.shape == (1, 0)


def test_horizontal_channels_are_felt_as_horizontal():
    """|Wb| at 10 Hz is 0.984 upright over 0.005; |Wd| is 0.203 sideways over 0.00357 (ISO 8041).

    A channel that says no direction is felt as vertical.
    """
    _, reduced = reduce_record(record())
    rms = 2 * np.pi * 10.0 * 1e-4 * np.arange(1.0, 4.0)
    expected = rms * np.array([0.988 / 0.005, 0.203 / 0.00357, 0.988 / 0.005])
    np.testing.assert_allclose(reduced.response_factor[0], expected, rtol=0.015)


@pytest.mark.parametrize(("seconds", "lowest"), [(8.0, 1.0), (5.0, 1.6), (2.0, 4.0)])
def test_bands_of_fewer_than_8_periods_are_not_shown(seconds, lowest):
    """8 periods of the lowest band fit; exact mid-bands 1.585 and 3.981 Hz need 5.05 and 2.01 s."""
    made = record(seconds=seconds)
    _, reduced = reduce_record(made, quantities=["band_rms_acceleration"])
    first = float(BANDS[8.0 / seconds * (1 - 1e-9) <= BANDS][0])
    for spectra in (reduced.spectra, reduced.more["band_rms_acceleration"]):
        np.testing.assert_array_equal(spectra.resolved, first * (1 - 1e-9) <= BANDS)
        assert np.isnan(spectra.values[..., ~spectra.resolved]).all()
        assert np.isfinite(spectra.values[..., spectra.resolved]).all()
    assert first >= lowest * 0.98


def test_a_short_record_is_not_passed_and_a_loud_one_fails():
    """5 s show nothing below 1.6 Hz: VC-C from 1 Hz is not assessed, whatever else is quiet."""
    curve = find_criterion("VC-C")
    for amplitude, status in ((1e-7, "not assessed"), (1e-4, "fail")):
        made = record(seconds=5.0, amplitude=amplitude)
        runs, reduced = reduce_record(made)
        found = assess_reduced(
            reduced, curve, percentile=50.0, f_resolved=runs.f_resolved, axes=made.axes
        )
        assert {v.status for v in found} == {status}
        assert found[0].unresolved[:2] == (1.0, 1.25)
        assert [v.axis for v in found] == ["vertical", "horizontal", "vertical"]


def test_an_acceleration_record_is_integrated_once():
    """0.1 m/s2 RMS at 10 Hz is 0.1 / (2 pi 10) m/s; the method says what was measured."""
    runs, reduced = reduce_record(record(quantity="acceleration", amplitude=0.1), high_pass=0.8)
    assert reduced.spectra.values[0, 0, 10] == pytest.approx(0.1 / (2 * np.pi * 10.0), rel=0.01)
    assert runs.method == "measured acceleration, high-pass 0.8 Hz"
    assert runs.f_max == 100.0
