"""Modes of universal files: what datasets say, and files that say too little."""

from pathlib import Path

import numpy as np
import pytest

from trundle.imports import units_of
from trundle.imports.modes_uff import read_universal_modes

pytest.importorskip("pyuff", reason="an extra")

SI = units_of("N, m")
DATA = Path(__file__).parents[3] / "shared" / "data" / "models" / "uff"


def dataset(number, *lines):
    return "\n".join(["    -1", f"{number:6d}", *lines, "    -1"]) + "\n"


PLACES = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
NODES = dataset(
    15,
    *(
        f"{i:10d}{0:10d}{0:10d}{8:10d}{x:13.5e}{y:13.5e}{1.2:13.5e}"
        for i, (x, y) in enumerate(PLACES, start=1)
    ),
)
QUAD = dataset(
    2412, f"{1:10d}{94:10d}{1:10d}{1:10d}{7:10d}{4:10d}", f"{1:10d}{2:10d}{3:10d}{4:10d}"
)
UNITS = dataset(
    164, f"{1:10d}{'SI: Meter (newton)':20s}{2:10d}",
    f"{1.0:25.17e}{1.0:25.17e}{1.0:25.17e}", f"{-273.15:25.17e}",
)  # fmt: skip


def normal(number, frequency, mass, motion, kind=8):
    head = [f"title {i}" for i in range(5)]
    head += [f"{1:10d}{2:10d}{2:10d}{kind:10d}{2:10d}{3:10d}"]
    head += [f"{2:10d}{4:10d}{1:10d}{number:10d}"]
    head += [f"{frequency:13.5e}{mass:13.5e}{0.01:13.5e}{0.0:13.5e}"]
    rows = [
        line
        for i, z in enumerate(motion, start=1)
        for line in (f"{i:10d}", f"{0.0:13.5e}{0.0:13.5e}{z:13.5e}")
    ]
    return dataset(55, *head, *rows)


def damped(number, eigenvalue, modal_a, motion):
    head = [f"title {i}" for i in range(5)]
    head += [f"{1:10d}{3:10d}{2:10d}{8:10d}{5:10d}{3:10d}"]
    head += [f"{2:10d}{6:10d}{1:10d}{number:10d}"]
    numbers = (eigenvalue.real, eigenvalue.imag, modal_a.real, modal_a.imag, 0.0, 0.0)
    head += ["".join(f"{one:13.5e}" for one in numbers)]
    rows = [
        line
        for i, z in enumerate(motion, start=1)
        for line in (
            f"{i:10d}",
            f"{0.0:13.5e}{0.0:13.5e}{0.0:13.5e}{0.0:13.5e}{z.real:13.5e}{z.imag:13.5e}",
        )
    ]
    return dataset(55, *head, *rows)


MODES = normal(1, 6.5, 2000.0, [0.1, 1.0, 0.9, 0.2]) + normal(2, 9.25, 500.0, [-1.0, 0.4, 0.1, 0.3])


def read(tmp_path, text, **asked):
    path = tmp_path / "modes.uff"
    path.write_text(text)
    return read_universal_modes(path, **asked)


def test_normal_modes_are_scaled_by_their_masses(tmp_path):
    found = read(tmp_path, UNITS + NODES + QUAD + MODES)
    assert found.problems == ()
    model = found.structure
    assert model.omega / (2.0 * np.pi) == pytest.approx([6.5, 9.25])
    vertical = model.shapes[model.dof_index[:, 2]]
    assert vertical[:, 0] == pytest.approx(np.array([0.1, 1.0, 0.9, 0.2]) / np.sqrt(2000.0))
    assert (model.dof_index[:, [0, 1, 3, 4, 5]] == -1).all()  # zero in all modes: not measured
    assert model.surface().frame.origin[2] == 1.2
    assert [face.connectivity.shape for face in model.faces] == [(1, 4)]


