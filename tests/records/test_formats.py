"""Formats are told by content; damaged, cut and hostile files are named, and nothing is executed."""

import io
import os
import pickle
import shutil
import struct
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

from trundle.criteria import find_criterion
from trundle.errors import InputError
from trundle.records import RecordOptions, read_record
from trundle.records.assess import assess_record

FS, N = 400.0, 4000
T = np.arange(N) / FS
Z = 1e-3 * np.sin(2 * np.pi * 10 * T) * np.exp(-(((T - 5.0) / 1.5) ** 2))  # m/s2


class Payload:
    """What runs a command when it is unpickled."""

    def __init__(self, trace):
        self.trace = trace

    def __reduce__(self):
        return os.system, (f"touch {self.trace}",)


def wav_bytes(values=Z):
    file = io.BytesIO()
    wavfile.write(file, int(FS), np.asarray(values, np.float32))
    return file.getvalue()


def mseed_bytes(*traces, **header):
    obspy = pytest.importorskip("obspy")
    base = {"network": "XX", "station": "FLOOR", "sampling_rate": FS}
    file = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        stream = obspy.Stream(
            [obspy.Trace(data=data, header=base | {"channel": c}) for c, data in traces]
        )
        stream.write(file, format="MSEED", **header)
    return file.getvalue()


def uff_bytes(*channels, units=None, pad=0):
    """Text as programs write dataset 58, before it dataset 164; lines padded to 80 columns."""
    lines = []
    if units is not None:
        lines += ["    -1", "   164", "         5mm (milli newton)           2", units,
                  "  0.00000000000000000D+00", "    -1"]  # fmt: skip
    for name, node, way, code, label, values in channels:
        lines += [
            "    -1", "    58", name, "NONE", "25-Nov-26 10:00:00", "NONE", "NONE",
            f"    1         0    0         0 {'NONE':<10}{node:>10}{way:>4} {'NONE':<10}         0   0",
            f"         4{len(values):>10}         1  0.00000E+00  {1 / FS:.5E}  0.00000E+00",
            f"        17    0    0    0 {'Time':<20} {'s':<20}",
            f"{code:>10}    0    0    0 {'NONE':<20} {label:<20}",
            f"         0    0    0    0 {'NONE':<20} {'NONE':<20}",
            f"         0    0    0    0 {'NONE':<20} {'NONE':<20}",
        ]  # fmt: skip
        lines += ["".join(f"{v:20.11E}" for v in values[i : i + 4]) for i in range(0, N, 4)]
        lines += ["    -1"]
    return "\n".join(line.ljust(pad) for line in lines).encode() + b"\n"


def read(tmp_path, data, name, **options):
    (tmp_path / name).write_bytes(data)
    return read_record(tmp_path / name, RecordOptions(**options))


@pytest.mark.parametrize("name", ["r.wav", "r.csv", "r", "r.mseed"])
def test_a_format_is_told_by_what_is_in_the_file(tmp_path, name):
    record = read(tmp_path, wav_bytes(), name, unit="m/s2")
    np.testing.assert_allclose(record.samples[0], Z, atol=1e-9)
    text = "time [s],z [m/s2]\n" + "\n".join(f"{t:.4f},{z:.9g}" for t, z in zip(T, Z, strict=True))
    if name in {"r.csv", "r"}:
        np.testing.assert_allclose(
            read(tmp_path, text.encode(), name).samples[0], Z, atol=1e-9 * np.abs(Z).max()
        )
    else:
        with pytest.raises(InputError, match="whatever its name says"):
            read(tmp_path, text.encode(), name)


