"""What is said of a record: verdicts in order, margins by hand, doubts that take a pass away."""

from dataclasses import replace

import numpy as np
import pytest

from studies import GOOD
from trundle.criteria import VC, find_criterion
from trundle.errors import InputError
from trundle.records.assess import assess_record, read_simulated
from trundle.results.cells import CellKey
from trundle.results.store import write_results
from trundle.run.whole_study import run_study
from trundle.signals import Record
from trundle.study_file import study_from_text

FS = 400.0
T = np.arange(0.0, 30.0, 1.0 / FS)
EASE = np.clip(np.minimum(T, 30.0 - T) / 5.0, 0.0, 1.0)
TONE = np.sqrt(2.0) * EASE * np.sin(2.0 * np.pi * 10.0 * T)  # RMS 1 at 10 Hz, the middle of a band


def record(*rows, names, quantity="velocity", axes=None, source="r.csv"):
    return Record(
        samples=np.stack(rows), sampling_frequency=FS, quantity=quantity, channel_names=names,
        axes=axes or ("vertical",) * len(names), source=source,
    )  # fmt: skip


def test_verdicts_stand_by_channel_and_then_by_criterion_with_margins_by_hand():
    """Between 8 and 80 Hz VC-A allows 50 um/s and VC-C 12.5: 25 and 5 um/s have 2, 0.5, 10, 2.5."""
    made = record(25e-6 * TONE, 5e-6 * TONE, names=("a", "b"))
    found = assess_record(made, [find_criterion("VC-A"), find_criterion("VC-C")]).verdicts
    assert [(v.point, v.criterion.name, v.status) for v in found] == [
        ("a", "VC-A", "pass"), ("a", "VC-C", "fail"), ("b", "VC-A", "pass"), ("b", "VC-C", "pass"),
    ]  # fmt: skip
    # a filter of a third octave and the fade cost less than 2 %
    assert [v.margin for v in found] == pytest.approx([2.0, 0.5, 10.0, 2.5], rel=0.02)
    assert {v.governing_band for v in found} == {10.0}


def test_a_peak_is_that_of_the_samples():
    """5 mm/s2 at 10 Hz against limits in gal (1 gal = 10 mm/s2): margin = limit / 0.5 gal."""
    made = record(5e-3 * TONE / np.sqrt(2.0), names=("z",), quantity="acceleration")
    curve = replace(
        find_criterion("VC-A"), name="P", title="P", quantity="peak_acceleration",
        frequencies=np.array([1.0, 80.0]), limits=np.array([0.01, 0.01]), aliases=(),
    )  # fmt: skip
    (verdict,) = assess_record(made, [curve]).verdicts
    assert verdict.margin == pytest.approx(2.0, rel=0.01)
    assert verdict.status == "pass"


def test_a_clipped_channel_takes_no_pass_from_the_sound_one_beside_it():
    """Same tone, cut at half its crest in one: that one alone passes nothing, and says why."""
    low = 1e-6 * TONE
    made = record(low, np.clip(low, -0.6e-6, 0.6e-6), names=("sound", "cut"))
    sound, cut = assess_record(made, [find_criterion("VC-A")]).verdicts
    assert (sound.status, cut.status) == ("pass", "not assessed")
    assert sound.reasons == ()
    assert "the channel is clipped or hides a gap" in cut.reasons[-1]
    assert cut.margin > 1.0  # the level is told all the same


@pytest.mark.parametrize(
    ("limit", "ok"), [(0.05, True), (0.5, True), (0.049, False), (0.51, False)]
)
def test_the_high_pass_has_both_ends_of_its_range(limit, ok):
    """At 0.5 Hz the 1 Hz band, from 0.89 Hz, is still whole; below 0.05 Hz drift stays in."""
    made = record(1e-6 * TONE, names=("z",))
    if ok:
        assert assess_record(made, VC, high_pass=limit).high_pass == limit
        return
    with pytest.raises(InputError, match=f"0.05 Hz to 0.5 Hz at most; got {limit:g} Hz"):
        assess_record(made, VC, high_pass=limit)


