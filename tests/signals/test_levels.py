"""Levels against sums over their definitions, closed forms of the filters, and known bursts."""

import numpy as np
import pytest
from scipy import signal

from trundle.signals import (
    averaged_rms,
    band_delay,
    band_filter,
    band_levels,
    band_maxima,
    band_peaks,
    filter_bands,
    filter_zero_phase,
    level_scatter,
    mid_band_frequencies,
    nominal_frequency,
    running_rms,
)

BANDS = mid_band_frequencies()
FS = 200.0
BUTTERWORTH = np.pi / 8.0 / np.sin(np.pi / 8.0)  # noise bandwidth of order 4 over 3 dB bandwidth
WIDTH = 10**0.05 - 10**-0.05  # of a band, times its mid-band frequency


def burst(at, f, *, seconds=20.0, length=0.4, fs=FS):
    """Return a burst of a tone about a time."""
    t = np.arange(round(seconds * fs)) / fs
    return np.exp(-(((t - at) / length) ** 2)) * np.sin(2 * np.pi * f * t)


@pytest.mark.parametrize("window", [0.005, 0.3, 1.0, 9.0])
def test_a_running_rms_is_its_sum_at_every_sample(window):
    """Mean square over the window that ends there, zeros before the record; by plain loops."""
    x = np.random.default_rng(1).standard_normal((2, 3, 400))
    width = round(window * FS)
    found = running_rms(x, FS, window=window)
    for i in (0, 1, 57, 200, 399):
        part = x[..., max(0, i + 1 - width) : i + 1]
        np.testing.assert_allclose(
            found[..., i], np.sqrt((part**2).sum(axis=-1) / width), rtol=1e-9
        )


def test_a_running_rms_is_quiet_again_behind_a_loud_event():
    """A blow of 1e6 leaves less than 1e-2 of rounding behind it, and no square root of a negative."""
    x = np.zeros(2000)
    x[100:120] = 1e6
    after = running_rms(x, FS)[400:]
    assert np.isfinite(after).all()
    assert after.max() < 1e-2


def test_exponential_averages_are_sums_with_weights_that_fade():
    """(1 - q) sum q^k x^2 with q = exp(-1 / (tau fs)), tau 1 s slow and 0.125 s fast; the largest."""
    x = np.random.default_rng(2).standard_normal((3, 700)) * np.hanning(700)
    for rule, tau in (("slow", 1.0), ("fast", 0.125)):
        q = np.exp(-1.0 / (tau * FS))
        weights = (1.0 - q) * q ** np.arange(700)
        every = [np.sum(x[:, i::-1] ** 2 * weights[: i + 1], axis=1) for i in range(700)]
        np.testing.assert_allclose(
            averaged_rms(x, FS, rule), np.sqrt(np.max(every, axis=0)), rtol=1e-9
        )


def test_rules_by_the_length_of_a_box():
    """A box of 1 for T: sqrt(T) over 1 s, sqrt(1 - exp(-T / tau)) by exponential averages."""
    for seconds in (0.05, 0.125, 0.5):
        x = np.zeros(4000)
        x[1000 : 1000 + round(1000 * seconds)] = 1.0
        assert averaged_rms(x, 1000.0, "max_1s") == pytest.approx(np.sqrt(seconds), rel=1e-9)
        for rule, tau in (("slow", 1.0), ("fast", 0.125)):
            expected = np.sqrt(1.0 - np.exp(-seconds / tau))
            assert averaged_rms(x, 1000.0, rule) == pytest.approx(expected, rel=1e-9)


def test_the_energy_of_a_click_in_a_band_is_the_noise_bandwidth_of_its_filter():
    """Parseval: sum h^2 = 2 B / fs, B = f (10^0.05 - 10^-0.05) pi/8 / sin(pi/8) of order 4.

    The mean square over n samples is that over n. The bilinear transform keeps both edges and bends
    what is between by less than 1 % below a twelfth of the sampling frequency.
    """
    fs, n = 1000.0, 60_000
    click = np.zeros(n)
    click[0] = 1.0
    found = band_levels(click, fs, BANDS, averaging="event")
    expected = np.sqrt(2.0 * BANDS * WIDTH * BUTTERWORTH / fs / n)
    np.testing.assert_allclose(found, expected, rtol=0.01)


