"""A record of any format in SI: scales by hand, contradictions and sizes that are refused."""

from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

from trundle.errors import InputError
from trundle.records import RecordOptions, read, read_record
from trundle.records.foreign import foreign
from trundle.records.record_format import all_formats, format_of

G = 9.80665
FS = 400
WAVE = np.sin(2.0 * np.pi * 5.0 * np.arange(2400) / FS)


def table(path, heading, *columns):
    rows = "\n".join(",".join(f"{x:.9g}" for x in row) for row in zip(*columns, strict=True))
    path.write_text(f"{heading}\n{rows}\n", encoding="utf-8")
    return path


@pytest.fixture
def seconds():
    return np.arange(2400) / FS


@pytest.mark.parametrize(
    ("dtype", "full", "offset"),
    [(np.int16, 2.0**15, 0.0), (np.int32, 2.0**31, 0.0), (np.uint8, 128.0, 128.0)],
)
def test_whole_numbers_of_a_wav_file_are_shares_of_its_full_scale(tmp_path, dtype, full, offset):
    """Half of full scale at 20 m/s2 is 10 m/s2, for 8 bits around 128 and for 16 and 32 around 0."""
    numbers = np.round(offset + 0.5 * full * WAVE).astype(dtype)
    wavfile.write(tmp_path / "r.wav", FS, numbers)
    found = read_record(tmp_path / "r.wav", RecordOptions(full_scale="20 m/s2"))
    assert found.quantity == "acceleration"
    np.testing.assert_allclose(found.samples[0], 10.0 * WAVE, atol=20.0 / full)


@pytest.mark.parametrize(
    ("options", "size"),
    [
        ({"full_scale": "10 V", "sensitivity": "1000 mV/g"}, 10.0 * G),
        ({"full_scale": "5 V", "sensitivity": "20 V/(m/s2)"}, 0.25),
        ({"full_scale": "2 mm/s"}, 2e-3),
        ({"unit": "mm/s"}, 1e-3),
    ],
)
def test_volts_become_motion_by_the_sensitivity(tmp_path, options, size):
    """By hand: 10 V at 1 V/g are 10 g; 5 V at 20 V/(m/s2) are 0.25 m/s2; floats may bear a unit."""
    wavfile.write(tmp_path / "r.wav", FS, np.stack([WAVE, 0.5 * WAVE], axis=1).astype(np.float32))
    found = read_record(tmp_path / "r.wav", RecordOptions(**options))
    assert found.channel_names == ("channel 1", "channel 2")
    np.testing.assert_allclose(found.samples, size * np.stack([WAVE, 0.5 * WAVE]), atol=1e-6 * size)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"full_scale": "0 m/s2"}, "'0 m/s2' must be greater than 0"),
        ({"full_scale": "-20 m/s2"}, "'-20 m/s2' must be greater than 0"),
        ({"full_scale": "20"}, "--full-scale: unit '20' is neither acceleration nor velocity"),
        ({"full_scale": "10 V"}, "with a sensitivity"),
        ({"unit": "V", "sensitivity": "-1 V/g"}, "must be greater than 0"),
        ({"unit": "furlong"}, "cannot be used: --unit: unit 'furlong' is neither"),
        ({}, "has no unit"),
    ],
)
def test_a_scale_that_is_none_is_refused_with_the_channel(tmp_path, options, told):
    """Each would turn the record's sign, or make it nothing or anything."""
    wavfile.write(tmp_path / "r.wav", FS, WAVE.astype(np.float32))
    with pytest.raises(InputError, match=r"r\.wav: channel 'channel 1'") as refused:
        read_record(tmp_path / "r.wav", RecordOptions(**options))
    assert told in str(refused.value)


def test_every_channel_has_its_own_unit(tmp_path, seconds):
    """1 g, 1 m/s2 and 100 gal beside each other: 9.80665, 1 and 1 m/s2."""
    path = table(
        tmp_path / "r.csv", "t [s],a [g],b [m/s2],c [gal]", seconds, WAVE, WAVE, 100 * WAVE
    )
    found = read_record(path, RecordOptions())
    np.testing.assert_allclose(found.samples, np.stack([G * WAVE, WAVE, WAVE]), atol=1e-7)
    assert found.sampling_frequency == pytest.approx(FS)


def test_a_channel_without_a_unit_is_passed_over_by_name_beside_a_sound_one(tmp_path, seconds):
    """The other is assessed; what was left out is told, with how to have it."""
    path = table(tmp_path / "r.csv", "t [s],z [mm/s],<i>bare</i>", seconds, WAVE, WAVE)
    found = read_record(path, RecordOptions())
    assert found.channel_names == ("z",)
    (note,) = found.notes
    assert note.subject == "passed over, <i>bare</i>"
    assert "say --unit" in note.message
    # --channel asks for it alone: then there is nothing left to read
    with pytest.raises(InputError, match="channel '<i>bare</i>' has no unit"):
        read_record(path, RecordOptions(channel="2"))


