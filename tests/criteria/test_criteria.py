"""Criteria against their published values, and the logic of a verdict."""

import numpy as np
import pytest

from trundle.criteria import VC, Criterion, all_criteria, assess, best_class, find_criterion
from trundle.errors import InputError
from trundle.simulate import Runs


def sine_runs(
    f: float, amplitude: float, *, dt: float = 0.0025, n_runs: int = 3, f_max: float = np.inf
) -> Runs:
    """A velocity sine [m/s] at one point for 20 s, the runs 1, 2, 3 ... times as strong."""
    t = dt * np.arange(round(20.0 / dt))
    ease = np.clip(np.minimum(t, 20 - t) / 4, 0, 1)  # a sudden start is a broadband event
    sine = ease**2 * (3 - 2 * ease) * np.sin(2 * np.pi * f * t)
    v = amplitude * np.arange(1, n_runs + 1)[:, None, None] * sine[None, :, None]
    a = 2 * np.pi * f * v
    return Runs(
        time=t, displacement=v, velocity=v, acceleration=a, contact_forces=np.zeros((n_runs, len(t), 1)),
        point_names=("p",), contact_names=("c",), seed=0, method="made", f_max=f_max,
    )  # fmt: skip


def test_the_nine_levels():
    """Levels 1 to 9 in um/s (Pan, Mita and Li 2001; Ungar et al. 1990)."""
    at_20_hz = [float(c.limit(np.array([20.0]))[0]) * 1e6 for c in VC]
    assert at_20_hz == pytest.approx([800, 400, 200, 100, 50, 25, 12.5, 6.25, 3.12])
    for i, criterion in enumerate(VC):
        assert find_criterion(f"level {i + 1}") is criterion
    assert find_criterion("Class II").name == "VC-B"


def test_shapes_below_8_hz():
    """Rising as 8 / f down to 4 Hz and no criterion below it; VC-C and stricter flat to 1 Hz."""
    f = np.array([1.0, 4.0, 5.0, 6.3, 8.0])
    a = find_criterion("VC-A").limit(f) * 1e6
    assert np.isnan(a[0])
    assert a[1:] == pytest.approx([100.0, 80.0, 50 * 8 / 6.3, 50.0])
    assert find_criterion("VC-C").limit(f) * 1e6 == pytest.approx(12.5)
    flat = find_criterion("VC-A").flattened()
    assert flat.limit(f) * 1e6 == pytest.approx(50.0)


def test_acceleration_limits():
    limits = {c.name: c.limits[0] for c in all_criteria() if c.quantity == "peak_acceleration"}
    assert limits == {
        "electron-microscope-vertical": 0.0007,
        "electron-microscope-horizontal": 0.0005,
        "precision-isolated": 0.003,
        "stepper-B": 0.001,
    }


def test_every_criterion_says_where_it_is_from():
    for criterion in all_criteria():
        assert len(criterion.source) > 20
        assert criterion.confidence


def test_a_sine_is_held_against_the_curves():
    """40 um/s RMS at 10 Hz in run 1, 80 and 120 in runs 2 and 3; the median is 80."""
    runs = sine_runs(10.0, 40e-6 * np.sqrt(2))
    verdicts = assess(runs, VC, percentile=50.0)
    by_name = {v.criterion.name: v for v in verdicts}
    assert by_name["operating-theatre"].status == "pass"
    assert by_name["operating-theatre"].margin == pytest.approx(100 / 80, rel=0.01)
    assert by_name["VC-A"].status == "fail"
    assert by_name["VC-A"].governing_band == pytest.approx(10.0)
    assert by_name["VC-A"].share_exceeding == pytest.approx(2 / 3)
    assert by_name["operating-theatre"].share_exceeding == pytest.approx(1 / 3)
    assert best_class(verdicts) == "operating-theatre"


def test_what_was_not_computed_is_not_a_pass():
    """At 25 ms bands above 16 Hz are missing: a quiet floor is not assessed, a loud one fails."""
    quiet = assess(sine_runs(5.0, 1e-9, dt=0.025), find_criterion("VC-A"))[0]
    assert quiet.status == "not assessed"
    assert quiet.unresolved == (20.0, 25.0, 31.5, 40.0, 50.0, 63.0, 80.0)
    assert quiet.margin > 1
    loud = assess(sine_runs(10.0, 1e-3, dt=0.025), find_criterion("VC-A"))[0]
    assert loud.status == "fail"
    cut = assess(sine_runs(10.0, 1e-9, f_max=40.0), find_criterion("VC-A"))[0]
    assert cut.status == "not assessed"


def test_peaks_against_gal():
    """0.05 gal at 2 Hz passes the electron microscope's 0.07 in run 1 and fails in run 2."""
    runs = sine_runs(2.0, 0.0005 / (4 * np.pi), n_runs=2)
    low = assess(runs, find_criterion("electron-microscope-vertical"), percentile=0.0)[0]
    high = assess(runs, find_criterion("electron-microscope-vertical"), percentile=100.0)[0]
    assert (low.status, high.status) == ("pass", "fail")
    assert low.margin == pytest.approx(1.4, rel=1e-3)
    assert high.share_exceeding == 0.5
    sideways = assess(runs, find_criterion("electron-microscope-horizontal"))[0]
    assert sideways.status == "not assessed"


def test_unknown_criteria_are_named():
    with pytest.raises(InputError, match="no criterion 'VC-Z'; there are"):
        find_criterion("VC-Z")


@pytest.mark.parametrize(
    ("f", "limits"), [([1.0], [1.0]), ([2.0, 1.0], [1.0, 1.0]), ([1.0, 2.0], [1.0, 0.0])]
)
def test_bad_curves_are_refused(f, limits):
    with pytest.raises(InputError, match="must"):
        Criterion(
            name="x", title="x", quantity="band_rms_velocity", frequencies=np.array(f),
            limits=np.array(limits), axis="vertical", averaging="max_1s", source="s", confidence="c",
        )  # fmt: skip


def test_a_quiet_peak_does_not_pass_beyond_what_was_computed():
    """The microscope's limit is for all frequencies: modes to 20 Hz cannot say that it is met."""
    runs = sine_runs(5.0, 1e-9, f_max=20.0)
    verdict = assess(runs, find_criterion("electron-microscope-vertical"))[0]
    assert verdict.status == "not assessed"
