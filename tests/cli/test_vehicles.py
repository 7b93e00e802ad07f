"""Ready vehicles listed and shown."""

import json

import numpy as np
import pytest

from trundle.vehicle import VEHICLES, library_vehicle


def test_the_list_names_all_with_masses_loads_and_trust(trundle, capsys):
    """A line each, and every source behind it."""
    assert trundle("vehicles") == 0
    told = capsys.readouterr().out
    assert all(name[:12] in told for name in VEHICLES)
    assert "EN 1991-1-1" in told
    assert "trust" in told


def test_a_vehicle_is_shown_with_its_numbers_and_a_picture(trundle, capsys, tmp_path):
    """Loads as its equilibrium gives them; a picture that a reader of images takes."""
    out = tmp_path / "truck.png"
    assert trundle("vehicles", "show", "hs20_44", "--out", out) == 0
    told = capsys.readouterr().out
    for word in ("axle 3", "14.5", "AASHTO", "confidence: medium", "assumed: springs", "truck.png"):
        assert word in told
    assert out.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert not list(tmp_path.glob(".*"))


def test_what_is_shown_is_there_for_programs(trundle, capsys, tmp_path):
    """JSON in SI, equal to what the library gives."""
    out = tmp_path / "lift.svg"
    assert trundle("vehicles", "show", "forklift_fl3_laden", "--out", out, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    vehicle = library_vehicle("forklift_fl3_laden")
    np.testing.assert_allclose(told["static_loads_n"], vehicle.static_forces)
    assert told["confidence"] == "low"
    assert "bounce 6 Hz" in told["assumption"]
    assert out.read_text().startswith("<?xml")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("forklift_fl9",), "forklift_fl"),
        (("hs20_44", "--out", "x.doc"), ".png, .svg or .pdf"),
        (("hs20_44", "--speed", "fast"), "--speed"),
        (("hs20_44", "--out", "/nowhere/x.png"), "cannot be written"),
    ],
)
def test_what_cannot_be_shown_is_refused(trundle, capsys, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert trundle("vehicles", "show", *arguments) == 2
    assert words in capsys.readouterr().err