def test_units_of_dataset_164_and_padded_lines(tmp_path):
    """1000 of the file's lengths are a metre: samples of acceleration are mm/s2; names by node."""
    pytest.importorskip("pyuff")
    factor = "  1.00000000000000000D+03  1.00000000000000000D+03  1.00000000000000000D+00"
    data = uff_bytes(
        ("NONE", 12, 3, 12, "NONE", 1e3 * Z), ("NONE", 12, 1, 12, "NONE", 2e3 * Z), units=factor,
        pad=80,
    )  # fmt: skip
    record = read(tmp_path, data, "r.uff")
    np.testing.assert_allclose(record.samples, [Z, 2 * Z], atol=1e-9)
    assert record.channel_names == ("12 z", "12 x")
    assert record.axes == ("vertical", "horizontal")
    labelled = uff_bytes(("1x : m/s²", 0, 0, 1, "m/s²", Z), pad=80)
    np.testing.assert_allclose(read(tmp_path, labelled, "r.unv").samples[0], Z, atol=1e-9)


def test_a_universal_file_that_is_cut_loses_no_channel_in_silence(tmp_path):
    pytest.importorskip("pyuff")
    two = (("a", 1, 3, 12, "m/s2", Z), ("b", 2, 3, 12, "m/s2", Z))
    data = uff_bytes(*two)
    assert read(tmp_path, data, "r.uff").channel_names == ("a", "b")
    for share in (0.3, 0.55, 0.8, 0.99):
        with pytest.raises(InputError, match=r"cut short|damaged|says 4000 samples"):
            read(tmp_path, data[: int(share * len(data))], "r.uff")


def test_text_channels_of_miniseed_are_passed_over(tmp_path):
    letters = np.frombuffer(b"started at ten " * 20, dtype="S1")
    both = mseed_bytes(("HHZ", 1e6 * Z), ("LOG", letters))
    record = read(tmp_path, both, "r.mseed", unit="um/s2")
    assert record.channel_names == ("XX.FLOOR..HHZ",)
    assert [note.message for note in record.notes] == [
        "XX.FLOOR..LOG holds text, and is passed over"
    ]
    with pytest.raises(InputError, match="LOG holds text, no samples"):
        read(tmp_path, mseed_bytes(("LOG", letters)), "r.mseed", unit="um/s2")
    long = np.concatenate([Z, Z])
    uneven = mseed_bytes(("HHZ", 1e6 * Z), ("HHN", 1e6 * long))
    with pytest.raises(InputError, match="--channel"):
        read(tmp_path, uneven, "r.mseed", unit="um/s2")
    assert read(tmp_path, uneven, "r.mseed", unit="um/s2", channel="HHN").samples.shape[1] == 2 * N


def test_names_are_no_patterns(tmp_path):
    """``rec[1].mseed`` is that file, and not ``rec1.mseed``."""
    (tmp_path / "rec1.mseed").write_bytes(mseed_bytes(("HHZ", 2e6 * Z)))
    record = read(tmp_path, mseed_bytes(("HHZ", 1e6 * Z)), "rec[1].mseed", unit="um/s2")
    np.testing.assert_allclose(record.samples[0], Z, rtol=1e-9)


@pytest.mark.parametrize("name", ["r.mseed", "r.wav", "r.uff", "r.csv", "r"])
@pytest.mark.parametrize("protocol", range(6))
def test_a_pickle_is_never_opened(tmp_path, name, protocol):
    trace = tmp_path / "trace"
    data = pickle.dumps(Payload(trace), protocol=protocol)
    with pytest.raises(InputError):
        read(tmp_path, data, name, unit="m/s2")
    assert not trace.exists()
    pickle.loads(data)
    assert trace.exists()  # it would have left one


@pytest.mark.parametrize("kind", ["zip", "gztar", "tar"])
def test_archives_are_not_unpacked(tmp_path, kind):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "r.mseed").write_bytes(mseed_bytes(("HHZ", Z)))
    archive = shutil.make_archive(str(tmp_path / "packed"), kind, tmp_path / "in")
    with pytest.raises(InputError):
        read_record(Path(archive), RecordOptions(unit="m/s2"))


@pytest.mark.parametrize("name", ["r.wav", "r.mseed", "r.uff", "r.csv"])
def test_a_pipe_or_a_device_is_no_record(tmp_path, name):
    os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match="device or a pipe"):
        read_record(tmp_path / name, RecordOptions(unit="m/s2"))
    with pytest.raises(InputError, match="device or a pipe"):
        read_record(Path("/dev/zero"), RecordOptions(unit="m/s2"))


