"""How a record runs: closed forms of tones and bursts; sections of a record are its whole."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate, signal

from trundle.criteria import VC, find_criterion
from trundle.records.assess import assess_record
from trundle.records.survey import RunningLevels
from trundle.records.surveying import Surveyor
from trundle.response import join_sections, reduce_record, reduce_section
from trundle.signals import Record, record_sections, weighting_response, welch_psd

FS = 200.0
RMS = 1e-4


def tone(seconds, f=10.0, rms=RMS):
    t = np.arange(round(seconds * FS)) / FS
    return np.sqrt(2.0) * rms * np.sin(2.0 * np.pi * f * t)


def record_of(*rows, names=("z",), quantity="velocity", **more):
    return Record(
        samples=np.array(rows), sampling_frequency=FS, quantity=quantity, channel_names=names,
        **more,
    )  # fmt: skip


def surveyed(record, most=2**21, averaging="max_1s"):
    surveyor = Surveyor(record, averaging)
    for section in record_sections(record, most=most):
        part = reduce_section(record, section, high_pass=0.5, averaging=averaging)
        surveyor.take(section, part.felt)
    return surveyor.survey()


@pytest.fixture(scope="module")
def long():
    """Ten minutes of noise of two channels, with bursts: one across a seam, one at the very end."""
    rng = np.random.default_rng(7)
    n = round(600 * FS)
    t = np.arange(n) / FS
    rows = 1e-6 * signal.lfilter([1.0], [1.0, -0.99], rng.standard_normal((2, n)), axis=1)
    for at, f in ((140.1, 8.0), (300.0, 1.2), (598.0, 20.0)):  # seams every 140 s
        rows += 2e-4 * np.exp(-(((t - at) / 0.8) ** 2)) * np.sin(2.0 * np.pi * f * t)
    return record_of(*rows, names=("z", "x"))


def test_a_short_record_is_one_section_and_a_long_one_is_covered_once(long):
    """Sections follow each other without gap or overlap, and only the ends are ends."""
    (one,) = record_sections(long)
    assert (one.first, one.n_seen, one.begins, one.ends) == (0, long.samples.shape[1], True, True)
    many = list(record_sections(long, most=1))
    assert len(many) > 3
    assert many[1].first == 140 * FS
    assert [s.first for s in many] == list(np.cumsum([0, *(s.n_seen for s in many)])[:-1])
    assert sum(s.n_seen for s in many) == long.samples.shape[1]
    assert [s.begins for s in many] == [True] + [False] * (len(many) - 1)
    assert [s.ends for s in many] == [False] * (len(many) - 1) + [True]


def test_motion_of_sections_is_that_of_the_whole(long):
    """A zero-phase high-pass of order 4 forgets as the fourth power of time: 1e-4 of the largest.

    What wanders far slower is taken off by a line whose knots lie elsewhere: displacement has most.
    """
    (one,) = record_sections(long)
    for name, whole, rtol in zip("dva", one.motion, (1e-2, 1e-4, 1e-4), strict=True):
        found = np.concatenate(
            [s.motion["dva".index(name)][:, s.seen] for s in record_sections(long, most=1)], axis=1
        )
        wanted = whole[:, one.seen]
        assert np.abs(found - wanted).max() < rtol * np.abs(wanted).max(), name


@pytest.mark.parametrize("averaging", ["max_1s", "slow", "event"])
def test_levels_of_sections_are_those_of_the_whole(long, averaging):
    """Maxima, times, means and doses within 5e-4: what a high-pass spreads is all that differs."""
    wanted = ("band_peak_acceleration", "narrow_band_acceleration")
    _, whole = reduce_record(long, averaging=averaging, quantities=wanted)
    parts = [
        reduce_section(long, s, high_pass=0.5, averaging=averaging, quantities=wanted)
        for s in record_sections(long, most=1)
    ]
    joined = join_sections(long, parts)
    for name, values in whole.numbers.items():
        np.testing.assert_allclose(joined.numbers[name], values, rtol=5e-4, err_msg=name)
    np.testing.assert_allclose(joined.spectra.values, whole.spectra.values, rtol=5e-4)
    if averaging != "event":
        np.testing.assert_allclose(joined.spectra.times, whole.spectra.times, atol=0.02)
    for name, rtol in zip(wanted, (5e-4, 0.03), strict=True):
        np.testing.assert_allclose(joined.more[name].values, whole.more[name].values, rtol=rtol)


def test_a_survey_by_sections_is_that_of_the_whole(long):
    """Every level, line, column and second is filled once, whatever the seams."""
    whole, parts = surveyed(long), surveyed(long, most=1)
    for name in ("bands", "whole"):
        np.testing.assert_allclose(
            getattr(parts.running, name), getattr(whole.running, name), rtol=2e-3, atol=2e-9
        )
    np.testing.assert_allclose(parts.spectrum.psd[:, 4:], whole.spectrum.psd[:, 4:], rtol=1e-3)
    felt = whole.spectrogram.psd > 1e-6 * whole.spectrogram.psd.max()
    np.testing.assert_allclose(parts.spectrogram.psd[felt], whole.spectrogram.psd[felt], rtol=0.01)
    np.testing.assert_allclose(parts.dose.sum(axis=1), whole.dose.sum(axis=1), rtol=1e-4)
    np.testing.assert_allclose(parts.mean_levels, whole.mean_levels, rtol=1e-4)
    np.testing.assert_allclose(parts.crest_factor, whole.crest_factor, rtol=1e-3)
    top = np.abs(whole.outline.velocity).max()
    np.testing.assert_allclose(parts.outline.velocity, whole.outline.velocity, atol=1e-3 * top)


def test_the_psd_of_a_tone_integrates_to_its_mean_square():
    """10 Hz lies on a line 0.25 Hz apart; all but the record's ends is RMS^2, in four lines."""
    spectrum = surveyed(record_of(tone(60.0))).spectrum
    assert spectrum.resolution == pytest.approx(0.25)
    assert spectrum.n_windows == 29  # of 4 s, half overlapping
    near = np.abs(spectrum.frequencies - 10.0) < 0.8
    assert spectrum.psd[0, near].sum() * 0.25 == pytest.approx(RMS**2, rel=2e-3)
    assert spectrum.psd[0].sum() * 0.25 == pytest.approx(RMS**2, rel=2e-3)


