"""Measured records: made files with known levels, files that are refused or warned of by name."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy import signal
from scipy.io import wavfile

from studies import GOOD
from trundle.criteria import VC, assess_reduced, find_criterion
from trundle.errors import ComputationError, InputError
from trundle.records import RecordOptions, read_record
from trundle.records.assess import assess_record, read_simulated
from trundle.response import BandSpectra, few_runs_warnings, level_warnings, percentile_interval
from trundle.run.whole_study import run_study
from trundle.signals import Record, band_edges, mid_band_frequencies, motion_of
from trundle.study_file.build import load_study

FS, T = 400.0, 60.0
TONES = {4: 60e-6, 6: 100e-6, 10: 40e-6, 13: 12e-6}  # band number: RMS velocity [m/s]
NO_OPTIONS = RecordOptions()


def tones(quantity="acceleration", fs=FS, duration=T):
    """Steady tones at mid-band, faded in and out over 8 s: their RMS is known in every 1 s."""
    t = np.arange(round(duration * fs)) / fs
    ease = np.clip(np.minimum(t, duration - t) / 8.0, 0, 1)
    v = np.zeros_like(t)
    for k, rms in TONES.items():
        f = 10.0 ** (k / 10.0)
        size = np.sqrt(2) * rms * (2 * np.pi * f if quantity == "acceleration" else 1.0)
        v += size * np.sin(2 * np.pi * f * t + k)
    return t, ease**2 * (3 - 2 * ease) * v


def write_csv(path, t, samples, heading="time [s],z [mm/s2]", scale=1e3):
    rows = "\n".join(f"{a:.6f},{scale * b:.9g}" for a, b in zip(t, samples, strict=True))
    path.write_text(f"{heading}\n{rows}\n")
    return path


@pytest.mark.parametrize("quantity", ["acceleration", "velocity"])
def test_known_levels_come_back_within_0_2_db(tmp_path, quantity):
    """Tones at mid-band of known RMS, plus an offset and a drift that would ruin an integral."""
    t, samples = tones(quantity)
    heading = "time [s],z [mm/s2]" if quantity == "acceleration" else "time [s],z [mm/s]"
    drifting = samples + 0.05 + 0.001 * t
    record = read_record(write_csv(tmp_path / "r.csv", t, drifting, heading), NO_OPTIONS)
    assert record.quantity == quantity
    assert record.sampling_frequency == pytest.approx(FS, rel=1e-6)
    spectra = assess_record(record, VC).reduced.spectra
    for k, rms in TONES.items():
        assert 20 * np.log10(spectra.values[0, 0, k] / rms) == pytest.approx(0.0, abs=0.2)


def test_a_noise_record_has_the_levels_of_its_spectrum(tmp_path):
    """White acceleration of PSD S: band RMS velocity^2 = S / (2 pi)^2 (1/f1 - 1/f2), event average."""
    rng = np.random.default_rng(8)
    psd, fs = 1e-8, 400.0
    a = rng.standard_normal(round(1200 * fs)) * np.sqrt(psd * fs / 2)
    record = Record(
        samples=a[None], sampling_frequency=fs, quantity="acceleration", channel_names=("z",)
    )
    spectra = assess_record(record, VC, averaging="event").reduced.spectra
    mid = mid_band_frequencies()
    low, high = band_edges(mid).T
    expected = np.sqrt(psd / (2 * np.pi) ** 2 * (1 / low - 1 / high))
    found = spectra.values[0, 0]
    decibels = 20 * np.log10(found / expected)[mid > 1.5]  # 1.013: Butterworth's noise bandwidth
    assert np.abs(decibels).max() < 0.45
    assert np.median(decibels) == pytest.approx(20 * np.log10(np.sqrt(1.013)), abs=0.1)


def test_integration_does_not_drift():
    """A burst in acceleration that is the derivative of a known velocity: that velocity comes back."""
    fs, t = 200.0, np.arange(0, 40, 1 / 200.0)
    v = 1e-4 * np.exp(-(((t - 20) / 1.5) ** 2)) * np.sin(2 * np.pi * 5 * t)
    a = np.gradient(v, t, edge_order=2)
    wander = 1e-3 * np.sin(2 * np.pi * 0.04 * t)  # 4 mm/s if it were integrated
    record = Record(
        samples=(a + 0.3 + wander)[None],
        sampling_frequency=fs,
        quantity="acceleration",
        channel_names=("z",),
    )
    _, velocity, acceleration = motion_of(record)
    assert np.abs(velocity[0] - v).max() < 0.02 * v.max()
    assert np.abs(acceleration[0] - a).max() < 0.01 * a.max()
    assert np.abs(velocity[0][:1000]).max() < 0.02 * v.max()


def test_every_format_holds_the_same_record(tmp_path):
    t, a = tones()
    expected = read_record(write_csv(tmp_path / "r.csv", t, a), NO_OPTIONS).samples[0]
    bare = tmp_path / "bare.txt"
    bare.write_text("\n".join(f"{x:.9g}" for x in a))
    semicolons = tmp_path / "comma.csv"
    semicolons.write_text(
        "Time [ms];z [m/s2]\n"
        + "\n".join(f"{1e3 * x:.3f};{y:.9g}".replace(".", ",") for x, y in zip(t, a, strict=True))
    )
    wavfile.write(tmp_path / "f.wav", int(FS), a.astype(np.float32))
    scaled = np.round(a / 0.1 * 2**31).astype(np.int32)
    wavfile.write(tmp_path / "i.wav", int(FS), scaled)
    for path, options in (
        (bare, RecordOptions(unit="m/s2", rate="400 Hz")),
        (semicolons, NO_OPTIONS),
        (tmp_path / "f.wav", RecordOptions(unit="m/s2")),
        (tmp_path / "i.wav", RecordOptions(full_scale="0.1 m/s2")),
        (tmp_path / "i.wav", RecordOptions(full_scale="1 V", sensitivity="10 V/(m/s2)")),
    ):
        record = read_record(path, options)
        assert record.sampling_frequency == pytest.approx(FS, rel=1e-6)
        np.testing.assert_allclose(record.samples[0], expected, atol=2e-7 * np.abs(a).max() + 1e-11)


def test_uff_58(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    t, a = tones(duration=20.0)
    data = pyuff.prepare_58(
        func_type=1, rsp_node=1, rsp_dir=3, ref_dir=3, ref_node=1, data=a, x=t, id1="slab z",
        ordinate_spec_data_type=12, abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=1 / FS,
        binary=0, ordinate_axis_units_lab="m/s2", orddenom_spec_data_type=0, z_axis_spec_data_type=0,
        abscissa_spec_data_type=17, id2="", id3="", id4="", id5="", ver_num=0, load_case_id=0,
        rsp_ent_name="NONE", ref_ent_name="NONE", abscissa_axis_units_lab="s", orddenom_axis_units_lab="NONE",
        z_axis_axis_units_lab="NONE", ord_data_type=4, z_axis_value=0.0,
    )  # fmt: skip
    pyuff.UFF(str(tmp_path / "r.uff")).write_sets(data, "add")
    record = read_record(tmp_path / "r.uff", NO_OPTIONS)
    assert record.channel_names == ("slab z",)
    assert record.sampling_frequency == pytest.approx(FS, rel=1e-5)
    np.testing.assert_allclose(record.samples[0], a, atol=1e-5 * np.abs(a).max())


@pytest.mark.filterwarnings("ignore")
def test_miniseed(tmp_path):
    obspy = pytest.importorskip("obspy")
    _, a = tones(duration=20.0)
    header = {"network": "XX", "station": "FLOOR", "channel": "HHZ", "sampling_rate": FS}
    trace = obspy.Trace(data=a / 1e-6, header=header)
    trace.write(str(tmp_path / "r.mseed"), format="MSEED")
    record = read_record(tmp_path / "r.mseed", RecordOptions(unit="um/s2"))
    assert record.channel_names == ("XX.FLOOR..HHZ",)
    np.testing.assert_allclose(record.samples[0], a, rtol=1e-12)
    hole = obspy.Trace(data=a[:1000], header=header | {"starttime": trace.stats.endtime + 5})
    obspy.Stream([trace, hole]).write(str(tmp_path / "gap.mseed"), format="MSEED")
    with pytest.raises(InputError, match=r"gaps in XX.FLOOR..HHZ"):
        read_record(tmp_path / "gap.mseed", RecordOptions(unit="m/s2"))


def broken(t, a, how):
    t, a = t.copy(), a.copy()
    if how == "nan":
        a[5000] = np.nan
    if how == "gap":
        t[9000:] += 0.5
    if how == "dead":
        a[:] = 1.0
    if how == "short":
        t, a = t[:400], a[:400]
    return t, a


@pytest.mark.parametrize(
    ("how", "told"),
    [("nan", r"channel 'z' has 1 samples that are not numbers, the first at 12.5 s"), ("gap", "gaps in time"),
     ("dead", "channel 'z' never moves"), ("short", "too short")],
)  # fmt: skip
def test_records_that_cannot_be_right_are_refused(tmp_path, how, told):
    path = write_csv(tmp_path / "r.csv", *broken(*tones(), how))
    with pytest.raises(InputError, match=told):
        read_record(path, NO_OPTIONS)


@pytest.mark.parametrize(
    ("text", "options", "told"),
    [
        ("time [s],z\n0,1\n0.01,2\n", NO_OPTIONS, "channel 'z' has no unit"),
        ("z [mm/s2]\n1\n2\n", NO_OPTIONS, "say its rate"),
        ("time [s],z [kg]\n0,1\n0.01,2\n", NO_OPTIONS, "neither acceleration nor velocity"),
        ("time [s],z [V]\n0,1\n0.01,2\n", NO_OPTIONS, "neither acceleration nor velocity"),
        ("time [s],z [mm/s2],y [mm/s]\n0,1,1\n0.01,2,2\n", NO_OPTIONS, "assess them apart"),
        ("time [s],z [mm/s2]\n0,1\n0.01,2\n", RecordOptions(rate="500 Hz"), "one is wrong"),
        ("time [s],z [mm/s2]\n0,1\n0.01,2,3\n", NO_OPTIONS, "line 3 has 3 columns"),
        ("# a logger\n\ntime [s],z [mm/s2]\n0,1\n0.01,2,3\n", NO_OPTIONS, "line 5 has 3 columns"),
        ('time [s],z [mm/s2]\n0,"1\n0.01,2"\n', NO_OPTIONS, "a quoted cell holds a line break"),
        ("time [s],z [V]\n0,1\n0.01,2\n", RecordOptions(sensitivity="0 V/g"), "greater than 0"),
        ("", NO_OPTIONS, "holds no samples"),
    ],
)
def test_files_that_say_too_little_are_refused(tmp_path, text, options, told):
    path = tmp_path / "r.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=told):
        read_record(path, options)


def subjects(samples, fs=FS):
    record = Record(
        samples=samples[None], sampling_frequency=fs, quantity="velocity", channel_names=("z",)
    )
    return {warning.subject for warning in assess_record(record, VC).warnings}


def test_records_in_doubt_are_warned_of_by_name():
    _, v = tones("velocity")
    assert subjects(v) == {"scatter"}
    assert "clipped, z" in subjects(np.clip(v, -0.5 * v.max(), 0.5 * v.max()))
    assert "sampling rate" in subjects(v[::4], fs=FS / 4)
    assert "record length" in subjects(tones("velocity", duration=5.0)[1])
    t = np.arange(0, 20, 1 / FS)
    pulse = np.exp(-(((t - 19.5) / 0.5) ** 2)) * np.sin(2 * np.pi * 5 * t)
    assert "record ends, z" in subjects(pulse)
    assert "record starts, z" in subjects(pulse[::-1])


def test_what_a_record_cannot_show_is_not_assessed():
    """5.1 s hold 8 periods of 1.57 Hz, and 100 Hz shows 40 Hz: VC-C asks for 1 to 80 Hz."""
    short = tones("velocity", duration=5.1)[1] * 1e-3
    record = Record(
        samples=short[None], sampling_frequency=FS, quantity="velocity", channel_names=("z",)
    )
    verdict = assess_record(record, [find_criterion("VC-C")]).verdicts[0]
    assert verdict.status == "not assessed"
    assert verdict.unresolved == (1.0, 1.25)
    slow = tones("velocity")[1][::4] * 1e-3
    record = Record(
        samples=slow[None], sampling_frequency=FS / 4, quantity="velocity", channel_names=("z",)
    )
    verdict = assess_record(record, [find_criterion("VC-C")]).verdicts[0]
    assert verdict.unresolved == (50.0, 63.0, 80.0)


def test_the_command_writes_a_report(tmp_path, monkeypatch, capsys, trundle):
    monkeypatch.chdir(tmp_path)
    t, a = tones()
    write_csv(tmp_path / "event <b>.csv", t, a)
    assert trundle("assess", "event <b>.csv", "-c", "VC-A,VC-D,R-office") == 0
    printed = capsys.readouterr().out
    assert "VC-D" in printed
    folder = tmp_path / "event <b>-results"
    summary = json.loads((folder / "summary.json").read_text())
    found = {v["criterion"]: v["verdict"] for v in summary["verdicts"]}
    assert found == {"VC-A": "fail", "VC-D": "fail", "R-office": "pass"}  # 100 um/s at 4 Hz
    page = (folder / "report.html").read_text()
    assert "event &lt;b&gt;.csv" in page
    assert "<b>.csv" not in page
    levels = (folder / "levels.csv").read_text().splitlines()
    assert levels[0] == "band_hz,z [um/s]"
    assert float(levels[7].split(",")[1]) == pytest.approx(100.0, rel=0.02)
    assert trundle("assess", "event <b>.csv", "--averaging", "max_2s") == 2
    assert "max_1s" in capsys.readouterr().err


@pytest.mark.parametrize(("fs", "decimals"), [(512.0, 3), (512.0, 4), (256.0, 3), (800.0, 3)])
def test_time_stamps_may_be_rounded(tmp_path, fs, decimals):
    """Stamps of 3 decimals at 512 Hz stray by up to 0.5 ms; the rate is that of the whole record."""
    n = round(10 * fs)
    rows = (f"{i / fs:.{decimals}f},{np.sin(i):.6f}" for i in range(n))
    (tmp_path / "r.csv").write_text("t [s],a [m/s2]\n" + "\n".join(rows))
    record = read_record(tmp_path / "r.csv", NO_OPTIONS)
    assert record.sampling_frequency == pytest.approx(fs, rel=2e-4)


@pytest.mark.parametrize("mark", ["\t", " ", ";"])
def test_decimal_commas(tmp_path, mark):
    rows = "\n".join(f"{i / 100:.2f}{mark}{(i % 7) - 3.5}".replace(".", ",") for i in range(400))
    (tmp_path / "r.txt").write_text(f"time [s]{mark}a [m/s2]\n{rows}")
    record = read_record(tmp_path / "r.txt", NO_OPTIONS)
    np.testing.assert_allclose(record.samples[0, :3], [-3.5, -2.5, -1.5])
    assert record.sampling_frequency == pytest.approx(100.0)


def test_what_contradicts_itself_is_refused(tmp_path):
    t, a = tones(duration=10.0)
    path = write_csv(tmp_path / "r.csv", t, a)
    with pytest.raises(InputError, match="leave one out"):
        read_record(path, RecordOptions(unit="m/s2"))
    with pytest.raises(InputError, match="for WAV files"):
        read_record(path, RecordOptions(full_scale="20 m/s2"))
    path = write_csv(tmp_path / "stamp.csv", t, a, heading="stamp,a [mm/s2]")
    with pytest.raises(InputError, match="rises evenly as time does"):
        read_record(path, RecordOptions(unit="mm/s2"))
    wavfile.write(tmp_path / "i.wav", int(FS), np.round(a / 0.1 * 2**15).astype(np.int16))
    with pytest.raises(InputError, match="shares of a full scale"):
        read_record(tmp_path / "i.wav", RecordOptions(unit="m/s2"))


def test_a_clipped_channel_passes_nothing():
    """Its true levels are higher than what is left; a failure still counts. Quantised is not clipped."""
    _, v = tones("velocity")
    quiet = np.clip(v, -0.5 * v.max(), 0.5 * v.max())
    for scale, status in ((1e-3, "not assessed"), (1e3, "fail")):
        record = Record(
            samples=scale * quiet[None],
            sampling_frequency=FS,
            quantity="velocity",
            channel_names=("z",),
        )
        assert assess_record(record, [find_criterion("VC-A")]).verdicts[0].status == status
    t = np.arange(0, 20, 1 / FS)
    coarse = np.round(100 * np.sin(2 * np.pi * 5 * t)) / 100
    assert not {s for s in subjects(coarse) if s.startswith("clipped")}


def test_a_high_pass_leaves_the_lowest_band_whole():
    record = Record(
        samples=tones()[1][None],
        sampling_frequency=FS,
        quantity="acceleration",
        channel_names=("z",),
    )
    with pytest.raises(InputError, match=r"0\.5 Hz at most"):
        assess_record(record, VC, high_pass=0.8)


@pytest.mark.parametrize(
    ("encoding", "heading"),
    [("utf-16", "time [s]\tz [µm/s2]"), ("cp1252", "Zeit [s]\tBöden [µm/s²]"), ("utf-8-sig", "t\tz [um/s2]")],
)  # fmt: skip
def test_text_of_spreadsheets_and_loggers(tmp_path, encoding, heading):
    """UTF-16 of a spreadsheet, Windows-1252 with a micro sign, a byte order mark."""
    t, a = tones(duration=10.0)
    rows = "\n".join(f"{x:.4f}\t{1e6 * y:.6f}" for x, y in zip(t, a, strict=True))
    (tmp_path / "r.txt").write_bytes(f"{heading}\n{rows}\n".encode(encoding))
    record = read_record(tmp_path / "r.txt", NO_OPTIONS)
    np.testing.assert_allclose(record.samples[0], a, atol=1e-12)
    (tmp_path / "r.txt").write_bytes(b"\x00\x01\x02" * 100)
    with pytest.raises(InputError, match="is not text"):
        read_record(tmp_path / "r.txt", NO_OPTIONS)


@pytest.mark.parametrize("heading", ["time [s];z [mg];", "time [s];z [mg]"])
def test_delimiters_behind_the_last_column(tmp_path, heading):
    """Some loggers end every line, or every line but the heading, with a delimiter; mg is milli-g."""
    t, a = tones(duration=10.0)
    rows = "\n".join(f"{x:.4f};{y / 9.80665e-3:.9f};" for x, y in zip(t, a, strict=True))
    (tmp_path / "r.csv").write_text(f"{heading}\n{rows}\n")
    record = read_record(tmp_path / "r.csv", NO_OPTIONS)
    assert record.channel_names == ("z",)
    np.testing.assert_allclose(record.samples[0], a, atol=1e-10)


def test_doses_are_for_as_many_events_as_are_said(tmp_path, monkeypatch, capsys, trundle):
    """VDV grows by the fourth root: 16 passages have twice the dose of one, and half its margin."""
    monkeypatch.chdir(tmp_path)
    write_csv(tmp_path / "r.csv", *tones())
    margins = []
    for events in ("1", "16"):
        options = ("-c", "VDV-residential-day-low", "--events", events, "--out", f"out{events}")
        assert trundle("assess", "r.csv", *options) == 0
        summary = json.loads((tmp_path / f"out{events}" / "summary.json").read_text())
        margins.append(summary["verdicts"][0]["margin"])
    assert margins[0] / margins[1] == pytest.approx(2.0, rel=1e-9)


def test_single_numbers_of_a_short_record_are_not_passed():
    """5 s hold 5 periods of 1 Hz: a weighted number could miss what is slow; too loud is too loud."""
    _, v = tones("velocity", duration=5.0)
    for scale, status in ((1e-3, "not assessed"), (1e3, "fail")):
        record = Record(
            samples=scale * v[None],
            sampling_frequency=FS,
            quantity="velocity",
            channel_names=("z",),
        )
        assert assess_record(record, [find_criterion("R-office")]).verdicts[0].status == status


def test_the_warning_of_scatter_is_that_of_the_averaging_rule():
    """By what the filter passes in a window; no more than a Rayleigh envelope's 52.3 %."""
    texts = {
        rule: str(level_warnings(rule, 30.0)[0]) for rule in ("max_1s", "slow", "fast", "event")
    }
    assert "51 % at 1 Hz, 32 % at 8 Hz, 11 % at 80 Hz" in texts["max_1s"]
    assert "46 % at 1 Hz" in texts["slow"]
    assert "52 % at 1 Hz" in texts["fast"]
    assert "record of 30 s" in texts["event"]


