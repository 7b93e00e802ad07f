"""Days that are run: against ensembles, against all vehicles run at once, against what is expected."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from models import small_floor
from trundle.criteria import VC, watched
from trundle.response import Meter, reduce_runs
from trundle.road import Profile, RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.signals import mid_band_frequencies
from trundle.simulate import (
    Coupled,
    Coverage,
    Crossing,
    Decoupled,
    Modal,
    ensemble,
    lay_out,
    prepare,
    runs_with_mean,
)
from trundle.structure import Spot
from trundle.traffic import (
    Departures,
    OnePassage,
    Poisson,
    Schedule,
    Times,
    closest_meeting,
    expected_day,
    lay_out_meeting,
    meeting_error,
    on_one_day,
    superpose,
)
from trundle.vehicle import quarter_car

POINTS = {"tool": Spot(8.0, 4.0), "bay": Spot(3.0, 2.0)}
INTEGRATION = Modal(f_max=60.0, dt=0.005)
CURVES = VC[:5]  # workshop to VC-A
QUIET = 0.25  # times the road's elevations: some runs then keep within the widest limit
SEED, LENGTH = 5, 16.0


def car(name="way", *, y=3.0, road=None):
    return Crossing(
        vehicle=quarter_car(
            body_mass=4500.0, axle_mass=500.0, stiffness=4e5, damping=2e4, tyre_stiffness=2e6,
            tyre_damping=500.0,
        ),
        route=Route.straight((0.0, y), (12.0, y), speed=6.0, name=name),
        road=road or RoadClass("B"), band=RoughnessBand(n_max=8.0, contact_patch=0.1),
        entry=DriveIn(length=2.0), run_in=5.0,
    )  # fmt: skip


WAVE, STATIONS = 2 * np.pi / 0.9, np.arange(-60.0, 200.0, 0.05)
BUMPY = Profile(
    station=STATIONS,
    elevation=2e-3 * np.sin(WAVE * STATIONS),
    slope=2e-3 * WAVE * np.cos(WAVE * STATIONS),
)


@pytest.fixture(scope="module")
def floor():
    return prepare(
        small_floor(mesh_size=2.0), INTEGRATION, Decoupled(integration=INTEGRATION).damping
    )


def laid(floor, *crossings, kind=Decoupled):
    method = kind(integration=INTEGRATION)
    return {
        one.route.name: lay_out(floor, one, method=method, points=POINTS, duration=LENGTH)
        for one in crossings
    }


def limits(layout):
    reach = Coverage(excited_to=48.0)
    return watched(CURVES, f_max=layout.f_max, sampling_frequency=200.0, coverage=reach)[0]


def departures(*times, route=("way",), which=None):
    return Departures(
        time=np.array(times), route=route,
        which=np.zeros(len(times), dtype=int) if which is None else np.array(which),
    )  # fmt: skip


@pytest.mark.parametrize("kind", [Decoupled, Coupled])
def test_passages_that_do_not_meet_are_those_of_the_ensemble(floor, kind):
    """Twenty, 40 s apart: each is its run alone, in time above limits and in the largest level.

    Within two samples a passage: its last second fades out here, and rings on there.
    """
    layouts = laid(floor, car(), kind=kind)
    curves = limits(layouts["way"])
    times = 3600.0 + 40.0 * np.arange(20)
    tally = on_one_day(layouts, departures(*times), curves, seed=SEED)
    runs = ensemble(
        floor, car(), method=kind(integration=INTEGRATION), points=POINTS, n_runs=20, seed=SEED,
        duration=LENGTH,
    )  # fmt: skip
    levels = reduce_runs(runs, curves=curves)
    for c, curve in enumerate(curves):
        alone = levels.above[curve.name].sum(axis=0)
        np.testing.assert_allclose(tally.seconds_above[:, c].sum(axis=0), alone, atol=0.2)
    hours = np.flatnonzero(tally.seconds_above.sum(axis=(1, 2)))
    np.testing.assert_array_equal(hours, [1])  # all within 1 to 2 o'clock
    for c, curve in enumerate(curves):
        known = np.isfinite(curve.limits)
        for p in range(2):
            largest = (levels.spectra.values[:, p, known] / curve.limits[known]).max()
            assert np.sqrt(tally.peaks[c][p].square) == pytest.approx(largest, rel=1e-4)


def test_vehicles_that_meet_add_up_as_if_run_at_once(floor):
    """Three on two routes within seconds, decoupled on one bumpy road: exactly the joint run."""
    one, two = car("way", road=BUMPY), car("other", y=2.0, road=BUMPY)
    layouts = laid(floor, one, two)
    curves = limits(layouts["way"])
    day = departures(100.0, 100.7, 102.0, route=("way", "other"), which=[0, 1, 0])
    tally = on_one_day(layouts, day, curves, seed=SEED)
    both = [one, replace(two, depart=0.7), replace(one, depart=2.0)]
    runs = ensemble(
        floor, both, method=Decoupled(integration=INTEGRATION), points=POINTS, n_runs=1, seed=SEED,
        duration=LENGTH,
    )  # fmt: skip
    motion = {
        name: np.pad(np.moveaxis(getattr(runs, name)[0], 0, -1), ((0, 0), (0, 600)))
        for name in ("displacement", "velocity", "acceleration")
    }
    square = Meter(curves, mid_band_frequencies(), 200.0).take(
        motion | {"felt": 0 * motion["velocity"]}
    )
    largest = square.square.max(axis=-1)
    found = np.array([[peak.square for peak in row] for row in tally.peaks])
    np.testing.assert_allclose(found, largest, rtol=1e-4)
    seconds = (square.square > 1.0).sum(axis=-1) / 200.0
    np.testing.assert_allclose(tally.seconds_above.sum(axis=0), seconds, atol=0.05)
    assert tally.at_once == 3
    who = tally.peaks[-1][0].who
    assert {route for route, _, _ in who} == {"way", "other"}
    assert sorted({t for _, t, _ in who}) == [100.0, 100.7, 102.0]
    assert [rms for _, _, rms in who] == sorted((rms for _, _, rms in who), reverse=True)


@pytest.mark.parametrize("part", [37, 500])
def test_parts_of_a_day_leave_no_seam(floor, part, monkeypatch):
    """Read 37 steps at a time, a day is what it is in parts of 4096."""
    layouts = laid(floor, car())
    curves, day = limits(layouts["way"]), departures(10.0, 12.0, 60.0)
    whole = on_one_day(layouts, day, curves, seed=SEED)
    monkeypatch.setattr(superpose, "_PART", part)
    parts = on_one_day(layouts, day, curves, seed=SEED)
    np.testing.assert_allclose(parts.seconds_above, whole.seconds_above, atol=0.011)
    np.testing.assert_array_equal(parts.events, whole.events)
    np.testing.assert_allclose(parts.dose, whole.dose, rtol=1e-9)


def test_empty_hours_are_passed_over_and_hours_are_told_apart(floor):
    """Two passages ten hours apart: two records and their ringing are stepped, each in its hour."""
    layouts = laid(floor, car())
    day = departures(9 * 3600.0 - 3.0, 22.999 * 3600.0)
    tally = on_one_day(layouts, day, limits(layouts["way"]), seed=SEED)
    assert tally.busy == pytest.approx(2 * (LENGTH + 10.0), abs=0.1)
    hours = np.flatnonzero(tally.seconds_above.sum(axis=(1, 2)))
    assert set(hours) <= {8, 9, 22, 23}
    assert {8, 9, 22} & set(hours)
    assert (tally.dose > 0.0).all()  # 22:59:56 runs on into the night


def test_rougher_roads_scale_what_is_random_alone(floor):
    """Twice the elevations by the factor are twice the elevations by the class: B and C."""
    smooth, rough = laid(floor, car()), laid(floor, car(road=RoadClass("C")))
    curves, day = limits(smooth["way"]), departures(10.0, 60.0)
    scaled = on_one_day(smooth, day, curves, seed=SEED, factor=2.0)
    drawn = on_one_day(rough, day, curves, seed=SEED)
    np.testing.assert_allclose(scaled.dose, drawn.dose, rtol=1e-6)
    np.testing.assert_allclose(scaled.seconds_above, drawn.seconds_above, atol=0.011)


def test_what_adding_up_leaves_out_is_told(floor):
    """Coupled, the closest two on a road run together; decoupled nothing is left out."""
    one = car()
    day = departures(10.0, 11.3, 60.0)
    coupled, decoupled = laid(floor, one, kind=Coupled), laid(floor, one)
    assert closest_meeting(coupled, day) == ("way", "way", pytest.approx(1.3))
    error = meeting_error(coupled, day, lay_out_meeting(floor, coupled, day, POINTS), seed=SEED)
    assert 1e-6 < error < 0.2
    settings = {
        "method": Coupled(integration=INTEGRATION), "points": POINTS, "n_runs": 1, "seed": SEED,
        "duration": one.exit_time + 5.0,
    }  # fmt: skip
    later = replace(one, depart=1.3)
    joint, first, second = (
        ensemble(floor, some, **settings).velocity[0] for some in ([one, later], one, later)
    )
    rms = np.sqrt(np.mean((joint - first - second) ** 2, axis=0) / np.mean(joint**2, axis=0))
    assert error == pytest.approx(rms.max(), rel=1e-6)
    assert lay_out_meeting(floor, decoupled, day, POINTS) is None
    assert meeting_error(decoupled, day, None, seed=SEED) == 0.0
    far = departures(10.0, 60.0)
    assert np.isnan(
        meeting_error(coupled, far, lay_out_meeting(floor, coupled, far, POINTS), seed=SEED)
    )


@pytest.mark.longest
def test_a_day_that_is_run_lies_where_it_is_expected(floor):
    """150 passages far apart, beside what 200 other roads let expect: within 99.9 % of chance.

    The roads of the runs that the expectation comes from are of another seed; both scatter.
    """
    layouts = laid(floor, car())
    curves = limits(layouts["way"])
    runs, mean = runs_with_mean(layouts["way"], runs=range(200), seed=77)
    levels = reduce_runs(runs.on_scaled_road(mean, QUIET), curves=curves)
    day = departures(*(30.0 * np.arange(150.0)))
    tally = on_one_day(layouts, day, curves, seed=SEED, factor=QUIET)
    looked_at = 0
    for c, curve in enumerate(curves):
        known = np.isfinite(curve.limits)
        for p in range(2):
            exceeds = (levels.spectra.values[:, p, known] > curve.limits[known]).any(axis=1)
            one = OnePassage(exceeds=exceeds, seconds=levels.above[curve.name][:, p])
            counts = np.zeros(24)
            counts[[0, 1]] = 75.0
            found = expected_day({"way": one}, {"way": counts}, random=False)
            share = exceeds.mean()
            # the chance itself is known to its binomial error of 200 runs
            spread = np.sqrt(150 * share * (1 - share) * (1 + 150 / 200)) + 1.0
            events = tally.events[:, c, p].sum()
            assert abs(events - found.events) < stats.norm.ppf(0.9995) * spread
            looked_at += 0.05 < share < 0.95
            minutes, sd = tally.seconds_above[:, c, p].sum() / 60.0, np.std(one.seconds)
            noise = 150 / 60.0 * sd * np.sqrt(1 / 150 + 1 / 200) + 0.02
            assert abs(minutes - found.minutes) < stats.norm.ppf(0.9995) * noise
    assert looked_at  # some limit is met by some and not by others


def test_doses_of_a_day_are_fourth_powers_added(floor):
    """Two passages far apart: VDV^4 of the day is the sum of theirs."""
    layouts = laid(floor, car())
    curves = limits(layouts["way"])
    tally = on_one_day(layouts, departures(36_000.0, 36_100.0), curves, seed=SEED)
    runs = ensemble(
        floor, car(), method=Decoupled(integration=INTEGRATION), points=POINTS, n_runs=2, seed=SEED,
        duration=LENGTH,
    )  # fmt: skip
    vdv = reduce_runs(runs).vdv
    np.testing.assert_allclose(tally.dose[0], np.sum(vdv**4, axis=0), rtol=1e-4)
    assert (tally.dose[1] == 0.0).all()


def test_nobody_drives_where_somebody_is_already():
    """In a stream who would come within 5 s of the one ahead waits; times that are given do not."""
    crowd = Poisson.through(start=0.0, end=3600.0, rate=600.0, mix={"way": 2.0, "other": 1.0})
    free = Schedule(name="d", streams=(crowd,)).draw(np.random.default_rng(1))
    queued = Schedule(name="d", streams=(crowd,)).draw(
        np.random.default_rng(1), {"way": 5.0, "other": 0.0}
    )
    assert free.counts() == queued.counts()
    ways = [np.sort(d.time[d.which == d.route.index("way")]) for d in (free, queued)]
    assert np.diff(ways[0]).min() < 5.0
    assert np.diff(ways[1]).min() >= 5.0 - 1e-9
    assert (ways[1] >= ways[0] - 1e-9).all()
    first = np.flatnonzero(np.diff(ways[0]) < 5.0)[0]
    np.testing.assert_allclose(ways[1][: first + 1], ways[0][: first + 1])
    known = Schedule(name="d", streams=(Times(route="way", times=np.array([1.0, 2.0])),))
    times = known.draw(np.random.default_rng(1), {"way": 5.0}).time
    np.testing.assert_array_equal(times, [1.0, 2.0])