def test_the_psd_is_welch_s_of_the_motion():
    """The other function of the project, on the record itself, above the high-pass."""
    noise = 1e-5 * np.random.default_rng(3).standard_normal(round(80 * FS))
    f, psd = welch_psd(noise[None], FS, resolution=0.25)
    found = surveyed(record_of(noise)).spectrum
    np.testing.assert_allclose(found.frequencies, f)
    np.testing.assert_allclose(found.psd[0, f > 2.0], psd[0, f > 2.0], rtol=2e-3)


def test_running_levels_of_a_burst_rise_and_fall_within_a_window():
    """Full level in the middle; half the energy where half the second is of the burst."""
    row = tone(40.0)
    row[: round(15 * FS)] = row[round(25 * FS) :] = 0.0
    running = surveyed(record_of(row)).running
    at = np.argmin(np.abs(running.time[:, None] - [10.0, 15.0, 20.0, 25.0, 30.0]), axis=0)
    expected = RMS * np.array([0.0, np.sqrt(0.5), 1.0, np.sqrt(0.5), 0.0])
    np.testing.assert_allclose(running.whole[0, at], expected, rtol=0.02, atol=1e-3 * RMS)
    assert running.step == pytest.approx(0.125)
    own = running.bands[0, 10]  # the 10 Hz band, its delay taken off: within a window of the same
    assert own[at[2]] == pytest.approx(RMS, rel=0.01)
    loud = running.time[own > 0.75 * RMS]
    assert abs(loud.min() - 15.0) < 0.5
    assert abs(loud.max() - 25.0) < 0.5


def test_levels_exceeded_for_shares_of_the_time_are_those_of_a_loud_quarter():
    """Loud (10 to 1) a quarter of the time: L10 is the loud level, L50 the quiet one."""
    loud = np.where(np.arange(round(80 * FS)) < 20 * FS, 1.0, 0.1)
    result = assess_record(record_of(loud * tone(80.0)), VC)
    running = result.survey.running
    assert running.exceeded(0.1)[0, 10] == pytest.approx(RMS, rel=0.01)
    assert running.exceeded(0.5)[0, 10] == pytest.approx(0.1 * RMS, rel=0.02)
    mean = RMS * np.sqrt(0.25 + 0.75 * 0.01)
    assert result.survey.mean_levels[0, 10] == pytest.approx(mean, rel=0.02)