def test_a_record_held_against_nothing_passes_nothing():
    """No criterion, no verdict; levels are there, and the line says that none was asked for."""
    result = assess_record(record(1e-6 * TONE, names=("z",)), [])
    assert result.verdicts == ()
    assert "held against nothing" in repr(result)
    assert "pass" not in result._repr_html_()


def test_names_of_channels_and_files_are_no_html():
    """``<script>`` in a file's heading is shown as it stands, in a notebook as in the report."""
    made = record(25e-6 * TONE, names=("<script>x</script>",), source='"a"&<b>.csv')
    result = assess_record(made, [find_criterion("VC-A")])
    page = result._repr_html_()
    assert "<script>" not in page
    assert "&lt;script&gt;x&lt;/script&gt;" in page
    assert "&amp;&lt;b&gt;.csv" in page
    assert "<td>pass</td>" in page
    assert "<td>2" in page or "<td>1.9" in page
    assert repr(result).startswith("<RecordResult of '\"a\"&<b>.csv', <script>")


TWO = (
    GOOD.replace('[[point]]\nname = "tool"', '[[point]]\nname = "größe, B"\nat = ["9 m", "3 m"]\n\n'
                 '[[point]]\nname = "tool"')
    .replace('class = "B"', 'class = "A"\n\n[[road]]\nclass = "C"')
    .replace("[criteria]", '[[method]]\nname = "late"\ninteraction = "decoupled"\nf_max = "20 Hz"\n'
             'dt = "5 ms"\ndamping = { ratio = "8 %" }\n\n[criteria]')
)  # fmt: skip


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """Two points, two roads and two methods in a store; and what was computed."""
    folder = tmp_path_factory.mktemp("stored")
    result = run_study(study_from_text(TWO))
    write_results(result, folder)
    return folder, result


@pytest.mark.parametrize(("point", "column"), [(None, 0), ("größe, B", 0), ("tool", 1)])
def test_each_simulated_curve_is_that_of_its_road_point_and_last_method(stored, point, column):
    """Percentiles of the runs themselves, cell by cell; the first point unless one is named."""
    folder, result = stored
    found = read_simulated(folder, point=point)
    name = point or "größe, B"
    assert [one.title for one in found] == [f"main, class {road}, {name}" for road in "AC"]
    for one, road in zip(found, "AC", strict=True):
        spectra = result.cells[CellKey("main", road, "late")].spectra
        wanted = np.percentile(spectra.values[:, column], [5.0, 50.0, 95.0], axis=0)
        np.testing.assert_allclose(one.levels, wanted, rtol=1e-12)
        np.testing.assert_allclose(one.mid_band, spectra.mid_band)
    assert not np.allclose(found[0].levels, found[1].levels, rtol=0.1)


def test_levels_of_another_rule_or_point_are_not_laid_beside(stored):
    """A maximum of 1 s and an event's mean are several times apart; the way out is named."""
    folder, _ = stored
    with pytest.raises(InputError, match=r"averaged by max_1s, .* say --averaging max_1s"):
        read_simulated(folder, averaging="event")
    with pytest.raises(InputError, match="no point 'Tool'; there are größe, B, tool"):
        read_simulated(folder, point="Tool")
    with pytest.raises(InputError, match="no point ''"):
        read_simulated(folder, point="")
    with pytest.raises(InputError, match=r"is no results folder of trundle"):
        read_simulated(folder / "results.zarr")


def test_what_is_laid_beside_stays_with_the_result(stored):
    """The curves change no verdict; they are there for the figure."""
    folder, _ = stored
    curves = read_simulated(folder)
    made = record(25e-6 * TONE, names=("z",))
    with_curves, without = (assess_record(made, VC, simulated=s) for s in (curves, ()))
    assert with_curves.simulated == curves
    assert [v.margin for v in with_curves.verdicts] == [v.margin for v in without.verdicts]