def test_the_scatter_of_many_runs_is_taken_from_them():
    """Levels 1 and 3 by halves have a mean of 2 and a standard deviation of 1: 50 %."""
    mid_band = 10.0 ** np.array([0.0, 0.9, 1.9])
    values = np.tile([1.0, 3.0], 500)[:, None, None] * np.array([1.0, 2.0, np.nan])
    levels = BandSpectra(
        mid_band=mid_band,
        values=values,
        times=values,
        resolved=np.array([True, True, False]),
        averaging="max_1s",
        point_names=("p",),
        quantity="band_rms_velocity",
    )
    text = str(level_warnings("max_1s", 30.0, levels=levels)[0])
    assert "over the runs levels scatter by 50 % at 1 Hz, 50 % at 8 Hz" in text
    assert "80 Hz" not in text


def test_a_percentile_of_few_runs_is_doubted():
    """The largest of n is below the 95 % level with 0.95^n: 72 runs for 2.5 %."""
    assert 0.95**72 < 0.025 < 0.95**71
    (warning,) = few_runs_warnings(71, 95.0)
    assert "72 runs" in str(warning)
    assert few_runs_warnings(72, 95.0) == ()
    assert few_runs_warnings(1, 100.0) == ()
    values = np.arange(72.0)
    assert np.isfinite(percentile_interval(values, 95.0)[1])
    assert np.isinf(percentile_interval(values[:71], 95.0)[1])


