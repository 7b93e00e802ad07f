"""V6: roads against ISO 8608, wheel tracks against their coherence, the IRI against a reference.

ISO 8608 by its closed forms; the IRI of a measured profile (M. Sorel, F. Sroubek, MIT licence, in
tests/data) as their program gives it; IRI of the classes 2.17 x 2^k mm/m. Spectral tolerances are
argued in each test from the number of independent averages.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy import signal

from trundle.road import (
    Profile,
    RoadClass,
    RoughnessBand,
    classify,
    fit_roughness,
    roughness_index,
    synthesise,
    synthesise_tracks,
    track_coherence,
)
from trundle.signals import welch_psd

CASE = "V6"
SOURCE = "ISO 8608:2016"
SIGMAS = {
    ("A", 0.01, 10.0): 3.998, ("B", 0.01, 10.0): 7.996, ("C", 0.01, 10.0): 15.992,
    ("A", 0.011, 2.83): 3.806, ("B", 0.011, 2.83): 7.613,
}  # fmt: skip
DATA = Path(__file__).parents[1] / "data"


def roads(road, *, n, length=500.0, **band):
    limits = RoughnessBand(**band)
    return [
        synthesise(road, length=length, rng=np.random.default_rng(seed), band=limits)
        for seed in range(n)
    ]


@pytest.mark.parametrize(("name", "low", "high"), SIGMAS)
def test_variance(record, name, low, high):
    """Closed form n0 sqrt(Gd (1/n1 - 1/n2)); 20 roads scatter by 0.3 %, being 99 % of a period."""
    sigma, where = SIGMAS[name, low, high], f"class {name}, {low:g} to {high:g} cycle/m"
    closed = 1e3 * np.sqrt(RoadClass(name).variance(low, high))
    record.row(f"sigma, {where}, closed form", sigma, closed, unit="mm", rtol=2e-4)
    drawn = roads(RoadClass(name), n=20, length=400.0, n_min=low, n_max=high)
    computed = 1e3 * np.sqrt(np.mean([np.mean(profile.elevation**2) for profile in drawn]))
    record.row(f"sigma, {where}, 20 roads", sigma, computed, unit="mm", rtol=3e-3)


def octave_levels(profiles, road, edges):
    psds = []
    for profile in profiles:
        step = profile.station[1] - profile.station[0]
        n, psd = welch_psd(profile.elevation, 1.0 / step, resolution=0.01)
        psds.append(psd)
    mean = np.mean(psds, axis=0)
    picks = [(n >= low) & (n < high) for low, high in pairwise(edges)]
    wanted = road.displacement_psd(np.maximum(n, 1e-9))
    return np.array([10 * np.log10(mean[p].sum() / wanted[p].sum()) for p in picks])


@pytest.mark.parametrize("gaussian", [False, True])
def test_spectrum_in_octaves(record, gaussian):
    """Within 1 dB of Gd: 60 roads of about nine windows scatter by 0.2 dB in the lowest octave."""
    road = RoadClass("B")
    edges = 0.04 * 2.0 ** np.arange(7)
    drawn = roads(road, n=60, n_min=0.005, n_max=4.0, gaussian_amplitudes=gaussian)
    kind = "random amplitudes" if gaussian else "fixed amplitudes"
    for (low, high), level in zip(pairwise(edges), octave_levels(drawn, road, edges), strict=True):
        name = f"PSD over Gd, {low:g} to {high:g} cycle/m, {kind}"
        record.row(name, 0.0, level, unit="dB", atol=1.0)


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_wrong_generators_would_be_seen(factor):
    """Negative control: half or twice the variance is 3 dB off in every octave."""
    wrong = RoadClass("B", level="upper" if factor == 2.0 else "lower")
    edges = 0.04 * 2.0 ** np.arange(7)
    levels = octave_levels(roads(wrong, n=30, n_min=0.005, n_max=4.0), RoadClass("B"), edges)
    assert np.abs(levels).min() > 1.0


def test_fitted_waviness(record):
    """The straight line through 60 roads of a kilometre: w = 2, each within 0.03 of it."""
    fits = [fit_roughness(p) for p in roads(RoadClass("B"), n=60, length=1000.0)]
    record.row("fitted waviness", 2.0, np.mean([f.waviness for f in fits]), atol=0.05)
    level = np.mean([f.roughness_at_two for f in fits]) / 64e-6
    record.row("fitted Gd(n0) over the class's", 1.0, level, rtol=0.05)


@pytest.mark.parametrize("name", "ABCDEFGH")
def test_the_class_asked_for_comes_back(record, name):
    """The geometric mean lies 3 dB inside its class, ten times the scatter of the fit."""
    drawn = roads(RoadClass(name), n=40, n_min=0.005, n_max=4.0, gaussian_amplitudes=True)
    share = np.mean([classify(profile).name == name for profile in drawn])
    record.row(f"share of class {name} roads classified {name}", 1.0, share, atol=0.0)


@pytest.mark.parametrize("gaussian", [False, True])
@pytest.mark.parametrize("pair", ["AB", "CD"])
def test_limits_split_evenly(record, pair, gaussian):
    """A road on the limit falls to either side: 200 of them within 99.9 % of a fair coin."""
    road = RoadClass(pair[0], level="upper")
    drawn = roads(road, n=200, n_min=0.005, n_max=4.0, gaussian_amplitudes=gaussian, length=400.0)
    share = np.mean([classify(profile).name == pair[1] for profile in drawn])
    kind = "random" if gaussian else "fixed"
    record.row(
        f"share above the limit {pair[0]}/{pair[1]}, {kind} amplitudes", 0.5, share, atol=0.117
    )


@pytest.mark.parametrize(("spacing", "length"), [(0.02, 300.0), (0.1, 300.0), (0.05, 1200.0)])
def test_spacing_and_length_do_not_matter(record, spacing, length):
    """Gd(n0) by the fit, mean of 40 roads; the scatter of the mean is 1 %."""
    band = RoughnessBand(n_min=0.005, n_max=2.83)
    fits = [
        fit_roughness(
            synthesise(
                RoadClass("C"), length=length, rng=np.random.default_rng(seed), band=band,
                spacing=spacing,
            )
        ).roughness_at_two
        for seed in range(40)
    ]  # fmt: skip
    name = f"Gd(n0) over the class's, spacing {spacing:g} m, {length:g} m long"
    record.row(name, 1.0, np.mean(fits) / 256e-6, rtol=0.05)


def test_no_repetition_within_the_length(record):
    """Autocorrelation at any shift beyond the longest wave stays that of chance.

    Waves from 0.05 cycle/m on a road of 600 m; a road that repeated would correlate with 1.
    """
    worst = 0.0
    for profile in roads(RoadClass("B"), n=5, length=600.0, n_min=0.05, n_max=2.0):
        z = profile.elevation[::8] - profile.elevation.mean()
        full = signal.correlate(z, z, method="fft")[len(z) - 1 :]
        overlap = np.arange(len(z), 0, -1) * z.var()
        step = 8 * (profile.station[1] - profile.station[0])
        far = slice(int(60 / step), int(500 / step))
        worst = max(worst, np.abs(full[far] / overlap[far]).max())
    record.row("largest autocorrelation, shifts of 60 to 500 m", 0.0, worst, atol=0.8)


def test_coherence_of_wheel_tracks(record):
    """Welch's coherence of 60 pairs, 2.0 m apart: bias 1/480 and scatter under 0.03."""
    cross, first, second = 0.0, 0.0, 0.0
    for seed in range(60):
        pair = synthesise_tracks(
            RoadClass("B"), [0.0, 2.0], length=500.0, rng=np.random.default_rng(seed),
            band=RoughnessBand(n_min=0.005, n_max=2.0, gaussian_amplitudes=True),
        )  # fmt: skip
        fs = 1.0 / (pair[0].station[1] - pair[0].station[0])
        window = {"fs": fs, "nperseg": int(100 * fs)}
        n, value = signal.csd(pair[0].elevation, pair[1].elevation, **window)
        cross = cross + value
        first = first + signal.welch(pair[0].elevation, **window)[1]
        second = second + signal.welch(pair[1].elevation, **window)[1]
    coherence = np.abs(cross) ** 2 / (first * second)
    for wanted in (0.03, 0.06, 0.1, 0.2, 0.4):
        at = np.argmin(np.abs(n - wanted))
        record.row(
            f"coherence of tracks 2 m apart at {n[at]:.3g} cycle/m",
            track_coherence(n[at], 2.0), coherence[at], atol=0.05,
            source="isotropic road, g = 2 pi n b K1(2 pi n b)",
        )  # fmt: skip
    ratio = second[(n > 0.05) & (n < 1.5)].sum() / first[(n > 0.05) & (n < 1.5)].sum()
    record.row("power of the second track over the first", 1.0, ratio, rtol=0.1)


