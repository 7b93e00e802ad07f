"""Verdicts from levels that are written down by hand: outcome, margin, reasons, several points."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.criteria import (
    VC,
    Verdict,
    assess_reduced,
    best_class,
    find_criterion,
    spectra_asked_for,
    watched,
)
from trundle.errors import ComputationError, InputError
from trundle.response import BandSpectra, RunLevels
from trundle.signals import mid_band_frequencies
from trundle.simulate import Coverage

BANDS = mid_band_frequencies()
AT_10 = 10  # number of the 10 Hz band
AT_80 = 19
POINTS = ("Prüfstand, <b>1</b>", "edge", "hall")
QUIET = 1e-8


def levels(values, *, resolved=None, quantity="band_rms_velocity", mid_band=BANDS, names=POINTS):
    """Return the levels of every run in every band, each with a time that tells its place."""
    values = np.array(values, dtype=float)
    runs, points, bands = np.indices(values.shape)
    return BandSpectra(
        mid_band=mid_band, values=values, times=100.0 * runs + 10.0 * points + 0.1 * bands,
        resolved=np.full(len(mid_band), True) if resolved is None else resolved,
        averaging="slow", point_names=names, quantity=quantity,
    )  # fmt: skip


def kept(spectra, numbers=None, more=None):
    """Return what is kept of runs: spectra, and single numbers of 1 unless given."""
    shape = spectra.values.shape[:2]
    names = ("peak_acceleration", "peak_time", "response_factor", "vdv")
    return RunLevels(
        numbers={name: np.ones(shape) for name in names} | (numbers or {}),
        spectra=spectra, more=more or {},
    )  # fmt: skip


def quiet(n_runs=3, n_points=3, n_bands=20):
    return np.full((n_runs, n_points, n_bands), QUIET)


def held(reduced, criteria, **settings):
    settings = {"percentile": 50.0, "f_resolved": 80.0, **settings}
    return assess_reduced(reduced, criteria, **settings)


def flat(limit, low=1.0, high=80.0, **changes):
    """Return a curve of one limit."""
    return replace(
        find_criterion("VC-C"),
        frequencies=np.array([low, high]),
        limits=np.full(2, limit),
        **changes,
    )


def test_verdicts_come_by_point_and_then_by_criterion():
    """Two curves at three points, of which the second alone is loud: its pair alone fails.

    500 um/s at 10 Hz over limits of 200 and 50 there: margins 0.4 and 0.1.
    """
    values = quiet()
    values[:, 1, AT_10] = 500e-6
    curves = [find_criterion("residential-day"), find_criterion("VC-A")]
    found = held(kept(levels(values)), curves)
    names = [(v.point, v.criterion.name, v.status) for v in found]
    assert names == [
        (POINTS[0], "residential-day", "pass"), (POINTS[0], "VC-A", "pass"),
        ("edge", "residential-day", "fail"), ("edge", "VC-A", "fail"),
        ("hall", "residential-day", "pass"), ("hall", "VC-A", "pass"),
    ]  # fmt: skip
    assert [v.margin for v in found[2:4]] == pytest.approx([0.4, 0.1], rel=1e-9)


def test_the_governing_band_is_that_of_the_least_margin_not_of_the_highest_level():
    """VC-A allows 100 um/s at 4 Hz and 50 at 16 Hz: 60 um/s at 4 Hz is met, 55 at 16 Hz is not.

    By hand: margins 100 / 60 = 1.667 and 50 / 55 = 0.909.
    """
    values = quiet(1, 1)
    values[0, 0, 6], values[0, 0, 12] = 60e-6, 55e-6
    (found,) = held(kept(levels(values, names=("p",))), find_criterion("VC-A"))
    assert found.status == "fail"
    assert found.governing_band == pytest.approx(10**1.2)
    assert found.margin == pytest.approx(50.0 / 55.0, rel=1e-9)
    assert (found.value, found.limit) == pytest.approx((55e-6, 50e-6), rel=1e-9)
    at = {round(f, 2): status for f, status in zip(BANDS, found.bands.statuses, strict=True)}
    assert (at[3.98], at[15.85]) == ("pass", "fail")


def test_a_level_exactly_at_its_limit_is_met():
    """A margin of 1 passes: only what exceeds a limit fails it, in the bands as in the whole."""
    values = quiet(1, 1)
    values[0, 0, AT_10] = 12.5e-6
    (found,) = held(kept(levels(values, names=("p",))), flat(12.5e-6))
    assert (found.status, found.margin, found.share_exceeding) == ("pass", 1.0, 0.0)
    assert set(found.bands.statuses) == {"pass"}
    above = held(kept(levels(values * (1 + 1e-12), names=("p",))), flat(12.5e-6))[0]
    assert (above.status, above.share_exceeding) == ("fail", 1.0)


def test_the_compared_level_is_the_percentile_over_runs_of_each_band():
    """Runs of 1, 2, 3, 4, 5 um/s: the 75 % level is 4, so a limit of 4.4 has a margin of 1.1.

    One run of five, that of 5, exceeds it. The time is that of the run of 4, the fourth.
    """
    values = quiet(5, 3)
    values[:, 2, AT_10] = 1e-6 * np.array([2.0, 5.0, 1.0, 4.0, 3.0])
    found = held(kept(levels(values)), flat(4.4e-6), percentile=75.0)[2]
    assert found.value == pytest.approx(4e-6, rel=1e-12)
    assert found.margin == pytest.approx(1.1, rel=1e-12)
    assert found.share_exceeding == pytest.approx(0.2)
    assert found.time == pytest.approx(100.0 * 3 + 10.0 * 2 + 0.1 * AT_10)
    assert found.percentile == 75.0
    assert found.averaging == "slow"


def test_the_share_exceeding_counts_runs_that_exceed_in_any_band():
    """Run 0 is loud at 10 Hz, run 1 at 80 Hz, run 2 in both, run 3 nowhere: three of four."""
    values = quiet(4, 1)
    values[[0, 2], 0, AT_10] = 1e-3
    values[[1, 2], 0, AT_80] = 1e-3
    (found,) = held(kept(levels(values, names=("p",))), flat(1e-6), percentile=0.0)
    assert found.status == "pass"  # the quietest run in each band is quiet
    assert found.share_exceeding == 0.75


def test_a_missing_band_takes_the_pass_and_not_the_failure():
    """Without the 80 Hz band a quiet point is not assessed and a loud one fails, with its name."""
    resolved = BANDS < 70.0
    values = quiet()
    values[:, 1, AT_10] = 1e-3
    values[:, :, AT_80] = np.nan
    one, two, _ = held(kept(levels(values, resolved=resolved)), flat(1e-6))
    assert (one.status, two.status) == ("not assessed", "fail")
    assert one.unresolved == two.unresolved == (80.0,)
    assert one.reasons[0].startswith("80 Hz are not shown")
    assert one.margin == pytest.approx(1e-6 / QUIET)
    assert one.bands.statuses[AT_80] == "not assessed"
    assert np.isnan(one.bands.values[AT_80])


def test_long_lists_of_missing_bands_are_cut_to_four():
    """Of seven bands from 20 Hz up the first four are named, and that there are more."""
    values = quiet(1, 1)
    (found,) = held(kept(levels(values, resolved=BANDS < 18.0, names=("p",))), flat(1.0))
    assert found.unresolved == (20.0, 25.0, 31.5, 40.0, 50.0, 63.0, 80.0)
    assert found.reasons[0].startswith("20, 25, 31.5, 40 ... Hz are not shown")


def test_where_no_band_of_the_curve_is_known_there_is_no_number():
    """A curve from 20 Hz on levels to 16 Hz: nothing is compared, so nothing is stated."""
    (found,) = held(
        kept(levels(quiet(1, 1), resolved=BANDS < 18.0, names=("p",))), flat(1e-3, low=20.0)
    )
    assert found.status == "not assessed"
    numbers = (found.margin, found.value, found.limit, found.governing_band, found.time)
    assert np.isnan([*numbers, found.share_exceeding, *found.interval]).all()
    assert set(found.bands.statuses) == {"not assessed"}
    assert found.words == "not assessed"


def test_a_level_that_is_no_number_is_an_error_and_no_pass():
    """NaN compares as met with every limit, so it must stop the work where it is compared.

    In a band that the curve does not ask for it is nobody's concern.
    """
    values = quiet(1, 3)
    values[0, 1, AT_10] = np.nan
    with pytest.raises(ComputationError, match=r"'edge' for VC-C is not a finite number"):
        held(kept(levels(values)), flat(1.0))
    assert held(kept(levels(values)), flat(1.0, low=20.0))[1].status == "pass"
    for name, curve in (("peak_acceleration", "stepper-B"), ("vdv", "VDV-office-low")):
        with pytest.raises(ComputationError, match="not a finite number"):
            held(kept(levels(quiet(1, 3)), {name: values[:, :, AT_10]}), find_criterion(curve))


def test_a_level_without_end_is_an_error_before_any_percentile_of_it():
    """Between two infinite runs a percentile is inf - inf, which numpy warns of and calls NaN."""
    values = quiet(2, 3)
    values[:, 1, AT_10] = np.inf
    with pytest.raises(ComputationError, match=r"'edge' for VC-C is not a finite number"):
        held(kept(levels(values)), flat(1.0))
    assert held(kept(levels(values)), flat(1.0, low=20.0))[1].status == "pass"


def test_a_curve_between_two_bands_says_why_nothing_is_assessed():
    """From 1.08 to 1.12 Hz: bands have their middles at 1 and 1.25 Hz (1.26)."""
    narrow = flat(1.0, low=1.08, high=1.12)
    found = held(kept(levels(quiet())), narrow)[0]
    assert found.status == "not assessed"
    assert found.reasons == (
        "no band has its middle within the curve, 1.08 to 1.12 Hz: draw it on",
    )
    _, complete = watched([narrow], f_max=90.0, sampling_frequency=200.0, coverage=Coverage())
    assert complete == (False,)
    below = held(kept(levels(quiet())), flat(1.0, low=0.2, high=0.5))[0]  # bands that nobody has
    assert "Hz are not shown" in below.reasons[0]
    assert len(below.reasons) == 1


def test_what_does_not_move_at_all_is_not_passed():
    """1e-13 m/s in every band is no low level; 1e-9 m/s in one of them is."""
    dead = np.full((2, 1, 20), 1e-13)
    (found,) = held(kept(levels(dead, names=("p",))), flat(1e-6))
    assert found.status == "not assessed"
    assert "nothing moves there" in found.reasons[0]
    assert np.isnan(found.margin)
    dead[0, 0, AT_10] = 1e-9
    assert held(kept(levels(dead, names=("p",))), flat(1e-6))[0].status == "pass"


def test_a_dead_point_is_not_passed_by_a_single_number():
    """A peak of 0 is below every limit, and stands for a sensor that is off."""
    zeros = {"peak_acceleration": np.zeros((2, 1))}
    spectra = levels(quiet(2, 1), names=("p",))
    (found,) = held(kept(spectra, zeros), find_criterion("stepper-B"))
    assert found.status == "not assessed"
    assert "nothing moves there" in found.reasons[0]


def test_a_peak_is_held_against_its_limit_with_its_time():
    """Peaks of 0.6, 0.9 and 1.2 mm/s2 against 1: the median has a margin of 1 / 0.9 in run 1."""
    numbers = {
        "peak_acceleration": 1e-3 * np.array([[0.6], [0.9], [1.2]]),
        "peak_time": np.array([[1.0], [2.5], [3.0]]),
    }
    (found,) = held(kept(levels(quiet(3, 1), names=("p",)), numbers), find_criterion("stepper-B"))
    assert found.status == "pass"
    assert found.margin == pytest.approx(1.0 / 0.9)
    assert found.share_exceeding == pytest.approx(1.0 / 3.0)
    assert found.time == 2.5
    assert np.isnan(found.governing_band)
    assert found.bands is None


def test_a_dose_grows_with_the_fourth_root_of_events_and_a_response_factor_does_not():
    """81 events: 3 times the dose of one, 0.5 against a limit of 0.8 makes 1.5."""
    numbers = {"vdv": np.full((1, 1), 0.5), "response_factor": np.full((1, 1), 3.0)}
    reduced = kept(levels(quiet(1, 1), names=("p",)), numbers)
    dose, factor = held(
        reduced, [find_criterion("VDV-office-low"), find_criterion("R-office")], events=81.0
    )
    assert (dose.value, dose.status) == (pytest.approx(1.5), "fail")
    assert (factor.value, factor.status) == (pytest.approx(3.0), "pass")
    assert factor.margin == pytest.approx(4.0 / 3.0)


@pytest.mark.parametrize(
    ("f_resolved", "excited_to", "unresolved", "unexcited"),
    [
        (80.0, np.inf, (), ()),
        (60.0, np.inf, (80.0,), ()),
        (80.0, 30.0, (), (80.0,)),
        (60.0, 30.0, (80.0,), (80.0,)),
    ],
)
def test_a_broadband_number_needs_all_frequencies_of_its_curve(
    f_resolved, excited_to, unresolved, unexcited
):
    """A dose to 60 Hz, or of waves to 30 Hz, is a lower bound: below its limit it is no pass.

    The curve reaches to infinity; asked for is what trundle computes, 80 Hz.
    """
    numbers = {"vdv": np.array([[0.1]])}
    (found,) = held(
        kept(levels(quiet(1, 1), names=("p",)), numbers), find_criterion("VDV-office-low"),
        f_resolved=f_resolved, coverage=Coverage(excited_to=excited_to),
    )  # fmt: skip
    whole = not unresolved and not unexcited
    assert found.status == ("pass" if whole else "not assessed")
    assert (found.unresolved, found.unexcited) == (unresolved, unexcited)
    assert len(found.reasons) == len(unresolved) + len(unexcited)
    loud = {"vdv": np.array([[7.0]])}
    failed = held(
        kept(levels(quiet(1, 1), names=("p",)), loud), find_criterion("VDV-office-low"),
        f_resolved=f_resolved, coverage=Coverage(excited_to=excited_to),
    )[0]  # fmt: skip
    assert failed.status == "fail"


def test_a_broadband_number_is_asked_no_further_than_its_curve_ends():
    """A curve of peaks to 25 Hz is passed by what is computed and excited to 25 Hz."""
    curve = replace(find_criterion("stepper-B"), frequencies=np.array([1.0, 25.0]))
    numbers = {"peak_acceleration": np.full((1, 1), 1e-5)}
    reduced = kept(levels(quiet(1, 1), names=("p",)), numbers)
    for top, status in ((25.0, "pass"), (24.0, "not assessed")):
        found = held(reduced, curve, f_resolved=top, coverage=Coverage(excited_to=top))[0]
        assert found.status == status


def test_a_vehicle_that_has_not_left_takes_every_pass():
    """What comes behind the record's end is not known, in bands and in single numbers alike."""
    numbers = {"peak_acceleration": np.full((1, 1), 1e-6)}
    reduced = kept(levels(quiet(1, 1), names=("p",)), numbers)
    curves = [flat(1.0), find_criterion("stepper-B")]
    for found in held(reduced, curves, coverage=Coverage(leaves=9.0, ends=6.0)):
        assert found.status == "not assessed"
        assert found.reasons == (
            "the record ends at 6 s and the last wheel leaves the floor at 9 s: lengthen or "
            "remove duration",
        )
    for found in held(reduced, curves, coverage=Coverage(leaves=6.0, ends=6.0)):
        assert found.status == "pass"