def test_running_levels_reach_the_largest_level_and_never_more(long):
    """The largest over all samples is that of every 25th within what a level turns in 1/8 s."""
    result = assess_record(long, VC)
    largest = result.reduced.spectra.values[0]
    sampled = result.survey.running.bands.max(axis=-1)
    assert np.all(sampled <= largest * (1.0 + 1e-5))
    assert np.all(sampled >= 0.95 * largest)


def test_the_dose_of_a_tone_is_its_closed_form():
    """(a^4 3/8 T)^(1/4) of an amplitude a, which is a_rms (3/2 T)^(1/4); |Wb| at 8 Hz."""
    a_rms, seconds = 0.05, 60.0
    result = assess_record(record_of(tone(seconds, 8.0, a_rms), quantity="acceleration"), VC)
    felt = a_rms * abs(weighting_response("Wb", np.array([8.0]))[0])
    (whole,) = result.doses
    assert (whole.period, whole.measured) == ("record", seconds)
    assert whole.values[0] == pytest.approx(felt * (1.5 * seconds) ** 0.25, rel=0.01)
    assert whole.values[0] == pytest.approx(result.reduced.vdv[0, 0], rel=1e-9)
    assert result.survey.dose.shape == (1, 60)


def test_what_the_record_does_not_show_has_no_running_level():
    """5 s hold 8 periods of 1.6 Hz, and 100 Hz shows bands to 40 Hz: the rest is no number."""
    short = replace(record_of(tone(5.0)), sampling_frequency=100.0)
    running = surveyed(record_of(tone(5.0))).running
    assert not running.shown[:2].any()
    assert running.shown[3:].all()
    assert np.isnan(running.bands[:, ~running.shown]).all()
    assert np.isfinite(running.bands[:, running.shown]).all()
    slow = surveyed(short).running
    assert not slow.shown[17:].any()


def test_the_outline_of_a_long_record_holds_its_extremes(long):
    """Columns of 40 samples: their smallest and largest are those of the motion."""
    outline = surveyed(long).outline
    (one,) = record_sections(long)
    velocity = one.motion[1][:, one.seen]
    assert outline.per_column == 40
    columns = velocity.reshape(2, -1, 40)
    np.testing.assert_allclose(outline.velocity[..., 0], columns.min(axis=-1))
    np.testing.assert_allclose(outline.velocity[..., 1], columns.max(axis=-1))


def test_a_spectrogram_shows_a_tone_when_it_sounds():
    """In its columns the line of 10 Hz holds 2/3 of RMS^2 over a line's width (Hann: 1/1.5)."""
    row = tone(60.0)
    row[: round(30 * FS)] = 0.0
    gram = surveyed(record_of(row)).spectrogram
    line = int(np.argmin(np.abs(gram.frequencies - 10.0)))
    middle = 0.5 * (gram.edges[1:] + gram.edges[:-1])
    loud = gram.psd[0, line, middle > 32.0]
    step = gram.frequencies[0]
    np.testing.assert_allclose(loud, RMS**2 / (1.5 * step), rtol=0.02)
    assert gram.psd[0, line, middle < 28.0].max() < 1e-4 * loud.min()


def test_a_long_record_takes_little_more_memory_than_a_short_one():
    """Motion of an hour more would take 3 times its samples; running levels take 20 x 8 x 4 B/s, 0.4."""
    peaks = []
    for minutes in (15, 75):
        record = record_of(
            1e-5 * np.random.default_rng(1).standard_normal(round(minutes * 60 * FS))
        )
        tracemalloc.start()
        surveyed(record, most=2**16)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] - peaks[0] < 0.7 * 3600 * FS * 8


def test_integral_of_a_tone_s_fourth_power():
    """The closed form that doses are held against: the mean of sin^4 is 3/8."""
    found, _ = integrate.quad(lambda t: np.sin(t) ** 4, 0.0, 2.0 * np.pi)
    assert found / (2.0 * np.pi) == pytest.approx(3.0 / 8.0)


def test_levels_without_a_second_one_have_no_step():
    one = RunningLevels(
        time=np.array([0.5]), bands=np.zeros((1, 1, 1), np.float32), whole=np.zeros((1, 1)),
        mid_band=np.array([1.0]), shown=np.array([True]), averaging="max_1s",
    )  # fmt: skip
    assert one.step == 0.0
    assert find_criterion("VC-A").title == "VC-A"
