"""Points behind isolators among points that are not."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.response import behind_isolators
from trundle.signals import Isolator, TransmissibilityTable, behind
from trundle.simulate import Harmonics, MeanResponse, Runs

FS = 200.0
N = 800
NAMES = ("a", "tool <2>", "c")
SPRING = Isolator(frequency=3.0, damping_ratio=0.1)
HALF = TransmissibilityTable(frequencies=np.array([1.0, 80.0]), ratios=np.array([0.5, 0.5]))
MOTION = ("displacement", "velocity", "acceleration")


def histories(*lead, seed=1):
    """Return noise that begins and ends in rest, without what lies at half the sampling rate."""
    noise = np.random.default_rng(seed).standard_normal((*lead, N, 3)) * np.hanning(N)[:, None]
    noise[..., [0, -1], :] = 0.0
    noise[..., 1:-1, :] = 0.25 * (
        noise[..., :-2, :] + 2.0 * noise[..., 1:-1, :] + noise[..., 2:, :]
    )
    return noise


def runs():
    return Runs(
        time=np.arange(N) / FS, displacement=histories(2, seed=1), velocity=histories(2, seed=2),
        acceleration=histories(2, seed=3), contact_forces=histories(2, seed=4),
        point_names=NAMES, contact_names=("f", "m", "r"), seed=1, method="m", f_max=90.0,
    )  # fmt: skip


def mean():
    return MeanResponse(
        time=np.arange(N) / FS, displacement=histories(seed=5), velocity=histories(seed=6),
        acceleration=histories(seed=7), contact_forces=histories(seed=8), point_names=NAMES,
    )  # fmt: skip


def test_an_isolated_point_moves_and_the_others_stay():
    """Each motion of each run passed on by itself; forces under the wheels are not."""
    before = runs()
    after = behind_isolators(before, {"tool <2>": SPRING, "c": HALF})
    for name in MOTION:
        old, new = getattr(before, name), getattr(after, name)
        np.testing.assert_array_equal(new[..., 0], old[..., 0])
        for r in range(2):
            wanted = behind(SPRING, old[r, :, 1].copy(), FS)
            np.testing.assert_allclose(new[r, :, 1], wanted, atol=1e-12)
        # a table that halves all frequencies halves the motion, and has no phase of its own
        np.testing.assert_allclose(new[..., 2], 0.5 * old[..., 2], atol=1e-9)
    np.testing.assert_array_equal(after.contact_forces, before.contact_forces)
    np.testing.assert_array_equal(before.velocity, runs().velocity)  # given runs stay as they were


def test_the_response_to_static_loads_and_to_waves_is_passed_on_too():
    """Answers to waves are complex: real and imaginary parts pass the isolator apart."""
    waves = {
        name: histories(4, seed=i) + 1j * histories(4, seed=10 + i) for i, name in enumerate(MOTION)
    }
    answer = Harmonics(
        time=np.arange(N) / FS, phase=np.zeros((4, N)), power=np.ones(4), coarse_power=np.ones(4),
        contact_forces=histories(4) + 0j, mean=mean(), **waves,
    )  # fmt: skip
    after = behind_isolators(answer, {"tool <2>": SPRING})
    for name in MOTION:
        old, new = getattr(answer, name), getattr(after, name)
        np.testing.assert_array_equal(new[..., [0, 2]], old[..., [0, 2]])
        parts = [behind(SPRING, p[2, :, 1].copy(), FS) for p in (old.real, old.imag)]
        np.testing.assert_allclose(new[2, :, 1], parts[0] + 1j * parts[1], atol=1e-6)
        still = behind(SPRING, getattr(answer.mean, name)[:, 1].copy(), FS)
        np.testing.assert_allclose(getattr(after.mean, name)[:, 1], still, atol=1e-12)
        np.testing.assert_array_equal(
            getattr(after.mean, name)[:, 0], getattr(answer.mean, name)[:, 0]
        )


def test_an_isolator_of_no_point_is_refused():
    """A name misspelt would leave a tool on the bare floor, or the floor behind an isolator."""
    with pytest.raises(InputError, match=r"no point 'Tool <2>' to isolate; the points are a, tool"):
        behind_isolators(runs(), {"Tool <2>": SPRING})
    some = runs()
    assert behind_isolators(some, {}) is some


def test_isolated_runs_differentiate_as_the_floor_does():
    """Velocity behind an isolator is the derivative of the displacement behind it: all is linear."""
    t = np.arange(N) / FS
    w, g, d = 2 * np.pi * 5.0, np.exp(-(((t - 2.0) / 0.4) ** 2)), -2.0 * (t - 2.0) / 0.4**2
    x, v = g * np.sin(w * t), g * (d * np.sin(w * t) + w * np.cos(w * t))
    some = replace(
        runs(), displacement=np.tile(x[None, :, None], (1, 1, 3)),
        velocity=np.tile(v[None, :, None], (1, 1, 3)), acceleration=histories(1),
        contact_forces=histories(1),
    )  # fmt: skip
    after = behind_isolators(some, {"c": SPRING})
    slope = np.gradient(after.displacement[0, :, 2], 1 / FS, edge_order=2)
    np.testing.assert_allclose(slope, after.velocity[0, :, 2], atol=0.01 * np.abs(v).max())