def test_a_complex_mode_of_a_damped_body_is_its_real_one(tmp_path):
    """Mass 800 kg at 7 Hz, 2 %: modal A is 2 i w_d m times the square of the shape's factor."""
    shape, factor, mass = np.array([0.1, 1.0, 0.9, 0.2]), 0.3 - 1.1j, 800.0
    omega, ratio = 2.0 * np.pi * 7.0, 0.02
    pole = omega * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    text = UNITS + NODES + QUAD
    text += damped(1, pole, 2j * pole.imag * mass * factor**2, shape * factor)
    found = read(tmp_path, text)
    assert found.problems == ()
    model = found.structure
    assert model.omega[0] == pytest.approx(omega, rel=1e-4)
    vertical = model.shapes[model.dof_index[:, 2], 0]
    assert np.abs(vertical) == pytest.approx(shape / np.sqrt(mass), rel=1e-4)
    crooked = damped(1, pole, 2j * pole.imag * mass, np.array([0.1, 1j, 0.9, 0.2]))
    assert "% of one is off its phase" in str(
        read(tmp_path, UNITS + NODES + QUAD + crooked).problems[0]
    )


TURNED = NODES.replace(f"{2:10d}{0:10d}{0:10d}", f"{2:10d}{0:10d}{3:10d}")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (MODES, "has no nodes (dataset 15 or 2411)"),
        (UNITS + NODES + QUAD, "has no modes (dataset 55)"),
        (NODES + MODES.replace("2.00000e+03", "0.00000e+00"), "nothing tells the scale"),
        (TURNED + MODES, "node 2 moves in a system of its own (3)"),
        (NODES + normal(1, 5.0, 1.0, [1.0] * 4, kind=12), "holds data of type 12"),
        (NODES + normal(1, 0.0, 1.0, [1.0] * 4), "a frequency must be above 0"),
        (NODES + normal(1, 5.0, 1.0, [1.0] * 5), "names node 5, which is not in modes.uff"),
        (NODES + normal(1, 5.0, 1.0, [0.0] * 4), "no node's vertical motion is known"),
        (NODES + MODES[:-200], "cut short"),
        ("hello\n", "is no universal file"),
        (
            NODES + MODES.replace(f"{2:10d}\n{0.0:13.5e}", f"{1:10d}\n{0.0:13.5e}", 1),
            "known in some modes and not in others",
        ),
        (
            NODES.replace(f"{2:10d}{0:10d}{0:10d}", f"{2:10d}{4:10d}{0:10d}") + MODES,
            "is placed in a",
        ),
        (NODES + MODES.replace(f"{1.0:13.5e}", "  1.0000a+00 "), "is a damaged universal file"),
    ],
)
def test_files_that_say_too_little_are_refused(tmp_path, text, words):
    found = read(tmp_path, text, units=None)
    assert found.structure is None
    assert words in str(found.problems[0])


@pytest.mark.skipif(not DATA.is_dir(), reason="models of other programs are not here")
def test_files_of_other_programs(tmp_path):
    """Three modes of four nodes at 10, 20, 30 Hz as printed, without places or modal masses."""
    path = DATA / "uff55_translation.uff"
    assert "has no nodes" in str(read_universal_modes(path).problems[0])
    (tmp_path / "n.csv").write_text("node,x,y,z\n1,0,0,0\n2,4,0,0\n3,4,3,0\n4,0,3,0\n")
    nodes = tmp_path / "n.csv"
    assert "nothing tells the scale" in str(read_universal_modes(path, nodes=nodes).problems[0])
    model = read_universal_modes(path, nodes=nodes, unit_mass=True).structure
    lines = path.read_text().splitlines()
    printed = [
        float(line.split()[0]) for line in lines if len(line.split()) == 4 and "E" in line.upper()
    ]
    assert (model.omega / 2.0 / np.pi).tolist() == pytest.approx(sorted(printed)[-3:])
    for name in ("testlab_modes.uff", "mesh_Oros-modal_uff15_uff2412.uff"):
        assert "has no modes" in str(read_universal_modes(DATA / name).problems[0])
