"""What is said of a record: single numbers of a sine by hand, levels by band, verdicts with reasons."""

import json
from dataclasses import replace

import numpy as np
import pytest

from made_results import curve
from trundle.records.assess import assess_record
from trundle.signals import Record
from trundle.views.record import level_rows, record_rows, record_summary

FS = 500.0
CURVE = curve("Kurve", limits=np.array([1e-3, 1e-3]))
SIDE = curve("seitlich", axis="horizontal")


@pytest.fixture(scope="module")
def result():
    """Two sines of 8 Hz for 16 s: 0.1 m/s2 at the first channel, 0.02 m/s2 at the second."""
    time = np.arange(int(16 * FS)) / FS
    wave = np.sin(2 * np.pi * 8.0 * time) * np.hanning(len(time)) ** 0.1
    record = Record(
        samples=np.array([0.1 * wave, 0.02 * wave]), sampling_frequency=FS, quantity="acceleration",
        channel_names=("Käfig, <b>", "=z"), source="Messung, 1.csv", axes=("vertical", ""),
    )  # fmt: skip
    return assess_record(record, [CURVE, SIDE])


def test_numbers_of_a_sine_are_those_of_its_formulas(result):
    """0.1 m/s2 is 10 gal; its velocity has an RMS of a / (2 pi 8 sqrt 2) = 1407 um/s, crest sqrt 2.

    The ends fade, which takes from an RMS over the record what the window's square leaves out of
    1 (a factor of 0.89), and nothing from a peak. Wb passes 8 Hz within some percent, so that R is
    about 0.0707 / 0.005 = 14.
    """
    fade = np.sqrt(np.mean(np.hanning(int(16 * FS)) ** 0.2))
    first, second = record_rows(result)
    assert (first["channel"], second["channel"]) == ("Käfig, <b>", "=z")
    assert first["peak_gal"] == pytest.approx(10.0, rel=0.01)
    assert second["peak_gal"] == pytest.approx(2.0, rel=0.01)
    assert first["rms_um_s"] == pytest.approx(1407.0 * fade, rel=0.01)
    assert first["crest_factor"] == pytest.approx(np.sqrt(2.0) / fade, rel=0.01)
    assert first["response_factor"] == pytest.approx(14.1, rel=0.1)
    assert first["response_factor"] == pytest.approx(5.0 * second["response_factor"])
    assert 0.0 < first["peak_time_s"] < 16.0


def test_levels_stand_by_band_and_channel(result):
    """The 8 Hz band holds 1407 um/s of the first, a fifth of it of the second; bands by their names."""
    headings, rows = level_rows(result)
    assert headings == ["band_hz", "Käfig, <b> [um/s]", "=z [um/s]"]
    assert [row[0] for row in rows][:6] == ["1", "1.25", "1.6", "2", "2.5", "3.15"]
    (band,) = (row for row in rows if row[0] == "8")
    assert float(band[1]) == pytest.approx(1407.0, rel=0.02)
    assert float(band[2]) == pytest.approx(1407.0 / 5.0, rel=0.02)
    far = next(row for row in rows if row[0] == "31.5")
    assert float(far[1]) < 0.01 * 1407.0


def test_a_band_that_is_not_known_is_an_empty_cell(result):
    """Nothing stands for NaN: a 0 would be a level that was met."""
    spectra = result.reduced.spectra
    values = spectra.values.copy()
    values[0, 1, 9] = np.nan
    lost = replace(result, reduced=replace(result.reduced, spectra=replace(spectra, values=values)))
    (band,) = (row for row in level_rows(lost)[1] if row[0] == "8")
    assert band[2] == ""
    assert float(band[1]) > 0.0


def test_verdicts_are_told_with_what_they_are_of(result):
    """1407 um/s beside 1000: failed at 0.71; a fifth of that passes; sideways nothing is known."""
    summary = record_summary(result)
    json.dumps(summary, allow_nan=True)
    found = {(v["channel"], v["criterion"]): v for v in summary["verdicts"]}
    loud = found["Käfig, <b>", "Kurve"]
    assert loud["verdict"] == "fail"
    assert loud["margin"] == pytest.approx(1000.0 / 1407.0, rel=0.02)
    assert loud["governing_band_hz"] == pytest.approx(10**0.9)
    assert loud["value_si"] == pytest.approx(1407e-6, rel=0.02)
    assert loud["limit_si"] == 1e-3
    assert loud["reasons"] == []
    assert found["=z", "Kurve"]["verdict"] == "pass"
    unknown = found["Käfig, <b>", "seitlich"]
    assert (unknown["verdict"], unknown["axis"]) == ("not assessed", "horizontal")
    assert unknown["reasons"] == ["the channel is vertical"]
    assert (summary["source"], summary["averaging"], summary["high_pass_hz"]) == (
        "Messung, 1.csv",
        "max_1s",
        0.5,
    )
    assert len(summary["channels"]) == 2
