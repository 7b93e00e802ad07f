"""What no wave excites, and what a record does not hold to its end, is never passed."""

from dataclasses import replace

import numpy as np
import pytest

from models import small_floor
from trundle.criteria import VC, assess, assess_reduced, class_map, find_criterion
from trundle.machine import Unbalance
from trundle.response import FloorMap, reduce_runs, velocity_spectra
from trundle.road import RoadClass, RoughnessBand
from trundle.route import DriveIn, Route
from trundle.signals import mid_band_frequencies
from trundle.simulate import (
    Coupled,
    Coverage,
    Crossing,
    Modal,
    ModalRatio,
    coverage_of,
    ensemble,
)
from trundle.simulate.sources.machine import Machine
from trundle.units import KMH
from trundle.vehicle import container_truck_40ft

BANDS = mid_band_frequencies()


def crossing(n_max=2.83):
    return Crossing(
        container_truck_40ft(), Route.straight((0.0, 3.0), (12.0, 3.0), speed=15 * KMH),
        RoadClass("A"), band=RoughnessBand(n_min=0.05, n_max=n_max, contact_patch=0.1),
        entry=DriveIn(length=2.0),
    )  # fmt: skip


def runs(n_max=2.83, duration=None):
    method = Coupled(integration=Modal(f_max=112.0, dt=0.005), damping=ModalRatio(ratio=0.05))
    return ensemble(
        small_floor(mesh_size=1.5), crossing(n_max), method=method, points={"p": (6.0, 5.0)},
        n_runs=3, seed=1, duration=duration,
    )  # fmt: skip


def test_a_band_is_excited_where_its_upper_edge_is():
    """2.83 cycle/m at 15 km/h end at 11.79 Hz: the 10 Hz band ends at 11.2, that of 12.5 at 14.1."""
    reach = Coverage(excited_to=2.83 * 15 * KMH)
    assert BANDS[reach.excites(BANDS)].max() == pytest.approx(10.0)
    assert Coverage(excited_to=90.0).excites(BANDS).all()


@pytest.mark.parametrize(("n_max", "assessed"), [(2.83, False), (22.0, True)])
def test_verdicts_need_the_waves_of_all_their_bands(n_max, assessed):
    """The same quiet truck: without waves above 11.8 Hz nothing can be passed; with them it can."""
    for name in ("office", "precision-isolated"):
        curve = find_criterion(name)
        soft = replace(curve, limits=1e3 * curve.limits)  # met by far, if it is assessed
        (verdict,) = assess(runs(n_max), soft)
        assert verdict.status == ("pass" if assessed else "not assessed")
        assert bool(verdict.unexcited) is not assessed
        assert verdict.margin > 1.0
        if not assessed:
            assert "waves end at 11.8 Hz" in verdict.reasons[0]
        if curve.quantity == "band_rms_velocity":
            assert verdict.governing_band < (80.0 if assessed else 11.3)
    if not assessed:
        assert verdict.unexcited == (80.0,)


def test_a_record_that_ends_before_the_last_wheel_has_left_passes_nothing():
    """12 m of route and 12.5 m of truck at 15 km/h, entered over 2 m: the last wheel leaves at
    (12 + 12.5) / 4.1667 = 5.88 s, the first already at 2.88 s."""
    curve = find_criterion("office")
    soft = replace(curve, limits=1e3 * curve.limits)
    leaves = (12.0 + container_truck_40ft().length) / (15 * KMH)
    for duration, status in ((4.0, "not assessed"), (leaves + 1.0, "pass")):
        (verdict,) = assess(runs(22.0, duration), soft)
        assert verdict.status == status
        assert ("last wheel" in "".join(verdict.reasons)) is (status != "pass")
    assert runs(22.0, 4.0).coverage.leaves == pytest.approx(leaves)


