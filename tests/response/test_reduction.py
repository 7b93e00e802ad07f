"""What is kept of runs, by formulas applied to histories run by run and point by point."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from trundle.errors import InputError
from trundle.response import (
    CurveLimit,
    few_runs_warnings,
    join,
    percentile_interval,
    reduce_on_scaled_roads,
    reduce_runs,
    size_warnings,
    spectra_of,
    velocity_spectra,
)
from trundle.signals import (
    band_levels,
    mid_band_frequencies,
    running_rms,
    vibration_dose_value,
    weight,
)
from trundle.simulate import MeanResponse, Runs

BANDS = mid_band_frequencies()
DT = 0.005
NAMES = ("Prüfstand <1>", "b, c")
CONTACTS = ("front", "rear", "pump")


def made(n_runs=3, n_steps=1600, *, seed=1, dt=DT, f_max=90.0, **changes):
    """Return runs of noise that begins and ends in rest, each history drawn on its own."""
    rng = np.random.default_rng(seed)
    ease = np.hanning(n_steps)[None, :, None]
    d, v, a = (
        size * rng.standard_normal((n_runs, n_steps, 2)) * ease for size in (1e-6, 1e-4, 0.1)
    )
    values = {
        "time": 2.0 + dt * np.arange(n_steps), "displacement": d, "velocity": v, "acceleration": a,
        "contact_forces": 1e4 + 1e3 * rng.standard_normal((n_runs, n_steps, 3)),
        "point_names": NAMES, "contact_names": CONTACTS, "seed": 5, "method": "made",
        "f_max": f_max,
    }  # fmt: skip
    return Runs(**{**values, **changes})


def test_single_numbers_are_those_of_every_history():
    """Largest absolute value and its time on the record's clock, RMS, largest force of a contact."""
    runs = made()
    kept = reduce_runs(runs)
    for r in range(3):
        for p in range(2):
            a, v = runs.acceleration[r, :, p], runs.velocity[r, :, p]
            at = max(range(len(a)), key=lambda i: abs(a[i]))
            assert kept.peak_acceleration[r, p] == abs(a[at])
            assert kept.peak_time[r, p] == runs.time[at]
            assert kept.rms_velocity[r, p] == pytest.approx(np.sqrt((v @ v) / len(v)), rel=1e-12)
        for c in range(3):
            assert kept.peak_contact_force[r, c] == max(runs.contact_forces[r, :, c])


def test_sideways_motion_is_weighted_as_sideways_motion():
    """Wb over 0.005 m/s2 upright, Wd over 0.00357 m/s2 sideways (BS 6841): point 1 alone."""
    runs = made(n_runs=2)
    kept = reduce_runs(runs, horizontal=[1])
    for p, (name, base) in enumerate((("Wb", 0.005), ("Wd", 0.00357))):
        for r in range(2):
            felt = weight(runs.acceleration[r, :, p].copy(), 1 / DT, name)
            rms = running_rms(felt, 1 / DT).max()
            assert kept.response_factor[r, p] == pytest.approx(rms / base, rel=1e-9)
            assert kept.vdv[r, p] == pytest.approx(vibration_dose_value(felt, 1 / DT), rel=1e-9)
            assert kept.numbers["weighted_rms"][r, p] == pytest.approx(
                np.sqrt(np.mean(felt**2)), rel=1e-9
            )
    said = reduce_runs(replace(runs, horizontal=(1,)))  # by the runs themselves
    np.testing.assert_array_equal(said.response_factor, kept.response_factor)
    upright = reduce_runs(runs)
    assert upright.response_factor[0, 0] == kept.response_factor[0, 0]
    assert upright.response_factor[0, 1] != pytest.approx(kept.response_factor[0, 1], rel=0.01)


def test_only_wheels_lift():
    """A pull on a wheel is a lift-off; of a pump about its weight a pull is no such thing."""
    runs = made()
    forces = runs.contact_forces.copy()
    forces[1, 700, 1] = -1.0
    forces[:, 300, 2] = -500.0
    lifted = replace(runs, contact_forces=forces, lifts=(True, True, False))
    np.testing.assert_array_equal(
        reduce_runs(lifted).tension, [[False] * 3, [False, True, False], [False] * 3]
    )
    np.testing.assert_allclose(lifted.tension_share(), [0.0, 1.0 / 3.0, 0.0])
    every = replace(lifted, lifts=None)
    np.testing.assert_allclose(every.tension_share(), [0.0, 1.0 / 3.0, 1.0])


