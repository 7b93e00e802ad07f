"""Classes over a floor from levels written down by hand; maps together; what a meter is told."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.criteria import VC, assess_reduced, class_map, envelope_of, find_criterion, watched
from trundle.errors import ComputationError, InputError
from trundle.response import BandSpectra, FloorMap, RunLevels
from trundle.signals import mid_band_frequencies
from trundle.simulate import Coverage

BANDS = mid_band_frequencies()
NUMBERS = ("rms_velocity", "peak_acceleration", "response_factor", "vdv")


def floor(levels, **numbers):
    """Return a map of levels (runs, places, bands), and of numbers (runs, places)."""
    levels = np.array(levels, dtype=float)
    shape = levels.shape[:2]
    every = {name: np.full(shape, np.nan) for name in NUMBERS} | numbers
    return FloorMap(
        places=np.arange(2.0 * shape[1]).reshape(-1, 2), mid_band=BANDS,
        resolved=np.full(20, True), averaging="max_1s", band_levels=levels, numbers=every,
    )  # fmt: skip


def flat(limit, **changes):
    return replace(
        find_criterion("VC-C"),
        frequencies=np.array([1.0, 80.0]),
        limits=np.full(2, limit),
        **changes,
    )


def random_levels(seed, n_runs=7, n_places=40):
    """Return levels from well below VC-E to above the workshop's."""
    rng = np.random.default_rng(seed)
    return np.geomspace(3e-7, 6e-3, n_places)[:, None] * rng.uniform(
        0.2, 1.0, (n_runs, n_places, 20)
    )


@pytest.mark.parametrize(
    "reach",
    [
        Coverage(),
        Coverage(excited_to=30.0),
        Coverage(leaves=9.0, ends=6.0),
        Coverage(excited_to=30.0, partly_to=70.0),
    ],
)
@pytest.mark.parametrize("top", [90.0, 60.0])
def test_a_map_says_at_a_place_what_a_verdict_says_at_a_point(reach, top):
    """The same levels as points of an ensemble: one margin, band and share; failed alike.

    A class that a map gives is one that the point's verdict passes, and the strictest of them.
    """
    values = random_levels(3, n_places=10)
    resolved = top >= BANDS * 10**0.05
    values[..., ~resolved] = np.nan
    made = replace(floor(values), resolved=resolved)
    names = tuple(f"p{i}" for i in range(values.shape[1]))
    reduced = RunLevels(
        numbers={},
        spectra=BandSpectra(
            mid_band=BANDS, values=values, times=np.zeros_like(values), resolved=resolved,
            averaging="max_1s", point_names=names,
        ),
        more={},
    )  # fmt: skip
    found = class_map(made, VC, percentile=80.0, f_max=top, coverage=reach)
    verdicts = assess_reduced(reduced, VC, percentile=80.0, f_resolved=top, coverage=reach)
    by_point = np.array(verdicts, dtype=object).reshape(len(names), len(VC))
    classes, seen = found.classes(), set()
    for i, point in enumerate(by_point):
        for j, verdict in enumerate(point):
            assert found.margin[j, i] == pytest.approx(verdict.margin, rel=1e-12)
            assert found.governing_band[j, i] == pytest.approx(verdict.governing_band)
            assert (found.margin[j, i] < 1.0) == (verdict.status == "fail")
        passed = [j for j, verdict in enumerate(point) if verdict.status == "pass"]
        expected = passed[-1] if passed else -1 if point[0].status == "fail" else -2
        assert classes[i] == expected
        seen.add(int(classes[i]))
    assert len(seen) >= (5 if all(found.complete) else 2)  # the levels spread over outcomes


def test_the_share_of_a_map_counts_runs_above_in_any_band():
    """Runs 0 and 1 exceed in different bands, run 2 in none: two thirds; nothing at a quiet place."""
    levels = np.full((3, 2, 20), 1e-8)
    levels[0, 0, 3] = levels[1, 0, 17] = 1e-4
    found = class_map(floor(levels), [flat(1e-6)], percentile=50.0, f_max=90.0)
    np.testing.assert_allclose(found.share_exceeding, [[2.0 / 3.0, 0.0]])


def test_classes_are_by_strictness_whatever_the_order_of_the_study():
    """Criteria from the strictest to the widest, with another quantity between: one class.

    20 um/s at 10 Hz meets VC-B (25 um/s) and not VC-C; 1 mm/s meets none; 1 nm/s meets all.
    """
    levels = np.full((1, 3, 20), 1e-9)
    levels[0, :2, 10] = 20e-6, 1e-3
    peaks = np.full((1, 3), 1e-5)
    many = [*VC[::-1][:4], find_criterion("stepper-B"), *VC[::-1][4:]]
    found = class_map(floor(levels, peak_acceleration=peaks), many, percentile=50.0, f_max=90.0)
    named = [found.criteria[i].name if i >= 0 else i for i in found.classes()]
    assert named == ["VC-B", -1, "VC-E"]
    order = [found.criteria[i].name for i in found.order()]
    assert order == [c.name for c in VC]


