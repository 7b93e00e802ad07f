"""The sentence that comes first: what is met, what is exceeded, and what nobody can say."""

from dataclasses import replace

import numpy as np
import pytest

from trundle.criteria import VC, find_criterion
from trundle.records.assess import assess_record
from trundle.signals import Record
from trundle.views.record_answer import answers, light, lights


def result_of(rms=30e-6, *, fs=400.0, seconds=20.0, criteria=VC, axes=("vertical",), clipped=None):
    """A tone of 10 Hz, the middle of a third octave; one channel for each axis."""
    t = np.arange(round(seconds * fs)) / fs
    row = np.sqrt(2.0) * rms * np.sin(2.0 * np.pi * 10.0 * t + 0.1)
    row = row if clipped is None else np.clip(row, -clipped, clipped)
    names = tuple(f"c{i}" for i in range(len(axes)))
    record = Record(
        samples=np.tile(row, (len(axes), 1)), sampling_frequency=fs, quantity="velocity",
        channel_names=names, axes=axes,
    )  # fmt: skip
    return assess_record(record, criteria)


def test_the_strictest_curve_met_and_the_first_exceeded():
    """30 um/s: VC-A (50 um/s) is met with 1.67, VC-B (25 um/s) exceeded at 0.833."""
    (one,) = answers(result_of())
    assert (one.met, one.status) == ("VC-A", "pass")
    assert one.margin == pytest.approx(50.0 / 30.0, rel=0.01)
    assert one.governing_band == pytest.approx(10.0)
    assert one.words.startswith("channel c0: VC-A is met with margin 1.6")
    assert "governing 10 Hz; VC-B is exceeded (margin 0.83" in one.words
    assert np.isnan([one.below, one.above]).all()
    assert "not assessed" not in one.words


def test_a_curve_that_is_not_shown_to_its_end_is_not_met():
    """170 Hz shows bands to 63 Hz: every curve reaches 80 Hz, so that none is surely met."""
    (one,) = answers(result_of(fs=170.0))
    assert (one.met, one.status) == ("", "not assessed")
    assert one.words.startswith(
        "channel c0: no criterion is surely met; in what the record shows VC-A has margin 1.6"
    )
    assert one.above == 63.0
    assert one.words.count("not assessed above 63 Hz") == 1
    assert "VC-B is exceeded" in one.words
    assert "shorten dt" not in one.words  # advice for computations


def test_a_short_record_says_below_what_nothing_is_assessed():
    """5 s hold 8 periods of 1.6 Hz; VC-C asks from 1 Hz on."""
    (one,) = answers(result_of(5e-6, seconds=5.1, criteria=[find_criterion("VC-C")]))
    assert one.status == "not assessed"
    assert one.below == 1.6
    assert "not assessed below 1.6 Hz" in one.words


def test_none_met_says_which_is_nearest_and_nothing_assessed_says_why():
    """2 mm/s exceeds the workshop's 0.8 mm/s; a vertical limit says nothing of level motion."""
    (one,) = answers(result_of(2e-3))
    assert one.status == "fail"
    assert one.words.startswith(
        "channel c0: none of 9 criteria is met; Workshop is exceeded, margin 0.4"
    )
    vertical = replace(find_criterion("VC-A"), axis="vertical")
    (one,) = answers(result_of(criteria=[vertical], axes=("horizontal",)))
    assert one.status == "not assessed"
    assert one.words == "channel c0: nothing is assessed (the channel is horizontal)"
    (one,) = answers(result_of(criteria=[]))
    assert "no criterion was asked for" in one.words


def test_a_channel_in_doubt_says_so():
    (one,) = answers(result_of(clipped=30e-6))
    assert one.status == "not assessed"
    assert "the channel is clipped or hides a gap" in one.words


def test_other_limits_are_counted_behind_the_class():
    """Peak of 30 sqrt 2 um/s at 10 Hz: 0.267 gal fails 0.07 gal."""
    curves = [find_criterion("VC-A"), find_criterion("electron-microscope-vertical")]
    (one,) = answers(result_of(criteria=curves))
    assert one.met == "VC-A"
    assert (
        "of 1 other limit 0 met, 1 exceeded (Electron microscope, vertical, margin 0.26"
        in one.words
    )


def test_the_table_has_a_verdict_for_every_channel_and_curve_in_words():
    """Signs and words beside the colour; rows in the order of curves, columns of channels."""
    result = result_of(criteria=[VC[4], VC[5]], axes=("vertical", "horizontal"))
    table = lights(result)
    assert [title for title, _ in table] == ["VC-A", "VC-B"]
    for _, verdicts in table:
        assert [v.point for v in verdicts] == ["c0", "c1"]
    assert light(table[0][1][0]).startswith("\N{CHECK MARK} pass 1.6")
    assert light(table[1][1][1]).startswith("\N{BALLOT X} fail 0.83")
    (_, (unknown,)), *_ = lights(result_of(fs=170.0))
    assert light(unknown) == "\N{EN DASH} not assessed"