def made(samples, quantity="velocity", fs=FS):
    return Record(
        samples=np.atleast_2d(samples), sampling_frequency=fs, quantity=quantity,
        channel_names=("z",),
    )  # fmt: skip


@pytest.mark.parametrize("f", [5.0, 30.0, 60.0])
def test_steady_motion_has_no_slow_motion_of_its_ends(f):
    """A cosine of acceleration that starts at its crest: 100 um/s at f, and nothing at 1 to 2 Hz."""
    t = np.arange(0, 30, 1 / FS)
    peak = 100e-6
    record = made(peak * 2 * np.pi * f * np.cos(2 * np.pi * f * t), "acceleration")
    result = assess_record(record, VC)
    low = result.reduced.spectra.values[0, 0, :4]
    assert low.max() < 1e-3 * peak
    assert result.reduced.rms_velocity[0, 0] == pytest.approx(peak / np.sqrt(2), rel=1e-3)


def test_slow_wander_is_no_velocity():
    """0.001 m/s2 that wanders in 25 s is 4 mm/s if integrated; the tone beside it is 60 um/s."""
    t = np.arange(0, 60, 1 / FS)
    wander = 1e-3 * np.cos(2 * np.pi * 0.04 * t + 0.3)
    tone = np.sqrt(2) * 60e-6 * 2 * np.pi * 10 * np.cos(2 * np.pi * 10 * t)
    levels = assess_record(made(wander + tone, "acceleration"), VC).reduced.spectra.values[0, 0]
    assert levels[10] == pytest.approx(60e-6, rel=0.01)
    assert levels[:6].max() < 1e-6