def test_a_force_of_nothing_is_no_pull():
    """A wheel that has left the floor presses with 0 N."""
    runs = made()
    rest = replace(runs, contact_forces=np.zeros_like(runs.contact_forces))
    assert not reduce_runs(rest).tension.any()


@pytest.mark.parametrize("record", [None, slice(400, 1300)])
def test_a_record_within_longer_histories_is_looked_at_alone(record):
    """Peaks, RMS and doses of its steps; what is felt is weighted with what came before."""
    runs = made()
    seen = record or slice(None)
    kept = reduce_runs(runs, record=record)
    part = runs.acceleration[:, seen]
    np.testing.assert_array_equal(kept.peak_acceleration, np.abs(part).max(axis=1))
    at = np.abs(part).argmax(axis=1)
    np.testing.assert_array_equal(kept.peak_time, runs.time[seen][at])
    np.testing.assert_allclose(
        kept.rms_velocity, np.sqrt((runs.velocity[:, seen] ** 2).mean(axis=1)), rtol=1e-12
    )
    felt = weight(np.moveaxis(runs.acceleration, 1, -1), 1 / DT, "Wb")[..., seen]
    np.testing.assert_allclose(kept.vdv, (DT * (felt**4).sum(axis=-1)) ** 0.25, rtol=1e-9)


@pytest.mark.parametrize(
    ("quantity", "of"),
    [
        ("band_rms_velocity", "velocity"),
        ("band_rms_acceleration", "acceleration"),
        ("band_rms_displacement", "displacement"),
    ],
)
def test_a_spectrum_is_of_its_own_motion(quantity, of):
    """Runs, points, bands in this order; each level that of its history through the band's filter."""
    runs = made(n_runs=2)
    found = spectra_of(runs, quantity, averaging="slow")
    assert found.values.shape == found.times.shape == (2, 2, 20)
    assert (found.quantity, found.averaging, found.point_names) == (quantity, "slow", NAMES)
    for r, p in np.ndindex(2, 2):
        history = np.ascontiguousarray(getattr(runs, of)[r, :, p])
        wanted = band_levels(history, 1 / DT, BANDS, averaging="slow")
        np.testing.assert_allclose(found.values[r, p], wanted, rtol=1e-9)


@pytest.mark.parametrize(
    ("dt", "f_max", "last"),
    [(0.005, 90.0, 80.0), (0.005, 89.0, 63.0), (0.005, 30.0, 25.0), (0.01, 90.0, 40.0)],
)
def test_bands_that_step_or_modes_do_not_show_are_not_numbers(dt, f_max, last):
    """By hand: the 80 Hz band ends at 89.1 Hz, that of 25 Hz at 28.2; 100 a second show 40 Hz."""
    found = velocity_spectra(made(dt=dt, f_max=f_max, n_runs=1))
    known = 1.02 * last > BANDS
    np.testing.assert_array_equal(found.resolved, known)
    np.testing.assert_array_equal(np.isfinite(found.values), np.broadcast_to(known, (1, 2, 20)))


def test_without_any_band_there_are_no_levels():
    """Modes to 1 Hz hold no whole band: all is NaN, and nothing fails."""
    found = velocity_spectra(made(f_max=1.0, n_runs=1))
    assert not found.resolved.any()
    assert np.isnan(found.values).all()


def test_narrow_lines_leave_out_what_does_not_vibrate():
    """Lines of 1 Hz from 1 Hz up, known to the last mode and to 0.4 of the sampling frequency."""
    found = spectra_of(made(n_runs=1), "narrow_band_acceleration")
    np.testing.assert_allclose(found.mid_band, np.arange(1.0, 101.0))
    assert found.mid_band[found.resolved].max() == pytest.approx(80.0)
    short = spectra_of(made(n_runs=1, f_max=30.5), "narrow_band_acceleration")
    assert short.mid_band[short.resolved].max() == pytest.approx(30.0)


def test_a_percentile_is_over_runs():
    """The share of runs that stay below, at every point and band by itself."""
    found = velocity_spectra(made(n_runs=9))
    for share in (0.0, 37.5, 100.0):
        for p, k in ((0, 4), (1, 17)):
            ordered = np.sort(found.values[:, p, k])
            at = 0.08 * share
            low = int(at)
            wanted = ordered[low] + (at - low) * (ordered[min(low + 1, 8)] - ordered[low])
            assert found.percentile(share)[p, k] == pytest.approx(wanted, rel=1e-12)


