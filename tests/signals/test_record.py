"""Records: what channels are called, what is refused and in which words, what is doubted."""

import numpy as np
import pytest

from trundle.errors import FitnessWarning, InputError
from trundle.signals import Record, axis_of, channel_fault, doubtful_channels, record_warnings

FS = 200.0


def noise(n_channels=1, seconds=10.0, fs=FS, seed=1):
    return 1e-3 * np.random.default_rng(seed).standard_normal((n_channels, round(seconds * fs)))


def record(samples=None, names=None, **changes):
    samples = noise() if samples is None else samples
    names = names or tuple(f"z{i}" for i in range(len(samples)))
    values = {"sampling_frequency": FS, "quantity": "velocity", "source": "hall <3>.csv"}
    return Record(samples=samples, channel_names=names, **{**values, **changes})


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (("a", "b"), ("a", "b")),
        (("a", "b", "a"), ("a (1)", "b", "a (2)")),
        (("a", "a", "a (1)"), ("a (1)", "a (2)", "a (1) (3)")),
        (("", ""), (" (1)", " (2)")),
        (("Prüf, <b>", "Prüf, <b>"), ("Prüf, <b> (1)", "Prüf, <b> (2)")),
        (("\x1b[2Jz", "a\nb"), ("?[2Jz", "a?b")),
        (("x" * 61, "x" * 60), ("x" * 57 + "...", "x" * 60)),
        (("x" * 70 + "1", "x" * 70 + "2"), ("x" * 57 + "... (1)", "x" * 57 + "... (2)")),
    ],
)
def test_every_channel_has_a_name_of_its_own(given, expected):
    """Verdicts are found by name: equal ones are numbered, and what steers a terminal is shown."""
    made = record(noise(len(given)), given)
    assert made.channel_names == expected
    assert len(set(made.channel_names)) == len(given)


def test_directions_are_given_or_said_by_names():
    """What is given counts before what the name says; a name without a word says nothing."""
    names = ("acc_z", "acc_x", "hall")
    assert record(noise(3), names).axes == ("vertical", "horizontal", "")
    given = ("horizontal", "vertical", "horizontal")
    assert record(noise(3), names, axes=given).axes == given


@pytest.mark.parametrize(
    ("name", "axis"),
    [
        ("Z-axis of pump", "vertical"),
        ("vert.", "vertical"),
        ("Vertikal", "vertical"),
        ("radial", "horizontal"),
        ("slab_y", "horizontal"),
        ("XX.FLOOR.00.HNZ", "vertical"),
        ("box", ""),
        ("Holz", ""),
        ("Ebene", ""),
        ("x / z", ""),
        ("", ""),
        ("hall E", ""),
    ],
)
def test_a_direction_is_a_word_of_its_own(name, axis):
    """The x of a box and the z of wood are letters; two directions in one name are none."""
    assert axis_of(name) == axis


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda x: x.__setitem__((1, 700), np.nan), r"'b' has 1 samples .* the first at 3.5 s"),
        (lambda x: x.__setitem__((1, slice(100, 105)), np.inf), r"'b' has 5 samples .* at 0.5 s"),
        (lambda x: x.__setitem__((0, 3), -2e4), r"'a' reaches 2e\+04 in SI units"),
        (lambda x: x.__setitem__(1, 0.25), r"'b' never moves"),
    ],
)
def test_channels_that_cannot_be_right_are_named_with_their_record(spoil, told):
    """A gap, an impossible size or a dead cable: the level would be wrong or would pass."""
    samples = noise(2)
    spoil(samples)
    with pytest.raises(InputError, match=rf"hall <3>.csv: channel {told}"):
        record(samples, ("a", "b"))


def test_a_sound_channel_has_no_fault():
    """Up to 10,000 in SI units, and however little it moves."""
    assert channel_fault(np.array([1e4, -1e4]), FS) == ""
    assert channel_fault(1e-15 * np.arange(5.0), FS) == ""