def test_channels_are_held_against_the_limits_of_their_own_direction():
    """A vertical limit says nothing of a horizontal channel; one of each axis asks for all.

    A channel of no known direction is taken for vertical.
    """
    numbers = {"peak_acceleration": np.full((1, 3), 1e-5)}
    reduced = kept(levels(quiet(1, 3)), numbers)
    up, side = (find_criterion(f"electron-microscope-{w}") for w in ("vertical", "horizontal"))
    every = flat(1e-3)
    assert every.axis == "each axis"
    found = held(reduced, [up, side, every], axes=("vertical", "horizontal", ""))
    assert [v.status for v in found] == [
        "pass", "not assessed", "pass",
        "not assessed", "pass", "pass",
        "pass", "not assessed", "pass",
    ]  # fmt: skip
    assert found[3].reasons == ("the channel is horizontal",)
    assert [v.axis for v in found[::4]] == ["vertical", "horizontal", "vertical"]
    assert [v.axis for v in found[2::3]] == ["vertical", "horizontal", "vertical"]
    computed = held(reduced, side)[0]
    assert computed.reasons == ("horizontal motion is not computed",)
    assert np.isnan(computed.margin)


def test_as_many_directions_as_points_are_needed():
    """Two directions for three points would judge one by another's limit."""
    with pytest.raises(ValueError, match="zip"):
        held(kept(levels(quiet(1, 3))), flat(1.0), axes=("vertical", "horizontal"))


