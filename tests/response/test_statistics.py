"""Exact statistics against closed forms and against sampling; peaks; intervals."""

import numpy as np
import pytest

from models import small_floor
from trundle.errors import InputError
from trundle.response import (
    LargestValues,
    exact_statistics,
    join,
    percentile_interval,
    reduce_runs,
)
from trundle.road import Profile, RoadClass, RoughnessBand, wave_power
from trundle.route import DriveIn, Route
from trundle.signals import band_filter
from trundle.simulate import (
    Coupled,
    Crossing,
    Harmonics,
    MeanResponse,
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


@pytest.mark.longest
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


@pytest.mark.longest
def test_variance_at_each_time_and_of_the_contact_forces(exact, sampled):
    """2000 Gaussian values: a standard deviation scatters by 1.6 %, 5 % at 99.9 % in time."""
    parts, _ = sampled
    for name in ("velocity", "acceleration", "contact_forces"):
        std = np.concatenate([getattr(p, name) for p in parts]).std(axis=0)
        assert np.abs(std - exact.std(name)).max() < 0.08 * std.max()


@pytest.mark.longest
def test_peaks_are_those_of_runs(exact, sampled):
    """1000 draws and 2000 runs scatter apart by 2.5 % at 95 %: three times that, at every factor."""
    _, reduced = sampled
    for share in (50.0, 95.0):
        runs = np.percentile(reduced.peak_acceleration, share, axis=0)
        np.testing.assert_allclose(exact.peak(share), runs, rtol=0.075)


def test_quadrature_error_falls_as_waves_are_added(layout, exact):
    """Half the waves are what the estimate compares; twice as many differ by far less."""
    coarse = exact_statistics(harmonics(layout, n_waves=200))
    change = np.abs(coarse.rms() / exact.rms() - 1).max()
    assert change < coarse.quadrature_error
    assert exact.quadrature_error < 0.5 * coarse.quadrature_error < 0.1
    assert exact.n_waves == 400


def test_twice_the_road_is_four_times_the_variance(exact):
    twice = exact.on_scaled_road(2.0)
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


def drawn(answers, mean=None):
    """Statistics of given answers at one point, velocity and acceleration alike."""
    n_waves, n_steps = answers.shape
    still = np.zeros((n_steps, 1)) if mean is None else mean[:, None]
    time = 0.005 * np.arange(n_steps)
    static = MeanResponse(
        time=time, displacement=still, velocity=still, acceleration=still, contact_forces=still,
        point_names=("p",),
    )  # fmt: skip
    power = np.ones(n_waves)
    values = answers[:, :, None]
    return Harmonics(
        time=time, phase=np.zeros_like(answers, float), power=power, coarse_power=power,
        displacement=values, velocity=values, acceleration=values, contact_forces=values,
        mean=static,
    )  # fmt: skip


def test_the_peak_of_one_wave_is_that_of_its_amplitude():
    """A wave that turns fully reaches its Rayleigh amplitude: sqrt(-2 ln(1 - share)).

    1000 draws: 1.5 standard errors of 2 % at 50 % and 3 of 1.4 % at 95 %.
    """
    turning = 2.0 * np.exp(2j * np.pi * np.arange(400) / 100.0)[None]
    found = exact_statistics([drawn(turning)]).peaks([50.0, 95.0])[:, 0]
    wanted = 2.0 * np.sqrt(-2.0 * np.log([0.5, 0.05]))
    np.testing.assert_allclose(found, wanted, rtol=0.06)


def test_a_wave_seen_once_is_a_half_normal_number():
    """At one instant alone the largest value is |a|: 0.6745 and 1.960 for the shares 50 and 95."""
    once = np.zeros((1, 300), complex)
    once[0, 150] = 1.0
    found = exact_statistics([drawn(once)]).peaks([50.0, 95.0])[:, 0]
    np.testing.assert_allclose(found, [0.6745, 1.960], rtol=0.08)


def test_peaks_without_randomness_are_those_of_the_mean():
    static = -3.0 * np.sin(np.linspace(0.0, 5.0, 300))
    still = exact_statistics([drawn(np.zeros((1, 300), complex), static)])
    assert still.peak(50)[0] == pytest.approx(np.abs(static).max(), rel=1e-6)


def test_peaks_on_rougher_roads_are_those_of_their_own_draws():
    """The same draws on answers so many times larger, with the same mean: within 1 % of them."""
    rng = np.random.default_rng(4)
    t = 0.005 * np.arange(600)
    waves = np.exp(2j * np.pi * rng.uniform(2.0, 9.0, (40, 1)) * t) / np.sqrt(40.0)
    static = 2.0 * np.exp(-(((t - 1.5) / 0.3) ** 2))
    one = exact_statistics([drawn(waves, static)])
    for factor in (0.3, 1.0, 1.3, 2.0, 4.0, 16.0):
        own = exact_statistics([drawn(factor * waves, static)])
        np.testing.assert_allclose(
            one.on_scaled_road(factor).peaks([50, 95]), own.peaks([50, 95]), rtol=0.01
        )


def test_the_same_answers_give_the_same_draws(monkeypatch):
    """Whatever the number of threads, to the last bit."""
    answers = drawn(np.random.default_rng(2).standard_normal((30, 9000)) * (1 + 1j))
    kept = []
    for threads in ("1", "3"):
        monkeypatch.setenv("TRUNDLE_THREADS", threads)
        kept.append(exact_statistics([answers]).largest["velocity"])
    assert isinstance(kept[0], LargestValues)
    np.testing.assert_array_equal(kept[0].random, kept[1].random)


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
    way = layout.sources[0].crossing
    direct = Coupled(integration=Newmark(dt=0.01), damping=Rayleigh(alpha=0.5, beta=1e-3))
    with pytest.raises(InputError, match="choose Modal"):
        next(harmonics(lay_out(floor, way, method=direct, points=POINTS)))
    smooth = Crossing(vehicle=way.vehicle, route=way.route, road=Profile.smooth())
    method = Coupled(integration=Modal(f_max=60.0, dt=0.01))
    with pytest.raises(InputError, match="no variance"):
        next(harmonics(lay_out(floor, smooth, method=method, points=POINTS)))
    slow = Coupled(integration=Modal(f_max=60.0, dt=0.04))
    with pytest.raises(InputError, match="time step of at most"):
        next(harmonics(lay_out(floor, way, method=slow, points=POINTS)))


def test_reduction_keeps_peaks_and_their_times(layout):
    runs = next(batches(layout, runs=range(3), seed=2))
    kept = reduce_runs(runs)
    sizes = np.abs(runs.acceleration)
    np.testing.assert_array_equal(kept.peak_time, runs.time[sizes.argmax(axis=1)])
    np.testing.assert_array_equal(kept.peak_acceleration, sizes.max(axis=1))
    upward = runs.acceleration.max(axis=1)
    assert np.any(upward < sizes.max(axis=1))  # some peaks are downward
    assert np.any(upward == sizes.max(axis=1))
    both = join([kept, kept])
    assert both.rms_velocity.shape == (6, 2)
    assert not both.tension.any()