def test_joined_parts_are_the_whole():
    """Runs reduced in two parts and put behind each other are those reduced at once."""
    runs = made(n_runs=5)
    curve = CurveLimit(name="c", quantity="band_rms_velocity", limits=np.full(20, 1e-5))
    settings = {"quantities": ["band_rms_acceleration"], "curves": [curve]}
    whole = reduce_runs(runs, **settings)
    both = join([reduce_runs(runs.part(s), **settings) for s in (slice(0, 2), slice(2, 5))])
    for name, values in whole.numbers.items():
        np.testing.assert_allclose(both.numbers[name], values, rtol=1e-9)
    np.testing.assert_allclose(both.spectra.values, whole.spectra.values, rtol=1e-9)
    np.testing.assert_allclose(
        both.more["band_rms_acceleration"].values, whole.more["band_rms_acceleration"].values,
        rtol=1e-9,
    )  # fmt: skip
    np.testing.assert_array_equal(both.above["c"], whole.above["c"])
    np.testing.assert_allclose(both.spectra.times, whole.spectra.times, atol=1e-9)


def test_time_above_a_curve_counts_the_second_behind_the_record():
    """10 Hz of RMS 1 for the record's last 3 s: above 0.1 for 3 s and the window's last second.

    Its mean square of 1 s lies above 0.01 from 0.01 s behind its beginning to 1 s behind its end;
    the filter blurs both by its own length of some 0.4 s.
    """
    t = DT * np.arange(1400)
    tone = np.where(t > 4.0, np.sqrt(2.0) * np.sin(2 * np.pi * 10.0 * t), 0.0)
    histories = np.stack([tone, 0.0 * tone], axis=-1)[None]
    runs = made(n_runs=1, n_steps=1400)
    runs = replace(runs, velocity=histories, displacement=histories, acceleration=histories)
    limits = np.full(20, np.nan)
    limits[10] = 0.1
    curves = [
        CurveLimit(name="ten", quantity="band_rms_velocity", limits=limits),
        CurveLimit(name="dose", quantity="vdv", limits=np.array([1.0])),
        CurveLimit(name="peak", quantity="peak_acceleration", limits=np.array([1.0])),
    ]
    above = reduce_runs(runs, curves=curves).above
    assert above["ten"][0, 0] == pytest.approx(4.0, abs=0.4)
    assert above["peak"][0, 0] == pytest.approx(4.0, abs=0.06)
    assert above["ten"][0, 1] == above["peak"][0, 1] == 0.0
    assert np.isnan(above["dose"]).all()
    assert not reduce_runs(runs).above


def test_a_road_twice_as_rough_adds_twice_what_the_road_adds():
    """Linear: the static loads' part stays; levels by hand from the histories put together.

    70 runs, which are taken 64 at a time: none is lost or doubled between.
    """
    runs = made(n_runs=70, n_steps=450)
    rng = np.random.default_rng(9)
    still = 1e-4 * rng.standard_normal((450, 2)) * np.hanning(450)[:, None]
    mean = MeanResponse(
        time=runs.time, displacement=still, velocity=still, acceleration=1e3 * still,
        contact_forces=np.full((450, 3), 1e4), point_names=NAMES,
    )  # fmt: skip
    one, two = reduce_on_scaled_roads(runs, mean, [1.0, 2.0])
    a = mean.acceleration + 2.0 * (runs.acceleration - mean.acceleration)
    v = mean.velocity + 2.0 * (runs.velocity - mean.velocity)
    np.testing.assert_allclose(two.peak_acceleration, np.abs(a).max(axis=1), rtol=1e-12)
    np.testing.assert_allclose(two.rms_velocity, np.sqrt((v**2).mean(axis=1)), rtol=1e-12)
    np.testing.assert_array_equal(one.peak_acceleration, np.abs(runs.acceleration).max(axis=1))
    force = 1e4 + 2.0 * (runs.contact_forces - 1e4)
    np.testing.assert_allclose(two.peak_contact_force, force.max(axis=1), rtol=1e-12)


def test_a_part_of_runs_is_its_own():
    """Histories are copied: the others can go, and what changes one does not change the other."""
    runs = made(n_runs=4)
    part = runs.part(slice(1, 3))
    assert part.n_runs == 2
    np.testing.assert_array_equal(part.velocity, runs.velocity[1:3])
    assert not np.shares_memory(part.velocity, runs.velocity)
    assert runs.point("b, c") == 1
    with pytest.raises(InputError, match=r"no point 'c'; the points are Prüfstand <1>, b, c"):
        runs.point("c")


