"""A measured record in pictures and on its page: tones whose levels are known in closed form."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from hand_made import BANDS, Page

from trundle.criteria import find_criterion
from trundle.records.assess import Simulated, assess_record
from trundle.report import write_record_report
from trundle.report.figures import record as figures
from trundle.report.pages.record import record_page
from trundle.signals import Record
from trundle.units import MICROMETRE_PER_SECOND

RATE = 400.0
TIME = np.arange(0.0, 16.0, 1.0 / RATE)
FADE = np.clip(np.minimum(TIME, TIME[-1] - TIME) / 3.0, 0.0, 1.0)
NAMES = ("<b>Tisch Z", "Ständer & Y")
TONES = ((10.0, 40e-6), (20.0, 8e-6))
"""Frequency [Hz] and amplitude of velocity [m/s] of each channel."""
CURVES = ("VC-A", "VC-B", "VC-E", "electron-microscope-vertical", "electron-microscope-horizontal")


def record_of(tones=TONES, names=NAMES, axes=("vertical", "horizontal")):
    samples = np.array([a * FADE * np.sin(2.0 * np.pi * f * TIME) for f, a in tones])
    return Record(
        samples=samples, sampling_frequency=RATE, quantity="velocity", channel_names=names,
        source="Prüf <stand>.csv", axes=axes,
    )  # fmt: skip


@pytest.fixture(scope="module")
def result():
    return assess_record(record_of(), [find_criterion(name) for name in CURVES])


@pytest.fixture(scope="module")
def page(result):
    return Page(record_page(result, []))


def line_named(axes, name):
    (line,) = [line for line in axes.lines if line.get_label() == name]
    return line


def test_levels_of_tones_are_drawn_where_they_are(result):
    """A steady tone of amplitude A has the RMS A / sqrt(2) in its own band, and hardly any beside."""
    (axes,) = figures.record_spectra_figure(result).axes
    for name, (f, amplitude) in zip(NAMES, TONES, strict=True):
        bands, levels = line_named(axes, name).get_data()
        own = int(np.argmin(np.abs(np.log(bands / f))))
        assert levels[own] == pytest.approx(1e6 * amplitude / np.sqrt(2.0), rel=0.02)
        assert np.nanargmax(levels) == own
    assert "um/s" in axes.get_ylabel()
    assert "largest 1 s average" in axes.get_ylabel()
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert axes.get_title() == "measured levels"


def test_velocity_curves_are_drawn_and_limits_on_peaks_are_not(result):
    """Three of five criteria are of band velocity: each black, with its title at its end."""
    (axes,) = figures.record_spectra_figure(result).axes
    black = [line for line in axes.lines if line.get_color() == "black"]
    assert len(black) == 3
    for line, name in zip(black, CURVES[:3], strict=True):
        curve = find_criterion(name)
        np.testing.assert_allclose(line.get_xdata(), curve.frequencies)
        np.testing.assert_allclose(line.get_ydata(), curve.limits / MICROMETRE_PER_SECOND)
    assert [text.get_text() for text in axes.texts] == ["VC-A", "VC-B", "VC-E"]


def test_histories_are_velocity_and_its_derivative(result):
    """v in um/s and a = v' in gal: amplitudes 40 um/s and 2 pi 10 Hz x 40 um/s = 0.2513 gal."""
    figure = figures.record_history_figure(result)
    assert [axes.get_ylabel() for axes in figure.axes] == ["v [um/s]", "a [gal]"] * 2
    assert [axes.get_title(loc="left") for axes in figure.axes[::2]] == list(NAMES)
    for (upper, lower), (f, amplitude) in zip(
        (figure.axes[:2], figure.axes[2:]), TONES, strict=True
    ):
        velocity, running = upper.lines
        (acceleration,) = lower.lines
        assert np.abs(velocity.get_ydata()).max() == pytest.approx(1e6 * amplitude, rel=0.02)
        assert np.max(running.get_ydata()) == pytest.approx(1e6 * amplitude / 2**0.5, rel=0.02)
        peak = 100.0 * 2.0 * np.pi * f * amplitude
        assert np.abs(acceleration.get_ydata()).max() == pytest.approx(peak, rel=0.02)
    assert figure.axes[-1].get_xlabel() == "time [s]"


