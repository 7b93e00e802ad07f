"""A criterion that is not met sets the exit code, where it is asked to."""

import numpy as np
import pytest


@pytest.fixture
def record(tmp_path, monkeypatch):
    """Thirty seconds of 30 um/s at 10 Hz: within VC-A (50 um/s), above VC-C (12.5 um/s)."""
    monkeypatch.chdir(tmp_path)
    t = np.arange(0, 30, 1 / 400)
    v = np.sqrt(2) * 30e-6 * np.sin(2 * np.pi * 10 * t)
    rows = "\n".join(f"{a:.4f},{b:.9g}" for a, b in zip(t, v, strict=True))
    (tmp_path / "r.csv").write_text(f"time [s],z [m/s]\n{rows}\n")
    return "r.csv"


@pytest.mark.parametrize(
    ("criteria", "code"), [(["VC-A"], 0), (["vc-c"], 3), (["VC-A", "VC-C"], 3)]
)
def test_the_exit_code_follows_the_criteria_asked_for(record, trundle, capsys, criteria, code):
    asked = [word for name in criteria for word in ("--fail-on", name)]
    assert trundle("assess", record, *asked) == code
    printed = capsys.readouterr().out
    assert ("not met: r.csv, z, VC-C: fail" in printed) == (code == 3)


def test_what_is_not_assessed_is_not_met(record, trundle, capsys, tmp_path):
    """Five seconds hold no 8 periods of 1 Hz: 0.3 um/s are far below VC-C, and yet no pass."""
    rows = (tmp_path / record).read_text().splitlines()[1 : 5 * 400]
    text = "\n".join(
        row.partition(",")[0] + f",{0.01 * float(row.split(',')[1]):.9g}" for row in rows
    )
    (tmp_path / "short.csv").write_text("time [s],z [m/s]\n" + text)
    assert trundle("assess", "short.csv", "--fail-on", "VC-C") == 3
    assert "not met: short.csv, z, VC-C: not assessed" in capsys.readouterr().out


def test_an_unknown_name_is_refused_before_work(record, trundle, capsys):
    assert trundle("assess", record, "--fail-on", "VC-Z") == 2
    assert "there are" in capsys.readouterr().err