def test_each_quantity_is_read_from_its_own_spectrum():
    """Velocity is loud, displacement quiet: the same limit fails the one and not the other."""
    velocity = levels(np.full((1, 1, 20), 1e-3), names=("p",))
    displacement = levels(quiet(1, 1), quantity="band_rms_displacement", names=("p",))
    reduced = kept(velocity, more={"band_rms_displacement": displacement})
    found = held(reduced, [flat(1e-6), flat(1e-6, quantity="band_rms_displacement")])
    assert [v.status for v in found] == ["fail", "pass"]
    with pytest.raises(KeyError):
        held(reduced, flat(1e-6, quantity="band_rms_acceleration"))


def test_lines_have_their_own_names():
    """Lines of 1 Hz that are missing are named as they are: 79 Hz is no band."""
    lines = np.arange(1.0, 101.0)
    spectra = levels(
        np.full((1, 1, 100), QUIET), quantity="narrow_band_acceleration", mid_band=lines,
        resolved=lines <= 78.0, names=("p",),
    )  # fmt: skip
    reduced = kept(levels(quiet(1, 1), names=("p",)), more={spectra.quantity: spectra})
    (found,) = held(reduced, flat(1e-3, quantity="narrow_band_acceleration"))
    assert found.status == "not assessed"
    assert found.unresolved == (79.0, 80.0, 81.0)  # 81 lies within 2 % of the curve's end
    assert found.governing_band in lines