@pytest.mark.parametrize("k", [0, 7, 13, 19])
def test_the_delay_of_a_band_is_that_of_the_butterworth_filter(k):
    """At its middle: 2 x 2.6131 / (2 pi B), 2.6131 the sum of the prototype's 2 sin of its poles."""
    f = BANDS[k]
    poles = sum(np.sin(np.pi * (2 * i + 1) / 8.0) for i in range(4))
    expected = 2.0 * poles / (2.0 * np.pi * f * WIDTH)
    assert poles == pytest.approx(2.6131, abs=1e-4)
    assert band_delay(float(f), 4000.0) == pytest.approx(expected, rel=0.005)


def test_bands_come_first_and_signals_keep_their_places():
    """A tone of its own at each run and point: its RMS in its own band, there and nowhere else."""
    t = np.arange(0, 16, 1 / FS)
    ease = np.sin(np.pi * t / 16.0) ** 0.5
    tones = np.array([[4, 9, 12], [14, 17, 6]])  # numbers of bands, runs by points
    amplitude = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    x = amplitude[..., None] * ease * np.sin(2 * np.pi * BANDS[tones][..., None] * t)
    found = band_levels(x, FS, BANDS)
    assert found.shape == (20, 2, 3)
    np.testing.assert_array_equal(found.argmax(axis=0), tones)
    np.testing.assert_allclose(found.max(axis=0), amplitude / np.sqrt(2.0), rtol=0.02)


@pytest.mark.parametrize("zero_phase", [False, True])
@pytest.mark.parametrize("k", [3, 9, 15, 19])
def test_a_burst_has_its_time_in_every_band(k, zero_phase):
    """Whatever delay a band's filter has, the loudest second is centred on the burst.

    Within 0.4 periods in the low bands, whose causal answer has a longer end than beginning; their
    delay is 3.6 periods.
    """
    x = np.stack([burst(at, BANDS[k]) for at in (6.0, 13.0)])
    _, when = band_maxima(x, FS, BANDS[k : k + 1], zero_phase=zero_phase)
    np.testing.assert_allclose(when[0], [6.0, 13.0], atol=max(0.1, 0.4 / BANDS[k]))
    event = band_maxima(x, FS, BANDS[k : k + 1], averaging="event", zero_phase=zero_phase)[1]
    assert np.isnan(event).all()


def test_peaks_in_bands_have_size_and_time():
    """A long burst of amplitude 3 at 20 Hz about 7 s: 3 there, within what its envelope hides."""
    x = -3.0 * burst(7.0, BANDS[13], length=2.0)
    size, when = band_peaks(np.stack([x, 0.0 * x]), FS, BANDS[13:14])
    assert size[0, 0] == pytest.approx(3.0, rel=0.02)
    assert when[0, 0] == pytest.approx(7.0, abs=0.1)
    assert size[0, 1] == 0.0


def test_a_record_within_a_longer_signal_is_what_is_looked_at():
    """Loud motion before the record fills the filters and is not counted; times begin with it.

    A tone from long before to long behind the record has its RMS from the first sample on; a burst
    10 s before it has none.
    """
    t = np.arange(0, 40, 1 / FS)
    tone = np.sin(2 * np.pi * 10.0 * t) * np.sin(np.pi * t / 40.0) ** 0.1
    early = 100.0 * burst(4.0, 10.0, seconds=40.0)
    record = slice(round(20 * FS), round(24 * FS))
    levels, when = band_maxima(np.stack([tone, early]), FS, BANDS[10:11], record=record)
    assert levels[0, 0] == pytest.approx(np.sqrt(0.5), rel=0.01)
    assert levels[0, 1] < 1e-3
    late = burst(22.5, 10.0, seconds=40.0)
    for zero_phase in (False, True):
        _, when = band_maxima(late, FS, BANDS[10:11], record=record, zero_phase=zero_phase)
        assert when[0] == pytest.approx(2.5, abs=0.1)
    peak, at = band_peaks(np.stack([tone, early, late]), FS, BANDS[10:11], record=record)
    assert peak[0, 0] == pytest.approx(1.0, rel=0.01)
    assert peak[0, 1] < 1e-3
    assert at[0, 2] == pytest.approx(2.5, abs=0.1)


