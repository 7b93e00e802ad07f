"""Spectral densities and narrow lines against closed forms of tones, clicks and noise."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.signals import amplitude_spectrum, welch_psd


def test_a_tone_has_its_power_about_its_line():
    """Amplitude a on a line: the integral is a^2 / 2, and a Hann window shares it 1/6, 2/3, 1/6."""
    fs = 256.0
    t = np.arange(0, 64, 1 / fs)
    x = 3.0 * np.sin(2 * np.pi * 16.0 * t)
    f, psd = welch_psd(x, fs, resolution=0.5)
    step = f[1] - f[0]
    assert step == pytest.approx(0.5)
    assert psd.sum() * step == pytest.approx(4.5, rel=1e-6)
    at = int(np.abs(f - 16.0).argmin())
    np.testing.assert_allclose(psd[at - 1 : at + 2] * step / 4.5, [1 / 6, 2 / 3, 1 / 6], rtol=1e-4)


def test_a_level_offset_is_no_power():
    """The mean of every window is taken off: 1000 m above the sea are no roughness."""
    x = np.random.default_rng(1).standard_normal((2, 4000))
    x[1] = x[0] + 1000.0
    _, psd = welch_psd(x, 20.0, resolution=0.1)
    np.testing.assert_allclose(psd[1], psd[0], rtol=1e-6)


def test_a_density_is_per_sample_rate():
    """White noise of variance 1 has 2 / fs at every frequency, along roads as in time."""
    x = np.random.default_rng(2).standard_normal(400_000)
    for fs in (20.0, 500.0):
        f, psd = welch_psd(x, fs, resolution=fs / 100.0)
        np.testing.assert_allclose(psd[3:-3].mean(), 2.0 / fs, rtol=0.01)
        assert f[-1] == pytest.approx(0.5 * fs)


def test_a_record_shorter_than_its_window_is_one_window():
    """Asked for lines closer than the record shows, it gives those that it shows."""
    x = np.sin(2 * np.pi * 4.0 * np.arange(200) / 100.0)
    f, psd = welch_psd(x, 100.0, resolution=0.01)
    assert f[1] - f[0] == pytest.approx(0.5)
    assert f[psd.argmax()] == pytest.approx(4.0)


def test_a_tone_between_two_lines_reads_as_the_hann_window_lets_it():
    """Half a line off its amplitude is 8 / (3 pi) = 0.849 on both lines beside it, -1.42 dB."""
    fs = 400.0
    t = np.arange(0, 20, 1 / fs)
    lines, amplitude = amplitude_spectrum(2.0 * np.sin(2 * np.pi * 20.5 * t), fs)
    assert lines[1] == pytest.approx(1.0)
    inner = amplitude[(lines == 20.0) | (lines == 21.0)]
    np.testing.assert_allclose(inner, 2.0 * 8.0 / (3.0 * np.pi), rtol=0.02)


def test_the_largest_of_all_windows_is_held():
    """Two tones one after the other, of 1 and 5: each line shows its own, wherever it was."""
    fs = 200.0
    t = np.arange(0, 30, 1 / fs)
    first = np.where(t < 10.0, np.sin(2 * np.pi * 12 * t), 0.0)
    second = np.where((t > 20.0) & (t < 26.0), 5.0 * np.sin(2 * np.pi * 30 * t), 0.0)
    x = np.stack([first + second, 0.5 * second])
    lines, amplitude = amplitude_spectrum(x, fs)
    assert amplitude.shape == (2, len(lines))
    assert amplitude[0, lines == 12.0][0] == pytest.approx(1.0, rel=0.01)
    assert amplitude[0, lines == 30.0][0] == pytest.approx(5.0, rel=0.01)
    assert amplitude[1, lines == 30.0][0] == pytest.approx(2.5, rel=0.01)


def test_lines_of_another_distance():
    """Lines of 0.25 Hz keep a steady tone's amplitude; a burst of 1 s is spread over 4 s."""
    fs = 100.0
    t = np.arange(0, 40, 1 / fs)
    lines, amplitude = amplitude_spectrum(np.sin(2 * np.pi * 10.25 * t), fs, resolution=0.25)
    assert lines[1] == pytest.approx(0.25)
    assert amplitude[lines == 10.25][0] == pytest.approx(1.0, rel=0.01)
    with pytest.raises(InputError, match="resolution must be greater than 0"):
        amplitude_spectrum(t, fs, resolution=0.0)
    with pytest.raises(InputError, match="sampling_frequency must be greater than 0"):
        welch_psd(t, -1.0, resolution=1.0)
