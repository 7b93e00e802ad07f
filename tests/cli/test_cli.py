"""Commands that only show something, and what an import costs."""

import subprocess
import sys

import pytest

from trundle.study_file.build import load_study


def trundle(*arguments, **options):
    return subprocess.run(
        [sys.executable, "-m", "trundle", *map(str, arguments)],
        capture_output=True, text=True, check=False, timeout=120, **options,
    )  # fmt: skip


def test_help_teaches():
    page = trundle("--help")
    assert page.returncode == 0
    for word in ("run", "check", "new", "modes", "criteria", "vehicles", "report.html"):
        assert word in page.stdout


def test_version():
    from trundle import __version__

    assert trundle("--version").stdout.split() == ["trundle", __version__]


def test_criteria_and_vehicles_are_listed():
    criteria = trundle("criteria").stdout
    for word in ("VC-A", "50 um/s at 8 Hz", "0.07 gal", "Ungar", "confidence", "level 9"):
        assert word in criteria
    vehicles = trundle("vehicles").stdout
    for word in ("40.69", "22.91", "loads [t]", "1.97", "source:"):
        assert word in vehicles


def test_a_new_study_is_sound_and_its_plan_is_drawn(tmp_path):
    path = tmp_path / "unit.toml"
    assert trundle("new", path).returncode == 0
    assert load_study(path).title == "My floor"
    page = trundle("check", path)
    assert page.returncode == 0
    assert "no mistakes" in page.stdout
    assert "route access road: 15 km/h" in page.stdout
    modes = trundle("modes", path, "--f-max", "12 Hz")
    assert "none is missing" in modes.stdout


def test_colour_is_left_out_when_asked(tmp_path):
    import os

    page = trundle("criteria", env={**os.environ, "NO_COLOR": "1", "FORCE_COLOR": ""})
    assert "\x1b[3" not in page.stdout


@pytest.mark.parametrize("module", ["matplotlib", "xarray", "pint", "pydantic", "scipy.signal"])
def test_importing_trundle_loads_nothing_heavy(module):
    code = f"import trundle, trundle.cli.app, sys; sys.exit({module!r} in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
