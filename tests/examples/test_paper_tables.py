"""The kept tables of the paper's cells are those of the study as it is, and of the code as it is."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from trundle.study_file.build import load_study

ROOT = Path(__file__).parents[2]
if not (ROOT / "scripts" / "paper_tables.py").exists():
    pytest.skip("the scripts are not here", allow_module_level=True)
sys.path.insert(0, str(ROOT / "scripts"))

import paper_tables  # noqa: E402  (the scripts' folder is on the path first)

KEPT = json.loads(paper_tables.KEPT.read_text("utf-8"))
METHODS = ("decoupled", "coupled")


@pytest.fixture(scope="module")
def study():
    return load_study(paper_tables.STUDY)


def medians(quantity, road, method):
    return {
        row["case"]: row[quantity][1]
        for row in KEPT["cells"]
        if (row["road"], row["method"]) == (road, method)
    }


def test_they_are_of_the_study_as_it_is(study):
    """Whoever changes the study runs the script again."""
    assert KEPT["study_hash"] == study.content_hash
    assert (KEPT["seed"], KEPT["runs"]) == (study.seed, study.runs)
    printed = [(p.case, p.road, p.method) for p in study.printed]
    assert [(r["case"], r["road"], r["method"]) for r in KEPT["cells"]] == printed
    assert {r["bound"] for r in KEPT["bounds"]} == {p.bound for p in study.printed_bounds}


@pytest.mark.parametrize("quantity", ["peak", "rms"])
def test_bounds_are_made_of_the_medians_of_single_roads(quantity):
    """Largest, sum and root of squares of four medians; rounding is to five digits."""
    rules = {
        "largest single route": max,
        "sum": sum,
        "root sum of squares": lambda values: np.sqrt(np.sum(np.square(values))),
    }
    checked = 0
    for row in KEPT["bounds"]:
        if row["rule"] in rules:
            values = list(medians(quantity, row["road"], row["method"]).values())
            assert len(values) == 4
            assert row[quantity] == pytest.approx(rules[row["rule"]](values), rel=1e-4)
            checked += 1
    assert checked == 12


@pytest.mark.longest
def test_the_code_as_it_is_gives_them(study):
    """The same seed: all that differs between machines is the rounding of their linear algebra."""
    found = paper_tables.ours(study)
    for part in ("cells", "bounds"):
        assert len(found[part]) == len(KEPT[part])
        for now, kept in zip(found[part], KEPT[part], strict=True):
            assert now.keys() == kept.keys()
            for name, value in now.items():
                if isinstance(value, str):
                    assert value == kept[name]
                elif name.endswith("_rank"):  # a run beside a printed number may change sides
                    assert value == pytest.approx(kept[name], abs=100.0 / KEPT["runs"])
                else:
                    np.testing.assert_allclose(value, kept[name], rtol=1e-3)
