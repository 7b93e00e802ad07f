"""What stands above a table: names and units of columns, rates, steps and numbers of samples."""

import pytest

from trundle.records.headings import facts_of, is_fact, is_unit, read_heading, usual_unit
from trundle.units import motion_scale

G = 9.80665  # m/s2, the standard gravity of ISO 80000-3


@pytest.mark.parametrize(
    ("spelled", "size", "kind"),
    [
        ("mg", 1e-3 * G, "acceleration"), ("milli-g", 1e-3 * G, "acceleration"),
        ("µg", 1e-6 * G, "acceleration"), ("g_n", G, "acceleration"),
        ("mm/s^2", 1e-3, "acceleration"), ("mm/s**2", 1e-3, "acceleration"),
        ("mm/sec2", 1e-3, "acceleration"), ("mm/(s2)", 1e-3, "acceleration"),
        ("µm/s²", 1e-6, "acceleration"), ("nm.s-2", 1e-9, "acceleration"),
        ("cm/s/s", 1e-2, "acceleration"), ("mGal", 1e-5, "acceleration"),
        ("GAL", 1e-2, "acceleration"), ("ips2", 0.0254, "acceleration"),
        ("in/s/s", 0.0254, "acceleration"), ("mm s-1", 1e-3, "velocity"),
        ("µm.s^-1", 1e-6, "velocity"), ("um/sec", 1e-6, "velocity"), ("IPS", 0.0254, "velocity"),
        ("mkine", 1e-5, "velocity"), ("kine", 1e-2, "velocity"), ("km/s", 1e3, "velocity"),
    ],
)  # fmt: skip
def test_units_of_loggers_have_the_size_that_their_makers_mean(spelled, size, kind):
    """By definition: g = 9.80665 m/s2, Gal = 1 cm/s2, kine = 1 cm/s, inch = 25.4 mm."""
    found, quantity = motion_scale(usual_unit(spelled))
    assert found == pytest.approx(size, rel=1e-12)
    assert quantity == kind


@pytest.mark.parametrize(
    ("text", "name", "unit", "sensor"),
    [
        ("z [mm/s2]", "z", "mm/s2", ""),
        ("Acc. z (m/(s2))", "Acc. z", "m/(s2)", ""),
        ("[mm/s2]", "channel 3", "mm/s2", ""),
        ("Geschwindigkeit / mm/s", "Geschwindigkeit", "mm/s", ""),
        ("slab north, mm/s", "slab north", "mm/s", ""),
        ("acc_z_mg", "acc_z", "mg", ""),
        ("X (40g)", "X", "", "40g"),
        ("X [±2 g]", "X", "", "±2 g"),
        ("X (+/-0,5 g)", "X", "", "+/-0,5 g"),
        ("temperature [°C]", "temperature", "°C", ""),
        ("hall 3", "hall 3", "", ""),
        ("point s", "point s", "", ""),
        ("Point G", "Point G", "", ""),
        ("sensor_g", "sensor_g", "", ""),
        ("Point G [mm/s]", "Point G", "mm/s", ""),
        ("acc_g", "acc", "g", ""),
        ("Acc z g", "Acc z", "g", ""),
        ("a (left) [mm/s]", "a (left)", "mm/s", ""),
        ("<b>z</b> [mm/s]", "<b>z</b>", "mm/s", ""),
        ("", "channel 3", "", ""),
    ],
)
def test_a_heading_is_a_name_and_a_unit_or_a_range(text, name, unit, sensor):
    """As a person reads it; ``40g`` is what a sensor bears, and no unit of its samples."""
    found = read_heading(text, 2)
    assert (found.name, found.unit, found.range) == (name, unit, sensor)


@pytest.mark.parametrize(
    ("lines", "rate"),
    [
        (["Sample rate: 500 Hz"], 500.0),
        (["# Sampling frequency = 0.5 kHz"], 500.0),
        (["fs;512"], 512.0),
        (["Abtastrate:\t200 Hz"], 200.0),
        (["SampleRate, 1e3, Hz"], 1000.0),
        (["dt = 2 ms"], 500.0),
        (["Delta_X\t0,004"], 250.0),
        (["Sampling interval: 5000 us"], 200.0),
        (["Abtastintervall: 2,5 ms"], 400.0),
        (["dt = 2 ms", "rate: 512"], 512.0),
        (["rate: 512", "rate: 100"], 512.0),
        (["Sample rate: 0 Hz"], None),
        (["Sample rate: -500 Hz"], None),
        (["Sample rate: fast"], None),
        (["Sample rate: 500 samples/second"], None),
        (["Bit rate: 500"], None),
        (["Sample rate: 12,800 Hz"], None),
        (["Sample rate: 12,800, Hz"], None),
        (["Sample rate: 25.600 Hz"], None),
        (["Sample rate: 100 000 Hz"], None),
        (["dt = 1,953 us"], None),
        (["dt = 1.953 ms"], 1e3 / 1.953),
        (["Sample rate: 200.000 Hz"], 200.0),
        (["Sample rate: 2.000 kHz"], 2000.0),
        (["Sample rate: 0.500 kHz"], 500.0),
        (["Sample rate: 12,800 Hz", "dt = 0.078125 ms"], 12800.0),
        ([], None),
    ],
)
def test_a_rate_above_the_table_is_in_hertz(lines, rate):
    """By hand, 1 / dt for steps; the rate itself wins over a step, and the first over the next.

    Three digits behind a mark are decimals where thousands would give no sensor's rate, as 200 kHz;
    where both readings are rates, there is none.
    """
    found = facts_of(lines).rate
    assert found == (None if rate is None else pytest.approx(rate, rel=1e-12))


def test_units_and_counts_above_the_table():
    """Units of each channel in their order, and whole numbers of samples alone."""
    found = facts_of(["Y_Unit_Label\tmg\tmm/s2", "Samples: 3000", "Operator: A. B."])
    assert found.units == ("mg", "mm/s2")
    assert found.n_samples == 3000
    assert facts_of(["Units: mm/s"]).units == ("mm/s",)
    assert facts_of(["npts = 12.5"]).n_samples is None
    assert facts_of(["Number of samples: 12"]).n_samples == 12
    for thousands in ("12,800", "12.800", "12 800", "12'800"):
        assert facts_of([f"Samples: {thousands}"]).n_samples == 12800


def test_lines_that_state_something_are_no_headings():
    """A fact has a key that is known; a heading has none, whatever stands behind a comma."""
    for line in ("Sample rate: 500 Hz", "# dt = 2 ms", "unit;mg", "Anzahl Werte: 20"):
        assert is_fact(line), line
    for line in ("time [s],z [mm/s2]", "rate of rise [mm/s2]", "Operator: A. B.", ""):
        assert not is_fact(line), line


def test_words_of_a_line_of_units():
    """Time, motion, volts and what stands in brackets; no number and no name of a direction."""
    for word in ("s", "(%)", "[V]", "mm/s2", "mg", "counts", "ips"):
        assert is_unit(word), word
    for word in ("z", "1", "9.81", "time", "", "x [", "m"):
        assert not is_unit(word), word
