"""Exact statistics against closed forms and against sampling; peaks; intervals."""

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.response import (
    Process,
    exact_statistics,
    join,
    peak_levels,
    percentile_interval,
    reduce_runs,
)
from trundle.road import Profile, RoadClass, RoughnessBand, wave_power
from trundle.route import DriveIn, Route
from trundle.signals import band_filter
from trundle.simulate import (
    Coupled,
    Crossing,
    Modal,
    Newmark,
    Rayleigh,
    batches,
    harmonics,
    lay_out,
    place_waves,
)
from trundle.vehicle import container_truck_40ft

POINTS = {"a": (3.0, 3.0), "b": (7.3, 1.9)}


@pytest.fixture(scope="module")
def layout():
    crossing = Crossing(
        vehicle=container_truck_40ft(),
        route=Route.straight((0.0, 3.0), (12.0, 3.0), speed=15 / 3.6),
        road=RoadClass("B"),
        band=RoughnessBand(n_min=0.05, n_max=4.0, gaussian_amplitudes=True),
        entry=DriveIn(length=3.0),
    )
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    return lay_out(small_floor(mesh_size=1.5), crossing, method=method, points=POINTS)


@pytest.fixture(scope="module")
def exact(layout):
    return exact_statistics(harmonics(layout, n_waves=400), f_max=layout.f_max)


@pytest.fixture(scope="module")
def sampled(layout):
    runs = batches(layout, runs=range(2000), seed=7, batch=500)
    parts = list(runs)
    return parts, join([reduce_runs(part, averaging="event") for part in parts])


@pytest.mark.slow
def test_rms_and_bands_lie_inside_the_interval_of_2000_runs(exact, sampled):
    """Mean square of 2000 independent runs: 99 % interval by the central limit theorem."""
    parts, reduced = sampled
    for name in ("velocity", "acceleration"):
        squares = np.concatenate([np.mean(getattr(p, name) ** 2, axis=1) for p in parts])
        inside(exact.rms(name) ** 2, squares)
    resolved = exact.resolved
    levels = reduced.spectra.values[:, :, resolved] ** 2
    # random waves reach from 0.2 to 17 Hz here; beyond them the static loads leave one value
    inside(exact.band_event()[:, resolved] ** 2, levels, share=0.95)


def inside(exact, squares, *, share=1.0):
    """Assert that exact mean squares lie within 2.576 standard errors of the sampled ones."""
    error = squares.std(axis=0, ddof=1) / np.sqrt(len(squares))
    held = np.abs(exact - squares.mean(axis=0)) <= 2.576 * error + 1e-9 * squares.mean(axis=0)
    assert held.mean() >= share, (exact, squares.mean(axis=0), error)


@pytest.mark.slow
def test_variance_at_each_time_and_of_the_contact_forces(exact, sampled):
    """2000 Gaussian values: a standard deviation scatters by 1.6 %, 5 % at 99.9 % in time."""
    parts, _ = sampled
    for name in ("velocity", "acceleration", "contact_forces"):
        std = np.concatenate([getattr(p, name) for p in parts]).std(axis=0)
        assert np.abs(std - exact.std(name)).max() < 0.08 * std.max()


@pytest.mark.slow
def test_peaks_within_a_tenth(exact, sampled):
    """Rice and Vanmarcke on exact moments: 50 and 95 % peaks within 10 % of 2000 runs."""
    _, reduced = sampled
    for share in (50.0, 95.0):
        runs = np.percentile(reduced.peak_acceleration, share, axis=0)
        np.testing.assert_allclose(exact.peak(share), runs, rtol=0.10)


def test_quadrature_error_falls_as_waves_are_added(layout, exact):
    """Half the waves are what the estimate compares; twice as many differ by far less."""
    coarse = exact_statistics(harmonics(layout, n_waves=200))
    change = np.abs(coarse.rms() / exact.rms() - 1).max()
    assert change < coarse.quadrature_error
    assert exact.quadrature_error < 0.5 * coarse.quadrature_error < 0.1
    assert exact.n_waves == 400


def test_twice_the_road_is_four_times_the_variance(exact):
    twice = exact.rougher(2.0)
    for name in ("velocity", "contact_forces"):
        np.testing.assert_allclose(twice.std(name), 2 * exact.std(name), rtol=1e-12)
        np.testing.assert_array_equal(twice.mean[name], exact.mean[name])
    power = np.mean(exact.mean["velocity"] ** 2 + 4 * exact.variance["velocity"], axis=0)
    np.testing.assert_allclose(twice.rms(), np.sqrt(power), rtol=1e-12)
    assert np.all(twice.band_event()[:, 3:8] > exact.band_event()[:, 3:8])
    assert np.all(twice.peak(50) > exact.peak(50))


def test_running_levels_are_the_largest_second(exact):
    """By the sum over its definition at every second, on one band and point."""
    k = 5
    square = exact.band_mean[k, 0] ** 2 + exact.band_variance[k, 0]
    seconds = [square[i : i + 100].sum() / 100 for i in range(len(square) - 99)]
    band = np.flatnonzero(exact.resolved)[k]
    assert exact.band_running()[0, band] == pytest.approx(np.sqrt(max(seconds)), rel=1e-9)