@pytest.mark.parametrize(
    ("n", "fs", "told"),
    [
        (31, 10.0, "31 samples are too few; give 32"),
        (500, 2.4, "2.4 Hz shows no band from 1 Hz up"),
        (300, 200.0, r"are 1.5 s, too short for a level over 1 s; give 2 s or more, 400 samples"),
        (32, 16.5, r"give 2 s or more, 33 samples"),
    ],
)
def test_records_too_short_or_too_slow_say_what_would_do(n, fs, told):
    """Levels are over 1 s, bands from 1 Hz, which needs 2.5 samples a second (IEC 61260)."""
    with pytest.raises(InputError, match=told):
        record(np.random.default_rng(1).standard_normal((1, n)), sampling_frequency=fs)
    enough = np.random.default_rng(1).standard_normal((1, 400))
    assert record(enough).duration == 2.0


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"sampling_frequency": 0.0}, "sampling_frequency must be greater than 0"),
        ({"sampling_frequency": np.nan}, "sampling_frequency must be finite"),
        ({"axes": ("vertical", "vertical")}, "axes: 1 are needed, one for each channel"),
    ],
)
def test_settings_that_do_not_belong_are_refused(changes, told):
    """A rate of no number, or more directions than channels."""
    with pytest.raises(InputError, match=told):
        record(**changes)


def test_a_record_is_not_changed_from_outside():
    """What a caller does to its own array afterwards does not reach the record."""
    given = noise()
    made = record(given)
    given[0, 0] = 9.0
    assert made.samples[0, 0] != 9.0
    with pytest.raises(ValueError, match="read-only"):
        made.samples[0, 0] = 1.0


def test_the_lowest_band_is_that_of_8_periods():
    """4 s hold 8 periods of 2 Hz; the doubt says so, and how long shows all."""
    made = record(noise(seconds=4.0))
    assert made.lowest_frequency == pytest.approx(2.0)
    doubts = {w.subject: w.message for w in record_warnings(made)}
    assert doubts["record length"].startswith("4 s hold 8 periods of 2 Hz")
    whole = {w.subject for w in record_warnings(record(noise(seconds=8.0)))}
    assert "record length" not in whole


@pytest.mark.parametrize(("fs", "top"), [(100.0, "40 Hz"), (50.0, "20 Hz"), (200.0, None)])
def test_slow_sampling_is_doubted_by_the_band_that_it_shows(fs, top):
    """A band needs 2.5 samples to its middle's period: 200 Hz show all to 80 Hz."""
    made = record(noise(fs=fs), sampling_frequency=fs)
    told = [w.message for w in record_warnings(made) if w.subject == "sampling rate"]
    assert bool(told) is (top is not None)
    if top:
        assert f"{fs:g} Hz shows bands to {top}" in told[0]


def test_channels_without_a_direction_are_listed_up_to_four():
    """They are judged as vertical, and the reader is told which."""
    made = record(noise(7), ("a", "z1", "b", "c", "d", "f", "x"))
    (told,) = (w.message for w in record_warnings(made) if w.subject == "axis")
    assert told.startswith("a, b, c, d ...: the name says no direction")
    assert not [w for w in record_warnings(record(noise(2), ("z", "x"))) if w.subject == "axis"]


def test_what_was_told_on_reading_is_told_again_first():
    """A reader's note about a repaired gap belongs to the doubts."""
    note = FitnessWarning(subject="gap", message="3 samples were filled")
    assert record_warnings(record(notes=(note,)))[0] is note


def test_only_the_overloaded_channel_is_doubted():
    """A sine cut at 60 % of its height beside the whole one, and beside one held for a second."""
    t = np.arange(0, 10, 1 / FS)
    sine = 1e-3 * np.sin(2 * np.pi * 3.7 * t)
    held = sine.copy()
    held[800:1000] = held[800]
    made = record(np.stack([sine, np.clip(sine, -6e-4, 1.0), held]), ("a", "b", "c"))
    assert doubtful_channels(made) == ("b", "c")
    subjects = [w.subject for w in record_warnings(made)]
    assert "clipped, b" in subjects
    assert "held, c" in subjects
    assert not [s for s in subjects if s.endswith(", a")]


@pytest.mark.parametrize(("at", "subject"), [(0.0, "starts"), (10.0, "ends"), (5.0, None)])
def test_an_event_at_an_end_is_doubted_there(at, subject):
    """A burst of 8 Hz cut by the record's start or end; in its middle it is whole."""
    t = np.arange(0, 10, 1 / FS)
    event = 1e-3 * np.exp(-(((t - at) / 0.4) ** 2)) * np.cos(2 * np.pi * 8 * (t - at))
    quiet = 1e-6 * np.random.default_rng(3).standard_normal(len(t))
    made = record((event + quiet)[None], ("z <i>",))
    told = [w.subject for w in record_warnings(made) if w.subject.startswith("record ")]
    assert told == ([f"record {subject}, z <i>"] if subject else [])