def test_spectra_asked_for_are_named_once_and_without_single_numbers():
    """What is formed of every run costs time: each spectrum once, in the order of the curves."""
    curves = [
        find_criterion(name)
        for name in ("Siemens-MRI", "VC-A", "R-office", "VDV-office-low", "stepper-B", "VC-B")
    ]
    assert spectra_asked_for(curves) == ("band_rms_acceleration", "band_rms_velocity")
    assert spectra_asked_for([]) == ()


def test_the_best_class_is_the_last_passed():
    """From the widest to the strictest: failed classes are passed over, none is "none"."""
    values = quiet(1, 1)
    values[0, 0, AT_10] = 20e-6  # VC-B allows 25 um/s at 10 Hz, VC-C 12.5
    found = held(kept(levels(values, names=("p",))), VC)
    assert best_class(found) == "VC-B"
    assert [v.status for v in found] == ["pass"] * 6 + ["fail"] * 3
    assert best_class(found[6:]) == "none"
    assert best_class([]) == "none"
    unknown = held(kept(levels(values, resolved=BANDS < 60, names=("p",))), VC)
    assert best_class(unknown) == "none"  # what is not assessed is no class


@pytest.mark.parametrize("percentile", [-1.0, 100.1, np.nan])
def test_a_share_of_runs_is_between_none_and_all(percentile):
    """Outside 0 to 100 there is no such level."""
    with pytest.raises(InputError, match=r"percentile must be"):
        held(kept(levels(quiet())), flat(1.0), percentile=percentile)