def test_mean_in_a_band_is_the_filtered_mean(exact):
    from scipy import signal

    band = np.flatnonzero(exact.resolved)[3]
    sos = band_filter(exact.mid_band[band], 100.0)
    wanted = signal.sosfilt(sos, exact.mean["velocity"][:, 1])
    np.testing.assert_allclose(exact.band_mean[3, 1], wanted, atol=1e-15)


def test_waves_hold_the_band_and_crowd_at_resonances():
    road, band = RoadClass("B"), RoughnessBand()
    waves = place_waves(road, band, 101, resonances=np.array([[0.5, 0.02]]))
    assert len(waves.n) == 102
    assert waves.power.sum() == pytest.approx(road.variance(band.n_min, band.n_max), rel=1e-9)
    assert waves.coarse_power.sum() == pytest.approx(waves.power.sum(), rel=1e-9)
    near, far = (np.diff(waves.n)[np.argmin(np.abs(waves.n[:-1] - n))] for n in (0.5, 0.3))
    assert near < 0.5 * far
    patch = RoughnessBand(contact_patch=0.3)
    ratio = wave_power(road, patch, waves.n) / wave_power(road, band, waves.n)
    np.testing.assert_allclose(ratio, np.sinc(0.3 * waves.n) ** 2)


@pytest.mark.parametrize("kind", ["oscillator", "band"])
def test_peaks_of_a_stationary_process(kind):
    """An oscillator of 3 % at 3 Hz, and noise of 0.5 to 6 Hz, over 60 s, sampled 400 times.

    Vanmarcke's law was made for such oscillators; 5 % at 50 and 95 % of the runs.
    """
    rng = np.random.default_rng(3)
    dt, n, runs = 0.01, 6000, 400
    t = dt * np.arange(n)
    f = np.linspace(0.5, 6.0, 700)
    density = np.ones_like(f)
    if kind == "oscillator":
        density = 1.0 / ((1 - (f / 3.0) ** 2) ** 2 + (2 * 0.03 * f / 3.0) ** 2)
    power = density / density.sum()
    amplitude = rng.standard_normal((2, runs, len(f))) * np.sqrt(power)
    angle = 2 * np.pi * np.outer(f, t)
    x = amplitude[0] @ np.cos(angle) + amplitude[1] @ np.sin(angle)
    moments = [np.sum(power * (2 * np.pi * f) ** i) for i in range(3)]
    one = np.ones((n, 1))
    process = Process(
        time=t, mean=0 * one, variance=moments[0] * one, rate_variance=moments[2] * one,
        covariance=0 * one, turning=moments[1] * one,
    )  # fmt: skip
    wanted = np.percentile(np.abs(x).max(axis=1), [50, 95])
    np.testing.assert_allclose(peak_levels(process, [50, 95]), wanted, rtol=0.05)


def test_peaks_without_randomness_are_those_of_the_mean():
    t = np.linspace(0.0, 10.0, 1001)[:, None]
    zero = 0 * t
    process = Process(
        time=t[:, 0], mean=3.0 * np.sin(t), variance=zero + 1e-12, rate_variance=zero,
        covariance=zero, turning=zero,
    )  # fmt: skip
    assert peak_levels(process, [50])[0] == pytest.approx(3.0, rel=0.01)
    still = Process(
        time=t[:, 0], mean=zero, variance=zero, rate_variance=zero, covariance=zero, turning=zero
    )
    assert peak_levels(still, [50])[0] == 0.0


def test_percentile_intervals_hold_what_they_say():
    """Coverage over 2000 samples of 100 values: 95 % at least, and no more than 98.5 %."""
    rng = np.random.default_rng(5)
    for share in (50.0, 90.0):
        true = share / 100.0
        held = 0
        for _ in range(2000):
            low, high = percentile_interval(rng.random(100), share)
            held += low <= true <= high
        assert 0.94 < held / 2000 < 0.985
    assert percentile_interval([1.0, 2.0], 95.0)[1] == np.inf


def test_what_cannot_have_exact_statistics_is_refused(layout):
    floor = small_floor(mesh_size=2.0)
    way = layout.crossings[0]
    direct = Coupled(integration=Newmark(dt=0.01), damping=Rayleigh(alpha=0.5, beta=1e-3))
    with pytest.raises(InputError, match="choose Modal"):
        next(harmonics(lay_out(floor, way, method=direct, points=POINTS)))
    smooth = Crossing(vehicle=way.vehicle, route=way.route, road=Profile.smooth())
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    with pytest.raises(InputError, match="no variance"):
        next(harmonics(lay_out(floor, smooth, method=method, points=POINTS)))
    slow = Coupled(integration=Modal(f_max=60.0, dt=0.1))
    with pytest.raises(InputError, match="time step of at most"):
        next(harmonics(lay_out(floor, way, method=slow, points=POINTS)))


def test_reduction_keeps_peaks_and_their_times(layout):
    runs = next(batches(layout, runs=range(3), seed=2))
    kept = reduce_runs(runs)
    at = np.abs(runs.acceleration[1, :, 0]).argmax()
    assert kept.peak_time[1, 0] == runs.time[at]
    assert kept.peak_acceleration[1, 0] == abs(runs.acceleration[1, at, 0])
    both = join([kept, kept])
    assert both.rms_velocity.shape == (6, 2)
    assert not both.tension.any()