def test_a_place_that_does_not_move_has_no_class():
    """A held edge: every level is below 1e-12 m/s, and no margin is made of it."""
    levels = np.full((2, 2, 20), 1e-9)
    levels[:, 0] = 1e-14
    zero = {"peak_acceleration": np.array([[0.0, 1e-5], [0.0, 1e-5]])}
    curves = [*VC, find_criterion("stepper-B")]
    found = class_map(floor(levels, **zero), curves, percentile=50.0, f_max=90.0)
    assert np.isnan(found.margin[:, 0]).all()
    assert np.isnan(found.share_exceeding[:, 0]).all()
    assert np.isfinite(found.margin[:, 1]).all()
    assert found.classes().tolist() == [-2, len(VC) - 1]


def test_peaks_on_a_map():
    """Peaks of 0.5 and 2 mm/s2 in two runs against 1 mm/s2: at 100 % a margin of 1/2, no band.

    They need all frequencies of the curve: 80 Hz of the computation and of the road.
    """
    levels = np.full((2, 1, 20), 1e-9)
    made = floor(levels, peak_acceleration=np.array([[0.5e-3], [2e-3]]))
    stepper = [find_criterion("stepper-B")]
    found = class_map(made, stepper, percentile=100.0, f_max=80.0)
    assert found.margin[0, 0] == pytest.approx(0.5)
    assert found.share_exceeding[0, 0] == 0.5
    assert np.isnan(found.governing_band).all()
    assert found.complete == (True,)
    for top, reach in (
        (79.0, Coverage()),
        (80.0, Coverage(excited_to=79.0)),
        (80.0, Coverage(leaves=2.0, ends=1.0)),
    ):
        assert class_map(made, stepper, f_max=top, coverage=reach).complete == (False,)


def test_a_number_that_was_not_asked_for_is_nowhere_passed():
    """Peaks that were not mapped are NaN: no margin, and not complete."""
    found = class_map(
        floor(np.full((2, 1, 20), 1e-9)), [find_criterion("stepper-B")], percentile=50.0, f_max=90.0
    )
    assert np.isnan(found.margin).all()
    assert found.complete == (False,)


def test_curves_that_a_map_has_no_level_for_are_left_out():
    """Doses and accelerations in bands are not mapped; limits on sideways motion are not either."""
    many = [
        find_criterion(name)
        for name in ("VDV-office-low", "Siemens-MRI", "electron-microscope-horizontal", "VC-A")
    ]
    found = class_map(floor(np.full((1, 2, 20), 1e-9)), many, f_max=90.0)
    assert [c.name for c in found.criteria] == ["VC-A"]


def test_level_motion_is_held_against_limits_on_level_motion():
    """Where a wall's or frame's level motion is mapped a vertical limit does not apply.

    Two places, the second level: 1 nm/s at both, so that whatever applies is passed.
    """
    level = np.array([False, True])
    curves = [
        flat(1e-5, axis="vertical", name="up"), flat(1e-6, axis="horizontal", name="side"),
        flat(1e-4, axis="each axis", name="any"),
    ]  # fmt: skip
    found = class_map(floor(np.full((1, 2, 20), 1e-9)), curves, f_max=90.0, level=level)
    np.testing.assert_array_equal(found.applies, [[True, False], [False, True], [True, True]])
    np.testing.assert_array_equal(np.isnan(found.margin), ~found.applies)
    assert [found.criteria[i].name for i in found.classes()] == ["up", "side"]
    loud = class_map(floor(np.full((1, 2, 20), 1.0)), curves, f_max=90.0, level=level)
    assert loud.classes().tolist() == [-1, -1]


def test_a_failed_place_is_known_by_the_widest_limit_that_applies_to_it():
    """The widest curve of all is for level motion: a vertical place that fails its own is -1."""
    level = np.array([False, True])
    curves = [flat(1.0, axis="horizontal"), flat(1e-6, axis="vertical")]
    levels = np.full((1, 2, 20), 1e-3)
    found = class_map(floor(levels), curves, f_max=60.0, level=level)
    part = replace(found, complete=(False, False))
    assert part.classes().tolist() == [-1, -2]


def test_part_of_a_map_is_that_of_its_places():
    """What is told of places 2 and 3 is what a map of those two alone tells."""
    values = random_levels(5, n_places=6)
    whole, some = (
        class_map(made, VC, percentile=60.0, f_max=90.0)
        for made in (floor(values), floor(values[:, 2:4]))
    )
    part = whole.part(slice(2, 4))
    for name in ("margin", "governing_band", "share_exceeding", "applies"):
        np.testing.assert_array_equal(getattr(part, name), getattr(some, name))
    np.testing.assert_array_equal(part.classes(), whole.classes()[2:4])
    np.testing.assert_array_equal(part.places, whole.places[2:4])


def test_a_criterion_of_a_map_is_found_by_its_name():
    """The names on the map are listed where one is not among them."""
    found = class_map(floor(np.full((1, 1, 20), 1e-9)), VC[3:5], f_max=90.0)
    assert found.index("VC-A") == 1
    with pytest.raises(InputError, match=r"no criterion 'VC-B' on the map; there are operating-th"):
        found.index("VC-B")