def test_a_summary_tells_medians_by_point():
    """Three runs whose peaks are 1, 2 and 3 times one history's: the median is the second."""
    runs = made(n_runs=1)
    many = replace(
        runs,
        **{
            name: np.concatenate([k * getattr(runs, name) for k in (3.0, 1.0, 2.0)])
            for name in ("displacement", "velocity", "acceleration", "contact_forces")
        },
    )
    peak = 2.0 * np.abs(runs.acceleration[0]).max(axis=0)
    rms = 2.0 * np.sqrt((runs.velocity[0] ** 2).mean(axis=0))
    lines = str(many).splitlines()
    assert lines[0] == "3 runs, 1600 steps of 5 ms, seed 5"
    for i, name in enumerate(NAMES):
        assert lines[2 + i] == (
            f"{name}: median peak {peak[i]:.3g} m/s2, record RMS {rms[i]:.3g} m/s"
        )


@pytest.mark.parametrize("share", [50.0, 75.0, 90.0, 95.0, 99.0])
def test_runs_that_are_said_to_be_enough_are_enough(share):
    """The number of runs asked for gives a percentile an upper limit, one fewer does not.

    All n lie below the share p with probability p^n: 2.5 % of it is left at both.
    """
    needed = int(np.ceil(np.log(0.025) / np.log(share / 100.0)))
    values = np.arange(float(needed))
    assert np.isfinite(percentile_interval(values, share)[1])
    assert np.isinf(percentile_interval(values[:-1], share)[1])
    assert few_runs_warnings(needed, share) == ()
    (doubt,) = few_runs_warnings(needed - 1, share)
    assert f"{needed} runs give it one" in doubt.message
    assert f"the {share:g} % level of {needed - 1} runs" in doubt.message


@pytest.mark.parametrize("share", [0.0, 100.0])
def test_no_number_of_runs_bounds_the_largest_of_all(share):
    """The 100 % level of all roads lies above any run's: nothing is asked for."""
    assert few_runs_warnings(3, share) == ()
    low, high = percentile_interval([1.0, 2.0, 3.0], share)
    assert (np.isinf(high) and low == 3.0) if share else (np.isinf(low) and high == 1.0)


@pytest.mark.parametrize(("n", "share"), [(20, 50.0), (100, 90.0), (59, 95.0), (500, 99.0)])
def test_an_interval_of_a_percentile_holds_it_with_its_confidence(n, share):
    """By the binomial sum between its two ranks: 95 % at least, and no narrower one of its kind.

    Values 1 to n are their own ranks; each tail keeps 2.5 %.
    """
    low, high = percentile_interval(np.arange(1.0, n + 1.0)[::-1], share)
    p = share / 100.0
    below = 0 if np.isinf(low) else int(low)
    above = n + 1 if np.isinf(high) else int(high)
    assert stats.binom.cdf(below - 1, n, p) <= 0.025 < stats.binom.cdf(below, n, p)
    assert stats.binom.sf(above - 1, n, p) <= 0.025 < stats.binom.sf(above - 2, n, p)


@pytest.mark.parametrize("share", [-0.1, 100.1])
def test_a_share_outside_all_runs_is_refused(share):
    """There is no such level."""
    with pytest.raises(InputError, match="share must be in"):
        percentile_interval([1.0, 2.0], share)


def test_motion_of_an_impossible_size_is_doubted_at_its_point():
    """150 m/s2 is no floor under a vehicle, 1e-8 m/s2 is a floor that nothing reaches.

    The largest run counts, of the one point; and 2 m/s of velocity alone are too much.
    """
    runs = made(n_runs=2)
    a, v = runs.acceleration.copy(), runs.velocity.copy()
    a *= 1.0 / np.abs(a).max(axis=(0, 1))  # peaks of 1 m/s2
    kept = reduce_runs(replace(runs, acceleration=a))
    assert size_warnings({"truck": kept}) == ()
    loud = a * np.array([150.0, 1.0])
    (doubt,) = size_warnings({"truck & <b>": reduce_runs(replace(runs, acceleration=loud))})
    assert doubt.subject == "size of the motion, truck & <b>"
    assert doubt.message.startswith("Prüfstand <1>: a peak of 150 m/s2")
    faint = a * np.array([1.0, 1e-8])
    (doubt,) = size_warnings({"car": reduce_runs(replace(runs, acceleration=faint))})
    assert doubt.message.startswith("b, c: a peak of 1e-08 m/s2 is less than any floor moves")
    v *= np.array([1.0, 2.0]) / np.sqrt((v**2).mean(axis=1)).max(axis=0)
    fast = size_warnings({"car": reduce_runs(replace(runs, acceleration=a, velocity=v))})
    assert ["b, c: a peak of 1 m/s2 and 2 m/s" in w.message for w in fast] == [True]