def test_one_track_is_the_single_road_and_equal_places_share_one():
    rng = [np.random.default_rng(3) for _ in range(2)]
    alone = synthesise(RoadClass("B"), length=50.0, rng=rng[0])
    tracks = synthesise_tracks(RoadClass("B"), [1.0, -1.0, 1.0], length=50.0, rng=rng[1])
    assert np.array_equal(alone.elevation, tracks[0].elevation)
    assert np.array_equal(tracks[0].elevation, tracks[2].elevation)
    assert not np.allclose(tracks[0].elevation, tracks[1].elevation)


def test_roughness_index_of_a_measured_road(record):
    """Three segments of 100 m in one run, to the four digits printed."""
    station, elevation = np.loadtxt(DATA / "sorel_profile_1.txt").T
    computed = 1e3 * roughness_index(Profile.piecewise_linear(station, elevation))
    for i, wanted in enumerate((3.2985, 2.4421, 3.5551)):
        record.row(
            f"IRI from {478 + 100 * i} m", wanted, computed[i], unit="mm/m", atol=1e-4,
            source="M. Sorel, F. Sroubek, iri (2023)",
        )  # fmt: skip


@pytest.mark.parametrize(("k", "name"), list(enumerate("ABCDE")))
def test_roughness_index_of_the_classes(record, k, name):
    """2.17 x 2^k mm/m at w = 2, within 5 %: 30 roads of 400 m scatter by 1 % in the mean."""
    values = [
        roughness_index(p, segment=400.0)[0] for p in roads(RoadClass(name), n=30, length=401.0)
    ]
    record.row(
        f"IRI of class {name}", 2.17 * 2**k, 1e3 * np.mean(values), unit="mm/m", rtol=0.05,
        source="2.17 x 2^k (verification list)",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("call", "match"),
    [
        (lambda p: roughness_index(p, segment=1e4), "shorter than a segment"),
        (lambda p: roughness_index(p, spacing=1.0), "spacing must be at most"),
        (lambda p: fit_roughness(p, n_max=0.02), "less than two octaves"),
    ],
)
def test_profiles_that_cannot_be_read_are_refused(call, match):
    profile = synthesise(RoadClass("B"), length=60.0, rng=np.random.default_rng(0))
    with pytest.raises(ValueError, match=match):
        call(profile)