def test_simulations_lie_behind_in_their_own_range(result):
    """A band from 5 to 95 %, a dashed median with its title; as many as are drawn are told."""
    levels = np.array([1.0, 2.0, 5.0])[:, None] * np.full(len(BANDS), 1e-6)
    one = Simulated(title="main, <b>class B", mid_band=BANDS, levels=levels)
    (axes,) = figures.record_spectra_figure(replace(result, simulated=(one,))).axes
    median = line_named(axes, "simulated: main, <b>class B")
    np.testing.assert_allclose(median.get_ydata(), 2.0)
    assert median.get_linestyle() == "--"
    (band,) = axes.collections
    heights = band.get_paths()[0].vertices[:, 1]
    assert (heights.min(), heights.max()) == (pytest.approx(1.0), pytest.approx(5.0))
    assert axes.get_title() == "measured levels, on simulated 5-95 %"
    many = tuple(replace(one, title=f"case {i}") for i in range(8))
    (axes,) = figures.record_spectra_figure(replace(result, simulated=many)).axes
    assert len(axes.collections) == 6
    assert axes.get_title().endswith("of the first 6 of 8 cases")


def test_verdicts_stand_in_the_row_of_their_channel_and_axis(page, result):
    """By hand: 40 / sqrt(2) = 28.3 um/s at 10 Hz passes VC-A (50) and fails VC-B (25) and VC-E (3.12).

    The other channel, 5.66 um/s at 20 Hz, passes both of them; peaks 0.251 gal fail 0.07 gal.
    """
    rows = {(row["channel"], row["criterion"]): row for row in page.rows("verdict")}
    assert len(rows) == 2 * len(CURVES)
    first, second = NAMES
    told = {
        (first, "VC-A"): ("pass", 50.0 / 28.284, "10"),
        (first, "VC-B"): ("fail", 25.0 / 28.284, "10"),
        (first, "VC-E"): ("fail", 3.12 / 28.284, "10"),
        (second, "VC-B"): ("pass", 25.0 / 5.657, "20"),
        (second, "VC-E"): ("fail", 3.12 / 5.657, "20"),
        (first, "Electron microscope, vertical"): ("fail", 0.07 / 0.25133, ""),
        (second, "Electron microscope, horizontal"): ("fail", 0.05 / 0.100531, ""),
    }
    for key, (status, margin, band) in told.items():
        assert rows[key]["verdict"] == status
        assert float(rows[key]["margin"]) == pytest.approx(margin, rel=0.03)
        assert rows[key]["governing band [Hz]"] == band
    assert {rows[first, "VC-A"]["axis"], rows[second, "VC-B"]["axis"]} == {"vertical", "horizontal"}


def test_a_limit_on_another_axis_is_not_assessed_and_says_why(page):
    """A vertical limit on a channel that moves sideways: no margin, no band, and the reason."""
    rows = {(row["channel"], row["criterion"]): row for row in page.rows("verdict")}
    row = rows[NAMES[1], "Electron microscope, vertical"]
    assert row["verdict"] == "not assessed"
    assert row["margin"] == ""
    assert row["governing band [Hz]"] == ""
    assert row["why not assessed"] == "the channel is horizontal"
    assert all(
        not row["why not assessed"] for row in rows.values() if row["verdict"] != "not assessed"
    )


def test_colours_of_verdicts_are_those_of_their_words(page):
    """Class pass where it says pass, fail where it says fail, and neither where nothing is known."""
    words, looks = page.tables["verdict"][0], page.classes["verdict"][0]
    at = words[0].index("verdict")
    for row, look in zip(words[1:], looks[1:], strict=True):
        expected = {"pass": "text pass", "fail": "text fail", "not assessed": "text"}
        assert look[at].strip() == expected[row[at]]


def test_single_numbers_are_in_the_units_of_their_headings(page):
    """Peak 2 pi f A in gal; RMS over 16 s: A^2 / 2 times the share of the faded envelope squared."""
    rows = page.rows("numbers")
    assert [row["channel"] for row in rows] == list(NAMES)
    for row, (f, amplitude) in zip(rows, TONES, strict=True):
        peak = 100.0 * 2.0 * np.pi * f * amplitude
        assert float(row["peak acceleration [gal]"]) == pytest.approx(peak, rel=0.02)
        rms = 1e6 * amplitude * np.sqrt(0.5 * (10.0 + 2.0 * 3.0 / 3.0) / 16.0)
        assert float(row["record RMS velocity [um/s]"]) == pytest.approx(rms, rel=0.02)


