"""Texts as loggers, phones and spreadsheets write them: the same burst comes back from each."""

from itertools import pairwise

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.records import RecordOptions, read_record

FS, N = 500.0, 1200
T = np.arange(N) / FS
Z = 1e-3 * np.sin(2 * np.pi * 10 * T) * np.exp(-(((T - 1.2) / 0.4) ** 2))  # m/s2
G = 9.80665
PLAIN = RecordOptions()


def rows(*columns, mark=",", comma=False):
    lines = [mark.join(map(str, row)) for row in zip(*columns, strict=True)]
    return "\n".join(line.replace(".", ",") if comma else line for line in lines) + "\n"


def fixed(values, decimals=10):
    return [f"{value:.{decimals}f}" for value in values]


def read(tmp_path, text, options=PLAIN, name="r.csv"):
    (tmp_path / name).write_text(text, encoding="utf-8")
    return read_record(tmp_path / name, options)


SECONDS, MMS2, MG = fixed(T, 4), fixed(1e3 * Z), fixed(1e3 * Z / G)
CLOCK = [f"10:{59 + int(t // 1):02d}:00" for t in T]
ISO = [f"2024-05-03T10:00:{t:06.3f}Z" for t in T]
PM = [f"11:59:{59 + t:06.3f} PM" if t < 1 else f"12:00:{t - 1:06.3f} AM" for t in T]
GERMAN_DAY = ["03.05.2024"] * N
GERMAN_CLOCK = [f"10:00:{t:06.3f}".replace(".", ",") for t in T]

FILES = {
    "heading": "time [s],z [mm/s2]\n" + rows(SECONDS, MMS2),
    "title lines": "Data file: floor\nSample rate: 500 Hz\nStart: 2024-05-03\n\nTime (s);Acc z (mm/s2)\n"
    + rows(SECONDS, MMS2, mark=";"),
    "german": "Messung 4\nZeit [s];Beschleunigung z [mm/s²]\n"
    + rows(SECONDS, MMS2, mark=";", comma=True),
    "german, in": "Zeit in s\tBeschleunigung z in mm/s²\n"
    + rows(SECONDS, MMS2, mark="\t", comma=True),
    "german, slash": "Zeit / s;z / mm/s²\n" + rows(SECONDS, MMS2, mark=";", comma=True),
    "unit row": "Time,Channel Z\n(s),(mm/s2)\n\n" + rows(SECONDS, MMS2),
    "bare unit row": "Time;Z\ns;mg\n" + rows(SECONDS, MG, mark=";"),
    "comment heading": "# floor, 3 May\n# time [s] z [mm/s2]\n" + rows(SECONDS, MMS2, mark=" "),
    "percent comments": "% fs = 500\n% unit: mm/s2\n" + rows(SECONDS, MMS2, mark=" "),
    "columns in a comment": ";Title, logger\n;SampleRate, 500,Hz\n;Headers, time,Az\n;Units, mm/s2\n"
    + rows(SECONDS, MMS2),
    "labview": "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\t\nChannels\t1\t\n"
    f"Samples\t{N}\t\nY_Unit_Label\tmg\t\nDelta_X\t0.002\t\n***End_of_Header***\t\n"
    "X_Value\tAcc z\tComment\n" + rows(SECONDS, MG, mark="\t"),
    "rate alone": "Sampling frequency: 0.5 kHz\nz [mm/s2]\n" + rows(MMS2),
    "step alone": "dt = 2 ms\nz [mm/s2]\n" + rows(MMS2),
    "iso stamps": "Timestamp,Z [mm/s2]\n" + rows(ISO, MMS2),
    "past midnight": "Time,Z [mm/s2]\n" + rows(PM, MMS2),
    "date and time": "Datum;Uhrzeit;Z [mm/s2]\n"
    + rows(GERMAN_DAY, GERMAN_CLOCK, [m.replace(".", ",") for m in MMS2], mark=";"),
    "counter": "Sample rate: 500 Hz\ncount,z [mm/s2]\n" + rows(range(1, N + 1), MMS2),
    "words behind": "Time (s),Z (mm/s^2)\n" + rows(SECONDS, MMS2) + "End of file\n",
    "milliseconds": "Time ms,z [mg]\n" + rows(fixed(1e3 * T, 1), MG),
    "unit in the name": "time_s,acc_z_mg\n" + rows(SECONDS, MG),
    "empty last column": "time [s],z [mm/s2],\n" + rows(SECONDS, MMS2, [""] * N),
    "long words": "Time (seconds);Z (mm/s2)\n" + rows(SECONDS, MMS2, mark=";"),
    "unit row of other things": "Time,Z,Load\n(sec),(mm/s2),(%)\n"
    + rows(SECONDS, MMS2, ["3"] * N),
    "quoted": '"Time (s)","Z (mm/s²)"\n' + rows(SECONDS, MMS2),
    "a word in a column": "time [s],z [mm/s2],event\n" + rows(SECONDS, MMS2, ["no"] * N),
}  # fmt: skip