def test_the_interval_of_a_margin_is_of_order_statistics():
    """Levels 1 to 100 um/s: the 50 % level lies between values 40 and 61 with 95 % confidence.

    Binomial of 100 and 1/2: P(N <= 39) = 0.0176 and P(N <= 40) = 0.0284 about 2.5 %, so the
    bounds are the 40th and the 61st value (tables of the sign test). Margins turn them over.
    """
    values = quiet(100, 1)
    values[:, 0, AT_10] = 1e-6 * np.random.default_rng(8).permutation(np.arange(1.0, 101.0))
    (found,) = held(kept(levels(values, names=("p",))), flat(61e-6))
    assert found.interval == pytest.approx((61.0 / 61.0, 61.0 / 40.0))
    assert not found.uncertain
    (tight,) = held(kept(levels(values, names=("p",))), flat(60e-6))
    assert tight.status == "pass"
    assert tight.uncertain
    assert "pass, not surely, margin 1.19" in tight.words


def test_few_runs_give_a_percentile_no_upper_limit():
    """Of three runs nothing bounds a 95 % level from above: 0 as margin, and that is said."""
    values = quiet(3, 1)
    values[:, 0, AT_10] = 1e-6 * np.array([1.0, 2.0, 3.0])
    (found,) = held(kept(levels(values, names=("p",))), flat(1e-3), percentile=95.0)
    assert found.interval[0] == 0.0
    assert found.uncertain
    assert found.words.startswith("pass, too few runs to be sure, margin")
    (single,) = held(kept(levels(quiet(1, 1), names=("p",))), flat(1e-3))
    assert np.isnan(single.interval).all()
    assert not single.uncertain