def test_levels_do_not_depend_on_the_company_they_are_formed_in():
    """All bands and signals at once give what each gives alone, to rounding."""
    x = np.random.default_rng(4).standard_normal((2, 2, 900)) * np.hanning(900)
    together = band_levels(x, FS, BANDS[::4])
    for b, f in enumerate(BANDS[::4]):
        for i in np.ndindex(2, 2):
            alone = band_levels(x[i], FS, np.array([f]))[0]
            assert together[(b, *i)] == pytest.approx(alone, rel=1e-12)


def test_a_filter_that_is_changed_by_its_user_stays_as_it_is_for_others():
    """Filters are kept for the next time: what is given out is a copy."""
    first = band_filter(10.0, FS)
    kept = first.copy()
    first *= 0.0
    np.testing.assert_array_equal(band_filter(10.0, FS), kept)


def test_filtering_without_delay_has_the_magnitude_of_the_causal_filter_and_no_phase():
    """An impulse becomes a symmetric answer about itself, whose transform is |H|.

    The same energy as the causal answer; nothing comes round from one end to the other.
    """
    sos = band_filter(BANDS[12], FS)
    x = np.zeros(4001)
    x[2000] = 1.0
    y = filter_zero_phase(sos, x, padding=400)
    np.testing.assert_allclose(y, y[::-1], atol=1e-12)
    f = np.array([10.0, 14.5, 15.85, 17.0, 25.0])
    turned = np.exp(-2j * np.pi * np.outer(f, np.arange(-2000, 2001)) / FS) @ y
    np.testing.assert_allclose(
        turned, np.abs(signal.freqz_sos(sos, f, fs=FS)[1]), rtol=1e-6, atol=1e-9
    )
    edge = np.zeros((2, 800))
    edge[1, -1] = 1.0
    out = filter_zero_phase(sos, edge, padding=1600)
    assert np.abs(out[0]).max() == 0.0
    assert np.abs(out[1, :20]).max() < 1e-6 * np.abs(out[1]).max()


def test_signals_in_bands_are_those_of_their_sections():
    """By the recursion of each second-order section written out."""
    x = np.random.default_rng(5).standard_normal((2, 60))
    found = filter_bands(x, FS, BANDS[9:11])
    for i, f in enumerate(BANDS[9:11]):
        y = x.copy()
        for b0, b1, b2, a0, a1, a2 in band_filter(f, FS):
            out = np.zeros_like(y)
            for k in range(y.shape[1]):
                before = [y[:, k - j] if k >= j else 0.0 for j in (1, 2)]
                already = [out[:, k - j] if k >= j else 0.0 for j in (1, 2)]
                out[:, k] = (
                    b0 * y[:, k] + b1 * before[0] + b2 * before[1]
                    - a1 * already[0] - a2 * already[1]
                ) / a0  # fmt: skip
            y = out
        np.testing.assert_allclose(found[i], y, rtol=1e-9, atol=1e-12)


def test_names_of_bands_are_the_preferred_frequencies():
    """ISO 266 from 0.1 to 1000 Hz, one decade's series of ten in each."""
    series = [1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0]
    for decade in (-1, 0, 1, 2):
        names = [nominal_frequency(f) for f in mid_band_frequencies(10 * decade, 10 * decade + 9)]
        assert names == pytest.approx([s * 10.0**decade for s in series])


def test_a_level_scatters_less_the_longer_it_is_averaged():
    """At an instant as a half-normal number, sqrt(pi/2 - 1); as 1 / sqrt(T) in the end.

    An exponential average of time constant T holds as much as a window of 2 T.
    """
    f = BANDS[::3]
    times = np.array([0.01, 0.1, 1.0, 10.0, 100.0])
    scatter = np.array([level_scatter(f, time) for time in times])
    assert (np.diff(scatter, axis=0) < 0.0).all()
    np.testing.assert_allclose(level_scatter(f, 1e-5), np.sqrt(0.5 * np.pi - 1.0), rtol=1e-3)
    long, longer = level_scatter(f, 100.0), level_scatter(f, 400.0)
    np.testing.assert_allclose(long / longer, 2.0, rtol=0.01)
    np.testing.assert_allclose(level_scatter(f, 200.0, exponential=True), longer, rtol=0.01)
