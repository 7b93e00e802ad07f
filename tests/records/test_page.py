"""The page on records holds what the reader does: each example in it is read."""

import re
from pathlib import Path

import numpy as np
import pytest

from trundle.errors import InputError
from trundle.records.headings import usual_unit
from trundle.records.table import read_table
from trundle.units import motion_scale

PAGE = (Path(__file__).parents[2] / "docs" / "records.md").read_text("utf-8")
EXAMPLES = re.findall(r"```text\n(.*?)```\n\n`(.*?)` in `(.*?)` at (\d+) Hz", PAGE, re.DOTALL)
UNITS = {
    kind: re.findall(r"`([^`]+)`", row)
    for kind, row in re.findall(r"^\| (acceleration|velocity) \| (.*?) \|$", PAGE, re.MULTILINE)
}


@pytest.mark.parametrize(("text", "name", "unit", "rate"), EXAMPLES)
def test_each_example_is_read_as_the_page_says(text, name, unit, rate):
    raw = read_table(text.encode(), Path("example"))
    assert (raw.names, raw.units) == ((name,), (unit,))
    assert raw.rate == pytest.approx(float(rate))
    np.testing.assert_allclose(raw.samples, [[0.11, 0.13, 0.12]])


@pytest.mark.parametrize(("kind", "unit"), [(k, unit) for k, row in UNITS.items() for unit in row])
def test_each_unit_is_understood(kind, unit):
    if unit in {"m", "u", "µ", "n", "k"}:
        with pytest.raises(InputError):
            motion_scale(unit)  # a prefix alone
        assert motion_scale(usual_unit(f"{unit}m/s2"))[1] == "acceleration"
    else:
        assert motion_scale(usual_unit(unit))[1] == kind


def test_there_are_examples():
    assert len(EXAMPLES) == 8
    assert len(UNITS["acceleration"]) > 10
