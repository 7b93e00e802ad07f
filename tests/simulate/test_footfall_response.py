"""Footfall from modes against closed forms of one mode, the guides' formulas, and brute force."""

import numpy as np
import pytest
from scipy.integrate import quad

from studies import BUILDING
from trundle.errors import InputError
from trundle.footfall import footfall_load
from trundle.signals import weighting_response
from trundle.simulate import (
    AiscBayRule,
    CcipRule,
    FootfallFloor,
    Modal,
    ModalRatio,
    SciRule,
    aisc_bay_acceleration,
    footfall_floor,
    footfall_paces,
    footfall_response,
    footfall_rule,
    point_load_deflection,
    prepare,
)
from trundle.structure import FloorPlan, Material, ShellSection, Spots, build_floor
from trundle.study_file import study_from_text

MASS, ZETA = 20e3, 0.03  # kg


def one_mode(f, *, mass=MASS, ratio=ZETA, felt=1.0, walked=1.0, **changes):
    """A floor of one mode, seen at a place with a shape of its own, modal mass `mass`."""
    given = {
        "omega": np.array([2 * np.pi * f]),
        "ratios": np.array([ratio]),
        "felt": np.array([[felt / np.sqrt(mass)]]),
        "walked": np.array([[walked / np.sqrt(mass)]]),
    }
    return FootfallFloor(**(given | changes))


def several(n_places=7, n_walkers=5, n_modes=6, seed=3):
    """A floor of several modes between 3 and 30 Hz, with a residual."""
    rng = np.random.default_rng(seed)
    felt = rng.standard_normal((n_places, n_modes)) / np.sqrt(MASS)
    walked = rng.standard_normal((n_walkers, n_modes)) / np.sqrt(MASS)
    return FootfallFloor(
        omega=2 * np.pi * np.sort(rng.uniform(3.0, 30.0, n_modes)),
        ratios=rng.uniform(0.01, 0.05, n_modes),
        felt=felt,
        walked=walked,
        residual=1e-3 * felt @ walked.T,
    )


@pytest.fixture(scope="module")
def prepared():
    """A slab of 8 m by 6 m on its edges, modes to 60 Hz."""
    material = Material(elastic_modulus=30e9, poisson_ratio=0.2, density=2500.0)
    edges = dict.fromkeys(("x_min", "x_max", "y_min", "y_max"), "pinned")
    plan = FloorPlan(
        x_lines=np.array([0.0, 8.0]), y_lines=np.array([0.0, 6.0]), x_extent=(0.0, 8.0),
        y_extent=(0.0, 6.0), material=material, edges=edges,
        slab=ShellSection(thickness=0.2, material=material),
    )  # fmt: skip
    return prepare(
        build_floor(plan, mesh_size=1.0), Modal(f_max=60.0, dt=2e-3), ModalRatio(ratio=0.02)
    )


def test_at_resonance_acceleration_is_force_over_twice_damping_and_mass():
    """``F / (2 zeta M)``: P354's ``a_w,rms = mu_e mu_r alpha Q W rho / (2 sqrt2 M zeta)``.

    The second harmonic of 2 Hz stands on a mode of 4 Hz; the first, third and fourth add what one
    mode gives off resonance, by the root of the sum of squares.
    """
    load, pace, mu = footfall_load("p354"), 2.0, (0.8, 0.5)
    length = 12.0
    found = footfall_response(
        one_mode(4.0, felt=mu[0], walked=mu[1]), load, SciRule(path_length=length),
        paces=(pace, pace),
    )  # fmt: skip
    alpha = np.array([0.436 * 1.05, 0.006 * 16.3, 0.007 * 11.2, 0.007 * 10.0])
    f = pace * np.arange(1, 5)
    rho = 1.0 - np.exp(-2 * np.pi * ZETA * length * pace / 1.52)  # v = 1.52 m/s at 2 Hz
    weight = abs(weighting_response("Wb", f))
    printed = mu[0] * mu[1] * alpha[1] * 746.0 / (2 * np.sqrt(2) * MASS * ZETA) * weight[1] * rho
    beta = pace * np.arange(1, 5) / 4.0
    enlarged = beta**2 / np.sqrt((1 - beta**2) ** 2 + (2 * ZETA * beta) ** 2)  # P354's D_n,h
    all_four = mu[0] * mu[1] * alpha * 746.0 / MASS * enlarged * weight * rho / np.sqrt(2)
    assert all_four[1] == pytest.approx(printed, rel=1e-12)
    assert found.steady.level[0] == pytest.approx(np.linalg.norm(all_four) / 0.005, rel=1e-9)
    assert (found.steady.harmonic[0], found.steady.mode[0]) == (2, 0)