def test_a_map_passes_no_class_without_waves():
    """Levels far below every limit: with waves the strictest class, without them none is known."""
    made = FloorMap(
        places=np.zeros((2, 2)), mid_band=BANDS, resolved=np.full(20, True), averaging="max_1s",
        band_levels=np.full((3, 2, 20), 1e-9),
        numbers={name: np.zeros((3, 2)) for name in ("rms_velocity", "peak_acceleration")},
    )  # fmt: skip
    for reach, expected in (
        (Coverage(excited_to=90.0), len(VC) - 1),
        (Coverage(excited_to=11.8), -2),
        (Coverage(leaves=9.0, ends=6.0), -2),
    ):
        found = class_map(made, VC, percentile=50.0, f_max=90.0, coverage=reach)
        assert set(found.classes()) == {expected}
        assert np.isfinite(found.margin).all()
    louder = replace(made, band_levels=np.where(BANDS > 40.0, 1e-3, made.band_levels))
    quiet = class_map(louder, VC, f_max=90.0, coverage=Coverage(excited_to=11.8))
    assert quiet.margin.min() > 1e3  # of bands that nothing excites no margin is made
    some = Coverage(excited_to=11.8, partly_to=90.0)  # a truck's road ends, a pump goes on
    failed = class_map(louder, VC, f_max=90.0, coverage=some)
    assert failed.margin.max() < 1.0
    assert failed.governing_band.min() > 40.0
    faint = replace(made, band_levels=np.where(BANDS > 40.0, 1e-8, made.band_levels))
    hushed = class_map(faint, VC, f_max=90.0, coverage=some)
    assert not any(hushed.complete)
    assert (hushed.governing_band < 11.8).all()  # what is not all of a band passes nothing
    none = class_map(faint, VC, f_max=90.0, coverage=Coverage(excited_to=0.5, partly_to=90.0))
    assert np.isnan(none.margin).all()
    assert np.isnan(none.governing_band).all()
    assert set(none.classes()) == {-2}


def test_the_interval_of_a_margin_holds_it():
    """Margin = limit / level, so its interval is that of the level, turned over."""
    found = runs(22.0)
    many = replace(
        found,
        **{
            name: np.concatenate([k * getattr(found, name) for k in np.linspace(0.5, 2.0, 40)])
            for name in ("displacement", "velocity", "acceleration", "contact_forces")
        },
    )
    (verdict,) = assess(many, find_criterion("office"), percentile=50.0)
    low, high = verdict.interval
    assert 0.0 < low < verdict.margin < high < np.inf
    sure = replace(verdict, status="pass", margin=2.0, interval=(0.9, 3.0))
    assert sure.uncertain
    assert "not surely" in str(sure)
    assert "vertical" in str(sure)


def test_a_pump_beside_a_truck_whose_road_ends_can_fail_and_not_pass():
    """Between the truck's last wave and the pump's line a level is a lower bound.

    A 12 Hz rotor on the floor lies in the 12.5 Hz band, which the truck's waves do not reach:
    alone it is assessed there; beside the truck it fails there if it does alone.
    """
    loud = Machine(
        name="pump", feet=np.array([[8.0, 4.0]]),
        force=Unbalance(mass_radius=1.0, frequency=12.0),
    )  # fmt: skip
    truck = runs(2.83)
    alone, both = (coverage_of(some, 20.0) for some in ([loud], [crossing(2.83), loud]))
    band = np.array([10**1.1])
    assert alone.excites(band).all()
    assert not both.excites(band).any()
    assert both.excites_partly(band).all()
    assert not truck.coverage.excites_partly(band).any()
    at = int(np.abs(BANDS - band).argmin())
    for level, status, governing in ((1e-3, "fail", band[0]), (1e-6, "not assessed", None)):
        spectra = velocity_spectra(truck)
        values = np.where(np.arange(20) == at, level, 1e-9) + 0.0 * spectra.values
        reduced = replace(reduce_runs(truck), spectra=replace(spectra, values=values))
        (verdict,) = assess_reduced(
            reduced, find_criterion("VC-A"), percentile=50.0, f_resolved=80.0, coverage=both
        )
        assert verdict.status == status
        if governing is not None:
            assert verdict.governing_band == pytest.approx(governing)