@pytest.mark.parametrize("averaging", ["max_1s", "event"])
@pytest.mark.parametrize("k", [6, 8, 10, 13, 16])
def test_steady_tones_are_no_louder_for_their_beginning(averaging, k):
    """Tones from 4 Hz up that fill a record of 20 s: their RMS, within 0.2 dB, by either rule."""
    t = np.arange(0, 20, 1 / FS)
    tone = np.sqrt(2) * 1e-4 * np.sin(2 * np.pi * 10 ** (k / 10) * t + 0.7)
    result = assess_record(made(tone), VC, averaging=averaging)
    error = 20 * np.log10(result.reduced.spectra.values[0, 0, k] / 1e-4)
    assert abs(error) < 0.2
    assert result.reduced.rms_velocity[0, 0] == pytest.approx(1e-4, rel=2e-3)


def test_a_drift_does_not_make_an_event_steady():
    """A passage 4 s behind the start of a minute, on a drift far larger: as without the drift."""
    t = np.arange(0, 60, 1 / FS)
    event = 1e-3 * np.exp(-(((t - 4) / 1) ** 2)) * np.sin(2 * np.pi * 8 * t)
    levels = [
        assess_record(made(event + drift), VC).reduced.spectra.values[0, 0, 9]
        for drift in (0.0, 0.01 * t)
    ]
    assert levels[1] == pytest.approx(levels[0], rel=0.01)