def test_ccip_by_hand():
    """CCIP-016 4.3: real and imaginary part as printed, N = 0.55 h L / l, base line by frequency."""
    load, pace, span, f_m = footfall_load("ccip-016"), 1.9, 9.0, 5.4
    found = footfall_response(one_mode(f_m), load, CcipRule(span=span), paces=(pace, pace))
    factors = []
    for h in range(1, 5):
        f = h * pace
        alpha = [0.41 * (f - 0.95), 0.069 + 0.0056 * f, 0.033 + 0.0064 * f, 0.013 + 0.0065 * f]
        rho = 1.0 - np.exp(-2 * np.pi * ZETA * 0.55 * h * span / 0.75)
        a, b = 1.0 - (f / f_m) ** 2, 2.0 * ZETA * f / f_m
        size = (f / f_m) ** 2 * alpha[h - 1] * 746.0 * rho / MASS
        real, imaginary = size * a / (a * a + b * b), size * b / (a * a + b * b)
        base = 0.0141 / np.sqrt(f) if f < 4 else 0.0071 if f <= 8 else 2.82e-4 * np.pi * f
        factors.append(np.hypot(real, imaginary) / base)
    assert found.steady.level[0] == pytest.approx(np.linalg.norm(factors), rel=1e-9)


@pytest.mark.parametrize("guide", ["p354", "ccip-016"])
def test_build_up_tends_to_one(guide):
    """A path without end reaches the steady state; a short one ``2 pi zeta N`` of it."""
    load, ratios = footfall_load(guide), np.array([0.01, 0.05])
    assert (footfall_rule(guide).build_up(load, 2.0, ratios) == 1.0).all()
    short = footfall_rule(guide, 1e-3).build_up(load, 2.0, ratios)
    np.testing.assert_allclose(short[:, 1] / short[:, 0], 5.0, rtol=1e-3)
    cycles = {"p354": [1e-3 * 2.0 / 1.52] * 4, "ccip-016": 0.55e-3 / 0.75 * np.arange(1, 5)}
    np.testing.assert_allclose(short[:, 0], 2 * np.pi * 0.01 * np.array(cycles[guide]), rtol=1e-3)


def test_an_impulse_gives_a_mode_its_size_over_the_mass():
    """``v = I / M exp(-zeta omega t) sin(omega_d t)``, RMS over a step; CCIP's base is 1e-4 m/s."""
    load, pace, f = footfall_load("ccip-016"), 2.0, 12.0
    found = footfall_response(one_mode(f), load, CcipRule(), paces=(pace, pace))
    speed = 54.0 * pace**1.43 / f**1.3 / MASS
    omega = 2 * np.pi * f
    turn = omega * np.sqrt(1 - ZETA**2)

    def square(t):
        return (speed * np.exp(-ZETA * omega * t) * np.sin(turn * t)) ** 2

    rms = np.sqrt(quad(square, 0.0, 0.5, epsabs=0.0, epsrel=1e-10, limit=400)[0] / 0.5)
    assert found.transient.level[0] == pytest.approx(rms / 1e-4, rel=1e-8)
    assert found.transient.harmonic[0] == 0


def test_transients_of_p354_and_dg11_are_its_accelerations():
    """``a = 2 pi f sqrt(1 - zeta^2) v``: by Wb over 0.005, and times sqrt 2 as an equivalent sine.

    Against each other: of one walker, R of P354 to a_ESPA is fixed by weighting and impulses.
    """
    f, pace = 14.0, 2.0
    levels = {
        guide: footfall_response(
            one_mode(f), footfall_load(guide), footfall_rule(guide), paces=(pace, pace)
        ).transient.level[0]
        for guide in ("p354", "dg11")
    }
    turned = f * np.sqrt(1 - ZETA**2)
    weight = abs(weighting_response("Wb", np.array([turned])))[0]
    impulses = (60.0 * 746.0 / 700.0) / (168.0 * 4.4482216 / 17.8)
    wanted = weight / 0.005 / np.sqrt(2.0) * impulses
    assert levels["p354"] / levels["dg11"] == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("guide", ["p354", "ccip-016", "dg11", "iso-10137"])