def test_names_of_channels_and_files_are_text(page):
    """A tag in a channel's name and in the file's: none of either in the page, both readable."""
    assert {"b", "stand"}.isdisjoint(page.tags)
    assert page.headings[0] == "Prüf <stand>.csv"
    assert page.tables["verdict"][0][1][0] == "<b>Tisch Z"


def test_bands_that_the_record_does_not_show_are_named():
    """At 50 samples a second nothing above 20 Hz is known: VC-A is failed by none and not passed."""
    slow = record_of()
    slow = replace(slow, samples=slow.samples[:, ::8], sampling_frequency=RATE / 8)
    found = assess_record(slow, [find_criterion("VC-A")])
    shown = Page(record_page(found, []))
    row = shown.rows("verdict")[0]
    assert row["verdict"] == "not assessed"
    missing = row["not shown [Hz]"].split(", ")
    assert missing[-2:] == ["63", "80"]
    assert "10" not in missing
    assert row["why not assessed"]
    (axes,) = figures.record_spectra_figure(found).axes
    levels = line_named(axes, NAMES[0]).get_ydata()
    assert np.isnan(levels[-1])  # no line where nothing is known
    assert np.isfinite(levels[10])


def test_the_folder_has_levels_verdicts_and_pictures(result, tmp_path):
    """CSV by band with a column a channel, JSON without not-a-number, both pictures in the page."""
    path = write_record_report(result, tmp_path)
    written = Page(path.read_text(encoding="utf-8"))
    assert [image["alt"].partition(".")[0] for image in written.images] == [
        "Velocity spectra on criteria", "Levels exceeded for shares of the time",
        "Running RMS and events", "Power spectral density", "Spectrogram", "Motion in time",
    ]  # fmt: skip
    with (tmp_path / "levels.csv").open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["band_hz", *(f"{name} [um/s]" for name in NAMES)]
    assert [row[0] for row in rows][:5] == ["1", "1.25", "1.6", "2", "2.5"]
    by_band = {row[0]: row[1:] for row in rows}
    assert float(by_band["10"][0]) == pytest.approx(28.28, rel=0.02)
    assert float(by_band["20"][1]) == pytest.approx(5.657, rel=0.02)
    text = (tmp_path / "summary.json").read_text(encoding="utf-8")
    summary = json.loads(text, parse_constant=pytest.fail)
    assert summary["source"] == "Prüf <stand>.csv"
    assert [one["channel"] for one in summary["channels"]] == list(NAMES)
    found = {(v["channel"], v["criterion"]): v for v in summary["verdicts"]}
    lost = found[NAMES[1], "electron-microscope-vertical"]
    assert (lost["verdict"], lost["margin"]) == ("not assessed", None)
    assert lost["reasons"] == ["the channel is horizontal"]
    assert found[NAMES[0], "VC-A"]["limit_si"] == pytest.approx(50e-6)
    assert found[NAMES[0], "VC-A"]["reasons"] == []


def test_channels_that_are_not_drawn_are_told():
    """Eight channels, six of them drawn: the captions do not speak of all."""
    tones = tuple((10.0 + i, 4e-5) for i in range(8))
    names = tuple(f"c{i}" for i in range(8))
    result = assess_record(record_of(tones, names, ("vertical",) * 8), [find_criterion("VC-A")])
    spectra, *others, history = figures.drawings(result)
    (axes,) = spectra.draw().axes
    assert {line.get_label() for line in axes.lines} & set(names) == set(names[:6])
    for drawing in (spectra, *others, history):
        assert "of the first 6 of 8 channels" in drawing.caption


def test_curves_for_other_motion_than_any_channel_s_are_not_drawn():
    """All channels are upright: a limit on sideways motion says nothing of them."""
    level = replace(find_criterion("VC-A"), name="level", title="level", axis="horizontal")
    result = assess_record(record_of(axes=("vertical", "")), [find_criterion("VC-A"), level])
    (axes,) = figures.record_spectra_figure(result).axes
    assert [text.get_text() for text in axes.texts] == ["VC-A"]


