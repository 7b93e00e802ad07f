"""Names in a file neither steer a terminal nor run in a spreadsheet."""

import csv

import numpy as np
import pytest

from trundle._csv import write_csv
from trundle.signals import Record


def test_control_characters_and_endless_names_are_not_shown():
    rng = np.random.default_rng(1)
    record = Record(
        samples=rng.standard_normal((3, 1000)), sampling_frequency=200.0, quantity="velocity",
        channel_names=("z\x1b[31m\x07", "x" * 3000, "hall\n3"),
    )  # fmt: skip
    assert record.channel_names == ("z?[31m?", "x" * 57 + "...", "hall?3")


@pytest.mark.parametrize("text", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1"])
def test_no_cell_is_a_formula(tmp_path, text):
    """A spreadsheet runs what begins with = + - @; numbers stay numbers."""
    write_csv(tmp_path / "t.csv", ["name", text], [[text, -1.5], ["-1.5e-3", 2]])
    with (tmp_path / "t.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows == [["name", "'" + text], ["'" + text, "-1.5"], ["-1.5e-3", "2"]]