def test_what_loggers_do_to_records_is_named():
    """A gap filled with zeros or one value, a single spike, rails hit seldom; none in sound records."""
    rng = np.random.default_rng(1)
    t = np.arange(0, 60, 1 / FS)
    noise = 1e-4 * rng.standard_normal(len(t))
    event = 1e-3 * np.exp(-(((t - 30) / 3) ** 2)) * np.sin(2 * np.pi * 8 * t)
    for fill in (0.0, noise[8000]):
        filled = noise.copy()
        filled[8000:8200] = fill
        assert "held, z" in subjects(filled)
        (verdict,) = assess_record(made(1e-3 * filled), [find_criterion("VC-A")]).verdicts
        assert (verdict.status, verdict.margin > 1.0) == ("not assessed", True)
    spiky = noise.copy()
    spiky[9000] = 0.1
    assert "spikes, z" in subjects(spiky)
    assert "clipped, z" in subjects(np.clip(noise, -2.5e-4, 2.5e-4))
    for f in (97.0, 10.0, 8.0, 25.0):  # 4, 40, 50 and 16 samples a period
        sine = 1e-3 * np.sin(2 * np.pi * f * t)
        assert "clipped, z" in subjects(np.clip(sine, -7e-4, 7e-4))
    for sound in (noise, event, np.round(event / 1e-5) * 1e-5, np.round(noise / 3e-5) * 3e-5):
        assert not {s.partition(",")[0] for s in subjects(sound)} & {"held", "spikes", "clipped"}


