"""What steps that are straight between samples lose is given back, mode by mode."""

import numpy as np
import pytest

from trundle.dynamics import (
    REACH,
    TOP,
    ModalRecursion,
    differentiator,
    following_filters,
    image_filters,
    responses_of,
    restoring_filter,
)

DT = 0.005
F = np.linspace(0.3, TOP / DT, 500)


def stepped(steps):
    """Return displacement, velocity, acceleration by force of the recursion at its frequencies."""
    z = np.exp(2j * np.pi * F * DT)[:, None]
    (p00, p01), (p10, p11) = steps.phi.transpose(1, 2, 0)
    to_u, to_v = (steps.from_start[:, i] + z * steps.from_end[:, i] for i in (0, 1))
    determinant = (z - p00) * (z - p11) - p01 * p10
    u = ((z - p11) * to_u + p01 * to_v) / determinant
    v = (p10 * to_u + (z - p00) * to_v) / determinant
    return u, v, 1.0 - steps.double * v - steps.square * u


@pytest.mark.parametrize("f0", [0.5, 5.0, 20.0, 60.0, 88.0])
def test_restored_modes_have_the_closed_form_response(f0):
    """``1 / (w0^2 - w^2 + 2 i zeta w0 w)`` and its rates: energy over the band within 0.2 %, each
    line within 2.5 % of velocity at its edge; as stepped, the same is wrong by 16 to 97 %."""
    steps = ModalRecursion(2 * np.pi * np.array([f0]), np.array([0.03]), DT)
    w = 2 * np.pi * F[:, None]
    exact = 1.0 / (steps.square - w**2 + 1j * w * steps.double)
    kept = responses_of(restoring_filter()[:, None], 2 * np.pi * F * DT)
    added = responses_of(image_filters(steps), 2 * np.pi * F * DT)
    for i, (found, rate) in enumerate(zip(stepped(steps), (1.0, 1j * w, -(w**2)), strict=True)):
        whole, wanted = kept * found + added[i], rate * exact
        energy = np.sqrt(np.sum(np.abs(whole) ** 2) / np.sum(np.abs(wanted) ** 2))
        assert energy == pytest.approx(1.0, abs=2e-3)
        off = np.abs(whole - wanted) / np.abs(wanted)
        assert np.median(off) < 3e-3
        assert off[F < 80.0].max() < (0.025 if f0 < 80.0 else 0.04)


@pytest.mark.parametrize("f0", [101.0, 112.0, 150.0, 400.0])
def test_modes_that_are_not_stepped_have_the_closed_form_response(f0):
    """The same, above half the sampling frequency: energy within 2 %, each line within 4 %; their
    statics alone are up to 80 % short of it."""
    modes = ModalRecursion(2 * np.pi * np.array([f0]), np.array([0.03]), DT)
    w = 2 * np.pi * F[:, None]
    exact = 1.0 / (modes.square - w**2 + 1j * w * modes.double)
    found = responses_of(following_filters(modes), 2 * np.pi * F * DT)
    for whole, rate in zip(found, (1.0, 1j * w, -(w**2)), strict=True):
        wanted = rate * exact
        energy = np.sqrt(np.sum(np.abs(whole) ** 2) / np.sum(np.abs(wanted) ** 2))
        assert energy == pytest.approx(1.0, abs=0.02)
        worst = np.abs(whole - wanted)[F < 80.0].max() / np.abs(wanted)[F < 80.0].max()
        assert worst < 0.04
    filters = following_filters(modes).sum(axis=1)[:, 0]
    np.testing.assert_allclose(filters, [1 / modes.square[0], 0.0, 0.0], atol=1e-14)


def test_the_filter_inverts_the_loss_and_keeps_a_constant():
    """sinc^2 times the filter is 1 within 0.1 %; the weights add up to 1."""
    kept = responses_of(restoring_filter()[:, None], 2 * np.pi * F * DT)[:, 0].real
    np.testing.assert_allclose(kept * np.sinc(F * DT) ** 2, 1.0, atol=1e-3)
    assert restoring_filter().sum() == pytest.approx(1.0, abs=1e-12)


def test_derivatives_of_a_sine():
    """cos and -sin times their frequency; a constant gives nothing."""
    for f, first, second in ((3.0, 5e-3, 2e-3), (40.0, 5e-3, 2e-3), (80.0, 2e-2, 3e-3)):
        w = 2 * np.pi * f
        near = np.sin(w * DT * np.arange(-REACH, REACH + 1) + 0.4)
        assert near @ differentiator(1) / DT == pytest.approx(w * np.cos(0.4), rel=first)
        assert near @ differentiator(2) / DT**2 == pytest.approx(-(w**2) * np.sin(0.4), rel=second)
    for order in (1, 2):
        assert differentiator(order).sum() == pytest.approx(0.0, abs=1e-12)