def test_a_long_record_is_held_twice_at_most(tmp_path):
    """Numbers of two bytes become eight; with the file and one channel looked at: below 2.6 times."""
    path, full = tmp_path / "long.wav", "20 m/s2"
    counts = np.random.default_rng(1).integers(-30000, 30000, (500_000, 6), dtype=np.int16)
    wavfile.write(path, 500, counts)
    tracemalloc.start()
    record = read_record(path, RecordOptions(full_scale=full))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    np.testing.assert_array_equal(record.samples, 20.0 * (counts.T / 32768.0))
    assert peak < 2.6 * record.samples.nbytes


def test_a_wav_file_cut_short_is_no_record(tmp_path):
    data = wav_bytes()
    whole = 4 * 1993 + len(data) - 4 * N  # bytes: the head and 1993 samples
    with pytest.raises(InputError, match="cut short"):
        read(tmp_path, data[:whole], "r.wav", unit="m/s2")
    with pytest.raises(InputError, match="damaged"):
        read(tmp_path, data[: whole - 1], "r.wav", unit="m/s2")
    absurd = bytearray(data)
    absurd[34:36] = struct.pack("<H", 77)  # bits a sample
    with pytest.raises(InputError, match="damaged WAV"):
        read(tmp_path, bytes(absurd), "r.wav", unit="m/s2")
    for size in (4, 12, 20, 36, 44):
        with pytest.raises(InputError):
            read(tmp_path, data[:size], "r.wav", unit="m/s2")


def read_or_refused(path):
    """Return a record, or the words that refuse it."""
    try:
        return read_record(path, RecordOptions(unit="m/s")), ""
    except InputError as refused:
        return None, str(refused)


@pytest.mark.filterwarnings("ignore")
def test_the_files_of_a_seismic_package_are_read_or_refused_by_name():
    """Its own test data, in place: beside its own reader, sample by sample."""
    obspy = pytest.importorskip("obspy")
    folder = Path(obspy.__file__).parent / "io" / "mseed" / "tests" / "data"
    seen = 0
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        record, refusal = read_or_refused(path)
        assert record is not None or path.name in refusal
        if record is None:
            continue
        stream = obspy.read(path, format="MSEED").merge()
        for name, row in zip(record.channel_names, record.samples, strict=True):
            (trace,) = (t for t in stream if t.id == name)
            np.testing.assert_array_equal(row, np.asarray(trace.data, float))
        seen += 1
    assert seen > 20


def test_directions_are_weighted_and_judged_as_they_are():
    """A tone of 2 Hz, weighted by Wd sideways over 3.57 mm/s2, by Wb upwards over 5 mm/s2.

    A vertical limit says nothing of a sideways channel.
    """
    from trundle.signals import Record

    t = np.arange(0, 40, 1 / 200.0)
    tone = 0.01 * np.sin(2 * np.pi * 2.0 * t)
    record = Record(
        samples=np.stack([tone, tone]), sampling_frequency=200.0, quantity="acceleration",
        channel_names=("z", "x"),
    )  # fmt: skip
    result = assess_record(record, [find_criterion("R-office"), find_criterion("VC-A")])
    up, sideways = result.reduced.response_factor[0]
    rms = 0.01 / np.sqrt(2)
    assert sideways == pytest.approx(rms / 0.00357 * 0.8902, rel=0.01)
    assert up == pytest.approx(rms / 0.005 * 0.4173, rel=0.01)
    axes = {(v.point, v.criterion.name): v.axis for v in result.verdicts}
    assert axes["x", "VC-A"] == "horizontal"
    assert axes["z", "VC-A"] == "vertical"
    limits = {v.point: v for v in result.verdicts if v.criterion.name == "R-office"}
    if limits["z"].criterion.axis == "vertical":
        assert limits["x"].status == "not assessed"
        assert "horizontal" in limits["x"].reasons[0]