@pytest.mark.parametrize("fs", [400.0, 500.0, 2000.0])
def test_crests_that_repeat_are_not_clipped(fs):
    """Tones of a whole number of samples a period, written with 9 decimals, and equal footfalls:
    each crest is the last one again. 100 Hz at 400 Hz is one that a clipped one cannot be told from."""
    t = np.arange(0, 30, 1 / fs)
    swell = np.clip(np.minimum(t, 30 - t) / 4.0, 0, 1)
    for f in (5.0, 10.0, 12.5, 20.0, 25.0, 50.0, 62.5, 100.0):
        tone = 30e-6 * swell * np.sin(2 * np.pi * f * t)
        assert "clipped, z" not in subjects(tone, fs)
        assert "clipped, z" not in subjects(np.round(tone, 9), fs)
    beats = np.exp(-((((t % 0.5) - 0.1) / 0.03) ** 2)) * np.sin(2 * np.pi * 12 * (t % 0.5))
    assert "clipped, z" not in subjects(1e-3 * beats, fs)
    assert "clipped, z" in subjects(np.clip(1e-3 * beats, -1e-3, 0.6e-3), fs)


@pytest.mark.parametrize("at", [3.0, 1.0, 30.0, 59.0])
def test_an_event_beside_a_hum_is_found_wherever_it_is(at):
    """A second of 8 Hz, 100 um/s, on a hum at 180 Hz that no band contains: the same level anywhere.

    The energy of the burst through the band by an independent filter: 99 to 103 um/s.
    """
    fs = 1000.0
    t = np.arange(0, 60, 1 / fs)
    burst = np.sqrt(2) * 1e-4 * np.exp(-0.5 * ((t - at) / 0.5) ** 2)
    v = burst * np.sin(2 * np.pi * 10**0.9 * t)
    hum = 2e-4 * np.sin(2 * np.pi * 180 * t + 1)
    record = Record(
        samples=(v + hum)[None], sampling_frequency=fs, quantity="velocity", channel_names=("z",)
    )
    sos = signal.butter(4, band_edges(np.array([10**0.9]))[0], "bandpass", fs=fs, output="sos")
    passed = signal.sosfilt(sos, np.append(v, np.zeros(3000)))
    square = np.cumsum(np.append(0.0, passed**2))
    expected = np.sqrt((square[1000:] - square[:-1000]).max() / 1000)
    found = assess_record(record, VC).reduced.spectra.values[0, 0, 9]
    assert 20 * np.log10(found / expected) == pytest.approx(0.0, abs=0.2)