@pytest.mark.parametrize(
    ("rate", "ok"), [("400 Hz", True), ("401.9 Hz", True), ("0.4 kHz", True), ("405 Hz", False)]
)
def test_a_stated_rate_must_be_that_of_the_stamps(tmp_path, seconds, rate, ok):
    """Within half a percent of 400 Hz it may be nominal, and the stamps count; beyond one is wrong."""
    path = table(tmp_path / "r.csv", "t [s],z [mm/s]", seconds, WAVE)
    if ok:
        found = read_record(path, RecordOptions(rate=rate))
        assert found.sampling_frequency == pytest.approx(400.0, rel=1e-9)
        return
    with pytest.raises(InputError, match=r"says 400 Hz, and --rate 405 Hz; one is wrong"):
        read_record(path, RecordOptions(rate=rate))


def test_a_rate_that_shows_no_band_is_refused(tmp_path):
    """The lowest band ends at 1.12 Hz, and 1 Hz shows motion to 0.4 Hz."""
    path = table(tmp_path / "r.csv", "z [mm/s]", WAVE)
    with pytest.raises(InputError, match="1 Hz shows no band"):
        read_record(path, RecordOptions(rate="1 Hz"))


@pytest.mark.parametrize("rate", ["0 Hz", "-400 Hz", "400", "400 kg", "nan Hz", "12,800 Hz"])
def test_a_rate_that_is_none_is_refused_by_its_option(tmp_path, rate):
    """Without a time column it alone says what a second is; several options may lack a unit."""
    path = table(tmp_path / "r.csv", "z [mm/s]", WAVE)
    with pytest.raises(InputError, match=f"--rate '{rate}': "):
        read_record(path, RecordOptions(rate=rate))


def test_the_name_of_a_file_is_kept_as_people_can_read_it(tmp_path, seconds):
    """Umlauts stay; what steers a terminal becomes a question mark; folders are left out."""
    path = table(tmp_path / "Größe, \x1b[2J.csv", "t [s],z [mm/s]", seconds, WAVE)
    assert read_record(path, RecordOptions()).source == "Größe, ?[2J.csv"


def test_files_that_are_too_large_are_not_read(tmp_path, monkeypatch, seconds):
    """A limit of 100 bytes in place of 2 GB, and of 90 for a text: refused by size alone."""
    path = table(tmp_path / "r.csv", "t [s],z [mm/s]", seconds, WAVE)
    monkeypatch.setattr(read, "_LARGEST_TEXT", 90)
    with pytest.raises(InputError, match="a text is at most 300 MB; cut it into events"):
        read_record(path, RecordOptions())
    wavfile.write(tmp_path / "r.wav", FS, WAVE.astype(np.float32))
    assert read_record(tmp_path / "r.wav", RecordOptions(unit="mm/s")).samples.shape == (1, 2400)
    monkeypatch.setattr(read, "_LARGEST", 100)
    with pytest.raises(InputError, match="at most 2 GB; cut it into events"):
        read_record(tmp_path / "r.wav", RecordOptions(unit="mm/s"))


def test_what_other_programs_write_is_told_with_the_way_out(tmp_path):
    """First bytes by the formats' own descriptions; the name does not matter."""
    for data, word in (
        (b"PK\x03\x04 sheet", "save the sheet as CSV"),
        (b"\x1f\x8b\x08", "unpack it"),
        (b"\x89HDF\r\n\x1a\n", "export it as CSV or UFF 58"),
        (b"MATLAB 5.0 MAT-file", "export it as CSV or UFF 58"),
        (b"%PDF-1.7", "ask for the numbers"),
    ):
        (tmp_path / "r.csv").write_bytes(data)
        with pytest.raises(InputError, match=word) as refused:
            read_record(tmp_path / "r.csv", RecordOptions())
        assert str(refused.value).startswith(f"{tmp_path / 'r.csv'}: is ")
    assert foreign(b"time [s],z [mm/s]\n0,1\n") == ""
    assert foreign(b"") == ""


def test_no_two_formats_claim_one_file(tmp_path):
    """A WAV file is claimed once, a text by none, and every format has endings of its own."""
    wavfile.write(tmp_path / "r.wav", FS, WAVE.astype(np.float32))
    data = (tmp_path / "r.wav").read_bytes()[:512]
    assert [one.name for one in all_formats() if one.claims(data)] == [format_of(data).name]
    assert format_of(b"time [s],z [mm/s]\n0,1\n0.1,2\n") is None
    assert format_of(b"") is None
    endings = [suffix for one in all_formats() for suffix in one.suffixes]
    assert len(endings) == len(set(endings))
    assert all(suffix.startswith(".") and suffix == suffix.lower() for suffix in endings)


def test_what_is_no_file_is_told_with_its_path(tmp_path):
    """A folder and nothing at all are two mistakes, and have two remedies."""
    with pytest.raises(InputError, match="is a folder; name the record in it"):
        read_record(tmp_path, RecordOptions())
    with pytest.raises(InputError, match=r"nothing.csv: no such file"):
        read_record(Path(tmp_path / "nothing.csv"), RecordOptions())