@pytest.mark.parametrize("kind", FILES)
def test_what_loggers_write_is_read(tmp_path, kind):
    """500 samples a second of a known burst, to a part in 1e6 of it."""
    record = read(tmp_path, FILES[kind])
    assert record.sampling_frequency == pytest.approx(FS, rel=1e-6)
    assert record.quantity == "acceleration"
    assert record.axes == (("",) if kind == "percent comments" else ("vertical",))
    np.testing.assert_allclose(record.samples[0], Z, atol=1e-6 * Z.max())


@pytest.mark.parametrize(
    ("unit", "size"),
    [
        ("g", G), ("G", G), ("mG", 1e-3 * G), ("g's", G), ("gs", G), ("m/s^2", 1.0), ("ms-2", 1.0),
        ("m.s-2", 1.0), ("mm.s^-2", 1e-3), ("m/s/s", 1.0), ("m/s²", 1.0), ("gal", 0.01),
        ("µg", 1e-6 * G), ("m s-2", 1.0),
    ],
)  # fmt: skip
def test_units_of_acceleration(tmp_path, unit, size):
    record = read(tmp_path, f"time [s],z [{unit}]\n" + rows(SECONDS, fixed(Z / size, 14)))
    assert record.quantity == "acceleration"
    np.testing.assert_allclose(record.samples[0], Z, atol=1e-6 * Z.max())


@pytest.mark.parametrize(
    ("unit", "size"),
    [("ips", 0.0254), ("in/s", 0.0254), ("kine", 0.01), ("mm/s", 1e-3), ("m.s-1", 1.0),
     ("ms-1", 1.0), ("mm/sec", 1e-3)],
)  # fmt: skip
def test_units_of_velocity(tmp_path, unit, size):
    record = read(tmp_path, f"time [s],z [{unit}]\n" + rows(SECONDS, fixed(Z / size, 14)))
    assert record.quantity == "velocity"
    np.testing.assert_allclose(record.samples[0], Z, atol=1e-6 * Z.max())


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("time [s],z [g]\n0,1,5\n" + rows(SECONDS, MMS2), "line 2 has 3 columns of numbers"),
        ("Sample rate: 1 kHz\ntime [s],z [g]\n" + rows(SECONDS, MMS2), "one is wrong"),
        ("Time,z [g]\n" + rows([s[:19] + "Z" for s in ISO], MMS2), "so coarse.*--rate"),
        ("time [s],X (40g)\n" + rows(SECONDS, MMS2), "looks like the sensor's range.*--unit g"),
        ("time [s],X (+-2 g)\n" + rows(SECONDS, MMS2), "looks like the sensor's range"),
        ("time,z [g]\n" + rows(fixed(1e3 * T, 1), MMS2), r"'time \[ms\]'"),
        ("time,z [g]\n" + rows(fixed(1e9 * T, 0), MMS2), r"says no unit.*time \["),
        ("count,z [g]\n" + rows(range(N), MMS2), "--rate"),
        ("x,z [g]\n" + rows(SECONDS, MMS2), r"'time \[s\]'"),
        ("Samples: 3000\ntime [s],z [g]\n" + rows(SECONDS, MMS2), "cut short"),
        ("time [s],z [g]\n" + rows(SECONDS, MMS2) + "2.4\n", "cut short"),
        ("time [s],z [g]\n" + rows(SECONDS, MMS2) + "2.4,1,1\n", "line 1202 has 3 columns"),
        ("time [s],T [°C]\n" + rows(SECONDS, MMS2), "cannot be used"),
        ("just words\n", "no samples"),
        ("", "no samples"),
    ],
)
def test_what_is_not_said_is_asked_for(tmp_path, text, told):
    with pytest.raises(InputError, match=told):
        read(tmp_path, text)


def test_a_range_is_read_once_its_unit_is_said(tmp_path):
    text = "time [s],X (40g)\n" + rows(SECONDS, fixed(Z / G, 14))
    record = read(tmp_path, text, RecordOptions(unit="g"))
    np.testing.assert_allclose(record.samples[0], Z, atol=1e-6 * Z.max())
    assert record.axes == ("horizontal",)


def test_a_stated_rate_counts_where_stamps_are_coarse(tmp_path):
    """Stamps of whole seconds over 2.4 s leave 500 Hz open to a half; the line above says it."""
    text = "Sample rate: 500 Hz\nTime,z [mm/s2]\n" + rows([s[:19] + "Z" for s in ISO], MMS2)
    assert read(tmp_path, text).sampling_frequency == 500.0


def test_a_unit_said_for_all_leaves_other_quantities_alone(tmp_path):
    text = "time [s],z,T [°C]\n" + rows(SECONDS, MMS2, ["21.5"] * N)
    record = read(tmp_path, text, RecordOptions(unit="mm/s2"))
    assert record.channel_names == ("z",)
    assert record.notes[0].subject == "passed over, T"
    with pytest.raises(InputError, match="leave one out"):
        read(tmp_path, text.replace("z,T", "z [mg],T"), RecordOptions(unit="mm/s2"))