@pytest.mark.longest
@pytest.mark.parametrize("seed", range(30))
def test_events_anywhere_over_hum_noise_drift_and_offset(seed):
    """Seeded mixtures: the band of the event within 0.2 dB of an independent filter.

    Event and noise are known; hum stands outside all bands, offset and drift below. The filter is
    SciPy's Butterworth run over velocity that is known in closed form, of the event and the noise.
    """
    rng = np.random.default_rng(seed)
    fs, length = rng.choice([400.0, 500.0, 1000.0, 2048.0]), 40.0
    t = np.arange(round(fs * length)) / fs
    k = int(rng.integers(5, 18))  # 3.15 to 50 Hz
    f, at = 10 ** (k / 10), rng.choice([1.2, rng.uniform(1.2, 38.8), 38.8])
    width = rng.uniform(0.25, 0.45)  # s
    size = 10 ** rng.uniform(-5, -3)
    omega = 2 * np.pi * f
    shape = np.exp(-0.5 * ((t - at) / width) ** 2)
    v = size * shape * np.sin(omega * t)
    a = size * shape * (omega * np.cos(omega * t) - (t - at) / width**2 * np.sin(omega * t))
    quantity = rng.choice(["velocity", "acceleration"])
    tones = [(g, rng.uniform(0, 6)) for g in rng.uniform(1.5, 90, 40)]  # noise known in closed form
    quiet = 0.01 * size
    noise = sum(quiet * np.sin(2 * np.pi * g * t + p) for g, p in tones)
    noise_a = sum(quiet * 2 * np.pi * g * np.cos(2 * np.pi * g * t + p) for g, p in tones)
    hum_f = rng.choice([0.29 * fs, 0.43 * fs])
    scale = size if quantity == "velocity" else size * 2 * np.pi * f
    other = 3 * scale * np.sin(2 * np.pi * hum_f * t + 1) + scale * (5 + 0.5 * t / length)
    samples = (v + noise if quantity == "velocity" else a + noise_a) + other
    record = Record(
        samples=samples[None], sampling_frequency=fs, quantity=str(quantity), channel_names=("z",)
    )
    sos = signal.butter(4, band_edges(np.array([f]))[0], "bandpass", fs=fs, output="sos")
    passed = signal.sosfilt(sos, np.append(v + noise, np.zeros(round(2 * fs))))
    square, n = np.cumsum(np.append(0.0, passed**2)), round(fs)
    expected = np.sqrt((square[n:] - square[:-n]).max() / n)
    found = assess_record(record, VC).reduced.spectra.values[0, 0, k]
    assert 20 * np.log10(found / expected) == pytest.approx(0.0, abs=0.2)


def test_sizes_that_no_floor_reaches_are_refused():
    with pytest.raises(InputError, match="which no floor does"):
        made(1e150 * tones("velocity")[1])


def test_levels_that_are_no_numbers_are_no_pass():
    """A run that has overflowed stops the verdict, whatever the limit."""
    record = made(tones("velocity")[1])
    reduced = assess_record(record, VC).reduced
    lost = replace(reduced.spectra, values=np.full_like(reduced.spectra.values, np.nan))
    with pytest.raises(ComputationError, match="not a finite number"):
        assess_reduced(replace(reduced, spectra=lost), VC, percentile=100.0, f_resolved=80.0)
    infinite = np.full_like(reduced.response_factor, np.inf)
    loud = replace(reduced, numbers={**reduced.numbers, "response_factor": infinite})
    with pytest.raises(ComputationError, match="not a finite number"):
        assess_reduced(loud, find_criterion("R-office"), percentile=100.0, f_resolved=80.0)


