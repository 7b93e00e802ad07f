"""Motion of a record: derivatives of each other, the high-pass, and what is put on at its ends."""

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.signals import Record, motion_of, wide_motion_of
from trundle.signals.beyond import carried_on

FS = 200.0
T = np.arange(0, 20, 1 / FS)


def record(samples, quantity="acceleration"):
    samples = np.atleast_2d(samples)
    return Record(
        samples=samples, sampling_frequency=FS, quantity=quantity,
        channel_names=tuple(f"z{i}" for i in range(len(samples))),
    )  # fmt: skip


def event(f, at=10.0, length=1.5):
    """Return displacement, velocity and acceleration of a burst, each the other's derivative."""
    g, w, x = np.exp(-(((T - at) / length) ** 2)), 2 * np.pi * f, T - at
    c, s = np.cos(w * x), np.sin(w * x)
    d1 = -2.0 * x / length**2
    d2 = d1**2 - 2.0 / length**2
    return g * c, g * (d1 * c - w * s), g * ((d2 - w**2) * c - 2.0 * w * d1 * s)


@pytest.mark.parametrize("f", [3.0, 12.0, 40.0])
@pytest.mark.parametrize("quantity", ["velocity", "acceleration"])
def test_a_burst_gives_its_own_integrals_and_derivatives(f, quantity):
    """A Gaussian burst in closed form, from its velocity or its acceleration.

    The high-pass of 0.5 Hz leaves more than 0.9999 of 3 Hz and above.
    """
    d, v, a = (1e-4 * x for x in event(f))
    found = motion_of(record(v if quantity == "velocity" else a, quantity))
    for name, got, wanted in zip("dva", found, (d, v, a), strict=True):
        assert np.abs(got[0] - wanted).max() < 2e-3 * np.abs(wanted).max(), name


@pytest.mark.parametrize("high_pass", [0.5, 1.0])
def test_the_high_pass_has_the_size_of_a_butterworth_filter(high_pass):
    """1 / sqrt(1 + (fc / f)^8), without phase: the crest of a slow burst stays where it is.

    Of a Gaussian burst exp(-(t / L)^2) it is the mean over its spectrum exp(-(pi (f - f0) L)^2).
    """
    for ratio in (1.0, 1.25, 2.0):
        f = ratio * high_pass
        x, _, _ = event(f, length=5.0)
        _, v, _ = motion_of(record(x, "velocity"), high_pass=high_pass)
        around = f + np.linspace(-0.3, 0.3, 601)
        share = np.exp(-((np.pi * (around - f) * 5.0) ** 2))
        passed = 1.0 / np.sqrt(1.0 + (high_pass / around) ** 8)
        expected = (share * passed).sum() / share.sum()
        middle = len(T) // 2
        assert v[0, middle] == pytest.approx(expected, rel=0.01)


def test_channels_do_not_hear_each_other():
    """Several channels at once are what each is alone, in their order."""
    rows = 1e-3 * np.stack([event(4.0)[2], 7.0 * event(9.0, at=5.0)[2], 0.1 * event(30.0)[2]])
    together = motion_of(record(rows))
    for i, row in enumerate(rows):
        for one, many in zip(motion_of(record(row)), together, strict=True):
            np.testing.assert_allclose(many[i], one[0], atol=1e-12 * np.abs(one).max())


def test_twice_the_record_is_twice_the_motion_whatever_its_offset():
    """All is linear, and an offset and a straight drift are taken off."""
    _, _, a = event(6.0)
    one = motion_of(record(a))
    two = motion_of(record(2.0 * a + 5.0 + 0.3 * T))
    for single, double in zip(one, two, strict=True):
        assert np.abs(double - 2.0 * single).max() < 1e-3 * np.abs(single).max()


def test_the_wide_motion_holds_the_seen_one():
    """4 s of what is put on at either end, and between them what was measured."""
    a = event(6.0)[2]
    motion, seen = wide_motion_of(record(a))
    assert (seen.start, seen.stop) == (800, 800 + len(T))
    assert {part.shape for part in motion} == {(1, 1600 + len(T))}
    for wide, narrow in zip(motion, motion_of(record(a)), strict=True):
        np.testing.assert_array_equal(wide[:, seen], narrow)


@pytest.mark.parametrize("bad", [0.0, 0.049, 201.0, np.nan])
def test_a_high_pass_that_keeps_drift_or_nothing_is_refused(bad):
    """Below 0.05 Hz drift is taken for motion; above the sampling rate nothing is left."""
    with pytest.raises(InputError, match="high_pass must be"):
        motion_of(record(event(6.0)[2]), high_pass=bad)


def test_tones_are_carried_on_as_tones():
    """Two tones go on in phase beyond both ends, times the half cosine that fades them out."""
    t = np.arange(-4.0, 24.0, 1 / FS)
    tones = np.sin(2 * np.pi * 3.3 * t) + 0.5 * np.sin(2 * np.pi * 21.7 * t + 1.0)
    before, behind = carried_on(np.stack([tones, -tones])[:, 800:-800], FS, 4.0)
    assert before.shape == behind.shape == (2, 800)
    fade = 0.5 * (1.0 + np.cos(np.pi * (np.arange(800) + 0.5) / 800))
    for sign, row in ((1.0, 0), (-1.0, 1)):
        np.testing.assert_allclose(behind[row], sign * tones[-800:] * fade, atol=0.05)
        np.testing.assert_allclose(before[row], sign * tones[:800] * fade[::-1], atol=0.05)


def test_rest_is_carried_on_as_rest_and_noise_dies_away():
    """Nothing comes of nothing; white noise, which has no memory, is not continued."""
    noise = np.random.default_rng(1).standard_normal(4000)
    before, behind = carried_on(np.stack([np.zeros(4000), noise]), FS, 4.0)
    assert np.abs(before[0]).max() == np.abs(behind[0]).max() == 0.0
    assert np.sqrt(np.mean(behind[1, 100:] ** 2)) < 0.25