def test_the_page_answers_first_and_every_curve_has_a_word_beside_its_colour(page, result):
    """28.3 um/s meets VC-A with 1.77 and exceeds VC-B; colours are those of the words."""
    table, looks = page.tables["answer"][0], page.classes["answer"][0]
    assert table[0] == ["criterion", *NAMES]
    rows = {row[0]: row[1:] for row in table[1:]}
    assert rows["VC-A"][0].startswith("\N{CHECK MARK} pass 1.7")
    assert rows["VC-B"][0].startswith("\N{BALLOT X} fail 0.88")
    assert rows["Electron microscope, vertical"][1] == "\N{EN DASH} not assessed"
    for row, look in zip(table[1:], looks[1:], strict=True):
        for word, colour in zip(row[1:], look[1:], strict=True):
            status = next(s for s in ("pass", "fail", "not assessed") if s in word)
            assert status.replace(" ", "-") in colour.split()
    text = record_page(result, [])
    assert text.index("VC-A is met with margin 1.7") < text.index('id="verdict"')


def test_events_stand_on_the_page_and_in_their_file_as_they_are_found(tmp_path):
    """A tone of 4 s amid a hundredth of it: one event of each channel, cut by no end of the record.

    The first exceeds VC-B, the second stands 6 dB above its median; a filter's answer to the sudden
    beginning overshoots by some percent.
    """
    gate = np.where((TIME >= 6.0) & (TIME < 10.0), 1.0, 0.01)
    samples = np.array([a * gate * np.sin(20.0 * np.pi * TIME) for a in (40e-6, 8e-6)])
    result = assess_record(replace(record_of(), samples=samples), [find_criterion("VC-B")])
    write_record_report(result, tmp_path)
    with (tmp_path / "events.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    shown = Page(record_page(result, [])).rows("events")
    assert [row["channel"] for row in rows] == [row["channel"] for row in shown] == list(NAMES)
    # the second's threshold, 2 % of its level, is met while the filter of 10 Hz rings out, too
    for row, level, late in zip(rows, (28.28, 5.657), (0.7, 1.8), strict=True):
        assert float(row["level_um_s"]) == pytest.approx(level, rel=0.05)
        assert (row["band_hz"], row["criterion"], row["cut"]) == ("10", "VC-B", "")
        assert float(row["margin"]) == pytest.approx(25.0 / level, rel=0.05)
        assert float(row["start_s"]) == pytest.approx(6.0, abs=0.7)
        assert 9.5 < float(row["end_s"]) < 10.0 + late
    assert shown[0]["largest running level [um/s]"].startswith("28.")


def test_tables_beside_the_page_hold_what_their_headings_say(result, tmp_path):
    """The PSD integrates to the mean square; running levels and percentiles are in um/s."""
    write_record_report(result, tmp_path)

    def table(name):
        with (tmp_path / name).open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    psd = table("psd.csv")
    f = np.array([float(row["frequency_hz"]) for row in psd])
    values = np.array([float(row[f"{NAMES[0]} [(um/s)2/Hz]"]) for row in psd])
    # the mean of 7 windows of 4 s, in each the mean of the faded envelope's square, weighted by Hann's
    hann = np.hanning(int(4 * RATE)) ** 2
    held = [hann @ FADE[int(at * RATE) :][: len(hann)] ** 2 / hann.sum() for at in range(0, 14, 2)]
    assert values.sum() * f[1] == pytest.approx(28.28**2 * np.mean(held), rel=0.01)
    running = table("running.csv")
    assert max(float(row[f"{NAMES[1]} [um/s]"]) for row in running) == pytest.approx(
        5.657, rel=0.02
    )
    rows = {(r["channel"], r["band_hz"]): r for r in table("percentiles.csv")}
    own = rows[NAMES[0], "10"]
    assert float(own["max_um_s"]) == pytest.approx(28.28, rel=0.02)
    assert float(own["L10_um_s"]) == pytest.approx(28.28, rel=0.02)
    assert float(own["L50_um_s"]) == pytest.approx(28.28, rel=0.02)
    assert float(own["mean_um_s"]) == pytest.approx(28.28 * np.sqrt(12.0 / 16.0), rel=0.02)