def test_a_counter_beside_a_rate_is_no_channel(tmp_path):
    text = "count,a_x,a_z\n" + rows(range(1, N + 1), fixed(Z / G, 14), fixed(1 + Z / G, 14))
    record = read(tmp_path, text, RecordOptions(unit="g", rate="500 Hz"))
    assert record.channel_names == ("a_x", "a_z")
    assert record.axes == ("horizontal", "vertical")
    assert "counts the samples" in record.notes[0].message


def test_sound_channels_are_assessed_beside_others(tmp_path):
    """A dead cable, a temperature, an overflow and a gap are passed over by name."""
    hole = list(MMS2)
    hole[700] = ""
    text = "time [s],z [mm/s2],dead [mm/s2],T [°C],far [g],hole [mm/s2]\n" + rows(
        SECONDS, MMS2, ["1"] * N, ["21.5"] * N, ["1e7"] * N, hole
    )
    record = read(tmp_path, text)
    assert record.channel_names == ("z",)
    told = {note.subject: note.message for note in record.notes}
    assert set(told) == {f"passed over, {name}" for name in ("dead", "T", "far", "hole")}
    assert "1.4 s" in told["passed over, hole"]


@pytest.mark.parametrize(
    ("wanted", "names"),
    [("y", ("acc y",)), ("acc z", ("acc z",)), ("2", ("acc y",)), ("vertical", ("acc z",)),
     ("horizontal", ("acc x", "acc y")), ("mm/s2", ("acc x", "acc y")), ("3,1", ("acc z", "acc x"))],
)  # fmt: skip
def test_channels_are_chosen(tmp_path, wanted, names):
    text = "time [s],acc x [mm/s2],acc y [mm/s2],acc z [mg]\n" + rows(SECONDS, MMS2, MMS2, MG)
    record = read(tmp_path, text, RecordOptions(channel=wanted))
    assert record.channel_names == names
    with pytest.raises(InputError, match=r"no channel is 'up'; there are 1 'acc x' \[mm/s2\]"):
        read(tmp_path, text, RecordOptions(channel="up"))


def test_stamps_that_jitter_are_taken_to_an_even_time(tmp_path):
    """0.3 ms of jitter at 200 Hz and a clock that wanders a step: a 10 Hz sine to 0.5 %."""
    rng, fs = np.random.default_rng(4), 200.0
    n = 4000
    t = np.arange(n) / fs
    stamps = t + 3e-4 * rng.standard_normal(n) + 2.5e-3 * np.sin(2 * np.pi * t / 20)
    sine = 1e-3 * np.sin(2 * np.pi * 10 * stamps)
    record = read(tmp_path, "time [s],z [m/s2]\n" + rows(fixed(stamps, 9), fixed(sine, 12)))
    assert record.sampling_frequency == pytest.approx(fs, rel=1e-4)
    even = stamps[0] + np.arange(n) / record.sampling_frequency
    expected = 1e-3 * np.sin(2 * np.pi * 10 * even)
    np.testing.assert_allclose(record.samples[0][5:-5], expected[5:-5], atol=5e-6)
    assert "stray by" in record.notes[0].message
    stamps[2000:] += 0.2
    with pytest.raises(InputError, match="gaps in time; the widest after"):
        read(tmp_path, "time [s],z [m/s2]\n" + rows(fixed(stamps, 9), fixed(sine, 12)))
    quicker = np.concatenate([t[:2000], t[1999] + np.arange(1, 2001) / 320])
    with pytest.raises(InputError, match="its rate changes"):
        read(tmp_path, "time [s],z [m/s2]\n" + rows(fixed(quicker, 9), fixed(sine, 12)))


def test_two_channels_of_one_name_are_numbered(tmp_path):
    record = read(tmp_path, "time [s],Acc [g],Acc [g]\n" + rows(SECONDS, MG, MMS2))
    assert record.channel_names == ("Acc (1)", "Acc (2)")


def test_names_say_directions():
    from trundle.signals import axis_of

    for name in ("z", "Z", "acc_z", "Az", "HHZ", "XX.FLOOR..BHZ", "slab vertical", "a z", "UD"):
        assert axis_of(name) == "vertical", name
    for name in ("x", "acc_y", "BHN", "XX.FLOOR.00.HH1", "lateral", "EW", "Ax", "N", "acc_n"):
        assert axis_of(name) == "horizontal", name
    # a place that was weighted as sideways motion would pass what it must not
    for name in ("hall E", "Point N", "hall north", "2 W", "hall 3", "Acc", "x and z", "max"):
        assert axis_of(name) == "", name
    assert not any(a == b for a, b in pairwise(map(axis_of, ("x", "z", "hall"))))