def test_an_envelope_is_the_worst_map_at_every_place():
    """Least margin with the band that belongs to it, largest share, by comparing place by place."""
    maps = [
        class_map(
            floor(np.random.default_rng(seed).permutation(random_levels(seed), axis=1)),
            VC,
            percentile=70.0,
            f_max=90.0,
        )
        for seed in range(4)
    ]
    worst = envelope_of(maps)
    for i in range(len(VC)):
        for j in range(40):
            margins = [one.margin[i, j] for one in maps]
            k = int(np.argmin(margins))
            assert worst.margin[i, j] == margins[k]
            assert worst.governing_band[i, j] == maps[k].governing_band[i, j]
            assert worst.share_exceeding[i, j] == max(one.share_exceeding[i, j] for one in maps)
    classes = np.array([one.classes() for one in maps])
    np.testing.assert_array_equal(worst.classes(), classes.min(axis=0))


def test_an_envelope_passes_only_what_every_map_knows():
    """One road whose waves end at 20 Hz leaves the envelope without a class; a failure stays."""
    levels = np.full((1, 2, 20), 1e-9)
    levels[:, 1, 10] = 1e-2
    whole = class_map(floor(levels), VC, f_max=90.0)
    short = class_map(floor(levels), VC, f_max=90.0, coverage=Coverage(excited_to=20.0))
    assert envelope_of([whole, whole]).classes().tolist() == [len(VC) - 1, -1]
    for maps in ([whole, short], [short, whole]):
        assert envelope_of(maps).classes().tolist() == [-2, -1]
    # the short one is of a machine, known altogether: it binds nobody, unless alone
    assert envelope_of([whole, short], [False, True]).classes().tolist() == [len(VC) - 1, -1]
    assert envelope_of([short, short], [True, True]).classes().tolist() == [-2, -1]


def test_a_map_without_a_number_at_a_place_does_not_hide_another():
    """NaN of one map, where nothing of it is known, leaves the margin of the other."""
    levels = np.full((1, 2, 20), 1e-6)
    known = class_map(floor(levels), VC, f_max=90.0)
    none = replace(known, margin=np.full_like(known.margin, np.nan))
    np.testing.assert_array_equal(envelope_of([none, known]).margin, known.margin)
    both = envelope_of([none, none])
    assert np.isnan(both.margin).all()


@pytest.mark.parametrize(
    ("top", "fs", "reach", "last", "whole"),
    [
        (90.0, 200.0, Coverage(), 80.0, True),
        (60.0, 200.0, Coverage(), 50.0, False),
        (90.0, 100.0, Coverage(), 40.0, False),
        (90.0, 200.0, Coverage(excited_to=30.0), 25.0, False),
        (90.0, 200.0, Coverage(leaves=9.0, ends=6.0), 80.0, False),
    ],
)
def test_a_meter_is_told_the_limits_of_what_is_known(top, fs, reach, last, whole):
    """By hand: a band's upper edge is 1.122 times its middle, and 40 Hz needs 100 samples a second.

    To 60 Hz reaches the 50 Hz band (56.1); waves to 30 Hz fill the 25 Hz band (28.1).
    """
    vc = find_criterion("VC-A")
    (limit,), (complete,) = watched([vc], f_max=top, sampling_frequency=fs, coverage=reach)
    known = np.isfinite(limit.limits)
    low = (BANDS > 3.9) & (last * 1.02 > BANDS)
    np.testing.assert_array_equal(known, low)
    np.testing.assert_allclose(limit.limits[known], vc.limit(BANDS)[known])
    assert complete is whole
    assert (limit.name, limit.quantity) == ("VC-A", "band_rms_velocity")


def test_a_meter_knows_no_curve_whole_that_goes_beyond_all_bands():
    """NIST-A asks for 100 Hz, which no level shows; the numbers for people ask for 80 Hz."""
    many = [find_criterion(name) for name in ("NIST-A", "VC-E", "R-office", "VDV-office-low")]
    _, complete = watched(many, f_max=90.0, sampling_frequency=200.0, coverage=Coverage())
    assert complete == (False, True, True, True)
    limits, less = watched(
        many, f_max=90.0, sampling_frequency=200.0, coverage=Coverage(excited_to=70.0)
    )
    assert less == (False, False, False, False)
    assert [one.limits.tolist() for one in limits[2:]] == [[4.0], [0.8]]


def test_a_map_that_no_criterion_is_for_has_no_rows():
    """Doses have no map: nothing applies, in an array of the kind that others have."""
    made = class_map(floor(np.full((1, 2, 20), 1e-9)), [find_criterion("VDV-office-low")], f_max=90)
    assert made.criteria == ()
    assert (made.applies.dtype, made.applies.shape) == (np.dtype(bool), (0, 2))
    assert made.classes().tolist() == [-2, -2]


def test_an_infinite_level_is_an_error_and_no_hole_in_a_map():
    """Percentiles between two of them are NaN, which reads as a place where nothing is known."""
    levels = np.full((2, 2, 20), 1e-9)
    levels[:, 1, 10] = np.inf
    with pytest.raises(ComputationError, match="infinite"):
        class_map(floor(levels), VC, f_max=90.0)