def test_a_verdict_in_words():
    """Name, direction, title, outcome, margin and the nominal name of the band, on one line."""
    values = quiet(1, 3)
    values[0, 0, 15] = 25e-6
    found = held(kept(levels(values)), flat(12.5e-6, title="VC-C <flat>"))[0]
    assert str(found) == ("Prüfstand, <b>1</b> vertical, VC-C <flat>: fail, margin 0.5 at 31.5 Hz")
    missing = held(kept(levels(values, resolved=BANDS < 70.0)), flat(1.0))[0]
    assert str(missing).endswith("if bands reach that far at all")
    assert "not assessed, margin 4e+04 at 31.5 Hz; 80 Hz are not shown" in str(missing)


def test_how_rough_a_road_may_be_is_the_square_of_the_margin():
    """Gd(n0) is a power: levels twice as high are those of a road four times as rough."""
    verdict = Verdict(
        criterion=flat(1.0), point="p", status="pass", percentile=50.0, unresolved=(),
        averaging="slow", margin=2.0,
    )  # fmt: skip
    assert verdict.roughest == 4.0
    assert np.isnan(replace(verdict, margin=np.nan).roughest)


def test_partly_excited_bands_can_fail_and_nothing_else():
    """Between 10 Hz, where a road ends, and 90 Hz, where a machine does, levels are lower bounds.

    A low level there neither governs nor passes; a high one fails and governs.
    """
    reach = Coverage(excited_to=11.3, partly_to=90.0)
    values = quiet(1, 1)
    values[0, 0, AT_80] = 0.9e-6
    reduced = kept(levels(values, names=("p",)))
    (below,) = held(reduced, flat(1e-6), coverage=reach)
    assert below.status == "not assessed"
    assert below.governing_band < 11.3
    assert below.bands.statuses[AT_80] == "not assessed"
    (above,) = held(reduced, flat(0.8e-6), coverage=reach)
    assert (above.status, above.governing_band) == ("fail", pytest.approx(10**1.9))
    assert above.bands.statuses[AT_80] == "fail"
    assert above.unexcited[0] == 12.5
    (beyond,) = held(reduced, flat(0.8e-6), coverage=Coverage(excited_to=11.3))
    assert beyond.status == "not assessed"  # what nothing excites is rounding, and no failure