def test_equals_brute_force(guide):
    """Every walker, pace, harmonic and mode one by one, transients summed over 20,000 samples."""
    floor, load, rule = several(), footfall_load(guide), footfall_rule(guide, 8.0)
    low, high = 1.8, 2.1
    found = footfall_response(floor, load, rule, paces=(low, high))
    n_places, n_walkers = len(floor.felt), len(floor.walked)
    steady = np.zeros((len(found.paces), n_places, n_walkers))
    for i, pace in enumerate(found.paces):
        force, rho = rule.amplitudes(load, pace), rule.build_up(load, pace, floor.ratios)
        for r in range(n_places):
            for e in range(n_walkers):
                levels = []
                for h in range(len(load.harmonics)):
                    f = pace * (h + 1)
                    w, total = 2 * np.pi * f, floor.residual[r, e] + 0j
                    for m, w_m in enumerate(floor.omega):
                        stiff = w_m**2 - w**2 + 2j * floor.ratios[m] * w * w_m
                        total += floor.felt[r, m] * floor.walked[e, m] * rho[h, m] / stiff
                    weight = rule.steady_weight(np.array([f]))[0]
                    levels.append(abs(-(w**2) * total) * force[h] * weight)
                steady[i, r, e] = np.linalg.norm(levels) if rule.together else max(levels)
    np.testing.assert_allclose(found.steady.level, steady.max(axis=(0, 2)), rtol=1e-9)
    at = steady.transpose(1, 0, 2).reshape(n_places, -1).argmax(axis=1)
    np.testing.assert_array_equal(found.steady.walker, at % n_walkers)
    np.testing.assert_array_equal(found.steady.pace, found.paces[at // n_walkers])
    if found.transient is None:
        assert guide == "iso-10137"
        return
    best = np.zeros(n_places)
    for pace in np.linspace(low, high, 9):
        n = 20_000
        t = (np.arange(n) + 0.5) / n / pace
        turn = floor.omega * np.sqrt(1 - floor.ratios**2)
        shapes = np.exp(-np.outer(t, floor.ratios * floor.omega)) * np.sin(np.outer(t, turn))
        shapes *= load.impulse.size(pace, floor.frequencies) * rule.transient_weight(turn)
        for e in range(n_walkers):
            motion = shapes @ (floor.felt * floor.walked[e]).T
            best = np.maximum(best, np.sqrt(np.mean(motion**2, axis=0)))
    np.testing.assert_allclose(found.transient.level, best, rtol=1e-6)


def test_alone_is_the_diagonal_and_all_walkers_are_no_less(prepared):
    """Walker and receiver at one place: the diagonal of all pairs; the worst walker gives more."""
    xy = np.array([[2.0, 1.5], [4.0, 3.0], [6.5, 2.0], [1.0, 5.0]])
    spots, load, rule = Spots(xy=xy), footfall_load("p354"), SciRule()
    alone = footfall_response(footfall_floor(prepared, spots), load, rule)
    for i in range(len(xy)):
        one = footfall_floor(prepared, Spots(xy=xy[i : i + 1]), Spots(xy=xy[i : i + 1]))
        pair = footfall_response(one, load, rule)
        assert alone.steady.level[i] == pytest.approx(pair.steady.level[0], rel=1e-9)
        assert alone.transient.level[i] == pytest.approx(pair.transient.level[0], rel=1e-9)
    full = footfall_response(footfall_floor(prepared, spots, spots), load, rule)
    assert (full.governing.level >= alone.governing.level * (1 - 1e-12)).all()
    np.testing.assert_array_equal(alone.governing.walker, np.arange(4))
    assert full.worst == 1  # the middle of the slab


def test_modes_and_residual_sum_up_to_the_static_deflection(prepared):
    """At frequency 0 all modes with the flexibility of those left out are the stiffness' inverse."""
    place = (3.0, 2.0)
    floor = footfall_floor(prepared, Spots(xy=np.array([place])), Spots(xy=np.array([place])))
    total = floor.felt[0] @ (floor.walked[0] / floor.omega**2) + floor.residual[0, 0]
    wanted = -point_load_deflection(prepared.floor, place, force=1.0)["load"]
    assert total == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize("ratio", [0.005, 0.03])
def test_paces_miss_no_resonance(ratio):
    """A harmonic on a mode is tried; what lies between paces is within 1 % of what was tried.

    Half-power bandwidth of a mode over its frequency is 2 zeta; steps are a quarter of it.
    """
    floor = several()
    floor = FootfallFloor(
        omega=floor.omega, ratios=np.full(6, ratio), felt=floor.felt, walked=floor.walked
    )
    load, rule = footfall_load("p354"), SciRule()
    paces = footfall_paces(floor, load, 1.8, 2.2)
    for f in floor.frequencies:
        for h in range(1, 5):
            if 1.8 < f / h < 2.2:
                assert np.abs(paces - f / h).min() < 1e-12
    found = footfall_response(floor, load, rule, paces=(1.8, 2.2)).steady.level
    finer = np.zeros_like(found)
    for pace in np.linspace(1.8, 2.2, 400):
        one = footfall_response(floor, load, rule, paces=(pace, pace)).steady.level
        finer = np.maximum(finer, one)
    assert (found > 0.99 * finer).all()


def test_chapter_4_of_dg11_is_its_formula_on_one_mode():
    """``P0 exp(-0.35 f) / (beta W)`` with W = 2 M g, whatever the harmonic: at 4 Hz the second."""
    by_modes = footfall_response(
        one_mode(4.0), footfall_load("dg11"), AiscBayRule(), paces=(2.0, 2.0)
    ).steady
    by_hand = aisc_bay_acceleration(frequency=4.0, weight=2 * MASS * 9.80665, damping_ratio=ZETA)
    assert by_modes.level[0] == pytest.approx(by_hand, rel=1e-9)
    assert by_hand / 9.80665 == pytest.approx(
        65.0 * 4.448222 * np.exp(-1.4) / (0.03 * 40e3 * 9.80665), rel=1e-6
    )


def test_chapter_7_of_dg11_is_its_formula_on_one_mode():
    """``FRF_max 0.09 exp(-0.075 f) Q rho``; rho is 1 from 3 %, 0.75 at 1 %, 0.5 at 0.5 %."""
    for ratio, rho in ((0.03, 1.0), (0.01, 0.75), (0.005, 0.5)):
        found = footfall_response(
            one_mode(6.0, ratio=ratio), footfall_load("dg11"), footfall_rule("dg11"),
            paces=(1.9, 2.1),
        ).steady  # fmt: skip
        wanted = 0.09 * np.exp(-0.075 * 6.0) * 747.3 * rho / (2 * ratio * MASS)
        assert found.level[0] == pytest.approx(wanted, rel=2e-3)  # the peak is a hair above f_n
        assert (found.harmonic[0], found.pace[0]) == (3, pytest.approx(2.0, rel=5e-3))


def test_the_dose_is_that_of_p354():
    """``0.68 a_w,rms (n T)^0.25``: 16 passages are twice the dose of one."""
    found = footfall_response(one_mode(4.0), footfall_load("p354"), SciRule())
    one = found.dose(10.0, 1.0)
    rms = 0.005 * found.governing.level
    assert one[0] == pytest.approx(0.68 * rms[0] * 10.0**0.25, rel=1e-12)
    assert found.dose(10.0, 16.0)[0] == pytest.approx(2.0 * one[0], rel=1e-12)
    with pytest.raises(InputError, match="has no vibration dose"):
        footfall_response(one_mode(4.0), footfall_load("dg11"), AiscBayRule()).dose(1.0, 1.0)


def test_what_is_in_doubt_is_said():
    """Paces that a guide is not for, no impulse, too few modes."""
    found = footfall_response(one_mode(4.0), footfall_load("p354"), SciRule(), paces=(1.5, 2.0))
    assert {doubt.subject for doubt in found.doubts} == {"paces", "modes"}
    found = footfall_response(one_mode(4.6), footfall_load("dg11"), AiscBayRule())
    said = {doubt.subject: doubt.message for doubt in found.doubts}
    assert "harmonic 3 of 1.53 steps/s would meet it" in said["paces"]
    found = footfall_response(one_mode(4.0), footfall_load("iso-10137"), CcipRule())
    assert [doubt.subject for doubt in found.doubts] == ["impulses"]


def test_what_cannot_be_is_refused(prepared):
    """No damping has no steady state; level motion and paces that fall are refused."""
    with pytest.raises(InputError, match="damping ratio of mode 1 is 0"):
        one_mode(4.0, ratio=0.0)
    with pytest.raises(InputError, match="paces must rise"):
        footfall_response(one_mode(4.0), footfall_load("p354"), SciRule(), paces=(2.2, 1.8))
    with pytest.raises(InputError, match="vertical"):
        footfall_floor(prepared, Spots(xy=np.array([[1.0, 1.0]]), axis="x"))
    with pytest.raises(InputError, match="path_length"):
        SciRule(path_length=-1.0)
    with pytest.raises(InputError, match="did you mean 'p354'"):
        footfall_rule("p345")


def test_several_storeys_are_answered_together():
    """A walker in the laboratory is felt on the deck below, less than where he walks."""
    study = study_from_text(BUILDING)
    method = study.methods[0].interaction
    prepared = prepare(study.floor, method.integration, method.damping)
    spots = [Spots(xy=np.array([[12.0, 3.0]]), on=name) for name in ("deck", "lab")]
    found = footfall_response(
        footfall_floor(prepared, spots, spots[1:]), footfall_load("p354"), SciRule()
    ).governing.level
    assert 0.0 < found[0] < 0.5 * found[1]
