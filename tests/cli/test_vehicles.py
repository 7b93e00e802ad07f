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
        (("hs20_44", "--out", "x.doc"), ".pdf or .png or .svg"),
        (("hs20_44", "--speed", "fast"), "--speed 'fast': "),
        (("hs20_44", "--out", "/nowhere/x.png"), "there is no folder"),
        (("hs20_44", "--out", "c" * 250 + ".png"), "File name too long"),
        (("hs20_44", "--out", "c" * 300 + ".png"), "File name too long"),
    ],
)
def test_what_cannot_be_shown_is_refused(trundle, capsys, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert trundle("vehicles", "show", *arguments) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize("out", ["none/x.png", "c" * 250 + ".png"])
def test_a_picture_that_cannot_be_written_leaves_one_document(
    trundle, capsys, tmp_path, monkeypatch, out
):
    """Programs read one JSON document from a stream: the vehicle, or the mistake."""
    monkeypatch.chdir(tmp_path)
    arguments = ("vehicles", "show", "hs20_44", "--out", out, "--json")
    monkeypatch.setattr("sys.argv", ["trundle", *arguments])
    assert trundle(*arguments) == 2
    assert list(json.loads(capsys.readouterr().out)) == ["error"]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("before", [True, False])
def test_json_counts_wherever_it_stands(trundle, capsys, tmp_path, before):
    """Before the word that follows or behind it: the vehicle's numbers, once."""
    words = ["vehicles", "show", "hs20_44", "--out", tmp_path / "x.png"]
    words.insert(1 if before else 3, "--json")
    assert trundle(*words) == 0
    assert json.loads(capsys.readouterr().out)["name"] == "hs20_44"