@pytest.mark.parametrize("start", [0.0, 1000.0, 1.7e9])
def test_gaps_show_however_late_the_clock(tmp_path, start):
    """0.8 s lost after an hour, or after half a century of stamps; 4 samples after 1000 s."""
    for lost in (400, 8):
        t, a = tones(fs=500.0, duration=12.0)
        t = np.delete(t, slice(2000, 2000 + lost)) + start
        a = np.delete(a, slice(2000, 2000 + lost))
        with pytest.raises(InputError, match="gaps in time"):
            read_record(write_csv(tmp_path / "r.csv", t, a), NO_OPTIONS)
    t, a = tones(fs=500.0, duration=12.0)
    record = read_record(write_csv(tmp_path / "r.csv", t + start, a), NO_OPTIONS)
    assert record.sampling_frequency == pytest.approx(500.0, rel=1e-6)


@pytest.mark.parametrize("heading", ["time_ms", "Time ms", "t_ms", "time [ms]"])
def test_units_of_time_behind_its_heading(tmp_path, heading):
    t, a = tones(duration=10.0)
    path = write_csv(tmp_path / "r.csv", 1e3 * t, a, heading=f"{heading},z [mm/s2]")
    assert read_record(path, NO_OPTIONS).sampling_frequency == pytest.approx(FS)


def test_options_that_do_not_apply_are_refused(tmp_path, monkeypatch, capsys, trundle):
    monkeypatch.chdir(tmp_path)
    t, a = tones(duration=10.0)
    write_csv(tmp_path / "r.csv", t, a)
    for options, told in (
        (("--sensitivity", "100"), "is motion already"),
        (("--point", "tool"), "--simulation"),
        (("--high-pass", "1e-9 Hz"), "0.05 Hz"),
        (("--shape", "round"), "--shape must be one of"),
    ):
        assert trundle("assess", "r.csv", *options) == 2
        assert told in capsys.readouterr().err
    assert trundle("assess", str(tmp_path)) == 2
    assert "is a folder" in capsys.readouterr().err
    wavfile.write(tmp_path / "r.wav", int(FS), a.astype(np.float32))
    assert trundle("assess", "r.wav", "--full-scale", "2 m/s2", "--unit", "mm/s2") == 2
    assert "leave --unit out" in capsys.readouterr().err
    assert trundle("assess", "--help") == 0
    assert "time [s], z [mm/s2]" in " ".join(capsys.readouterr().out.split())


def test_generic_curves_may_be_flat(tmp_path, monkeypatch, trundle):
    """VC-A allows 100 um/s at 4 Hz where it rises, and 50 um/s on pneumatic isolation."""
    monkeypatch.chdir(tmp_path)
    t = np.arange(0, 60, 1 / FS)
    np.savetxt(
        "r.csv", np.stack([t, np.sqrt(2) * 75 * np.sin(2 * np.pi * 10**0.6 * t)], axis=1),
        delimiter=",", header="time [s],z [um/s]", comments="",
    )  # fmt: skip
    for shape, verdict in (("rising", "pass"), ("flat", "fail")):
        options = ("-c", "VC-A,VC-C", "--shape", shape, "--out", shape)
        assert trundle("assess", "r.csv", *options) == 0
        summary = json.loads((tmp_path / shape / "summary.json").read_text())
        found = {v["criterion"]: v["verdict"] for v in summary["verdicts"]}
        assert found == {"VC-A": verdict, "VC-C": "fail"}


def test_a_simulation_is_laid_beside(tmp_path, monkeypatch, capsys, trundle):
    """The curves are those of the study's runs; another averaging rule is refused."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(GOOD.replace('duration = "4 s"', 'duration = "14 s"'))
    assert trundle("run", "study.toml", "--out", "simulated") == 0
    (cell,) = run_study(load_study(tmp_path / "study.toml")).cells.values()
    (curve,) = read_simulated(tmp_path / "simulated")
    expected = np.percentile(cell.spectra.values[:, 0], [5, 50, 95], axis=0)
    np.testing.assert_allclose(curve.levels, expected, rtol=1e-12)
    write_csv(tmp_path / "r.csv", *tones())
    options = ("--simulation", "simulated", "--point", "tool")
    assert trundle("assess", "r.csv", *options) == 0
    figure = (tmp_path / "r-results" / "figures" / "spectra.svg").read_text()
    assert curve.title == "main, class B, tool"
    assert curve.title in figure
    assert trundle("assess", "r.csv", *options, "--averaging", "event", "--out", "other") == 2
    assert "averaged by max_1s" in capsys.readouterr().err
    assert (
        trundle("assess", "r.csv", "--simulation", "simulated", "--point", "x", "--out", "y") == 2
    )
    assert "no point 'x'; there are tool" in capsys.readouterr().err
