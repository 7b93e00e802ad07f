"""What half the mesh size changes, as it is printed: bands, levels, signs and what a mesh carries."""

from dataclasses import replace

import numpy as np
import pytest

from studies import GOOD
from trundle.cli import meshes_command
from trundle.errors import InputError
from trundle.run.meshes import MeshComparison
from trundle.signals import mid_band_frequencies
from trundle.study_file import study_from_text


@pytest.fixture
def compared(monkeypatch, tmp_path):
    """Two points in the bands of 4, 8 and 16 Hz, by hand; the study is the small one."""
    path = tmp_path / "s.toml"
    path.write_text(GOOD)
    bands = mid_band_frequencies()[[6, 9, 12]]
    levels = np.array([[[20e-6, 30e-6, 5e-6], [1e-6, 1e-6, 1e-6]],
                       [[10e-6, 40e-6, 5e-6], [3e-6, 1e-6, 1e-9]]])  # fmt: skip
    found = MeshComparison(
        sizes=(1.5, 0.75), case="main", road="B", method="coupled", points=("[b]tool", "two"),
        bands=bands, levels=levels,
    )  # fmt: skip
    monkeypatch.setattr(meshes_command, "compare_meshes", lambda _study, *, tell: found)
    return path


def rows_of(text):
    return [
        [cell.strip() for cell in line.strip("│").split("│")]
        for line in text.splitlines()
        if line.startswith("│")
    ]


def test_levels_and_changes_are_those_of_each_point_and_band(compared, capsys):
    """By hand: 20 against 10 um/s is +100 %, 30 against 40 is -25 %, 1 against 3 is -67 %."""
    meshes_command.compare(compared)
    said = capsys.readouterr().out
    assert [row[:4] for row in rows_of(said)] == [
        ["4", "20", "10", "+100 %"],
        ["8", "30", "40", "-25 %"],
        ["16", "5", "5", "+0 %"],
        ["4", "1", "3", "-67 %"],
        ["8", "1", "1", "+0 %"],
        ["16", "1", "0.001", "+99900 %"],
    ]
    assert "[b]tool: main, road B, coupled; rms velocity [um/s]" in said
    assert "set mesh_size to 0.75 m" in " ".join(said.split())


def test_levels_are_in_the_unit_of_the_study_s_report(compared, capsys):
    """20 um/s are 0.02 mm/s; changes have no unit."""
    compared.write_text(GOOD + '\n[report]\nvelocity = "mm/s"\n')
    meshes_command.compare(compared)
    said = capsys.readouterr().out
    assert rows_of(said)[0][:4] == ["4", "0.02", "0.01", "+100 %"]
    assert "rms velocity [mm/s]" in said


def test_a_band_is_carried_where_seven_elements_span_a_wave(compared, capsys):
    """2 pi sqrt(D / m) / (7 h)^2 with D = 30 GPa 0.2^3 / 12 (nu = 0.2) and 790 kg/m2: 9.3 Hz."""
    meshes_command.compare(compared)
    assert [row[4] for row in rows_of(capsys.readouterr().out)] == ["yes", "yes", "no"] * 2
    study = study_from_text(GOOD)
    plate = study.plan.slab
    stiff = plate.material.elastic_modulus * plate.thickness**3 / 12.0
    stiff /= 1.0 - plate.material.poisson_ratio**2
    mass = plate.material.density * plate.thickness + plate.superimposed_mass
    reach = 2.0 * np.pi * np.sqrt(stiff / mass) / (7.0 * 1.5) ** 2
    assert meshes_command._reach(study, 1.5) == pytest.approx(reach, rel=0.02)
    assert meshes_command._reach(study, 0.75) == pytest.approx(4.0 * reach, rel=0.02)
    # of a mesh that came as it is nothing is known against it
    assert meshes_command._reach(replace(study, plan=None), 1.5) == np.inf


def test_a_comparison_that_takes_hours_is_asked_for(compared, monkeypatch, capsys):
    """Refused before any table; --yes has it as it is."""
    monkeypatch.setattr("trundle.cli.afford.memory_there_is", lambda: 1e3)
    with pytest.raises(InputError, match=r"on half its mesh size: it would take .* say --yes"):
        meshes_command.compare(compared)
    assert "um/s" not in capsys.readouterr().out
    meshes_command.compare(compared, yes=True)
    assert "um/s" in capsys.readouterr().out
